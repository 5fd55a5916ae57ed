"""log |det J| and its gradient against central differences, for every kind of constraint."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp.determinant.search.gradient import log_determinant
from gsp.geometry.frames import exp3
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import angle_axes, rotation_from_angles

MECHANISMS = [
    "D1^6", "D2^6", "D3^6", "D4^6", "D1^5 A1", "D1 D2 D3 D4 A1^2", "D4^3 A1^3", "D1^3 A1^3",
    "D2^3 D3^3",
]  # fmt: skip


def general_design(legs, seed):
    rng = np.random.default_rng(seed)
    n = len(legs)
    return gsp.Design(legs, *rng.normal(size=(4, n, 3)))


def central_differences(design, pose, step=1e-6):
    twists = np.vstack((np.eye(6), -np.eye(6))) * step
    position = pose.position[..., None, :] + twists[:, :3]
    rotation = exp3(twists[:, 3:]) @ pose.rotation[..., None, :, :]
    up, down = np.split(log_determinant(design, Pose(position, rotation))[0], 2, axis=-1)
    return (up - down) / (2 * step)


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (2, 0)])
@pytest.mark.parametrize("name", MECHANISMS)
def test_gradient_is_that_of_central_differences(name, shape):
    legs = [leg.name for leg in gsp.catalogue.mechanism(name).legs]
    design = general_design(legs, seed=len(name))
    rng = np.random.default_rng(7)
    pose = Pose.from_rpy(rng.normal(size=(*shape, 3)), rng.normal(size=(*shape, 3)))
    value, gradient = log_determinant(design, pose)
    assert value.shape == shape
    assert gradient.shape == (*shape, 6)
    np.testing.assert_allclose(
        np.exp(value), gsp.indices.manipulability(design.at(pose)), rtol=1e-11
    )
    differences = central_differences(design, pose)
    error = np.linalg.norm(gradient - differences, axis=-1)
    assert (error < 1e-6 * (1 + np.linalg.norm(gradient, axis=-1))).all()


def test_gradient_of_all_195_mechanisms():
    pose = Pose.from_rpy([0.3, -0.2, 0.9], [0.4, 0.5, -0.6])
    for i, mechanism in enumerate(gsp.catalogue.mechanisms()):
        design = general_design([leg.name for leg in mechanism.legs], seed=i)
        _, gradient = log_determinant(design, pose)
        differences = central_differences(design, pose)
        assert np.linalg.norm(gradient - differences) < 2e-5 * (1 + np.linalg.norm(gradient))


def test_gradient_of_a_redundant_design():
    design = general_design(["D1"] * 5 + ["D3", "D2", "D4 A1"], seed=2)
    pose = Pose.from_rpy([0.3, -0.2, 0.9], [0.4, 0.5, -0.6])
    value, gradient = log_determinant(design, pose)
    assert np.exp(value) == pytest.approx(gsp.indices.manipulability(design.at(pose)), rel=1e-12)
    np.testing.assert_allclose(gradient, central_differences(design, pose), atol=1e-7)


def test_undefined_and_singular_poses_are_minus_infinity():
    ring = np.c_[np.cos(np.arange(6)), np.sin(np.arange(6)), np.zeros(6)]
    design = gsp.Design(["D1"] * 6, ring, ring)
    value, gradient = log_determinant(design, Pose([[0.0, 0.0, 0.0], [0.3, 0.2, 0.0], [0, 0, 1.0]]))
    assert value[0] == -np.inf  # every leg has length zero
    assert value[1] == -np.inf  # all legs in one plane
    assert not gradient[:2].any()


@pytest.mark.parametrize("order", ["rpy", "approach-roll", "ZYX", "zxz"])
def test_angle_axes_are_the_rates_of_the_rotation(order):
    angles = np.array([[0.3, -0.4, 0.5], [1.2, 0.7, -2.0]])
    axes = angle_axes(angles, order)
    for i, step in enumerate(np.eye(3) * 1e-6):
        up, down = (rotation_from_angles(angles + s, order) for s in (step, -step))
        spin = (up - down) / 2e-6 @ np.swapaxes(rotation_from_angles(angles, order), -1, -2)
        vector = np.stack((spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]), axis=-1)
        np.testing.assert_allclose(axes[..., i], vector, atol=1e-9)
