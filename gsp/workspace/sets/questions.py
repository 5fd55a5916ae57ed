"""What is asked of a workspace: reachable, dextrous, fixed orientation, orientations at a point."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from os import cpu_count
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_integer, check_positive, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import PoseBox
from gsp.geometry.rotations import angles_from_rotation, check_rotation
from gsp.geometry.vectors import Array
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.progress import Progress, meter
from gsp.workspace.sets.boxes import turn_measure
from gsp.workspace.sets.problem import Bounded, bounded
from gsp.workspace.sets.region import Region, region_of
from gsp.workspace.sets.tree import Aim, grow
from gsp.workspace.sets.verdicts import (
    FINEST,
    Cells,
    Codes,
    dextrous_cells,
    reach,
    verdicts,
)

# Where a search ends without a resolution: half the width of the bracket over its middle.
BRACKET = {"space": 0.06, "plane": 0.02, "orientations": 0.06}
# Rotation cells of a search.
BUDGET = 3_000_000
# Rotation cells [rad] of single points are halved to this.
POINT_FINEST = 2e-3

Decide = Callable[..., Cells]


def reachable(
    design: Design,
    limits: Limits | None = None,
    *,
    plane: Any = None,
    rotations: PoseBox | None = None,
    resolution: float | None = None,
    budget: int = BUDGET,
    workers: int | None = None,
    progress: Progress = None,
) -> Region:
    """Return the positions that the design reaches with some orientation.

    Parameters
    ----------
    design : Design
        Any legs.
    limits : Limits or None
        Default: the strokes of the design.
    plane : pair (point, two directions) or None [length, any length]
        The positions are those of a plane: base axes; default all of space.
    rotations : PoseBox or None
        The orientations that count are those of its angles; its positions are not used. Default
        all orientations.
    resolution : float or None [length]
        Longest side of the cells that may stay undecided. Default: cells are halved until the
        bracket is within ±6 % (of an area 2 %), or the budget ends.
    budget : int
        Rotation cells to decide, at most; a level that would probably exceed it is not begun.
    workers : int or None
        Threads; default as many as the machine has. The result does not depend on it.
    progress : function (done, total), bool or None
        Called after each level of halving; False for nothing; None or True draw a bar.

    Returns
    -------
    Region [length]

    Raises
    ------
    MissingParameter
        If nothing bounds the design.
    InvalidInput
        If positions are not bounded, or on arguments of other types, shapes or ranges.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> box = gsp.PoseBox([0, 0, 0], [0, 0, 0])
    >>> plane = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
    >>> found = reachable(d, plane=plane, rotations=box, resolution=0.5)
    >>> found.contains([0, 0, 8])
    array(1, dtype=int8)

    *Source: the bounds and the search are ours; see docs/sets.md*
    """
    problem = bounded(_design(design), limits, plane, _rotations(rotations))
    aim = _aim(_kind(plane), resolution, budget)
    return _positions(problem, _kind(plane), reach, aim, workers, progress)


def dextrous(
    design: Design,
    rotations: PoseBox,
    limits: Limits | None = None,
    *,
    plane: Any = None,
    resolution: float | None = None,
    budget: int = BUDGET,
    workers: int | None = None,
    progress: Progress = None,
) -> Region:
    """Return the positions that keep all orientations of a range.

    Parameters
    ----------
    design : Design
        Any legs.
    rotations : PoseBox
        The orientations are those of its angles; its positions are not used.
    limits : Limits or None
        Default: the strokes of the design.
    plane : pair (point, two directions) or None [length, any length]
        The positions are those of a plane, given in base axes; default all of space.
    resolution : float or None [length]
        Longest side of the cells that may stay undecided. Default: cells are halved until the
        bracket is within ±6 % (of an area 2 %), or the budget ends.
    budget : int
        Rotation cells to decide, at most; a level that would probably exceed it is not begun.
    workers : int or None
        Threads; default as many as the machine has. The result does not depend on it.
    progress : function (done, total), bool or None
        Called after each level of halving; False for nothing; None or True draw a bar.

    Returns
    -------
    Region [length]

    Raises
    ------
    MissingParameter
        If nothing bounds the design.
    InvalidInput
        If positions are not bounded, or on arguments of other types, shapes or ranges.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> box = gsp.PoseBox([0, 0, 0], [0, 0, (-10, 10)], degrees=True)
    >>> dextrous(d, box, resolution=2.0).contains([0, 0, 8])
    array(1, dtype=int8)

    *Source: Workspace-3, §3.1; the bounds and the search are ours*
    """
    check_type("rotations", rotations, PoseBox)
    problem = bounded(_design(design), limits, plane, rotations)
    aim = _aim(_kind(plane), resolution, budget)
    return _positions(problem, _kind(plane), dextrous_cells, aim, workers, progress)


def fixed_orientation(
    design: Design,
    rotation: ArrayLike | None = None,
    limits: Limits | None = None,
    *,
    plane: Any = None,
    resolution: float | None = None,
    budget: int = BUDGET,
    workers: int | None = None,
    progress: Progress = None,
) -> Region:
    """Return the positions that the design reaches with one orientation.

    Parameters
    ----------
    design : Design
        Any legs.
    rotation : (3, 3) array_like or None [1]
        Default the identity.
    limits : Limits or None
        Default: the strokes of the design.
    plane : pair (point, two directions) or None [length, any length]
        The positions are those of a plane, given in base axes; default all of space.
    resolution : float or None [length]
        Longest side of the cells that may stay undecided. Default: cells are halved until the
        bracket is within ±6 % (of an area 2 %), or the budget ends.
    budget : int
        Rotation cells to decide, at most; a level that would probably exceed it is not begun.
    workers : int or None
        Threads; default as many as the machine has. The result does not depend on it.
    progress : function (done, total), bool or None
        Called after each level of halving; False for nothing; None or True draw a bar.

    Returns
    -------
    Region [length]

    Raises
    ------
    MissingParameter
        If nothing bounds the design.
    InvalidInput
        If positions are not bounded, or on arguments of other types, shapes or ranges.
    InvalidRotation
        If `rotation` is none.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> fixed_orientation(d, resolution=2.0).contains([0, 0, 8])
    array(1, dtype=int8)

    *Source: Workspace-3, §3.1 (ii); the bounds and the search are ours*
    """
    turn = np.eye(3) if rotation is None else check_rotation("rotation", rotation)
    if turn.ndim != 2:
        raise InvalidInput(expected("rotation", "a single rotation", f"shape {turn.shape}"))
    box = PoseBox([0.0, 0.0, 0.0], angles_from_rotation(turn).tolist())
    problem = bounded(_design(design), limits, plane, box)
    aim = _aim(_kind(plane), resolution, budget)
    return _positions(problem, _kind(plane), reach, aim, workers, progress)


def orientations(
    design: Design,
    position: ArrayLike,
    limits: Limits | None = None,
    *,
    resolution: float | None = None,
    budget: int = BUDGET,
    workers: int | None = None,
    progress: Progress = None,
) -> Region:
    """Return the orientations that the design takes at one position.

    Parameters
    ----------
    design : Design
        Any legs.
    position : (3,) array_like [length]
    limits : Limits or None
        Default: the strokes of the design.
    resolution : float or None [rad]
        Longest side of the cells of angles that may stay undecided. Default: as in `reachable`.
    budget : int
        Rotation cells to decide, at most; a level that would probably exceed it is not begun.
    workers : int or None
        Threads; default as many as the machine has. The result does not depend on it.
    progress : function (done, total), bool or None
        Called after each level of halving; False for nothing; None or True draw a bar.

    Returns
    -------
    Region [length]
        Its cells are boxes of "rpy" angles; its volume is that among the rotations, of 8π² in all.

    Raises
    ------
    MissingParameter
        If nothing bounds the design.
    InvalidInput
        On arguments of other types, shapes or ranges.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> orientations(d, [0, 0, 8], resolution=0.4).contains([0, 0, 0])
    array(1, dtype=int8)

    *Source: the bounds and the search are ours; see docs/sets.md*
    """
    place = check_array("position", position, (3,))
    if place.ndim != 1:
        raise InvalidInput(expected("position", "a single point", f"shape {place.shape}"))
    problem = bounded(_design(design), limits, domain=False)
    domain = np.stack((problem.least, problem.most))

    def decide(cells: Cells) -> Cells:
        at = np.broadcast_to(place, cells.low.shape)
        boxes = np.concatenate((cells.low, cells.high), axis=1)
        cells.codes = verdicts(problem, np.ascontiguousarray(at), np.ascontiguousarray(at), boxes)
        cells.nodes = len(cells)
        return cells

    def single(angles: Array) -> Codes:
        at = np.repeat(place[None], len(angles), axis=0)
        return verdicts(problem, at, at, np.concatenate((angles, angles), axis=1))

    with meter(progress, "orientations") as report:
        leaves = grow(
            _root(domain[0], domain[1], np.zeros((0, 6))),
            decide,
            turn_measure,
            _aim("orientations", resolution, budget),
            _workers(workers),
            report,
        )
    return region_of("orientations", problem, leaves, domain, single)


def _positions(
    problem: Bounded, kind: str, decide: Decide, aim: Aim, workers: int | None, progress: Progress
) -> Region:
    rotations = _first_cells(problem)
    d = 2 if kind == "plane" else 3
    low, high = problem.low, problem.high
    domain = np.stack((low, np.maximum(low, high)))
    cells = _root(low, high, rotations)
    if (low > high).any():
        cells = cells.some(slice(0, 0))

    def measure(low: Array, high: Array) -> Array:
        return np.asarray((high - low)[:, :d].prod(axis=1))

    def single(points: Array) -> Codes:
        return _single(problem, decide, points, rotations)

    with meter(progress, "cells") as report:
        leaves = grow(
            cells, partial(decide, problem, fine=FINEST), measure, aim, _workers(workers), report
        )
    return region_of(kind, problem, leaves, domain, single)


def _single(problem: Bounded, decide: Decide, points: Array, rotations: Array) -> Codes:
    """Decide single points."""
    n = len(points)
    cells = Cells(
        points,
        points,
        np.zeros(n, dtype=np.int64),
        np.full(n, len(rotations)),
        rotations,
        np.zeros((n, 3)),
        np.zeros(n, dtype=np.bool_),
    )
    return decide(problem, cells, POINT_FINEST).codes


def _root(low: Array, high: Array, rotations: Array) -> Cells:
    one = np.array([len(rotations)], dtype=np.int64)
    return Cells(
        low[None],
        high[None],
        np.zeros(1, dtype=np.int64),
        one,
        rotations,
        np.zeros((1, 3)),
        np.zeros(1, dtype=np.bool_),
    )


def _first_cells(problem: Bounded) -> Array:
    """Rotation cells to begin with: no side above a quarter of a turn, shape (m, 6)."""
    edges = []
    for least, most in zip(problem.least, problem.most, strict=True):
        n = max(1, int(np.ceil((most - least) / (0.5 * np.pi) - 1e-9)))
        ends = np.linspace(least, most, n + 1)
        edges.append(list(pairwise(ends)))
    cells = [(a, b, c) for a in edges[0] for b in edges[1] for c in edges[2]]
    return np.array([[*(x for x, _ in cell), *(y for _, y in cell)] for cell in cells])


def _design(design: Any) -> Design:
    check_type("design", design, Design)
    return design  # type: ignore[no-any-return]


def _rotations(rotations: Any) -> PoseBox | None:
    if rotations is not None:
        check_type("rotations", rotations, PoseBox, "a gsp.PoseBox, or None for all orientations")
    return rotations  # type: ignore[no-any-return]


def _kind(plane: Any) -> str:
    return "space" if plane is None else "plane"


def _aim(kind: str, resolution: float | None, budget: int) -> Aim:
    fine = None if resolution is None else check_positive("resolution", resolution)
    return Aim(fine, BRACKET[kind], check_integer("budget", budget))


def _workers(workers: int | None) -> int:
    return (cpu_count() or 1) if workers is None else check_integer("workers", workers)
