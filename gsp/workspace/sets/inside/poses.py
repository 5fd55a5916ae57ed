"""Feasible poses of a region, evenly distributed."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.checks import check_integer, check_memory, check_rng
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.rotations import angle_set, moving_places, rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.limits import feasible

# Poses that are drawn for one that is wanted, at most, and of one block.
DRAWS_PER_POSE, DRAWS_PER_BLOCK = 2_000, 20_000


def poses(region: Any, count: int, rng: np.random.Generator | int) -> Pose:
    """Return poses of a region of positions: see `gsp.workspace.Region.poses`."""
    count, generator = check_integer("count", count, 1), check_rng("rng", rng)
    check_memory("count", count, POSE_BYTES, "poses")
    if region.kind == "orientations":
        raise InvalidInput(expected("region", "a region of positions", region.kind))
    if region.empty:
        raise EmptyWorkspace(expected("region", "a cell or more", "an empty region"))
    problem = region.problem
    found_p, found_r = [np.zeros((0, 3))], [np.zeros((0, 3, 3))]
    found, drawn = 0, 0
    while found < count and drawn < max(DRAWS_PER_POSE * count, DRAWS_PER_BLOCK):
        inner = _positions(region, DRAWS_PER_BLOCK, generator)
        p = problem.outward(inner)
        r = drawn_rotations(problem, DRAWS_PER_BLOCK, generator)
        ok = feasible(problem.design, Pose(p, r), problem.limits).ok
        ok &= (inner @ problem.side[:, :3].T >= problem.side[:, 3]).all(axis=1)
        found_p.append(p[ok])
        found_r.append(r[ok])
        found, drawn = found + int(ok.sum()), drawn + DRAWS_PER_BLOCK
    if found < count:
        got = f"{found} of {drawn} poses that were drawn"
        raise EmptyWorkspace(expected("region", f"{count} feasible poses", got))
    return Pose(np.concatenate(found_p)[:count], np.concatenate(found_r)[:count])


def _positions(region: Any, count: int, rng: np.random.Generator) -> Array:
    """Positions evenly distributed over the cells, in the axes of the problem: (count, 3)."""
    share = np.cumsum(region.sizes) / region.sizes.sum()
    cell = np.minimum(np.searchsorted(share, rng.random(count)), len(share) - 1)
    d = region.low.shape[1]
    inner = rng.random((count, d))
    points = region.low[cell] + inner * (region.high - region.low)[cell]
    return np.pad(points, ((0, 0), (0, 3 - d)))


def drawn_rotations(problem: Any, count: int, rng: np.random.Generator) -> Array:
    """Rotations evenly distributed over the range of the problem, in base axes: (count, 3, 3).

    The measure of the rotations is |cos β| dα dβ dγ with the second angle β about moving axes, and
    |sin β| dα dβ dγ where the first and the third axis are the same.
    """
    sequence, _ = angle_set(problem.order)
    weight = np.sin if sequence[0].lower() == sequence[2].lower() else np.cos
    low, high = problem.least, problem.most
    if low[1] == high[1]:
        moving = low + rng.random((count, 3)) * (high - low)
    else:
        moving = np.zeros((0, 3))
        while len(moving) < count:
            more = low + rng.random((2 * count, 3)) * (high - low)
            kept = rng.random(2 * count) < np.abs(weight(more[:, 1]))
            moving = np.concatenate((moving, more[kept]))
    angles = np.empty((count, 3))
    angles[:, moving_places(problem.order)] = moving[:count]
    return rotation_from_angles(angles, problem.order)
