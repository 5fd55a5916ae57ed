"""Reading a space of designs from TOML, with errors that have file, line and key."""

from __future__ import annotations

import re
from collections.abc import Sequence

from gsp.catalogue import design as published_design
from gsp.errors import InvalidInput, MalformedFile, UnknownName, expected
from gsp.exploration.space import Space
from gsp.exploration.space_toml import MAKERS, Find, function_of_name
from gsp.families.texts import design_of_family, is_family
from gsp.files.toml_lines import line_of, parse_toml
from gsp.model.design import Design, read_design

TABLES = ("ranges", "choices", "fixed")
# Table, or table and key, with which messages on a space begin, and the place in a list.
_PLACE = re.compile(r"space(?:\.(\w+)(?:\['(.+?)'\])?)?( \(at index .+?\))?: ")


def find_design(text: str) -> Design:
    """Return the design of a text: a file (.toml), a family with parameters, or a published one.

    Raises
    ------
    MalformedFile, InvalidInput, UnknownDesign
    """
    if text.lower().endswith(".toml"):
        return read_design(text)
    return design_of_family(text) if is_family(text) else published_design(text)


def space_from_toml(text: str, origin: str, find: Find = find_design) -> Space:
    """Return the space of a TOML text: `make`, and the tables [ranges], [choices] and [fixed].

    Parameters
    ----------
    text : str
    origin : str
        Names the file in errors.
    find : function (text) -> Design
        Finds the template of a placement.

    Raises
    ------
    MalformedFile
        If it is not TOML, or has a wrong key or value: with the file, the line and the key.
    """
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
        make = function_of_name(data["make"], find)
        return Space(make, *(data.get(name, {}) for name in TABLES))
    except (InvalidInput, UnknownName) as error:
        raise MalformedFile(f"{origin}{_at_key(lines, str(error))}") from error


def _at_key(lines: Sequence[str], text: str) -> str:
    """Return a message on a space after the file: the line and the key, and what is wrong."""
    found = _PLACE.match(text)
    table, key, item = ("make", None, None) if found is None else found.groups()
    if table is None:
        return f": {text}"
    line = line_of(lines, table) if key is None else line_of(lines, key, table)
    path = table if key is None else f"{table}.{key}"
    rest = text if found is None else text[found.end() :]
    return f", line {line}, key {path!r}{item or ''}: {rest}"
