"""Rows of numbers, from an option or from the columns of a table."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gsp.checks import check_separated
from gsp.cli.outputs.console import counted
from gsp.errors import InvalidInput, MalformedFile, brief, expected
from gsp.files.cells import SUFFIXES, number_of, table_rows
from gsp.geometry.vectors import Array

# Texts of cells that stand for a missing number, in small letters.
MISSING = ("", "nan", "na", "n/a", "null", "none")


def number_words(option: str, text: str) -> list[str]:
    """Return the words of a list of numbers, which commas or spaces separate.

    Raises
    ------
    InvalidInput
        If there is none between two commas.
    """
    return [word for item in check_separated(option, text) for word in item.split()]


def read_rows(
    option: str,
    text: str,
    columns: Sequence[str],
    *,
    gaps: bool = False,
    also: Sequence[str] = (),
) -> Array:
    """Return numbers of an option, or the columns of a table that it names.

    Parameters
    ----------
    option : str
        For errors.
    text : str
        As many numbers as there are columns, or the path of a file: .csv, .parquet or .xlsx.
    columns : sequence of str
    gaps : bool
        Whether cells of a table may be empty; they are NaN.
    also : sequence of str
        What the option may be besides, for errors.

    Returns
    -------
    (n,) array of numbers that were given, or (m, n) array of a table

    Raises
    ------
    InvalidInput
        If the option is neither.
    MalformedFile
        With the file, row and column of the first mistake.
    """
    if Path(text).suffix.lower() in SUFFIXES:
        return _rows(Path(text), columns, gaps)
    values = [number_of(word) for word in number_words(option, text)]
    if len(values) != len(columns) or not all(map(math.isfinite, values)):
        several = f"{counted(len(columns), 'number')} ({' '.join(columns)})"
        wanted = ", ".join([*also, several, f"or a file {' or '.join(SUFFIXES)}"])
        raise InvalidInput(expected(option, wanted, brief(text)))
    return np.array(values)


def read_table(option: str, path: str | Path, columns: Sequence[str]) -> Array:
    """Return the columns of a table that an option names.

    Parameters
    ----------
    option : str
        For errors.
    path : str or Path
        Of a .csv, .parquet or .xlsx file.
    columns : sequence of str

    Returns
    -------
    (m, n) array

    Raises
    ------
    InvalidInput
        If it is not the name of such a file.
    MalformedFile
        With the file, row and column of the first mistake.
    """
    if Path(path).suffix.lower() not in SUFFIXES:
        raise InvalidInput(expected(option, f"a file {' or '.join(SUFFIXES)}", brief(str(path))))
    return _rows(Path(path), columns, gaps=False)


def _rows(path: Path, columns: Sequence[str], gaps: bool) -> Array:
    rows = table_rows(path)
    _, header = next(rows)
    for name in columns:
        if (count := header.count(name)) != 1:
            wanted = f"one column {name!r} (the columns are {', '.join(columns)})"
            got = brief(", ".join(header)) if not count else f"{count} of that name"
            raise MalformedFile(expected(str(path), wanted, got))
    chosen = [(header.index(name), name) for name in columns]
    values = array("d")
    for where, cells in rows:
        for i, name in chosen:
            value = _cell(cells[i])
            missing = value is not None and math.isnan(value)
            if value is None or math.isinf(value) or (missing and not gaps):
                place = f"{path}, {where}, column {name!r}"
                empty = cells[i] is None or not str(cells[i])
                got = "nothing" if empty else brief(cells[i])
                raise MalformedFile(expected(place, "a finite number", got))
            values.append(value)
    if not values:
        raise MalformedFile(expected(str(path), "rows of numbers", "a header only"))
    return np.array(values).reshape(-1, len(columns))


def _cell(cell: Any) -> float | None:
    """Return the number of a cell, NaN of an empty one, and None where it is not a number."""
    if cell is None or (isinstance(cell, str) and cell.lower() in MISSING):
        return math.nan
    if isinstance(cell, str):
        value = number_of(cell)
        return None if math.isnan(value) else value
    if type(cell).__name__ in ("bool", "bool_", "bytes"):
        return None
    try:
        return float(cell)
    except (TypeError, ValueError, OverflowError):
        return None
