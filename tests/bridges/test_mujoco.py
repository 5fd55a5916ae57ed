"""MuJoCo loads the models assembled, holds them, drives them, and agrees with our rows."""

from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gsp
from gsp import Slider
from gsp.bridges import (
    Drives,
    Solids,
    agreement,
    mujoco_rates,
    simulate,
    to_mjcf,
    to_pinocchio,
    to_sdf,
    to_urdf,
)
from gsp.bridges.mujoco.mjcf import LARGEST_REACH
from gsp.bridges.mujoco.program import compiled, gaps_of
from gsp.bridges.mujoco.simulation import _changes, load
from gsp.bridges.proof import BOX, DIFFERENCE_TOLERANCE, prove, random_design
from gsp.errors import FailedComputation, InvalidInput, MissingParameter, MissingSoftware
from gsp.model.units import METRES_PER_UNIT
from tests import campaign, driven

mujoco = pytest.importorskip("mujoco")

DOZEN = gsp.catalogue.mechanisms()[8::16]
EXOTIC = ("D4^3 A1^3", "D2^3 D3^3", "D1 D2 D3 D4 A1^2")
TWO = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
# The constraints of MuJoCo are springs: under gravity the loops of mechanisms of about 2 m open
# by 6e-8 to 4e-6 m or rad. That moves the platform by as much times the condition number.
SOFTNESS = 5e-6
LIFT = gsp.hexapod(2.0, np.deg2rad(20.0), 1.0, np.deg2rad(30.0), 1.5, unit="m")


def good_posture(name, seed=0):
    """A random posture that is far enough from singular ones to hold its own weight."""
    for number in range(seed, seed + 50):
        rng = np.random.default_rng(number)
        design = random_design(gsp.catalogue.mechanism(name), rng)
        pose = BOX.sample(1, rng=rng)[0]
        if np.linalg.cond(design.at(pose).homogeneous(design.rms_radius)) < 30:
            return design, pose
    raise AssertionError(name)


def loaded(text):
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return model, data


@pytest.mark.parametrize("mechanism", gsp.catalogue.mechanisms()[::5], ids=str)
def test_models_load_assembled(mechanism):
    rng = np.random.default_rng(3)
    design, pose = random_design(mechanism, rng), BOX.sample(1, rng=rng)[0]
    model, data = loaded(to_mjcf(design, pose))
    assert np.abs(data.efc_pos).max() < 1e-12
    assert [model.actuator(i).name for i in range(model.nu)] == list(design.joint_names)
    np.testing.assert_allclose(data.actuator_length, design.at(pose).joints, atol=1e-12)
    np.testing.assert_array_equal(data.ctrl, 0.0)
    np.testing.assert_allclose(model.qpos0, model.key_qpos[0], atol=1e-12)
    np.testing.assert_allclose(data.body("platform").xpos, pose.position, atol=1e-12)
    np.testing.assert_allclose(data.body("platform").xmat.reshape(3, 3), pose.rotation, atol=1e-12)


@pytest.mark.parametrize("name", ["apo-secondary", "toz-kucuk-2016-d3-6"])
def test_models_stay_where_they_start(name):
    """As programs load them: without a reset to the keyframe, with all controls zero."""
    design = gsp.catalogue.design(name)
    model = mujoco.MjModel.from_xml_string(to_mjcf(design, design.home))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 300)
    place = design.home.position * METRES_PER_UNIT[design.unit]
    sag = 1e-3 * design.rms_radius * METRES_PER_UNIT[design.unit]
    np.testing.assert_allclose(data.body("platform").xpos, place, atol=sag)


def test_controls_are_changes_of_the_joint_variables():
    design = gsp.catalogue.design("apo-secondary")
    model = mujoco.MjModel.from_xml_string(to_mjcf(design, design.home, gravity=np.zeros(3)))
    data = mujoco.MjData(model)
    aim = design.home.moved([5.0, -8.0, 10.0, 0.02, 0.03, -0.05])
    data.ctrl[:] = 1e-3 * (design.at(aim).joints - design.at(design.home).joints)
    mujoco.mj_step(model, data, 2000)
    np.testing.assert_allclose(data.body("platform").xpos, 1e-3 * aim.position, atol=1e-6)


def test_models_with_all_platform_anchors_in_one_point_load():
    rng = np.random.default_rng(2)
    legs = ["D1", "D2", "D3", "D4", "A1", "D1"]
    points = (rng.normal(size=(6, 3)), np.tile([0.1, 0.2, 0.7], (6, 1)))
    design = gsp.Design(legs, *points, *rng.normal(size=(2, 6, 3)))
    almost = 5e-9 * rng.normal(size=(6, 3))  # MuJoCo refuses capsules by ends that are so near
    for place in (design, *(design.replace(platform_points=x) for x in (np.zeros((6, 3)), almost))):
        _, data = loaded(to_mjcf(place, gsp.Pose([0.1, 0.2, 3.0])))
        assert np.abs(data.efc_pos).max() < 1e-12


def test_masses_that_mujoco_refuses_are_refused():
    small = TWO.scaled(1e-3 / TWO.rms_radius)
    with pytest.raises(InvalidInput, match=r"solids .*radius.: expected a mass .* of platform"):
        to_mjcf(small, small.home, Solids(metres=1.0))
    loaded(to_mjcf(small, small.home, Solids(metres=1.0, density=2700e9)))
    with pytest.raises(InvalidInput, match=r"^pose \(or radius of solids\): .* 6e\+11 m of length"):
        to_mjcf(TWO, gsp.Pose([1e12, 0.0, 0.0]), Solids(metres=1.0))


def test_actuator_and_passive_rates_agree_for_a_dozen():
    proof = prove(DOZEN, poses=2, seed=9, programs=["mujoco"])
    assert len(proof.table) == 12
    assert list(proof.differences) == ["mujoco closure", "mujoco actuators", "mujoco passive"]
    assert proof.holds


def test_rates_agree_in_millimetres():
    assert max(agreement(TWO, TWO.home, "mujoco")) < DIFFERENCE_TOLERANCE


def test_a_wrong_row_would_be_seen():
    rng = np.random.default_rng(9)
    design, pose = random_design(DOZEN[0], rng), BOX.sample(1, rng=rng)[0]
    other = design.replace(base_points=design.base_points + 1e-6)
    theirs = mujoco_rates(other, pose).actuators
    assert np.abs(theirs - design.at(pose).jacobian).max() > 1e-8


@pytest.mark.parametrize("name", EXOTIC)
def test_holds_together_under_gravity(name):
    design, pose = good_posture(name)
    rest = simulate(design, pose, duration=2.0)
    assert 0.0 < rest.gap < SOFTNESS
    assert rest.speed < 1e-3
    assert np.abs(rest.joints - design.at(pose).joints).max() < 0.01
    assert np.abs(rest.pose.position - pose.position).max() < 0.05
    # Its pose is that of `forward` for the actual joint values.
    found = gsp.forward(design, rest.joints, pose)
    shift = 5 * rest.gap * np.linalg.cond(design.at(pose).homogeneous(design.rms_radius))
    np.testing.assert_allclose(rest.pose.position, found.pose.position, atol=shift)
    np.testing.assert_allclose(rest.pose.rotation, found.pose.rotation, atol=shift)


@pytest.mark.parametrize("name", ["D1^6", *EXOTIC])
def test_driven_joints_move_the_platform_to_the_pose_of_forward(name):
    design, pose = good_posture(name, seed=7)
    joints = design.at(pose.moved([0.03, -0.02, 0.04, 0.03, 0.02, -0.04])).joints
    end = simulate(design, pose, joints, duration=3.0, gravity=[0, 0, 0])
    found = gsp.forward(design, joints, pose)
    assert found.converged
    np.testing.assert_allclose(end.joints, joints, atol=1e-6)
    np.testing.assert_allclose(end.pose.position, found.pose.position, atol=1e-6)
    np.testing.assert_allclose(end.pose.rotation, found.pose.rotation, atol=1e-6)
    assert np.abs(found.pose.position - pose.position).max() > 0.02


def test_a_redundant_hexapod_in_millimetres_is_driven():
    rng = np.random.default_rng(8)
    angle = np.arange(8) * np.pi / 4
    ring = np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)
    design = gsp.Design(
        ["D1"] * 8,
        300 * ring + rng.normal(scale=20, size=(8, 3)),
        150 * np.roll(ring, (1, 0), axis=(0, 1)) + rng.normal(scale=20, size=(8, 3)),
        unit="mm",
    )
    pose = gsp.Pose([0, 0, 400])
    target = design.at(pose.moved([20, 10, 30, 0.1, -0.1, 0.05])).joints
    end = simulate(design, pose, target, duration=2.0, gravity=[0, 0, 0])
    found = gsp.forward(design, target, pose)
    assert found.converged
    np.testing.assert_allclose(end.pose.position, found.pose.position, atol=1e-2)
    np.testing.assert_allclose(end.joints, target, atol=1e-2)


def test_lengths_are_metres():
    model, data = loaded(to_mjcf(TWO, TWO.home))
    np.testing.assert_allclose(data.body("platform").xpos, TWO.home.position / 1000)
    scale = np.where([n.startswith("theta") for n in TWO.joint_names], 1.0, 1e-3)
    np.testing.assert_allclose(data.actuator_length, TWO.at(TWO.home).joints * scale, rtol=1e-9)
    assert model.opt.gravity.tolist() == [0.0, 0.0, -9.81]


def test_an_unknown_unit_is_required():
    strange = TWO.replace(unit="cubit")
    with pytest.raises(MissingParameter, match=r"solids.metres.*cubit"):
        to_mjcf(strange, TWO.home)
    _, data = loaded(to_mjcf(strange, TWO.home, Solids(metres=0.5)))
    np.testing.assert_allclose(data.body("platform").xpos, TWO.home.position / 2)


def test_masses_and_strokes_are_the_users():
    n = len(TWO.joint_names)
    design = TWO.replace(strokes=[[10.0, 300.0], *[[np.nan, np.nan]] * (n - 1)])
    model, _ = loaded(to_mjcf(design, TWO.home, Solids(platform_mass=3.0, link_mass=0.2)))
    assert model.body("platform").mass[0] == pytest.approx(3.0)
    assert model.body("leg1_lower").mass[0] == pytest.approx(0.2)
    np.testing.assert_allclose(model.joint("d1").range, [0.01, 0.3])
    change = np.array([0.01, 0.3]) - 1e-3 * TWO.at(TWO.home).joints[0]
    np.testing.assert_allclose(model.actuator("d1").ctrlrange, change)
    assert not model.joint("d2").limited[0]


@pytest.mark.parametrize(
    ("stroke", "control", "end"), [((np.nan, 1.45), 0.2, 1.45), ((1.2, np.nan), -0.4, 1.2)]
)
def test_strokes_with_one_end_stop_the_servos(stroke, control, end):
    design = gsp.hexapod(1.0, 0.4, 0.6, 0.4, 1.2, unit="m").replace(strokes=[stroke] * 6)
    model, data = loaded(to_mjcf(design, design.home, gravity=[0, 0, 0]))
    data.ctrl[:] = control
    for _ in range(2000):
        mujoco.mj_step(model, data)
    np.testing.assert_allclose(data.actuator_length, end, atol=1e-3)


def test_a_locked_actuator_has_a_range():
    joints = LIFT.at(LIFT.home).joints
    strokes = np.stack((joints, joints), axis=1)
    model, _ = loaded(to_mjcf(LIFT.replace(strokes=strokes), LIFT.home))
    np.testing.assert_allclose(model.joint("d1").range, joints[0], rtol=1e-11)
    np.testing.assert_allclose(model.actuator("d1").ctrlrange, 0.0, atol=1e-11)


@pytest.mark.parametrize("form", [to_mjcf, to_urdf, to_sdf, to_pinocchio, simulate])
def test_a_pose_beyond_the_strokes_is_refused(form):
    """The model would not stay there."""
    design = LIFT.replace(strokes=[(0.5, 1.2)] * 6)
    with pytest.raises(InvalidInput, match=r"pose: expected d1 within its stroke .* 0.5 to 1.2"):
        form(design, LIFT.home)
    mujoco_rates(design, LIFT.home)


def test_a_crank_with_one_end_of_its_stroke_turns_within_it():
    """From 3.0 to -2.9: through π without a stroke, the other way if it ends at 3.1."""
    design = driven.rotary()
    theta = np.where(np.arange(6) == 4, 3.0, design.at(design.home).joints)
    assert theta[4] == 3.0
    change = _changes(design, np.where(np.arange(6) == 4, -2.9, theta), theta)
    assert change[4] == pytest.approx(2.0 * np.pi - 5.9)
    ended = design.replace(strokes=[(np.nan, 3.1)] * 6)
    assert _changes(ended, np.where(np.arange(6) == 4, -2.9, theta), theta)[4] == -5.9


def leaning(lift, rod, share, count, others="D1"):
    """Some legs of a hexapod as sliders, whose rods lean by a share of their length; lines differ.

    The other legs stay, of one kind.
    """
    rng = np.random.default_rng(0)
    rails = [0.0, 0.0, 1.0] + 0.3 * rng.normal(size=(6, 3))
    lines = [1.0, 0.0, 0.0] + 0.3 * rng.normal(size=(6, 3))
    heads = (lift.home.position + lift.platform_points)[:count]
    base = lift.base_points.copy()
    along = heads - base[:count]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.cross(along, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    base[:count], rails[:count] = heads - rod * np.sqrt(1.0 - share**2) * along, across
    base[:count] -= rod * share * across
    legs = [*[Slider(rod=rod)] * count, *[others] * (6 - count)]
    return lift.replace(
        legs=legs, base_points=base, base_directions=rails, platform_directions=lines
    )


@pytest.mark.parametrize("others", ["D1", "D4", "D4 A1"])
@pytest.mark.parametrize(("rod", "share"), [(4.0, 0.5), (40.0, 0.1)])
def test_a_slider_beside_legs_of_other_kinds_keeps_its_branch(others, rod, share):
    """Welds are open by angles, which say nothing of lengths: a machine of 50 mm."""
    lift = gsp.hexapod(60.0, 20.0, 40.0, 30.0, 52.0, degrees=True, unit="mm")
    design = leaning(lift, rod, share, 1, others)
    joints = design.at(design.home).joints.copy()
    simulate(design, design.home, duration=0.5)
    joints[0] += 2.0 * share * rod
    with pytest.raises(FailedComputation, match="d1 passed a singular posture of its drive"):
        simulate(design, design.home, joints)


def test_a_strained_loop_does_not_hide_the_branch_of_a_short_rod():
    """Its own loop is open by far less than the rod leans to the other side; others by more."""
    lift = gsp.hexapod(6.0, 20.0, 4.0, 30.0, 5.2, degrees=True, unit="m")
    design = leaning(lift, 0.05, 0.2, 1)
    joints = design.at(design.home).joints
    targets = [joints[0] + 2.0 * 0.2 * 0.05 - 0.015, *(joints[1:] - 0.2)]
    with pytest.raises(FailedComputation, match="d1 passed a singular posture of its drive"):
        simulate(design, design.home, targets)


@pytest.mark.parametrize("rod", [0.01, 0.05, 0.3])
def test_a_motion_to_the_other_branch_of_a_drive_is_refused(rod):
    """A carriage passes below its anchor, to where the rod leans back as it leant forward."""
    lift = gsp.hexapod(1.5, 0.35, 1.0, 0.35, 1.3, unit="m")
    design = leaning(lift, rod, 0.3, 6)
    joints = design.at(design.home).joints
    held = simulate(design, design.home, joints, duration=0.5)
    np.testing.assert_allclose(held.joints, joints, atol=1e-3 * rod)
    joints = joints + 2.0 * 0.3 * rod * np.eye(6)[0]
    with pytest.raises(FailedComputation, match="d1 passed a singular posture of its drive"):
        simulate(design, design.home, joints, duration=1.0)


def measured(constraint, anchor, axis, direction):
    """Simulated motions, along a direction, of a hexapod with a seventh leg, which has a target."""
    lift = gsp.hexapod(1.0, 0.3, 0.6, 0.4, 1.2, unit="m")
    design = gsp.Design(
        ["D1"] * 6 + [constraint],
        [*lift.base_points, [0.0, 0.0, 0.2]],
        [*lift.platform_points, anchor],
        base_directions=[[0.0, 0.0, 1.0]] * 7,
        platform_directions=[axis] * 7,
        home=lift.home,
        unit="m",
    )

    def moved(step, target):
        pose = lift.home.moved(step * np.array(direction))
        joints = [*lift.at(pose).joints, target]
        return simulate(design, design.home, joints, gravity=[0.0, 0.0, 0.0])

    return moved


@pytest.mark.parametrize("constraint", ["D3", "D4"])
def test_a_distance_that_passes_zero_is_refused(constraint):
    """It is x + 0.02."""
    moved = measured(constraint, [0.02, 0.0, -0.2], [0.0, 0.6, 0.8], [1, 0, 0, 0, 0, 0])
    found = moved(-0.01, 0.01)
    assert found.joints[6] == pytest.approx(0.01, abs=1e-6)
    assert found.passed is None
    with pytest.raises(FailedComputation, match="on which d7 passed 0"):
        moved(-0.06, 0.0)


def test_an_angle_between_lines_that_passes_zero_is_refused():
    """The axis of the platform is at 0.3 rad from that of the base, and turns towards it."""
    axis = [0.0, np.sin(0.3), np.cos(0.3)]
    moved = measured("A1", [0.02, 0.3, -0.2], axis, [0, 0, 0, 1, 0, 0])
    assert moved(0.2, 0.1).joints[6] == pytest.approx(0.1, abs=1e-6)
    with pytest.raises(FailedComputation, match="on which theta7 passed 0"):
        moved(0.31, 0.0)


@pytest.mark.parametrize(("frequency", "passed"), [(300.0, False), (2.0, True)])
def test_a_platform_that_falls_through_its_base_has_passed_a_singular_posture(frequency, passed):
    """Below the base are the mirror images of the poses above, where det J has the other sign."""
    lift = gsp.hexapod(1.0, 0.3, 0.6, 0.4, 0.6, unit="m")
    found = simulate(lift, lift.home, servo_frequency=frequency)
    assert (found.pose.position[2] < 0.0) == passed
    assert found.passed is passed


def test_beside_a_singular_posture_it_is_not_known_whether_it_was_passed():
    """Turned by 90° the design is singular, and in the first step loops open by some 1e-8."""
    lift = gsp.hexapod(1.0, 0.3, 0.6, 0.4, 1.2, unit="m")
    for beside, known in ((0.1, True), (1e-6, False)):
        pose = gsp.Pose.from_rpy([0.0, 0.0, 1.2], [0.0, 0.0, np.pi / 2.0 - beside])
        assert not lift.at(pose).singular()
        found = simulate(lift, pose, gravity=[0.0, 0.0, -1.0], duration=0.001)
        assert found.passed is (False if known else None)


def test_the_gap_is_a_distance():
    """Legs of D1 are as long as their joint values but for the gaps of their loops."""
    rng = np.random.default_rng(3)
    for _ in range(10):
        joints = LIFT.at(LIFT.home).joints + 0.15 * rng.normal(size=6)
        found = simulate(LIFT, LIFT.home, joints, duration=0.4)
        legs = found.pose.position + LIFT.platform_points @ found.pose.rotation.T - LIFT.base_points
        open_by = np.abs(np.linalg.norm(legs, axis=1) - found.joints).max()
        assert open_by <= found.gap * (1.0 + 1e-6) + 1e-14


def test_the_angles_of_cranks_with_a_stroke_are_those_of_the_design():
    """A target beyond π would be an angle near −π, beyond the stroke."""
    design = driven.rotary()
    joints = design.at(design.home).joints
    for stroke in ((-1.0, np.nan), (2.0, 4.0)):
        ended = design.replace(strokes=[stroke] * 6)
        with pytest.raises(InvalidInput, match=r"theta1 within its .*, (-1|2) to 3.14159, receiv"):
            simulate(ended, ended.home, joints + 0.5)


@pytest.mark.parametrize("far", [1e3, 1e6])
def test_a_platform_origin_far_away_changes_no_motion(far):
    near = LIFT.at(LIFT.home).joints + [0.1, -0.05, 0.0, 0.1, 0.0, 0.05]
    here = simulate(LIFT, LIFT.home, near, duration=1.0)
    shifted = LIFT.with_origin([far, 0.0, 0.0])
    there = simulate(shifted, shifted.home, near, duration=1.0)
    np.testing.assert_allclose(there.joints, here.joints, atol=1e-8)
    np.testing.assert_allclose(there.speed, here.speed, atol=1e-6)
    position = there.pose.position + there.pose.rotation @ [-far, 0.0, 0.0]
    np.testing.assert_allclose(position, here.pose.position, atol=1e-15 * far + 1e-8)


def test_sensors_read_joints_forces_and_the_pose():
    model, data = loaded(to_mjcf(TWO, TWO.home, drives=Drives(efforts=7.0)))
    posture = TWO.at(TWO.home)
    for i, (name, angular) in enumerate(zip(TWO.joint_names, TWO.angular, strict=True)):
        read = data.sensor(f"{name}_position").data[0]
        assert read == pytest.approx(posture.joints[i] * (1.0 if angular else 1e-3), rel=1e-9)
        assert data.sensor(f"{name}_force").data[0] == pytest.approx(data.actuator_force[i])
        assert model.actuator(name).forcerange.tolist() == [-7.0, 7.0]
    np.testing.assert_allclose(data.sensor("platform_position").data, TWO.home.position / 1000)
    turn = np.roll(data.sensor("platform_rotation").data, -1)
    same = gsp.Pose.from_quaternion([0.0, 0.0, 0.0], turn)
    np.testing.assert_allclose(same.rotation, TWO.home.rotation, atol=1e-12)


def test_every_leg_closes_one_loop():
    root = ElementTree.fromstring(to_mjcf(TWO, TWO.home))
    closings = [(node.tag, node.get("name")) for node in root.find("equality")]
    kinds = ["connect", "weld", "connect", "weld", "weld"]
    assert closings == [(kind, f"leg{i}") for i, kind in enumerate(kinds, 1)]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"gravity": [0, 0]}, "gravity"),
        ({"servo_frequency": 0.0}, "servo_frequency"),
        ({"solids": "steel"}, "solids: expected a Solids"),
    ],
)
def test_bad_options(options, message):
    with pytest.raises(InvalidInput, match=message):
        to_mjcf(TWO, TWO.home, **options)


def test_without_mujoco_the_extra_is_named(monkeypatch):
    monkeypatch.setattr("gsp.installed.is_installed", lambda module: False)
    with pytest.raises(MissingSoftware, match=r"gsp-mechanisms\[mujoco\]"):
        simulate(TWO, TWO.home)
    assert to_mjcf(TWO, TWO.home).startswith("<mujoco")


@pytest.mark.parametrize("name", ["radius", "density", "link_mass", "platform_mass", "metres"])
@pytest.mark.parametrize("value", [1e-300, 1e21, 1e308])
def test_solids_whose_inertias_are_not_numbers_are_refused(name, value):
    with pytest.raises(InvalidInput, match=f"solids.{name}: expected a number from 1e-20"):
        Solids(**{name: value})


def test_bad_solids_and_targets():
    with pytest.raises(InvalidInput, match=r"solids\.radius"):
        Solids(radius=-1.0)
    with pytest.raises(InvalidInput, match="joints"):
        simulate(TWO, TWO.home, [1.0, 2.0])
    with pytest.raises(InvalidInput, match="duration"):
        simulate(TWO, TWO.home, duration=0.0)


def test_agreement_names_a_design_that_is_too_small():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6").scaled(1e-3)
    with pytest.raises(gsp.GspError, match="design: expected one whose links are heavy enough"):
        agreement(design, design.home, "mujoco")


SIZES = ("radius", "density", "link_mass", "platform_mass", "metres")


@pytest.mark.parametrize("name", SIZES)
def test_mujoco_loads_every_model_that_is_written(name):
    """Of solids of any size: a model that MuJoCo cannot load is an error of the library."""
    written = 0
    for exponent in np.linspace(-20.0, 20.0, campaign.count(11, 41)):
        try:
            text = to_mjcf(TWO, TWO.home, Solids(**{name: 10.0**exponent}))
        except InvalidInput:
            continue
        written += 1
        mujoco.MjModel.from_xml_string(text)
    assert written > 2


def test_a_text_that_mujoco_refuses_is_an_error_of_the_library():
    with pytest.raises(InvalidInput, match="can make a model, received"):
        compiled("<mujoco><worldbody><body><freejoint/></body></worldbody></mujoco>")


def reach(design, pose):
    """Distance of the foot of leg 1 from its base anchor along the line, over the size."""
    posture = design.at(pose)
    d, s, t = (getattr(posture.lines, name)[0] for name in "dst")
    normal = np.cross(s, t)
    along = np.cross(d, t) @ normal / (normal @ normal), np.cross(d, s) @ normal / (normal @ normal)
    return np.abs(along).max() / design.rms_radius


def test_rates_of_nearly_parallel_lines_are_right_or_refused():
    refused = 0
    for seed in range(8):
        rng = np.random.default_rng(seed)
        points, others, lines, ends = rng.normal(size=(4, 6, 3))
        ends[0] = lines[0] + 10.0 ** rng.uniform(-6, -2) * rng.normal(size=3)
        design = gsp.Design(["D4"] * 6, points, others, lines, ends)
        pose = gsp.Pose([0.0, 0.0, 2.0])
        if reach(design, pose) > LARGEST_REACH:
            with pytest.raises(InvalidInput, match=r"leg1: .* nearly parallel"):
                agreement(design, pose, "mujoco")
            refused += 1
            continue
        found = agreement(design, pose, "mujoco")
        assert max(found.actuators, found.passive) < 1e-6
    assert 0 < refused < 8


@pytest.mark.parametrize("frequency", [300.0, 5000.0])
def test_fast_servos_reach_their_targets(frequency):
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    aim = design.at(design.home).joints + 5.0
    still = np.zeros(3)
    found = simulate(design, design.home, aim, 0.15, gravity=still, servo_frequency=frequency)
    np.testing.assert_allclose(found.joints, aim, atol=0.2 * 300.0 / frequency)


def test_a_motion_that_mujoco_loses_is_an_error(monkeypatch):
    """MuJoCo starts again from the pose, so that its state looks as if nothing had happened."""
    monkeypatch.setattr("gsp.bridges.mujoco.mjcf.TIMESTEP", 0.02)
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    aim = design.at(design.home).joints + 5.0
    with pytest.raises(FailedComputation, match="became unstable before"):
        simulate(design, design.home, aim, 4.0)


def test_nothing_beyond_the_strokes_is_simulated():
    joints = LIFT.at(LIFT.home).joints
    design = LIFT.replace(strokes=np.stack((joints - 0.01, joints + 0.1), axis=1))
    with pytest.raises(InvalidInput, match=r"joints: expected d1 within its stroke or range, "):
        simulate(design, design.home, joints + 0.2)
    with pytest.raises(InvalidInput, match="pose: expected d1 within its stroke"):
        simulate(design, design.home.moved([0, 0, 0.5, 0, 0, 0]))


def test_targets_that_no_joint_can_have_are_refused():
    joints = LIFT.at(LIFT.home).joints
    with pytest.raises(InvalidInput, match=r"expected d1 within its stroke or range, 0 to inf"):
        simulate(LIFT, LIFT.home, np.where(np.arange(6) == 0, -joints, joints))
    angles = TWO.at(TWO.home).joints
    with pytest.raises(InvalidInput, match=r"expected theta5 within .*, 0 to 3\.14159"):
        simulate(TWO, TWO.home, np.where(np.arange(6) == 5, 4.0, angles))


def test_cranks_take_the_shorter_way_round():
    """The crank of docs/drives.md, from 2.75 across π to -3.09."""
    ring = np.deg2rad([[-8, 8, 112, 128, 232, 248], [-52, 52, 68, 172, 188, 292]])
    base, platform = (
        radius * np.stack((np.cos(a), np.sin(a), 0.0 * a), axis=1)
        for radius, a in zip((2.0, 1.0), ring, strict=True)
    )
    axes = np.cross([0.0, 0.0, 1.0], base) / 2.0
    design = gsp.Design(
        [gsp.Crank(arm=0.3 * point, rod=2.0) for point in base],
        base_points=base,
        base_directions=axes,
        platform_points=platform,
        home=gsp.Pose([0.0, 0.0, 1.5]),
    )
    up = gsp.Pose([0.0, 0.0, 1.78])
    aim = design.at(up).joints
    assert (design.at(design.home).joints > 2.0).all()
    assert (aim < -2.0).all()
    found = simulate(design, design.home, aim, 0.3, gravity=np.zeros(3))
    np.testing.assert_allclose(found.pose.position, up.position, atol=1e-3)
    np.testing.assert_allclose(found.joints, aim, atol=1e-3)


@pytest.mark.parametrize("kinds", ["D1^2 D2^2 D3^2", "D1 D2 D3 D4 A1^2"])
def test_the_origin_of_the_platform_does_not_change_how_the_model_gives_way(kinds):
    """Under gravity, at the centre of the platform anchors."""
    rng = np.random.default_rng(8)
    design = random_design(gsp.catalogue.mechanism(kinds), rng).replace(unit="m")
    design = design.replace(home=BOX.sample(1, rng=rng)[0])
    centre, sags = design.platform_points.mean(axis=0), []
    for shift in (np.zeros(3), np.array([50.0, -50.0, 50.0])):
        moved = design.with_origin(centre + shift)
        end = simulate(moved, moved.home, duration=0.3).pose
        home = moved.home
        sags.append(end.position - home.position - (end.rotation - home.rotation) @ shift)
    np.testing.assert_allclose(sags[1], sags[0], atol=0.02 * np.abs(sags[0]).max())


def test_targets_that_mujoco_takes_for_zero_are_an_error():
    with pytest.raises(FailedComputation, match="became unstable"):
        simulate(LIFT, LIFT.home, np.full(6, 1e15), duration=0.1)


def test_targets_that_open_the_loops_are_refused():
    """Legs of three times the length beside legs of a tenth; the platform is held by none of them.

    A quarter more on one leg and less on another is within reach, with closed loops.
    """
    design = gsp.catalogue.design("cheers-hexapod")
    joints = design.at(design.home).joints
    far = joints * [3.0, 0.1, 3.0, 0.1, 3.0, 0.1]
    with pytest.raises(FailedComputation, match=r"reach together, .* a loop that is open by 0\.\d"):
        simulate(design, design.home, far, duration=1.0)
    near = joints * [1.25, 1.0, 1.0, 0.75, 1.0, 1.0]
    found = simulate(design, design.home, near, duration=1.0)
    reached = design.at(found.pose).joints
    np.testing.assert_allclose(found.joints, reached, atol=1e-3 * design.rms_radius)


def test_the_angle_of_an_open_weld_is_that_of_the_turn():
    """The platform is turned away from the legs that are welded to it, by hand."""
    model, data = load(TWO, TWO.home)
    assert gaps_of(data)[1].max(initial=0.0) < 1e-9
    free = int(np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0])
    start = model.jnt_qposadr[free] + 3
    turn = Rotation.from_rotvec([0.0, 0.0, 0.3]) * Rotation.from_quat(
        np.roll(data.qpos[start : start + 4], -1)
    )
    data.qpos[start : start + 4] = np.roll(turn.as_quat(), 1)
    mujoco.mj_forward(model, data)
    turns = gaps_of(data)[1]
    assert turns.size
    np.testing.assert_allclose(turns, 0.3, rtol=1e-9)
