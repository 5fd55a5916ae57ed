import itertools

import numpy as np
import pytest

import gsp
from gsp.errors import EmptyWorkspace, InvalidDesign, InvalidInput
from gsp.geometry.rotations import rotation_from_angles
from gsp.workspace import dextrous, fixed_orientation

BOX = [(-10, 10), (-8, 8), (-20, 20)]


def lengths(platform, points, angles):
    arms = platform.platform_points @ np.swapaxes(angles, -1, -2)
    return np.linalg.norm(points[:, None, None] + arms - platform.base_points, axis=-1)


@pytest.mark.parametrize("box", [[0, 0, (-30, 30)], [5, (-40, 10), -20], BOX])
def test_extremes_bound_all_angles_of_the_box_and_are_attained(platform, box):
    points = np.random.default_rng(1).uniform((-4, -4, 5), (4, 4, 12), (30, 3))
    found, where = dextrous(platform, box, degrees=True).extremes(points)
    pairs = [np.broadcast_to(b, (2,)) for b in box]
    grid = np.stack(np.meshgrid(*[np.linspace(*b, 15) for b in pairs], indexing="ij"), -1)
    rotation = rotation_from_angles(grid.reshape(-1, 3), "approach-roll", degrees=True)
    sampled = lengths(platform, points, rotation)
    assert (sampled.min(axis=1) >= found[..., 0] - 1e-12).all()
    assert (sampled.max(axis=1) <= found[..., 1] + 1e-12).all()
    assert np.allclose(sampled.min(axis=1), found[..., 0], atol=2e-2)
    assert np.allclose(sampled.max(axis=1), found[..., 1], atol=2e-2)
    turn = rotation_from_angles(where, "approach-roll")
    for leg in range(6):
        for side in (0, 1):
            arm = turn[:, leg, side] @ platform.platform_points[leg]
            gap = np.linalg.norm(points + arm - platform.base_points[leg], axis=1)
            assert np.allclose(gap, found[:, leg, side], atol=1e-12)


def test_a_box_of_one_orientation_is_the_fixed_orientation_set(platform):
    points = np.random.default_rng(2).uniform((-8, -8, 0), (8, 8, 14), (20_000, 3))
    shells = fixed_orientation(platform)
    point = dextrous(platform, [0, 0, 0])
    assert np.array_equal(point.contains(points), shells.contains(points))
    exact = shells.volume((0, np.inf)).value
    volume = point.volume(6, (0.0, np.inf))
    assert volume.value == pytest.approx(exact, rel=0.01)


def test_larger_boxes_have_smaller_sets(platform):
    points = np.random.default_rng(3).uniform((-8, -8, 0), (8, 8, 14), (5000, 3))
    sets = [
        dextrous(platform, [0, 0, (-g, g)], degrees=True).contains(points) for g in (0, 10, 20, 30)
    ]
    counts = [inside.sum() for inside in sets]
    assert all((larger <= smaller).all() for smaller, larger in itertools.pairwise(sets))
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[-1] > 0


def test_ray_ends_are_first_exits(platform):
    found = dextrous(platform, [0, 0, (-30, 30)], degrees=True)
    ends = found.section([0.0, 0.0, 9.5], rays=24)
    assert ends.certified.all()
    assert np.abs(found.margins(ends.position).min(axis=(1, 2))).max() < 1e-10
    share = np.linspace(0, 1, 41)[:, None, None]
    between = [0.0, 0.0, 9.5] + share * (ends.position - [0.0, 0.0, 9.5])
    assert found.margins(between.reshape(-1, 3)).min() > -1e-10
    for place, angles, text in zip(ends.position, ends.angles, ends.labels, strict=True):
        pose = gsp.Pose.from_angles(place, angles, "approach-roll")
        joints = platform.at(pose).joints
        leg = next(i for i, mark in enumerate(text.split()) if mark != "-")
        assert joints[leg] == pytest.approx((8.0, 15.0)[int(text.split()[leg])], abs=1e-9)


def test_bad_input(platform):
    with pytest.raises(InvalidInput, match="least ≤ greatest"):
        dextrous(platform, [0, 0, (10, -10)])
    with pytest.raises(InvalidInput, match="full turn"):
        dextrous(platform, [0, 0, (-10, 10)])
    with pytest.raises(InvalidInput, match="three numbers"):
        dextrous(platform, [0, 0])
    with pytest.raises(InvalidDesign, match="SPS"):
        dextrous(gsp.catalogue.design("toz-kucuk-2016-d3-6"), [0, 0, 0])
    with pytest.raises(EmptyWorkspace, match="leg"):
        dextrous(platform, [0, 0, (-1, 1)]).section([0.0, 0.0, 30.0])
