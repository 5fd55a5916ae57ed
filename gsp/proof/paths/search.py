"""The search along a path: intervals that are not decided are halved."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from gsp.errors import apart
from gsp.geometry.vectors import Array, Mask
from gsp.proof.branching.claims import violation
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Problem
from gsp.proof.paths.charts import Charts
from gsp.proof.paths.pieces import Numbers
from gsp.proof.paths.rates import HIGH as RATE_HIGH
from gsp.proof.paths.rates import LOW as RATE_LOW
from gsp.proof.paths.rates import MID_HIGH as RATE_MID_HIGH
from gsp.proof.paths.rates import MID_LOW as RATE_MID_LOW
from gsp.proof.paths.rates import RATES, Rates
from gsp.variation.layout import HIGH, LOW, MID_HIGH, MID_LOW

# Least width of an interval, and of one on a path that is refuted, as shares of a piece.
LEAST_WIDTH, LEAST_REFUTED_WIDTH = 2.0**-40, 2.0**-12
# The same where a rate at the middle is nearer to its bound than it is known, for tolerances:
# halves are decided only if they are away from there.
UNKNOWN_WIDTH = 2.0**-8
# Intervals that are evaluated at a time.
INTERVALS_AT_ONCE = 4096
SINGULAR = "det J changes its sign: a pose between the parameters is singular or undefined"


@dataclass(frozen=True, eq=False)
class _Verdicts:
    """What is known of each of n intervals: arrays (n,).

    Attributes
    ----------
    proven, violated : bool arrays
        All poses satisfy all bounds; all poses violate one bound.
    reason : list of str
        What the pose in the middle violates, or nothing.
    sign : array
        The sign of det J in the middle, 0 if it is not certain.
    unknown : bool array
        Where a rate in the middle is neither within its bound nor beyond it.
    """

    proven: Mask
    violated: Mask
    reason: list[str]
    sign: Array
    unknown: Mask


@dataclass(eq=False)
class _State:
    """What the search has found."""

    proven: list[tuple[float, float]] = field(default_factory=list)
    violated: list[tuple[float, float]] = field(default_factory=list)
    open: list[tuple[float, float]] = field(default_factory=list)
    signs: list[tuple[float, float]] = field(default_factory=list)
    n_boxes: int = 0
    first: tuple[float, str] | None = None

    def leave_open(self, low: Array, high: Array) -> None:
        """Add intervals that are not decided."""
        self.open += list(zip(low.tolist(), high.tolist(), strict=True))


@dataclass(frozen=True, eq=False, kw_only=True)
class FoundOnPath:
    """What a search found.

    Attributes
    ----------
    undecided : bool
        Whether an interval is not proven.
    reason : str
        What is violated, or "".
    points : tuple of float
        One parameter, number of the piece plus its u, where a limit is violated, or the two between
        which det J changes its sign.
    intervals : list of (low, high, mark)
        The whole path in order.
    n_boxes : int
    """

    undecided: bool
    reason: str
    points: tuple[float, ...]
    intervals: list[tuple[float, float, str]]
    n_boxes: int


def search(charts: Charts, problem: Problem | None, rates: Rates, budget: int) -> FoundOnPath:
    """Decide a path: requirements over poses, if there are any, and bounds of rates."""
    state = _State()
    chart, (low, high) = np.arange(len(charts.piece)), charts.ends.T
    while len(low) and state.n_boxes < budget:
        state.n_boxes += len(low)
        found = _verdicts(charts, problem, rates, chart, low, high)
        left = ~(found.proven | found.violated)
        _noted(state, found, low, high)
        chart, low, high = chart[left], low[left], high[left]
        least = LEAST_WIDTH if state.first is None else LEAST_REFUTED_WIDTH
        wide = high - low > np.where(found.unknown[left], UNKNOWN_WIDTH, least)
        state.leave_open(low[~wide], high[~wide])
        chart, low, high = chart[wide], low[wide], high[wide]
        middle = 0.5 * (low + high)
        chart = np.concatenate((chart, chart))
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
    state.leave_open(low, high)
    if state.first is None and problem is not None and _change(state.signs) is not None:
        state.signs = _certain(charts, problem, state.signs)
    # Rounding may leave an interval that violates a limit without a pose that certainly does.
    return _result(state, undecided=bool(state.open or state.violated))


def _noted(state: _State, found: _Verdicts, low: Array, high: Array) -> None:
    """Add the verdicts of intervals to what is found."""
    middle = 0.5 * (low + high)
    for mask, target in ((found.proven, state.proven), (found.violated, state.violated)):
        target += list(zip(low[mask].tolist(), high[mask].tolist(), strict=True))
    certain = found.sign != 0.0
    state.signs += list(zip(middle[certain].tolist(), found.sign[certain].tolist(), strict=True))
    if state.first is None:
        some = [i for i in np.argsort(middle) if found.reason[i]]
        if some:
            state.first = float(middle[some[0]]), found.reason[some[0]]


def _verdicts(
    charts: Charts, problem: Problem | None, rates: Rates, chart: Numbers, low: Array, high: Array
) -> _Verdicts:
    n = len(low)
    no = np.zeros(n, dtype=bool)
    result = _Verdicts(~no, no.copy(), [""] * n, np.zeros(n), no.copy())
    for start in range(0, n, INTERVALS_AT_ONCE):
        some = np.arange(start, min(n, start + INTERVALS_AT_ONCE))
        if problem is not None:
            _of_poses(charts, problem, chart[some], low[some], high[some], some, result)
        if np.isfinite(rates.most).any():
            _of_rates(charts, rates, chart[some], low[some], high[some], some, result)
    return result


def _of_poses(
    charts: Charts,
    problem: Problem,
    chart: Numbers,
    low: Array,
    high: Array,
    some: Numbers,
    result: _Verdicts,
) -> None:
    """Join the verdicts on requirements over poses."""
    out, sign = _enclosed(charts, problem, chart, low, high)
    least, most = problem.bounds[:2, problem.chosen]
    values = out[:, problem.chosen]
    result.proven[some] &= ((values[..., LOW] >= least) & (values[..., HIGH] <= most)).all(axis=1)
    if problem.signed >= 0:
        certain = out[:, problem.signed, MID_LOW] > 0.0
        result.sign[some] = np.where(certain, sign, 0.0)
    least, most = problem.bounds[2:, problem.chosen]
    bad = (values[..., HIGH] < least) | (values[..., LOW] > most)
    result.violated[some] |= bad.any(axis=1)
    bad = (values[..., MID_HIGH] < least) | (values[..., MID_LOW] > most)
    suspect = np.flatnonzero(bad.any(axis=1))
    if not suspect.size:
        return
    # The path is within a margin of where it is computed: all poses there must be bad.
    middle = 0.5 * (low + high)[suspect]
    values = _enclosed(charts, problem, chart[suspect], middle, middle)[0][:, problem.chosen]
    bad = (values[..., HIGH] < least) | (values[..., LOW] > most)
    exact, _ = _enclosed(charts, problem.nominal(), chart[suspect], middle, middle)
    for i, each, values in zip(suspect, bad, exact, strict=True):
        if each.any():
            quantity = int(problem.chosen[int(each.argmax())])
            result.reason[some[i]] = violation(problem, quantity, *values[quantity, [LOW, HIGH]])


def _enclosed(
    charts: Charts, problem: Problem, chart: Numbers, low: Array, high: Array
) -> tuple[Array, Array]:
    """Bounds and signs of intervals."""
    boxes = charts.boxes(chart, low, high)
    out, signs = np.empty((len(low), len(problem.named), 10)), np.empty(len(low))
    # Boxes whose angles have no bounds give no bound.
    bounded = np.isfinite(boxes).all(axis=1, keepdims=True)
    boxes = np.where(bounded, boxes, np.nan)
    for number in np.unique(chart):
        each = np.flatnonzero(chart == number)
        out[each], signs[each] = enclose(problem, charts.frames[number], boxes[each])
    return out, signs


def _of_rates(
    charts: Charts,
    rates: Rates,
    chart: Numbers,
    low: Array,
    high: Array,
    some: Numbers,
    result: _Verdicts,
) -> None:
    """Join the verdicts on speeds and accelerations."""
    piece = charts.piece[chart]
    middle, half = 0.5 * (low + high) - piece, 0.5 * (high - low)
    values, most = rates.bounds(charts.pieces, piece, middle, half), rates.most[:, :, None]
    fine = (values[..., RATE_LOW] >= -most) & (values[..., RATE_HIGH] <= most)
    result.proven[some] &= (fine | np.isinf(most)).all(axis=(0, 1))
    bad = (values[..., RATE_HIGH] < -most) | (values[..., RATE_LOW] > most)
    result.violated[some] |= bad.any(axis=(0, 1))
    bad = (values[..., RATE_MID_HIGH] < -most) | (values[..., RATE_MID_LOW] > most)
    near = (values[..., RATE_MID_LOW] < -most) | (values[..., RATE_MID_HIGH] > most)
    result.unknown[some] = (near & ~bad).any(axis=(0, 1))
    suspect = np.flatnonzero(bad.any(axis=(0, 1)))
    if not suspect.size:
        return
    exact = rates.nominal().bounds(
        charts.pieces, piece[suspect], middle[suspect], np.zeros(len(suspect))
    )
    for i, values in zip(suspect, exact.transpose(2, 0, 1, 3), strict=True):
        order, joint = np.argwhere(bad[:, :, i])[0]
        value, bound = values[order, joint, RATE_MID_LOW:].mean(), rates.most[order, joint]
        sign, bound = (">", bound) if value > 0.0 else ("<", -bound)
        violated = f" {sign} ".join(apart(value, bound))
        text = f"{RATES[order]} of {rates.names[joint]} = {violated}"
        result.reason[some[i]] = result.reason[some[i]] or text


def _certain(
    charts: Charts, problem: Problem, signs: list[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Return the signs of det J that are the same at all poses within the margin."""
    result, ends = [], charts.ends[:, 1]
    for start in range(0, len(signs), INTERVALS_AT_ONCE):
        middle, sign = np.array(signs[start : start + INTERVALS_AT_ONCE]).T
        chart = np.minimum(np.searchsorted(ends, middle), len(ends) - 1)
        out, _ = _enclosed(charts, problem, chart, middle, middle)
        good = out[:, problem.signed, LOW] > 0.0
        result += [(float(x), float(s)) for x, s in zip(middle[good], sign[good], strict=True)]
    return result


def _change(signs: list[tuple[float, float]]) -> tuple[float, float] | None:
    """Narrowest interval between neighbours with opposite signs."""
    changes = [(b[0] - a[0], a[0], b[0]) for a, b in pairwise(sorted(signs)) if a[1] != b[1]]
    return min(changes)[1:] if changes else None


def _result(state: _State, *, undecided: bool) -> FoundOnPath:
    reason, change = "", _change(state.signs)
    points: tuple[float, ...] = ()
    if state.first is not None:
        points, reason = (state.first[0],), state.first[1]
    elif change is not None:
        points, reason = change, SINGULAR
    lists = {"proven": state.proven, "violated": state.violated, "open": state.open}
    intervals = sorted((*x, mark) for mark, some in lists.items() for x in some)
    return FoundOnPath(
        undecided=undecided,
        reason=reason,
        points=points,
        intervals=intervals,
        n_boxes=state.n_boxes,
    )
