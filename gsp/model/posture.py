"""Posture: a design at poses, evaluated. The row-vector assembler."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gsp.checks import check_positive
from gsp.errors import MissingParameter, UndefinedPosture
from gsp.geometry.matrices import reciprocal_condition, singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask, norm
from gsp.model.constraints import Lines, Segment
from gsp.model.legs import LEGS, Leg

if TYPE_CHECKING:
    from gsp.model.design import Design


class Undefined(NamedTuple):
    """One element of a posture that has no value, and why."""

    pose: tuple[int, ...]
    joint: str
    reason: str


@dataclass(frozen=True, eq=False)
class Posture:
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

    NaN marks an element that is not defined; `undefined` says why.
    """

    design: Design
    pose: Pose

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch shape of the poses."""
        return self.pose.shape

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the actuated joints, in row order."""
        return self.design.joint_names

    @cached_property
    def lines(self) -> Lines:
        """Anchor points and lines of all legs, in base axes."""
        design, (p, r) = self.design, (self.pose.position, self.pose.rotation)
        arm = design.platform_points @ np.swapaxes(r, -1, -2)
        t = design.platform_directions @ np.swapaxes(r, -1, -2)
        d = p[..., None, :] + arm - design.base_points
        reach = norm(design.platform_points) + norm(design.base_points)
        return Lines(d, arm, design.base_directions, t, norm(p)[..., None] + reach)

    @cached_property
    def _assembled(self) -> tuple[Array, Array]:
        """Joints and Jacobian."""
        n = len(self.joint_names)
        joints, rows = np.empty((*self.shape, n)), np.empty((*self.shape, n, 6))
        for leg, legs, first_rows, segment in self._kinds():
            lines = self.lines[legs]
            for place, constraint in enumerate(leg.constraints):
                at = [row + place for row in first_rows]
                ok = segment.defined
                joints[..., at] = np.where(ok, constraint.measure(lines, segment), np.nan)
                rows[..., at, :] = np.where(ok[..., None], constraint.row(lines, segment), np.nan)
        joints.flags.writeable = rows.flags.writeable = False
        return joints, rows

    def _kinds(self) -> Iterator[tuple[Leg, list[int], list[int], Segment]]:
        """Each kind of leg that is there, its legs, the first row of each, and their segments."""
        first_rows = np.cumsum([0] + [len(leg.constraints) for leg in self.design.legs])
        for kind in LEGS:
            legs = [i for i, leg in enumerate(self.design.legs) if leg is kind]
            if legs:
                segment = kind.constraints[0].segment(self.lines[legs])
                yield kind, legs, [int(first_rows[i]) for i in legs], segment

    @property
    def joints(self) -> Array:
        """Actuated distances and angles, shape (..., n)."""
        return self._assembled[0]

    @property
    def jacobian(self) -> Array:
        """Inverse Jacobian, shape (..., n, 6)."""
        return self._assembled[1]

    @cached_property
    def defined(self) -> Mask:
        """Whether all elements of a pose are defined, shape (...)."""
        return np.asarray(~np.isnan(self.joints).any(axis=-1))

    @property
    def undefined(self) -> tuple[Undefined, ...]:
        """The elements that are NaN, each with pose, joint and reason; () when there are none."""
        reasons = [c.undefined for leg in self.design.legs for c in leg.constraints]
        return tuple(
            Undefined(
                tuple(int(i) for i in where[:-1]), self.joint_names[where[-1]], reasons[where[-1]]
            )
            for where in np.argwhere(np.isnan(self.joints))
        )

    def check_defined(self) -> None:
        """Raise UndefinedPosture, with joint and reason, if an element has no value."""
        if not self.defined.all():
            raise UndefinedPosture(self.design.name, self.undefined)

    @cached_property
    def angular(self) -> Mask:
        """Which rows belong to A1 constraints, shape (n,)."""
        kinds = [c.quantity == "angle" for leg in self.design.legs for c in leg.constraints]
        return np.array(kinds, dtype=bool)

    def homogeneous(self, length: float) -> Array:
        """Return the dimensionless Jacobian for a characteristic length, shape (..., n, 6).

        Rows of distances are [∂/∂v, (∂/∂ω)/L]; rows of angles, multiplied by L as well, stay as
        they are.

        Parameters
        ----------
        length : float [unit of the design]
            L > 0.

        *Source: TozKucuk2016 §4.3; the matrices (24) and (25) are printed so*
        """
        scale = check_positive("length", length)
        return np.asarray(self.weighted(scale) * np.repeat([1.0, 1.0 / scale], 3))

    def weighted(self, length: float | None) -> Array:
        """Return the Jacobian with angular rates counted as speeds L·θ̇ [length/time]: (..., n, 6).

        Without angular rows it is `jacobian`, and no length is needed. The rule for angular
        rows is ours.
        """
        scale = 1.0 if length is None else check_positive("length", length)
        if length is None or not self.angular.any():
            return self.jacobian
        return np.asarray(self.jacobian * np.where(self.angular, scale, 1.0)[:, None])

    def passive_rates(self, length: float | None) -> Array:
        """Return the rows that give the passive joint rates from a twist, shape (..., m, 6).

        Per leg the rates at which the unit vector of its segment turns, seen from the base and
        from the platform, two each, and its passive slides divided by `length`: along the base
        line (D3, D4, A1), the platform line (D2, D4, A1) and the common normal (A1). Legs of one
        kind stand together, kinds in the order of `gsp.model.legs.LEGS`.

        Parameters
        ----------
        length : float or None [unit of the design]
            L > 0; needed for legs with cylindrical joints only.

        Raises
        ------
        MissingParameter
            If a leg has cylindrical joints and no length is given.

        *Source: Nawratil, eqs. (18)–(20) for UPS legs; slides are our extension.*
        """
        scale = 1.0 if length is None else check_positive("length", length)
        if length is None and any(leg.cylindrical for leg in self.design.legs):
            raise MissingParameter(
                "passive_rates: expected a length, as legs have cylindrical joints; received none"
            )
        blocks = []
        for kind, legs, _, segment in self._kinds():
            with np.errstate(divide="ignore", invalid="ignore"):
                turns, slides = kind.passive(self.lines[legs], segment)
            rows = np.concatenate((turns, slides / scale), axis=-2)
            rows = np.where(segment.defined[..., None, None], rows, np.nan)
            blocks.append(rows.reshape(*self.shape, len(legs) * rows.shape[-2], 6))
        return np.concatenate(blocks, axis=-2)

    @cached_property
    def _spectra(self) -> dict[float, Array]:
        return {}

    def singular_values(self, length: float) -> Array:
        """Return the singular values of `homogeneous(length)`, descending, shape (..., 6)."""
        scale = check_positive("length", length)
        if scale not in self._spectra:
            self._spectra[scale] = singular_values(self.homogeneous(scale))
        return self._spectra[scale]

    def singular(self, length: float | None = None) -> Mask:
        """Whether the Jacobian has not full rank in double precision, shape (...).

        Parameters
        ----------
        length : float or None [unit of the design]
            What makes the Jacobian dimensionless; default `design.size`.
        """
        values = self.singular_values(self.design.size if length is None else length)
        return np.asarray(reciprocal_condition(values) == 0.0)
