"""The decision of one cell of positions of SPS legs, over all rotations or those of a range.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.workspace.sets.compiled.climbing import ascend
from gsp.workspace.sets.compiled.covering import WEIGHT_TURN, at_middle, none_feasible
from gsp.workspace.sets.compiled.frames import (
    CELL_FRAME_SCALARS,
    SPIN,
    angle_between,
    frame_of,
    straighten,
)
from gsp.workspace.sets.compiled.sums import (
    COUPLING,
    MIDDLE,
    PULL,
    SECOND,
    SLOPE,
    SUM_SCALARS,
    ball,
    rise,
)
from gsp.workspace.sets.compiled.witness import witnessed

# Steps of a climb; climbs from rotations that no family comes from; proofs of one cell.
REACH_CLIMB_STEPS, EXTRA_CLIMBS, PROOFS_PER_CELL = 20, 2, 6
# Rotations nearer than this belong to one family [rad].
SAME_FAMILY = 0.03
# Share of the size of a cell by which its outside part is taken smaller, so that it is proven.
SPARE_SHARE = 0.05
# A part is sought if it may be greater than this: −1 for nothing, 1 for all of the cell.
LEAST_PART = -0.8


@njit(error_model="numpy", nogil=True)
def _met(r: Array, margin: float, family: Array, margins: Array, count: int) -> tuple[int, int]:
    """Keep a rotation among the best of its cell; return its place, or −1, and how many are."""
    for k in range(count):
        if angle_between(r, family[k]) < SAME_FAMILY:
            return -1, count
    place = count
    if count == len(family):
        place = 0
        for k in range(count):
            if margins[k] < margins[place]:
                place = k
        if margins[place] >= margin:
            return -1, count
        count -= 1
    family[place], margins[place] = r, margin
    return place, count + 1


@njit(error_model="numpy", nogil=True)
def _farthest(r: Array, turns: Array, given: Array) -> float:
    """Return an upper bound of the angle from a rotation to those of some cells."""
    frame, far = np.empty(CELL_FRAME_SCALARS), 0.0
    for i in range(len(given)):
        frame_of(given[i, :3], given[i, 3:], turns, frame)
        far = max(far, angle_between(r, frame) + frame[SPIN])
    return min(np.pi, far)


@njit(error_model="numpy", nogil=True)
def outside_part(
    p: Array,
    h: Array,
    legs: Array,
    faces: Array,
    turns: Array,
    within: Array,
    given: Array,
    r: Array,
    most: int,
    cut: Array,
) -> tuple[bool, int]:
    """Find a part n · δ ≤ c of a box that is outside; write n and c. Return whether, and nodes."""
    m = 2 * len(legs) + 1 + len(faces)
    values, slopes, weight, mix = np.empty(m), np.empty((m, 6)), np.empty(m), np.empty(6)
    out, stop = np.empty(SUM_SCALARS), np.empty(12)
    ball(
        p,
        h,
        legs,
        faces,
        r,
        WEIGHT_TURN,
        -np.inf,
        cut,
        False,
        values,
        slopes,
        weight,
        mix,
        out,
        False,
    )
    size = 0.0
    for k in range(3):
        cut[k] = out[SLOPE + k]
        size += abs(cut[k]) * h[k]
    top = 0.0
    if out[PULL] > 0.0 or out[COUPLING] > 0.0:
        far = np.pi if len(within) == 0 else _farthest(r, turns, given)
        top = rise(out, np.sin(0.5 * far))
    cut[3] = min(size, -(out[MIDDLE] + out[SECOND] + top) - SPARE_SHARE * size)
    if not cut[3] > LEAST_PART * size:
        return False, 1
    code, nodes = none_feasible(p, h, legs, faces, turns, within, given, r, cut, True, most, stop)
    return code == 1, nodes + 1


@njit(error_model="numpy", nogil=True)
def reach_cell(
    p: Array,
    h: Array,
    family: Array,
    count: int,
    legs: Array,
    faces: Array,
    turns: Array,
    within: Array,
    given: Array,
    most: int,
    cut: Array,
) -> tuple[int, int, int]:
    """Decide a cell of positions; return its code, how many families it has, and nodes.

    Parameters
    ----------
    p, h : (3,) arrays [length]
    family : (k, 12) array
        The first `count` are rotations where climbs begin; filled with those where they end: the
        rotation by rows, and its angles.
    legs, turns : arrays
        As in `Bounded`.
    faces : (f, 7) array
        As in `gsp.workspace.sets.faces`.
    within : (2, 3) array [rad]
        The range of the angles; (0, 3) for all rotations.
    given : (m, 6) array [rad]
        Rotation cells that hold the range.
    most : int
        Sums that one proof bounds, at most.
    cut : (8,) array
        Filled for an undecided cell: n and c of a part n · δ ≤ c that is outside, n and c of a part
        n · δ ≥ c that is inside.
    """
    m = 2 * len(legs) + 1 + len(faces)
    values, slopes, weight, mix = np.empty(m), np.empty((m, 6)), np.empty(m), np.empty(6)
    frame, axis = np.empty(CELL_FRAME_SCALARS), np.empty(3)
    new, r, stop = np.empty(12), np.empty(12), np.empty(12)
    normal, follows, nothing = np.empty(3), np.empty((3, 3)), np.zeros(3)
    starts, margins = family.copy(), np.empty(len(family))
    extra = EXTRA_CLIMBS if count > 0 else len(given)
    wide, hashed = h[0] + h[1] + h[2], 0
    if wide > 0.0:
        hashed = int(abs(p[0] + 1.7 * p[1] + 2.3 * p[2]) / wide * 7.0) % len(given)
    met, nodes, best, tightest = 0, 0, -1, np.inf
    for attempt in range(count + extra + PROOFS_PER_CELL):
        if attempt < count:
            r[:] = starts[attempt]
        elif attempt < count + extra:
            if count > 0 and margins[best] < -wide:
                continue
            which = (hashed + 11 * (attempt - count)) % len(given)
            frame_of(given[which, :3], given[which, 3:], turns, frame)
            at_middle(given[which], frame, r)
        else:
            if margins[best] >= 0.0:
                break
            first = family[best].copy()
            code, some = none_feasible(
                p, h, legs, faces, turns, within, given, first, cut, False, most, stop
            )
            nodes += some
            if code > 0:
                return -1, met, nodes
            if code < 0 or angle_between(stop, first) < 1e-3:
                break
            r[:] = stop
        start = 0.1 if attempt < count else 0.3
        margin = ascend(
            p,
            nothing,
            legs,
            turns,
            within,
            r,
            start,
            REACH_CLIMB_STEPS,
            values,
            slopes,
            weight,
            mix,
            new,
            axis,
        )
        if len(within) == 0:
            straighten(r)
        nodes += REACH_CLIMB_STEPS // 2
        place, met = _met(r, margin, family, margins, met)
        if place < 0:
            if attempt >= count + extra:
                break
            continue
        best = 0
        for k in range(met):
            if margins[k] > margins[best]:
                best = k
        if margin > -wide or (wide == 0.0 and margin >= 0.0):
            c = witnessed(
                p,
                h,
                legs,
                turns,
                within,
                r,
                margin,
                values,
                slopes,
                weight,
                mix,
                normal,
                follows,
            )
            if c == -np.inf:
                return 1, met, nodes
            size = 0.0
            for k in range(3):
                size += abs(normal[k]) * h[k]
            if c < tightest * size:
                tightest = c / size
                cut[4], cut[5], cut[6], cut[7] = normal[0], normal[1], normal[2], c
    if wide > 0.0:
        found, some = outside_part(
            p, h, legs, faces, turns, within, given, family[best], most, cut[:4]
        )
        nodes += some
        if not found:
            cut[3] = -np.inf
    return 0, met, nodes
