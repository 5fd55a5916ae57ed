"""The compiled evaluation: all indices of a block of poses in one pass, LANES poses at a time.

Only this module and `straightline` import numba; import it where it is used.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.kernels import straightline as line
from gsp.kernels.stages import (
    ACTIVE,
    CHUNK,
    DETERMINANT,
    GEOMETRY,
    LANES,
    POSE,
    SPECTRUM,
    UNDEFINED,
    UPPER,
)

# What is solved, as bits of `problems`.
HOMOGENEOUS, ELLIPSOID, CONTROL = 1, 2, 4
# Rows of the result.
RECIPROCAL, LEAST, VOLUME, ELLIPSOID_RECIPROCAL, CONTROL_RECIPROCAL = range(5)
RESULTS = 5
# Laguerre's steps converge by at least 0.4 each, so that fewer than 40 are needed.
MOST_STEPS = 60

N_ROWS = np.array([1, 1, 1, 1, 1, 2])
N_PASSIVE = np.array([4, 4, 4, 5, 6, 5])


@njit(error_model="numpy", nogil=True)
def _load(position, rotation, start, count, pose):
    """Copy LANES poses, scalar by scalar; the last pose fills up an incomplete block."""
    for i in range(LANES):
        at = start + min(i, count - 1)
        for k in range(3):
            pose[k * LANES + i] = position[at, k]
        for k in range(9):
            pose[(3 + k) * LANES + i] = rotation[at, k]
    line.reach(pose)


@njit(error_model="numpy", nogil=True)
def _triangle(rows, n, factors, sums, upper):
    """QR factorisation of an n × 6 matrix, followed by CHUNK rows of zeros, by Householder."""
    row = 6 * LANES
    for i in range(n, n + CHUNK):
        rows[i * row : (i + 1) * row] = 0.0
    sums[:] = 0.0
    for i in range(0, n, CHUNK):
        line.sweep(0, rows[i * row :], factors, sums)
    line.pivot(0, rows, sums, factors, upper)
    for column in range(1, 6):
        for i in range(column, n, CHUNK):
            line.sweep(column, rows[i * row :], factors, sums)
        line.pivot(column, rows[column * row :], sums, factors, upper)


@njit(error_model="numpy", nogil=True)
def _solve(matrix, n, factors, sums, upper, spectrum, result):
    """Extreme singular values and determinant of an n × 6 matrix."""
    if n > 6:
        _triangle(matrix, n, factors, sums, upper)
        matrix[: 36 * LANES] = 0.0
        k = 0
        for i in range(6):
            for j in range(i, 6):
                place = 6 * i + j
                matrix[place * LANES : (place + 1) * LANES] = upper[k * LANES : (k + 1) * LANES]
                k += 1
    line.bidiagonal(matrix, spectrum)
    for _ in range(MOST_STEPS):
        line.laguerre(spectrum)
        active = 0.0
        for i in range(ACTIVE * LANES, (ACTIVE + 1) * LANES):
            active += spectrum[i]
        if not active > 0.0:
            break
    line.extremes(spectrum, result)


@njit(error_model="numpy", nogil=True)
def _store(values, offset, scale, missing, out, k, start, count):
    for i in range(count):
        value = values[offset * LANES + i] * scale
        out[k, start + i] = np.nan if missing[UNDEFINED * LANES + i] > 0.0 else value


@njit(
    "void(float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], float64[::1], float64,"
    " float64, int64, float64[:, ::1])",
    error_model="numpy",
    nogil=True,
    cache=True,
)
def evaluate_block(
    position, rotation, kinds, geometry, ellipsoid, length, volume, problems, out
):
    """Solve the wanted problems for a block of poses.

    Parameters
    ----------
    position, rotation : (n, 3) and (n, 9) arrays
    kinds : (n_legs,) int array
        Places in `gsp.legs.LEGS`.
    geometry : (n_legs, 13) array
        a, b, s, t, |a| + |b|.
    ellipsoid : (12,) array
        Centre, and axes over the roots of their inertia, by rows.
    length : float
        Characteristic length.
    volume : float
        What |det| of the homogeneous Jacobian is multiplied with.
    problems : int
        Sum of HOMOGENEOUS, ELLIPSOID, CONTROL.
    out : (5, n) array
        Filled for the wanted problems; NaN where the pose is undefined.
    """
    n, n_rows, n_passive = position.shape[0], 0, 0
    for kind in kinds:
        n_rows += N_ROWS[kind]
        n_passive += N_PASSIVE[kind]
    row = 6 * LANES
    pose, frame = np.empty(POSE * LANES), np.empty(12 * LANES)
    rows, matrix = np.empty(n_rows * row), np.empty((n_rows + CHUNK) * row)
    passive, upper = np.empty((n_passive + CHUNK) * row), np.empty(UPPER * LANES)
    factors, sums = np.empty(row), np.empty(row)
    spectrum, result = np.empty(SPECTRUM * LANES), np.empty(3 * LANES)
    for start in range(0, n, LANES):
        count = min(LANES, n - start)
        _load(position, rotation, start, count, pose)
        at = 0
        for leg in range(kinds.size):
            line.rows(kinds[leg], pose, geometry[leg], rows[at * row :], length)
            at += N_ROWS[kinds[leg]]
        if problems & HOMOGENEOUS:
            for r in range(n_rows):
                line.homogeneous_row(rows[r * row :], matrix[r * row :], 1.0 / length)
            _solve(matrix, n_rows, factors, sums, upper, spectrum, result)
            _store(result, 0, 1.0, pose, out, RECIPROCAL, start, count)
            _store(result, 1, 1.0, pose, out, LEAST, start, count)
            _store(spectrum, DETERMINANT, volume, pose, out, VOLUME, start, count)
        if problems & ELLIPSOID:
            line.ellipsoid_frame(pose, ellipsoid, frame)
            for r in range(n_rows):
                line.ellipsoid_row(rows[r * row :], frame, matrix[r * row :])
            _solve(matrix, n_rows, factors, sums, upper, spectrum, result)
            _store(result, 0, 1.0, pose, out, ELLIPSOID_RECIPROCAL, start, count)
        if problems & CONTROL:
            at = 0
            for leg in range(kinds.size):
                line.passive(kinds[leg], pose, geometry[leg], passive[at * row :], length)
                at += N_PASSIVE[kinds[leg]]
            _triangle(passive, n_passive, factors, sums, upper)
            for r in range(n_rows):
                line.solved_row(rows[r * row :], upper, matrix[r * row :])
            _solve(matrix, n_rows, factors, sums, upper, spectrum, result)
            _store(result, 0, 1.0, pose, out, CONTROL_RECIPROCAL, start, count)
