"""Exports in the loaders of other programs: they load, and their loops stay closed under gravity.

But for MuJoCo the programs are no dependencies; where one is not installed, its tests are skipped.
"""

import functools
import logging
import shutil
import subprocess
from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio as pin
import pytest

import gsp
from gsp.bridges import Solids, masses, simulate, to_mjcf, to_pinocchio, to_sdf, to_urdf
from gsp.bridges.formats.contacts import NAMESPACE
from gsp.bridges.proof import BOX, random_design
from gsp.model.units import METRES_PER_UNIT
from tests import campaign, driven

NAMES = (
    "apo-secondary",
    "basic-robotics-small",
    "cheers-hexapod",
    "dehaeze-general",
    "dietmaier-40",
    "lane-modified-paradex",
    "lane-rotary",
    "lee-2000-3-3",
    "linuxcnc-genhexkins",
    "nawratil-k-plus",
    "rubin-camera-hexapod",
    "toz-kucuk-2016-d1-d2-d3-d4-a1-2",
    "toz-kucuk-2016-d3-6",
    "wolfram-stewart-platform",
)
STEP = 1e-3  # s
# The solver of PyBullet stops before it has converged; loops open by the load of one step.
BULLET_STEP = 2.5e-4  # s
# Loops of cylindrical joints end in light links where they are cut in an SDF.
SDF_STEP = 1e-4  # s
# Largest gap of a loop, in shares of the size of the design.
GAP = 1e-4


def of_class(text):
    """A mechanism of a class, at a pose without any symmetry."""
    rng = np.random.default_rng(6)
    pose = BOX.sample(1, rng=rng)[0]
    return random_design(gsp.catalogue.mechanism(text), rng).replace(home=pose)


CLASSES = ("D1^6", "D1^2 D2^2 D3 A1", "D2 D4^3 A1^2", "D1 D3^2 A1^3")
DESIGNS = {name: gsp.catalogue.design(name) for name in NAMES} | {
    text: of_class(text) for text in CLASSES
}
DESIGNS["sliders, crank, D1, D4 A1"] = driven.of_five_legs()
HELD = campaign.some(DESIGNS, 3)
SECONDS = campaign.count(1, 10) / 10


def size(design):
    """Of a design, in metres."""
    return design.rms_radius * METRES_PER_UNIT.get(design.unit, 1.0)


def written(tmp_path, design, **options):
    tree = to_urdf(design, design.home, **options)
    path = tmp_path / "model.urdf"
    path.write_text(tree.text)
    return tree, str(path)


@pytest.mark.parametrize("name", HELD)
def test_mujoco(name):
    design = DESIGNS[name]
    assert simulate(design, design.home, duration=SECONDS).gap < GAP * size(design)


def test_mujoco_and_pinocchio_hold_the_weights_by_the_forces_of_gsp():
    """With a payload, and without stiffness of servos: by balance of generalised forces."""
    solids = Solids(platform_mass=25.0)
    for name, given in DESIGNS.items():
        design = given.scaled(METRES_PER_UNIT.get(given.unit, 1.0)).replace(unit="m")
        weights = masses(design, design.home, solids)
        forces = gsp.statics.holding_forces(design, design.home, weights)
        close = 1e-6 * np.abs(forces).max()
        for held in (held_by_mujoco(design, solids), held_by_pinocchio(design, solids)):
            np.testing.assert_allclose(held, forces, atol=close, err_msg=name)


def holding(bias, columns, rows):
    """Actuator forces that balance a bias together with the forces of the loops."""
    matrix = np.concatenate((np.eye(len(bias))[:, columns], rows.T), axis=1)
    found = np.linalg.lstsq(matrix, bias, rcond=1e-12)[0]
    np.testing.assert_allclose(matrix @ found, bias, atol=1e-9 * np.abs(bias).max())
    return found[: len(columns)]


def held_by_mujoco(design, solids):
    model = mujoco.MjModel.from_xml_string(to_mjcf(design, design.home, solids))
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    columns = [model.joint(joint).dofadr[0] for joint in design.joint_names]
    return holding(data.qfrc_bias, columns, data.efc_J.reshape(-1, model.nv))


def held_by_pinocchio(design, solids):
    model, loops, q = to_pinocchio(design, design.home, solids)
    data = model.createData()
    bias = pin.computeGeneralizedGravity(model, data, q)
    pin.computeJointJacobians(model, data, q)
    pairs = pin.StdVec_RigidConstraintData()
    models = pin.StdVec_RigidConstraintModel()
    for loop in loops:
        models.append(loop)
        pairs.append(loop.createData())
    pin.initConstraintDynamics(model, data, models, pairs)
    rows = pin.getConstraintsJacobian(model, data, models, pairs)
    columns = [model.joints[model.getJointId(joint)].idx_v for joint in design.joint_names]
    return holding(np.array(bias), columns, np.array(rows))


@pytest.mark.parametrize("name", DESIGNS)
def test_yourdfpy(name, tmp_path):
    program = pytest.importorskip("yourdfpy", reason="yourdfpy is not installed")
    tree, path = written(tmp_path, DESIGNS[name])
    model = program.URDF.load(path)
    assert model.validate()
    for loop in tree.loops:
        place = np.eye(4)
        place[:3, :3], place[:3, 3] = loop.placement.rotation, loop.placement.position
        there = model.get_transform(loop.link_2) @ place
        np.testing.assert_allclose(model.get_transform(loop.link_1), there, atol=1e-9)


@pytest.mark.parametrize("floating", [True, False])
@pytest.mark.parametrize("name", HELD)
def test_drake(name, floating, tmp_path):
    """The tags in the file close the loops. The actuators are locked."""
    drake = pytest.importorskip("pydrake.all", reason="drake is not installed")
    design = DESIGNS[name]
    tree, path = written(tmp_path, design, floating=floating)
    builder = drake.DiagramBuilder()
    plant, _ = drake.AddMultibodyPlantSceneGraph(builder, STEP)
    drake.Parser(plant).AddModels(path)
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("base"))
    assert plant.num_constraints() == sum(len(loop.points) for loop in tree.loops)
    plant.Finalize()
    simulator = drake.Simulator(builder.Build())
    context = plant.GetMyContextFromRoot(simulator.get_mutable_context())
    if floating:
        platform = plant.GetBodyByName("platform")
        plant.SetFreeBodyPose(context, platform, placed(drake, tree.platform))
    for joint in design.joint_names:
        plant.GetJointByName(joint).Lock(context)

    def gap():
        gaps = []
        for loop in tree.loops:
            one, two = (
                plant.GetBodyByName(link).EvalPoseInWorld(context)
                for link in (loop.link_1, loop.link_2)
            )
            apart = one.inverse() @ (two @ placed(drake, loop.placement))
            gaps.append(apart.translation())
        return float(np.abs(gaps).max())

    assert gap() < 1e-12
    assert not touching(plant, context)
    simulator.AdvanceTo(SECONDS)
    assert gap() < GAP * size(design)
    place = plant.GetBodyByName("platform").EvalPoseInWorld(context).translation()
    np.testing.assert_allclose(place, tree.platform.position, atol=1e-3 * size(design))


def touching(plant, context):
    """Whether links are in contact, which have shapes for it."""
    assert plant.GetCollisionGeometriesForBody(plant.GetBodyByName("leg1_upper"))
    return plant.get_geometry_query_input_port().Eval(context).HasCollisions()


def placed(drake, pose):
    return drake.RigidTransform(drake.RotationMatrix(pose.rotation), pose.position)


@pytest.mark.parametrize("name", HELD)
def test_pybullet(name, tmp_path):
    """The actuators are position controlled, and the other joints free."""
    p = pytest.importorskip("pybullet", reason="pybullet is not installed")
    tree, path = written(tmp_path, DESIGNS[name], floating=False)
    p.connect(p.DIRECT)
    try:
        assert held_by_bullet(p, tree, path) < GAP * size(DESIGNS[name])
    finally:
        p.disconnect()


def held_by_bullet(p, tree, path):
    p.setGravity(0, 0, -9.81)
    p.setPhysicsEngineParameter(
        numSolverIterations=200, fixedTimeStep=BULLET_STEP, solverResidualThreshold=0
    )
    body = p.loadURDF(path, useFixedBase=True, flags=p.URDF_USE_INERTIA_FROM_FILE)
    infos = [p.getJointInfo(body, i) for i in range(p.getNumJoints(body))]
    links = {info[12].decode(): i for i, info in enumerate(infos)}
    for i, info in enumerate(infos):
        p.setJointMotorControl2(body, i, p.VELOCITY_CONTROL, force=0)
        if info[1].decode() in tree.joints:
            p.setJointMotorControl2(body, i, p.POSITION_CONTROL, targetPosition=0, force=1e5)
    for loop in tree.loops:
        one, two = links[loop.link_1], links[loop.link_2]
        own = p.invertTransform(*p.getDynamicsInfo(body, one)[3:5])
        at, turn = loop.placement.position.tolist(), loop.placement.quaternion.tolist()
        other = p.multiplyTransforms(
            *p.invertTransform(*p.getDynamicsInfo(body, two)[3:5]), at, turn
        )
        p.createConstraint(
            body, one, body, two, p.JOINT_FIXED, [0, 0, 0], own[0], other[0], own[1], other[1]
        )
    for _ in range(round(SECONDS / BULLET_STEP)):
        p.stepSimulation()
    gaps = []
    for loop in tree.loops:
        one, two = (
            p.getLinkState(body, links[link], computeForwardKinematics=True)[4:6]
            for link in (loop.link_1, loop.link_2)
        )
        at, turn = loop.placement.position.tolist(), loop.placement.quaternion.tolist()
        gaps.append(np.subtract(one[0], p.multiplyTransforms(*two, at, turn)[0]))
    return float(np.abs(gaps).max())


@functools.cache
def gazebo():
    """Return the command of Gazebo that has sdformat, or None."""
    for program in filter(None, map(shutil.which, ("gz", "ign"))):
        known = subprocess.run([program, "--commands"], capture_output=True, text=True, check=False)
        if "sdf" in known.stdout.split():
            return program
    return None


def sdformat(*arguments):
    """The output of Gazebo's reader, which must be silent about mistakes and what it leaves out."""
    if gazebo() is None:
        pytest.skip("sdformat is not installed")
    command = [gazebo(), "sdf", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert not done.returncode, done.stderr
    for mistake in ("Error Code", "Warning"):
        assert mistake not in done.stderr
    return done.stdout


@pytest.mark.parametrize("name", HELD)
def test_sdformat(name, tmp_path):
    """The reader of Gazebo finds no mistake, nor in the frames and the joints."""
    path = tmp_path / "model.sdf"
    path.write_text(to_sdf(DESIGNS[name], DESIGNS[name].home).text)
    assert sdformat("--check", path).split() == ["Valid."]


@pytest.mark.parametrize("floating", [True, False])
@pytest.mark.parametrize("name", campaign.some(DESIGNS, 1))
def test_gazebo_converts_the_urdf_with_its_loops(name, floating, tmp_path):
    """No link is left out, the loops are joints, and the platform is at its place."""
    # Gazebo leaves out links of 1e-6 kg and less: docs/bridges.md.
    heavy = Solids(density=2e4) if size(DESIGNS[name]) < 0.05 else None
    tree, path = written(tmp_path, DESIGNS[name], floating=floating, solids=heavy)
    assert sdformat("--check", path).split() == ["Valid."]
    urdf = ElementTree.fromstring(tree.text)
    model = ElementTree.fromstring(sdformat("-p", path)).find("model")
    links = [{link.get("name") for link in root.findall("link")} for root in (urdf, model)]
    assert links[0] == links[1]
    loops = [joint for joint in model.findall("joint") if joint.get("name").endswith("_loop")]
    ends = [(joint.find("parent").text, joint.find("child").text) for joint in loops]
    assert ends == [(loop.link_1, loop.link_2) for loop in tree.loops]
    there = placed_by_gazebo(model, "platform")
    # The text of the conversion has a few digits less than that of the URDF.
    np.testing.assert_allclose(there.translation, tree.platform.position, atol=1e-6, rtol=1e-6)
    np.testing.assert_allclose(there.rotation, tree.platform.rotation, atol=1e-6)


def placed_by_gazebo(model, name):
    """Where a link, joint or frame is, through those that its pose is relative to."""
    found = pin.SE3.Identity()
    while name:
        node = model.find(f"*[@name='{name}']")
        pose = node.find("pose")
        numbers = np.zeros(6) if pose is None else np.array(pose.text.split(), dtype=float)
        found = pin.SE3(pin.rpy.rpyToMatrix(numbers[3:]), numbers[:3]) * found
        name = node.get("attached_to") if pose is None else pose.get("relative_to", "")
        name = name or node.get("attached_to", "")
    return found


@pytest.mark.parametrize("name", HELD)
def test_drake_holds_the_sdf_with_its_loops_as_constraints(name, caplog):
    """The joints whose child is the platform are cut off the text, and added as points in it."""
    drake = pytest.importorskip("pydrake.all", reason="drake is not installed")
    design = DESIGNS[name]
    text, closings = cut(to_sdf(design, design.home).text)
    builder = drake.DiagramBuilder()
    plant, _ = drake.AddMultibodyPlantSceneGraph(builder, SDF_STEP)
    with caplog.at_level(logging.WARNING):
        drake.Parser(plant).AddModelsFromString(text, "sdf")
    assert not caplog.records
    for parent, child, place in closed(drake, text, closings, 0.3 * size(design)):
        bodies = [plant.GetBodyByName(link) for link in ("platform", parent)]
        plant.AddBallConstraint(bodies[0], child, bodies[1], place)
    plant.Finalize()
    simulator = drake.Simulator(builder.Build())
    context = plant.GetMyContextFromRoot(simulator.get_mutable_context())
    for joint in design.joint_names:
        plant.GetJointByName(joint).Lock(context)
    assert not touching(plant, context)
    simulator.AdvanceTo(SECONDS)
    for parent, child, place in closed(drake, text, closings, 0.0):
        one, two = (
            plant.GetBodyByName(link).EvalPoseInWorld(context) for link in ("platform", parent)
        )
        assert np.abs(one @ child - two @ place).max() < GAP * size(design)


def cut(text):
    """An SDF whose platform is free, and the joints that held it."""
    ElementTree.register_namespace("drake", NAMESPACE)  # keeps the prefix, as Drake demands it
    root = ElementTree.fromstring(text)
    model = root.find("model")
    closings = [joint for joint in model.iter("joint") if joint.find("child").text == "platform"]
    assert len(closings) > 3
    for joint in closings:
        model.remove(joint)
    return ElementTree.tostring(root, encoding="unicode"), closings


def closed(drake, text, closings, reach):
    """Per point that is common to a link and the platform: the link, and the point in both.

    These are the place of a ball, and two points on the axis of a turn, `reach` from its place.
    """
    poses = {link.get("name"): frame(drake, link) for link in ElementTree.fromstring(text)[0]}
    for joint in closings:
        parent, at = joint.find("parent").text, frame(drake, joint)
        axis = joint.find("axis/xyz")
        line = np.zeros(3) if axis is None else np.array(axis.text.split(), dtype=float)
        for share in (-reach, reach) if line.any() else (0.0,):
            point = at @ (share * line)
            place = poses[parent].inverse() @ poses["platform"] @ point
            yield parent, point, place


def frame(drake, node):
    pose = node.find("pose")
    numbers = np.zeros(6) if pose is None else np.array(pose.text.split(), dtype=float)
    return drake.RigidTransform(drake.RollPitchYaw(numbers[3:]), numbers[:3])


def test_drake_refuses_loops_of_sdf_with_its_reason(tmp_path):
    """Why the docs send users of Drake to URDF; a version that reads loops makes this fail."""
    drake = pytest.importorskip("pydrake.all", reason="drake is not installed")
    path = tmp_path / "model.sdf"
    design = DESIGNS["dehaeze-general"]
    path.write_text(to_sdf(design, design.home).text)
    plant = drake.MultibodyPlant(STEP)
    drake.Parser(plant).AddModels(str(path))
    with pytest.raises(RuntimeError, match="loops"):
        plant.Finalize()
