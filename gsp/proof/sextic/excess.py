"""Compiled test whether polynomials are below a product of lengths in a box; this loads numba."""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.proof.sextic.expansions import derivatives
from gsp.proof.sextic.lengths import GRADIENT, HESSIAN, LENGTH_SUM_ROUNDING, NUMBERS, REST, SHARES

# Rounding of a Cholesky factorisation, relative to the trace.
CHOLESKY_ROUNDING = 2.0**-44
# The slower bound is evaluated for values in the middle above this share of what is allowed.
SLOWER_BOUND_SHARE = 0.7


@njit(error_model="numpy", nogil=True)
def quadratic(slope: Array, bend: Array, parts: Array) -> float:
    """Return an upper bound of g·δ + δᵀHδ/2 over all δ, and write the parts of the coordinates."""
    total = 0.0
    for k in range(6):
        g, h = abs(slope[k]), 0.5 * bend[k, k]
        part = g * g / (-4.0 * h) if h < 0.0 and g < -2.0 * h else g + h
        for m in range(6):
            if m != k:
                part += 0.5 * abs(bend[max(k, m), min(k, m)])
        parts[k] = part
        total += part
    return total


@njit(error_model="numpy", nogil=True)
def concave(slope: Array, m: Array, y: Array) -> float:
    """Return an upper bound of g·δ − δᵀMδ/2 over all real δ; inf unless M is positive definite.

    M, of which the lower triangle is read, is overwritten by its Cholesky factor.
    """
    trace, total = 0.0, 0.0
    for k in range(6):
        trace += abs(m[k, k])
    for k in range(6):
        for j in range(k):
            s = m[k, j]
            for i in range(j):
                s -= m[k, i] * m[j, i]
            m[k, j] = s / m[j, j]
        s = m[k, k] - CHOLESKY_ROUNDING * trace
        for i in range(k):
            s -= m[k, i] * m[k, i]
        if not s > 0.0:
            return np.inf
        m[k, k] = np.sqrt(s)
        t = slope[k]
        for i in range(k):
            t -= m[k, i] * y[i]
        y[k] = t / m[k, k]
        total += y[k] * y[k]
    return float(0.5 * total * (1.0 + LENGTH_SUM_ROUNDING))


@njit(error_model="numpy", nogil=True)
def dual(slope: Array, bend: Array, m: Array, y: Array) -> float:
    """Return another upper bound of g·δ + δᵀHδ/2, from concave functions above it.

    δᵀHδ is at most δᵀ(H − D)δ + tr D for a diagonal D ≥ 0.
    """
    half = 0.0
    for k in range(6):
        row = bend[k, k]
        for j in range(6):
            if j != k:
                row += abs(bend[max(k, j), min(k, j)])
        d = abs(slope[k]) + max(row, 0.0)
        half += 0.5 * d
        for j in range(k + 1):
            m[k, j] = -bend[k, j]
        m[k, k] += d
    best = half + concave(slope, m, y)
    for k in range(6):
        for j in range(k + 1):
            m[k, j] = -bend[k, j]
    return min(best, concave(slope, m, y))


@njit(error_model="numpy", nogil=True)
def length(
    values: Array, many: int, slope: Array, bend: Array, g: Array, h: Array, sums: Array
) -> None:
    """Write the expansion of the length |C| of a vector of polynomials, or of one with its sign.

    With c = |C| in the middle, |C| ≤ (|C|² + c²)/(2 c). With one polynomial, |C| is ± C.

    Parameters
    ----------
    sums : (3,) array
        c, and bounds of the parts of C of degree 1 and 2.
    """
    middle, first, second = 0.0, 0.0, 0.0
    for c in range(many):
        middle += values[0, 10 * c] ** 2
    middle = np.sqrt(middle)
    for k in range(6):
        g[k] = 0.0
        for m in range(k + 1):
            h[k, m] = 0.0
    for c in range(many):
        derivatives(values, 10 * c, slope, bend)
        share = values[0, 10 * c] / middle if middle > 0.0 else 1.0
        one, two = 0.0, 0.0
        for k in range(6):
            one += abs(slope[k])
            g[k] += share * slope[k]
            for m in range(k + 1):
                two += abs(bend[k, m]) * (0.5 if m == k else 1.0)
                h[k, m] += share * bend[k, m]
                if many > 1:
                    h[k, m] += slope[k] * slope[m] / middle
        first += one * one
        second += two * two
    sums[0], sums[1], sums[2] = middle, np.sqrt(first), np.sqrt(second)


@njit(error_model="numpy", nogil=True)
def excess(
    values: Array, rests: Array, weight: float, total: Array, parts: Array, work: Array
) -> float:
    """Return 0 if |C| ≤ weight · Π / Π₀ in a box, else a positive number, relative to the weight.

    C is a vector of polynomials, Π a product of lengths of quaternions, Π₀ its value in the middle.
    Then `parts` are the contributions of the coordinates to what is missing.

    Parameters
    ----------
    values, rests : (20, 10 m), (m,) arrays
        Of C; see `in_position`.
    total : (9, 6) array
        The expansion s of log Π.
    """
    slope, bend, g, h, sums = work[5], work[6:12], work[12], work[13:19], work[19]
    many, rest = len(rests), 0.0
    for c in range(many):
        rest += rests[c] ** 2
    rest = np.sqrt(rest)
    length(values, many, slope, bend, g, h, sums)
    middle, first, second = sums[0], sums[1], sums[2]
    for k in range(6):
        slope[k] = -total[GRADIENT, k]
        for m in range(k + 1):
            bend[k, m] = -total[HESSIAN + k, m]
    drop = quadratic(slope, bend, parts) * (1.0 + LENGTH_SUM_ROUNDING) + total[NUMBERS, REST]
    least = weight * np.exp(-drop) * (1.0 - LENGTH_SUM_ROUNDING)
    vary = (first + second + rest) * (1.0 + LENGTH_SUM_ROUNDING)
    if (middle + vary) * (1.0 + LENGTH_SUM_ROUNDING) <= least:
        return 0.0
    # exp(s) ≥ 1 + s: what remains is |C| − weight (1 + s), of degree 2 with a rest.
    if many > 1:
        if middle == 0.0:
            return np.inf
        rest += (2.0 * first + second) * second / (2.0 * middle)
    rest += weight * total[NUMBERS, REST] + LENGTH_SUM_ROUNDING * (
        first + second + middle + 10.0 * weight
    )
    worst = 0.0
    for side in range(1 if many > 1 else 2):
        sign = 1.0 - 2.0 * side
        if side == 1 and (vary - middle) * (1.0 + LENGTH_SUM_ROUNDING) <= least:
            break
        for k in range(6):
            slope[k] = sign * g[k] - weight * total[GRADIENT, k]
            for m in range(k + 1):
                bend[k, m] = sign * h[k, m] - weight * total[HESSIAN + k, m]
        level = sign * middle - weight + rest
        worst = level + quadratic(slope, bend, parts) * (1.0 + LENGTH_SUM_ROUNDING)
        if worst <= 0.0:
            continue
        if level < 0.0 and (worst + level < 0.0 or level > (SLOWER_BOUND_SHARE - 1.0) * weight):
            if (
                level + dual(slope, bend, work[20:26], work[26]) * (1.0 + LENGTH_SUM_ROUNDING)
                <= 0.0
            ):
                continue
        shares = 0.0
        for k in range(6):
            shares += total[SHARES, k]
        for k in range(6):
            parts[k] += rest * total[SHARES, k] / shares
        return float(worst / weight)
    return 0.0
