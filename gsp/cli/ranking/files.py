"""The files of `gsp rank` and `gsp explore`: table, metadata, picture, under one free name."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from gsp.checks import check_separated
from gsp.cli.interrupts import INTERRUPTED
from gsp.cli.outputs.console import say, warn
from gsp.cli.outputs.headings import latex_headings
from gsp.cli.outputs.pictures import check_picture, save_picture
from gsp.errors import (
    InvalidInput,
    MissingSoftware,
    UnknownIndex,
    UnknownName,
    UnwritableOutput,
    expected,
)
from gsp.files.claims import Claim, InUse
from gsp.files.tables import check_table, sidecar, write_table
from gsp.indices import INDICES, index_name
from gsp.ranking import STATISTICS
from gsp.ranking.restrictions import FEASIBLE, WITHIN_STROKES

if TYPE_CHECKING:
    import pandas as pd

RESULT = Path("results/ranking.csv")
KEYS = ("rank", "design", "class")
# Columns that are not statistics of an index.
COLUMNS = (
    *KEYS,
    "mechanism",
    "n_legs",
    "drives",
    "singular",
    "undefined",
    WITHIN_STROKES,
    FEASIBLE,
)


def keys_of(table: pd.DataFrame) -> tuple[str, ...]:
    """Return the columns that name a design: with its drives, if a design of the table has some."""
    return (*KEYS, *(("drives",) if "drives" in table else ()))


class Files(NamedTuple):
    """The files of a run: the table, whether there is a picture, and the folder of its parts.

    No other run has the same names meanwhile.
    """

    table: Path
    picture: bool
    parts: Claim


@contextmanager
def outputs(
    out: Path | None, plot: bool | None, force: bool, resume: bool, default: Path = RESULT
) -> Iterator[Files]:
    """Yield the files before the work starts; folders that stay empty are deleted.

    Without a name it is the first free one, or, to resume, that of the last interrupted run.

    Raises
    ------
    UnwritableOutput, MissingSoftware
        If the files could not be written, or another run writes them.
    """
    made = out is None and not default.parent.exists()
    claim = None
    try:
        path = make_default(default) if out is None else out
        drawn = plot is not False
        if out is None and not force:
            claim = (interrupted(path) if resume else None) or free_claim(path, drawn)
            path = table_of(claim)
        check_table(path, overwrite=force)
        drawn = drawn and _drawable(path, plot, force)
        claim = claim or Claim(parts_of(path))
        if force and not resume:
            claim.clear()
        yield Files(path, drawn, claim)
    finally:
        if claim:
            claim.release()
        if made:
            with suppress(OSError):  # it has files, or was not made
                default.parent.rmdir()


def _drawable(path: Path, plot: bool | None, force: bool) -> bool:
    try:
        check_picture(path.with_suffix(".png"), overwrite=force)
    except MissingSoftware as error:
        if plot:
            raise
        warn(f"no picture: {error}")
        return False
    return True


def parts_of(path: Path) -> Path:
    """Return the folder with the rows of finished designs while a ranking is computed."""
    return path.with_name(path.name + ".parts")


def table_of(claim: Claim) -> Path:
    """Return the name of the table whose parts a folder has."""
    return claim.folder.with_suffix("")


def interrupted(path: Path) -> Claim | None:
    """Return the folder of the last interrupted run among the default names.

    Raises
    ------
    UnwritableOutput
        If there are such folders, all of them of runs in progress.
    """
    folders = path.parent.glob(f"{path.stem}*{path.suffix}.parts")
    refused = None
    for folder in sorted(folders, key=_last_change, reverse=True):
        try:
            claim = Claim(folder)
        except InUse as error:
            refused = refused or error
            continue
        if claim.has_begun():
            return claim
        claim.release()
    if refused:
        raise refused
    return None


def _last_change(folder: Path) -> float:
    try:
        return folder.stat().st_mtime
    except FileNotFoundError:  # its run has ended meanwhile
        return 0.0


def make_default(path: Path) -> Path:
    """Return a default name, after making its folder."""
    try:
        path.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise UnwritableOutput(
            f"{path.parent}: cannot be made: {error.strerror}; expected a writable folder, or --out"
        ) from error
    return path


def stopped(claim: Claim, stored: str = "the rows of {} designs are kept") -> int:
    """Print what of an interrupted run is stored, and return its exit status."""
    kept = claim.count()
    if kept:
        what = f"{stored.format(kept)} in {claim.folder}; --resume continues"
    else:
        what = "nothing was written"
        claim.clear()
    claim.release()
    warn(f"stopped; {what}")
    return INTERRUPTED


def free_claim(path: Path, picture: bool) -> Claim:
    """Return the folder of parts for the first of ranking.csv, ranking-2.csv, … that is free.

    There are no files of this name, and no other run has it or gets it.
    """
    for name in _names(path):
        if not _is_free(name, picture):
            continue
        try:
            claim = Claim(parts_of(name))
        except InUse:
            continue
        # Another run may have written its table and released the name meanwhile.
        if not claim.has_begun() and _is_free(name, picture):
            return claim
        claim.release()
    raise AssertionError("there is always another name")


def _names(path: Path) -> Iterator[Path]:
    yield path
    yield from (path.with_stem(f"{path.stem}-{i}") for i in count(2))


def _is_free(name: Path, picture: bool) -> bool:
    files = [name, sidecar(name), *([name.with_suffix(".png")] if picture else [])]
    return not any(os.path.lexists(file) for file in files)


def save(
    table: pd.DataFrame,
    metadata: Mapping[str, Any],
    files: Files,
    force: bool,
    columns: list[str] | None = None,
) -> None:
    """Write the files; if another program has taken the name, under the next free one.

    A table for a text in LaTeX has the means only, unless columns are chosen. Columns of indices
    that were not computed are left out with a warning, so that the table is not lost.
    """
    path, picture, _ = files
    if not force and not _is_free(path, picture):
        free = free_claim(path, picture)
        try:
            save(table, metadata, Files(table_of(free), picture, free), force, columns)
        finally:
            free.release()
        return
    if columns is None and path.suffix.lower() == ".tex":
        columns = [*keys_of(table), *(f"{name}_mean" for name in table.attrs["indices"])]
    missing = [name for name in columns or () if name not in table]
    if missing:
        names = ", ".join(missing)
        why = "not among --indices, or without a parameter that they need, such as --length"
        warn(f"columns left out: {names}: {why}")
        columns = [name for name in columns or () if name in table] or None
    headings = latex_headings(table)
    write_table(table, path, metadata, columns=columns, headings=headings, overwrite=force)
    say(f"Table      {path} ({len(table)} rows), metadata {sidecar(path)}")
    if picture:
        draw(table, path.with_suffix(".png"), force)


def chosen_columns(texts: list[str] | None, also: Collection[str] = ()) -> list[str] | None:
    """Return the columns that are chosen: names of columns, or of indices for their means.

    Parameters
    ----------
    texts : list of str or None
    also : collection of str
        Columns that are neither shares nor statistics of an index.

    Raises
    ------
    UnknownName
        If a name is that of no column and no index.
    InvalidInput
        If there is no name, or an empty one.
    """
    if texts is None:
        return None
    known = {f"{name}_{statistic}" for name in INDICES for statistic in STATISTICS}
    known |= {*COLUMNS, *also}
    words = [word for text in texts for word in check_separated("--columns", text)]
    if not words:
        raise InvalidInput(expected("--columns", "at least one name", "none"))
    named = [*COLUMNS, *also]
    return [word if word in known else _mean_of(word, known, named) for word in words]


def _mean_of(word: str, known: set[str], named: Sequence[str]) -> str:
    try:
        return f"{index_name(word)}_mean"
    except UnknownIndex:
        hint = f"Known: {', '.join(named)}, and indices (CTN, control_number_min …)"
        raise UnknownName("column", word, sorted(known), hint) from None


def draw(table: pd.DataFrame, image: Path, force: bool) -> None:
    """Draw a ranking to a file."""
    from gsp import plots

    save_picture(plots.ranking(table), image, overwrite=force)
