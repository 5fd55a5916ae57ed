"""`gsp check`: recompute every published number."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gsp.cli.inputs.options import Force, Out
from gsp.cli.outputs.console import counted, say, stdout
from gsp.files.tables import check_table, write_table
from gsp.files.writing import check_writable, write_text
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd

SHOWN = ("paper", "place", "quantity", "printed", "computed", "digits", "verdict", "holds", "proof")
COLOURS = {"reproduced": "green", "misprint": "yellow", "unreadable": "magenta"}
# Width of a terminal from which proofs are a column of the table; in a narrower one they follow it.
WIDE_TERMINAL = 140


def check(
    paper: Annotated[
        list[str] | None,
        typer.Option(
            help="Only this paper, such as TozKucuk2016; may be repeated.",
            metavar="KEY",
            show_default=False,
        ),
    ] = None,
    every: Annotated[
        bool,
        typer.Option("--all", help="One line per entry of a matrix instead of one per record."),
    ] = False,
    out: Out = None,
    page: Annotated[
        Path | None,
        typer.Option(
            "--errata",
            help="Write the page of misprints to this file (.md).",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Recompute every published number, and check its verdict.

    The exit status is 1 if a verdict no longer holds, also because a number cannot be computed,
    as with a damaged or missing design file; it is 2 if a file of records is damaged.

    **Examples**

    - `gsp check --paper TozKucuk2016 --all`

    - `gsp check --out numbers.csv`
    """
    from gsp.published import check as recompute
    from gsp.published import errata, select, select_slips, summary

    if out is not None:
        check_table(out, overwrite=force)
    if page is not None:
        check_writable(page, overwrite=force, suffixes=(".md",))
    checked = recompute(paper or None)
    records = summary(checked)
    table = checked if every else records
    _print(table)
    if out is not None:
        write_table(table, out, {"library": f"gsp {__version__}"}, overwrite=force)
        say(f"Table      {out}")
    if page is not None:
        text = errata(select(paper or None), select_slips(paper or None))
        write_text(page, text, overwrite=force)
        say(f"Errata     {page}")
    _conclude(checked, records)


def _conclude(checked: pd.DataFrame, records: pd.DataFrame) -> None:
    for failure in records.loc[records["failure"] != "", "failure"]:
        say(f"Not computed: {failure}", "red")
    broken = records.loc[~records["holds"], "record"].tolist()
    what = f"{counted(len(records), 'record')}, {counted(len(checked), 'printed number')}"
    if not broken:
        say(f"{what}: all verdicts hold")
        return
    verb = "NO LONGER HOLDS" if len(broken) == 1 else "NO LONGER HOLD"
    say(f"{what}: {counted(len(broken), 'verdict')} {verb} ({', '.join(broken)})", "red")
    raise typer.Exit(1)


def cells(row: Mapping[Hashable, Any]) -> dict[str, str]:
    """Return the texts of a row of the table."""
    single = row.get("entries", 1) == 1
    printed = f"{row['printed']} {row['unit']}".strip() if single else f"{row['entries']} entries"
    return {
        **{key: str(row[key]) for key in ("paper", "place", "verdict", "proof")},
        "quantity": f"{row['quantity']} {row['entry']}".strip(),
        "printed": row["text"] or printed,
        "computed": f"{row['computed']:.7g}" if single else f"{row['agreeing']} agree",
        "digits": f"{row['agreed_digits']}/{row['of_digits']}",
        "holds": "yes" if row["holds"] else "NO",
    }


def _print(table: pd.DataFrame) -> None:
    from rich.table import Table
    from rich.text import Text

    console = stdout()
    wide = console.width >= WIDE_TERMINAL
    columns = [key for key in SHOWN if wide or key not in ("paper", "proof")]
    printed = Table(box=None, pad_edge=False)
    for key in columns:
        printed.add_column(
            key,
            overflow="fold",
            no_wrap=key in ("digits", "verdict", "holds"),
            justify="right" if key == "computed" else "left",
            header_style="bold",
        )
    rows = [cells(row) for row in table.to_dict("records")]
    for row in rows:
        style = {"verdict": COLOURS[row["verdict"]], "holds": "red" if row["holds"] == "NO" else ""}
        printed.add_row(*(Text(row[key], style=style.get(key, "")) for key in columns))
    console.print(printed)
    if not wide:
        notes = [f"{r['paper']}, {r['place']}: {r['proof']}" for r in rows if r["proof"]]
        console.print(Text("\n".join(["", *dict.fromkeys(notes), ""])))
