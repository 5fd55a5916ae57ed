"""Climbs with gradients: sequential quadratic programming by scipy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, NamedTuple

import numpy as np

from gsp.errors import GspError, expected
from gsp.exploration.optimisation.derivatives import (
    Motion,
    motion_of,
    statistic,
    values_and_slopes,
    why_not_smooth,
)
from gsp.exploration.optimisation.evaluating import Evaluator, parameters_at
from gsp.exploration.optimisation.goals import NO_MERIT, Goals, merit
from gsp.exploration.space import Space
from gsp.exploration.task import Wanted
from gsp.geometry.vectors import Array
from gsp.limits import Limits
from gsp.model.posture import Posture
from gsp.model.posture.slopes import Slopes

# A climb ends where the merit, a logarithm, changes by less.
MERIT_TOLERANCE = 1e-15
MOST_ITERATIONS = 100
# Bounds are kept with a margin, in logarithms and shares of the size: rounding then violates none.
BOUND_MARGIN = 1e-9
# All parts of a task that a climb can satisfy.
STROKES_ONLY = ("strokes",)


class Local(NamedTuple):
    """A design and its surroundings: everything that a climb asks for at one point.

    Attributes
    ----------
    means : (m,) array, mean_slopes : (m, k) array
        Merits of what is wanted, and derivatives along the unit cube; of worst values those at the
        worst pose.
    each : list of (n,) and (n, k) arrays
        Merits at single poses, of the worst values that are wanted.
    margins : (c,) array, margin_slopes : (c, k) array
        ≥ 0 where bounds and strokes hold.
    """

    means: Array
    mean_slopes: Array
    each: list[tuple[Array, Array]]
    margins: Array
    margin_slopes: Array


def why_not_climb(space: Space, goals: Goals) -> str:
    """Return why there is no climb for a task, "" if there is one."""
    reason = why_not_smooth(space, goals.watched)
    if reason:
        return reason
    if goals.certify:
        return expected("certify", "False, as certificates have no gradient", "True")
    limits = goals.task.limits
    if limits is not None:
        given = [f.name for f in fields(Limits) if f.init and f.name not in STROKES_ONLY]
        plain = [name for name in given if getattr(limits, name) not in (None, ())]
        if plain:
            return expected("task.limits", "strokes only, as others have no gradient", plain[0])
        if goals.feasible < 1.0:
            return expected("feasible", "1, as shares have no gradient", goals.feasible)
    return ""


class Climb:
    """The functions of a climb from one start; choices are fixed.

    Parameters
    ----------
    evaluator : Evaluator
    start : (d,) array
        Point of the unit cube.
    """

    def __init__(self, evaluator: Evaluator, start: Array) -> None:
        self.space, self.goals, self.start = evaluator.space, evaluator.goals, start
        self.k = len(self.space.ranges)
        self.widths = np.array([high - low for low, high in self.space.ranges.values()])
        self.pose = self.goals.task.pose()
        self.worst = [i for i, w in enumerate(self.goals.task.wanted) if w.of == "worst"]
        self._at: tuple[bytes, Local] | None = None

    def local(self, z: Array) -> Local:
        """Return what is known at a point; that of the last call is kept."""
        key = z[: self.k].tobytes()
        if self._at is None or self._at[0] != key:
            self._at = key, self._computed(z[: self.k])
        return self._at[1]

    def _computed(self, u: Array) -> Local:
        parameters = parameters_at(self.space, np.concatenate((u, self.start[self.k :])))
        try:
            design = self.space.design(**parameters)
            motion = motion_of(self.space, parameters, design, self.goals.watched)
        except GspError:
            return self._nothing()
        posture = design.at(self.pose)
        found = {
            wish.column: values_and_slopes(wish, self.goals.task, posture, motion.directions)
            for wish in self.goals.watched.wanted
        }
        wanted = self.goals.task.wanted
        pairs = [self._summary(wish, *found[wish.column]) for wish in wanted]
        margins = [*self._bounds(found), *self._strokes(posture, motion)]
        return Local(
            np.array([pair[0] for pair in pairs]),
            np.array([pair[1] for pair in pairs]),
            [self._logs(wanted[i], *found[wanted[i].column]) for i in self.worst],
            np.concatenate([np.empty(0), *(pair[0] for pair in margins)]),
            np.concatenate([np.empty((0, self.k)), *(pair[1] for pair in margins)]),
        )

    def _nothing(self) -> Local:
        """Return what holds where there is no design: a merit below all others."""
        m, n = len(self.goals.task.wanted), self.pose.size
        flat = np.zeros((m, self.k))
        each = [(np.full(n, NO_MERIT), np.zeros((n, self.k))) for _ in self.worst]
        return Local(np.full(m, NO_MERIT), flat, each, np.empty(0), np.empty((0, self.k)))

    def _logs(self, wish: Wanted, values: Array, slopes: Array) -> tuple[Array, Array]:
        """Return merits (n,) and their derivatives along the unit cube (n, k)."""
        sign = 1.0 if wish.better == "higher" else -1.0
        with np.errstate(divide="ignore", invalid="ignore"):
            rates = sign * slopes * self.widths / values[:, None]
        logs = np.array([merit(wish, value) for value in values])
        return logs, np.where(np.isfinite(rates), rates, 0.0)

    def _summary(self, wish: Wanted, values: Array, slopes: Array) -> tuple[float, Array]:
        value, slope = statistic(wish, values, slopes)
        logs, rates = self._logs(wish, np.array([value]), slope[None])
        return float(logs[0]), rates[0]

    def _bounds(self, found: Mapping[str, tuple[Array, Array]]) -> list[tuple[Array, Array]]:
        margins = []
        for wish, bound in self.goals.bounds:
            pair = found[wish.column]
            if wish.of == "worst":
                logs, rates = self._logs(wish, *pair)
            else:
                value, rate = self._summary(wish, *pair)
                logs, rates = np.array([value]), rate[None]
            margins.append((logs - merit(wish, bound) - BOUND_MARGIN, rates))
        return margins

    def _strokes(self, posture: Posture, motion: Motion) -> list[tuple[Array, Array]]:
        """Return the distances of joints from the ends of their strokes, over the size."""
        limits, design = self.goals.task.limits, posture.design
        if limits is None:
            return []
        given = design.strokes if limits.strokes is None else np.asarray(limits.strokes)
        if given is None:
            return []
        size = np.where(design.angular, 1.0, design.rms_radius)
        rates = np.swapaxes(Slopes(posture, motion.directions).joints, -1, -2)
        ends = np.zeros((self.k, *given.shape)) if limits.strokes is not None else motion.strokes
        margins = []
        for end, sign in ((0, 1.0), (1, -1.0)):
            there = ~np.isnan(given[:, end])
            moved = np.zeros((self.k, len(given))) if ends is None else ends[..., end]
            gap = sign * (posture.joints - given[:, end]) / size
            slope = sign * (rates - moved.T) * self.widths / size[:, None]
            margins.append(
                (gap[:, there].ravel() - BOUND_MARGIN, slope[:, there].reshape(-1, self.k))
            )
        return margins


def climbed(evaluator: Evaluator, start: Array) -> Array:
    """Return where a climb from a point (d,) of the unit cube ends, (d,).

    Of worst values the least merit over the poses is a variable of its own, below the merit of each
    pose: the problem is then smooth also where another pose becomes the worst.
    """
    from scipy import optimize

    climb = Climb(evaluator, start)
    shares, k, worst = climb.goals.shares, climb.k, climb.worst
    means = [i for i in range(len(shares)) if i not in worst]

    def negative_merit(z: Array) -> float:
        return -float(shares[means] @ climb.local(z).means[means] + shares[worst] @ z[k:])

    def slope(z: Array) -> Array:
        along = shares[means] @ climb.local(z).mean_slopes[means]
        return -np.concatenate((along, shares[worst]))

    def margins(z: Array) -> Array:
        at = climb.local(z)
        each = [logs - t for (logs, _), t in zip(at.each, z[k:], strict=True)]
        return np.concatenate([at.margins, *each])

    def margin_slopes(z: Array) -> Array:
        at, size = climb.local(z), len(worst)
        blocks = [np.hstack((at.margin_slopes, np.zeros((len(at.margins), size))))]
        for number, (_, rates) in enumerate(at.each):
            blocks.append(np.hstack((rates, np.tile(-np.eye(size)[number], (len(rates), 1)))))
        return np.concatenate(blocks)

    first = climb.local(start)
    z = np.concatenate((start[:k], [logs.min() for logs, _ in first.each]))
    constraint = {"type": "ineq", "fun": margins, "jac": margin_slopes}
    minimize: Any = optimize.minimize
    found = minimize(
        negative_merit,
        z,
        method="SLSQP",
        jac=slope,
        bounds=[(0.0, 1.0)] * k + [(None, None)] * len(worst),
        constraints=[constraint] if margins(z).size else [],
        options={"ftol": MERIT_TOLERANCE, "maxiter": MOST_ITERATIONS},
    )
    return np.concatenate((np.clip(found.x[:k], 0.0, 1.0), start[k:]))
