"""`assess`: many designs for one task, in one table."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from functools import partial
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.checks import check_integer, check_positive, check_type
from gsp.errors import InvalidInput, expected
from gsp.evaluation.maxima import with_maxima
from gsp.evaluation.parts import Output, Parts, digest
from gsp.evaluation.request import Request, check_resume
from gsp.evaluation.settings import Settings
from gsp.exploration.demands import demands
from gsp.exploration.proving import Proofs, proof_rows, proven, recorded
from gsp.exploration.scores import scored
from gsp.exploration.task import Task
from gsp.exploration.toml import record_of
from gsp.exploration.volumes import check_bounded, volumes
from gsp.geometry.pose import Pose
from gsp.model.design import Design
from gsp.progress import Progress, meter
from gsp.proof.extremes import BOXES_PER_SEARCH, ENDS_TOLERANCE
from gsp.ranking.comparison import attributes, check_by, check_units
from gsp.ranking.order import checked_designs, prepared, rows_of_designs
from gsp.ranking.tables import infinite_means
from gsp.statics import gravity_wrench
from gsp.workspace.sets.questions import CELL_BUDGET

if TYPE_CHECKING:
    import pandas as pd

# What is evaluated where only volumes are wanted: it needs no parameter and has one unit.
NO_INDEX = ("condition_number_points",)


class Run(NamedTuple):
    """Where and how rows are computed and stored: see `gsp.rank`."""

    workers: int | None
    executor: Executor | None
    out: str | PathLike[str] | None
    parts: str | PathLike[str] | None
    resume: bool


def assess(
    designs: Design | Iterable[Design],
    task: Task,
    *,
    tolerance: float = ENDS_TOLERANCE,
    budget: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    out: str | PathLike[str] | None = None,
    parts: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress = None,
) -> pd.DataFrame:
    """Evaluate designs for a task, best first.

    The score of a design is the weighted geometric mean of what is wanted, each over the best in
    the table: Π (v / v_best)^(w / Σ w), with v_best / v for indices that are better if lower. It
    does not depend on units, and the order of two designs does not depend on the others. 1 is a
    design that is best in all, 0 one with a worst possible value.

    Parameters
    ----------
    designs : Design or iterable of Design
        With one unit of length, that of the task if it names one.
    task : Task
    tolerance : float [1]
        Relative gap at which the search for a proven worst value ends: see `gsp.bounds`.
    budget : int or None
        Most boxes of such a search, default 100 000; most cells of a search for a volume, default
        6 000 000.
    workers, executor, out, parts, resume, progress : see `gsp.rank`

    Returns
    -------
    pandas.DataFrame
        One row per design: rank, score, and the columns of `gsp.rank` for the indices of the task.
        For each proven worst value of an index: "…_proven", a bound that no pose of the box
        violates; "…_found", the worst value that occurs at a pose of the search; "…_closed",
        whether they differ by no more than the tolerance. For each volume "…_volume_low" and
        "…_volume_high", between which it is proven to be [unit³], and "…_volume_resolution", the
        longest side of the cells that are undecided [unit]; the least volume decides. Where
        nothing else is wanted, the table has CDN_3P as well. A design that has no pose within
        the limits has `feasible` = 0, and score and rank NaN, as every design of which a wanted
        value is undefined; it comes last. "violated_joint", "violated_cone" … are the
        shares of all poses that violate a limit of the kind. With loads "actuator_force" [N] and
        "actuator_torque" [N · unit] are the greatest at the poses within the limits, inf if one is
        singular. `attrs` holds the task as well.

    Raises
    ------
    UnknownIndex, MissingParameter, InvalidInput
        On arguments of a wrong type or value, unlike units, limits that do not fit a design, and
        parameters that an index needs.
    MissingSoftware
        If `out` is given and pyarrow is not installed.
    UnwritableOutput
        If `out` exists and is not resumed, or cannot be written.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> box = gsp.PoseBox.around(d.home, [10, 10, 10, 0.1, 0.1, 0.1])
    >>> task = gsp.Task(poses=box, wanted=["mean CTN", "worst CDN_CL"], samples=100)
    >>> others = gsp.catalogue.placements(gsp.catalogue.mechanism("D1^3 D2^3"), d)
    >>> gsp.exploration.assess([d, *others], task)["design"][0]
    'D1-D2-D1-D2-D1-D2'
    """
    chosen, proofs = checked(designs, task, tolerance, budget)
    run = Run(workers=workers, executor=executor, out=out, parts=parts, resume=resume)
    request, asked = requested(chosen, task, run, progress)
    return assessed_table(request, chosen, task, asked, proofs, run, lambda r: scored(r, task), {})


def assessed_table(
    request: Request,
    designs: Sequence[Design],
    task: Task,
    asked: tuple[str, ...],
    proofs: Proofs,
    run: Run,
    finish: Callable[[Sequence[dict[str, Any]]], pd.DataFrame],
    facts: dict[str, Any],
) -> pd.DataFrame:
    """Return the table of designs, stored while it is computed if a place is given.

    Parameters
    ----------
    request, designs, task, asked, proofs, run :
        As `checked` and `requested` return them.
    finish : function (rows of the designs) -> table
    facts : dict
        What the table records as well; tables of other facts are not resumed.
    """
    out, parts = run.out, run.parts
    mark = fingerprint(request, task, proofs, facts) if out is not None or parts is not None else ""
    output = None if out is None else Output(out, mark, resume=run.resume)
    if output and output.finished:
        return output.result()
    beside = None if output is None else output.folder
    folder = beside if parts is None else parts
    kept = None if folder is None else Parts(folder, mark, ".json", resume=run.resume)
    with kept.removed() if kept else nullcontext():
        request, rows = assessed(request, task, asked, proofs, kept)
        frame = finish(rows)
        frame.attrs.update(
            attributes(request, "score", designs, Settings(task.length, task.ellipsoid)),
            task=record_of(task),
            **facts,
            **recorded(task, proofs),
            **infinite_means(frame, request.names),
        )
        if output:
            output.write(frame)
    return frame


def checked(
    designs: Any, task: Any, tolerance: Any, budget: Any
) -> tuple[Sequence[Design], Proofs]:
    """Return the designs, and how worst values are proven, if the arguments fit each other.

    Raises
    ------
    InvalidInput
    """
    check_type("task", task, Task)
    chosen = checked_designs(designs)
    unit = check_units(chosen)
    if unit and task.unit not in ("", unit):
        wanted = (
            f"the unit of the task, {task.unit!r} (convert them: gsp rank --unit {task.unit}, "
            f"gsp.ranking.in_unit(design, {task.unit!r}) in Python)"
        )
        raise InvalidInput(expected("designs", wanted, repr(unit)))
    most = None if budget is None else check_integer("budget", budget)
    found = check_positive("tolerance", tolerance), most or BOXES_PER_SEARCH, most or CELL_BUDGET
    return chosen, Proofs(*found)


def requested(
    designs: Sequence[Design], task: Task, run: Run, report: Progress
) -> tuple[Request, tuple[str, ...]]:
    """Return the checked request of a task, and the columns of shares; nothing is computed yet.

    Raises
    ------
    InvalidInput, UnknownIndex, MissingParameter
    """
    check_resume(run.resume, run.out, run.parts)
    request, _, asked = prepared(
        designs,
        task.pose(),
        list(task.indices or NO_INDEX),
        None,
        limits=task.limits,
        by_kind=True,
        length=task.length,
        ellipsoid=task.ellipsoid,
        maximum=None,
        progress=report,
        workers=run.workers,
        executor=run.executor,
        out=run.out,
        resume=run.resume,
    )
    for name in task.indices:
        check_by(name, request.names, designs)
    if volumes(task):
        for design in designs:
            check_bounded(design, task)
    if task.payload is not None:
        for design in designs:
            gravity_wrench(design, Pose(np.zeros(3)), task.payload)
    return request, asked


def fingerprint(request: Request, task: Task, proofs: Proofs, facts: dict[str, Any]) -> str:
    """Return a checksum of all data that the rows of a task depend on."""
    how = {"kind": "assess", "proofs": list(proofs), "facts": facts}
    return digest(request.jobs, request.pose, request.names, task=record_of(task), **how)


def assessed(
    request: Request, task: Task, asked: tuple[str, ...], proofs: Proofs, parts: Parts | None
) -> tuple[Request, list[dict[str, Any]]]:
    """Return the request and the row of each design; stored rows are read, and new ones stored.

    The parts are numbered by designs, first their statistics, then one series per proof.
    """
    with meter(request.progress, "designs") as report:
        request = with_maxima(request, report)
        beside = partial(demands, pose=request.pose, task=task)
        request, rows = rows_of_designs(request, asked, parts, report, beside)
    wanted = [*proven(task), *volumes(task)]
    if wanted:
        with meter(request.progress, "proofs") as report:
            for done, (number, row) in enumerate(
                proof_rows(request, task, wanted, proofs, parts), 1
            ):
                rows[number] |= row
                report(done, len(wanted) * len(rows))
    return request, rows
