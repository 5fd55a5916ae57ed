"""Files with a table of anchor points, with the headers that are commonly found."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gsp.errors import GspError, InvalidInput, MalformedFile, MissingSoftware, brief, expected
from gsp.files.writing import check_readable, read_text
from gsp.model.design.designs import Design
from gsp.model.design.frame import COLUMNS, check_columns, parameters_from_columns

SUFFIXES = (".csv", ".parquet", ".xlsx")
# Columns that only number the legs.
NUMBERS = ("", "leg", "index", "i")


def _aliases() -> dict[str, str]:
    found = {name: name for name in COLUMNS} | {"constraint": "constraints"}
    for side, words in (("base", ("base", "b")), ("platform", ("platform", "p"))):
        for word in words:
            for axis in "xyz":
                for text in (f"{word}_{axis}", f"{word}{axis}", f"{axis}_{word}", f"{axis}{word}"):
                    found[text] = f"{side}_{axis}"
                for text in (f"{word}_d{axis}", f"{word}d{axis}"):
                    found[text] = f"{side}_d{axis}"
    for end, word in (("low", "min"), ("high", "max")):
        texts = (word, f"l{word}", f"l_{word}", f"stroke_{word}")
        found |= dict.fromkeys(texts, f"stroke_{end}")
    return found


ALIASES: Mapping[str, str] = MappingProxyType(_aliases())


def design_from_table(path: Path, **parameters: Any) -> Design:
    """Return the design of a table with one row per leg.

    Parameters
    ----------
    path : path of a file
        Ending in .csv, .parquet or .xlsx (its first sheet). The columns are those of
        `Design.from_frame`; capitals, spaces, dots and hyphens in their names do not matter, and
        "bx", "x_b", "x_base" … are read as "base_x". A table in CSV is separated by commas,
        semicolons or tabs; empty lines and lines that begin with # are skipped.
    **parameters : unit, name, source, home …
        Of the design.

    Returns
    -------
    Design

    Raises
    ------
    MalformedFile
        With the path, and the line and column of the first mistake.
    MissingSoftware
        If the format needs a package that is not installed.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        wanted = "a table ending in " + ", ".join(SUFFIXES)
        raise MalformedFile(expected(str(path), wanted, suffix or "no suffix"))
    header, lines, rows = _csv_rows(path) if suffix == ".csv" else _other_rows(path)
    kept = [(i, _column(name)) for i, name in enumerate(header) if _plain(name) not in NUMBERS]
    try:
        check_columns([name for _, name in kept], f"line {lines[0]}")
        given = {name: header[i] for i, name in kept}

        def place(row: int, name: str) -> str:
            return f"line {lines[1 + row]}, column {given.get(name, name)!r}"

        columns = {name: [row[i] for row in rows] for i, name in kept}
        if suffix == ".csv":
            columns = {
                name: cells if name == "constraints" else _numbers(cells, name, place)
                for name, cells in columns.items()
            }
        return Design(**parameters_from_columns(columns, place), **parameters)
    except GspError as error:
        raise MalformedFile(f"{path}: {error}") from error


def _plain(name: Any) -> str:
    return re.sub(r"[\s.\-]+", "_", str(name).strip().lower())


def _column(name: Any) -> str:
    return ALIASES.get(_plain(name), str(name))


Rows = tuple[list[str], list[int], list[list[Any]]]


def _csv_rows(path: Path) -> Rows:
    """Return the header, the line of each row with that of the header first, and the rows."""
    text = read_text(path)
    first = next((x for x in text.splitlines() if x.strip() and x.lstrip()[0] != "#"), "")
    delimiter = max(",;\t", key=first.count)
    reader = csv.reader(io.StringIO(text), delimiter=delimiter)
    found: list[tuple[int, list[str]]] = []
    try:
        for row in reader:
            if any(cell.strip() for cell in row) and not row[0].lstrip().startswith("#"):
                found.append((reader.line_num, [cell.strip() for cell in row]))
    except csv.Error as error:
        raise MalformedFile(f"{path}, line {reader.line_num}: {error}") from error
    if not found:
        raise MalformedFile(expected(str(path), "a header and rows", "an empty table"))
    width = len(found[0][1])
    for line, row in found:
        if len(row) != width:
            raise MalformedFile(
                expected(f"{path}, line {line}", f"{width} cells, as in the header", len(row))
            )
    return found[0][1], [line for line, _ in found], [row for _, row in found[1:]]


def _other_rows(path: Path) -> Rows:
    import pandas as pd

    check_readable(path)
    excel = path.suffix.lower() == ".xlsx"
    try:
        frame = pd.read_excel(path) if excel else pd.read_parquet(path)
    except ImportError as error:
        package = "openpyxl" if excel else "pyarrow"
        raise MissingSoftware(package, f"a {path.suffix} table", "tables") from error
    except Exception as error:  # of the packages that read the formats: zip, XML, Arrow
        first = str(error).partition("\n")[0]
        raise MalformedFile(f"{path}: expected a table: {first}") from error
    rows = [list(row) for row in frame.itertuples(index=False, name=None)]
    return list(map(str, frame.columns)), list(range(1, len(rows) + 2)), rows


def _numbers(cells: list[Any], name: str, place: Any) -> list[float | None]:
    """Return the numbers of a column of texts; None where a cell is empty."""
    found: list[float | None] = []
    for i, cell in enumerate(cells):
        try:
            found.append(float(cell) if cell else None)
        except ValueError as error:
            raise InvalidInput(expected(place(i, name), "a number", brief(cell))) from error
    return found
