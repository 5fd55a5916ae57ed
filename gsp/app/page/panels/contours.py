"""Contour lines of values on a grid, with places for their labels.

The extra `app` is without matplotlib, by which `gsp.plots` draws contours.
"""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array

# About how many lines a plot has, and the share of it beside its frame that labels keep clear.
MOST_LINES, CLEAR_OF_FRAME = 6, 0.1

Corner = tuple[int, int]
Edge = tuple[Corner, Corner]


def round_levels(low: float, high: float) -> list[float]:
    """Return round numbers between two values, at most `MOST_LINES` + 1; none where low ≥ high.

    >>> round_levels(0.13, 0.62)
    [0.2, 0.3, 0.4, 0.5, 0.6]
    """
    least = (high - low) / MOST_LINES
    if not least > 0.0:
        return []
    power = 10.0 ** np.floor(np.log10(least))
    step = next(m * power for m in (1.0, 2.0, 2.5, 5.0, 10.0) if m * power >= least)
    counts = np.arange(np.ceil(low / step), np.floor(high / step) + 1.0)
    return [float(f"{count * step:.6g}") for count in counts]


def contour(values: Array, level: float) -> list[Array]:
    """Return the lines on which values on a grid have a level, by linear interpolation.

    Parameters
    ----------
    values : (n, m) array
        No line passes a cell with a corner that is not finite.
    level : float

    Returns
    -------
    list of (k, 2) arrays
        Points of lines, in steps of the grid: [i, j] is the place of values[i, j]. The first and
        the last point of a closed line are equal.
    """
    links = _links(values, level)
    lines = []
    while links:
        start = next((edge for edge, others in links.items() if len(others) == 1), None)
        path = [start or next(iter(links))]
        while others := links[path[-1]]:
            path.append(others.pop())
            links[path[-1]].remove(path[-2])
        links = {edge: others for edge, others in links.items() if others}
        lines.append(np.array([_crossing(values, edge, level) for edge in path]))
    return lines


def _links(values: Array, level: float) -> dict[Edge, list[Edge]]:
    """Return which edges of the grid a line connects through a cell."""
    above = values > level
    cells = [slice(None, -1), slice(1, None)]
    corners = np.array([above[a, b] for a in cells for b in cells])
    known = np.all([np.isfinite(values[a, b]) for a in cells for b in cells], axis=0)
    links: dict[Edge, list[Edge]] = {}
    for i, j in np.argwhere(known & corners.any(axis=0) & ~corners.all(axis=0)).tolist():
        around = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        sides = [(around[k], around[(k + 1) % 4]) for k in range(4)]
        crossed = [(min(side), max(side)) for side in sides if above[side[0]] != above[side[1]]]
        if len(crossed) == 4:  # a saddle: the side of its middle is connected
            middle = np.mean([values[corner] for corner in around]) > level
            if middle != above[i, j]:
                crossed = crossed[3:] + crossed[:3]
        for one, other in zip(crossed[::2], crossed[1::2], strict=True):
            links.setdefault(one, []).append(other)
            links.setdefault(other, []).append(one)
    return links


def _crossing(values: Array, edge: Edge, level: float) -> Array:
    first, last = edge
    share = (level - values[first]) / (values[last] - values[first])
    point: Array = np.array(first) + share * (np.array(last) - np.array(first))
    return point


def label_place(lines: list[Array], shape: tuple[int, int], taken: list[Array]) -> Array | None:
    """Return the point of lines that is farthest from those taken; None where all are at the frame.

    Parameters
    ----------
    lines : list of (k, 2) arrays
        As `contour` returns them.
    shape : (n, m)
        Of the grid.
    taken : list of (2,) arrays
        At least one.
    """
    ends = np.array(shape) - 1.0
    points = np.concatenate([*lines, np.empty((0, 2))])
    shares = points / ends
    points = points[((shares > CLEAR_OF_FRAME) & (shares < 1.0 - CLEAR_OF_FRAME)).all(axis=1)]
    if not len(points):
        return None
    away = np.linalg.norm(points[:, None] - np.array(taken), axis=2).min(axis=1)
    place: Array = points[away.argmax()]
    return place
