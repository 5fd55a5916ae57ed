"""Feasible poses of a region, evenly distributed."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp.checks import check_integer, check_memory, check_rng
from gsp.errors import EmptyWorkspace, expected
from gsp.geometry.pose import Pose
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.rotations import angle_set, moving_places, rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.limits import feasible
from gsp.workspace.sets.codes import INSIDE
from gsp.workspace.sets.region.sampling import even_pitch

# Poses that are drawn for one that is wanted, at most, and of one block.
DRAWS_PER_POSE, DRAWS_PER_BLOCK = 2_000, 20_000


def poses(region: Any, count: int, rng: np.random.Generator | int) -> Pose:
    """Return poses of a region: see `gsp.workspace.Region.poses`."""
    count, generator = check_integer("count", count, 1), check_rng("rng", rng)
    check_memory("count", count, POSE_BYTES, "poses")
    if region.empty:
        raise EmptyWorkspace(expected("region", "a cell or more", "an empty region"))
    found_p, found_r = [np.zeros((0, 3))], [np.zeros((0, 3, 3))]
    found, drawn = 0, 0
    while found < count and drawn < max(DRAWS_PER_POSE * count, DRAWS_PER_BLOCK):
        p, r = _feasible(region, generator, count - found)
        found_p.append(p)
        found_r.append(r)
        found, drawn = found + len(p), drawn + DRAWS_PER_BLOCK
    if found < count:
        got = f"{found} of {drawn} poses that were drawn"
        raise EmptyWorkspace(expected("region", f"{count} feasible poses", got))
    return Pose(np.concatenate(found_p)[:count], np.concatenate(found_r)[:count])


def _feasible(region: Any, rng: np.random.Generator, most: int) -> tuple[Array, Array]:
    """Positions and rotations of a block of draws that are in the region, `most` at most."""
    problem = region.problem
    if region.kind == "orientations":
        r = rotation_from_angles(_angles(region, DRAWS_PER_BLOCK, rng))
        p = np.repeat(problem.low[None], DRAWS_PER_BLOCK, axis=0)
        ok = feasible(problem.design, Pose(p, r), problem.limits).ok
        return p[ok][:most], r[ok][:most]
    inner = _positions(region, DRAWS_PER_BLOCK, rng)
    p, r = problem.outward(inner), drawn_rotations(problem, DRAWS_PER_BLOCK, rng)
    ok = feasible(problem.design, Pose(p, r), problem.limits).ok
    ok &= (inner @ problem.side[:, :3].T >= problem.side[:, 3]).all(axis=1)
    chosen = np.flatnonzero(ok)
    if region.all_rotations and (problem.most > problem.least).any():
        # One feasible orientation is not enough: the position has to be in the region.
        chosen = _inside(region, p, chosen, most)
    return p[chosen][:most], r[chosen][:most]


def _inside(region: Any, points: Array, chosen: NDArray[np.intp], most: int) -> NDArray[np.intp]:
    """Return those of the chosen points that are in the region; no more are decided than needed."""
    kept, found = [chosen[:0]], 0
    for part in np.split(chosen, range(2 * most, len(chosen), 2 * most)):
        kept.append(part[region.contains(points[part]) == INSIDE])
        found += len(kept[-1])
        if found >= most:
            break
    return np.concatenate(kept)


def _cells(region: Any, count: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """Cells, drawn by their measure, and even numbers from 0 to 1 per coordinate: (count, d)."""
    share = np.cumsum(region.sizes) / region.sizes.sum()
    cell = np.minimum(np.searchsorted(share, rng.random(count)), len(share) - 1)
    return cell, rng.random((count, region.low.shape[1]))


def _angles(region: Any, count: int, rng: np.random.Generator) -> Array:
    """Angles evenly distributed over the cells by the measure of the rotations: (count, 3)."""
    cell, inner = _cells(region, count, rng)
    low, high = region.low[cell], region.high[cell]
    angles: Array = low + inner * (high - low)
    angles[:, 1] = even_pitch(low[:, 1], high[:, 1], inner[:, 1])
    return angles


def _positions(region: Any, count: int, rng: np.random.Generator) -> Array:
    """Positions evenly distributed over the cells, in the axes of the problem: (count, 3)."""
    cell, inner = _cells(region, count, rng)
    points = region.low[cell] + inner * (region.high - region.low)[cell]
    return np.pad(points, ((0, 0), (0, 3 - points.shape[1])))


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
