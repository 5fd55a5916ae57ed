"""`evaluate`: indices of one design at many poses."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Literal

import numpy as np

from gsp.evaluation.blocks import evaluated
from gsp.evaluation.maxima import facts, mended, with_maxima
from gsp.evaluation.parts import Output, Parts, digest
from gsp.evaluation.request import Request, check_resume, left_out, make_request
from gsp.evaluation.settings import divide_by_largest, provenance
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.model.design import Design
from gsp.progress import Progress, Report, meter

if TYPE_CHECKING:
    import pandas as pd


def evaluate(
    design: Design,
    pose: Pose,
    indices: Iterable[str] | str | None = None,
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
        At least one pose; an empty batch is an error.
    indices : str, iterable of str or None
        Names or symbols of indices ("control_number", "CTN"), or "all": those that are defined for
        the number of actuators; `attrs["left_out"]` names the others. Default the routine ones
        whose parameters are there.
    length : float or None [unit of the design]
        Characteristic length; default the one that the design records, if any. |det J| and λ do
        not depend on it.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid; default the one that the design records, if any.
    maximum : float, "sample" or None [unit of |det J|]
        |det J|max for λ; "sample" takes the largest value over the given poses (λ is NaN if that is
        0). None searches it with `gsp.determinant.maximum` if λ is requested by name;
        `attrs["maxima"]` records how.
    backend : "compiled" or "numpy"
        The two agree to the rounding that the condition of a posture allows. The first use of the
        compiled one on a machine takes some seconds, as the code is made then.
    workers : int or None
        Threads; default all cores. The bits of a value depend neither on it nor on the executor
        nor on the other poses of the batch.
    executor : concurrent.futures.Executor or None
        Is used instead of threads: a process pool, `client.get_executor()` of a
        `dask.distributed` client, an MPI pool. Blocks that fail there are submitted again.
    out : path or None
        A Parquet file for the table, with its index and `attrs`; the blocks are its row groups.
        Finished blocks are stored beside it at once, in a folder, until all are.
    resume : bool
        Continue from the blocks that an interrupted run with the same arguments stored for `out`,
        which it needs.
    progress : function (done, total), bool or None
        Called after each search for a maximum and after each block of poses. By default a bar is
        drawn where standard error is a terminal, unless the work is short; False draws none.

    Returns
    -------
    pandas.DataFrame
        One row per pose (numbered in C order; by several levels for a batch of several axes), one
        column per index: |det J| in the unit of the design to the power 3 − n_A1, λ without unit.
        `attrs` holds the parameters, in "units" the unit of each column, and in "undefined" the
        number of poses at which some index is NaN.

    Raises
    ------
    UnknownIndex, MissingParameter, InvalidInput
        On unknown names, parameters that an index needs, and arguments of a wrong type or value.
    MissingSoftware
        If `out` is given and pyarrow is not installed.
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
    check_resume(resume, out)
    request = make_request(
        [design],
        pose,
        indices,
        length=length,
        ellipsoid=ellipsoid,
        maximum=maximum,
        progress=progress,
        backend=backend,
        workers=workers,
        executor=executor,
        out=out,
        resume=resume,
    )
    with meter(progress, design.name or "poses") as report:
        request = with_maxima(request, report)
        output = _output(request)
        parts = None
        if output and not output.finished:
            job = f"{output.job} {request.block}"  # poses of a part
            parts = Parts(output.folder, job, ".parquet", resume=request.resume)
        with parts.removed() if parts else nullcontext():
            request, columns = _computed(request, report, output, parts)
            frame = _frame(request, columns)
            if output and parts:
                output.write(frame, request.block)
    return frame


def _computed(
    request: Request, report: Report, output: Output | None, parts: Parts | None
) -> tuple[Request, Array]:
    """Values of all poses, (n_names, n); stored blocks are read, and new ones stored.

    The returned request has a better maximum of |det J| if some λ was above 1.
    """
    names, cut = list(request.names), request.cut
    if output and output.finished:
        return request, np.asarray(output.result()[names].to_numpy(dtype=np.float64).T.copy())
    columns = np.empty((len(names), request.pose.size))
    stored = {number for number in range(len(cut)) if parts and parts.has(number)}
    for number in stored:
        if parts:
            columns[:, cut[number]] = parts.read(number)[names].to_numpy().T
    for _, number, values in evaluated(request, report, lambda job, number: number in stored):
        columns[:, cut[number]] = values.columns
        if parts:
            parts.write(number, _block_frame(names, values.columns))
    job = mended(request.jobs[0], request.pose, names, columns)
    if job is not request.jobs[0]:
        request = replace(request, jobs=[job])
        if parts:
            for number, block in enumerate(cut):
                parts.write(number, _block_frame(names, columns[:, block]))
    return request, columns


def _block_frame(names: Sequence[str], columns: Array) -> pd.DataFrame:
    import pandas as pd

    return pd.DataFrame(dict(zip(names, columns, strict=True)))


def _output(request: Request) -> Output | None:
    if request.out is None:
        return None
    job = digest(
        request.jobs, request.pose, request.names, backend=request.backend, kind="evaluate"
    )
    return Output(request.out, job, resume=request.resume)


def _frame(request: Request, values: Array) -> pd.DataFrame:
    import pandas as pd

    (design, settings), names = request.jobs[0], request.names
    columns = dict(zip(names, values, strict=True))
    if settings.maximum == "sample":
        divide_by_largest(columns)
    frame = pd.DataFrame(columns, index=_pose_index(request.pose), copy=False)
    frame.attrs.update(
        provenance(settings),
        design=design.name,
        unit=design.unit,
        units={name: INDICES[name].unit(design) for name in names},
        **left_out(request),
        undefined=int(np.isnan(values).any(axis=0).sum()),
        **facts(request.jobs, request.pose),
    )
    return frame


def _pose_index(pose: Pose) -> pd.Index:
    """0 … n − 1, or one level per axis for a batch of several axes."""
    import pandas as pd

    if len(pose.shape) < 2:
        return pd.RangeIndex(pose.size)
    levels = [range(n) for n in pose.shape]
    return pd.MultiIndex.from_product(levels, names=[f"pose_{i}" for i in range(len(levels))])
