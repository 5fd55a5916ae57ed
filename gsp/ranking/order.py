"""rank(): many designs over the same poses."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

from gsp.errors import InvalidInput, brief, expected
from gsp.evaluation.backends import check_backend
from gsp.evaluation.blocks import BLOCK, Job, Task, by_design
from gsp.evaluation.found import facts, listed, with_maxima
from gsp.evaluation.parts import Parts, digest
from gsp.evaluation.settings import (
    Maximum,
    Settings,
    check_index,
    check_indices,
    check_types,
    maxima,
    provenance,
    settings_of,
)
from gsp.evaluation.tables import divide_by_largest
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.model.design import Design
from gsp.progress import Progress, meter
from gsp.ranking.tables import ranked, summary

if TYPE_CHECKING:
    import pandas as pd


def rank(
    designs: Design | Iterable[Design],
    pose: Pose,
    indices: Iterable[str] | None = None,
    by: str | None = None,
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: Maximum = None,
    backend: Literal["compiled", "numpy"] = "compiled",
    workers: int | None = None,
    executor: Executor | None = None,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress = None,
) -> pd.DataFrame:
    """Rank designs by an index over the same poses.

    Parameters
    ----------
    designs : designs
    pose : Pose, batch shape (...)
    indices : names in `gsp.indices.INDICES`, default the routine ones whose needs are met
    by : str or None
        The index whose mean decides; its record says whether higher is better. Default the first
        of `indices`.
    length, ellipsoid : see `evaluate`
    maximum : float, sequence (one a design), mapping from design name, "sample" or None
        |det J|max for λ; "sample" takes for each design its largest value over the given poses.
        None finds them with `gsp.determinant.maximum` if λ is asked for by name, and
        `attrs["maxima"]` says how.
    backend, workers, executor, progress : see `evaluate`
    out, resume : see `evaluate`; what is stored is the row of each finished design.

    Returns
    -------
    pandas.DataFrame
        A row a design, best first: rank, design, mechanism, class, n_legs, then for each index its
        mean, min, 5 % quantile, median, 95 % quantile and max over the defined poses
        ("control_number_mean", …), then the shares of singular and of undefined poses. `attrs`
        holds the parameters; those that differ from design to design are None there.

    Raises
    ------
    UnknownIndex, MissingParameter, InvalidInput
    UnwritableOutput
        If `out` exists and is not resumed, or cannot be written.
    """
    import pandas as pd

    chosen = _check_designs(designs, pose, progress)
    jobs = [
        (design, settings_of(design, length, ellipsoid, most))
        for design, most in zip(chosen, maxima(maximum, chosen), strict=True)
    ]
    indices = listed(indices)
    check_backend(backend)
    if by is not None:
        check_index(by)
    with meter(progress, "maxima") as tell:
        jobs = with_maxima(jobs, indices, tell)
    names = check_indices(indices, jobs)
    by = names[0] if by is None else check_index(by)
    if by not in names:
        raise InvalidInput(expected("by", "one of the indices " + ", ".join(names), repr(by)))
    parts = None
    if out is not None:
        job = digest(jobs, pose, names, backend=backend, block=BLOCK, kind="rank", by=by)
        parts = Parts(out, job, resume=resume)
    with meter(progress, "designs") as tell:
        task = Task(jobs, pose, names, True, backend, workers, executor, tell)
        if parts and parts.finished:
            frame = parts.result()
        else:
            frame = ranked(pd.DataFrame(_rows(task, parts)), by)
    given = Settings(length, ellipsoid, maximum if isinstance(maximum, str) else None)
    shared = jobs[0][1] if len({settings for _, settings in jobs}) == 1 else given
    frame.attrs.update(provenance(shared), by=by, indices=list(names), poses=pose.size)
    frame.attrs.update(facts(jobs))
    if parts:
        parts.finish(frame)
    return frame


def _rows(task: Task, parts: Parts | None) -> list[dict[str, Any]]:
    """Row of each design, of which stored ones are read and new ones stored."""
    import pandas as pd

    rows: dict[int, dict[str, Any]] = {}
    for job in range(len(task.jobs)) if parts else ():
        if parts and parts.has(job):
            rows[job] = {str(k): v for k, v in parts.read(job).iloc[0].items()}
    known = frozenset(rows)
    for job, values, singular in by_design(task, lambda job, number: job in known):
        rows[job] = _row(task.jobs[job], dict(zip(task.names, values, strict=True)), singular)
        if parts:
            parts.write(job, pd.DataFrame([rows[job]]))
    return [rows[job] for job in range(len(task.jobs))]


def _row(job: Job, columns: dict[str, Any], singular: Any) -> dict[str, Any]:
    design, settings = job
    if settings.maximum == "sample" and "quality_index" in columns:
        divide_by_largest(columns["quality_index"])
    return summary(design, columns, singular)


def _check_designs(designs: Any, pose: Any, progress: Any) -> Sequence[Design]:
    if not isinstance(designs, Iterable | Design):
        raise InvalidInput(expected("designs", "designs", brief(designs)))
    chosen = [designs] if isinstance(designs, Design) else list(designs)
    check_types(chosen, pose, progress)
    return chosen
