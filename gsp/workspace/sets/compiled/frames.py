"""Compiled frames of cells of angles: rotations, turns along each angle, and how far they go.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array

# Numbers of a rotation cell's frame: R by rows, the three turns by rows, w, w₂.
CELL_FRAME_SCALARS, TURNS, SPIN, TWIST = 20, 9, 18, 19


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
def turn_about(r: Array, axis: Array, angle: float, out: Array) -> None:
    """Write the rotation r (9,), turned by an angle about a unit axis of the fixed frame."""
    c, s = np.cos(angle), np.sin(angle)
    for k in range(3):
        x, y, z = r[k], r[3 + k], r[6 + k]
        along = (axis[0] * x + axis[1] * y + axis[2] * z) * (1.0 - c)
        out[k] = x * c + (axis[1] * z - axis[2] * y) * s + axis[0] * along
        out[3 + k] = y * c + (axis[2] * x - axis[0] * z) * s + axis[1] * along
        out[6 + k] = z * c + (axis[0] * y - axis[1] * x) * s + axis[2] * along


@njit(error_model="numpy", nogil=True)
def trace_of(r: Array, s: Array) -> float:
    """Return the trace of rᵀ s of two rotations, (≥ 9,) each: 1 + 2 cos of the angle between."""
    trace = 0.0
    for k in range(9):
        trace += r[k] * s[k]
    return trace


@njit(error_model="numpy", nogil=True)
def angle_between(r: Array, s: Array) -> float:
    """Return an upper bound of the angle between two rotations, (≥ 9,) each."""
    cosine = 0.5 * (trace_of(r, s) - 1.0)
    # arccos has an error of the root of the rounding at 0.
    return float(np.arccos(min(1.0, max(-1.0, cosine))) + 1e-7)


@njit(error_model="numpy", nogil=True)
def straighten(r: Array) -> None:
    """Make the rows of a rotation (9,) orthonormal again, after many turns."""
    for i in range(3):
        for j in range(i):
            dot = 0.0
            for k in range(3):
                dot += r[3 * i + k] * r[3 * j + k]
            for k in range(3):
                r[3 * i + k] -= dot * r[3 * j + k]
        size = 0.0
        for k in range(3):
            size += r[3 * i + k] ** 2
        size = np.sqrt(size)
        for k in range(3):
            r[3 * i + k] /= size
