"""`sobol_indices`: shares of the variance over a space that its parameters have, by SALib."""

from __future__ import annotations

from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.checks import check_memory
from gsp.errors import InvalidInput, expected
from gsp.exploration.assessing import Run, assessed, checked, requested
from gsp.exploration.exploring import DESIGN_BYTES, designs_of
from gsp.exploration.proving import proven
from gsp.exploration.space import Space
from gsp.exploration.task import Task
from gsp.exploration.toml import record_of
from gsp.exploration.volumes import volumes
from gsp.geometry.vectors import Array
from gsp.installed import optional
from gsp.progress import Progress
from gsp.proof.extremes import ENDS_TOLERANCE
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd

# Values whose range is at most this share of the greatest magnitude differ by rounding alone.
SAME_VALUE_SHARE = 1e-12


@arguments.validated(
    space=arguments.kind(Space, "a gsp.Space"),
    task=arguments.kind(Task, "a gsp.Task"),
    n=arguments.integer(2),
    seed=arguments.integer(0, 2**32 - 1),
    confidence=arguments.share,
    resamples=arguments.integer(2),
)
def sobol_indices(
    space: Space,
    task: Task,
    n: int = 256,
    *,
    seed: int = 0,
    confidence: float = 0.95,
    resamples: int = 100,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> pd.DataFrame:
    """Return the Sobol indices of what a task wants over the ranges of a space.

    The parameters are independent and uniform in their ranges. The first-order index is the share
    of the variance that a parameter has by itself, the total index that with all its interactions:
    what is left of the variance, in the mean, if all others are fixed. Sample and estimators
    are those of SALib.

    Parameters
    ----------
    space : Space
        Without choices, with a design for all parameters in the ranges.
    task : Task
        Without proven worst values.
    n : int
        A power of two; n (number of ranges + 2) designs are evaluated.
    seed : int
    confidence : float [1]
        In (0, 1): the level of the confidence intervals.
    resamples : int
        Number of bootstrap samples for these.
    workers, executor, progress : see `gsp.rank`

    Returns
    -------
    pandas.DataFrame
        One row per wanted value and parameter: wanted, parameter, first, first_confidence, total,
        total_confidence [1]; confidences are half widths. NaN where the value is the same for
        all designs: where its range is at most 1e-12 of its greatest magnitude, which is rounding.
        `attrs` has space, task, seed, n, designs, confidence, call and version.

    Raises
    ------
    InvalidInput
        On arguments of a wrong type or value, choices, a number n that is no power of two, proven
        worst values, and designs that are missing or have no value.
    MissingSoftware
        Without the extra `sensitivity`.

    Examples
    --------
    >>> import gsp
    >>> space = gsp.Space(
    ...     gsp.hexapod,
    ...     {"platform_radius": (0.8, 1.2), "height": (1.4, 1.6)},
    ...     fixed={"base_radius": 2.0, "base_angle": 0.3, "platform_angle": 0.4},
    ... )
    >>> task = gsp.Task(poses=gsp.Pose([[0.1, 0.0, 1.5]]), wanted="mean CTN")
    >>> table = gsp.exploration.sobol_indices(space, task, 64, seed=1)
    >>> table.set_index("parameter")["total"].idxmax()
    'platform_radius'
    """
    import pandas as pd

    with optional("SALib", "Sobol indices", "sensitivity"):
        from SALib.analyze import sobol as analysis
        from SALib.sample import sobol as sampling
    _check(space, task, n, confidence)
    check_memory("n", n, (len(space.ranges) + 2) * DESIGN_BYTES, "points")
    problem = {
        "num_vars": len(space.ranges),
        "names": list(space.ranges),
        "bounds": [list(pair) for pair in space.ranges.values()],
    }
    points = sampling.sample(problem, n, calc_second_order=False, seed=seed)
    found = _values(space, task, points, Run(workers, executor, None, None, False), progress)
    parts = []
    for wish, values in zip(task.wanted, found.T, strict=True):
        one: dict[str, Any] = {"wanted": wish.column, "parameter": list(space.ranges)}
        options = {"num_resamples": resamples, "conf_level": confidence, "seed": seed}
        columns = dict.fromkeys(("S1", "S1_conf", "ST", "ST_conf"), np.nan)
        if np.ptp(values) > SAME_VALUE_SHARE * np.abs(values).max():
            columns = analysis.analyze(problem, values, calc_second_order=False, **options)
        one |= {"first": columns["S1"], "first_confidence": columns["S1_conf"]}
        one |= {"total": columns["ST"], "total_confidence": columns["ST_conf"]}
        parts.append(pd.DataFrame(one))
    table = pd.concat(parts, ignore_index=True)
    call = f"gsp.exploration.sobol_indices(space, task, {n}, {seed=}, {confidence=}, {resamples=})"
    facts = {"n": n, "designs": len(points), "confidence": confidence, "seed": seed, "call": call}
    table.attrs.update(space=space.record(), task=record_of(task), version=__version__, **facts)
    return table


def _check(space: Space, task: Task, n: int, confidence: float) -> None:
    if space.choices:
        raise InvalidInput(expected("space", "ranges only", f"choices {', '.join(space.choices)}"))
    if proven(task):
        raise InvalidInput(expected("task.wanted", "means and worst values", "a proven worst"))
    if volumes(task):
        raise InvalidInput(expected("task.wanted", "means and worst values", "a volume"))
    if n & (n - 1):
        raise InvalidInput(expected("n", "a power of two", n))
    if not 0.0 < confidence < 1.0:
        raise InvalidInput(expected("confidence", "a number in (0, 1)", confidence))


def _values(space: Space, task: Task, points: Array, run: Run, progress: Progress) -> Array:
    """Return what is wanted of the designs at points, (number of points, number of values)."""
    import pandas as pd

    sample = pd.DataFrame(points, columns=list(space.ranges))
    designs, errors = designs_of(space, sample)
    wrong = [error for error in errors if error]
    if wrong:
        got = f"none for {len(wrong)} of {len(errors)}; the first error: {wrong[0]}"
        raise InvalidInput(expected("space", "a design for all parameters in the ranges", got))
    chosen, proofs = checked(designs, task, ENDS_TOLERANCE, None)
    request, asked = requested(chosen, task, run, progress)
    rows = assessed(request, task, asked, proofs, None)[1]
    found = np.array([[float(row[wish.column]) for wish in task.wanted] for row in rows])
    missing = int((~np.isfinite(found)).any(axis=1).sum())
    if missing:
        got = f"none for {missing} of {len(found)}"
        raise InvalidInput(expected("space", "finite values of all designs", got))
    return found
