"""Limits: what bounds a workspace, besides the geometry."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_positive
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.evaluation.backends import Block, with_compiled
from gsp.evaluation.settings import Settings
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, dot, norm
from gsp.indices import INDICES, Index, index_name
from gsp.limits.clearance import clearances, leg_pairs
from gsp.limits.quantities import (
    BoundedQuantities,
    Quantities,
    check_bounds,
    differentiated,
    joined,
    point_distances,
)
from gsp.model.design import Design
from gsp.model.posture import Posture

# Indices of so many poses at once are left to compiled code, where it covers them: fewer take less
# time in numpy than the code takes to load.
POSES_FOR_COMPILED = 4096
_THRESHOLD = re.compile(r"^\s*(.+?)\s*(>=|<=|≥|≤)\s*([-+0-9.eE]+)\s*$")


@dataclass(frozen=True, eq=False)
class Limits:
    """What bounds the poses of a design.

    Parameters
    ----------
    strokes : (n, 2) array_like or None [unit, rad]
        Least and greatest value per actuator, NaN for none; default the strokes of the design.
    base_cone, platform_cone : float, (n_legs,) array_like or None [rad]
        Greatest angle between a leg and the axis of its passive joint, on the base and on the
        platform: the half-angle of the cone of an S joint; for a C joint, whose leg stays
        perpendicular to the line, the greatest turn about the line to either side.
    base_axes, platform_axes : (n_legs, 3) array_like or None
        The axes of those cones, in base axes and in platform axes; default the directions that
        the legs have in the design's home pose.
    position : three pairs or None [unit]
        Intervals of x, y and z of the platform origin; None or NaN for no bound.
    leg_radius : float or None [unit]
        Radius of the legs, taken as capsules around the segments between their feet; two legs
        keep a distance of two radii. Legs that share an anchor point are not compared.
    indices : iterable of str
        Thresholds on indices by name or symbol: "λ >= 0.3", "CTN >= 0.1",
        "condition_number <= 20".
    length, ellipsoid, maximum : see `gsp.evaluate`
        What those indices need; default what the design records.

    Examples
    --------
    >>> Limits(indices=["λ >= 0.3"], maximum=1000.0).thresholds[0][1:]
    (0.3, inf)
    """

    strokes: ArrayLike | None = None
    base_cone: ArrayLike | None = None
    platform_cone: ArrayLike | None = None
    base_axes: ArrayLike | None = None
    platform_axes: ArrayLike | None = None
    position: Iterable[Any] | None = None
    leg_radius: float | None = None
    indices: Iterable[str] = ()
    length: float | None = None
    ellipsoid: Ellipsoid | None = None
    maximum: float | None = None
    thresholds: tuple[tuple[Index, float, float], ...] = field(init=False)

    def __post_init__(self) -> None:
        texts = (self.indices,) if isinstance(self.indices, str) else tuple(self.indices)
        object.__setattr__(self, "indices", texts)
        object.__setattr__(self, "thresholds", tuple(_threshold(text) for text in texts))
        if self.leg_radius is not None:
            check_positive("leg_radius", self.leg_radius)


def bounded_quantities(
    design: Design, limits: Limits | None = None, *, crossed: bool = False
) -> BoundedQuantities:
    """Return what bounds a design as quantities between bounds, joints first.

    Parameters
    ----------
    design : Design
    limits : Limits or None
        Default: the strokes of the design alone.
    crossed : bool
        Allow least = greatest (a locked actuator); otherwise it is refused, as no workspace with
        an interior is left.

    Raises
    ------
    MissingParameter
        Without any limit, or where a cone has no axis or an index lacks a parameter.
    InvalidInput
        On limits that cross.
    """
    given = Limits() if limits is None else limits
    bounds = _strokes(design, given)
    names, parts = list(design.joint_names), [_joints(design)]
    for add in (_cones, _clearance, _thresholds, _position):
        more = add(design, given)
        if more is not None:
            names += more[0]
            bounds = np.concatenate((bounds, more[1]))
            parts.append(more[2])
    if not np.isfinite(bounds).any():
        raise MissingParameter(
            f"limits of design {design.name!r}: expected strokes or other limits, received none"
        )
    if not crossed:
        check_bounds(bounds[:, 0], bounds[:, 1], tuple(names))
    elif (bounds[:, 0] > bounds[:, 1]).any():
        raise InvalidInput(expected("limits", "least ≤ greatest", bounds.tolist()))
    return BoundedQuantities(
        tuple(names),
        bounds[:, 0],
        bounds[:, 1],
        joined(parts),
        design.size,
        len(design.joint_names),
    )


def _strokes(design: Design, limits: Limits) -> Array:
    n = len(design.joint_names)
    chosen = design.strokes if limits.strokes is None else limits.strokes
    if chosen is None:
        return np.tile((-np.inf, np.inf), (n, 1))
    strokes = check_array("limits.strokes", chosen, (n, 2), finite=False)
    return np.where(np.isnan(strokes), (-np.inf, np.inf), strokes)


def _joints(design: Design) -> Quantities:
    if all(leg.name == "D1" for leg in design.legs):
        return point_distances(design.base_points, design.platform_points)

    def evaluate(position: Array, rotation: Array) -> tuple[Array, Array]:
        posture = design.at(Pose(position, rotation))
        return posture.joints, posture.jacobian

    def values(position: Array, rotation: Array) -> Array:
        return design.at(Pose(position, rotation)).joints

    return Quantities(values, evaluate)


def _of_posture(design: Design, measure: Callable[[Posture], Array]) -> Quantities:
    def values(position: Array, rotation: Array) -> Array:
        return measure(design.at(Pose(position, rotation)))

    return differentiated(values, design.size)


def _cones(design: Design, limits: Limits) -> tuple[list[str], Array, Quantities] | None:
    sides = [
        (side, cone, _axes(design, side, axes))
        for side, cone, axes in (
            ("base", limits.base_cone, limits.base_axes),
            ("platform", limits.platform_cone, limits.platform_axes),
        )
        if cone is not None
    ]
    if not sides:
        return None
    n = design.n_legs
    names = [f"{side} cone {i}" for side, _, _ in sides for i in range(1, n + 1)]
    most = [np.broadcast_to(check_array("cone", cone, ()), (n,)) for _, cone, _ in sides]
    bounds = np.stack((np.full(len(names), -np.inf), np.concatenate(most)), axis=1)
    if not (bounds[:, 1] > 0.0).all():
        raise InvalidInput(expected("cone", "angles > 0", bounds[:, 1].tolist()))

    def measure(posture: Posture) -> Array:
        return np.concatenate([_cone_angles(posture, s, a) for s, _, a in sides], axis=-1)

    return names, bounds, _of_posture(design, measure)


def _leg_directions(posture: Posture, side: str) -> Array:
    along = posture.segments.along
    if side == "platform":
        along = np.asarray(along @ posture.pose.rotation)
    return along


def _cone_angles(posture: Posture, side: str, axes: Array) -> Array:
    """Angles between legs and axes, accurate for small angles too: shape (..., n_legs)."""
    along = _leg_directions(posture, side)
    across = norm(cross(along, np.broadcast_to(axes, along.shape)))
    return np.arctan2(across, dot(along, axes))


def _axes(design: Design, side: str, given: ArrayLike | None) -> Array:
    if given is not None:
        return check_array(f"limits.{side}_axes", given, (design.n_legs, 3))
    if design.home is None:
        raise MissingParameter(
            f"limits.{side}_cone: expected {side}_axes, or a design with a home pose, received none"
        )
    axes = _leg_directions(design.at(design.home), side)
    return check_array(f"{side} axes from the home pose", axes, (design.n_legs, 3))


def _clearance(design: Design, limits: Limits) -> tuple[list[str], Array, Quantities] | None:
    pairs = leg_pairs(design)
    if limits.leg_radius is None or not pairs:
        return None
    names = [f"clearance {i + 1}-{j + 1}" for i, j in pairs]
    bounds = np.tile((2.0 * limits.leg_radius, np.inf), (len(pairs), 1))
    return names, bounds, _of_posture(design, lambda posture: clearances(posture, pairs))


def _thresholds(design: Design, limits: Limits) -> tuple[list[str], Array, Quantities] | None:
    if not limits.thresholds:
        return None
    length = design.characteristic_length if limits.length is None else limits.length
    ellipsoid = design.ellipsoid if limits.ellipsoid is None else limits.ellipsoid
    settings = Settings(length, ellipsoid, limits.maximum)
    indices = [index for index, _, _ in limits.thresholds]
    for index in indices:
        for need in index.missing(design, settings.given()):
            raise MissingParameter(f"limits on {index.missing_message(need, design)}")

    def measure(posture: Posture) -> Array:
        values = [index.function(posture, **settings.for_index(index)) for index in indices]
        return np.stack(values, axis=-1)

    names = [index.name for index in indices]
    bounds = np.array([(low, high) for _, low, high in limits.thresholds])
    exact = _of_posture(design, measure)

    def values(position: Array, rotation: Array) -> Array:
        if position.ndim != 2 or len(position) < POSES_FOR_COMPILED:
            return exact.values(position, rotation)
        pose = Pose(position, rotation)
        return with_compiled(
            Block(design, settings, tuple(names), False, pose, "compiled")
        ).columns.T

    return names, bounds, Quantities(values, exact.evaluate)


def _position(design: Design, limits: Limits) -> tuple[list[str], Array, Quantities] | None:
    if limits.position is None:
        return None
    pairs = [(None, None) if pair is None else tuple(pair) for pair in limits.position]
    numbers = [[np.nan if x is None else x for x in pair] for pair in pairs]
    given = check_array("limits.position", numbers, (3, 2), finite=False)
    bounds = np.where(np.isnan(given), (-np.inf, np.inf), given)
    rows = np.concatenate((np.eye(3), np.zeros((3, 3))), axis=1)

    def evaluate(position: Array, rotation: Array) -> tuple[Array, Array]:
        return position, np.broadcast_to(rows, (*position.shape[:-1], 3, 6))

    return ["x", "y", "z"], bounds, Quantities(lambda position, rotation: position, evaluate)


def _threshold(text: str) -> tuple[Index, float, float]:
    """Read "λ >= 0.3"."""
    match = _THRESHOLD.match(str(text))
    try:
        value = float(match[3]) if match else np.nan
    except ValueError:
        value = np.nan
    if match is None or np.isnan(value):
        raise InvalidInput(expected("limits.indices", 'texts such as "CTN >= 0.1"', repr(text)))
    name = index_name(match[1])
    least = match[2] in (">=", "≥")
    return INDICES[name], value if least else -np.inf, np.inf if least else value
