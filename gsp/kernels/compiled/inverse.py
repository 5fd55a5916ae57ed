"""Compiled inverse kinematics: joint values of poses, LANES at a time.

Only import this module where it is used: it loads numba.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kernels import stages
from gsp.kernels.compiled.matrices import ACTUATOR_ROWS, AT_POSE, checksum_of_code, load_poses
from gsp.kernels.compiled.vectorised import vectorised
from gsp.kernels.formulas.arcs import ARC
from gsp.kernels.stages import LANES, LEG_SCALARS, POSE_SCALARS, POSE_UNDEFINED, Stage, checksum

_values = vectorised(*stages.VALUES)
AT_VALUES = AT_POSE + POSE_SCALARS * LANES


def _digest() -> int:
    """Return a checksum of the sources that numba's cache does not check for changes."""
    arcs = Stage("arc", (), (), [("arc", 0, ARC)])
    return checksum_of_code(checksum((stages.REACH_STAGE, *stages.VALUES, arcs)))


def _driver(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def joint_block(
        position: Array, rotation: Array, kinds: NDArray[np.int64], geometry: Array, out: Array
    ) -> None:
        """Evaluate a block of poses.

        Parameters
        ----------
        position, rotation, kinds, geometry : arrays
            As for `gsp.kernels.compiled.evaluation.evaluate_block`.
        out : (n, n_actuators) array
            Filled with the joint values, NaN where a leg of the pose is undefined.
        """
        n, n_rows = position.shape[0], out.shape[1]
        memory = np.empty(AT_VALUES + n_rows * LANES + 0 * digest)
        for start in range(0, n, LANES):
            count = min(LANES, n - start)
            load_poses(position, rotation, start, count, memory)
            at = AT_VALUES
            for leg in range(kinds.size):
                _values(kinds[leg], memory, AT_POSE, geometry, leg * LEG_SCALARS, memory, at)
                at += ACTUATOR_ROWS[kinds[leg]] * LANES
            for i in range(count):
                defined = memory[AT_POSE + POSE_UNDEFINED * LANES + i] == 0.0
                for k in range(n_rows):
                    out[start + i, k] = memory[AT_VALUES + k * LANES + i] if defined else np.nan

    return joint_block


def _fixed(dimensions: int) -> types.Array:
    return types.Array(types.float64, dimensions, "C", readonly=True)


joint_block = njit(
    types.void(
        _fixed(2),
        _fixed(2),
        types.Array(types.int64, 1, "C", readonly=True),
        _fixed(1),
        types.float64[:, ::1],
    ),
    error_model="numpy",
    nogil=True,
    cache=True,
)(_driver(_digest()))
