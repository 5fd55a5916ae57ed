"""What compiled evaluations share: the memory of a block, its poses, and matrices of LANES poses.

Only import this module where it is used: it loads numba.
"""

from __future__ import annotations

from pathlib import Path
from zlib import crc32

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.kernels import stages
from gsp.kernels.compiled.vectorised import vectorised
from gsp.kernels.stages import LANES, POSE_SCALARS, QR_ROWS_AT_ONCE, SPECTRUM_SCALARS, UPPER_SCALARS

_reach = vectorised(stages.REACH_STAGE)
_sweep, _pivot = vectorised(*stages.SWEEPS), vectorised(*stages.PIVOTS)
bidiagonalise, iterate_laguerre = vectorised(stages.BIDIAGONAL), vectorised(stages.LAGUERRE)
_extremes = vectorised(stages.EXTREMES)

# Rows that the actuators of a leg of each kind give.
ACTUATOR_ROWS = np.array(stages.N_ACTUATORS)

# Where the arrays of a block lie in its memory; the two of unknown size come last.
ROW_DOUBLES = 6 * LANES
AT_POSE = 0
AT_FRAME = AT_POSE + POSE_SCALARS * LANES
AT_UPPER = AT_FRAME + 2 * ROW_DOUBLES
AT_FACTORS = AT_UPPER + UPPER_SCALARS * LANES
AT_SUMS = AT_FACTORS + ROW_DOUBLES
AT_SPECTRUM = AT_SUMS + ROW_DOUBLES
AT_RESULT = AT_SPECTRUM + SPECTRUM_SCALARS * LANES
AT_ROWS = AT_RESULT + 3 * LANES


@njit(error_model="numpy", nogil=True)
def load_poses(position: Array, rotation: Array, start: int, count: int, memory: Array) -> None:
    """Copy LANES poses, scalar by scalar; the last pose fills up an incomplete block."""
    for i in range(LANES):
        pose = start + min(i, count - 1)
        for k in range(3):
            memory[AT_POSE + k * LANES + i] = position[pose, k]
        for k in range(9):
            memory[AT_POSE + (3 + k) * LANES + i] = rotation[pose, k]
    _reach(0, memory, AT_POSE)


@njit(error_model="numpy", nogil=True)
def triangularise(memory: Array, at: int, n: int) -> None:
    """R of an n × 6 matrix that QR_ROWS_AT_ONCE free rows follow, by Householder reflections."""
    for i in range(at + n * ROW_DOUBLES, at + (n + QR_ROWS_AT_ONCE) * ROW_DOUBLES):
        memory[i] = 0.0
    for i in range(AT_SUMS, AT_SUMS + ROW_DOUBLES):
        memory[i] = 0.0
    for column in range(6):
        for row in range(column, n, QR_ROWS_AT_ONCE):
            _sweep(column, memory, at + row * ROW_DOUBLES, memory, AT_FACTORS, memory, AT_SUMS)
        _pivot(
            column,
            memory,
            at + column * ROW_DOUBLES,
            memory,
            AT_SUMS,
            memory,
            AT_FACTORS,
            memory,
            AT_UPPER,
        )


@njit(error_model="numpy", nogil=True)
def write_square(memory: Array, at: int) -> None:
    """Write the upper triangle as a 6 × 6 matrix."""
    k = AT_UPPER
    for i in range(6):
        for j in range(6):
            for lane in range(LANES):
                value = memory[k + lane] if j >= i else 0.0
                memory[at + (6 * i + j) * LANES + lane] = value
            k += LANES if j >= i else 0


@njit(error_model="numpy", nogil=True)
def solve_spectrum(memory: Array, at: int, n: int) -> None:
    """Extreme singular values and determinant of an n × 6 matrix, n ≥ 6."""
    if n > 6:
        triangularise(memory, at, n)
        write_square(memory, at)
    bidiagonalise(0, memory, at, memory, AT_SPECTRUM)
    iterate_laguerre(0, memory, AT_SPECTRUM)
    _extremes(0, memory, AT_SPECTRUM, memory, AT_RESULT)


def checksum_of_code(number: int) -> int:
    """Return a checksum of this module and the one that writes the code, from that of the stages.

    Numba's cache depends only on the file of the function itself.
    """
    for name in ("matrices.py", "vectorised.py"):
        number = crc32(Path(__file__).with_name(name).read_bytes(), number)
    return number
