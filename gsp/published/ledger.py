"""Ledgers: which equations, figures and tables a paper has, and why some have no record."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gsp import arguments
from gsp.errors import MalformedFile, expected
from gsp.files.knowledge import knowledge
from gsp.files.toml_lines import parse_toml
from gsp.files.writing import read_text
from gsp.published.record import Record

_KEYS = ("paper", "equations", "figures", "tables", "without_record", "statements")
_TOKENS = re.compile(
    r"eqs?\.|figures?|[Tt]ables?\b|\(?(?:[A-D]\.)?\d[\d.]*\)?(?: \([a-z]\))?|[-–]|[^\W\d]\w*"
)
_KINDS = MappingProxyType(
    {"eq.": "eq. ({})", "eqs.": "eq. ({})", "figure": "figure {}", "table": "table {}"}
)
# The only table of a paper that does not number it.
_TABLE = "Table"


@dataclass(frozen=True, eq=False)
class Ledger:
    """The contents of a paper.

    Attributes
    ----------
    paper : str
    items : tuple of str
        All equations, figures and tables, such as "eq. (3)", "figure 2 (b)", "table 1";
        "Table" for the only one of a paper that does not number it.
    without_record : mapping from str to str
        Items that no record names, and why.
    statements : mapping from str to str
        Numeric statements of the text beside them: where they are recorded, as "record: place", or
        why they are not.
    """

    paper: str
    items: tuple[str, ...]
    without_record: Mapping[str, str]
    statements: Mapping[str, str]


def ledger_files() -> tuple[Path, ...]:
    """Return the files of ledgers, sorted by name."""
    return tuple(sorted(knowledge("indices", "published", "ledger").glob("*.toml")))


@arguments.validated(path=arguments.path)
def read_ledger(path: str | Path) -> Ledger:
    """Return the ledger in a file.

    Parameters
    ----------
    path : str or path

    Returns
    -------
    Ledger

    Raises
    ------
    MalformedFile
        If it cannot be read, is not TOML, or has a wrong key or value.
    """
    origin = Path(path).name
    data = parse_toml(read_text(path), origin)
    if set(data) != set(_KEYS):
        raise MalformedFile(f"{origin}: " + expected("keys", ", ".join(_KEYS), ", ".join(data)))
    texts = {key: _texts(origin, key, data[key]) for key in ("without_record", "statements")}
    names = ("eq. ({})", "figure {}", "table {}")
    items = tuple(
        number if number == _TABLE else form.format(number)
        for key, form in zip(_KEYS[1:4], names, strict=True)
        for number in _numbers(origin, key, data[key])
    )
    return Ledger(str(data["paper"]), items, **texts)


def _texts(origin: str, key: str, value: Any) -> Mapping[str, str]:
    if not isinstance(value, dict) or not all(isinstance(v, str) and v for v in value.values()):
        raise MalformedFile(f"{origin}, key {key!r}: " + expected("value", "texts", repr(value)))
    return MappingProxyType(value)


def _numbers(origin: str, key: str, value: Any) -> Iterator[str]:
    """Expand "1-3" and "A.1-A.3" in a list of numbers."""
    if not isinstance(value, list) or not all(isinstance(entry, str) for entry in value):
        raise MalformedFile(f"{origin}, key {key!r}: " + expected("value", "texts", repr(value)))
    for entry in value:
        first, dash, last = entry.partition("-")
        yield from _between(first, last) if dash else (entry,)


def _between(first: str, last: str) -> Iterator[str]:
    stem, low = _split(first)
    other, high = _split(last)
    if stem != other or high < low:
        raise MalformedFile(expected("range", "numbers of one chapter", f"{first}-{last}"))
    yield from (f"{stem}{number}" for number in range(low, high + 1))


def _split(text: str) -> tuple[str, int]:
    """Split "A.12" into "A." and 12."""
    head, dot, tail = text.rpartition(".")
    if not tail.isdecimal():
        raise MalformedFile(expected("range", "numbers such as 3 or A.3", repr(text)))
    return head + dot, int(tail)


def items_of(place: str) -> frozenset[str]:
    """Return the equations, figures and tables that the place of a record names.

    A figure with parts, such as "figure 2 (b)", is named by its parts.

    Examples
    --------
    >>> sorted(items_of("eqs. (8)-(10), figure 7 (a)"))
    ['eq. (10)', 'eq. (8)', 'eq. (9)', 'figure 7 (a)']
    """
    return frozenset(_items(place))


def _items(place: str) -> Iterator[str]:
    form, before, range_of = "", "", False
    tokens = _TOKENS.findall(place)
    for token, after in zip(tokens, [*tokens[1:], ""], strict=True):
        if token == _TABLE and not after[:1].isdigit():
            yield _TABLE
        if token[0] in "-–":
            range_of = True
        elif token[0] == "(" or token[0].isdigit() or "." in token[1:-1]:
            number = token.replace("(", "").replace(")", "") if form.startswith("eq") else token
            names = tuple(_between(before, number))[1:] if range_of and before else (number,)
            yield from (form.format(name) for name in names if form)
            before, range_of = number, False
        elif token != "and":
            word = "table" if token in ("Table", "Tables") else token.removesuffix("s")
            form, before = _KINDS.get(word, _KINDS.get(token, "")), ""


@arguments.validated(ledger=arguments.kind(Ledger), records=arguments.many(Record))
def unaccounted(ledger: Ledger, records: Iterable[Record]) -> tuple[str, ...]:
    """Return what is wrong with a ledger: items in neither list, in both, or not in the paper.

    Parameters
    ----------
    ledger : Ledger
    records : sequence of Record
        Of any papers.

    Returns
    -------
    tuple of str
        A sentence for each; empty if the records and the ledger account for every item.

    Raises
    ------
    InvalidInput
        If `ledger` is not a Ledger, or on items that are not records.
    """
    own = [record for record in records if record.paper == ledger.paper]
    places = {record.place for record in own}
    named = frozenset(item for place in places for item in items_of(place))
    excused = set(ledger.without_record)
    wrong = [f"{i}: no record, and no reason" for i in ledger.items if i not in named | excused]
    wrong += [f"{i}: a record, and a reason for none" for i in sorted(excused & named)]
    wrong += [f"{i}: not in the ledger" for i in sorted((named | excused) - set(ledger.items))]
    for statement, where in ledger.statements.items():
        key, colon, place = where.partition("record: ")
        if colon and not key and place not in places:
            wrong.append(f"{statement}: no record at {place!r}")
    return tuple(wrong)
