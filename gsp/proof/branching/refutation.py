"""A fast search for a counterexample, which boxes alone would find late.

If it finds none, nothing is proven. A counterexample is a pose where a bound is violated by more
than rounding, or two poses where det J has certain and opposite signs.
"""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Problem
from gsp.variation.layout import MID_HIGH, MID_LOW, SIGN_CHANGED, VIOLATED

# How it ended, the quantity that is violated or −1, the point, and the other one of a bracket.
Refuted = tuple[int, int, Array | None, Array | None]

# Points that are spread over the box, and the irrational steps that spread them: powers of the
# root of x⁷ = x + 1.
SPREAD_POINTS = 8192
SPREAD_STEPS = 1.1127756842787055 ** -np.arange(1.0, 7.0)
# Corners of a box: whether each coordinate is at its greatest value.
CORNERS = np.stack(np.meshgrid(*[[False, True]] * 6, indexing="ij"), axis=-1).reshape(-1, 6)
# Points that are improved for each bounded quantity, how often, how many are tried each time, and
# by how much the steps shrink.
CLIMBING_POINTS, CLIMB_ROUNDS, TRIES_PER_ROUND, CLIMB_SHRINK = 24, 24, 12, 0.75


def refute_at_corners(problem: Problem, frame: Array, box: Array) -> tuple[Refuted | None, Array]:
    """Try the corners of a box, (12,); also return a sign of det J and where, or 0, (7,)."""
    points = np.where(CORNERS, box[6:], box[:6])
    found, _, sign = _tried(problem, frame, points, np.zeros(7))
    return found, sign


def refute(problem: Problem, frame: Array, box: Array, sign: Array) -> Refuted | None:
    """Try spread points, and steps from the corners and the best of them.

    Parameters
    ----------
    box : (12,) array
    sign : (7,) array
        A sign of det J that is known, or 0, and where.
    """
    share = np.modf(0.5 + np.arange(1, SPREAD_POINTS)[:, None] * SPREAD_STEPS)[0]
    width = box[6:] - box[:6]
    points = _within(box, box[:6] + np.concatenate((CORNERS, share)) * width)
    found, excess, sign = _tried(problem, frame, points, sign)
    # Always the same seed: a verdict must not change between two runs with the same arguments.
    rng = np.random.default_rng(0)
    for k in range(excess.shape[1]):
        if found is not None:
            return found
        best = np.argsort(-excess[:, k], kind="stable")[:CLIMBING_POINTS]
        here, value, reach = points[best], excess[best, k], 0.2
        for _ in range(CLIMB_ROUNDS):
            steps = reach * width * rng.uniform(-1.0, 1.0, (TRIES_PER_ROUND, len(here), 6))
            tries = _within(box, here + steps)
            found, values, sign = _tried(problem, frame, tries.reshape(-1, 6), sign)
            if found is not None:
                return found
            each = values[:, k].reshape(TRIES_PER_ROUND, -1)
            top, lane = each.argmax(axis=0), np.arange(len(here))
            better = each[top, lane] > value
            here = np.where(better[:, None], tries[top, lane], here)
            value = np.where(better, each[top, lane], value)
            reach *= CLIMB_SHRINK
    return found


def _within(box: Array, points: Array) -> Array:
    return np.clip(points, box[:6], box[6:])


def _tried(
    problem: Problem, frame: Array, points: Array, sign: Array
) -> tuple[Refuted | None, Array, Array]:
    """Evaluate points: what refutes, by how much bounds are exceeded, and a sign with its place.

    The excess is negative where a bound holds: shape (points, 2 · bounded quantities).
    """
    out, signs = enclose(problem, frame, np.concatenate((points, points), axis=1))
    values, chosen = out[:, problem.chosen], problem.chosen
    least, most = problem.bounds[2:, chosen]
    below, above = least - values[:, :, MID_HIGH], values[:, :, MID_LOW] - most
    excess = np.concatenate((below, above), axis=1)
    active = np.concatenate((least > -np.inf, most < np.inf))
    excess = np.where(np.isnan(excess), -np.inf, excess)[:, active]
    names = np.concatenate((chosen, chosen))[active]
    if (excess > 0.0).any():
        i, k = np.argwhere(excess > 0.0)[0]
        return (VIOLATED, int(names[k]), points[i], None), excess, sign
    if problem.signed >= 0:
        certain = np.where(out[:, problem.signed, MID_LOW] > 0.0, signs, 0.0)
        if sign[0] == 0.0 and certain.any():
            i = int(np.flatnonzero(certain)[0])
            sign = np.concatenate(([certain[i]], points[i]))
        other = np.flatnonzero(certain * sign[0] < 0.0)
        if other.size:
            return (SIGN_CHANGED, -1, points[other[0]], sign[1:]), excess, sign
    return None, excess, sign
