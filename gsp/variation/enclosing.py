"""Compiled bounds of all quantities on LANES patches at once.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.matrices import (
    ACTUATOR_ROWS,
    AT_SPECTRUM,
    AT_UPPER,
    ROW_DOUBLES,
    bidiagonalise,
    iterate_laguerre,
    triangularise,
    write_square,
)
from gsp.kernels.compiled.vectorised import vectorised
from gsp.kernels.stages import LANES
from gsp.model.legs import LEGS
from gsp.variation import blocks, matrices, screening, stages
from gsp.variation.blocks import BLOCK_SUMS_SCALARS
from gsp.variation.layout import (
    CLEARANCE,
    CONES,
    CONTROL,
    ELLIPSOID,
    HIGH,
    JOINTS,
    LOW,
    MID_HIGH,
    MID_LOW,
    PARTS,
    POSITION,
    QUANTITY_SCALARS,
    SCREEN,
    SPECTRA,
)
from gsp.variation.legs import PATCH_LEG_SCALARS
from gsp.variation.matrices import GRAM_SCALARS, SUMS_SCALARS
from gsp.variation.memory import (
    AT_BLOCKS,
    AT_BOX,
    AT_DIRECTIONS,
    AT_FEET,
    AT_GRAM,
    AT_INVERSE,
    AT_PATCH,
    AT_RATES,
    AT_SIGN,
    AT_SPARE,
    AT_SUMS,
    FEET_DOUBLES,
    JET_DOUBLES,
    N_INDICES,
    PASSIVE_ROWS,
    QUANTITY_DOUBLES,
    Numbers,
    clear,
)
from gsp.variation.stages import BOX_SCALARS

_boxes = vectorised(stages.BOXES)
_rows, _values = vectorised(*stages.ROWS), vectorised(*stages.VALUES)
_cones = vectorised(*stages.CONES)
_ellipsoid_rows = vectorised(*stages.ELLIPSOID_ROWS)
_passive_rows = vectorised(*stages.PASSIVE_ROWS)
_feet, _clearance = vectorised(*stages.FEET), vectorised(stages.CLEARANCE)
_triangle, _inverse = vectorised(matrices.TRIANGLE), vectorised(matrices.INVERSE_STAGE)
_gram = vectorised(matrices.GRAM_ROW)
_solved, _copied = vectorised(matrices.SOLVED_ROW), vectorised(matrices.COPIED_ROW)
_slopes, _squares = vectorised(matrices.SLOPES_ROW), vectorised(matrices.SQUARES_ROW)
_screen, _second_screen = vectorised(screening.SCREEN), vectorised(screening.SECOND_SCREEN)
_extremes = vectorised(matrices.EXTREMES)
_directions, _block_rows = vectorised(blocks.DIRECTIONS_STAGE), vectorised(*blocks.BLOCK_ROWS)
_blocks = vectorised(blocks.BLOCKS)
_control = vectorised(matrices.CONTROL)

_N_ANGLES = np.array([sum(c.quantity == "angle" for c in leg.constraints) for leg in LEGS])


@njit(error_model="numpy", nogil=True)
def _preconditioner(memory: Array, at: int, n: int, at_matrix: int, at_sign: int) -> None:
    """Triangle of n rows, to AT_UPPER, and its inverse, to AT_INVERSE; overwrites the matrix."""
    if n == 6:
        _triangle(0, memory, at, memory, AT_UPPER)
    else:
        for row in range(n):
            _copied(0, memory, at + row * JET_DOUBLES, memory, at_matrix + row * ROW_DOUBLES)
        triangularise(memory, at_matrix, n)
    _inverse(0, memory, AT_UPPER, memory, AT_INVERSE, memory, at_sign)


@njit(error_model="numpy", nogil=True)
def _multiplied(memory: Array, at: int, n: int, at_sums: int, at_matrix: int) -> None:
    """Multiply n rows by the preconditioner: sums, and the rows as a matrix."""
    clear(memory, at_sums, SUMS_SCALARS)
    for row in range(n):
        _solved(
            0,
            memory,
            at + row * JET_DOUBLES,
            memory,
            AT_INVERSE,
            memory,
            at_sums,
            memory,
            at_matrix + row * ROW_DOUBLES,
        )


@njit(error_model="numpy", nogil=True)
def _sloped(memory: Array, at: int, n: int) -> None:
    """Multiply the derivatives of n rows by the preconditioner: the first part of AT_SUMS."""
    clear(memory, AT_SUMS, GRAM_SCALARS)
    for row in range(n):
        _slopes(0, memory, at + row * JET_DOUBLES, memory, AT_INVERSE, memory, AT_SUMS)


@njit(error_model="numpy", nogil=True)
def _spectrum(memory: Array, at_matrix: int, n: int) -> None:
    """Extreme singular values of n rows."""
    triangularise(memory, at_matrix, n)
    write_square(memory, at_matrix)
    bidiagonalise(0, memory, at_matrix, memory, AT_SPECTRUM)
    iterate_laguerre(0, memory, AT_SPECTRUM)


@njit(error_model="numpy", nogil=True)
def narrow(memory: Array, n: int, at_jets: int, at: int, length: float) -> None:
    """Narrow bounds of singular values by their derivatives; AT_GRAM is that of the rows."""
    _directions(0, memory, AT_UPPER, memory, AT_INVERSE, memory, AT_DIRECTIONS)
    if n == 6:
        _block_rows(1, memory, at_jets, memory, AT_DIRECTIONS, memory, AT_BLOCKS)
    else:
        clear(memory, AT_BLOCKS, BLOCK_SUMS_SCALARS)
        for row in range(n):
            at_row = at_jets + row * JET_DOUBLES
            _block_rows(0, memory, at_row, memory, AT_DIRECTIONS, memory, AT_BLOCKS)
    _blocks(
        0,
        memory,
        AT_PATCH,
        memory,
        AT_UPPER,
        memory,
        AT_GRAM,
        memory,
        AT_DIRECTIONS,
        memory,
        AT_BLOCKS,
        memory,
        at,
        length,
    )


@njit(error_model="numpy", nogil=True)
def _spectra(
    memory: Array, n: int, at_jets: int, at_matrix: int, at: int, length: float, volume: float
) -> None:
    """Quantities of the singular values of the rows at a place; they have been multiplied."""
    clear(memory, AT_GRAM, GRAM_SCALARS)
    for row in range(n):
        _gram(0, memory, at_jets + row * JET_DOUBLES, memory, AT_GRAM)
    write_square(memory, at_matrix)
    bidiagonalise(0, memory, at_matrix, memory, AT_SPECTRUM)
    iterate_laguerre(0, memory, AT_SPECTRUM)
    _extremes(
        0,
        memory,
        AT_PATCH,
        memory,
        AT_SPECTRUM,
        memory,
        AT_GRAM,
        memory,
        AT_SUMS,
        memory,
        AT_INVERSE,
        memory,
        at,
        length,
        volume,
    )
    narrow(memory, n, at_jets, at, length)


@njit(error_model="numpy", nogil=True)
def _unit(kinds: Numbers, length: float) -> float:
    """Return what |det J| of homogeneous rows is multiplied by."""
    power, unit = 3, 1.0
    for kind in kinds:
        power -= _N_ANGLES[kind]
    for _ in range(abs(power)):
        unit = unit * length if power > 0 else unit / length
    return unit


@njit(error_model="numpy", nogil=True)
def second_screen(
    memory: Array, kinds: Numbers, places: tuple[int, int, int, int, int, int]
) -> None:
    """Narrow the bounds of patches that SPECTRA | SCREEN screened."""
    n, at_jets, _, _, at_quantities, _ = places
    at = at_quantities + (n + 3 + 2 * kinds.size) * QUANTITY_DOUBLES
    clear(memory, AT_GRAM, GRAM_SCALARS)
    for row in range(n):
        _gram(0, memory, at_jets + row * JET_DOUBLES, memory, AT_GRAM)
    _second_screen(0, memory, AT_UPPER, memory, AT_GRAM, memory, at)


@njit(error_model="numpy", nogil=True)
def spectra(
    memory: Array, kinds: Numbers, length: float, places: tuple[int, int, int, int, int, int]
) -> None:
    """Bounds by singular values, of patches for which SPECTRA | SCREEN gave wider ones."""
    n, at_jets, _, at_matrix, at_quantities, _ = places
    at = at_quantities + (n + 3 + 2 * kinds.size) * QUANTITY_DOUBLES
    clear(memory, AT_SUMS + GRAM_SCALARS * LANES, SUMS_SCALARS - GRAM_SCALARS)
    for row in range(n):
        _squares(0, memory, at_jets + row * JET_DOUBLES, memory, AT_INVERSE, memory, AT_SUMS)
    _spectra(memory, n, at_jets, at_matrix, at, length, _unit(kinds, length))


@njit(error_model="numpy", nogil=True)
def _matrices(
    memory: Array,
    kinds: Numbers,
    geometry: Array,
    weights: Array,
    length: float,
    wanted: int,
    places: tuple[int, int, int, int, int, int],
) -> None:
    """Quantities of the Jacobian, of the passive rates and of the ellipsoid."""
    n, at_jets, at_passive, at_matrix, at_quantities, _ = places
    at = at_quantities + (n + 3 + 2 * kinds.size) * QUANTITY_DOUBLES
    row, rate = at_jets, at_passive
    for leg in range(kinds.size):
        kind, here = kinds[leg], leg * PATCH_LEG_SCALARS
        _rows(kind, memory, AT_PATCH, geometry, here, memory, row, 1.0 / length)
        row += ACTUATOR_ROWS[kind] * JET_DOUBLES
        if wanted & CONTROL:
            _passive_rows(kind, memory, AT_PATCH, geometry, here, memory, rate, 1.0 / length)
            rate += PASSIVE_ROWS[kind] * JET_DOUBLES
    if wanted & SPECTRA:
        _preconditioner(memory, at_jets, n, at_matrix, AT_SIGN)
        if wanted & SCREEN:
            _sloped(memory, at_jets, n)
            _screen(
                0,
                memory,
                AT_PATCH,
                memory,
                AT_UPPER,
                memory,
                AT_SUMS,
                memory,
                AT_INVERSE,
                memory,
                at,
                length,
            )
        else:
            _multiplied(memory, at_jets, n, AT_SUMS, at_matrix)
            _spectra(memory, n, at_jets, at_matrix, at, length, _unit(kinds, length))
    if wanted & CONTROL:
        n_passive = (rate - at_passive) // JET_DOUBLES
        # The sign of the determinant is that of the Jacobian alone.
        _preconditioner(memory, at_passive, n_passive, at_matrix, AT_SPARE)
        _multiplied(memory, at_passive, n_passive, AT_RATES, at_matrix)
        _multiplied(memory, at_jets, n, AT_SUMS, at_matrix)
        _spectrum(memory, at_matrix, n)
        _control(
            0,
            memory,
            AT_PATCH,
            memory,
            AT_SPECTRUM,
            memory,
            AT_SUMS,
            memory,
            AT_RATES,
            memory,
            AT_INVERSE,
            memory,
            at + 4 * QUANTITY_DOUBLES,
            length,
        )
    if wanted & ELLIPSOID:
        row = at_jets
        for leg in range(kinds.size):
            kind, here = kinds[leg], leg * PATCH_LEG_SCALARS
            _ellipsoid_rows(kind, memory, AT_PATCH, geometry, here, weights, 0, memory, row, length)
            row += ACTUATOR_ROWS[kind] * JET_DOUBLES
        _preconditioner(memory, at_jets, n, at_matrix, AT_SPARE)
        _multiplied(memory, at_jets, n, AT_SUMS, at_matrix)
        _spectra(memory, n, at_jets, at_matrix, AT_SPARE, length, 1.0)
        for i in range(QUANTITY_DOUBLES):
            memory[at + 3 * QUANTITY_DOUBLES + i] = memory[AT_SPARE + QUANTITY_DOUBLES + i]


@njit(error_model="numpy", nogil=True)
def _positions(memory: Array, at: int) -> None:
    """Bounds of x, y, z: those of the box."""
    for k in range(3):
        for i in range(LANES):
            here = at + k * QUANTITY_SCALARS * LANES + i
            low, high = memory[AT_BOX + k * LANES + i], memory[AT_BOX + (6 + k) * LANES + i]
            middle = memory[AT_PATCH + k * LANES + i]
            memory[here + LOW * LANES], memory[here + HIGH * LANES] = low, high
            memory[here + MID_LOW * LANES] = memory[here + MID_HIGH * LANES] = middle
            for m in range(6):
                memory[here + (PARTS + m) * LANES] = high - low if m == k else 0.0


@njit(error_model="numpy", nogil=True)
def load_boxes(memory: Array, boxes: Array, start: int, count: int, frame: Array) -> None:
    """Load boxes as patches; the last one fills up an incomplete block."""
    for i in range(LANES):
        box = start + min(i, count - 1)
        for k in range(BOX_SCALARS):
            memory[AT_BOX + k * LANES + i] = boxes[box, k]
    _boxes(0, memory, AT_BOX, frame, 0, memory, AT_PATCH)


@njit(error_model="numpy", nogil=True)
def enclose(
    memory: Array,
    kinds: Numbers,
    geometry: Array,
    axes: Array,
    weights: Array,
    pairs: Numbers,
    length: float,
    wanted: int,
    places: tuple[int, int, int, int, int, int],
) -> None:
    """Bound the quantities on LANES patches."""
    n, at_quantities = places[0], places[4]
    at, cone = at_quantities, at_quantities + (n + 3) * QUANTITY_DOUBLES
    for leg in range(kinds.size):
        kind, here = kinds[leg], leg * PATCH_LEG_SCALARS
        if wanted & JOINTS:
            _values(kind, memory, AT_PATCH, geometry, here, memory, at, length)
        if wanted & CONES:
            _cones(kind, memory, AT_PATCH, geometry, here, axes, 6 * leg, memory, cone, length)
        if wanted & CLEARANCE:
            _feet(kind, memory, AT_PATCH, geometry, here, memory, AT_FEET + leg * FEET_DOUBLES)
        at, cone = at + ACTUATOR_ROWS[kind] * QUANTITY_DOUBLES, cone + 2 * QUANTITY_DOUBLES
    if wanted & POSITION:
        _positions(memory, at)
    if wanted & (SPECTRA | CONTROL | ELLIPSOID):
        _matrices(memory, kinds, geometry, weights, length, wanted, places)
    if wanted & CLEARANCE:
        at = cone + N_INDICES * QUANTITY_DOUBLES
        for pair in range(len(pairs)):
            one, other = (
                AT_FEET + pairs[pair, 0] * FEET_DOUBLES,
                AT_FEET + pairs[pair, 1] * FEET_DOUBLES,
            )
            _clearance(0, memory, AT_PATCH, memory, one, memory, other, memory, at, length)
            at += QUANTITY_DOUBLES
