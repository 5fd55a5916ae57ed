"""Corners of the parts of boxes that lie on one side of a plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.workspace.sets.tree.boxes import CORNERS

# The six faces of a box, by its corners.
FACES = np.array(
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
)


def corners_beyond(low: Array, high: Array, plane: Array) -> Array:
    """Return the corners (m, 3) of the parts n · δ ≥ c of boxes, some of them several times.

    Parameters
    ----------
    low, high : (n, 3) arrays
    plane : (n, 4) array
        n and c of each box, with δ from its middle. c is infinite where there is no part, and −∞
        where the part is the whole box.
    """
    around, kept = _sides(*_heights(low, high, plane))
    return np.asarray(around[kept])


def _heights(low: Array, high: Array, plane: Array) -> tuple[Array, Array]:
    """Return corners (m, 8, 3) and their heights above the plane (m, 8), of boxes with a part."""
    corners = np.where(CORNERS, high[:, None], low[:, None])
    middle = 0.5 * (low + high)
    above = ((corners - middle[:, None]) * plane[:, None, :3]).sum(axis=-1) - plane[:, None, 3]
    some = (above > 0.0).any(axis=1)
    return corners[some], above[some]


def _sides(corners: Array, above: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return eight points around each face of the boxes, and which are above their plane."""
    points, heights = corners[:, FACES].reshape(-1, 4, 3), above[:, FACES].reshape(-1, 4)
    following = np.roll(points, -1, axis=1), np.roll(heights, -1, axis=1)
    crossed, at = _crossings(points, heights, *following)
    # A corner, and where the edge after it passes the plane.
    around = np.stack((points, at), axis=2).reshape(-1, 8, 3)
    return around, np.stack((heights > 0.0, crossed), axis=2).reshape(-1, 8)


def _crossings(
    start: Array, above: Array, end: Array, after: Array
) -> tuple[NDArray[np.bool_], Array]:
    """Return which edges pass a plane, and where: (…) and (…, 3)."""
    crossed = (above > 0.0) != (after > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(crossed, above / (above - after), 0.0)
    return crossed, start + share[..., None] * (end - start)
