"""`gsp.bounds`: proven bounds of a quantity over a box of poses, best box first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.checks import check_integer, check_positive, check_type
from gsp.errors import InvalidInput, UnknownIndex, brief, expected
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.proof.certify import check_box
from gsp.proof.enclosure import enclose
from gsp.proof.problem import INDEX_PLACES, Angles, Problem, boxes_of, problem_of
from gsp.proof.variation.layout import HIGH, LOW, MID_HIGH, MID_LOW, PARTS

# Boxes of one round of the search, and default number of boxes of a search.
ROUND, BUDGET = 4096, 100_000
# Default relative gap of the two ends, as a share of the greater magnitude.
TOLERANCE = 0.05


class Bounds(tuple[float, float]):
    """A pair (low, high) that encloses every value over a box, and the record of its search.

    Attributes
    ----------
    low, high : float [of the quantity]
        The pair.
    least, greatest : float [of the quantity]
        Values that occur in the box, so that the least value of all is in [low, least] and the
        greatest one in [greatest, high].
    least_pose, greatest_pose : Pose of shape ()
        Where they occur.
    closed : bool
        Whether both gaps are within the tolerance.
    n_boxes : int
        Boxes that were evaluated.
    """

    least: float
    greatest: float
    least_pose: Pose
    greatest_pose: Pose
    closed: bool
    n_boxes: int

    @property
    def low(self) -> float:
        """Proven lower bound [of the quantity]."""
        return self[0]

    @property
    def high(self) -> float:
        """Proven upper bound [of the quantity]."""
        return self[1]


@dataclass(frozen=True, eq=False)
class _End:
    """One end: the proven bound, a value that occurs, where, whether they are close, boxes."""

    bound: float
    value: float
    point: Array
    closed: bool
    n_boxes: int


def bounds(
    design: Design,
    box: PoseBox,
    index: str,
    tolerance: float = TOLERANCE,
    *,
    length: float | None = None,
    budget: int | None = None,
) -> Bounds:
    """Return proven bounds of an index, or of an actuated joint, over a box of poses.

    Parameters
    ----------
    design : Design
    box : PoseBox
    index : str
        "condition_number", "minimum_singular_value" or their symbols, or a distance of
        `design.joint_names`.
    tolerance : float [1]
        Each bound comes as near to a value that occurs as this share of it, unless the budget ends.
    length : float or None [unit of the design]
        Characteristic length; default that of the design.
    budget : int or None
        Most boxes per end, default 100 000.

    Returns
    -------
    Bounds
        The pair (low, high): no pose of the box has a value outside. Without a finite bound, as
        for the condition number of a box with a singular pose, high is inf.

    Raises
    ------
    InvalidInput
        On a wrong type, or angles beyond π.
    UnknownIndex
        For an index that has no bounds over boxes.
    MissingParameter
        If the index needs a length and there is none.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> low, high = gsp.bounds(d, gsp.PoseBox.around(d.home, [5, 5, 5, 0, 0, 0]), "CDN_CL")
    >>> bool(low < gsp.indices.condition_number(d.at(d.home), 95.0) < high)
    True

    *Source: ours; see `docs/proofs.md`.*
    """
    check_type("design", design, Design)
    check_box(box)
    share = check_positive("tolerance", tolerance)
    most = BUDGET if budget is None else check_integer("budget", budget)
    name = _name(design, index)
    problem = _problem(design, name, length)
    angles = Angles.of(box.order)
    place = problem.names.index(name)
    ends = [
        extreme(problem, problem.frame(angles), boxes_of(box, angles), place, side, share, most)
        for side in (-1.0, 1.0)
    ]
    result = Bounds((ends[0].bound, ends[1].bound))
    result.least, result.greatest = ends[0].value, ends[1].value
    result.least_pose, result.greatest_pose = (_pose(box, angles, end.point) for end in ends)
    result.closed = all(end.closed for end in ends)
    result.n_boxes = sum(end.n_boxes for end in ends)
    return result


def _name(design: Design, index: Any) -> str:
    symbols = {INDICES[name].symbol: name for name in INDEX_PLACES}
    distances = [name for name in design.joint_names if name.startswith("d")]
    if not isinstance(index, str):
        raise InvalidInput(expected("index", "the name of an index or a joint", brief(index)))
    name = symbols.get(index, index)
    if name not in (*INDEX_PLACES, *distances):
        raise UnknownIndex("index with bounds over boxes", index, (*INDEX_PLACES, *distances))
    return name


def _problem(design: Design, name: str, length: float | None) -> Problem:
    n = len(design.joint_names)
    strokes = np.full((n, 2), np.nan)
    if name in INDEX_PLACES:
        limits = Limits(strokes=strokes, indices=[f"{name} >= 0"], length=length)
    else:
        strokes[design.joint_names.index(name)] = 0.0, 1e300
        limits = Limits(strokes=strokes, length=length)
    return problem_of(design, limits, regular=False)


def extreme(
    problem: Problem, frame: Array, box: Array, place: int, side: float, share: float, budget: int
) -> _End:
    """Bound the greatest (side = 1) or the least (side = −1) value of a quantity.

    The boxes with the greatest bounds are halved; those whose bound is not above a value that
    occurs are left out.
    """
    out, _ = enclose(problem, frame, box)
    boxes, bound = box, _outer(out[:, place], side)
    parts = out[:, place, PARTS:]
    value, point = _best(out[:, place], box, side, -np.inf, box[0, :6])
    done, n_boxes = -np.inf, 1
    while len(boxes) and n_boxes < budget:
        if bound.max() - value <= share * abs(value):
            break
        some = np.argsort(-bound, kind="stable")[:ROUND]
        rest = np.ones(len(boxes), dtype=bool)
        rest[some] = False
        halves, stuck = halved(boxes[some], parts[some], problem.length)
        done = max(done, bound[some][stuck].max(initial=-np.inf))
        out, _ = enclose(problem, frame, halves)
        n_boxes += len(halves)
        value, point = _best(out[:, place], halves, side, value, point)
        boxes = np.concatenate((boxes[rest], halves))
        bound = np.concatenate((bound[rest], _outer(out[:, place], side)))
        parts = np.concatenate((parts[rest], out[:, place, PARTS:]))
        keep = bound > value
        boxes, bound, parts = boxes[keep], bound[keep], parts[keep]
    most = max(value, done, bound.max(initial=-np.inf))
    closed = bool(most - value <= share * abs(value))
    return _End(float(side * most), float(side * value), point, closed, n_boxes)


def _outer(quantity: Array, side: float) -> Array:
    values = quantity[:, HIGH] if side > 0.0 else -quantity[:, LOW]
    return np.where(np.isnan(values), np.inf, values)


def _best(
    quantity: Array, boxes: Array, side: float, value: float, point: Array
) -> tuple[float, Array]:
    """Greatest value that certainly occurs, of the centres of boxes and what is known already."""
    values = quantity[:, MID_LOW] if side > 0.0 else -quantity[:, MID_HIGH]
    values = np.where(np.isnan(values), -np.inf, values)
    i = int(values.argmax())
    if values[i] <= value:
        return value, point
    return float(values[i]), 0.5 * (boxes[i, :6] + boxes[i, 6:])


def halved(boxes: Array, parts: Array, length: float) -> tuple[Array, Array]:
    """Halve boxes in the coordinate with the greatest part; also which could not be halved.

    Where parts are not finite it is the widest coordinate, positions divided by the length.
    """
    finite = np.asarray((parts < np.inf).all(axis=1))
    widths = (boxes[:, 6:] - boxes[:, :6]) / np.repeat((length, 1.0), 3)
    middle = 0.5 * (boxes[:, :6] + boxes[:, 6:])
    can = (boxes[:, :6] < middle) & (middle < boxes[:, 6:])
    weights = np.where(can, np.where(finite[:, None], parts, widths), -1.0)
    k, i = weights.argmax(axis=1), np.arange(len(boxes))
    stuck = ~can[i, k]
    first, second = boxes.copy(), boxes.copy()
    first[i, 6 + k] = second[i, k] = middle[i, k]
    return np.concatenate((first[~stuck], second[~stuck])), stuck


def _pose(box: PoseBox, angles: Angles, point: Array) -> Pose:
    values = np.empty(6)
    values[angles.coordinates] = point
    return box.pose(values)
