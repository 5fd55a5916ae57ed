"""The compiled search over boxes: halve what is not decided, LANES boxes at a time.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from zlib import crc32

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kernels import compiled
from gsp.kernels.compiled import _N_ACTUATORS, AT_ROWS, AT_SPECTRUM, _solve
from gsp.kernels.stages import ALL, CHUNK, LANES, checksum
from gsp.kernels.vectorised import vectorised
from gsp.proof.variation import stages
from gsp.proof.variation.layout import (
    CHANGED,
    CONES,
    DONE,
    ENDED,
    HIGH,
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
from gsp.proof.variation.stages import BOX, GRAM, ROW_SCALARS

Codes = NDArray[np.int8]
Numbers = NDArray[np.int64]

_boxes = vectorised(stages.BOXES)
_rows, _values = vectorised(*stages.ROWS), vectorised(*stages.VALUES)
_cones = vectorised(*stages.CONES)
_gram, _extremes = vectorised(stages.GRAM_ROW), vectorised(stages.EXTREMES)
_orientation = vectorised(stages.ORIENTATION)

AT_BOX = AT_ROWS
AT_PATCH = AT_BOX + BOX * LANES
AT_GRAM = AT_PATCH + PATCH * LANES
AT_SIGN = AT_GRAM + GRAM * LANES
AT_JETS = AT_SIGN + LANES


@njit(error_model="numpy", nogil=True)
def _size(kinds: Numbers) -> int:
    """Return the number of rows."""
    n = 0
    for kind in kinds:
        n += _N_ACTUATORS[kind]
    return n


@njit(error_model="numpy", nogil=True)
def _room(kinds: Numbers) -> tuple[int, int, int, int]:
    """Return the number of rows, where matrix and quantities lie, and the size of the memory."""
    n = _size(kinds)
    at_matrix = AT_JETS + n * ROW_SCALARS * LANES
    at_quantities = at_matrix + (n + CHUNK) * 6 * LANES
    return n, at_matrix, at_quantities, at_quantities + quantities(kinds) * QUANTITY * LANES


@njit(error_model="numpy", nogil=True)
def quantities(kinds: Numbers) -> int:
    """Count the quantities: joints, x, y, z, cones on base and platform, σ_min, condition."""
    return _size(kinds) + 3 + 2 * len(kinds) + 2


@njit(error_model="numpy", nogil=True)
def _spectra(memory: Array, n: int, at_matrix: int, at: int, length: float) -> None:
    """Quantities of the singular values of the homogeneous Jacobian."""
    for i in range(AT_GRAM, AT_GRAM + GRAM * LANES):
        memory[i] = 0.0
    for row in range(n):
        start = AT_JETS + row * ROW_SCALARS * LANES
        _gram(0, memory, start, memory, AT_GRAM)
        for i in range(6 * LANES):
            memory[at_matrix + row * 6 * LANES + i] = memory[start + i]
    if n == 6:
        _orientation(0, memory, at_matrix, memory, AT_SIGN)
    _solve(memory, at_matrix, n)
    _extremes(
        0, memory, AT_PATCH, memory, AT_SPECTRUM, memory, AT_GRAM, memory, at, length
    )  # fmt: skip


@njit(error_model="numpy", nogil=True)
def _enclose(
    memory: Array, kinds: Numbers, geometry: Array, axes: Array, length: float, wanted: int,
) -> None:  # fmt: skip
    """Bound the quantities on LANES patches."""
    n, at_matrix, at_quantities, _ = _room(kinds)
    step = QUANTITY * LANES
    row, cone = 0, at_quantities + (n + 3) * step
    for leg in range(kinds.size):
        kind = kinds[leg]
        at = at_quantities + row * step
        if wanted & JOINTS:
            _values(kind, memory, AT_PATCH, geometry, leg * GEOMETRY, memory, at, length)
        if wanted & SPECTRA:
            at = AT_JETS + row * ROW_SCALARS * LANES
            _rows(kind, memory, AT_PATCH, geometry, leg * GEOMETRY, memory, at, 1.0 / length)
        if wanted & CONES:
            _cones(
                kind, memory, AT_PATCH, geometry, leg * GEOMETRY, axes, 6 * leg,
                memory, cone + 2 * leg * step, length,
            )  # fmt: skip
        row += _N_ACTUATORS[kind]
    if wanted & SPECTRA:
        _spectra(memory, n, at_matrix, cone + 2 * kinds.size * step, length)


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
def _judge(
    memory: Array, at: int, low: Array, high: Array, chosen: Numbers, lane: int
) -> tuple[int, int]:
    """First quantity that is not proven on a patch, and first that is refuted at its centre.

    Each is −1 if there is none. NaN proves nothing and refutes nothing.
    """
    unproven = -1
    for q in chosen:
        here = at + q * QUANTITY * LANES + lane
        if not (memory[here + LOW * LANES] >= low[q] and memory[here + HIGH * LANES] <= high[q]):
            if unproven < 0:
                unproven = q
            below = memory[here + MID_HIGH * LANES] < low[q]
            if below or memory[here + MID_LOW * LANES] > high[q]:
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
    """Checksum of what numba's cache does not watch: the graphs, and the code in other files."""
    files = [Path(compiled.__file__).with_name(name) for name in ("compiled.py", "vectorised.py")]
    number = checksum((*ALL, *stages.ALL))
    for path in files:
        number = crc32(path.read_bytes(), number)
    return number


def _encloser(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def enclose_boxes(
        boxes: Array, frame: Array, kinds: Numbers, geometry: Array, axes: Array, length: float,
        wanted: int, out: Array, signs: Array,
    ) -> None:  # fmt: skip
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
        n, _, at_quantities, size = _room(kinds)
        memory = np.zeros(size + 0 * digest)
        for start in range(0, len(boxes), LANES):
            count = min(LANES, len(boxes) - start)
            for i in range(LANES):
                for k in range(BOX):
                    memory[AT_BOX + k * LANES + i] = boxes[start + min(i, count - 1), k]
            _boxes(0, memory, AT_BOX, frame, 0, memory, AT_PATCH)
            _enclose(memory, kinds, geometry, axes, length, wanted)
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
        stack: Array, nodes: Numbers, top: int, frame: Array, kinds: Numbers, geometry: Array,
        axes: Array, length: float, wanted: int, low: Array, high: Array, chosen: Numbers,
        signed: int, sign: Array, marks: Codes, children: Numbers, used: int, budget: int,
        found: Array,
    ) -> tuple[int, int, int, int, int]:  # fmt: skip
        """Decide the boxes on a stack, or halve them.

        Parameters
        ----------
        stack, nodes : (m, 12) and (m,) arrays
            Boxes to decide and their numbers; the first `top` are there, and room for more.
        low, high : (quantities,) arrays
            What each quantity has to be within.
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
        n, _, at_quantities, size = _room(kinds)
        memory = np.zeros(size + 0 * digest)
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
            _enclose(memory, kinds, geometry, axes, length, wanted)
            _positions(memory, at_quantities + n * QUANTITY * LANES)
            taken = nodes[top : top + count].copy()
            for i in range(count):
                node = taken[i]
                decided += 1
                for k in range(BOX):
                    box[k] = memory[AT_BOX + k * LANES + i]
                unproven, refuted = _judge(memory, at_quantities, low, high, chosen, i)
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
