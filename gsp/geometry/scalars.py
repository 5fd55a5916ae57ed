"""Scalars of any kind of number, and vectors as lists of them, three in space, two in the plane.

A formula that uses only `+ - * /` and the functions of this module runs on floats, on numpy arrays
(one array per component), on complex numbers, on mpmath numbers, on dual numbers
(`gsp.geometry.duals`), on the symbols of `gsp.kernels.trace`, and on any other kind of number that
has the methods `sqrt`, `atan2` and `__lt__`. It has no branches: a case distinction is
`choose(less(x, y), …)`. What `less` returns is a bool, a mask, or an object with a method
`choose(yes, no)`, so that an interval may return the hull of both cases.

A vector may also be one numpy array with the components along its first axis, which is faster
where arrays are small; the results have the same bits.

This is the only module that depends on the type of a number. Products of complex numbers are not
conjugated: `dot` and `norm` continue the real ones analytically, so that complex steps
differentiate and complex solutions of polynomial equations are solutions.

Python floats and mpmath numbers raise `ZeroDivisionError` where numpy arrays become infinite.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.duals import Dual

Scalar = Any
Vector = list[Any]


def components(array: NDArray[Any]) -> list[NDArray[Any]]:
    """Components of vectors, each a contiguous array with the first axis of `array` last.

    (N, ..., m) to m arrays (..., N). Functions like `arctan2` round differently on some machines
    when numbers are not neighbours in memory; so the result for one pose does not depend on the
    others.
    """
    return list(np.ascontiguousarray(array.transpose(*range(array.ndim)[::-1])))


def root(x: Scalar) -> Scalar:
    """Square root; the principal one of a complex number."""
    if isinstance(x, np.ndarray | np.float64):
        return np.sqrt(x)
    if isinstance(x, float | int):
        return math.sqrt(x)
    return cmath.sqrt(x) if isinstance(x, complex) else _apply("sqrt", x)


def arc(sine: Scalar, cosine: Scalar) -> Scalar:
    """Angle in (0, π) [rad] from multiples of its sine, which is positive, and of its cosine.

    Of complex numbers it is π/2 − atan(cosine / sine): analytic, and so exact for complex steps,
    which the logarithm of cosine + i sine would lose in rounding.
    """
    if isinstance(sine, np.ndarray):
        if np.iscomplexobj(sine):
            return np.pi / 2 - np.arctan(cosine / sine)
        return np.arctan2(sine, cosine)
    if isinstance(sine, float | int):
        return math.atan2(sine, cosine)
    if isinstance(sine, complex):
        return math.pi / 2 - cmath.atan(cosine / sine)
    context = getattr(sine, "context", None)
    if context is not None and isinstance(sine, context.mpc):
        return context.pi / 2 - context.atan(cosine / sine)
    return _apply("atan2", sine, cosine)


def full_arc(sine: Scalar, cosine: Scalar) -> Scalar:
    """Angle in (−π, π] [rad] from multiples of its sine and of its cosine; not of complex numbers.

    Parameters
    ----------
    sine, cosine : real scalars of the same kind
    """
    if isinstance(sine, np.ndarray):
        angle: Any = np.arctan2(sine, cosine)
    elif isinstance(sine, float | int):
        angle = math.atan2(sine, cosine)
    else:
        angle = _apply("atan2", sine, cosine)
    # A sine of −0, or below it by rounding, gives −π.
    return choose(less(-math.pi, angle), angle, angle + math.tau)


def _apply(name: str, x: Any, *others: Any) -> Any:
    """Call a method of a number, or the function of that name of its mpmath context."""
    method = getattr(x, name, None)
    return getattr(x.context, name)(x, *others) if method is None else method(*others)


def less(x: Scalar, y: Scalar) -> Any:
    """Condition x < y for `choose`; of complex numbers the real parts are compared."""
    left: Any = getattr(x, "real", x)
    return left < getattr(y, "real", y)


def choose(condition: Any, yes: Any, no: Any) -> Any:
    """Return `yes` where the condition holds, else `no`; both have been computed."""
    if isinstance(condition, np.ndarray):
        if isinstance(yes, Dual):
            return yes.where(condition, no)
        return no.where(~condition, yes) if isinstance(no, Dual) else np.where(condition, yes, no)
    if isinstance(condition, bool | np.bool_):
        return yes if condition else no
    return condition.choose(yes, no)


def dot(x: Sequence[Any], y: Sequence[Any]) -> Scalar:
    """Scalar product, without conjugation."""
    if isinstance(x, np.ndarray) and isinstance(y, np.ndarray):
        return np.add.reduce(x * y, axis=0)
    total = x[0] * y[0]
    for a, b in zip(x[1:], y[1:], strict=True):
        total = total + a * b
    return total


def cross(x: Vector, y: Vector) -> Vector:
    """Vector product."""
    return [
        x[1] * y[2] - x[2] * y[1],
        x[2] * y[0] - x[0] * y[2],
        x[0] * y[1] - x[1] * y[0],
    ]


def times(factor: Scalar, x: Sequence[Any]) -> Vector:
    """Vector multiplied by a scalar."""
    if isinstance(x, np.ndarray):
        return factor * x
    return [factor * a for a in x]


def plus(x: Sequence[Any], y: Sequence[Any]) -> Vector:
    """Sum of two vectors."""
    if isinstance(x, np.ndarray) and isinstance(y, np.ndarray):
        return x + y
    return [a + b for a, b in zip(x, y, strict=True)]


def minus(x: Sequence[Any], y: Sequence[Any]) -> Vector:
    """Difference of two vectors."""
    if isinstance(x, np.ndarray) and isinstance(y, np.ndarray):
        return x - y
    return [a - b for a, b in zip(x, y, strict=True)]


def norm(x: Sequence[Any]) -> Scalar:
    """Square root of the scalar product of a vector with itself."""
    return root(dot(x, x))


def turned(rotation: Sequence[Any], x: Sequence[Any]) -> Vector:
    """R x, with R as nine scalars by rows, four in the plane."""
    n = len(x)
    if isinstance(rotation, np.ndarray) and isinstance(x, np.ndarray):
        # Three terms are added one after the other, as by `dot`.
        return np.add.reduce(rotation.reshape(n, n, *rotation.shape[1:]) * x, axis=1)
    return [dot(rotation[n * i : n * i + n], x) for i in range(n)]


def rotation_from_quaternion(x: Sequence[Any]) -> Vector:
    """R as nine scalars by rows, times x · x, for a quaternion x = (w, x, y, z).

    Without divisions, so that integers stay exact.
    """
    w, i, j, k = x
    return [
        w * w + i * i - j * j - k * k, (i * j - w * k) * 2, (i * k + w * j) * 2,
        (i * j + w * k) * 2, w * w - i * i + j * j - k * k, (j * k - w * i) * 2,
        (i * k - w * j) * 2, (j * k + w * i) * 2, w * w - i * i - j * j + k * k,
    ]  # fmt: skip
