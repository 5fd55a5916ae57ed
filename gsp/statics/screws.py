"""Eigenscrews of a stiffness matrix: displacements whose wrench is a screw on the same axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.matrices import defined_matrices
from gsp.geometry.vectors import Array, dot, nearest_to_origin

# How far a stiffness may be from symmetric, as a share of its size.
SYMMETRY = 1e-9
# Least eigenvalue over the greatest, up to which a stiffness is not told from a singular one.
DEFINITE_SHARE = 10.0 * np.finfo(float).eps


@dataclass(frozen=True, eq=False, kw_only=True)
class Eigenscrews(ReadOnly):
    """Result of `eigenscrews`: six screws per stiffness matrix, by descending value.

    Attributes
    ----------
    values : (..., 6) array [force]
        λ: three are positive, three negative. The wrench of a displacement (δ, θ) on the screw has
        the force λ θ and the moment λ δ.
    twists : (..., 6, 6) array [unit, rad]
        Columns (δ, θ) about the reference point of the matrix, with |θ| = 1.
    """

    values: Array
    twists: Array

    @property
    def pitch(self) -> Array:
        """Pitches δ·θ, of the sign of λ, shape (..., 6) [unit/rad].

        *Source: Murray1994, chapter 2: the pitch of a twist*
        """
        return dot(*self._columns)

    @property
    def axis(self) -> Array:
        """Points of the axes nearest to the reference point, shape (..., 6, 3) [unit].

        *Source: Murray1994, chapter 2: the axis of a twist*
        """
        shift, turn = self._columns
        return nearest_to_origin(turn, shift)

    @property
    def _columns(self) -> tuple[Array, Array]:
        rows = np.swapaxes(self.twists, -1, -2)
        return rows[..., :3], rows[..., 3:]


def eigenscrews(stiffness: ArrayLike) -> Eigenscrews:
    """Return the eigenscrews of symmetric, positive definite stiffness matrices.

    They solve K t = λ Δ t, where Δ exchanges the halves of a twist t = (δ, θ). Values, pitches and
    axes in space do not depend on the reference point of K.

    Parameters
    ----------
    stiffness : (..., 6, 6) array_like [force/unit, force, force · unit]
        As `gsp.stiffness` returns it without a preload.

    Returns
    -------
    Eigenscrews
        NaN where the matrix is.

    Raises
    ------
    InvalidInput
        If a matrix is not symmetric or not positive definite, or on another shape.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> screws = gsp.statics.eigenscrews(gsp.stiffness(d, d.home, 1000.0))
    >>> (screws.values > 0).tolist()
    [True, True, True, False, False, False]

    *Source: the eigenwrenches and eigentwists of Patterson and Lipkin (1993), J. Mech. Design 115*
    """
    given = check_array("stiffness", stiffness, (6, 6), finite=False)
    known = defined_matrices(given)
    matrix = np.where(known[..., None, None], given, np.eye(6))
    # In units of a power of two near the greatest element, so that no product overflows.
    power = np.frexp(np.abs(matrix).max(axis=(-2, -1)))[1] - 1
    matrix = np.ldexp(matrix, -power[..., None, None])
    # In the length that makes the traces of both diagonal blocks equal.
    traces = [np.trace(matrix[..., s, s], axis1=-2, axis2=-1) for s in (slice(3), slice(3, 6))]
    if min(trace.min(initial=np.inf) for trace in traces) <= 0.0:
        got = "one with a trace ≤ 0 of forces or of moments (of a singular posture?)"
        raise InvalidInput(expected("stiffness", "positive definite matrices", got))
    length = np.sqrt(traces[1] / traces[0])
    units = np.stack([np.ones_like(length)] * 3 + [1.0 / length] * 3, axis=-1)
    matrix = matrix * units[..., :, None] * units[..., None, :]
    _check_symmetric(matrix)
    values, twists = _of_definite(0.5 * (matrix + np.swapaxes(matrix, -1, -2)))
    twists = twists * units[..., :, None]
    twists = twists / np.linalg.norm(twists[..., 3:, :], axis=-2)[..., None, :]
    with np.errstate(over="ignore"):
        values = np.ldexp(values * length[..., None], power[..., None])
    return Eigenscrews(
        values=np.where(known[..., None], values, np.nan),
        twists=np.where(known[..., None, None], twists, np.nan),
    )


def _check_symmetric(matrix: Array) -> None:
    size = np.abs(matrix).max(axis=(-2, -1))
    apart = np.abs(matrix - np.swapaxes(matrix, -1, -2)).max(axis=(-2, -1))
    if (apart > SYMMETRY * size).any():
        wanted = "symmetric matrices (without a preload)"
        raise InvalidInput(expected("stiffness", wanted, "one that is not symmetric"))


def _of_definite(matrix: Array) -> tuple[Array, Array]:
    """Return λ, descending, and t of K t = λ Δ t: (..., 6) and (..., 6, 6).

    With K = R Rᵀ and t = Δ R y / λ, the λ are the eigenvalues of Rᵀ Δ R, near singular matrices
    the large ones to rounding. With t = R⁻ᵀ z, the 1/λ are those of R⁻¹ Δ R⁻ᵀ: the small ones.
    """
    sizes = np.linalg.eigvalsh(matrix)
    if (sizes[..., 0] <= DEFINITE_SHARE * sizes[..., -1]).any():
        got = "one that is not, to rounding (of a singular posture?)"
        raise InvalidInput(expected("stiffness", "positive definite matrices", got))
    root = np.linalg.cholesky(matrix)
    inverse = np.linalg.inv(root)
    swapped = np.roll(root, 3, axis=-2)  # Δ R
    large, y = np.linalg.eigh(np.swapaxes(root, -1, -2) @ swapped)
    inverses, z = np.linalg.eigh(np.roll(inverse, 3, axis=-1) @ np.swapaxes(inverse, -1, -2))
    # Both in descending order.
    large, y = large[..., ::-1], y[..., ::-1]
    order = np.argsort(-1.0 / inverses, axis=-1)
    small = np.take_along_axis(1.0 / inverses, order, axis=-1)
    z = np.take_along_axis(z, order[..., None, :], axis=-1)
    magnitudes = np.abs(large)
    middle = np.sqrt(magnitudes.max(axis=-1) * np.abs(small).min(axis=-1))
    first = magnitudes > middle[..., None]
    of_large = swapped @ y / np.where(first, large, 1.0)[..., None, :]
    of_small = np.swapaxes(inverse, -1, -2) @ z
    return np.where(first, large, small), np.where(first[..., None, :], of_large, of_small)
