"""Positions reached with some rotation of a range, against closed forms and samples."""

import numpy as np
import pytest

import gsp
from gsp.workspace.sets import reachable
from gsp.workspace.sets.compiled import frames, witness
from gsp.workspace.sets.compiled.frames import CELL_FRAME_SCALARS, TURNS
from gsp.workspace.sets.problem import bounded
from tests.reference.workspace_samples import designs, product_of_turns, reachable_within

ORDERS = ("rpy", "approach-roll", "ZYZ", "XZX", "zxy")


def drawn_range(rng, order):
    middle = rng.uniform(-1.0, 1.0, 3)
    if order in ("ZYZ", "XZX"):
        middle[1] += 1.5
    half = rng.uniform(0.0, 1.5, 3) * rng.integers(0, 2, 3)
    return gsp.PoseBox(
        [0, 0, 0], [(m - w, m + w) for m, w in zip(middle, half, strict=True)], order=order
    )


@pytest.mark.parametrize("order", ORDERS)
def test_faces_hold_the_rotations_of_a_range_and_touch_them(order):
    rng = np.random.default_rng(2)
    design = gsp.catalogue.design("workspace-6-3")
    plane = ([0.0, 1.0, 0.0], [[1.0, 1.0, 0.0], [0.0, 0.2, 1.0]])
    counted = 0
    for _ in range(20):
        box = drawn_range(rng, order)
        problem = bounded(design, None, plane, box)
        least, most = box.low[3:], box.high[3:]
        share = rng.uniform(size=(300, 3))
        share[:100] = rng.integers(0, 2, (100, 3))
        turns = problem.frame @ gsp.geometry.rotation_from_angles(
            least + share * (most - least), order
        )
        n, m, c = problem.faces[:, :3], problem.faces[:, 3:6], problem.faces[:, 6]
        values = np.einsum("fi,kij,fj->kf", n, turns, m) - c
        assert (values > -1e-12 * problem.arm).all()
        assert (values.min(axis=0) < 0.2 * problem.arm).all()
        counted += len(problem.faces)
    assert counted > 40


def arc_distances(points, half):
    """Least and greatest distance from −(cos φ, sin φ, 0), |φ| ≤ half, to points."""
    x = -points
    radius, turn = np.hypot(x[:, 0], x[:, 1]), np.arctan2(x[:, 1], x[:, 0])
    near = np.clip(turn, -half, half)
    opposite = turn - np.sign(turn) * np.pi
    far = np.where(np.abs(opposite) <= half, opposite, np.where(turn > 0, -half, half))
    return tuple(
        np.sqrt(radius**2 + 1 - 2 * radius * np.cos(turn - a) + x[:, 2] ** 2) for a in (near, far)
    )


@pytest.mark.parametrize("half", [0.4, 1.2])
def test_one_common_leg_that_turns_about_one_axis(half):
    arm = np.repeat([[1.0, 0.0, 0.0]], 6, axis=0)
    design = gsp.Design(["D1"] * 6, np.zeros((6, 3)), arm, strokes=[(1.0, 2.0)] * 6)
    box = gsp.PoseBox([0, 0, 0], [0, 0, (-half, half)])
    region = reachable(design, rotations=box, plane=([0, 0, 0.3], [[1, 0, 0], [0, 1, 0]]))
    low, high = region.area
    assert high - low < 0.05 * high
    rng = np.random.default_rng(0)
    points = rng.uniform(-3.1, 3.1, (2000, 3))
    points[:, 2] = 0.3
    near, far = arc_distances(points, half)
    # Rotations between the nearest and the farthest one have all distances between them.
    inside = (near <= 2.0) & (far >= 1.0)
    codes = region.contains(points)
    assert (codes[inside] >= 0).all()
    assert (codes[~inside] <= 0).all()
    assert (codes != 0).mean() > 0.99
    share = inside.mean() * 6.2**2
    assert low - 0.9 < share < high + 0.9


@pytest.mark.parametrize("number", [0, 3])
def test_a_range_of_rotations_has_the_points_of_samples(number):
    rng = np.random.default_rng(number)
    design = list(designs(rng, number + 1))[number]
    order = ("rpy", "approach-roll")[number % 2]
    box = gsp.PoseBox(
        [0, 0, 0], [(-30, 10), (-5, 40), 20 * (number == 0)], order=order, degrees=True
    )
    region = reachable(design, rotations=box, budget=20_000)
    points = rng.uniform(region.low.min(0), region.high.max(0), (40, 3))
    truth = reachable_within(design, points, box, *design.strokes.T, rng, starts=60, rounds=40)
    codes = region.contains(points)
    assert truth.sum() > 2
    assert not (truth & (codes < 0)).any()
    assert not (~truth & (codes > 0)).any()
    assert (codes != 0).mean() > 0.9


def test_turns_along_three_angles_are_feasible_where_it_is_proven(monkeypatch):
    # As plain Python: compiled for this test alone they would take longer than all of it.
    monkeypatch.setattr(witness, "_add_order", witness._add_order.py_func)
    monkeypatch.setattr(frames, "_turned", frames._turned.py_func)
    rng = np.random.default_rng(4)
    found = 0
    for number in range(300):
        # Along one direction the bounds are exact up to terms of third order.
        angles, h = rng.uniform(-0.5, 0.5, 3), 0.02 * rng.uniform(0.3, 1.0, 3)
        if number % 2:
            h *= np.eye(3)[rng.integers(0, 3)]
        p, a, b = rng.normal(size=3) + [0, 0, 2], rng.normal(size=3), rng.normal(size=3)
        turns = np.concatenate((np.eye(3)[::-1], np.eye(3)))  # moving axes z, y, x
        frame = np.empty(CELL_FRAME_SCALARS)
        frames.frame_of.py_func(angles - 1.0, angles + 1.0, turns, frame)
        axes = frame[TURNS : TURNS + 9].reshape(3, 3)
        slopes = 2.0 * rng.normal(size=(3, 3))
        slopes[rng.integers(0, 3)] = 0.0
        r = product_of_turns(angles[::-1][None], "rpy")[0]
        d = p - a + r @ b
        length, arm = np.sqrt(d @ d), np.cross(r @ b, d)
        normal = (d + (axes.T @ slopes).T @ arm) / length
        bend = np.linalg.norm(p - a) * np.linalg.norm(b) * (np.abs(slopes) @ h).sum() ** 2
        margin = np.abs(normal) @ h + rng.uniform(-0.5, 0.5) * bend
        side = rng.integers(0, 2)
        bounds = (length - margin, np.inf) if side == 0 else (0.0, length + margin)
        normal = normal if side == 0 else -normal
        legs = np.array([[*a, *b, np.linalg.norm(b), *bounds]])
        c = witness.covered.py_func(p, h, legs, r.ravel(), axes.T @ slopes, normal, axes, slopes)
        if c == np.inf:
            continue
        delta = h * (rng.integers(0, 2, (200, 3)) * 2 - 1)
        delta *= rng.uniform(0.5, 1.0, (200, 1)) ** rng.integers(0, 2, (200, 1))
        delta = delta[delta @ normal >= c]
        new = angles + delta @ slopes.T
        ends = p + delta + product_of_turns(new[:, ::-1], "rpy") @ b
        lengths = np.linalg.norm(ends - a, axis=1)
        assert ((lengths >= bounds[0]) & (lengths <= bounds[1])).all()
        found += len(delta) > 0
    assert found > 60
