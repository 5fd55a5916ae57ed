"""The common part of postures in space and in the plane: matrices in one unit, and forces."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.errors import MissingParameter, expected
from gsp.geometry.copies import kept_property, read_only
from gsp.geometry.frames.changes import about_point
from gsp.geometry.frames.placements import common_shape
from gsp.geometry.matrices import reciprocal_condition, singular_values
from gsp.geometry.vectors import Array, Mask
from gsp.model.posture.assembled import Assembled, finite_rows
from gsp.model.posture.statics import forces_or_nan, least_forces


def check_length(length: float | None, needed: bool, why: str) -> float | None:
    """Return a characteristic length that is given; None is accepted where no length is needed.

    Parameters
    ----------
    length : float or None [unit of the design]
    needed : bool
    why : str
        The reason, as the end of "expected a positive number, as …".

    Raises
    ------
    MissingParameter
        If one is needed and none is given.
    InvalidInput
        On anything but a number from 1e-100 to 1e100.
    """
    if length is None and needed:
        raise MissingParameter(expected("length", f"a positive number, as {why}", "none"))
    return length if length is None else arguments.size("length", length)


class Evaluated(Assembled):
    """A design at a pose or a batch of poses; c = 6 columns in space, 3 in the plane.

    Attributes
    ----------
    design : AnchoredDesign
    pose : pose, batch shape (...)
    """

    def homogeneous(self, length: float) -> Array:
        """Return the dimensionless Jacobian for a characteristic length, shape (..., n, c).

        Rows of distances are [∂/∂v, (∂/∂ω)/L]; rows of angles are multiplied by L as well, which
        leaves [L ∂/∂v, ∂/∂ω].

        Parameters
        ----------
        length : float [unit of the design]
            L > 0.

        Raises
        ------
        InvalidInput
            If the length is not a number from 1e-100 to 1e100.

        *Source: TozKucuk2016 §4.3; the matrices (24) and (25) are printed so*
        """
        scale = arguments.size("length", length)
        rows = self._times_length(scale)
        turns = np.arange(rows.shape[-1]) >= self.design.dimension
        return np.asarray(rows * np.where(turns, 1.0 / scale, 1.0))

    def weighted(self, length: float | None) -> Array:
        """Return the Jacobian with angular rates counted as speeds L·θ̇ [length/time].

        Without angular rows it is `jacobian`, and no length is needed. The rule for angular
        rows is ours.

        Parameters
        ----------
        length : float or None [unit of the design]
            L > 0.

        Returns
        -------
        (..., n, c) array [1 for v, unit of the design for ω]

        Raises
        ------
        MissingParameter
            If there are angular rows and no length is given.
        InvalidInput
            If the length is not a number from 1e-100 to 1e100.

        *Source: docs/conventions.md, "Homogeneous Jacobian"; the rule for angular rows is ours*
        """
        needed = bool(self.angular.any())
        return self._times_length(
            check_length(length, needed, "the design has A1 actuators or cranks")
        )

    def _times_length(self, length: float | None) -> Array:
        """Return the Jacobian with rows of angles multiplied by a length."""
        if length is None or not self.angular.any():
            return self.jacobian
        return np.asarray(self.jacobian * np.where(self.angular, length, 1.0)[:, None])

    def passive_rates(self, length: float | None) -> Array:
        """Return the matrix of the passive joint rates over the twist, shape (..., m, c).

        Per leg the rates at which the direction of its segment turns, seen from the base and from
        the platform, and its passive slides divided by `length`. In space two turns each, then
        slides along the base line (D3, D4, A1), the platform line (D2, D4, A1) and the common
        normal (A1). Legs are sorted by kind, kinds in the order of the tables of legs.

        Parameters
        ----------
        length : float or None [unit of the design]
            L > 0; needed for legs with passive slides only.

        Returns
        -------
        (..., m, c) array [1/unit of the design for v, 1 for ω]

        Raises
        ------
        MissingParameter
            If a leg has passive slides and no length is given.
        InvalidInput
            If the length is not a number from 1e-100 to 1e100.

        *Source: Nawratil, eqs. (18)–(20) for UPS legs, §4.2 for RPR legs; slides are our
        extension.*
        """
        scale = check_length(length, self.design.cylindrical, "legs have passive slides")
        return self._passive_rates(1.0 if scale is None else scale)

    @cached_property
    def _spectra(self) -> dict[float, Array]:
        return {}

    def singular_values(self, length: float) -> Array:
        """Return the singular values of `homogeneous(length)`, descending, shape (..., c) [1].

        Parameters
        ----------
        length : float [unit of the design]
            L > 0.

        Returns
        -------
        (..., c) array [1]
            NaN where the posture is undefined.

        Raises
        ------
        InvalidInput
            If the length is not a number from 1e-100 to 1e100.

        *Source: TozKucuk2016, §1, for condition numbers from them, and §4.3 for the homogeneous
        Jacobian*
        """
        scale = arguments.size("length", length)
        if scale not in self._spectra:
            self._spectra[scale] = read_only(singular_values(self.homogeneous(scale)))
        return self._spectra[scale]

    def singular(self, length: float | None = None) -> Mask:
        """Whether the Jacobian is rank deficient in double precision, shape (...).

        Parameters
        ----------
        length : float or None [unit of the design]
            The length that makes the Jacobian dimensionless, with moments about the platform
            origin. None takes `design.rms_radius` and moments about the centre of the platform
            anchors, so that the result does not depend on the platform origin.

        Raises
        ------
        InvalidInput
            If the length is neither None nor a number > 0.

        *Source: docs/conventions.md, "Undefined and singular"*
        """
        values = self._centred_values if length is None else self.singular_values(length)
        return np.asarray(reciprocal_condition(values) == 0.0)

    @kept_property
    def about_centre(self) -> Array:
        """Dimensionless Jacobian about the centre of the platform anchors, shape (..., n, c) [1].

        The length is `design.rms_radius`. Twists have the velocity of that centre, so that nothing
        depends on where the platform origin is.

        *Source: ours; docs/conventions.md, "Homogeneous Jacobian" and "Undefined and singular"*
        """
        size = self.design.rms_radius
        centre = arm_of_centre(self.design, self.pose) / size
        rows = self.homogeneous(size)
        if not self.design.driven:
            return about_point(rows, centre[..., None, :])
        with np.errstate(invalid="ignore"):
            moved = about_point(rows, centre[..., None, :])
        return np.where(np.isinf(rows), rows, moved)

    @kept_property
    def _centred_values(self) -> Array:
        return singular_values(self.about_centre)

    def wrench(self, actuator_forces: ArrayLike) -> Array:
        """Return the wrench that actuators exert on the platform, Jᵀ f.

        Parameters
        ----------
        actuator_forces : (..., n) array_like [force; force · unit of the design for A1 actuators]
            Positive where an actuator pushes its joint value up; NaN where it is undefined.

        Returns
        -------
        (..., c) array [force, force · unit of the design]
            Force and moment about the platform origin in base axes; NaN where a force or the
            Jacobian is, or where the Jacobian is infinite.

        Raises
        ------
        InvalidInput
            On shapes that do not fit, infinite numbers or numbers beyond 1e100.

        *Source: docs/conventions.md, "Frames and reference points", by the principle of virtual
        work*
        """
        forces = forces_or_nan("actuator_forces", actuator_forces, len(self.joint_names))
        common_shape("actuator_forces", forces.shape[:-1], self.shape)
        return np.asarray((forces[..., None, :] @ finite_rows(self, self.jacobian))[..., 0, :])

    def actuator_forces(self, wrench: ArrayLike) -> Array:
        """Return the actuator forces that balance an external wrench, Jᵀ f = −w.

        Of more actuators than coordinates the forces with the least sum of squares, with torques
        divided by `design.rms_radius`.

        Parameters
        ----------
        wrench : (..., c) array_like [force, force · unit of the design]
            External force and moment about the platform origin, in base axes; NaN where it is
            undefined.

        Returns
        -------
        (..., n) array [force; force · unit of the design for A1 actuators]
            What the actuators exert, positive where they push their joint values up. NaN where a
            number of the wrench is, and where the posture is undefined or singular (see
            `singular`).

        Raises
        ------
        InvalidInput
            On shapes that do not fit, infinite numbers or numbers beyond 1e100.

        *Source: the principle of virtual work; the weight of torques is ours*

        Examples
        --------
        >>> import gsp
        >>> posture = (d := gsp.catalogue.design("toz-kucuk-2016-d3-6")).at(d.home)
        >>> weight = [0.0, 0.0, -100.0, 0.0, 0.0, 0.0]
        >>> posture.wrench(posture.actuator_forces(weight)).round(6) + 0.0
        array([  0.,   0., 100.,   0.,   0.,   0.])
        """
        given = forces_or_nan("wrench", wrench, self._columns)
        common_shape("wrench", given.shape[:-1], self.shape)
        n, size = self.design.dimension, self.design.rms_radius
        moved = about_point(given, arm_of_centre(self.design, self.pose))
        moved[..., n:] /= size
        balance = least_forces(self.about_centre, moved)
        return np.asarray(balance * np.where(self.angular, size, 1.0))


def arm_of_centre(design: Any, pose: Any) -> Array:
    """Return the vectors from the platform origin to the centre of the platform anchors.

    Parameters
    ----------
    design : Design or PlanarDesign
    pose : its kind of pose, batch shape (...)

    Returns
    -------
    (..., n) array [unit of the design]
        In base axes.
    """
    return np.asarray(pose.rotation @ design.platform_points.mean(axis=0))
