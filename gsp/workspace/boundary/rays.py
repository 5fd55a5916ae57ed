"""Ray ends: farthest points on rays, solved to rounding and checked."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, Mask, dot, norm
from gsp.limits.labels import Active, label
from gsp.limits.quantities import BoundedQuantities
from gsp.workspace.boundary.climb import WAY_SAMPLE, Interior, climb
from gsp.workspace.boundary.critical import Chart, Extra, Jet, Points
from gsp.workspace.boundary.maxima import VIOLATED, WEIGHT_TOLERANCE, why_not_maximal

# Slack [share of the scale] below which the barrier's end point counts a constraint as active: the
# last barrier weight leaves slacks of about 1e-7 divided by the multiplier.
ACTIVE_SLACK = 3e-4
# How often a bound is added to the active ones of an end that violates others, to solve it again.
BOUNDS_ADDED = 3
# Longest step [share of the scale, rad] along which constraints count as linear.
LINEAR_STEP = 0.1


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
    ends = _Ends.begun(chart, inside)
    ends.solve(range(len(position)), position, direction, count)
    for _ in range(BOUNDS_ADDED):
        ends.solve(ends.widened(), position, direction, count)
    return RayEnds(
        ends.points.position,
        ends.points.rotation,
        dot(ends.points.position - position, direction),
        tuple(ends.active),
        tuple(ends.weights),
        np.array([not why for why in ends.reasons], dtype=bool),
        tuple(ends.reasons),
        bounds,
    )


@dataclass(eq=False)
class _Ends:
    """Ends of climbs that are being solved: N points, their active constraints and multipliers.

    `beyond` are those that violate other bounds.
    """

    chart: Chart
    inside: Interior
    active: list[Active]
    points: Points
    weights: list[Array]
    reasons: list[str]
    beyond: list[int]

    @classmethod
    def begun(cls, chart: Chart, inside: Interior) -> _Ends:
        """Return the ends of climbs as they are."""
        active = _active(inside.slack)
        position, rotation = inside.position.copy(), inside.rotation.copy()
        points = Points(position, rotation, np.zeros((len(position), 0)))
        weights = [np.zeros(len(a)) for a in active]
        return cls(chart, inside, active, points, weights, [""] * len(active), [])

    def solve(
        self,
        rows: Iterable[int],
        origin: Array,
        direction: Array,
        count: Callable[[int], object],
    ) -> None:
        """Solve some ends, those with the same constraints at once."""
        most = len(self.chart.turns) + 1
        alike: dict[Active, list[int]] = {}
        for i in rows:
            held = self.active[i]
            if len(held) > most:
                held = self._supporting(i, direction[[i]])
            if 0 < len(held) <= most:
                alike.setdefault(held, []).append(i)
            self.reasons[i] = self._unsolved(i)
        for held, some in sorted(alike.items()):
            self._polish(held, some, origin[some], direction[some])
            count(0)

    def _unsolved(self, i: int) -> str:
        if not self.inside.converged[i]:
            return "the climb used all of its steps"
        if not self.active[i]:
            return "the climb stopped inside"
        return "the active constraints are not independent"

    def _polish(self, held: Active, rows: list[int], origin: Array, direction: Array) -> None:
        start = self.inside.position[rows], self.inside.rotation[rows]
        guess = Points(*start, np.zeros((len(rows), 0)))
        points, why = polish(self.chart, guess, held, origin, direction)
        for place, i in enumerate(rows):
            if why[place]:
                self.reasons[i] = why[place] if self.inside.converged[i] else self._unsolved(i)
                if why[place] == VIOLATED:
                    self.beyond.append(i)
                continue
            self.reasons[i] = ""
            self.points.position[i] = points.position[place]
            self.points.rotation[i] = points.rotation[place]
            spread = dict(zip(held, points.weight[place], strict=True))
            self.weights[i] = np.array([spread.get(a, 0.0) for a in self.active[i]])

    def widened(self) -> list[int]:
        """Return ends that violate other bounds, with one more active: the nearest to its climb."""
        rows, self.beyond = self.beyond, []
        for i in rows:
            slack = self.inside.slack[i].copy()
            slack[tuple(np.transpose(self.active[i]))] = np.inf
            q, side = np.unravel_index(int(np.argmin(slack)), slack.shape)
            self.active[i] = tuple(sorted((*self.active[i], (int(q), int(side)))))
            self.weights[i] = np.zeros(len(self.active[i]))
        return rows

    def _supporting(self, i: int, direction: Array) -> Active:
        """Return independent constraints, out of too many, that determine the end of a ray.

        Those with multipliers where the distance is the greatest under the constraints, linear in
        the pose about the end of the climb.
        """
        from scipy.optimize import linprog

        active = self.active[i]
        jet = self.chart.jet(self.inside.position[[i]], self.inside.rotation[[i]])
        excess, gradient = jet.of(active)
        system, target = _conditions(gradient, direction)
        # In units of small slacks, as the tolerances of the solver are absolute ones.
        slack, step = -excess[0] / ACTIVE_SLACK, LINEAR_STEP / ACTIVE_SLACK
        found = linprog(-target, system[0].T, slack, bounds=(-step, step), method="highs-ds")
        if found.status:
            return active
        weight = -found.ineqlin.marginals
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


def _active(slack: Array) -> list[Active]:
    """Constraints that hold each of N points at the end of its climb."""
    found: list[list[tuple[int, int]]] = [[] for _ in slack]
    for point, i, side in np.argwhere(slack < ACTIVE_SLACK).tolist():
        found[point].append((i, side))
    return [tuple(active) for active in found]
