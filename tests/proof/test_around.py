"""The largest proven balls and cylinders, and the worst value of an index for many designs."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, UnknownIndex
from tests.proof.proofs import around, hexapod, singular_design, unit

HEXAPOD = hexapod()
UP = gsp.Pose([0.0, 0.0, 1.5])
WIDE = np.array([0.1, 0.1, 0.1, 0.05, 0.05, 0.05])


def inside(rng, shape, n):
    """Offsets (n, 6) with a gauge of at most 1 for half-widths of 1."""
    x = rng.uniform(-1.0, 1.0, (4 * n, 6))
    k = 3 if shape == "ball" else 2
    return x[np.linalg.norm(x[:, :k], axis=1) <= 1.0][:n]


@pytest.mark.parametrize("shape", ["ball", "cylinder"])
def test_no_pose_inside_violates_and_the_violation_does(shape):
    rng = np.random.default_rng(0)
    joints = HEXAPOD.at(UP).joints
    strokes = np.stack((joints - 0.2, joints + 0.2), axis=1)
    for limits in (None, gsp.Limits(strokes=strokes)):
        found = gsp.proof.largest_around(HEXAPOD, UP, WIDE, limits, shape=shape, budget=20_000)
        assert 0.5 < found.factor <= found.above
        x = inside(rng, shape, 4000) * found.factor * WIDE
        poses = gsp.Pose.from_rpy(UP.position + x[:, :3], x[:, 3:])
        sign = np.sign(np.linalg.det(HEXAPOD.at(UP).jacobian))
        assert (np.sign(np.linalg.det(HEXAPOD.at(poses).jacobian)) == sign).all()
        if limits is None:
            continue
        values = HEXAPOD.at(poses).joints
        assert ((values >= strokes[:, 0]) & (values <= strokes[:, 1])).all()
        assert not gsp.feasible(HEXAPOD, found.violation, limits)
        away = np.concatenate((found.violation.position - UP.position, found.violation.angles()))
        share, k = np.abs(away) / WIDE, 3 if shape == "ball" else 2
        gauge = max(np.linalg.norm(share[:k]), share[k:].max())
        assert gauge == pytest.approx(found.above, rel=1e-9)
        assert found.above < 1.3 * found.factor


def test_a_ball_of_positions_ends_where_a_leg_has_its_stroke():
    """Vertical displacement alone: the closed form."""
    most = HEXAPOD.at(gsp.Pose([0, 0, 1.7])).joints[0]
    limits = gsp.Limits(strokes=[(np.nan, most)] * 6)
    wide = [0, 0, 1.0, 0, 0, 0]
    for shape in ("ball", "cylinder"):
        found = gsp.proof.largest_around(HEXAPOD, UP, wide, limits, regular=False, shape=shape)
        assert found.factor <= 0.2 * (1 + 1e-9) <= found.above * (1 + 1e-9)
        assert found.factor > 0.19


def test_known_singular_poses_are_outside():
    rng = np.random.default_rng(1)
    for _ in range(4):
        design, singular = singular_design(rng, ["D1", "D2", "D3", "D1", "D1", "D1"])
        step = unit(rng.standard_normal(3)) * 0.1
        here = gsp.Pose(singular.position + step, singular.rotation)
        found = gsp.proof.largest_around(design, here, [0.1] * 3 + [0.05] * 3, budget=1500)
        assert found.factor <= 1.0 + 1e-9


def test_bad_input_of_balls():
    for given in ({"shape": "box"}, {"shape": None}, {"half_widths": [0.0] * 6}, {"pose": None}):
        with pytest.raises(InvalidInput):
            gsp.proof.largest_around(
                **{"design": HEXAPOD, "pose": UP, "half_widths": WIDE, **given}
            )


@pytest.mark.parametrize("index", ["CDN_CL", "σ_min"])
def test_the_worst_value_is_between_its_bounds_for_each_design(index):
    rng = np.random.default_rng(0)
    box = around(1.5, 0.05, 3.0)
    designs = [HEXAPOD, HEXAPOD.replace(platform_points=0.9 * HEXAPOD.platform_points)]
    seen = []
    given = {"length": 1.0, "budget": 5000}
    table = gsp.proof.worst(designs, box, index, **given, progress=lambda *x: seen.append(x))
    assert seen[-1] == (2, 2)
    poses = box.pose(box.low + rng.random((20_000, 6)) * (box.high - box.low))
    for i, design in enumerate(designs):
        row = table.iloc[i]
        function = gsp.indices.INDICES[gsp.indices.index_name(index)].function
        values = function(design.at(poses), 1.0)
        if index == "σ_min":
            assert row["low"] <= values.min()
            assert row["high"] <= 1.05 * values.min()
        else:
            assert values.max() <= row["high"]
            assert row["low"] >= 0.95 * values.max()
        assert row["low"] <= row["high"]
    again = gsp.proof.worst(designs, box, index, **given, workers=1)
    assert table.equals(again)
    low, high = gsp.bounds(designs[1], box, index, length=1.0, budget=5000)
    assert table["low" if index == "σ_min" else "high"][1] == (low if index == "σ_min" else high)


def test_bad_input_of_worst():
    box = around(1.5, 0.05, 3.0)
    with pytest.raises(InvalidInput):
        gsp.proof.worst([], box, "CDN_CL", length=1.0)
    with pytest.raises(InvalidInput):
        gsp.proof.worst([HEXAPOD, None], box, "CDN_CL", length=1.0)
    with pytest.raises(UnknownIndex):
        gsp.proof.worst([HEXAPOD], box, "rigidity_rate")
