"""The tree of cells: halve what is undecided, level by level, on any number of threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.geometry.vectors import Array
from gsp.progress import Report
from gsp.workspace.sets.verdicts import INSIDE, UNDECIDED, Cells, Codes

# Cells that one task decides; it does not depend on the number of threads, nor does any result.
TASK = 64
# Levels of halving, at most: three or two directions share them.
MOST_LEVELS = 60


@dataclass(frozen=True, eq=False)
class Aim:
    """When a tree is fine enough.

    Attributes
    ----------
    resolution : float or None
        Longest side of an undecided cell; None to end by the bracket and the budget.
    bracket : float [1]
        Half the width of the bracket over its middle.
    budget : int
        Rotation cells to decide, at most; a level is not begun if it would probably need more.
    """

    resolution: float | None
    bracket: float
    budget: int


@dataclass(frozen=True, eq=False)
class Leaves:
    """What is left of a tree: cells that are inside, and cells that are undecided.

    Attributes
    ----------
    low, high : (n, 3) arrays
    codes : (n,) int8 array
        1 inside, 0 undecided.
    levels : int
        How often the domain was halved for the smallest cells.
    nodes : int
        Rotation cells that were decided.
    """

    low: Array
    high: Array
    codes: Codes
    levels: int
    nodes: int


def grow(
    cells: Cells,
    decide: Callable[[Cells], Cells],
    measure: Callable[[Array, Array], Array],
    aim: Aim,
    workers: int,
    report: Report,
) -> Leaves:
    """Decide cells, and halve those that are undecided until the aim is met."""
    settled: list[tuple[Array, Array]] = []
    inside, nodes, level = 0.0, 0, 0
    with ThreadPoolExecutor(workers) as pool:
        while len(cells) and level < MOST_LEVELS:
            found = _decided(cells, decide, pool, workers)
            nodes += found.nodes
            done = found.codes == INSIDE
            settled.append((found.low[done], found.high[done]))
            inside += float(measure(found.low[done], found.high[done]).sum())
            cells = found.some(found.codes == UNDECIDED)
            open_ = float(measure(cells.low, cells.high).sum())
            report(min(nodes, aim.budget), aim.budget)
            side = (cells.high - cells.low).max(initial=0.0)
            if not len(cells) or _enough(aim, side, inside, open_, nodes, found.nodes):
                break
            cells, level = _halves(cells), level + 1
    low = np.concatenate([x for x, _ in settled] + [cells.low])
    high = np.concatenate([x for _, x in settled] + [cells.high])
    codes = np.zeros(len(low), dtype=np.int8)
    codes[: len(low) - len(cells)] = INSIDE
    return Leaves(low, high, codes, level, nodes)


def _enough(aim: Aim, side: float, inside: float, open_: float, nodes: int, last: int) -> bool:
    if aim.resolution is not None:
        if side <= aim.resolution:
            return True
    elif open_ <= 2.0 * aim.bracket * (inside + 0.5 * open_):
        return True
    return nodes + 2 * last > aim.budget


def _decided(cells: Cells, decide: Callable[[Cells], Cells], pool: Any, workers: int) -> Cells:
    parts = [cells.some(slice(i, i + TASK)) for i in range(0, len(cells), TASK)]
    results = list(pool.map(decide, parts)) if workers > 1 else [decide(part) for part in parts]
    shift = np.cumsum([0] + [len(part.rotations) for part in results[:-1]])
    for part, start in zip(results, shift, strict=True):
        part.offset = part.offset + start

    def joined(name: str) -> Any:
        return np.concatenate([getattr(part, name) for part in results])

    return Cells(
        joined("low"),
        joined("high"),
        joined("offset"),
        joined("count"),
        joined("rotations"),
        joined("seed"),
        joined("seeded"),
        joined("codes"),
        sum(part.nodes for part in results),
    )


def _halves(cells: Cells) -> Cells:
    """Halves of all cells along the longest side of the first; they are all alike."""
    k = int(np.argmax((cells.high - cells.low)[0]))
    middle = 0.5 * (cells.low[:, k] + cells.high[:, k])
    low, high = np.repeat(cells.low, 2, axis=0), np.repeat(cells.high, 2, axis=0)
    high[0::2, k] = middle
    low[1::2, k] = middle
    both = cells.some(np.repeat(np.arange(len(cells)), 2))
    both.low, both.high = low, high
    return both
