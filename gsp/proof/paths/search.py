"""The search along a path: intervals that are not decided are halved."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Problem
from gsp.proof.certificate import Status
from gsp.proof.paths.certificate import PathCertificate
from gsp.proof.paths.charts import Charts
from gsp.proof.paths.pieces import Numbers
from gsp.proof.paths.rates import HIGH as RATE_HIGH
from gsp.proof.paths.rates import LOW as RATE_LOW
from gsp.proof.paths.rates import MID_HIGH as RATE_MID_HIGH
from gsp.proof.paths.rates import MID_LOW as RATE_MID_LOW
from gsp.proof.paths.rates import Rates
from gsp.variation.layout import HIGH, LOW, MID_HIGH, MID_LOW

# Least width of an interval, and of one on a path that is refuted, as shares of a piece.
LEAST_WIDTH, REFUTED_WIDTH = 2.0**-40, 2.0**-12
# The same where a rate at the middle is nearer to its bound than it is known, for tolerances:
# halves are decided only if they are away from there.
UNKNOWN_WIDTH = 2.0**-8
# Intervals that are evaluated at a time.
CHUNK = 4096
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
    signs: list[tuple[float, float]] = field(default_factory=list)
    n_boxes: int = 0
    first: tuple[float, str] | None = None


def search(charts: Charts, problem: Problem | None, rates: Rates, budget: int) -> PathCertificate:
    """Decide a path: requirements over poses, if there are any, and bounds of rates."""
    state, stuck = _State(), False
    chart, (low, high) = np.arange(len(charts.piece)), charts.ends.T
    while len(low) and state.n_boxes < budget:
        state.n_boxes += len(low)
        found = _verdicts(charts, problem, rates, chart, low, high)
        left = ~(found.proven | found.violated)
        _noted(state, found, low, high)
        chart, low, high = chart[left], low[left], high[left]
        least = LEAST_WIDTH if state.first is None else REFUTED_WIDTH
        wide = high - low > np.where(found.unknown[left], UNKNOWN_WIDTH, least)
        stuck = stuck or not wide.all()
        chart, low, high = chart[wide], low[wide], high[wide]
        middle = 0.5 * (low + high)
        chart = np.concatenate((chart, chart))
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
    if state.first is None and problem is not None and _change(state.signs) is not None:
        state.signs = _certain(charts, problem, state.signs)
    return _result(charts, state, undecided=stuck or len(low) > 0)


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
    for start in range(0, n, CHUNK):
        some = np.arange(start, min(n, start + CHUNK))
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
    for i, each in zip(suspect, bad, strict=True):
        if each.any():
            name = problem.names[problem.chosen[int(each.argmax())]]
            result.reason[some[i]] = f"{name} is out of its bounds"


def _enclosed(
    charts: Charts, problem: Problem, chart: Numbers, low: Array, high: Array
) -> tuple[Array, Array]:
    """Bounds and signs of intervals."""
    boxes = charts.boxes(chart, low, high)
    out, signs = np.empty((len(low), len(problem.names), 10)), np.empty(len(low))
    # Boxes whose angles have no bounds say nothing.
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
    for i in np.flatnonzero(bad.any(axis=(0, 1))):
        order, joint = np.argwhere(bad[:, :, i])[0]
        value = np.abs(values[order, joint, i, RATE_MID_LOW:]).mean()
        kind = ("speed", "acceleration")[order]
        text = f"{kind} of {rates.names[joint]}: {value:.6g} > {rates.most[order, joint]:.6g}"
        result.reason[some[i]] = result.reason[some[i]] or text


def _certain(
    charts: Charts, problem: Problem, signs: list[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Return the signs of det J that are the same at all poses within the margin."""
    result, ends = [], charts.ends[:, 1]
    for start in range(0, len(signs), CHUNK):
        middle, sign = np.array(signs[start : start + CHUNK]).T
        chart = np.minimum(np.searchsorted(ends, middle), len(ends) - 1)
        out, _ = _enclosed(charts, problem, chart, middle, middle)
        good = out[:, problem.signed, LOW] > 0.0
        result += [(float(x), float(s)) for x, s in zip(middle[good], sign[good], strict=True)]
    return result


def _change(signs: list[tuple[float, float]]) -> tuple[float, float] | None:
    """Narrowest interval between neighbours with opposite signs."""
    changes = [(b[0] - a[0], a[0], b[0]) for a, b in pairwise(sorted(signs)) if a[1] != b[1]]
    return min(changes)[1:] if changes else None


def _result(charts: Charts, state: _State, *, undecided: bool) -> PathCertificate:
    pieces = charts.pieces
    status: Status = "undecided" if undecided else "proven"
    reason, bracket = "", _change(state.signs)
    if state.first is not None:
        status, reason, bracket = "refuted", state.first[1], (state.first[0],) * 2
    elif bracket is not None:
        status, reason = "refuted", SINGULAR
    pose: Pose | None = None
    ends: Any = None
    if bracket is not None:
        pose = pieces.pose(0.5 * sum(bracket))
        ends = tuple(pieces.time(np.array(bracket)).tolist())
    return PathCertificate(
        status=status,
        reason=reason,
        bracket=ends,
        counterexample=pose,
        proven=_joined(charts, state.proven),
        violated=_joined(charts, state.violated),
        n_boxes=state.n_boxes,
    )


def _joined(charts: Charts, intervals: list[tuple[float, float]]) -> Array:
    """Return intervals in order, neighbours joined, as times."""
    result: list[list[float]] = []
    for low, high in sorted(intervals):
        if result and result[-1][1] == low:
            result[-1][1] = high
        else:
            result.append([low, high])
    joined = np.array(result).reshape(-1, 2)
    return charts.pieces.time(joined.ravel()).reshape(-1, 2)
