"""Rows of numbers, from an option or from the columns of a table."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gsp.errors import InvalidInput, MalformedFile, expected
from gsp.files.writing import check_readable
from gsp.geometry.vectors import Array


def read_rows(option: str, text: str, columns: Sequence[str]) -> Array:
    """Return numbers of an option, or the columns of a table (.csv or .parquet) that it names.

    Parameters
    ----------
    option : str
        For errors.
    text : str
        As many numbers as there are columns, or the path of a file.
    columns : sequence of str

    Returns
    -------
    (n,) array of numbers that were given, or (m, n) array of a table; NaN where a cell is empty
    """
    if Path(text).suffix.lower() in (".csv", ".parquet"):
        return _table(Path(text), columns)
    words = text.replace(",", " ").split()
    try:
        values = np.array([float(word) for word in words])
    except ValueError:
        values = np.empty(0)
    if len(values) != len(columns):
        wanted = f"{len(columns)} numbers ({' '.join(columns)}), or a .csv or .parquet file"
        raise InvalidInput(expected(option, wanted, repr(text)))
    return values


def _table(path: Path, columns: Sequence[str]) -> Array:
    check_readable(path)
    try:
        frame = _frame(path)
        missing = [name for name in columns if name not in frame.columns]
        if missing:
            wanted = "the columns " + ", ".join(columns)
            raise MalformedFile(expected(str(path), wanted, ", ".join(map(str, frame.columns))))
        chosen = frame[list(columns)]
        for name, kind in chosen.dtypes.items():
            if kind.kind == "b":
                raise MalformedFile(expected(f"{path}, column {name}", "numbers", "true and false"))
        return np.asarray(chosen.to_numpy(dtype=np.float64))
    except MalformedFile:
        raise
    except (OSError, ValueError, TypeError, ImportError) as error:
        first = str(error).partition("\n")[0]
        raise MalformedFile(f"{path}: expected a table of numbers: {first}") from error


def _frame(path: Path) -> Any:
    """Read a table; rows with more values than the header has columns are an error."""
    import pandas as pd

    if path.suffix.lower() != ".csv":
        return pd.read_parquet(path)
    with warnings.catch_warnings():
        warnings.simplefilter("error", pd.errors.ParserWarning)
        try:
            # Without index_col=False the columns of such a table are shifted by one.
            return pd.read_csv(path, index_col=False)
        except pd.errors.ParserWarning as error:
            wanted = "as many values in each row as in the header"
            raise MalformedFile(expected(str(path), wanted, "rows with more")) from error
