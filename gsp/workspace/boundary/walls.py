"""Walls: boundary curves of one constraint that no turn changes, as an interval of the position.

Any orientation that satisfies the others will do along them. So where another constraint is met,
the platform turns, and the wall goes on; it ends where no orientation is left. Along the curve of a
single leg the turn about it is free.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from gsp.geometry.vectors import Array, norm
from gsp.limits.labels import Active
from gsp.workspace.boundary.critical import FREE_TURN, Chart, Points
from gsp.workspace.boundary.events import constraint_event
from gsp.workspace.boundary.maxima import EXCESS_TOLERANCE, why_not_maximal

# A change per rad [share of the size] that counts as none.
NO_TURN = 1e-9
# Slacks that turns aim at [share of the size], one after the other: near the end of a wall the
# orientations that are left have little.
TURNED_SLACKS = (1e-2, 1e-3, 1e-4, 1e-6, 0.0)
# Steps toward each of these, and the longest of them [rad].
TURN_STEPS, LONGEST_TURN = 12, 0.1
# Slack [share of the size] up to which a constraint may end a wall within the next step.
ENDING_SLACK = 0.02
# Greatest length of the way over a point, per length of the chord, if the point is on it [1].
ON_CHORD = 1.05


@dataclass(frozen=True, eq=False)
class Walls:
    """The walls of a chart.

    Attributes
    ----------
    chart : Chart
    quantities : frozenset of int
        The bounded quantities that no turn changes; none where no turn is free.
    curves : frozenset of Active
        Each side of these alone.
    """

    chart: Chart
    quantities: frozenset[int]
    curves: frozenset[Active]

    @classmethod
    def of(cls, chart: Chart) -> Walls:
        """Return the walls: quantities without a change by turns, at poses in general position."""
        numbers: list[int] = []
        if len(chart.turns):
            place = chart.bounds.scale * np.array([[0.3, -0.7, 1.9], [-1.1, 0.4, 2.3]])
            guess = Points(place, np.tile(np.eye(3), (2, 1, 1)), np.zeros((2, 0)))
            turn = np.zeros((2, chart.freedoms))
            turn[:, len(chart.axes) :] = [[0.9], [-1.7]]
            poses = chart.move(guess, turn)
            gradient = chart.jet(poses.position, poses.rotation).gradient[:, :, 1]
            still = (np.abs(gradient[..., len(chart.axes) :]) <= NO_TURN).all(axis=(0, 2))
            numbers = np.flatnonzero(still).tolist()
        curves = frozenset(((i, side),) for i in numbers for side in (0, 1))
        return cls(chart, frozenset(numbers), curves)

    def any(self, active: Active) -> bool:
        """Whether one of the constraints is a wall."""
        return any(i in self.quantities for i, _ in active)

    def turns_freely(self, point: Points, active: Active) -> bool:
        """Whether some turn changes none of the equations of a curve at a single point.

        On walls, and about the line of a single leg: there positions alone tell what is known.
        """
        if active in self.curves or len(active) > len(self.chart.turns):
            return active in self.curves
        matrix = self.chart.equations(point, active)[1]
        values = np.linalg.svd(matrix, compute_uv=False)[0]
        return bool(values[-1] <= FREE_TURN * values[0])

    def free_along(self, points: Points, active: Active, closed: bool) -> bool:
        """Whether positions along a curve are those of each free turn, as no other bound ends it.

        That is known where it is closed, and where nothing else is limited.
        """
        limited = np.isfinite(self.chart.bounds.low) | np.isfinite(self.chart.bounds.high)
        alone = set(np.flatnonzero(limited).tolist()) <= {i for i, _ in active}
        middle = points[[len(points.position) // 2]]
        return (closed or alone) and self.turns_freely(middle, active)

    def passed(self, points: Points, point: Points) -> bool:
        """Whether the position of a single point is on a line of points, with any turn."""
        pairs = range(len(points.position) - 1)
        return any(self.between(points[[i]], points[[i + 1]], point) for i in pairs)

    def between(self, one: Points, other: Points, point: Points) -> bool:
        """Whether the position of a single point is on the chord of two others."""
        first, last = point.position[0] - one.position[0], other.position[0] - point.position[0]
        chord = float(norm(other.position[0] - one.position[0]))
        return float(norm(first) + norm(last)) < ON_CHORD * chord

    def turned(self, point: Points, active: Active) -> Points | None:
        """Return a point on a wall after a turn that satisfies all constraints, if one is found.

        By steps of Gauss and Newton on those that lack the slack that is aimed at.
        """
        m = len(self.chart.axes)
        for slack in TURNED_SLACKS:
            here = point
            for _ in range(TURN_STEPS):
                jet = self.chart.jet(here.position, here.rotation)
                excess = jet.excess[0].copy()
                excess[active[0]] = -np.inf
                lacking = excess > -slack
                if not (excess > 0.0).any():
                    return here
                pull = jet.gradient[0][lacking][:, m:]
                turn = -np.linalg.pinv(pull, rcond=1e-6) @ (excess[lacking] + slack)
                turn *= min(1.0, LONGEST_TURN / max(float(norm(turn)), 1e-300))
                step = np.concatenate((np.zeros(m), turn, np.zeros(point.weight.shape[1])))
                here = self.chart.move(here, step[None])
        return None

    def end(self, here: Points, active: Active, tangent: Array, step: float) -> Points | None:
        """Return where a wall ends within a step: the farthest point along it.

        There the equations of another curve hold, of those constraints that leave no orientation.
        """
        chart, turns = self.chart, len(self.chart.turns)
        excess = chart.jet(here.position, here.rotation).excess[0]
        near = [(int(i), int(s)) for i, s in np.argwhere(excess > -ENDING_SLACK)]
        others = [one for one in near if one != active[0]]
        for number in range(1, turns + 2):
            for chosen in combinations(others, number):
                end = self._solved(here, active, chosen, tangent, step)
                if end is not None:
                    return Points(end.position, end.rotation, here.weight)
        return None

    def _solved(
        self, here: Points, active: Active, chosen: Active, tangent: Array, step: float
    ) -> Points | None:
        chart, m = self.chart, len(self.chart.axes)
        if len(chosen) > 1 and self.any(chosen):
            return None
        gradient = chart.jet(here.position, here.rotation).of(chosen)[1]
        weight = chart.weights(gradient)[0]
        guess = Points(here.position, here.rotation, weight)
        points, solved, _ = chart.solve(guess, chosen, constraint_event(*active[0]))
        way = tangent[:m] @ chart.axes
        way = way / norm(way)
        advance = float((points.position[0] - here.position[0]) @ way) / chart.bounds.scale
        if not solved[0] or not -EXCESS_TOLERANCE <= advance <= 2.0 * step:
            return None
        space = Chart(chart.bounds, np.eye(3), chart.turns)
        points = points.upright()
        jet = space.jet(points.position, points.rotation)
        why = why_not_maximal(space, points, jet, chosen, way[None], solved)
        return None if why[0] else points
