"""`gsp.proof.largest_around`: the largest ball or cylinder of poses that is proven."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_integer, check_type
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array
from gsp.limits import Limits
from gsp.model.design import Design, check_undriven
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Angles, Problem, problem_of
from gsp.proof.extremes import halved
from gsp.proof.largest import check_around
from gsp.proof.tolerances import Tolerances
from gsp.variation.layout import HIGH, LOW, MID_HIGH, MID_LOW, PARTS

Shape = Literal["ball", "cylinder"]
# Default number of boxes, and boxes of one round of the search.
BOX_BUDGET, BOXES_PER_ROUND = 200_000, 1024
# Relative gap at which the search ends.
RADIUS_TOLERANCE = 0.02
# Roundings of gauges and distances, inward, relative to them.
DISTANCE_INWARD = 1.0 - 2.0**-40


@dataclass(frozen=True, eq=False, kw_only=True)
class LargestAround(ReadOnly):
    """The largest ball or cylinder that was proven; made by `gsp.proof.largest_around`.

    Attributes
    ----------
    factor : float [1]
        Every pose whose gauge is below it satisfies the requirements.
    above : float [1]
        The gauge of `violation`; inf where none was found.
    violation : Pose of shape (), or None
        A pose that violates a requirement; or where det J has the other sign, so that a pose with
        a gauge of at most `above` is singular or undefined.
    n_boxes : int
        Boxes that were evaluated.
    """

    factor: float
    above: float
    violation: Pose | None
    n_boxes: int


def largest_around(
    design: Design,
    pose: Pose,
    half_widths: ArrayLike,
    limits: Limits | None = None,
    *,
    shape: Shape = "ball",
    order: str = "rpy",
    regular: bool = True,
    tolerances: Tolerances | None = None,
    budget: int | None = None,
) -> LargestAround:
    """Return the largest ball or cylinder of positions, times a range of angles, that is proven.

    The gauge of a pose is the greater one of that of its position and max |angle − centre|/h over
    the three angles. In a ball with the half-widths a, b, c the gauge of a position is
    sqrt((x/a)² + (y/b)² + (z/c)²); in a cylinder it is max(sqrt((x/a)² + (y/b)²), |z|/c).

    Parameters
    ----------
    design : Design
    pose : Pose of shape ()
        The centre.
    half_widths : (6,) array_like [unit of the design, rad]
        Semi-axes of positions and half-widths of angles for the factor 1; 0 fixes a coordinate.
        Three equal ones make a ball, two a circular cylinder about the z axis of the base.
    limits : Limits or None
        See `gsp.certify`.
    shape : "ball" or "cylinder"
        Of the positions.
    order : str
        The angle set: see `gsp.PoseBox`.
    regular : bool
        Whether every pose has to be defined and not singular.
    tolerances : Tolerances or None
        The proof then holds for every copy within them.
    budget : int or None
        Most boxes, default 200 000.

    Returns
    -------
    LargestAround

    Raises
    ------
    InvalidInput
        On a wrong type or shape, or half-widths that are negative or all zero.
    MissingParameter
        If an index needs a length that is not given.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> found = gsp.proof.largest_around(d, d.home, [1, 1, 1, 0.01, 0.01, 0.01], budget=3000)
    >>> 5 < found.factor <= found.above
    True

    *Source: ours; see `docs/proofs.md`.*
    """
    check_undriven("design", design)
    wide = check_around(pose, half_widths)
    shape = arguments.one_of(*get_args(Shape))("shape", shape)
    if limits is not None:
        check_type("limits", limits, Limits)
    most = BOX_BUDGET if budget is None else check_integer("budget", budget)
    problem = problem_of(design, limits, regular=regular, tolerances=tolerances)
    box, angles = PoseBox.around(pose, np.zeros(6), order=order), Angles.of(order)
    chosen = angles.coordinates
    centre, half = box.low[chosen], wide[chosen]
    gauge = _Gauge(centre, half, 2 if shape == "cylinder" else 3)
    factor, above, point, n_boxes = _search(problem, problem.frame(angles), gauge, most)
    violation = None
    if point is not None:
        values = np.empty(6)
        values[chosen] = point
        violation = box.pose(values)
    return LargestAround(factor=factor, above=above, violation=violation, n_boxes=n_boxes)


@dataclass(frozen=True, eq=False)
class _Gauge:
    """Gauges around a centre (6,) with half-widths (6,); `round` coordinates are of the ball."""

    centre: Array
    half: Array
    round: int

    def least(self, boxes: Array) -> Array:
        """Lower bounds of the gauges of the poses in boxes (m, 12)."""
        low, high = boxes[:, :6] - self.centre, boxes[:, 6:] - self.centre
        return self.of(np.maximum(np.maximum(low, -high), 0.0))

    def of(self, away: Array) -> Array:
        """Gauges of points at distances (m, 6) from the centre."""
        with np.errstate(all="ignore"):
            share = np.where(self.half > 0.0, np.abs(away) / self.half, 0.0)
        near = np.linalg.norm(share[:, : self.round], axis=1)
        return np.asarray(np.maximum(near, share[:, self.round :].max(axis=1)))

    def largest(self) -> float:
        """Return the factor at which an angle would pass half a turn from its centre."""
        angles = self.half[3:]
        return float(np.pi / angles.max()) if angles.any() else np.inf


def _search(
    problem: Problem, frame: Array, gauge: _Gauge, budget: int
) -> tuple[float, float, Array | None, int]:
    """Return the proven factor, the least one of a violation, where it is, and boxes.

    The box is doubled until a violation is found; then the open box that is nearest is halved.
    """
    factor, reach, n_boxes = 0.0, min(1.0, gauge.largest()), 0
    above, point = np.inf, None
    while n_boxes < budget:
        some = _within(problem, frame, gauge, min(reach, above), max(1, (budget - n_boxes) // 4))
        n_boxes += some[3]
        factor = max(factor, some[0])
        if some[1] < above:
            above, point = some[1], some[2]
        if factor >= (1.0 - RADIUS_TOLERANCE) * min(above, gauge.largest()):
            break
        # A small set takes few boxes; a large one whose budget ends may prove nothing.
        if some[0] >= 0.99 * reach:
            reach = min(1.5 * reach, above, gauge.largest())
        elif factor > 0.0:
            reach = max(factor * 1.02, 0.5 * (factor + min(reach, above)))
        else:
            reach *= 0.5
        if not 2.0**-60 < reach < 2.0**60:
            break
    return factor, above, point, n_boxes


def _within(
    problem: Problem, frame: Array, gauge: _Gauge, reach: float, budget: int
) -> tuple[float, float, Array | None, int]:
    """Search the set with the factor `reach`, the nearest open boxes first."""
    least, most = problem.bounds[:2, problem.chosen]
    boxes = np.concatenate((gauge.centre - reach * gauge.half, gauge.centre + reach * gauge.half))
    boxes, near, n_boxes, stuck_at = boxes[None], np.zeros(1), 0, np.inf
    out, start = enclose(problem, frame, np.tile(gauge.centre, 2)[None])
    if problem.signed >= 0 and not out[0, problem.signed, MID_LOW] > 0.0:
        # Without a certain sign at the centre no other sign is a violation.
        start = 0.0 * start
    above, point = np.inf, None
    while len(boxes) and n_boxes < budget and near.min() < min(stuck_at, above):
        some = np.argsort(near, kind="stable")[:BOXES_PER_ROUND]
        rest = np.ones(len(boxes), dtype=bool)
        rest[some] = False
        out, signs = enclose(problem, frame, boxes[some])
        n_boxes += len(some)
        values = out[:, problem.chosen]
        left = ~((values[..., LOW] >= least) & (values[..., HIGH] <= most)).all(axis=1)
        middle = 0.5 * (boxes[some, :6] + boxes[some, 6:])
        bad = _violated(problem, out, signs * start[0])
        far = np.where(bad, gauge.of(middle - gauge.centre), np.inf)
        if far.min(initial=np.inf) < above:
            above, point = float(far.min()), middle[int(far.argmin())]
        place = problem.chosen[_first(values, least, most)]
        parts = out[np.arange(len(some)), place, PARTS:]
        halves, stuck = halved(boxes[some][left], parts[left], problem.length)
        stuck_at = min(stuck_at, near[some][left][stuck].min(initial=np.inf))
        away = gauge.least(halves)
        inside = away < min(reach, above)
        boxes = np.concatenate((boxes[rest], halves[inside]))
        near = np.concatenate((near[rest], away[inside]))
    free = min(float(near.min(initial=min(reach, above))), stuck_at) * DISTANCE_INWARD
    return free, above, point, n_boxes


def _violated(problem: Problem, out: Array, signs: Array) -> Array:
    """Whether the centres of boxes certainly violate a requirement."""
    least, most = problem.bounds[2:, problem.chosen]
    values = out[:, problem.chosen]
    bad = ((values[..., MID_HIGH] < least) | (values[..., MID_LOW] > most)).any(axis=1)
    if problem.signed >= 0:
        bad |= (out[:, problem.signed, MID_LOW] > 0.0) & (signs < 0.0)
    return np.asarray(bad)


def _first(values: Array, least: Array, most: Array) -> Array:
    """Return the first of the bounded quantities that is not proven, by box."""
    fine = (values[..., LOW] >= least) & (values[..., HIGH] <= most)
    return np.asarray((~fine).argmax(axis=1))
