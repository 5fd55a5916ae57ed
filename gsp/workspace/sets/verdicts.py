"""Decisions on cells of positions and rotations, and on cells of positions, for any limits."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gsp.geometry.vectors import Array
from gsp.proof.branching.enclosure import enclose
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes, Numbers
from gsp.workspace.sets.cuts import decided, no_cuts
from gsp.workspace.sets.problem import Bounded, inside_walls

# Rotation cells that a cell of positions keeps at most.
MOST_KEPT = 512
# Rotations that are tried as witnesses in one cell of positions.
WITNESSES = 24
# Rotation cells reach as far as this share of the cell of positions, at the platform anchors.
SHARE, DEXTROUS_SHARE = 1.0, 0.5
# The smallest rotation cells [rad].
FINEST = 1e-3
# Climbs and rotation cells of one cell of positions, in compiled code, over a range of rotations.
STARTS, NODES = 16, 4000
# Sums that are bounded to prove a cell of positions outside, over all rotations; of a point.
SUMS, POINT_SUMS = 400, 4000
# Rotation cells of one leg and one cell of positions that keep all rotations.
KEPT_SUMS = 3000
# Rotations that a cell of positions keeps for its halves.
FAMILIES = 4


@dataclass(eq=False)
class Cells:
    """Cells of positions, with the rotation cells that are not decided in each.

    Attributes
    ----------
    low, high : (n, 3) arrays [length]
    offset, count : (n,) int arrays
        Where the rotation cells of each begin in `rotations`, and how many there are.
    rotations : (m, 6) array [rad]
    families : (n, FAMILIES, 9) array
        Rotations at local maxima of the least margin, for all rotations; else, in the first three
        numbers, angles of the best pose that was met.
    met : (n,) int array
        How many there are.
    cuts : (n, 8) array
        Parts that are inside or outside, as in `gsp.workspace.sets.cuts`.
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
            np.zeros((n, FAMILIES, 9)),
            np.zeros(n, dtype=np.int64),
            no_cuts(n),
        )


def joined(parts: list[Cells]) -> Cells:
    """Return cells one after the other, with the rotation cells that they use."""

    def of(name: str) -> Any:
        return np.concatenate([getattr(part, name) for part in parts])

    offset, count, rotations = of("offset"), of("count"), parts[-1].rotations
    if any(part.rotations is not rotations for part in parts):
        rotations = np.concatenate([_pairs(part)[1] for part in parts])
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


def verdicts(problem: Bounded, low: Array, high: Array, rotations: Array) -> Codes:
    """Decide cells of positions and rotations: −1 if no pose is feasible, 1 if all are, else 0."""
    from gsp.workspace.sets.compiled.cells import clear_verdicts, sphere_verdicts

    codes = np.ones(len(low), dtype=np.int8)
    if not len(low):
        return codes
    # Arrays of one memory layout, so that one version of each function is compiled.
    low, high, rotations = (np.array(x, order="C") for x in (low, high, rotations))
    sphere_verdicts(low, high, rotations, problem.legs, problem.turns, codes)
    codes = _both(codes, inside_walls(problem.walls, low, high))
    if len(problem.pairs):
        clear = np.empty(len(low), dtype=np.int8)
        clear_verdicts(
            low,
            high,
            rotations,
            problem.legs,
            problem.turns,
            problem.pairs,
            problem.clearance,
            clear,
        )
        codes = _both(codes, clear)
    if problem.proof is not None:
        open_ = np.flatnonzero(codes >= 0)
        codes[open_] = _both(
            codes[open_], _enclosed(problem, low[open_], high[open_], rotations[open_])
        )
    return np.minimum(codes, UNDECIDED).astype(np.int8) if problem.opaque else codes


def _both(one: Codes, other: Codes) -> Codes:
    return np.asarray(np.minimum(one, other), dtype=np.int8)


def _enclosed(problem: Bounded, low: Array, high: Array, rotations: Array) -> Codes:
    proof = problem.proof
    assert proof is not None
    boxes = np.concatenate((low, rotations[:, :3], high, rotations[:, 3:]), axis=1)
    with np.errstate(all="ignore"):
        bounds, _ = enclose(proof, problem.turns.ravel(), boxes)
    least, most = bounds[:, proof.chosen, 0], bounds[:, proof.chosen, 1]
    below, above = proof.low[proof.chosen], proof.high[proof.chosen]
    within = ((least >= below) & (most <= above)).all(axis=1)
    beyond = ((most < below) | (least > above)).any(axis=1)
    return np.where(beyond, OUTSIDE, np.where(within, INSIDE, UNDECIDED)).astype(np.int8)


def reach(problem: Bounded, cells: Cells, fine: float = FINEST) -> Cells:
    """Decide cells of positions: inside if one rotation is feasible on all of it."""
    walls = inside_walls(problem.walls, cells.low, cells.high)
    found = (
        _reach_spheres(problem, cells, fine) if problem.plain else _reach_any(problem, cells, fine)
    )
    # Beyond a wall is outside; across it, a witness of the rest is none of the cell.
    across = (walls == UNDECIDED) & (found.codes == INSIDE)
    found.codes = np.where(walls == OUTSIDE, OUTSIDE, found.codes).astype(np.int8)
    found.codes[across] = UNDECIDED
    found.cuts[walls != INSIDE, 7] = np.inf
    if across.any():
        found.count[across], found.offset[across] = cells.count[across], len(found.rotations)
        kept = [
            cells.rotations[o : o + n]
            for o, n in zip(cells.offset[across], cells.count[across], strict=True)
        ]
        found.offset[across] += np.concatenate(([0], np.cumsum([len(k) for k in kept])[:-1]))
        found.rotations = np.concatenate((found.rotations, *kept))
    return found


def _reach_spheres(problem: Bounded, cells: Cells, fine: float) -> Cells:
    if problem.free:
        return _reach_freely(problem, cells)
    from gsp.workspace.sets.compiled.cells import reach_cells

    n = len(cells)
    codes = np.zeros(n, dtype=np.int8)
    offset, count = np.zeros(n, dtype=np.int64), np.zeros(n, dtype=np.int64)
    families, seeded = cells.families.copy(), cells.met > 0
    kept, nodes = reach_cells(
        cells.low,
        cells.high,
        cells.offset,
        cells.count,
        cells.rotations,
        families[:, 0, :3],
        seeded,
        problem.legs,
        problem.turns,
        problem.least,
        problem.most,
        SHARE,
        fine,
        problem.arm,
        STARTS,
        NODES,
        codes,
        offset,
        count,
    )
    met = seeded.astype(np.int64)
    cuts = no_cuts(n)
    return Cells(cells.low, cells.high, offset, count, kept, families, met, cuts, codes, nodes)


def _reach_freely(problem: Bounded, cells: Cells) -> Cells:
    """Decide cells over all rotations, each from the first rotation cells."""
    from gsp.workspace.sets.compiled.cells import reach_freely

    codes = decided(cells.low, cells.high, cells.cuts)
    open_ = np.flatnonzero(codes == UNDECIDED)
    some = cells.some(open_)
    found, met, families, cuts = (
        np.zeros(len(some), dtype=np.int8),
        *(x.copy() for x in (some.met, some.families, some.cuts)),
    )
    points = bool((some.low == some.high).all())
    nodes = 0
    if len(some):
        first = cells.rotations[some.offset[0] : some.offset[0] + some.count[0]]
        nodes = reach_freely(
            some.low,
            some.high,
            families,
            met,
            problem.legs,
            problem.turns,
            first,
            POINT_SUMS if points else SUMS,
            found,
            cuts,
        )
    result = cells.some(slice(None))
    result.codes, result.nodes = codes, nodes
    for name, part in (("codes", found), ("met", met), ("families", families), ("cuts", cuts)):
        whole = getattr(result, name).copy()
        whole[open_] = part
        setattr(result, name, whole)
    return result


def _targets(problem: Bounded, cells: Cells, share: float, fine: float) -> Array:
    """Widths [rad] below which rotation cells are not halved."""
    wide = 0.5 * np.linalg.norm(cells.high - cells.low, axis=1)
    return np.asarray(np.maximum(fine, share * wide / problem.arm))


def _pairs(cells: Cells) -> tuple[Numbers, Array]:
    """Owners and rotation cells, one after the other."""
    owner = np.repeat(np.arange(len(cells)), cells.count)
    start = np.repeat(
        cells.offset - np.concatenate(([0], np.cumsum(cells.count)))[:-1], cells.count
    )
    return owner, cells.rotations[start + np.arange(len(owner))]


def _points(angles: Array) -> Array:
    """Rotation cells of no width."""
    return np.concatenate((angles, angles), axis=1)


def _middles(rotations: Array) -> Array:
    return 0.5 * (rotations[:, :3] + rotations[:, 3:])


def _halved(rotations: Array) -> Array:
    """Halves of rotation cells along their widest angle, (2 n, 6), pair after pair."""
    width = rotations[:, 3:] - rotations[:, :3]
    k, i = width.argmax(axis=1), np.arange(len(rotations))
    middle = 0.5 * (rotations[i, k] + rotations[i, 3 + k])
    halves = np.repeat(rotations[:, None], 2, axis=1)
    halves[i, 0, 3 + k] = middle
    halves[i, 1, k] = middle
    return halves.reshape(-1, 6)


def _spread(owner: Numbers, most: int) -> Numbers:
    """Numbers of at most `most` pairs of each owner, evenly spread; owners are sorted."""
    count = np.bincount(owner)
    start = np.concatenate(([0], np.cumsum(count)[:-1]))
    place = np.arange(len(owner)) - start[owner]
    step = np.maximum(1, -(-count // most))[owner]
    return np.flatnonzero(place % step == 0)


def _sieve(
    problem: Bounded, cells: Cells, share: float, fine: float, decided: int
) -> tuple[Codes, Numbers, Array, int]:
    """Halve rotation cells until they are decided or small; drop those with the code `decided`.

    Returns
    -------
    codes of cells that a rotation or a rotation cell decides (the opposite of `decided`), owners
    and rotation cells that are left, and how many were decided.
    """
    target = _targets(problem, cells, share, fine)
    codes = np.zeros(len(cells), dtype=np.int8)
    owner, rotations = _pairs(cells)
    done_owner, done = [], []
    nodes = 0
    while len(owner):
        code = verdicts(problem, cells.low[owner], cells.high[owner], rotations)
        nodes += len(owner)
        codes[owner[code == -decided]] = -decided
        left = (code == UNDECIDED) & (codes[owner] == 0)
        owner, rotations = owner[left], rotations[left]
        if not len(owner):
            break
        tried = _spread(owner, WITNESSES)
        some = owner[tried]
        single = _points(_middles(rotations[tried]))
        code = verdicts(problem, cells.low[some], cells.high[some], single)
        codes[some[code == -decided]] = -decided
        left = codes[owner] == 0
        owner, rotations = owner[left], rotations[left]
        width = (rotations[:, 3:] - rotations[:, :3]).max(axis=1)
        crowd = np.bincount(owner, minlength=len(cells))[owner] > MOST_KEPT
        small = (width <= target[owner]) | crowd
        done_owner.append(owner[small])
        done.append(rotations[small])
        owner, rotations = np.repeat(owner[~small], 2), _halved(rotations[~small])
    owner = np.concatenate([*done_owner, owner])
    rotations = np.concatenate([*done, rotations])
    order = np.argsort(owner, kind="stable")
    left = codes[owner[order]] == 0
    return codes, owner[order][left], rotations[order][left], nodes


def _left(cells: Cells, codes: Codes, owner: Numbers, rotations: Array, nodes: int) -> Cells:
    count = np.bincount(owner, minlength=len(cells)).astype(np.int64)
    offset = np.concatenate(([0], np.cumsum(count)[:-1])).astype(np.int64)
    return Cells(
        cells.low,
        cells.high,
        offset,
        count,
        rotations,
        cells.families,
        cells.met,
        no_cuts(len(cells)),
        codes,
        nodes,
    )


def _reach_any(problem: Bounded, cells: Cells, fine: float) -> Cells:
    codes, owner, rotations, nodes = _sieve(problem, cells, SHARE, fine, OUTSIDE)
    left = np.bincount(owner, minlength=len(cells)) > 0
    codes = np.where((codes == 0) & ~left, OUTSIDE, codes).astype(np.int8)
    return _left(cells, codes, owner, rotations, nodes)


def _keep_spheres(problem: Bounded, cells: Cells) -> Cells:
    """Decide cells of positions that keep all rotations, for SPS legs."""
    from gsp.workspace.sets.compiled.cells import keep_cells

    result = cells.some(slice(None))
    result.codes, result.cuts = np.zeros(len(cells), dtype=np.int8), no_cuts(len(cells))
    if len(cells):
        first = cells.rotations[cells.offset[0] : cells.offset[0] + cells.count[0]]
        result.nodes = keep_cells(
            cells.low,
            cells.high,
            problem.legs,
            problem.turns,
            first,
            problem.least,
            problem.most,
            KEPT_SUMS,
            result.codes,
            result.cuts,
        )
    walls = inside_walls(problem.walls, cells.low, cells.high)
    result.codes = np.minimum(result.codes, walls)
    result.cuts[walls != INSIDE, 7] = np.inf
    return result


def dextrous_cells(problem: Bounded, cells: Cells, fine: float = FINEST) -> Cells:
    """Decide cells of positions: inside if all rotations are feasible on all of it."""
    if problem.plain:
        return _keep_spheres(problem, cells)
    codes, owner, rotations, nodes = _sieve(problem, cells, DEXTROUS_SHARE, fine, INSIDE)
    if len(owner) and not problem.opaque:
        for corner in range(8):
            chosen = np.array([3 * (corner >> k & 1) + k for k in range(3)])
            some = codes[owner] == 0
            single = _points(rotations[some][:, chosen])
            who = owner[some]
            code = verdicts(problem, cells.low[who], cells.high[who], single)
            codes[who[code == OUTSIDE]] = OUTSIDE
    keep = codes[owner] == 0
    owner, rotations = owner[keep], rotations[keep]
    left = np.bincount(owner, minlength=len(cells)) > 0
    codes = np.where((codes == 0) & ~left, INSIDE, codes).astype(np.int8)
    return _left(cells, codes, owner, rotations, nodes)
