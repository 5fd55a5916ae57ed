"""Compiled proofs that no rotation is feasible on a box of positions, by balls of rotations.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.workspace.sets.compiled.climbing import ascend
from gsp.workspace.sets.compiled.frames import (
    CELL_FRAME_SCALARS,
    SPIN,
    angle_between,
    frame_of,
    trace_of,
)
from gsp.workspace.sets.compiled.sums import BASE, SUM_SCALARS, ball

# Balls that are kept for comparison, rotation cells that wait, and climbs of one proof.
COMPARED_BALLS, COVERING_STACK, CLIMBS_PER_PROOF = 256, 1024, 30
# Numbers of a ball: its rotation, its angle, and the cosine and sine of that.
BALL_SCALARS, ANGLE, COSINE, SINE = 12, 9, 10, 11
# Climbs begin in rotation cells of less than this spin [rad], and have so many steps.
CLIMB_SPIN, COVER_CLIMB_STEPS = 1.0, 12
# Turns [rad] for which the weights about a given rotation are chosen.
WEIGHT_TURN = 0.3


@njit(error_model="numpy", nogil=True)
def _keep(balls: Array, count: int, r: Array, angle: float) -> int:
    """Add a ball, if it is one and there are fewer than COMPARED_BALLS; return their number."""
    if angle <= 0.0 or count >= len(balls):
        return count
    for k in range(9):
        balls[count, k] = r[k]
    balls[count, ANGLE] = angle
    balls[count, COSINE], balls[count, SINE] = np.cos(angle), np.sin(angle)
    return count + 1


@njit(error_model="numpy", nogil=True)
def _known(frame: Array, balls: Array, count: int) -> bool:
    """Whether a rotation cell is in one of the balls."""
    spin = frame[SPIN]
    cosine, sine = np.cos(spin), np.sin(spin)
    for k in range(count):
        kept = balls[k]
        if kept[ANGLE] < spin:
            continue
        # The cosines are compared first, as most balls are too far away and arccos is slow.
        nearest = kept[COSINE] * cosine + kept[SINE] * sine
        near = 0.5 * (trace_of(frame, kept) - 1.0) >= nearest - 1e-9
        if near and angle_between(frame, kept) + spin <= kept[ANGLE]:
            return True
    return False


@njit(error_model="numpy", nogil=True)
def at_middle(cell: Array, frame: Array, r: Array) -> None:
    """Write the rotation and the angles (12,) in the middle of a rotation cell."""
    r[:9] = frame[:9]
    for k in range(3):
        r[9 + k] = 0.5 * (cell[k] + cell[3 + k])


@njit(error_model="numpy", nogil=True)
def none_feasible(
    p: Array,
    h: Array,
    legs: Array,
    faces: Array,
    turns: Array,
    within: Array,
    given: Array,
    first: Array,
    cut: Array,
    cutting: bool,
    most: int,
    stop: Array,
) -> tuple[int, int]:
    """Prove that no rotation of some cells is feasible on a box, or the part n · δ ≤ c of it.

    Parameters
    ----------
    p, h : (3,) arrays [length]
    legs, faces, turns, within : arrays
        As in `reach_cell`.
    given : (m, 6) array [rad]
        The rotation cells.
    first : (12,) array
        A rotation where a pose is most likely to be feasible.
    cut : (4,) array
        n and c; used with `cutting`.
    most : int
        Rotation cells, at most.
    stop : (12,) array
        Filled with a rotation that is not excluded, if there is one.

    Returns
    -------
    1 if it is proven, 0 at a rotation that sums do not exclude, −1 at the end of the cells; and how
    many sums were bounded.
    """
    m = 2 * len(legs) + 1 + len(faces)
    values, slopes, weight, mix = np.empty(m), np.empty((m, 6)), np.empty(m), np.empty(6)
    out, frame, nothing = np.empty(SUM_SCALARS), np.empty(CELL_FRAME_SCALARS), np.zeros(3)
    r, new, axis = np.empty(12), np.empty(12), np.empty(3)
    balls, stack = np.empty((COMPARED_BALLS, BALL_SCALARS)), np.empty((COVERING_STACK, 6))
    arm, count, climbs, top, nodes = 0.0, 0, 0, len(given), 1
    for i in range(len(legs)):
        arm = max(arm, legs[i, 6])
    angle = ball(
        p,
        h,
        legs,
        faces,
        first,
        WEIGHT_TURN,
        -np.inf,
        cut,
        cutting,
        values,
        slopes,
        weight,
        mix,
        out,
        False,
    )
    if angle >= np.pi:
        return 1, nodes
    if angle <= 0.0:
        nodes += 1
        ball(
            p,
            h,
            legs,
            faces,
            first,
            0.0,
            0.0,
            cut,
            cutting,
            values,
            slopes,
            weight,
            mix,
            out,
            False,
        )
        if out[BASE] >= 0.0:
            stop[:] = first
            return 0, nodes
    count = _keep(balls, count, first, angle)
    stack[:top] = given
    while top > 0:
        top -= 1
        frame_of(stack[top, :3], stack[top, 3:], turns, frame)
        spin = frame[SPIN]
        if _known(frame, balls, count):
            continue
        nodes += 1
        w = min(spin, np.pi)
        goal = -0.5 * arm * w * w
        angle = ball(
            p, h, legs, faces, frame, w, goal, cut, cutting, values, slopes, weight, mix, out, True
        )
        if angle >= w:
            count = _keep(balls, count, frame, angle)
            continue
        if angle <= 0.0:
            nodes += 1
            angle = ball(
                p,
                h,
                legs,
                faces,
                frame,
                0.0,
                0.0,
                cut,
                cutting,
                values,
                slopes,
                weight,
                mix,
                out,
                False,
            )
            if out[BASE] >= 0.0:
                at_middle(stack[top], frame, stop)
                return 0, nodes
        count = _keep(balls, count, frame, angle)
        if spin < CLIMB_SPIN and climbs < CLIMBS_PER_PROOF:
            # Weights of the local optimum exclude the most, or show that nothing does.
            climbs += 1
            nodes += COVER_CLIMB_STEPS
            at_middle(stack[top], frame, r)
            ascend(
                p,
                nothing,
                legs,
                turns,
                within,
                r,
                min(spin, WEIGHT_TURN),
                COVER_CLIMB_STEPS,
                values,
                slopes,
                weight,
                mix,
                new,
                axis,
            )
            w = min(0.5, 2.0 * spin)
            angle = ball(
                p,
                h,
                legs,
                faces,
                r,
                w,
                -np.inf,
                cut,
                cutting,
                values,
                slopes,
                weight,
                mix,
                out,
                True,
            )
            if angle <= 0.0:
                angle = ball(
                    p,
                    h,
                    legs,
                    faces,
                    r,
                    0.0,
                    -np.inf,
                    cut,
                    cutting,
                    values,
                    slopes,
                    weight,
                    mix,
                    out,
                    True,
                )
            if out[BASE] >= 0.0:
                stop[:] = r
                return 0, nodes
            count = _keep(balls, count, r, angle)
            if angle_between(r, frame) + spin <= angle:
                continue
        if nodes > most or top + 2 > len(stack):
            at_middle(stack[top], frame, stop)
            return -1, nodes
        k = 0
        for i in range(3):
            if stack[top, 3 + i] - stack[top, i] > stack[top, 3 + k] - stack[top, k]:
                k = i
        middle = 0.5 * (stack[top, k] + stack[top, 3 + k])
        for i in range(6):
            stack[top + 1, i] = stack[top, i]
        stack[top, 3 + k] = middle
        stack[top + 1, k] = middle
        top += 2
    return 1, nodes
