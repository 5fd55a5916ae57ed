"""Workspaces as regions: reachable, dextrous, of one orientation; orientations at one position."""

from __future__ import annotations

from os import cpu_count
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import bounded_array
from gsp.checks import check_integer, check_positive, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import PoseBox
from gsp.geometry.rotations import angles_from_rotation, check_rotation
from gsp.limits import Limits
from gsp.model.design import Design, check_undriven
from gsp.progress import Progress
from gsp.workspace.sets.problem import bounded
from gsp.workspace.sets.region.regions import Region
from gsp.workspace.sets.search import orientation_region, position_region
from gsp.workspace.sets.tree.deciding import dextrous_cells, reach
from gsp.workspace.sets.tree.growing import Aim

# Where a search ends without a resolution: half the width of the bracket over its middle.
BRACKET_TOLERANCES = {"space": 0.06, "plane": 0.02, "orientations": 0.06, "dextrous": 0.03}
# Rotation cells and balls of a search.
CELL_BUDGET = 6_000_000


def reachable(
    design: Design,
    limits: Limits | None = None,
    *,
    plane: Any = None,
    half_space: ArrayLike | None = None,
    rotations: PoseBox | None = None,
    resolution: float | None = None,
    budget: int = CELL_BUDGET,
    workers: int | None = None,
    progress: Progress = None,
) -> Region:
    """Return the positions at which some orientation is feasible.

    Parameters
    ----------
    design : Design
        Any legs.
    limits : Limits or None
        Default: the strokes of the design.
    plane : pair (point, two directions) or None [length, any length]
        The positions are those of a plane, given in base axes; default all of space.
    half_space : (4,) array_like or None [any length n, that length times length]
        n and c: only positions p with n · p ≥ c, in base axes, such as those on one side of an
        inclined base.
    rotations : PoseBox or None
        The orientations that count are those of its angles; its positions are not used. Default
        all orientations.
    resolution : float or None [length]
        Longest side of the cells that may stay undecided; `Region.reached` states whether the
        budget ended the search before, at `Region.resolution`. Default: cells are halved until the
        bracket is within ±6 % (of an area 2 %), or the budget ends.
    budget : int
        Rotation cells and weighted sums to bound, at most; a level that would probably exceed it
        is not begun.
    workers : int or None
        Threads; default as many as the machine has. The result does not depend on it.
    progress : function (done, total), bool or None
        Called after each level of halving; False: no output; None or True: a progress bar.

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
    problem = bounded(_design(design), limits, plane, _rotations(rotations), half_space=half_space)
    aim = _aim(_kind(plane), resolution, budget)
    return position_region(problem, _kind(plane), reach, aim, _workers(workers), progress)


def dextrous(
    design: Design,
    rotations: PoseBox,
    limits: Limits | None = None,
    *,
    plane: Any = None,
    half_space: ArrayLike | None = None,
    resolution: float | None = None,
    budget: int = CELL_BUDGET,
    workers: int | None = None,
    progress: Progress = None,
) -> Region:
    """Return the positions at which all orientations of a range are feasible.

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
    half_space : (4,) array_like or None [any length n, that length times length]
        n and c: only positions p with n · p ≥ c, in base axes, such as those on one side of an
        inclined base.
    resolution : float or None [length]
        Longest side of the cells that may stay undecided; `Region.reached` states whether the
        budget ended the search before, at `Region.resolution`. Default: cells are halved until the
        bracket is within ±3 % (of an area 2 %), or the budget ends.
    budget : int
        Rotation cells and weighted sums to bound, at most; a level that would probably exceed it
        is not begun.
    workers : int or None
        Threads; default as many as the machine has. The result does not depend on it.
    progress : function (done, total), bool or None
        Called after each level of halving; False: no output; None or True: a progress bar.

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
    problem = bounded(_design(design), limits, plane, rotations, half_space=half_space)
    aim = _aim("dextrous" if plane is None else "plane", resolution, budget)
    return position_region(problem, _kind(plane), dextrous_cells, aim, _workers(workers), progress)


def fixed_orientation(
    design: Design,
    rotation: ArrayLike | None = None,
    limits: Limits | None = None,
    *,
    plane: Any = None,
    half_space: ArrayLike | None = None,
    resolution: float | None = None,
    budget: int = CELL_BUDGET,
    workers: int | None = None,
    progress: Progress = None,
) -> Region:
    """Return the positions at which one orientation is feasible.

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
    half_space : (4,) array_like or None [any length n, that length times length]
        n and c: only positions p with n · p ≥ c, in base axes, such as those on one side of an
        inclined base.
    resolution : float or None [length]
        Longest side of the cells that may stay undecided; `Region.reached` states whether the
        budget ended the search before, at `Region.resolution`. Default: cells are halved until the
        bracket is within ±6 % (of an area 2 %), or the budget ends.
    budget : int
        Rotation cells and weighted sums to bound, at most; a level that would probably exceed it
        is not begun.
    workers : int or None
        Threads; default as many as the machine has. The result does not depend on it.
    progress : function (done, total), bool or None
        Called after each level of halving; False: no output; None or True: a progress bar.

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
        If `rotation` is not a rotation matrix.

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
    problem = bounded(_design(design), limits, plane, box, half_space=half_space)
    # One rotation is reached where it is kept; for SPS legs that is decided faster.
    decide = dextrous_cells if problem.with_bounds.only_spheres else reach
    aim = _aim(_kind(plane), resolution, budget)
    return position_region(problem, _kind(plane), decide, aim, _workers(workers), progress)


def orientations(
    design: Design,
    position: ArrayLike,
    limits: Limits | None = None,
    *,
    resolution: float | None = None,
    budget: int = CELL_BUDGET,
    workers: int | None = None,
    progress: Progress = None,
) -> Region:
    """Return the orientations that are feasible at one position.

    Parameters
    ----------
    design : Design
        Any legs.
    position : (3,) array_like [length]
    limits : Limits or None
        Default: the strokes of the design.
    resolution : float or None [rad]
        Longest side of the cells of angles that may stay undecided, as in `reachable`, which has
        the default too.
    budget : int
        Rotation cells and weighted sums to bound, at most; a level that would probably exceed it
        is not begun.
    workers : int or None
        Threads; default as many as the machine has. The result does not depend on it.
    progress : function (done, total), bool or None
        Called after each level of halving; False: no output; None or True: a progress bar.

    Returns
    -------
    Region [rad]
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
    place = bounded_array("position", position, (3,))
    if place.ndim != 1:
        raise InvalidInput(expected("position", "a single point", f"shape {place.shape}"))
    problem = bounded(_design(design), limits, domain=False)
    aim = _aim("orientations", resolution, budget)
    return orientation_region(problem, place, aim, _workers(workers), progress)


def _design(design: Any) -> Design:
    check_undriven("design", design)
    return design  # type: ignore[no-any-return]


def _rotations(rotations: Any) -> PoseBox | None:
    if rotations is not None:
        check_type("rotations", rotations, PoseBox, "a gsp.PoseBox, or None for all orientations")
    return rotations  # type: ignore[no-any-return]


def _kind(plane: Any) -> str:
    return "space" if plane is None else "plane"


def _aim(kind: str, resolution: float | None, budget: int) -> Aim:
    fine = None if resolution is None else check_positive("resolution", resolution)
    return Aim(fine, BRACKET_TOLERANCES[kind], check_integer("budget", budget))


def _workers(workers: int | None) -> int:
    return (cpu_count() or 1) if workers is None else check_integer("workers", workers)
