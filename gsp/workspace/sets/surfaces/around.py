"""The points around rectangles where pieces touch: corners, and where planes end on the sides."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.vectors import Array, Mask
from gsp.workspace.sets.codes import Numbers
from gsp.workspace.sets.surfaces.contacts import Contacts
from gsp.workspace.sets.surfaces.pieces import Pieces

# Of the sides of a rectangle: the direction, 0 or 1, along which it runs, and whether backward.
SIDES = ((0, False), (1, False), (0, True), (1, True))


class Around(NamedTuple):
    """Points around rectangles: per side its first corner, and up to two ends of chords.

    Attributes
    ----------
    valid : (n, 12) bool array
    plane : (n, 12) int array
        The plane whose chord ends there, −1 for a corner.
    point : (n, 12, 3) int array
        Coordinates; along the side those of the last point of the grid before the end.
    at : (n, 12) array
        Coordinate along the side, in cells of the grid.
    inside : (2, n, 12) bool array
        Whether what follows is in the piece below, and in the one above.
    """

    valid: Mask
    plane: Numbers
    point: Numbers
    at: Array
    inside: Mask


def points_around(boxes: Pieces, touching: Contacts) -> Around:
    """Return the points around rectangles, in their order."""
    n, u, v = len(touching.below), (touching.axis + 1) % 3, (touching.axis + 2) % 3
    corners = np.repeat(touching.first[:, None], 4, axis=1)
    corners[:, 1:3, u], corners[:, 2:, v] = touching.last[:, None, u], touching.last[:, None, v]
    owners = np.stack((touching.below, touching.above))
    planes = np.where(owners >= 0, boxes.plane[owners], -1)
    signs = np.stack([boxes.above(plane[:, None], corners) for plane in planes])
    signs &= (owners >= 0)[..., None]
    found = Around(
        np.ones((n, 12), dtype=np.bool_),
        np.full((n, 12), -1),
        np.repeat(corners, 3, axis=1),
        np.zeros((n, 12)),
        np.zeros((2, n, 12), dtype=np.bool_),
    )
    changes = np.zeros((2, n, 12), dtype=np.bool_)
    for side, (direction, backward) in enumerate(SIDES):
        along, slot = (u, v)[direction], 3 * side
        found.at[:, slot] = corners[:, side, along]
        ends = corners[:, side], corners[:, (side + 1) % 4]
        low = ends[1] if backward else ends[0]
        length = np.abs(ends[1] - ends[0])[:, along]
        crossed = signs[:, :, side] != signs[:, :, (side + 1) % 4]
        chords = [_crossings(boxes, planes[i], low, along, length, crossed[i]) for i in (0, 1)]
        (g, x), (h, y) = chords
        later = (g > h) | ((g == h) & ((x > y) | ((x == y) & (planes[0] > planes[1]))))
        # The chord of the piece below is second where it ends later.
        second = (later != backward) & crossed.all(axis=0)
        for which in (0, 1):
            place = np.where(second, 1 - which, which) + slot + 1
            where = np.arange(n), place
            found.valid[where] = crossed[which]
            found.plane[where] = planes[which]
            found.point[*where, along] = chords[which][0]
            found.at[where] = chords[which][1]
            changes[which][where] = crossed[which]
    np.logical_xor(signs[:, :, :1], np.logical_xor.accumulate(changes, axis=2), out=found.inside)
    return found


def _crossings(
    boxes: Pieces, plane: Numbers, low: Numbers, along: int, length: Numbers, crossed: Mask
) -> tuple[Numbers, Array]:
    """Return where planes cross lines: the last point of the grid before it, and the coordinate.

    It depends on the plane and the line only, not on where on it the search begins.
    """
    g, x = np.zeros(len(plane), dtype=np.int64), np.zeros(len(plane))
    plane, point = plane[crossed], low[crossed].copy()
    before = point[:, along].copy()
    after = before + length[crossed]
    sign = boxes.above(plane, point)
    while (after - before > 1).any():
        middle = (before + after) // 2
        point[:, along] = middle
        same = boxes.above(plane, point) == sign
        before, after = np.where(same, middle, before), np.where(same, after, middle)
    heights = []
    for end in (before, after):
        point[:, along] = end
        heights.append(boxes.heights(plane, point))
    g[crossed] = before
    x[crossed] = before + np.clip(heights[0] / (heights[0] - heights[1]), 0.0, 1.0)
    return g, x
