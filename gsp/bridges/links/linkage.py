"""The links and joints of a mechanism, as all exports use them.

Each leg is a chain of three joints from a frame on the base to a frame on the platform. In the
frame of a link, x lies along the line of the leg's base or platform joint (if it is one), z along
the leg, so that every joint turns about or slides along x or z. Joints of legs that change their
own length are at the origin of the link below. Of a leg that is driven at the base the first joint
is that of the drive, the second is the ball at the tip of the carriage or the crank, and the third
at the end of the rod. The chain depends on the design alone; the pose determines the values of the
joints, and the side of its base line on which a CCC leg is.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from gsp.bridges.links.motions import Chain, Kind, Motion, X, Z
from gsp.checks import check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, dot, perpendicular, unit
from gsp.model.design import Design
from gsp.model.drives import Drive
from gsp.model.legs import Leg
from gsp.model.posture import Posture
from gsp.model.rods import TIPS


def linkage(design: Design, pose: Pose) -> tuple[Chain, ...]:
    """Return the chains of all legs at a pose.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (), a single pose

    Returns
    -------
    tuple of Chain

    Raises
    ------
    UndefinedPosture
        If a leg is not defined there, or one of its joint axes has no direction.
    InvalidInput
        If `pose` is a batch, or the arguments have other types.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    >>> [motion.name for motion in linkage(d, d.home)[3].motions]
    ['leg4_base_slide', 'leg4_base_turn', 'd4', 'theta4', 'leg4_platform_slide', \
'leg4_platform_turn']
    """
    check_type("design", design, Design)
    posture = design.at(pose)
    if pose.shape:
        raise InvalidInput(expected("pose", "a single pose", f"a batch of shape {pose.shape}"))
    posture.check_defined()
    return tuple(_chain(posture, i) for i in range(design.n_legs))


def _chain(posture: Posture, i: int) -> Chain:
    leg, design = posture.design.legs[i], posture.design
    foot = Pose(design.base_points[i], _frame(design.base_directions[i]))
    head = Pose(design.platform_points[i], _frame(design.platform_directions[i]))
    make = _telescope if leg.drive is None else _driven
    base, middle, platform = make(posture, i, foot, posture.pose.rotation @ head.rotation)
    return Chain(
        leg=leg,
        name=f"leg{i + 1}",
        foot=foot,
        head=head,
        base=base,
        middle=middle,
        platform=platform,
        length=float(posture.segments.length[i]),
    )


Joints = tuple[tuple[Motion, ...], tuple[Motion, ...], tuple[Motion, ...]]


def _telescope(posture: Posture, i: int, foot: Pose, end: Array) -> Joints:
    """Make the joints of a leg that changes its own length; `end` has the axes of its head."""
    leg, name, design = posture.design.legs[i], f"leg{i + 1}", posture.design
    lines, segments = posture.lines, posture.segments
    s, t, length = lines.s[i], lines.t[i], float(segments.length[i])
    lower, upper, along = _link_axes(leg, segments.direction[i], s, t)
    above = segments.arm[i] - lines.arm[i]  # from platform anchor to platform foot
    below = lines.d[i] + above - segments.along[i]
    return (
        _end_joint(f"{name}_base", leg.base_line, foot.rotation, lower, X, dot(below, s)),
        _middle_joint(design, i, along, length, lower, upper),
        _end_joint(f"{name}_platform", leg.platform_line, upper, end, -X, dot(above, t)),
    )


def _driven(posture: Posture, i: int, foot: Pose, end: Array) -> Joints:
    """Make the joints of a leg that is driven at the base; `end` has the axes of its head.

    The frame of the carriage or crank is that of the foot, moved along or turned about its x axis.
    """
    design, name = posture.design, f"leg{i + 1}"
    drive = cast("Drive", design.drives[i])
    row = [leg for leg, _ in design.rows].index(i)
    kind: Kind = "slide" if design.legs[i].joints[0].kind == "P" else "turn"
    value, joint = float(posture.joints[row]), design.joint_names[row]
    moved = Motion(kind, joint, X, value, active=True)
    lower = foot.rotation @ moved.placement.rotation
    u = posture.segments.direction[i]
    rod = _axes(_level(u), u)
    tip, _ = TIPS[type(drive)](drive, np.zeros(3), design.base_directions[i], 0.0)
    return (
        (moved,),
        (_ball(f"{name}_tip", lower, rod, foot.rotation.T @ tip),),
        (_ball(f"{name}_platform", rod, end, Z * drive.rod),),
    )


def _link_axes(leg: Leg, u: Array, s: Array, t: Array) -> tuple[Array, Array, Array]:
    """Axes of the lower and the upper link in base axes, and u in both of them: ±z.

    A CCC leg has z along s × t, so that its turn from s to t is the angle in (0, π).
    """
    if leg.base_line and leg.platform_line:
        z = unit(cross(s, t))
        return _axes(s, z), _axes(t, z), Z * np.copysign(1.0, dot(u, z))
    line = s if leg.base_line else t if leg.platform_line else _level(u)
    return _axes(line, u), _axes(line, u), Z


def _end_joint(
    name: str, cylindrical: bool, below: Array, above: Array, slide: Array, value: Array
) -> tuple[Motion, ...]:
    if not cylindrical:
        return (_ball(name, below, above, np.zeros(3)),)
    turn = below.T @ above
    angle = float(np.arctan2(turn[2, 1] - turn[1, 2], turn[1, 1] + turn[2, 2]))
    return (
        Motion("slide", f"{name}_slide", slide, float(value)),
        Motion("turn", f"{name}_turn", X, angle),
    )


def _ball(name: str, below: Array, above: Array, offset: Array) -> Motion:
    return Motion("ball", name, np.zeros(3), below.T @ above, offset=offset)


def _middle_joint(
    design: Design, i: int, along: Array, length: float, lower: Array, upper: Array
) -> tuple[Motion, ...]:
    actuated = {
        row.constraint.quantity: name
        for row, name in zip(design.rows, design.joint_names, strict=True)
        if row.leg == i
    }
    name = actuated.get("distance", f"leg{i + 1}_slide")
    slide = Motion("slide", name, along, length, "distance" in actuated)
    if design.legs[i].joints[1].kind == "P":
        return (slide,)
    turn = lower.T @ upper
    angle = float(np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]))
    name = actuated.get("angle", f"leg{i + 1}_turn")
    return (slide, Motion("turn", name, Z, angle, "angle" in actuated))


def _axes(x: Array, z: Array) -> Array:
    """Rotation with columns x, z × x and (corrected in rounding) z."""
    y = unit(cross(z, x))
    return np.stack((x, y, cross(x, y)), axis=-1)


def _frame(line: Array) -> Array:
    """Axes of an anchor: x along its line; those of its body where it has no line."""
    return np.eye(3) if np.isnan(line).any() else _axes(line, perpendicular(line))


def _level(u: Array) -> Array:
    """Return a unit vector perpendicular to u and, if there is one, to the vertical."""
    level = cross(Z, u)
    return unit(level) if level.any() else X
