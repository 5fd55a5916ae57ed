"""Compiled tracking: from each sample of joint values to the next, in the first of the LANES.

Only import this module where it is used: it loads numba.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from zlib import crc32

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kernels.stages import LANES
from gsp.kinematics.newton import compiled
from gsp.kinematics.newton.compiled import (
    AT_ERRORS,
    AT_HERE,
    AT_SEARCH,
    AT_TARGET,
    GIVEN,
    SEARCH_MEMORY,
    digest_of_code,
    fixed,
    load,
    search,
    store,
)
from gsp.kinematics.newton.control import CONVERGED, LARGEST_STEP, SINGULAR, UNDEFINED
from gsp.kinematics.newton.stages import (
    POINT_INVERSE,
    POINT_LARGEST,
    POINT_SCALARS,
    POINT_SIZE,
    POINT_SQUARE,
    POINT_STEP,
    SEARCH_ENDING,
    SEARCH_SHARE,
    SEARCH_STEPS,
)

# How a track ends, beside the numbers of `control`.
AT_GAP = 5
# Steps within which a piece of the way between two samples must converge, or it is halved.
STEPS_PER_PIECE = 6
# Halvings of the way between two samples.
SAMPLE_HALVINGS = 20


@njit(error_model="numpy", nogil=True)
def _aim(memory: Array, values: Array, target: Array) -> bool:
    """Begin a search for a target where the last one ended; False if the first step is cut."""
    error, size, largest = np.empty(6), 0.0, 0.0
    for k in range(6):
        memory[AT_TARGET + k * LANES] = target[k]
        error[k] = values[k] - target[k]
        size += error[k] * error[k]
        largest = max(largest, abs(error[k]))
    shift = turn = 0.0
    for i in range(6):
        x = 0.0
        for k in range(6):
            x -= memory[AT_HERE + (POINT_INVERSE + 6 * i + k) * LANES] * error[k]
        memory[AT_HERE + (POINT_STEP + i) * LANES] = x
        if i < 3:
            shift += x * x
        else:
            turn += x * x
    longest = np.sqrt(max(shift, turn))
    memory[AT_HERE + POINT_LARGEST * LANES] = largest
    memory[AT_HERE + POINT_SIZE * LANES] = np.sqrt(size)
    memory[AT_SEARCH + SEARCH_SHARE * LANES] = min(1.0, LARGEST_STEP / max(longest, LARGEST_STEP))
    memory[AT_SEARCH + SEARCH_STEPS * LANES] = 0.0
    memory[AT_SEARCH + SEARCH_ENDING * LANES] = 0.0
    return bool(longest <= LARGEST_STEP)


@njit(error_model="numpy", nogil=True)
def _keep(memory: Array, saved: Array, values: Array) -> None:
    """Save the state of the search of the first lane, and its joint values."""
    for k in range(POINT_SCALARS):
        saved[k] = memory[AT_HERE + k * LANES]
    for k in range(6):
        values[k] = memory[AT_ERRORS + k * LANES] + memory[AT_TARGET + k * LANES]


@njit(error_model="numpy", nogil=True)
def _restore(memory: Array, saved: Array) -> None:
    for k in range(POINT_SCALARS):
        memory[AT_HERE + k * LANES] = saved[k]


@njit(error_model="numpy", nogil=True)
def _follow(
    memory: Array,
    saved: Array,
    values: Array,
    goal: Array,
    kinds: NDArray[np.int64],
    geometry: Array,
    paths: Array,
    tolerance: float,
    most: int,
) -> tuple[int, int, int]:
    """Track from the present state to a goal, in pieces; how it ended, pieces, steps."""
    first, target = values.copy(), np.empty(6)
    done, width, pieces, steps, halvings = 0.0, 1.0, 0, 0, 0
    while done < 1.0:
        end = min(1.0, done + width)
        for k in range(6):
            target[k] = goal[k] if end == 1.0 else first[k] + end * (goal[k] - first[k])
        largest = 0.0
        for k in range(6):
            largest = max(largest, abs(values[k] - target[k]))
        if largest <= tolerance:
            done = end
            continue
        last = halvings == SAMPLE_HALVINGS
        whole = _aim(memory, values, target)
        ending = 0
        if whole or last:
            limit = most if last else STEPS_PER_PIECE
            ending = search(memory, kinds, geometry, paths, tolerance, limit)
            steps += int(memory[AT_SEARCH + SEARCH_STEPS * LANES])
        if ending == CONVERGED:
            _keep(memory, saved, values)
            done, width, pieces = end, 2.0 * width, pieces + 1
            halvings = max(0, halvings - 1)
            continue
        if last:
            return ending, pieces, steps
        _restore(memory, saved)
        width, halvings = 0.5 * (end - done), halvings + 1
    return CONVERGED, pieces, steps


def _driver(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def track_samples(
        joints: Array,
        start_position: Array,
        start_rotation: Array,
        kinds: NDArray[np.int64],
        geometry: Array,
        paths: Array,
        angular: NDArray[np.bool_],
        frame: Array,
        limits: Array,
        most: int,
        skip: bool,
        position: Array,
        rotation: Array,
        numbers: Array,
        ends: NDArray[np.int64],
    ) -> None:
        """Track m samples.

        Parameters
        ----------
        joints : (m, 6) array [unit, rad]
        start_position, start_rotation : (1, 3) and (1, 9) arrays
        kinds, geometry, paths, angular, frame :
            As for `gsp.kinematics.newton.compiled.solve`.
        limits : (3,) array
            Tolerance, largest change between samples, least margin.
        most : int
            Steps for the first sample, and for the smallest pieces.
        skip : bool
            Whether impossible samples are skipped.
        position, rotation : (m, 3) and (m, 9) arrays
            Filled; NaN where a sample was not reached.
        numbers : (m, 5) array
            Filled: how the search ended, largest error, steps, pieces, margin.
        ends : (2,) int array
            Filled: number of samples reached, and how the track ended.
        """
        m = joints.shape[0]
        memory = np.zeros(SEARCH_MEMORY + 0 * digest)
        saved, values, goal = np.empty(POINT_SCALARS), np.empty(6), np.empty(6)
        tolerance, gap, margin = limits
        position[:], rotation[:], numbers[:] = np.nan, np.nan, np.nan
        begun = False
        for i in range(m):
            possible, missing = True, False
            for k in range(6):
                value = joints[i, k]
                goal[k] = value if angular[k] else value / frame[0]
                possible &= 0.0 < value < np.pi if angular[k] else 0.0 <= value < np.inf
                missing |= value != value
            if not possible:
                if skip:
                    continue
                ends[0], ends[1] = i, (AT_GAP if missing else UNDEFINED)
                return
            if not begun:
                load(joints, start_position, start_rotation, i, 0, angular, frame, memory, 0)
                ending = search(memory, kinds, geometry, paths, tolerance, most)
                pieces, steps = 1, int(memory[AT_SEARCH + SEARCH_STEPS * LANES])
                if ending == CONVERGED:
                    _keep(memory, saved, values)
            else:
                for k in range(6):
                    if not abs(goal[k] - values[k]) <= gap:
                        ends[0], ends[1] = i, AT_GAP
                        return
                ending, pieces, steps = _follow(
                    memory, saved, values, goal, kinds, geometry, paths, tolerance, most
                )
            if ending != CONVERGED:
                ends[0], ends[1] = i, ending
                return
            begun = True
            here = 1.0 / np.sqrt(memory[AT_HERE + POINT_SQUARE * LANES])
            if here < margin:
                ends[0], ends[1] = i, SINGULAR
                return
            # Errors of this sample, also where the last one was near enough.
            largest = 0.0
            for k in range(6):
                largest = max(largest, abs(values[k] - goal[k]))
            store(memory, 0, i, CONVERGED, frame, position, rotation, numbers)
            numbers[i, 1], numbers[i, 2] = largest, steps
            numbers[i, 3], numbers[i, 4] = pieces, here
        ends[0], ends[1] = m, CONVERGED

    return track_samples


_OWN = crc32(Path(compiled.__file__).read_bytes(), digest_of_code())

track_samples = njit(
    types.void(
        *GIVEN,
        fixed(1),
        types.int64,
        types.boolean,
        types.float64[:, ::1],
        types.float64[:, ::1],
        types.float64[:, ::1],
        types.int64[::1],
    ),
    error_model="numpy",
    nogil=True,
    cache=True,
)(_driver(_OWN))
