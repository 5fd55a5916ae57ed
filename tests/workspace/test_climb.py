import numpy as np
import pytest

import gsp
from gsp.kernels.compiled.legs import leg_vectors
from gsp.limits.bounds import bounded_quantities
from gsp.workspace import Limits, feasible
from gsp.workspace.boundary.climb import climb_compiled, climb_stacked
from gsp.workspace.boundary.orientations import feasible_orientations
from tests.support import random_design, turn


@pytest.mark.parametrize("turns", [np.eye(3), np.eye(3)[2:], np.zeros((0, 3))])
def test_compiled_and_stacked_climbs_end_at_the_same_poses(platform, turns):
    bounds = bounded_quantities(platform)
    turn = feasible_orientations(platform, bounds, platform.home.position, None, 40, 3)
    place = np.tile(platform.home.position, (len(turn), 1))
    heading = np.random.default_rng(1).normal(size=place.shape)
    heading /= np.linalg.norm(heading, axis=1)[:, None]
    one = climb_stacked(bounds, turns, place.copy(), turn.copy(), heading)
    two = climb_compiled(bounds, turns, place.copy(), turn.copy(), heading)
    assert np.abs(one.position - place).max() > 1.0
    assert np.abs(one.position - two.position).max() < 1e-9 * bounds.scale
    assert np.abs(one.rotation - two.rotation).max() < 1e-9
    assert np.abs(one.slack - two.slack).max() < 1e-9


def test_thresholds_by_compiled_code_are_those_of_the_indices(platform, monkeypatch):
    pose = gsp.PoseBox.around(platform.home, [3, 3, 3, 0.3, 0.3, 0.3]).sample(200, rng=1)
    bounds = Limits(indices=["condition_number <= 20", "CTN >= 0.1"], length=platform.rms_radius)
    exact = feasible(platform, pose, bounds)
    monkeypatch.setattr("gsp.limits.bounds.POSES_FOR_COMPILED", 1)
    fast = feasible(platform, pose, bounds)
    assert 0.1 < exact.ok.mean() < 0.9
    assert (exact.ok == fast.ok).all()
    assert np.allclose(exact.values, fast.values, rtol=1e-9)


def test_compiled_vectors_of_a_leg_are_those_of_postures():
    """Their sum is d, whose norm is the joint value; the row is [u, R b × u]."""
    rng = np.random.default_rng(4)
    for _ in range(5):
        design = random_design(rng, ["D1"] * 6)
        pose = gsp.Pose(rng.normal(size=3), turn(rng.normal(size=3)))
        posture = design.at(pose)
        for i, points in enumerate(np.hstack((design.base_points, design.platform_points))):
            vectors = leg_vectors.py_func(pose.position, points, pose.rotation.ravel())
            arm = np.array(vectors[3:])
            d = np.array(vectors[:3]) + arm
            length = np.linalg.norm(d)
            assert np.isclose(length, posture.joints[i], rtol=1e-14)
            row = np.concatenate((d, np.cross(arm, d))) / length
            assert np.abs(row - posture.jacobian[i]).max() < 1e-14


def test_a_ray_with_a_fixed_orientation_ends_where_it_first_leaves():
    """The least root of |u0 + r e + b − a| = bound over six spheres, one of them a small hole."""
    met = 0
    for seed in range(8):
        rng = np.random.default_rng(seed)
        base, platform, origin = rng.normal(size=(6, 3)), 0.5 * rng.normal(size=(6, 3)), [0, 0, 1.2]
        centre = base - platform - origin
        strokes = np.c_[np.full(6, 0.05), 1.8 * np.linalg.norm(centre, axis=1)]
        design = gsp.Design(["D1"] * 6, base, platform, strokes=strokes)
        e = centre[0] / np.linalg.norm(centre[0])
        across = np.cross(e, [1.0, 0.0, 0.0])
        ends = gsp.workspace.section(
            design,
            origin,
            [e, across],
            rotation=np.eye(3),
            rays=[-0.005, 0.0, 0.005, 2.0],
            starts=1,
            most=1,
            connecting=False,
            progress=False,
        ).ends
        assert ends.maximal.all()
        for distance, position in zip(ends.distance, ends.position, strict=True):
            along = centre @ ((position - origin) / np.linalg.norm(position - origin))
            with np.errstate(invalid="ignore"):
                half = np.sqrt(strokes.T**2 - (centre**2).sum(axis=1) + along**2)
            exits = np.concatenate([along - half[0], along + half[1]])
            first = exits[exits > 0].min()
            assert np.isclose(distance, first, rtol=1e-9)
            met += int(first < along[0])
    assert met >= 8


def hollow(seed):
    """A design whose first leg ends at the platform origin, with a ball around its anchor cut out.

    The other legs allow all orientations, so that the reachable set is known.
    """
    rng = np.random.default_rng(seed)
    base, platform = rng.normal(size=(6, 3)), 0.5 * rng.normal(size=(6, 3))
    platform[0] = 0.0
    base[0] = [0.0, 0.0, 0.4]
    base[1:, 2] -= 6.0
    strokes = np.tile((0.01, 30.0), (6, 1))
    plain = gsp.Design(["D1"] * 6, base, platform)
    strokes[0] = plain.rms_radius * np.array([0.02, 4.0])
    return gsp.Design(["D1"] * 6, base, platform, strokes=strokes)


@pytest.mark.parametrize("seed", range(3))
def test_rays_with_free_orientations_end_before_a_gap_of_all_orientations(seed):
    """They end at the least root of |u0 + r e − a| = bound, from each start."""
    design, origin = hollow(seed), np.array([0.0, 0.0, -1.6])
    (low, high), centre = design.strokes[0], design.base_points[0] - origin
    tilt = np.array([0.0, 0.3, -0.6, 0.9, -1.5, 2.0]) * low / np.linalg.norm(centre)
    ends = gsp.workspace.section(
        design, origin, [[0, 0, 1], [1, 0, 0]], rays=tilt, starts=6, most=1, connecting=False,
        progress=False,
    ).ends  # fmt: skip
    assert ends.maximal.all(), ends.reason
    along = (ends.position - origin) @ centre / ends.distance
    square = along**2 - centre @ centre
    with np.errstate(invalid="ignore"):
        near, far = along - np.sqrt(square + low**2), along + np.sqrt(square + high**2)
    first = np.where(np.isnan(near), far, near)
    assert 0 < np.isnan(near).sum() < near.size
    assert np.allclose(ends.distance, first, rtol=1e-9)


def test_rays_reach_ends_that_are_a_thousand_sizes_away():
    design, origin = hollow(0), np.array([0.0, 0.0, -1.6])
    strokes, far = design.strokes.copy(), 1000.0 * design.rms_radius
    strokes[0, 1], strokes[1:, 1] = far, 4.0 * far
    mapped = gsp.workspace.surface(
        design.replace(strokes=strokes), origin, counts=(2, 3), starts=2, progress=False
    )
    assert mapped.maximal.all()
    away = np.linalg.norm(mapped.points - design.base_points[0], axis=-1)
    assert np.allclose(away, far, rtol=1e-9)
