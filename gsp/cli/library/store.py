"""`gsp store …`: the store of maxima of |det J|."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, cast

import typer

from gsp.cli.inputs.options import Force
from gsp.cli.outputs.console import number, plain_table, say, show_table, warn
from gsp.determinant.store import (
    MissingStore,
    Store,
    StoreError,
    checked_entry,
    damage,
    location,
    open_store,
)
from gsp.determinant.store.exchange import export_maxima, import_maxima
from gsp.errors import InvalidInput, brief, expected

store = typer.Typer(
    name="store",
    invoke_without_command=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@store.callback()
def alone(context: typer.Context) -> None:
    """List, export and import the stored maxima of |det J|.

    The store is a SQLite file in the user's data folder. The environment variable GSP_STORE names
    another one (a path or a SQLAlchemy URL); with GSP_STORE=off there is none.
    """
    if context.invoked_subcommand is None:
        say(context.get_help())


@store.command("path")
def path() -> None:
    """Print the location of the store."""
    say(location() or "off")


@store.command("list")
def listing() -> None:
    """Print the stored maxima, each with its state: valid, or damaged.

    |det J| is computed at the stored pose; an entry whose value differs is damaged.
    """
    try:
        opened = _opened()
    except MissingStore as missing:
        say(f"{_counted(0)}: {missing}")
        return
    entries = opened.rows()
    right = ("|det J|max", "starts", "agreed", "evaluations")
    table = plain_table("key", "state", "legs", *right, "domain", "library", "found", right=right)
    wrong = []
    for row in entries:
        key = str(row["key"])[:12]
        if reason := damage(row):
            wrong.append((key, reason))
            table.add_row(key, "damaged", *[""] * 8)
        else:
            table.add_row(key, "valid", *_cells(checked_entry(row)))
    show_table(table)
    say(f"{_counted(len(entries) - len(wrong))}, of designs of size 1, in {opened.url}")
    for key, reason in wrong:
        warn(f"{key} is damaged and not used: {reason}")


@store.command("export")
def export(
    file: Annotated[Path, typer.Argument(help="The file to write: .csv or .json.")],
    force: Force = False,
) -> None:
    """Write all valid maxima to a file that others can import; damaged ones are left out."""
    written, damaged = export_maxima(_opened(), file, overwrite=force)
    say(f"{_counted(written)} written to {file}")
    if damaged:
        warn(f"{_counted(damaged)} left out as damaged; `gsp store list` gives the reasons")


@store.command("import")
def importing(
    file: Annotated[Path, typer.Argument(help="The file that `gsp store export` wrote.")],
) -> None:
    """Read maxima from a file; each value is checked, and better ones replace worse ones."""
    _refuse_without_store()
    read, stored, outdated = import_maxima(lambda: _opened(make=True), file)
    say(f"{_counted(read)} read, {stored} of them new or better")
    if outdated:
        warn(
            f"{_counted(outdated)} of another method of searching (an older or newer gsp) left out"
        )


@store.command("remove")
def remove(
    key: Annotated[str, typer.Argument(help="A key, or the beginning of one, as in `list`.")],
) -> None:
    """Remove one maximum."""
    if not key.strip():
        raise InvalidInput(expected("key", "the beginning of one key", brief(key)))
    opened = _opened()
    keys = [k for row in opened.rows() if (k := str(row["key"])).startswith(key)]
    if len(keys) != 1:
        raise InvalidInput(
            expected("key", "the beginning of one key", f"{brief(key)}, that of {len(keys)}")
        )
    opened.remove(keys[0])
    say(f"removed {keys[0]}")


def _cells(row: dict[str, Any]) -> list[str]:
    """Return the cells of a valid entry after its key and state."""
    numbers = [str(int(row[name])) for name in ("starts", "agreed", "evaluations")]
    found = "" if row["found"] is None else _minute(row["found"])
    domain = "all poses" if not row["domain"] else str(json.loads(row["domain"])[0])
    value = number(float(row["value"]), 10)
    return [_legs(row["design"]), value, *numbers, domain, str(row["library"]), found]


def _minute(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d %H:%M")


def _counted(number: int) -> str:
    return "1 maximum" if number == 1 else f"{number} maxima"


def _opened(*, make: bool = False) -> Store:
    """Return the store; only a command that writes to it makes one that is not there."""
    _refuse_without_store()
    return cast(Store, open_store(make=make))


def _refuse_without_store() -> None:
    if location() is None:
        raise StoreError("store: expected one, but GSP_STORE has switched it off")


def _legs(text: str) -> str:
    legs = json.loads(text)["legs"]
    return " ".join(dict.fromkeys(f"{legs.count(leg)}×{leg}" for leg in legs))
