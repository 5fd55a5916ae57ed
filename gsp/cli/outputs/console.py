"""Output on the terminal: lines, tables and numbers."""

from __future__ import annotations

import os
import sys
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest

from rich.cells import cell_len
from rich.console import Console
from rich.text import Text

from gsp.cli.outputs.pipes import drop
from gsp.rounding import rounded_down, rounded_up

# A pipe or a file has no width of its own: no line is broken or cut there.
UNBROKEN_WIDTH = 1000
# Columns of prose, which a narrow terminal may break into lines, and their least width.
PROSE_COLUMNS, LEAST_PROSE_WIDTH = ("source", "row"), 24
# Between two columns.
COLUMN_GAP = "  "


class Output(Console):
    """A console that does not end the command when its pipe is closed, as files follow."""

    def on_broken_pipe(self) -> None:
        """Drop what is printed from now on; rich would end the process."""
        self.quiet = True
        drop(sys.stderr if self.stderr else sys.stdout)


def stdout() -> Console:
    """Return the console of results; its width is COLUMNS, if that is set."""
    console = Output(highlight=False)
    if not (console.is_terminal or os.environ.get("COLUMNS", "").isdigit()):
        console.width = max(console.width, UNBROKEN_WIDTH)
    return console


def say(text: str, style: str = "") -> None:
    """Print one line of text as it is: no markup, no colours of numbers, no wrapping."""
    stdout().print(Text(text, style=style), soft_wrap=True)


def warn(text: str) -> None:
    """Print one line on stderr that is not an error."""
    Output(stderr=True, highlight=False).print(Text(f"gsp: {text}", "yellow"), soft_wrap=True)


def number(value: float, digits: int = 4) -> str:
    """Return a number with so many significant digits; "–" stands for an undefined one."""
    if value != value:
        return "–"
    return f"{value:#.{digits}g}".removesuffix(".") if value else "0"


def between(low: float, high: float) -> str:
    """Return the words for two proven ends: rounded, they are still true."""
    return f"between {number(rounded_down(low, 4))} and {number(rounded_up(high, 4))}"


@dataclass(frozen=True, kw_only=True)
class Table:
    """A table of texts for the terminal.

    Attributes
    ----------
    headings : tuple of str
    title : str
        The line above it, "" for none.
    right : tuple of str
        Headings of the columns that hold numbers.
    rows : list of tuple of str
    """

    headings: tuple[str, ...]
    title: str = ""
    right: tuple[str, ...] = ()
    rows: list[tuple[str, ...]] = field(default_factory=list)

    def add_row(self, *cells: str) -> None:
        """Append a row, one text per column."""
        self.rows.append(cells)


def plain_table(*columns: str, title: str = "", right: tuple[str, ...] = ()) -> Table:
    """Return an empty table with these headings; those named in `right` hold numbers."""
    return Table(headings=columns, title=title, right=right)


def show_table(table: Table) -> None:
    """Print a table; where the terminal is too narrow, prose is broken and no number is cut.

    Cells are set here and not by rich, which takes 20 s for a design of 5,000 legs.
    """
    console = stdout()
    columns = list(zip(table.headings, *table.rows, strict=True))
    widths = [max(map(cell_len, column)) for column in columns]
    surplus = sum(widths) + len(COLUMN_GAP) * (len(widths) - 1) - console.width
    for i, heading in enumerate(table.headings):
        if heading in PROSE_COLUMNS and surplus > 0:
            narrower = max(min(widths[i], LEAST_PROSE_WIDTH), widths[i] - surplus)
            surplus -= widths[i] - narrower
            widths[i] = narrower
    right = [heading in table.right for heading in table.headings]
    if table.title:
        console.out(table.title, highlight=False)
    console.out("\n".join(_lines(table.headings, widths, right)), style="bold", highlight=False)
    lines = [line for row in table.rows for line in _lines(row, widths, right)]
    if lines:
        console.out("\n".join(lines), highlight=False)


def _lines(row: Sequence[str], widths: Sequence[int], right: Sequence[bool]) -> Iterator[str]:
    """Yield the lines of a row: one, or more where a text is broken."""
    cells = [
        [text] if cell_len(text) <= width else textwrap.wrap(text, width)
        for text, width in zip(row, widths, strict=True)
    ]
    for parts in zip_longest(*cells, fillvalue=""):
        padded = [
            " " * (width - cell_len(part)) + part
            if numeric
            else part + " " * (width - cell_len(part))
            for part, width, numeric in zip(parts, widths, right, strict=True)
        ]
        yield COLUMN_GAP.join(padded).rstrip()


def counted(number: int, noun: str) -> str:
    """Return a number with its noun, in the singular or in the plural."""
    return f"{number} {noun}" + ("" if number == 1 else "s")
