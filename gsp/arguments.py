"""Checks of arguments as a decorator of a function: `@arguments.validated(radius=positive)`.

The function gets the checked values. Checks of `gsp.checks` return what they accept, so they serve
here as they are.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping, Sequence
from os import fspath
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.checks import (
    check_array,
    check_integer,
    check_items,
    check_positive,
    check_rng,
    check_text,
    check_type,
    has_axes,
    is_a,
    plain_text,
    reading,
)
from gsp.errors import InvalidInput, apart, brief, expected

P = ParamSpec("P")
R = TypeVar("R")
Check = Callable[[str, Any], Any]

# Single numbers beyond it overflow when they are squared or cubed.
LARGEST_NUMBER = 1e100


def bounded_array(
    what: str,
    value: ArrayLike,
    shape: Sequence[int | None],
    most: float = LARGEST_NUMBER,
    *,
    finite: bool = True,
    axes: int | None = None,
) -> NDArray[np.float64]:
    """Return `value` as float64 whose last axes are `shape`, of numbers whose squares are finite.

    Infinite numbers and NaN, which stand for no bound, are accepted unless `finite`.

    Raises
    ------
    InvalidInput
        On a wrong type or shape, or finite numbers beyond `most`.
    """
    array = check_array(what, value, shape, finite=finite, axes=axes)
    largest = float(np.abs(array).max(initial=0.0, where=np.isfinite(array)))
    if largest > most:
        got, limit = apart(largest, most)
        raise InvalidInput(expected(what, f"numbers of at most {limit} in size", got))
    return array


def _stated(what: str, value: Any) -> Any:
    """Return an argument, a text as a plain one, or raise InvalidInput if it states no class."""
    try:
        value.__class__  # noqa: B018 - which `isinstance` asks for
    except Exception as error:
        wanted = "an object that states its class"
        raise InvalidInput(expected(what, wanted, brief(value))) from error
    return plain_text(value)


def validated(**checks: Check) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator that checks arguments by their names before the function is called.

    Texts among the other arguments become plain ones, and what does not state its class is refused.
    Defaults are not checked. A call with wrong or missing names raises Python's own TypeError.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        signature = inspect.signature(function)
        unknown = set(checks) - set(signature.parameters)
        if unknown:
            raise TypeError(f"{function.__name__} has no parameters {sorted(unknown)}")

        @functools.wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> R:
            try:
                bound = signature.bind(*args, **kwargs)
            except TypeError:
                return function(*args, **kwargs)  # whose own TypeError has its name
            for name, check in checks.items():
                if name in bound.arguments:
                    bound.arguments[name] = check(name, bound.arguments[name])
            bound.arguments.update({k: _stated(k, v) for k, v in bound.arguments.items()})
            return function(*bound.args, **bound.kwargs)

        return call

    return decorate


def optional(check: Check) -> Check:
    """Return a check that accepts None as well."""
    return lambda what, value: None if value is None else check(what, value)


positive: Check = check_positive
text: Check = check_text
rng: Check = check_rng


def numbers(what: str, value: Any) -> Any:
    """Return real finite numbers of any shape as float64."""
    return check_array(what, value, ())


def number(what: str, value: Any) -> float:
    """Return one real finite number as a float."""
    if type(value) is float and abs(value) <= LARGEST_NUMBER:  # by far the most
        return value
    array = np.empty(1) if has_axes(value) else check_array(what, value, ())
    if array.ndim or abs(array) > LARGEST_NUMBER:
        wanted = f"one number of at most {LARGEST_NUMBER:g} in size"
        raise InvalidInput(expected(what, wanted, brief(value)))
    return float(array)


def within(low: float, high: float, wanted: str = "") -> Check:
    """Return a check of finite numbers of any shape between bounds, which returns float64."""

    def check(what: str, value: Any) -> Any:
        array = check_array(what, value, ())
        outside = array[(array < low) | (array > high)]
        if outside.size:
            got, least, most = apart(outside[0], low, high)
            raise InvalidInput(expected(what, wanted or f"a number in [{least}, {most}]", got))
        return array

    return check


#: Positive lengths of any shape, whose cubes and inverses are finite.
sizes = within(
    1.0 / LARGEST_NUMBER,
    LARGEST_NUMBER,
    f"a positive number from {1.0 / LARGEST_NUMBER:g} to {LARGEST_NUMBER:g}",
)
#: Coordinates, heights and angles of any shape, whose squares and cubes are finite.
moderate = within(
    -LARGEST_NUMBER, LARGEST_NUMBER, f"a number of at most {LARGEST_NUMBER:g} in size"
)
shares = within(0.0, 1.0)


def one(check: Check) -> Check:
    """Return a check of one number, as a float, from a check of numbers of any shape."""

    def single(what: str, value: Any) -> float:
        array = np.empty(1) if has_axes(value) else check(what, value)
        if array.ndim:
            raise InvalidInput(expected(what, "one number", brief(value)))
        return float(array)

    return single


def size(what: str, value: Any) -> float:
    """Return one length whose cube and inverse are finite, as a float."""
    if type(value) is float and 1.0 / LARGEST_NUMBER <= value <= LARGEST_NUMBER:  # by far the most
        return value
    number = check_positive(what, value)
    return float(sizes(what, number))


def share(what: str, value: Any) -> float:
    """Return one number between 0 and 1 as a float."""
    try:
        result = number(what, value)
    except InvalidInput:
        result = -1.0
    if not 0.0 <= result <= 1.0:
        raise InvalidInput(expected(what, "a number in [0, 1]", brief(value)))
    return result


def array(*shape: int | None, finite: bool = True) -> Check:
    """Return a check of numbers whose last axes have a shape; None stands for any size."""
    return lambda what, value: check_array(what, value, shape, finite=finite)


def integer(least: int, most: int | None = None) -> Check:
    """Return a check of one integer between bounds."""

    def check(what: str, value: Any) -> int:
        result = check_integer(what, value, least)
        if most is not None and result > most:
            raise InvalidInput(expected(what, f"an integer ≤ {most}", result))
        return result

    return check


def flag(what: str, value: Any) -> bool:
    """Return True or False."""
    if not is_a(value, bool | np.bool_):
        raise InvalidInput(expected(what, "True or False", brief(value)))
    return bool(value)


def function(what: str, value: Any) -> Any:
    """Return a callable."""
    if not callable(value):
        raise InvalidInput(expected(what, "a function", brief(value)))
    return value


def path(what: str, value: Any) -> Any:
    """Return the path of a file."""
    with reading(what, "the path of a file", value):
        text = plain_text(fspath(value)).encode().decode()
        named = bool(Path(text).name) and "\0" not in text
    if not named:
        raise InvalidInput(expected(what, "the path of a file", brief(value)))
    return plain_text(value)


def kind(of: type, wanted: str = "") -> Check:
    """Return a check of the type of a value."""

    def check(what: str, value: Any) -> Any:
        if not is_a(value, of):
            got = f"{type(value).__name__} {brief(value)}"
            raise InvalidInput(expected(what, wanted or f"a {of.__name__}", got))
        return value

    return check


def one_of(*choices: str) -> Check:
    """Return a check of a text that must be one of several."""

    def check(what: str, value: Any) -> str:
        text: str = plain_text(value)
        if not is_a(text, str) or text not in choices:
            raise InvalidInput(expected(what, " or ".join(choices), brief(value)))
        return text

    return check


def sequence(length: int | None = None) -> Check:
    """Return a check of a tuple, list or array, of a length if that is given, as a tuple."""
    wanted = "a sequence" + (f" of {length}" if length is not None else "")

    def check(what: str, value: Any) -> tuple[Any, ...]:
        if not is_a(value, Sequence | np.ndarray):
            raise InvalidInput(expected(what, wanted, brief(value)))
        return check_items(what, value, wanted, length)

    return check


def many(of: type) -> Check:
    """Return a check of an iterable of instances of a class, as a tuple."""

    def check(what: str, value: Any) -> tuple[Any, ...]:
        wanted = f"a sequence of {of.__name__}"
        found = check_items(what, value, wanted)
        if not all(is_a(item, of) for item in found):
            raise InvalidInput(expected(what, wanted, brief(value)))
        return found

    return check


def names(what: str, value: Any) -> tuple[str, ...]:
    """Return one text, or several, as a tuple of texts."""
    if is_a(value, str):
        return (check_text(what, value),)
    found: tuple[str, ...] = many(str)(what, value)
    return found


def frame(what: str, value: Any, wanted: str = "a pandas.DataFrame") -> Any:
    """Return a pandas.DataFrame whose columns have different names."""
    import pandas as pd

    check_type(what, value, pd.DataFrame, wanted)
    with reading(what, wanted, value):
        twice = value.columns[value.columns.duplicated()]
    if len(twice):
        raise InvalidInput(expected(what, "columns with different names", f"two of {twice[0]!r}"))
    return value


def attribute(table: Any, key: str, check: Check, default: Any) -> Any:
    """Return an entry of the `attrs` of a table, checked, or `default` where there is none."""
    value = table.attrs.get(key)
    return default if value is None else check(f"attrs[{key!r}] of the table", value)


def mapping(what: str, value: Any) -> dict[Any, Any]:
    """Return a mapping as a dictionary, whose keys and values that are texts are plain ones."""
    check_type(what, value, Mapping, "a mapping")
    with reading(what, "a mapping", value):
        pairs = check_items(what, value.items(), "a mapping")
        return {plain_text(key): plain_text(one) for key, one in pairs}
