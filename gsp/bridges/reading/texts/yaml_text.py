"""The text of a YAML file: its contents, with the numbers of YAML 1.2, and the line of each key."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from gsp.bridges.reading.texts.json_text import DIGITS_OF_INTEGERS, integer, joined, repeated
from gsp.errors import MalformedFile, brief, expected
from gsp.installed import optional

# Pairs of a mapping after merges, which may double with each merge of a merged one.
MERGED_PAIRS = 100_000
MERGE = "tag:yaml.org,2002:merge"
INTEGER, REAL = "tag:yaml.org,2002:int", "tag:yaml.org,2002:float"
# Numbers of YAML 1.2. YAML 1.1, which PyYAML reads, has 1:30 for 90, 010 for 8 and 1_0 for 10, and
# takes 1e3 for a text.
_INTEGER = re.compile(r"([-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+)\Z")
_REAL = re.compile(
    r"([-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN))\Z"
)
# Prefixes of integers of other bases.
BASES = {"0o": 8, "0x": 16}


def from_yaml(path: Path, text: str) -> tuple[Any, Iterator[tuple[str, int]]]:
    """Return the contents of a text, and the places of its values with their lines.

    Raises
    ------
    MalformedFile
    MissingSoftware
        If PyYAML is not installed.
    """
    with optional("yaml", "a file in YAML", "yaml"):
        import yaml  # type: ignore[import-untyped]
    try:
        loader = _loader(yaml)(text)
        node = loader.get_single_node()
        lines = list(_yaml_places(path, node, "", set()))
        _check_merges(path, node)
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
    return content, iter(lines)


def _number(text: str) -> int | float:
    base = BASES.get(text[:2])
    if base is None:
        return integer(text)
    digits = text[2:].lstrip("0") or "0"
    return int(digits, base) if len(digits) <= DIGITS_OF_INTEGERS else float("inf")


def _real(text: str) -> float:
    return float(text.replace(".", "") if text[-1:].isalpha() else text)  # .inf and .nan


def _loader(yaml: Any) -> Any:
    """Return the safe loader of PyYAML, with the numbers of YAML 1.2."""
    resolvers = {
        first: [(tag, pattern) for tag, pattern in pairs if tag not in (INTEGER, REAL)]
        for first, pairs in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }
    loader: Any = type("Loader", (yaml.SafeLoader,), {"yaml_implicit_resolvers": resolvers})
    loader.add_implicit_resolver(INTEGER, _INTEGER, list("-+0123456789"))
    loader.add_implicit_resolver(REAL, _REAL, list("-+.0123456789"))
    loader.add_constructor(INTEGER, lambda self, node: _number(self.construct_scalar(node)))
    loader.add_constructor(REAL, lambda self, node: _real(self.construct_scalar(node)))
    return loader


def _check_merges(path: Path, node: Any) -> None:
    """Refuse merges << of merged mappings that write the same keys again and again."""
    waiting, seen, known = [node], set[int](), dict[int, int]()
    while waiting:
        at = waiting.pop()
        if at is None or id(at) in seen or at.id == "scalar":
            continue
        seen.add(id(at))
        if at.id == "sequence":
            waiting += at.value
            continue
        if _merged_pairs(at, known) > MERGED_PAIRS:
            wanted = f"at most {MERGED_PAIRS} keys of merged mappings"
            place = f"{path}, line {at.start_mark.line + 1}"
            raise MalformedFile(expected(place, wanted, "more"))
        waiting += [part for pair in at.value for part in pair]


def _merged_pairs(node: Any, known: dict[int, int]) -> int:
    """Return how many pairs a mapping has when the mappings are written out that it merges."""
    if id(node) not in known:
        count = 0
        for key, value in node.value:
            if key.tag != MERGE:
                count += 1
                continue
            for one in value.value if value.id == "sequence" else [value]:
                count += _merged_pairs(one, known) if one.id == "mapping" else 1
        known[id(node)] = count
    return known[id(node)]


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
                raise repeated(path, key.start_mark.line + 1, joined(where, key.value))
            keys.add((key.tag, key.value))
        parts = [(joined(where, key.value), value) for key, value in named]
    elif node.id == "sequence":
        parts = [(f"{where}[{i}]", value) for i, value in enumerate(node.value)]
    for place, value in parts:
        yield from _yaml_places(path, value, place, seen)
