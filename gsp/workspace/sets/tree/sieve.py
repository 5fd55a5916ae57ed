"""Rotation cells of many cells of positions, halved until they are decided or small."""

from __future__ import annotations

import numpy as np

from gsp.geometry.rotations import moving_places, rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE, UNDECIDED, Codes, Numbers
from gsp.workspace.sets.problem import Bounded
from gsp.workspace.sets.tree.cells import Cells, pairs_of
from gsp.workspace.sets.tree.verdicts import verdicts

# Rotation cells that a cell of positions keeps at most.
MOST_KEPT_ROTATIONS = 512
# Rotations that are tried as witnesses in one cell of positions.
WITNESSES_TRIED = 24
# Rotations of one cell of positions of which the best one is climbed from, and steps of that.
ROTATIONS_COMPARED, WITNESS_STEPS = 64, 6
# Directions of angles in which a step is tried.
DIRECTIONS = np.concatenate((np.eye(3), -np.eye(3)))


def _targets(problem: Bounded, cells: Cells, share: float, fine: float) -> Array:
    """Widths [rad] below which rotation cells are not halved."""
    wide = 0.5 * np.linalg.norm(cells.high - cells.low, axis=1)
    return np.asarray(np.maximum(fine, share * wide / problem.arm))


def points(angles: Array) -> Array:
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


def spread(owner: Numbers, most: int) -> Numbers:
    """Numbers of at most `most` pairs of each owner, evenly spread; owners are sorted."""
    count = np.bincount(owner)
    start = np.concatenate(([0], np.cumsum(count)[:-1]))
    place = np.arange(len(owner)) - start[owner]
    step = np.maximum(1, -(-count // most))[owner]
    return np.flatnonzero(place % step == 0)


def sieve(
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
    owner, rotations = pairs_of(cells)
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
        # A single rotation has narrower bounds than a cell, and one is enough as a witness.
        tried = spread(owner, WITNESSES_TRIED)
        some = owner[tried]
        single = points(_middles(rotations[tried]))
        code = verdicts(problem, cells.low[some], cells.high[some], single)
        codes[some[code == -decided]] = -decided
        left = codes[owner] == 0
        owner, rotations = owner[left], rotations[left]
        width = (rotations[:, 3:] - rotations[:, :3]).max(axis=1)
        # Cells with too many are not halved further, which bounds the memory.
        crowd = np.bincount(owner, minlength=len(cells))[owner] > MOST_KEPT_ROTATIONS
        small = (width <= target[owner]) | crowd
        done_owner.append(owner[small])
        done.append(rotations[small])
        owner, rotations = np.repeat(owner[~small], 2), _halved(rotations[~small])
    owner = np.concatenate([*done_owner, owner])
    rotations = np.concatenate([*done, rotations])
    order = np.argsort(owner, kind="stable")
    left = codes[owner[order]] == 0
    return codes, owner[order][left], rotations[order][left], nodes


def witnessed(problem: Bounded, cells: Cells, owner: Numbers, rotations: Array) -> Numbers:
    """Return the numbers of cells that a climbed rotation decides: it is feasible on all of them.

    Owners are sorted. Of the middles of rotation cells the one with the largest least margin, at
    the middle of the cell of positions, is moved to neighbours with a larger one.
    """
    if not len(owner):
        return owner
    place = 0.5 * (cells.low + cells.high)
    some = spread(owner, ROTATIONS_COMPARED)
    who, angles = owner[some], _middles(rotations[some])
    width = rotations[some, 3:] - rotations[some, :3]
    margin = _margins(problem, place[who], angles)
    order = np.lexsort((-margin, who))
    who, first = np.unique(who[order], return_index=True)
    best = order[first]
    angles, margin, step = angles[best], margin[best], 0.5 * width[best]
    i = np.arange(len(who))
    for _ in range(WITNESS_STEPS):
        tried = np.clip(angles[:, None] + step[:, None] * DIRECTIONS, problem.least, problem.most)
        found = _margins(problem, place[who, None], tried)
        k = found.argmax(axis=1)
        higher = found[i, k] > margin
        angles = np.where(higher[:, None], tried[i, k], angles)
        margin = np.maximum(margin, found[i, k])
        step[~higher] *= 0.5
    who, angles = who[margin > 0.0], angles[margin > 0.0]
    code = verdicts(problem, cells.low[who], cells.high[who], points(angles))
    return np.asarray(who[code == INSIDE])


def _margins(problem: Bounded, places: Array, angles: Array) -> Array:
    """How far the nearest bound is at poses, per size of its quantity; below zero beyond it.

    Places (..., 3) are in the axes of the frame, angles (..., 3) in the order of moving axes.
    """
    given, bounds = np.empty_like(angles), problem.quantities
    given[..., moving_places(problem.order)] = angles
    position = np.broadcast_to(problem.outward(places), angles.shape)
    with np.errstate(all="ignore"):
        values = bounds.quantities.values(position, rotation_from_angles(given, problem.order))
        worst = (bounds.excess(values) / bounds.sizes[:, None]).max(axis=(-2, -1))
    return np.where(np.isnan(worst), -np.inf, -worst)
