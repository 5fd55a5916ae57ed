"""Compiled rows of a design on balls of poses: values, derivatives and rests.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.matrices import ACTUATOR_ROWS, checksum_of_code
from gsp.kernels.compiled.vectorised import vectorised
from gsp.kernels.stages import LANES, checksum
from gsp.variation import stages
from gsp.variation.legs import PATCH_LEG_SCALARS, PATCH_SCALARS
from gsp.variation.memory import Numbers
from gsp.variation.quantities import ROW_REST, ROW_SCALARS

_rows = vectorised(*stages.ROWS)


@njit(error_model="numpy", nogil=True)
def _load(
    memory: Array, lane: int, position: Array, rotation: Array, radius: float, length: float
) -> None:
    """Write the patch of a ball: displacements by a radius, turns by that over the length."""
    for k in range(PATCH_SCALARS):
        memory[k * LANES + lane] = 0.0
    square, angle = 0.0, radius / length
    for k in range(3):
        square += position[k] * position[k]
        memory[k * LANES + lane] = position[k]
        memory[(12 + k) * LANES + lane] = radius
        memory[(15 + 4 * k) * LANES + lane] = angle
    for k in range(9):
        memory[(3 + k) * LANES + lane] = rotation[k // 3, k % 3]
    memory[24 * LANES + lane], memory[26 * LANES + lane] = radius, angle
    memory[28 * LANES + lane] = np.sqrt(square)


def _filler(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def rows_on_balls(
        position: Array,
        rotation: Array,
        radius: Array,
        length: float,
        kinds: Numbers,
        geometry: Array,
        rows: Array,
        rests: Array,
    ) -> None:
        """Write the rows of n poses on balls around them.

        Parameters
        ----------
        position, rotation, radius : (n, 3), (n, 3, 3), (n,) arrays
        kinds : (n_legs,) int array
            Numbers of the legs in `gsp.model.legs.LEGS`.
        geometry : (n_legs * PATCH_LEG_SCALARS,) array
        rows : (n, m, 42) array
            Filled with the values and the six derivatives, times radii, of each of m rows; not if
            it is empty.
        rests : (n,) array
            Filled with the norms of the rests.
        """
        m = 0 * digest
        for kind in kinds:
            m += ACTUATOR_ROWS[kind]
        memory = np.zeros((PATCH_SCALARS + m * ROW_SCALARS) * LANES)
        for start in range(0, len(position), LANES):
            count = min(LANES, len(position) - start)
            for lane in range(LANES):
                pose = start + min(lane, count - 1)
                _load(memory, lane, position[pose], rotation[pose], radius[pose], length)
            at = PATCH_SCALARS * LANES
            for leg in range(kinds.size):
                kind, here = kinds[leg], leg * PATCH_LEG_SCALARS
                _rows(kind, memory, 0, geometry, here, memory, at, 1.0 / length)
                at += ACTUATOR_ROWS[kind] * ROW_SCALARS * LANES
            for lane in range(count):
                square = 0.0
                for row in range(m):
                    at = (PATCH_SCALARS + row * ROW_SCALARS) * LANES + lane
                    square += memory[at + ROW_REST * LANES] ** 2
                    if rows.size:
                        for k in range(ROW_REST):
                            rows[start + lane, row, k] = memory[at + k * LANES]
                rests[start + lane] = np.sqrt(square)

    return rows_on_balls


_digest = checksum_of_code(checksum(stages.ROWS))
rows_on_balls = njit(error_model="numpy", nogil=True, cache=True)(_filler(_digest))
