"""Where the arrays of LANES patches lie in the memory of a compiled proof.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.matrices import ACTUATOR_ROWS, AT_ROWS, ROW_DOUBLES
from gsp.kernels.stages import LANES, QR_ROWS_AT_ONCE
from gsp.variation.blocks import BLOCK_SUMS_SCALARS, DIRECTIONS_SCALARS
from gsp.variation.layout import INDEX_ORDER, QUANTITY_SCALARS
from gsp.variation.legs import PATCH_SCALARS
from gsp.variation.matrices import GRAM_SCALARS, INVERSE_SCALARS, SUMS_SCALARS
from gsp.variation.quantities import ROW_SCALARS
from gsp.variation.stages import BOX_SCALARS, FOOT_SCALARS, N_PASSIVE

Numbers = NDArray[np.int64]

PASSIVE_ROWS = np.array(N_PASSIVE)
N_INDICES = len(INDEX_ORDER)
# Doubles of a row with its derivatives, of a quantity and of the two feet of a leg, in all lanes.
JET_DOUBLES = ROW_SCALARS * LANES
QUANTITY_DOUBLES = QUANTITY_SCALARS * LANES
FEET_DOUBLES = 2 * FOOT_SCALARS * LANES

# Where the arrays of a patch lie in the memory; those of unknown size come last.
AT_BOX = AT_ROWS
AT_PATCH = AT_BOX + BOX_SCALARS * LANES
AT_SIGN = AT_PATCH + PATCH_SCALARS * LANES
AT_INVERSE = AT_SIGN + LANES
AT_GRAM = AT_INVERSE + INVERSE_SCALARS * LANES
AT_SUMS = AT_GRAM + GRAM_SCALARS * LANES
AT_RATES = AT_SUMS + SUMS_SCALARS * LANES
# Quantities of the ellipsoid that are not kept.
AT_SPARE = AT_RATES + SUMS_SCALARS * LANES
AT_DIRECTIONS = AT_SPARE + 3 * QUANTITY_DOUBLES
AT_BLOCKS = AT_DIRECTIONS + DIRECTIONS_SCALARS * LANES
AT_FEET = AT_BLOCKS + BLOCK_SUMS_SCALARS * LANES


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
    at_jets = AT_FEET + kinds.size * FEET_DOUBLES
    at_passive = at_jets + n * JET_DOUBLES
    at_matrix = at_passive + n_passive * JET_DOUBLES
    at_quantities = at_matrix + (max(n, n_passive) + QR_ROWS_AT_ONCE) * ROW_DOUBLES
    end = at_quantities + quantities(kinds, pairs) * QUANTITY_DOUBLES
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
