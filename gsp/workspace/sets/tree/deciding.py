"""Decisions on cells of positions: with some rotation of a range, or with all of them."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes, Numbers
from gsp.workspace.sets.problem import Bounded, inside_half_spaces
from gsp.workspace.sets.tree.cells import Cells
from gsp.workspace.sets.tree.cuts import decided, no_cuts
from gsp.workspace.sets.tree.sieve import points, sieve, witnessed
from gsp.workspace.sets.tree.verdicts import verdicts

# Rotation cells reach as far as this share of the cell of positions, at the platform anchors.
# Smaller ones would hardly narrow bounds that the positions make wide.
SHARE, DEXTROUS_SHARE = 1.0, 0.5
# The smallest rotation cells [rad].
FINEST_ROTATIONS = 1e-3
# Sums that are bounded to prove a cell of positions outside: over all rotations, over a range of
# them (a proof that ends too early costs more in the halves), and of a point.
CELL_SUMS, RANGE_SUMS, POINT_SUMS = 400, 1200, 4000
# Rotation cells of one leg and one cell of positions that keep all rotations.
KEPT_SUMS = 3000


def reach(
    problem: Bounded, cells: Cells, fine: float = FINEST_ROTATIONS, sums: int | None = None
) -> Cells:
    """Decide cells of positions: inside if one rotation is feasible on all of it.

    `sums` are those that are bounded to prove a cell outside, if not as many as usual.
    """
    half_spaces = inside_half_spaces(problem.half_spaces, cells.low, cells.high)
    spheres = problem.only_spheres
    found = _reach_spheres(problem, cells, sums) if spheres else _reach_any(problem, cells, fine)
    # Outside a half-space is outside; a cell that its boundary crosses is not inside.
    across = (half_spaces == UNDECIDED) & (found.codes == INSIDE)
    found.codes = np.where(half_spaces == OUTSIDE, OUTSIDE, found.codes).astype(np.int8)
    found.codes[across] = UNDECIDED
    found.cuts[half_spaces != INSIDE, 7] = np.inf
    # These are halved again and need their rotation cells, which the code inside has dropped.
    if across.any() and not spheres:
        found.count[across], found.offset[across] = cells.count[across], len(found.rotations)
        kept = [
            cells.rotations[o : o + n]
            for o, n in zip(cells.offset[across], cells.count[across], strict=True)
        ]
        found.offset[across] += np.concatenate(([0], np.cumsum([len(k) for k in kept])[:-1]))
        found.rotations = np.concatenate((found.rotations, *kept))
    return found


def _reach_spheres(problem: Bounded, cells: Cells, most: int | None) -> Cells:
    """Decide cells over the rotations of a range, each from the first rotation cells."""
    from gsp.workspace.sets.compiled.cells import reach_cells

    codes = decided(cells.low, cells.high, cells.cuts)
    open_ = np.flatnonzero(codes == UNDECIDED)
    some = cells.some(open_)
    found, met, families, cuts = (
        np.zeros(len(some), dtype=np.int8),
        *(x.copy() for x in (some.met, some.families, some.cuts)),
    )
    sums = CELL_SUMS if problem.free else RANGE_SUMS
    if bool((some.low == some.high).all()):
        sums = POINT_SUMS
    sums = sums if most is None else most
    nodes = 0
    if len(some):
        first = cells.rotations[some.offset[0] : some.offset[0] + some.count[0]]
        nodes = reach_cells(
            some.low,
            some.high,
            families,
            met,
            problem.legs,
            problem.faces,
            problem.turns,
            problem.within,
            first,
            sums,
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
    codes, owner, rotations, nodes = sieve(problem, cells, SHARE, fine, OUTSIDE)
    left = np.bincount(owner, minlength=len(cells)) > 0
    codes = np.where((codes == 0) & ~left, OUTSIDE, codes).astype(np.int8)
    if not problem.single_rotation:  # a single rotation has been tried
        codes[witnessed(problem, cells, owner, rotations)] = INSIDE
    left = codes[owner] == UNDECIDED
    return _left(cells, codes, owner[left], rotations[left], nodes)


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
    half_spaces = inside_half_spaces(problem.half_spaces, cells.low, cells.high)
    result.codes = np.minimum(result.codes, half_spaces)
    result.cuts[half_spaces != INSIDE, 7] = np.inf
    return result


def dextrous_cells(problem: Bounded, cells: Cells, fine: float = FINEST_ROTATIONS) -> Cells:
    """Decide cells of positions: inside if all rotations are feasible on all of it."""
    if problem.only_spheres:
        return _keep_spheres(problem, cells)
    codes, owner, rotations, nodes = sieve(problem, cells, DEXTROUS_SHARE, fine, INSIDE)
    if len(owner) and not problem.unbounded_limits:
        # A corner of a rotation cell is a rotation of the range, and its bounds are narrower.
        for corner in range(8):
            chosen = np.array([3 * (corner >> k & 1) + k for k in range(3)])
            some = codes[owner] == 0
            single = points(rotations[some][:, chosen])
            who = owner[some]
            code = verdicts(problem, cells.low[who], cells.high[who], single)
            codes[who[code == OUTSIDE]] = OUTSIDE
    keep = codes[owner] == 0
    owner, rotations = owner[keep], rotations[keep]
    left = np.bincount(owner, minlength=len(cells)) > 0
    codes = np.where((codes == 0) & ~left, INSIDE, codes).astype(np.int8)
    return _left(cells, codes, owner, rotations, nodes)
