"""Rectangles in which boxes of one grid touch, and those that only one box has."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.vectors import Mask
from gsp.workspace.sets.codes import Numbers
from gsp.workspace.sets.surfaces.pieces import Pieces


class Contacts(NamedTuple):
    """Rectangles across one axis k, none of which overlap.

    Attributes
    ----------
    axis : int
    below, above : (n,) int arrays
        The boxes on both sides, −1 for none.
    first, last : (n, 3) int arrays
        Least and greatest coordinates, equal along k.
    """

    axis: int
    below: Numbers
    above: Numbers
    first: Numbers
    last: Numbers


class _Faces(NamedTuple):
    """Rectangles of one size, sorted by their keys, and the boxes that they belong to."""

    key: Numbers
    box: Numbers


def contacts(boxes: Pieces, k: int) -> Contacts:
    """Return the rectangles across an axis in which boxes touch, or end at no other."""
    return _Search(boxes, k).contacts()


class _Search:
    """Faces of boxes across an axis, by size: a rectangle is (plane, a, b) in units of its size.

    Of two sizes the greater one is a multiple of the other in both directions, so two rectangles
    in a plane are apart, or one contains the other.
    """

    def __init__(self, boxes: Pieces, k: int) -> None:
        self.k, self.across = k, [(k + 1) % 3, (k + 2) % 3]
        self.extent = boxes.extent
        sides = (boxes.last - boxes.first)[:, self.across]
        sizes, level = np.unique(-sides, axis=0, return_inverse=True)
        self.sizes, self.level = -sizes, level.reshape(-1)
        self.places = boxes.first[:, self.across]
        # Sides: 0 of boxes below the plane, 1 of boxes above it.
        self.planes = (boxes.last[:, k], boxes.first[:, k])
        self.faces: list[list[_Faces]] = [[], []]
        self.holding: list[list[Numbers]] = [[], []]
        for side in (0, 1):
            self._sort(side)
        self.found: list[tuple[Numbers, Numbers, Numbers, Numbers, Numbers]] = []

    def key(self, plane: Numbers, place: Numbers, level: int) -> Numbers:
        """Return one number for each rectangle of a size."""
        a, b = (place // self.sizes[level]).T
        m, n = self.extent[self.across] // self.sizes[level]
        return np.asarray((plane * m + a) * n + b)

    def _sort(self, side: int) -> None:
        """Sort the faces of a side, and the greater rectangles that hold smaller faces."""
        for level in range(len(self.sizes)):
            box = np.flatnonzero(self.level == level)
            key = self.key(self.planes[side][box], self.places[box], level)
            order = np.argsort(key)
            self.faces[side].append(_Faces(key[order], box[order]))
            finer = self.level > level
            held = self.key(self.planes[side][finer], self.places[finer], level)
            self.holding[side].append(np.unique(held))

    def contacts(self) -> Contacts:
        """Return the rectangles, those of each size from both sides."""
        left: list[tuple[Numbers, Numbers, Numbers]] = [_none(), _none()]
        for level in range(len(self.sizes)):
            for side in (0, 1):
                alone = self._touching(side, level)
                work = [np.concatenate(x) for x in zip(left[side], alone, strict=True)]
                left[side] = self._divided(side, level, *work)
        parts = [np.concatenate([part[i] for part in self.found]) for i in range(5)]
        below, above, plane, place, of_level = parts
        first = np.empty((len(below), 3), dtype=np.int64)
        first[:, self.k], first[:, self.across] = plane, place
        last = first.copy()
        last[:, self.across] += self.sizes[of_level]
        return Contacts(self.k, below, above, first, last)

    def _touching(self, side: int, level: int) -> tuple[Numbers, Numbers, Numbers]:
        """Note the faces of a size that lie in a face of the other side; return the others."""
        box = self.faces[side][level].box
        plane, place = self.planes[side][box], self.places[box]
        other = np.full(len(box), -1)
        for coarser in range(level + 1):
            faces = self.faces[1 - side][coarser]
            at, same = _among(faces.key, self.key(plane, place, coarser))
            other[same] = faces.box[at[same]]
            if coarser == level and side == 1:  # noted from the other side
                other[same] = -2
        met = other >= 0
        self._note(side, box[met], other[met], plane[met], place[met], level)
        alone = other == -1
        return box[alone], plane[alone], place[alone]

    def _divided(
        self, side: int, level: int, box: Numbers, plane: Numbers, place: Numbers
    ) -> tuple[Numbers, Numbers, Numbers]:
        """Note rectangles without a face of the other side; return the parts of the others."""
        _, holds = _among(self.holding[1 - side][level], self.key(plane, place, level))
        free = ~holds
        self._note(side, box[free], np.full(free.sum(), -1), plane[free], place[free], level)
        if not holds.any():
            return _none()
        m, n = self.sizes[level] // self.sizes[level + 1]
        shift = np.stack(np.meshgrid(np.arange(m), np.arange(n)), axis=-1).reshape(-1, 2)
        parts = place[holds][:, None] + shift * self.sizes[level + 1]
        box, plane = (np.repeat(x[holds], len(shift)) for x in (box, plane))
        place = parts.reshape(-1, 2)
        key = self.key(plane, place, level + 1)
        _, met = _among(self.faces[1 - side][level + 1].key, key)
        return box[~met], plane[~met], place[~met]

    def _note(
        self, side: int, box: Numbers, other: Numbers, plane: Numbers, place: Numbers, level: int
    ) -> None:
        pair = (box, other) if side == 0 else (other, box)
        self.found.append((*pair, plane, place, np.full(len(box), level)))


def _none() -> tuple[Numbers, Numbers, Numbers]:
    empty = np.zeros(0, dtype=np.int64)
    return empty, empty, np.zeros((0, 2), dtype=np.int64)


def _among(keys: Numbers, wanted: Numbers) -> tuple[Numbers, Mask]:
    """Return where numbers would be in sorted ones, and which are there."""
    if not len(keys):
        return np.zeros(len(wanted), dtype=np.int64), np.zeros(len(wanted), dtype=np.bool_)
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return at, np.asarray(keys[at] == wanted)
