"""Checks of arguments: each returns the checked value or raises InvalidInput."""

from __future__ import annotations

import operator
import os
import sys
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from itertools import chain, islice
from types import UnionType
from typing import Any, TypeGuard, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.errors import GspError, InvalidInput, brief, expected

Array = NDArray[np.float64]
T = TypeVar("T")

# The least number whose inverse is finite.
SMALLEST = float(np.finfo(np.float64).tiny)
# Bytes of memory that are assumed where the system does not state them.
ASSUMED_MEMORY = 16 * 2**30
# Items of an argument that are taken from it one by one: more, as of range(10**9), are a mistake.
MOST_ITEMS = 10_000_000
# From so many on, the shape of nested sequences is looked at before they are read.
MANY_ITEMS = 100_000
# Levels of nested sequences whose lengths are looked at; arguments have up to five axes or so.
MOST_NESTING = 8
NUMBER_BYTES = 8
# Leading axes of a batch. numpy broadcasts 32 axes in all, and matrices of legs have up to four.
MOST_BATCH_AXES = 28
# Characters of a text, such as a description; and of one of one line, such as a name or a unit.
MOST_LETTERS, MOST_LETTERS_OF_LINE = 100_000, 1000
WHITESPACE = "\t\n\r"
# Unicode categories: control, format (no width, direction), separators of lines and paragraphs.
HIDDEN = ("Cc", "Cf", "Zl", "Zp")


@contextmanager
def reading(what: str, wanted: str, value: Any) -> Iterator[None]:
    """Enclose what calls methods of an object of the user, which may raise anything.

    Raises
    ------
    InvalidInput
        For whatever the object raises, but for lack of memory; errors of the library are kept.
    """
    try:
        yield
    except (GspError, MemoryError):
        raise
    except Exception as error:
        raise InvalidInput(expected(what, wanted, brief(value))) from error


def has(value: Any, name: str) -> bool:
    """Whether an object has an attribute; whatever it raises when it is asked means no."""
    try:
        return hasattr(value, name)
    except Exception:  # `hasattr` catches AttributeError alone
        return False


def plain_text(value: Any) -> Any:
    """Return the text of a subclass of str as a str, anything else as it is.

    The methods of a subclass may raise, or compare in another way than texts do.
    """
    return str.__str__(value) if type(value) is not str and is_a(value, str) else value


def is_a(value: Any, kind: type[T] | UnionType | tuple[type, ...]) -> TypeGuard[T]:
    """Whether the type of a value is a subclass of a class, whatever class the value states.

    An object may state another class as its `__class__`, of which it has no attribute, or raise an
    error when it is asked, which `isinstance` does.
    """
    try:
        return issubclass(type(value), kind)
    except Exception:  # of a metaclass
        return False


def check_array(
    what: str,
    value: ArrayLike,
    shape: Sequence[int | None],
    *,
    finite: bool = True,
    axes: int | None = None,
) -> Array:
    """Return `value` as float64 if its last axes are `shape` (None: any size), else raise.

    It has at most `axes` axes, where that is given: with as many as `shape` has, just this shape.

    Raises
    ------
    InvalidInput
        On a wrong type or shape, or on numbers that are not finite.
    """
    array = _real(what, value, shape, axes)
    if finite and not np.isfinite(array).all():
        if not array.ndim:
            raise InvalidInput(expected(what, "a finite number", str(array)))
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise InvalidInput(
            expected(what, "finite numbers", str(array[where]), f"at index {list(where)}")
        )
    return array


_PLAIN_NUMBERS = frozenset({float, int, np.float64, np.float32, np.int64, np.int32})
_LISTS = frozenset({list, tuple})
_NO_NUMBERS = (str, bytes, bytearray, bool, type(None))


def _real(
    what: str, value: ArrayLike, shape: Sequence[int | None] = (), axes: int | None = None
) -> Array:
    """Float64 of integers, floats and objects that are real numbers; not of text or booleans.

    Lengths and shape are looked at before numbers are copied.
    """
    if type(value) is np.ndarray and value.dtype == np.float64 and value.flags.c_contiguous:
        _check_shape(what, value.shape, shape, axes)  # by far the most arrays
        return value
    try:
        if type(value) is not np.ndarray:
            _check_lengths(what, value, shape, axes)
        raw = np.asarray(value)
        if raw.dtype.kind not in "iufO" or is_a(value, _NO_NUMBERS):
            raise TypeError(raw.dtype)
        objects = raw.dtype.kind == "O"
        if not objects:
            _check_shape(what, raw.shape, shape, axes)
        if raw.size > MANY_ITEMS:
            check_memory(what, raw.size, NUMBER_BYTES, "numbers")
        odd = objects and any(is_a(x, _NO_NUMBERS) for x in raw.flat)
        if odd or np.ma.is_masked(value):
            raise TypeError(raw.dtype)
        with np.errstate(over="ignore"):
            numbers = np.asarray(raw, dtype=np.float64, order="C")
        if objects:  # now that they are known to be numbers
            _check_shape(what, raw.shape, shape, axes)
        return numbers
    except InvalidInput:
        raise
    except MemoryError as error:
        wanted = "real numbers that fit into the memory"
        raise InvalidInput(expected(what, wanted, str(error) or brief(value))) from error
    except Exception as error:  # also what an object's own `__array__` or `__float__` raises
        raise InvalidInput(expected(what, "real numbers", brief(value))) from error


def _check_shape(
    what: str, given: tuple[int, ...], shape: Sequence[int | None], axes: int | None
) -> None:
    """Raise InvalidInput unless the last of at most `axes` axes are `shape`, None for any size."""
    batched = axes is None or axes > len(shape)
    if axes is not None and len(given) > axes and batched:
        wanted = "one number, or one axis of them" if axes == 1 else f"at most {axes} axes"
        raise InvalidInput(expected(what, wanted, f"shape {given}"))
    if len(given) > len(shape) + MOST_BATCH_AXES:
        got = f"{len(given)} axes"
        raise InvalidInput(expected(what, f"at most {len(shape) + MOST_BATCH_AXES} axes", got))
    fits = len(given) >= len(shape) if batched else len(given) == len(shape)
    last = given[len(given) - len(shape) :] if fits else None
    if last is None or any(w is not None and w != g for w, g in zip(shape, last, strict=True)):
        sizes = ["..."] * batched + ["n" if w is None else str(w) for w in shape]
        comma = "," if len(sizes) == 1 and not batched else ""
        wanted = f"shape ({', '.join(sizes)}{comma})"
        raise InvalidInput(expected(what, wanted, f"shape {given}"))


def _check_lengths(what: str, value: Any, shape: Sequence[int | None], axes: int | None) -> None:
    """Raise InvalidInput if a sequence holds too many numbers, or many in another shape.

    The lengths of what lists hold at each level are added before any of it is read.
    """
    if type(value) in _LISTS and len(value) > MANY_ITEMS:
        _check_first(what, value, shape, axes)
    level = [value]
    for _ in range(MOST_NESTING):
        kinds = set(map(type, level))
        if kinds <= _PLAIN_NUMBERS:
            return
        lists = level if kinds <= _LISTS else [x for x in level if is_a(x, list | tuple)]
        others = [] if kinds <= _LISTS else [x for x in level if not is_a(x, list | tuple)]
        read = sum(_length(what, x, "real numbers") for x in others if _is_sequence(x))
        if read > MOST_ITEMS:
            raise InvalidInput(_too_many(what, "real numbers", value))
        number = read + sum(x.size for x in others if is_a(x, np.ndarray))
        number += sum(map(len, lists))
        if number > MANY_ITEMS:
            check_memory(what, number, NUMBER_BYTES, "numbers")
            _check_first(what, value, shape, axes)
        level = list(chain.from_iterable(lists))


def _check_first(what: str, value: Any, shape: Sequence[int | None], axes: int | None) -> None:
    """Raise InvalidInput if what sequences hold first is no number, or shows another shape."""
    found: list[int] = []
    first = value
    with reading(what, "real numbers", value):
        while _is_sequence(first) and len(first) and len(found) < MOST_NESTING:
            found.append(len(first))
            first = first[0]
    if is_a(first, _NO_NUMBERS):
        raise InvalidInput(expected(what, "real numbers", brief(value)))
    if type(first) in _PLAIN_NUMBERS or type(first) is np.ndarray:
        _check_shape(what, (*found, *np.shape(first)), shape, axes)


def has_axes(value: Any) -> bool:
    """Whether a value is a sequence or an array with axes, which is no single number."""
    return _is_sequence(value) or (type(value) is np.ndarray and value.ndim > 0)


def _is_sequence(value: Any) -> bool:
    return is_a(value, Sequence) and not is_a(value, str | bytes)


def _length(what: str, value: Any, wanted: str) -> int:
    """Return the length of a sequence, the greatest number of the machine if it is longer."""
    with reading(what, wanted, value):
        try:
            return len(value)
        except OverflowError:
            return sys.maxsize


def check_positive(what: str, value: Any) -> float:
    """Return `value` as a float if it is one positive finite number, else raise InvalidInput.

    Numbers below 2.2e-308, which have no finite inverse, raise it as well.
    """
    if type(value) is float and SMALLEST <= value < np.inf:  # by far the most calls
        return value
    try:
        number = np.array(np.nan) if has_axes(value) else _real(what, value)
    except InvalidInput:
        number = np.array(np.nan)
    if number.ndim or not SMALLEST <= number < np.inf:
        tiny = not number.ndim and 0.0 < number < SMALLEST
        wanted = f"a positive number of at least {SMALLEST:.3g}" if tiny else "a positive number"
        raise InvalidInput(expected(what, wanted, brief(value)))
    return float(number)


def check_integer(what: str, value: Any, least: int = 1) -> int:
    """Return `value` as an int if it is an integer ≥ `least` (no float, no bool), else raise."""
    if type(value) is int and least <= value <= sys.maxsize:  # by far the most calls
        return value
    try:
        number = least - 1 if is_a(value, bool) else operator.index(value)
    except Exception:  # TypeError, and whatever an object's own `__index__` raises
        number = least - 1
    if not least <= number <= sys.maxsize:
        wanted = f"≥ {least}" if number < least else f"≤ {sys.maxsize}"
        raise InvalidInput(expected(what, f"an integer {wanted}", brief(value)))
    return number


def check_memory(what: str, number: int, each: int, items: str) -> int:
    """Return `number` if so many items fit into the memory of this machine, else raise.

    It is called before any of them is made: a process that uses all memory stops the machine.

    Parameters
    ----------
    what : str
        The argument that states the number, for the message.
    number : int
    each : int [bytes]
        Memory that an item needs at least while it is computed.
    items : str
        What the items are, in the plural.

    Raises
    ------
    InvalidInput
        With the largest number that fits.
    """
    there = _memory()
    if number * each > there:
        size = f"each needs about {each} bytes, and this machine has {there / 1e9:.3g} GB of memory"
        wanted = f"at most {there // each} {items} ({size})"
        raise InvalidInput(expected(what, wanted, brief(number)))
    return number


def _memory() -> int:
    """Return the bytes of memory of this machine."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):  # Windows
        return ASSUMED_MEMORY


def check_text(what: str, value: Any) -> str:
    """Return `value` if it is text that UTF-8 can hold, of at most MOST_LETTERS that are seen.

    Spaces, tabs and ends of lines are accepted. Other control characters would change a terminal,
    and no Excel file can hold them. Characters of no width and marks of direction would make
    different names look alike.

    Raises
    ------
    InvalidInput
    """
    if not is_a(value, str):
        raise InvalidInput(expected(what, "a text", brief(value)))
    text: str = plain_text(value)
    _check_letters(what, text, MOST_LETTERS)
    try:
        text.encode()
    except UnicodeEncodeError as error:
        raise InvalidInput(expected(what, "a text in Unicode", brief(text))) from error
    if not text.isprintable() and any(_hidden(character) for character in text):
        wanted = "a text without control characters, zero-width or bidirectional ones"
        raise InvalidInput(expected(what, wanted, brief(text)))
    return text


def _check_letters(what: str, text: str, most: int) -> None:
    if len(text) > most:
        got = f"{len(text)}: {brief(text)}"
        raise InvalidInput(expected(what, f"a text of at most {most} characters", got))


def _hidden(character: str) -> bool:
    return character not in WHITESPACE and unicodedata.category(character) in HIDDEN


def check_line(what: str, value: Any) -> str:
    """Return `value` if it is text of one line as `check_text` accepts it, without tabs.

    It has at most MOST_LETTERS_OF_LINE characters. Tabs and ends of lines would break a row of a
    table.

    Raises
    ------
    InvalidInput
    """
    text = check_text(what, value)
    _check_letters(what, text, MOST_LETTERS_OF_LINE)
    if any(character in text for character in WHITESPACE):
        wanted = "a text of one line without control characters"
        raise InvalidInput(expected(what, wanted, brief(value)))
    return text


def check_rng(what: str, value: Any) -> np.random.Generator:
    """Return a generator from a seed (an integer ≥ 0) or the given `numpy.random.Generator`."""
    if is_a(value, np.random.Generator):
        generator: np.random.Generator = value
        return generator
    try:
        return np.random.default_rng(check_integer(what, value, least=0))
    except InvalidInput:
        if is_a(value, int) and not is_a(value, bool):
            raise  # the message has the bound
        wanted = "a seed (an integer ≥ 0) or a numpy.random.Generator"
        raise InvalidInput(expected(what, wanted, brief(value))) from None


def is_iterable(value: Any) -> TypeGuard[Iterable[Any]]:
    """Whether a value can be iterated over; an array without axes, which is an Iterable, cannot."""
    try:
        iter(value)
    except Exception:  # TypeError, and whatever an object's own `__iter__` raises
        return False
    return True


def check_items(what: str, value: Any, wanted: str, length: int | None = None) -> tuple[Any, ...]:
    """Return what an iterable holds as a tuple, or raise InvalidInput; a text is none.

    Texts among it are plain ones. More than MOST_ITEMS are refused before all are taken, also of
    an iterable without an end; and any other number than `length`, if that is given.
    """
    if is_a(value, str | bytes | bytearray) or not is_iterable(value):
        raise InvalidInput(expected(what, wanted, brief(value)))
    with reading(what, wanted, value):
        if length is None:
            _check_count(what, value, wanted)
        most = MOST_ITEMS if length is None else length
        items = tuple(map(plain_text, islice(value, most + 1)))
    if length is not None and len(items) != length:
        raise InvalidInput(expected(what, wanted, brief(value)))
    if len(items) > MOST_ITEMS:
        raise InvalidInput(_too_many(what, wanted, value))
    return items


def _check_count(what: str, value: Any, wanted: str) -> None:
    """Raise InvalidInput if a sequence or an array is so long that it is a mistake."""
    long = is_a(value, Sequence | np.ndarray) and _length(what, value, wanted) > MOST_ITEMS
    if long:
        raise InvalidInput(_too_many(what, wanted, value))


def _too_many(what: str, wanted: str, value: Any) -> str:
    return expected(what, f"{wanted}, at most {MOST_ITEMS} items", brief(value))


def check_rows(what: str, value: Any, wanted: str, length: int | None = None) -> tuple[Any, ...]:
    """Return what an iterable holds as `check_items` does; of an array or a frame the rows.

    A frame by itself holds the names of its columns.

    Raises
    ------
    InvalidInput
        Also if something in an array is masked.
    """
    if is_a(value, memoryview) or has(value, "__array__"):
        with reading(what, wanted, value):
            array = np.asanyarray(value)
            if np.ma.is_masked(array):
                raise TypeError
            value = array
    return check_items(what, value, wanted, length)


def check_separated(what: str, text: str) -> list[str]:
    """Return the items of a text that commas separate, without spaces around; [] of an empty text.

    Raises
    ------
    InvalidInput
        If an item is empty, as before a comma at the beginning and between two of them.
    """
    items = [item.strip() for item in text.split(",")]
    if items == [""]:
        return []
    if "" in items:
        got = f"{brief(text)}, whose item {items.index('') + 1} is empty"
        raise InvalidInput(expected(what, "no empty item between commas", got))
    return items


def check_type(what: str, value: Any, kind: type, wanted: str = "") -> None:
    """Raise InvalidInput if `value` is not an instance of a type; the message names the type."""
    if not is_a(value, kind):
        got = f"{type(value).__name__} {brief(value)}"
        raise InvalidInput(expected(what, wanted or f"a gsp.{kind.__name__}", got))
