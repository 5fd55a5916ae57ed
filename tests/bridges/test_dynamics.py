"""Dynamics of the exports: finite, the same in three programs, and held by the forces of `gsp`."""

from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio as pin
import pytest

import gsp
from gsp.bridges import Solids, masses, to_mjcf, to_pinocchio, to_sdf, to_urdf
from gsp.bridges.proof import BOX, random_design
from tests import campaign

ALL = gsp.catalogue.mechanisms()
SOME = ALL[:: len(ALL) // campaign.count(9, len(ALL))]
SPLIT = 1e-5
TWO = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")


def posture(mechanism, seed=5):
    rng = np.random.default_rng(seed)
    return random_design(mechanism, rng), BOX.sample(1, rng=rng)[0]


def closed_acceleration(model, loops, q, forces=None):
    """Accelerations at rest by Pinocchio, loops closed."""
    data = model.createData()
    models, datas = pin.StdVec_RigidConstraintModel(), pin.StdVec_RigidConstraintData()
    for loop in loops:
        models.append(loop)
        datas.append(loop.createData())
    pin.initConstraintDynamics(model, data, models, datas)
    tau = np.zeros(model.nv) if forces is None else forces
    settings = pin.ProximalSettings(1e-14, 1e-12, 20)
    still = np.zeros(model.nv)
    return np.array(pin.constraintDynamics(model, data, q, still, tau, models, datas, settings))


def open_acceleration(model, q):
    still = np.zeros(model.nv)
    return np.array(pin.aba(model, model.createData(), q, still, still))


def loop_of(model, first, second, placement):
    """A constraint of Pinocchio that fixes one frame to a placement on another."""
    one, two = (model.frames[model.getFrameId(name)] for name in (first, second))
    return pin.RigidConstraintModel(
        pin.ContactType.CONTACT_6D, model, one.parentJoint, one.placement,
        two.parentJoint, two.placement * placement, pin.ReferenceFrame.LOCAL,
    )  # fmt: skip


def urdf_machine(tree):
    model = pin.buildModelFromXML(tree.text)
    loops = [
        loop_of(model, loop.link_1, loop.link_2, loop.placement.to_se3()) for loop in tree.loops
    ]
    return model, loops, pin.neutral(model)


def part(model, acceleration, joint):
    at = model.joints[model.getJointId(joint)]
    return acceleration[at.idx_v : at.idx_v + at.nv]


def test_all_mechanisms_load_and_have_finite_accelerations():
    for mechanism in ALL[:: len(ALL) // campaign.count(24, len(ALL))]:
        design, pose = posture(mechanism)
        model, loops, q = to_pinocchio(design, pose)
        assert np.isfinite(open_acceleration(model, q)).all(), mechanism
        assert np.isfinite(closed_acceleration(model, loops, q)).all(), mechanism


@pytest.mark.parametrize("mechanism", campaign.some(SOME, 5), ids=str)
def test_programs_agree_on_the_acceleration_of_a_falling_platform(mechanism):
    """With free actuators. The light links between turns of a joint differ, 1e-5 of g or less."""
    design, pose = posture(mechanism)
    model, loops, q = to_pinocchio(design, pose)
    falling = closed_acceleration(model, loops, q)
    ours = part(model, falling, "platform")
    scale = np.abs(ours).max()
    tree, *machine = urdf_machine(to_urdf(design, pose))
    theirs = part(tree, closed_acceleration(tree, *machine), "base_to_platform")
    np.testing.assert_allclose(theirs, ours, atol=SPLIT * scale)
    # The platform on leg 1: one loop less.
    tree, *machine = urdf_machine(to_urdf(design, pose, floating=False))
    assert len(machine[0]) == design.n_legs - 1
    theirs = closed_acceleration(tree, *machine)
    for name in design.joint_names:
        expected = part(model, falling, name)[0]
        assert part(tree, theirs, name)[0] == pytest.approx(expected, abs=10 * SPLIT * scale)
    np.testing.assert_allclose(sdf_acceleration(design, pose), ours, atol=SPLIT * scale)
    np.testing.assert_allclose(mujoco_acceleration(design, pose), ours, atol=1e-9 * scale)


def mujoco_acceleration(design, pose, forces=0.0):
    """Of the platform, in its axes, by MuJoCo's mass matrix, bias and Jacobian of the loops."""
    model = mujoco.MjModel.from_xml_string(to_mjcf(design, pose))
    model.dof_armature[:] = 0.0
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    given = -data.qfrc_bias
    given[[model.joint(name).dofadr[0] for name in design.joint_names]] += forces
    found = constrained(mass, data.efc_J.reshape(-1, model.nv), given)
    first = model.joint("platform").dofadr[0]
    shift, turn = found[first : first + 6].reshape(2, 3)
    return np.concatenate((pose.rotation.T @ shift, turn))


def constrained(mass, rows, forces):
    """Accelerations of a system at rest under constraints."""
    matrix = np.block([[mass, rows.T], [rows, np.zeros((len(rows), len(rows)))]])
    return np.linalg.solve(matrix, np.concatenate((forces, np.zeros(len(rows)))))[: len(mass)]


def sdf_acceleration(design, pose):
    """Of the platform, in its axes: each link of the SDF a free body, each joint constraints."""
    root = ElementTree.fromstring(to_sdf(design, pose).text).find("model")
    links = [link for link in root.iter("link") if link.get("name") != "base"]
    names = [link.get("name") for link in links]
    mass = np.zeros((6 * len(links), 6 * len(links)))
    weights, centres = np.zeros((len(links), 6)), {}
    for i, link in enumerate(links):
        inertial, frame = link.find("inertial"), place(link)
        centres[names[i]] = (frame * place(inertial)).translation
        own = float(inertial.find("mass").text)
        ixx, ixy, ixz, iyy, iyz, izz = (float(x.text) for x in inertial.find("inertia"))
        turn = (frame * place(inertial)).rotation
        at = 6 * i + np.arange(3)
        mass[np.ix_(at, at)] = own * np.eye(3)
        mass[np.ix_(at + 3, at + 3)] = (
            turn @ np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]]) @ turn.T
        )
        weights[i, 2] = -9.81 * own
    rows = [joint_rows(root, joint, names, centres) for joint in root.iter("joint")]
    found = constrained(mass, np.concatenate(rows), weights.ravel()).reshape(-1, 2, 3)
    shift, turn = found[names.index("platform")]
    shift = shift + np.cross(turn, pose.position - centres["platform"])
    return np.concatenate((pose.rotation.T @ shift, pose.rotation.T @ turn))


def place(node):
    """The pose of an element, in its parent element."""
    found = node.find("pose")
    numbers = np.zeros(6) if found is None else np.array(found.text.split(), dtype=float)
    return pin.SE3(pin.rpy.rpyToMatrix(numbers[3:]), numbers[:3])


def joint_rows(root, joint, names, centres):
    """Rows of a joint: relative velocities of its point, and of the turn, that are zero."""
    child = next(x for x in root.iter("link") if x.get("name") == joint.find("child").text)
    frame, kind = place(child) * place(joint), joint.get("type")
    relative = np.zeros((6, len(names), 6))
    for end, sign in (("child", 1.0), ("parent", -1.0)):
        name = joint.find(end).text
        if name in names:
            arm = pin.skew(frame.translation - centres[name])
            velocity = np.block([[np.eye(3), -arm], [np.zeros((3, 3)), np.eye(3)]])
            relative[:, names.index(name)] = sign * velocity
    shifts, turns = relative.reshape(6, -1)[:3], relative.reshape(6, -1)[3:]
    if kind == "fixed":
        assert (joint.find("parent").text, joint.find("child").text) == ("world", "base")
        return np.zeros((0, relative[0].size))
    if kind == "ball":
        return shifts
    axis = frame.rotation @ np.array(joint.find("axis/xyz").text.split(), dtype=float)
    across = np.linalg.svd(axis[None])[2][1:]
    free, kept = {"prismatic": (shifts, turns), "revolute": (turns, shifts)}[kind]
    return np.concatenate((across @ free, kept))


@pytest.mark.parametrize("solids", [None, Solids(platform_mass=40.0, link_mass=0.3, radius=0.05)])
def test_the_holding_forces_of_gsp_hold_all_mechanisms_in_pinocchio(solids):
    for mechanism in ALL[:: len(ALL) // campaign.count(12, len(ALL))]:
        design, pose = posture(mechanism)
        forces = gsp.statics.holding_forces(design, pose, masses(design, pose, solids))
        machine = to_pinocchio(design, pose, solids)
        assert held(machine, design, forces) < 1e-8, mechanism
        assert held(machine, design, 1.01 * forces) > 1e-4, mechanism


def held(machine, design, forces):
    """Largest acceleration under actuator forces, in shares of the force of gravity."""
    model, loops, q = machine
    tau = np.zeros(model.nv)
    for name, force in zip(design.joint_names, forces, strict=True):
        tau[model.joints[model.getJointId(name)].idx_v] = force
    return np.abs(closed_acceleration(model, loops, q, tau)).max()


@pytest.mark.parametrize("mechanism", SOME[::3], ids=str)
def test_the_holding_forces_of_gsp_hold_in_mujoco(mechanism):
    design, pose = posture(mechanism)
    forces = gsp.statics.holding_forces(design, pose, masses(design, pose))
    assert np.abs(mujoco_acceleration(design, pose, forces)).max() < 1e-8


def test_forces_in_millimetres_are_newtons():
    forces = gsp.statics.holding_forces(TWO, TWO.home, masses(TWO, TWO.home))
    machine = to_pinocchio(TWO, TWO.home)
    np.testing.assert_allclose(machine.model.gravity.linear, [0.0, 0.0, -9810.0])
    # kg mm/s² is a thousandth of a newton, and N mm are a thousand kg mm²/s².
    assert held(machine, TWO, 1e3 * forces) < 1e-5
    metres = TWO.scaled(1e-3).replace(unit="m")
    unit = np.where(TWO.angular, 1e-3, 1.0)
    again = gsp.statics.holding_forces(metres, metres.home, masses(metres, metres.home))
    np.testing.assert_allclose(again, forces * unit, rtol=1e-10)


@pytest.mark.parametrize("mechanism", SOME[::3], ids=str)
def test_accelerations_by_actuators_are_those_of_our_jacobian(mechanism):
    """Without weights a = M⁻¹ Jᵀ f, so that A J⁻ᵀ is symmetric and positive definite."""
    design, pose = posture(mechanism)
    model, loops, q = to_pinocchio(design, pose)
    model.gravity.linear = np.zeros(3)
    columns = []
    for name in design.joint_names:
        tau = np.zeros(model.nv)
        tau[model.joints[model.getJointId(name)].idx_v] = 1.0
        columns.append(part(model, closed_acceleration(model, loops, q, tau), "platform"))
    axes = np.kron(np.eye(2), pose.rotation)
    inverse = axes @ np.stack(columns, axis=1) @ np.linalg.inv(design.at(pose).jacobian.T)
    np.testing.assert_allclose(inverse, inverse.T, atol=1e-9 * np.abs(inverse).max())
    assert np.linalg.eigvalsh(inverse).min() > 0.0


@pytest.mark.parametrize("mechanism", SOME[::2], ids=str)
def test_all_links_have_mass_and_inertias_of_bodies(mechanism):
    """Positive moments, none larger than the sum of the two others; in both kinds of files."""
    design, pose = posture(mechanism)
    urdf = ElementTree.fromstring(to_urdf(design, pose).text)
    sdf = ElementTree.fromstring(to_sdf(design, pose).text)
    found = [
        (float(link.find("inertial/mass").get("value")),
         [float(link.find("inertial/inertia").get(x)) for x in ENTRIES])
        for link in urdf.iter("link")
    ] + [
        (float(link.find("inertial/mass").text),
         [float(link.find(f"inertial/inertia/{x}").text) for x in ENTRIES])
        for link in sdf.iter("link")
    ]  # fmt: skip
    assert len(found) > 4 * design.n_legs
    for mass, (ixx, ixy, ixz, iyy, iyz, izz) in found:
        moments = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
        assert mass > 0.0
        assert moments[0] > 0.0
        assert moments[2] <= (moments[0] + moments[1]) * (1.0 + 1e-12)


ENTRIES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def test_mujoco_reads_the_urdf_with_the_same_accelerations():
    for mechanism in SOME[::4]:
        design, pose = posture(mechanism)
        text = to_urdf(design, pose).text
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        assert model.ngeom > 6 * design.n_legs
        assert not data.ncon
        tree = pin.buildModelFromXML(text)
        expected = open_acceleration(tree, pin.neutral(tree))
        for name in set(tree.names) - {"universe", "base_to_platform"}:
            found = data.qacc[model.joint(name).dofadr[0]]
            assert found == pytest.approx(part(tree, expected, name)[0], abs=1e-9)
