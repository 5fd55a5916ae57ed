"""Where the arrays of LANES patches lie in the memory of a compiled proof.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.matrices import ACTUATOR_ROWS, AT_ROWS, ROW
from gsp.kernels.stages import CHUNK, LANES
from gsp.variation.layout import INDEX_ORDER, QUANTITY
from gsp.variation.legs import PATCH
from gsp.variation.matrices import GRAM, INVERSE, SUMS
from gsp.variation.quantities import ROW_SCALARS
from gsp.variation.stages import BOX, FOOT, N_PASSIVE

Numbers = NDArray[np.int64]

PASSIVE_ROWS = np.array(N_PASSIVE)
N_INDICES = len(INDEX_ORDER)
# Lanes of a row, of a quantity and of the two feet of a leg.
JET, STEP, FEET = ROW_SCALARS * LANES, QUANTITY * LANES, 2 * FOOT * LANES

# Where the arrays of a patch lie in the memory; those of unknown size come last.
AT_BOX = AT_ROWS
AT_PATCH = AT_BOX + BOX * LANES
AT_SIGN = AT_PATCH + PATCH * LANES
AT_INVERSE = AT_SIGN + LANES
AT_GRAM = AT_INVERSE + INVERSE * LANES
AT_SUMS = AT_GRAM + GRAM * LANES
AT_RATES = AT_SUMS + SUMS * LANES
# Quantities of the ellipsoid that are not kept.
AT_SPARE = AT_RATES + SUMS * LANES
AT_FEET = AT_SPARE + 3 * STEP


@njit(error_model="numpy", nogil=True)
def _counts(kinds: Numbers) -> tuple[int, int]:
    """Return the numbers of rows of the actuators and of the passive rates."""
    n, n_passive = 0, 0
    for kind in kinds:
        n += ACTUATOR_ROWS[kind]
        n_passive += PASSIVE_ROWS[kind]
    return n, n_passive


@njit(error_model="numpy", nogil=True)
def places_of(kinds: Numbers, pairs: Numbers) -> tuple[int, int, int, int, int, int]:
    """Return the number of rows, where jets, passive jets, matrix, quantities lie, and the end."""
    n, n_passive = _counts(kinds)
    at_jets = AT_FEET + kinds.size * FEET
    at_passive = at_jets + n * JET
    at_matrix = at_passive + n_passive * JET
    at_quantities = at_matrix + (max(n, n_passive) + CHUNK) * ROW
    end = at_quantities + quantities(kinds, pairs) * STEP
    return n, at_jets, at_passive, at_matrix, at_quantities, end


@njit(error_model="numpy", nogil=True)
def quantities(kinds: Numbers, pairs: Numbers) -> int:
    """Count the quantities: joints, x, y, z, cones on base and platform, indices, clearances."""
    return _counts(kinds)[0] + 3 + 2 * len(kinds) + N_INDICES + len(pairs)


@njit(error_model="numpy", nogil=True)
def clear(memory: Array, at: int, size: int) -> None:
    """Write zeros to some scalars of all lanes."""
    for i in range(at, at + size * LANES):
        memory[i] = 0.0
