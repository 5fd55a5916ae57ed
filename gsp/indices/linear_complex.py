"""σ_r and σ_t: the deviation of the legs from the best fitting linear line complex."""

from __future__ import annotations

import numpy as np

from gsp.geometry.matrices import defined_matrices, rounding_of_rank, singular_values
from gsp.geometry.vectors import Array
from gsp.indices.record import Index, Invariance, Properties
from gsp.indices.requirements import require_posture, with_singular_drives
from gsp.indices.spectra import decomposed, extremes, of_block
from gsp.model.posture import Posture
from gsp.model.posture.assembled import finite_rows
from gsp.model.posture.slopes import Slopes


def complex_deviation_rotation(posture: Posture, length: float | None = None) -> Array:
    """σ_r: least norm of the actuator rates over all twists of unit angular velocity.

    The legs' deviation from the best fitting path-normal complex of a rotation or a helical motion.
    The velocity part is eliminated by an orthogonal projection: no normal equations.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float or None [unit of the design]
        Weight of A1 actuators, which count with the speed L·θ̇; not used without them.

    Returns
    -------
    (...) array [unit of the design / rad]
        ≥ 0; 0 at postures with an uncontrolled rotation or screw, but not at those whose only
        uncontrolled motions are translations. NaN where the posture is undefined.

    Raises
    ------
    MissingParameter
        If the design has A1 actuators and no length is given.

    *Source: Nawratil, §3.1, after Pottmann, Peternell and Ravani: the square root of the minimum of
    Σ d_i² under cᵀc = 1, for UPS legs; other legs are our extension.*
    """
    require_posture(posture)
    rows = finite_rows(posture, posture.weighted(length))
    forces, moments = rows[..., :3], rows[..., 3:]
    least = _least(without_span(moments, forces), np.linalg.norm(moments, axis=(-2, -1)))
    return with_singular_drives(posture, least, 0.0)


def complex_deviation_translation(posture: Posture) -> Array:
    """σ_t: least norm of the actuator rates over all translations of unit speed.

    The legs' deviation from the best fitting path-normal complex of a translation. It depends on
    the directions of the legs only.

    Parameters
    ----------
    posture : Posture, batch shape (...)

    Returns
    -------
    (...) array [1]
        In [0, √(n/3)] for n actuated distances; 0 at postures with an uncontrolled translation,
        but at no other singular ones. NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If `posture` is not a Posture.

    *Source: Nawratil, §3.1, after Pottmann, Peternell and Ravani: ĉᵀĉ = 1. The source does not say
    that c = 0 there, but a value that no translation of a line changes (§3.4) has it. Legs other
    than UPS are our extension; A1 actuators do not move in a translation.*
    """
    require_posture(posture)
    forces = finite_rows(posture, posture.jacobian)[..., :3]
    least = _least(forces, np.linalg.norm(forces, axis=(-2, -1)))
    return with_singular_drives(posture, least, 0.0)


def without_span(matrix: Array, span: Array) -> Array:
    """Return the part of the columns of `matrix` that is orthogonal to the columns of `span`.

    Parameters
    ----------
    matrix, span : (..., n, 3) arrays

    Returns
    -------
    (..., n, 3) array; NaN where either has a NaN.
    """
    defined = defined_matrices(span)[..., None, None]
    left, values, _ = np.linalg.svd(np.where(defined, span, 0.0), full_matrices=False)
    basis = np.where((values > rounding_of_rank(values[..., :1]))[..., None, :], left, 0.0)
    rest = matrix
    for _ in range(2):  # the second pass removes the rounding of the first
        rest = rest - basis @ (np.swapaxes(basis, -1, -2) @ rest)
    return np.where(defined, rest, np.nan)


def _least(matrix: Array, size: Array) -> Array:
    """Smallest singular value, and 0 where it is the rounding of terms of a size (...)."""
    least = singular_values(matrix)[..., -1]
    return np.where(least <= rounding_of_rank(size), 0.0, least)


def _rotation_slope(slopes: Slopes, length: float | None = None) -> Array:
    """Return the derivative of the least norm, by Danskin's theorem: at the twist that has it."""
    rows, rates = slopes.posture.weighted(length), slopes.weighted(length)
    forces, moments = rows[..., :3], rows[..., 3:]
    known = defined_matrices(rows)[..., None, None]
    safe = np.where(known, forces, 0.0)
    left, values, right = decomposed(without_span(moments, forces))
    # The velocity that goes with each angular velocity.
    velocities = -np.linalg.pinv(safe) @ np.where(known, moments, 0.0) @ right
    twists = np.concatenate((velocities, right), axis=-2)[..., None, :, :]
    block = np.swapaxes(left, -1, -2)[..., None, :, :] @ rates @ twists
    zero = complex_deviation_rotation(slopes.posture, length) == 0.0
    return np.where(zero[..., None], np.nan, of_block(values, block).low_rise)


def _translation_slope(slopes: Slopes) -> Array:
    rows, rates = slopes.posture.jacobian[..., :3], slopes.jacobian[..., :3]
    zero = complex_deviation_translation(slopes.posture) == 0.0
    return np.where(zero[..., None], np.nan, extremes(rows, rates).low_rise)


COMPLEX_DEVIATION_ROTATION = Index(
    name="complex_deviation_rotation",
    symbol="σ_r",
    function=complex_deviation_rotation,
    slope=_rotation_slope,
    better="higher",
    best=np.inf,
    worst=0.0,
    parameters=("length",),
    needs=(),
    length_for="angular",
    unit_power="length",
    source="Nawratil, §3.1",
    properties=Properties(
        non_negative=True,
        zero_iff_singular=False,
        motion_invariant=True,
        similarity_invariant=False,
        geometric=True,
        real_time=True,
    ),
    invariance=Invariance(),
    routine=False,
)

COMPLEX_DEVIATION_TRANSLATION = Index(
    name="complex_deviation_translation",
    symbol="σ_t",
    function=complex_deviation_translation,
    slope=_translation_slope,
    better="higher",
    best=np.inf,
    worst=0.0,
    parameters=(),
    needs=(),
    length_for="",
    unit_power="1",
    source="Nawratil, §3.1",
    properties=Properties(
        non_negative=True,
        zero_iff_singular=False,
        motion_invariant=True,
        similarity_invariant=True,
        geometric=True,
        real_time=True,
    ),
    invariance=Invariance(),
    routine=False,
)
