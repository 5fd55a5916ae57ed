"""No quantity varies over a box by more than its bounds state, and the bounds are not far off."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

import gsp
from gsp.model.legs import LEGS
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Angles, boxes_of, problem_of
from gsp.variation import legs, passive
from gsp.variation.kernel import enclose_boxes
from gsp.variation.layout import (
    HIGH,
    INDEX_ORDER,
    LOW,
    MID_HIGH,
    MID_LOW,
    SCREEN,
    SECOND_SCREEN,
    SPECTRA,
)
from gsp.variation.stages import sine_cosine
from tests.campaign import count
from tests.proof.measured import (
    CORNERS,
    bounds,
    commensurable,
    limits,
    measured,
    random_box,
)
from tests.proof.proofs import KINDS, poses_in
from tests.support import random_design


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("order", ["rpy", "approach-roll", "ZXZ", "yzx"])
def test_no_quantity_leaves_its_bounds(kind, order):
    rng = np.random.default_rng([KINDS.index(kind), len(order)])
    for size in np.geomspace(1e-4, 0.2, count(6, 60)):
        design = random_design(rng, [kind] * 5 + ["D1"])
        box = random_box(rng, size, order)
        names, found = bounds(design, box)
        share = np.concatenate((0.5 + 0.5 * CORNERS, rng.random((count(100, 400), 6))))
        values = measured(design, box.pose(box.low + share * (box.high - box.low)))
        # The library rounds too; a singular value by some units of the greatest one.
        margin = 1e-12 * (1.0 + np.abs(values).max(axis=0))
        inside = (values >= found[:, LOW] - margin) & (values <= found[:, HIGH] + margin)
        unbounded = np.isnan(found[:, LOW]) | np.isnan(found[:, HIGH])
        assert (inside | unbounded).all(), np.array(names)[~inside.all(axis=0)]
        assert size > 0.01 or not unbounded.any()


@pytest.mark.parametrize("kind", KINDS)
def test_bounds_at_a_point_hold_the_values_and_are_narrow(kind):
    rng = np.random.default_rng(KINDS.index(kind))
    for _ in range(20):
        design = random_design(rng, [kind] * 2 + ["D1"] * 4)
        box = random_box(rng, 0.0)
        _, found = bounds(design, box)
        value = measured(design, box.pose(0.5 * (box.low + box.high)))
        margin = 1e-12 * (1.0 + np.abs(value))
        assert (value >= found[:, MID_LOW] - margin).all()
        assert (value <= found[:, MID_HIGH] + margin).all()
        narrow = found[:, MID_HIGH] - found[:, MID_LOW] <= 1e-7 * (1.0 + np.abs(value) ** 2)
        assert narrow.all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_screen_holds_what_occurs_and_is_near_to_the_bounds_by_singular_values(kind):
    """Both screens bound them by norms of eighth powers and more, which take less time."""
    rng = np.random.default_rng([9, KINDS.index(kind)])
    for size in np.geomspace(1e-4, 0.1, count(4, 60)):
        design = random_design(rng, [kind] * 2 + ["D1"] * 4)
        box = random_box(rng, size)
        problem, angles = problem_of(design, limits(design)), Angles.of(box.order)
        whole, _ = enclose(problem, problem.frame(angles), boxes_of(box, angles))
        screens = []
        for second in (0, SECOND_SCREEN):
            screens.append(np.zeros_like(whole))
            enclose_boxes(
                boxes_of(box, angles), problem.frame(angles), *problem.arguments,
                SPECTRA | SCREEN | second, screens[-1], np.zeros(1),
            )  # fmt: skip
        wide, narrow = screens
        least = problem.names.index("minimum_singular_value")
        share = np.concatenate((0.5 + 0.5 * CORNERS, rng.random((400, 6))))
        values = measured(design, box.pose(box.low + share * (box.high - box.low)))
        for q in (least, least + 1):
            assert narrow[0, q, HIGH] <= wide[0, q, HIGH]
            low, high = narrow[0, q, [LOW, HIGH]] * [1.0 - 1e-9, 1.0 + 1e-9]
            assert ((values[:, q] >= low) & (values[:, q] <= high)).all()
            if size < 1e-3:
                assert wide[0, q, MID_LOW] >= whole[0, q, MID_LOW] / 1.6
                assert wide[0, q, MID_HIGH] <= whole[0, q, MID_HIGH] * 1.6


def climbed(function, rng, rounds=6):
    """Greatest value of a function of points in [−1, 1]⁶ by a random search that closes in."""
    crowd = count(15, 40)
    points = np.concatenate((CORNERS, rng.uniform(-1.0, 1.0, (crowd, 6))))
    best, value, reach = None, -np.inf, 1.0
    for _ in range(rounds):
        values = function(points)
        if values.max() > value:
            best, value = points[values.argmax()], values.max()
        reach *= 0.6
        points = np.clip(best + reach * rng.uniform(-1.0, 1.0, (crowd, 6)), -1.0, 1.0)
    return value


@pytest.mark.parametrize("kind", KINDS)
def test_searched_extremes_are_within_the_bounds_and_near_to_them(kind):
    """Maximise each of some quantities over a small box; the ratio is the tightness."""
    rng = np.random.default_rng([7, KINDS.index(kind)])
    some = ("base cone 2", "clearance 1-2", *INDEX_ORDER)
    for _ in range(count(1, 40)):
        design = random_design(rng, [kind] * 2 + ["D1"] * 4)
        box = random_box(rng, 0.004)
        names, found = bounds(design, box)
        half, middle = 0.5 * (box.high - box.low), 0.5 * (box.high + box.low)
        centre = measured(design, box.pose(middle))
        for name, side in [(names[0], 1.0), *((name, side) for name in some for side in (-1, 1))]:
            if name == "manipulability" and not commensurable(design):
                continue
            i = names.index(name)

            def quantity(x, i=i, side=side, design=design, box=box, middle=middle, half=half):
                return side * measured(design, box.pose(middle + x * half))[:, i]

            value, bound = side * climbed(quantity, rng), found[i, HIGH if side > 0 else LOW]
            assert side * value <= side * bound + 1e-12 * (1.0 + abs(value)), name
            if i == 0 and kind not in ("D2", "D4", "D4 A1"):  # their rests are larger
                assert (value - centre[i]) / (bound - centre[i]) > 0.7


def test_sines_of_the_search_are_right_to_some_units():
    """The rounding that the proofs allow for, 2⁻⁴⁴, is far above it."""
    worst = 0.0
    for angle in np.random.default_rng(0).uniform(-np.pi, np.pi, 2000):
        s, c = sine_cosine(float(angle))
        exact = mpmath.mpf(float(angle))
        worst = max(worst, abs(s - mpmath.sin(exact)), abs(c - mpmath.cos(exact)))
    assert worst < 2.0**-49


def test_halving_a_box_halves_the_remainder_by_four():
    """The rest beyond the linear part is of second order."""
    rng = np.random.default_rng(3)
    design = random_design(rng, ["D1"] * 6)
    widths = []
    for size in (0.04, 0.02, 0.01):
        box = gsp.PoseBox.around(gsp.Pose([0.1, 0.2, 1.5]), [size] * 6)
        names, found = bounds(design, box)
        share = rng.random((4000, 6))
        values = measured(design, box.pose(box.low + share * (box.high - box.low)))[:, 0]
        del names
        slope = np.abs(design.at(gsp.Pose([0.1, 0.2, 1.5])).jacobian[0]).sum() * size
        widths.append(found[0, HIGH] - found[0, LOW] - 2.0 * slope)
        assert values.max() <= found[0, HIGH]
    assert widths[0] / widths[1] == pytest.approx(4.0, rel=0.1)
    assert widths[1] / widths[2] == pytest.approx(4.0, rel=0.1)


def test_poses_in_a_box_are_in_the_box():
    rng = np.random.default_rng(0)
    box = random_box(rng, 0.3)
    inside = gsp.PoseBox.around(poses_in(rng, box, 1000), [0.0] * 6)
    assert (inside.low >= box.low - 1e-12).all()
    assert (inside.high <= box.high + 1e-12).all()


def test_each_leg_has_one_kind_on_patches():
    """Rows and values as many as constraints; the sign is that of legs between two lines."""
    names = tuple(leg.name for leg in LEGS)
    assert tuple(legs.KINDS) == tuple(passive.PASSIVE) == names
    for leg in LEGS:
        kind = legs.KINDS[leg.name]
        assert len(kind.rows) == len(kind.values) == len(leg.constraints)
        assert kind.signed == (leg.base_line and leg.platform_line)


@pytest.mark.parametrize("kind", KINDS)
def test_bounds_of_singular_values_have_the_exact_derivative(kind):
    """What they exceed the values at corners by falls with the square of the size of a box."""
    rng = np.random.default_rng([11, KINDS.index(kind)])
    falls = []
    for _ in range(12):
        design, place = random_design(rng, [kind] * 2 + ["D1"] * 4), random_box(rng, 0.0)
        excess = []
        for half in (1e-3, 1e-4):
            box = gsp.PoseBox.around(place.pose(place.low), [half] * 6, order=place.order)
            names, found = bounds(design, box)
            share = 0.5 + 0.5 * CORNERS
            values = measured(design, box.pose(box.low + share * (box.high - box.low)))
            q = names.index("minimum_singular_value")
            ends = values[:, q : q + 2]
            low, high = found[q : q + 2, LOW], found[q : q + 2, HIGH]
            excess.append([*(ends.min(axis=0) - low), *(high - ends.max(axis=0))])
        falls.append(np.divide(*np.array(excess)))
    assert (np.median(falls, axis=0) > 50.0).all(), np.median(falls, axis=0)
