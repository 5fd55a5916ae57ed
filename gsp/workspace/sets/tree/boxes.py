"""Boxes of positions or of angles: their measure, where points are among them, which touch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.pose.intervals import middle_measure
from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes
from gsp.workspace.sets.tree.cuts import sides

# Share of the size of a region within which a point counts as on the face of a box.
FACE_TOLERANCE = 1e-9
# Corners of a box in space, as low (0) or high (1) ends.
CORNERS = np.array([[i >> k & 1 for k in range(3)] for i in range(8)])
# The angles of boxes of rotations in their order, and the rotation that they stand for ("rpy").
TURNS, CONVENTION = ("roll", "pitch", "yaw"), "R = Rz(yaw) Ry(pitch) Rx(roll)"
# Measure of all rotations [rad³], as in `turn_measure`.
ALL_ROTATIONS = 8.0 * np.pi**2


def turn_measure(low: Array, high: Array) -> Array:
    """Volume of boxes of rpy angles (..., 3) among the rotations, 8π² in all [rad³]."""
    side = high - low
    return np.asarray(side[:, 0] * middle_measure(low[:, 1], high[:, 1]) * side[:, 2])


def located(
    points: Array,
    low: Array,
    high: Array,
    codes: Codes,
    domain: Array,
    cuts: Array | None = None,
) -> Codes:
    """Return the codes of the boxes in which points are.

    Parameters
    ----------
    points : (m, d) array [length, or rad]
    low, high : (n, d) arrays [as points]
        Boxes that come from `domain` by halving.
    codes : (n,) int8 array
    domain : (2, d) array [as points]
    cuts : (n, 8) array or None [1, as points]
        Parts of undecided boxes that are inside or outside.

    Returns
    -------
    (m,) int8 array
        Undecided on the faces of boxes, outside in no box.
    """
    result = np.full(len(points), OUTSIDE, dtype=np.int8)
    size = max(float((domain[1] - domain[0]).max(initial=0.0)), 1e-300)
    near = FACE_TOLERANCE * size
    # Farther points lie outside as well, and the numbers of their cells would overflow.
    points = np.clip(points, domain[0] - 3.0 * size, domain[1] + 3.0 * size)
    width = domain[1] - domain[0]
    # Exact sides: the number of a cell twenty halvings deep has no digit to spare for rounding.
    with np.errstate(divide="ignore", invalid="ignore"):
        halvings = np.rint(np.log2(width / (high - low)))
    halvings = np.where(high > low, halvings, 0.0)
    for number in np.unique(halvings, axis=0):
        chosen = np.flatnonzero((halvings == number).all(axis=1))
        least, most, known = low[chosen], high[chosen], codes[chosen]
        step = np.maximum(width / 2.0**number, near)
        keys = _keys(np.rint((least - domain[0]) / step).astype(np.int64))
        order = np.argsort(keys)
        # A point on a face is in the boxes on both sides, and rounding decides for one of them:
        # points beside it, in all directions, find each.
        for shift in _corners(low.shape[1]):
            moved = points + near * shift
            at = np.floor((moved - domain[0]) / step).astype(np.int64)
            place = np.minimum(np.searchsorted(keys[order], _keys(at)), len(order) - 1)
            cell = order[place]
            found = (moved >= least[cell]) & (moved <= most[cell])
            found = found.all(axis=1) & (keys[cell] == _keys(at))
            deep = (points > least[cell] + near) & (points < most[cell] - near)
            deep = found & deep.all(axis=1)
            result[found & (result == OUTSIDE)] = UNDECIDED
            result[deep & (known[cell] == INSIDE)] = INSIDE
            if cuts is not None:
                open_ = np.flatnonzero(deep & (known[cell] == UNDECIDED))
                own = cell[open_]
                result[open_] = sides(points[open_], least[own], most[own], cuts[chosen][own])
    return result


def components(low: Array, high: Array, turn: Array) -> NDArray[np.int64]:
    """Return the number of the part of each box (n, d); closed boxes that touch are one part.

    Parameters
    ----------
    low, high : (n, d) arrays [any; rad]
    turn : (d,) array [as a coordinate]
        Length after which it repeats, 0 if it does not.
    """
    from gsp.workspace.sets.compiled.connecting import connect

    parent = np.arange(len(low))
    if len(low):
        near = FACE_TOLERANCE * (high - low).max(axis=0)
        low, high, turn = (np.ascontiguousarray(x) for x in (low, high, turn))
        connect(low, high, turn, near, parent)
    return np.unique(parent, return_inverse=True)[1]


def _corners(d: int) -> Array:
    return np.array(np.meshgrid(*[(-1.0, 1.0)] * d)).reshape(d, -1).T


def _keys(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """One number per cell of a grid."""
    key = np.zeros(len(cells), dtype=np.int64)
    most = 1 << (62 // cells.shape[1])
    for k in range(cells.shape[1]):
        key = key * most + np.clip(cells[:, k], -1, most - 2) + 1
    return key
