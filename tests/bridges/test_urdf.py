"""The URDF tree loads in Pinocchio, and closes at its listed loops."""

import json
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin
import pytest

import gsp
from gsp.bridges import Drives, Solids, to_pinocchio, to_sdf, to_urdf
from gsp.bridges.proof import BOX, random_design
from gsp.errors import InvalidInput
from gsp.geometry.pose import Pose

TWO = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")


def configured(tree):
    """The model, and the configuration in which it starts."""
    model = pin.buildModelFromXML(tree.text)
    return model, pin.neutral(model)


def gaps(tree):
    model, q = configured(tree)
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    for loop in tree.loops:
        first = data.oMf[model.getFrameId(loop.link_1)]
        second = data.oMf[model.getFrameId(loop.link_2)] * loop.placement.to_se3()
        yield np.abs(first.actInv(second).homogeneous - np.eye(4)).max()


@pytest.mark.parametrize("mechanism", gsp.catalogue.mechanisms()[::20], ids=str)
def test_the_listed_loops_are_closed_where_all_joints_are_zero(mechanism):
    rng = np.random.default_rng(5)
    design, pose = random_design(mechanism, rng), BOX.sample(1, rng=rng)[0]
    tree = to_urdf(design, pose)
    assert len(tree.loops) == design.n_legs
    assert max(gaps(tree)) < 1e-12
    assert max(gaps(to_urdf(design, pose, floating=False))) < 1e-12
    values = [tree.joints[name] for name in design.joint_names]
    np.testing.assert_allclose(values, design.at(pose).joints, rtol=1e-12)


@pytest.mark.parametrize("direction", np.eye(3))
def test_legs_along_an_axis_close_too(direction):
    """Where three turns stand for a ball, a leg may lie in the worst direction for them."""
    ring = np.array([[np.cos(a), np.sin(a), 0.1 * a] for a in np.arange(6)])
    design = gsp.Design(["D1"] * 6, ring, ring)
    assert max(gaps(to_urdf(design, Pose(direction)))) < 1e-7


def test_lengths_are_metres_and_the_links_have_mass():
    tree = to_urdf(TWO, TWO.home, Solids(platform_mass=1.5, link_mass=0.1))
    model, q = configured(tree)
    np.testing.assert_allclose(tree.platform.position, TWO.home.position / 1000)
    scale = np.where([n.startswith("theta") for n in TWO.joint_names], 1.0, 1e-3)
    values = [tree.joints[name] for name in TWO.joint_names]
    np.testing.assert_allclose(values, TWO.at(TWO.home).joints * scale, rtol=1e-12)
    joint = model.getJointId("base_to_platform")
    assert model.inertias[joint].mass == pytest.approx(1.5)
    inertia = model.inertias[joint].inertia
    assert (np.linalg.eigvalsh(inertia) > 0).all()
    assert model.nq == q.size


@pytest.mark.parametrize("export", [to_urdf, to_sdf])
def test_shapes_are_seen_and_touched(export):
    root = ElementTree.fromstring(export(TWO, TWO.home).text)
    for link in root.iter("link"):
        shapes = {
            purpose: [
                [(part.tag, part.text, part.attrib) for part in shape.iter() if part is not shape]
                for shape in link.iterfind(purpose)
            ]
            for purpose in ("visual", "collision")
        }
        assert shapes["visual"]
        assert shapes["visual"] == shapes["collision"]


def limits_of(model, name):
    at = model.joints[model.getJointId(name)].idx_q
    return model.lowerPositionLimit[at], model.upperPositionLimit[at]


def test_strokes_are_limits_about_the_pose():
    n = len(TWO.joint_names)
    strokes = np.full((n, 2), np.nan)
    strokes[0], strokes[-1] = [10, 300], [0.1, 3.0]
    first, *_, last = TWO.joint_names
    tree = to_urdf(TWO.replace(strokes=strokes), TWO.home)
    model = pin.buildModelFromXML(tree.text)
    at_zero = tree.joints
    assert limits_of(model, first) == pytest.approx(np.array([0.01, 0.3]) - at_zero[first])
    assert limits_of(model, last) == pytest.approx(np.array([0.1, 3.0]) - at_zero[last])
    assert limits_of(model, "d2") == (-1e9, 1e9)


def test_greatest_forces_and_speeds_are_limits():
    n = len(TWO.joint_names)
    drives = Drives(efforts=100.0 + np.arange(n), speeds=0.5)
    model = pin.buildModelFromXML(to_urdf(TWO, TWO.home, drives=drives).text)
    machine = to_pinocchio(TWO, TWO.home, drives=drives).model
    for i, (name, angular) in enumerate(zip(TWO.joint_names, TWO.angular, strict=True)):
        at = model.joints[model.getJointId(name)].idx_v
        assert (model.effortLimit[at], model.velocityLimit[at]) == (100.0 + i, 0.5)
        own = machine.joints[machine.getJointId(name)].idx_v  # in mm: N = 1e3 kg mm/s²
        assert machine.effortLimit[own] == pytest.approx((100.0 + i) * (1e6 if angular else 1e3))
        assert machine.velocityLimit[own] == pytest.approx(0.5 * (1.0 if angular else 1e3))
    with pytest.raises(InvalidInput, match=r"efforts: expected one number, or shape \(6,\)"):
        to_urdf(TWO, TWO.home, drives=Drives(efforts=[1.0, 2.0]))
    with pytest.raises(InvalidInput, match=r"received shape \(1,\)"):
        to_urdf(TWO, TWO.home, drives=Drives(efforts=[1.0]))


def test_what_is_beside_reads_back():
    tree = to_urdf(TWO, TWO.home)
    beside = json.loads(tree.beside())
    assert beside["joints_at_zero"] == dict(tree.joints)
    assert [loop["link_1"] for loop in beside["loops"]] == [loop.link_1 for loop in tree.loops]
    platform = Pose.from_quaternion(
        **{
            "position": beside["platform_at_zero"]["position"],
            "xyzw": beside["platform_at_zero"]["rotation"],
        }
    )
    np.testing.assert_allclose(platform.rotation, TWO.home.rotation, atol=1e-15)
