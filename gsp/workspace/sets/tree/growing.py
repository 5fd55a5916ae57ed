"""The tree of cells: halve what is undecided, level by level, on any number of threads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp.evaluation.scheduling import pool_of
from gsp.geometry.vectors import Array
from gsp.progress import Report
from gsp.workspace.sets.codes import INSIDE, UNDECIDED, Codes
from gsp.workspace.sets.tree.cells import Cells, joined
from gsp.workspace.sets.tree.cuts import moved, no_cuts, shares

# Share of what may stay undecided that is left in the cells that are least undecided.
LEFT_SHARE = 0.6
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
    cuts : (n, 8) array [1, length]
        Parts that are inside or outside, as in `gsp.workspace.sets.tree.cuts`.
    levels : int
        How often the domain was halved for the smallest cells.
    nodes : int
        Rotation cells that were decided.
    """

    low: Array
    high: Array
    codes: Codes
    cuts: Array
    levels: int
    nodes: int

    def undecided(self) -> Leaves:
        """Return the leaves with nothing inside."""
        cuts = self.cuts.copy()
        cuts[:, 7] = np.inf
        return replace(self, codes=np.full_like(self.codes, UNDECIDED), cuts=cuts)


def grow(
    cells: Cells,
    decide: Callable[[Cells], Cells],
    measure: Callable[[Array, Array], Array],
    aim: Aim,
    task: int,
    workers: int,
    report: Report,
) -> Leaves:
    """Decide cells, `task` of them at a time, and halve what is undecided until the aim is met.

    Nothing depends on the number of threads.
    """
    # Cells that are not chosen wait, and may be chosen at a later level: what may stay undecided
    # depends on what has been proven since.
    settled: list[tuple[Array, Array]] = []
    waiting = cells.some(slice(0, 0))
    slab, part = np.zeros(0), np.zeros(0)
    inside, nodes, level = 0.0, 0, 0
    with pool_of(workers) as pool:
        while len(cells):
            found = _decided(cells, decide, task, pool, workers)
            nodes += found.nodes
            done = found.codes == INSIDE
            settled.append((found.low[done], found.high[done]))
            inside += float(measure(found.low[done], found.high[done]).sum())
            waiting = joined([waiting, found.some(found.codes == UNDECIDED)])
            size = measure(waiting.low, waiting.high)
            share, beyond = shares(waiting.low, waiting.high, waiting.cuts)
            slab, part = size * (1.0 - share - beyond), size * share
            report(min(nodes, aim.budget), aim.budget)
            chosen = _chosen(aim, waiting, slab, inside + float(part.sum()))
            # Halves need about as many nodes as cells of the last level did.
            costly = 2 * chosen.sum() * found.nodes > (aim.budget - nodes) * len(cells)
            if costly or level == MOST_LEVELS:  # what is not halved stays undecided
                break
            cells, level = _halves(waiting.some(chosen)), level + 1
            waiting = waiting.some(~chosen)
    n = sum(len(x) for x, _ in settled)
    return Leaves(
        np.concatenate([x for x, _ in settled] + [waiting.low]),
        np.concatenate([x for _, x in settled] + [waiting.high]),
        np.repeat([INSIDE, UNDECIDED], [n, len(waiting)]).astype(np.int8),
        np.concatenate((no_cuts(n), waiting.cuts)),
        level,
        nodes,
    )


def _chosen(aim: Aim, cells: Cells, slab: Array, low: float) -> NDArray[np.bool_]:
    """Choose the cells to halve: those that are too large, or the most undecided ones."""
    if aim.resolution is not None:
        return np.asarray((cells.high - cells.low).max(axis=1) > aim.resolution)
    open_ = float(slab.sum())
    target = 2.0 * aim.bracket * (low + 0.5 * open_)
    chosen = np.zeros(len(cells), dtype=np.bool_)
    # The cells that are least undecided stay. They hold LEFT_SHARE of what the aim allows, so that
    # the halves of the others can meet it.
    if open_ > target:
        order = np.argsort(slab, kind="stable")
        chosen[order[np.cumsum(slab[order]) > LEFT_SHARE * target]] = True
    return chosen


def _decided(
    cells: Cells, decide: Callable[[Cells], Cells], task: int, pool: Any, workers: int
) -> Cells:
    parts = [cells.some(slice(i, i + task)) for i in range(0, len(cells), task)]
    # In the order of the parts, whichever thread is first: results do not depend on the threads.
    results = list(pool.map(decide, parts)) if workers > 1 else [decide(part) for part in parts]
    return joined(results)


def _halves(cells: Cells) -> Cells:
    """Halves of cells along their longest sides."""
    k, i = np.argmax(cells.high - cells.low, axis=1), np.arange(len(cells))
    middle = 0.5 * (cells.low[i, k] + cells.high[i, k])
    low, high = np.repeat(cells.low, 2, axis=0), np.repeat(cells.high, 2, axis=0)
    high[2 * i, k] = middle
    low[2 * i + 1, k] = middle
    both = cells.some(np.repeat(np.arange(len(cells)), 2))
    middles = 0.5 * (both.low + both.high)
    both.low, both.high = low, high
    both.cuts = moved(both.cuts, 0.5 * (low + high) - middles)
    return both
