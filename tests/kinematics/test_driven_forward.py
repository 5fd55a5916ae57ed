"""Forward kinematics of designs with legs that are driven at the base."""

import numpy as np
import pytest

import gsp
from tests import campaign, driven

CASES = [
    *[("compiled", name) for name in driven.DESIGNS],
    *[("numpy", name) for name in campaign.some(driven.DESIGNS, 3)],
]


@pytest.mark.parametrize(("backend", "name"), CASES)
def test_poses_are_found_from_their_joint_values(backend, name):
    design = driven.DESIGNS[name]
    poses = driven.near_home(design, campaign.count(3, 6))
    found = gsp.forward(design, design.at(poses).joints, design.home, backend=backend)
    assert found.converged.all()
    size = design.rms_radius
    assert np.abs(found.pose.position - poses.position).max() < 1e-9 * size
    assert np.abs(found.pose.rotation - poses.rotation).max() < 1e-9
    assert found.residual.max() < 1e-12


def test_a_pose_on_another_branch_is_not_a_solution():
    """The tips are the same: the joint values belong to the branches of the other design."""
    one, other = driven.hexaglide(), driven.hexaglide(-1)
    joints = one.at(one.home).joints
    assert gsp.forward(one, joints, one.home).converged
    found = gsp.forward(other, joints, one.home)
    assert found.status == "not converged"
    assert np.isnan(found.pose.position).all()


def test_turns_of_a_crank_by_a_full_circle_change_nothing():
    design = driven.rotary()
    joints = design.at(design.home).joints
    found = gsp.forward(design, joints + 2 * np.pi * np.array([1, -1, 2, 0, 0, 1]), design.home)
    assert np.allclose(found.pose.position, design.home.position, rtol=0, atol=1e-9)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e300])
def test_joint_values_that_are_no_numbers_are_undefined(value):
    design = driven.hexaglide()
    joints = np.stack([design.at(design.home).joints] * 2)
    joints[1, 2] = value
    found = gsp.forward(design, joints, design.home)
    assert found.status.tolist() == ["converged", "undefined"]
    assert np.isnan(found.pose.position[1]).all()


def test_joint_values_out_of_reach_do_not_converge():
    design = driven.hexaglide()
    joints = design.at(design.home).joints
    joints = joints + np.array([9.0, 0, 0, 0, 0, 0])
    assert not gsp.forward(design, joints, design.home).converged
