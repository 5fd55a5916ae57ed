"""What the tree of cells calls: compiled decisions of many cells at once.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.legs import checksum_of_code, leg_vectors
from gsp.workspace.sets.compiled.comparing import buffers_for, compare
from gsp.workspace.sets.compiled.frames import CELL_FRAME_SCALARS, SPIN, frame_of
from gsp.workspace.sets.compiled.gaps import segment_gap, stay_apart
from gsp.workspace.sets.compiled.keeping import keep_cell
from gsp.workspace.sets.compiled.reaching import reach_cell

Numbers = NDArray[np.int64]
Codes = NDArray[np.int8]


def _digest() -> int:
    """Checksum of the files that are compiled: numba's cache depends on one of them only."""
    number = checksum_of_code()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        number = crc32(path.read_bytes(), number)
    return number


@njit(error_model="numpy", nogil=True)
def _middle_of(low: Array, high: Array, p: Array, h: Array) -> None:
    """Write the middle p and the half-widths h of a cell of positions, (3,) arrays [length].

    The greater of both differences, as p is rounded: [p − h, p + h] contains the cell.
    """
    for k in range(3):
        p[k] = 0.5 * (low[k] + high[k])
        h[k] = max(p[k] - low[k], high[k] - p[k])


def _reacher(digest: int) -> Callable[..., Any]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def reach_cells(
        lows: Array,
        highs: Array,
        families: Array,
        counts: Numbers,
        legs: Array,
        faces: Array,
        turns: Array,
        within: Array,
        given: Array,
        most: int,
        codes: Codes,
        cuts: Array,
    ) -> int:
        """Decide cells of positions that some rotation of a range reaches; return nodes.

        A cut that a cell has already is kept if no greater part is found.

        Parameters
        ----------
        lows, highs : (n, 3) arrays [length]
            The cells.
        families : (n, k, 12) array
            Rotations by rows and their angles, where climbs begin; filled with where they end.
        counts : (n,) int array
            How many of the k are filled; updated.
        legs, faces, turns, within, given, most : as in `reach_cell`
        codes : (n,) int8 array
            Filled: −1 outside, 1 inside, 0 undecided.
        cuts : (n, 8) array
            Parts of undecided cells, as in `gsp.workspace.sets.tree.cuts`; updated.
        """
        p, h, cut = np.empty(3), np.empty(3), np.empty(8)
        nodes = 0 * digest
        for c in range(len(lows)):
            _middle_of(lows[c], highs[c], p, h)
            cut[:] = 0.0
            cut[3], cut[7] = -np.inf, np.inf
            codes[c], counts[c], some = reach_cell(
                p, h, families[c], counts[c], legs, faces, turns, within, given, most, cut
            )
            nodes += some
            if cut[3] > -np.inf:
                cuts[c, :4] = cut[:4]
            if cut[7] < np.inf:
                cuts[c, 4:] = cut[4:]
        return nodes

    return reach_cells


def _keeper(digest: int) -> Callable[..., Any]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def keep_cells(
        lows: Array,
        highs: Array,
        legs: Array,
        turns: Array,
        given: Array,
        least: Array,
        greatest: Array,
        most: int,
        codes: Codes,
        cuts: Array,
    ) -> int:
        """Decide cells of positions that keep all rotations of a range; return nodes.

        Parameters
        ----------
        lows, highs : (n, 3) arrays [length]
            The cells.
        legs, turns, given, most : as in `keep_cell`
        least, greatest : (3,) arrays [rad]
            The range of the angles.
        codes, cuts : (n,) int8 and (n, 8) arrays
            Filled, as in `reach_cells`.
        """
        p, h, cut = np.empty(3), np.empty(3), np.empty(8)
        nodes = 0 * digest
        for c in range(len(lows)):
            _middle_of(lows[c], highs[c], p, h)
            cut[:] = 0.0
            cut[3], cut[7] = -np.inf, np.inf
            codes[c], some = keep_cell(p, h, legs, turns, given, least, greatest, most, cut)
            nodes += some
            cuts[c] = cut
        return nodes

    return keep_cells


def _sphere_judge(digest: int) -> Callable[..., Any]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def sphere_verdicts(
        lows: Array, highs: Array, rotations: Array, legs: Array, turns: Array, codes: Codes
    ) -> None:
        """Compare lengths with their bounds on cells of positions and rotations.

        Parameters
        ----------
        lows, highs : (n, 3) arrays [length]
        rotations : (n, 6) array [rad]
            Least, then greatest angles of each cell.
        legs, turns : arrays
            As in `Bounded`.
        codes : (n,) int8 array
            Filled: −1 if a bound is violated everywhere, 1 if none is anywhere, else 0.
        """
        buffers, frame = buffers_for(legs), np.empty(CELL_FRAME_SCALARS)
        p, h = np.empty(3), np.empty(3)
        for c in range(len(lows)):
            _middle_of(lows[c], highs[c], p, h)
            frame_of(rotations[c, :3], rotations[c, 3:], turns, frame)
            codes[c] = compare(p, h, legs, frame, buffers) + 0 * digest

    return sphere_verdicts


def _clear_judge(digest: int) -> Callable[..., Any]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def clear_verdicts(
        lows: Array,
        highs: Array,
        rotations: Array,
        legs: Array,
        turns: Array,
        pairs: Numbers,
        clearance: float,
        codes: Codes,
    ) -> None:
        """Compare the distances between SPS legs with a bound, on cells of poses.

        The platform end of a leg moves by at most `wide` with the position, as all others do, and
        by at most chord |b| with the rotation. So the difference of points at the shares s and t of
        two legs changes by at most |s − t| wide + chord (s |b| + t |b′|).

        Parameters
        ----------
        lows, highs, rotations, legs, turns, codes : as in `sphere_verdicts`
        pairs : (m, 2) int array
            Legs whose distance counts.
        clearance : float [length]
            Its least allowed value.
        """
        frame = np.empty(CELL_FRAME_SCALARS)
        p, h, tip = np.empty(3), np.empty(3), np.empty((len(legs), 3))
        moves, ends = np.empty(3), np.empty((4, 3))
        for c in range(len(lows)):
            _middle_of(lows[c], highs[c], p, h)
            wide, scale = np.sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]), 0.0
            frame_of(rotations[c, :3], rotations[c, 3:], turns, frame)
            chord = 2.0 * np.sin(0.5 * min(frame[SPIN], np.pi))
            for i in range(len(legs)):
                _, _, _, r0, r1, r2 = leg_vectors(p, legs[i], frame)
                tip[i, 0], tip[i, 1], tip[i, 2] = p[0] + r0, p[1] + r1, p[2] + r2
                for k in range(3):
                    scale = max(scale, abs(p[k]) + abs(legs[i, k]) + legs[i, 6])
            code = 1 + 0 * digest
            for q in range(len(pairs)):
                i, j = pairs[q, 0], pairs[q, 1]
                gap = segment_gap(legs[i, :3], tip[i], legs[j, :3], tip[j])
                # For rounding, and for nearly parallel legs, of which only the ends are compared.
                spare = 1e-7 * scale
                moves[0], moves[1], moves[2] = wide, chord * legs[i, 6], chord * legs[j, 6]
                reach = moves[0] + moves[1] + moves[2] + spare
                if gap + reach < clearance:
                    code = -1
                    break
                if code == 1 and gap - reach < clearance:
                    least = clearance + spare
                    code = int(
                        stay_apart(legs[i, :3], tip[i], legs[j, :3], tip[j], moves, least, ends)
                    )
            codes[c] = code

    return clear_verdicts


reach_cells = njit(error_model="numpy", nogil=True, cache=True)(_reacher(_digest()))
keep_cells = njit(error_model="numpy", nogil=True, cache=True)(_keeper(_digest()))
sphere_verdicts = njit(error_model="numpy", nogil=True, cache=True)(_sphere_judge(_digest()))
clear_verdicts = njit(error_model="numpy", nogil=True, cache=True)(_clear_judge(_digest()))
