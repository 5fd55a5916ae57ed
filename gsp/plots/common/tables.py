"""Checks of the tables that are drawn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from gsp import arguments
from gsp.checks import check_array, is_a, plain_text
from gsp.errors import GspError, InvalidInput, brief, expected
from gsp.geometry.vectors import Array, Mask
from gsp.indices import index_names
from gsp.plots.common.style import plain, symbol_text


def check_frame(what: str, table: Any) -> None:
    """Raise InvalidInput unless the value is a pandas table with rows and different columns."""
    if not len(arguments.frame(what, table)):
        raise InvalidInput(expected(what, "a table with rows", "an empty one"))


def column(table: pd.DataFrame, name: str) -> Array:
    """Return a column as floats, or raise InvalidInput if it is missing or holds no numbers."""
    if name not in table:
        raise InvalidInput(expected("table", f"a column {name}", "none"))
    try:
        return table[name].to_numpy(dtype=np.float64, na_value=np.nan)
    except (TypeError, ValueError) as error:
        got = f"a column of {table[name].dtype}"
        raise InvalidInput(expected(f"table[{name!r}]", "numbers", got)) from error


def chosen_indices(given: Iterable[str] | str, there: Sequence[str]) -> list[str]:
    """Return the names of the indices of a table that are given by names or symbols.

    "all" stands for all of the table.

    Raises
    ------
    InvalidInput
        If one is unknown or not in the table, or there is none.
    """
    try:
        given = plain_text(given)
        everything = is_a(given, str) and given == "all"
        names = list(there) if everything else list(index_names(given))
        fits = bool(names) and set(names) <= set(there)
    except (GspError, TypeError):
        fits = False
    if not fits:
        wanted = "some of " + (", ".join(there) or "a table that holds an index")
        raise InvalidInput(expected("indices", wanted, brief(given)))
    return names


def coordinates_of(table: pd.DataFrame, name: str) -> Array:
    """Return a column of coordinates as floats, or raise InvalidInput if one is not finite."""
    return check_array(f"table[{name!r}]", column(table, name), (None,))


def driven(table: pd.DataFrame) -> Mask:
    """Return which designs of a table have legs that are driven at the base."""
    if "drives" not in table:
        return np.zeros(len(table), dtype=bool)
    return np.array([isinstance(text, str) and text != "" for text in table["drives"]])


def index_label(table: pd.DataFrame, name: str) -> str:
    """Return the symbol of an index with its unit in the table, if it has one."""
    units = table.attrs.get("units")
    return with_unit(name, str(units.get(name, "")) if isinstance(units, Mapping) else "")


def with_unit(name: str, unit: str) -> str:
    """Return the symbol of an index with a unit, if it has one; "a, b" lists those of designs."""
    parts = [part.strip() for part in unit.split(",") if part.strip() not in ("", "1")]
    written = ", ".join(_power(part) for part in parts)
    return f"{symbol_text(name)} [{written}]" if written else symbol_text(name)


def _power(unit: str) -> str:
    """Return "mm^3" with its power raised."""
    stem, _, power = unit.rpartition("^")
    raised = power.strip("()").lstrip("-").isdecimal()
    return rf"{plain(stem)}$^{{{power}}}$" if raised else plain(unit)
