"""Rotation cells of many cells of positions, halved until they are decided or small."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import UNDECIDED, Codes, Numbers
from gsp.workspace.sets.problem import Bounded
from gsp.workspace.sets.tree.cells import Cells, pairs_of
from gsp.workspace.sets.tree.verdicts import verdicts

# Rotation cells that a cell of positions keeps at most.
MOST_KEPT_ROTATIONS = 512
# Rotations that are tried as witnesses in one cell of positions.
WITNESSES_TRIED = 24


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
