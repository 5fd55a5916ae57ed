"""Forward kinematics of designs with legs that are driven at the base.

Locked drives hold the tips of their rods, so the pose is that of a design whose driven legs are
D1 legs between tips and platform anchors, with the lengths of the rods.
"""

from __future__ import annotations

import numpy as np

from gsp.arguments import LARGEST_NUMBER
from gsp.geometry.vectors import Array, norm
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


def on_branches(design: Design, joints: Array, position: Array, rotation: Array) -> bool:
    """Whether all drives are on their branches at a pose with joint values (n,).

    Parameters
    ----------
    design : Design
    joints : (n,) array [unit of the design, rad]
    position, rotation : (3,) and (3, 3) arrays
    """
    cosines: list[float] = []
    for row, (leg, _) in enumerate(design.rows):
        drive = design.drives[leg]
        if drive is not None:
            line = design.base_directions[leg]
            tip, slope = TIPS[type(drive)](drive, design.base_points[leg], line, joints[row])
            rod = position + rotation @ design.platform_points[leg] - tip
            cosines.append(drive.branch * float(rod @ slope) / float(norm(rod) * norm(slope)))
    return min(cosines) > -BRANCH_COSINE
