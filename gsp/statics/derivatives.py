"""Derivatives of the rows of the Jacobian along the coordinates of a twist."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array, skew
from gsp.model.posture import Posture
from gsp.model.posture.assembly import parts, put

# Imaginary step of the complex-step derivative: its square is below the rounding of 1.
STEP = 1e-30


def row_derivatives(posture: Posture) -> Array:
    """Return ∂J/∂x by steps of x = (v, ω) as in `Pose.moved`, shape (..., n, 6, 6).

    The last axis is that of x. Complex steps of the formulas of the legs: no digit is lost. NaN
    where a leg is undefined.

    Parameters
    ----------
    posture : Posture of batch shape (...)
    """
    pose, design = posture.pose, posture.design
    n, count = len(posture.joint_names), pose.size
    position, rotation = pose.position.reshape(-1, 3), pose.rotation.reshape(-1, 3, 3)
    found = np.empty((count, n, 6, 6))
    for k, axis in enumerate(np.tile(np.eye(3), (2, 1))):
        shift, turn = (axis, 0.0 * axis) if k < 3 else (0.0 * axis, axis)
        moved = position + 1j * STEP * shift, rotation + 1j * STEP * (skew(turn) @ rotation)
        rows = np.empty((count, n, 6), dtype=np.complex128)
        with np.errstate(all="ignore"):
            for poses, group, _, segment, undefined in parts(design.groups, *moved):
                for constraint, places in zip(group.kind.constraints, group.rows, strict=True):
                    put(rows, poses, places, constraint.row(segment, 1.0), undefined)
        found[..., k] = rows.imag / STEP
    return found.reshape(*posture.shape, n, 6, 6)
