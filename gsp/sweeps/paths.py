"""Paths: poses along translations and turns of one pose, and over planes.

A `Path` is a batch of poses with the coordinates that number them. A path starts from one pose and
does not depend on a design; `sweep` evaluates indices along it.

Turns are about a line in base axes: through the platform origin (which then
stays where it is), through the base origin, or through any point.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.arguments import LARGEST_NUMBER
from gsp.checks import check_array, check_memory, check_type, is_a, plain_text
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.frames import exp3
from gsp.geometry.pose import Pose
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.vectors import Array, cross, norm, unit

# Directions of a plane whose angle has a smaller sine count as parallel.
LEAST_SINE = 1e-9
PLATFORM_ORIGIN, BASE_ORIGIN = "platform origin", "base origin"
AXES = MappingProxyType({"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)})


@dataclass(frozen=True, eq=False)
class Path(ReadOnly):
    """Poses along a line, or over a plane, of motions.

    Attributes
    ----------
    coordinates : mapping from name to (...) array [unit of the design, degrees]
        The coordinates of the poses, such as "turn_deg" or "distance_x" and "distance_y".
    pose : Pose, batch shape (...)
    motion : str
        What moves, in words.
    labels : mapping from name to str
        The meaning of each coordinate, for the axes of figures, without the unit.
    start : Pose of batch shape (), or None
        The pose that is moved: where every coordinate is 0.
    """

    coordinates: Mapping[str, Array]
    pose: Pose
    motion: str
    labels: Mapping[str, str] = field(default_factory=dict)
    start: Pose | None = None


def translation(start: Pose, direction: ArrayLike, distances: ArrayLike) -> Path:
    """Return the poses at distances from a pose along a direction of the base.

    Parameters
    ----------
    start : Pose of batch shape ()
    direction : "x", "y", "z" or (3,) array_like [1]
        In base axes; normalised.
    distances : (n,) array_like [unit of the design]

    Returns
    -------
    Path
        With the coordinate "distance".

    Raises
    ------
    InvalidInput
        If `start` is not a single pose, a direction or the numbers have a wrong shape or value, or
        the poses do not fit into the memory.
    """
    direction = plain_text(direction)
    way, steps = _direction("direction", direction), check_steps("distances", distances)
    check_single(start)
    pose = Pose(start.position + steps[:, None] * way, start.rotation)
    name = _name(direction)
    labels = {"distance": f"displacement along {name}"}
    return Path({"distance": steps}, pose, f"translation along {name}", labels, start)


def plane(
    start: Pose,
    u: ArrayLike,
    v: ArrayLike,
    directions: tuple[ArrayLike, ArrayLike] = ("x", "y"),
) -> Path:
    """Return the poses at distances u × v from a pose along two directions of the base.

    Parameters
    ----------
    start : Pose of batch shape ()
    u, v : (n,) and (m,) array_like [unit of the design]
    directions : two of "x", "y", "z" or (3,) array_like [1]
        In base axes; normalised.

    Returns
    -------
    Path
        Batch shape (n, m). The coordinates are "distance_x", "distance_y" or "distance_z" along
        axes, and "distance_u" or "distance_v" along other directions.

    Raises
    ------
    InvalidInput
        If `start` is not a single pose, a direction or the numbers have a wrong shape or value, or
        the poses do not fit into the memory.
    """
    directions = arguments.sequence(2)("directions", directions)
    ways = [_direction(f"directions[{i}]", way) for i, way in enumerate(directions)]
    if not norm(cross(*ways)) > LEAST_SINE:
        raise InvalidInput(expected("directions", "two that are not parallel", brief(directions)))
    check_single(start)
    steps = check_steps("u", u), check_steps("v", v)
    check_memory("u, v", steps[0].size * steps[1].size, POSE_BYTES, "poses")
    first, second = np.meshgrid(*steps, indexing="ij")
    moved = first[..., None] * ways[0] + second[..., None] * ways[1]
    names = [_name(direction) for direction in directions]
    motion = f"translation over the plane of {names[0]} and {names[1]}"
    keys = [
        f"distance_{way if isinstance(way, str) else letter}"
        for way, letter in zip(directions, "uv", strict=True)
    ]
    labels = {key: f"displacement along {n}" for key, n in zip(keys, names, strict=True)}
    pose = Pose(start.position + moved, start.rotation)
    return Path(dict(zip(keys, (first, second), strict=True)), pose, motion, labels, start)


def turn(
    start: Pose, axis: ArrayLike, angles_deg: ArrayLike, through: ArrayLike = PLATFORM_ORIGIN
) -> Path:
    """Return the poses that result from rotations of a pose about a line.

    Parameters
    ----------
    start : Pose of batch shape ()
    axis : "x", "y", "z" or (3,) array_like [1]
        Direction of the line in base axes; normalised.
    angles_deg : (n,) array_like [degrees]
    through : "platform origin", "base origin" or (3,) array_like [unit of the design]
        A point of the line: the platform's origin (figures 6, 8 and 9 of `Lee2000`), the base
        origin (its figures 25–27 and 35–37), or any point in base axes.

    Returns
    -------
    Path
        With the coordinate "turn_deg".

    Raises
    ------
    InvalidInput
        If `start` is not a single pose, a direction or the numbers have a wrong shape or value, or
        the poses do not fit into the memory.

    Examples
    --------
    >>> quarter = turn(Pose([1.0, 0.0, 2.0]), "z", [90.0], through="base origin")
    >>> quarter.pose.position.round(9) + 0.0
    array([[0., 1., 2.]])
    """
    axis = plain_text(axis)
    line, steps = _direction("axis", axis), check_steps("angles_deg", angles_deg)
    if np.abs(steps).max() > LARGEST_NUMBER:
        raise InvalidInput(
            expected("angles_deg", f"at most {LARGEST_NUMBER:g} in size", brief(steps))
        )
    check_single(start)
    through = plain_text(through)
    if is_a(through, str):
        points = {PLATFORM_ORIGIN: start.position, BASE_ORIGIN: np.zeros(3)}
        if through not in points:
            wanted = ", ".join(map(repr, points)) + " or a point"
            raise InvalidInput(expected("through", wanted, brief(through)))
        point, place = points[through], f"the {through}"
    else:
        point = check_array("through", through, (3,))
        if point.ndim != 1:
            raise InvalidInput(expected("through", "one point", f"shape {point.shape}"))
        place = f"the point {_name(point)}"
    turned = exp3(np.deg2rad(steps)[:, None] * line)
    position = point + turned @ (start.position - point)
    motion = f"turn about {_name(axis)} through {place}"
    labels = {"turn_deg": f"rotation about {_name(axis)}"}
    return Path({"turn_deg": steps}, Pose(position, turned @ start.rotation), motion, labels, start)


def check_steps(what: str, values: ArrayLike) -> Array:
    """Return a list of numbers as an array (n,), n ≥ 1, or raise InvalidInput."""
    steps = np.atleast_1d(check_array(what, values, (), axes=1))
    if not steps.size:
        raise InvalidInput(expected(what, "a list of at least one number", "none"))
    check_memory(what, steps.size, POSE_BYTES, "poses")
    return steps


def check_single(start: Any) -> None:
    """Raise InvalidInput if `start` is not a single pose."""
    check_type("start", start, Pose)
    if start.shape:
        raise InvalidInput(expected("start", "a single pose", f"a batch of shape {start.shape}"))


def _direction(what: str, value: ArrayLike) -> Array:
    if is_a(value, str):
        if value not in AXES:
            raise InvalidInput(expected(what, '"x", "y", "z" or three numbers', brief(value)))
        return np.array(AXES[value])
    vector = check_array(what, value, (3,))
    if vector.ndim != 1 or not vector.any():
        raise InvalidInput(expected(what, "one direction that is not zero", vector.tolist()))
    # Its squares may overflow or vanish.
    return unit(vector / np.abs(vector).max())


def _name(direction: ArrayLike) -> str:
    if isinstance(direction, str):
        return direction
    return f"({', '.join(f'{x:g}' for x in np.asarray(direction, dtype=np.float64))})"
