"""The surface of convex pieces, as polygons without gaps: faces of cells, and planes in them.

Which points a polygon has is decided by signs alone, never by distances, so that each edge has two
polygons. On a rectangle where two pieces touch, the plane of each is a chord. Two chords cross if
and only if their ends alternate around the rectangle; on each of its sides the ends have one order,
which all rectangles at that line of the grid share.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.vectors import Array, Mask
from gsp.workspace.sets.codes import Numbers
from gsp.workspace.sets.surfaces.around import SIDES, Around, points_around
from gsp.workspace.sets.surfaces.contacts import contacts
from gsp.workspace.sets.surfaces.pieces import Pieces


class Edges(NamedTuple):
    """Directed edges of polygons.

    Attributes
    ----------
    start, end : (m,) int arrays
        Numbers of vertices.
    polygon : (m,) int array
        The polygon, seen from outside counterclockwise.
    """

    start: Numbers
    end: Numbers
    polygon: Numbers


def outer(boxes: Pieces) -> tuple[Array, Edges]:
    """Return vertices (v, 3) and directed edges of the polygons that bound pieces."""
    if not len(boxes.plane):
        return np.zeros((0, 3)), Edges(*np.zeros((3, 0), dtype=np.int64))
    touching = [contacts(boxes, k) for k in range(3)]
    around = [points_around(boxes, one) for one in touching]
    below, above = (np.concatenate([one[i] for one in touching]) for i in (1, 2))
    joined = Around(
        valid=np.concatenate([one.valid for one in around]),
        plane=np.concatenate([one.plane for one in around]),
        point=np.concatenate([one.point for one in around]),
        at=np.concatenate([one.at for one in around]),
        inside=np.concatenate([one.inside for one in around], axis=1),
    )
    axis = np.repeat([0, 1, 2], [len(one.below) for one in touching])
    return _Polygons(boxes, axis, below, above, joined).surface()


class _Polygons:
    """Polygons on rectangles and in planes, from the points around the rectangles.

    Polygons 2 i and 2 i + 1 are on rectangle i: of the piece below it where the one above is not,
    and the other way round. After them come the planes of the pieces.
    """

    def __init__(
        self, boxes: Pieces, axis: Numbers, below: Numbers, above: Numbers, around: Around
    ) -> None:
        self.boxes, self.around = boxes, around
        self.owners = np.stack((below, above))
        self.planes = np.where(self.owners >= 0, boxes.plane[self.owners], -1)
        # Direction of each side of the rectangles.
        self.along = (axis[:, None] + 1 + np.array([d for d, _ in SIDES])) % 3
        self.vertices = self._numbered()
        # The same plane on both sides: what is above it is inside on both.
        self.apart = (self.planes[0] != self.planes[1]) | (self.planes[0] < 0)
        # Rectangles with a chord of the piece below, and the two ends of it.
        self.below: Numbers = np.zeros(0, dtype=np.int64)
        self.chords: tuple[Numbers, Numbers] = (self.below, self.below)
        self.rows: list[tuple[Numbers, Numbers, Numbers]] = []

    def surface(self) -> tuple[Array, Edges]:
        """Return the vertices, and the directed edges of the polygons."""
        self._along_sides()
        crossing = self._along_chords()
        vertices = np.concatenate((self.points, self._crossed(crossing)))
        return vertices, Edges(*(np.concatenate(x) for x in zip(*self.rows, strict=True)))

    def _numbered(self) -> Numbers:
        """Return the numbers (n, 12) of points: of the grid, and where planes cross it."""
        a = self.around
        self.slots = np.nonzero(a.valid)
        point, plane = a.point[self.slots], a.plane[self.slots]
        along = self.along[self.slots[0], self.slots[1] // 3]
        line = self._lines(point, along)
        ends = plane >= 0
        size = self.boxes.extent + 1
        key = (point[:, 0] * size[1] + point[:, 1]) * size[2] + point[:, 2]
        _, first, corner = np.unique(key[~ends], return_index=True, return_inverse=True)
        places = point[~ends][first].astype(np.float64)
        number = np.empty(len(key), dtype=np.int64)
        number[~ends] = corner
        key = line[ends] * len(self.boxes.planes) + plane[ends]
        _, chosen, which = np.unique(key, return_index=True, return_inverse=True)
        number[ends] = len(places) + which
        crossed = point[ends][chosen].astype(np.float64)
        crossed[np.arange(len(chosen)), along[ends][chosen]] = a.at[self.slots][ends][chosen]
        self.points = self.boxes.start + np.concatenate((places, crossed)) * self.boxes.step
        result = np.full(a.valid.shape, -1)
        result[self.slots] = number
        return result

    def _lines(self, point: Numbers, along: Numbers) -> Numbers:
        """Return a number for each line of the grid, those through points along axes."""
        rest = point.copy()
        rest[np.arange(len(rest)), along] = 0
        size = self.boxes.extent + 1
        key = (rest[:, 0] * size[1] + rest[:, 1]) * size[2] + rest[:, 2]
        order = np.lexsort((along, key))
        new = np.ones(len(key), dtype=np.bool_)
        new[1:] = (np.diff(key[order]) != 0) | (np.diff(along[order]) != 0)
        result = np.empty(len(key), dtype=np.int64)
        result[order] = np.cumsum(new) - 1
        return result

    def _add(
        self, start: Numbers, end: Numbers, rectangle: Numbers, which: int, *, plane: bool = False
    ) -> None:
        """Note edges of the piece below (0) or above (1) rectangles, on them or in its plane."""
        of_plane = 2 * self.owners.shape[1] + self.owners[which, rectangle]
        polygon = of_plane if plane else 2 * rectangle + which
        # From outside, polygons of the piece above are seen from the other side.
        pair = (start, end) if (which == 0) != plane else (end, start)
        self.rows.append((*pair, polygon))

    def _along_sides(self) -> None:
        """Note the edges along sides of rectangles, divided where others have a vertex."""
        rectangle, slot = self.slots
        first = np.searchsorted(rectangle, np.arange(len(self.around.valid)))
        following = np.arange(1, len(rectangle) + 1)
        last = np.append(first[1:], len(rectangle)) - 1
        following[last] = first
        after = slot[following]
        side = slot // 3
        inside = self.around.inside[:, rectangle, slot]
        used = (inside[0] != inside[1]) & self.apart[rectangle]
        rectangle, slot, after, side = (x[used] for x in (rectangle, slot, after, side))
        which = np.where(inside[0][used], 0, 1)
        along = self.along[rectangle, side]
        line = self._lines(self.around.point[rectangle, slot], along)
        starts = self._incidence(rectangle, slot, along)
        ends = self._incidence(rectangle, after, along)
        columns = [np.concatenate(x) for x in zip(starts, ends, strict=True)]
        vertex, lines = columns.pop(), np.tile(line, 2)
        order = np.lexsort((*columns, lines))
        new = np.ones(len(order), dtype=np.bool_)
        new[1:] = (np.diff(vertex[order]) != 0) | (np.diff(lines[order]) != 0)
        rank = np.empty(len(order), dtype=np.int64)
        rank[order] = np.cumsum(new) - 1
        of_rank = vertex[order][new]
        low, high = rank[: len(line)], rank[len(line) :]
        pieces, sign = np.abs(high - low), np.sign(high - low)
        which, rectangle = np.repeat(which, pieces), np.repeat(rectangle, pieces)
        inner = np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
        begin = np.repeat(low, pieces) + inner * np.repeat(sign, pieces)
        end = begin + np.repeat(sign, pieces)
        for k in (0, 1):
            some = which == k
            self._add(of_rank[begin[some]], of_rank[end[some]], rectangle[some], k)

    def _incidence(self, rectangle: Numbers, slot: Numbers, along: Numbers) -> list[Numbers]:
        """Return by what points on a line are sorted, last first, and their vertices."""
        plane = self.around.plane[rectangle, slot]
        point = self.around.point[rectangle, slot][np.arange(len(slot)), along]
        at = np.where(plane >= 0, self.around.at[rectangle, slot], point)
        return [plane, at, (plane >= 0).astype(np.int64), point, self.vertices[rectangle, slot]]

    def _along_chords(self) -> Numbers:
        """Note the edges along chords; return the rectangles in which two of them cross."""
        a = self.around
        some = [np.flatnonzero(self._ends(k).any(axis=1)) for k in (0, 1)]
        crossing: Numbers = np.zeros(0, dtype=np.int64)
        number = np.full(len(a.valid), -1)
        for which in (0, 1):
            r = some[which]
            ends, other = self._ends(which)[r], a.inside[1 - which][r]
            enters = ends & a.inside[which][r]
            leaves = ends & ~a.inside[which][r]
            i, o = enters.argmax(axis=1), leaves.argmax(axis=1)
            rows = np.arange(len(r))
            begin, end = other[rows, i], other[rows, o]
            if which == 0:
                crossing = r[(begin != end) & self.apart[r]]
                number[crossing] = len(self.points) + np.arange(len(crossing))
            v_in, v_out, x = self.vertices[r, i], self.vertices[r, o], number[r]
            self._chord(r, which, v_in, v_out, x, (begin, end))
        return crossing

    def _ends(self, which: int) -> Mask:
        """Return where the chords of the pieces below (0) or above (1) end, (n, 12)."""
        inside = self.around.inside[which]
        return np.asarray(inside != np.roll(inside, 1, axis=1)) & self.around.valid

    def _chord(
        self,
        r: Numbers,
        which: int,
        enters: Numbers,
        leaves: Numbers,
        crossing: Numbers,
        other: tuple[Mask, Mask],
    ) -> None:
        """Note the edges of chords, from where the piece is left to where it is entered."""
        apart, crossed = self.apart[r], crossing >= 0
        at_enter, at_leave = other

        def add(start: Numbers, end: Numbers, some: Mask, kind: int, plane: bool = False) -> None:
            self._add(start[some], end[some], r[some], kind, plane=plane)

        # The piece lies to the left of the way from `leaves` to `enters`.
        for inside, kind in ((False, which), (True, 1 - which)):
            # Where the other piece is not, this piece has the edge; where it is, the other has.
            one, two = (at_leave == inside) & apart, (at_enter == inside) & apart
            ways = ((leaves, enters, one & two), (leaves, crossing, one & ~two),
                    (crossing, enters, two & ~one))  # fmt: skip
            for start, end, some in ways:
                if inside:
                    add(end, start, some, kind)
                else:
                    add(start, end, some, kind)
        whole = ~crossed
        for start, end, some in (
            (leaves, enters, whole), (leaves, crossing, crossed), (crossing, enters, crossed),
        ):  # fmt: skip
            add(start, end, some, which, plane=True)
        if which == 0:
            self.below, self.chords = r, (enters, leaves)

    def _crossed(self, rectangle: Numbers) -> Array:
        """Return where two chords cross, (n, 3): on the first one, by the heights of its ends."""
        at = np.searchsorted(self.below, rectangle)
        ends = [self.points[v[at]] for v in self.chords]
        normal = self.boxes.planes[self.planes[1, rectangle]]
        heights = [
            ((p - self.boxes.start) * normal[:, :3]).sum(axis=1) - normal[:, 3] for p in ends
        ]
        apart = heights[0] - heights[1]
        share = np.where(apart != 0.0, heights[0] / np.where(apart != 0.0, apart, 1.0), 0.5)
        return np.asarray(ends[0] + np.clip(share, 0.0, 1.0)[:, None] * (ends[1] - ends[0]))
