"""The compiled search over boxes: halve what is not decided, LANES boxes at a time.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.matrices import (
    ACTUATOR_ROWS,
    AT_ROWS,
    AT_SPECTRUM,
    AT_UPPER,
    ROW,
    bidiagonalise,
    checksum_of_code,
    iterate_laguerre,
    triangularise,
    write_square,
)
from gsp.kernels.compiled.vectorised import vectorised
from gsp.kernels.stages import ALL, CHUNK, LANES, checksum
from gsp.model.legs import LEGS
from gsp.proof.variation import matrices, stages
from gsp.proof.variation.layout import (
    CHANGED,
    CLEARANCE,
    CONES,
    CONTROL,
    DONE,
    ELLIPSOID,
    ENDED,
    HIGH,
    INDEX_ORDER,
    JOINTS,
    LOW,
    MID_HIGH,
    MID_LOW,
    OPEN,
    PARTS,
    PROVEN,
    QUANTITY,
    SPECTRA,
    VIOLATED,
)
from gsp.proof.variation.legs import GEOMETRY, PATCH
from gsp.proof.variation.matrices import GRAM, INVERSE, SUMS
from gsp.proof.variation.quantities import ROW_SCALARS
from gsp.proof.variation.stages import BOX, FOOT, N_PASSIVE

Codes = NDArray[np.int8]
Numbers = NDArray[np.int64]

_boxes = vectorised(stages.BOXES)
_rows, _values = vectorised(*stages.ROWS), vectorised(*stages.VALUES)
_cones = vectorised(*stages.CONES)
_ellipsoid_rows = vectorised(*stages.ELLIPSOID_ROWS)
_passive_rows = vectorised(*stages.PASSIVE_ROWS)
_feet, _clearance = vectorised(*stages.FEET), vectorised(stages.CLEARANCE)
_inverse, _gram = vectorised(matrices.INVERSE_STAGE), vectorised(matrices.GRAM_ROW)
_solved = vectorised(matrices.SOLVED_ROW)
_extremes, _control = vectorised(matrices.EXTREMES), vectorised(matrices.CONTROL)

_N_PASSIVE = np.array(N_PASSIVE)
_N_ANGLES = np.array([sum(c.name == "A1" for c in leg.constraints) for leg in LEGS])
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
        n_passive += _N_PASSIVE[kind]
    return n, n_passive


@njit(error_model="numpy", nogil=True)
def _places(kinds: Numbers, pairs: Numbers) -> tuple[int, int, int, int, int, int]:
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
def _cleared(memory: Array, at: int, size: int) -> None:
    for i in range(at, at + size * LANES):
        memory[i] = 0.0


@njit(error_model="numpy", nogil=True)
def _preconditioner(memory: Array, at: int, n: int, at_matrix: int) -> None:
    """Inverse of the triangle of n rows, to AT_INVERSE; the matrix becomes the triangle."""
    for row in range(n):
        for i in range(ROW):
            memory[at_matrix + row * ROW + i] = memory[at + row * JET + i]
    triangularise(memory, at_matrix, n)
    _inverse(0, memory, AT_UPPER, memory, AT_INVERSE, memory, AT_SIGN)


@njit(error_model="numpy", nogil=True)
def _multiplied(memory: Array, at: int, n: int, at_sums: int, at_matrix: int) -> None:
    """Multiply n rows by the preconditioner: sums, and the rows as a matrix."""
    _cleared(memory, at_sums, SUMS)
    for row in range(n):
        _solved(
            0,
            memory,
            at + row * JET,
            memory,
            AT_INVERSE,
            memory,
            at_sums,
            memory,
            at_matrix + row * ROW,
        )


@njit(error_model="numpy", nogil=True)
def _spectrum(memory: Array, at_matrix: int, n: int) -> None:
    """Extreme singular values of n rows."""
    triangularise(memory, at_matrix, n)
    write_square(memory, at_matrix)
    bidiagonalise(0, memory, at_matrix, memory, AT_SPECTRUM)
    iterate_laguerre(0, memory, AT_SPECTRUM)


@njit(error_model="numpy", nogil=True)
def _spectra(
    memory: Array, n: int, at_jets: int, at_matrix: int, at: int, length: float, volume: float
) -> None:
    """Quantities of the singular values of the rows at a place."""
    _cleared(memory, AT_GRAM, GRAM)
    for row in range(n):
        _gram(0, memory, at_jets + row * JET, memory, AT_GRAM)
    _preconditioner(memory, at_jets, n, at_matrix)
    write_square(memory, at_matrix)
    bidiagonalise(0, memory, at_matrix, memory, AT_SPECTRUM)
    iterate_laguerre(0, memory, AT_SPECTRUM)
    _multiplied(memory, at_jets, n, AT_SUMS, at_matrix)
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
    at = at_quantities + (n + 3 + 2 * kinds.size) * STEP
    sign = np.zeros(LANES)
    row, rate = at_jets, at_passive
    for leg in range(kinds.size):
        kind, here = kinds[leg], leg * GEOMETRY
        _rows(kind, memory, AT_PATCH, geometry, here, memory, row, 1.0 / length)
        row += ACTUATOR_ROWS[kind] * JET
        if wanted & CONTROL:
            _passive_rows(kind, memory, AT_PATCH, geometry, here, memory, rate, 1.0 / length)
            rate += _N_PASSIVE[kind] * JET
    if wanted & SPECTRA:
        power = 3
        for kind in kinds:
            power -= _N_ANGLES[kind]
        volume = 1.0
        for _ in range(abs(power)):
            volume = volume * length if power > 0 else volume / length
        _spectra(memory, n, at_jets, at_matrix, at, length, volume)
        for i in range(LANES):
            sign[i] = memory[AT_SIGN + i]
    if wanted & CONTROL:
        n_passive = (rate - at_passive) // JET
        _preconditioner(memory, at_passive, n_passive, at_matrix)
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
            at + 4 * STEP,
            length,
        )
    if wanted & ELLIPSOID:
        row = at_jets
        for leg in range(kinds.size):
            kind, here = kinds[leg], leg * GEOMETRY
            _ellipsoid_rows(kind, memory, AT_PATCH, geometry, here, weights, 0, memory, row, length)
            row += ACTUATOR_ROWS[kind] * JET
        _spectra(memory, n, at_jets, at_matrix, AT_SPARE, length, 1.0)
        for i in range(STEP):
            memory[at + 3 * STEP + i] = memory[AT_SPARE + STEP + i]
    for i in range(LANES):
        memory[AT_SIGN + i] = sign[i]


@njit(error_model="numpy", nogil=True)
def _enclose(
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
    at, cone = at_quantities, at_quantities + (n + 3) * STEP
    for leg in range(kinds.size):
        kind, here = kinds[leg], leg * GEOMETRY
        if wanted & JOINTS:
            _values(kind, memory, AT_PATCH, geometry, here, memory, at, length)
        if wanted & CONES:
            _cones(kind, memory, AT_PATCH, geometry, here, axes, 6 * leg, memory, cone, length)
        if wanted & CLEARANCE:
            _feet(kind, memory, AT_PATCH, geometry, here, memory, AT_FEET + leg * FEET)
        at, cone = at + ACTUATOR_ROWS[kind] * STEP, cone + 2 * STEP
    if wanted & (SPECTRA | CONTROL | ELLIPSOID):
        _matrices(memory, kinds, geometry, weights, length, wanted, places)
    if wanted & CLEARANCE:
        at = cone + N_INDICES * STEP
        for pair in range(len(pairs)):
            one, other = AT_FEET + pairs[pair, 0] * FEET, AT_FEET + pairs[pair, 1] * FEET
            _clearance(0, memory, AT_PATCH, memory, one, memory, other, memory, at, length)
            at += STEP


@njit(error_model="numpy", nogil=True)
def _positions(memory: Array, at: int) -> None:
    """Bounds of x, y, z: those of the box."""
    for k in range(3):
        for i in range(LANES):
            here = at + k * QUANTITY * LANES + i
            low, high = memory[AT_BOX + k * LANES + i], memory[AT_BOX + (6 + k) * LANES + i]
            middle = memory[AT_PATCH + k * LANES + i]
            memory[here + LOW * LANES], memory[here + HIGH * LANES] = low, high
            memory[here + MID_LOW * LANES] = memory[here + MID_HIGH * LANES] = middle
            for m in range(6):
                memory[here + (PARTS + m) * LANES] = high - low if m == k else 0.0


@njit(error_model="numpy", nogil=True)
def _judge(memory: Array, at: int, bounds: Array, chosen: Numbers, lane: int) -> tuple[int, int]:
    """First quantity that is not proven on a patch, and first that is refuted at its centre.

    Each is −1 if there is none. NaN proves nothing and refutes nothing.
    """
    unproven = -1
    for q in chosen:
        here = at + q * QUANTITY * LANES + lane
        low, high = memory[here + LOW * LANES], memory[here + HIGH * LANES]
        if not (low >= bounds[0, q] and high <= bounds[1, q]):
            if unproven < 0:
                unproven = q
            below = memory[here + MID_HIGH * LANES] < bounds[2, q]
            if below or memory[here + MID_LOW * LANES] > bounds[3, q]:
                return unproven, q
    return unproven, -1


@njit(error_model="numpy", nogil=True)
def _coordinate(memory: Array, at: int, lane: int, box: Array, length: float) -> int:
    """Coordinate to halve: the one that makes most of the width, −1 if none can be halved.

    Where the width is infinite it is the widest coordinate, positions divided by the length.
    """
    best, most, finite = -1, -1.0, True
    for k in range(6):
        finite &= memory[at + (PARTS + k) * LANES + lane] < np.inf
    for k in range(6):
        middle = 0.5 * (box[k] + box[6 + k])
        if not (box[k] < middle < box[6 + k]):
            continue
        if finite:
            part = memory[at + (PARTS + k) * LANES + lane]
        else:
            part = (box[6 + k] - box[k]) / (length if k < 3 else 1.0)
        if part > most:
            best, most = k, part
    return best


def _digest() -> int:
    """Return a checksum of what numba's cache does not watch."""
    return checksum_of_code(checksum((*ALL, *stages.ALL)))


def _encloser(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def enclose_boxes(
        boxes: Array,
        frame: Array,
        kinds: Numbers,
        geometry: Array,
        axes: Array,
        weights: Array,
        pairs: Numbers,
        length: float,
        wanted: int,
        out: Array,
        signs: Array,
    ) -> None:
        """Bound the quantities on n boxes.

        Parameters
        ----------
        boxes : (n, 12) array
            Least values, then greatest, of p and of the angles in the order of moving axes.
        out : (n, quantities, 10) array
            Filled: see `gsp.proof.variation.stages`.
        signs : (n,) array
            Filled with the sign of the determinant at the centres, if SPECTRA are wanted.
        """
        places = _places(kinds, pairs)
        n, at_quantities = places[0], places[4]
        memory = np.zeros(places[5] + 0 * digest)
        for start in range(0, len(boxes), LANES):
            count = min(LANES, len(boxes) - start)
            for i in range(LANES):
                for k in range(BOX):
                    memory[AT_BOX + k * LANES + i] = boxes[start + min(i, count - 1), k]
            _boxes(0, memory, AT_BOX, frame, 0, memory, AT_PATCH)
            _enclose(memory, kinds, geometry, axes, weights, pairs, length, wanted, places)
            _positions(memory, at_quantities + n * QUANTITY * LANES)
            for i in range(count):
                signs[start + i] = memory[AT_SIGN + i]
                for q in range(out.shape[1]):
                    for k in range(QUANTITY):
                        out[start + i, q, k] = memory[
                            at_quantities + (q * QUANTITY + k) * LANES + i
                        ]

    return enclose_boxes


def _searcher(digest: int) -> Callable[..., tuple[int, int, int, int, int]]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def search(
        stack: Array,
        nodes: Numbers,
        top: int,
        frame: Array,
        kinds: Numbers,
        geometry: Array,
        axes: Array,
        weights: Array,
        pairs: Numbers,
        length: float,
        wanted: int,
        bounds: Array,
        chosen: Numbers,
        signed: int,
        sign: Array,
        marks: Codes,
        children: Numbers,
        used: int,
        budget: int,
        found: Array,
    ) -> tuple[int, int, int, int, int]:
        """Decide the boxes on a stack, or halve them.

        Parameters
        ----------
        stack, nodes : (m, 12) and (m,) arrays
            Boxes to decide and their numbers; the first `top` are there, and room for more.
        bounds : (4, quantities) array
            Least and greatest values to prove, and those that a pose beyond them refutes.
        chosen : int array
            Numbers of the quantities that count.
        signed : int
            Number of the quantity σ_min, if a change of sign of det J refutes; else −1.
        sign : (7,) array
            The sign that was met first and where, 0 if none was; updated.
        marks, children : arrays
            Filled for each number of a box: its mark, and the number of its first half.
        used : int
            Boxes that have numbers.
        budget : int
            Most boxes to decide.
        found : (6,) array
            Filled with the coordinates of the centre that refutes.

        Returns
        -------
        how it ended, boxes on the stack, boxes that have numbers, boxes decided, quantity refuted
        """
        places = _places(kinds, pairs)
        n, at_quantities = places[0], places[4]
        memory = np.zeros(places[5] + 0 * digest)
        box = np.empty(BOX)
        decided = 0
        while top > 0:
            if decided >= budget or used + 2 * LANES > len(marks) or top + LANES > len(stack):
                return ENDED, top, used, decided, -1
            count = min(LANES, top)
            top -= count
            for i in range(LANES):
                for k in range(BOX):
                    memory[AT_BOX + k * LANES + i] = stack[top + min(i, count - 1), k]
            _boxes(0, memory, AT_BOX, frame, 0, memory, AT_PATCH)
            _enclose(memory, kinds, geometry, axes, weights, pairs, length, wanted, places)
            _positions(memory, at_quantities + n * QUANTITY * LANES)
            taken = nodes[top : top + count].copy()
            for i in range(count):
                node = taken[i]
                decided += 1
                for k in range(BOX):
                    box[k] = memory[AT_BOX + k * LANES + i]
                unproven, refuted = _judge(memory, at_quantities, bounds, chosen, i)
                ended = VIOLATED if refuted >= 0 else DONE
                if signed >= 0:
                    at = at_quantities + signed * QUANTITY * LANES
                    here = memory[AT_SIGN + i]
                    if memory[at + MID_LOW * LANES + i] > 0.0 and here != 0.0:
                        if sign[0] == 0.0:
                            sign[0] = here
                            for k in range(6):
                                sign[1 + k] = 0.5 * (box[k] + box[6 + k])
                        elif sign[0] != here and ended == DONE:
                            ended = CHANGED
                if ended != DONE:
                    for k in range(6):
                        found[k] = 0.5 * (box[k] + box[6 + k])
                    return ended, top, used, decided, refuted
                if unproven < 0:
                    marks[node] = PROVEN
                    continue
                k = _coordinate(memory, at_quantities + unproven * QUANTITY * LANES, i, box, length)
                if k < 0:
                    marks[node] = OPEN
                    continue
                marks[node], children[node] = k, used
                middle = 0.5 * (box[k] + box[6 + k])
                for half in range(2):
                    for m in range(BOX):
                        stack[top, m] = box[m]
                    stack[top, k + 6 * (1 - half)] = middle
                    nodes[top] = used
                    top, used = top + 1, used + 1
        return DONE, top, used, decided, -1

    return search


enclose_boxes = njit(error_model="numpy", nogil=True, cache=True)(_encloser(_digest()))
search = njit(error_model="numpy", nogil=True, cache=True)(_searcher(_digest()))
