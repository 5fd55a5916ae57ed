"""Assembly modes of driven designs, against own searches and designs of other branches."""

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

import gsp
from gsp import Crank, Design, Pose, Slider
from tests import campaign, driven

NAMES = ("hexaglide, other branches", "rotary", "cranks", "mixed of six")
LANE = ("lane-rotary", "lane-modified-paradex")


def designs():
    rng = np.random.default_rng(5)
    legs = [Slider(rod=2.6), Crank(arm=[0.5, 0.1, 0.2], rod=2.1), "D1", "D3", Slider(rod=2.5), "D2"]
    lines = [[0.1, 0.2, 1], [0.1, 1, 0.2], [1, 0, 0], [1, 0.3, 0.2], [0.2, -0.1, 1], [0, 0, 1]]
    base = driven.BASE + 0.1 * rng.normal(size=(6, 3))
    six = Design(legs, base, driven.PLATFORM, lines, rng.normal(size=(6, 3)), home=driven.HOME)
    return {**driven.DESIGNS, "mixed of six": six} | {x: gsp.catalogue.design(x) for x in LANE}


DESIGNS = designs()


def searched(design, joints, starts, rng):
    """Poses of the joint values from random starts, by the lengths of the rods from known tips."""
    posture = design.at(design.home)
    tips = driven.tips(design, posture)
    size, free = design.rms_radius, [i for i in range(6) if i not in tips]

    def error(x):
        turn = Rotation.from_rotvec(x[3:]).as_matrix()
        ends = size * x[:3] + design.platform_points @ turn.T
        rods = [np.linalg.norm(ends[i] - tip) - design.drives[i].rod for i, tip in tips.items()]
        others = design.at(Pose(size * x[:3], turn)).joints[free] - joints[free] if free else []
        return np.nan_to_num(np.concatenate((rods, others)) / size, nan=1e3)

    found = []
    for _ in range(starts):
        begin = np.concatenate((2.0 * rng.normal(size=3), Rotation.random(rng=rng).as_rotvec()))
        end = least_squares(error, begin, xtol=1e-15, ftol=1e-15, gtol=1e-15)
        if np.abs(end.fun).max() < 1e-11:
            found.append(Pose(size * end.x[:3], Rotation.from_rotvec(end.x[3:]).as_matrix()))
    return found


def apart(modes, pose, size):
    position = np.abs(modes.poses.position - pose.position).max(axis=1) / size
    return position + np.abs(modes.poses.rotation - pose.rotation).max(axis=(1, 2))


@pytest.mark.parametrize("name", NAMES)
def test_poses_of_random_searches_are_among_the_modes(name):
    design, rng = DESIGNS[name], np.random.default_rng(3)
    joints = design.at(design.home).joints
    modes = gsp.assembly_modes(design, joints, certify=True)
    assert modes.status == "found"
    assert modes.certified.all()
    assert modes.residual.max() < 1e-13
    found = searched(design, joints, campaign.count(12, 400), rng)
    assert len(found) > 3
    for pose in [design.home, *found]:
        assert apart(modes, pose, design.rms_radius).min() < 1e-8


def on_other_branches(design, joints, pose):
    """The design whose branches are those of a pose: signs of the motion of the tips along rods."""
    legs, step = list(design.legs), 1e-6
    for row, (leg, _) in enumerate(design.rows):
        drive = design.drives[leg]
        if drive is None:
            continue
        lengths = []
        for q in (joints[row] - step, joints[row] + step):
            values = np.where(np.arange(6) == row, q, joints)
            tip = driven.tips(design, _Values(values))[leg]
            end = pose.position + pose.rotation @ design.platform_points[leg]
            lengths.append(np.linalg.norm(end - tip))
        branch = 1 if lengths[0] > lengths[1] else -1
        numbers = {"arm": drive.arm} if isinstance(drive, Crank) else {}
        legs[leg] = type(drive)(rod=drive.rod, branch=branch, **numbers)
    return design.replace(legs=legs)


class _Values:
    def __init__(self, joints):
        self.joints = joints


@pytest.mark.parametrize("name", [*LANE, "rotary", "cranks", "mixed of six"])
def test_modes_have_the_joint_values_and_the_jacobian_of_the_branches_that_they_are_on(name):
    design = DESIGNS[name]
    joints = design.at(design.home).joints
    modes = gsp.assembly_modes(design, joints)
    np.testing.assert_array_equal(modes.joints, joints)
    size, centre = design.rms_radius, design.platform_points.mean(axis=0)
    units = np.where(design.angular, 1.0, 1.0 / size)
    for i in range(len(modes.side)):
        pose = modes.poses[i]
        own = on_other_branches(design, joints, pose)
        assert modes.on_branches[i] == (own.legs == design.legs)
        posture = own.at(pose)
        np.testing.assert_allclose(posture.joints * units, joints * units, rtol=0, atol=1e-9)
        rows = gsp.geometry.jacobian_at(posture.jacobian, pose.rotation @ centre)
        rows = rows * units[:, None] * np.repeat([size, 1.0], 3)
        assert modes.side[i] == np.sign(np.linalg.det(rows))
        assert modes.condition[i] == pytest.approx(np.linalg.cond(rows), rel=1e-6)
    if name not in ("rotary", "cranks"):
        assert modes.on_branches.any()


def test_a_guess_half_a_turn_away_ends_at_the_nearest_mode_on_the_branches():
    design = DESIGNS["rotary"]
    joints = design.at(design.home).joints
    far = design.home.moved([0, 0, -3.0, 0, 0, 2.5])
    assert not gsp.forward(design, joints, far).converged
    found = gsp.forward(design, joints, far, fallback="modes")
    assert found.status == "nearest mode"
    np.testing.assert_allclose(design.at(found.pose).joints, joints, rtol=0, atol=1e-9)
    # A mode on another branch is nearer.
    modes = gsp.assembly_modes(design, joints)
    nearest = np.linalg.norm(modes.poses.position - far.position, axis=1).argmin()
    assert not modes.on_branches[nearest]


def test_a_mode_at_a_singular_drive_is_labelled():
    """A rod at right angles to its rail: the travel is the foot of the anchor on the rail."""
    design = driven.hexaglide()
    pose = design.home.moved([0.0, 0.0, 0.3, 0.0, 0.0, 0.0])
    anchor = pose.position + pose.rotation @ design.platform_points[0]
    rod = np.linalg.norm((anchor - design.base_points[0])[1:])
    legs = [Slider(rod=rod), *design.legs[1:]]
    design = design.replace(legs=legs)
    joints = design.at(pose).joints
    assert design.at(pose).singular_drives
    modes = gsp.assembly_modes(design, joints)
    here = apart(modes, pose, design.rms_radius).argmin()
    assert apart(modes, pose, design.rms_radius)[here] < 1e-7
    assert (modes.side[here], modes.condition[here]) == (0.0, np.inf)
    assert modes.multiplicity[here] == 1
    assert modes.on_branches[here]


def test_named_ends():
    design = driven.hexaglide()
    joints = design.at(design.home).joints
    for value, status in ((np.nan, "undefined"), (1e300, "undefined"), (50.0, "impossible")):
        modes = gsp.assembly_modes(design, np.where(np.arange(6) == 2, value, joints))
        assert modes.status == status
        assert len(modes.side) == len(modes.on_branches) == 0
    with pytest.raises(gsp.GspError, match="six actuators"):
        gsp.assembly_modes(driven.mixed(), np.zeros(8))


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_modes_do_not_depend_on_unit_and_frame(factor):
    design = DESIGNS["mixed of six"]
    far = np.array([30.0, -20.0, 10.0])
    moved = design.replace(base_points=design.base_points + far).scaled(factor)
    units = np.where(design.angular, 1.0, factor)
    joints = design.at(design.home).joints
    one, other = gsp.assembly_modes(design, joints), gsp.assembly_modes(moved, joints * units)
    assert len(one.side) == len(other.side)
    for i in range(len(one.side)):
        back = Pose(other.poses[i].position / factor - far, other.poses[i].rotation)
        k = apart(one, back, design.rms_radius).argmin()
        assert apart(one, back, design.rms_radius)[k] < 1e-9
        assert (other.side[i], other.on_branches[i]) == (one.side[k], one.on_branches[k])
        assert other.condition[i] == pytest.approx(one.condition[k], rel=1e-6)
