"""Poses of regions, their worst index, and parts without singular poses."""

from functools import cache

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput, UnknownIndex
from gsp.proof import extremes
from tests.support import random_design

RING = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])
SHELL = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 2.0)] * 6)
SIX_THREE = gsp.catalogue.design("workspace-6-3")
TURNS = gsp.PoseBox([0, 0, 0], [(-5, 5), (-8, 8), (-2, 2)], degrees=True)


@cache
def both():
    """Above and below the base."""
    return gsp.workspace.fixed_orientation(SIX_THREE, resolution=2.0)


def test_poses_are_evenly_distributed_over_a_shell():
    region = gsp.workspace.fixed_orientation(SHELL, resolution=0.4)
    poses = region.poses(4000, rng=1)
    radius = np.linalg.norm(poses.position, axis=1)
    assert radius.min() >= 1.0
    assert radius.max() <= 2.0
    # The volume within r is (r³ − 1)/7 of all: even on [0, 1].
    share = np.sort((radius**3 - 1.0) / 7.0)
    assert np.abs(share - (np.arange(4000) + 0.5) / 4000).max() < 1.95 / np.sqrt(4000)
    assert np.abs(poses.position.mean(axis=0)).max() < 5 * 0.9 / np.sqrt(4000)
    again = region.poses(4000, rng=1)
    assert np.array_equal(again.position, poses.position)


def test_rotations_of_a_range_have_the_measure_of_the_rotations():
    wide = gsp.PoseBox([0, 0, 0], [(-1.0, 1.0), (0.0, 1.5), (0.3, 0.4)])
    legs = gsp.Design(["D1"] * 6, np.zeros((6, 3)), 0.1 * RING, strokes=[(0.5, 2.0)] * 6)
    limits = gsp.Limits(position=[(-1, 1), (-1, 1), (0.8, 1)])
    region = gsp.workspace.dextrous(legs, wide, limits, resolution=0.5)
    angles = region.poses(4000).angles()
    assert (angles >= wide.low[3:] - 1e-12).all()
    assert (angles <= wide.high[3:] + 1e-12).all()
    pitch = np.sort(np.sin(angles[:, 1]) / np.sin(1.5))
    assert np.abs(pitch - (np.arange(4000) + 0.5) / 4000).max() < 1.95 / np.sqrt(4000)


@pytest.mark.parametrize("index", ["CDN_CL", "σ_min"])
def test_worst_value_occurs_and_no_pose_is_worse(index):
    region = gsp.workspace.fixed_orientation(
        SIX_THREE, limits=gsp.Limits(position=[None, None, (6, None)]), resolution=2.0
    )
    found = region.worst(index, 0.3, length=1.0)
    sampled = gsp.evaluate(SIX_THREE, region.poses(3000), index, length=1.0).iloc[:, -1]
    own = gsp.evaluate(SIX_THREE, found.pose, index, length=1.0).iloc[0, -1]
    assert own == pytest.approx(found.value, rel=1e-6)
    assert gsp.feasible(SIX_THREE, found.pose).ok
    assert found.closed
    if index == "CDN_CL":
        assert sampled.max() <= found.bound
        assert found.value <= found.bound
    else:
        assert sampled.min() >= found.bound
        assert found.value >= found.bound


def test_worst_value_over_a_range_of_rotations():
    limits = gsp.Limits(position=[None, None, (6, None)])
    region = gsp.workspace.dextrous(SIX_THREE, TURNS, limits, resolution=1.5)
    found = region.worst("CDN_CL", length=1.0, budget=20_000)
    sampled = gsp.evaluate(SIX_THREE, region.poses(500), "CDN_CL", length=1.0).iloc[:, -1]
    assert sampled.max() <= found.bound
    assert region.contains(found.pose.position) == 1


@pytest.mark.parametrize("scale", [1.0, 1e3])
def test_the_least_determinant_is_not_below_the_power_of_the_least_singular_value(scale):
    """With few boxes the bound of |det J| alone is 0 here."""
    turns = gsp.PoseBox([0, 0, 0], [(-8, 8)] * 3, degrees=True)
    design = SIX_THREE.scaled(scale)
    limits = gsp.Limits(position=[None, None, (6 * scale, None)])
    region = gsp.workspace.dextrous(design, turns, limits, resolution=1.5 * scale)
    length = 7.5 * scale
    found = region.worst("|det J|", budget=200, length=length)
    least = region.worst("σ_min", budget=200, length=length).bound
    assert found.bound >= length**3 * least**6 * (1.0 - 1e-12) > 0.0
    own = np.abs(np.linalg.det(design.at(region.poses(500)).jacobian))
    assert found.bound <= min(found.value, own.min())
    share = region.worst("λ", budget=200, length=length, maximum=2.0 * scale**3)
    assert share.bound == pytest.approx(found.bound / (2.0 * scale**3), rel=1e-12)


def test_a_region_states_that_its_resolution_was_not_reached():
    given = {"limits": gsp.Limits(position=[None, None, (6, None)]), "resolution": 0.5}
    short = gsp.workspace.fixed_orientation(SIX_THREE, budget=20_000, **given)
    assert not short.reached
    assert short.resolution > short.wanted == 0.5
    assert "0.5 is not reached" in repr(short)
    whole = gsp.workspace.fixed_orientation(SIX_THREE, **{**given, "resolution": 2.0})
    assert whole.reached
    assert whole.resolution <= 2.0
    assert "reached" not in repr(whole)


@pytest.mark.parametrize("seed", [1, 10])
def test_the_worst_control_number_is_that_near_singular_poses(seed):
    """Its own bounds leave open where it is least; singular poses are the worst of all indices."""
    bare = random_design(np.random.default_rng(seed), ["D1"] * 5 + ["A1"])
    home = gsp.Pose([0.1, 0.0, 1.5])
    joints = bare.at(home).joints
    design = bare.replace(home=home, strokes=np.stack((0.9 * joints, 1.1 * joints), axis=-1))
    region = gsp.workspace.fixed_orientation(design, resolution=0.02)
    given = {"budget": 4000, "length": 1.0}
    near = design.at(region.worst("σ_min", **given).pose)
    found = region.worst("CTN", **given)
    assert found.value <= gsp.indices.control_number(near, length=1.0) * (1 + 1e-6) < 1e-4
    own = gsp.indices.control_number(design.at(found.pose), length=1.0)
    assert found.value == pytest.approx(own, rel=1e-6)


def test_worst_value_has_the_same_bits_in_blocks_of_any_size(monkeypatch):
    """All quantities of many cells at once would need gigabytes."""
    whole = both().worst("CTN", budget=6000)
    sizes, bounded = [], extremes.enclose
    monkeypatch.setattr(extremes, "BOXES_PER_BLOCK", 96)
    monkeypatch.setattr(
        extremes,
        "enclose",
        lambda problem, frame, boxes: (sizes.append(len(boxes)), bounded(problem, frame, boxes))[1],
    )
    parts = both().worst("CTN", budget=6000)
    assert max(sizes) == 96
    assert (parts.value, parts.bound) == (whole.value, whole.bound)
    np.testing.assert_array_equal(parts.pose.position, whole.pose.position)


def test_worst_in_a_plane_that_is_not_through_the_axes():
    plane = ([0.3, 0.2, 0.0], [[1.0, 1.0, 0.0], [0.0, 0.2, 1.0]])
    limits = gsp.Limits(position=[None, None, (6, None)])
    region = gsp.workspace.fixed_orientation(SIX_THREE, plane=plane, limits=limits)
    found = region.worst("CDN_CL", length=1.0)
    # The value occurs at the pose, which is in the region; the bound holds for all of its poses.
    own = np.linalg.cond(SIX_THREE.at(found.pose).jacobian)
    assert own == pytest.approx(found.value, rel=1e-9)
    assert region.contains(found.pose.position) == 1
    assert found.closed
    assert found.value <= found.bound <= 1.05 * found.value
    sampled = gsp.evaluate(SIX_THREE, region.poses(2000), "CDN_CL", length=1.0).iloc[:, -1]
    assert sampled.max() <= found.bound


def test_the_parts_above_and_below_the_base_are_regular_with_opposite_signs():
    parts = both().regular_parts()
    assert [part.sign for part in parts] in ([1, -1], [-1, 1])
    for part in parts:
        middle = np.unique(np.sign(part.low[:, 2] + part.high[:, 2]))
        assert len(middle) == 1
        centres = 0.5 * (part.low + part.high)[:, :3]
        jacobian = SIX_THREE.at(gsp.Pose(centres)).jacobian
        assert (np.sign(np.linalg.det(jacobian)) == part.sign).all()
        inside = both().contains(centres)
        assert (inside == 1).all()
    assert sum(part.size for part in parts) == pytest.approx(both().sizes[both().codes == 1].sum())


def test_a_singular_surface_divides_a_connected_region():
    # det J changes its sign where the platform crosses the plane of the base.
    flat = SIX_THREE.replace(strokes=[(0.01, 40.0)] * 6)
    limits = gsp.Limits(position=[(-0.5, 0.5), (-0.5, 0.5), (-2, 2)])
    region = gsp.workspace.fixed_orientation(flat, limits=limits, resolution=0.5)
    assert len(region.parts) == 1
    parts = region.regular_parts()
    assert {part.sign for part in parts[:2]} == {1, -1}
    for part in parts:
        at = gsp.Pose(0.5 * (part.low + part.high)[:, :3])
        assert (np.sign(np.linalg.det(flat.at(at).jacobian)) == part.sign).all()


def test_positions_with_one_of_several_orientations_have_no_worst_index():
    region = gsp.workspace.reachable(SIX_THREE, rotations=TURNS, resolution=4.0, budget=2000)
    with pytest.raises(InvalidInput, match="all orientations"):
        region.worst("CDN_CL", length=1.0)
    with pytest.raises(UnknownIndex):
        both().worst("rigidity_rate")


def own_poses(design, least, most, turns, rng, n):
    """Feasible poses of SPS legs in a box, with lengths and rows written out: J with L = 1."""
    p = rng.uniform(least, most, (n, 3))
    roll, pitch, yaw = (rng.uniform(-turn, turn, n) for turn in turns)
    kept = rng.random(n) < np.cos(pitch)  # the measure of rotations, R = Rz Ry Rx
    p, roll, pitch, yaw = p[kept], roll[kept], pitch[kept], yaw[kept]
    one, none = np.ones(len(p)), np.zeros(len(p))

    def turned(axis, angle):
        c, s = np.cos(angle), np.sin(angle)
        rows = {
            "x": [[one, none, none], [none, c, -s], [none, s, c]],
            "y": [[c, none, s], [none, one, none], [-s, none, c]],
            "z": [[c, -s, none], [s, c, none], [none, none, one]],
        }[axis]
        return np.moveaxis(np.array(rows), 2, 0)

    r = turned("z", yaw) @ turned("y", pitch) @ turned("x", roll)
    arm = np.einsum("nij,kj->nki", r, design.platform_points)
    d = p[:, None] + arm - design.base_points
    length = np.linalg.norm(d, axis=2)
    low, high = design.strokes.T
    ok = ((length >= low) & (length <= high)).all(axis=1)
    u = (d / length[..., None])[ok]
    return np.concatenate((u, np.cross(arm[ok], u)), axis=2)


def agree(value, error, sample):
    """An estimate and the mean of an own sample are within 4.5 of their standard errors."""
    own = sample.std() / np.sqrt(len(sample))
    assert abs(value - sample.mean()) < 4.5 * np.hypot(error, own)
    assert 0.0 < error < 0.1 * abs(value)


def test_means_and_shares_over_a_region_are_those_of_an_own_sample():
    turns = np.deg2rad([25, 40, 20])
    box = gsp.PoseBox([0, 0, 0], np.stack((-turns, turns), axis=1))
    limits = gsp.Limits(position=[(-4, 4), (-4, 4), (4, 11)])
    region = gsp.workspace.reachable(SIX_THREE, limits, rotations=box, resolution=2.0)
    sample = region.index_sample("CDN_CL, λ, σ_min", 4000, length=1.0, maximum=100.0)
    rng = np.random.default_rng(11)
    rows = own_poses(SIX_THREE, (-4, -4, 4), (4, 4, 11), turns, rng, 60_000)
    sizes = np.linalg.svd(rows, compute_uv=False)
    least, condition = sizes[:, 5], sizes[:, 0] / sizes[:, 5]
    share = np.abs(np.linalg.det(rows)) / 100.0
    table = sample.summary()
    row = table.loc["minimum_singular_value"]
    agree(row["mean"], row["mean_error"], least)
    agree(row["global"], row["global_error"], least)
    assert row["worst"] == row["min"] == sample.values["minimum_singular_value"].min()
    agree(*table.loc["condition_number", ["global", "global_error"]], 1.0 / condition)
    assert table.loc["condition_number", "worst"] == sample.values["condition_number"].max()
    agree(*table.loc["quality_index", ["mean", "mean_error"]], share)
    middle = [float(f"{np.quantile(x, 0.4):.3g}") for x in (share, condition, least)]
    for text, hits in (
        (f"λ >= {middle[0]}", share >= middle[0]),
        (f"CDN_CL ≤ {middle[1]}", condition <= middle[1]),
        (f"σ_min <= {middle[2]}", least <= middle[2]),
    ):
        found = sample.share_where(text)
        assert 0.1 < found.value < 0.9
        agree(found.value, found.error, hits)
    # The share has the standard error that repeated samples have.
    shares = []
    for seed in range(30):
        again = region.index_sample("σ_min", 200, length=1.0, rng=seed)
        shares.append(again.share_where(text))
    spread = np.std([one.value for one in shares], ddof=1)
    assert 0.6 < spread / np.mean([one.error for one in shares]) < 1.5


def test_a_share_of_all_poses_has_an_error_and_undefined_values_satisfy_nothing():
    region = both()
    sample = region.index_sample("σ_min", 50, length=1.0)
    every = sample.share_where("σ_min >= 0")
    assert every.value == 1.0
    assert 0.01 < every.error < 0.1
    holed = np.where(np.arange(50) < 10, np.nan, sample.values["minimum_singular_value"])
    part = type(sample)(region=region, pose=sample.pose, values={"minimum_singular_value": holed})
    assert part.share_where("σ_min >= 0").value == pytest.approx(0.8)
    assert part.summary().loc["minimum_singular_value", "undefined"] == pytest.approx(0.2)
    with pytest.raises(InvalidInput, match=r"bound: expected a bound of one of minimum_singular"):
        sample.share_where("CTN >= 0.1")
    with pytest.raises(InvalidInput, match=r'bound: expected texts such as "CTN >= 0.1"'):
        sample.share_where("σ_min > 0")
    with pytest.raises(UnknownIndex):
        sample.share_where("FOO >= 0")


def test_poses_of_a_dextrous_region_are_at_positions_that_take_all_orientations():
    wide = gsp.PoseBox([0, 0, 0], [(-20, 20), (-20, 20), (-20, 20)], degrees=True)
    region = gsp.workspace.dextrous(SIX_THREE, wide, resolution=0.6)
    places = region.poses(100).position
    assert (region.contains(places) == 1).all()
    ends = np.array(np.meshgrid(*[np.deg2rad([-20, 0, 20])] * 3)).reshape(3, -1).T
    turns = gsp.geometry.rotation_from_angles(ends)
    poses = gsp.Pose(np.repeat(places, len(turns), 0), np.tile(turns, (len(places), 1, 1)))
    assert gsp.feasible(SIX_THREE, poses).ok.all()


def test_poses_and_worst_index_of_the_orientations_at_a_point():
    place = [1.0, 0.5, 8.0]
    region = gsp.workspace.orientations(SIX_THREE, place, resolution=0.25)
    poses = region.poses(3000)
    assert (poses.position == place).all()
    assert gsp.feasible(SIX_THREE, poses).ok.all()
    # Rotations of all, drawn from quaternions: the same share of them has a pitch below 0.
    q = np.random.default_rng(2).normal(size=(200_000, 4))
    all_ = gsp.Pose.from_quaternion(np.repeat([place], len(q), 0), q)
    joints = SIX_THREE.at(all_).joints
    ok = ((joints >= SIX_THREE.strokes[:, 0]) & (joints <= SIX_THREE.strokes[:, 1])).all(axis=1)
    for angle in range(3):
        own, found = all_.angles()[ok, angle], poses.angles()[:, angle]
        level = np.quantile(own, 0.3)
        assert abs((found < level).mean() - 0.3) < 4.5 * np.sqrt(0.21 * (1 / len(own) + 1 / 3000))
    assert (region.codes == 1).any()
    worst = region.worst("σ_min", length=1.0, budget=3000)
    assert worst.bound <= worst.value
    sampled = gsp.evaluate(SIX_THREE, poses, "σ_min", length=1.0).iloc[:, -1]
    assert worst.bound <= sampled.min()
    assert (worst.pose.position == place).all()
    assert gsp.feasible(SIX_THREE, worst.pose).ok


SHORT = [(9.0, 12.5)] * 6


def checked(design, part):
    """Poses drawn in boxes of a part: all are feasible, and det J has its sign."""
    rng = np.random.default_rng(3)
    box = rng.integers(len(part.low), size=2000)
    inner = part.low[box] + rng.random((2000, 6)) * (part.high - part.low)[box]
    place = part.origin + inner[:, :3] @ part.frame
    turns = gsp.geometry.rotation_from_angles(inner[:, [5, 4, 3]], "rpy")  # moving: yaw first
    poses = gsp.Pose(place, turns)
    joints = design.at(poses).joints
    low, high = design.strokes.T
    assert ((joints > low) & (joints < high)).all()
    assert (np.sign(np.linalg.det(design.at(poses).jacobian)) == part.sign).all()
    assert part.contains(poses).all()


def test_parts_among_the_poses_of_a_reachable_set():
    """In the plane of symmetry with turns of a range: feasible, regular, and on both sides."""
    plane = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
    box = gsp.PoseBox([0, 0, 0], [(-20, 20), (-20, 20), (-20, 20)], degrees=True)
    region = gsp.workspace.reachable(SIX_THREE, plane=plane, rotations=box, resolution=1.0)
    parts = region.regular_parts(60_000)
    assert {part.sign for part in parts[:2]} == {1, -1}
    for part in parts[:2]:
        checked(SIX_THREE, part)
    below = gsp.Pose(SIX_THREE.home.position * [1, 1, -1], SIX_THREE.home.rotation)
    holding = [[bool(part.contains(pose)) for part in parts] for pose in (SIX_THREE.home, below)]
    assert [sum(row) for row in holding] == [1, 1]
    assert holding[0] != holding[1]
    # Poses of a part of the region are those of its positions.
    assert len(region.parts) == 2
    upper = region.part_of(SIX_THREE.home.position)
    some = upper.regular_parts(20_000)
    assert all((part.low[:, 1] + part.high[:, 1] > 0.0).all() for part in some)


@pytest.mark.parametrize("angles", [[0, 0, 180], [0, 90, 30], [180, 20, 10]])
def test_orientations_are_connected_across_half_turns_and_at_the_poles(angles):
    """The platform axes are turned, so that the same poses have other angles."""
    turned = gsp.geometry.rotation_from_angles(np.deg2rad(angles), "rpy")
    home = SIX_THREE.home.position
    # R b = (R turned) (turnedᵀ b)
    design = gsp.Design(
        ["D1"] * 6, SIX_THREE.base_points, SIX_THREE.platform_points @ turned, strokes=SHORT
    )
    region = gsp.workspace.orientations(design, home, resolution=0.1)
    assert len(region.parts) == len(plain().parts)
    parts = region.regular_parts()
    small = np.random.default_rng(2).uniform(-0.05, 0.05, (40, 3))
    poses = gsp.Pose(home, gsp.geometry.exp3(small) @ turned)
    assert parts[0].contains(poses).all()
    checked(design, parts[0])


@cache
def plain():
    design = SIX_THREE.replace(strokes=SHORT)
    return gsp.workspace.orientations(design, SIX_THREE.home.position, resolution=0.1)


def test_the_worst_value_of_singular_poses_is_theirs():
    # Equal and parallel legs: every pose of this orientation is singular.
    design = gsp.Design(["D1"] * 6, RING, RING, strokes=[(1.0, 1.8)] * 6)
    region = gsp.workspace.fixed_orientation(design, resolution=0.5)
    found = region.worst("CTN", budget=500)
    assert found.value == found.bound == 0.0
