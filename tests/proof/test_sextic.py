"""Bounds of |det J| over all poses of six D1 legs: no pose exceeds what is proven."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

import gsp
from gsp.determinant.symmetry import symmetries
from gsp.proof.sextic.coefficients import POSITION, ROTATION, SINGLE, charts, coefficients
from gsp.proof.sextic.halving import left_out
from gsp.proof.sextic.region import Sextic, halved, images, majorants, short_together
from tests.campaign import count
from tests.proof.proofs import hexapod

LEE = gsp.families.lee
POOL = np.empty((1 << 16, 6))


def quaternion(rotation):
    """(w, x, y, z)."""
    return np.roll(Rotation.from_matrix(rotation).as_quat(), 1)


def matrix(q):
    """Rotation of a quaternion (w, x, y, z) of any length."""
    return Rotation.from_quat(np.roll(q, -1)).as_matrix()


def plain(anchors):
    """The problem of anchors as they are, without symmetries."""
    free = (*SINGLE, *short_together(anchors))
    polynomials = charts(coefficients(anchors[0], anchors[1], free))
    return Sextic(
        anchors=anchors,
        unit=1.0,
        tolerance=1e-14,
        polynomials=polynomials,
        free=free,
        majorants=majorants(polynomials[0]),
        images=np.array([[1.0, 0.0, 0.0, 0.0]]),
    )


def values(anchors, chart, points):
    """|det J| at coordinates (..., 6)."""
    points = np.atleast_2d(points)
    q = np.insert(points[:, 3:], chart, 1.0, axis=1)
    turned = Rotation.from_quat(np.roll(q, -1, axis=1)).as_matrix() @ anchors[1].T
    d = points[:, None, :3] + turned.swapaxes(1, 2) - anchors[0]
    u = d / np.linalg.norm(d, axis=2, keepdims=True)
    return np.abs(np.linalg.det(np.concatenate((u, np.cross(anchors[0], u)), axis=2)))


def least_bound(problem, chart, box):
    """The least number, to 1 %, that one box is proven to be below; None without one."""
    low, high = 1e-12, 1e6
    if halved(problem, chart, box, 1e3, high, 1, POOL) != 1:
        return None
    while high / low > 1.01:
        middle = np.sqrt(low * high)
        if halved(problem, chart, box, 1e3, middle, 1, POOL) == 1:
            high = middle
        else:
            low = middle
    return high


def random_box(rng, problem, widest):
    """A chart and a box; in every third one a leg has length zero somewhere."""
    chart, x = int(rng.integers(4)), rng.uniform(-0.9, 0.9, 3)
    p, half = rng.normal(size=3), widest * rng.random(6)
    a, b = problem.anchors
    if rng.random() < 1 / 3:
        i, inside = rng.integers(6), rng.uniform(-1.0, 1.0, 6) * half
        r = matrix(np.insert(x + inside[3:], chart, 1.0))
        p = a[i] - r @ b[i] + inside[:3]
    return chart, np.concatenate((p, x, half))


def at(polynomials, p, x):
    """Polynomials (..., 84, 20) at a point."""
    high = np.prod(x ** np.array(ROTATION), axis=1)
    low = np.prod(p ** np.array(POSITION), axis=1)
    return np.einsum("n,...nm,m->...", high, polynomials, low)


def test_the_polynomial_is_the_determinant():
    rng = np.random.default_rng(0)
    base, platform = rng.normal(size=(2, 6, 3))
    polynomials = charts(coefficients(base, platform))
    design = gsp.Design(["D1"] * 6, base, platform)
    for chart in range(4):
        p, x = 3.0 * rng.normal(size=3), rng.normal(size=3)
        q = np.insert(x, chart, 1.0)
        d = p + platform @ matrix(q).T - base
        value = gsp.indices.manipulability(design.at(gsp.Pose(p, matrix(q))))
        lengths = np.prod(np.linalg.norm(d, axis=1)) * np.linalg.norm(q) ** 6
        np.testing.assert_allclose(
            abs(at(polynomials[chart, 0], p, x)) / lengths, value, rtol=1e-10
        )


def test_the_polynomials_agree_with_determinants_of_50_digits():
    """To the rounding of the coefficients to doubles, of P and of the cofactors."""
    mp = pytest.importorskip("mpmath").mp
    rng = np.random.default_rng(6)
    base, platform = rng.normal(size=(2, 6, 3))
    free = (*SINGLE, (1, 4), (0, 2, 3))
    polynomials = coefficients(base, platform, free)
    p, x = rng.normal(size=3), rng.uniform(-1.0, 1.0, 3)
    with mp.workdps(50):
        w = [mp.mpf(float(k)) for k in x]
        s = 1 + sum(k * k for k in w)
        skew = mp.matrix([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        turn = mp.eye(3) + 2 / s * (skew + skew * skew)
        d = [
            [p[k] + sum(turn[k, m] * mp.mpf(b[m]) for m in range(3)) - a[k] for k in range(3)]
            for a, b in zip(base, platform, strict=True)
        ]

        def exact(legs, columns):
            rows = [list(row) for row in d]
            for leg, column in zip(legs, columns, strict=True):
                rows[leg] = [turn[k, column] for k in range(3)]
            lines = [
                [
                    *v,
                    a[1] * v[2] - a[2] * v[1],
                    a[2] * v[0] - a[0] * v[2],
                    a[0] * v[1] - a[1] * v[0],
                ]
                for a, v in zip(base, rows, strict=True)
            ]
            return float(mp.det(mp.matrix(lines)) * s**3)

        expected = [
            exact(legs, columns) for legs in free for columns in product(range(3), repeat=len(legs))
        ]
    size = at(np.abs(polynomials), np.abs(p), np.abs(x))
    assert (np.abs(at(polynomials, p, x) - expected) < 1e-14 * size).all()


def highest(problem, chart, low, high, rng):
    """The largest |det J| that samples, corners and a local search find in a box."""
    points = rng.uniform(low, high, (100, 6))
    points[:50] = np.where(rng.random((50, 6)) < 0.5, low, high)
    found = values(problem.anchors, chart, points)
    top = found.max()
    best = minimize(
        lambda z: -values(problem.anchors, chart, z)[0] / top,
        points[found.argmax()],
        bounds=np.stack((low, high), axis=1),
        method="L-BFGS-B",
        options={"maxiter": 4},
    )
    return max(top, -best.fun * top)


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_no_pose_of_a_box_exceeds_its_bound(share):
    """With a bound that is wrong by half, the same test fails."""
    rng, exceeded = np.random.default_rng(1), 0
    for _ in range(count(1, 200)):
        problem = plain(rng.normal(size=(2, 6, 3)) * np.array([1.0, 0.7])[:, None, None])
        for n in range(8):
            chart, box = random_box(rng, problem, 0.15 if n % 2 else 0.02)
            bound = least_bound(problem, chart, box)
            if bound is not None:  # else two legs are short
                low, high = box[:6] - box[6:], box[:6] + box[6:]
                exceeded += highest(problem, chart, low, high, rng) > share * bound
    assert exceeded == 0 if share == 1.0 else exceeded > 0


def short_legs(rng, n):
    """Anchors, the first n of base and platform congruent, and a pose where these legs vanish."""
    base, platform = rng.normal(size=(2, 6, 3)) * np.array([1.0, 0.7])[:, None, None]
    chart, x, p = int(rng.integers(4)), rng.uniform(-0.9, 0.9, 3), rng.normal(size=3)
    platform[:n] = (base[:n] - p) @ matrix(np.insert(x, chart, 1.0))
    return plain(np.stack((base, platform))), chart, p, x


@pytest.mark.parametrize("n", [2, 3])
def test_no_pose_exceeds_its_bound_where_legs_are_short_together(n):
    """Without their cofactors such a box has no bound: all its parts down to a point are open."""
    rng = np.random.default_rng(7)
    for _ in range(count(1, 200)):
        problem, chart, p, x = short_legs(rng, n)
        single = replace(problem, free=SINGLE)
        for widest in (0.05, 0.01):
            half = widest * rng.uniform(0.1, 1.0, 6)
            middle = np.concatenate((p, x)) + rng.uniform(-0.5, 0.5, 6) * half
            box = np.concatenate((middle, half))
            assert least_bound(single, chart, box) is None
            bound = least_bound(problem, chart, box)
            low, high = middle - half, middle + half
            value = highest(problem, chart, low, high, rng)
            assert value <= bound < 10.0 * value


def test_bounds_of_small_boxes_are_near_to_values():
    rng, ratios = np.random.default_rng(2), []
    problem = plain(rng.normal(size=(2, 6, 3)))
    for _ in range(5):
        box = np.concatenate((rng.normal(size=3), rng.uniform(-0.9, 0.9, 3), np.full(6, 1e-4)))
        bound = least_bound(problem, 0, box)
        ratios.append(bound / values(problem.anchors, 0, box[:6])[0])
    assert min(ratios) >= 1.0
    assert np.median(ratios) < 1.03


@pytest.mark.parametrize("share", [0.9, 0.999])
def test_a_bound_below_a_value_is_not_proven(share):
    rng = np.random.default_rng(3)
    problem = plain(rng.normal(size=(2, 6, 3)))
    for _ in range(5):
        chart, box = random_box(rng, problem, 0.1)
        point = box[:6] + 0.9 * box[6:]
        bound = share * values(problem.anchors, chart, point)[0]
        assert halved(problem, chart, box, 1e3, bound, 3000, POOL) < 0


def test_the_maximum_of_a_neighbourhood_is_closed_to_one_percent():
    best = gsp.determinant.maximum(LEE.octahedral_3_3(1.0, 1.2))
    problem = plain(centred(LEE.octahedral_3_3(1.0, 1.2)))
    q = quaternion(best.pose.rotation)
    chart = int(np.abs(q).argmax())
    box = np.concatenate((best.pose.position, np.delete(q / q[chart], chart), np.full(6, 0.05)))
    assert halved(problem, chart, box, 1e3, best.value / 0.99, 100_000, POOL) > 0
    assert halved(problem, chart, box, 1e3, best.value * 0.999, 100_000, POOL) < 0


def centred(design):
    bodies = np.stack((design.base_points, design.platform_points))
    return bodies - bodies.mean(axis=1, keepdims=True)


def test_images_are_those_of_the_symmetries():
    rng = np.random.default_rng(0)
    designs = LEE.octahedral_3_3(1.0, 1.2), LEE.separated_to_centre(1, 2, 0.2), hexapod()
    assert [len(images(centred(d))[0]) for d in designs] == [12, 6, 12]
    assert len(images(rng.normal(size=(2, 6, 3)))[0]) == 1


def test_of_all_images_of_a_rotation_one_is_searched():
    anchors, rng = centred(LEE.octahedral_3_3(1.0, 1.2)), np.random.default_rng(5)
    turned, apart = images(anchors)
    assert apart < 1e-12
    group = symmetries(gsp.Design(["D1"] * 6, *anchors))
    for _ in range(20):
        r, kept = matrix(rng.normal(size=4)), 0
        for s in group:
            q = quaternion(s.base[:, :3] @ r @ s.platform[:, :3].T)
            chart = int(np.abs(q).argmax())
            kept += not left_out.py_func(chart, q / q[chart], np.zeros(6), turned)
        assert kept == 1
