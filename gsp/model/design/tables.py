"""Files with a table of anchor points, with the headers that are commonly found."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from gsp.errors import GspError, InvalidInput, MalformedFile, brief, expected
from gsp.files.cells import number_of, table_rows
from gsp.model.design.designs import Design
from gsp.model.design.frame import (
    COLUMNS,
    DIRECTIONS,
    TEXTS,
    check_columns,
    is_missing,
    parameters_from_columns,
)
from gsp.model.legs import Leg

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
    rows = table_rows(path)
    at, header = next(rows)
    kept = [(i, _column(name)) for i, name in enumerate(header) if _plain(name) not in NUMBERS]
    filled = [(where, cells) for where, cells in rows if any(c not in (None, "") for c in cells)]
    try:
        check_columns([name for _, name in kept], at)
        given = {name: header[i] for i, name in kept}

        def place(row: int, name: str) -> str:
            return f"{filled[row][0]}, column {brief(given.get(name, name))}"

        columns = {name: [cells[i] for _, cells in filled] for i, name in kept}
        if path.suffix.lower() == ".csv":
            columns = {
                name: cells if name in TEXTS else _numbers(cells, name, place)
                for name, cells in columns.items()
            }
        design = Design(**parameters_from_columns(columns, place), **parameters)
        _check_repeated(design, [where for where, _ in filled])
    except GspError as error:
        raise MalformedFile(f"{path}: {error}") from error
    unused = _unused_directions(columns, design)
    if unused:
        warnings.warn(f"{path}: not used: {'; '.join(unused)}", stacklevel=2)
    return design


def _check_repeated(design: Design, places: list[str]) -> None:
    """Raise an error for a row whose leg is that of another row: a copy of it, no further leg."""
    numbers = np.hstack(
        (design.base_points, design.platform_points)
        + (design.base_directions, design.platform_directions)
    )
    seen: dict[Any, int] = {}
    for i, leg in enumerate(design.legs):
        row = tuple(None if math.isnan(x) else x for x in numbers[i].tolist())
        first = seen.setdefault((_leg_key(leg), row), i)
        if first != i:
            wanted = f"another leg than that of {places[first]}"
            raise InvalidInput(expected(places[i], wanted, "the same"))


def _leg_key(leg: Leg) -> Any:
    drive = leg.drive
    return leg.name, None if drive is None else (drive.kind, *drive.numbers)


def _unused_directions(columns: Mapping[str, list[Any]], design: Design) -> list[str]:
    """Return the directions that a table gives for legs without a line, one text per side."""
    found = []
    for side, lines in (("base", "base_line"), ("platform", "platform_line")):
        legs = [
            str(i + 1)
            for i, leg in enumerate(design.legs)
            if not getattr(leg, lines)
            and any(not is_missing(columns[n][i]) for n in DIRECTIONS[side] if n in columns)
        ]
        if legs:
            numbers = f"{'leg' if len(legs) == 1 else 'legs'} {', '.join(legs)}"
            found.append(f"directions of the {side} of {numbers}, which have no line there")
    return found


def _plain(name: Any) -> str:
    return re.sub(r"[\s.\-]+", "_", str(name).strip().lower())


def _column(name: Any) -> str:
    return ALIASES.get(_plain(name), str(name))


def _numbers(cells: list[Any], name: str, place: Any) -> list[float | None]:
    """Return the numbers of a column of texts; None where a cell is empty."""
    found: list[float | None] = []
    for i, cell in enumerate(cells):
        value = number_of(cell) if cell else None
        if value is not None and math.isnan(value) and cell.lower() not in ("nan", "+nan", "-nan"):
            raise InvalidInput(expected(place(i, name), "a number", brief(cell)))
        found.append(value)
    return found
