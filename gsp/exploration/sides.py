"""Which side of the columns of a table is better: known ones of indices, and stated ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from gsp import arguments
from gsp.checks import check_items, is_a
from gsp.errors import InvalidInput, brief, expected
from gsp.exploration.proving import FOUND, PROVEN
from gsp.exploration.task import HIGH, LOW, WORKSPACES
from gsp.indices import INDICES
from gsp.ranking.tables import STATISTICS

if TYPE_CHECKING:
    import pandas as pd

DIRECTIONS = ("higher", "lower")
# Columns of tables that are not of an index, and which side is better.
OTHER_COLUMNS = {
    **dict.fromkeys(("score", "feasible", "within_strokes"), "higher"),
    "rank": "lower",
    **{f"{name}_{end}": "higher" for name in WORKSPACES for end in (LOW, HIGH)},
}
# Ends of the names of columns of an index.
ENDS = (*STATISTICS, PROVEN, FOUND)

Objectives = Mapping[str, str] | Sequence[str]


def better_sides(table: Any, objectives: Any) -> dict[str, str]:
    """Return the better side of each objective.

    Raises
    ------
    InvalidInput
        See `pareto`.
    """
    arguments.frame("table", table)
    if is_a(objectives, Mapping):
        pairs = objectives
    else:
        wanted = "names of columns"
        names = [
            arguments.text("objectives", name)
            for name in check_items("objectives", objectives, wanted)
        ]
        pairs = {name: known_side(name) for name in names}
    sides = stated_sides(table, pairs, "objectives")
    if len(sides) < 2:
        raise InvalidInput(expected("objectives", "at least two columns", len(sides)))
    return sides


def stated_sides(table: pd.DataFrame, pairs: Any, what: str = "better") -> dict[str, str]:
    """Return which side of columns is better, as a mapping states it.

    Raises
    ------
    InvalidInput
        On what is no mapping, names that are no columns, and other sides than those of an index.
    """
    pairs = arguments.mapping(what, pairs)
    for name, side in pairs.items():
        if not isinstance(name, str) or name not in table.columns:
            raise InvalidInput(expected(what, "columns of the table", brief(name)))
        if not isinstance(side, str) or side not in DIRECTIONS:
            wanted = f'"higher" or "lower" for each, as {what}={{name: side}}'
            raise InvalidInput(expected(f"{what}, {name}", wanted, brief(side)))
    return dict(pairs)


def known_side(name: str) -> str | None:
    """Return which side of a column is better, None if it is not known."""
    found = index_column(name)
    return INDICES[found[0]].better if found else OTHER_COLUMNS.get(name)


def index_column(name: str) -> tuple[str, str] | None:
    """Return the index of a column and what of it, ("control_number", "mean"); else None."""
    index, _, end = name.rpartition("_")
    return (index, end) if index in INDICES and end in ENDS else None
