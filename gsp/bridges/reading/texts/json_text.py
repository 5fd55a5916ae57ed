"""The text of a JSON file: its contents, and the line of each value."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gsp.errors import MalformedFile, brief, cut, expected

# Python refuses integers of more than 4300 digits; beyond 309 all of them are infinite floats.
DIGITS_OF_INTEGERS = 400
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\],:]|[^\s{}\[\],:"]+')


def joined(where: str, key: str) -> str:
    """Return the place of a key in what is at a place.

    >>> joined("", "points"), joined("model", "points")
    ('points', 'model.points')
    """
    return f"{where}.{key}" if where else key


def repeated(path: Path, line: int, key: str) -> MalformedFile:
    """Return the error about a key that a mapping has twice."""
    place = f"{path}, line {line}, key {cut(key)}"
    return MalformedFile(expected(place, "each key once", "it again"))


def integer(text: str) -> int | float:
    """Return the number of a text of digits, infinite if it has very many."""
    return int(text) if len(text) <= DIGITS_OF_INTEGERS else float(text)


def from_json(path: Path, text: str) -> tuple[Any, Iterator[tuple[str, int]]]:
    """Return the contents of a text, and the places of its values with their lines.

    Raises
    ------
    MalformedFile
    """
    repeats = False

    def mapping(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        nonlocal repeats
        found = dict(pairs)
        repeats = repeats or len(found) < len(pairs)
        return found

    try:
        content = json.loads(text, parse_int=integer, object_pairs_hook=mapping)
    except json.JSONDecodeError as error:
        raise MalformedFile(f"{path}, line {error.lineno}: not JSON: {error.msg}") from error
    except (ValueError, RecursionError) as error:
        raise MalformedFile(f"{path}: not JSON: {brief(str(error))}") from error
    if repeats:
        place, line = next((place, line) for place, line, again in _json_places(text) if again)
        raise repeated(path, line, place)
    return content, (found[:2] for found in _json_places(text))


def _json_places(text: str) -> Iterator[tuple[str, int, bool]]:
    """Yield for each value of a text in JSON its keys, its line, and whether it has one again."""
    # Of each object or array around: its keys, and those that it has had, or its length.
    around: list[tuple[str, set[str] | None]] = []
    counts: list[int] = []
    key, line, end = None, 1, 0
    for found in _TOKEN.finditer(text):
        token = found[0]
        line, end = line + text.count("\n", end, found.start()), found.start()
        if token in "}]":
            around.pop()
            counts.pop()
        elif token == ",":
            key, counts[-1] = None, counts[-1] + 1
        elif token != ":":
            where, keys = around[-1] if around else ("", set())
            if around and keys is not None and key is None:
                key = json.loads(token)
                continue
            place, again = where, False
            if keys is None:
                place = f"{where}[{counts[-1]}]"
            elif key is not None:
                place, again = joined(where, key), key in keys
                keys.add(key)
            yield place, line, again
            if token in "{[":
                around.append((place, set() if token == "{" else None))
                counts.append(0)
                key = None
