"""Comparison of the lengths of SPS legs with their bounds, on one cell of poses.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.workspace.sets.compiled.bounds import LENGTH_SCALARS, squares
from gsp.workspace.sets.compiled.frames import SPIN
from gsp.workspace.sets.compiled.sums import BASE, SUM_SCALARS, rise, sum_of
from gsp.workspace.sets.compiled.weights import weights

Numbers = NDArray[np.int64]

# Values, slopes, weights, all weights, Σ w slopes, bounds of a length, a sum, places.
Buffers = tuple[Array, Array, Array, Array, Array, Array, Array, Numbers]


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
    sum_of(p, h, legs, np.empty((0, 7)), full, line[:4], frame, out)
    return -1 if out[BASE] + rise(out, np.sin(0.5 * min(frame[SPIN], np.pi))) < 0.0 else 0


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
        np.empty(LENGTH_SCALARS),
        np.empty(SUM_SCALARS),
        np.empty(m, dtype=np.int64),
    )
