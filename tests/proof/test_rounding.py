"""Bounds of singular values hold in 50 digits where rounding is not small beside σ_min."""

from __future__ import annotations

from types import SimpleNamespace

import mpmath
import numpy as np
import pytest

import gsp
from gsp.kernels.stages import UPPER_SCALARS
from gsp.kernels.trace import Traced, needed
from gsp.variation import blocks, matrices
from gsp.variation.layout import HIGH, LOW, MID_HIGH, MID_LOW, QUANTITY_SCALARS
from gsp.variation.legs import PATCH_SCALARS
from gsp.variation.quantities import ROW_SCALARS, ROW_SLOPES
from tests.campaign import count
from tests.exact import DIGITS, screw_rates, weighted_rows
from tests.proof.measured import CORNERS, LENGTH, bounds, random_box
from tests.screws import exact
from tests.support import random_design

OPERATIONS = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "<": np.less,
    "sqrt": np.sqrt,
    "choose": np.where,
}
RATIO = 1e-6


def singular_values(matrix):
    with mpmath.workdps(DIGITS):
        return mpmath.svd_r(mpmath.matrix(matrix.tolist()), compute_uv=False)


# --- boxes of designs ---


def exact_pose(values):
    """The pose of six coordinates, with roll, pitch and yaw, in 50 digits."""
    x = exact(values)
    (sr, cr), (sp, cp), (sy, cy) = ((mpmath.sin(a), mpmath.cos(a)) for a in x[3:])
    rotation = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return SimpleNamespace(position=x[:3], rotation=np.array(rotation), shape=())


def extremes(design, values):
    """σ_min and the condition number in 50 digits, from joint screws."""
    with mpmath.workdps(DIGITS):
        rows = weighted_rows(design, screw_rates(design, exact_pose(values)), LENGTH)
        s = singular_values(rows * np.array([1] * 3 + [1 / mpmath.mpf(LENGTH)] * 3))
        return np.array([s[5], s[0] / s[5]])


def nearly_singular(rng, design):
    """Coordinates of a pose where σ_min / σ_max is about RATIO: near to a change of sign of det."""
    place = random_box(rng, 0.0)

    def at(t):
        return design.at(place.pose(ends[0] + t * (ends[1] - ends[0])))

    def sign(t):
        return np.sign(np.linalg.det(at(t).jacobian))

    while True:
        ends = random_box(rng, 0.0).low, random_box(rng, 0.0).low
        if sign(0.0) * sign(1.0) > 0.0:
            continue
        low, high = 0.0, 1.0
        for _ in range(50):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if sign(middle) == sign(0.0) else (low, middle)
        s = at(low + 1e-4).singular_values(LENGTH)
        t = low + RATIO * 1e-4 * s[0] / s[-1]
        s = at(t).singular_values(LENGTH)
        # The sign also changes where two lines of a leg meet.
        if RATIO / 5 < s[-1] / s[0] < 5 * RATIO:
            return ends[0] + t * (ends[1] - ends[0])


def test_bounds_hold_in_50_digits_near_to_singular_poses():
    rng, tight = np.random.default_rng(40), 0
    kinds = ["D1"] * 6, ["D1"] * 5 + ["A1"], ["D1"] * 3 + ["D2", "D3", "D4"]
    number = count(4, 30)
    for i in range(number):
        design = random_design(rng, kinds[i % 3])
        middle = nearly_singular(rng, design)
        half = 10.0 ** rng.uniform(-10.0, -7.0) * rng.random(6)
        pairs = np.stack((middle - half, middle + half), axis=1).tolist()
        box = gsp.PoseBox(pairs[:3], pairs[3:])
        names, found = bounds(design, box)
        q = names.index("minimum_singular_value")
        found = found[q : q + 2]
        points = box.low + (0.5 + 0.5 * CORNERS) * (box.high - box.low)
        sigma = design.at(box.pose(points)).singular_values(LENGTH)
        ends = {
            k(x) for x in (sigma[:, -1], sigma[:, 0] / sigma[:, -1]) for k in (np.argmin, np.argmax)
        }
        values = np.array([extremes(design, points[k]) for k in ends])
        assert (found[:, LOW] <= values).all()
        assert (found[:, HIGH] >= values).all()
        at_centre = extremes(design, 0.5 * (box.low + box.high))
        assert (found[:, MID_LOW] <= at_centre).all()
        assert (found[:, MID_HIGH] >= at_centre).all()
        least, most = values[:, 0].min(), values[:, 0].max()
        tight += least - found[0, LOW] < 0.2 * (most - least)
    # Bounds without the exact derivative are several times as wide.
    assert tight > number / 4


# --- the stages on matrices that they are sensitive to ---


def run(stage, arrays, **scalars):
    """Evaluate a stage in doubles, one column for each matrix."""
    done = {}

    def value(x):
        return done[x.number] if isinstance(x, Traced) else np.float64(x)

    for node in needed([x for _, _, x in stage.outputs]):
        if node.op == "lane":
            done[node.number] = arrays[node.args[0]][node.args[1]]
        elif node.op == "scalar":
            done[node.number] = np.float64(scalars[node.args[0]])
        else:
            done[node.number] = OPERATIONS[node.op](*map(value, node.args))
    outputs = [(name, k, value(x)) for name, k, x in stage.outputs]
    for name, k, x in outputs:
        arrays[name][k] = x


def bounds_of(centres, slopes):
    """Bounds of σ_min and of the condition number by the blocks alone.

    (4, n) of J + Σ ±J_k, and (4, n) of J.
    """
    n = len(centres)
    rows = np.zeros((6, ROW_SCALARS, n))
    rows[:, :6] = centres.transpose(1, 2, 0)
    rows[:, ROW_SLOPES : ROW_SLOPES + 36] = slopes.transpose(2, 1, 3, 0).reshape(6, 36, n)
    sizes = {
        "upper": UPPER_SCALARS,
        "inverse": matrices.INVERSE_SCALARS,
        "sign": 1,
        "gram": matrices.GRAM_SCALARS,
        "directions": blocks.DIRECTIONS_SCALARS,
        "sums": blocks.BLOCK_SUMS_SCALARS,
        "quantity": 2 * QUANTITY_SCALARS,
    }
    arrays = {name: np.zeros((size, n)) for name, size in sizes.items()}
    arrays |= {"rows": rows.reshape(-1, n), "patch": np.ones((PATCH_SCALARS, n))}
    quantity = arrays["quantity"]
    for high in (HIGH, MID_HIGH):
        quantity[[high, QUANTITY_SCALARS + high]] = np.inf
    with np.errstate(all="ignore"):
        for stage in (matrices.TRIANGLE, matrices.INVERSE_STAGE, blocks.DIRECTIONS_STAGE):
            run(stage, arrays)
        run(blocks.BLOCK_ROWS[1], arrays)
        at_once, arrays["sums"] = arrays["sums"], np.zeros_like(arrays["sums"])
        for row in rows:
            arrays |= {"row": row, "rows": row}
            run(matrices.GRAM_ROW, arrays)
            run(blocks.BLOCK_ROWS[0], arrays)
        # Six rows at once are those one after the other.
        assert np.allclose(arrays["sums"], at_once, rtol=1e-12, atol=1e-14 * np.abs(at_once).max())
        run(blocks.BLOCKS, arrays, length=1.0)
    places = np.array([LOW, HIGH, QUANTITY_SCALARS + LOW, QUANTITY_SCALARS + HIGH])
    return quantity[places], quantity[places + (MID_LOW - LOW)]


def sensitive(rng, kind):
    """A matrix of condition 1e2 to 1e7 and six derivatives, by what makes bounds sharp.

    Derivatives so small that rounding is all; or only σ_min changes, or u against the others, with
    a part of 1e-9 to 1e-3 across, so that differences of products cancel.
    """
    least = 10.0 ** rng.uniform(-7.0, -2.0)
    second = min(1.0, least * 10.0 ** rng.uniform(0.1, 2.0 if kind else 6.0))
    middle = np.exp(np.sort(rng.uniform(np.log(second), 0.0, 3)))[::-1]
    left, right = (np.linalg.qr(rng.standard_normal((6, 6)))[0] for _ in range(2))
    centre = left @ np.diag([1.0, *middle, second, least]) @ right.T
    if kind == 0:
        return centre, rng.standard_normal((6, 6, 6)) * least * 10.0 ** rng.uniform(-10.0, -2.0)
    u = left[:, 5] + 10.0 ** rng.uniform(-9.0, -3.0) * left[:, 4]
    slopes = np.zeros((6, 6, 6))
    slopes[0] = rng.uniform(0.05, 0.9) * least * np.outer(u, right[:, 5])
    slopes[1] = rng.uniform(0.05, 0.9) * second * np.outer(left[:, 5], right[:, 4])
    return centre, slopes


@pytest.mark.parametrize("kind", [0, 1])
def test_blocks_hold_in_50_digits_for_matrices_that_are_sensitive(kind):
    rng = np.random.default_rng([41, kind])
    given = [sensitive(rng, kind) for _ in range(count(30, 1000))]
    centres, slopes = (np.array(x) for x in zip(*given, strict=True))
    found, at_centre = bounds_of(centres, slopes)
    assert np.mean(found[0] > 0.0) > 0.9
    assert np.median(at_centre[1] / at_centre[0]) < 1.0 + 1e-4
    for centre, (low, high, least, most) in zip(centres, at_centre.T, strict=True):
        s = singular_values(exact(centre))
        assert low <= s[5] <= high
        assert least <= s[0] / s[5] <= most
    for centre, some, (low, high, least, most) in zip(centres, slopes, found.T, strict=True):
        sigma = np.linalg.svd(centre + np.einsum("ck,kij->cij", CORNERS, some), compute_uv=False)
        for k in {sigma[:, 5].argmin(), sigma[:, 5].argmax()}:
            with mpmath.workdps(DIGITS):
                parts = (int(x) * exact(y) for x, y in zip(CORNERS[k], some, strict=True))
                s = singular_values(sum(parts, exact(centre)))
            assert low <= s[5] <= high
            assert least <= s[0] / s[5] <= most
