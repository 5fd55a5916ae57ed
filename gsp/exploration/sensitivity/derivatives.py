"""`sensitivities`: derivatives of what a task wants, at one design."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, brief, expected
from gsp.exploration.optimisation.derivatives import (
    gradient,
    has_gradient,
    statistic,
    values_and_slopes,
)
from gsp.exploration.space import Space
from gsp.exploration.task import Task
from gsp.exploration.toml import record_of
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.model.design import Design
from gsp.model.dimensions import ANCHORS, Dimensions
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd


@arguments.validated(task=arguments.kind(Task, "a gsp.Task"))
def sensitivities(
    of: Space | Design, task: Task, parameters: Mapping[str, Any] | None = None
) -> pd.DataFrame:
    """Return how what a task wants changes with the parameters of a space, or with all dimensions.

    Derivatives are those of `gsp.exploration.gradient` and `gsp.indices.gradient`. All poses of the
    task count, also those that violate its limits; a worst value is that at the worst pose.

    Parameters
    ----------
    of : Space or Design
        A space: its ranges. A design: the coordinates of its anchor points, and the turns of its
        lines.
    task : Task
        Without proven worst values.
    parameters : mapping from name to value, or None
        All parameters of the space; None for a design.

    Returns
    -------
    pandas.DataFrame
        One row per wanted value and parameter: wanted, such as "control_number_mean"; parameter,
        such as "platform_radius" or "base_x1"; value, of what is wanted; derivative [unit of the
        value / unit of the parameter]; relative, the relative change of the value per relative
        change of the parameter [1], of a design per `design.rms_radius` or rad [1]. NaN where there
        is no derivative.

    Raises
    ------
    InvalidInput
        On arguments of a wrong type, a space without ranges, a proven worst value, or an index
        without a gradient.
    GspError
        Whatever the function of the space raises.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    >>> task = gsp.Task(poses=gsp.Pose([[0.1, 0.2, 1.5]]), wanted="mean CTN")
    >>> table = gsp.exploration.sensitivities(d, task)
    >>> len(table), table["parameter"][0]
    (36, 'base_x1')
    """
    if isinstance(of, Space):
        if parameters is None:
            raise InvalidInput(expected("parameters", "a value for each of the space", "none"))
        return _of_space(of, task, parameters)
    if not isinstance(of, Design):
        raise InvalidInput(expected("of", "a gsp.Space or a gsp.Design", brief(of)))
    if parameters is not None:
        raise InvalidInput(expected("parameters", "none, for a design", brief(parameters)))
    return _of_design(of, task)


def _of_space(space: Space, task: Task, parameters: Mapping[str, Any]) -> pd.DataFrame:
    found = gradient(space, task, parameters)
    scales = np.array([float(parameters[name]) for name in space.ranges])
    rows = {name: row.to_numpy(dtype=np.float64) for name, row in found.iterrows()}
    values = {str(name): (float(row[0]), row[1:]) for name, row in rows.items()}
    return _table(values, tuple(space.ranges), scales, task)


def _of_design(design: Design, task: Task) -> pd.DataFrame:
    for wish in task.wanted:
        proof = wish.of in ("proven worst", "volume")
        if proof or not has_gradient(INDICES[wish.index]):
            wanted = "means and worst values of indices with a gradient"
            raise InvalidInput(expected("task.wanted", wanted, wish.label))
    dimensions = Dimensions.of(design, ANCHORS)
    posture, directions = design.at(task.pose()), dimensions.directions(design)
    values = {
        wish.column: statistic(wish, *values_and_slopes(wish, task, posture, directions))
        for wish in task.wanted
    }
    return _table(values, dimensions.names, dimensions.sizes, task)


def _table(
    values: Mapping[str, tuple[float, Array]], names: tuple[str, ...], scales: Array, task: Task
) -> pd.DataFrame:
    """Return the table of values with their derivatives, for parameters of some scales."""
    import pandas as pd

    parts = []
    for wanted, (value, slopes) in values.items():
        with np.errstate(invalid="ignore", divide="ignore"):
            relative = slopes * scales / value
        one = {"wanted": wanted, "parameter": list(names), "value": value}
        parts.append(pd.DataFrame({**one, "derivative": slopes, "relative": relative}))
    table = pd.concat(parts, ignore_index=True)
    table.attrs.update(task=record_of(task), version=__version__)
    return table
