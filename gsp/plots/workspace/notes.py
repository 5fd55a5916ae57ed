"""Texts beside places of a picture: they cover neither each other nor the frame."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gsp.figures import INK
from gsp.geometry.vectors import Array, norm
from gsp.plots.common.labels import (
    APART,
    Candidates,
    arrange,
    covered,
    drawn_places,
    settle,
    struck,
    touched,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Bifurcation points up to which each has its label: of more the labels would cover each other.
MOST_LABELS = 60
# Letters of a label up to which it is written beside its point: those of twelve legs. Longer ones,
# which name other limits than strokes, would be as wide as the axes.
MOST_LABEL_LETTERS = 23
# Points: size of the labels of bifurcation points, about the width of a letter of that size, how
# far a label is from its point, and the size of the mark of a bifurcation point.
LABEL_SIZE, NOTE_LETTER_WIDTH, NOTE_DISTANCE, MARK_SIZE = 7.0, 4.4, 4.0, 4.0
# Directions and distances [points] of labels that find no place beside their point, and what the
# next place costs [area in points].
NOTE_DIRECTIONS = np.stack(
    (np.cos(np.arange(16) * np.pi / 8), np.sin(np.arange(16) * np.pi / 8)), axis=-1
)
NOTE_DISTANCES, NEXT_NOTE_COST = (6.0, 12.0, 20.0, 30.0, 42.0, 58.0, 80.0), 0.05
# Of all places of a label, in order, so many are beside its point without a line.
UNJOINED = 4
# What a place costs that is nearer to the point of another label [area in points], and how far from
# its point a label is joined to it by a thin line [points]; what a point of its length costs.
NEARER_COST, JOINED_FROM, LINE_COST = 5.0, 6.5, 0.05
# How bad an area of a label outside of the axes, or on a curve, is, and a point of the length of
# its thin line on a mark, compared with an area in points.
OUTSIDE_COST, CURVE_COST, MARK_COST = 20.0, 0.15, 2.0
# Shares of the length of a curve where its number may be, and how near curves of one number have
# it once [points].
NUMBER_SHARES, ONE_NUMBER = (0.5, 0.35, 0.65, 0.2, 0.8), 40.0


class Note(NamedTuple):
    """A short text beside one of several places of the picture.

    Attributes
    ----------
    text : str
    places : (k, 2) array
        In coordinates of the axes, the preferred first.
    colour : str
    once : float [points]
        Of notes with one text that are nearer than this, only the first is written.
    """

    text: str
    places: Array
    colour: str
    once: float = MARK_SIZE


def label_text(label: str) -> str:
    """Return a label of a bifurcation point or a curve as pictures show it: 1 0 – – 0 1.

    Its spaces stay, as the mark of one joint may have two digits.
    """
    return label.replace("-", "–")


def point_texts(numbers: Sequence[int], labels: Sequence[str]) -> list[str]:
    """Return what is written beside bifurcation points: labels, and numbers where needed."""
    if len(labels) > MOST_LABELS:
        return [f"({number})" for number in numbers]
    times = Counter(labels)
    return [
        f"({number})" if is_long(label) else label if times[label] == 1 else f"{label} ({number})"
        for number, label in zip(numbers, labels, strict=True)
    ]


def is_long(label: str) -> bool:
    """Return whether pictures have the number of a bifurcation point only, not its label."""
    return len(label) > MOST_LABEL_LETTERS


def mark_points(ax: Axes, places: Sequence[Array], labels: Sequence[str]) -> list[Note]:
    """Draw bifurcation points at places (2,); return their labels as notes."""
    if places:
        ax.plot(*np.transpose(places), "o", color=INK, markersize=MARK_SIZE)
    return [Note(label_text(label), p[None], INK) for label, p in zip(labels, places, strict=True)]


def number_note(number: str, flat: Array, colour: str) -> list[Note]:
    """Return the number of a curve beside the middle of its points (N, 2), if it has one."""
    if not number:
        return []
    way = np.concatenate(([0.0], np.cumsum(norm(np.diff(flat, axis=0)))))
    shares = np.multiply(NUMBER_SHARES, way[-1])
    places = np.stack([np.interp(shares, way, x) for x in flat.T], axis=-1)
    return [Note(number, places, colour, ONE_NUMBER)]


def write(ax: Axes, notes: Sequence[Note]) -> None:
    """Write texts beside their places, within the axes; a thin line joins those that are far."""
    if not notes:
        return
    from matplotlib.patheffects import withStroke

    settle(ax)
    anchors = [ax.transData.transform(note.places) * 72.0 / ax.figure.dpi for note in notes]
    kept = _distinct(notes, anchors)
    notes, anchors = [notes[i] for i in kept], [anchors[i] for i in kept]
    options, numbers = _candidates(ax, notes, anchors)
    for i, best in enumerate(arrange(options)):
        note, number = notes[i], numbers[i][best]
        x, y = note.places[number].tolist()
        offset = (options[i].centres[best] - anchors[i][number]).tolist()
        joined = (options[i].ends[best] != options[i].centres[best]).any()
        line = {"arrowstyle": "-", "linewidth": 0.4, "color": note.colour, "shrinkA": 0.0}
        ax.annotate(
            note.text,
            (x, y),
            offset,
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=LABEL_SIZE,
            color=note.colour,
            arrowprops=line if joined else None,
            path_effects=[withStroke(linewidth=2.0, foreground="white")],
        )


def _distinct(notes: Sequence[Note], anchors: Sequence[Array]) -> list[int]:
    """Return the numbers of the notes that are written: near ones with one text once."""
    kept: list[int] = []
    for i, note in enumerate(notes):
        same = [j for j in kept if notes[j].text == note.text]
        if all(norm(anchors[i][0] - anchors[j][0]) >= note.once for j in same):
            kept.append(i)
    return kept


def _candidates(
    ax: Axes, notes: Sequence[Note], anchors: Sequence[Array]
) -> tuple[list[Candidates], list[list[int]]]:
    """Return where each note may be, and at which of its places it is then [points]."""
    frame = ax.transAxes.transform([(0.0, 0.0), (1.0, 1.0)]) * 72.0 / ax.figure.dpi
    frame += APART * np.array([[1.0], [-1.0]])
    points, drawn = np.stack([around[0] for around in anchors]), drawn_places(ax)
    marks = np.concatenate((points - 0.5 * MARK_SIZE, points + 0.5 * MARK_SIZE), axis=1)
    options, numbers = [], []
    for note, own in zip(notes, anchors, strict=True):
        size = _size(note.text)
        offsets = _offsets(size)
        # At the further places only what needs no line.
        order = np.concatenate((np.arange(len(offsets)), *[np.arange(UNJOINED)] * (len(own) - 1)))
        number = np.repeat(np.arange(len(own)), [len(offsets)] + [UNJOINED] * (len(own) - 1))
        centres = own[number] + offsets[order]
        gaps = _gaps(centres - own[number], size)
        ends = np.where((gaps > JOINED_FROM)[:, None], own[number], centres)
        near = _gaps(centres[:, None] - points, size).min(axis=1)
        around = np.concatenate((centres - 0.5 * size, centres + 0.5 * size), axis=1)
        others = marks[(points != own[0]).any(axis=1)]
        costs: Array = NEXT_NOTE_COST * (order + UNJOINED * number).astype(np.float64)
        costs += np.where(near < gaps - APART, NEARER_COST, 0.0)
        costs += LINE_COST * norm(ends - centres)
        costs += OUTSIDE_COST * _outside(around, frame)
        costs += CURVE_COST * covered(centres, size, touched(drawn, around))
        costs += MARK_COST * struck(centres, ends, touched(others, around)).sum(axis=1)
        options.append(Candidates(centres, size, ends, costs))
        numbers.append(number.tolist())
    return options, numbers


def _size(text: str) -> Array:
    """Return width and height of a label [points]."""
    # A space is half as wide as a digit.
    wide = NOTE_LETTER_WIDTH * (len(text) - 0.5 * text.count(" "))
    return np.array((wide + APART, 1.2 * LABEL_SIZE + APART))


def _offsets(size: Array) -> Array:
    """Return where the middle of a label may be from its place, (k, 2), the preferred first."""
    half = 0.5 * size
    beside = NOTE_DISTANCE + half
    sides = [beside * way for way in ((1, 1), (-1, 1), (1, -1), (-1, -1))]
    steps = [sides[i] + (0.0, s * size[1]) for s in (1.0, -1.0, 2.0, -2.0, 3.0) for i in (0, 1)]
    rings = [(half + far) * NOTE_DIRECTIONS for far in NOTE_DISTANCES]
    return np.concatenate((sides, steps, *rings))


def _gaps(away: Array, size: Array) -> Array:
    """Return distances between points and boxes whose centres are so far away, (..., 2)."""
    return np.asarray(norm(np.maximum(np.abs(away) - 0.5 * size, 0.0)))


def _outside(boxes: Array, frame: Array) -> Array:
    """Return the areas of boxes (k, 4) outside of a frame, its two corners."""
    sides = boxes[:, 2:] - boxes[:, :2]
    inside = np.minimum(boxes[:, 2:], frame[1]) - np.maximum(boxes[:, :2], frame[0])
    return np.asarray(sides.prod(axis=1) - np.maximum(inside, 0.0).prod(axis=1))
