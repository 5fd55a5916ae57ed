"""The decision of one cell of positions that keep all rotations of a range, for SPS legs.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.legs import leg_vectors
from gsp.workspace.sets.compiled.bounds import LENGTH_SCALARS, SQUARE_ROUNDING, squares
from gsp.workspace.sets.compiled.frames import CELL_FRAME_SCALARS, SPIN, frame_of

# A rotation cell is not halved where its rotations change a squared length by no more than this
# share of what the positions of the cell do.
TURNING_SHARE = 0.1
# Rotations along each angle that are tried first, and halvings of the step to better ones.
TRIALS_PER_ANGLE, STEP_HALVINGS = 5, 7
# Rotation cells that wait.
KEEPING_STACK = 1024


@njit(error_model="numpy", nogil=True)
def _margin(p: Array, leg: Array, side: int, angles: Array, turns: Array, frame: Array) -> float:
    """Return l² − L² for the least length, L² − l² for the greatest one; the frame is written."""
    frame_of(angles, angles, turns, frame)
    a0, a1, a2, r0, r1, r2 = leg_vectors(p, leg, frame)
    square = (a0 + r0) ** 2 + (a1 + r1) ** 2 + (a2 + r2) ** 2
    bound = leg[7 + side]
    return float(bound * bound - square if side else square - bound * bound)


@njit(error_model="numpy", nogil=True)
def worst_rotation(
    p: Array, leg: Array, side: int, low: Array, high: Array, turns: Array, angles: Array
) -> float:
    """Write angles of a range at which a length is nearest to its bound, or beyond it.

    A grid, then steps along each angle that are halved. The result is only a proposal; return its
    difference of squares.
    """
    frame, trial = np.empty(CELL_FRAME_SCALARS), np.empty(3)
    best = np.inf
    for number in range(TRIALS_PER_ANGLE**3):
        left, again = number, False
        for k in range(3):
            trial[k] = low[k] + (high[k] - low[k]) * (left % TRIALS_PER_ANGLE) / (
                TRIALS_PER_ANGLE - 1.0
            )
            again = again or (high[k] == low[k] and left % TRIALS_PER_ANGLE > 0)
            left //= TRIALS_PER_ANGLE
        if again:  # of an angle without a range all trials are the first one
            continue
        value = _margin(p, leg, side, trial, turns, frame)
        if value < best:
            best = value
            angles[:] = trial
    step = 0.5 / (TRIALS_PER_ANGLE - 1.0)
    for _ in range(STEP_HALVINGS):
        for k in range(3):
            if high[k] == low[k]:
                continue
            for sign in (-1.0, 1.0):
                trial[:] = angles
                trial[k] += sign * step * (high[k] - low[k])
                trial[k] = min(high[k], max(low[k], trial[k]))
                value = _margin(p, leg, side, trial, turns, frame)
                if value < best:
                    best = value
                    angles[:] = trial
        step *= 0.5
    return best


@njit(error_model="numpy", nogil=True)
def _outside(p: Array, h: Array, leg: Array, side: int, frame: Array, cut: Array) -> float:
    """Write n and c of the part n · δ ≤ c where one rotation is beyond a bound; return c / size."""
    a0, a1, a2, r0, r1, r2 = leg_vectors(p, leg, frame)
    d0, d1, d2 = a0 + r0, a1 + r1, a2 + r2
    square = d0 * d0 + d1 * d1 + d2 * d2
    scale = abs(a0) + abs(r0) + (abs(a1) + abs(r1)) + (abs(a2) + abs(r2))
    factor, bound = -2.0 if side else 2.0, leg[7 + side]
    cut[0], cut[1], cut[2] = factor * d0, factor * d1, factor * d2
    wide, size = 0.0, 0.0
    for k in range(3):
        wide += h[k] * h[k]
        size += abs(cut[k]) * h[k]
    slack = SQUARE_ROUNDING * (scale * scale + wide)
    # |d + δ|² ≥ |d|² + 2 d · δ, and ≤ that and |δ|².
    if side:
        cut[3] = square - bound * bound - slack
    else:
        cut[3] = bound * bound - square - wide - slack
    if size <= 0.0:
        return np.inf if cut[3] > 0.0 else -np.inf
    # An open half-space: points on the plane may be feasible.
    cut[3] -= SQUARE_ROUNDING * size
    return float(cut[3] / size)


@njit(error_model="numpy", nogil=True)
def _narrow(
    p: Array, h: Array, leg: Array, side: int, cell: Array, frame: Array, line: Array
) -> bool:
    """Reduce a rotation cell to its worst end along angles in which a length is monotonic.

    The slope along an angle is 2 x · (ω × R b) with x = p + δ − a and the unit axis ω; over the
    cell ω and R b turn by no more than the spin, and x moves by no more than r.
    """
    arm, wide, narrowed = 0.0, 0.0, False
    for k in range(3):
        arm += (p[k] - leg[k]) ** 2
        wide += h[k] * h[k]
    change = 2.0 * leg[6] * (2.0 * np.sqrt(arm) * frame[SPIN] + np.sqrt(wide)) * (1.0 + 1e-9)
    for k in range(3):
        half = 0.5 * (cell[3 + k] - cell[k])
        if half > 0.0 and abs(line[6 + k]) > half * (1.0 + 1e-9) * change:
            grows = line[6 + k] > 0.0
            end = cell[3 + k] if grows == (side == 1) else cell[k]
            cell[k] = cell[3 + k] = end
            narrowed = True
    return narrowed


@njit(error_model="numpy", nogil=True)
def _all_kept(
    p: Array,
    h: Array,
    leg: Array,
    side: int,
    turns: Array,
    given: Array,
    normal: Array,
    most: int,
    stack: Array,
) -> tuple[float, int]:
    """Return the least c for which a leg is within a bound where n · δ ≥ c; and cells.

    NaN if one rotation is beyond the bound on all of the box.
    """
    line, frame = np.empty(LENGTH_SCALARS), np.empty(CELL_FRAME_SCALARS)
    square_n, size, bound = 0.0, 0.0, leg[7 + side]
    sign = -1.0 if side else 1.0
    arm, wide = 0.0, 0.0
    for k in range(3):
        square_n += normal[k] * normal[k]
        size += abs(normal[k]) * h[k]
        arm += abs(p[k] - leg[k]) + h[k]
        wide += h[k] * h[k]
    slack = SQUARE_ROUNDING * (arm + leg[6]) ** 2
    c, nodes, top = -np.inf, 0, len(given)
    stack[:top] = given
    while top > 0:
        top -= 1
        nodes += 1
        cell = stack[top]
        frame_of(cell[:3], cell[3:], turns, frame)
        squares(p, h, leg, frame, line)
        if side == 1 and line[1] <= bound * bound:
            continue
        if side == 0 and line[0] >= bound * bound and line[0] > 0.0:
            continue
        moving = abs(line[3]) + abs(line[4]) + abs(line[5]) + slack
        if side == 1 and line[2] - moving > bound * bound:
            return np.nan, nodes
        if side == 0 and line[2] + moving + wide < bound * bound:
            return np.nan, nodes
        if _narrow(p, h, leg, side, cell, frame, line):
            top += 1
            continue
        turning = abs(line[6]) + abs(line[7]) + abs(line[8])
        if square_n > 0.0 and turning + line[9] <= TURNING_SHARE * moving:
            value = sign * (line[2] - bound * bound) - turning - line[9 + side]
            share, beside = 0.0, 0.0
            for k in range(3):
                if h[k] > 0.0:
                    share += sign * line[3 + k] / h[k] * normal[k]
            if not share > 0.0:
                return np.inf, nodes
            share /= square_n
            for k in range(3):
                beside += abs(sign * line[3 + k] - share * normal[k] * h[k])
            c = max(c, (beside - value) / share)
            if c >= size:
                return np.inf, nodes
            continue
        k = 0
        for i in range(3):
            if cell[3 + i] - cell[i] > cell[3 + k] - cell[k]:
                k = i
        middle = 0.5 * (cell[k] + cell[3 + k])
        if nodes > most or top + 2 > len(stack) or not cell[k] < middle < cell[3 + k]:
            return np.inf, nodes
        stack[top + 1] = stack[top]
        stack[top, 3 + k] = middle
        stack[top + 1, k] = middle
        top += 2
    return c, nodes


@njit(error_model="numpy", nogil=True)
def keep_cell(
    p: Array,
    h: Array,
    legs: Array,
    turns: Array,
    given: Array,
    low: Array,
    high: Array,
    most: int,
    cut: Array,
) -> tuple[int, int]:
    """Decide a cell of positions that keep all rotations of a range; return its code, and nodes.

    Parameters
    ----------
    p, h : (3,) arrays [length]
    legs, turns : arrays
        As in `Bounded`.
    given : (m, 6) array [rad]
        Rotation cells that hold the range.
    low, high : (3,) arrays [rad]
        The range.
    most : int
        Rotation cells of one leg, at most.
    cut : (8,) array
        Filled for an undecided cell, as in `gsp.workspace.sets.tree.cuts`.
    """
    angles, frame, trial, normal = (
        np.empty(3),
        np.empty(CELL_FRAME_SCALARS),
        np.empty(4),
        np.zeros(3),
    )
    stack = np.empty((KEEPING_STACK, 6))
    worst, most_outside, nodes = np.inf, -1.0, 0
    for i in range(len(legs)):
        for side in range(2):
            if legs[i, 7 + side] == np.inf or (side == 0 and legs[i, 7] <= 0.0):
                continue
            nodes += TRIALS_PER_ANGLE**3 // 4
            value = worst_rotation(p, legs[i], side, low, high, turns, angles)
            value /= legs[i, 7 + side]
            frame_of(angles, angles, turns, frame)
            part = _outside(p, h, legs[i], side, frame, trial)
            if part >= 1.0:
                return -1, nodes
            if part > most_outside:
                most_outside = part
                cut[:4] = trial
            if value < worst:
                worst = value
                normal[:] = trial[:3]
    least = -np.inf
    for i in range(len(legs)):
        for side in range(2):
            # Without a least length the length must not be 0.
            if legs[i, 7 + side] == np.inf:
                continue
            c, some = _all_kept(p, h, legs[i], side, turns, given, normal, most, stack)
            nodes += some
            if np.isnan(c):
                return -1, nodes
            least = max(least, c)
            if least == np.inf:
                return 0, nodes
    size = 0.0
    for k in range(3):
        size += abs(normal[k]) * h[k]
    if least <= -size:
        return 1, nodes
    cut[4], cut[5], cut[6], cut[7] = normal[0], normal[1], normal[2], least
    return 0, nodes
