"""Contents of JSON and YAML files, of which errors name the file, the line and the key."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn

from gsp import arguments
from gsp.checks import optional
from gsp.errors import LETTERS_PER_TEXT, MalformedFile, brief, cut, expected
from gsp.files.writing import read_text

PACKAGE_BYTES = 10_000_000  # bytes
# Python refuses integers of more than 4300 digits; beyond 309 all of them are infinite floats.
DIGITS_OF_INTEGERS = 400
MERGE = "tag:yaml.org,2002:merge"
INTEGER, REAL = "tag:yaml.org,2002:int", "tag:yaml.org,2002:float"
_INTEGER = re.compile(r"[-+]?[0-9]+\Z")
# Numbers of YAML 1.2, as C++ programs read them. YAML 1.1, which PyYAML reads, has 1:30 for 90,
# 010 for 8 and 1_0 for 10, and takes 1e3 for a text.
_REAL = re.compile(
    r"([-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN))\Z"
)
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\],:]|[^\s{}\[\],:"]+')


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
        place = f"{self._where}[{key}]" if isinstance(key, int) else _joined(self._where, key)
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
        """Return numbers in a list, each perhaps in a list of its own."""
        if not isinstance(self.content, list) or len(self.content) != count:
            self.fail(f"{count} numbers")
        each = [self[i] for i in range(count)]
        return [
            (x[0] if isinstance(x.content, list) and len(x.content) == 1 else x).number()
            for x in each
        ]

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
    return _from_json(path, text) if path.suffix.lower() == ".json" else _from_yaml(path, text)


def _joined(where: str, key: str) -> str:
    return f"{where}.{key}" if where else key


def _repeated(path: Path, line: int, key: str) -> MalformedFile:
    place = f"{path}, line {line}, key {cut(key)}"
    return MalformedFile(expected(place, "each key once", "it again"))


def _integer(text: str) -> int | float:
    return int(text) if len(text) <= DIGITS_OF_INTEGERS else float(text)


def _real(text: str) -> float:
    return float(text.replace(".", "") if text[-1:].isalpha() else text)  # .inf and .nan


def _from_json(path: Path, text: str) -> Keys:
    repeats = False

    def mapping(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        nonlocal repeats
        found = dict(pairs)
        repeats = repeats or len(found) < len(pairs)
        return found

    try:
        content = json.loads(text, parse_int=_integer, object_pairs_hook=mapping)
    except json.JSONDecodeError as error:
        raise MalformedFile(f"{path}, line {error.lineno}: not JSON: {error.msg}") from error
    except (ValueError, RecursionError) as error:
        raise MalformedFile(f"{path}: not JSON: {brief(str(error))}") from error
    if repeats:
        place, line = next((place, line) for place, line, again in _json_places(text) if again)
        raise _repeated(path, line, place)
    return Keys(_Source(path, (found[:2] for found in _json_places(text))), content)


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
                place, again = _joined(where, key), key in keys
                keys.add(key)
            yield place, line, again
            if token in "{[":
                around.append((place, set() if token == "{" else None))
                counts.append(0)
                key = None


def _from_yaml(path: Path, text: str) -> Keys:
    with optional("yaml", "a file in YAML", "yaml"):
        import yaml  # type: ignore[import-untyped]
    try:
        loader = _loader(yaml)(text)
        node = loader.get_single_node()
        lines = list(_yaml_places(path, node, "", set()))
        content = None if node is None else loader.construct_document(node)
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        got = repr(chr(error.character))
        message = expected(f"{path}, line {line}", "no control characters", got)
        raise MalformedFile(message) from error
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        at = f", line {mark.line + 1}" if mark is not None else ""
        raise MalformedFile(f"{path}{at}: not YAML: {error.problem}") from error
    except MalformedFile:
        raise
    # PyYAML raises the last three for wrong values of explicit tags, such as "!!bool x".
    except (
        *(yaml.YAMLError, ValueError, RecursionError),
        *(AttributeError, LookupError, TypeError),
    ) as error:
        raise MalformedFile(f"{path}: not YAML: {brief(str(error))}") from error
    return Keys(_Source(path, iter(lines)), content)


def _loader(yaml: Any) -> Any:
    """Return the safe loader of PyYAML, with the numbers of YAML 1.2."""
    resolvers = {
        first: [(tag, pattern) for tag, pattern in pairs if tag not in (INTEGER, REAL)]
        for first, pairs in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }
    loader: Any = type("Loader", (yaml.SafeLoader,), {"yaml_implicit_resolvers": resolvers})
    loader.add_implicit_resolver(INTEGER, _INTEGER, list("-+0123456789"))
    loader.add_implicit_resolver(REAL, _REAL, list("-+.0123456789"))
    loader.add_constructor(INTEGER, lambda self, node: _integer(self.construct_scalar(node)))
    loader.add_constructor(REAL, lambda self, node: _real(self.construct_scalar(node)))
    return loader


def _yaml_places(path: Path, node: Any, where: str, seen: set[int]) -> Iterator[tuple[str, int]]:
    """Yield the line of each key of a YAML file; what aliases repeat is yielded once.

    Raises
    ------
    MalformedFile
        If a mapping has a key twice.
    """
    if where and node is not None:
        yield where, node.start_mark.line + 1
    if node is None or id(node) in seen:
        return
    seen.add(id(node))
    parts: Sequence[tuple[str, Any]] = ()
    if node.id == "mapping":
        named = [(key, value) for key, value in node.value if key.id == "scalar"]
        keys: set[tuple[str, str]] = set()
        for key, _ in named:
            if key.tag != MERGE and (key.tag, key.value) in keys:
                raise _repeated(path, key.start_mark.line + 1, _joined(where, key.value))
            keys.add((key.tag, key.value))
        parts = [(_joined(where, key.value), value) for key, value in named]
    elif node.id == "sequence":
        parts = [(f"{where}[{i}]", value) for i, value in enumerate(node.value)]
    for place, value in parts:
        yield from _yaml_places(path, value, place, seen)
