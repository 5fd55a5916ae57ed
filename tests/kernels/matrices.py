"""Running the compiled solver on given matrices, and the same in 50 digits."""

from __future__ import annotations

import mpmath
import numpy as np
from numba import njit

from gsp.kernels.compiled import matrices as compiled
from gsp.kernels.stages import LANES, QR_ROWS_AT_ONCE


@njit(error_model="numpy")
def _solved(matrices, results, memory):
    n = matrices.shape[1]
    for m in range(matrices.shape[0]):
        for k in range(n * 6):
            for lane in range(LANES):
                memory[compiled.AT_ROWS + k * LANES + lane] = matrices[m, k // 6, k % 6]
        compiled.solve_spectrum(memory, compiled.AT_ROWS, n)
        for k in range(3):
            results[m, k] = memory[compiled.AT_RESULT + k * LANES]


def solved(matrices):
    """σ_min/σ_max, σ_min and |det| of (m, n, 6) matrices, by the compiled stages."""
    array = np.ascontiguousarray(matrices, dtype=np.float64)
    memory = np.zeros(compiled.AT_ROWS + (array.shape[1] + QR_ROWS_AT_ONCE) * 6 * LANES)
    results = np.empty((len(array), 3))
    _solved(array, results, memory)
    return results


def exact(matrix):
    """σ_min/σ_max, σ_min and |det|, (or √det MᵀM), in 50 digits."""
    with mpmath.workdps(50):
        values = mpmath.svd_r(mpmath.matrix(matrix.tolist()), compute_uv=False)
        return values[5] / values[0], values[5], mpmath.fprod(values)
