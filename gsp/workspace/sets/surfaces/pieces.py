"""What is proven inside of a region in space, as convex pieces on one grid."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from gsp.geometry.vectors import Array, Mask, norm
from gsp.workspace.sets.codes import INSIDE, Numbers
from gsp.workspace.sets.tree.boxes import CORNERS

# Planes of cells that agree to this, as a share of the size of the region, are one: halves of a
# cell keep its plane.
SAME_PLANE = 1e-9


class Pieces(NamedTuple):
    """Boxes, each whole or with the part of it that is above a plane.

    Attributes
    ----------
    start, step : (3,) arrays [length; of orientations rad]
        Least coordinates of the grid, and the sides of its cells.
    extent : (3,) int array
        Cells of the grid along each axis.
    first, last : (n, 3) int arrays
        Least and greatest coordinates of the boxes, in cells of the grid.
    plane : (n,) int array
        The plane of each box, −1 if it is whole.
    planes : (m, 4) array [1, length]
        n and d of the planes: n · q > d is above, with q from `start`.
    """

    start: Array
    step: Array
    extent: Numbers
    first: Numbers
    last: Numbers
    plane: Numbers
    planes: Array

    def heights(self, plane: Numbers, points: Any) -> Array:
        """Return how far points (..., 3) of the grid are above planes (...) [length].

        The sums are rounded in one order, so that along each axis they grow, or fall, everywhere:
        along a line of the grid the sign changes no more than once.
        """
        q, (a, b, c, d) = points * self.step, np.moveaxis(self.planes[plane], -1, 0)
        return np.asarray(((a * q[..., 0] + b * q[..., 1]) + c * q[..., 2]) - d)

    def above(self, plane: Numbers, points: Any) -> Mask:
        """Return which points (..., 3) of the grid are above planes (...); all are above −1."""
        if not len(self.planes):
            return np.ones(np.shape(points)[:-1], dtype=np.bool_)
        return np.asarray((plane < 0) | (self.heights(plane, points) > 0.0))


def pieces(region: Any) -> Pieces:
    """Return the inside cells of a region in space, and the inside parts of undecided ones."""
    settled = region.codes == INSIDE
    some = settled | (region.cuts[:, 7] < np.inf)
    start, width = region.domain[0], region.domain[1] - region.domain[0]
    some &= bool((width > 0.0).all())
    low, high = region.low[some], region.high[some]
    with np.errstate(divide="ignore", invalid="ignore"):
        halvings = np.rint(np.log2(width / (high - low))).astype(np.int64)
    deepest = halvings.max(axis=0, initial=0)
    count = np.int64(1) << deepest
    step = width / count
    first = np.rint((low - start) / step).astype(np.int64)
    last = first + (np.int64(1) << (deepest - halvings))
    planes, plane = _planes(
        region.cuts[some, 4:], 0.5 * (first + last) * step, settled[some], float(width.max())
    )
    found = Pieces(start, step, count, *_in_one_order(first, last, halvings, plane), planes)
    return _with_volume(found)


def _planes(cuts: Array, middle: Array, whole: Mask, size: float) -> tuple[Array, Numbers]:
    """Return planes n · q > d, those that are the same once, and which one each box has."""
    length = norm(cuts[:, :3])
    # A part without a normal is all of the cell, or nothing.
    whole = whole | (cuts[:, 3] == -np.inf) | ((length == 0.0) & (cuts[:, 3] < 0.0))
    plane = np.full(len(cuts), -1)
    normal = cuts[~whole, :3] / np.where(length > 0.0, length, 1.0)[~whole, None]
    away = cuts[~whole, 3] / np.where(length > 0.0, length, 1.0)[~whole]
    found = np.column_stack((normal, away + (normal * middle[~whole]).sum(axis=1)))
    scaled = found / (SAME_PLANE * np.array([1.0, 1.0, 1.0, size]))
    which = numbered(scaled)
    # Of planes that are one, the one with the least above it.
    chosen = np.lexsort((-found[:, 3], which))
    chosen = chosen[np.unique(which[chosen], return_index=True)[1]]
    plane[~whole] = which
    return found[chosen], plane


def numbered_rows(rows: Array | Numbers) -> Numbers:
    """Return a number for each row (n, d), the same for equal ones."""
    number = np.zeros(len(rows), dtype=np.int64)
    for column in rows.T:
        values, here = np.unique(column, return_inverse=True)
        number = np.unique(number * len(values) + here, return_inverse=True)[1]
    return number


def numbered(rows: Array) -> Numbers:
    """Return a number for each row (n, d), the same for rows that differ by much less than 1.

    Rows are in one cell of a grid, or of one that is shifted by a half.
    """
    first, second = (numbered_rows(np.floor(rows + s)) for s in (0.0, 0.5))
    m = first.max(initial=-1) + 1
    links = coo_array(
        (np.ones(len(rows)), (first, m + second)), shape=(m + second.max(initial=-1) + 1,) * 2
    )
    return np.asarray(connected_components(links, directed=False)[1][first], dtype=np.int64)


def _in_one_order(
    first: Numbers, last: Numbers, halvings: Numbers, plane: Numbers
) -> tuple[Numbers, Numbers, Numbers]:
    """Divide boxes so that of any two sizes one is at least as long as the other in all axes.

    Halving along the longest side does that already, but for sides that are equal to rounding.
    """
    sizes, which = np.unique(halvings, axis=0, return_inverse=True)
    order = np.argsort(sizes.sum(axis=1), kind="stable")
    wanted = np.empty_like(sizes)
    wanted[order] = np.maximum.accumulate(sizes[order], axis=0)
    rest = (wanted - sizes)[which.reshape(-1)]
    for k in range(3):
        while (rest[:, k] > 0).any():
            divided = rest[:, k] > 0
            rest[divided, k] -= 1
            middle = (first[divided, k] + last[divided, k]) // 2
            near, far = last.copy(), first[divided].copy()
            near[divided, k] = far[:, k] = middle
            first, last = np.concatenate((first, far)), np.concatenate((near, last[divided]))
            plane = np.concatenate((plane, plane[divided]))
            rest = np.concatenate((rest, rest[divided]))
    return first, last, plane


def _with_volume(given: Pieces) -> Pieces:
    """Leave out boxes of which nothing is above their plane; those that all is above are whole."""
    corners = np.where(CORNERS, given.last[:, None], given.first[:, None])
    above: NDArray[np.bool_] = given.above(given.plane[:, None], corners)
    some = above.any(axis=1)
    plane = np.where(above.all(axis=1), -1, given.plane)
    return given._replace(first=given.first[some], last=given.last[some], plane=plane[some])
