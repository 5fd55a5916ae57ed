"""Styles and numbers of curves by label, and texts beside places of a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.figures import INK
from gsp.geometry.vectors import Array, norm
from gsp.plots.common.labels import APART, covered, drawn_places, free_places, settle
from gsp.plots.common.style import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY, INK)
DASHES = ("-", (0, (6, 1.5)), (0, (1.5, 1)), (0, (8, 1.5, 1.5, 1.5)), (0, (3, 3)))
# Points: size of the labels of bifurcation points, about the width of a letter of that size, and
# how far a label is from its point.
LABEL_SIZE, NOTE_LETTER_WIDTH, NOTE_DISTANCE = 7.0, 4.4, 4.0
# Directions and distances [points] of labels that find no place beside their point, and what the
# next place costs [area in points].
NOTE_DIRECTIONS = np.stack(
    (np.cos(np.arange(16) * np.pi / 8), np.sin(np.arange(16) * np.pi / 8)), axis=-1
)
NOTE_DISTANCES, NEXT_NOTE_COST = (6.0, 12.0, 20.0, 30.0, 42.0), 0.05
# What a place costs that is nearer to the point of another label [area in points], and how far from
# its point a label is joined to it by a thin line [points].
NEARER_COST, JOINED_FROM = 5.0, 6.5
# How bad an area of a label outside of the axes, or on a curve, is, compared with an overlap of two
# labels.
OUTSIDE_COST, CURVE_COST = 0.3, 0.15


class CurveStyle(NamedTuple):
    """How curves of one label are drawn: their entry in the legend, and their number or ""."""

    colour: str
    dash: Any
    entry: str
    number: str


def curve_styles(labels: Sequence[str]) -> dict[str, CurveStyle]:
    """Return the styles of labels; with numbers where colours alone do not distinguish them."""
    unique = list(dict.fromkeys(labels))
    n = len(COLOURS)
    styles = {}
    for i, text in enumerate(unique):
        number = str(i + 1) if len(unique) > n else ""
        colour, dash = COLOURS[i % n], DASHES[i // n % len(DASHES)]
        styles[text] = CurveStyle(colour, dash, f"{number}  [{text}]".lstrip(), number)
    return styles


def label_text(label: str) -> str:
    """Return a label of a bifurcation point or a curve as pictures show it: 1 0 – – 0 1.

    Its spaces stay, as the mark of one joint may have two digits.
    """
    return label.replace("-", "–")


class Note(NamedTuple):
    """A short text beside a place of the picture."""

    text: str
    place: Array
    colour: str


def mark_points(ax: Axes, places: Sequence[Array], labels: Sequence[str]) -> list[Note]:
    """Draw bifurcation points at places (2,); return their labels as notes."""
    if places:
        ax.plot(*np.transpose(places), "o", color=INK, markersize=4)
    return [Note(label_text(label), p, INK) for label, p in zip(labels, places, strict=True)]


def write(ax: Axes, notes: Sequence[Note]) -> None:
    """Write texts beside their places."""
    if not notes:
        return
    from matplotlib.patheffects import withStroke

    places = np.array([note.place for note in notes])
    offsets = label_offsets(ax, places, [note.text for note in notes])
    sizes = _sizes([note.text for note in notes])
    far = _gaps(np.array(offsets) + 0.5 * sizes, sizes) > JOINED_FROM
    for note, offset, joined in zip(notes, offsets, far, strict=True):
        line = {"arrowstyle": "-", "linewidth": 0.4, "color": note.colour, "shrinkA": 0.0}
        ax.annotate(
            note.text,
            (note.place[0], note.place[1]),
            offset,
            textcoords="offset points",
            fontsize=LABEL_SIZE,
            color=note.colour,
            arrowprops=line if joined else None,
            path_effects=[withStroke(linewidth=2.0, foreground="white")],
        )


def _sizes(texts: Sequence[str]) -> Array:
    """Return widths and heights of labels, (n, 2) [points]."""
    # A space is half as wide as a digit.
    letters = np.array([len(text) - 0.5 * text.count(" ") for text in texts])
    wide = NOTE_LETTER_WIDTH * letters + APART
    return np.stack((wide, np.full(len(texts), 1.2 * LABEL_SIZE + APART)), axis=-1)


def _gaps(away: Array, size: Array) -> Array:
    """Return distances between points and boxes whose centres are so far away, (..., 2)."""
    return np.asarray(norm(np.maximum(np.abs(away) - 0.5 * size, 0.0)))


def label_offsets(ax: Axes, places: Array, texts: Sequence[str]) -> list[tuple[float, float]]:
    """Return where labels go from their points [points]: with little overlap, within the axes.

    They avoid each other, the curves and marks that are drawn, and points of other labels.
    """
    settle(ax)
    anchors = ax.transData.transform(places) * 72.0 / ax.figure.dpi
    tall, sizes = LABEL_SIZE, _sizes(texts)
    corners, centres = [], []
    for anchor, (wide, high) in zip(anchors, sizes, strict=True):
        sides = [
            (x, y)
            for y in (NOTE_DISTANCE, -NOTE_DISTANCE - tall)
            for x in (NOTE_DISTANCE, -NOTE_DISTANCE - wide)
        ]
        sides += [(x, y + s * high) for s in (1.0, -1.0, 2.0, -2.0, 3.0) for x, y in sides[:2]]
        half = 0.5 * np.array((wide, high))
        corners.append(
            np.concatenate(
                (sides, *((half + far) * NOTE_DIRECTIONS - half for far in NOTE_DISTANCES))
            )
        )
        centres.append(corners[-1] + anchor + (0.5 * wide, 0.5 * high))
    frame = ax.transAxes.transform([(0.0, 0.0), (1.0, 1.0)]) * 72.0 / ax.figure.dpi
    costs, drawn = [], drawn_places(ax)
    for around, size, own in zip(centres, sizes, anchors, strict=True):
        ends = np.minimum(around + 0.5 * size, frame[1])
        starts = np.maximum(around - 0.5 * size, frame[0])
        inside = np.maximum(ends - starts, 0.0).prod(axis=1)
        cost = NEXT_NOTE_COST * np.arange(len(around))
        gaps = _gaps(around[:, None] - anchors, size).min(axis=1)
        cost += NEARER_COST * (gaps < _gaps(around - own, size) - APART)
        cost += CURVE_COST * covered(around, size, drawn)
        costs.append(OUTSIDE_COST * (size.prod() - inside) + cost)
    chosen = free_places(centres, sizes, np.empty((0, 4)), costs)
    offsets = np.array(chosen) - anchors - 0.5 * sizes
    return [(float(x), float(y)) for x, y in offsets]
