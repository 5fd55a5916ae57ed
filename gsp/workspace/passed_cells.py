"""Which cells of a region curves pass on its boundary."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gsp.geometry.vectors import Array, Mask, norm
from gsp.workspace.boundary.branches import Branch
from gsp.workspace.boundary.critical import Points, between, joined
from gsp.workspace.boundary.events import across
from gsp.workspace.boundary.tracing import Tracer
from gsp.workspace.seeds import Seeds
from gsp.workspace.sets.codes import INSIDE, UNDECIDED
from gsp.workspace.sets.region.regions import Region

# Share of the size of a region by which a point beyond a face still counts as in the cell.
FACE_SHARE = 1e-9
# How far beyond a curve points are tested, one after the other until one is decided: those near to
# a boundary may not be, and of the farther ones another family may be.
BEYOND_SHARES = (1e-4, 1e-3, 4e-3)
# Points of a chord among which the end of the boundary is sought.
CHORD_POINTS = 15


@dataclass(eq=False)
class PassedCells:
    """The cells of a region, those that curves pass on its boundary, and what is there of each.

    Attributes
    ----------
    region : Region
    seeds : Seeds
    passed : (n,) bool array
    outer : list of (N,) bool arrays
        For each curve which of its points are on the boundary of the region.
    """

    region: Region
    seeds: Seeds

    def __post_init__(self) -> None:
        low, high, domain = self.region.low, self.region.high, self.region.domain
        self.passed: Mask = np.zeros(len(low), dtype=bool)
        self.outer: list[Mask] = []
        self.size = float((domain[1] - domain[0]).max())
        chosen = self.region.codes == UNDECIDED
        self.low, self.high = low - FACE_SHARE * self.size, high + FACE_SHARE * self.size
        self._open = self.low[chosen], self.high[chosen]

    def hold(self, points: Array) -> Mask:
        """Which points (N, 3) in base axes are in undecided cells, shape (N,)."""
        flat = self.region.problem.inward(points)[:, None, :2]
        low, high = self._open
        return np.asarray(((flat >= low) & (flat <= high)).all(axis=-1).any(axis=1))

    def undecided_at(self, point: Array) -> bool:
        """Whether a point (3,) is in an undecided cell."""
        return bool(self.hold(point[None])[0])

    def pass_along(self, tracer: Tracer, branch: Branch) -> Branch:
        """Mark the cells that a branch passes on the boundary; return it with the ends of that."""
        points = branch.trace.points
        outer = self._outer(tracer, points, branch)
        for i in np.flatnonzero(outer[:-1] != outer[1:])[::-1]:
            end = self._end(tracer, points, branch, int(i), bool(outer[i]))
            if end is not None:
                points = joined([points[: i + 1], end, points[i + 1 :]])
                outer = np.insert(outer, i + 1, True)
        flat = self.region.problem.inward(points.position)[:, :2]
        kept = outer[:-1] & outer[1:]
        for first, last in zip(flat[:-1][kept], flat[1:][kept], strict=True):
            self.passed |= crosses(self.low, self.high, first, last)
        self.outer.append(outer)
        return replace(branch, trace=replace(branch.trace, points=points))

    def _outer(self, tracer: Tracer, points: Points, branch: Branch) -> Mask:
        """Which points are local maxima in undecided cells, not proven inside beyond."""
        chart, active = tracer.chart, branch.trace.active
        outer = tracer.maximal(points, active)
        if active not in tracer.walls.curves:  # cells that end at a wall are mostly inside
            outer &= self.hold(points.position)
        some = points[outer].upright()
        if outer.any():
            normal = chart.normal(some, chart.jet(some.position, some.rotation), active)
            way = (normal / norm(normal)[:, None]) @ chart.axes
            outer[outer] = self._nothing_beyond(some.position, way)
        return outer

    def _nothing_beyond(self, position: Array, way: Array) -> Mask:
        """Whether the first point that is decided, along unit vectors, is not inside."""
        codes = np.zeros(len(position), dtype=np.int8)
        for share in BEYOND_SHARES:
            left = codes == UNDECIDED
            codes[left] = self.seeds.decided(position[left] + share * self.size * way[left])
        return np.asarray(codes != INSIDE)

    def _end(
        self, tracer: Tracer, points: Points, branch: Branch, i: int, first: bool
    ) -> Points | None:
        """Return the last point on the boundary between a point of a curve and the next one."""
        share = np.arange(1, CHORD_POINTS + 1) / (CHORD_POINTS + 1.0)
        guess = between(points, np.full(CHORD_POINTS, i), share)
        outer = self._outer(tracer, guess, branch)
        outer = outer if first else outer[::-1]
        number = CHORD_POINTS if outer.all() else int(np.argmin(outer))
        if not number:
            return None
        place = number - 1 if first else CHORD_POINTS - number
        near, active = guess[[place]], branch.trace.active
        held = across(tracer.tangent(near, active, None))
        point, solved, _ = tracer.chart.solve(near, active, held)
        return point if solved[0] else None


def crosses(low: Array, high: Array, first: Array, last: Array) -> Mask:
    """Whether a segment meets closed boxes (n, d): its parameters between the faces of an axis."""
    step = last - first
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = (low - first) / step, (high - first) / step
    still = step == 0.0
    between_faces = (low <= first) & (first <= high)
    enter = np.where(still, np.where(between_faces, -np.inf, np.inf), np.minimum(one, two))
    leave = np.where(still, np.where(between_faces, np.inf, -np.inf), np.maximum(one, two))
    begin, end = np.maximum(enter.max(axis=1), 0.0), np.minimum(leave.min(axis=1), 1.0)
    return np.asarray(begin <= end)
