"""evaluate(): one design over many poses."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Executor
from os import PathLike
from typing import TYPE_CHECKING, Literal

import numpy as np

from gsp.evaluation.backends import check_backend
from gsp.evaluation.blocks import BLOCK, Task, evaluated
from gsp.evaluation.found import facts, listed, with_maxima
from gsp.evaluation.parts import Parts, digest
from gsp.evaluation.settings import (
    Settings,
    check_indices,
    check_types,
    maxima,
    provenance,
    settings_of,
)
from gsp.evaluation.tables import divide_by_largest, pose_index
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.progress import Progress, meter

if TYPE_CHECKING:
    import pandas as pd


def evaluate(
    design: Design,
    pose: Pose,
    indices: Iterable[str] | None = None,
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | Literal["sample"] | None = None,
    backend: Literal["compiled", "numpy"] = "compiled",
    workers: int | None = None,
    executor: Executor | None = None,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress = None,
) -> pd.DataFrame:
    """Evaluate indices of one design over poses.

    Parameters
    ----------
    design : Design
    pose : Pose, batch shape (...)
    indices : names in `gsp.indices.INDICES`, default the routine ones whose needs are met
    length : float or None [unit of the design]
        Characteristic length; default the one that the design records, if any.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid; default the one that the design records, if any.
    maximum : float, "sample" or None
        |det J|max for λ; "sample" takes the largest value over the given poses. None finds it
        with `gsp.determinant.maximum` if λ is asked for by name, and `attrs["maxima"]` says how.
    backend : "compiled" or "numpy"
        The two agree to the rounding that the condition of a posture allows. The first use of the
        compiled one on a machine takes some seconds, as the code is made then.
    workers : int or None
        Threads; default all cores. The result does not depend on it, to the last bit.
    executor : concurrent.futures.Executor or None
        Does the work instead of threads: a process pool, `client.get_executor()` of a
        `dask.distributed` client, an MPI pool. Blocks that fail there are given out again.
    out : path or None
        A Parquet file. Finished blocks are stored beside it at once, in a folder, and become its
        row groups in the end, in the order of the poses.
    resume : bool
        Go on from the blocks that an interrupted run with the same arguments stored for `out`.
    progress : function (done, total), bool or None
        Called after each block of poses. By default a bar is drawn where standard error is a
        terminal, unless the work is short; False draws none.

    Returns
    -------
    pandas.DataFrame
        A row a pose (numbered in C order; by several levels for a batch of several axes), a
        column an index. `attrs` holds the parameters, and the count of undefined poses.

    Raises
    ------
    UnknownIndex, MissingParameter, InvalidInput
    UnwritableOutput
        If `out` exists and is not resumed, or cannot be written.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> gsp.evaluate(d, d.home, ["condition_number"]).round(3)
       condition_number
    0             3.063
    """
    check_types([design], pose, progress)
    settings = settings_of(design, length, ellipsoid, *maxima(maximum, [design]))
    indices = listed(indices)
    check_backend(backend)
    with meter(progress, "maxima") as tell:
        jobs = with_maxima([(design, settings)], indices, tell)
    names, settings = check_indices(indices, jobs), jobs[0][1]
    parts = None
    if out is not None:
        job = digest(jobs, pose, names, backend=backend, block=BLOCK, kind="evaluate")
        parts = Parts(out, job, resume=resume)
    with meter(progress, design.name or "poses") as tell:
        task = Task(jobs, pose, names, False, backend, workers, executor, tell)
        columns = _finished(parts, names) if parts and parts.finished else _computed(task, parts)
    return _frame(design, settings, pose, dict(zip(names, columns, strict=True)))


def _finished(parts: Parts, names: tuple[str, ...]) -> Array:
    return parts.result()[list(names)].to_numpy(dtype=np.float64).T.copy()


def _computed(task: Task, parts: Parts | None) -> Array:
    """Values of all poses, (n_names, n), of which stored parts are read and new ones stored."""
    import pandas as pd

    columns, cut = np.empty((len(task.names), task.pose.size)), task.cut
    stored: set[int] = set()
    if parts:
        stored.update(number for number in range(len(cut)) if parts.has(number))
        for number in stored:
            columns[:, cut[number]] = parts.read(number)[list(task.names)].to_numpy().T
    for _, number, values in evaluated(task, lambda job, number: number in stored):
        columns[:, cut[number]] = values.columns
        if parts:
            parts.write(number, pd.DataFrame(dict(zip(task.names, values.columns, strict=True))))
    if parts:
        parts.join(len(cut))
    return columns


def _frame(
    design: Design, settings: Settings, pose: Pose, columns: dict[str, Array]
) -> pd.DataFrame:
    import pandas as pd

    if settings.maximum == "sample" and "quality_index" in columns:
        divide_by_largest(columns["quality_index"])
    frame = pd.DataFrame(columns, index=pose_index(pose), copy=False)
    undefined = int(frame.isna().any(axis=1).sum())
    frame.attrs.update(
        provenance(settings), design=design.name, unit=design.unit, undefined=undefined,
        **facts([(design, settings)]),
    )  # fmt: skip
    return frame
