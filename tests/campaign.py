"""Sizes of campaigns: a short seeded form for `make test`, the whole for `make check-long`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

T = TypeVar("T")
SHORT, FULL = "short", "full"
_chosen = SHORT


def choose(campaign: str) -> None:
    """Set the form in which the campaigns of this run are made; `conftest.py` calls it."""
    global _chosen
    if campaign not in (SHORT, FULL):
        raise ValueError(f"expected {SHORT!r} or {FULL!r}, got {campaign!r}")
    _chosen = campaign


def count(short: int, full: int) -> int:
    """The number of cases: `full` with `pytest --campaign=full`, else `short`.

    The cases of the short form should be the first ones of the full form: take them in one order
    from one seed.
    """
    if not 0 < short <= full:
        raise ValueError(f"expected 0 < short <= full, got {short} and {full}")
    return full if _chosen == FULL else short


def some(cases: Iterable[T], short: int) -> list[T]:
    """All cases with `pytest --campaign=full`, else `short` of them, spread from first to last."""
    every = list(cases)
    kept = count(min(short, len(every)), len(every))
    return [every[i * (len(every) - 1) // max(kept - 1, 1)] for i in range(kept)]
