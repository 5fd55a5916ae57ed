"""`gsp.bounds`: proven bounds of a quantity over a box of poses, best box first."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import FrozenInstanceError, dataclass
from typing import Any, NoReturn, Self

import numpy as np

from gsp.checks import check_integer, check_positive, is_a, plain_text
from gsp.errors import InvalidInput, UnknownIndex, brief, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array
from gsp.indices import INDICES, index_name
from gsp.indices.table import MAXIMUM_SHARES
from gsp.limits import Limits
from gsp.model.design import Design, check_undriven
from gsp.progress import Report
from gsp.proof.boxes import check_box
from gsp.proof.branching.claims import value_at
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import (
    Angles,
    Problem,
    boxes_of,
    problem_of,
    quantities_of,
)
from gsp.proof.branching.requirements import COSINE_ROUNDING, bounded_by, with_maximum
from gsp.variation.layout import HIGH, INDEX_ORDER, LOW, MID_HIGH, MID_LOW, PARTS

# Boxes of one round of the search, and default number of boxes of a search.
EXTREMES_BOXES_PER_ROUND, BOXES_PER_SEARCH = 4096, 100_000
# Centres of which it is decided at first whether their values occur, then twice as many.
CENTRES_COUNTED = 32
# Boxes that are bounded at once: all quantities of one box take two kilobytes.
BOXES_PER_BLOCK = 8192
# The indices that have bounds.
BOUNDED = (*INDEX_ORDER, *MAXIMUM_SHARES)
# The legs in the name of a clearance.
PAIR = re.compile(r"(\d+)-(\d+)")
# Share of the greater magnitude of the two ends to which they are closed by default.
ENDS_TOLERANCE = 0.05


class Bounds(tuple[float, float]):
    """A pair (low, high) that encloses every value over a box, and the record of its search.

    Attributes
    ----------
    low, high : float [of the quantity]
        The pair: proven bounds.
    least, greatest : float [of the quantity]
        Values that occur in the box, so that the least value of all is in [low, least] and the
        greatest one in [greatest, high]. NaN if the search found no pose with a defined value.
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

    def __new__(
        cls,
        low: float,
        high: float,
        *,
        least: float,
        greatest: float,
        least_pose: Pose,
        greatest_pose: Pose,
        closed: bool,
        n_boxes: int,
    ) -> Self:
        """Return the pair with its record, which cannot be changed."""
        pair = super().__new__(cls, (low, high))
        vars(pair).update(
            least=least,
            greatest=greatest,
            least_pose=least_pose,
            greatest_pose=greatest_pose,
            closed=closed,
            n_boxes=n_boxes,
        )
        return pair

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> NoReturn:
        raise FrozenInstanceError(f"cannot delete field {name!r}")

    def __getnewargs_ex__(self) -> tuple[tuple[float, ...], dict[str, Any]]:
        # Pickling a tuple would give the pair as one argument.
        return tuple(self), vars(self)

    @property
    def low(self) -> float:
        """Proven lower bound [of the quantity].

        *Source: ours; see `docs/proofs.md`*
        """
        return self[0]

    @property
    def high(self) -> float:
        """Proven upper bound [of the quantity].

        *Source: ours; see `docs/proofs.md`*
        """
        return self[1]


@dataclass(frozen=True, eq=False, kw_only=True)
class End:
    """One end: the proven bound, a value that occurs, where, whether they are close, boxes."""

    bound: float
    value: float
    pose: Pose
    closed: bool
    n_boxes: int


@dataclass(frozen=True, eq=False, kw_only=True)
class Extreme:
    """The same of a search over boxes (m, 12), at a point (6,) of one of them."""

    bound: float
    value: float
    point: Array
    n_boxes: int


def bounds(
    design: Design,
    box: PoseBox,
    index: str,
    tolerance: float = ENDS_TOLERANCE,
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
        "clearance 1-2" for the distance of two legs, which have no common anchor.
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
        Also if the largest coordinate of an anchor is not between 1e-40 and 1e40.
    UnknownIndex
        For another name; the message states what has bounds for this design.
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
    check_undriven("design", design)
    check_box(box)
    share = check_positive("tolerance", tolerance)
    most = BOXES_PER_SEARCH if budget is None else check_integer("budget", budget)
    name = _name(design, index)
    given = {"length": length, "ellipsoid": ellipsoid, "maximum": maximum}
    low, high = (one_end(design, box, name, side, share, most, **given) for side in (-1, 1))
    # Of values that are equal but for rounding, the greatest may have been met as the least.
    least, greatest = (high, low) if low.value > high.value else (low, high)
    return Bounds(
        low.bound,
        high.bound,
        least=least.value,
        greatest=greatest.value,
        least_pose=least.pose,
        greatest_pose=greatest.pose,
        closed=low.closed and high.closed,
        n_boxes=low.n_boxes + high.n_boxes,
    )


def one_end(
    design: Design, box: PoseBox, name: str, side: int, share: float, budget: int, **given: Any
) -> End:
    """Bound the greatest (side = 1) or the least (side = −1) value of a quantity over a box.

    `given` are the length, the ellipsoid and the maximum for the indices that need them.
    """
    problem, place, factor = index_problem(design, name, given)
    angles = Angles.of(box.order)
    cosine = problem.is_cosine(place)
    found = extreme(
        problem,
        problem.frame(angles),
        boxes_of(box, angles),
        place,
        -side if cosine else side,
        share,
        budget,
    )
    pose = _pose(box, angles, found.point)
    bound, value = found.bound / factor, found.value / factor
    if cosine:
        bound, value = np.arccos((bound, value)) * (1.0 + side * COSINE_ROUNDING, 1.0)
    elif name in BOUNDED:
        value = value_at(design, pose, name, given)
    return End(
        bound=float(bound),
        value=float(value),
        pose=pose,
        closed=is_closed(bound, value, share),
        n_boxes=found.n_boxes,
    )


def is_closed(bound: float, value: float, share: float) -> bool:
    """Whether a bound is as near to a value that occurs as a share of it; both may be inf."""
    return bool(bound == value or abs(bound - value) <= share * abs(value) < np.inf)


def _range(problem: Problem, place: int) -> tuple[float, float]:
    """Return the interval that holds all defined values of a quantity."""
    quantity = problem.named[place]
    if quantity.angular:
        return -1.0, 1.0
    if quantity.kind == "index":
        index = INDICES[quantity.name]
        return min(index.best, index.worst), max(index.best, index.worst)
    return -np.inf if quantity.kind == "position" else 0.0, np.inf


def _name(design: Design, index: Any) -> str:
    """Return the name of an index, a joint or a clearance, whose legs may be in any order."""
    legs = [q.name for q in quantities_of(design) if q.kind == "clearance"]
    known = {name: name for name in (*design.joint_names, *legs)}
    known |= {PAIR.sub(r"\2-\1", name): name for name in legs}
    name = index.strip() if is_a(index := plain_text(index), str) else None
    if name in known:
        return known[name]
    joints = f"; {', '.join(design.joint_names)}"
    pairs = f'; or a clearance of legs without a common anchor, such as "{legs[0]}"' if legs else ""
    return bounded_name(index, (*design.joint_names, *legs), joints + pairs)


def bounded_name(index: Any, others: Sequence[str] = (), also: str = "") -> str:
    """Return the name of an index that has bounds, given by its name or symbol.

    Raises
    ------
    InvalidInput
        If it is not a text.
    UnknownIndex
        For another text; `others` are the names that it may have as well, and `also` states them.
    """
    symbols = [INDICES[name].symbol for name in BOUNDED]
    known = f"{', '.join(symbols)}, or their names{also}"
    if not is_a(index, str):
        raise InvalidInput(expected("index", known, brief(index)))
    try:
        name = index_name(index)
    except UnknownIndex:
        name = ""
    if name not in BOUNDED:
        kind = "quantity" if others else "index"
        names = (*BOUNDED, *symbols, *others)
        raise UnknownIndex(f"{kind} with bounds over boxes", index, names, f"Known: {known}")
    return name


def index_problem(design: Design, name: str, options: dict[str, Any]) -> tuple[Problem, int, float]:
    """Return the problem that bounds a quantity, its number there, and the scale of its bounds."""
    strokes = np.full((len(design.joint_names), 2), np.nan)
    given = dict(options)
    kinds = {quantity.name: quantity.kind for quantity in quantities_of(design)}
    if kinds.get(name) == "joint":
        # A bound that is finite, so that the quantity is computed.
        strokes[design.joint_names.index(name)] = (0.1, 0.2)
    elif kinds.get(name) == "clearance":
        given["leg_radius"] = 1.0
    else:
        given["indices"] = [f"{name} >= 1"]
    limits = with_maximum(design, Limits(strokes=strokes, **given))
    factor = limits.maximum if bounded_by(name) != name else None
    problem = problem_of(design, limits, regular=False)
    place = problem.names.index(bounded_by(name))
    return problem, place, 1.0 if factor is None else factor


# Which boxes (m, 12) hold a pose that counts, or which points (m, 6) do.
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
    counts: Keep | None = None,
    value: float = -np.inf,
    report: Report = lambda done, total: None,
) -> Extreme:
    """Bound the greatest (side = 1) or the least (side = −1) value of a quantity over boxes.

    The boxes with the greatest bounds are halved; those whose bound is not above a value that
    occurs, or may be given as `value`, are left out, and those that `keep` leaves out. The value
    at a centre occurs if `counts` is true there, by default everywhere. `report` is called after
    each round with the number of boxes and the budget.
    """
    limits = _range(problem, place)
    out = _enclosed(problem, frame, box, place)
    boxes, bound, parts = box, _outer(out, side, limits), out[:, PARTS:]
    value, point = _best(out, box, side, value, box[0, :6], counts)
    done, n_boxes = -np.inf, len(box)
    # Corners may be outside of a part of the box that is kept.
    corners = _corners(box) if keep is None else box[:0]
    while len(boxes) and n_boxes + 2 <= budget:
        if is_closed(bound.max(), value, share):
            break
        if 0 < len(corners) <= min(n_boxes, budget - n_boxes - 2):
            # The extreme of a quantity that is monotonic is at a corner, which no centre reaches.
            out = _enclosed(problem, frame, corners, place)
            value, point = _best(out, corners, side, value, point, counts)
            n_boxes, corners = n_boxes + len(corners), corners[:0]
        # Each halved box makes two, both of which count in the budget.
        some = np.argsort(-bound, kind="stable")[
            : min(EXTREMES_BOXES_PER_ROUND, (budget - n_boxes) // 2)
        ]
        rest = np.ones(len(boxes), dtype=bool)
        rest[some] = False
        halves, stuck = halved(boxes[some], parts[some], problem.length)
        done = max(done, bound[some][stuck].max(initial=-np.inf))
        if keep is not None:
            halves = halves[keep(halves)]
        out = _enclosed(problem, frame, halves, place)
        n_boxes += len(halves)
        report(min(n_boxes, budget), budget)
        value, point = _best(out, halves, side, value, point, counts)
        boxes = np.concatenate((boxes[rest], halves))
        bound = np.concatenate((bound[rest], _outer(out, side, limits)))
        parts = np.concatenate((parts[rest], out[:, PARTS:]))
        above = bound > value
        boxes, bound, parts = boxes[above], bound[above], parts[above]
    outermost = max(value, done, bound.max(initial=-np.inf))
    found = side * value if value > -np.inf else np.nan
    ends = np.clip((side * outermost, found), *limits)
    return Extreme(bound=float(ends[0]), value=float(ends[1]), point=point, n_boxes=n_boxes)


def _enclosed(problem: Problem, frame: Array, boxes: Array, place: int) -> Array:
    """Bound one quantity on boxes (n, 12): (n, 10)."""
    parts = [boxes[i : i + BOXES_PER_BLOCK] for i in range(0, len(boxes), BOXES_PER_BLOCK)]
    found = [enclose(problem, frame, part)[0][:, place].copy() for part in parts]
    return np.concatenate(found or [np.empty((0, 10))])


def _corners(boxes: Array) -> Array:
    """Corners of one box as boxes of no width; none of several boxes."""
    if len(boxes) > 1:
        return boxes[:0]
    ends = boxes.reshape(2, 6).T
    points = np.stack(np.meshgrid(*[np.unique(x) for x in ends], indexing="ij"), axis=-1)
    return np.tile(points.reshape(-1, 6), 2)


def _outer(quantity: Array, side: float, limits: tuple[float, float]) -> Array:
    """Return the bounds of boxes on one side; a box with undefined poses has all of the range."""
    least, greatest = limits
    if side > 0.0:
        return np.fmin(quantity[:, HIGH], greatest)
    return -np.fmax(quantity[:, LOW], least)


def _best(
    quantity: Array, boxes: Array, side: float, value: float, point: Array, counts: Keep | None
) -> tuple[float, Array]:
    """Greatest value that certainly occurs, of the centres of boxes and what is known already."""
    values = quantity[:, MID_LOW] if side > 0.0 else -quantity[:, MID_HIGH]
    above = np.flatnonzero(values > value)
    # The greatest first: where one counts, the others need not be decided, which takes long.
    above = above[np.argsort(-values[above], kind="stable")]
    centres = 0.5 * (boxes[above, :6] + boxes[above, 6:])
    done, block = 0, CENTRES_COUNTED
    while done < len(above):
        some = centres[done : done + block]
        hits = np.flatnonzero(counts(some)) if counts is not None else np.zeros(1, dtype=np.intp)
        if hits.size:
            return float(values[above[done + hits[0]]]), some[hits[0]]
        done, block = done + block, 2 * block
    return value, point


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
