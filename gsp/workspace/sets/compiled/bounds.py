"""Compiled bounds of leg lengths, and of their weighted sums, over cells of poses.

A cell is a box of positions, p + δ with |δ_k| ≤ h_k, and a box of three angles about moving axes.
`docs/sets.md` derives each bound. Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array

# Every bound of squared lengths is widened by this share of the square of the size of the problem:
# some 4000 units of rounding, where evaluation makes about 50.
ROUNDING = 1e-12
# λ_max of a symmetric matrix by the trigonometric formula is widened by this share of its norm: it
# loses half of the digits at a double root.
ROOT_ROUNDING = 1e-7
# Steps of the search for weights, at most.
WEIGHT_STEPS = 40
# Numbers of a rotation cell's frame: R by rows, the three turns by rows, w, w₂.
FRAME, TURNS, SPIN, TWIST = 20, 9, 18, 19


@njit(error_model="numpy", nogil=True)
def _turned(axis: Array, angle: float, out: Array) -> None:
    """Write the rotation by an angle about a unit axis."""
    c, s = np.cos(angle), np.sin(angle)
    for i in range(3):
        for j in range(3):
            out[i, j] = (1.0 - c) * axis[i] * axis[j]
        out[i, i] += c
    out[0, 1] -= s * axis[2]
    out[0, 2] += s * axis[1]
    out[1, 0] += s * axis[2]
    out[1, 2] -= s * axis[0]
    out[2, 0] -= s * axis[1]
    out[2, 1] += s * axis[0]


@njit(error_model="numpy", nogil=True)
def frame_of(low: Array, high: Array, turns: Array, frame: Array) -> None:
    """Write the frame of a cell of angles: R at its middle, turns along each angle, w and w₂.

    Parameters
    ----------
    low, high : (3,) arrays [rad]
    turns : (6, 3) array
        The moving axes, and the rotation before them.
    frame : (20,) array
        Filled.
    """
    half = np.empty(3)
    r, step, new = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            r[i, j] = 1.0 if i == j else 0.0
    for k in range(3):
        middle = 0.5 * (low[k] + high[k])
        half[k] = max(middle - low[k], high[k] - middle) * (1.0 + 1e-15)
        for i in range(3):
            total = 0.0
            for j in range(3):
                total += r[i, j] * turns[k, j]
            frame[TURNS + 3 * k + i] = total
        _turned(turns[k], middle, step)
        for i in range(3):
            for j in range(3):
                new[i, j] = r[i, 0] * step[0, j] + r[i, 1] * step[1, j] + r[i, 2] * step[2, j]
        r[:, :] = new
    for i in range(3):
        for j in range(3):
            frame[3 * i + j] = r[i, 0] * turns[3, j] + r[i, 1] * turns[4, j] + r[i, 2] * turns[5, j]
    skewed = 0.0
    for i in range(3):
        skewed += frame[TURNS + i] * frame[TURNS + 6 + i]
    skewed = min(1.0, abs(skewed) + half[1])
    square = half[0] ** 2 + half[1] ** 2 + half[2] ** 2 + 2.0 * half[0] * half[2] * skewed
    frame[SPIN] = np.sqrt(square) * (1.0 + 1e-14)
    frame[TWIST] = (half[0] * half[1] + half[0] * half[2] + half[1] * half[2]) * (1.0 + 1e-14)
    for k in range(3):
        for i in range(3):
            frame[TURNS + 3 * k + i] *= half[k]


@njit(error_model="numpy", nogil=True)
def squares(p: Array, h: Array, leg: Array, frame: Array, out: Array) -> None:
    """Write bounds of a squared length over a cell, its value in the middle, and its slopes.

    Parameters
    ----------
    p, h : (3,) arrays
        Middle and half-widths of the positions.
    leg : (9,) array
        a, b, |b|, and the least and the greatest length.
    out : (9,) array
        Filled: least, greatest, middle; slopes along three positions and three angles, scaled by
        the half-widths.
    """
    r0 = frame[0] * leg[3] + frame[1] * leg[4] + frame[2] * leg[5]
    r1 = frame[3] * leg[3] + frame[4] * leg[4] + frame[5] * leg[5]
    r2 = frame[6] * leg[3] + frame[7] * leg[4] + frame[8] * leg[5]
    a0, a1, a2 = p[0] - leg[0], p[1] - leg[1], p[2] - leg[2]
    d0, d1, d2 = a0 + r0, a1 + r1, a2 + r2
    square = d0 * d0 + d1 * d1 + d2 * d2
    size = np.sqrt(square)
    c0, c1, c2 = r1 * d2 - r2 * d1, r2 * d0 - r0 * d2, r0 * d1 - r1 * d0
    out[3], out[4], out[5] = 2.0 * d0 * h[0], 2.0 * d1 * h[1], 2.0 * d2 * h[2]
    linear = abs(out[3]) + abs(out[4]) + abs(out[5])
    for k in range(3):
        at = TURNS + 3 * k
        slope = 2.0 * (frame[at] * c0 + frame[at + 1] * c1 + frame[at + 2] * c2)
        out[6 + k] = slope
        linear += abs(slope)
    spin = frame[SPIN]
    chord = 2.0 * np.sin(0.5 * min(spin, np.pi)) * leg[6]
    wide = np.sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2])
    bend = size * (spin * spin + frame[TWIST]) * leg[6]
    shift = wide + chord
    arm = np.sqrt(a0 * a0 + a1 * a1 + a2 * a2)
    near = max(0.0, max(size - shift, abs(arm - leg[6]) - wide))
    far = min(size + shift, arm + leg[6] + wide)
    scale = arm + leg[6] + wide
    slack = ROUNDING * scale * scale
    out[0] = max(near * near, square - linear - bend) - slack
    out[1] = min(far * far, square + linear + bend + shift * shift) + slack
    out[2] = square


@njit(error_model="numpy", nogil=True)
def weights(
    values: Array, slopes: Array, n: int, weight: Array, mix: Array, reach: float, goal: float
) -> float:
    """Write weights ≥ 0 of sum 1 that make Σ w values + reach |Σ w slopes| small; return that sum.

    The method of Frank and Wolfe with pairwise, exact steps. It ends as soon as the sum is below
    `goal`, and, if that is finite, as soon as the sum can't become negative.

    Parameters
    ----------
    values : (≥ n,) array
    slopes : (≥ n, 6) array
    weight : (≥ n,) array
        Filled.
    mix : (6,) array
        Filled with Σ w slopes.
    """
    best, start = np.inf, 0
    for j in range(n):
        square = 0.0
        for k in range(6):
            square += slopes[j, k] * slopes[j, k]
        value = values[j] + reach * np.sqrt(square)
        weight[j] = 0.0
        if value < best:
            best, start = value, j
    weight[start] = 1.0
    total = values[start]
    for k in range(6):
        mix[k] = slopes[start, k]
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
        least, chosen, most, worst = np.inf, 0, -np.inf, 0
        for j in range(n):
            value = 0.0
            for k in range(6):
                value += mix[k] * slopes[j, k]
            value = values[j] + per * value
            if value < least:
                least, chosen = value, j
            if weight[j] > 0.0 and value > most:
                most, worst = value, j
        if (least > 0.0 and goal > -np.inf) or most - least <= 1e-9 * (1.0 + abs(result)):
            break
        cross, bend = 0.0, 0.0
        for k in range(6):
            step = slopes[chosen, k] - slopes[worst, k]
            cross += mix[k] * step
            bend += step * step
        fall = (values[chosen] - values[worst]) / reach
        if fall * fall >= bend:
            share = weight[worst] if fall < 0.0 else 0.0
        else:
            rest = max(0.0, (square - cross * cross / bend) / bend)
            share = -fall * np.sqrt(rest / (bend - fall * fall)) - cross / bend
        share = min(weight[worst], share)
        if share <= 0.0:
            break
        total += share * reach * fall
        for k in range(6):
            mix[k] += share * (slopes[chosen, k] - slopes[worst, k])
        weight[chosen] += share
        weight[worst] = weight[worst] - share
    return float(result)


@njit(error_model="numpy", nogil=True)
def _largest_root(m: Array) -> float:
    """Return an upper bound of the largest eigenvalue of the symmetric part of a 3 × 3 matrix."""
    a, b, c = m[0, 0], m[1, 1], m[2, 2]
    d, e, f = 0.5 * (m[0, 1] + m[1, 0]), 0.5 * (m[0, 2] + m[2, 0]), 0.5 * (m[1, 2] + m[2, 1])
    mean = (a + b + c) / 3.0
    a, b, c = a - mean, b - mean, c - mean
    off = d * d + e * e + f * f
    spread = np.sqrt((a * a + b * b + c * c + 2.0 * off) / 6.0)
    norm = abs(mean) + spread
    if spread <= 1e-300:
        return float(mean + ROOT_ROUNDING * norm)
    det = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)
    ratio = min(1.0, max(-1.0, 0.5 * det / (spread * spread * spread)))
    root = mean + 2.0 * spread * np.cos(np.arccos(ratio) / 3.0)
    return float(root + 3.0 * ROOT_ROUNDING * norm)


@njit(error_model="numpy", nogil=True)
def sum_below_zero(
    p: Array,
    h: Array,
    legs: Array,
    owner: NDArray[np.int64],
    sign: Array,
    weight: Array,
    n: int,
    frame: Array,
) -> bool:
    """Whether a weighted sum of constraints is negative on all of a cell, rounding included.

    Constraint j is sign_j (l² − L²), with L the greatest length of leg owner_j if sign_j < 0, else
    the least. Feasible poses have all constraints ≥ 0.
    """
    middle, mass, scale = 0.0, 0.0, 0.0
    g0, g1, g2, t0, t1, t2, e0, e1, e2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    m = np.zeros((3, 3))
    for j in range(n):
        if weight[j] <= 0.0:
            continue
        i = owner[j]
        u = weight[j] * sign[j]
        bound = legs[i, 8] if sign[j] < 0.0 else legs[i, 7]
        b0, b1, b2 = legs[i, 3], legs[i, 4], legs[i, 5]
        r0 = frame[0] * b0 + frame[1] * b1 + frame[2] * b2
        r1 = frame[3] * b0 + frame[4] * b1 + frame[5] * b2
        r2 = frame[6] * b0 + frame[7] * b1 + frame[8] * b2
        a0, a1, a2 = p[0] - legs[i, 0], p[1] - legs[i, 1], p[2] - legs[i, 2]
        d0, d1, d2 = a0 + r0, a1 + r1, a2 + r2
        square = d0 * d0 + d1 * d1 + d2 * d2
        middle += u * (square - bound * bound)
        reach = np.sqrt(a0 * a0 + a1 * a1 + a2 * a2) + legs[i, 6]
        scale += weight[j] * (reach * reach + bound * bound)
        mass += u
        g0, g1, g2 = g0 + 2.0 * u * d0, g1 + 2.0 * u * d1, g2 + 2.0 * u * d2
        e0, e1, e2 = e0 + u * r0, e1 + u * r1, e2 + u * r2
        t0 += 2.0 * u * (r1 * a2 - r2 * a1)
        t1 += 2.0 * u * (r2 * a0 - r0 * a2)
        t2 += 2.0 * u * (r0 * a1 - r1 * a0)
        m[0, 0] += 2.0 * u * r0 * a0
        m[0, 1] += 2.0 * u * r0 * a1
        m[0, 2] += 2.0 * u * r0 * a2
        m[1, 0] += 2.0 * u * r1 * a0
        m[1, 1] += 2.0 * u * r1 * a1
        m[1, 2] += 2.0 * u * r1 * a2
        m[2, 0] += 2.0 * u * r2 * a0
        m[2, 1] += 2.0 * u * r2 * a1
        m[2, 2] += 2.0 * u * r2 * a2
    wide = np.sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2])
    spin = min(frame[SPIN], np.pi)
    total = middle + abs(g0) * h[0] + abs(g1) * h[1] + abs(g2) * h[2]
    total += max(0.0, mass) * wide * wide
    total += 4.0 * wide * np.sin(0.5 * spin) * np.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
    pull = np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
    bend = _largest_root(m) - (m[0, 0] + m[1, 1] + m[2, 2])
    crest = np.arctan2(pull, -bend)
    if spin >= crest:
        total += bend + np.sqrt(pull * pull + bend * bend)
    else:
        total += pull * np.sin(spin) + bend * (1.0 - np.cos(spin))
    return bool(total + ROUNDING * (scale + 4.0 * wide * wide) < 0.0)


@njit(error_model="numpy", nogil=True)
def box_margin(p: Array, h: Array, legs: Array, frame: Array) -> float:
    """Return how far lengths stay within their bounds for one rotation and all of a box.

    The least over the legs; rounding is taken off. Infinite without legs.
    """
    least = np.inf
    for i in range(len(legs)):
        near, far, scale = 0.0, 0.0, 0.0
        for k in range(3):
            x = p[k] - legs[i, k]
            y = frame[3 * k] * legs[i, 3] + frame[3 * k + 1] * legs[i, 4]
            y += frame[3 * k + 2] * legs[i, 5]
            scale += abs(x) + abs(y)
            size = abs(x + y)
            near += max(0.0, size - h[k]) ** 2
            far += (size + h[k]) ** 2
        slack = ROUNDING * scale
        least = min(least, legs[i, 8] - np.sqrt(far) - slack)
        # A length of 0 has no direction: such a pose is undefined, and never feasible.
        least = min(least, np.sqrt(near) - legs[i, 7] - slack)
    return least
