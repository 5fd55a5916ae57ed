"""The compiled evaluation: all indices of a block of poses in one pass, LANES poses at a time.

Only import this module where it is used: it loads numba.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kernels import stages
from gsp.kernels.compiled.matrices import (
    ACTUATOR_ROWS,
    AT_FRAME,
    AT_POSE,
    AT_RESULT,
    AT_ROWS,
    AT_UPPER,
    ROW_DOUBLES,
    checksum_of_code,
    load_poses,
    solve_spectrum,
    triangularise,
)
from gsp.kernels.compiled.vectorised import vectorised
from gsp.kernels.problems import (
    CONTROL_PROBLEM,
    CONTROL_RECIPROCAL,
    ELLIPSOID_PROBLEM,
    ELLIPSOID_RECIPROCAL,
    HOMOGENEOUS_PROBLEM,
    LEAST,
    RECIPROCAL,
    VOLUME,
)
from gsp.kernels.stages import LANES, LEG_SCALARS, POSE_UNDEFINED, QR_ROWS_AT_ONCE

_actuators, _passive = vectorised(*stages.ACTUATORS), vectorised(*stages.PASSIVE)
_homogeneous_row = vectorised(stages.HOMOGENEOUS_ROW)
_ellipsoid_frame = vectorised(stages.ELLIPSOID_FRAME)
_ellipsoid_row = vectorised(stages.ELLIPSOID_ROW)
_solved_row = vectorised(stages.SOLVED_ROW)

_N_PASSIVE = np.array(stages.N_PASSIVE)


@njit(error_model="numpy", nogil=True)
def _store(memory: Array, at: int, out: Array, k: int, start: int, count: int) -> None:
    """Write a scalar of the poses to row k of the result, NaN where a pose is undefined."""
    for i in range(count):
        defined = memory[AT_POSE + POSE_UNDEFINED * LANES + i] == 0.0
        out[k, start + i] = memory[at + i] if defined else np.nan


@njit(error_model="numpy", nogil=True)
def _store_rows(memory: Array, n: int, out: Array, start: int, count: int) -> None:
    """Write n scalars of the rows of each pose."""
    for i in range(count):
        for k in range(n):
            out[start + i, k] = memory[AT_ROWS + k * LANES + i]


def _driver(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the numbers it encloses."""

    def evaluate_block(
        position: Array,
        rotation: Array,
        kinds: NDArray[np.int64],
        geometry: Array,
        ellipsoid: Array,
        length: float,
        problems: int,
        out: Array,
        rows: Array,
    ) -> None:
        """Solve the wanted problems for a block of poses.

        Parameters
        ----------
        position, rotation : (n, 3) and (n, 9) arrays
        kinds : (n_legs,) int array
            Places in `gsp.model.legs.LEGS`.
        geometry : (n_legs * 13,) array
            a, b, s, t, |a| + |b| of each leg.
        ellipsoid : (12,) array
            Centre, and axes over the roots of their inertia, by rows.
        length : float
            Characteristic length.
        problems : int
            Sum of HOMOGENEOUS_PROBLEM, ELLIPSOID_PROBLEM, CONTROL_PROBLEM.
        out : (5, n) array
            Filled for the wanted problems; NaN where the pose is undefined.
        rows : (n, 6 n_actuators) array, or (0, 0) if they are not wanted
            Filled with the Jacobians, in which rows of angles are multiplied by the length.
        """
        n, n_rows, n_passive = position.shape[0], 0, 0 * digest
        for kind in kinds:
            n_rows += ACTUATOR_ROWS[kind]
            n_passive += _N_PASSIVE[kind]
        at_matrix = AT_ROWS + n_rows * ROW_DOUBLES
        at_passive = at_matrix + (n_rows + QR_ROWS_AT_ONCE) * ROW_DOUBLES
        memory = np.empty(at_passive + (n_passive + QR_ROWS_AT_ONCE) * ROW_DOUBLES)
        for start in range(0, n, LANES):
            count = min(LANES, n - start)
            load_poses(position, rotation, start, count, memory)
            at = AT_ROWS
            for leg in range(kinds.size):
                kind = kinds[leg]
                _actuators(kind, memory, AT_POSE, geometry, leg * LEG_SCALARS, memory, at, length)
                at += ACTUATOR_ROWS[kind] * ROW_DOUBLES
            if rows.size:
                _store_rows(memory, 6 * n_rows, rows, start, count)
            if problems & HOMOGENEOUS_PROBLEM:
                for i in range(0, n_rows * ROW_DOUBLES, ROW_DOUBLES):
                    _homogeneous_row(0, memory, AT_ROWS + i, memory, at_matrix + i, 1.0 / length)
                solve_spectrum(memory, at_matrix, n_rows)
                _store(memory, AT_RESULT, out, RECIPROCAL, start, count)
                _store(memory, AT_RESULT + LANES, out, LEAST, start, count)
                _store(memory, AT_RESULT + 2 * LANES, out, VOLUME, start, count)
            if problems & ELLIPSOID_PROBLEM:
                _ellipsoid_frame(0, memory, AT_POSE, ellipsoid, 0, memory, AT_FRAME)
                for i in range(0, n_rows * ROW_DOUBLES, ROW_DOUBLES):
                    _ellipsoid_row(0, memory, AT_ROWS + i, memory, AT_FRAME, memory, at_matrix + i)
                solve_spectrum(memory, at_matrix, n_rows)
                _store(memory, AT_RESULT, out, ELLIPSOID_RECIPROCAL, start, count)
            if problems & CONTROL_PROBLEM:
                at = at_passive
                for leg in range(kinds.size):
                    kind = kinds[leg]
                    _passive(kind, memory, AT_POSE, geometry, leg * LEG_SCALARS, memory, at, length)
                    at += _N_PASSIVE[kind] * ROW_DOUBLES
                triangularise(memory, at_passive, n_passive)
                for i in range(0, n_rows * ROW_DOUBLES, ROW_DOUBLES):
                    _solved_row(0, memory, AT_ROWS + i, memory, AT_UPPER, memory, at_matrix + i)
                solve_spectrum(memory, at_matrix, n_rows)
                _store(memory, AT_RESULT, out, CONTROL_RECIPROCAL, start, count)

    return evaluate_block


def _fixed(dimensions: int) -> types.Array:
    return types.Array(types.float64, dimensions, "C", readonly=True)


evaluate_block = njit(
    types.void(
        _fixed(2),
        _fixed(2),
        types.Array(types.int64, 1, "C", readonly=True),
        _fixed(1),
        _fixed(1),
        types.float64,
        types.int64,
        types.float64[:, ::1],
        types.float64[:, ::1],
    ),
    error_model="numpy",
    nogil=True,
    cache=True,
)(_driver(checksum_of_code(stages.checksum())))


@njit(
    types.boolean(_fixed(1), _fixed(2), types.float64),
    error_model="numpy",
    nogil=True,
    cache=True,
)
def is_pose(position: Array, rotation: Array, tolerance: float) -> bool:
    """Whether a position (3,) is finite and a matrix (3, 3) a rotation, as `Pose` requires."""
    good = True
    for i in range(3):
        good &= np.isfinite(position[i])
        for j in range(3):
            entry = -1.0 if i == j else 0.0
            for k in range(3):
                entry += rotation[k, i] * rotation[k, j]
            good &= abs(entry) <= tolerance
    x, y, z = rotation
    determinant = (
        x[0] * (y[1] * z[2] - y[2] * z[1])
        + x[1] * (y[2] * z[0] - y[0] * z[2])
        + x[2] * (y[0] * z[1] - y[1] * z[0])
    )
    return good and determinant > 0.0
