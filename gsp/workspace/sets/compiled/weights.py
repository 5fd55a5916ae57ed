"""Compiled constraints at one rotation, of leg lengths and of ranges; weights of their sums.

Constraint 2 i is l_i ≥ least length, 2 i + 1 is l_i ≤ greatest length; both are differences of
squares over twice the bound, so that they are lengths. Only import it where it is used.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.legs import leg_vectors

# Steps of the search for weights, at most.
WEIGHT_STEPS = 40


@njit(error_model="numpy", nogil=True)
def constraints(
    p: Array, h: Array, legs: Array, r: Array, w: float, values: Array, slopes: Array
) -> None:
    """Write the constraints at p and the rotation r; their slopes along h, and along turns by w.

    Parameters
    ----------
    p, h : (3,) arrays [length]
    legs : (n, 9) array
        As in `Bounded.legs`.
    r : (≥ 9,) array
        The rotation by rows.
    w : float [rad]
    values : (≥ 2 n,) array
        Filled; infinite where there is no bound.
    slopes : (≥ 2 n, 6) array
        Filled.
    """
    for i in range(len(legs)):
        a0, a1, a2, r0, r1, r2 = leg_vectors(p, legs[i], r)
        d0, d1, d2 = a0 + r0, a1 + r1, a2 + r2
        square = d0 * d0 + d1 * d1 + d2 * d2
        t0, t1, t2 = (r1 * d2 - r2 * d1) * w, (r2 * d0 - r0 * d2) * w, (r0 * d1 - r1 * d0) * w
        for side in range(2):
            bound, j = legs[i, 7 + side], 2 * i + side
            if (side == 0 and bound <= 0.0) or bound == np.inf:
                values[j] = np.inf
                for k in range(6):
                    slopes[j, k] = 0.0
                continue
            factor = -1.0 / bound if side else 1.0 / bound
            values[j] = 0.5 * factor * (square - bound * bound)
            slopes[j, 0] = factor * d0 * h[0]
            slopes[j, 1] = factor * d1 * h[1]
            slopes[j, 2] = factor * d2 * h[2]
            slopes[j, 3], slopes[j, 4], slopes[j, 5] = factor * t0, factor * t1, factor * t2


@njit(error_model="numpy", nogil=True)
def face_constraints(
    faces: Array, r: Array, w: float, start: int, values: Array, slopes: Array
) -> None:
    """Write n · R m − c of the faces of a range from the place `start` on, and slopes by turns.

    Parameters
    ----------
    faces : (f, 7) array
        n, m and c, as in `gsp.workspace.sets.faces`.
    r : (≥ 9,) array
        The rotation by rows.
    w : float [rad]
    start : int
    values, slopes : (≥ start + f,) and (≥ start + f, 6) arrays
        Filled.
    """
    for f in range(len(faces)):
        n0, n1, n2 = faces[f, 0], faces[f, 1], faces[f, 2]
        m0, m1, m2 = faces[f, 3], faces[f, 4], faces[f, 5]
        y0 = r[0] * m0 + r[1] * m1 + r[2] * m2
        y1 = r[3] * m0 + r[4] * m1 + r[5] * m2
        y2 = r[6] * m0 + r[7] * m1 + r[8] * m2
        j = start + f
        values[j] = n0 * y0 + n1 * y1 + n2 * y2 - faces[f, 6]
        slopes[j, 0] = slopes[j, 1] = slopes[j, 2] = 0.0
        slopes[j, 3] = (y1 * n2 - y2 * n1) * w
        slopes[j, 4] = (y2 * n0 - y0 * n2) * w
        slopes[j, 5] = (y0 * n1 - y1 * n0) * w


@njit(error_model="numpy", nogil=True)
def weights(
    values: Array,
    slopes: Array,
    n: int,
    weight: Array,
    mix: Array,
    reach: float,
    goal: float,
    floor: float,
    share: float,
    warm: bool,
) -> float:
    """Write weights ≥ 0 of sum 1 that make Σ w values + reach |Σ w slopes| small; return that sum.

    The method of Frank and Wolfe with pairwise, exact steps. It ends as soon as the sum is below
    `goal`; if that is finite, as soon as the sum can't become negative; and when the gap to the
    least sum is below a share of the distance of the sum from `floor`.

    Parameters
    ----------
    values : (≥ n,) array
        Infinite ones are left out.
    slopes : (≥ n, 6) array
    weight : (≥ n,) array
        Filled; where it begins, if `warm`.
    mix : (6,) array
        Filled with Σ w slopes.
    """
    best, start, mass = np.inf, 0, 0.0
    for j in range(n):
        square = 0.0
        for k in range(6):
            square += slopes[j, k] * slopes[j, k]
        value = values[j] + reach * np.sqrt(square)
        if value < best:
            best, start = value, j
        if not warm or values[j] == np.inf:
            weight[j] = 0.0
        mass += weight[j]
    if best == np.inf:
        return np.inf
    if mass <= 0.0:
        weight[start] = mass = 1.0
    total = 0.0
    mix[:] = 0.0
    for j in range(n):
        if weight[j] > 0.0:
            weight[j] /= mass
            total += weight[j] * values[j]
            for k in range(6):
                mix[k] += weight[j] * slopes[j, k]
    result = best
    for _ in range(WEIGHT_STEPS):
        square = 0.0
        for k in range(6):
            square += mix[k] * mix[k]
        size = np.sqrt(square)
        result = total + reach * size
        if result < goal:
            return float(result)
        per = reach / size if size > 0.0 else 0.0
        m0, m1, m2 = per * mix[0], per * mix[1], per * mix[2]
        m3, m4, m5 = per * mix[3], per * mix[4], per * mix[5]
        least, chosen, most, worst = np.inf, 0, -np.inf, 0
        for j in range(n):
            value = values[j] + m0 * slopes[j, 0] + m1 * slopes[j, 1] + m2 * slopes[j, 2]
            value += m3 * slopes[j, 3] + m4 * slopes[j, 4] + m5 * slopes[j, 5]
            if value < least:
                least, chosen = value, j
            if weight[j] > 0.0 and value > most:
                most, worst = value, j
        # The sum is convex and homogeneous in the weights, so none is below the least of these.
        if (least > 0.0 and goal > -np.inf) or most - least <= share * abs(result - floor):
            break
        # Weight moves from the worst constraint in use to the best of all. But for a constant the
        # sum is reach (part · fall + |mix + part · step|), without a minimum if |fall| ≥ |step|.
        cross, bend = 0.0, 0.0
        for k in range(6):
            step = slopes[chosen, k] - slopes[worst, k]
            cross += mix[k] * step
            bend += step * step
        fall = (values[chosen] - values[worst]) / reach
        if fall * fall >= bend:
            part = weight[worst] if fall < 0.0 else 0.0
        else:
            rest = max(0.0, (square - cross * cross / bend) / bend)
            part = -fall * np.sqrt(rest / (bend - fall * fall)) - cross / bend
        part = min(weight[worst], part)
        if part <= 0.0:
            break
        total += part * reach * fall
        for k in range(6):
            mix[k] += part * (slopes[chosen, k] - slopes[worst, k])
        weight[chosen] += part
        weight[worst] -= part
    return float(result)
