"""What the explorer shows of a table, as plain numbers and texts."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from gsp.errors import InvalidInput, expected
from gsp.exploration.sides import Objectives, better_sides, index_column, known_side
from gsp.exploration.space import Space
from gsp.figures.gaps import gap_words
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.indices.table import ARROWS
from gsp.plots.common.tables import column
from gsp.plots.fronts import front_rows, is_log
from gsp.plots.parallels import MOST_PARALLEL, MOST_TEXTS, parallel_lines

# Columns that come last: they have one value for most designs, or say nothing of a value.
LAST = ("rank", "mechanism", "class", "n_legs", "singular", "undefined", "error")
NAME = "design"
# Letters of a text that is shown of a cell.
LETTERS = 200
# Values of a hover label: more do not fit beside a point.
MOST_HOVERED = 14


def content(
    table: pd.DataFrame, objectives: Objectives, columns: Sequence[str], by: str
) -> dict[str, Any]:
    """Return the table with its front and its parallel coordinates.

    Columns and rows are given by their places; numbers that are not finite are None, and stand in
    "odd" as texts.
    """
    sides = better_sides(table, objectives)
    front, knee = front_rows(table, objectives)
    lines = parallel_lines(table, columns, by, sides)
    names, axes = list(table.columns), list(sides)
    order = _ordered(table, [*sides, by, *lines.names])
    return {
        "columns": [_column(table, name, sides) for name in names],
        "names": _names(table),
        "x": names.index(axes[0]),
        "y": names.index(axes[1]),
        "by": names.index(by),
        "objectives": [names.index(name) for name in sides],
        "front": front.tolist(),
        "knee": knee,
        "order": [names.index(name) for name in order],
        "hovered": min(MOST_HOVERED, len(order)),
        "parallel": {
            "columns": [names.index(name) for name in lines.names],
            "rows": lines.rows.tolist(),
            "heights": [_rounded(heights) for heights in lines.heights.T],
            "marks": lines.marks,
        },
    }


def is_number(table: pd.DataFrame, name: Any) -> bool:
    """Return whether a column has real numbers; bools are texts, as in parallel coordinates."""
    kind = table[name].dtype
    kinds = pd.api.types
    return bool(
        kinds.is_numeric_dtype(kind)
        and not kinds.is_bool_dtype(kind)
        and not kinds.is_complex_dtype(kind)
    )


def default_columns(
    table: pd.DataFrame, space: Space | None, objectives: Objectives, by: str
) -> list[str]:
    """Return the parameters of a table, its objectives and the column that colours.

    Without a space the parameters are those that the table records. Texts of too many kinds are
    left out, and parameters for which there is no place.
    """
    found = space.record() if space is not None else table.attrs.get("space")
    parts = [found.get(part) for part in ("ranges", "choices")] if isinstance(found, dict) else []
    named = [name for part in parts if isinstance(part, dict) for name in part]
    rest = list(dict.fromkeys([*better_sides(table, objectives), by]))
    fitting = [
        name
        for name in dict.fromkeys(named)
        if name in table
        and name not in rest
        and (is_number(table, name) or table[name].astype(str).nunique() <= MOST_TEXTS)
    ]
    return [*fitting[: max(MOST_PARALLEL - len(rest), 0)], *rest]


def label(name: Any) -> str:
    """Return the label of a column: "CDN_CL, mean" for condition_number_mean, else its words.

    Examples
    --------
    >>> label("condition_number_mean"), label("platform_radius")
    ('CDN_CL, mean', 'platform radius')
    """
    found = index_column(name) if isinstance(name, str) else None
    return f"{INDICES[found[0]].symbol}, {found[1]}" if found else str(name).replace("_", " ")


def _column(table: pd.DataFrame, name: Any, sides: dict[str, str]) -> dict[str, Any]:
    side = sides.get(name) or (known_side(name) if isinstance(name, str) else None)
    text = label(name)
    shown = {"name": str(name), "label": text, "side": side, "arrow": ARROWS[side] if side else ""}
    if not is_number(table, name):
        return {**shown, "values": [_text(value) for value in table[name]]}
    numbers = column(table, name)
    finite = np.isfinite(numbers)
    odd = {str(place): _odd(numbers[place]) for place in np.flatnonzero(~finite)}
    return {
        **shown,
        "numbers": True,
        "log": is_log(numbers[finite]),
        "values": [x if there else None for x, there in zip(numbers.tolist(), finite, strict=True)],
        "odd": odd,
        "gap": gap_words(text, numbers, "design"),
    }


def _odd(value: float) -> str:
    return "undefined" if np.isnan(value) else "∞" if value > 0 else "−∞"


def _text(value: Any) -> str:
    if value is None or value is pd.NA or value is pd.NaT or (value != value) is True:
        return ""
    text = re.sub(r"\s+", " ", str(value))
    return text if len(text) <= LETTERS else text[: LETTERS - 1] + "…"


def _names(table: pd.DataFrame) -> list[str]:
    """Return what the rows are called: their designs, or the labels of the table's index."""
    if NAME in table:
        return [_text(value) or f"row {place}" for place, value in enumerate(table[NAME])]
    return [f"row {_text(label)}" for label in table.index]


def _ordered(table: pd.DataFrame, first: Sequence[str]) -> list[Any]:
    """Return all columns: chosen ones, those of the user, indices, and what says little."""
    own: list[Any] = []
    indices: list[Any] = []
    last: list[Any] = []
    for name in table.columns:
        text = isinstance(name, str)
        known = text and (index_column(name) or known_side(name))
        group = last if text and name in LAST else indices if known else own
        group.append(name)
    return list(dict.fromkeys(name for name in [*first, *own, *indices, *last] if name != NAME))


def _rounded(values: Array) -> list[float]:
    return [round(value, 9) for value in values.tolist()]


def check_numbers(table: pd.DataFrame, name: str) -> None:
    """Raise InvalidInput if a column has no real numbers."""
    column(table, name)
    if not is_number(table, name):
        got = f"a column of {table[name].dtype}"
        raise InvalidInput(expected(f"table[{name!r}]", "numbers", got))
