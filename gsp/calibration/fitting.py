"""Least squares over dimensions and poses by the method of Levenberg and Marquardt.

All unknowns are damped alike. The poses are eliminated from each step, one after the other, so that
the cost is linear in their number. Of all dimensions that fit alike, the nearest to the nominal
ones are returned.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gsp.calibration.damping import LAST_DAMPING, MOST_STEP, accepted, next_damping
from gsp.calibration.losses import Robust
from gsp.calibration.measurements import Linear, Measurements, State
from gsp.calibration.reduction import LinearProblem, Reduced, Step
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.dimensions import Dimensions

# Steps below it, in sizes and rad, are taken although rounding may hide that they descend; a search
# has converged where they become no shorter.
ROUNDING_STEP = 1e-6


@dataclass(frozen=True, eq=False, kw_only=True)
class Fit:
    """Where a search ended.

    Attributes
    ----------
    state : State
    residuals : (k, m) array [1]
    weights : (k, m) array [1]
    reduced : Reduced
    rank : int
        Number of combinations of all unknowns, poses too, that are determined.
    iterations : int
    converged : bool
    """

    state: State
    residuals: Array
    weights: Array
    reduced: Reduced
    rank: int
    iterations: int
    converged: bool


@dataclass(frozen=True, eq=False, kw_only=True)
class Problem:
    """A fit of dimensions to measurements.

    Attributes
    ----------
    measured : Measurements
    dimensions : Dimensions
    loss : Robust
    """

    measured: Measurements
    dimensions: Dimensions
    loss: Robust

    def cost(self, state: State) -> float:
        """Return the sum of the loss, infinite where a posture is undefined."""
        return self.loss.sum(self.measured.residuals(self.dimensions, state))

    def linear(self, state: State) -> LinearProblem:
        """Return the linear problem at a state."""
        return LinearProblem.of(*self.weighted(state), self.measured.exact)

    def weighted(self, state: State) -> tuple[Linear, Array]:
        """Return the linear problem at a state, and the weights of its residuals."""
        found = self.measured.linear(self.dimensions, state)
        return found, self.loss.weights(found.residuals)

    def moved(self, state: State, step: Step) -> State:
        """Return a state after a step in sizes of the design."""
        values = state.values + step.dimensions * self.dimensions.sizes
        pose = state.pose if step.poses is None else self.turned(state.pose, step.poses)
        return State(values, pose)

    def turned(self, pose: Pose, steps: Array) -> Pose:
        """Return poses after steps (k, 6) in sizes of the design."""
        size = self.dimensions.design.rms_radius
        return pose.moved(steps * np.repeat([size, 1.0], 3))


def best(
    problem: Problem,
    starts: Sequence[State],
    tolerance: float,
    most: int,
    report: Callable[[int, int], object],
) -> Fit:
    """Return the fit of least cost of those from several starts; see `fitted`."""

    def told(before: int) -> Callable[[int, int], object]:
        return lambda done, _: report(before + done, most * len(starts))

    fits = [fitted(problem, s, tolerance, most, told(i * most)) for i, s in enumerate(starts)]
    return min(fits, key=lambda fit: problem.loss.sum(fit.residuals))


def fitted(
    problem: Problem,
    start: State,
    tolerance: float,
    most: int,
    report: Callable[[int, int], object],
) -> Fit:
    """Search the least sum of the loss over dimensions and poses.

    Parameters
    ----------
    problem : Problem
    start : State
        With a defined posture at each pose.
    tolerance : float [1]
        Largest component of the last step, in sizes of the design and in rad.
    most : int
        Number of steps.
    report : function (done, total)
    """
    state, damping, count = start, 0.0, 0
    left, last = np.inf, np.inf
    while count < most and damping <= LAST_DAMPING:
        count += 1
        state, damping, left = _descended(problem, state, damping)
        report(count, most)
        if left <= tolerance or last <= left <= ROUNDING_STEP:
            break
        last = left
    converged = left <= tolerance or (left <= ROUNDING_STEP and count < most)
    if converged:
        state, more = _nearest(problem, state, tolerance, most - count)
        count += more
    found, weights = problem.weighted(state)
    here = LinearProblem.of(found, weights, problem.measured.exact)
    reduced = here.reduced()
    return Fit(
        state=state,
        residuals=found.residuals,
        weights=weights,
        reduced=reduced,
        rank=reduced.rank + (0 if here.blocks is None else here.blocks.rank),
        iterations=count,
        converged=converged,
    )


def _descended(problem: Problem, state: State, damping: float) -> tuple[State, float, float]:
    """Return a state of lower cost, the next damping, and the largest component of a free step.

    The state itself, with a damping beyond the last, where there is none.
    """
    here, cost = problem.linear(state), problem.cost(state)
    free = here.step(0.0)
    if free.largest <= ROUNDING_STEP:
        return problem.moved(state, free), 0.0, free.largest
    while damping <= LAST_DAMPING:
        step = here.step(damping * here.size)
        there, decrease = state, -np.inf
        if step.largest <= MOST_STEP:
            there = problem.moved(state, step)
            decrease = cost - problem.cost(there)
        measures = np.array([decrease, step.predicted, step.largest])
        damping = float(next_damping(np.array(damping), *measures))
        if accepted(*measures):
            return there, damping, free.largest
    return state, damping, np.inf


def _nearest(problem: Problem, state: State, tolerance: float, most: int) -> tuple[State, int]:
    """Return the dimensions nearest to the nominal ones that fit alike, and the number of steps.

    The given state where the steps do not converge.
    """
    now, left = state, np.inf
    for count in range(1, most + 1):
        here = problem.linear(now)
        reduced = here.reduced()
        if reduced.rank == len(reduced.values):
            break
        step = here.with_poses(reduced.step(0.0, now.values / problem.dimensions.sizes))
        now = problem.moved(now, step)
        if not np.isfinite(problem.cost(now)):
            break
        left, last = step.largest, left
        if left <= tolerance or last <= left <= ROUNDING_STEP:
            return now, count
    return state, 0
