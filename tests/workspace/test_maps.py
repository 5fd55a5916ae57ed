import numpy as np
import pytest

import gsp
from gsp.errors import EmptyWorkspace
from gsp.workspace import Limits, index_map

COUNTS = (7, 6, 5, 1, 1, 1)
WIDE = Limits(strokes=[[0.1, 100.0]] * 6)


@pytest.fixture(scope="module")
def mapped(platform):
    box = gsp.PoseBox([(-6, 6), (-6, 6), (3, 12)], [0, 0, 0])
    return index_map(platform, box, COUNTS, ["condition_number", "manipulability"], length=7.5)


def test_values_are_those_of_evaluate_at_the_feasible_poses(platform, mapped):
    assert mapped.feasible.shape == COUNTS
    assert np.array_equal(mapped.feasible, gsp.feasible(platform, mapped.pose).ok)
    assert 0.0 < mapped.share < 1.0
    for where in np.argwhere(mapped.feasible)[::17]:
        pose = mapped.pose[tuple(where)]
        single = gsp.evaluate(platform, pose, ["condition_number"], length=7.5)
        value = mapped.values["condition_number"][tuple(where)]
        assert value == pytest.approx(single["condition_number"].iloc[0], rel=1e-12)
    assert np.isnan(mapped.values["condition_number"][~mapped.feasible]).all()


def test_global_indices(mapped):
    known = mapped.values["condition_number"][mapped.feasible]
    # At an end of an interval a node stands for half of a step.
    weight = np.ones(COUNTS)
    for axis in range(3):
        ends = np.moveaxis(weight, axis, 0)
        ends[[0, -1]] *= 0.5
    weight = weight[mapped.feasible] / weight[mapped.feasible].sum()
    row = mapped.summary().loc["condition_number"]
    assert row["mean"] == pytest.approx(weight @ known)
    assert row["worst"] == known.max()
    assert row["global"] == pytest.approx(weight @ (1 / known))
    assert row["uniformity"] == pytest.approx(known.min() / known.max())
    assert row["undefined"] == 0.0
    flat = mapped.values["manipulability"][mapped.feasible]
    assert mapped.summary().loc["manipulability", "global"] == pytest.approx(weight @ flat)


@pytest.mark.parametrize("order", ["rpy", "approach-roll", "ZYZ"])
def test_orientations_count_by_the_measure_of_the_rotations(platform, order):
    """The mean of a function of R over all rotations is the same in each angle set."""
    middle = {"rpy": 1, "approach-roll": 0, "ZYZ": 1}[order]
    angles = [(-180, 180)] * 3
    angles[middle] = (0, 180) if order == "ZYZ" else (-90, 90)
    box = gsp.PoseBox([0, 0, 8], angles, degrees=True, order=order)
    counts = [1, 1, 1, 13, 13, 13]
    found = index_map(platform, box, counts, ["manipulability"], limits=WIDE)
    assert found.weight.sum() == pytest.approx(1.0)
    assert found.share == pytest.approx(1.0)
    # Over all rotations the entries of R have the mean 0, and their squares the mean 1/3.
    rotation = found.pose.rotation
    assert np.einsum("abcdef,abcdefij->ij", found.weight, rotation) == pytest.approx(0.0, abs=1e-9)
    squares = np.einsum("abcdef,abcdefij->ij", found.weight, rotation**2)
    assert squares == pytest.approx(1 / 3, abs=0.01)


def test_the_singularity_free_part_has_one_sign_and_is_connected(platform):
    """Turned about the vertical a 6–3 platform is singular at one angle, on either side."""
    box = gsp.PoseBox([0, 0, 8], [0, 0, (-170, 170)], degrees=True)
    limits = Limits(strokes=[[0.1, 100.0]] * 6)
    turned = index_map(platform, box, (1, 1, 1, 1, 1, 341), ["manipulability"], limits=limits)
    part = turned.singularity_free()
    rows = platform.at(turned.pose.reshape(341)).jacobian
    sign = np.sign(np.linalg.det(rows))
    inside = np.flatnonzero(part.ravel())
    assert 170 in inside
    assert 0 < len(inside) < 341
    assert len(set(sign[inside])) == 1
    assert inside.max() - inside.min() + 1 == len(inside)
    assert sign[inside.max() + 1] != sign[170] or sign[inside.min() - 1] != sign[170]


def test_a_platform_that_is_singular_everywhere_has_no_singularity_free_part():
    """Similar hexagons at a yaw of 90° (Fichter): rounding gives det J a sign at every node."""
    angle = np.deg2rad([-10, 10, 110, 130, 230, 250])
    ring = np.stack((np.cos(angle), np.sin(angle), 0.0 * angle), axis=1)
    design = gsp.Design(["D1"] * 6, 2.0 * ring, ring)
    box = gsp.PoseBox([(-0.4, 0.4), (-0.4, 0.4), (1.5, 2.5)], [0, 0, 90], degrees=True)
    limits = Limits(strokes=[[0.1, 100.0]] * 6)
    found = index_map(design, box, (5, 5, 5, 1, 1, 1), ["manipulability"], limits=limits)
    assert design.at(found.pose).singular().all()
    home = gsp.Pose.from_rpy([0.0, 0.0, 2.0], [0.0, 0.0, np.pi / 2])
    with pytest.raises(EmptyWorkspace, match="received a singular one"):
        found.singularity_free(home)
    narrow = Limits(strokes=[[3.0, 100.0]] * 6)
    found = index_map(design, box, (5, 5, 5, 1, 1, 1), ["manipulability"], limits=narrow)
    with pytest.raises(EmptyWorkspace, match="received an infeasible one"):
        found.singularity_free(gsp.Pose([0.0, 0.0, 1.5], home.rotation))


def test_bad_input(platform, mapped):
    box = gsp.PoseBox([(20, 30), 0, 0], [0, 0, 0])
    with pytest.raises(EmptyWorkspace, match="feasible"):
        index_map(platform, box, (3, 1, 1, 1, 1, 1), ["manipulability"])
    with pytest.raises(EmptyWorkspace, match="home"):
        mapped.singularity_free(gsp.Pose([6.0, 6.0, 3.0]))


def test_the_share_of_a_map_without_infeasible_nodes_is_not_above_one(platform):
    """Sums of the weights round to a little more than 1 for some boxes."""
    sums, rng = [], np.random.default_rng(4)
    for _ in range(40):
        ends = np.sort(rng.uniform(-0.3, 0.3, (6, 2)), axis=1)
        ends[2] += 8.0
        found = gsp.workspace.index_map(
            platform, gsp.PoseBox(ends[:3], ends[3:]), 3, ["CDN_CL"], length=1.0
        )
        assert found.feasible.all()
        sums.append(found.weight[found.feasible].sum())
        assert found.share <= 1.0
        assert found.share_where("CDN_CL >= 1") <= 1.0
    assert max(sums) > 1.0
