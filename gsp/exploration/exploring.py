"""`explore`: a sample of a space of designs, assessed for a task."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.checks import check_memory
from gsp.errors import GspError, InvalidInput, expected
from gsp.exploration.assessing import Run, assessed_table, checked, requested
from gsp.exploration.scores import ranks, score
from gsp.exploration.space import Space
from gsp.exploration.task import Task
from gsp.model.design import Design
from gsp.progress import Progress
from gsp.proof.extremes import ENDS_TOLERANCE

if TYPE_CHECKING:
    import pandas as pd

# The column with the reason why there is no design, where there is none.
ERROR = "error"
# Memory of a design [bytes].
DESIGN_BYTES = 3000


@arguments.validated(
    space=arguments.kind(Space, "a gsp.Space"),
    n=arguments.integer(1),
    seed=arguments.integer(0),
    method=arguments.text,
)
def explore(
    space: Space,
    task: Task,
    n: int,
    *,
    seed: int = 0,
    method: str = "halton",
    tolerance: float = ENDS_TOLERANCE,
    budget: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    out: str | PathLike[str] | None = None,
    parts: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress = None,
) -> pd.DataFrame:
    """Evaluate a sample of designs of a space for a task.

    Parameters
    ----------
    space : Space
    task : Task
    n : int
        Number of designs.
    seed : int
    method : "halton" or "sobol"
        See `Space.sample`.
    tolerance : float [1]
    budget : int or None
        See `gsp.exploration.assess`.
    workers, executor, out, parts, resume, progress : see `gsp.rank`

    Returns
    -------
    pandas.DataFrame
        One row per design, in the order of the sample: the parameters, then rank, score and the
        other columns of `gsp.exploration.assess`. Where the function of the space raises an error
        of the library for some parameters, the column "error" has its text, and the other columns
        are empty. `attrs` holds space, task, seed, method, version and the call.

    Raises
    ------
    UnknownIndex, MissingParameter, InvalidInput
        On arguments of a wrong type or value, unlike units, parameters that an index needs, or if
        there is no design for any of the parameters.
    MissingSoftware
        If `out` is given and pyarrow is not installed.
    UnwritableOutput
        If `out` exists and is not resumed, or cannot be written.

    Examples
    --------
    >>> import gsp
    >>> space = gsp.Space(
    ...     gsp.hexapod,
    ...     {"platform_radius": (0.5, 1.5), "platform_angle": (0.1, 1.0)},
    ...     fixed={"base_radius": 2.0, "base_angle": 0.3, "height": 1.5},
    ... )
    >>> box = gsp.PoseBox([(-0.1, 0.1), (-0.1, 0.1), 1.5], [0, 0, 0])
    >>> task = gsp.Task(poses=box, wanted="worst CTN", samples=20)
    >>> gsp.exploration.explore(space, task, 8, seed=1)["rank"].min()
    np.int64(1)
    """
    check_memory("n", n, DESIGN_BYTES, "designs")
    sample = space.sample(n, seed=seed, method=method)
    designs, errors = designs_of(space, sample)
    chosen, proofs = checked(designs, task, tolerance, budget)
    run = Run(workers=workers, executor=executor, out=out, parts=parts, resume=resume)
    request, asked = requested(chosen, task, run, progress)

    def finish(rows: Sequence[dict[str, Any]]) -> pd.DataFrame:
        return _joined(sample, errors, rows, task)

    call = f"gsp.exploration.explore(space, task, {n}, seed={seed}, method={method!r})"
    how = {"space": space.record(), "seed": seed, "method": method, "call": call}
    return assessed_table(request, chosen, task, asked, proofs, run, finish, how)


def designs_of(space: Space, sample: pd.DataFrame) -> tuple[list[Design], list[str]]:
    """Return the designs of the rows of a sample, and the error of each row, "" for none.

    Raises
    ------
    InvalidInput
        If no row has a design.
    """
    designs: list[Design] = []
    errors: list[str] = []
    # As Python's numbers, which a function may compare, write or use as an index.
    columns = {name: sample[name].tolist() for name in space.names}
    for i in range(len(sample)):
        try:
            made = space.design(**{name: values[i] for name, values in columns.items()})
        except GspError as error:
            errors.append(str(error))
        else:
            errors.append("")
            designs.append(made.replace(name=f"{made.name or 'design'} {i}"))
    if not designs:
        wanted = "a space with a design for some of the parameters"
        raise InvalidInput(expected("space", wanted, f"none; the first error: {errors[0]}"))
    return designs, errors


def _joined(
    sample: pd.DataFrame, errors: Sequence[str], rows: Sequence[dict[str, Any]], task: Task
) -> pd.DataFrame:
    """Return parameters and values side by side, one row per set of parameters."""
    import pandas as pd

    found = pd.DataFrame(rows)
    found.insert(0, "score", score(found, task))
    found.insert(0, "rank", ranks(found))
    there = np.flatnonzero([not error for error in errors])
    found.index = pd.Index(there)
    table = sample.join(found)
    if any(errors):
        table[ERROR] = errors
    return table
