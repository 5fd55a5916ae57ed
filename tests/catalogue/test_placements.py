"""Placements of mechanisms on templates: their number, their symmetries, their names."""

from functools import cache
from itertools import product
from math import factorial, prod

import numpy as np
import pytest

import gsp
from gsp import catalogue
from gsp.catalogue.arrangements import distinct, image
from gsp.catalogue.placement import name_of, read_word, spread
from gsp.errors import InvalidDesign, InvalidInput
from gsp.indices import INDICES
from tests.metamorphic import circle
from tests.support import random_design, random_pose, turn

SIX = catalogue.design("toz-kucuk-2016-d3-6")
ALL = catalogue.mechanisms()
PAIRS = np.array([-10.0, 10.0, 110.0, 130.0, 230.0, 250.0])
TURN, MIRROR = (2, 3, 4, 5, 0, 1), (1, 0, 5, 4, 3, 2)


def lined(base, platform, base_lines=None, platform_lines=None):
    """A template with lines at all anchors, towards the origins where none are given."""
    return gsp.Design(
        ["D4"] * len(base),
        base,
        platform,
        -base if base_lines is None else base_lines,
        -platform if platform_lines is None else platform_lines,
        characteristic_length=0.8,
        home=gsp.Pose([0.0, 0.0, 1.5]),
    )


def thrice(lines):
    """Two lines, turned by 0, 120 and 240 degrees about the z-axis."""
    turns = turn([[0.0, 0.0, k * 2.0 * np.pi / 3.0] for k in range(3)])
    return np.einsum("kij,nj->kni", turns, lines).reshape(6, 3)


PRISM = lined(circle(PAIRS, 1.0, 0.3), circle(PAIRS + 40.0, 1.0, 0.3))
MACHINE = lined(circle(PAIRS, 1.5, 0.3), circle(PAIRS[::-1] + 60.0, 0.8, -0.1))
SKEW = lined(
    circle(PAIRS, 1.5, 0.3),
    circle(PAIRS + 60.0, 0.8),
    thrice([[0.3, 0.5, 1.0], [0.2, -0.4, 1.0]]),
    thrice([[0.7, 0.1, -1.0], [0.2, 0.9, 0.4]]),
)
HEXAGON = lined(circle(np.arange(6) * 60.0, 1.7), circle(np.arange(6) * 60.0 + 20.0))
SEVEN = lined(
    np.concatenate((MACHINE.base_points, [[0.0, 0.0, 0.4]])),
    np.concatenate((MACHINE.platform_points, [[0.0, 0.0, 0.0]])),
    platform_lines=np.concatenate((-MACHINE.platform_points, [[0.0, 0.0, 1.0]])),
)
# Template, and generators of its group as they are read off a drawing: image of each position, and
# whether base and platform are exchanged.
TEMPLATES = {
    "TozKucuk2016": (SIX, [(TURN, False), (MIRROR, False)]),
    "hexagons": (HEXAGON, [((1, 2, 3, 4, 5, 0), False), ((0, 5, 4, 3, 2, 1), False)]),
    "seven": (SEVEN, [((*TURN, 6), False), ((*MIRROR, 6), False)]),
    "prism": (PRISM, [(TURN, False), (MIRROR, False), (tuple(range(6)), True)]),
    "skew": (SKEW, [(TURN, False)]),
}


@cache
def group(name):
    """All products of the generators."""
    template, generators = TEMPLATES[name]
    found = {(tuple(range(template.n_legs)), False)}
    while True:
        more = {
            (tuple(b[0][i] for i in a[0]), a[1] != b[1]) for a in found for b in generators
        } | found
        if more == found:
            return found
        found = more


def cycles(order):
    """Lengths of the cycles of a permutation."""
    left, lengths = set(range(len(order))), []
    while left:
        i = min(left)
        length = 0
        while i in left:
            left.remove(i)
            i, length = order[i], length + 1
        lengths.append(length)
    return lengths


EXCHANGED = {"D2": "D3", "D3": "D2"}


def unchanged(order, exchanged, counts):
    """The number of ways that a symmetry leaves as they are, for numbers of legs of each kind.

    All places of a cycle have one leg; an exchange makes D2 and D3 alternate along it.
    """
    ways = {tuple(0 for _ in counts): 1}
    kinds = list(counts)
    for length in cycles(order):
        new = {}
        for used, number in ways.items():
            for kind in kinds:
                other = EXCHANGED.get(kind, kind) if exchanged else kind
                if other != kind and length % 2:
                    continue
                add = dict.fromkeys(kinds, 0)
                for i in range(length):
                    add[other if i % 2 else kind] += 1
                total = tuple(u + add[k] for u, k in zip(used, kinds, strict=True))
                new[total] = new.get(total, 0) + number
        ways = new
    return ways.get(tuple(counts.values()), 0)


def burnside(name, mechanism, exchange=False):
    """The number of placements by Burnside's lemma: the mean number of unchanged ways."""
    template = TEMPLATES[name][0]
    legs = [leg.name for leg in mechanism.legs]
    counts = {kind: legs.count(kind) for kind in dict.fromkeys(legs)}
    counts[""] = template.n_legs - len(legs)
    exchange &= mechanism.exchanged() == mechanism
    elements = [element for element in group(name) if exchange or not element[1]]
    total = sum(unchanged(*element, counts) for element in elements)
    assert total % len(elements) == 0
    return total // len(elements)


@pytest.mark.parametrize("name", TEMPLATES)
def test_the_group_is_that_of_the_drawing(name):
    template = TEMPLATES[name][0]
    found = catalogue.symmetries(template, exchange=True)
    assert {(s.legs, s.exchanged) for s in found} == group(name)
    assert len(found) == len(group(name))
    assert found[0].legs == tuple(range(template.n_legs))
    kept = catalogue.symmetries(template)
    assert {s.legs for s in kept} == {order for order, exchanged in group(name) if not exchanged}


@pytest.mark.parametrize("name", ["TozKucuk2016", "hexagons", "seven"])
def test_all_mechanisms_have_as_many_placements_as_burnside_counts(name):
    template = TEMPLATES[name][0]
    found = catalogue.symmetries(template)
    for mechanism in ALL:
        words = list(distinct(spread(mechanism, template), found, exchange=False))
        assert len(words) == burnside(name, mechanism), mechanism
    for mechanism in ALL[::40]:
        assert len(catalogue.placements(mechanism, template)) == burnside(name, mechanism)


def test_exchange_joins_placements_of_mechanisms_that_are_their_own_exchange():
    own = [mechanism for mechanism in ALL if mechanism.exchanged() == mechanism]
    for mechanism in [*own, *ALL[1::60]]:
        found = catalogue.placements(mechanism, PRISM, exchange=True)
        assert len(found) == burnside("prism", mechanism, exchange=True), mechanism
    numbers = [burnside("prism", mechanism, exchange) for mechanism in own for exchange in (0, 1)]
    assert sum(numbers[1::2]) < 0.8 * sum(numbers[::2])


def test_sums_that_are_known():
    """Words of six letters D1 … D4 modulo the group: (4⁶ + 2 · 4² + 3 · 4³)/6 of the class 6D.

    The others are the numbers that docs/exploration.md states.
    """
    number = dict.fromkeys(("6D", "5D1A", "4D2A", "3D3A"), 0)
    for mechanism in ALL:
        number[mechanism.group] += burnside("TozKucuk2016", mechanism)
    assert number["6D"] == (4**6 + 2 * 4**2 + 3 * 4**3) // 6
    assert number == {"6D": 720, "5D1A": 1523, "4D2A": 1008, "3D3A": 456}
    assert sum(number.values()) == 3707


@pytest.mark.parametrize("text", ["D1^3 D2^3", "D1 D2 D3 D4 A1^2", "D4^3 A1^3", "D1^2 D2^2 D3^2"])
@pytest.mark.parametrize("name", ["TozKucuk2016", "seven", "skew"])
def test_each_way_is_there_once(name, text):
    """The images of all placements are all ways, and no placement is an image of another one."""
    template, mechanism = TEMPLATES[name][0], catalogue.mechanism(text)
    legs = mechanism.legs
    seen = []
    for design in catalogue.placements(mechanism, template):
        word = design.name.split("-")
        images = set()
        for order, exchanged in group(name):
            moved = [""] * len(word)
            for leg, place in zip(word, order, strict=True):
                moved[place] = leg
            if not exchanged:
                images.add(tuple(moved))
        seen.extend(images)
    names = [leg.name for leg in legs] + [""] * (template.n_legs - len(legs))
    ways = factorial(len(names)) // prod(factorial(names.count(kind)) for kind in set(names))
    assert len(seen) == len(set(seen)) == ways


def test_a_template_without_symmetry_has_all_ways():
    template = random_design(np.random.default_rng(3), ["D4"] * 6)
    assert len(catalogue.symmetries(template)) == 1
    assert len(catalogue.placements(catalogue.mechanism("D1^3 D2^3"), template)) == 20
    assert len(catalogue.placements(catalogue.mechanism("D4^3 A1^3"), template)) == 20


def values(index, design, pose):
    given = {"length": 0.8, "ellipsoid": gsp.Ellipsoid([0.5, 0.5, 0.2]), "maximum": 2.0}
    return index.function(design.at(pose), **{name: given[name] for name in index.parameters})


@pytest.mark.parametrize("template", [MACHINE, SKEW, SEVEN, HEXAGON], ids=["D3", "C3", "7", "D6"])
def test_symmetric_placements_have_the_same_indices_and_joints(template):
    rng = np.random.default_rng(1)
    pose = random_pose(rng, (5,))
    found = catalogue.symmetries(template)
    assert len(found) > 1
    spare = ["0"] * (template.n_legs - 5)
    for legs in (["D1", "D2", "D3", "D4A1", "A1", *spare], ["D2", "D3", "D4", "A1", "D1", "D2"]):
        word = read_word([*legs, *["D3"] * (template.n_legs - len(legs))])
        design = catalogue.place(name_of(word), template)
        for symmetry in found:
            other = catalogue.place(name_of(image(word, symmetry)), template)
            there = gsp.Pose(*symmetry.image(pose.position, pose.rotation))
            _check_rows(design, pose, other, there, symmetry)
            for name, index in INDICES.items():
                if index.actuators not in (None, len(design.rows)):
                    continue
                here = values(index, design, pose)
                if index.invariance.base_turn == "changes":
                    axis = symmetry.base[:, "xyz".index(name[-1])]
                    springs = np.where(other.angular, 0.8**2, 1.0)
                    moved = gsp.statics.directional_stiffness(other, there, springs, axis)
                else:
                    moved = values(index, other, there)
                np.testing.assert_allclose(moved, here, rtol=1e-6, atol=1e-9, err_msg=name)


def _check_rows(design, pose, other, there, symmetry):
    """Rows [u, r × u] become [Q u, ±Q (r × u)], of angles perhaps with the other sign."""
    place = {leg: symmetry.legs[int(where)] for leg, where in _positions(design)}
    seats = {where: leg for leg, where in _positions(other)}
    order = [
        next(
            k
            for k, mine in enumerate(other.rows)
            if mine.leg == seats[place[row.leg]] and mine.constraint is row.constraint
        )
        for row in design.rows
    ]
    q = symmetry.base[:, :3]
    hand = -1.0 if symmetry.reflected else 1.0
    assert np.sign(np.linalg.det(q)) == hand
    twist = np.block([[q, np.zeros((3, 3))], [np.zeros((3, 3)), hand * q]])
    here, moved = design.at(pose), other.at(there)
    rows = (moved.jacobian @ twist)[:, order]
    signs = np.sign((rows * here.jacobian).sum(axis=-1))
    assert (signs[:, ~design.angular] == 1.0).all()
    np.testing.assert_allclose(rows, here.jacobian * signs[..., None], atol=1e-9)
    joints = moved.joints[:, order]
    wanted = np.where(signs > 0.0, here.joints, np.pi - here.joints)
    np.testing.assert_allclose(joints, wanted, atol=1e-9)


def _positions(design):
    """Each leg with its position on the template, which its name states."""
    there = [i for i, leg in enumerate(design.name.split("-")) if leg != "0"]
    return list(enumerate(there))


def test_exchanged_placements_have_the_same_joints_and_determinant():
    rng = np.random.default_rng(2)
    pose = random_pose(rng, (5,))
    word = read_word("D1-D2-D3-D4A1-A1-0")
    design = catalogue.place(name_of(word), PRISM)
    exchanges = [s for s in catalogue.symmetries(PRISM, exchange=True) if s.exchanged]
    assert len(exchanges) == 6
    for symmetry in exchanges:
        other = catalogue.place(name_of(image(word, symmetry)), PRISM)
        there = gsp.Pose(*symmetry.image(pose.position, pose.rotation))
        for name in ("manipulability", "quality_index"):
            index = INDICES[name]
            assert index.invariance.exchange == "unchanged"
            here = values(index, design, pose)
            np.testing.assert_allclose(values(index, other, there), here, rtol=1e-9)
        distances = [
            np.sort(d.at(p).joints[:, ~d.angular]) for d, p in ((design, pose), (other, there))
        ]
        np.testing.assert_allclose(*distances, rtol=1e-9)


def test_names_make_the_same_designs():
    names = set()
    for mechanism, exchange in product(ALL[::7], [False, True]):
        found = catalogue.placements(mechanism, SIX, exchange=exchange)
        first = catalogue.instantiate(mechanism, SIX)
        assert [leg.name for leg in found[0].legs] == [leg.name for leg in first.legs]
        np.testing.assert_array_equal(found[0].base_points, first.base_points)
        for design in found[:: 1 + len(found) // 3]:
            again = catalogue.place(design.name, SIX)
            assert (again.name, again.mechanism) == (design.name, mechanism)
            for part in ("base_points", "platform_points", "base_directions"):
                np.testing.assert_array_equal(getattr(again, part), getattr(design, part))
            names.add(design.name)
    assert catalogue.place(["d1", "D2", "", "D4 A1", "a1", "D3"], SIX).name == "D1-D2-0-D4A1-A1-D3"


def test_another_order_of_the_template_gives_the_same_placements():
    order = [3, 0, 5, 1, 4, 2]
    other = SIX.replace(
        base_points=SIX.base_points[order],
        platform_points=SIX.platform_points[order],
        base_directions=SIX.base_directions[order],
    )
    for text in ("D1^3 D2^3", "D1 D2 D3 D4 A1^2", "D4^3 A1^3"):
        mechanism = catalogue.mechanism(text)
        orbits = []
        for template, places in ((SIX, range(6)), (other, order)):
            found = set()
            for design in catalogue.placements(mechanism, template):
                word = [""] * 6
                for leg, place in zip(design.name.split("-"), places, strict=True):
                    word[place] = leg
                images = (
                    tuple(word[symmetry.index(i)] for i in range(6))
                    for symmetry, _ in group("TozKucuk2016")
                )
                found.add(min(images))
            orbits.append(found)
        assert orbits[0] == orbits[1]
        assert len(orbits[0]) == burnside("TozKucuk2016", mechanism)


def test_reflections_can_be_kept_apart():
    mechanism = catalogue.mechanism("D1 D2 D3 D4^2 A1")
    turns = catalogue.symmetries(SIX, reflections=False)
    assert [s.reflected for s in turns] == [False] * 3
    ways = factorial(6) // 1  # D1, D2, D3, D4, D4 A1, and an empty position
    assert len(catalogue.placements(mechanism, SIX, reflections=False)) == ways // 3
    assert len(catalogue.placements(mechanism, SIX)) == ways // 6


def test_what_is_fixed_to_the_platform_belongs_to_its_symmetry():
    """The platform origin, about which indices are taken, and the ellipsoid."""
    assert len(catalogue.symmetries(MACHINE)) == 6
    lines = MACHINE.replace(platform_points=MACHINE.platform_points + [0.1, 0.0, 0.0])
    assert [s.legs for s in catalogue.symmetries(lines)] == [(0, 1, 2, 3, 4, 5), (5, 4, 3, 2, 1, 0)]
    tall = MACHINE.replace(platform_points=MACHINE.platform_points + [0.0, 0.0, 0.1])
    assert len(catalogue.symmetries(tall)) == 6
    for axes, centre, number in (
        ([0.5, 0.5, 0.2], [0, 0, 0.3], 6),
        ([0.5, 0.4, 0.2], [0, 0, 0.3], 2),
        ([0.5, 0.5, 0.2], [0.1, 0.2, 0.3], 1),
    ):
        ellipsoid = gsp.Ellipsoid(axes, centre)
        assert len(catalogue.symmetries(MACHINE.replace(ellipsoid=ellipsoid))) == number


def test_the_tolerance_decides():
    rng = np.random.default_rng(4)
    shake = 1e-3 * rng.uniform(-1.0, 1.0, (6, 3))
    near = MACHINE.replace(base_points=MACHINE.base_points + shake)
    assert len(catalogue.symmetries(near)) == 1
    assert len(catalogue.symmetries(near, tolerance=1e-2)) == 6
    assert len(catalogue.symmetries(SIX, tolerance=1e-8)) == 2  # printed to a micrometre


def test_orders_that_are_no_group():
    """Radii of a platform that differ by 1 % of the next one's and by 1.7 % of the one after."""
    radii = 1.0 + 0.01 * np.cos(np.arange(6) * np.pi / 3)
    points = circle(np.arange(6) * 60.0) * radii[:, None]
    template = lined(circle(np.arange(6) * 60.0, 1.0, 0.4), points)
    with pytest.raises(InvalidInput, match="tolerance: expected a tolerance at which"):
        catalogue.symmetries(template, tolerance=0.013 / template.rms_radius)
    assert len(catalogue.symmetries(template, tolerance=0.03 / template.rms_radius)) == 12
    assert len(catalogue.symmetries(template, tolerance=0.001)) == 2


def test_bad_templates_and_legs():
    mechanism = catalogue.mechanism("D1^6")
    nine = random_design(np.random.default_rng(0), ["D1"] * 9)
    with pytest.raises(InvalidDesign, match="template: expected at most 8 legs"):
        catalogue.placements(mechanism, nine)
    five = catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    with pytest.raises(InvalidDesign, match="template: expected at least 6 legs"):
        catalogue.placements(mechanism, five)
    with pytest.raises(InvalidDesign, match="legs: expected 6 legs, one per position"):
        catalogue.place("D1-D1-D1", SIX)
    with pytest.raises(InvalidDesign, match=r"legs\[1\]: expected one of 'D1'"):
        catalogue.place("D1-D9-D1-D1-D1-D1", SIX)
    with pytest.raises(InvalidDesign, match="legs: expected at least six constraints"):
        catalogue.place("D1-0-D1-D1-D1-D1", SIX)
    points = SIX.platform_points.copy()
    points[2] = 0.0
    lineless = SIX.replace(platform_points=points)
    assert len(catalogue.placements(mechanism, lineless)) == 1
    with pytest.raises(InvalidDesign, match=r"template, platform line of leg 3 \(D2\): expected"):
        catalogue.placements(catalogue.mechanism("D1^5 D2"), lineless)
