"""Compiled expansions of the logarithms of lengths of quaternions over a box.

A box has its centre (p, q), one coordinate of q being 1, and half-widths of the position and of the
other three coordinates. Its unit coordinates δ are in [−1, 1]⁶. Arrays are written to and kept by
the caller, as small ones are slow to make. Importing this loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.proof.sextic.space import MOST_FREE_LEGS

# Roundings: of a leg quaternion relative to the sum of the magnitudes of all terms, and of sums of
# few terms.
QUATERNION_ROUNDING, LENGTH_SUM_ROUNDING = 2.0**-46, 2.0**-40
# A quaternion that varies by more than this share of itself is not expanded.
LARGEST_EXPANDED_SHARE = 0.8
# Rows of an expansion: gradient; Hessian, below the diagonal and on it, from row 1 on; squares of
# the shares by which the coordinates vary the quaternions; numbers: the square of the product in
# the middle, the rest of its logarithm, and the largest share by which one quaternion varies.
GRADIENT, HESSIAN, SHARES, NUMBERS = 0, 1, 7, 8
SQUARE, REST, SHARE = range(3)
# Numbers of a box: largest |q|, and those of a design: largest norms of anchors, their tolerance.
LARGEST_NORM, BASE, PLATFORM, TOLERANCE = range(4)


@njit(error_model="numpy", nogil=True)
def product(a: Array, b: Array, out: Array) -> None:
    """Write the product of two quaternions."""
    out[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3]
    out[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2]
    out[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1]
    out[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]


@njit(error_model="numpy", nogil=True)
def leg(u: Array, v: Array, q: Array, chart: int, width: Array, parts: Array, work: Array) -> None:
    """Write E = u q + q v, its derivatives along δ, and what is mixed: rows 0, 1–6, 7–15."""
    s, t, zero = work[0], work[1], work[2]
    product(u, q, s)
    product(q, v, t)
    for m in range(4):
        parts[0, m] = s[m] + t[m]
        zero[m] = 0.0
    for j in range(3):
        zero[1 + j] = width[j]
        product(zero, q, parts[1 + j])
        zero[1 + j] = 0.0
    n = 0
    for k in range(4):
        if k != chart:
            zero[k] = width[3 + n]
            product(u, zero, s)
            product(zero, v, t)
            for m in range(4):
                parts[4 + n, m] = s[m] + t[m]
                t[m] = 0.0
            for j in range(3):
                t[1 + j] = width[j]
                product(t, zero, parts[7 + 3 * j + n])
                t[1 + j] = 0.0
            zero[k] = 0.0
            n += 1


@njit(error_model="numpy", nogil=True)
def inner(parts: Array, i: int, j: int) -> float:
    """Return the scalar product of two quaternions."""
    return float(
        parts[i, 0] * parts[j, 0]
        + parts[i, 1] * parts[j, 1]
        + parts[i, 2] * parts[j, 2]
        + parts[i, 3] * parts[j, 3]
    )


@njit(error_model="numpy", nogil=True)
def logarithm(parts: Array, mixed: float, lost: float, out: Array) -> None:
    """Write the expansion of log|E| to second order, with its rest; inf if E varies too much.

    Parameters
    ----------
    parts : (16, 4) array
        See `leg`.
    mixed, lost : float
        What the mixed terms of E, and the tolerance of anchors and the rounding, are at most.
    out : (9, 6) array
    """
    square, first = inner(parts, 0, 0), 0.0
    for k in range(6):
        out[GRADIENT, k] = inner(parts, 0, 1 + k) / square
        for m in range(k + 1):
            both = inner(parts, 1 + k, 1 + m)
            first += abs(both) if m == k else 2.0 * abs(both)
            out[HESSIAN + k, m] = both / square - 2.0 * out[GRADIENT, k] * out[GRADIENT, m]
        out[SHARES, k] = inner(parts, 1 + k, 1 + k) / square
    for j in range(3):
        for n in range(3):
            out[HESSIAN + 3 + n, j] += inner(parts, 0, 7 + 3 * j + n) / square
    one = np.sqrt(first / square)
    two = (mixed + lost) / np.sqrt(square)
    share = one + two
    rest = np.inf
    if share < LARGEST_EXPANDED_SHARE:
        rest = one * two + 0.5 * two * two - np.log1p(-share) - share - 0.5 * share * share
        rest += lost / np.sqrt(square)
    else:
        share = np.inf
    out[NUMBERS, SQUARE], out[NUMBERS, REST], out[NUMBERS, SHARE] = square, rest, share


@njit(error_model="numpy", nogil=True)
def add(one: Array, total: Array) -> None:
    """Add the logarithm of the length of a quaternion to that of a product."""
    for k in range(6):
        total[GRADIENT, k] += one[GRADIENT, k]
        total[SHARES, k] += one[SHARES, k]
        for m in range(k + 1):
            total[HESSIAN + k, m] += one[HESSIAN + k, m]
    total[NUMBERS, SQUARE] *= one[NUMBERS, SQUARE]
    total[NUMBERS, REST] += one[NUMBERS, REST]
    total[NUMBERS, SHARE] = max(total[NUMBERS, SHARE], one[NUMBERS, SHARE])


@njit(error_model="numpy", nogil=True)
def rotation_length(q: Array, chart: int, width: Array, parts: Array, out: Array) -> None:
    """Write the expansion of log|q|."""
    parts[:] = 0.0
    n = 0
    for k in range(4):
        parts[0, k] = q[k]
        if k != chart:
            parts[4 + n, k] = width[3 + n]
            n += 1
    logarithm(parts, 0.0, 0.0, out)


@njit(error_model="numpy", nogil=True)
def legs(
    anchors: Array,
    p: Array,
    q: Array,
    chart: int,
    width: Array,
    facts: Array,
    totals: Array,
    single: Array,
    order: Array,
    parts: Array,
    work: Array,
) -> None:
    """Write log Π |E_i| of all legs, and of all but the one, two, three that vary most.

    Where legs are left out, log|q| is added for each: see `docs/proofs.md`.

    Parameters
    ----------
    anchors : (2, 6, 3) array
    totals : (4, 9, 6) array
        With 0 to 3 legs left out.
    single : (7, 9, 6) array
        Of each leg, and of q.
    order : (6,) int array
        The legs, of which the first three are those that vary most.
    """
    u, v = work[3], work[4]
    moved, turned, size, reach = 0.0, 0.0, 0.0, facts[BASE] + facts[PLATFORM]
    for k in range(3):
        moved += width[k] * width[k]
        turned += width[3 + k] * width[3 + k]
        size += p[k] * p[k]
    reach += np.sqrt(size)
    mixed = np.sqrt(moved * turned)
    lost = (2.0 * facts[TOLERANCE] + QUATERNION_ROUNDING * reach) * facts[LARGEST_NORM]
    for i in range(6):
        order[i] = i
        u[0], v[0] = 0.0, 0.0
        for k in range(3):
            u[1 + k], v[1 + k] = p[k] - anchors[0, i, k], anchors[1, i, k]
        leg(u, v, q, chart, width, parts, work)
        logarithm(parts, mixed, lost, single[i])
    for n in range(MOST_FREE_LEGS):
        for m in range(n + 1, 6):
            if single[order[m], NUMBERS, SHARE] > single[order[n], NUMBERS, SHARE]:
                order[n], order[m] = order[m], order[n]
    rotation_length(q, chart, width, parts, single[6])
    last = totals[MOST_FREE_LEGS]
    last[:] = 0.0
    last[NUMBERS, SQUARE], last[NUMBERS, REST] = 1.0, LENGTH_SUM_ROUNDING
    for n in range(MOST_FREE_LEGS, 6):
        add(single[order[n]], last)
    for n in range(MOST_FREE_LEGS - 1, -1, -1):
        totals[n] = totals[n + 1]
        add(single[order[n]], totals[n])
    for n in range(1, MOST_FREE_LEGS + 1):
        for _ in range(n):
            add(single[6], totals[n])
