"""Records that cannot be changed: neither what they hold, nor what they compute once and keep."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import cached_property, wraps
from types import MappingProxyType
from typing import Any, NoReturn, TypeVar

import numpy as np

# Characters of the repr of a record, and of one of its fields; items that a field shows.
LETTERS_OF_RECORD, LETTERS_OF_FIELD, MOST_SHOWN = 480, 120, 12

COLLECTIONS = (tuple, list, dict, MappingProxyType)

T = TypeVar("T")
K = TypeVar("K")
V = TypeVar("V")


class ReadOnlyDict(dict[K, V]):
    """A dictionary of a record, which cannot be changed; JSON takes it as the dictionary it is."""

    def __reduce__(self) -> tuple[type[dict[K, V]], tuple[dict[K, V]]]:
        return ReadOnlyDict, (dict(self),)

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        raise TypeError("a dictionary of a record does not support item assignment")

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse


def read_only(value: T) -> T:
    """Return a value as records hold it: arrays are read-only views, also inside of it.

    Lists become tuples, and mappings a `ReadOnlyDict`. Tuples and mappings are searched, other
    objects are not.
    """
    changed: Any = value
    if isinstance(value, COLLECTIONS):
        if isinstance(value, list):
            changed = tuple(value)
        elif isinstance(value, dict | MappingProxyType) and not isinstance(value, ReadOnlyDict):
            changed = ReadOnlyDict(value)
        return _protected(changed, read_only)  # type: ignore[no-any-return]
    return _unwritable(value)  # type: ignore[no-any-return]


def _unwritable(value: Any) -> Any:
    """Return a read-only view of an array that can be written to, anything else as it is."""
    if isinstance(value, np.ndarray) and value.flags.writeable:
        value = value.view()
        value.flags.writeable = False
    return value


def _protected(value: Any, inner: Callable[[Any], Any]) -> Any:
    """Return `inner` of what a tuple or a `ReadOnlyDict` holds, in one of the same type."""
    if isinstance(value, tuple):
        items = tuple(map(inner, value))
        if any(a is not b for a, b in zip(items, value, strict=True)):
            return type(value)(*items) if hasattr(value, "_fields") else items
    if isinstance(value, ReadOnlyDict):
        pairs = {key: inner(item) for key, item in value.items()}
        if any(pairs[key] is not value[key] for key in value):
            return ReadOnlyDict(pairs)
    return value


def _again(value: Any) -> Any:
    """Return what a record held, of new arrays; lists that it held are left as they are."""
    if isinstance(value, COLLECTIONS):
        return _protected(value, _again)
    return _unwritable(value)


def made(kind: type[T], **values: Any) -> T:
    """Return a record of its fields, which are read-only already, without the time of its checks.

    For records that are made within microseconds. `kind` is a dataclass without slots, and nobody
    else holds arrays of which its own are views.
    """
    record = object.__new__(kind)
    object.__setattr__(record, "__dict__", values)
    return record


def changeable(value: Any) -> Any:
    """Return dictionaries and tuples of a record as new dictionaries and lists, for a file."""
    if isinstance(value, Mapping):
        return {key: changeable(item) for key, item in value.items()}
    return [changeable(item) for item in value] if isinstance(value, list | tuple) else value


class kept_property(cached_property[T]):
    """A property that is computed once and kept, so it is read-only, as by `read_only`."""

    def __init__(self, function: Callable[[Any], T]) -> None:
        super().__init__(wraps(function)(lambda record: read_only(function(record))))


def read_only_tuple(kind: type[T]) -> type[T]:
    """Decorate a named tuple so that what it holds is read-only, in copies of it too.

    Lists stay lists: Pinocchio takes no tuples.
    """
    make: Callable[..., T] = kind.__new__

    def hold(value: Any) -> Any:
        if isinstance(value, COLLECTIONS) and not isinstance(value, list):
            return read_only(value)
        return _unwritable(value)

    @wraps(make)
    def new(cls: type[T], *args: Any, **kwargs: Any) -> T:
        return make(cls, *map(hold, args), **{name: hold(value) for name, value in kwargs.items()})

    kind.__new__ = new  # type: ignore[method-assign, assignment]
    kind.__repr__ = short_repr  # type: ignore[method-assign]
    return kind


def short_repr(record: Any) -> str:
    """Return the class of a record and its fields, of at most LETTERS_OF_RECORD characters.

    Of long arrays, tuples and dictionaries it states the size.
    """
    names = getattr(record, "_fields", None) or [x.name for x in fields(record) if x.repr]
    text = ", ".join(f"{name}={_short(getattr(record, name))}" for name in names)
    most = LETTERS_OF_RECORD - len(type(record).__name__) - 3
    return f"{type(record).__name__}({text if len(text) <= most else text[: most - 1] + '…'})"


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size > MOST_SHOWN:
        return f"<array of shape {value.shape}>"
    if isinstance(value, tuple | list | dict) and len(value) > MOST_SHOWN:
        return f"<{len(value)} items>"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key!r}: {_short(item)}" for key, item in value.items()) + "}"
    if isinstance(value, tuple) and not hasattr(value, "_fields"):
        return "(" + ", ".join(map(_short, value)) + ("," if len(value) == 1 else "") + ")"
    text = repr(value[: LETTERS_OF_FIELD + 1] if isinstance(value, str) else value)
    return text if len(text) <= LETTERS_OF_FIELD else f"{text[: LETTERS_OF_FIELD - 1]}…"


class ReadOnly:
    """A record whose arrays and dictionaries are read-only, in copies of it and after unpickling.

    `copy.deepcopy` and `pickle` make new arrays, which can be written to. What a record computes
    once and keeps is left out, and is computed again from the arrays of the copy. Records whose
    arrays are those of others hold views of them, which are read-only, and leave the arrays as
    they are.

    Compared with an array a record is not equal, as with any other object, and arithmetic with
    arrays is a TypeError: numpy would take the record apart, or compare it with each element.
    """

    __array_ufunc__ = None

    def __init_subclass__(cls, **given: Any) -> None:
        super().__init_subclass__(**given)
        # `dataclass` makes none for a class that has one of its own.
        cls.__repr__ = cls.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        return short_repr(self)

    def __post_init__(self) -> None:
        for name, value in list(vars(self).items()):
            held = read_only(value)
            if held is not value:
                object.__setattr__(self, name, held)

    def __getstate__(self) -> dict[str, Any]:
        return {k: v for k, v in vars(self).items() if not _is_computed(type(self), k)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update({name: _again(value) for name, value in state.items()})


def _is_computed(kind: type, name: str) -> bool:
    return isinstance(getattr(kind, name, None), cached_property)
