"""The formulas of the legs on arrays: legs of one kind and poses of a batch at once.

Scalars are arrays with the axes (leg, pose), so that poses are neighbours in memory, and
POSES_PER_ASSEMBLY bounds them to what a cache holds. Every operation acts on single numbers and is
rounded correctly or by the same code: the bits of an element do not depend on the batch.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.geometry import scalars
from gsp.geometry.copies import ReadOnly
from gsp.geometry.scalars import Vector, components
from gsp.geometry.vectors import Array, Mask, norm
from gsp.model.formulas import PassiveRate, Placement, placement

# Number of poses whose arrays fit into a cache.
POSES_PER_ASSEMBLY = 4096

# Up to this number of poses a vector is one array: numpy's overhead of a call, which then takes
# most of the time, occurs once for three components.
FEW_POSES = 64

Places = slice | NDArray[np.int64]


@dataclass(frozen=True, eq=False, kw_only=True)
class Group(ReadOnly):
    """The legs of one kind in a design; n = 3 components in space, 2 in the plane.

    Attributes
    ----------
    kind : Leg or PlanarConstraint
    count : int
        Their number k.
    legs : slice or (k,) int array
        Which legs of the design they are.
    rows : tuple of slices or (k,) int arrays
        Their rows of the Jacobian, for each constraint of the kind.
    points, directions : two (n, k, 1) arrays
        a and b [length], s and t; t is empty where the kind has no line on the platform.
    reach : (k, 1) array [length]
        |a| + |b|.
    drives : (m, k, 1) array, or none
        The numbers of the drives of legs that are driven at the base.
    """

    kind: Any
    count: int
    legs: Places
    rows: tuple[Places, ...]
    points: tuple[Any, Any]
    directions: tuple[Any, Any]
    reach: Array
    drives: Any = ()


class Part(NamedTuple):
    """The legs of one kind at some poses of a batch: scalars are (k, poses) arrays."""

    poses: slice
    group: Group
    at: Placement
    segment: Any  # Segment or PlanarSegment
    undefined: Mask | None  # where the segment is; None if nowhere


def groups(
    legs: Sequence[Any],
    kinds: Sequence[Any],
    points: tuple[Array, Array],
    directions: tuple[Array, Array],
) -> tuple[Group, ...]:
    """Return the groups of legs of one kind, in the order of `kinds`.

    Parameters
    ----------
    legs, kinds : sequences of Leg or PlanarConstraint
        Of a design, and all there are.
    points : two (n_legs, n) arrays [length]
        a and b.
    directions : two (n_legs, n) arrays
        s and t.
    """
    first_rows = np.cumsum([0] + [len(leg.constraints) for leg in legs])[:-1]
    reach = norm(points[0]) + norm(points[1])
    result = []
    for kind in kinds:
        chosen = np.array(
            [i for i, leg in enumerate(legs) if leg.name == kind.name], dtype=np.int64
        )
        if not chosen.size:
            continue
        a, b, s, t = (x[chosen].T[..., None] for x in (*points, *directions))
        result.append(
            Group(
                kind=kind,
                count=len(chosen),
                legs=_places(chosen),
                rows=tuple(_places(first_rows[chosen] + i) for i in range(len(kind.constraints))),
                points=(a, b),
                directions=(s, t if kind.platform_line else []),
                reach=reach[chosen, None],
                drives=_numbers_of_drives([legs[i] for i in chosen]),
            )
        )
    return tuple(result)


def _numbers_of_drives(legs: Sequence[Any]) -> Any:
    """Return the numbers of the drives of legs of one kind, (m, k, 1), or () if it has none."""
    if getattr(legs[0], "drive", None) is None:
        return ()
    return np.array([leg.drive.numbers for leg in legs]).T[..., None]


def _places(indices: NDArray[np.int64]) -> Places:
    """Return evenly spaced indices as a slice, with which numpy is faster."""
    steps = np.unique(np.diff(indices))
    if steps.size > 1:
        return indices
    step = int(steps[0]) if steps.size else 1
    return slice(int(indices[0]), int(indices[-1]) + 1, step)


def parts(legs: Sequence[Group], position: Array, rotation: Array) -> Iterator[Part]:
    """Yield the groups of legs at some of the poses after the other.

    Poses are counted without the shape of their batch, POSES_PER_ASSEMBLY together.

    Parameters
    ----------
    legs : sequence of Group
    position : (..., n) array [length]
    rotation : (..., n, n) array
    """
    n = position.shape[-1]
    positions, rotations = position.reshape(-1, n), rotation.reshape(-1, n * n)
    for start in range(0, len(positions), POSES_PER_ASSEMBLY):
        poses = slice(start, start + POSES_PER_ASSEMBLY)
        p, r = _scalars(positions[poses]), _scalars(rotations[poses])
        with np.errstate(all="ignore"):
            distance = scalars.norm(p)
            evaluated = [part_of(group, poses, p, r, distance) for group in legs]
        yield from evaluated


def _scalars(array: Array) -> Any:
    """Return components (n, 1, poses) as one array where the poses are few, else as n arrays."""
    if len(array) > FEW_POSES:
        return components(array)
    return np.ascontiguousarray(array.T)[:, None]


def part_of(group: Group, poses: slice, p: Vector, r: Vector, distance: Any) -> Part:
    """Return the legs of a group at poses whose p, R and |p| are scalars of any kind."""
    at = placement(p, r, group.points, group.directions, distance + group.reach)
    if len(group.drives):
        at = at._replace(drive=group.drives)
    segment = group.kind.segment(at)
    undefined = None if np.all(segment.defined) else ~segment.defined
    return Part(poses, group, at, segment, undefined)


def joints_and_rows(
    legs: Iterable[Part], n_poses: int, n_joints: int, columns: int
) -> tuple[Array, Array]:
    """Return joint values (n_poses, n_joints) and rows (n_poses, n_joints, columns).

    NaN where an element is undefined.

    Parameters
    ----------
    legs : iterable of Part
        All legs of a design at all poses of a batch.
    n_poses, n_joints : int
        Poses and actuated joints.
    columns : int
        Components of a twist; 0 leaves the rows out.
    """
    joints, rows = np.empty((n_poses, n_joints, 1)), np.empty((n_poses, n_joints, columns))
    with np.errstate(all="ignore"):
        for poses, group, _, segment, undefined in legs:
            for constraint, places in zip(group.kind.constraints, group.rows, strict=True):
                put(joints, poses, places, [constraint.measure(segment)], undefined)
                if columns:
                    put(rows, poses, places, constraint.row(segment, 1.0), undefined)
    return joints[..., 0], rows


def put(
    array: NDArray[Any],
    poses: slice,
    places: Places,
    vector: Sequence[Any],
    undefined: Mask | None = None,
) -> None:
    """Write components (k, poses) to array[poses, places].

    Parameters
    ----------
    array : (n, n_places, m) array of numbers
        Filled in part.
    poses, places : slice; slice or (k,) int array
    vector : m arrays (k, poses), or numbers
    undefined : (k, poses) bool array or None
        Where NaN is written.
    """
    for component, value in enumerate(vector):
        if undefined is not None:
            value = np.where(undefined, np.nan, value)
        array[poses, places, component] = value.T if isinstance(value, np.ndarray) else value


def passive_places(legs: Sequence[Group]) -> tuple[list[tuple[int, int]], int]:
    """Return first row, rows per leg of each group in `passive_rates`; and how many there are."""
    counts = [sum(group.kind.turns) + group.kind.slides for group in legs]
    sizes = [count * group.count for count, group in zip(counts, legs, strict=True)]
    starts = np.cumsum([0, *sizes]).tolist()
    return list(zip(starts, counts, strict=False)), starts[-1]


def in_places(kind: Any, rates: Sequence[PassiveRate], columns: int) -> list[Vector]:
    """Return rows in order: turns seen from the base, from the platform, then slides.

    Turns that are zero for every posture, which the formulas leave out, come first of theirs.

    Parameters
    ----------
    kind : Leg or PlanarConstraint
    rates : sequence of PassiveRate
        Of a leg of that kind.
    columns : int
        Components of a twist.
    """
    rows: list[Vector] = []
    for body, count in zip(("base", "platform"), kind.turns, strict=True):
        turns = [rate.row for rate in rates if rate.kind == body]
        rows += [[0.0] * columns] * (count - len(turns)) + turns
    return rows + [rate.row for rate in rates if rate.kind == "slide"]
