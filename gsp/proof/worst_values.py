"""`gsp.proof.worst`: the worst value of an index over a box of poses, for many designs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any, NamedTuple

from gsp.checks import check_integer, check_items, check_positive, is_a
from gsp.errors import InvalidInput, expected
from gsp.evaluation.scheduling import run_all
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import PoseBox
from gsp.indices import INDICES
from gsp.model.design import Design, check_undriven
from gsp.progress import Progress, meter
from gsp.proof.boxes import check_box
from gsp.proof.extremes import BOXES_PER_SEARCH, ENDS_TOLERANCE, End, bounded_name, one_end

if TYPE_CHECKING:
    import pandas as pd


class _Task(NamedTuple):
    """The arguments of `one_end`, with the number of the design."""

    number: int
    design: Design
    box: PoseBox
    name: str
    side: int
    share: float
    budget: int
    given: dict[str, Any]


class WorstValue(NamedTuple):
    """Proven bounds of the worst value of an index over a box: see `worst`."""

    low: float
    high: float
    closed: bool
    n_boxes: int


def _run(task: _Task) -> End:
    _, design, box, name, side, share, budget, given = task
    return one_end(design, box, name, side, share, budget, **given)


def worst(
    designs: Design | Sequence[Design],
    box: PoseBox,
    index: str,
    tolerance: float = ENDS_TOLERANCE,
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | None = None,
    budget: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> pd.DataFrame:
    """Return proven bounds of the worst value of an index over a box, one row per design.

    It is the least value over all poses of the box, or the greatest of an index that is better if
    lower. As an objective of design both ends are deterministic: maximise `low` of an index that is
    better if higher, or minimise `high`, and what is found is guaranteed.

    Parameters
    ----------
    designs : Design or sequence of Design
    box : PoseBox
    index : str
        Name or symbol of CDN_CL, σ_min, |det J|, λ, CDN_OE or CTN.
    tolerance : float [1]
        Relative gap at which the search of a design ends: see `gsp.bounds`.
    length : float or None [unit of the designs]
        Characteristic length; default that of each design.
    ellipsoid : Ellipsoid or None
        For CDN_OE; default that of each design.
    maximum : float or None [unit of |det J|]
        For λ; default `gsp.determinant.reference(design).value`.
    budget : int or None
        Most boxes per design, default 100 000.
    workers : int or None
        Threads, default one per core; the result does not depend on it.
    executor : concurrent.futures.Executor or None
        Computes the designs instead of threads; it is not shut down.
    progress : function (done, total), bool or None
        Called with the number of designs that are done: see `gsp.evaluate`.

    Returns
    -------
    pandas.DataFrame, shape (number of designs, 5)
        Columns `design` (the name), `low` and `high` [of the index]: the worst value is between
        them, and one of them is a value that occurs, or NaN if the search found no pose with a
        defined value; `closed`, whether they are within the tolerance; `n_boxes`. `attrs` contains
        the index and the box.

    Raises
    ------
    InvalidInput
        On a wrong type, an empty list of designs, or a box that `gsp.bounds` does not take.
    UnknownIndex
        For an index that has no bounds over boxes.
    MissingParameter
        If the index needs a length or an ellipsoid and there is none.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> box = gsp.PoseBox.around(d.home, [5, 5, 5, 0, 0, 0])
    >>> table = gsp.proof.worst([d, d.exchanged()], box, "σ_min", length=95.0, budget=1000)
    >>> bool((table["low"] <= table["high"]).all())
    True

    *Source: ours; see `docs/proofs.md`.*
    """
    import pandas as pd

    wanted, single = "a design or a sequence of them", is_a(designs, Design)
    given = (designs,) if single else check_items("designs", designs, wanted)
    if not given:
        raise InvalidInput(expected("designs", wanted, "none"))
    for i, design in enumerate(given):
        check_undriven(f"designs[{i}]", design)
    check_box(box)
    name, share = bounded_name(index), check_positive("tolerance", tolerance)
    most = BOXES_PER_SEARCH if budget is None else check_integer("budget", budget)
    options = {"length": length, "ellipsoid": ellipsoid, "maximum": maximum}
    found = worst_of_each(
        dict(enumerate(given)), box, name, share, most, options, workers, executor
    )
    rows: list[tuple[Any, ...]] = [()] * len(given)
    with meter(progress, "worst") as report:
        for done, (number, value) in enumerate(found, 1):
            rows[number] = (given[number].name, *value)
            report(done, len(given))
    table = pd.DataFrame(rows, columns=["design", *WorstValue._fields])
    ends = {"low": box.low.tolist(), "high": box.high.tolist(), "order": box.order}
    table.attrs.update(index=name, box=ends)
    return table


def worst_of_each(
    designs: Mapping[int, Design],
    box: PoseBox,
    name: str,
    share: float,
    budget: int,
    options: dict[str, Any],
    workers: int | None,
    executor: Executor | None,
) -> Iterator[tuple[int, WorstValue]]:
    """Yield the worst value of an index for each numbered design, as soon as it is known.

    The arguments are those of `worst`, checked; `options` are length, ellipsoid and maximum.
    """
    side = 1 if INDICES[name].better == "lower" else -1
    tasks = [
        _Task(number, design, box, name, side, share, budget, options)
        for number, design in designs.items()
    ]
    for task, found in run_all(_run, iter(tasks), len(tasks), workers=workers, executor=executor):
        low, high = (found.bound, found.value)[::-side]
        yield task.number, WorstValue(low, high, found.closed, found.n_boxes)
