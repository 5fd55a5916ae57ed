"""Static balance of a platform: forces of its actuators and the wrench on it.

The power of the actuators f·q̇ is that of the wrench they exert, w·(v, ω), for every twist. With
q̇ = J (v, ω) this is w = Jᵀ f.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import bounded_array
from gsp.checks import check_array
from gsp.geometry.matrices import defined_matrices, full_rank
from gsp.geometry.vectors import Array

# Condition number, of Frobenius norms, below which a matrix has full rank whatever rounding does,
# and its inverse takes no more than four digits.
CERTAIN = 1e4


def forces_or_nan(what: str, value: ArrayLike, number: int) -> Array:
    """Return forces of shape (..., number) as float64, with NaN where they are undefined.

    Raises
    ------
    InvalidInput
        On other shapes, infinite numbers or numbers beyond 1e100.
    """
    given = check_array(what, value, (number,), finite=False)
    bounded_array(what, np.where(np.isnan(given), 0.0, given), (number,))
    return given


def least_forces(jacobian: Array, wrench: Array) -> Array:
    """Return the solutions f of Jᵀ f = −w with the least Σ f², shape (..., n).

    They are unique if J is square. NaN where J is undefined or does not have full rank in double
    precision: then some wrenches have no balance, and others have many.

    Parameters
    ----------
    jacobian : (..., n, c) array [1]
    wrench : (..., c) array [force]
        The leading axes broadcast.
    """
    inverse = _inverses(jacobian)
    with np.errstate(invalid="ignore"):
        sizes = np.sqrt((jacobian**2).sum(axis=(-2, -1)) * (inverse**2).sum(axis=(-2, -1)))
        found = -np.squeeze(wrench[..., None, :] @ inverse, axis=-2)
    left = np.broadcast_to(~(sizes < CERTAIN), found.shape[:-1])
    if left.any():
        matrices, wrenches = (
            np.broadcast_to(x, left.shape + x.shape[-axes:])[left]
            for x, axes in ((jacobian, 2), (wrench, 1))
        )
        found[left] = _by_singular_values(matrices, wrenches)
    return np.asarray(found)


def _inverses(matrix: Array) -> Array:
    """Return inverses of square matrices; NaN, shape (..., c, n), where they are not at hand."""
    unknown = np.full(np.swapaxes(matrix, -1, -2).shape, np.nan)
    if matrix.shape[-2] != matrix.shape[-1]:
        return unknown
    try:
        return np.asarray(np.linalg.inv(matrix))
    except np.linalg.LinAlgError:  # of exactly singular ones
        with np.errstate(invalid="ignore"):
            sound = np.nan_to_num(np.linalg.det(matrix))[..., None, None] != 0.0
        inverses = np.linalg.inv(np.where(sound, matrix, np.eye(matrix.shape[-1])))
        return np.where(sound, inverses, unknown)


def _by_singular_values(jacobian: Array, wrench: Array) -> Array:
    """Return the solutions of `least_forces` for a list of matrices and of wrenches."""
    defined = defined_matrices(jacobian)
    u, s, vt = np.linalg.svd(np.where(defined[..., None, None], jacobian, 0.0), full_matrices=False)
    regular = defined & full_rank(s)
    inverse = 1.0 / np.where(regular[..., None], s, np.nan)
    along = (vt @ wrench[..., None])[..., 0] * inverse
    return np.asarray(-(u @ along[..., None])[..., 0])
