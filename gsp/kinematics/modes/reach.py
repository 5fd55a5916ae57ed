"""Joint values that no pose can have."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array, norm
from gsp.kinematics.modes.equations import Layout
from gsp.kinematics.modes.forms import NUMBER
from gsp.model.design import Design

# By how much a side may exceed the sum of the others, as a share: far above the rounding of both.
SIDES_ROUNDING = 1e-12


def contradict(design: Design, joints: Array) -> bool:
    """Whether two joint values contradict each other, whatever the pose.

    The anchors of two legs are the corners of a quadrilateral, of which no side is longer than the
    other three together. Two sides are distances of anchors of base and platform. The other two are
    joint values of D1; one may be a distance from a line instead, as this is no longer than that
    from the anchor on the line.

    Parameters
    ----------
    design : Design
        With six actuators.
    joints : (6,) array [unit of the design, rad]

    Returns
    -------
    bool
        True is proven, for the dimensions and joint values as they are given. False is not: most
        joint values that no pose has contradict each other in another way.
    """
    layout = Layout.of([leg.name for leg in design.legs])
    sides = [
        norm(points[layout.legs, None] - points[layout.legs])
        for points in (design.base_points, design.platform_points)
    ]
    base, platform = sides
    one, other = joints[:, None], joints
    from_point = layout.kinds == NUMBER["D1"]
    both = from_point[:, None] & from_point
    with np.errstate(over="ignore"):
        too_long = _exceeds(one, other + base + platform) & ~layout.angular[:, None] & from_point
        apart = _exceeds(base, one + other + platform) | _exceeds(platform, one + other + base)
    return bool((too_long | (apart & both)).any())


def _exceeds(side: Array, others: Array) -> np.ndarray:
    return np.asarray(side > others * (1.0 + SIDES_ROUNDING))
