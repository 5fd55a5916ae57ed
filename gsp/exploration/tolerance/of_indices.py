"""`index_tolerance`: the distribution of what a task wants over manufactured copies of a design."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, expected
from gsp.exploration.assessing import Run, assessed, checked, requested
from gsp.exploration.optimisation.derivatives import has_gradient, statistic, values_and_slopes
from gsp.exploration.proving import proven
from gsp.exploration.task import Task, Wanted
from gsp.exploration.tolerance.deviations import (
    Deviations,
    error_values,
    standard_deviations,
)
from gsp.exploration.tolerance.shares import shares
from gsp.exploration.toml import record_of
from gsp.exploration.volumes import volumes
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.model.design import Design, check_undriven
from gsp.model.dimensions import ANCHORS, Dimensions
from gsp.progress import Progress
from gsp.proof.extremes import ENDS_TOLERANCE
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd

# The ends of the interval that holds 95 % of the copies.
LOW_SHARE, HIGH_SHARE = 0.025, 0.975


@dataclass(frozen=True, eq=False, kw_only=True)
class IndexTolerance(ReadOnly):
    """Result of `index_tolerance`.

    Attributes
    ----------
    table : pandas.DataFrame
        One row per wanted value, such as "control_number_mean": nominal; mean and standard
        deviation over the copies; first_order, the standard deviation to first order; low and high,
        between which 95 % of the copies are; least and greatest; undefined, the number of copies
        without a value. `attrs` has seed, task, version and call.
    shares : pandas.DataFrame
        One row per part of a leg: part, leg (from 1), and per wanted value the share of its
        variance to first order, the greatest of the first value on top.
    samples : pandas.DataFrame
        One row per copy: the errors of its dimensions, then the wanted values.
    """

    table: pd.DataFrame
    shares: pd.DataFrame
    samples: pd.DataFrame


@arguments.validated(
    design=check_undriven,
    task=arguments.kind(Task, "a gsp.Task"),
    deviations=arguments.kind(Deviations, "a gsp.exploration.Deviations"),
    samples=arguments.integer(2),
    seed=arguments.integer(0),
)
def index_tolerance(
    design: Design,
    task: Task,
    deviations: Deviations,
    *,
    samples: int = 1024,
    seed: int = 0,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> IndexTolerance:
    """Return how the errors of manufactured copies change what a task wants of indices.

    Every copy is evaluated at the poses of the task: quasi-Monte Carlo. To first order, the
    standard deviation follows from the gradient of each value. Zero points of joints change no
    index at a pose; see `pose_tolerance`.

    Parameters
    ----------
    design : Design
    task : Task
        Without limits and proven worst values.
    deviations : Deviations
        With an error of anchor points or lines.
    samples : int
        Number of copies; a power of two is best.
    seed : int
    workers, executor, progress : see `gsp.rank`

    Returns
    -------
    IndexTolerance
        The first order is NaN of indices that have no gradient, and of worst values at poses where
        there is none.

    Raises
    ------
    InvalidInput, MissingParameter
        On arguments of a wrong type or value, limits, proven worst values, sizes that do not fit
        the design or are all 0, or parameters that an index needs.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    >>> task = gsp.Task(poses=gsp.Pose([[0.0, 0.1, 1.5]]), wanted="mean CTN")
    >>> errors = gsp.exploration.Deviations(base_points=1e-3)
    >>> found = gsp.exploration.index_tolerance(d, task, errors, samples=64)
    >>> found.table.shape
    (1, 9)
    """
    import pandas as pd

    _check(task)
    dimensions = Dimensions.of(design, ANCHORS)
    spread = standard_deviations(deviations, dimensions)
    if not spread.any():
        raise InvalidInput(expected("deviations", "errors of anchor points or lines", "none"))
    values = error_values(deviations, dimensions, samples, seed)
    run = Run(workers, executor, None, None, False)
    rows = _rows([design, *(dimensions.at(one) for one in values)], task, run, progress)
    wanted = [wish.column for wish in task.wanted]
    nominal, *copies = ([float(row[column]) for column in wanted] for row in rows)
    found = pd.DataFrame(copies, columns=wanted)
    first = {wish.column: _first_order(wish, task, dimensions) * spread for wish in task.wanted}
    table = pd.DataFrame(
        [
            _row(value, found[name].to_numpy(), first[name])
            for name, value in zip(wanted, nominal, strict=True)
        ],
        index=wanted,
    )
    call = f"gsp.exploration.index_tolerance(design, task, deviations, {samples=}, {seed=})"
    table.attrs.update(call=call, seed=seed, task=record_of(task), version=__version__)
    errors = pd.DataFrame(values, columns=list(dimensions.names))
    squares = {name: slopes**2 for name, slopes in first.items()}
    return IndexTolerance(
        table=table, shares=shares(dimensions, squares), samples=errors.join(found)
    )


def _check(task: Task) -> None:
    if task.limits is not None:
        wanted = "none, as the same poses are to count for all copies"
        raise InvalidInput(expected("task.limits", wanted, "limits"))
    if proven(task):
        raise InvalidInput(expected("task.wanted", "means and worst values", "a proven worst"))
    if volumes(task):
        raise InvalidInput(expected("task.wanted", "means and worst values", "a volume"))


def _rows(designs: list[Design], task: Task, run: Run, progress: Progress) -> list[dict[str, Any]]:
    """Return the columns of designs, in their order."""
    chosen, proofs = checked(designs, task, ENDS_TOLERANCE, None)
    request, asked = requested(chosen, task, run, progress)
    return assessed(request, task, asked, proofs, None)[1]


def _first_order(wish: Wanted, task: Task, dimensions: Dimensions) -> Array:
    """Return the derivatives (p,) of a wanted value by the coordinates."""
    index = INDICES[wish.index]
    if not has_gradient(index):
        return np.full(len(dimensions), np.nan)
    design = dimensions.design
    directions = dimensions.directions(design)
    return statistic(wish, *values_and_slopes(wish, task, design.at(task.pose()), directions))[1]


def _row(nominal: float, values: Array, first: Array) -> dict[str, float | int]:
    known = values[~np.isnan(values)]
    some = known if known.size > 1 else np.full(2, np.nan)
    low, high = np.quantile(some, [LOW_SHARE, HIGH_SHARE])
    return {
        "nominal": nominal,
        "mean": float(some.mean()),
        "deviation": float(some.std(ddof=1)),
        "first_order": float(np.sqrt((first**2).sum())),
        "low": float(low),
        "high": float(high),
        "least": float(some.min()),
        "greatest": float(some.max()),
        "undefined": len(values) - len(known),
    }
