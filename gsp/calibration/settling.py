"""Poses that fit the nominal dimensions, each by itself: where a fit with unknown poses starts."""

from __future__ import annotations

import numpy as np

from gsp.calibration.damping import LAST_DAMPING, MOST_STEP, accepted, next_damping
from gsp.calibration.fitting import ROUNDING_STEP, Problem
from gsp.calibration.measurements import State
from gsp.calibration.reduction import PoseBlocks, reduction
from gsp.geometry.pose import Pose, unchecked
from gsp.geometry.vectors import Mask


def settled(problem: Problem, start: State, most: int) -> State:
    """Return the state with poses that fit the nominal dimensions best, each by itself.

    Each pose has a damping of its own. The squares count without the loss.

    Parameters
    ----------
    problem : Problem
    start : State
    most : int
        Number of steps.
    """
    state, damping = start, np.zeros(len(start.pose.position))
    for _ in range(most):
        found = problem.measured.linear(problem.dimensions, state)
        blocks = PoseBlocks.of(found.by_pose)
        free = np.abs(blocks.step(found.residuals, 0.0)).max(axis=-1)
        waiting = (free > ROUNDING_STEP) & (damping <= LAST_DAMPING)
        if not waiting.any():
            break
        size = np.linalg.norm(found.by_pose, axis=1).max(axis=-1)
        steps = blocks.step(found.residuals, (damping * size)[:, None])
        steps[~waiting] = 0.0
        largest = np.abs(steps).max(axis=-1)
        steps[largest > MOST_STEP] = 0.0
        tried = State(state.values, problem.turned(state.pose, steps))
        residuals = problem.measured.residuals(problem.dimensions, tried)
        change = (found.by_pose @ steps[..., None])[..., 0]
        measures = (
            (found.residuals**2).sum(axis=-1) - (residuals**2).sum(axis=-1),
            reduction(found.residuals, change),
            largest,
        )
        better = waiting & accepted(*measures)
        damping = np.where(waiting, next_damping(damping, *measures), damping)
        state = State(state.values, _chosen(better, tried.pose, state.pose))
    return state


def _chosen(better: Mask, tried: Pose, pose: Pose) -> Pose:
    """Return the poses that were tried where they are better (k,), else those before."""
    return unchecked(
        Pose,
        np.where(better[:, None], tried.position, pose.position),
        np.where(better[:, None, None], tried.rotation, pose.rotation),
    )
