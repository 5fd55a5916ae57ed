"""The links and joints of a mechanism, as all exports use them.

Each leg is a chain of three joints from a frame on the base to a frame on the platform. In the
frame of a link, x lies along the line of the leg's base or platform joint (if it is one), z along
the leg, so that every joint turns about or slides along x or z and no link has an offset. The
chain depends on the design alone; the pose determines the values of the joints, and the side of
its base line on which a CCC leg is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, dot, perpendicular, unit
from gsp.model.design import Design, check_undriven
from gsp.model.legs import Leg
from gsp.model.posture import Posture

X, Z = np.eye(3)[0], np.eye(3)[2]


@dataclass(frozen=True, eq=False)
class Motion:
    """One freedom of a joint, and its value at the pose.

    Attributes
    ----------
    kind : "ball", "slide" or "turn"
    name : str
        Name of the actuated joint ("d1", "theta4"), or of the passive one.
    axis : (3,) array
        Of a slide or a turn, in the frame of the link below.
    value : float [unit of the design, or rad], or (3, 3) array
        Displacement, angle, or for a ball the rotation of the link above in the link below.
    active : bool
        Whether an actuator drives it.
    """

    kind: Literal["ball", "slide", "turn"]
    name: str
    axis: Array
    value: float | Array
    active: bool = False

    @property
    def placement(self) -> Pose:
        """Frame above the joint in the frame below it."""
        if self.kind == "ball":
            return Pose(np.zeros(3), self.value)
        if self.kind == "slide":
            return Pose(self.axis * self.value)
        return Pose(np.zeros(3)).moved(np.concatenate((np.zeros(3), self.axis * self.value)))


@dataclass(frozen=True, eq=False, kw_only=True)
class Chain:
    """One leg: its joints between a frame on the base and a frame on the platform.

    Attributes
    ----------
    leg : Leg
    name : str
        "leg1", "leg2" …
    foot, head : Pose
        The frame on the base, in base axes, and the one on the platform, in platform axes.
    base, middle, platform : tuple of Motion
        The three joints; one motion of a ball, two of a cylindrical joint (slide, then turn).
    length : float [unit of the design]
        Distance of the feet at the pose.
    """

    leg: Leg
    name: str
    foot: Pose
    head: Pose
    base: tuple[Motion, ...]
    middle: tuple[Motion, ...]
    platform: tuple[Motion, ...]
    length: float

    @property
    def motions(self) -> tuple[Motion, ...]:
        """All motions from base to platform."""
        return self.base + self.middle + self.platform


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
    check_undriven("design", design)
    posture = design.at(pose)
    if pose.shape:
        raise InvalidInput(expected("pose", "a single pose", f"a batch of shape {pose.shape}"))
    posture.check_defined()
    return tuple(_chain(posture, i) for i in range(design.n_legs))


class Span(NamedTuple):
    """What a leg passes through at several poses [unit of the design].

    Attributes
    ----------
    longest : float
        Greatest distance of its feet.
    base, platform : (2,) tuple of float
        Least and greatest displacement along the line of its base and platform joint; zeros where
        there is none.
    """

    longest: float
    base: tuple[float, float]
    platform: tuple[float, float]


def spans(legs: Sequence[Sequence[Chain]]) -> tuple[Span, ...]:
    """Return the span of each leg over poses.

    Parameters
    ----------
    legs : sequence of sequence of Chain
        Those of `linkage` at each pose.

    Returns
    -------
    tuple of Span
    """
    found = []
    for chains in zip(*legs, strict=True):
        ends = [(0.0, 0.0), (0.0, 0.0)]
        lines = chains[0].leg.base_line, chains[0].leg.platform_line
        for k, joints in enumerate(((c.base for c in chains), (c.platform for c in chains))):
            if lines[k]:
                values = [float(joint[0].value) for joint in joints]
                ends[k] = (min(values), max(values))
        found.append(Span(max(chain.length for chain in chains), *ends))
    return tuple(found)


def _chain(posture: Posture, i: int) -> Chain:
    leg, name, design = posture.design.legs[i], f"leg{i + 1}", posture.design
    lines, segments = posture.lines, posture.segments
    s, t, length = lines.s[i], lines.t[i], float(segments.length[i])
    lower, upper, along = _link_axes(leg, segments.direction[i], s, t)
    foot = Pose(design.base_points[i], _frame(design.base_directions[i]))
    head = Pose(design.platform_points[i], _frame(design.platform_directions[i]))
    above = segments.arm[i] - lines.arm[i]  # from platform anchor to platform foot
    below = lines.d[i] + above - segments.along[i]
    end = posture.pose.rotation @ head.rotation
    return Chain(
        leg=leg,
        name=name,
        foot=foot,
        head=head,
        base=_end_joint(f"{name}_base", leg.base_line, foot.rotation, lower, X, dot(below, s)),
        middle=_middle_joint(design, i, along, length, lower, upper),
        platform=_end_joint(f"{name}_platform", leg.platform_line, upper, end, -X, dot(above, t)),
        length=length,
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
    turn = below.T @ above
    if not cylindrical:
        return (Motion("ball", name, np.zeros(3), turn),)
    angle = float(np.arctan2(turn[2, 1] - turn[1, 2], turn[1, 1] + turn[2, 2]))
    return (
        Motion("slide", f"{name}_slide", slide, float(value)),
        Motion("turn", f"{name}_turn", X, angle),
    )


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
