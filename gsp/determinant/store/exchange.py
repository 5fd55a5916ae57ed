"""Stored maxima as files, which users can exchange: CSV or JSON by suffix."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

from gsp.determinant.record import METHOD
from gsp.determinant.store.database import Store
from gsp.determinant.store.schema import FIELDS
from gsp.determinant.store.validity import checked_entry, damage, remove_damaged, structured
from gsp.errors import GspError, InvalidInput, MalformedFile, brief, expected
from gsp.files.cells import table_rows
from gsp.files.writing import check_writable, read_text, write_text
from gsp.progress import Progress, meter

SUFFIXES = (".csv", ".json")
# What a JSON file of maxima states first.
FORMAT = "gsp maxima 1"


class Exported(NamedTuple):
    """Numbers of the maxima of a store that were exported.

    Attributes
    ----------
    written : int
        Those in the file.
    damaged : int
        Those that are left out, as they fail the checks of the store.
    """

    written: int
    damaged: int


class Imported(NamedTuple):
    """Numbers of the maxima of a file that were imported.

    Attributes
    ----------
    read : int
        All in the file.
    stored : int
        Those that are new or better than known ones.
    outdated : int
        Those of an older method of searching, which are left out.
    """

    read: int
    stored: int
    outdated: int


def export_maxima(store: Store, path: str | PathLike[str], *, overwrite: bool = False) -> Exported:
    """Write the valid maxima of a store to a .csv or .json file, and return how many there are.

    |det J| of each is computed at its pose; damaged entries are left out.

    Parameters
    ----------
    store : Store
    path : str or path
    overwrite : bool
        Whether an existing file is replaced.

    Returns
    -------
    Exported

    Raises
    ------
    InvalidInput
        On another suffix.
    UnwritableOutput
        If the file exists and `overwrite` is not set, or cannot be written.
    StoreError
    """
    import pandas as pd

    target = _target(path)
    check_writable(target, overwrite=overwrite)
    entries = store.rows()
    valid = [checked_entry(row) for row in entries if not damage(row)]
    if target.suffix == ".csv":
        # Objects keep integers and all digits of numbers.
        text = pd.DataFrame(valid, columns=list(FIELDS), dtype=object).to_csv(index=False)
    else:
        rows = [structured(row) for row in valid]
        text = json.dumps({"format": FORMAT, "maxima": rows}, indent=1) + "\n"
    write_text(target, text, overwrite=overwrite)
    return Exported(len(valid), len(entries) - len(valid))


def import_maxima(
    store: Store | Callable[[], Store],
    path: str | PathLike[str],
    *,
    progress: Progress = None,
) -> Imported:
    """Read maxima from a .csv or .json file into a store; better ones replace worse ones.

    Each value is computed anew at its pose before any is stored. Damaged entries of the store are
    replaced in any case.

    Parameters
    ----------
    store : Store, or function without arguments that returns one
        A function is called once the file is checked and has maxima to store: a store that such a
        call makes is not made for a file that is refused.
    path : str or path
    progress : function (done, total), bool or None
        Called after each checked maximum.

    Returns
    -------
    Imported
        Numbers of maxima.

    Raises
    ------
    InvalidInput
        On another suffix.
    MalformedFile
        If the file cannot be read, or an entry is incomplete or does not agree with its pose;
        nothing is stored then.
    StoreError
    """
    source = _target(path)
    rows = _rows(source)
    entries, outdated = [], 0
    with meter(progress, "checking") as report:
        for number, row in enumerate(rows, 1):
            try:
                _refuse_nan(row)
                if _version(row) != METHOD:
                    outdated += 1
                else:
                    entries.append(checked_entry(row))
            except GspError as error:
                raise MalformedFile(f"{source}, maximum {number}: {error}") from error
            report(number, len(rows))
    if not entries:
        return Imported(len(rows), 0, outdated)
    opened = store() if callable(store) else store
    for entry in entries:
        remove_damaged(opened, entry["key"])
    return Imported(len(rows), sum(opened.put(entry) for entry in entries), outdated)


def _target(path: str | PathLike[str]) -> Path:
    target = Path(path)
    if target.suffix not in SUFFIXES:
        raise InvalidInput(expected("file of maxima", "a name in .csv or .json", str(path)))
    return target


def _rows(source: Path) -> list[dict[str, Any]]:
    if source.suffix == ".csv":
        rows = table_rows(source)
        _, header = next(rows)
        if len(set(header)) < len(header):
            raise MalformedFile(expected(str(source), "columns of different names", "equal ones"))
        if "key" not in header:
            got = brief(", ".join(header))
            raise MalformedFile(expected(str(source), "the columns of maxima, such as key", got))
        return [{k: v or None for k, v in zip(header, c, strict=True)} for _, c in rows]
    content = _json(source)
    found = content.get("maxima") if isinstance(content, dict) else None
    if not isinstance(found, list) or not all(isinstance(row, dict) for row in found):
        wanted = 'an object with a list "maxima" of objects'
        raise MalformedFile(
            expected(str(source), wanted, "null" if content is None else brief(content))
        )
    # Files without a format are taken: only one that is stated can be another.
    if content.get("format", FORMAT) != FORMAT:
        raise MalformedFile(
            f"{source}: {expected('format', repr(FORMAT), brief(content['format']))}"
        )
    return found


def _json(source: Path) -> Any:
    text = read_text(source)
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise MalformedFile(f"{source}, {place}: not JSON: {error.msg}") from error
    except RecursionError as error:
        raise MalformedFile(f"{source}: not JSON that can be read: nested too deeply") from error
    except ValueError as error:
        raise MalformedFile(
            f"{source}: not JSON that can be read: an integer is too long"
        ) from error


def _refuse_nan(row: dict[str, Any]) -> None:
    """Raise an error for NaN, which JSON of Python has and which is not a missing number."""
    for name, value in row.items():
        if isinstance(value, float) and math.isnan(value):
            raise InvalidInput(expected(name, "a finite number", "NaN"))


def _version(row: dict[str, Any]) -> float:
    """Return the number of the method of searching; files of the first one have none."""
    if "key" not in row:
        raise InvalidInput(expected("entry", "a key", "none"))
    given = row.get("version")
    try:
        return 1.0 if given is None else float(given)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidInput(expected("version", "a number", brief(given))) from error
