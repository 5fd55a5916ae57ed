"""The errors that the library raises, each with the data that caused it."""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterable, Iterator
from typing import Any


class GspError(Exception):
    """Base of all errors; the message states the argument, what was expected and received."""

    def __str__(self) -> str:
        # KeyError would print the repr of its argument.
        return _printable(str(self.args[0])) if self.args else ""


class InvalidInput(GspError, ValueError):
    """An array or a number that cannot be used: wrong shape, not finite, out of range."""


class InvalidIndex(GspError, IndexError):
    """A number or slice that selects no pose of a batch."""


class InvalidRotation(InvalidInput):
    """A matrix that is not a rotation."""


class InvalidDesign(InvalidInput):
    """Dimensions that define no mechanism: too few constraints, a missing or zero direction."""


class EmptyWorkspace(InvalidInput):
    """A workspace without a point, or a radiating point outside of it."""


class UndefinedPosture(InvalidInput):
    """A pose at which an element has no value; `undefined` lists such joints with the reasons."""

    def __init__(self, design: str, undefined: Iterable[Any]) -> None:
        self.undefined = tuple(undefined)
        self._given = (design, self.undefined)
        pose, joint, reason = self.undefined[0]
        place = f"at pose {list(pose)}" if pose else "at this pose"
        message = expected(
            joint, "a value", f"none: {reason}", f"of {design or 'the design'} {place}"
        )
        more = len(self.undefined) - 1
        super().__init__(message + (f"; and {more} more" if more else ""))

    def __reduce__(self) -> tuple[Any, ...]:
        # An error crosses processes by pickling, which would give the message to __init__.
        return type(self), self._given


class MalformedFile(InvalidInput):
    """A data file that cannot be read: its path, line and key are in the message."""


class FailedComputation(GspError, ArithmeticError):
    """A printed number whose computation ends with an error; record and design are named."""


class MissingParameter(GspError, TypeError):
    """An index needs a length, an ellipsoid or a maximum that was not given."""


class MissingSoftware(GspError, ImportError):
    """A package that a function needs is not installed; the message names the way to install it."""

    def __init__(self, package: str, purpose: str, extra: str = "", hint: str = "") -> None:
        self.package, self.extra = package, extra
        self._given = (package, purpose, extra, hint)
        how = hint or f'pip install "gsp-mechanisms[{extra}]"'
        super().__init__(
            f"{purpose}: expected the package {package}, which is not installed; {how}"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._given


class UnwritableOutput(GspError, OSError):
    """A result could not be written, or would overwrite a file."""


class UnknownName(GspError, KeyError):
    """A name that is not known; the nearest known names are in the message."""

    def __init__(self, kind: str, name: str, known: Iterable[str], hint: str = "") -> None:
        names = tuple(known)
        self._given = (kind, name, names, hint)
        self.name = name
        near = difflib.get_close_matches(name[:LETTERS_PER_TEXT], names, n=3, cutoff=0.4)
        self.nearest = tuple(near)
        word, shown = ("nearest", self.nearest) if self.nearest else ("known", names)
        listed = 0 < len(shown) <= 20 and not (word == "known" and hint.startswith("Known:"))
        ending = f"; {word}: {', '.join(shown)}" if listed else ""
        super().__init__(f"unknown {kind} {brief(name)}{ending}{'. ' + hint if hint else ''}")

    def __reduce__(self) -> tuple[Any, ...]:
        # An error crosses processes by pickling, which would give the message to __init__.
        return type(self), self._given


class UnknownMechanism(UnknownName):
    """A name that is not that of one of the 195 mechanisms."""


class UnknownDesign(UnknownName):
    """Neither a published design nor a readable design file."""


class UnknownIndex(UnknownName):
    """A name that is not that of a performance index."""


# Longer messages, such as of a path of a million characters, lose their middle.
LETTERS_PER_MESSAGE = 1200
# Characters of a value in a message, and of a text about it.
LETTERS_PER_VALUE, LETTERS_PER_TEXT = 60, 300


def _printable(text: str) -> str:
    """Return a message that every terminal and file can hold.

    Control characters, but tabs and ends of lines, and lone surrogates are escaped.
    """
    if len(text) > LETTERS_PER_MESSAGE:
        text = f"{text[: LETTERS_PER_MESSAGE // 2]} … {text[-LETTERS_PER_MESSAGE // 4 :]}"
    escaped = _CONTROL.sub(lambda found: f"\\x{ord(found[0]):02x}", text)
    return escaped.encode("utf-8", "backslashreplace").decode()


_CONTROL = re.compile("[\\x00-\\x08\\x0b-\\x1f\\x7f-\\x9f]")


def expected(what: str, wanted: Any, got: Any, where: str = "") -> str:
    """Compose the message of an error: what, expected, received, where.

    Long values are cut, such as arrays.

    >>> expected("pose.position", "shape (..., 3)", "shape (2,)")
    'pose.position: expected shape (..., 3), received shape (2,)'
    """
    place = f" ({where})" if where else ""
    text = cut(got, LETTERS_PER_TEXT) if isinstance(got, str) else brief(got)
    return f"{what}{place}: expected {wanted}, received {text}"


# Digits of numbers in messages, and of the shortest text from which any double is read again.
DIGITS, MOST_DIGITS = 6, 17


def apart(*numbers: float) -> tuple[str, ...]:
    """Return texts of numbers, of six digits or of as many as tell unequal ones apart.

    So that a message does not state that a number is beyond a bound that looks the same.

    >>> apart(10.0, 12.5), apart(6.2831854, 6.2831853)
    (('10', '12.5'), ('6.2831854', '6.2831853'))
    """
    unequal = len({float(number) for number in numbers})
    for digits in range(DIGITS, MOST_DIGITS + 1):
        texts = tuple(f"{number:.{digits}g}" for number in numbers)
        if len(set(texts)) >= unequal:
            break
    return texts


def form_of(error: Exception) -> str:
    """Return what is wrong with a record whose members were read as if they were of the right form.

    The text of an error of the library is kept; those of Python are about Python.

    >>> form_of(KeyError("tree"))
    "a record without 'tree'"
    """
    if isinstance(error, GspError):
        return str(error)
    if isinstance(error, json.JSONDecodeError):
        return f"a text that is not JSON (line {error.lineno}, column {error.colno})"
    if isinstance(error, KeyError):
        return f"a record without {brief(error.args[0] if error.args else '')}"
    return "a record with members of another form"


_DATE = re.compile(r"datetime\.(date|time|datetime)\([^()]*(\([^()]*\([^()]*\)\))?[^()]*\)")


def brief(value: object) -> str:
    """Return the repr of a value on one line, cut to `LETTERS_PER_VALUE` characters.

    Dates, as TOML has them, are called so: "a date", "a time", "a datetime".
    """
    try:
        text = _DATE.sub(r"a \1", " ".join(repr(_first(value, [ITEMS_SHOWN])).split()))
    except RecursionError:
        text = f"a deeply nested {type(value).__name__}"
    except ValueError:  # Python writes no integers of thousands of digits
        text = f"a great {type(value).__name__}"
    except Exception:  # an object whose own `__repr__` fails
        text = f"an object of {type(value).__name__}"
    return cut(text)


# Items of a collection, and of those in it, that a message can hold: each has a separator.
ITEMS_SHOWN = LETTERS_PER_VALUE // 2


def _first(value: Any, left: list[int]) -> Any:
    """Return a collection with as many of its items, and of theirs, as a message can hold.

    Of a text as many characters as it can hold if each is escaped. `left` has the number of items
    that may follow, so that great collections, and those that repeat others, take no time.
    """
    kind = type(value)
    if kind in (str, bytes, bytearray):
        return value[: LETTERS_PER_TEXT * LETTERS_PER_VALUE]
    if kind is dict:
        pairs = _few(value.items(), left)
        return {_first(key, left): _first(one, left) for key, one in pairs}
    if kind in (list, tuple, set, frozenset):
        return kind(_first(x, left) for x in _few(value, left))
    return value


def _few(items: Iterable[Any], left: list[int]) -> Iterator[Any]:
    for number, item in enumerate(items):
        if number:
            if not left[0]:
                return
            left[0] -= 1
        yield item


def cut(text: str, most: int = LETTERS_PER_VALUE) -> str:
    """Return a text, cut to so many characters, for a message.

    >>> cut("9" * 5000, 10)
    '9999999...'
    """
    return text if len(text) <= most else text[: most - 3] + "..."
