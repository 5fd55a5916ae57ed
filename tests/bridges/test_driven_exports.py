"""Exports of designs with legs that are driven at the base: the same machine in all programs."""

from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio as pin
import pytest

import gsp
from gsp import Crank, Slider
from gsp.bridges import (
    Drives,
    Solids,
    agreement,
    masses,
    simulate,
    to_mjcf,
    to_pinocchio,
    to_sdf,
    to_urdf,
)
from gsp.bridges.links.linkage import linkage
from gsp.bridges.mujoco.elements import configuration
from gsp.bridges.mujoco.scene import Scene
from gsp.bridges.proof import DIFFERENCE_TOLERANCE
from gsp.errors import InvalidInput, UndefinedPosture
from gsp.model.units import METRES_PER_UNIT
from tests import campaign, driven
from tests.bridges.test_dynamics import (
    closed_acceleration,
    held,
    mujoco_acceleration,
    part,
    sdf_acceleration,
    urdf_machine,
)
from tests.bridges.test_linkage import end_of
from tests.bridges.test_loaders import held_by_mujoco, held_by_pinocchio
from tests.bridges.test_scene import rod

FIVE = driven.of_five_legs()
PUBLISHED = {name: gsp.catalogue.design(name) for name in ("lane-rotary", "lane-modified-paradex")}
DESIGNS = {**driven.DESIGNS, "five legs": FIVE, **PUBLISHED}
SOME = [DESIGNS[name] for name in ("five legs", "sliders", "cranks, other branch")]
EXPORTS = (to_mjcf, to_pinocchio, to_sdf, to_urdf)


def metres(design):
    return design.scaled(METRES_PER_UNIT[design.unit]).replace(unit="m")


def frames(design):
    """A design as it is, in other units, and with both frames moved and turned."""
    yield design
    for unit in ("um", "mm"):
        yield design.scaled(1.0 / METRES_PER_UNIT[unit]).replace(unit=unit)
    yield design.with_origin(design.rms_radius * np.array([0.4, -2.0, 0.7]))


@pytest.mark.parametrize("program", ["pinocchio", "mujoco"])
@pytest.mark.parametrize("name", DESIGNS)
def test_rates_of_actuators_and_passive_joints_agree(name, program):
    design = DESIGNS[name]
    for pose in driven.near_home(design, 2, seed=3):
        assert max(agreement(design, pose, program)) < DIFFERENCE_TOLERANCE


@pytest.mark.parametrize("seed", range(campaign.count(6, 200)))
def test_mixtures_of_all_legs_agree_with_both_programs(seed):
    """Of dimensions at random; far enough from singular ones to have digits left."""
    design = driven.mixture(seed)
    posture = design.at(design.home)
    condition = np.linalg.cond(posture.homogeneous(design.rms_radius))
    if condition > 1e3 or np.abs(posture.drive_scales).min() < 1e-2:
        return
    for program in ("pinocchio", "mujoco"):
        assert max(agreement(design, design.home, program)) < DIFFERENCE_TOLERANCE
    solids = Solids(platform_mass=9.0)
    forces = gsp.statics.holding_forces(design, design.home, masses(design, design.home, solids))
    for found in (held_by_mujoco(design, solids), held_by_pinocchio(design, solids)):
        np.testing.assert_allclose(found, forces, atol=1e-10 * np.abs(forces).max())


@pytest.mark.parametrize("program", ["pinocchio", "mujoco"])
def test_rates_agree_in_other_units_and_frames(program):
    for design in frames(FIVE):
        moved = design.home.moved(np.repeat([0.03 * design.rms_radius, 0.03], 3))
        assert max(agreement(design, moved, program)) < DIFFERENCE_TOLERANCE


@pytest.mark.parametrize("program", ["pinocchio", "mujoco"])
def test_another_rod_or_branch_would_be_seen(program):
    """The rates of a design that is not quite the same, or has another branch, differ."""
    rates = gsp.bridges.agreements.PROGRAMS[program]
    ours = FIVE.at(FIVE.home).jacobian
    longer = [Slider(rod=2.4 + 1e-6), *FIVE.legs[1:]]
    other = [Slider(rod=2.4, branch=-1), *FIVE.legs[1:]]
    for legs, least in ((longer, 1e-8), (other, 0.1)):
        theirs = rates(FIVE.replace(legs=legs), FIVE.home).actuators
        assert np.abs(theirs - ours).max() > least


@pytest.mark.parametrize("name", DESIGNS)
def test_chains_lead_to_the_platform_by_way_of_the_tips(name):
    design, poses = DESIGNS[name], driven.near_home(DESIGNS[name], 2)
    close = 1e-13 * design.rms_radius
    for i in range(poses.size):
        pose = poses[i]
        posture, chains = design.at(pose), linkage(design, pose)
        for chain in chains:
            end, head = end_of(chain), pose.compose(chain.head)
            np.testing.assert_allclose(end.position, head.position, atol=10 * close)
            np.testing.assert_allclose(end.rotation, head.rotation, atol=1e-12)
        for leg, tip in driven.tips(design, posture).items():
            moved, ball = chains[leg].base[0].placement, chains[leg].middle[0]
            place = chains[leg].foot.compose(moved).compose(ball.placement)
            np.testing.assert_allclose(place.position, tip, atol=10 * close)
        active = [motion for chain in chains for motion in chain.motions if motion.active]
        assert tuple(motion.name for motion in active) == design.joint_names
        np.testing.assert_allclose([m.value for m in active], posture.joints, rtol=1e-13)


def test_one_pinocchio_model_serves_all_poses():
    here, there = (to_pinocchio(FIVE, FIVE.home), FIVE.home.moved([0.05, -0.04, 0.06, 0.1, 0, 0]))
    mixed = here._replace(configuration=to_pinocchio(FIVE, there).configuration)
    data = mixed.model.createData()
    assert gsp.bridges.pinocchio.rates.closure_residual(mixed, data) < 1e-12


@pytest.mark.parametrize("name", DESIGNS)
def test_models_start_assembled_and_stay_so_under_gravity(name):
    design = DESIGNS[name]
    size = design.rms_radius * METRES_PER_UNIT[design.unit]
    model = mujoco.MjModel.from_xml_string(to_mjcf(design, design.home))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos).max() < 1e-12 * size
    rest = simulate(design, design.home, duration=0.1)
    assert rest.gap < 1e-6 * size
    unit = np.where(design.angular, 1.0, design.rms_radius)
    assert np.abs((rest.joints - design.at(design.home).joints) / unit).max() < 1e-3


def test_loops_of_urdf_are_closed_where_all_joints_are_zero():
    for design in frames(FIVE):
        for floating in (True, False) if design is FIVE else (True,):
            tree = to_urdf(design, design.home, floating=floating)
            model, loops, q = urdf_machine(tree)
            data = model.createData()
            pin.forwardKinematics(model, data, q)
            size = design.rms_radius * METRES_PER_UNIT[design.unit]
            for loop in loops:
                first = data.oMi[loop.joint1_id] * loop.joint1_placement
                gap = first.actInv(data.oMi[loop.joint2_id] * loop.joint2_placement)
                assert np.abs(gap.translation).max() < 1e-12 * size
                assert np.abs(gap.rotation - np.eye(3)).max() < 1e-12
            values = [tree.joints[name] for name in design.joint_names]
            scale = np.where(design.angular, 1.0, METRES_PER_UNIT[design.unit])
            np.testing.assert_allclose(values, design.at(design.home).joints * scale, rtol=1e-12)
            assert set(tree.slides) == {"leg5_base_slide"}


def test_drives_move_the_platform_to_the_pose_of_forward():
    joints = FIVE.at(FIVE.home.moved([0.03, -0.02, 0.04, 0.03, 0.02, -0.04])).joints
    end = simulate(FIVE, FIVE.home, joints, duration=1.0, gravity=[0, 0, 0])
    found = gsp.forward(FIVE, joints, FIVE.home)
    assert found.converged
    np.testing.assert_allclose(end.joints, joints, atol=1e-6)
    np.testing.assert_allclose(end.pose.position, found.pose.position, atol=1e-6)
    np.testing.assert_allclose(end.pose.rotation, found.pose.rotation, atol=1e-6)


@pytest.mark.parametrize("design", SOME, ids=lambda design: design.mechanism.name)
def test_programs_agree_on_the_acceleration_of_a_falling_platform(design, monkeypatch):
    """The links between the turns of a joint are so light that they do not count."""
    monkeypatch.setattr("gsp.bridges.links.stock.SPLIT_SHARE", 1e-7)
    monkeypatch.setattr("gsp.bridges.links.stock.LEAST_SPLIT", 0.0)
    pose = design.home
    model, loops, q = to_pinocchio(design, pose)
    ours = part(model, closed_acceleration(model, loops, q), "platform")
    scale = np.abs(ours).max()
    tree, *machine = urdf_machine(to_urdf(design, pose))
    theirs = part(tree, closed_acceleration(tree, *machine), "base_to_platform")
    np.testing.assert_allclose(theirs, ours, atol=1e-8 * scale)
    np.testing.assert_allclose(sdf_acceleration(design, pose), ours, atol=1e-8 * scale)
    np.testing.assert_allclose(mujoco_acceleration(design, pose), ours, atol=1e-9 * scale)


@pytest.mark.parametrize("name", [name for name, d in driven.DESIGNS.items() if d.n_legs == 6])
def test_the_holding_forces_of_gsp_are_those_of_the_programs(name):
    """With a payload, by balance of generalised forces."""
    design, solids = metres(DESIGNS[name]), Solids(platform_mass=25.0)
    forces = gsp.statics.holding_forces(design, design.home, masses(design, design.home, solids))
    for found in (held_by_mujoco(design, solids), held_by_pinocchio(design, solids)):
        np.testing.assert_allclose(found, forces, atol=1e-10 * np.abs(forces).max())


def test_a_redundant_design_is_held():
    design = DESIGNS["mixed"]
    forces = gsp.statics.holding_forces(design, design.home, masses(design, design.home))
    assert held(to_pinocchio(design, design.home), design, forces) < 1e-8


def test_masses_are_the_same_in_all_formats():
    """Body by body: carriages, cranks and rods with their centres, from each file's own text."""
    solids = Solids(radius=0.03)
    for design in (FIVE, FIVE.scaled(1e3).replace(unit="mm")):
        unit = METRES_PER_UNIT[design.unit]
        given = Solids(radius=solids.radius / unit)
        sdf = ElementTree.fromstring(to_sdf(design, design.home, given).text)
        urdf = ElementTree.fromstring(to_urdf(design, design.home, given).text)
        simulated = mujoco.MjModel.from_xml_string(to_mjcf(design, design.home, given))
        own = to_pinocchio(design, design.home, given).model
        total = masses(design, design.home, given)
        for i, chain in enumerate(linkage(design, design.home)):
            for end, joint in (("lower", chain.base), ("upper", chain.middle)):
                link = f"{chain.name}_{end}"
                inertia = own.inertias[own.getJointId(_carrier(own, joint, chain.name))]
                centre = inertia.lever * unit
                found = [
                    (simulated.body(link).mass[0], simulated.body(link).ipos),
                    *(_mass(root, link) for root in (sdf, urdf)),
                ]
                assert getattr(total, end)[i] == pytest.approx(inertia.mass, rel=1e-12)
                for mass, place in found:
                    assert mass == pytest.approx(inertia.mass, rel=1e-12)
                    np.testing.assert_allclose(place, centre, atol=1e-12)


def _carrier(model, motions, name):
    """The joint of a link in Pinocchio; those of cylindrical joints have names of their own."""
    return motions[-1].name if model.existJointName(motions[-1].name) else f"{name}_base"


def _mass(root, link):
    inertial = next(x for x in root.iter("link") if x.get("name") == link).find("inertial")
    if root.tag == "robot":
        origin = inertial.find("origin").get("xyz")
        return float(inertial.find("mass").get("value")), np.array(origin.split(), dtype=float)
    numbers = np.array(inertial.find("pose").text.split(), dtype=float)
    return float(inertial.find("mass").text), numbers[:3]


def test_cranks_reach_from_the_axis_to_the_tip_and_rods_to_the_anchor():
    """At each pose of a film; rails hold their carriages and cranks at all of them."""
    for design in (FIVE, DESIGNS["cranks"], PUBLISHED["lane-modified-paradex"]):
        poses, unit = driven.near_home(design, 3), 1.0 / design.rms_radius
        scene = Scene(design, poses, None)
        close = 1e-9 * design.rms_radius * unit
        for frame in range(poses.size):
            scene.show(frame)
            found = design.at(poses[frame]).segments
            for leg, tip in driven.tips(design, design.at(poses[frame])).items():
                start, end = rod(scene, f"leg{leg + 1}_upper")
                np.testing.assert_allclose(start, tip * unit, atol=close)
                np.testing.assert_allclose(end, found.platform_feet[leg] * unit, atol=close)
                low, high = rod(scene, f"leg{leg + 1}_lower")
                s, a = design.base_directions[leg], design.base_points[leg] * unit
                if isinstance(design.drives[leg], Crank):
                    np.testing.assert_allclose(high, tip * unit, atol=close)
                    assert abs((high - low) @ s) < close
                    assert np.linalg.norm(np.cross(low - a, s)) < close
                    held_at = low
                else:
                    np.testing.assert_allclose((low + high) / 2, tip * unit, atol=close)
                    assert np.linalg.norm(np.cross(high - low, s)) < close
                    held_at = tip * unit
                assert _on_a_rail(scene, held_at, s)


def _on_a_rail(scene, point, s):
    """Whether one of the rods of the base is along s and passes a point within its ends."""
    for geom in range(int(scene.model.body("world").geomnum[0])):
        start, end = rod(scene, "world", geom)
        length = np.linalg.norm(end - start)
        along = (end - start) / length
        if np.linalg.norm(np.cross(along, s)) < 1e-9:
            off = point - start
            if np.linalg.norm(np.cross(off, along)) < 1e-9 * length:
                return 0.0 <= off @ along <= length
    return False


def test_one_mujoco_model_is_assembled_at_all_poses():
    poses = driven.near_home(FIVE, 4, seed=5)
    model = mujoco.MjModel.from_xml_string(to_mjcf(FIVE, poses[0]))
    data, start = mujoco.MjData(model), linkage(FIVE, poses[0])
    for i in range(poses.size):
        data.qpos[:] = configuration(start, linkage(FIVE, poses[i]), poses[i], 1.0)
        mujoco.mj_forward(model, data)
        assert np.abs(data.efc_pos).max() < 1e-12
        np.testing.assert_allclose(data.actuator_length, FIVE.at(poses[i]).joints, atol=1e-12)


def test_strokes_forces_and_speeds_are_limits_of_the_drives():
    n = len(FIVE.joint_names)
    values, half = FIVE.at(FIVE.home).joints, np.linspace(0.1, 0.2, n)
    design = FIVE.replace(strokes=np.stack((values - half, values + half), axis=1))
    limits = Drives(efforts=10.0 + np.arange(n), speeds=0.5)
    tree = pin.buildModelFromXML(to_urdf(design, design.home, drives=limits).text)
    own = to_pinocchio(design, design.home, drives=limits).model
    simulated = mujoco.MjModel.from_xml_string(to_mjcf(design, design.home, drives=limits))
    sdf = ElementTree.fromstring(to_sdf(design, design.home, drives=limits).text)
    for i, name in enumerate(design.joint_names):
        for model, at_zero in ((tree, values[i]), (own, 0.0)):
            joint = model.joints[model.getJointId(name)]
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            expected = np.array([values[i] - half[i], values[i] + half[i]]) - at_zero
            np.testing.assert_allclose([low, high], expected, atol=1e-12)
            assert model.effortLimit[joint.idx_v] == 10.0 + i
            assert model.velocityLimit[joint.idx_v] == 0.5
        axis = next(x for x in sdf.iter("joint") if x.get("name") == name).find("axis/limit")
        found = [float(axis.find(x).text) for x in ("lower", "upper", "effort", "velocity")]
        np.testing.assert_allclose(found, [-half[i], half[i], 10.0 + i, 0.5], atol=1e-12)
        stroke = [values[i] - half[i], values[i] + half[i]]
        np.testing.assert_allclose(simulated.joint(name).range, stroke, rtol=1e-12)
        assert simulated.actuator(name).forcerange.tolist() == [-10.0 - i, 10.0 + i]


@pytest.mark.parametrize("function", [*EXPORTS, masses], ids=lambda f: f.__name__)
def test_out_of_reach_is_named(function):
    for name, reason in (("hexaglide", "does not reach"), ("rotary", "do not reach")):
        with pytest.raises(UndefinedPosture, match=reason):
            function(DESIGNS[name], gsp.Pose([0.0, 0.0, 9.0]))


def with_a_singular_drive():
    """The rod of leg 1 is vertical, and its rail is not."""
    design = driven.hexaglide()
    foot = design.base_points[0] + [0.3, 0.0, 0.0]
    pose = gsp.Pose(foot + [0.0, 0.0, 2.2] - design.platform_points[0])
    legs = [Slider(rod=2.2), *(Slider(rod=4.0, branch=leg.drive.branch) for leg in design.legs[1:])]
    design = design.replace(legs=legs, home=pose)
    assert design.at(pose).drive_is_singular.tolist() == [True] + [False] * 5
    return design


def test_models_at_singular_drives_are_written_and_have_no_rates():
    """The machine is assembled there; only the rate of the drive has no bound."""
    design = with_a_singular_drive()
    model = mujoco.MjModel.from_xml_string(to_mjcf(design, design.home))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos).max() < 1e-12
    machine = to_pinocchio(design, design.home)
    assert np.isfinite(closed_acceleration(*machine)).all()
    for program in ("pinocchio", "mujoco"):
        with pytest.raises(InvalidInput, match=r"singular drive of d1: the rod is perpendicular"):
            agreement(design, design.home, program)
    weights = masses(design, design.home)
    assert np.isnan(gsp.statics.gravity_wrench(design, design.home, weights)).all()
    assert np.isnan(gsp.statics.holding_forces(design, design.home, weights)).all()
