"""Derivatives of extreme singular values, also where they are repeated, and of inverses."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.matrices import (
    defined_matrices,
    full_rank,
    log_and_inverse,
    solve_right_triangular,
    triangular_root,
)
from gsp.geometry.vectors import Array, Mask

# Singular values whose gap is a smaller share of the largest one count as one, repeated: of vectors
# of a gap g rounding leaves EPS / g.
REPEATED_GAP = 1e-10
# Derivatives of repeated values that differ by a smaller share of all derivatives are equal.
SAME_SLOPE = 1e-7


class Extremes(NamedTuple):
    """The largest and the smallest singular value, and their derivatives along k directions.

    Attributes
    ----------
    largest, smallest : (..., 1) arrays
    rise, low_rise : (..., k) arrays
        Derivatives of the largest and of the smallest; NaN where there is none.
    """

    largest: Array
    smallest: Array
    rise: Array
    low_rise: Array

    @property
    def condition(self) -> Array:
        """Derivative of σ_max / σ_min, shape (..., k)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return -self.reciprocal * (self.largest / self.smallest) ** 2

    @property
    def reciprocal(self) -> Array:
        """Derivative of σ_min / σ_max, shape (..., k)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return (self.low_rise - self.rise * (self.smallest / self.largest)) / self.largest


def extremes(matrix: Array, slopes: Array) -> Extremes:
    """Return the extreme singular values of matrices, and their derivatives.

    Parameters
    ----------
    matrix : (..., n, c) array, n ≥ c
    slopes : (..., k, n, c) array
        Derivatives of the entries along k directions.
    """
    left, values, right = decomposed(matrix)
    block = np.swapaxes(left, -1, -2)[..., None, :, :] @ slopes @ right[..., None, :, :]
    return of_block(values, block)


def decomposed(matrix: Array) -> tuple[Array, Array, Array]:
    """Return U (..., n, c), σ (..., c) and V (..., c, c) of M = U diag(σ) Vᵀ, NaN where M is."""
    known = defined_matrices(matrix)[..., None, None]
    left, values, right = np.linalg.svd(np.where(known, matrix, 0.0), full_matrices=False)
    return left, np.where(known[..., 0], values, np.nan), np.swapaxes(right, -1, -2)


def of_block(values: Array, block: Array) -> Extremes:
    """Return the extremes of singular values (..., c) with Uᵀ dM V (..., k, c, c).

    A value of multiplicity m has m derivatives, the eigenvalues of the symmetric part of its
    m × m block. It is differentiable if they are equal; else the largest value has a kink.
    There is no derivative either where the rank is not full: |x| has none at 0.
    """
    with np.errstate(invalid="ignore"):
        regular = full_rank(values)[..., None]
        symmetric = (block + np.swapaxes(block, -1, -2)) / 2.0
        gap = REPEATED_GAP * values[..., :1]
        rises = [
            np.where(regular, shared_slope(symmetric, np.abs(values - end) <= gap), np.nan)
            for end in (values[..., :1], values[..., -1:])
        ]
    return Extremes(values[..., :1], values[..., -1:], *rises)


def shared_slope(block: Array, chosen: Mask) -> Array:
    """Return the derivative that chosen values share, (..., k); NaN where they differ.

    Parameters
    ----------
    block : (..., k, c, c) array
        Symmetric.
    chosen : (..., c) bool array
    """
    both = (chosen[..., :, None] & chosen[..., None, :])[..., None, :, :]
    count = chosen.sum(axis=-1)[..., None]
    trace = np.where(chosen[..., None, :], np.diagonal(block, axis1=-2, axis2=-1), 0.0)
    mean = trace.sum(axis=-1) / np.maximum(count, 1)
    apart = block - mean[..., None, None] * np.eye(block.shape[-1])
    gap = np.abs(np.where(both, apart, 0.0)).max(axis=(-2, -1))
    return np.where(
        gap <= SAME_SLOPE * np.abs(block).max(axis=(-3, -2, -1))[..., None], mean, np.nan
    )


def whitened_extremes(matrix: Array, root: Array, slopes: Array, root_slopes: Array) -> Extremes:
    """Return the extreme singular values of M R⁻¹ with WᵀW = RᵀR, and their derivatives.

    With x_i = R⁻¹ v_i and y_i = W x_i the block is u_i · dM x_j − σ_i y_i · dW x_j, the second
    product taken symmetric: R is determined but for a rotation, which moves no singular value.

    Parameters
    ----------
    matrix : (..., n, c) array
        M.
    root : (..., m, c) array
        W.
    slopes, root_slopes : (..., k, n, c) and (..., k, m, c) arrays
    """
    inverse = solve_right_triangular(np.eye(root.shape[-1]), triangular_root(root))
    usable = defined_matrices(inverse) & defined_matrices(root)
    inverse = np.where(usable[..., None, None], inverse, np.nan)
    left, values, right = decomposed(matrix @ inverse)
    x = (inverse @ right)[..., None, :, :]
    y = root[..., None, :, :] @ x
    with np.errstate(invalid="ignore"):
        inner = np.swapaxes(y, -1, -2) @ root_slopes @ x
        inner = (inner + np.swapaxes(inner, -1, -2)) / 2.0
        outer = np.swapaxes(left, -1, -2)[..., None, :, :] @ slopes @ x
        return of_block(values, outer - values[..., None, :, None] * inner)


def inverse_and_slopes(rows: Array, rates: Array) -> tuple[Array, Array]:
    """Return the (pseudo-)inverse of a Jacobian, and its derivatives along k directions.

    dJ⁺ = −J⁺ dJ J⁺ + J⁺ J⁺ᵀ dJᵀ (1 − J J⁺), for J of full rank.

    Parameters
    ----------
    rows : (..., n, 6) array, n ≥ 6
    rates : (..., k, n, 6) array

    Returns
    -------
    (..., 6, n) and (..., k, 6, n) arrays
        Numbers without a meaning where J does not have full rank.
    """
    inverse = log_and_inverse(rows)[1]
    each = inverse[..., None, :, :]
    rest = np.eye(rows.shape[-2]) - rows[..., None, :, :] @ each
    turned = each @ np.swapaxes(each, -1, -2) @ np.swapaxes(rates, -1, -2) @ rest
    return inverse, np.asarray(turned - each @ rates @ each)
