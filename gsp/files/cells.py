"""Cells of tables in files: CSV, Parquet or Excel by suffix, with the line or row of each."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gsp.errors import MalformedFile, MissingSoftware, expected
from gsp.files.writing import check_readable, read_text

if TYPE_CHECKING:
    import pandas as pd

SUFFIXES = (".csv", ".parquet", ".xlsx")
SEPARATORS = ",;\t"

# Where a row is, "line 3" or "row 3", and its cells.
Row = tuple[str, list[Any]]


def table_rows(path: str | PathLike[str]) -> Iterator[Row]:
    r"""Yield the rows of a table, its header first.

    Parameters
    ----------
    path : path
        Ending in .csv, .parquet or .xlsx (its first sheet). A table in CSV is separated by commas,
        semicolons or tabs. Empty lines and lines that begin with # are skipped, and a separator at
        the end of a row is ignored.

    Yields
    ------
    Where the row is, "line 3" or "row 3", and its cells, as many as in the header: from CSV texts
    without spaces around them, else what the file holds, None for an empty cell.

    Raises
    ------
    MalformedFile
        If the file cannot be read, has no header, or a row of another width.
    MissingSoftware
        If the format needs a package that is not installed.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> path = Path(mkdtemp(), "a.csv")
    >>> _ = path.write_text("x, y\n1, 2\n")
    >>> list(table_rows(path))
    [('line 1', ['x', 'y']), ('line 2', ['1', '2'])]
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        wanted = "a table ending in " + ", ".join(SUFFIXES)
        raise MalformedFile(expected(str(path), wanted, suffix or "no suffix"))
    yield from _csv_rows(path) if suffix == ".csv" else _stored_rows(path, suffix)


def _csv_rows(path: Path) -> Iterator[Row]:
    text = read_text(path)
    first = next((x for x in text.splitlines() if x.strip() and not _comment(x)), "")
    if not first:
        raise MalformedFile(expected(str(path), "a header and rows", "an empty table"))
    # Comments may have quotes, which would go on in the next line.
    lines = ["" if _comment(line) else line for line in text.split("\n")]
    mark = max(SEPARATORS, key=first.count)
    reader = csv.reader(io.StringIO("\n".join(lines), newline=""), delimiter=mark)
    width, start = 0, 1
    try:
        for row in reader:
            where, raw = f"line {start}", lines[start - 1 : reader.line_num]
            if any('"' in line for line in raw) and not _closed(raw, mark):
                got = "none to the end of the file"
                raise MalformedFile(expected(f"{path}, {where}", "a closing quote", got))
            start = reader.line_num + 1
            cells = [cell.strip() for cell in row]
            if cells in ([], [""]) or _comment(cells[0]):
                continue
            width = width or len(cells)
            if len(cells) == width + 1 and not cells[-1]:
                cells.pop()
            if len(cells) != width:
                wanted = f"{width} cells, as in the header"
                raise MalformedFile(expected(f"{path}, {where}", wanted, len(cells)))
            yield where, cells
    except csv.Error as error:
        wanted = "a table in CSV"
        raise MalformedFile(
            expected(f"{path}, line {start}", wanted, f"another text: {error}")
        ) from error


def _closed(lines: list[str], mark: str) -> bool:
    """Whether the quotes of a row are closed; only a strict reader states where they are not."""
    try:
        next(csv.reader(io.StringIO("\n".join(lines), newline=""), delimiter=mark, strict=True))
    except csv.Error as error:
        return "unexpected end" not in str(error)
    return True


def _comment(text: str) -> bool:
    return text.lstrip().startswith("#")


def _stored_rows(path: Path, suffix: str) -> Iterator[Row]:
    frame = _frame(path, suffix)
    names = [str(name) for name in frame.columns]
    whole = frame.astype(object).where(frame.notna(), None)
    rows = whole.itertuples(index=False, name=None)
    if suffix == ".xlsx":
        names = ["" if cell is None else str(cell).strip() for cell in next(rows, ())]
    if not names:
        raise MalformedFile(expected(str(path), "a header and rows", "an empty table"))
    yield "the header", names
    for number, row in enumerate(rows, 2 if suffix == ".xlsx" else 1):
        yield f"row {number}", list(row)


def _frame(path: Path, suffix: str) -> pd.DataFrame:
    """Return a table; the header of one in Excel is a row of it, as pandas renames equal names."""
    import pandas as pd

    check_readable(path)
    try:
        if suffix == ".xlsx":
            return pd.read_excel(path, header=None, dtype=object)
        return pd.read_parquet(path)
    except ImportError as error:
        package = "openpyxl" if suffix == ".xlsx" else "pyarrow"
        raise MissingSoftware(package, f"a {suffix} table", "tables") from error
    except Exception as error:  # of the packages that read the formats: zip, XML, Arrow
        named = isinstance(error, OSError) and error.strerror
        reason = f"none that can be read: {named}" if named else "another file, or a damaged one"
        raise MalformedFile(expected(str(path), f"a table in {suffix}", reason)) from error


def number_of(text: str) -> float:
    """Return the number of a text, and NaN if it is none: ASCII digits, without underscores.

    >>> number_of("1e-3"), number_of("1_000"), number_of("\u0661\u0662")
    (0.001, nan, nan)
    """
    try:
        return float(text) if is_ascii_number(text) else math.nan
    except ValueError:
        return math.nan


def is_ascii_number(text: str) -> bool:
    """Whether a text has no digits that only Python reads: 1_000, and those of other scripts."""
    return text.isascii() and "_" not in text
