"""Compiled distance of two segments, for code that takes one cell at a time.

`gsp.limits.legs` computes the same on arrays, for limits of postures: it is called without
numba, whose import takes most of a second. Cells need it inside a compiled loop.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.limits.legs import PARALLEL_SINE_SQUARED

# Parts of a segment that moves with one of its ends.
PARTS_OF_SEGMENT = 4


@njit(error_model="numpy", nogil=True)
def _to_segment(x: Array, start: Array, end: Array) -> float:
    """Return the distance of a point from a segment."""
    along, size = 0.0, 0.0
    for k in range(3):
        u = end[k] - start[k]
        along += (x[k] - start[k]) * u
        size += u * u
    share = min(1.0, max(0.0, along / size)) if size > 0.0 else 0.0
    square = 0.0
    for k in range(3):
        square += (x[k] - start[k] - share * (end[k] - start[k])) ** 2
    return float(np.sqrt(square))


@njit(error_model="numpy", nogil=True)
def segment_gap(p: Array, p_end: Array, q: Array, q_end: Array) -> float:
    """Return the distance of two segments [length].

    That of the lines if they come nearest within both, else from an end.

    Parameters
    ----------
    p, p_end, q, q_end : (3,) arrays [length]
        The ends of the segments, which may coincide.
    """
    best = min(
        min(_to_segment(p, q, q_end), _to_segment(p_end, q, q_end)),
        min(_to_segment(q, p, p_end), _to_segment(q_end, p, p_end)),
    )
    a, b, c, d, e = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        u, v, w = p_end[k] - p[k], q_end[k] - q[k], p[k] - q[k]
        a, b, c, d, e = a + u * u, b + u * v, c + v * v, d + u * w, e + v * w
    n = a * c - b * b
    if n > PARALLEL_SINE_SQUARED * a * c:
        s, t = (b * e - c * d) / n, (a * e - b * d) / n
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            square = 0.0
            for k in range(3):
                x = p[k] + s * (p_end[k] - p[k]) - q[k] - t * (q_end[k] - q[k])
                square += x * x
            best = min(best, np.sqrt(square))
    return best


@njit(error_model="numpy", nogil=True)
def stay_apart(
    p: Array, p_end: Array, q: Array, q_end: Array, moves: Array, least: float, ends: Array
) -> bool:
    """Whether two segments whose second ends move are proven to be some distance apart.

    At the shares s and t of the segments, their difference changes by at most |s − t| of a common
    motion, s of that of the first end, and t of that of the second. Parts of the segments are
    compared one by one, as ends move most and segments are often nearest at their other ends.

    Parameters
    ----------
    p, p_end, q, q_end : (3,) arrays [length]
    moves : (3,) array [length]
        Bounds of the common motion of the ends, and of that of each of them besides.
    least : float [length]
        The distance.
    ends : (4, 3) array
        Working memory.
    """
    step = 1.0 / PARTS_OF_SEGMENT
    for i in range(PARTS_OF_SEGMENT):
        for j in range(PARTS_OF_SEGMENT):
            for k in range(3):
                u, v = step * (p_end[k] - p[k]), step * (q_end[k] - q[k])
                ends[0, k], ends[1, k] = p[k] + i * u, p[k] + (i + 1) * u
                ends[2, k], ends[3, k] = q[k] + j * v, q[k] + (j + 1) * v
            reach = (abs(i - j) + 1) * moves[0] + (i + 1) * moves[1] + (j + 1) * moves[2]
            if segment_gap(ends[0], ends[1], ends[2], ends[3]) < least + step * reach:
                return False
    return True
