"""The chains of all legs lead from the base to the platform at every pose."""

import numpy as np
import pytest

import gsp
from gsp.bridges.links.linkage import linkage
from gsp.bridges.proof import BOX, random_design
from gsp.errors import InvalidInput, UndefinedPosture
from gsp.geometry.pose import Pose

MECHANISMS = gsp.catalogue.mechanisms()[::24]


def end_of(chain):
    place = chain.foot
    for motion in chain.motions:
        place = place.compose(motion.placement)
    return place


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=str)
def test_chains_lead_to_the_platform(mechanism):
    rng = np.random.default_rng(3)
    design, poses = random_design(mechanism, rng), BOX.sample(5, rng=rng)
    for pose in (poses[i] for i in range(5)):
        for chain in linkage(design, pose):
            end, head = end_of(chain), pose.compose(chain.head)
            np.testing.assert_allclose(end.position, head.position, atol=1e-12)
            np.testing.assert_allclose(end.rotation, head.rotation, atol=1e-12)


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=str)
def test_active_motions_are_the_joint_variables(mechanism):
    rng = np.random.default_rng(5)
    design, pose = random_design(mechanism, rng), BOX.sample(1, rng=rng)[0]
    active = [m for chain in linkage(design, pose) for m in chain.motions if m.active]
    assert tuple(m.name for m in active) == design.joint_names
    np.testing.assert_allclose([m.value for m in active], design.at(pose).joints, atol=1e-13)


def test_lines_that_meet_are_accepted():
    rng = np.random.default_rng(1)
    design = random_design(gsp.catalogue.mechanism("D4^6"), rng)
    pose = Pose([0.1, 0.2, 1.0])
    on_line = pose.position + design.platform_points[0] + 0.7 * design.platform_directions[0]
    design = design.replace(base_points=[on_line, *design.base_points[1:]])
    assert design.at(pose).joints[0] < 1e-12
    chain = linkage(design, pose)[0]
    head = pose.compose(chain.head)
    np.testing.assert_allclose(end_of(chain).position, head.position, atol=1e-12)
    np.testing.assert_allclose(end_of(chain).rotation, head.rotation, atol=1e-12)
    assert max(gsp.bridges.agreement(design, pose)) < 1e-9


RING = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6) * np.pi / 3])
UP = np.tile([0.0, 0.0, 1.0], (6, 1))


@pytest.mark.parametrize(
    ("leg", "position", "reason"),
    [
        ("D1", [0, 0, 0], "anchor points coincide"),
        ("D2", [0, 0, 1], "base point lies on the platform line"),
        ("D3", [0, 0, 1], "platform point lies on the base line"),
        ("D4", [1, 2, 3], "parallel"),
        ("A1", [1, 2, 3], "parallel"),
    ],
)
@pytest.mark.parametrize("bridge", ["to_pinocchio", "to_mjcf", "to_urdf"])
def test_a_degenerate_leg_is_named(bridge, leg, position, reason):
    design = gsp.Design([leg] * 6, RING, RING, UP, UP, name="mine")
    with pytest.raises(UndefinedPosture, match=f"1 .*mine.*{reason}"):
        getattr(gsp.bridges, bridge)(design, Pose(position))


@pytest.mark.parametrize("bridge", ["to_pinocchio", "to_mjcf", "to_urdf"])
def test_a_batch_of_poses_is_an_error(bridge):
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    with pytest.raises(InvalidInput, match="pose: expected a single pose"):
        getattr(gsp.bridges, bridge)(design, Pose(np.ones((2, 3))))
