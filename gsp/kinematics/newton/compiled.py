"""Compiled forward kinematics: LANES searches at once, each lane refilled when its search ends.

A lane never reads another one, so that every bit of a result is the same alone and in a batch.
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
from gsp.kernels import stages as kernel_stages
from gsp.kernels.compiled import vectorised as writer
from gsp.kernels.compiled.vectorised import vectorised
from gsp.kernels.formulas.arcs import ARC
from gsp.kernels.stages import LANES, LEG_SCALARS, checksum
from gsp.kinematics.newton import stages
from gsp.kinematics.newton.control import CONVERGED, NEAR_SINGULAR, NOT_CONVERGED, SINGULAR
from gsp.kinematics.newton.control import UNDEFINED as IS_UNDEFINED
from gsp.kinematics.newton.stages import (
    POINT_LARGEST,
    POINT_ROWS,
    POINT_SCALARS,
    POINT_SQUARE,
    POINT_STEP,
    SEARCH_ENDING,
    SEARCH_FRESH,
    SEARCH_SCALARS,
    SEARCH_SHARE,
    SEARCH_STEPS,
)
from gsp.variation.legs import PATCH_LEG_SCALARS, PATCH_SCALARS

_move = vectorised(stages.MOVE)
_leg = vectorised(*stages.LEG_STAGES)
_solve, _decide = vectorised(stages.SOLVE), vectorised(stages.DECIDE)
_N_ACTUATORS = np.array(kernel_stages.N_ACTUATORS)

# Where the arrays of the searches lie in their memory.
AT_HERE = 0
AT_THERE = AT_HERE + POINT_SCALARS * LANES
AT_SEARCH = AT_THERE + POINT_SCALARS * LANES
AT_PATCH = AT_SEARCH + SEARCH_SCALARS * LANES
AT_TARGET = AT_PATCH + PATCH_SCALARS * LANES
AT_ERRORS = AT_TARGET + 6 * LANES
AT_SIGNS = AT_ERRORS + 6 * LANES
AT_BENDS = AT_SIGNS + 6 * LANES
SEARCH_MEMORY = AT_BENDS + 6 * LANES


@njit(error_model="numpy", nogil=True)
def load(
    joints: Array,
    position: Array,
    rotation: Array,
    i: int,
    g: int,
    angular: NDArray[np.bool_],
    frame: Array,
    memory: Array,
    lane: int,
) -> bool:
    """Begin the search of element i from guess g in a lane; False if no joint has such values."""
    size = frame[0]
    possible = True
    for k in range(6):
        value = joints[i, k]
        if angular[k]:
            possible &= 0.0 < value < np.pi
        else:
            value = value / size
            possible &= 0.0 <= value < np.inf
        memory[AT_TARGET + k * LANES + lane] = value
    if not possible:
        return False
    for k in range(3):
        moved = position[g, k] - frame[1 + k]
        for m in range(3):
            moved += rotation[g, 3 * k + m] * frame[4 + m]
        memory[AT_HERE + k * LANES + lane] = moved / size
    for k in range(9):
        memory[AT_HERE + (3 + k) * LANES + lane] = rotation[g, k]
    for k in range(6):
        memory[AT_HERE + (POINT_STEP + k) * LANES + lane] = 0.0
    memory[AT_SEARCH + SEARCH_SHARE * LANES + lane] = 0.0
    memory[AT_SEARCH + SEARCH_FRESH * LANES + lane] = 1.0
    memory[AT_SEARCH + SEARCH_STEPS * LANES + lane] = 0.0
    memory[AT_SEARCH + SEARCH_ENDING * LANES + lane] = 0.0
    return True


@njit(error_model="numpy", nogil=True)
def store(
    memory: Array,
    lane: int,
    i: int,
    ending: int,
    frame: Array,
    position: Array,
    rotation: Array,
    numbers: Array,
) -> None:
    """Write the end of a search as element i."""
    found = ending == CONVERGED
    for k in range(9):
        entry = memory[AT_HERE + (3 + k) * LANES + lane]
        rotation[i, k] = entry if found else np.nan
    for k in range(3):
        moved = memory[AT_HERE + k * LANES + lane] * frame[0] + frame[1 + k]
        for m in range(3):
            moved -= rotation[i, 3 * k + m] * frame[4 + m]
        position[i, k] = moved if found else np.nan
    numbers[i, 0] = ending
    known = ending != IS_UNDEFINED
    numbers[i, 1] = memory[AT_HERE + POINT_LARGEST * LANES + lane] if known else np.nan
    numbers[i, 2] = memory[AT_SEARCH + SEARCH_STEPS * LANES + lane]


@njit(error_model="numpy", nogil=True)
def _reject(i: int, position: Array, rotation: Array, numbers: Array) -> None:
    """Write element i, whose joint values are impossible."""
    for k in range(3):
        position[i, k] = np.nan
    for k in range(9):
        rotation[i, k] = np.nan
    numbers[i, 0], numbers[i, 1], numbers[i, 2] = IS_UNDEFINED, np.nan, 0.0


@njit(error_model="numpy", nogil=True)
def _step(
    memory: Array, kinds: NDArray[np.int64], geometry: Array, paths: Array, tolerance: float
) -> None:
    """Try one step in every lane."""
    _move(0, memory, AT_HERE, memory, AT_SEARCH, memory, AT_THERE, memory, AT_PATCH)
    row = 0
    for leg in range(kinds.size):
        kind = kinds[leg]
        one = row * LANES
        _leg(
            kind,
            memory,
            AT_THERE,
            memory,
            AT_SEARCH,
            memory,
            AT_PATCH,
            geometry,
            leg * LEG_SCALARS,
            paths,
            leg * PATCH_LEG_SCALARS,
            memory,
            AT_TARGET + one,
            memory,
            AT_THERE + POINT_ROWS * LANES + 6 * one,
            memory,
            AT_ERRORS + one,
            memory,
            AT_SIGNS + one,
            memory,
            AT_BENDS + one,
        )
        row += _N_ACTUATORS[kind]
    _solve(0, memory, AT_THERE, memory, AT_ERRORS)
    _decide(0, memory, AT_HERE, memory, AT_THERE, memory, AT_BENDS, memory, AT_SEARCH, tolerance)


@njit(error_model="numpy", nogil=True)
def search(
    memory: Array,
    kinds: NDArray[np.int64],
    geometry: Array,
    paths: Array,
    tolerance: float,
    most: int,
) -> int:
    """Step until the search of the first lane ends; return how."""
    while True:
        _step(memory, kinds, geometry, paths, tolerance)
        ending = ended(memory, 0, most)
        if ending != 0:
            return ending


@njit(error_model="numpy", nogil=True)
def ended(memory: Array, lane: int, most: int) -> int:
    """How the search of a lane has ended, 0 if it continues."""
    ending = int(memory[AT_SEARCH + SEARCH_ENDING * LANES + lane])
    if ending == 0 and memory[AT_SEARCH + SEARCH_STEPS * LANES + lane] >= most:
        near = memory[AT_HERE + POINT_SQUARE * LANES + lane] * NEAR_SINGULAR**2 > 1.0
        ending = SINGULAR if near else NOT_CONVERGED
    return ending


def digest_of_code() -> int:
    """Return a checksum of the sources that numba's cache does not check for changes."""
    number = checksum((*stages.ALL, ARC_STAGE))
    return crc32(Path(writer.__file__).read_bytes(), number)


ARC_STAGE = kernel_stages.Stage("arc", (), (), [("arc", 0, ARC)])


def _driver(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def solve(
        joints: Array,
        guess_position: Array,
        guess_rotation: Array,
        kinds: NDArray[np.int64],
        geometry: Array,
        paths: Array,
        angular: NDArray[np.bool_],
        frame: Array,
        tolerance: float,
        most: int,
        position: Array,
        rotation: Array,
        numbers: Array,
    ) -> None:
        """Solve n elements.

        Parameters
        ----------
        joints : (n, 6) array [unit, rad]
        guess_position, guess_rotation : (n or 1, 3) and (n or 1, 9) arrays
            One guess is that of all elements.
        kinds : (n_legs,) int array
            Places in `gsp.model.legs.LEGS`.
        geometry, paths : (n_legs * 13,) and (n_legs * 18,) arrays
            Of the centred design in units of its size, for formulas and for bounds.
        angular : (6,) bool array
        frame : (7,) array
            Size; centre of the base anchors and of the platform anchors, each in its own axes.
        tolerance : float
        most : int
            Steps per element.
        position, rotation : (n, 3) and (n, 9) arrays
            Filled.
        numbers : (n, 3) array
            Filled with how the search ended, the largest error and the number of steps.
        """
        n, waiting, active = joints.shape[0], 0, 0
        memory = np.zeros(SEARCH_MEMORY + 0 * digest)
        element = np.full(LANES, -1)
        shared = guess_position.shape[0] == 1
        empty = True  # whether lanes are filled for the first time
        while empty or active > 0:
            if not empty:
                _step(memory, kinds, geometry, paths, tolerance)
            for lane in range(LANES):
                i = element[lane]
                if i >= 0:
                    ending = ended(memory, lane, most)
                    if ending == 0:
                        continue
                    store(memory, lane, i, ending, frame, position, rotation, numbers)
                    element[lane] = -1
                    active -= 1
                while waiting < n:
                    i, waiting = waiting, waiting + 1
                    g = 0 if shared else i
                    if load(
                        joints, guess_position, guess_rotation, i, g, angular, frame, memory, lane
                    ):
                        element[lane] = i
                        active += 1
                        break
                    _reject(i, position, rotation, numbers)
            empty = False

    return solve


def fixed(dimensions: int) -> types.Array:
    """Return the type of a contiguous array of numbers that is not changed."""
    return types.Array(types.float64, dimensions, "C", readonly=True)


# Of joint values, positions and rotations, then kinds, anchors, paths, angular rows and frame.
GIVEN = (
    *(fixed(2), fixed(2), fixed(2)),
    types.Array(types.int64, 1, "C", readonly=True),
    *(fixed(1), fixed(1)),
    types.Array(types.boolean, 1, "C", readonly=True),
    fixed(1),
)

solve = njit(
    types.void(
        *GIVEN,
        types.float64,
        types.int64,
        types.float64[:, ::1],
        types.float64[:, ::1],
        types.float64[:, ::1],
    ),
    error_model="numpy",
    nogil=True,
    cache=True,
)(_driver(digest_of_code()))
