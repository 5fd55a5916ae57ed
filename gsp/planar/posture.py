"""PlanarPosture: a planar design at poses, evaluated."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from gsp import arguments
from gsp.checks import check_positive
from gsp.geometry.matrices import reciprocal_condition, singular_values
from gsp.geometry.vectors import Array, Mask, norm
from gsp.model.posture import Undefined
from gsp.planar.constraints import PLANAR_CONSTRAINTS, PlanarConstraint, PlanarLines
from gsp.planar.pose import PlanarPose

if TYPE_CHECKING:
    from gsp.planar.design import PlanarDesign


@dataclass(frozen=True, eq=False)
class PlanarPosture:
    """A planar design at a pose or a batch of poses; made by `PlanarDesign.at`.

    Attributes
    ----------
    design : PlanarDesign
    pose : PlanarPose
        Batch shape (...).
    joints : (..., n) array [unit of the design, rad]
        Actuated distances ≥ 0 and oriented angles in (−π, π].
    jacobian : (..., n, 3) array
        Inverse Jacobian: actuator rates = J · (v_x, v_y, ω), with v the velocity of the platform
        origin in base axes.

    NaN marks an element that is not defined; `undefined` says why.
    """

    design: PlanarDesign
    pose: PlanarPose

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch shape of the poses."""
        return self.pose.shape

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the actuated joints, in row order."""
        return self.design.joint_names

    @cached_property
    def lines(self) -> PlanarLines:
        """Anchor points and lines of all legs, in base axes."""
        design, p = self.design, self.pose.position
        back = np.swapaxes(self.pose.rotation, -1, -2)
        arm = design.platform_points @ back
        t = design.platform_directions @ back
        d = p[..., None, :] + arm - design.base_points
        reach = norm(design.platform_points) + norm(design.base_points)
        s = np.broadcast_to(design.base_directions, d.shape)
        return PlanarLines(d, arm, s, t, norm(p)[..., None] + reach)

    def _kinds(self) -> Iterator[tuple[PlanarConstraint, list[int], PlanarLines]]:
        for kind in PLANAR_CONSTRAINTS:
            legs = [i for i, leg in enumerate(self.design.legs) if leg is kind]
            if legs:
                yield kind, legs, self.lines[legs]

    @cached_property
    def _assembled(self) -> tuple[Array, Array]:
        n = self.design.n_legs
        joints, rows = np.empty((*self.shape, n)), np.empty((*self.shape, n, 3))
        for kind, legs, lines in self._kinds():
            ok = kind.defined(lines)
            value, row = kind.value_and_row(lines)
            joints[..., legs] = np.where(ok, value, np.nan)
            rows[..., legs, :] = np.where(ok[..., None], row, np.nan)
        joints.flags.writeable = rows.flags.writeable = False
        return joints, rows

    @property
    def joints(self) -> Array:
        """Actuated distances and angles, shape (..., n)."""
        return self._assembled[0]

    @property
    def jacobian(self) -> Array:
        """Inverse Jacobian, shape (..., n, 3)."""
        return self._assembled[1]

    @cached_property
    def defined(self) -> Mask:
        """Whether all elements of a pose are defined, shape (...)."""
        return np.asarray(~np.isnan(self.joints).any(axis=-1))

    @property
    def undefined(self) -> tuple[Undefined, ...]:
        """The elements that are NaN, each with pose, joint and reason; () when there are none."""
        return tuple(
            Undefined(
                tuple(int(i) for i in where[:-1]),
                self.joint_names[where[-1]],
                self.design.legs[where[-1]].undefined,
            )
            for where in np.argwhere(np.isnan(self.joints))
        )

    @cached_property
    def angular(self) -> Mask:
        """Which rows belong to A1 constraints, shape (n,)."""
        return np.array([c.quantity == "angle" for c in self.design.legs], dtype=bool)

    def homogeneous(self, length: float) -> Array:
        """Return the dimensionless Jacobian for a characteristic length, shape (..., n, 3).

        Rows of distances are [∂/∂v, (∂/∂ω)/L]; rows of angles stay as they are.
        """
        scale = check_positive("length", length)
        return np.asarray(self.weighted(scale) * np.array([1.0, 1.0, 1.0 / scale]))

    def weighted(self, length: float | None) -> Array:
        """Return the Jacobian with angular rates counted as speeds L·θ̇: shape (..., n, 3)."""
        if length is None or not self.angular.any():
            return self.jacobian
        weight = np.where(self.angular, check_positive("length", length), 1.0)
        return self.jacobian * weight[:, None]

    @arguments.validated(length=arguments.optional(arguments.positive))
    def passive_rates(self, length: float | None) -> Array:
        """Return the rows that give the passive joint rates from a twist, shape (..., m, 3).

        Per leg the rates at which its direction turns, seen from the base and from the platform,
        and its passive slides divided by `length`.

        *Source: Nawratil, §4.2 for RPR legs; the other legs are our extension.*
        """
        blocks = []
        for kind, _, lines in self._kinds():
            turns, slides = kind.passive(lines)
            scale = 1.0 if length is None else length
            rows = np.concatenate((turns, slides / scale), axis=-2)
            rows = np.where(kind.defined(lines)[..., None, None], rows, np.nan)
            blocks.append(rows.reshape(*self.shape, -1, 3))
        return np.concatenate(blocks, axis=-2)

    def singular_values(self, length: float) -> Array:
        """Return the singular values of `homogeneous(length)`, descending, shape (..., 3)."""
        return singular_values(self.homogeneous(length))

    def singular(self, length: float | None = None) -> Mask:
        """Whether the Jacobian has not full rank in double precision, shape (...)."""
        values = self.singular_values(self.design.size if length is None else length)
        return np.asarray(reciprocal_condition(values) == 0.0)
