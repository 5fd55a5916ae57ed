"""The bounded quantities of a design: joints, cones, clearances, indices, positions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_type
from gsp.errors import MissingParameter
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.limits.kinds import (
    Quantity,
    clearance_quantities,
    cone_quantities,
    index_quantities,
    joint_quantities,
    position_quantities,
)
from gsp.limits.legs import all_cone_angles, clearances, cone_axes, greatest_angles, leg_pairs
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


class _Bounded(NamedTuple):
    """Quantities of one kind of limit: m of them, bounds (m, 2), functions, sizes (m,) or one."""

    named: tuple[Quantity, ...]
    bounds: Array
    quantities: Quantities
    size: ArrayLike


def bounded_quantities(
    design: Design,
    limits: Limits | None = None,
    *,
    crossed: bool = False,
    driven: bool = False,
    smooth: bool = False,
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
    smooth : bool
        Take thresholds on the greatest value of the actuators for thresholds on all these values.

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
    for add in (_cones, _clearance, partial(_thresholds, smooth=smooth), _position):
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
    most = [greatest_angles(f"limits.{side}_cone", cone, n) for side, cone, _ in sides]
    greatest = np.concatenate(most)
    bounds = np.stack((np.full(len(named), -np.inf), greatest), axis=1)
    measure = partial(all_cone_angles, [(side, axes) for side, _, axes in sides])
    return _Bounded(named, bounds, _of_posture(design, measure), 1.0)


def _clearance(design: Design, limits: Limits) -> _Bounded | None:
    pairs = leg_pairs(design)
    if limits.leg_radius is None or not pairs:
        return None
    bounds = np.tile((2.0 * limits.leg_radius, np.inf), (len(pairs), 1))
    quantities = _of_posture(design, partial(clearances, pairs=pairs))
    return _Bounded(clearance_quantities(design), bounds, quantities, design.rms_radius)


def _thresholds(design: Design, limits: Limits, *, smooth: bool) -> _Bounded | None:
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
    near = np.where(np.isfinite(bounds), np.abs(bounds), 0.0).max(axis=1)
    size = np.where(near > 0.0, near, 1.0)
    if smooth:
        split = [
            index.of_actuators is not None and low == -np.inf for index, low, _ in limits.thresholds
        ]
        counts = np.where(split, len(design.joint_names), 1)
        measure = partial(_smooth_values, names, split, settings)
        named = index_quantities(np.repeat(names, counts).tolist())
        each = (np.repeat(bounds, counts, axis=0), _of_posture(design, measure))
        return _Bounded(named, *each, np.repeat(size, counts))
    exact = _of_posture(design, partial(_index_values, names, settings))
    values = partial(_many_index_values, design, settings, names)
    quantities = replace(exact, values=values)
    return _Bounded(index_quantities(names), bounds, quantities, size)


def _index_values(names: Sequence[str], settings: Settings, posture: Posture) -> Array:
    indices = [INDICES[name] for name in names]
    values = [index.function(posture, **settings.for_index(index)) for index in indices]
    return np.stack(values, axis=-1)


def _smooth_values(
    names: Sequence[str], split: Sequence[bool], settings: Settings, posture: Posture
) -> Array:
    """Return values of indices, of some those of each actuator instead of the greatest one."""
    found = []
    for index, parts in zip((INDICES[name] for name in names), split, strict=True):
        of_actuators = index.of_actuators if parts else None
        values = (of_actuators or index.function)(posture, **settings.for_index(index))
        found.append(values[..., None] if of_actuators is None else values)
    return np.concatenate(found, axis=-1)


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
