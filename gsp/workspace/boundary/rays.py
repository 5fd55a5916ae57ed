"""Ray ends: farthest points on rays, solved to rounding and checked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, Mask, dot, norm
from gsp.limits.labels import Active, label
from gsp.limits.quantities import SECOND_DIFFERENCE_STEP, BoundedQuantities
from gsp.workspace.boundary.climb import WAY_SAMPLE, climb
from gsp.workspace.boundary.critical import Chart, Extra, Jet, Points

# Slack [share of the scale] below which the barrier's end point counts a constraint as active: the
# last barrier weight leaves slacks of about 1e-7 divided by the multiplier.
ACTIVE_SLACK = 3e-4
# How far beyond its bound a quantity may be [share of the scale]: rounding of solved points.
EXCESS_TOLERANCE = 1e-9
# Multipliers of the active constraints, and the outward normal that they add up to, count as zero
# below this [1]; the multipliers have norm one.
WEIGHT_TOLERANCE = 1e-9
# Negative curvature [1] that counts as zero: rounding over the square of `SECOND_DIFFERENCE_STEP`
# is some 2e-8.
CURVATURE_TOLERANCE = 1e-7


@dataclass(frozen=True, eq=False)
class RayEnds(ReadOnly):
    """Local maxima of the distance on N rays, which poses lead to from the radiating point.

    No gap on the way is wider than `WAY_SAMPLE`: see `section`.

    Attributes
    ----------
    position : (N, 3) array [length]
    rotation : (N, 3, 3) array [1]
    distance : (N,) array [length]
        From the radiating point.
    active : tuple of N tuples (quantity, side)
        Constraints that are at their bound; side 0 least, 1 greatest.
    weight : tuple of N arrays of shape (k,) [1]
        Multipliers λ ≥ 0 of the k active constraints, Σ λ² = 1.
    maximal : (N,) bool array
        Whether the end is a local maximum up to rounding: the equations are solved, no other
        constraint is violated, no multiplier is negative, and the second-order condition holds.
        The checks are made in floating-point numbers. They prove nothing, and no farther point is
        excluded: `gsp.workspace.reachable` and `fixed_orientation` prove what is outside.
    reason : tuple of N str
        Which check failed, "" where maximal.
    bounds : BoundedQuantities
    """

    position: Array
    rotation: Array
    distance: Array
    active: tuple[Active, ...]
    weight: tuple[Array, ...]
    maximal: Mask
    reason: tuple[str, ...]
    bounds: BoundedQuantities

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels in the notation of the source."""
        return tuple(label(a, self.bounds.names, self.bounds.joints) for a in self.active)

    def seed(self, i: int) -> tuple[Points, Active]:
        """Return one end as a point, with the active constraints that have a multiplier.

        Parameters
        ----------
        i : int
            Which ray, from 0.
        """
        used = self.weight[i] != 0.0
        active = tuple(a for a, w in zip(self.active[i], used, strict=True) if w)
        return Points(self.position[[i]], self.rotation[[i]], self.weight[i][None, used]), active

    @classmethod
    def joined(cls, parts: Sequence[RayEnds]) -> RayEnds:
        """Return the ends of several records as one.

        Parameters
        ----------
        parts : sequence of RayEnds
            One or more.
        """
        return cls(
            np.concatenate([ends.position for ends in parts]),
            np.concatenate([ends.rotation for ends in parts]),
            np.concatenate([ends.distance for ends in parts]),
            tuple(chain.from_iterable(ends.active for ends in parts)),
            tuple(chain.from_iterable(ends.weight for ends in parts)),
            np.concatenate([ends.maximal for ends in parts]),
            tuple(chain.from_iterable(ends.reason for ends in parts)),
            parts[0].bounds,
        )


def ray_ends(
    bounds: BoundedQuantities,
    turns: Array,
    position: Array,
    rotation: Array,
    direction: Array,
    count: Callable[[int], object] = lambda _: None,
) -> RayEnds:
    """Return the ends of N rays from strictly feasible poses, solved and checked.

    Parameters
    ----------
    bounds : BoundedQuantities
    turns : (k, 3) array
        Axes of the free turns, in base axes.
    position, rotation, direction : (N, 3), (N, 3, 3), (N, 3) arrays
    count : function (int)
        Called with the number of steps, `CLIMB_STEPS` in all, and with 0 while ends are solved.
    """
    inside = climb(bounds, turns, position, rotation, direction, count)
    chart = Chart(bounds, np.eye(3), turns)
    sets = _active(inside.slack)
    out_p, out_r = inside.position.copy(), inside.rotation.copy()
    weights: list[Array] = [np.zeros(len(a)) for a in sets]
    reasons = [
        "the active constraints are not independent" if a else "the climb stopped inside"
        for a in sets
    ]
    full = list(sets)
    for i, active in enumerate(sets):
        if len(active) > len(turns) + 1:
            pose = (inside.position[[i]], inside.rotation[[i]])
            sets[i] = _supporting(chart, *pose, active, direction[[i]])
    alike: dict[Active, list[int]] = {}
    for i, active in enumerate(sets):
        alike.setdefault(active, []).append(i)
    for active, rows in sorted(alike.items()):
        if not 0 < len(active) <= len(turns) + 1:
            continue
        guess = Points(inside.position[rows], inside.rotation[rows], np.zeros((len(rows), 0)))
        points, why = polish(chart, guess, active, position[rows], direction[rows])
        count(0)
        for place, row in enumerate(rows):
            reasons[row] = why[place]
            if not why[place]:
                out_p[row], out_r[row] = points.position[place], points.rotation[place]
                spread = dict(zip(active, points.weight[place], strict=True))
                weights[row] = np.array([spread.get(a, 0.0) for a in full[row]])
    for i in np.flatnonzero(~inside.converged).tolist():
        if reasons[i]:
            reasons[i] = "the climb used all of its steps"
    return RayEnds(
        out_p,
        out_r,
        dot(out_p - position, direction),
        tuple(full),
        tuple(weights),
        np.array([not why for why in reasons], dtype=bool),
        tuple(reasons),
        bounds,
    )


def _supporting(
    chart: Chart, position: Array, rotation: Array, active: Active, direction: Array
) -> Active:
    """Return independent constraints, out of too many active ones, that determine the ray's end."""
    from scipy.optimize import nnls

    gradient = chart.jet(position, rotation).of(active)[1]
    system, target = _conditions(gradient, direction)
    weight, _ = nnls(system[0], target)
    return tuple(a for a, w in zip(active, weight, strict=True) if w > WEIGHT_TOLERANCE)


def polish(
    chart: Chart, guess: Points, active: Active, origin: Array, direction: Array
) -> tuple[Points, list[str]]:
    """Solve points on rays to rounding, and return the check that each one fails, or ""."""
    jet = chart.jet(guess.position, guess.rotation)
    weight = ray_weights(jet.of(active)[1], direction)
    start = Points(guess.position, guess.rotation, weight)
    points, solved, jet = chart.solve(start, active, on_ray(chart, origin, direction))
    # Farther from the end of the climb it may be another point, beyond a gap.
    near = norm(points.position - guess.position) < WAY_SAMPLE * chart.bounds.scale
    return points, why_not_maximal(chart, points, jet, active, direction, solved & near)


def ray_weights(gradient: Array, direction: Array) -> Array:
    """λ that best satisfies the ray's conditions Σ λ ∂g = (1 along the ray, 0 for turns)."""
    system, target = _conditions(gradient, direction)
    weight = np.linalg.pinv(system) @ target
    return weight / np.maximum(norm(weight), 1e-300)[..., None]


def _conditions(gradient: Array, direction: Array) -> tuple[Array, Array]:
    along = (gradient[..., :3] @ direction[..., None])[..., 0]
    system = np.concatenate((along[..., None, :], np.swapaxes(gradient[..., 3:], -1, -2)), axis=-2)
    target = np.zeros(system.shape[-2])
    target[0] = 1.0
    return system, target


def on_ray(chart: Chart, origin: Array, direction: Array) -> Extra:
    """Two equations that hold a point on its ray."""
    across = np.linalg.svd(direction[:, None, :])[2][:, 1:]

    def equations(points: Points, jet: Jet) -> tuple[Array, Array]:
        offset = (points.position - origin) / chart.bounds.scale
        gradient = np.zeros((len(offset), 2, chart.freedoms + points.weight.shape[1]))
        gradient[:, :, :3] = across
        return (across @ offset[..., None])[..., 0], gradient

    return equations


def why_not_maximal(
    chart: Chart, points: Points, jet: Jet, active: Active, direction: Array, solved: Mask
) -> list[str]:
    """Return the reason why a point is not a local maximum along its ray, "" where it is one."""
    points = points.upright()
    outward = dot(chart.normal(points, jet, active), direction)
    with np.errstate(invalid="ignore"):
        checks = (
            (solved, "the end could not be solved to rounding"),
            ((jet.excess <= EXCESS_TOLERANCE).all(axis=(1, 2)), "another constraint is violated"),
            ((points.weight >= -WEIGHT_TOLERANCE).all(axis=1), "a multiplier is negative"),
            (outward > WEIGHT_TOLERANCE, "the ray does not leave there"),
            (second_order(chart, points, active, direction), "the second-order condition fails"),
        )
    reasons = np.full(len(points.position), "", dtype=object)
    for ok, text in reversed(checks):
        reasons[~np.asarray(ok)] = text
    return list(reasons)


def second_order(chart: Chart, points: Points, active: Active, direction: Array) -> Mask:
    """Whether Σ λ g bends outward on all moves that keep the active constraints, along the ray."""
    k = len(chart.turns)
    number = len(points.position)
    if len(active) >= k + 1:
        return np.ones(number, dtype=bool)
    gradient = chart.jet(points.position, points.rotation).of(active)[1]
    along = (gradient[..., :3] @ direction[..., None])[..., 0]
    line = np.concatenate((along[..., None], gradient[..., 3:]), axis=-1)
    n = len(active)
    free = np.linalg.svd(line)[2][:, n:]
    second = _second_derivatives(chart, points, active, direction)
    reduced = free @ second @ np.swapaxes(free, -1, -2)
    curvature = np.linalg.eigvalsh(0.5 * (reduced + np.swapaxes(reduced, -1, -2)))
    return np.asarray(curvature[:, 0] > -CURVATURE_TOLERANCE)


def _second_derivatives(chart: Chart, points: Points, active: Active, direction: Array) -> Array:
    """Second derivatives of Σ λ g over (r, turns), shape (N, 1 + k, 1 + k)."""
    k, n = len(chart.turns), len(active)
    step = SECOND_DIFFERENCE_STEP
    index = [i for i, _ in active], [side for _, side in active]
    moves = np.zeros((1 + k, len(direction), chart.freedoms + n))
    moves[0, :, :3] = direction
    moves[np.arange(1, 1 + k), :, 3 + np.arange(k)] = 1.0

    def total(move: Array) -> Array:
        there = chart.move(points, move)
        jet = chart.jet(there.position, there.rotation)
        g = jet.excess[..., index[0], index[1]]
        return np.asarray((g * points.weight).sum(axis=-1))

    here = total(np.zeros_like(moves[0]))
    second = np.empty((len(direction), 1 + k, 1 + k))
    for i in range(1 + k):
        for j in range(i, 1 + k):
            plus, minus = step * (moves[i] + moves[j]), step * (moves[i] - moves[j])
            if i == j:
                value = (total(plus / 2) + total(-plus / 2) - 2 * here) / step**2
            else:
                value = (total(plus) + total(-plus) - total(minus) - total(-minus)) / (4 * step**2)
            second[:, i, j] = second[:, j, i] = value
    return second


def _active(slack: Array) -> list[Active]:
    """Constraints that hold each of N points at the end of its climb."""
    found: list[list[tuple[int, int]]] = [[] for _ in slack]
    for point, i, side in np.argwhere(slack < ACTIVE_SLACK).tolist():
        found[point].append((i, side))
    return [tuple(active) for active in found]
