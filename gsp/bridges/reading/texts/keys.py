"""Contents of JSON and YAML files, of which errors name the file, the line and the key."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn

from gsp import arguments
from gsp.bridges.reading.texts.json_text import from_json, joined
from gsp.bridges.reading.texts.yaml_text import from_yaml
from gsp.errors import LETTERS_PER_TEXT, MalformedFile, brief, cut, expected
from gsp.files.writing import read_text

PACKAGE_BYTES = 10_000_000  # bytes


class _Source:
    """The file of the keys; where they are is only looked up for an error."""

    def __init__(self, path: Path, places: Iterator[tuple[str, int]]) -> None:
        self.path, self._places = path, places

    @cached_property
    def lines(self) -> Mapping[str, int]:
        return dict(self._places)


class Keys:
    """The contents of a file; errors name the file, the line and the key."""

    def __init__(self, source: _Source, content: Any, where: str = "") -> None:
        self._source, self._where = source, where
        self.content = content

    def __getitem__(self, key: str | int) -> Keys:
        """Return what is at a key, which must be there."""
        place = f"{self._where}[{key}]" if isinstance(key, int) else joined(self._where, key)
        content = self.content
        if not isinstance(content, list if isinstance(key, int) else dict):
            self.fail("a list" if isinstance(key, int) else "a mapping of keys")
        try:
            found: Any = self.content[key]
        except (KeyError, IndexError):
            self._fail(place, "a value", "none")
        return Keys(self._source, found, place)

    def __contains__(self, key: str) -> bool:
        """Whether there is a key."""
        return isinstance(self.content, dict) and key in self.content

    def names(self) -> list[str]:
        """Return the keys of a mapping, as texts."""
        if not isinstance(self.content, dict):
            self.fail("a mapping of keys")
        return list(map(str, self.content))

    def items(self, least: int = 0) -> list[Keys]:
        """Return the entries of a list, of which there must be some."""
        if not isinstance(self.content, list) or len(self.content) < least:
            self.fail(f"a list of at least {least} entries" if least else "a list")
        return [self[i] for i in range(len(self.content))]

    def text(self) -> str:
        """Return a text that is not empty."""
        if not isinstance(self.content, str) or not self.content:
            self.fail("a name")
        return self.content

    def number(self) -> float:
        """Return a number whose square is finite."""
        value = self.content
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail("a finite number")
        try:
            found = float(value)
        except OverflowError:
            found = math.inf
        if not math.isfinite(found):
            self.fail("a finite number")
        if abs(found) > arguments.LARGEST_NUMBER:
            self.fail(f"a number of at most {arguments.LARGEST_NUMBER:g} in size")
        return found

    def between(self, low: float, high: float, wanted: str) -> float:
        """Return a number in an interval."""
        found = self.number()
        if not low <= found <= high:
            self.fail(wanted)
        return found

    def flag(self) -> bool:
        """Return a truth value, which may be written as 0 or 1."""
        if not isinstance(self.content, bool | int | float) or self.content not in (0, 1):
            self.fail("true or false, 1 or 0")
        return bool(self.content)

    def size(self) -> float:
        """Return a length whose inverse is finite."""
        low, high = 1.0 / arguments.LARGEST_NUMBER, arguments.LARGEST_NUMBER
        return self.between(low, high, "a number > 0")

    def vector(self, count: int = 3) -> list[float]:
        """Return numbers in a list, or in a column: a list of lists of one number each."""
        if not isinstance(self.content, list) or len(self.content) != count:
            self.fail(f"{count} numbers")
        each = [self[i] for i in range(count)]
        if all(isinstance(x.content, list) and len(x.content) == 1 for x in each):
            each = [x[0] for x in each]
        return [x.number() for x in each]

    def fail(self, wanted: str) -> NoReturn:
        """Raise an error about what is here.

        Raises
        ------
        MalformedFile
        """
        self._fail(self._where, wanted, brief(self.content))

    def _fail(self, where: str, wanted: str, got: str) -> NoReturn:
        near, lines = where, self._source.lines
        while near and near not in lines:
            near = near[: max(near.rfind("."), near.rfind("["), 0)]
        line = f", line {lines[near]}" if near in lines else ""
        named = f", key {cut(where, LETTERS_PER_TEXT)}" if where else ""
        raise MalformedFile(expected(f"{self._source.path}{line}{named}", wanted, got))


def read_keys(path: Path) -> Keys:
    """Return the contents of a file: of JSON by its suffix, else of YAML.

    Raises
    ------
    MalformedFile
        With the file and line, also for a key that an object has twice.
    MissingSoftware
        If the file is YAML, and PyYAML is not installed.
    """
    text = read_text(path, most=PACKAGE_BYTES)
    read = from_json if path.suffix.lower() == ".json" else from_yaml
    content, places = read(path, text)
    return Keys(_Source(path, places), content)
