"""Rows of numbers, from an option or from the columns of a table."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

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
    import pandas as pd

    check_readable(path)
    try:
        read = pd.read_csv if path.suffix.lower() == ".csv" else pd.read_parquet
        frame = read(path)
        missing = [name for name in columns if name not in frame.columns]
        if missing:
            wanted = "the columns " + ", ".join(columns)
            raise MalformedFile(expected(str(path), wanted, ", ".join(map(str, frame.columns))))
        return np.asarray(frame[list(columns)].to_numpy(dtype=np.float64))
    except MalformedFile:
        raise
    except (OSError, ValueError, TypeError, ImportError) as error:
        first = str(error).partition("\n")[0]
        raise MalformedFile(f"{path}: expected a table of numbers: {first}") from error
