"""Compiled: which boxes are connected, as they touch one after the other.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

import gsp.kernels.compiled  # noqa: F401, which logs the first compilation
from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import Numbers

# Boxes of a leaf of the tree.
BOXES_PER_LEAF = 8
# Nodes that wait at once: one per level and one more.
DEEPEST_TREE = 64


@njit(error_model="numpy", nogil=True)
def _root(parent: Numbers, i: int) -> int:
    """Return the first box of the part of a box so far, and shorten the way to it."""
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@njit(error_model="numpy", nogil=True)
def _touch(
    low: Array, high: Array, other_low: Array, other_high: Array, turn: Array, near: Array
) -> bool:
    """Whether two closed boxes touch: along each axis their intervals do, after some turns."""
    for k in range(len(low)):
        gap, reach = other_low[k] - high[k], low[k] - other_high[k]
        if turn[k] > 0.0:
            # The last image of the other box that begins before the end of this one, or at it.
            whole = np.ceil((gap - near[k]) / turn[k]) * turn[k]
            gap, reach = gap - whole, reach + whole
        if gap > near[k] or reach > near[k]:
            return False
    return True


@njit(error_model="numpy", nogil=True)
def _widest(low: Array, high: Array, some: Numbers) -> int:
    """Return the axis along which boxes are the most apart, in widths of a box."""
    best, axis = -1.0, 0
    for k in range(low.shape[1]):
        least, most, wide = np.inf, -np.inf, 0.0
        for i in some:
            middle = 0.5 * (low[i, k] + high[i, k])
            least, most = min(least, middle), max(most, middle)
            wide += high[i, k] - low[i, k]
        apart = (most - least) * len(some) / max(wide, 1e-300)
        if apart > best:
            best, axis = apart, k
    return axis


@njit(error_model="numpy", nogil=True)
def _tree(low: Array, high: Array) -> Any:
    """Divide boxes at medians until few are left.

    Returns the order of the boxes, their bounds in each node, (m, d) each, and first box, end and
    first child of each node, (m, 3); the second child follows the first, and leaves have 0.
    """
    n, d = low.shape
    order = np.arange(n)
    most = 4 * (n // BOXES_PER_LEAF) + 3
    least, greatest = np.full((most, d), np.inf), np.full((most, d), -np.inf)
    nodes = np.zeros((most, 3), dtype=np.int64)
    nodes[0, 1] = n
    count, at = 1, 0
    while at < count:
        first, end = nodes[at, 0], nodes[at, 1]
        some = order[first:end].copy()
        for i in some:
            for k in range(d):
                least[at, k] = min(least[at, k], low[i, k])
                greatest[at, k] = max(greatest[at, k], high[i, k])
        if end - first > BOXES_PER_LEAF:
            axis = _widest(low, high, some)
            order[first:end] = some[np.argsort(low[some, axis] + high[some, axis])]
            middle = (first + end) // 2
            nodes[at, 2] = count
            nodes[count, 0], nodes[count, 1] = first, middle
            nodes[count + 1, 0], nodes[count + 1, 1] = middle, end
            count += 2
        at += 1
    return order, least[:count], greatest[:count], nodes[:count]


# Cached, as all of it is in this file: numba's cache depends only on the file of its function.
@njit(error_model="numpy", nogil=True, cache=True)
def connect(low: Array, high: Array, turn: Array, near: Array, parent: Numbers) -> None:
    """Join the parts of boxes that touch, in place.

    Parameters
    ----------
    low, high : (n, d) arrays
        Closed boxes.
    turn : (d,) array
        Length after which a coordinate repeats, 0 if it does not.
    near : (d,) array
        How far apart boxes may be that touch.
    parent : (n,) int array
        Of each box one of the same part that is not after it; those of a part lead to one.
    """
    order, least, greatest, nodes = _tree(low, high)
    waiting = np.empty(DEEPEST_TREE, dtype=np.int64)
    for i in range(len(low)):
        waiting[0], count = 0, 1
        while count:
            count -= 1
            at = waiting[count]
            if not _touch(low[i], high[i], least[at], greatest[at], turn, near):
                continue
            if nodes[at, 2]:
                waiting[count], waiting[count + 1] = nodes[at, 2], nodes[at, 2] + 1
                count += 2
                continue
            for j in order[nodes[at, 0] : nodes[at, 1]]:
                one, two = _root(parent, i), _root(parent, j)
                if one != two and _touch(low[i], high[i], low[j], high[j], turn, near):
                    parent[max(one, two)] = min(one, two)
    for i in range(len(parent)):
        parent[i] = _root(parent, i)
