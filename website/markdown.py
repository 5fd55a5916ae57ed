"""Pieces of Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence


def table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table; a bar in a cell is escaped."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(cell(text) for text in line) + " |" for line in lines)


def cell(text: object) -> str:
    """Return the text of a cell of a table: one line, bars escaped."""
    return re.sub(r"[ \t\n]+", " ", str(text)).strip(" ").replace("|", "\\|")


def fence(text: str, language: str = "text") -> str:
    """Return a block of code, fenced by more backticks than it contains in a row."""
    marks = "```"
    while marks in text:
        marks += "`"
    return f"{marks}{language}\n{text.rstrip()}\n{marks}"


def page(*parts: str) -> str:
    """Return a page of these paragraphs; empty ones are left out."""
    return "\n\n".join(part.strip("\n") for part in parts if part) + "\n"
