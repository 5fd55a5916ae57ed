"""Copies of records: what was read-only stays so."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np


class ReadOnly:
    """A record whose arrays are read-only, in copies of it and after unpickling too.

    `copy.deepcopy` and `pickle` make new arrays, which can be written to. What a record computes
    once and keeps is left out, and is computed again from the arrays of the copy.
    """

    def __getstate__(self) -> dict[str, Any]:
        return {k: v for k, v in vars(self).items() if not _is_computed(type(self), k)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        for value in state.values():
            _protect(value)
        vars(self).update(state)


def _is_computed(kind: type, name: str) -> bool:
    return isinstance(getattr(kind, name, None), cached_property)


def _protect(value: Any) -> None:
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif isinstance(value, tuple):
        for item in value:
            _protect(item)
