"""`rank`: many designs at the same poses."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

from gsp.checks import check_items, is_a
from gsp.evaluation.blocks import DesignValues, by_design
from gsp.evaluation.maxima import mended, with_maxima
from gsp.evaluation.parts import Output, Parts, digest
from gsp.evaluation.request import Request, check_designs, check_resume, make_request
from gsp.evaluation.settings import Maximum, Settings, divide_by_largest
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Mask
from gsp.indices import index_name
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.progress import Progress, Report, meter
from gsp.ranking.comparison import attributes, check_by, check_units, distinct_names
from gsp.ranking.restrictions import FEASIBLE, WITHIN_STROKES, limits_record, restrictions
from gsp.ranking.tables import infinite_means, ranked, share, summary, with_drives

if TYPE_CHECKING:
    import pandas as pd


def rank(
    designs: Design | Iterable[Design],
    pose: Pose,
    indices: Iterable[str] | str | None = None,
    by: str | None = None,
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: Maximum = None,
    limits: Limits | None = None,
    backend: Literal["compiled", "numpy"] = "compiled",
    workers: int | None = None,
    executor: Executor | None = None,
    out: str | PathLike[str] | None = None,
    parts: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress = None,
) -> pd.DataFrame:
    """Return a table of designs, ranked by an index at the same poses.

    All designs are evaluated at the same positions and orientations of their platform frames, in
    one unit of length, also where they differ in size. `attrs` records the sizes, and the
    characteristic lengths if they differ.

    Parameters
    ----------
    designs : Design or iterable of Design
        With one unit of length. A design that names none is taken to be in that of the others, and
        is listed in `attrs["unitless"]`. Designs of the same name are distinguished in the table as
        "name", "name (2)" …; `attrs["renamed"]` maps such names to those of the designs.
    pose : Pose, batch shape (...)
        At least one pose; an empty batch is an error.
    indices : str, iterable of str or None
        See `evaluate`.
    by : str or None
        The index by whose mean the designs are ranked, by name or symbol; its record states
        whether higher is better. It needs one unit for all designs, which |det J| does not have if
        they differ in n_A1. Default the first of `indices`; without `indices` it is computed beside
        the default ones.
    length : float or None [unit of the designs]
        Characteristic length of all designs; default the one that each records.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid of all designs; default the one that each records.
    maximum : float, sequence (one per design), mapping from design name, "sample" or None
        |det J|max for λ; a pandas Series whose labels are texts is such a mapping. "sample" takes
        for each design its largest value over the given poses. None searches them with
        `gsp.determinant.maximum` if λ is requested by name;
        `attrs["maxima"]` records how.
    limits : Limits or None
        If given, statistics are taken over the poses that satisfy them; `gsp.Limits()` stands for
        the strokes of each design. By default no pose is left out.
    backend, workers, executor, progress : see `evaluate`
    out : path or None
        A Parquet file for the table, with its `attrs`. While the run lasts, the rows of finished
        designs are in the folder `out` + ".parts".
    parts : path or None
        Another folder for these rows, with or without `out`.
    resume : bool
        Continue from the rows that an interrupted run with the same arguments stored.

    Returns
    -------
    pandas.DataFrame
        One row per design, best first: rank, design, mechanism, class, n_legs; drives ("6 cranks"),
        if legs of a design are driven at the base; then for each index
        its mean, min, 5 % quantile, median, 95 % quantile and max over the defined poses
        ("control_number_mean", …; quantiles are observed values, the nearest ones, as an
        interpolation between a number and inf has no meaning); then the shares of singular and of
        undefined poses;
        "within_strokes", if a design has strokes: the share of poses at which its joints are within
        them, NaN for designs without; "feasible", if limits are given: the share of poses that
        satisfy them. `attrs` holds the parameters; those that differ between designs are None. A
        singular pose makes the mean of a condition number inf: `attrs["infinite_means"]` counts
        such designs by index, if there are some.

    Raises
    ------
    UnknownIndex, MissingParameter, InvalidInput
        On unknown names, parameters that an index needs, unlike units, and arguments of a wrong
        type or value.
    MissingSoftware
        If `out` is given and pyarrow is not installed.
    UnwritableOutput
        If `out` exists and is not resumed, or cannot be written.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> other = gsp.catalogue.instantiate(gsp.catalogue.mechanism("D1^6"), d)
    >>> table = gsp.rank([d, other], d.home, "CTN")
    >>> table[["rank", "design", "control_number_mean"]].round(3)
       rank               design  control_number_mean
    0     1                 D1^6                0.261
    1     2  toz-kucuk-2016-d3-6                0.170
    """
    import pandas as pd

    chosen = checked_designs(designs)
    check_resume(resume, out, parts)
    request, by, asked = prepared(
        chosen,
        pose,
        indices,
        by,
        length=length,
        ellipsoid=ellipsoid,
        maximum=maximum,
        limits=limits,
        progress=progress,
        backend=backend,
        workers=workers,
        executor=executor,
        out=out,
        resume=resume,
    )
    with meter(progress, "designs") as report:
        request = with_maxima(request, report)
        mark = fingerprint(request, by, limits) if out is not None or parts is not None else ""
        output = None if out is None else Output(out, mark, resume=resume)
        if output and output.finished:
            frame = output.result()
            frame.attrs.update(attributes(request, by, chosen, Settings(length, ellipsoid)))
            frame.attrs.update(infinite_means(frame, request.names))
            return frame
        beside = None if output is None else output.folder
        folder = beside if parts is None else parts
        kept = Parts(folder, mark, ".json", resume=resume) if folder is not None else None
        with kept.removed() if kept else nullcontext():
            request, rows = rows_of_designs(request, asked, kept, report)
            frame = ranked(pd.DataFrame(rows), by)
            frame.attrs.update(attributes(request, by, chosen, Settings(length, ellipsoid)))
            frame.attrs.update(infinite_means(frame, request.names))
            if output:
                output.write(frame)
    return frame


def prepared(
    designs: Sequence[Design],
    pose: Pose,
    indices: Iterable[str] | str | None,
    by: str | None,
    *,
    limits: Limits | None = None,
    by_kind: bool = False,
    backend: str = "compiled",
    workers: int | None = None,
    **how: Any,
) -> tuple[Request, str, tuple[str, ...]]:
    """Return the checked request of a ranking, the index that decides, and the columns of shares.

    The designs of the request have distinct names. Nothing is computed yet. `by_kind`: see
    `restrictions`.

    Raises
    ------
    As `rank`, but for its files.
    """
    check_units(designs)
    asked = restrictions(designs, limits, by_kind=by_kind)

    def asking(indices: Iterable[str] | str | None) -> Request:
        return make_request(
            designs,
            pose,
            indices,
            backend=backend,
            workers=workers,
            singular=True,
            checks=asked.checks,
            **{"executor": None, **how},
        )

    request = asking(indices)
    decides = request.names[0] if by is None else index_name(by)
    if indices is None and decides not in request.names:
        request = asking((*request.names, decides))
    check_by(decides, request.names, designs)
    jobs = [
        job if job.design.name == name else job._replace(design=job.design.replace(name=name))
        for job, name in zip(request.jobs, distinct_names(designs), strict=True)
    ]
    return replace(request, jobs=jobs), decides, asked.columns


def checked_designs(designs: Any) -> Sequence[Design]:
    """Return one design or several as a sequence, or raise InvalidInput."""
    single, wanted = is_a(designs, Design), "a gsp.Design or a sequence of them"
    chosen = (designs,) if single else check_items("designs", designs, wanted)
    check_designs(chosen)
    return chosen


def fingerprint(request: Request, by: str, limits: Limits | None) -> str:
    """Return a checksum of all data that a ranking depends on, by which its parts are known."""
    how = {"backend": request.backend, "kind": "rank", "by": by}
    return digest(request.jobs, request.pose, request.names, limits=limits_record(limits), **how)


def rows_of_designs(
    request: Request,
    asked: tuple[str, ...],
    parts: Parts | None,
    report: Report,
    beside: Callable[[Design, Mask | None], dict[str, Any]] | None = None,
) -> tuple[Request, list[dict[str, Any]]]:
    """Row of each design; stored ones are read, and new ones stored.

    `beside` gives more columns from a design and the mask of its feasible poses, None without
    limits. The returned request has better maxima where λ is above 1.
    """
    jobs, numbers = list(request.jobs), range(len(request.jobs))
    rows = {job: parts.read_row(job) for job in numbers if parts and parts.has(job)}
    for values in by_design(request, report, frozenset(rows)):
        jobs[values.job] = mended(jobs[values.job], request.pose, request.names, values.columns)
        row = row_of_design(request, asked, values)
        if beside:
            used = dict(zip(asked, values.checked, strict=True)).get(FEASIBLE)
            row |= beside(jobs[values.job].design, used)
        rows[values.job] = row
        if parts:
            parts.write_row(values.job, rows[values.job])
    designs = [job.design for job in jobs]
    return replace(request, jobs=jobs), with_drives([rows[job] for job in numbers], designs)


def row_of_design(request: Request, asked: tuple[str, ...], values: DesignValues) -> dict[str, Any]:
    """Return the row of a ranking for the values of one design."""
    design, settings = request.jobs[values.job]
    flags = dict(zip(asked, values.checked, strict=True))
    used = flags.get(FEASIBLE)
    arrays = values.columns if used is None else values.columns[:, used]
    if settings.maximum == "sample":
        divide_by_largest(dict(zip(request.names, arrays, strict=True)))
    singular = values.singular if used is None else values.singular[used]
    row = summary(design, request.names, arrays, singular)
    for name, flag in flags.items():
        missing = name == WITHIN_STROKES and design.strokes is None
        row[name] = float("nan") if missing else share(flag)
    return row
