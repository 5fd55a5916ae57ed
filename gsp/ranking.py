"""Where designs, poses and indices meet: evaluate() and rank()."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import islice
from typing import Any, Literal, NamedTuple

import numpy as np
import pandas as pd

from gsp.design import Design
from gsp.ellipsoid import Ellipsoid
from gsp.errors import (
    InvalidInput,
    MissingParameter,
    UnknownIndex,
    brief,
    check_type,
    expected,
)
from gsp.indices import INDICES, Index
from gsp.pose import Pose
from gsp.vectors import Array, Mask, check_integer, check_positive
from gsp.version import __version__

BLOCK = 2048
STATISTICS = ("mean", "min", "q05", "median", "q95", "max")

Maximum = float | Sequence[float] | Mapping[str, float] | Literal["sample"] | None
Progress = Callable[[int, int], object] | None


@dataclass(frozen=True)
class Settings:
    """What the indices are given: length, ellipsoid and maximum of |det J|."""

    length: float | None = None
    ellipsoid: Ellipsoid | None = None
    maximum: float | Literal["sample"] | None = None

    def given(self) -> tuple[str, ...]:
        """Return the names of the parameters that there are."""
        return tuple(name for name, value in vars(self).items() if value is not None)

    def for_index(self, index: Index) -> dict[str, Any]:
        """Return the arguments of an index; "sample" stands for 1 until all poses are known."""
        given = {name: getattr(self, name) for name in index.parameters}
        if given.get("maximum") == "sample":
            given["maximum"] = 1.0
        return given


def evaluate(
    design: Design,
    pose: Pose,
    indices: Iterable[str] | None = None,
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | Literal["sample"] | None = None,
    workers: int | None = None,
    progress: Progress = None,
) -> pd.DataFrame:
    """Evaluate indices of one design over poses.

    Parameters
    ----------
    design : Design
    pose : Pose, batch shape (...)
    indices : names in `gsp.indices.INDICES`, default all whose needs are met
    length : float or None [unit of the design]
        Characteristic length; default the one that the design records, if any.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid; default the one that the design records, if any.
    maximum : float, "sample" or None
        |det J|max for λ; "sample" takes the largest value over the given poses.
    workers : int or None
        Threads; default all cores. The result does not depend on it.
    progress : function (done, total) or None
        Called after each block of poses.

    Returns
    -------
    pandas.DataFrame
        A row a pose (numbered in C order; by several levels for a batch of several axes), a
        column an index. `attrs` holds the parameters, and the count of undefined poses.

    Raises
    ------
    UnknownIndex, MissingParameter, InvalidInput

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> gsp.evaluate(d, d.home, ["condition_number"]).round(3)
       condition_number
    0             3.063
    """
    _check_types([design], pose, progress)
    settings = _settings(design, length, ellipsoid, _one_maximum(maximum, design, 0))
    names = _check_indices(indices, [(design, settings)])
    ((values, _),) = _evaluated([(design, settings)], pose, names, workers, progress)
    frame = pd.DataFrame(values, index=_pose_index(pose))
    undefined = int(frame.isna().any(axis=1).sum())
    frame.attrs.update(
        _provenance(settings), design=design.name, unit=design.unit, undefined=undefined
    )
    return frame


def rank(
    designs: Design | Iterable[Design],
    pose: Pose,
    indices: Iterable[str] | None = None,
    by: str | None = None,
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: Maximum = None,
    workers: int | None = None,
    progress: Progress = None,
) -> pd.DataFrame:
    """Rank designs by an index over the same poses.

    Parameters
    ----------
    designs : designs
    pose : Pose, batch shape (...)
    indices : names in `gsp.indices.INDICES`, default all whose needs are met
    by : str or None
        The index whose mean decides; its record says whether higher is better. Default the first
        of `indices`.
    length, ellipsoid : see `evaluate`
    maximum : float, sequence (one a design), mapping from design name, "sample" or None
        |det J|max for λ; "sample" takes for each design its largest value over the given poses.
    workers, progress : see `evaluate`

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
    """
    if not isinstance(designs, Iterable | Design):
        raise InvalidInput(expected("designs", "designs", brief(designs)))
    chosen = [designs] if isinstance(designs, Design) else list(designs)
    _check_types(chosen, pose, progress)
    if isinstance(maximum, Sequence | np.ndarray) and not isinstance(maximum, str):
        if len(maximum) != len(chosen):
            wanted = f"one a design, {len(chosen)} in all"
            raise InvalidInput(expected("maximum", wanted, len(maximum)))
    jobs = [
        (d, _settings(d, length, ellipsoid, _one_maximum(maximum, d, i)))
        for i, d in enumerate(chosen)
    ]
    names = _check_indices(indices, jobs)
    by = names[0] if by is None else _check_index(by)
    if by not in names:
        raise InvalidInput(expected("by", "one of the indices " + ", ".join(names), repr(by)))
    results = _evaluated(jobs, pose, names, workers, progress)
    rows = [_summary(d, v, s) for (d, _), (v, s) in zip(jobs, results, strict=True)]
    frame = _ranked(pd.DataFrame(rows), by)
    given = Settings(length, ellipsoid, maximum if isinstance(maximum, str) else None)
    shared = jobs[0][1] if len({settings for _, settings in jobs}) == 1 else given
    frame.attrs.update(_provenance(shared), by=by, indices=list(names), poses=pose.size)
    return frame


def _ranked(frame: pd.DataFrame, by: str) -> pd.DataFrame:
    ascending = INDICES[by].better == "lower"
    order = frame[f"{by}_mean"].rank(method="min", ascending=ascending, na_option="bottom")
    frame.insert(0, "rank", order.astype(int))
    return frame.sort_values("rank", kind="stable", ignore_index=True)


def _summary(design: Design, values: dict[str, Array], singular: Mask) -> dict[str, Any]:
    row: dict[str, Any] = {
        "design": design.name,
        "mechanism": design.mechanism.name,
        "class": design.mechanism.group,
        "n_legs": design.n_legs,
    }
    undefined = np.zeros(singular.shape, dtype=bool)
    for name, column in values.items():
        undefined |= np.isnan(column)
        for statistic, value in zip(STATISTICS, _statistics(column), strict=True):
            row[f"{name}_{statistic}"] = value
    row["singular"] = float(singular.mean())
    row["undefined"] = float(undefined.mean())
    return row


def _statistics(column: Array) -> tuple[float, ...]:
    """Mean, min, 5 %, 50 %, 95 % quantiles (observed values, so that inf is allowed), max."""
    known = column[~np.isnan(column)]
    if not known.size:
        return (float("nan"),) * len(STATISTICS)
    low, middle, high = np.quantile(known, (0.05, 0.5, 0.95), method="nearest")
    return tuple(map(float, (known.mean(), known.min(), low, middle, high, known.max())))


def _evaluated(
    jobs: Sequence[tuple[Design, Settings]],
    pose: Pose,
    names: Sequence[str],
    workers: int | None,
    progress: Progress,
) -> Iterator[tuple[dict[str, Array], Mask]]:
    """Design by design: values per index over all poses, and which poses are singular.

    Only the designs whose blocks are in work are held, so that memory does not grow with them.
    """
    flat = pose.reshape(pose.size)
    parts = [slice(i, i + BLOCK) for i in range(0, flat.size, BLOCK)]

    def blocks() -> Iterator[_Block]:
        for design, settings in jobs:
            values = {name: np.empty(flat.size) for name in names}
            singular = np.empty(flat.size, dtype=bool)
            for part in parts:
                yield _Block(design, settings, part, part is parts[-1], values, singular)

    def run(block: _Block) -> _Block:
        posture = block.design.at(flat[block.part])
        for name, column in block.values.items():
            index = INDICES[name]
            column[block.part] = index.function(posture, **block.settings.for_index(index))
        block.singular[block.part] = posture.singular(block.settings.length)
        return block

    number = len(jobs) * len(parts)
    for done, block in enumerate(_in_threads(run, blocks(), number, workers), 1):
        if progress is not None:
            progress(done, number)
        if block.last:
            if block.settings.maximum == "sample" and "quality_index" in block.values:
                _divide_by_largest(block.values["quality_index"])
            yield block.values, block.singular


class _Block(NamedTuple):
    """Some poses of a design, and the columns (over all poses) that their values go to."""

    design: Design
    settings: Settings
    part: slice
    last: bool
    values: dict[str, Array]
    singular: Mask


def _divide_by_largest(column: Array) -> None:
    largest = np.fmax.reduce(column, initial=0.0)
    if largest > 0.0:
        column /= largest


def _in_threads(
    run: Callable[[_Block], _Block], blocks: Iterator[_Block], number: int, workers: int | None
) -> Iterator[_Block]:
    """Run blocks in threads, a few at a time, so that memory stays flat and Ctrl-C ends soon."""
    threads = min(
        number, check_integer("workers", os.cpu_count() or 1 if workers is None else workers)
    )
    if threads == 1:
        yield from map(run, blocks)
        return
    with ThreadPoolExecutor(threads) as pool:
        try:
            pending = deque(pool.submit(run, block) for block in islice(blocks, 2 * threads))
            while pending:
                yield pending.popleft().result()
                pending.extend(pool.submit(run, block) for block in islice(blocks, 1))
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _settings(
    design: Design, length: float | None, ellipsoid: Ellipsoid | None, maximum: Any
) -> Settings:
    chosen = design.characteristic_length if length is None else check_positive("length", length)
    if ellipsoid is not None:
        check_type("ellipsoid", ellipsoid, Ellipsoid)
    return Settings(chosen, design.ellipsoid if ellipsoid is None else ellipsoid, maximum)


def _one_maximum(maximum: Maximum, design: Design, number: int) -> Any:
    """Return the maximum that belongs to one of the designs."""
    if maximum is None or (isinstance(maximum, str) and maximum == "sample"):
        return maximum
    if isinstance(maximum, str | bytes):
        raise InvalidInput(expected("maximum", 'a number or "sample"', repr(maximum)))
    given: Any = maximum
    if isinstance(maximum, Mapping):
        given = maximum.get(design.name)
    elif isinstance(maximum, Sequence | np.ndarray):
        given = maximum[number] if number < len(maximum) else None
    if given is None:
        raise MissingParameter(f"maximum: expected one for design {design.name!r}, received none")
    return check_positive("maximum", given)


def _check_types(designs: Sequence[Any], pose: Any, progress: Any) -> None:
    if not designs:
        raise InvalidInput(expected("designs", "at least one design", "none"))
    for i, design in enumerate(designs):
        check_type("design" if len(designs) == 1 else f"designs[{i}]", design, Design)
    check_type("pose", pose, Pose)
    if not pose.size:
        raise InvalidInput(expected("pose", "at least one pose", "an empty batch"))
    if progress is not None and not callable(progress):
        raise InvalidInput(expected("progress", "a function (done, total)", brief(progress)))


def _check_index(name: str) -> str:
    if not isinstance(name, str) or name not in INDICES:
        raise UnknownIndex("index", str(name), INDICES)
    return name


def _check_indices(
    names: Iterable[str] | None, jobs: Sequence[tuple[Design, Settings]]
) -> tuple[str, ...]:
    if names is None:
        return tuple(
            name
            for name, index in INDICES.items()
            if not any(index.missing(d, s.given()) for d, s in jobs)
        )
    if not isinstance(names, Iterable):
        raise InvalidInput(expected("indices", "names of indices", brief(names)))
    chosen = (names,) if isinstance(names, str) else tuple(names)
    for name in chosen:
        index = INDICES[_check_index(name)]
        for design, settings in jobs:
            for need in index.missing(design, settings.given()):
                raise MissingParameter(
                    f"{name}: expected {need}=, received none (design {design.name!r})"
                )
    if not chosen:
        raise InvalidInput(expected("indices", "at least one name", "none"))
    return tuple(dict.fromkeys(chosen))


def _pose_index(pose: Pose) -> pd.Index:
    if len(pose.shape) < 2:
        return pd.RangeIndex(pose.size)
    levels = [range(n) for n in pose.shape]
    return pd.MultiIndex.from_product(levels, names=[f"pose_{i}" for i in range(len(levels))])


def _provenance(settings: Settings) -> dict[str, Any]:
    ellipsoid = settings.ellipsoid
    return {
        "library": f"gsp {__version__}",
        "length": settings.length,
        "ellipsoid": None if ellipsoid is None else {
            "semi_axes": ellipsoid.semi_axes.tolist(),
            "center": ellipsoid.center.tolist(),
            "rotation": ellipsoid.rotation.tolist(),
        },
        "maximum": settings.maximum,
    }  # fmt: skip
