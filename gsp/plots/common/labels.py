"""Places of labels that do not cover each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.geometry.vectors import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D

# How many points apart texts in space are, and what the next candidate costs [area in points].
APART, NEXT_PLACE_COST = 1.5, 0.5
# Squares that lines cover [points], and how many of them a straight part has at most.
LINE_STEP, MOST_STEPS = 2.0, 2000
# How bad an area where two labels overlap is, and a point of the length of a line across a label,
# compared with the costs of places; how often all labels are placed anew.
OVERLAP_COST, STRUCK_COST, ROUNDS = 4.0, 12.0, 6
# A place that is far from every picture [points].
AWAY = -1e6


class Candidates(NamedTuple):
    """Where a label may be, and the thin line that then joins it to its place.

    Attributes
    ----------
    centres : (k, 2) array [points]
        The preferred first.
    size : (2,) array [points]
    ends : (k, 2) array [points]
        Where the line ends that begins in the centre; the centre where there is none.
    costs : (k,) array [area in points]
    """

    centres: Array
    size: Array
    ends: Array
    costs: Array


def arrange(labels: Sequence[Candidates]) -> list[int]:
    """Return which candidate each label takes, so that texts and lines avoid each other's texts.

    In turn, each takes the best as the others are; again until none changes.
    """
    boxes = np.full((len(labels), 4), AWAY)
    lines = np.full((len(labels), 2, 2), AWAY)
    chosen = [-1] * len(labels)
    for _ in range(ROUNDS):
        before = list(chosen)
        for i, (centres, size, ends, costs) in enumerate(labels):
            boxes[i], lines[i] = AWAY, AWAY
            around = np.concatenate((centres - 0.5 * size, centres + 0.5 * size), axis=1)
            others = touched(boxes, around)
            cost = costs + OVERLAP_COST * covered(centres, size, others)
            cost += STRUCK_COST * struck(centres, ends, others).sum(axis=1)
            crossing = lines[(lines[:, 0] != lines[:, 1]).any(axis=1)]
            cost += STRUCK_COST * struck(crossing[:, 0], crossing[:, 1], around).sum(axis=0)
            chosen[i] = int(cost.argmin())
            boxes[i], lines[i] = around[chosen[i]], (centres[chosen[i]], ends[chosen[i]])
        if chosen == before:
            break
    return chosen


def touched(boxes: Array, places: Array) -> Array:
    """Return those of the boxes (m, 4) that are within the extent of others (k, 4)."""
    low, high = places[:, :2].min(axis=0), places[:, 2:].max(axis=0)
    return np.asarray(boxes[(boxes[:, 2:] > low).all(axis=1) & (boxes[:, :2] < high).all(axis=1)])


def struck(starts: Array, ends: Array, boxes: Array) -> Array:
    """Return the lengths of straight lines (k, 2) within boxes (m, 4), shape (k, m)."""
    along = ends - starts
    enter, leave = np.zeros((len(along), len(boxes))), np.ones((len(along), len(boxes)))
    # One coordinate after the other, as numpy takes long for the least of two numbers in a row.
    for axis in (0, 1):
        start, slope = starts[:, axis, None], along[:, axis, None]
        # Lines along an axis as nearly so, which spares cases of their own.
        slope = np.where(slope == 0.0, 1e-9, slope)
        one, other = (boxes[:, axis] - start) / slope, (boxes[:, 2 + axis] - start) / slope
        np.maximum(enter, np.minimum(one, other), out=enter)
        np.minimum(leave, np.maximum(one, other), out=leave)
    return np.asarray(np.maximum(leave - enter, 0.0) * np.hypot(*along.T)[:, None])


def free_places(
    candidates: Sequence[Array], sizes: Array, taken: Array, costs: Sequence[Array]
) -> list[Array]:
    """Return the centres of labels, each chosen from its candidates, in turn.

    The first of those with the least sum of overlaps with what is there already and of its cost.

    Parameters
    ----------
    candidates : n arrays (k, 2) [any length]
        Centres, the preferred ones first.
    sizes : (n, 2) array [the same]
        Width and height of the labels.
    taken : (m, 4) array [the same]
        Boxes to avoid: left, bottom, right, top.
    costs : n arrays (k,) [its square]
        Of each candidate, compared with areas of overlap.
    """
    found = []
    for places, size, cost in zip(candidates, sizes, costs, strict=True):
        best = int((covered(places, size, taken) + cost).argmin())
        box = np.concatenate((places[best] - 0.5 * size, places[best] + 0.5 * size))
        taken = np.concatenate((taken, box[None]))
        found.append(places[best])
    return found


def covered(places: Array, size: Array, taken: Array) -> Array:
    """Return the areas that boxes of a size at places (k, 2) have in common with others, (k,).

    Summed over the others, (m, 4) as of `free_places`.
    """
    areas = np.ones((len(places), len(taken)))
    for axis in (0, 1):  # as in `struck`
        ends = np.minimum((places + 0.5 * size)[:, axis, None], taken[:, 2 + axis])
        starts = np.maximum((places - 0.5 * size)[:, axis, None], taken[:, axis])
        areas *= np.maximum(ends - starts, 0.0)
    return np.asarray(areas.sum(axis=-1))


def drawn_places(ax: Axes) -> Array:
    """Return boxes that lines and marks of plane axes cover, (m, 4) [points], for `free_places`.

    A line covers squares of a grid, once where lines cover each other. Texts are not counted.
    """
    per_point = ax.figure.dpi / 72.0
    squares, marks = [np.empty((0, 2))], [np.empty((0, 4))]
    for line in ax.lines:
        if line.get_transform() != ax.transData:
            continue
        path = np.asarray(ax.transData.transform(line.get_xydata())) / per_point
        if line.get_marker() not in ("None", "", None):
            half = 0.5 * float(line.get_markersize())
            marks.append(np.concatenate((path - half, path + half), axis=1))
        if line.get_linestyle() != "None":
            squares.append(np.floor(_steps(path) / LINE_STEP))
    cells = LINE_STEP * np.unique(np.concatenate(squares), axis=0)
    boxes = np.concatenate((*marks, np.concatenate((cells, cells + LINE_STEP), axis=1)))
    return np.asarray(boxes[np.isfinite(boxes).all(axis=1)])


def _steps(path: Array) -> Array:
    """Return points along a path (n, 2), at most LINE_STEP apart; parts with NaN are left out."""
    starts, ends = path[:-1], path[1:]
    known = np.isfinite(starts).all(axis=1) & np.isfinite(ends).all(axis=1)
    starts, ends = starts[known], ends[known]
    lengths = np.hypot(*(ends - starts).T)
    counts = np.minimum(np.ceil(lengths / LINE_STEP), MOST_STEPS).astype(int) + 1
    part = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    share = (part / np.repeat(np.maximum(counts - 1, 1), counts))[:, None]
    first = np.repeat(starts, counts, axis=0)
    return np.asarray(first + share * (np.repeat(ends, counts, axis=0) - first))


def settle(ax: Axes) -> None:
    """Give axes the place that they have when the figure is drawn, so that labels can be placed.

    Legend and title have to be there.
    """
    figure = ax.figure.canvas.figure
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
    ax.apply_aspect()


class SpaceNote(NamedTuple):
    """A short text at one of several places in space (k, 3), the preferred first."""

    text: str
    places: Array
    style: Mapping[str, Any]


def write_in_space(ax: Axes3D, notes: Sequence[SpaceNote]) -> None:
    """Write texts where, as seen now, they do not cover each other or the legend.

    The limits of the axes and the legend have to be set before.
    """
    from mpl_toolkits.mplot3d.proj3d import proj_transform

    settle(ax)
    per_point, view = ax.figure.dpi / 72.0, ax.get_proj()
    texts = [
        ax.text(*note.places[0], note.text, ha="center", va="center", **note.style)
        for note in notes
    ]
    sizes = []
    for text in texts:
        patch = text.get_bbox_patch()
        if patch is not None:
            text.update_bbox_position_size(ax.figure._get_renderer())
        sizes.append((text if patch is None else patch).get_window_extent().size)
    legend = ax.get_legend()
    taken = [] if legend is None else [legend.get_window_extent().extents / per_point]
    candidates = []
    for note in notes:
        x, y, _ = proj_transform(*note.places.T, view)
        seen = ax.transData.transform(np.stack((x, y), axis=-1))
        candidates.append(np.asarray(seen) / per_point)
    costs = [
        np.asarray(NEXT_PLACE_COST * np.arange(len(places)), dtype=np.float64)
        for places in candidates
    ]
    wide = np.array(sizes) / per_point + APART
    found = free_places(candidates, wide, np.array(taken).reshape(-1, 4), costs)
    for text, note, places, best in zip(texts, notes, candidates, found, strict=True):
        chosen = int(np.flatnonzero((places == best).all(axis=1))[0])
        text.set_position_3d(note.places[chosen])
