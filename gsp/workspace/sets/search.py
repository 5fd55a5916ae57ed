"""Regions from trees of cells: of positions, and of orientations at one position."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from gsp.geometry.rotations import moving_places
from gsp.geometry.vectors import Array
from gsp.progress import Progress, meter
from gsp.workspace.sets.codes import Codes
from gsp.workspace.sets.problem import Bounded
from gsp.workspace.sets.region.regions import Region
from gsp.workspace.sets.tree.boxes import turn_measure
from gsp.workspace.sets.tree.cells import Cells, first_cells
from gsp.workspace.sets.tree.deciding import FINEST_ROTATIONS, dextrous_cells, reach
from gsp.workspace.sets.tree.growing import Aim, Leaves, grow
from gsp.workspace.sets.tree.symmetry import mirror_planes, unfolded
from gsp.workspace.sets.tree.verdicts import verdicts

# Rotation cells [rad] of single points are halved to this.
POINT_FINEST = 2e-3
# Cells that one task decides: by compiled code, which takes as long for each cell as alone; by
# arrays, whose evaluation costs the same for few; and by arrays where each has many rotation cells.
COMPILED_TASK, ARRAY_TASK, ROTATIONS_TASK = 16, 1024, 64

Decide = Callable[..., Cells]


def position_region(
    problem: Bounded, kind: str, decide: Decide, aim: Aim, workers: int, progress: Progress
) -> Region:
    """Return the region of positions that `decide` finds, in space or in a plane."""
    rotations = first_cells(problem)
    known = _searched(problem, aim)
    d = 2 if kind == "plane" else 3
    low, high = problem.low.copy(), problem.high
    domain = np.stack((low, np.maximum(low, high))).copy()
    planes = mirror_planes(known) if decide is reach else []
    for k, middle in planes:
        # The half beyond the plane is the image of this one.
        reach_k = max(high[k] - middle, middle - low[k])
        domain[:, k] = middle - reach_k, middle + reach_k
        low[k] = middle
    cells = Cells.begun(low[None], domain[1:], rotations)
    if (low > high).any():
        cells = cells.some(slice(0, 0))

    def measure(low: Array, high: Array) -> Array:
        return np.asarray((high - low)[:, :d].prod(axis=1))

    by_arrays = ARRAY_TASK if problem.single_rotation else ROTATIONS_TASK
    task = COMPILED_TASK if known.only_spheres else by_arrays
    chosen = partial(decide, known, fine=FINEST_ROTATIONS)
    with meter(progress, "cells") as report:
        leaves = grow(cells, chosen, measure, aim, task, workers, report)
    return _region(
        kind,
        problem,
        unfolded(leaves, planes),
        domain,
        partial(_codes_of_points, decide, problem, rotations),
        all_rotations=problem.single_rotation or decide is dextrous_cells,
        wanted=aim.resolution,
    )


def orientation_region(
    problem: Bounded, place: Array, aim: Aim, workers: int, progress: Progress
) -> Region:
    """Return the region of orientations at a position; cells are angles, as in `problem.order`."""
    known = _searched(problem, aim)
    moving = moving_places(problem.order)
    domain = np.empty((2, 3))
    domain[:, moving] = problem.least, problem.most

    def decide(cells: Cells) -> Cells:
        cells.codes, cells.nodes = _codes_of_turns(known, place, cells.low, cells.high), len(cells)
        return cells

    problem = replace(problem, low=place, high=place)
    root = Cells.begun(domain[:1], domain[1:], np.zeros((0, 6)))
    with meter(progress, "orientations") as report:
        leaves = grow(root, decide, turn_measure, aim, ARRAY_TASK, workers, report)
    single = partial(_codes_of_angles, problem, place)
    return _region("orientations", problem, leaves, domain, single, wanted=aim.resolution)


# What a region keeps to decide on single points: functions of the module, which can be pickled.
def _codes_of_points(decide: Decide, problem: Bounded, rotations: Array, points: Array) -> Codes:
    return decide(problem, Cells.begun(points, points, rotations), POINT_FINEST).codes


def _codes_of_angles(problem: Bounded, place: Array, angles: Array) -> Codes:
    return _codes_of_turns(problem, place, angles, angles)


def _codes_of_turns(problem: Bounded, place: Array, low: Array, high: Array) -> Codes:
    """Return the codes of boxes of angles at a place."""
    moving = moving_places(problem.order)
    at = np.repeat(place[None], len(low), axis=0)
    turns = np.concatenate((low[:, moving], high[:, moving]), axis=1)
    return verdicts(problem, at, at, turns)


def _searched(problem: Bounded, aim: Aim) -> Bounded:
    """Return the problem by which cells are halved.

    Where nothing can be proven inside, only a resolution is a reason to halve cells that all limits
    with bounds allow: nothing more would be decided on them.
    """
    return problem if aim.resolution is not None else problem.with_bounds


def _region(
    kind: str,
    problem: Bounded,
    leaves: Leaves,
    domain: Array,
    decide: Callable[[Array], Codes],
    *,
    all_rotations: bool = False,
    wanted: float | None,
) -> Region:
    d = 2 if kind == "plane" else 3
    leaves = leaves.undecided() if problem.unbounded_limits else leaves
    return Region(
        kind,
        problem,
        leaves.low[:, :d],
        leaves.high[:, :d],
        leaves.codes,
        leaves.cuts,
        domain[:, :d],
        leaves.levels,
        leaves.nodes,
        decide,
        all_rotations,
        wanted,
    )
