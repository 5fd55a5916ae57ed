"""Cells of positions, and what is known of the rotations in each."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import Codes, Numbers
from gsp.workspace.sets.tree.cuts import no_cuts

# Rotations that a cell of positions keeps for its halves.
KEPT_FAMILIES = 4


@dataclass(eq=False)
class Cells:
    """Cells of positions, with the rotation cells that are not decided in each.

    Attributes
    ----------
    low, high : (n, 3) arrays [length]
    offset, count : (n,) int arrays
        Where the rotation cells of each begin in `rotations`, and how many there are.
    rotations : (m, 6) array [rad]
    families : (n, KEPT_FAMILIES, 12) array
        Rotations at local maxima of the least margin, by rows, and their angles.
    met : (n,) int array
        How many there are.
    cuts : (n, 8) array
        Parts that are inside or outside, as in `gsp.workspace.sets.tree.cuts`.
    """

    low: Array
    high: Array
    offset: Numbers
    count: Numbers
    rotations: Array
    families: Array
    met: Numbers
    cuts: Array
    codes: Codes = field(default_factory=lambda: np.zeros(0, dtype=np.int8))
    nodes: int = 0

    def __len__(self) -> int:
        return len(self.low)

    def some(self, chosen: Any) -> Cells:
        """Return some of the cells."""
        return Cells(
            self.low[chosen],
            self.high[chosen],
            self.offset[chosen],
            self.count[chosen],
            self.rotations,
            self.families[chosen],
            self.met[chosen],
            self.cuts[chosen],
        )

    @classmethod
    def begun(cls, low: Array, high: Array, rotations: Array) -> Cells:
        """Return cells of which nothing is known, all with the same rotation cells."""
        n = len(low)
        return cls(
            low,
            high,
            np.zeros(n, dtype=np.int64),
            np.full(n, len(rotations)),
            rotations,
            np.zeros((n, KEPT_FAMILIES, 12)),
            np.zeros(n, dtype=np.int64),
            no_cuts(n),
        )


def joined(parts: list[Cells]) -> Cells:
    """Return cells one after the other, with the rotation cells that they use."""

    def of(name: str) -> Any:
        return np.concatenate([getattr(part, name) for part in parts])

    offset, count, rotations = of("offset"), of("count"), parts[-1].rotations
    if any(part.rotations is not rotations for part in parts):
        rotations = np.concatenate([pairs_of(part)[1] for part in parts])
        offset = np.concatenate(([0], np.cumsum(count)))[:-1].astype(np.int64)
    return Cells(
        of("low"),
        of("high"),
        offset,
        count,
        rotations,
        of("families"),
        of("met"),
        of("cuts"),
        of("codes"),
        sum(part.nodes for part in parts),
    )


def pairs_of(cells: Cells) -> tuple[Numbers, Array]:
    """Owners and rotation cells, one after the other."""
    owner = np.repeat(np.arange(len(cells)), cells.count)
    start = np.repeat(
        cells.offset - np.concatenate(([0], np.cumsum(cells.count)))[:-1], cells.count
    )
    return owner, cells.rotations[start + np.arange(len(owner))]


def first_cells(problem: Any) -> Array:
    """Rotation cells to begin with: no side above a quarter of a turn, shape (m, 6)."""
    edges = []
    for least, most in zip(problem.least, problem.most, strict=True):
        n = max(1, int(np.ceil((most - least) / (0.5 * np.pi) - 1e-9)))
        ends = np.linspace(least, most, n + 1)
        edges.append(list(pairwise(ends)))
    cells = [(a, b, c) for a in edges[0] for b in edges[1] for c in edges[2]]
    return np.array([[*(x for x, _ in cell), *(y for _, y in cell)] for cell in cells])
