"""Output on the terminal: lines, tables and numbers."""

from __future__ import annotations

from typing import Literal

from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

# A pipe or a file has no width of its own: no line is broken or cut there.
WIDTH = 1000
# Columns of prose, which a narrow terminal may break into lines, and their least width.
PROSE, LEAST = ("source", "row"), 24


def stdout() -> Console:
    """Return the console of results."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = max(console.width, WIDTH)
    return console


def say(text: str, style: str = "") -> None:
    """Print one line of text as it is: no markup, no colours of numbers, no wrapping."""
    stdout().print(Text(text, style=style), soft_wrap=True)


def warn(text: str) -> None:
    """Print one line on stderr that is not an error."""
    Console(stderr=True, highlight=False).print(Text(f"gsp: {text}", "yellow"), soft_wrap=True)


def number(value: float, digits: int = 4) -> str:
    """Return a number with so many significant digits; "–" stands for an undefined one."""
    if value != value:
        return "–"
    return f"{value:#.{digits}g}" if value else "0"


def plain_table(*columns: str, title: str = "", right: tuple[str, ...] = ()) -> Table:
    """Return an empty table with these headings; those named in `right` hold numbers."""
    table = Table(title=title or None, title_justify="left", box=None, pad_edge=False)
    for heading in columns:
        justify: Literal["left", "right"] = "right" if heading in right else "left"
        prose = heading in PROSE
        table.add_column(
            heading, justify=justify, no_wrap=not prose, overflow="fold", header_style="bold"
        )
    return table


def show_table(table: Table) -> None:
    """Print a table; where the terminal is too narrow, prose is broken and no number is cut."""
    console = stdout()
    texts = [[column.header, *column.cells] for column in table.columns]
    widths = [max(cell_len(str(text)) for text in column) for column in texts]
    needed = sum(min(w, LEAST) if c[0] in PROSE else w for w, c in zip(widths, texts, strict=True))
    console.width = max(console.width, needed + 2 * len(widths))
    console.print(table, soft_wrap=False, crop=False, overflow="ignore")
