"""`gsp check`: recompute every published number."""

from __future__ import annotations

import os
from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gsp.errors import InvalidInput, expected
from gsp.files import check_writable, write_text
from gsp.published import check as recompute
from gsp.published import errata, select, summary

if TYPE_CHECKING:
    import pandas as pd

SHOWN = ("paper", "place", "quantity", "printed", "computed", "digits", "verdict", "holds", "proof")
COLOURS = {"reproduced": "green", "misprint": "yellow", "unreadable": "magenta"}
# From this width of the terminal on, proofs stand in the table; below it they follow.
WIDE = 150


def check(
    paper: Annotated[
        list[str] | None, typer.Option(help="Key of a paper, such as TozKucuk2016; repeatable.")
    ] = None,
    every: Annotated[
        bool, typer.Option("--all", help="A line an entry of a matrix, not a line a record.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="Write the table to this .csv or .md file as well.")
    ] = None,
    page: Annotated[
        Path | None, typer.Option("--errata", help="Write the misprints to this .md file as well.")
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace existing files.")] = False,
) -> None:
    """Recompute every published number and print its verdict.

    Exit status 1 if a verdict no longer holds, 2 if a file of records is damaged.
    """
    _check_outputs(out, page, overwrite)
    checked = _with_progress(paper)
    records = summary(checked)
    table = checked if every else records
    _print(table)
    if out is not None:
        text = table.to_csv(index=False) if out.suffix == ".csv" else markdown(table)
        write_text(out, text, overwrite=overwrite)
    if page is not None:
        write_text(page, errata(select(paper or None)), overwrite=overwrite)
    broken = int((~records["holds"]).sum())
    verdict = f"{broken} verdicts NO LONGER HOLD" if broken else "all verdicts hold"
    print(f"{len(records)} records, {len(checked)} printed numbers: {verdict}")
    if broken:
        raise typer.Exit(1)


def _check_outputs(out: Path | None, page: Path | None, overwrite: bool) -> None:
    for option, path, suffixes in (("--out", out, (".csv", ".md")), ("--errata", page, (".md",))):
        if path is None:
            continue
        if path.suffix not in suffixes:
            wanted = "a name that ends in " + " or ".join(suffixes)
            raise InvalidInput(expected(option, wanted, str(path)))
        check_writable(path, overwrite=overwrite)


def _with_progress(papers: list[str] | None) -> pd.DataFrame:
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("checking", total=None)
        return recompute(
            papers or None,
            progress=lambda done, total: bar.update(task, completed=done, total=total),
        )


def cells(row: Mapping[Hashable, Any]) -> dict[str, str]:
    """Return what a row of the table shows, as texts."""
    computed = row["computed"]
    return {
        **{key: str(row[key]) for key in ("paper", "place", "verdict", "proof")},
        "quantity": f"{row['quantity']} {row['entry']}".strip(),
        "printed": row["text"] or f"{row['printed']} {row['unit']}".strip(),
        "computed": computed if isinstance(computed, str) else f"{computed:.7g}",
        "digits": f"{row['agreed_digits']}/{row['of_digits']}",
        "holds": "yes" if row["holds"] else "NO",
    }


def markdown(table: pd.DataFrame) -> str:
    """Return the table as a Markdown table."""
    rows = [cells(row) for row in table.to_dict("records")]
    lines = ["| " + " | ".join(SHOWN) + " |", "|" + " --- |" * len(SHOWN)]
    lines += ["| " + " | ".join(r[k].replace("|", r"\|") for k in SHOWN) + " |" for r in rows]
    return "\n".join(lines) + "\n"


def _print(table: pd.DataFrame) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console()
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console = Console(width=250)
    wide = console.width >= WIDE
    shown = Table(box=None, header_style="bold")
    columns = [key for key in SHOWN if wide or key not in ("paper", "proof")]
    for key in columns:
        shown.add_column(
            key,
            overflow="fold",
            no_wrap=key in ("digits", "verdict", "holds"),
            justify="right" if key == "computed" else "left",
        )
    rows = [cells(row) for row in table.to_dict("records")]
    for row in rows:
        style = {"verdict": COLOURS[row["verdict"]], "holds": "red" if row["holds"] == "NO" else ""}
        shown.add_row(*(Text(row[key], style=style.get(key, "")) for key in columns))
    console.print(shown)
    if not wide:
        notes = [f"{r['paper']}, {r['place']}: {r['proof']}" for r in rows if r["proof"]]
        console.print(Text("\n".join(["", *dict.fromkeys(notes), ""])))
