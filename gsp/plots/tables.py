"""Checks of the tables that are drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from gsp.checks import check_array
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.vectors import Array


def check_frame(what: str, table: Any) -> None:
    """Raise InvalidInput if something is no pandas table with rows and different columns."""
    if not isinstance(table, pd.DataFrame):
        got = f"{type(table).__name__} {brief(table)}"
        raise InvalidInput(expected(what, "a pandas.DataFrame", got))
    if not len(table):
        raise InvalidInput(expected(what, "a table with rows", "an empty one"))
    if not table.columns.is_unique:
        twice = table.columns[table.columns.duplicated()][0]
        raise InvalidInput(expected(what, "columns with different names", f"two of {twice!r}"))


def column(table: pd.DataFrame, name: str) -> Array:
    """Return a column as floats, or raise InvalidInput if it is missing or holds no numbers."""
    if name not in table:
        raise InvalidInput(expected("table", f"a column {name}", "none"))
    try:
        return table[name].to_numpy(dtype=np.float64, na_value=np.nan)
    except (TypeError, ValueError) as error:
        got = f"a column of {table[name].dtype}"
        raise InvalidInput(expected(f"table[{name!r}]", "numbers", got)) from error


def coordinates_of(table: pd.DataFrame, name: str) -> Array:
    """Return a column of coordinates as floats, or raise InvalidInput if one is not finite."""
    return check_array(f"table[{name!r}]", column(table, name), (None,))
