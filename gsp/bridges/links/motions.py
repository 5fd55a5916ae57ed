"""The records of a leg as a chain of joints, from a frame on the base to one on the platform."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.legs import Leg

X, Z = np.eye(3)[0], np.eye(3)[2]
Kind = Literal["ball", "slide", "turn"]


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
    offset : (3,) array [unit of the design]
        Where the joint is in the frame of the link below.
    """

    kind: Kind
    name: str
    axis: Array
    value: float | Array
    active: bool = False
    offset: Array = field(default_factory=lambda: np.zeros(3))

    @property
    def placement(self) -> Pose:
        """Frame above the joint in the frame below it."""
        if self.kind == "ball":
            return Pose(self.offset, self.value)
        if self.kind == "slide":
            return Pose(self.offset + self.axis * self.value)
        return Pose(self.offset).moved(np.concatenate((np.zeros(3), self.axis * self.value)))


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
        Distance of the feet at the pose; of a leg that is driven at the base that of its rod.
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

    @property
    def telescopic(self) -> bool:
        """Whether the leg changes its own length: its lower and its upper link slide."""
        return self.middle[0].kind == "slide"

    @property
    def turns_from_base(self) -> bool:
        """Whether the first joint turns passively; else the second does, on a carriage or crank."""
        return any(motion.kind != "slide" and not motion.active for motion in self.base)


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


def displacements(motions: Iterable[Motion]) -> list[float]:
    """Return the values of those motions that are slides [unit of the design].

    Parameters
    ----------
    motions : iterable of Motion
    """
    return [float(motion.value) for motion in motions if motion.kind == "slide"]


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
        ends = [
            (min(values, default=0.0), max(values, default=0.0))
            for joints in ((c.base for c in chains), (c.platform for c in chains))
            for values in [displacements(motion for joint in joints for motion in joint)]
        ]
        found.append(Span(max(chain.length for chain in chains), *ends))
    return tuple(found)
