"""Ratios of speeds, measured in turn in one run."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Way:
    """One way of doing it: what runs, and how many poses that is."""

    run: Callable[[], object]
    poses: int


def in_turn(
    ways: Mapping[str, Way], rounds: int, clock: Callable[[], float] = time.process_time
) -> dict[str, np.ndarray]:
    """Return seconds per pose of each way in each round, in turn, after one that does not count."""
    times = {name: np.empty(rounds) for name in ways}
    for r in range(-1, rounds):
        for name, way in ways.items():
            start = clock()
            way.run()
            if r >= 0:
                times[name][r] = (clock() - start) / way.poses
    return times


def ratio(times: Mapping[str, np.ndarray], slow: str, fast: str) -> tuple[float, float, float]:
    """Least, median and greatest ratio of two ways, round by round."""
    ratios = times[slow] / times[fast]
    return float(ratios.min()), float(np.median(ratios)), float(ratios.max())


def rows(
    times: Mapping[str, np.ndarray], reference: str, scale: float = 1e9
) -> list[tuple[str, ...]]:
    """Rows of a table: way, median and least time (ns), ratio to a reference."""
    table = []
    for name, values in times.items():
        low, middle, high = ratio(times, reference, name)
        table.append(
            (
                name,
                f"{np.median(values) * scale:,.0f}",
                f"{values.min() * scale:,.0f}",
                f"{middle:.3g} ({low:.3g} … {high:.3g})",
            )
        )
    return table


def markdown(head: tuple[str, ...], table: list[tuple[str, ...]]) -> str:
    """Return a Markdown table."""
    return "\n".join(map(line, [head, tuple("---" for _ in head), *table]))


def line(row: tuple[str, ...]) -> str:
    """Return one line of a Markdown table."""
    return "| " + " | ".join(row) + " |"
