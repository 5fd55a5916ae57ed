"""Compiled bounds of leg lengths over cells of poses.

A cell is a box of positions, p + δ with |δ_k| ≤ h_k, and a box of three angles about moving axes.
`docs/sets.md` derives each bound. Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.legs import leg_vectors
from gsp.workspace.sets.compiled.frames import SPIN, TURNS, TWIST

# Every bound of squared lengths is widened by this share of the square of the size of the problem:
# some 4000 units of rounding, where evaluation makes about 50.
SQUARE_ROUNDING = 1e-12
# Numbers that bound a squared length.
LENGTH_SCALARS = 11


@njit(error_model="numpy", nogil=True)
def squares(p: Array, h: Array, leg: Array, frame: Array, out: Array) -> None:
    """Write bounds of a squared length over a cell, its value in the middle, and its slopes.

    Parameters
    ----------
    p, h : (3,) arrays
        Middle and half-widths of the positions.
    leg : (9,) array
        a, b, |b|, and the least and the greatest length.
    out : (LENGTH_SCALARS,) array
        Filled: least, greatest, middle; slopes along three positions and three angles, scaled by
        the half-widths; what is less, and more, than the linear part at most.
    """
    a0, a1, a2, r0, r1, r2 = leg_vectors(p, leg, frame)
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
    slack = SQUARE_ROUNDING * scale * scale
    out[9], out[10] = bend + slack, bend + shift * shift + slack
    out[0] = max(near * near - slack, square - linear - out[9])
    out[1] = min(far * far + slack, square + linear + out[10])
    out[2] = square
