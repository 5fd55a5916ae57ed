"""Least squares over dimensions and poses: Gauss–Newton steps, damped where they do not descend.

The poses are eliminated from each step, one after the other, so that the cost is linear in their
number. Of all dimensions that fit alike, the nearest to the nominal ones are returned.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gsp.calibration.losses import Robust
from gsp.calibration.measurements import Linear, Measurements, State
from gsp.calibration.reduction import PoseSteps, Reduced, reduced
from gsp.geometry.pose import Pose, unchecked
from gsp.geometry.vectors import Array
from gsp.model.dimensions import Dimensions

# Damping, as a share of the greatest singular value: where it starts after a step that does not
# descend, by which factor it changes, and where the search ends.
FIRST_DAMPING, DAMPING_FACTOR, LAST_DAMPING = 1e-4, 10.0, 1e6
# Steps below it, in sizes and rad, are taken although rounding may hide that they descend; a search
# has converged where they become no shorter.
ROUNDING_STEP = 1e-6
# Halvings of a step of one pose.
HALVINGS = 30


@dataclass(frozen=True, eq=False, kw_only=True)
class Fit:
    """Where a search ended.

    Attributes
    ----------
    state : State
    residuals : (k, m) array [1]
    weights : (k, m) array [1]
    reduced : Reduced
    iterations : int
    converged : bool
    """

    state: State
    residuals: Array
    weights: Array
    reduced: Reduced
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

    def linear(self, state: State) -> tuple[Reduced, PoseSteps | None]:
        """Return one linear step at a state."""
        return reduced(*self.weighted(state), self.measured.exact)

    def weighted(self, state: State) -> tuple[Linear, Array]:
        """Return the linear problem at a state, and the weights of its residuals."""
        found = self.measured.linear(self.dimensions, state)
        return found, self.loss.weights(found.residuals)

    def moved(self, state: State, step: Array, follow: PoseSteps | None) -> State:
        """Return a state after a step (p,) in sizes of the design, with the poses that follow."""
        values = state.values + step * self.dimensions.sizes
        if follow is None:
            return State(values, state.pose)
        return State(values, self.turned(state.pose, follow.step(step)))

    def turned(self, pose: Pose, steps: Array) -> Pose:
        """Return poses after steps (k, 6) in sizes of the design."""
        size = self.dimensions.design.rms_radius
        return pose.moved(steps * np.repeat([size, 1.0], 3))


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
        here, follow = problem.linear(state)
        state, damping, left = _descended(problem, state, here, follow, damping)
        report(count, most)
        if left <= tolerance or last <= left <= ROUNDING_STEP:
            break
        last = left
    converged = left <= tolerance or (left <= ROUNDING_STEP and count < most)
    if converged:
        state, more = _nearest(problem, state, tolerance, most - count)
        count += more
    found, weights = problem.weighted(state)
    return Fit(
        state=state,
        residuals=found.residuals,
        weights=weights,
        reduced=reduced(found, weights, problem.measured.exact)[0],
        iterations=count,
        converged=converged,
    )


def _descended(
    problem: Problem, state: State, here: Reduced, follow: PoseSteps | None, damping: float
) -> tuple[State, float, float]:
    """Return a state of lower cost, the damping, and the largest component of the step to it.

    The state itself, with a damping beyond the last, where there is none.
    """
    cost = problem.cost(state)
    still = np.zeros(len(problem.dimensions))
    step = here.step(0.0, still)
    if _largest(step) <= ROUNDING_STEP:
        return problem.moved(state, step, follow), 0.0, _largest(step)
    while damping <= LAST_DAMPING:
        step = here.step(damping, still)
        there = problem.moved(state, step, follow)
        if problem.cost(there) < cost:
            lower = damping / DAMPING_FACTOR**2
            return there, lower if lower >= FIRST_DAMPING else 0.0, _largest(step)
        damping = max(FIRST_DAMPING, damping * DAMPING_FACTOR)
    return state, damping, np.inf


def _nearest(problem: Problem, state: State, tolerance: float, most: int) -> tuple[State, int]:
    """Return the dimensions nearest to the nominal ones that fit alike, and the number of steps.

    The given state where the steps do not converge.
    """
    now, left = state, np.inf
    for count in range(1, most + 1):
        here, follow = problem.linear(now)
        if here.rank == len(here.values):
            break
        step = here.step(0.0, now.values / problem.dimensions.sizes)
        now = problem.moved(now, step, follow)
        if not np.isfinite(problem.cost(now)):
            break
        left, last = _largest(step), left
        if left <= tolerance or last <= left <= ROUNDING_STEP:
            return now, count
    return state, 0


def _largest(step: Array) -> float:
    return float(np.abs(step).max(initial=0.0))


def settled(problem: Problem, start: State, most: int) -> State:
    """Return the state with poses that fit the nominal dimensions best, each by itself.

    Parameters
    ----------
    problem : Problem
    start : State
    most : int
        Number of steps.
    """
    state = start
    for _ in range(most):
        found = problem.measured.linear(problem.dimensions, state)
        steps = -(np.linalg.pinv(found.by_pose) @ found.residuals[..., None])[..., 0]
        state, moved = _lowered(problem, state, steps, (found.residuals**2).sum(axis=-1))
        if not moved or _largest(steps) <= ROUNDING_STEP:
            break
    return state


def _lowered(problem: Problem, state: State, steps: Array, cost: Array) -> tuple[State, bool]:
    """Return poses after halved steps (k, 6), each with lower squares than `cost` (k,)."""
    pose, waiting = state.pose, np.ones(len(cost), dtype=bool)
    for halving in range(HALVINGS):
        tried = problem.turned(state.pose, steps * 0.5**halving)
        residuals = problem.measured.residuals(problem.dimensions, State(state.values, tried))
        better = waiting & ((residuals**2).sum(axis=-1) < cost)
        pose = unchecked(
            Pose,
            np.where(better[:, None], tried.position, pose.position),
            np.where(better[:, None, None], tried.rotation, pose.rotation),
        )
        waiting &= ~better
        if not waiting.any():
            break
    return State(state.values, pose), not waiting.all()
