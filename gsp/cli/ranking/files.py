"""The files of `gsp rank` and `gsp explore`: table, metadata, picture, under one free name."""

from __future__ import annotations

import shutil
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gsp.checks import check_separated
from gsp.cli.interrupts import INTERRUPTED
from gsp.cli.outputs.console import say, warn
from gsp.cli.outputs.pictures import check_picture, save_picture
from gsp.errors import (
    InvalidInput,
    MissingSoftware,
    UnknownIndex,
    UnknownName,
    UnwritableOutput,
    expected,
)
from gsp.files.tables import check_table, sidecar, write_table
from gsp.indices import INDICES, index_name
from gsp.ranking import STATISTICS
from gsp.ranking.restrictions import FEASIBLE, WITHIN_STROKES

if TYPE_CHECKING:
    import pandas as pd

RESULT = Path("results/ranking.csv")
KEYS = ("rank", "design", "class")
# Columns that are not statistics of an index.
COLUMNS = (*KEYS, "mechanism", "n_legs", "singular", "undefined", WITHIN_STROKES, FEASIBLE)


@contextmanager
def outputs(
    out: Path | None, plot: bool | None, force: bool, resume: bool, default: Path = RESULT
) -> Iterator[tuple[Path, bool]]:
    """Yield what `check_outputs` returns; the folder of a default name goes if it stays empty."""
    made = out is None and not default.parent.exists()
    try:
        yield check_outputs(out, plot, force, resume, default)
    finally:
        if made:
            with suppress(OSError):  # it has files, or was not made
                default.parent.rmdir()


def check_outputs(
    out: Path | None, plot: bool | None, force: bool, resume: bool, default: Path = RESULT
) -> tuple[Path, bool]:
    """Return the name of the table, and whether a picture will be drawn, before the work starts.

    Without a name it is the first free one, or, to resume, that of the last interrupted run.

    Raises
    ------
    UnwritableOutput, MissingSoftware
        If the files could not be written.
    """
    drawn = plot is not False
    path = make_default(default) if out is None else out
    if out is None and not force:
        path = (interrupted(path) if resume else None) or free_name(path, drawn)
    check_table(path, overwrite=force)
    try:
        if drawn:
            check_picture(path.with_suffix(".png"), overwrite=force)
    except MissingSoftware as error:
        if plot:
            raise
        warn(f"no picture: {error}")
        drawn = False
    if force and not resume and parts_of(path).joinpath("job.json").is_file():
        shutil.rmtree(parts_of(path))
    return path, drawn


def parts_of(path: Path) -> Path:
    """Return the folder with the rows of finished designs while a ranking is computed."""
    return path.with_name(path.name + ".parts")


def interrupted(path: Path) -> Path | None:
    """Return the name of the last interrupted run among the default names."""
    folders = path.parent.glob(f"{path.stem}*{path.suffix}.parts")
    found = sorted(folders, key=lambda folder: folder.stat().st_mtime)
    return found[-1].with_suffix("") if found else None


def make_default(path: Path) -> Path:
    """Return a default name, after making its folder."""
    try:
        path.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise UnwritableOutput(
            f"{path.parent}: cannot be made: {error.strerror}; expected a writable folder, or --out"
        ) from error
    return path


def stopped(path: Path, stored: str = "the rows of {} designs are kept") -> int:
    """Print what of an interrupted run is stored, and return its exit status."""
    kept = len(list(parts_of(path).glob("part-*")))
    if kept:
        what = f"{stored.format(kept)} in {parts_of(path)}; --resume continues"
    else:
        what = "nothing was written"
        if parts_of(path).is_dir():
            shutil.rmtree(parts_of(path))
    warn(f"stopped; {what}")
    return INTERRUPTED


def free_name(path: Path, picture: bool) -> Path:
    """Return the first of ranking.csv, ranking-2.csv, … of which no file exists."""
    for i in count(1):
        name = path.with_stem(f"{path.stem}-{i}") if i > 1 else path
        files = [
            name,
            sidecar(name),
            parts_of(name),
            *([name.with_suffix(".png")] if picture else []),
        ]
        if not any(file.exists() for file in files):
            break
    return name


def save(
    table: pd.DataFrame,
    metadata: Mapping[str, Any],
    path: Path,
    picture: bool,
    force: bool,
    columns: list[str] | None = None,
) -> None:
    """Write the files; if the name is no longer free, under the next free one.

    A table for a text in LaTeX has the means only, unless columns are chosen. Columns of indices
    that were not computed are left out with a warning, so that the table is not lost.
    """
    target = path if force else free_name(path, picture)
    if columns is None and target.suffix.lower() == ".tex":
        columns = [*KEYS, *(f"{name}_mean" for name in table.attrs["indices"])]
    missing = [name for name in columns or () if name not in table]
    if missing:
        names = ", ".join(missing)
        warn(f"columns left out: {names}: not computed, as a parameter such as --length is missing")
        columns = [name for name in columns or () if name in table] or None
    write_table(table, target, metadata, columns=columns, overwrite=force)
    say(f"Table      {target} ({len(table)} rows), metadata {sidecar(target)}")
    if picture:
        image = target.with_suffix(".png")
        draw(table, image, force)


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
