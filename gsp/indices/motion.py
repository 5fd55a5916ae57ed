"""The least controlled motion of a posture: its screw, and the linear complex close to the legs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.frames.changes import twists_about_point
from gsp.geometry.matrices import (
    defined_matrices,
    full_rank,
    rounding_of_rank,
    singular_values,
    solve_right_triangular,
    triangular_root,
    whiten,
)
from gsp.geometry.vectors import Array, dot, nearest_to_origin, norm
from gsp.indices.linear_complex import without_span
from gsp.indices.requirements import require_posture
from gsp.model.posture import Posture

Method = Literal["control_number", "linear_complex"]
FITS = ("none", "complex", "pencil", "bundle")

# A motion is a translation if its rotation moves the anchors by less than this share of their whole
# displacement: some thousand rounding errors.
TRANSLATION_SHARE = 1e-12


@dataclass(frozen=True, eq=False)
class InstantaneousMotion(ReadOnly):
    """Twists of a posture, the least controlled one first, and the screw of the first one.

    Attributes
    ----------
    twists : (..., 6, k) array [length/rad, 1]
        Columns (v, ω) at the platform origin, in base axes, least controlled first; k is 6 for
        the control number and 3 for Pottmann's linear complexes. Each has unit size in the measure
        of the method: the passive joint rates, or the angular velocity.
    rates : (..., k) array [length/rad]
        The norms of the actuator rates that they cause, ≥ 0, ascending: sqrt(1/λ), or σ_r first.
    position : (..., 3) array [length]
        The platform origin, which the twists refer to, from the base origin.
    """

    twists: Array
    rates: Array
    position: Array

    @property
    def twist(self) -> Array:
        """The least controlled twist (v, ω) at the platform origin, (..., 6) [length/rad, 1].

        *Source: Nawratil, §3.3, the eigenvector of λ₊; §3.1 for linear complexes*
        """
        return self.twists[..., 0]

    @property
    def complex(self) -> Array:
        """The linear complex closest to the legs: q, q̂ about the base origin, (..., 6) [1, length].

        Its lines (l, l̂) have l · q̂ + l̂ · q = 0: they are the path normals of the motion. The
        norm of q is 1; for a translation q is zero, and q̂ is a unit vector [1].

        *Source: Nawratil, eq. (3) with d = 0, and §3.3; ours: the norm*
        """
        w = self.twist[..., 3:]
        about_base = twists_about_point(self.twist, -self.position)[..., :3]
        size = np.where(norm(w) > 0.0, norm(w), norm(about_base))
        return np.concatenate((w, about_base), axis=-1) / size[..., None]

    @property
    def pitch(self) -> Array:
        """Translation along the axis per radian, shape (...) [length/rad]; NaN for a translation.

        *Source: Nawratil, eq. (24)*
        """
        v, w = self.twist[..., :3], self.twist[..., 3:]
        with np.errstate(invalid="ignore", divide="ignore"):
            return dot(v, w) / dot(w, w)

    @property
    def axis(self) -> Array:
        """Plücker coordinates (c, ĉ) of the screw axis about the base origin, (..., 6) [1, length].

        c is a unit vector; all are NaN for a translation.

        *Source: Nawratil, eq. (24)*
        """
        q, q_hat = self.complex[..., :3], self.complex[..., 3:]
        size = norm(q)[..., None]
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.concatenate((q / size, (q_hat - self.pitch[..., None] * q) / size), axis=-1)

    @property
    def point(self) -> Array:
        """The point of the axis that is closest to the base origin, shape (..., 3) [length].

        NaN for a translation.

        *Source: ours; c × ĉ of the axis*
        """
        return nearest_to_origin(self.axis[..., :3], self.axis[..., 3:])

    def multiplicity(self, tolerance: float = 0.1) -> Array:
        """Return how many twists are about as little controlled as the first.

        Parameters
        ----------
        tolerance : float [1]
            t in [0, 1). Twists count whose eigenvalue is within this share of the largest,
            λ ≥ λ₊ (1 − t), and at singular postures all uncontrolled twists.

        Returns
        -------
        (...) array of int [1]
            From 1 to k; 0 where undefined.

        Raises
        ------
        InvalidInput
            If `tolerance` is not a number in [0, 1).

        *Source: Nawratil, the Remark at the end of §3.3, which says "differs only a little"*
        """
        share = 1.0 - arguments.share("tolerance", tolerance)
        if share <= 0.0:
            raise InvalidInput(expected("tolerance", "a number in [0, 1)", brief(tolerance)))
        first, last = self.rates[..., :1], self.rates[..., -1:]
        floor = rounding_of_rank(last)
        with np.errstate(invalid="ignore"):
            near = (self.rates <= first / np.sqrt(share)) | (self.rates <= floor)
        return np.asarray(near.sum(axis=-1))

    def fit(self, tolerance: float = 0.1) -> tuple[str, ...] | str:
        """Return what fits the legs: a "complex", a "pencil" of two, a "bundle" of three or more.

        Parameters
        ----------
        tolerance : float [1]
            As for `multiplicity`.

        Returns
        -------
        str or tuple of str
            A str for a single posture, else a tuple of them in C order; "none" where undefined.

        Raises
        ------
        InvalidInput
            If `tolerance` is not a number in [0, 1).

        Examples
        --------
        >>> import gsp
        >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
        >>> gsp.instantaneous_motion(design.at(design.home), length=90.0).fit()
        'complex'

        *Source: Nawratil, the Remark at the end of §3.3*
        """
        names = tuple(FITS[min(int(m), 3)] for m in np.ravel(self.multiplicity(tolerance)))
        return names if np.ndim(self.rates) > 1 else names[0]


@arguments.validated(method=arguments.text)
def instantaneous_motion(
    posture: Posture, method: Method = "control_number", length: float | None = None
) -> InstantaneousMotion:
    """Return the least controlled motion; at a singularity this is the uncontrolled motion.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    method : "control_number" or "linear_complex"
        The eigenvector of the largest generalised eigenvalue of the control number; or Pottmann's
        linear complex, which compares motions of the same angular velocity.
    length : float or None [unit of the design]
        As for `control_number`; for linear complexes the weight of A1 actuators.

    Returns
    -------
    InstantaneousMotion
        NaN where the posture is undefined, and for "control_number" where some motion turns no
        leg at all (parallel legs: a singular posture of defect three at least).

    Raises
    ------
    InvalidInput
        If the method is unknown.
    MissingParameter
        If the legs need a length and none is given.

    Examples
    --------
    >>> from gsp.families import nawratil
    >>> design = nawratil.example_design(nawratil.BEST_ALPHA)
    >>> posture = design.at(nawratil.example_pose(nawratil.BEST_H, [0.0, -0.95, 0.0]))
    >>> abs(instantaneous_motion(posture).axis[:3]).round(3)
    array([0., 1., 0.])

    *Source: Nawratil, §3.3, eq. (24); §3.1 for the method of Pottmann, Peternell and Ravani*
    """
    require_posture(posture)
    if method not in get_args(Method):
        raise InvalidInput(expected("method", " or ".join(get_args(Method)), repr(method)))
    if method == "control_number":
        return _by_control_number(posture, length)
    return _by_linear_complex(posture, length)


def _by_control_number(posture: Posture, length: float | None) -> InstantaneousMotion:
    """J R⁻¹ = U Σ Vᵀ with T = RᵀR: the eigenvectors are the columns of R⁻¹ V."""
    metric = _defined_metric(posture, length)
    right, values = _right_vectors(whiten(posture.weighted(length), metric))
    inverse = solve_right_triangular(np.eye(6), triangular_root(metric))
    with np.errstate(invalid="ignore"):
        twists = inverse @ right
    twists = _without_rounded_turns(twists, posture.design.rms_radius)
    return InstantaneousMotion(twists, values, posture.pose.position)


def _defined_metric(posture: Posture, length: float | None) -> Array:
    """Return the passive rates; NaN where drives on parallel rails leave them without full rank.

    Then a translation of all carriages moves no passive joint, at regular postures too, and has no
    unit size.
    """
    metric = posture.passive_rates(length)
    if not posture.design.driven:
        return metric
    size = posture.design.rms_radius
    scaled = metric * np.where(np.arange(6) < 3, size, 1.0)
    return np.where(full_rank(singular_values(scaled))[..., None, None], metric, np.nan)


def _without_rounded_turns(twists: Array, size: float) -> Array:
    """Return twists, as columns, with the angular velocity 0 where it is rounding."""
    speed, turn = (
        np.linalg.norm(part, axis=-2) for part in (twists[..., :3, :], twists[..., 3:, :])
    )
    rounding = np.asarray(turn * size <= TRANSLATION_SHARE * speed)[..., None, :]
    spins = np.arange(6)[:, None] >= 3
    return np.where(rounding & spins, 0.0, twists)


def _by_linear_complex(posture: Posture, length: float | None) -> InstantaneousMotion:
    """Angular velocities are unit vectors; the velocity that goes with each is the best one."""
    rows = posture.weighted(length)
    forces, moments = rows[..., :3], rows[..., 3:]
    spins, values = _right_vectors(without_span(moments, forces))
    defined = defined_matrices(forces)[..., None, None]
    inverse: Array = np.asarray(np.linalg.pinv(np.where(defined, forces, 0.0)), dtype=np.float64)
    return InstantaneousMotion(
        np.concatenate((-inverse @ (moments @ spins), spins), axis=-2),
        values,
        posture.pose.position,
    )


def _right_vectors(matrix: Array) -> tuple[Array, Array]:
    """Right singular vectors as columns, and the values, both ascending; NaN where undefined."""
    defined = defined_matrices(matrix)[..., None]
    safe = np.where(defined[..., None], matrix, 0.0)
    _, values, right = np.linalg.svd(safe, full_matrices=False)
    columns = np.swapaxes(right, -1, -2)[..., ::-1]
    return np.where(defined[..., None], columns, np.nan), np.where(defined, values, np.nan)[
        ..., ::-1
    ]
