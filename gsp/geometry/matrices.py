"""Small-matrix numerics over batches in plain numpy; faster code is tested against it.

One NaN in a stack makes LAPACK refuse the whole stack, so undefined matrices are set aside
first and come back as NaN.
"""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import EPS, Array, Mask


def defined_matrices(matrix: Array) -> Mask:
    """Which matrices of a stack have finite entries only: (..., m, k) to (...)."""
    return np.asarray(np.isfinite(matrix).all(axis=(-2, -1)))


def singular_values(matrix: Array) -> Array:
    """Singular values, descending: (..., m, 6) to (..., 6); NaN where the matrix has a NaN."""
    defined = defined_matrices(matrix)
    safe = np.where(defined[..., None, None], matrix, 0.0)
    values = np.linalg.svd(safe, compute_uv=False)
    return np.where(defined[..., None], values, np.nan)


def reciprocal_condition(values: Array) -> Array:
    """σ_min / σ_max of descending singular values (..., k): in [0, 1], NaN where undefined.

    It is zero where σ_min is below the rounding of σ_max (the rank rule of numpy), because
    from there on the digits of σ_min mean nothing.
    """
    largest, smallest = values[..., 0], values[..., -1]
    floor = values.shape[-1] * EPS * largest
    with np.errstate(invalid="ignore"):
        ratio = smallest / np.where(largest > 0.0, largest, 1.0)
    return np.where(smallest <= floor, 0.0, ratio)


def absolute_determinant(matrix: Array) -> Array:
    """|det| of square matrices, else sqrt(det MᵀM) as the product of singular values: (...)."""
    if matrix.shape[-2] != matrix.shape[-1]:
        return np.asarray(np.prod(singular_values(matrix), axis=-1))
    defined = defined_matrices(matrix)
    safe = np.where(defined[..., None, None], matrix, 0.0)
    return np.where(defined, np.abs(np.linalg.det(safe)), np.nan)


def solve_right_triangular(matrix: Array, upper: Array) -> Array:
    """X = M U⁻¹ for upper triangular U: (..., n, k), (..., k, k) to (..., n, k).

    A zero on the diagonal gives infinities or NaN in that element only, without an error.
    """
    result = np.empty(np.broadcast_shapes(matrix.shape, (*upper.shape[:-2], *matrix.shape[-2:])))
    with np.errstate(all="ignore"):
        for j in range(upper.shape[-1]):
            known = (result[..., :j] @ upper[..., :j, j, None])[..., 0]
            result[..., j] = (matrix[..., j] - known) / upper[..., j, j, None]
    return result


def whiten(matrix: Array, metric_root: Array) -> Array:
    """Return M R⁻¹ with WᵀW = RᵀR, so that its σ⁻² are the eigenvalues of (WᵀW, MᵀM).

    Parameters
    ----------
    matrix : (..., n, 6) array
    metric_root : (..., m, 6) array
        W, m ≥ 6. R is its QR factor: neither WᵀW nor MᵀM is ever formed.

    Returns
    -------
    (..., n, 6) array; NaN where either is NaN, infinite or NaN where W has not full rank.
    """
    defined = defined_matrices(metric_root)[..., None, None]
    return solve_right_triangular(np.where(defined, matrix, np.nan), triangular_root(metric_root))


def triangular_root(metric_root: Array) -> Array:
    """R of the QR factors of W, so that WᵀW = RᵀR: (..., m, k) to (..., k, k), m ≥ k.

    The identity stands in where W is not finite.
    """
    defined = defined_matrices(metric_root)[..., None, None]
    safe = np.where(defined, metric_root, np.eye(*metric_root.shape[-2:]))
    upper: Array = np.linalg.qr(safe, mode="r")  # type: ignore[assignment]
    return upper
