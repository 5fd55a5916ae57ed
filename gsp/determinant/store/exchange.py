"""Stored maxima as files, which users can exchange: CSV or JSON by suffix."""

from __future__ import annotations

import json
from io import StringIO
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gsp.determinant.canonical import design_of, key_of, region_of
from gsp.determinant.record import METHOD
from gsp.determinant.store.database import Store, StoreError
from gsp.determinant.store.entries import maximum_of
from gsp.determinant.store.schema import FIELDS, INTEGERS
from gsp.errors import GspError, InvalidInput, MalformedFile, expected
from gsp.files.writing import check_writable, read_text, write_text
from gsp.progress import Progress, meter

SUFFIXES = (".csv", ".json")


class Imported(NamedTuple):
    """Numbers of the maxima of a file: all, those stored, and those of an older method.

    Stored are those that are new or better than known ones. Those of an older method of searching
    are left out.
    """

    read: int
    stored: int
    outdated: int


def export_maxima(store: Store, path: str | PathLike[str], *, overwrite: bool = False) -> int:
    """Write all maxima of a store to a .csv or .json file, and return how many there are.

    Parameters
    ----------
    store : Store
    path : str or path
    overwrite : bool
        Whether an existing file is replaced.

    Returns
    -------
    int

    Raises
    ------
    InvalidInput
        On another suffix.
    UnwritableOutput
        If the file exists and `overwrite` is not set, or cannot be written.
    StoreError
    """
    target = _target(path)
    check_writable(target, overwrite=overwrite)
    entries = store.entries()
    if target.suffix == ".csv":
        text = entries.to_csv(index=False, float_format="%.17g")
    else:
        rows = [_exported(row) for row in entries.to_dict("records")]
        text = json.dumps({"format": "gsp maxima 1", "maxima": rows}, indent=1) + "\n"
    write_text(target, text, overwrite=overwrite)
    return len(entries)


def import_maxima(
    store: Store, path: str | PathLike[str], *, progress: Progress = None
) -> Imported:
    """Read maxima from a .csv or .json file into a store; better ones replace worse ones.

    Each value is computed anew at its pose before any is stored.

    Parameters
    ----------
    store : Store
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
    rows = _rows(source, read_text(source))
    entries, outdated = [], 0
    with meter(progress, "checking") as report:
        for number, row in enumerate(rows, 1):
            try:
                if _number(row.get("version") or 1) != METHOD:
                    outdated += 1
                else:
                    entries.append(_checked(row))
            except (GspError, KeyError, TypeError, ValueError, OverflowError) as error:
                what = f"no {error}" if isinstance(error, KeyError) else str(error)
                raise MalformedFile(f"{source}, maximum {number}: {what}") from error
            report(number, len(rows))
    return Imported(len(rows), sum(store.put(entry) for entry in entries), outdated)


def _target(path: str | PathLike[str]) -> Path:
    target = Path(path)
    if target.suffix not in SUFFIXES:
        raise InvalidInput(expected("file of maxima", "a name in .csv or .json", str(path)))
    return target


def _exported(row: dict[Any, Any]) -> dict[str, Any]:
    try:
        return _plain(row)
    except (TypeError, ValueError, RecursionError) as error:
        wanted = "JSON in position, rotation, design and domain"
        raise StoreError(
            expected(f"entry {row['key']}", wanted, f"a damaged one: {error}")
        ) from error


def _plain(row: dict[Any, Any]) -> dict[str, Any]:
    """Return a row with structures for JSON texts, and None for what is missing."""
    values = {str(k): None if isinstance(v, float) and np.isnan(v) else v for k, v in row.items()}
    return {k: json.loads(v) if k in _STRUCTURES and v else v for k, v in values.items()}


_STRUCTURES = ("position", "rotation", "design", "domain")


def _rows(source: Path, text: str) -> list[dict[str, Any]]:
    import pandas as pd

    if source.suffix == ".csv":
        try:
            frame = pd.read_csv(StringIO(text), dtype=str)
        except (ValueError, pd.errors.ParserError) as error:
            raise MalformedFile(f"{source}: not CSV: {error}") from error
        return [_plain(row) for row in frame.to_dict("records")]
    try:
        rows = json.loads(text.removeprefix("\ufeff"))["maxima"]
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise MalformedFile(f'{source}: expected JSON with a list "maxima": {error}') from error
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise MalformedFile(f'{source}: expected a list of objects as "maxima"')
    return rows


def _checked(row: dict[str, Any]) -> dict[str, Any]:
    """Return an entry of the store; its key and value are those of its design and pose."""
    legs, rows = row["design"]["legs"], row["design"]["rows"]
    key = key_of(legs, rows, row.get("domain"))
    if key != row["key"]:
        raise InvalidInput(expected("key", f"{key}, which its design has", row["key"]))
    found = maximum_of(row, design_of(legs, rows), region_of(row.get("domain")))
    kept = {name: row.get(name) for name in FIELDS}
    texts = {k: None if kept[k] is None else json.dumps(kept[k]) for k in _STRUCTURES}
    whole = {k: int(v) for k in INTEGERS if (v := getattr(found, k, None)) is not None}
    given = {"value": found.value, "version": METHOD, "found": _number(kept["found"])}
    return {**kept, **texts, **whole, **given}


def _number(value: Any) -> float | None:
    return None if value is None else float(value)
