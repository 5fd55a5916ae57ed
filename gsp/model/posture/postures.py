"""Posture: a design at poses, evaluated. The row-vector assembler."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.geometry.copies import ReadOnly, kept_property
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.model.posture.assembled import SingularDrive
from gsp.model.posture.assembly import put
from gsp.model.posture.evaluated import Evaluated

if TYPE_CHECKING:
    from gsp.model.design import Design
    from gsp.model.rods import Driven


@dataclass(frozen=True, eq=False, kw_only=True)
class Lines(ReadOnly):
    """Anchor points and lines of all legs of a posture, in base axes.

    Attributes
    ----------
    d : (..., n_legs, 3) array [length]
        p + R b − a, from base anchor to platform anchor. *Source: TozKucuk2016, eq. (1)*
    arm : (..., n_legs, 3) array [length]
        R b, from platform origin to platform anchor.
    s, t : (n_legs, 3) and (..., n_legs, 3) arrays [1]
        Unit directions of the base line and (turned by R) of the platform line; NaN where the
        leg has no such line.
    """

    d: Array
    arm: Array
    s: Array
    t: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Segments(ReadOnly):
    """The segments along which the legs of a posture act, in base axes; NaN where undefined.

    Attributes
    ----------
    base_feet, platform_feet : (..., n_legs, 3) arrays [length]
        Their ends; of a leg that is driven at the base those of its rod, the tip and the anchor.
    direction : (..., n_legs, 3) array [1]
        Unit vectors from base foot to platform foot; of a D4 or A1 leg whose lines meet, +t × s
        over its norm.
    length : (..., n_legs) array [length]
        Distances of the feet, ≥ 0.
    arm : (..., n_legs, 3) array [length]
        From the platform origin to the platform foot.
    normal : (..., n_legs, 3) array [1]
        t × s, along the common normal of the two lines of a leg; zero where they are parallel, and
        NaN only for a leg without two lines.
    sine : (..., n_legs) array [1]
        |t × s|, in [0, 1]; NaN for a leg without two lines.
    """

    base_feet: Array
    platform_feet: Array
    direction: Array
    length: Array
    arm: Array
    normal: Array
    sine: Array

    @property
    def along(self) -> Array:
        """Vectors from base foot to platform foot, shape (..., n_legs, 3) [length].

        *Source: ours; length times direction*
        """
        return self.length[..., None] * self.direction


@dataclass(frozen=True, eq=False)
class Posture(Evaluated):
    """A design at a pose or a batch of poses; made by `Design.at`.

    Attributes
    ----------
    design : Design
    pose : Pose
        Batch shape (...).
    joints : (..., n) array [unit of the design, rad]
        Actuated distances ≥ 0 and angles in (0, π), named by `joint_names`.
    jacobian : (..., n, 6) array
        Inverse Jacobian: actuator rates = J · (v, ω), with v the velocity of the platform origin
        and ω the angular velocity, both in base axes. Rows of distances are [1, unit], rows of
        angles [1/unit, 1]. *Source: TozKucuk2016, eqs. (8), (12)–(16)*

    NaN marks an element that is not defined; `undefined` gives the reason. The row of a drive at
    the base that is singular is infinite; `singular_drives` gives the reason.
    """

    design: Design
    pose: Pose

    @kept_property
    def drive_scales(self) -> Array:
        """Speed of the tip of each rod along the rod per joint rate, shape (..., n) [1, length].

        A row of a driven leg is that of a fixed base anchor, over this number; it is positive on
        the branch 1 and zero where the drive is singular. 1 for joints that are not driven at the
        base; NaN where undefined.

        *Source: docs/drives.md; ours*
        """
        return self._of_drives(lambda driven: driven.scale, 1.0)

    @kept_property
    def drive_is_singular(self) -> Mask:
        """Which drives at the base are singular, shape (..., n): their rates have no bound.

        *Source: the first kind of singularity of Gosselin and Angeles (1990); docs/drives.md*
        """
        regular = self._of_drives(lambda driven: np.where(driven.regular, 1.0, 0.0), 1.0)
        return np.asarray(regular == 0.0)

    @property
    def poses_of_singular_drives(self) -> Mask:
        """Where a drive at the base is singular, and all legs are defined, shape (...).

        *Source: ours; docs/drives.md*
        """
        return np.asarray(self.drive_is_singular.any(axis=-1) & self.defined)

    @property
    def singular_drives(self) -> tuple[SingularDrive, ...]:
        """The drives at the base that are singular, each with pose, joint and reason."""
        return tuple(
            SingularDrive(pose, joint, constraint.singular)
            for pose, joint, constraint in self._named(self.drive_is_singular)
        )

    def _of_drives(self, measure: Callable[[Driven], Any], other: float) -> Array:
        """Return a number per joint, shape (..., n), from what its drive adds to the segment."""
        found = np.full((self.pose.size, len(self.joint_names), 1), other)
        if self.design.driven:
            with np.errstate(all="ignore"):
                for poses, group, _, segment, undefined in self._parts():
                    if segment.driven is not None:
                        put(found, poses, group.rows[0], [measure(segment.driven)], undefined)
        return self._batch(found[..., 0])

    @kept_property
    def lines(self) -> Lines:
        """Anchor points and lines of all legs, in base axes.

        *Source: TozKucuk2016, eq. (1); docs/conventions.md, "Geometry of a leg"*
        """
        n = self.design.n_legs
        d, arm = (np.empty((self.pose.size, n, 3)) for _ in range(2))
        t = np.full((self.pose.size, n, 3), np.nan)
        for poses, group, at, _, _ in self._parts():
            for array, vector in ((d, at.d), (arm, at.arm), (t, at.t)):
                put(array, poses, group.legs, vector)
        d, arm, t = (self._batch(array) for array in (d, arm, t))
        return Lines(d=d, arm=arm, s=self.design.base_directions, t=t)

    @kept_property
    def segments(self) -> Segments:
        """The segments that all legs act along, in base axes; NaN where they are undefined.

        *Source: ours, after TozKucuk2016, eqs. (2)–(5)*
        """
        shape = (self.pose.size, self.design.n_legs)
        direction, arm, normal = (np.empty((*shape, 3)) for _ in range(3))
        length, sine = (np.empty((*shape, 1)) for _ in range(2))
        for poses, group, _, segment, undefined in self._parts():
            lines = len(segment.normal) > 0
            put(normal, poses, group.legs, segment.normal if lines else [np.nan] * 3)
            put(sine, poses, group.legs, [segment.sine if lines else np.nan])
            put(direction, poses, group.legs, segment.direction, undefined)
            put(arm, poses, group.legs, segment.arm, undefined)
            put(length, poses, group.legs, [segment.length], undefined)
        feet = self._batch(self.pose.position.reshape(-1, 1, 3) + arm)
        return Segments(
            base_feet=feet - self._batch(length * direction),
            platform_feet=feet,
            direction=self._batch(direction),
            length=self._batch(length[..., 0]),
            arm=self._batch(arm),
            normal=self._batch(normal),
            sine=self._batch(sine[..., 0]),
        )
