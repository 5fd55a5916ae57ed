"""Derivatives of what a task wants by the parameters of a space."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, brief, expected
from gsp.exploration.space import Space
from gsp.exploration.task import Task, Wanted
from gsp.geometry.vectors import Array
from gsp.indices import INDICES, Index
from gsp.indices.gradients import index_slopes
from gsp.model.design import Design
from gsp.model.posture import Posture
from gsp.model.posture.slopes import Directions

if TYPE_CHECKING:
    import pandas as pd

# Step of the differences of dimensions, as a share of a range: its fourth power and the rounding of
# dimensions over it are both about 1e-12.
DIMENSION_STEP = 1e-3
# Places in steps, and weights of the values there: the derivative up to the fourth power.
CENTRAL_PLACES, CENTRAL_WEIGHTS = (-2, -1, 1, 2), np.array([1.0, -8.0, 8.0, -1.0]) / 12.0
# The same to one side, for ends of ranges, beyond which there may be no design.
SIDE_PLACES, SIDE_WEIGHTS = (0, 1, 2, 3, 4), np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0


class Motion(NamedTuple):
    """How a design changes with the parameters of a space, per unit of each.

    Attributes
    ----------
    directions : Directions
    strokes : (k, n, 2) array or None [unit, rad]
        Rates of the strokes.
    """

    directions: Directions
    strokes: Array | None


@arguments.validated(
    space=arguments.kind(Space, "a gsp.Space"), task=arguments.kind(Task, "a gsp.Task")
)
def gradient(space: Space, task: Task, parameters: Mapping[str, Any]) -> pd.DataFrame:
    """Return the derivatives of what a task wants by the ranges of a space, at one design.

    Derivatives of indices by anchors, lines and length are in closed form (see
    `gsp.indices.gradient`); those of the dimensions by the parameters are differences of fourth
    order of the function of the space, which evaluates no pose. All poses of the task count, also
    those that violate its limits. A worst value is that at the worst pose.

    Parameters
    ----------
    space : Space
        With at least one range.
    task : Task
        Without proven worst values.
    parameters : mapping from name to value
        All parameters of the space.

    Returns
    -------
    pandas.DataFrame
        One row per wanted value, such as "control_number_mean": "value", then one column per range
        with the derivative [unit of the value / unit of the parameter]; NaN where there is none.

    Raises
    ------
    InvalidInput
        On a space without ranges, a proven worst value, an index without a gradient, an ellipsoid
        that changes with a parameter, or legs that do.
    GspError
        Whatever the function of the space raises.

    Examples
    --------
    >>> import gsp
    >>> space = gsp.Space(
    ...     gsp.hexapod,
    ...     {"platform_radius": (0.5, 1.5)},
    ...     fixed={"base_radius": 2.0, "base_angle": 0.3, "platform_angle": 0.3, "height": 1.5},
    ... )
    >>> task = gsp.Task(poses=gsp.Pose([[0.1, 0.2, 1.5]]), wanted="mean CTN")
    >>> table = gsp.exploration.gradient(space, task, {"platform_radius": 1.0})
    >>> bool(table.loc["control_number_mean", "platform_radius"] > 0)
    True
    """
    import pandas as pd

    given = arguments.mapping("parameters", parameters)
    if not all(isinstance(name, str) for name in given):
        raise InvalidInput(expected("parameters", ", ".join(space.names), brief(list(given))))
    check_smooth(space, task)
    design = space.design(**given)
    motion = motion_of(space, given, design, task)
    posture = design.at(task.pose())
    rows = {}
    for wish in task.wanted:
        values, slopes = values_and_slopes(wish, task, posture, motion.directions)
        pair = statistic(wish, values, slopes)
        rows[wish.column] = [pair[0], *pair[1]]
    return pd.DataFrame.from_dict(rows, orient="index", columns=["value", *space.ranges])


def check_smooth(space: Space, task: Task) -> None:
    """Raise InvalidInput if derivatives of a task by a space are not defined."""
    reason = why_not_smooth(space, task)
    if reason:
        raise InvalidInput(reason)


def why_not_smooth(space: Space, task: Task) -> str:
    """Return why there are no derivatives, "" if there are."""
    if not space.ranges:
        return expected("space", "at least one range", "choices only")
    for wish in task.wanted:
        if wish.of in ("proven worst", "volume"):
            return expected("task.wanted", "means and worst values", wish.label)
        index = INDICES[wish.index]
        if not has_gradient(index):
            return expected("task.wanted", "indices with a gradient", index.symbol)
    return ""


def has_gradient(index: Index) -> bool:
    """Return whether statistics of an index have derivatives by dimensions."""
    return index.slope is not None or bool(index.share_of)


def motion_of(space: Space, parameters: Mapping[str, Any], design: Design, task: Task) -> Motion:
    """Return how a design changes with the ranges of a space.

    Raises
    ------
    InvalidInput
        If its legs change, or its ellipsoid does where an index takes that of the design.
    """
    anchors, lengths, strokes = [], [], []
    for name, (low, high) in space.ranges.items():
        steps, weights = _stencil(parameters[name], low, high)
        near = [space.design(**{**parameters, name: parameters[name] + step}) for step in steps]
        _check_alike([design, *near], task)
        anchors.append(np.tensordot(weights, [_anchors(one) for one in near], 1))
        own = [one.characteristic_length or 0.0 for one in near]
        lengths.append(0.0 if task.length is not None else float(weights @ own))
        if design.strokes is not None:
            strokes.append(np.tensordot(weights, [one.strokes for one in near], 1))
    directions = Directions(anchors=np.array(anchors), length=np.array(lengths))
    return Motion(directions, np.array(strokes) if strokes else None)


def _stencil(x: float, low: float, high: float) -> tuple[Array, Array]:
    """Return steps from x and weights of a difference that stays in a range which x is in."""
    step = DIMENSION_STEP * (high - low)
    if low <= x < low - CENTRAL_PLACES[0] * step:
        return step * np.array(SIDE_PLACES), SIDE_WEIGHTS / step
    if high - CENTRAL_PLACES[-1] * step < x <= high:
        return -step * np.array(SIDE_PLACES), -SIDE_WEIGHTS / step
    return step * np.array(CENTRAL_PLACES), CENTRAL_WEIGHTS / step


def _anchors(design: Design) -> Array:
    lines = (design.base_directions, design.platform_directions)
    parts = (design.base_points, design.platform_points, *map(np.nan_to_num, lines))
    return np.concatenate(parts, axis=1)


def _check_alike(designs: list[Design], task: Task) -> None:
    first = designs[0]
    if any(one.legs != first.legs for one in designs):
        raise InvalidInput(expected("space", "the same legs along its ranges", "others"))
    takes = any("ellipsoid" in INDICES[wish.index].parameters for wish in task.wanted)
    if task.ellipsoid is None and first.ellipsoid is not None and takes:
        scalars = [one.ellipsoid.scalars for one in designs if one.ellipsoid is not None]
        if len(scalars) < len(designs) or not all(np.array_equal(scalars[0], s) for s in scalars):
            wanted = "an ellipsoid of the task, or one that no range changes"
            raise InvalidInput(expected("task.ellipsoid", wanted, "none"))


def values_and_slopes(
    wish: Wanted, task: Task, posture: Posture, directions: Directions
) -> tuple[Array, Array]:
    """Return the values (n,) of a wanted index at poses, and derivatives (n, k)."""
    design, index = posture.design, INDICES[wish.index]
    own = {"length": design.characteristic_length, "ellipsoid": design.ellipsoid}
    given = {
        "length": own["length"] if task.length is None else task.length,
        "ellipsoid": own["ellipsoid"] if task.ellipsoid is None else task.ellipsoid,
        "maximum": None,
    }
    if index.of_determinant:
        given["length"] = None
    slopes = index_slopes(wish.index, posture, directions, given)
    options = {key: given[key] for key in index.parameters if given[key] is not None}
    return index.function(posture, **options), slopes


def statistic(wish: Wanted, values: Array, slopes: Array) -> tuple[float, Array]:
    """Return the mean or the worst value over the poses where it is defined, and its derivative."""
    known = ~np.isnan(values)
    if not known.any():
        return float("nan"), np.full(slopes.shape[-1], np.nan)
    if wish.of == "mean":
        return float(values[known].mean()), slopes[known].mean(axis=0)
    worst = np.nanargmin if INDICES[wish.index].better == "higher" else np.nanargmax
    place = int(worst(values))
    return float(values[place]), slopes[place]
