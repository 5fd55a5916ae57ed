"""The compiled search over boxes: halve what is not decided, LANES boxes at a time.

Both functions take a design and its limits as these arguments:

- frame, (18,): the axes of the three turns in their order, and the rotation before them, by rows.
- kinds, (n_legs,): places of the legs in `LEGS`.
- geometry, (n_legs · GEOMETRY,): the rows of `gsp.variation.designs.geometry_of`.
- axes, (n_legs · 6,): unit axes of the cones on base and platform; 0 where there is none.
- weights, (WEIGHTS,): scalars of the ellipsoid, see `gsp.variation.passive`; zeros without one.
- pairs, (m, 2): legs whose distance is bounded.
- length [length]: the characteristic length, by which values are divided.
- wanted: the sum of the flags of `gsp.variation.layout` that are computed.

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
from gsp.kernels.compiled.matrices import checksum_of_code
from gsp.kernels.stages import ALL, LANES, checksum
from gsp.variation import blocks, screening, stages
from gsp.variation.enclosing import enclose, load_boxes, narrow, second_screen, spectra
from gsp.variation.layout import (
    DONE,
    ENDED,
    HIGH,
    LOW,
    MID_HIGH,
    MID_LOW,
    OPEN,
    PARTS,
    PROVEN,
    QUANTITY_SCALARS,
    SCREEN,
    SECOND_SCREEN,
    SIGN_CHANGED,
    VIOLATED,
)
from gsp.variation.memory import AT_BOX, AT_SIGN, QUANTITY_DOUBLES, Numbers, places_of
from gsp.variation.stages import BOX_SCALARS

Codes = NDArray[np.int8]

# Where the bound of the first screen exceeds the required one by more than this factor, the second
# is not tried: it would exceed it too. Of 1.5, 1.25 and 1.2 the search took least time with 1.25.
SECOND_SCREEN_FACTOR = 1.25
# Boxes whose bounds exceed the required ones by less than this factor after the screens are
# collected, and bounded with exact derivatives, LANES at a time: that takes twice the time of the
# screens. With 1.03 the search took up to twice the time for bounds that are nearly reached, and
# with 1.1 some percent more for others.
DERIVATIVES_FACTOR = 1.05


@njit(error_model="numpy", nogil=True)
def _judge(memory: Array, at: int, bounds: Array, chosen: Numbers, lane: int) -> tuple[int, int]:
    """First quantity that is not proven on a patch, and first that is refuted at its centre.

    Each is −1 if there is none. NaN proves nothing and refutes nothing.
    """
    unproven = -1
    for q in chosen:
        here = at + q * QUANTITY_DOUBLES + lane
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
    total = 0.0
    for k in range(6):
        total += memory[at + (PARTS + k) * LANES + lane]
    # No branches in the loop: which coordinate it is cannot be predicted.
    finite, best, most, unit = total < np.inf, -1, -1.0, 1.0 / length
    for k in range(6):
        low, high = box[k], box[6 + k]
        middle, width = 0.5 * (low + high), (high - low) * (unit if k < 3 else 1.0)
        part = memory[at + (PARTS + k) * LANES + lane] if finite else width
        part = part if (low < middle) & (middle < high) else -1.0
        more = part > most
        best, most = k if more else best, part if more else most
    return best


@njit(error_model="numpy", nogil=True)
def _is_settled(memory: Array, at: int, bounds: Array, least: int, lane: int, far: float) -> bool:
    """Whether the bounds of a screen decide a patch, so that narrower bounds are not needed.

    They prove the requirement; or they exceed it by more than a factor, so that the patch is too
    large, and the centre satisfies it.
    """
    for q in range(least, least + 2):
        here = at + q * QUANTITY_DOUBLES + lane
        low, high = memory[here + LOW * LANES], memory[here + HIGH * LANES]
        if low >= bounds[0, q] and high <= bounds[1, q]:
            continue
        if not (memory[here + MID_LOW * LANES] >= bounds[2, q]):
            return False
        if not (memory[here + MID_HIGH * LANES] <= bounds[3, q]):
            return False
        if q == least and (low * far >= bounds[0, q] or high > bounds[1, q]):
            return False
        if q > least and (high <= far * bounds[1, q] or low < bounds[0, q]):
            return False
    return True


@njit(error_model="numpy", nogil=True)
def _all_settled(memory: Array, at: int, bounds: Array, least: int, count: int, far: float) -> bool:
    """Whether the bounds of a screen decide all patches."""
    settled = True
    for lane in range(count):
        settled &= _is_settled(memory, at, bounds, least, lane, far)
    return settled


@njit(error_model="numpy", nogil=True)
def _narrow(
    memory: Array,
    kinds: Numbers,
    length: float,
    places: tuple[int, int, int, int, int, int],
    bounds: Array,
    count: int,
    whole: bool,
) -> None:
    """Narrow the bounds of a screen where they do not decide; all that is known if `whole`."""
    n, at_jets, at_quantities = places[0], places[1], places[4]
    least = n + 3 + 2 * kinds.size
    if not whole and _all_settled(
        memory, at_quantities, bounds, least, count, SECOND_SCREEN_FACTOR
    ):
        return
    second_screen(memory, kinds, places)
    if whole:
        narrow(memory, n, at_jets, at_quantities + least * QUANTITY_DOUBLES, length)
        # Halving costs less than singular values: these are for centres that may refute.
        if not _all_settled(memory, at_quantities, bounds, least, count, 0.0):
            spectra(memory, kinds, length, places)


def _digest() -> int:
    """Return a checksum of the sources that numba's cache does not check."""
    number = checksum_of_code(checksum((*ALL, *stages.ALL, *screening.ALL, *blocks.ALL)))
    for name in ("enclosing.py", "memory.py"):
        number = crc32(Path(__file__).with_name(name).read_bytes(), number)
    return number


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
            Filled: see `gsp.variation.stages`.
        signs : (n,) array
            Filled with the sign of the determinant at the centres, if SPECTRA are wanted.
        """
        places = places_of(kinds, pairs)
        at_quantities = places[4]
        memory = np.zeros(places[5] + 0 * digest)
        for start in range(0, len(boxes), LANES):
            count = min(LANES, len(boxes) - start)
            load_boxes(memory, boxes, start, count, frame)
            enclose(memory, kinds, geometry, axes, weights, pairs, length, wanted, places)
            if wanted & SECOND_SCREEN:
                second_screen(memory, kinds, places)
                least = places[0] + 3 + 2 * kinds.size
                narrow(
                    memory, places[0], places[1], at_quantities + least * QUANTITY_DOUBLES, length
                )
            for i in range(count):
                signs[start + i] = memory[AT_SIGN + i]
                for q in range(out.shape[1]):
                    for k in range(QUANTITY_SCALARS):
                        out[start + i, q, k] = memory[
                            at_quantities + (q * QUANTITY_SCALARS + k) * LANES + i
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
            Boxes to decide and their numbers; the first `top` are filled.
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
        places = places_of(kinds, pairs)
        at_quantities, least = places[4], places[0] + 3 + 2 * kinds.size
        memory = np.zeros(places[5] + 0 * digest)
        box, taken = np.empty(BOX_SCALARS), np.empty(LANES, dtype=np.int64)
        # Boxes that wait until there are LANES of them for bounds with exact derivatives.
        held, held_nodes = np.empty((2 * LANES, BOX_SCALARS)), np.zeros(2 * LANES, dtype=np.int64)
        waiting, decided = 0, 0
        while top + waiting > 0:
            if decided >= budget or used + 2 * LANES > len(marks) or top + 4 * LANES > len(stack):
                stack[top : top + waiting] = held[:waiting]
                nodes[top : top + waiting] = held_nodes[:waiting]
                return ENDED, top + waiting, used, decided, -1
            whole = waiting >= LANES or top == 0
            if whole:
                count = min(LANES, waiting)
                waiting -= count
                load_boxes(memory, held, waiting, count, frame)
                taken[:count] = held_nodes[waiting : waiting + count]
            else:
                count = min(LANES, top)
                top -= count
                load_boxes(memory, stack, top, count, frame)
                taken[:count] = nodes[top : top + count]
            enclose(memory, kinds, geometry, axes, weights, pairs, length, wanted, places)
            if wanted & SCREEN:
                _narrow(memory, kinds, length, places, bounds, count, whole)
            for i in range(count):
                node = taken[i]
                for k in range(BOX_SCALARS):
                    box[k] = memory[AT_BOX + k * LANES + i]
                unproven, refuted = _judge(memory, at_quantities, bounds, chosen, i)
                if wanted & SCREEN and not whole and refuted < 0:
                    if not _is_settled(memory, at_quantities, bounds, least, i, DERIVATIVES_FACTOR):
                        held[waiting], held_nodes[waiting] = box, node
                        waiting += 1
                        continue
                decided += 1
                ended = VIOLATED if refuted >= 0 else DONE
                if signed >= 0:
                    at = at_quantities + signed * QUANTITY_DOUBLES
                    here = memory[AT_SIGN + i]
                    if memory[at + MID_LOW * LANES + i] > 0.0 and here != 0.0:
                        if sign[0] == 0.0:
                            sign[0] = here
                            for k in range(6):
                                sign[1 + k] = 0.5 * (box[k] + box[6 + k])
                        elif sign[0] != here and ended == DONE:
                            ended = SIGN_CHANGED
                if ended != DONE:
                    for k in range(6):
                        found[k] = 0.5 * (box[k] + box[6 + k])
                    return ended, top, used, decided, refuted
                if unproven < 0:
                    marks[node] = PROVEN
                    continue
                k = _coordinate(memory, at_quantities + unproven * QUANTITY_DOUBLES, i, box, length)
                if k < 0:
                    marks[node] = OPEN
                    continue
                marks[node], children[node] = k, used
                middle = 0.5 * (box[k] + box[6 + k])
                for half in range(2):
                    for m in range(BOX_SCALARS):
                        stack[top, m] = box[m]
                    stack[top, k + 6 * (1 - half)] = middle
                    nodes[top] = used
                    top, used = top + 1, used + 1
        return DONE, top, used, decided, -1

    return search


enclose_boxes = njit(error_model="numpy", nogil=True, cache=True)(_encloser(_digest()))
search = njit(error_model="numpy", nogil=True, cache=True)(_searcher(_digest()))
