"""Random designs and poses, and motions of them, for tests."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

import gsp
from gsp.model.legs import LEGS

LEG_NAMES = tuple(leg.name for leg in LEGS)


def turn(rotvec):
    """Rotation matrices of rotation vectors (..., 3)."""
    rotvec = np.asarray(rotvec, dtype=float)
    return Rotation.from_rotvec(rotvec.reshape(-1, 3)).as_matrix().reshape(*rotvec.shape, 3)


def random_design(rng, legs, **given):
    """A design of general geometry: anchors in unit cubes, lines in all directions."""
    n = len(legs)
    return gsp.Design(
        legs,
        base_points=rng.uniform(-1.0, 1.0, (n, 3)),
        platform_points=rng.uniform(-0.7, 0.7, (n, 3)),
        base_directions=rng.standard_normal((n, 3)),
        platform_directions=rng.standard_normal((n, 3)),
        **given,
    )


def random_pose(rng, shape=()):
    """Poses about 1.5 above the base, turned by up to about a radian."""
    position = rng.uniform(-0.3, 0.3, (*shape, 3)) + np.array([0.0, 0.0, 1.5])
    return gsp.Pose(position, turn(rng.uniform(-0.6, 0.6, (*shape, 3))))


def moved(pose, twist, step):
    """The pose after the motion step·(v, ω): p + step v, exp(step ω) R."""
    v, w = np.split(np.asarray(twist, dtype=float), 2, axis=-1)
    return gsp.Pose(pose.position + step * v, turn(step * w) @ pose.rotation)


def derivative(function, pose, h=1e-4):
    """Gradient of function(pose) for the twist (v, ω): a last axis of 6 is added.

    Central differences of fourth order: the error is about h⁴ and 1e-16/h.
    """
    columns = []
    for twist in np.eye(6):
        near = function(moved(pose, twist, h)) - function(moved(pose, twist, -h))
        far = function(moved(pose, twist, 2 * h)) - function(moved(pose, twist, -2 * h))
        columns.append((8.0 * near - far) / (12.0 * h))
    return np.stack(columns, axis=-1)
