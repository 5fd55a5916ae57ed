"""Compiled climbs: rotations whose least margin is large.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.workspace.sets.compiled.bounds import box_margin
from gsp.workspace.sets.compiled.frames import FRAME, TURNS, frame_of, turn_about
from gsp.workspace.sets.compiled.weights import constraints, weights

# Steps of one climb, and the first of them [rad].
CLIMB_STEPS, FIRST_STEP = 25, 0.3


@njit(error_model="numpy", nogil=True)
def _least(values: Array, n: int) -> float:
    least = np.inf
    for j in range(n):
        least = min(least, values[j])
    return least


@njit(error_model="numpy", nogil=True)
def _farthest(legs: Array) -> float:
    """Return the largest |b|: no slope of a length is steeper [length/rad]."""
    most = 0.0
    for i in range(len(legs)):
        most = max(most, legs[i, 6])
    return most


@njit(error_model="numpy", nogil=True)
def ascend(
    p: Array,
    nothing: Array,
    legs: Array,
    r: Array,
    first: float,
    steps: int,
    values: Array,
    slopes: Array,
    weight: Array,
    mix: Array,
    new: Array,
    axis: Array,
) -> float:
    """Turn a rotation (9,) to where the least constraint at p is large; return that constraint.

    Steps of a trust region: each maximises the least of the constraints, taken as linear.

    Parameters
    ----------
    nothing : (3,) array
        Zeros.
    first : float [rad]
        The first step.
    values, slopes, weight, mix, new, axis : arrays
        Overwritten; `new` (9,), `axis` (3,).
    """
    m = 2 * len(legs)
    constraints(p, nothing, legs, r, 1.0, values, slopes)
    margin, reach, far = _least(values, m), first, _farthest(legs)
    for step in range(steps):
        if reach < 1e-4:
            break
        expected = weights(values, slopes, m, weight, mix, reach, -np.inf, margin, 0.1, step > 0)
        size = np.sqrt(mix[3] ** 2 + mix[4] ** 2 + mix[5] ** 2)
        # At a local maximum the weighted slopes cancel, or no step promises a gain.
        if size <= 1e-9 * far or not expected > margin + 1e-4 * abs(margin) + 1e-9 * size:
            break
        for k in range(3):
            axis[k] = mix[3 + k] / size
        turn_about(r, axis, reach, new)
        constraints(p, nothing, legs, new, 1.0, values, slopes)
        found = _least(values, m)
        gain = (found - margin) / (expected - margin)
        if gain > 0.0:
            for k in range(9):
                r[k] = new[k]
            margin = found
        else:  # the arrays hold the rotation that was tried
            constraints(p, nothing, legs, r, 1.0, values, slopes)
        if gain > 0.5:
            reach = min(1.0, 2.0 * reach)
        elif gain < 0.2:
            reach *= 0.3
    return margin


@njit(error_model="numpy", nogil=True)
def _margins(p: Array, h: Array, legs: Array, frame: Array, values: Array, slopes: Array) -> int:
    """Write margins of one rotation on a box of positions, and their slopes along three angles."""
    n = 0
    v = np.empty(3)
    r = np.empty(3)
    for i in range(len(legs)):
        for side in range(2):
            bound = legs[i, 7 + side]
            if (side == 0 and bound <= 0.0) or bound == np.inf:
                continue
            square = 0.0
            for k in range(3):
                r[k] = frame[3 * k] * legs[i, 3] + frame[3 * k + 1] * legs[i, 4]
                r[k] += frame[3 * k + 2] * legs[i, 5]
                x = p[k] - legs[i, k] + r[k]
                size = abs(x) + h[k] if side else max(0.0, abs(x) - h[k])
                v[k] = size if x >= 0.0 else -size
                square += size * size
            length = np.sqrt(square)
            turn = 1.0 / length if length > 0.0 else 0.0
            if side:
                turn = -turn
            values[n] = bound - length if side else length - bound
            c0 = turn * (r[1] * v[2] - r[2] * v[1])
            c1 = turn * (r[2] * v[0] - r[0] * v[2])
            c2 = turn * (r[0] * v[1] - r[1] * v[0])
            for k in range(3):
                at = TURNS + 3 * k
                slopes[n, k] = frame[at] * c0 + frame[at + 1] * c1 + frame[at + 2] * c2
                slopes[n, 3 + k] = 0.0
            n += 1
    return n


@njit(error_model="numpy", nogil=True)
def climb(
    angles: Array,
    least: Array,
    most: Array,
    p: Array,
    h: Array,
    legs: Array,
    turns: Array,
    enough: float,
) -> float:
    """Move angles to where the least margin on a box of positions is large; return that margin.

    Steps of a trust region: each maximises the least of the margins, taken as linear. It ends as
    soon as the margin is `enough`. Angles stay within `least` and `most`.
    """
    m = 2 * len(legs)
    values, slopes = np.empty(m), np.empty((m, 6))
    weight, mix = np.empty(m), np.empty(6)
    frame, new = np.empty(FRAME), np.empty(3)
    frame_of(angles - 1.0, angles + 1.0, turns, frame)
    margin, far = box_margin(p, h, legs, frame), _farthest(legs)
    reach = FIRST_STEP
    for _ in range(CLIMB_STEPS):
        if margin >= enough or reach < 1e-7:
            break
        n = _margins(p, h, legs, frame, values, slopes)
        expected = weights(values, slopes, n, weight, mix, reach, -np.inf, 0.0, 1e-9, False)
        size = np.sqrt(mix[0] ** 2 + mix[1] ** 2 + mix[2] ** 2)
        if size <= 1e-12 * far or expected <= margin:
            break
        for k in range(3):
            new[k] = min(most[k], max(least[k], angles[k] + reach * mix[k] / size))
        frame_of(new - 1.0, new + 1.0, turns, frame)
        found = box_margin(p, h, legs, frame)
        gain = found - margin
        if gain > 0.0:
            for k in range(3):
                angles[k] = new[k]
            margin = found
        else:
            frame_of(angles - 1.0, angles + 1.0, turns, frame)
        if gain > 0.5 * (expected - margin + gain):
            reach = min(1.0, 2.0 * reach)
        elif gain < 0.2 * (expected - margin):
            reach *= 0.3
    return margin
