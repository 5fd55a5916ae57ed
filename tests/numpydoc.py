"""Sections and fields of numpydoc docstrings, for the test of docstrings."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass

SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)
FIELD = re.compile(r"^(?P<names>\*{0,2}\w+(?:, \*{0,2}\w+)*)(?: :(?P<kind>.*))?$")


@dataclass(frozen=True, kw_only=True)
class Field:
    """One entry of a section: a parameter, an attribute."""

    kind: str
    text: str


@dataclass(frozen=True, kw_only=True)
class Docstring:
    """A docstring: its first line, everything before the sections, and the sections."""

    first: str
    head: str
    sections: dict[str, str]

    def fields(self, *names: str) -> dict[str, Field]:
        """Entries of these sections by name; `a, b : float` gives two."""
        found = {}
        for name in names:
            for heading, text in _entries(self.sections.get(name, "")):
                match = FIELD.match(heading)
                if match:
                    field = Field(kind=(match["kind"] or "").strip(), text=text)
                    found |= {n.strip(" *"): field for n in match["names"].split(",")}
        return found


def parse(text: str | None) -> Docstring:
    """A docstring in its parts; without a text all parts are empty."""
    clean = inspect.cleandoc(text or "")
    head, *rest = SECTION.split(clean)
    sections = dict(zip(rest[::2], (part.strip("\n") for part in rest[1::2]), strict=True))
    return Docstring(first=clean.partition("\n")[0], head=head, sections=sections)


def _entries(section: str) -> list[tuple[str, str]]:
    """Lines that are not indented, each with the indented text below it."""
    entries: list[tuple[str, list[str]]] = []
    for line in section.splitlines():
        if line and not line[0].isspace():
            entries.append((line, []))
        elif entries:
            entries[-1][1].append(line)
    return [(heading, "\n".join(lines)) for heading, lines in entries]
