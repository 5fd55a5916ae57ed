"""The files of `gsp rank`: a table, its metadata, and a picture, under one free name."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gsp.cli.console import say, warn
from gsp.cli.pictures import check_picture, save_picture
from gsp.errors import MissingSoftware, UnwritableOutput
from gsp.files.tables import check_table, sidecar, write_table

if TYPE_CHECKING:
    import pandas as pd

RESULT = Path("results/ranking.csv")


def check_outputs(out: Path | None, plot: bool | None, force: bool) -> tuple[Path, bool]:
    """Return the name of the table, and whether a picture will be drawn, before the work starts.

    Raises
    ------
    UnwritableOutput, MissingSoftware
        If the files could not be written.
    """
    drawn = plot is not False
    path = make_default() if out is None else out
    if out is None and not force:
        path = free_name(path, drawn)
    check_table(path, overwrite=force)
    try:
        if drawn:
            check_picture(path.with_suffix(".png"), overwrite=force)
    except MissingSoftware as error:
        if plot:
            raise
        warn(f"no picture: {error}")
        drawn = False
    return path, drawn


def make_default() -> Path:
    """Return the default name, after making its folder."""
    try:
        RESULT.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise UnwritableOutput(
            f"{RESULT.parent.resolve()}: cannot be made: {error.strerror}; "
            "expected a writable folder, or --out"
        ) from error
    return RESULT


def free_name(path: Path, picture: bool) -> Path:
    """Return the first of ranking.csv, ranking-2.csv, … of which no file exists."""
    for i in count(1):
        name = path.with_stem(f"{path.stem}-{i}") if i > 1 else path
        files = [name, sidecar(name), *([name.with_suffix(".png")] if picture else [])]
        if not any(file.exists() for file in files):
            break
    return name


def save(
    table: pd.DataFrame, metadata: Mapping[str, Any], path: Path, picture: bool, force: bool
) -> None:
    """Write the files; if the name was taken meanwhile, under the next one that is free."""
    target = path if force else free_name(path, picture)
    write_table(table, target, metadata, overwrite=force)
    say(f"Table      {target} ({len(table)} rows), metadata {sidecar(target)}")
    if picture:
        image = target.with_suffix(".png")
        draw(table, image, force)


def draw(table: pd.DataFrame, image: Path, force: bool) -> None:
    """Draw a ranking to a file."""
    from gsp import plots

    save_picture(plots.ranking(table), image, overwrite=force)
