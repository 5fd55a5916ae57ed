"""Files of spaces of designs: a function, and ranges, choices and fixed values of its arguments."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from gsp.catalogue import place
from gsp.cli.inputs.designs import find_design
from gsp.errors import InvalidInput, MalformedFile, UnknownName, expected
from gsp.exploration import Space
from gsp.families.texts import FAMILIES, function_of_family
from gsp.files.toml_lines import line_of, parse_toml
from gsp.files.writing import read_text
from gsp.model.design import Design

# The function that puts legs on the positions of a template.
PLACE = "place"
MAKERS = (*FAMILIES, PLACE)
TABLES = ("ranges", "choices", "fixed")
# Table, or table and key, with which messages on a space begin.
_PLACE = re.compile(r"space(?:\.(\w+)(?:\['(.+?)'\])?)?: ")


def read_space(path: Path) -> Space:
    """Return the space of a TOML file: `make`, and the tables [ranges], [choices] and [fixed].

    `make` is a family of `gsp.families.texts`, whose angles are in degrees, or "place", whose
    argument `template` is a design as commands take it.

    Raises
    ------
    MalformedFile
        If the file cannot be read, is not TOML, or has a wrong key or value: with the file, the
        line and the key.
    """
    text, origin = read_text(path), str(path)
    data, lines = parse_toml(text, origin), text.split("\n")
    for key, value in data.items():
        wanted = "a text" if key == "make" else f"a table [{key}]"
        if key not in ("make", *TABLES):
            got = expected("key", "one of " + ", ".join(("make", *TABLES)), repr(key))
        elif not isinstance(value, str if key == "make" else dict):
            got = expected("value", wanted, repr(value))
        else:
            continue
        raise MalformedFile(f"{origin}, line {line_of(lines, key)}, key {key!r}: {got}")
    if "make" not in data:
        raise MalformedFile(f"{origin}: expected the key 'make', one of {', '.join(MAKERS)}")
    try:
        return Space(_function(data["make"]), *(data.get(name, {}) for name in TABLES))
    except (InvalidInput, UnknownName) as error:
        raise MalformedFile(f"{origin}{_at_key(lines, str(error))}") from error


def _at_key(lines: Sequence[str], text: str) -> str:
    """Return a message on a space after the file: the line and the key, and what is wrong."""
    found = _PLACE.match(text)
    table, key = ("make", None) if found is None else found.groups()
    if table is None:
        return f": {text}"
    line = line_of(lines, table) if key is None else line_of(lines, key, table)
    path = table if key is None else f"{table}.{key}"
    return f", line {line}, key {path!r}: {text if found is None else text[found.end() :]}"


def _function(name: str) -> Callable[..., Design]:
    if name == PLACE:
        return _placed
    if name not in FAMILIES:
        raise UnknownName("make", name, MAKERS)
    return function_of_family(name)


def _placed(*, legs: str, template: Any) -> Design:
    if not isinstance(template, str):
        raise InvalidInput(expected("template", "the name or file of a design", repr(template)))
    return place(legs, find_design(template))
