"""Three-vectors over leading batch axes: products, norms, unit vectors."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

EPS = float(np.finfo(np.float64).eps)

Number = TypeVar("Number", np.float64, np.int64, np.complex128)


def dot(x: Array, y: Array) -> Array:
    """Scalar product over the last axis, shape (...)."""
    return np.asarray(np.einsum("...i,...i->...", x, y), dtype=np.float64)


def cross(x: NDArray[Number], y: NDArray[Number]) -> NDArray[Number]:
    """Vector product over the last axis, shape (..., 3); of real, whole or complex numbers."""
    x0, x1, x2 = x[..., 0], x[..., 1], x[..., 2]
    y0, y1, y2 = y[..., 0], y[..., 1], y[..., 2]
    return np.stack((x1 * y2 - x2 * y1, x2 * y0 - x0 * y2, x0 * y1 - x1 * y0), axis=-1)


def norm(x: Array) -> Array:
    """Euclidean norm over the last axis, shape (...)."""
    return np.sqrt(dot(x, x))


def unit(x: Array) -> Array:
    """Vectors of norm one; a zero vector becomes NaN, and a unit vector is returned unchanged."""
    length = norm(x)[..., None]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(np.abs(length - 1.0) <= 4 * EPS, x, x / length)


def perpendicular(x: Array) -> Array:
    """Return unit vectors perpendicular to vectors, shape (..., 3); NaN for a zero vector.

    x × e with e along the coordinate axis that x has the least component along.
    """
    return unit(cross(x, np.eye(3)[np.abs(x).argmin(axis=-1)]))


def nearest_to_origin(direction: Array, moment: Array) -> Array:
    """Points of lines nearest to the origin, from unit directions and moments, shape (..., 3)."""
    return cross(direction, moment)


def skew(x: Array) -> Array:
    """Matrices of the map y -> x × y, shape (..., 3, 3)."""
    matrix = np.zeros((*x.shape, 3))
    matrix[..., 0, 1], matrix[..., 0, 2] = -x[..., 2], x[..., 1]
    matrix[..., 1, 0], matrix[..., 1, 2] = x[..., 2], -x[..., 0]
    matrix[..., 2, 0], matrix[..., 2, 1] = -x[..., 1], x[..., 0]
    return matrix


def frozen(array: ArrayLike) -> Array:
    """Return a read-only float64 copy in C order, for use in records.

    Sums over arrays of another order differ in the last bit.
    """
    copy = np.array(array, dtype=np.float64, order="C")
    copy.flags.writeable = False
    return copy
