"""The check of printed numbers: every verdict is recomputed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from gsp import arguments
from gsp.checks import check_items, plain_text, reading
from gsp.errors import (
    FailedComputation,
    InvalidInput,
    UnknownName,
    expected,
)
from gsp.geometry.vectors import Array
from gsp.progress import Progress, meter
from gsp.published.computing import compute
from gsp.published.numbers import Agreement, Rounding, compare
from gsp.published.record import (
    Record,
    Slip,
    Texts,
    read_records,
    read_slips,
    record_files,
)


def check(
    papers: str | Iterable[str] | None = None,
    *,
    places: str | None = None,
    files: Iterable[str | Path] | None = None,
    progress: Progress = None,
) -> pd.DataFrame:
    """Recompute the published numbers, and check their verdicts.

    Parameters
    ----------
    papers : str, sequence of str, or None
        Keys such as "TozKucuk2016"; default all.
    places : str or None
        A regular expression: only the records in whose place it occurs, as r"figure 1[45]".
    files : sequence of paths, or None
        Files of records; default those of the library, `indices/published/*.toml`.
    progress : function (done, total), bool or None
        Called after each record; False: no output; None or True: a progress bar.

    Returns
    -------
    DataFrame
        One row per printed number, by files: paper, place, quantity, entry (such as
        "[1, 4]", from 1; "" for a single number), printed, text (see `Record`), computed,
        agreed_digits, of_digits, agrees, verdict, holds (of the whole record), unit, proof,
        record (its file and line), failure. The last is why a number could not be computed, as
        with a damaged design file; `computed` is then NaN, and the verdict does not hold.

    Raises
    ------
    InvalidInput
        If `places` is not a regular expression.
    MalformedFile
        If a file is damaged, or names a quantity that is not known.
    UnknownName
        If a paper has no records.

    Examples
    --------
    >>> bool(check("TozKucuk2016")["holds"].all())
    True
    """
    found = _pattern(places)
    records = [record for record in select(papers, files) if found.search(record.place)]
    rows: list[dict[str, Any]] = []
    with meter(progress, "records") as report:
        for done, record in enumerate(records, 1):
            rows += _judged(record)
            report(done, len(records))
    return pd.DataFrame(rows)


def _judged(record: Record) -> list[dict[str, Any]]:
    """Return the rows of a record; all entries NaN if its computation fails."""
    try:
        return judge(record, compute(record))
    except FailedComputation as error:
        return judge(record, np.full(record.printed.shape, np.nan), str(error))


def _pattern(places: Any) -> re.Pattern[str]:
    """Return the regular expression of places; that of all of them for None."""
    places = plain_text(places)
    with reading("places", "a regular expression", places):
        pattern = re.compile("" if places is None else places)
        pattern.search("")  # a pattern of bytes raises TypeError
    return pattern


def select(
    papers: str | Iterable[str] | None = None, files: Iterable[str | Path] | None = None
) -> tuple[Record, ...]:
    """Return the records of some papers.

    Parameters
    ----------
    papers, files : see `check`

    Returns
    -------
    tuple of Record
        In the order of the files.

    Raises
    ------
    MalformedFile
        If a file is damaged.
    UnknownName
        If a paper has no records.
    """
    records = tuple(record for path in _paths(files) for record in read_records(path))
    if papers is None:
        return records
    wanted = _known(papers, records)
    return tuple(record for record in records if record.paper in wanted)


def _known(papers: str | Iterable[str], found: Iterable[Record | Slip]) -> tuple[str, ...]:
    """Return the keys of papers; UnknownName is raised for one of which nothing was found."""
    known = tuple(dict.fromkeys(entry.paper for entry in found))
    wanted: tuple[str, ...] = arguments.names("papers", papers)
    for paper in wanted:
        if paper not in known:
            raise UnknownName("paper", str(paper), known, "Known: " + ", ".join(known))
    return wanted


def select_slips(
    papers: str | Iterable[str] | None = None, files: Iterable[str | Path] | None = None
) -> tuple[Slip, ...]:
    """Return the slips of the text of some papers, which may be none.

    Parameters
    ----------
    papers, files : see `check`

    Returns
    -------
    tuple of Slip
        In the order of the files.

    Raises
    ------
    MalformedFile
        If a file is damaged.
    UnknownName
        If a paper has neither records nor slips.
    """
    paths = _paths(files)
    slips = tuple(slip for path in paths for slip in read_slips(path))
    if papers is None:
        return slips
    wanted = _known(papers, (*(r for path in paths for r in read_records(path)), *slips))
    return tuple(slip for slip in slips if slip.paper in wanted)


def _paths(files: Iterable[str | Path] | None) -> tuple[str | Path, ...]:
    if files is None:
        return record_files()
    return check_items("files", files, "a sequence of paths")


def judge(record: Record, computed: Array, failure: str = "") -> list[dict[str, Any]]:
    """Compare computed values with a record: one row per entry, and whether its verdict holds.

    "reproduced" holds if every entry agrees with the print; "misprint" if every entry is
    readable, is computed, and does not agree; "unreadable" if no entry is a number. The last two
    hold only if what is given as correct agrees in every entry. With a failure none holds.
    """
    entries = list(_entries(record.printed))
    found = [
        compare(text, float(computed[at]), record.rounding, record.decimals, record.names)
        for at, text in entries
    ]
    holds = not failure and _verdict_holds(record, computed, found)
    return [
        {
            "paper": record.paper,
            "place": record.place,
            "quantity": record.quantity,
            "entry": str([i + 1 for i in at]) if at else "",
            "printed": text,
            "text": record.text,
            "computed": float(computed[at]),
            "agreed_digits": agreement.digits,
            "of_digits": agreement.of,
            "agrees": agreement.agrees,
            "verdict": record.verdict,
            "holds": holds,
            "unit": record.unit,
            "proof": record.proof,
            "record": record.origin,
            "failure": failure,
        }
        for (at, text), agreement in zip(entries, found, strict=True)
    ]


def _entries(texts: Texts) -> Iterator[tuple[tuple[int, ...], str]]:
    for at in np.ndindex(texts.shape):
        if texts[at]:
            yield at, str(texts[at])


def _verdict_holds(record: Record, computed: Array, found: list[Agreement]) -> bool:
    if record.verdict == "reproduced":
        return all(agreement.agrees for agreement in found)
    if not _correct_holds(record, computed):
        return False
    if record.verdict == "unreadable":
        return not any(agreement.readable for agreement in found)
    known = all(np.isfinite(computed[at]) for at, _ in _entries(record.printed))
    return known and all(a.readable and not a.agrees for a in found)


def _correct_holds(record: Record, computed: Array) -> bool:
    if record.correct is None:
        return True
    rounding: Rounding = "exact" if record.rounding == "exact" else "rounded"
    return all(
        compare(text, float(computed[at]), rounding, None, record.names).agrees
        for at, text in _entries(record.correct)
    )


@arguments.validated(checked=arguments.frame)
def summary(checked: pd.DataFrame) -> pd.DataFrame:
    """Return one row per record of what `check` returns.

    Parameters
    ----------
    checked : DataFrame
        What `check` returned.

    Returns
    -------
    DataFrame
        With the columns of `checked`, and entries and agreeing: how many entries a vector or
        matrix has, and how many of them agree. `printed` and `computed` are then "" and NaN, and
        the digits those of the entry that agrees least.

    Raises
    ------
    InvalidInput
        If the table is none of `check`.
    """
    if checked.empty:
        return checked
    if unknown := {"record", "agreed_digits", "of_digits", "agrees"} - set(checked):
        wanted = "a table as check returns it"
        raise InvalidInput(expected("checked", wanted, f"no column {min(unknown)}"))
    return pd.DataFrame([_one_row(rows) for _, rows in checked.groupby("record", sort=False)])


def _one_row(rows: pd.DataFrame) -> dict[str, Any]:
    worst = rows.iloc[int((rows["agreed_digits"] - rows["of_digits"]).to_numpy().argmin())]
    row: dict[str, Any] = {str(key): value for key, value in worst.items()}
    row |= {"entries": len(rows), "agreeing": int(rows["agrees"].sum())}
    if len(rows) > 1:
        row |= {
            "entry": "",
            "printed": "",
            "computed": np.nan,
            "agrees": bool(rows["agrees"].all()),
        }
    return row
