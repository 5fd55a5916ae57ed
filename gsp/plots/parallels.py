"""Pictures of tables: parallel coordinates."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from gsp import arguments
from gsp.checks import check_items
from gsp.errors import InvalidInput, brief, expected
from gsp.exploration.sides import known_side, stated_sides
from gsp.figures import style
from gsp.geometry.vectors import Array
from gsp.indices.table import ARROWS
from gsp.plots.common.style import axes_or_new, plain
from gsp.plots.common.tables import check_frame, column
from gsp.plots.fronts import Places, is_log, label_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Marks of an axis: heights in [0, 1] and texts.
Marks = list[tuple[float, str]]
# More columns than this do not fit side by side.
MOST_PARALLEL = 12
# Inches per column of parallel coordinates.
COLUMN_WIDTH = 1.25
# Letters of a line below an axis.
LABEL_LETTERS = 18
# More texts than this do not fit along one axis.
MOST_TEXTS = 12


def parallel(
    table: pd.DataFrame,
    columns: Sequence[str],
    by: str = "score",
    ax: Axes | None = None,
    *,
    better: Mapping[str, str] | None = None,
) -> Axes:
    """Return axes with parallel coordinates: one line per design, one vertical axis per column.

    Each axis has its own scale, with the least and the greatest value, logarithmic as in
    `gsp.plots.ranking` where all values are positive and span much. Where lower is better it is
    reversed, so that better is always up. Lines are coloured by one column, the best on top.

    Parameters
    ----------
    table : pandas.DataFrame
        Such as of `gsp.exploration.explore`.
    columns : sequence of str
        From 2 to 12 columns of numbers, bools or texts.
    by : str
        The column of numbers that colours the lines.
    ax : matplotlib Axes, optional
    better : mapping of names to "lower" or "higher", optional
        The better sides of columns of your own; those of indices are known, and can be turned.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        On what is not a table, columns that it does not have, more than 12 different texts of a
        column, other sides, or if no row has a number in all columns.
    MissingSoftware
        Without matplotlib.
    """
    by = arguments.text("by", by)
    lines = parallel_lines(table, columns, by, {} if better is None else better)
    shades = column(table, by)[lines.rows]
    with style():
        ax = axes_or_new(ax, COLUMN_WIDTH * (len(lines.names) + 1), 4.0)
        _draw(ax, lines, shades, by)
        return ax


@dataclass(frozen=True, eq=False, kw_only=True)
class ParallelLines:
    """Lines of parallel coordinates.

    Attributes
    ----------
    names : list of str
        Of the columns.
    sides : list of "lower", "higher" or None
        The better sides of the columns, None where they are not known.
    rows : (m,) array of int
        Places of the rows that have a line, the best last.
    heights : (m, number of columns) array
        In [0, 1], better values above.
    marks : list of lists of (height, text), one per column
    """

    names: list[str]
    sides: list[str | None]
    rows: Places
    heights: Array
    marks: list[Marks]


def parallel_lines(
    table: pd.DataFrame, columns: Sequence[str], by: str, better: Mapping[str, str]
) -> ParallelLines:
    """Return the lines of `parallel`.

    Raises
    ------
    InvalidInput
        See `parallel`.
    """
    check_frame("table", table)
    names = [
        arguments.text("columns", name)
        for name in check_items("columns", columns, "names of columns")
    ]
    if not 2 <= len(names) <= MOST_PARALLEL:
        raise InvalidInput(expected("columns", f"from 2 to {MOST_PARALLEL} columns", len(names)))
    by = arguments.text("by", by)
    shades = column(table, by)
    stated = stated_sides(table, better)
    sides = [stated.get(name) or known_side(name) for name in names]
    axes = [_scaled(table, name, side) for name, side in zip(names, sides, strict=True)]
    heights = np.stack([axis[0] for axis in axes], axis=1)
    there = np.flatnonzero(np.isfinite(heights).all(axis=1) & np.isfinite(shades))
    if not there.size:
        raise InvalidInput(expected("table", "a row with numbers in all columns", "none"))
    sign = -1.0 if (stated.get(by) or known_side(by)) == "lower" else 1.0
    there = there[np.argsort(sign * shades[there], kind="stable")]
    marks = [axis[1] for axis in axes]
    return ParallelLines(names=names, sides=sides, rows=there, heights=heights[there], marks=marks)


def _draw(ax: Axes, lines: ParallelLines, shades: Array, by: str) -> None:
    from matplotlib.collections import LineCollection

    places = list(range(len(lines.names)))
    ends = [np.column_stack((places, row)) for row in lines.heights]
    drawn = LineCollection(ends, array=shades, cmap="viridis", linewidths=0.9, alpha=0.8)
    ax.add_collection(drawn)
    for place, marks in zip(places, lines.marks, strict=True):
        ax.axvline(place, color="black", linewidth=0.8, zorder=3)
        for height, text in marks:
            ax.annotate(
                plain(_short(text)), (place, height), (3, 0), textcoords="offset points",
                fontsize=7, va="center", zorder=4,
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.8},
            )  # fmt: skip
    ax.set_xlim(-0.15, places[-1] + 0.45)
    ax.set_ylim(-0.06, 1.06)
    texts = [
        f"{label_of(name)} {ARROWS[side]}" if side else label_of(name)
        for name, side in zip(lines.names, lines.sides, strict=True)
    ]
    ax.set_xticks(places, [_lines_of(text) for text in texts], fontsize=8)
    ax.set_yticks([])
    ax.grid(visible=False)
    for spine in ax.spines.values():
        spine.set_visible(False)
    ax.figure.colorbar(drawn, ax=ax, label=label_of(by), pad=0.02)


def _short(text: str) -> str:
    """Return a text of at most `LABEL_LETTERS` letters, with its beginning and its end."""
    half = LABEL_LETTERS // 2
    return text if len(text) <= LABEL_LETTERS else f"{text[: half - 1]}…{text[-half:]}"


def _lines_of(text: str) -> str:
    """Return a label in lines that fit between two axes; symbols stay whole."""
    parts = text.split(", ") if "$" in text else textwrap.wrap(text, LABEL_LETTERS)
    return (",\n" if "$" in text else "\n").join(parts)


def _scaled(table: pd.DataFrame, name: str, side: str | None) -> tuple[Array, Marks]:
    """Return the heights of a column in [0, 1], the better side above, and its marks."""
    if name not in table:
        raise InvalidInput(expected("columns", "columns of the table", brief(name)))
    values: Any = table[name]
    if values.dtype == bool or not pd.api.types.is_numeric_dtype(values):
        heights, marks = _of_texts(name, [str(value) for value in values])
    else:
        heights, marks = _of_numbers(column(table, name))
    if side == "lower":
        return 1.0 - heights, [(1.0 - height, text) for height, text in marks]
    return heights, marks


def _of_texts(name: str, values: Sequence[str]) -> tuple[Array, Marks]:
    texts = sorted(set(values))
    if len(texts) > MOST_TEXTS:
        wanted = f"at most {MOST_TEXTS} different texts"
        raise InvalidInput(expected(f"column {name}", wanted, len(texts)))
    places = np.linspace(0.0, 1.0, len(texts)).tolist()
    heights = dict(zip(texts, places, strict=True))
    marks = [(height, text) for text, height in heights.items()]
    return np.array([heights[value] for value in values]), marks


def _of_numbers(numbers: Array) -> tuple[Array, Marks]:
    finite = numbers[np.isfinite(numbers)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    digits = next((n for n in range(4, 17) if f"{low:.{n}g}" != f"{high:.{n}g}"), 4)
    marks = [(0.0, f"{low:.{digits}g}"), (1.0, f"{high:.{digits}g}")]
    if is_log(finite):
        numbers, low, high = np.log(numbers), float(np.log(low)), float(np.log(high))
    width = 0.5 * high - 0.5 * low or 1.0  # of halves, whose differences are numbers
    return np.asarray((0.5 * numbers - 0.5 * low) / width), marks
