"""Records of printed numbers: how `indices/published/*.toml` is read and validated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, NoReturn, TypeAlias, get_args

import numpy as np

from gsp.checks import plain_text
from gsp.errors import MalformedFile, expected
from gsp.files.knowledge import knowledge
from gsp.files.toml_lines import heads_of, line_of, parse_toml
from gsp.files.writing import read_text
from gsp.geometry.copies import ReadOnly
from gsp.published.numbers import Rounding

Verdict = Literal["reproduced", "misprint", "unreadable"]
Texts: TypeAlias = "np.ndarray[Any, np.dtype[np.str_]]"

TABLE = "value"
SLIPS = "slip"
# No print has more digits after the point.
MOST_DECIMALS = 100
_REQUIRED = ("paper", "place", "quantity", "printed", "verdict")
_TEXTS = ("paper", "place", "quantity", "text", "unit", "proof")
_CHOICES = MappingProxyType({"verdict": get_args(Verdict), "rounding": get_args(Rounding)})
_KEYS = (
    *_REQUIRED,
    "arguments",
    "invariant",
    "text",
    "unit",
    "rounding",
    "decimals",
    "correct",
    "proof",
)
_SLIP_KEYS = ("paper", "place", "text", "correct", "proof")


@dataclass(frozen=True, eq=False)
class Record(ReadOnly):
    """A printed number, vector or matrix, and what is known about it.

    Attributes
    ----------
    paper, place : str
        Key of the paper; equation, table, figure or section.
    quantity : str
        What it is: a name in the quantities of the paper.
    arguments : mapping
        Keywords of that quantity.
    invariant : tuple of str
        Arguments near whose given values the result does not depend on them: because this is the
        claim, or because they are start values of a search.
    printed : array of str, shape () for a number
        As printed; an entry with an empty text is not compared.
    text : str
        The printed text, where `printed` only follows from it (such as the error 0 of a formula).
    decimals : int or None
        Digits after the point that the print has, where it leaves out zeros at the end.
    unit : str
    rounding : "rounded", "cut" or "exact"
    verdict : "reproduced", "misprint" or "unreadable"
    correct : array of str or None
        What it should be, in the shape of `printed`.
    proof : str
        Why it is a misprint, or under which interpretation it is reproduced.
    origin : str
        File and line.
    """

    paper: str
    place: str
    quantity: str
    arguments: Mapping[str, Any]
    invariant: tuple[str, ...]
    printed: Texts
    text: str
    decimals: int | None
    unit: str
    rounding: Rounding
    verdict: Verdict
    correct: Texts | None
    proof: str
    origin: str

    @property
    def names(self) -> Mapping[str, float]:
        """Arguments that are numbers [their units]: letters that an exact expression may use."""
        return {
            key: float(value)
            for key, value in self.arguments.items()
            if isinstance(value, int | float) and not isinstance(value, bool)
        }


@dataclass(frozen=True)
class Slip:
    """A slip of the text that no number depends on, such as a wrong reference to a section.

    Attributes
    ----------
    paper, place : str
        Key of the paper; equation or section.
    text, correct : str
        The printed text, and what it should be.
    proof : str
        Why.
    """

    paper: str
    place: str
    text: str
    correct: str
    proof: str


def record_files() -> tuple[Path, ...]:
    """Return the files of published numbers, sorted by name."""
    return tuple(sorted(knowledge("indices", "published").glob("*.toml")))


def read_records(path: str | Path) -> tuple[Record, ...]:
    """Return the records in one file of published numbers.

    Parameters
    ----------
    path : str or path

    Returns
    -------
    tuple of Record
        In the order of the file.

    Raises
    ------
    MalformedFile
        If it cannot be read, is not TOML, or has a wrong key or value; the message names the file,
        the line, the record and the key.
    """
    lines, tables = _tables(path, TABLE)
    heads = heads_of(lines, TABLE) + [1] * len(tables)  # the line is 1 where there is no head
    return tuple(
        _Reader(lines, str(path), i).record(table, heads[i]) for i, table in enumerate(tables)
    )


def read_slips(path: str | Path) -> tuple[Slip, ...]:
    """Return the slips of the text in one file of published numbers.

    Parameters
    ----------
    path : str or path

    Returns
    -------
    tuple of Slip
        In the order of the file.

    Raises
    ------
    MalformedFile
        As `read_records`.
    """
    lines, tables = _tables(path, SLIPS)
    readers = (_Reader(lines, str(path), i, SLIPS) for i in range(len(tables)))
    return tuple(reader.slip(table) for reader, table in zip(readers, tables, strict=True))


def _tables(path: str | Path, name: str) -> tuple[list[str], list[dict[str, Any]]]:
    """Return the lines of a file and its tables of one name, after a check of all names."""
    path = plain_text(path)
    text, origin = read_text(path), str(path)
    data = parse_toml(text, origin)
    lines = text.splitlines()
    for key in data:
        if key not in (TABLE, SLIPS):
            message = expected("key", f"tables [[{TABLE}]] or [[{SLIPS}]]", repr(key))
            raise MalformedFile(f"{origin}, line {line_of(lines, key)}, key {key!r}: {message}")
    if TABLE not in data:
        raise MalformedFile(f"{origin}: " + expected("file", f"tables [[{TABLE}]]", "none"))
    tables = data.get(name, [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise MalformedFile(f"{origin}: " + expected("file", f"tables [[{name}]]", repr(tables)))
    return lines, tables


@dataclass(frozen=True)
class _Reader:
    """Reads one record, with the line of each key."""

    lines: list[str]
    origin: str
    number: int
    table: str = TABLE

    def fail(self, key: str, message: str) -> NoReturn:
        line = line_of(self.lines, key, self.table, self.number)
        raise MalformedFile(
            f"{self.origin}, line {line}, record {self.number + 1}, key {key!r}: {message}"
        )

    def keys(self, data: dict[str, Any], known: tuple[str, ...], needed: tuple[str, ...]) -> None:
        for key in data:
            if key not in known:
                self.fail(key, expected("key", "one of " + ", ".join(known), repr(key)))
        for key in needed:
            if key not in data:
                self.fail(key, "expected this key, received none")

    def slip(self, data: dict[str, Any]) -> Slip:
        self.keys(data, _SLIP_KEYS, _SLIP_KEYS)
        for key, value in data.items():
            if not isinstance(value, str) or not value.strip():
                self.fail(key, expected("value", "a text", repr(value)))
        return Slip(**data)

    def record(self, data: dict[str, Any], line: int) -> Record:
        self.keys(data, _KEYS, _REQUIRED)
        printed = self.texts(data, "printed")
        correct = self.texts(data, "correct") if "correct" in data else None
        if correct is not None and correct.shape != printed.shape:
            shapes = f"shape {printed.shape}", f"shape {correct.shape}"
            self.fail("correct", expected("value", *shapes))
        texts = {key: self.text(data, key) for key in _TEXTS}
        if data["verdict"] == "misprint" and not texts["proof"].strip():
            self.fail("proof", expected("value", "a proof, as the verdict is misprint", "none"))
        if data["verdict"] == "reproduced" and correct is not None:
            self.fail("correct", expected("key", "none, as the verdict is reproduced", "correct"))
        arguments = self.arguments(data)
        return Record(
            **texts,
            arguments=MappingProxyType(arguments),
            invariant=self.invariant(data, arguments),
            printed=printed,
            decimals=self.decimals(data),
            rounding=self.choice(data, "rounding", "rounded"),
            verdict=self.choice(data, "verdict", ""),
            correct=correct,
            origin=f"{Path(self.origin).name}:{line}",
        )

    def text(self, data: dict[str, Any], key: str) -> str:
        value = data.get(key, "")
        if not isinstance(value, str) or (key in _REQUIRED and not value):
            self.fail(key, expected("value", "a text", repr(value)))
        return value

    def choice(self, data: dict[str, Any], key: str, default: str) -> Any:
        value = data.get(key, default)
        if value not in _CHOICES[key]:
            self.fail(key, expected("value", "one of " + ", ".join(_CHOICES[key]), repr(value)))
        return value

    def arguments(self, data: dict[str, Any]) -> dict[str, Any]:
        value = data.get("arguments", {})
        if not isinstance(value, dict):
            self.fail("arguments", expected("value", "a table", repr(value)))
        return value

    def invariant(self, data: dict[str, Any], arguments: dict[str, Any]) -> tuple[str, ...]:
        value = data.get("invariant", [])
        if not isinstance(value, list) or not all(name in arguments for name in value):
            self.fail("invariant", expected("value", "names of arguments", repr(value)))
        return tuple(value)

    def decimals(self, data: dict[str, Any]) -> int | None:
        value = data.get("decimals")
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= MOST_DECIMALS:
            self.fail("decimals", expected("value", f"0 to {MOST_DECIMALS}", repr(value)))
        return value

    def texts(self, data: dict[str, Any], key: str) -> Texts:
        """Read a text, or nested arrays of texts of one shape."""
        value = data[key]
        try:
            array = np.array(value, dtype=object)
        except ValueError:
            self.fail(key, expected("value", "rows of one length", repr(value)))
        if not all(isinstance(entry, str) for entry in array.flat) or not any(array.flat):
            self.fail(
                key, expected("value", "a text, or arrays of texts of one shape", repr(value))
            )
        result = array.astype(np.str_)
        result.flags.writeable = False
        return result
