"""The exact coefficients of P(p, q) = det J Π l_i |q|⁶ of six D1 legs, and of its cofactors."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from itertools import combinations, product
from math import factorial

import numpy as np

from gsp.geometry.scalars import rotation_from_quaternion
from gsp.geometry.vectors import Array

Powers = tuple[int, int, int]
# Numbers of legs, in order.
Legs = tuple[int, ...]


def powers(degree: int) -> list[Powers]:
    """Return the exponents (i, j, k) of all monomials of three variables up to a degree."""
    span = range(degree + 1)
    return [(i, j, k) for i in span for j in span for k in span if i + j + k <= degree]


# Monomials of the position, and of three of the coordinates of q, the fourth being 1.
POSITION, ROTATION = powers(3), powers(6)
TRIPLES = list(combinations(range(6), 3))
PAIRS = list(combinations(range(6), 2))
# P, and the cofactors of each leg.
SINGLE: tuple[Legs, ...] = ((), (0,), (1,), (2,), (3,), (4,), (5,))


def coefficients(base: Array, platform: Array, free: Sequence[Legs] = SINGLE) -> Array:
    """Return the coefficients of P and of its cofactors for q = (1, x).

    The cofactors of some legs are P with each of their leg vectors d_i replaced by a column of the
    rotation matrix. All are known at as many integer points as they have coefficients, where they
    are computed in integers, and are interpolated by divided differences, in integers as well. That
    the degrees are at most 3 and 6 is checked at a further point.

    Parameters
    ----------
    base, platform : (6, 3) arrays [length]
    free : sequence of tuples of int
        Legs whose vectors are replaced; () for P itself.

    Returns
    -------
    (m, 84, 20) array
        Of each entry of `free` all 3^n cofactors, the column of its last leg first in turn, for the
        monomials `ROTATION` of x and `POSITION` of p. They are doubles next to the exact numbers.

    *Source: ours; the degree 3 in the position is well known.*
    """
    scale, a, b = _integers(base, platform)
    values = _values(a, b, scale * _objects(POSITION), _objects(ROTATION), free)
    rows = _interpolated({p: values[:, n] for n, p in enumerate(POSITION)}, 3)
    mixed = np.stack([rows[p] for p in POSITION], axis=1)
    table = _interpolated({x: mixed[n] for n, x in enumerate(ROTATION)}, 6)
    exact = np.stack([table[x] for x in ROTATION])
    multiple = factorial(3) * factorial(6)
    _check(exact, multiple, scale, a, b, free)
    # P is of degree 9 in lengths, with those of p, and cofactors of one leg of degree 8. The
    # quotient of two integers is rounded once.
    lengths = np.repeat([9 - len(some) for some in free], [3 ** len(some) for some in free])
    units = _objects([multiple * scale ** int(n) for n in lengths])
    return np.moveaxis(np.asarray(exact / units, dtype=np.float64), 2, 0)


def charts(first: Array) -> Array:
    """Return the coefficients where q₀, q₁, q₂ or q₃ is 1, shape (4, m, 84, 20).

    Parameters
    ----------
    first : (m, 84, 20) array
        Those where q₀ is 1.
    """
    place = {x: n for n, x in enumerate(ROTATION)}
    result = np.zeros((4, *first.shape))
    for n, x in enumerate(ROTATION):
        exponents = (6 - sum(x), *x)
        for chart in range(4):
            i, j, k = (e for m, e in enumerate(exponents) if m != chart)
            result[chart, :, place[i, j, k]] = first[:, n]
    return result


def along(point: Powers, axis: int, degree: int) -> list[Powers]:
    """Return the points of `powers(degree)` along an axis from a point where it is zero."""
    line = [list(point) for _ in range(degree + 1 - sum(point))]
    for number, other in enumerate(line):
        other[axis] = number
    return [(i, j, k) for i, j, k in line]


def _objects(numbers: object) -> Array:
    """Return an array of Python integers, which are exact."""
    return np.array(numbers, dtype=object)


def _integers(base: Array, platform: Array) -> tuple[int, Array, Array]:
    """Return anchors as exact integers, and what they were multiplied with, a power of two."""
    parts = [[[Fraction(float(v)) for v in row] for row in body] for body in (base, platform)]
    scale = max(v.denominator for body in parts for row in body for v in row)
    a, b = (_objects([[int(v * scale) for v in row] for row in body]) for body in parts)
    return scale, a, b


def _values(a: Array, b: Array, positions: Array, rotations: Array, free: Sequence[Legs]) -> Array:
    """Return P and its cofactors at integer points, shape (rotations, positions, m).

    With s = |q|² the rows are s d and a × s d, and the determinant is divided by s³.
    """
    turns = _objects([rotation_from_quaternion((1, *x)) for x in rotations]).reshape(-1, 3, 3)
    s = _objects([1 + sum(k * k for k in x) for x in rotations])
    d = (turns @ b.T).swapaxes(1, 2)[:, None]
    d = d + s[:, None, None, None] * (positions[:, None] - a)
    rows = _lines(a, d)
    directions = np.broadcast_to(turns.swapaxes(1, 2)[:, None], (len(turns), 6, 3, 3))
    columns = _lines(a[:, None], directions)

    @cache
    def minors(half: int, replaced: tuple[tuple[int, int], ...]) -> dict[Legs, Array]:
        part = rows[..., 3 * half : 3 * half + 3, :].copy()
        for i, k in replaced:
            part[..., i % 3, :] = columns[:, None, i, k]
        return _minors(part)

    result = []
    for legs in free:
        for axes in product(range(3), repeat=len(legs)):
            replaced = list(zip(legs, axes, strict=True))
            halves = [minors(h, tuple(x for x in replaced if x[0] // 3 == h)) for h in range(2)]
            result.append(_laplace(*halves))
    total, cube = np.stack(result, axis=-1), (s**3)[:, None, None]
    if (total % cube).any():
        raise ArithmeticError("the determinant of six lines is not a polynomial of degree 6")
    return np.asarray(total // cube)


def _lines(a: Array, d: Array) -> Array:
    """Return the rows (d, a × d)."""
    moments = [a[..., i] * d[..., j] - a[..., j] * d[..., i] for i, j in ((1, 2), (2, 0), (0, 1))]
    return np.concatenate((d, np.stack(moments, axis=-1)), axis=-1)


def _minors(rows: Array) -> dict[Legs, Array]:
    """Return the determinants of three rows (..., 3, 6) for each three columns."""
    first, second, third = (rows[..., n, :] for n in range(3))
    two = {
        (i, j): first[..., i] * second[..., j] - first[..., j] * second[..., i] for i, j in PAIRS
    }
    return {
        (i, j, k): two[i, j] * third[..., k] - two[i, k] * third[..., j] + two[j, k] * third[..., i]
        for i, j, k in TRIPLES
    }


def _laplace(top: dict[Legs, Array], bottom: dict[Legs, Array]) -> Array:
    """Return the determinant from the minors of its first and of its last three rows."""
    total: Array = np.zeros((), dtype=object)
    for columns in TRIPLES:
        rest = tuple(k for k in range(6) if k not in columns)
        term = top[columns] * bottom[rest]
        total = total + term if sum(columns) % 2 else total - term
    return total


def _interpolated(values: dict[Powers, Array], degree: int) -> dict[Powers, Array]:
    """Return degree! times the coefficients of polynomials with given values at `powers`.

    With that factor all divided differences are integers.
    """
    table = {point: factorial(degree) * value for point, value in values.items()}
    for step in (_differences, _monomials):
        for axis in range(3):
            for point in powers(degree):
                if point[axis] == 0:
                    step(table, along(point, axis, degree))
    return table


def _differences(table: dict[Powers, Array], line: list[Powers]) -> None:
    """Replace values at 0, 1, 2, … by divided differences, the coefficients of Newton's form."""
    for order in range(1, len(line)):
        for i in range(len(line) - 1, order - 1, -1):
            table[line[i]] = (table[line[i]] - table[line[i - 1]]) // order


def _monomials(table: dict[Powers, Array], line: list[Powers]) -> None:
    """Replace the coefficients of Newton's form by those of monomials."""
    for node in range(len(line) - 2, -1, -1):
        for i in range(node, len(line) - 1):
            table[line[i]] = table[line[i]] - node * table[line[i + 1]]


def _check(
    exact: Array, multiple: int, scale: int, a: Array, b: Array, free: Sequence[Legs]
) -> None:
    """Compare the polynomials with their values at a point that they were not made from."""
    p, x = _objects([(5, -3, 2)]), _objects([(-3, 2, 5)])
    at = [np.prod(point ** _objects(e), axis=1) for point, e in ((x, ROTATION), (p, POSITION))]
    total = at[1] @ np.tensordot(at[0], exact, axes=(0, 0))
    if (total != multiple * _values(a, b, scale * p, x, free)[0, 0]).any():
        raise ArithmeticError("the determinant of six lines has another degree than 3 and 6")
