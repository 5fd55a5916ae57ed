"""Legs that are driven at the base, for kinematics: with locked drives their rods are D1 legs."""

from __future__ import annotations

import numpy as np

from gsp.arguments import LARGEST_NUMBER
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask, dot, norm
from gsp.model.design import Design
from gsp.model.rods import TIPS

# By how much the cosine of rod and tip velocity may be on the other branch by rounding [1]: the
# square root of what a pose may be off by.
BRANCH_COSINE = 1e-6


def held(design: Design, joints: Array) -> tuple[Design, Array]:
    """Return the design whose D1 legs are the rods of locked drives, and its joint values (n,).

    Parameters
    ----------
    design : Design
    joints : (n,) array [unit of the design, rad]
        Finite.
    """
    points, values = design.base_points.copy(), joints.copy()
    legs: list[object] = list(design.legs)
    for row, (leg, constraint) in enumerate(design.rows):
        drive = design.drives[leg]
        if constraint.driven and drive is not None:
            line = design.base_directions[leg]
            points[leg] = TIPS[type(drive)](drive, points[leg], line, joints[row])[0]
            legs[leg], values[row] = "D1", drive.rod
    return design.replace(legs=legs, base_points=points, strokes=None), values


def usable(joints: Array) -> bool:
    """Whether a design can be held at joint values (n,): they are finite and not extreme."""
    return bool((np.abs(joints) <= LARGEST_NUMBER**0.5).all())


def scales_of_held(design: Design, joints: Array, pose: Pose) -> tuple[Array, Array]:
    """Return the scales of locked drives, and their cosines on the stated branches.

    Parameters
    ----------
    design : Design
    joints : (n,) array [unit of the design, rad]
    pose : Pose of batch shape (...)
        With these joint values, on any branches.

    Returns
    -------
    scales : (..., n) array [1, length]
        As `Posture.drive_scales`, with the signs of the branches that the drives are on.
    cosines : (..., n) array [1]
        Of the rod and the velocity of its tip, times the stated branch: negative on the other one.
        1 for joints that are not driven at the base.

    *Source: docs/drives.md; ours*
    """
    scales = np.ones((*pose.shape, len(design.rows)))
    cosines = scales.copy()
    for row, (leg, constraint) in enumerate(design.rows):
        drive = design.drives[leg]
        if constraint.driven and drive is not None:
            line = design.base_directions[leg]
            tip, slope = TIPS[type(drive)](drive, design.base_points[leg], line, joints[row])
            rod = pose.position + pose.rotation @ design.platform_points[leg] - tip
            scales[..., row] = dot(rod, np.broadcast_to(slope, rod.shape)) / norm(rod)
            cosines[..., row] = drive.branch * scales[..., row] / norm(slope)
    return scales, cosines


def on_branches(cosines: Array) -> Mask:
    """Whether all drives are on their branches, (...), from cosines (..., n) on these."""
    return np.asarray((cosines > -BRANCH_COSINE).all(axis=-1))
