"""The decision of one cell of positions of SPS legs: inside, outside or undecided.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.workspace.sets.compiled.bounds import (
    FRAME,
    SPIN,
    TURNS,
    box_margin,
    frame_of,
    squares,
    sum_below_zero,
    weights,
)

Numbers = NDArray[np.int64]
Codes = NDArray[np.int8]

# Rotation cells that one cell of positions keeps at most; with more it keeps those it was given.
MOST_KEPT = 1024
# Steps of one climb, and the first of them [rad].
CLIMB_STEPS, FIRST_STEP = 25, 0.3


@njit(error_model="numpy", nogil=True)
def screen(
    p: Array,
    h: Array,
    legs: Array,
    frame: Array,
    line: Array,
    values: Array,
    slopes: Array,
    owner: Numbers,
    sign: Array,
    factor: Array,
) -> tuple[int, int]:
    """Compare the lengths on a cell with their bounds.

    Returns
    -------
    −1 if one is violated everywhere, 1 if none is anywhere, else 0; and how many may be violated:
    their values and slopes are written, divided by twice their bound.
    """
    n, whole = 0, True
    for i in range(len(legs)):
        low, high = legs[i, 7], legs[i, 8]
        squares(p, h, legs[i], frame, line)
        whole &= line[0] > 0.0  # a length of 0 is undefined
        if low > 0.0:
            if line[1] < low * low:
                return -1, 0
            if line[0] < low * low:
                factor[n] = 0.5 / low
                values[n] = factor[n] * (line[2] - low * low)
                for k in range(6):
                    slopes[n, k] = factor[n] * line[3 + k]
                owner[n], sign[n] = i, 1.0
                n += 1
        if high < np.inf:
            if line[0] > high * high:
                return -1, 0
            if line[1] > high * high:
                factor[n] = 0.5 / high
                values[n] = factor[n] * (high * high - line[2])
                for k in range(6):
                    slopes[n, k] = -factor[n] * line[3 + k]
                owner[n], sign[n] = i, -1.0
                n += 1
    return (1 if n == 0 and whole else 0), n


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
    margin = box_margin(p, h, legs, frame)
    reach = FIRST_STEP
    for _ in range(CLIMB_STEPS):
        if margin >= enough or reach < 1e-7:
            break
        n = _margins(p, h, legs, frame, values, slopes)
        expected = weights(values, slopes, n, weight, mix, reach, -np.inf)
        size = np.sqrt(mix[0] ** 2 + mix[1] ** 2 + mix[2] ** 2)
        if size <= 1e-12 or expected <= margin:
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


@njit(error_model="numpy", nogil=True)
def reach_cell(
    p: Array,
    h: Array,
    given: Array,
    seed: Array,
    seeded: bool,
    legs: Array,
    turns: Array,
    least: Array,
    most: Array,
    target: float,
    starts: int,
    most_nodes: int,
    stack: Array,
    kept: Array,
) -> tuple[int, int, bool, int]:
    """Decide a cell of positions; return its code, kept rotation cells, whether seeded, nodes."""
    nothing = np.zeros(3)
    goal = 0.0
    for i in range(len(legs)):
        goal = max(goal, legs[i, 6])
    m = 2 * len(legs)
    values, slopes, weight = np.empty(m), np.empty((m, 6)), np.empty(m)
    owner = np.empty(m, dtype=np.int64)
    sign, factor = np.empty(m), np.empty(m)
    line, frame, mix, trial = np.empty(9), np.empty(FRAME), np.empty(6), np.empty(3)
    best = -np.inf
    feasible = False
    nodes = 0
    if seeded:
        margin = climb(seed, least, most, p, h, legs, turns, 0.0)
        if margin >= 0.0:
            return 1, 0, True, nodes
        best = margin
        frame_of(seed, seed, turns, frame)
        feasible = box_margin(p, nothing, legs, frame) >= 0.0
    n_kept, top = 0, 0
    tried = 0
    for start in range(len(given)):
        if feasible or n_kept >= MOST_KEPT or nodes >= most_nodes:
            if n_kept >= len(kept):
                return 0, -1, seeded, nodes
            for k in range(6):
                kept[n_kept, k] = given[start, k]
            n_kept += 1
            continue
        top = 1
        for k in range(6):
            stack[0, k] = given[start, k]
        while top > 0:
            top -= 1
            keep = feasible or nodes >= most_nodes
            if not keep:
                nodes += 1
                frame_of(stack[top, :3], stack[top, 3:], turns, frame)
                code, n = screen(p, h, legs, frame, line, values, slopes, owner, sign, factor)
                if code < 0:
                    continue
                if (
                    n > 0
                    and weights(values, slopes, n, weight, mix, 1.0, -goal * frame[SPIN] ** 2) < 0.0
                ):
                    for j in range(n):
                        weight[j] *= factor[j]
                    if sum_below_zero(p, h, legs, owner, sign, weight, n, frame):
                        continue
                keep = frame[SPIN] <= target or top + 2 > len(stack)
                if keep and tried < starts:
                    tried += 1
                    for k in range(3):
                        trial[k] = 0.5 * (stack[top, k] + stack[top, 3 + k])
                    margin = climb(trial, least, most, p, h, legs, turns, 0.0)
                    if margin > best:
                        best = margin
                        seeded = True
                        for k in range(3):
                            seed[k] = trial[k]
                    if margin >= 0.0:
                        return 1, 0, True, nodes
                    frame_of(trial, trial, turns, frame)
                    feasible = box_margin(p, nothing, legs, frame) >= 0.0
            if keep:
                if n_kept >= len(kept):
                    return 0, -1, seeded, nodes
                for k in range(6):
                    kept[n_kept, k] = stack[top, k]
                n_kept += 1
                continue
            widest, coordinate = -1.0, 0
            for k in range(3):
                if stack[top, 3 + k] - stack[top, k] > widest:
                    widest, coordinate = stack[top, 3 + k] - stack[top, k], k
            middle = 0.5 * (stack[top, coordinate] + stack[top, 3 + coordinate])
            for k in range(6):
                stack[top + 1, k] = stack[top, k]
            stack[top, 3 + coordinate] = middle
            stack[top + 1, coordinate] = middle
            top += 2
    return (0 if n_kept else -1), n_kept, seeded, nodes
