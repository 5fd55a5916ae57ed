"""Three-vectors over leading batch axes: products, norms, unit vectors, checks."""

from __future__ import annotations

import operator
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.errors import InvalidInput, brief, expected

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

EPS = float(np.finfo(np.float64).eps)
SMALLEST = float(np.finfo(np.float64).tiny)


def dot(x: Array, y: Array) -> Array:
    """Scalar product over the last axis, shape (...)."""
    return np.asarray(np.einsum("...i,...i->...", x, y), dtype=np.float64)


def cross(x: Array, y: Array) -> Array:
    """Vector product over the last axis, shape (..., 3)."""
    x0, x1, x2 = x[..., 0], x[..., 1], x[..., 2]
    y0, y1, y2 = y[..., 0], y[..., 1], y[..., 2]
    return np.stack((x1 * y2 - x2 * y1, x2 * y0 - x0 * y2, x0 * y1 - x1 * y0), axis=-1)


def norm(x: Array) -> Array:
    """Euclidean norm over the last axis, shape (...)."""
    return np.sqrt(dot(x, x))


def unit(x: Array) -> Array:
    """Vectors of norm one; a zero vector becomes NaN, and a unit vector comes back unchanged."""
    length = norm(x)[..., None]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(np.abs(length - 1.0) <= 4 * EPS, x, x / length)


def skew(x: Array) -> Array:
    """Matrices of the map y -> x × y, shape (..., 3, 3)."""
    matrix = np.zeros((*x.shape, 3))
    matrix[..., 0, 1], matrix[..., 0, 2] = -x[..., 2], x[..., 1]
    matrix[..., 1, 0], matrix[..., 1, 2] = x[..., 2], -x[..., 0]
    matrix[..., 2, 0], matrix[..., 2, 1] = -x[..., 1], x[..., 0]
    return matrix


def frozen(array: ArrayLike) -> Array:
    """Return a read-only float64 copy, for use in records."""
    copy = np.array(array, dtype=np.float64)
    copy.flags.writeable = False
    return copy


def check_array(
    what: str, value: ArrayLike, shape: Sequence[int | None], *, finite: bool = True
) -> Array:
    """Return `value` as float64 if its last axes are `shape` (None: any size), else raise.

    Raises
    ------
    InvalidInput
        On a wrong type or shape, or on numbers that are not finite.
    """
    array = _real(what, value)
    last = array.shape[array.ndim - len(shape) :] if array.ndim >= len(shape) else None
    if last is None or any(w is not None and w != g for w, g in zip(shape, last, strict=True)):
        wanted = ", ".join("n" if w is None else str(w) for w in shape)
        dots = ", ".join(("...", wanted)) if shape else "..."
        raise InvalidInput(expected(what, f"shape ({dots})", f"shape {array.shape}"))
    if finite and not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise InvalidInput(
            expected(what, "finite numbers", str(array[where]), f"at index {list(where)}")
        )
    return array


_NO_NUMBERS = (str, bytes, bool, type(None))


def _real(what: str, value: ArrayLike) -> Array:
    """Float64 of integers, floats and objects that are real numbers; not of text or booleans."""
    try:
        raw = np.asarray(value)
        odd = raw.dtype.kind == "O" and any(isinstance(x, _NO_NUMBERS) for x in raw.flat)
        if raw.dtype.kind not in "iufO" or odd or np.ma.is_masked(value):
            raise TypeError(raw.dtype)
        with np.errstate(over="ignore"):
            return np.asarray(raw, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidInput(expected(what, "real numbers", brief(value))) from error


def check_positive(what: str, value: Any) -> float:
    """Return `value` as a float if it is one positive finite number, else raise InvalidInput.

    Numbers below 2.2e-308, which have no finite inverse, are refused too.
    """
    try:
        number = _real(what, value)
    except InvalidInput:
        number = np.array(np.nan)
    if number.ndim or not SMALLEST <= number < np.inf:
        raise InvalidInput(expected(what, "a positive number", brief(value)))
    return float(number)


def check_integer(what: str, value: Any, least: int = 1) -> int:
    """Return `value` as an int if it is an integer ≥ `least` (no float, no bool), else raise."""
    try:
        number = least - 1 if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = least - 1
    if not least <= number <= sys.maxsize:
        raise InvalidInput(expected(what, f"an integer ≥ {least}", brief(value)))
    return number


def check_text(what: str, value: Any) -> str:
    """Return `value` if it is text that UTF-8 can hold, else raise InvalidInput."""
    if not isinstance(value, str):
        raise InvalidInput(expected(what, "a text", brief(value)))
    try:
        value.encode()
    except UnicodeEncodeError as error:
        raise InvalidInput(expected(what, "a text in Unicode", brief(value))) from error
    return str(value)


def check_rng(what: str, value: Any) -> np.random.Generator:
    """Return a generator from a seed (an integer ≥ 0) or the given `numpy.random.Generator`."""
    if isinstance(value, np.random.Generator):
        return value
    try:
        return np.random.default_rng(check_integer(what, value, least=0))
    except InvalidInput:
        wanted = "a seed (an integer ≥ 0) or a numpy.random.Generator"
        raise InvalidInput(expected(what, wanted, brief(value))) from None
