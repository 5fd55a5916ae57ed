"""Compiled expansions of polynomials of position and rotation over a box; this loads numba.

The unit coordinates of a box are those of `lengths.py`.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array

# Rounding of a value of a polynomial relative to the sum of the magnitudes of all terms.
VALUE_ROUNDING = 2.0**-42


@njit(error_model="numpy", nogil=True)
def shift(values: Array, steps: Array, centre: Array) -> None:
    """Expand polynomials, whose coefficients are columns, about another centre, in place."""
    for n in range(len(steps)):
        c, to, of = centre[steps[n, 0]], steps[n, 1], steps[n, 2]
        for m in range(values.shape[1]):
            values[to, m] += c * values[of, m]


@njit(error_model="numpy", nogil=True)
def scale(values: Array, exponents: Array, width: Array) -> None:
    """Multiply coefficients with powers of the half-widths, in place."""
    for n in range(len(exponents)):
        factor = 1.0
        for k in range(3):
            for _ in range(exponents[n, k]):
                factor *= width[k]
        for m in range(values.shape[1]):
            values[n, m] *= factor


@njit(error_model="numpy", nogil=True)
def in_rotation(
    coefficients: Array,
    x: Array,
    width: Array,
    order: Array,
    steps: Array,
    exponents: Array,
    table: Array,
    start: Array,
    tails: Array,
) -> None:
    """Expand polynomials about the middle of a box of rotations, to degree 2.

    Parameters
    ----------
    coefficients : (m, 84, 20) array
    x, width : (3,), (6,) arrays
        Middle and half-widths.
    order : (10,) int array
        Rows of the monomials 1, the three coordinates, squares, products.
    table : (84, 20) array
        Space.
    start, tails : (20, 10 m), (20 m,) arrays
        The coefficients, and the sums of magnitudes of those of higher degree, for each monomial of
        the position.
    """
    for c in range(len(coefficients)):
        table[:] = coefficients[c]
        shift(table, steps, x)
        scale(table, exponents, width[3:])
        for m in range(20):
            tails[20 * c + m] = 0.0
            for n in range(10):
                start[m, 10 * c + n] = table[order[n], m]
        for n in range(len(exponents)):
            if exponents[n, 0] + exponents[n, 1] + exponents[n, 2] > 2:
                for m in range(20):
                    tails[20 * c + m] += abs(table[n, m])


@njit(error_model="numpy", nogil=True)
def in_position(
    start: Array,
    p: Array,
    width: Array,
    tails: Array,
    majorants: Array,
    lost: float,
    steps: Array,
    exponents: Array,
    values: Array,
    rests: Array,
) -> None:
    """Expand polynomials about a position, with rests of all that is of third order in δ.

    Parameters
    ----------
    start, tails : (20, 10 m), (20 m,) arrays
        See `in_rotation`.
    majorants : (m, 4) array
        Sums of the magnitudes of all coefficients, for each degree in the position.
    lost : float
        What the tolerance of anchors changes, a part of the rests as the rounding is.
    values, rests : (20, 10 m), (m,) arrays
    """
    values[:] = start
    shift(values, steps, p)
    scale(values, exponents, width)
    size, many = 0.0, len(majorants)
    for k in range(3):
        size += (abs(p[k]) + width[k]) ** 2
    far = np.sqrt(size)
    for c in range(many):
        rests[c], power = lost, VALUE_ROUNDING
        for k in range(4):
            rests[c] += majorants[c, k] * power
            power *= far
    for n in range(20):
        degree, power = 0, 1.0
        for k in range(3):
            degree += exponents[n, k]
            for _ in range(exponents[n, k]):
                power *= abs(p[k]) + width[k]
        for c in range(many):
            rest = tails[20 * c + n] * power
            if degree >= 3:
                rest += abs(values[n, 10 * c])
            if degree >= 2:
                for m in range(1, 4):
                    rest += abs(values[n, 10 * c + m])
            if degree >= 1:
                for m in range(4, 10):
                    rest += abs(values[n, 10 * c + m])
            rests[c] += rest


@njit(error_model="numpy", nogil=True)
def derivatives(values: Array, first: int, slope: Array, bend: Array) -> None:
    """Write gradient and Hessian of a polynomial from its coefficients, ten columns from one on.

    The monomials of the position are 1, z, z², z³, y, yz, …: z is number 1, y 4 and x 10.
    """
    one = (10, 4, 1)
    two = (16, 7, 2)
    for j in range(3):
        slope[j], slope[3 + j] = values[one[j], first], values[0, first + 1 + j]
        bend[j, j] = 2.0 * values[two[j], first]
        bend[3 + j, 3 + j] = 2.0 * values[0, first + 4 + j]
        for n in range(3):
            bend[3 + n, j] = values[one[j], first + 1 + n]
    bend[1, 0], bend[2, 0], bend[2, 1] = values[13, first], values[11, first], values[5, first]
    bend[4, 3], bend[5, 3], bend[5, 4] = (
        values[0, first + 7],
        values[0, first + 8],
        values[0, first + 9],
    )
