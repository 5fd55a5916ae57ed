"""The bounded quantities of a design: joints, cones, clearances, indices, positions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_type
from gsp.errors import InvalidInput, MissingParameter, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, dot, norm
from gsp.indices import INDICES
from gsp.limits.clearance import clearances, leg_pairs
from gsp.limits.kinds import (
    Quantity,
    clearance_quantities,
    cone_quantities,
    index_quantities,
    joint_quantities,
    position_quantities,
)
from gsp.limits.limits import Limits
from gsp.limits.quantities import (
    BoundedQuantities,
    Quantities,
    differentiated,
    joined,
    leg_joints,
    point_distances,
    positions,
)
from gsp.model.design import Design, check_undriven
from gsp.model.design.checks import check_bounds, check_strokes, open_strokes
from gsp.model.posture import Posture

if TYPE_CHECKING:
    from gsp.evaluation.settings import Settings

# From this number of poses on compiled code evaluates the indices that it covers; fewer take less
# time in numpy than the compiled code takes to load.
POSES_FOR_COMPILED = 4096
# Sine of the least angle between the axis of a cone and the line of a C joint.
LEAST_CONE_SINE = 1e-9


class _Bounded(NamedTuple):
    """Quantities of one kind of limit: m of them, bounds (m, 2), functions, sizes (m,) or one."""

    named: tuple[Quantity, ...]
    bounds: Array
    quantities: Quantities
    size: ArrayLike


def bounded_quantities(
    design: Design, limits: Limits | None = None, *, crossed: bool = False, driven: bool = False
) -> BoundedQuantities:
    """Return the limits of a design as quantities between bounds, joints first.

    Parameters
    ----------
    design : Design
    limits : Limits or None
        Default: the strokes of the design alone.
    crossed : bool
        Allow least = greatest (a locked actuator); otherwise it is an error, as the workspace has
        no interior.
    driven : bool
        Allow legs that are driven at the base, with limits other than cones and clearances.

    Returns
    -------
    BoundedQuantities

    Raises
    ------
    MissingParameter
        Without any limit, or where a cone has no axis or an index misses a parameter.
    InvalidInput
        On limits that cross or do not fit the design, or arguments of other types.
    """
    check_type("design", design, Design)
    if limits is not None:
        check_type("limits", limits, Limits, "a gsp.Limits or None")
    given = Limits() if limits is None else limits
    # Cones and clearances are those of the legs, not of carriages, cranks and their joints.
    of_legs = (given.base_cone, given.platform_cone, given.leg_radius)
    if not driven or any(limit is not None for limit in of_legs):
        check_undriven("design", design)
    bounds = _strokes(design, given)
    named, parts = joint_quantities(design), [_joints(design)]
    sizes = [np.where(design.angular, 1.0, design.rms_radius)]
    for add in (_cones, _clearance, _thresholds, _position):
        more = add(design, given)
        if more is not None:
            named += more.named
            bounds = np.concatenate((bounds, more.bounds))
            parts.append(more.quantities)
            sizes.append(np.broadcast_to(more.size, len(more.named)))
    if not np.isfinite(bounds).any():
        raise MissingParameter(
            f"limits of design {design.name!r}: expected strokes or other limits, received none"
        )
    result = BoundedQuantities(
        named,
        bounds[:, 0],
        bounds[:, 1],
        joined(parts, [len(size) for size in sizes], design.rms_radius),
        design.rms_radius,
        np.concatenate(sizes),
    )
    check_bounds(result.low, result.high, result.names, equal=crossed)
    return result


def _strokes(design: Design, limits: Limits) -> Array:
    chosen = design.strokes if limits.strokes is None else limits.strokes
    checked = check_strokes(chosen, design.signed, "limits.strokes")
    return open_strokes(checked, len(design.joint_names))


def _joints(design: Design) -> Quantities:
    if design.between_points:
        return point_distances(design.base_points, design.platform_points)
    return leg_joints(design.groups, len(design.joint_names))


def _of_posture(design: Design, measure: Callable[[Posture], Array]) -> Quantities:
    return differentiated(partial(_measured, design, measure), design.rms_radius)


def _measured(
    design: Design, measure: Callable[[Posture], Array], position: Array, rotation: Array
) -> Array:
    return measure(design.at(Pose(position, rotation)))


def _cones(design: Design, limits: Limits) -> _Bounded | None:
    sides = [
        (side, cone, cone_axes(design, side, axes))
        for side, cone, axes in (
            ("base", limits.base_cone, limits.base_axes),
            ("platform", limits.platform_cone, limits.platform_axes),
        )
        if cone is not None
    ]
    if not sides:
        return None
    n = design.n_legs
    named = tuple(one for side, _, _ in sides for one in cone_quantities(design, side))
    # NaN stands for no cone, as in strokes.
    most = [_per_leg(f"limits.{side}_cone", cone, n) for side, cone, _ in sides]
    greatest = np.concatenate(most)
    greatest = np.where(np.isnan(greatest), np.inf, greatest)
    bounds = np.stack((np.full(len(named), -np.inf), greatest), axis=1)
    measure = partial(_all_cone_angles, [(side, axes) for side, _, axes in sides])
    return _Bounded(named, bounds, _of_posture(design, measure), 1.0)


def _all_cone_angles(sides: Sequence[tuple[str, Array]], posture: Posture) -> Array:
    return np.concatenate([_cone_angles(posture, side, axes) for side, axes in sides], axis=-1)


def _per_leg(what: str, cone: ArrayLike, n: int) -> Array:
    angles = np.asarray(cone, dtype=np.float64)
    if angles.shape not in ((), (n,)):
        got = f"shape {angles.shape}"
        raise InvalidInput(expected(what, f"one angle, or {n}, one per leg", got))
    return np.broadcast_to(angles, (n,))


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


def cone_axes(design: Design, side: str, given: ArrayLike | None) -> Array:
    """Return the axes of the cones on "base" or "platform": given, or those of the home pose.

    A leg stays perpendicular to the line of a C joint. So the angle from the given axis, projected
    onto the plane across the line, is the turn about the line.

    Parameters
    ----------
    design : Design
    side : "base" or "platform"
    given : (n_legs, 3) array_like or None

    Returns
    -------
    (n_legs, 3) array
        In the axes of that side, of any length.

    Raises
    ------
    MissingParameter
        If none are given and the design has no home pose.
    InvalidInput
        On a wrong shape, or an axis along the line of a C joint.
    """
    if given is not None:
        what = f"limits.{side}_axes"
        return _across_lines(design, side, what, check_array(what, given, (design.n_legs, 3)))
    if design.home is None:
        raise MissingParameter(
            f"limits.{side}_cone: expected {side}_axes, or a design with a home pose, received none"
        )
    axes = _leg_directions(design.at(design.home), side)
    return check_array(f"{side} axes from the home pose", axes, (design.n_legs, 3))


def _across_lines(design: Design, side: str, what: str, axes: Array) -> Array:
    lines = np.array([getattr(leg, f"{side}_line") for leg in design.legs])
    directions = getattr(design, f"{side}_directions")[lines]
    along = dot(axes[lines], directions)
    across = axes[lines] - along[:, None] * directions
    bad = norm(across) < LEAST_CONE_SINE * norm(axes[lines])
    if bad.any():
        i = int(np.flatnonzero(lines)[bad][0])
        wanted = "an axis that is not along the line of the leg, about which it turns"
        raise InvalidInput(expected(f"{what}[{i}]", wanted, brief(axes[i].tolist())))
    result = axes.copy()
    result[lines] = across
    return result


def _clearance(design: Design, limits: Limits) -> _Bounded | None:
    pairs = leg_pairs(design)
    if limits.leg_radius is None or not pairs:
        return None
    bounds = np.tile((2.0 * limits.leg_radius, np.inf), (len(pairs), 1))
    quantities = _of_posture(design, partial(clearances, pairs=pairs))
    return _Bounded(clearance_quantities(design), bounds, quantities, design.rms_radius)


def _thresholds(design: Design, limits: Limits) -> _Bounded | None:
    if not limits.thresholds:
        return None
    # Here, as the other limits need no index, and loading the indices takes longer than they do.
    from gsp.evaluation.settings import Settings

    length = design.characteristic_length if limits.length is None else limits.length
    ellipsoid = design.ellipsoid if limits.ellipsoid is None else limits.ellipsoid
    settings = Settings(length, ellipsoid, limits.maximum)
    indices = [index for index, _, _ in limits.thresholds]
    for index in indices:
        for need in index.missing(design, settings.given()):
            raise MissingParameter(f"limits on {index.missing_message(need, design)}")

    names = tuple(index.name for index in indices)
    bounds = np.array([(low, high) for _, low, high in limits.thresholds])
    exact = _of_posture(design, partial(_index_values, names, settings))
    values = partial(_many_index_values, design, settings, names)
    near = np.where(np.isfinite(bounds), np.abs(bounds), 0.0).max(axis=1)
    size = np.where(near > 0.0, near, 1.0)
    quantities = replace(exact, values=values)
    return _Bounded(index_quantities(names), bounds, quantities, size)


def _index_values(names: Sequence[str], settings: Settings, posture: Posture) -> Array:
    indices = [INDICES[name] for name in names]
    values = [index.function(posture, **settings.for_index(index)) for index in indices]
    return np.stack(values, axis=-1)


def _many_index_values(
    design: Design, settings: Settings, names: tuple[str, ...], position: Array, rotation: Array
) -> Array:
    """Return values of indices at poses, by compiled code if they are many."""
    pose = Pose(position, rotation)
    if position.ndim != 2 or len(position) < POSES_FOR_COMPILED:
        return _index_values(names, settings, design.at(pose))
    from gsp.evaluation.backends import Block, with_compiled

    return with_compiled(Block(design, settings, names, False, pose, "compiled")).columns.T


def _position(design: Design, limits: Limits) -> _Bounded | None:
    if limits.position is None:
        return None
    bounds = np.asarray(limits.position, dtype=np.float64)
    return _Bounded(position_quantities(), bounds, positions(), design.rms_radius)
