"""The decision of one cell of positions of SPS legs, over the rotations of a range.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.workspace.sets.compiled.bounds import LINE, box_margin, squares
from gsp.workspace.sets.compiled.climbing import climb
from gsp.workspace.sets.compiled.frames import FRAME, SPIN, frame_of
from gsp.workspace.sets.compiled.sums import BASE, SUM, rise, sum_of
from gsp.workspace.sets.compiled.weights import weights

Numbers = NDArray[np.int64]
Codes = NDArray[np.int8]

# Values, slopes, weights, all weights, Σ w slopes, bounds of a length, a sum, places.
Buffers = tuple[Array, Array, Array, Array, Array, Array, Array, Numbers]
# Rotation cells that one cell of positions keeps at most; with more it keeps those it was given.
MOST_KEPT = 1024


@njit(error_model="numpy", nogil=True)
def screen(
    p: Array,
    h: Array,
    legs: Array,
    frame: Array,
    line: Array,
    values: Array,
    slopes: Array,
    place: Numbers,
) -> tuple[int, int]:
    """Compare the lengths on a cell with their bounds.

    Returns
    -------
    −1 if one is violated everywhere, 1 if none is anywhere, else 0; and how many may be violated:
    their values, slopes and places among the constraints are written.
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
                values[n] = 0.5 * (line[2] - low * low) / low
                for k in range(6):
                    slopes[n, k] = 0.5 * line[3 + k] / low
                place[n] = 2 * i
                n += 1
        if high < np.inf:
            if line[0] > high * high:
                return -1, 0
            if line[1] > high * high:
                values[n] = 0.5 * (high * high - line[2]) / high
                for k in range(6):
                    slopes[n, k] = -0.5 * line[3 + k] / high
                place[n] = 2 * i + 1
                n += 1
    return (1 if n == 0 and whole else 0), n


@njit(error_model="numpy", nogil=True)
def compare(p: Array, h: Array, legs: Array, frame: Array, buffers: Buffers) -> int:
    """Return −1 if a bound is violated on all of a cell of poses, 1 if none is anywhere, else 0."""
    values, slopes, weight, full, mix, line, out, place = buffers
    code, n = screen(p, h, legs, frame, line, values, slopes, place)
    if code != 0 or n < 2:
        return code
    goal = 0.0
    for i in range(len(legs)):
        goal = max(goal, legs[i, 6])
    goal *= frame[SPIN] ** 2
    if weights(values, slopes, n, weight, mix, 1.0, -goal, 0.0, 1e-3, False) >= 0.0:
        return 0
    full[:] = 0.0
    for j in range(n):
        full[place[j]] = weight[j]
    sum_of(p, h, legs, full, line[:4], frame, out)
    return -1 if out[BASE] + rise(out, frame[SPIN]) < 0.0 else 0


@njit(error_model="numpy", nogil=True)
def buffers_for(legs: Array) -> Buffers:
    """Return the arrays that `compare` needs."""
    m = 2 * len(legs) + 1
    return (
        np.empty(m),
        np.empty((m, 6)),
        np.empty(m),
        np.empty(m),
        np.empty(6),
        np.empty(LINE),
        np.empty(SUM),
        np.empty(m, dtype=np.int64),
    )


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
    buffers, frame, trial = buffers_for(legs), np.empty(FRAME), np.empty(3)
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
                if compare(p, h, legs, frame, buffers) < 0:
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
