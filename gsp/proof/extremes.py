"""`gsp.bounds`: proven bounds of a quantity over a box of poses, best box first."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.checks import check_integer, check_positive, check_type
from gsp.errors import InvalidInput, UnknownIndex, brief, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.limits import Limits
from gsp.limits.clearance import leg_pairs
from gsp.model.design import Design
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import (
    Angles,
    Problem,
    boxes_of,
    problem_of,
    quantity_names,
)
from gsp.proof.branching.requirements import COSINE, with_maximum
from gsp.proof.certify import check_box
from gsp.variation.layout import HIGH, INDEX_ORDER, LOW, MID_HIGH, MID_LOW, PARTS

# Boxes of one round of the search, and default number of boxes of a search.
ROUND, BUDGET = 4096, 100_000
# The indices that have bounds.
BOUNDED = (*INDEX_ORDER, "quality_index")
# Share of the greater magnitude of the two ends to which they are closed if nothing is said.
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
    ellipsoid: Ellipsoid | None = None,
    maximum: float | None = None,
    budget: int | None = None,
) -> Bounds:
    """Return proven bounds of an index, of an actuated joint or a clearance over a box of poses.

    Parameters
    ----------
    design : Design
    box : PoseBox
    index : str
        Name or symbol of CDN_CL, σ_min, |det J|, λ, CDN_OE or CTN; one of `design.joint_names`; or
        "clearance 1-2" for the distance of two legs.
    tolerance : float [1]
        Each bound comes as near to a value that occurs as this share of it, unless the budget ends.
    length : float or None [unit of the design]
        Characteristic length; default that of the design.
    ellipsoid : Ellipsoid or None
        For CDN_OE; default that of the design.
    maximum : float or None [unit of |det J|]
        For λ; default `gsp.determinant.reference(design).value`.
    budget : int or None
        Most boxes per end, default 100 000.

    Returns
    -------
    Bounds
        The pair (low, high): no defined pose of the box has a value outside. Without a finite
        bound, as for the condition number of a box with a singular pose, high is inf.

    Raises
    ------
    InvalidInput
        On a wrong type, angles beyond 2π or wider than a turn, or |det J| of a design where it has
        no unit.
    UnknownIndex
        For an index that has no bounds over boxes.
    MissingParameter
        If the index needs a length or an ellipsoid and there is none.

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
    problem, factor = _problem(design, name, length, ellipsoid, maximum)
    angles = Angles.of(box.order)
    place = problem.names.index("manipulability" if name == "quality_index" else name)
    ends = [
        extreme(problem, problem.frame(angles), boxes_of(box, angles), place, side, share, most)
        for side in (-1.0, 1.0)
    ]
    limits = _range(problem.names[place])
    numbers = [np.clip(x, *limits) for end in ends for x in (end.bound, end.value)]
    if problem.is_cosine(place):
        ends, numbers = ends[::-1], _angles(numbers)
    low, least, high, greatest = (float(x) / factor for x in numbers)
    result = Bounds((low, high))
    result.least, result.greatest = least, greatest
    result.least_pose, result.greatest_pose = (_pose(box, angles, end.point) for end in ends)
    result.closed = least - low <= share * abs(least) and high - greatest <= share * abs(greatest)
    result.n_boxes = sum(end.n_boxes for end in ends)
    return result


def _range(name: str) -> tuple[float, float]:
    """Return the interval that holds all defined values."""
    if name.startswith("condition"):
        return 1.0, np.inf
    if name.startswith("theta"):
        return -1.0, 1.0
    return 0.0, 1.0 if name == "control_number" else np.inf


def _angles(cosines: list[float]) -> list[float]:
    """Return bound and value of both ends of an angle from those of its cosine, outward."""
    low, least, high, greatest = np.arccos(cosines)
    return [high * (1.0 - COSINE), greatest, low * (1.0 + COSINE), least]


def _name(design: Design, index: Any) -> str:
    if not isinstance(index, str):
        raise InvalidInput(expected("index", "the name of an index or a joint", brief(index)))
    symbols = {INDICES[name].symbol: name for name in BOUNDED}
    name = symbols.get(index, index)
    known = (*BOUNDED, *design.joint_names, *quantity_names(design)[-len(leg_pairs(design)) :])
    if name not in known:
        raise UnknownIndex("index with bounds over boxes", index, known)
    return name


def _problem(
    design: Design,
    name: str,
    length: float | None,
    ellipsoid: Ellipsoid | None,
    maximum: float | None,
) -> tuple[Problem, float]:
    """Return what computes a quantity, and what its bounds are to be divided by."""
    strokes = np.full((len(design.joint_names), 2), np.nan)
    given: dict[str, Any] = {"length": length, "ellipsoid": ellipsoid, "maximum": maximum}
    if name in design.joint_names:
        # A bound that is finite, so that the quantity is computed.
        strokes[design.joint_names.index(name)] = (0.1, 0.2)
    elif name.startswith("clearance"):
        given["leg_radius"] = 1.0
    else:
        given["indices"] = [f"{name} >= 1"]
    limits = with_maximum(design, Limits(strokes=strokes, **given))
    factor = limits.maximum if name == "quality_index" else None
    return problem_of(design, limits, regular=False), 1.0 if factor is None else factor


# Which boxes (m, 12) hold a pose that counts.
Keep = Callable[[Array], Array]


def extreme(
    problem: Problem,
    frame: Array,
    box: Array,
    place: int,
    side: float,
    share: float,
    budget: int,
    *,
    keep: Keep | None = None,
    value: float = -np.inf,
) -> _End:
    """Bound the greatest (side = 1) or the least (side = −1) value of a quantity over boxes.

    The boxes with the greatest bounds are halved; those whose bound is not above a value that
    occurs, or may be given as `value`, are left out, and those that `keep` leaves out.
    """
    out, _ = enclose(problem, frame, box)
    boxes, bound = box, _outer(out[:, place], side)
    parts = out[:, place, PARTS:]
    value, point = _best(out[:, place], box, side, value, box[0, :6])
    done, n_boxes = -np.inf, len(box)
    while len(boxes) and n_boxes < budget:
        if bound.max() - value <= share * abs(value):
            break
        some = np.argsort(-bound, kind="stable")[:ROUND]
        rest = np.ones(len(boxes), dtype=bool)
        rest[some] = False
        halves, stuck = halved(boxes[some], parts[some], problem.length)
        done = max(done, bound[some][stuck].max(initial=-np.inf))
        if keep is not None:
            halves = halves[keep(halves)]
        out, _ = enclose(problem, frame, halves)
        n_boxes += len(halves)
        value, point = _best(out[:, place], halves, side, value, point)
        boxes = np.concatenate((boxes[rest], halves))
        bound = np.concatenate((bound[rest], _outer(out[:, place], side)))
        parts = np.concatenate((parts[rest], out[:, place, PARTS:]))
        above = bound > value
        boxes, bound, parts = boxes[above], bound[above], parts[above]
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
    if not len(values):  # no box could be halved
        return value, point
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
