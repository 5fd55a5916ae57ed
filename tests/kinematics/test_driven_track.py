"""Logs of drives at the base, and prepared driven designs, against own continuations."""

import pickle

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

import gsp
from gsp import Crank, Pose
from tests import campaign, driven

SIX = [name for name, design in driven.DESIGNS.items() if len(design.joint_names) == 6]


def a_path(design, m=60, seed=0):
    """Poses along a straight path that a scan finds to be regular, with its drives."""
    rng = np.random.default_rng(seed)
    for _ in range(20):
        twist = rng.normal(size=6) * np.repeat([0.12 * design.rms_radius, 0.12], 3)
        poses = design.home.moved(np.linspace(0.0, 1.0, m)[:, None] * twist)
        posture = design.at(poses)
        side = np.sign(np.linalg.det(np.nan_to_num(posture.jacobian)))
        if posture.defined.all() and (side == side[0]).all():
            return poses
    raise AssertionError("no path")


@pytest.mark.parametrize("name", campaign.some(SIX, 4))
def test_poses_of_a_log_are_found_again(name):
    design = driven.DESIGNS[name]
    poses = a_path(design)
    start = design.home.moved(1e-3 * np.arange(6))
    found = gsp.track(design, design.at(poses).joints, start)
    assert (found.status, found.reached) == ("complete", 60)
    np.testing.assert_allclose(found.pose.position, poses.position, atol=1e-9)
    np.testing.assert_allclose(found.pose.rotation, poses.rotation, atol=1e-9)
    assert found.residual.max() <= 1e-12
    assert (found.pieces >= 1).all()


@pytest.mark.parametrize("name", ["rotary", "sliders"])
def test_margins_are_those_of_the_rods_and_of_the_drives(name):
    design = driven.DESIGNS[name]
    poses = a_path(design, 5)
    found = gsp.track(design, design.at(poses).joints, design.home)
    size, centre = design.rms_radius, design.platform_points.mean(axis=0)
    tips = driven.tips(design, design.at(poses))
    for i in range(5):
        ends = poses.position[i] + design.platform_points @ poses.rotation[i].T
        rods = np.stack([ends[k] - tips[k][i] for k in range(6)])
        rods /= np.linalg.norm(rods, axis=1, keepdims=True)
        arms = (design.platform_points - centre) @ poses.rotation[i].T / size
        rows = np.hstack((rods, np.cross(arms, rods)))
        cosines = []
        for k, drive in enumerate(design.drives):
            slope = design.base_directions[k]
            if isinstance(drive, Crank):
                slope = np.cross(slope, tips[k][i] - design.base_points[k])
            cosines.append(abs(rods[k] @ slope) / np.linalg.norm(slope))
        expected = min(1.0 / np.linalg.norm(np.linalg.inv(rows)), *cosines)
        assert found.margin[i] == pytest.approx(expected, rel=1e-6)


def continued(design, log):
    """Poses of a log by Newton's method of scipy from sample to sample, and cosines of the drives.

    The equations are the lengths of the rods from tips, so drives may change their branch.
    """
    x, poses, cosines = np.concatenate((design.home.position, [0.0] * 3)), [], []
    rods = np.array([drive.rod for drive in design.drives])
    turn = design.home.rotation

    def sides(x, tips):
        ends = x[:3] + design.platform_points @ (Rotation.from_rotvec(x[3:]).as_matrix() @ turn).T
        return ends - tips

    for joints in log:
        tips = driven.tips(design, _Values(joints))
        tips = np.stack([tips[k] for k in range(6)])
        x = least_squares(
            lambda x, tips=tips: np.linalg.norm(sides(x, tips), axis=1) - rods, x, xtol=1e-15
        ).x
        poses.append(x)
        cosines.append((sides(x, tips) * design.base_directions).sum(axis=1) / rods)
    return np.array(poses), np.array(cosines)


class _Values:
    def __init__(self, joints):
        self.joints = joints


def test_a_log_that_passes_a_singular_drive_ends_before_it():
    design = driven.hexaglide()
    joints = design.at(design.home).joints
    branches = np.array([drive.branch for drive in design.drives])
    # Carriages that move to the middle lift the platform, until one of them passes below its rod.
    log = joints + np.linspace(0.0, 2.2, 120)[:, None] * branches
    log[:, 0] += np.linspace(0.0, 0.4, 120) * branches[0]
    poses, cosines = continued(design, log)
    crossed = int((cosines * branches < 0.0).any(axis=1).argmax())
    assert 20 < crossed < 119
    found = gsp.track(design, log, design.home)
    assert found.status == "singular drive"
    assert crossed - 1 <= found.reached <= crossed
    np.testing.assert_allclose(
        found.pose.position[: found.reached], poses[: found.reached, :3], atol=1e-6
    )
    assert np.isnan(found.pose.position[found.reached :]).all()
    near = gsp.track(design, log, design.home, least_margin=0.1)
    assert near.status == "singular drive"
    assert np.abs(cosines[: near.reached]).min() > 0.1 > np.abs(cosines[near.reached]).min()


def test_a_log_that_passes_a_singular_posture_ends_before_it():
    """Where det J of a scan changes its sign, and no drive is near to its own singular posture."""
    design, rng = driven.DESIGNS["sliders"], np.random.default_rng(4)
    ends = 0
    for _ in range(200):
        twist = rng.normal(size=6) * np.repeat([design.rms_radius, 1.0], 3)
        posture = design.at(design.home.moved(np.linspace(0.0, 0.6, 150)[:, None] * twist))
        side = np.sign(np.linalg.det(np.nan_to_num(posture.jacobian)))
        crossed = int((side != side[0]).argmax())
        if crossed < 20 or not posture.defined[: crossed + 2].all():
            continue
        if np.abs(posture.drive_scales[: crossed + 2]).min() < 0.2:
            continue
        found = gsp.track(design, posture.joints[: crossed + 1], design.home)
        # A sample beyond the singular posture may have the joint values of one before it.
        assert found.status == "singular" or found.complete
        assert (found.reached >= crossed - 1) or found.margin[found.reached - 1] < 0.02
        before = design.at(found.pose[np.arange(found.reached)])
        assert (np.sign(np.linalg.det(before.jacobian)) == side[0]).all()
        ends += found.status == "singular"
        if ends == 2:
            return
    raise AssertionError("no log ended as singular")


def test_a_log_that_starts_or_ends_at_a_singular_drive_ends_there():
    design = driven.hexaglide()
    pose = design.home.moved([0.0, 0.0, 0.3, 0.0, 0.0, 0.0])
    anchor = pose.position + pose.rotation @ design.platform_points[0]
    rod = np.linalg.norm((anchor - design.base_points[0])[1:])
    design = design.replace(legs=[gsp.Slider(rod=rod), *design.legs[1:]])
    joints = design.at(pose).joints
    at = gsp.track(design, [joints, joints], pose)
    assert (at.status, at.reached) == ("singular drive", 0)
    poses = pose.moved(np.linspace(-0.1, 0.0, 30)[:, None] * [0, 0, 1, 0, 0, 0])
    to = gsp.track(design, design.at(poses).joints, poses[0])
    assert (to.status, to.reached) == ("singular drive", 29)


def test_angles_of_cranks_may_jump_by_full_turns():
    design = driven.rotary()
    joints = design.at(a_path(design)).joints
    one = gsp.track(design, joints, design.home)
    turns = 2 * np.pi * np.random.default_rng(0).integers(-2, 3, joints.shape)
    other = gsp.track(design, joints + turns, design.home)
    assert other.status == "complete"
    np.testing.assert_allclose(other.pose.position, one.pose.position, atol=1e-9)


def test_bad_samples_and_gaps():
    design = driven.DESIGNS["sliders"]
    joints = design.at(a_path(design, 30)).joints
    lost = joints.copy()
    lost[12, 3] = np.nan
    found = gsp.track(design, lost, design.home)
    assert (found.status, found.reached) == ("gap", 12)
    found = gsp.track(design, lost, design.home, skip=True)
    assert found.complete
    assert np.isnan(found.pose.position[12]).all()
    assert np.isfinite(found.pose.position[np.arange(30) != 12]).all()
    lost[12, 3] = np.inf
    assert gsp.track(design, lost, design.home).status == "undefined"
    lost[12] = joints[12] + 0.5 * design.rms_radius
    assert gsp.track(design, lost, design.home).status == "gap"
    few = gsp.track(design, joints[[0, 29]], design.home, largest_gap=3.0)
    assert few.complete
    np.testing.assert_allclose(few.pose.position[1], a_path(design, 30).position[-1], atol=1e-8)
    assert gsp.track(design, np.empty((0, 6)), design.home).complete
    unreached = design.home.moved([0, 0, 50, 0, 0, 0])
    assert gsp.track(design, joints, unreached).status == "undefined"
    with pytest.raises(gsp.GspError, match="six actuators"):
        gsp.track(driven.mixed(), np.zeros((3, 8)), driven.mixed().home)


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_tracks_do_not_depend_on_unit_and_frame(factor):
    design = driven.general("slider", 1)
    joints = design.at(a_path(design, 12)).joints
    far = np.array([20.0, -30.0, 10.0])
    moved = design.replace(
        base_points=design.base_points + far, home=Pose(design.home.position + far)
    ).scaled(factor)
    home = Pose(factor * (design.home.position + far), design.home.rotation)
    one, other = (
        gsp.track(design, joints, design.home), gsp.track(moved, factor * joints, home)
    )  # fmt: skip
    assert other.status == one.status == "complete"
    position = other.pose.position / factor - far
    np.testing.assert_allclose(position, one.pose.position, atol=1e-8)


@pytest.mark.parametrize("name", ["mixed", "rotary"])
def test_prepared_driven_designs_return_what_postures_do(name):
    design = driven.DESIGNS[name]
    robot = gsp.prepare(design, "control_number", length=1.3)
    poses = driven.near_home(design, 3)
    posture = design.at(poses)
    np.testing.assert_array_equal(robot.joints(poses), posture.joints)
    for i in range(3):
        one = design.at(poses[i])
        np.testing.assert_array_equal(robot.jacobian(poses[i]), one.jacobian)
        expected = gsp.indices.control_number(one, length=1.3)
        assert robot.index(poses[i]) == expected
        rows, value = robot(poses[i].position, poses[i].rotation)
        np.testing.assert_array_equal(rows, one.jacobian)
        assert value == expected
        back = robot.forward(one.joints, design.home)
        np.testing.assert_allclose(back.pose.position, poses[i].position, atol=1e-9)
    far = design.home.moved([0, 0, 90, 0, 0, 0])
    assert np.isnan(robot.joints(far)).all()
    again = pickle.loads(pickle.dumps(robot))
    np.testing.assert_array_equal(again.joints(poses), posture.joints)
    with pytest.raises(gsp.GspError, match="length"):
        gsp.prepare(design, "condition_number")
