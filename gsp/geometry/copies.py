"""Copies of records: what was read-only stays so."""

from __future__ import annotations

from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np


class ReadOnly:
    """A record whose arrays and mappings are read-only, in copies of it and after unpickling too.

    `copy.deepcopy` and `pickle` make new arrays, which can be written to, and cannot copy read-only
    mappings. What a record computes once and keeps is left out, and is computed again from the
    arrays of the copy. Records whose arrays are those of others hold views of them, which are
    read-only, and leave the arrays as they are.
    """

    def __post_init__(self) -> None:
        for name, value in list(vars(self).items()):
            if isinstance(value, np.ndarray) and value.flags.writeable:
                view = value.view()
                view.flags.writeable = False
                object.__setattr__(self, name, view)

    def __getstate__(self) -> tuple[dict[str, Any], tuple[str, ...]]:
        kept = {k: v for k, v in vars(self).items() if not _is_computed(type(self), k)}
        mappings = tuple(k for k, v in kept.items() if isinstance(v, MappingProxyType))
        return {**kept, **{k: dict(kept[k]) for k in mappings}}, mappings

    def __setstate__(self, given: tuple[dict[str, Any], tuple[str, ...]]) -> None:
        state, mappings = given
        for value in state.values():
            _protect(value)
        vars(self).update(state, **{k: MappingProxyType(state[k]) for k in mappings})


def _is_computed(kind: type, name: str) -> bool:
    return isinstance(getattr(kind, name, None), cached_property)


def _protect(value: Any) -> None:
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif isinstance(value, tuple):
        for item in value:
            _protect(item)
