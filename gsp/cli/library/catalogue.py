"""`gsp catalogue`: the 195 mechanisms, the published designs, and the files made from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from gsp.catalogue import designs as published_designs
from gsp.catalogue import mechanisms, table
from gsp.catalogue.pages import stale, write
from gsp.cli.inputs.options import Force, Out, refuse_unused
from gsp.cli.outputs.console import plain_table, say, show_table
from gsp.errors import InvalidInput, UnknownName
from gsp.files.knowledge import knowledge
from gsp.files.tables import check_table, write_table
from gsp.model.mechanism import NAMES

if TYPE_CHECKING:
    import pandas as pd

DESIGNS = ("name", "mechanism", "n_legs", "drives", "unit", "characteristic_length", "source")
PLANAR = ("name", "class", "chains", "mobility", "exchanged")
# Names of parameters that select mechanisms, and of those that select what is listed.
FILTERS = ("group", "constraint", "symmetric")
CHOICES = (*FILTERS, "designs", "planar", "out", "force")
SHOWN = ("name", "class", "chains", "n_legs", "loops", "symmetric", "mobility", "exchanged")


def catalogue(
    context: typer.Context,
    group: Annotated[
        list[str] | None,
        typer.Option(
            "--class",
            help="Only this class: 6D, 5D1A, 4D2A or 3D3A; may be repeated.",
            metavar="CLASS",
            show_default=False,
        ),
    ] = None,
    constraint: Annotated[
        list[str] | None,
        typer.Option(
            help="Only mechanisms with this constraint: D1, D2, D3, D4 or A1; if repeated, with "
            "all of them.",
            metavar="NAME",
            show_default=False,
        ),
    ] = None,
    symmetric: Annotated[
        bool, typer.Option("--symmetric", help="Only the four with six constraints of one kind.")
    ] = False,
    designs: Annotated[
        bool, typer.Option("--designs", help="The published designs instead of the mechanisms.")
    ] = False,
    planar: Annotated[
        bool, typer.Option("--planar", help="The 16 planar platforms instead of the mechanisms.")
    ] = False,
    out: Out = None,
    force: Force = False,
    write_files: Annotated[
        bool,
        typer.Option(
            "--write", help="In a checkout: write the generated files that are out of date."
        ),
    ] = False,
    check: Annotated[
        bool,
        typer.Option(
            "--check", help="In a checkout: exit status 1 if a generated file is out of date."
        ),
    ] = False,
) -> None:
    """List the 195 mechanisms, the 16 planar ones, or the published designs.

    **Examples**

    - `gsp catalogue --class 3D3A --constraint D2`

    - `gsp catalogue --designs`

    - `gsp catalogue --out mechanisms.csv`
    """
    if write_files or check:
        if write_files and check:
            raise InvalidInput("--write, --check: expected one of them, received both")
        refuse_unused(context, CHOICES, "--write" if write_files else "--check")
        _generated_files(write_files)
        return
    if designs and planar:
        raise InvalidInput("--designs, --planar: expected one of them, received both")
    if designs or planar:
        beside = f"{'--designs' if designs else '--planar'}, which lists all"
        refuse_unused(context, FILTERS, beside)
    if out is not None:
        check_table(out, overwrite=force)
    columns: tuple[str, ...]
    if designs:
        frame, columns, total = published_designs(), DESIGNS, "designs"
    elif planar:
        from gsp.planar import table as planar_table

        frame, columns, total = planar_table(), PLANAR, "planar platforms"
    else:
        frame = _chosen(group or [], constraint or [], symmetric)
        columns, total = SHOWN, f"of {len(mechanisms())} mechanisms"
    _print(frame[list(columns)])
    say(f"{len(frame)} {total}", "dim")
    if out is not None:
        write_table(frame, out, overwrite=force)
        say(f"Table      {out}")


def _chosen(groups: list[str], constraints: list[str], symmetric: bool) -> pd.DataFrame:
    frame = table()
    known = list(dict.fromkeys(frame["class"]))
    wanted = [_known("class", group, known) for group in groups]
    if wanted:
        frame = frame[frame["class"].isin(wanted)]
    for name in constraints:
        frame = frame[frame[f"n_{_known('constraint', name, NAMES)}"] > 0]
    if symmetric:
        frame = frame[frame["symmetric"]]
    return frame


def _known(kind: str, text: str, known: list[str] | tuple[str, ...]) -> str:
    if text.upper() not in known:
        raise UnknownName(kind, text, known, f"Known: {', '.join(known)}")
    return text.upper()


def _print(frame: pd.DataFrame) -> None:
    import pandas as pd

    numbers = tuple(str(c) for c in frame if pd.api.types.is_numeric_dtype(frame[c]))
    printed = plain_table(*map(str, frame.columns), right=numbers)
    for row in frame.itertuples(index=False):
        printed.add_row(*map(_cell, row))
    show_table(printed)


def _cell(value: Any) -> str:
    import pandas as pd

    if isinstance(value, bool):
        return "yes" if value else ""
    return "" if pd.isna(value) else f"{value:g}" if isinstance(value, float) else str(value)


def _generated_files(write_them: bool) -> None:
    root = knowledge()
    if not (root / "pyproject.toml").is_file():
        raise InvalidInput("--write, --check: expected a checkout, received an installed package")
    if write_them:
        written = write(root)
        for path in written:
            say(f"Written    {path}")
        if not written:
            say("Nothing to write: the files are those of the library")
        return
    files = stale(root)
    for path in files:
        say(f"Stale      {path} (gsp catalogue --write)")
    if files:
        raise typer.Exit(1)
    say("The files are those of the library")
