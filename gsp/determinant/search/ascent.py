"""Climbing from many states at once: quasi-Newton steps, then Newton steps to rounding."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.determinant.search.charts import Chart
from gsp.geometry.vectors import EPS, Array, dot, norm

# A slope below FLAT_SLOPE ends a climb: log |det J| is then within about FLAT_SLOPE² of its
# maximum.
FLAT_SLOPE = 1e-7
# Steps of a climb, at most.
MOST_CLIMB_STEPS = 100
# Longest step, in units of a chart (a size, a radian).
LONGEST_CLIMB_STEP = 1.0
# Step of the central differences of slopes, in the same units: truncation (its square) and rounding
# (2⁻⁵² over it) then both leave about ten digits of a curvature.
CURVATURE_STEP = 1e-5
# Curvatures below this share of the largest one count as zero: a thousand times their error.
FLAT_CURVATURE = 1e-7
# Newton's method is left where a step is longer: the climb has not ended near a maximum.
LONGEST_POLISH_STEP = 0.1


class Climbed(NamedTuple):
    """Ends of climbs: states (n, k), values (n,) and slopes (n,), and number of evaluations."""

    state: Array
    value: Array
    slope: Array
    evaluations: int


def joined(one: Climbed, other: Climbed) -> Climbed:
    """Return the ends of two groups of climbs as one group."""
    return Climbed(
        np.concatenate((one.state, other.state)),
        np.concatenate((one.value, other.value)),
        np.concatenate((one.slope, other.slope)),
        one.evaluations + other.evaluations,
    )


def climb(chart: Chart, state: Array, steps: int = MOST_CLIMB_STEPS) -> Climbed:
    """Climb from each state with BFGS steps of bounded length, all states at once.

    A step that does not increase the value is undone, and the next one is a quarter as long.
    """
    state = state.copy()
    value, slope = chart.evaluate(state)
    inverse = np.tile(0.1 * np.eye(6), (len(state), 1, 1))
    reach = np.full(len(state), 0.3)
    evaluations = len(state)
    busy = np.flatnonzero(np.isfinite(value))
    for _ in range(steps):
        # A reach of a few units of rounding does not change the state any more.
        busy = busy[(norm(slope[busy]) > FLAT_SLOPE) & (reach[busy] > 16 * EPS)]
        if not busy.size:
            break
        step = _step(inverse[busy], slope[busy], reach[busy])
        moved = chart.move(state[busy], step)
        height, rate = chart.evaluate(moved)
        evaluations += len(busy)
        rose = height > value[busy]
        length = norm(step)
        reach[busy] = np.where(
            rose, np.clip(2.0 * length, reach[busy], LONGEST_CLIMB_STEP), length / 4.0
        )
        up = busy[rose]
        inverse[up] = _updated(inverse[up], step[rose], slope[up] - rate[rose])
        state[up], value[up], slope[up] = moved[rose], height[rose], rate[rose]
    return Climbed(state, value, norm(slope), evaluations)


def _step(inverse: Array, slope: Array, reach: Array) -> Array:
    step = (inverse @ slope[..., None])[..., 0]
    # Rounding can make the approximated curvature indefinite; the slope itself always leads up.
    uphill = dot(step, slope) > 0.0
    step = np.where(uphill[:, None], step, slope)
    return np.asarray(step * np.minimum(1.0, reach / norm(step))[:, None])


def _updated(inverse: Array, step: Array, change: Array) -> Array:
    """BFGS update of inverse curvatures, left out where the curvature is not that of a maximum."""
    curvature = dot(step, change)
    # With a curvature ≤ 0 the update would not be positive definite, and steps could lead down.
    good = curvature > 1e-10 * norm(step) * norm(change)
    weight = np.where(good, 1.0 / np.where(good, curvature, 1.0), 0.0)[:, None, None]
    left = np.eye(6) - weight * step[:, :, None] * change[:, None, :]
    updated = left @ inverse @ np.swapaxes(left, 1, 2)
    updated += weight * step[:, :, None] * step[:, None, :]
    return np.where(good[:, None, None], updated, inverse)


def polish(chart: Chart, state: Array, steps: int = 8) -> Climbed:
    """Take Newton steps from one state (1, k) to the rounding of log |det J|.

    The curvature is the central difference of the slope; where it is not negative in all
    directions (as for a curve of equal maxima), the flat directions are left out.
    """
    value, slope = chart.evaluate(state)
    evaluations = 1
    for _ in range(steps):
        around = chart.move(np.repeat(state, 12, axis=0), CURVATURE_STEP * _both_ways())
        slopes = chart.evaluate(around)[1]
        evaluations += 13
        curvature = (slopes[:6] - slopes[6:]) / (2.0 * CURVATURE_STEP)
        eigenvalues, axes = np.linalg.eigh(-(curvature + curvature.T) / 2.0)
        steep = eigenvalues > FLAT_CURVATURE * max(eigenvalues[-1], 1.0)
        along = np.where(steep, slope[0] @ axes / np.where(steep, eigenvalues, 1.0), 0.0)
        step = (axes @ along)[None]
        if not norm(step)[0] < LONGEST_POLISH_STEP:  # NaN too
            break
        moved = chart.move(state, step)
        height, rate = chart.evaluate(moved)
        # Near a maximum values differ by rounding alone, and the slope decides.
        if height[0] < value[0] - 64 * EPS or norm(rate)[0] >= norm(slope)[0]:
            break
        state, value, slope = moved, height, rate
    return Climbed(state, value, norm(slope), evaluations)


def _both_ways() -> Array:
    return np.concatenate((np.eye(6), -np.eye(6)))
