"""Tracing: boundary curves by pseudo-arclength continuation, up to their ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations

import numpy as np

from gsp.geometry.vectors import Array, Mask, norm
from gsp.limits.labels import Active
from gsp.workspace.boundary.critical import Chart, Points, between, distance, joined
from gsp.workspace.boundary.events import (
    border_event,
    constraint_event,
    held_still,
    weight_event,
)
from gsp.workspace.boundary.maxima import EXCESS_TOLERANCE, WEIGHT_TOLERANCE, why_not_maximal
from gsp.workspace.boundary.stepping import FIRST_CURVE_STEP, LEAST_CURVE_STEP, longest_step
from gsp.workspace.boundary.walls import ON_CHORD, Walls

# Step along a branch that tests whether it leaves a node [share of the scale, rad].
TRIAL_STEP = 1e-4
# Least cosine between the tangents before and after a step [1].
LEAST_COSINE = 0.97
# Continuation steps per curve; a full turn takes about 80 of the longest per size of its radius.
STEPS_PER_CURVE = 2000
# Poses nearer than this [share of the scale, rad] are the same.
POSE_TOLERANCE = 1e-7


@dataclass(frozen=True, eq=False)
class Node:
    """A point where curves meet, solved to rounding.

    Attributes
    ----------
    points : Points
        One point; its weights are those of the curve that found it.
    active : Active
        All constraints that are at a bound there.
    """

    points: Points
    active: Active

    def same_pose(self, other: Points, size: float) -> bool:
        """Whether another single point is at this pose."""
        return distance(self.points, other, size) < POSE_TOLERANCE


@dataclass(frozen=True, eq=False)
class Tracer:
    """Follows the critical curves of a chart of a plane.

    Attributes
    ----------
    chart : Chart
    faces : (f, 4) array [1, length]
        Planes (*n, c) in base axes beyond which no curve is followed: n · p ≥ c.
    """

    chart: Chart
    faces: Array = field(default_factory=lambda: np.zeros((0, 4)))

    @cached_property
    def walls(self) -> Walls:
        """The constraints that no turn changes."""
        return Walls.of(self.chart)

    def tangent(self, point: Points, active: Active, along: Array | None) -> Array:
        """Return the unit tangent at a single point, in the sense of `along`."""
        tangent = np.asarray(self.chart.tangents(point, active)[0])
        return -tangent if along is not None and tangent @ along < 0.0 else tangent

    def follow(
        self,
        start: Points,
        active: Active,
        along: Array,
        count: Callable[[], object] = lambda: None,
        most: int = STEPS_PER_CURVE,
    ) -> tuple[list[Points], str]:
        """Follow a curve from a point: its points, and how it ended.

        That is "node", or as the status of `Curve`: "closed", "border" at one of `faces`, "lost",
        or "budget" after `most` steps. `count` is called before each step, also before those that
        are repeated with half the length: where a limit on an index is active one takes up to a
        second.
        """
        here, tangent, step = start, self.tangent(start, active, along), FIRST_CURVE_STEP
        found = [start]
        # Where any turn will do, it is another one after a full circle.
        turned = self.walls.turns_freely(start, active)
        for _ in range(min(most, STEPS_PER_CURVE)):
            if step < LEAST_CURVE_STEP:
                return found, "lost"
            count()
            there, ahead, how = self._within(here, tangent, step, active)
            if how == "again":
                step *= 0.5
                continue
            found.append(there)
            if how != "on":
                return found, how
            if len(found) > 3 and self._returned(here, there, start, turned):
                return [*found, start], "closed"
            bend = float(ahead @ tangent)
            here, tangent = there, ahead
            longest = longest_step(self.chart, tangent, active)
            step = min(step * (1.6 if bend > 0.995 else 1.0), longest)
        return found, "budget" if most < STEPS_PER_CURVE else "lost"

    def _within(
        self, here: Points, tangent: Array, step: float, active: Active
    ) -> tuple[Points, Array, str]:
        """Return the end of a step as `_step`, or the point where it meets one of the faces."""
        there, ahead, how = self._step(here, tangent, step, active)
        if how == "again" or not len(self.faces):
            return there, ahead, how
        inner, outer = (
            p.position[0] @ self.faces[:, :3].T - self.faces[:, 3] for p in (here, there)
        )
        worst = int(np.argmin(outer))
        if outer[worst] >= -EXCESS_TOLERANCE * self.chart.bounds.scale:
            return there, ahead, how
        drop = float(inner[worst] - outer[worst])
        share = np.array([np.clip(inner[worst] / drop if drop > 0.0 else 0.0, 0.0, 1.0)])
        guess = between(joined([here, there]), np.zeros(1, dtype=np.intp), share)
        event = border_event(self.chart, self.faces[worst])
        end, solved, jet = self.chart.solve(guess, active, event)
        good = solved[0] and not self._broken(jet.excess[0], active)
        return end, ahead, "border" if good and self._is_near(here, end, step) else "again"

    def _step(
        self, here: Points, tangent: Array, step: float, active: Active
    ) -> tuple[Points, Array, str]:
        """Return the point after a step, the tangent there, and "on", "node" or "again"."""
        chart = self.chart
        guess = chart.move(here, step * tangent)
        there, solved, jet = chart.solve(guess, active, held_still(tangent, chart))
        ahead = self.tangent(there, active, tangent) if solved[0] else tangent
        if not solved[0] or ahead @ tangent < LEAST_COSINE:
            return there, ahead, "again"
        end: Points | None
        if broken := self._broken(jet.excess[0], active):
            if active in self.walls.curves:
                turned = self.walls.turned(there, active)
                if turned is not None:
                    return turned, ahead, "on"
                end = self.walls.end(here, active, tangent, step)
            else:
                end = self._first(here, step * tangent, active, jet.excess[0], broken)
        elif len(active) <= len(chart.turns) and (there.weight < -WEIGHT_TOLERANCE).any():
            end = self._without(here, there, active)
        else:
            return there, ahead, "on"
        return (there, ahead, "again") if end is None else (end, ahead, "node")

    def _is_near(self, here: Points, end: Points, step: float) -> bool:
        """Whether the end of a step is not that of another point."""
        return distance(here, end, self.chart.bounds.scale) <= 4.0 * step

    def _broken(self, excess: Array, active: Active) -> list[tuple[int, int]]:
        return [
            (int(i), int(side))
            for i, side in np.argwhere(excess > EXCESS_TOLERANCE)
            if (int(i), int(side)) not in active
        ]

    def _first(
        self,
        here: Points,
        step: Array,
        active: Active,
        after: Array,
        broken: list[tuple[int, int]],
    ) -> Points | None:
        """Solve for the first of the broken constraints along a step."""
        size, best, nearest = self.chart.bounds.scale, None, np.inf
        before = self.chart.jet(here.position, here.rotation).excess[0]
        for i, side in broken:
            low, high = before[i, side], after[i, side]
            share = float(np.clip(-low / (high - low), 0.0, 1.0))
            guess = self.chart.move(here, share * step)
            end, solved, jet = self.chart.solve(guess, active, constraint_event(i, side))
            far = distance(here, end, size)
            near = bool(solved[0]) and far <= 4.0 * np.linalg.norm(step)
            if not near or self._broken(jet.excess[0], active):
                continue
            if far < nearest:
                best, nearest = end, far
        return best

    def _without(self, here: Points, there: Points, active: Active) -> Points | None:
        """Solve for the point between two where the least weight of the second one is zero."""
        place = int(np.argmin(there.weight[0]))
        one, two = here.weight[0, place], there.weight[0, place]
        share = np.array([np.clip(one / (one - two), 0.0, 1.0)])
        guess = between(joined([here, there]), np.zeros(1, dtype=np.intp), share)
        end, solved, jet = self.chart.solve(guess, active, weight_event(place), second_order=True)
        size = self.chart.bounds.scale
        near = distance(here, end, size) <= 4.0 * distance(here, there, size)
        return end if solved[0] and near and not self._broken(jet.excess[0], active) else None

    def _returned(self, here: Points, there: Points, start: Points, turned: bool) -> bool:
        """Whether the step from here to there passed the start, with any turn where `turned`."""
        if turned:
            return self.walls.between(here, there, start)
        size = self.chart.bounds.scale
        leg = distance(here, there, size)
        return distance(there, start, size) + distance(here, start, size) < ON_CHORD * leg

    def outgoing(
        self, node: Node, *, any_sign: bool = False
    ) -> Iterator[tuple[Active, Points, Array]]:
        """Yield the branches that leave a node: active constraints, first point, direction.

        Those of local maxima; with `any_sign` all that are fixed by their active constraints
        alone and violate no other constraint.
        """
        jet = self.chart.jet(node.points.position, node.points.rotation)
        most = len(self.chart.turns) + 1
        for n in range(most if any_sign else 1, most + 1):
            for active in combinations(node.active, n):
                if n > 1 and self.walls.any(active):
                    continue  # the others have no weight
                weight, defect = self.chart.weights(jet.of(active)[1])
                if defect[0] > WEIGHT_TOLERANCE or (
                    (weight < -WEIGHT_TOLERANCE).any() and not any_sign
                ):
                    continue
                start = Points(node.points.position, node.points.rotation, weight)
                tangent = self.tangent(start, active, None)
                for along in (tangent, -tangent):
                    if self._leaves(start, active, along, any_sign):
                        yield active, start, along

    def goes_on(self, point: Points, active: Active, tangent: Array) -> bool:
        """Whether a curve continues in both directions from a point, so does not end there."""
        return all(self._leaves(point, active, way * tangent, True) for way in (1.0, -1.0))

    def _leaves(self, start: Points, active: Active, along: Array, any_sign: bool) -> bool:
        guess = self.chart.move(start, TRIAL_STEP * along)
        there, solved, jet = self.chart.solve(guess, active, held_still(along, self.chart))
        if active in self.walls.curves and self._broken(jet.excess[0], active):
            turned = self.walls.turned(there, active)
            return turned is not None and bool(self.maximal(turned, active)[0])
        near = distance(start, there, self.chart.bounds.scale) < 4.0 * TRIAL_STEP
        fine = any_sign or bool((there.weight > -WEIGHT_TOLERANCE).all())
        if len(active) <= len(self.chart.turns) and near and not self.maximal(there, active)[0]:
            return False
        return bool(solved[0]) and near and fine and not self._broken(jet.excess[0], active)

    def turning_points(self, points: Points, active: Active) -> list[Points]:
        """Return the points of a curve that its own constraints fix where a weight is zero."""
        if len(active) <= len(self.chart.turns):
            return []
        found = []
        w = points.weight
        for i, place in np.argwhere(w[:-1] * w[1:] < 0.0):
            share = np.array([w[i, place] / (w[i, place] - w[i + 1, place])])
            guess = between(points, np.array([i]), share)
            point, solved, jet = self.chart.solve(
                guess, active, weight_event(int(place)), second_order=True
            )
            if solved[0] and not self._broken(jet.excess[0], active):
                found.append(point.upright())
        return [p for p in found if (p.weight > -WEIGHT_TOLERANCE).all()]

    def held_along(self, points: Points) -> Active:
        """Return the constraints that are at a bound at every one of some points.

        At the end of a curve one more may be, so no single point of a short curve has the answer.
        """
        excess = self.chart.jet(points.position, points.rotation).excess
        held = (np.abs(excess) <= EXCESS_TOLERANCE).all(axis=0)
        return tuple((int(i), int(s)) for i, s in np.argwhere(held))

    def maximal(self, points: Points, active: Active) -> Mask:
        """Which points are local maxima along the normal of the curve, shape (N,)."""
        points = points.upright()
        jet = self.chart.jet(points.position, points.rotation)
        normal = self.chart.normal(points, jet, active)
        length = norm(normal)
        direction = (normal / np.maximum(length, 1e-300)[:, None]) @ self.chart.axes
        space = Chart(self.chart.bounds, np.eye(3), self.chart.turns)
        solved = np.ones(len(length), dtype=bool)
        why = why_not_maximal(
            space, points, space.jet(points.position, points.rotation), active, direction, solved
        )
        return np.array([not text for text in why]) & (length > WEIGHT_TOLERANCE)
