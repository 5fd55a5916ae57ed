"""`gsp check`: recompute every published number."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gsp.errors import InvalidInput, expected
from gsp.files import check_writable, write_text
from gsp.published import check as recompute
from gsp.published import summary

if TYPE_CHECKING:
    import pandas as pd

_SHOWN = (
    "paper",
    "place",
    "quantity",
    "printed",
    "computed",
    "digits",
    "verdict",
    "holds",
    "proof",
)


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
    overwrite: Annotated[bool, typer.Option(help="Let --out replace a file.")] = False,
) -> None:
    """Recompute every published number and print its verdict.

    Exit status 1 if a verdict no longer holds, 2 if a file of records is damaged.
    """
    if out is not None:
        _check_suffix(out)
        check_writable(out, overwrite=overwrite)
    checked = _with_progress(paper)
    table = checked if every else summary(checked)
    _print(table)
    if out is not None:
        text = table.to_csv(index=False) if out.suffix == ".csv" else markdown(table)
        write_text(out, text, overwrite=overwrite)
    broken = int((~summary(checked)["holds"]).sum())
    _tell(len(summary(checked)), len(checked), broken)
    if broken:
        raise typer.Exit(1)


def _check_suffix(out: Path) -> None:
    if out.suffix not in (".csv", ".md"):
        raise InvalidInput(expected("--out", "a name that ends in .csv or .md", str(out)))


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
    name = row["quantity"] + (f" {row['entry']}" if row["entry"] else "")
    return {
        **{key: str(row[key]) for key in ("paper", "place", "verdict", "proof")},
        "printed": f"{row['printed']} {row['unit']}".strip(),
        "quantity": name,
        "computed": computed if isinstance(computed, str) else f"{computed:.7g}",
        "digits": f"{row['agreed_digits']}/{row['of_digits']}",
        "holds": "yes" if row["holds"] else "NO",
    }


def markdown(table: pd.DataFrame) -> str:
    """Return the table as a Markdown table."""
    rows = [cells(row) for row in table.to_dict("records")]
    lines = ["| " + " | ".join(_SHOWN) + " |", "|" + " --- |" * len(_SHOWN)]
    lines += ["| " + " | ".join(r[k].replace("|", r"\|") for k in _SHOWN) + " |" for r in rows]
    return "\n".join(lines) + "\n"


def _print(table: pd.DataFrame) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    colours = {"reproduced": "green", "misprint": "yellow", "unreadable": "magenta"}
    shown = Table(box=None, header_style="bold")
    for key in _SHOWN:
        shown.add_column(key, overflow="fold", justify="right" if key == "computed" else "left")
    for row in table.to_dict("records"):
        texts = cells(row)
        style = {"verdict": colours[row["verdict"]], "holds": "green" if row["holds"] else "red"}
        shown.add_row(*(Text(texts[key], style=style.get(key, "")) for key in _SHOWN))
    Console().print(shown)


def _tell(records: int, entries: int, broken: int) -> None:
    verb = "all verdicts hold" if not broken else f"{broken} verdicts no longer hold"
    print(f"{records} records, {entries} printed numbers: {verb}")
