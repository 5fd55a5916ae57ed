"""Farthest points on rays, many rays at once, by an interior-point method.

Along u = u0 + r e the distance r is maximised over r and the orientation under the constraints.
The iterates stay strictly feasible. A step that ends outside of the interior is halved, and so is
one that leaves it on its way, which is sampled. So poses lead from the start to the end of a ray
without a gap that is wider than `WAY_SAMPLE`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.geometry.vectors import Array, Mask, dot
from gsp.limits.quantities import BoundedQuantities, moved

# Barrier weights [share of the scale], and the most Newton steps at each of them. A climb that goes
# on from a weight before its maximum follows a curved bound with slacks that allow no step: with 20
# steps half of the rays of some designs did.
BARRIERS = tuple(10.0**-p for p in range(1, 8))
BARRIER_STEPS = (60,) * len(BARRIERS)
CLIMB_STEPS = sum(BARRIER_STEPS)
# Halvings of a step until it stays inside.
BACKTRACKS = 12
# Of a Newton step [share of the scale, rad]; along the ray, a share of the distance from its start
# if that is more.
LONGEST_BARRIER_STEP, LONGEST_SHARE_OF_WAY = 0.25, 0.5
# Between samples of the way of a step [share of the scale, rad]; along the ray, a share of the
# distance from its start if that is more.
WAY_SAMPLE = 1.0 / 128.0
# Decrement at which a climb is at the maximum of a barrier function [share of the barrier weight].
CONVERGED_DECREMENT = 0.1
# Fewer rays than this take less time in numpy than compiled code takes to load.
RAYS_FOR_COMPILED = 200


@dataclass(frozen=True, eq=False)
class Interior:
    """Poses that have climbed N rays: position (N, 3), rotation (N, 3, 3), slack (N, m, 2).

    `converged` (N,) is False where the steps were used up before the maximum.
    """

    position: Array
    rotation: Array
    slack: Array
    converged: Mask


def climb(
    bounds: BoundedQuantities,
    turns: Array,
    position: Array,
    rotation: Array,
    direction: Array,
    count: Callable[[int], object] = lambda _: None,
) -> Interior:
    """Move feasible poses outward along rays to the maximum of the barrier function.

    Parameters
    ----------
    bounds : BoundedQuantities
    turns : (k, 3) array
        Axes of the free turns.
    position, rotation : (N, 3) and (N, 3, 3) arrays
        Strictly feasible poses.
    direction : (N, 3) array
        Unit vectors.
    count : function (int)
        Called with the number of Newton steps after each of them, `CLIMB_STEPS` in all.
    """
    position, rotation = position.copy(), rotation.copy()
    if bounds.quantities.points is not None and len(position) >= RAYS_FOR_COMPILED:
        inside = climb_compiled(bounds, turns, position, rotation, direction)
        count(CLIMB_STEPS)
        return inside
    return climb_stacked(bounds, turns, position, rotation, direction, count)


def climb_compiled(
    bounds: BoundedQuantities, turns: Array, position: Array, rotation: Array, direction: Array
) -> Interior:
    """Climb in compiled code, where all quantities are distances of points."""
    from gsp.kernels.compiled.ascent import climb_points

    assert bounds.quantities.points is not None
    slack = np.empty((len(position), len(bounds.low), 2))
    converged = np.empty(len(position), dtype=bool)
    legs, low, high, turns, direction, barriers, control = (
        np.ascontiguousarray(x, dtype=np.float64)
        for x in (
            np.hstack(bounds.quantities.points),
            bounds.low,
            bounds.high,
            turns,
            direction,
            np.stack((BARRIERS, BARRIER_STEPS), axis=1),
            (
                BACKTRACKS,
                LONGEST_BARRIER_STEP,
                LONGEST_SHARE_OF_WAY,
                WAY_SAMPLE,
                CONVERGED_DECREMENT,
            ),
        )
    )
    climb_points(
        legs,
        low,
        high,
        bounds.scale,
        turns,
        direction,
        barriers,
        control,
        position,
        rotation.reshape(-1, 9),
        slack,
        converged,
    )
    return Interior(position, rotation, slack, converged)


def climb_stacked(
    bounds: BoundedQuantities,
    turns: Array,
    position: Array,
    rotation: Array,
    direction: Array,
    count: Callable[[int], object] = lambda _: None,
) -> Interior:
    """Climb with numpy, all rays at once."""
    rays = _Rays(bounds, turns, direction, position.copy())
    for barrier, steps in zip(BARRIERS, BARRIER_STEPS, strict=True):
        going = np.arange(len(position))
        for left in reversed(range(steps)):
            part = rays[going]
            p, r, decrement = part.step(position[going], rotation[going], barrier)
            moves = (p != position[going]).any(axis=1) | (r != rotation[going]).any(axis=(1, 2))
            position[going], rotation[going] = p, r
            going = going[moves & (decrement > CONVERGED_DECREMENT * barrier)]
            count(1 if going.size else 1 + left)
            if not going.size:
                break
    slack = rays.slacks(position, rotation)
    return Interior(position, rotation, slack, ~np.isin(np.arange(len(position)), going))


@dataclass(frozen=True, eq=False)
class _Rays:
    bounds: BoundedQuantities
    turns: Array
    direction: Array
    start: Array

    def __getitem__(self, rays: Any) -> _Rays:
        return _Rays(self.bounds, self.turns, self.direction[rays], self.start[rays])

    def way(self, position: Array) -> Array:
        """Distances (N,) from the starts of the rays [share of the scale]."""
        return np.asarray(dot(position - self.start, self.direction) / self.bounds.scale)

    def slacks(self, position: Array, rotation: Array) -> Array:
        """Slacks (..., m, 2) ≥ 0 inside."""
        values = self.bounds.quantities.values(position, rotation)
        return -self.bounds.excess(values) / self.bounds.sizes[:, None]

    def slack(self, position: Array, rotation: Array) -> tuple[Array, Array]:
        """Slacks (..., m, 2) ≥ 0 inside, and gradients of the quantities (..., m, 1 + k)."""
        excess, rows = self.bounds.comparable(position, rotation)
        along = (rows[..., :3] @ self.direction[..., None])[..., 0]
        gradient = np.concatenate((along[..., None], rows[..., 3:] @ self.turns.T), axis=-1)
        return -excess, gradient

    def moved(self, position: Array, rotation: Array, step: Array) -> tuple[Array, Array]:
        v = step[..., :1] * self.direction
        twist = np.concatenate((v, step[..., 1:] @ self.turns), axis=-1)
        return moved(position, rotation, twist, self.bounds.scale)

    def step(self, position: Array, rotation: Array, barrier: float) -> tuple[Array, Array, Array]:
        """One damped Newton step: new poses, and the Newton decrement before it."""
        slack, gradient = self.slack(position, rotation)
        multiplier = barrier / slack
        pull = np.einsum("...m,...mk->...k", multiplier[..., 1] - multiplier[..., 0], gradient)
        pull[..., 0] -= 1.0
        stiffness = (multiplier / slack).sum(axis=-1)
        hessian = np.einsum("...m,...mi,...mj->...ij", stiffness, gradient, gradient)
        net = multiplier[..., 1] - multiplier[..., 0]
        hessian += self._second_derivatives(position, rotation, net)
        longest = np.maximum(LONGEST_BARRIER_STEP, LONGEST_SHARE_OF_WAY * self.way(position))
        step, decrement = _descend(hessian, pull, longest)
        slope = -(step * pull).sum(axis=-1)
        return *self._search(position, rotation, step, slack, barrier, slope), decrement

    def _second_derivatives(self, position: Array, rotation: Array, net: Array) -> Array:
        """Second derivatives of the weighted quantities, shape (N, 1 + k, 1 + k)."""
        bend = self.bounds.curvature(position, rotation, net)
        return ray_curvature(bend, self.direction, self.turns)

    def _search(
        self,
        position: Array,
        rotation: Array,
        step: Array,
        slack: Array,
        barrier: float,
        slope: Array,
    ) -> tuple[Array, Array]:
        """Shorten steps until their ways stay inside and they lower the barrier function."""
        log = _log(slack)
        factor = np.ones(len(step))
        best_p, best_r = position.copy(), rotation.copy()
        going = np.arange(len(step))
        for _ in range(BACKTRACKS):
            part = self[going]
            scaled = step[going] * factor[going, None]
            p, r = part.moved(position[going], rotation[going], scaled)
            new = part.slacks(p, r)
            inside = (new > 0.0).all(axis=(-2, -1))
            with np.errstate(invalid="ignore", divide="ignore"):
                gain = scaled[:, 0] + barrier * (_log(new) - log[going])
            good = inside & (gain >= 1e-4 * factor[going] * slope[going] - 1e-15)
            some = going[good]
            good[good] = self[some].stays(position[some], rotation[some], scaled[good])
            best_p[going[good]], best_r[going[good]] = p[good], r[good]
            factor[going] *= 0.5
            going = going[~good]
            if not going.size:
                break
        return best_p, best_r

    def stays(self, position: Array, rotation: Array, step: Array) -> Mask:
        """Whether the samples of the ways of steps are inside, (N,)."""
        long = step / WAY_SAMPLE
        long[:, 0] /= np.maximum(1.0, self.way(position))
        number = np.ceil(np.abs(long).max(axis=1, initial=0.0)).astype(int)
        inner = np.maximum(number - 1, 0)
        ray = np.repeat(np.arange(len(step)), inner)
        place = np.arange(len(ray)) - np.repeat(np.cumsum(inner) - inner, inner) + 1
        share = place / number[ray]
        p, r = self[ray].moved(position[ray], rotation[ray], share[:, None] * step[ray])
        result = np.ones(len(step), dtype=bool)
        result[ray[~self.bounds.allowed(p, r)]] = False
        return result


def ray_curvature(curvature: Array, direction: Array, turns: Array) -> Array:
    """Restrict second derivatives (N, 6, 6) to the ways along rays and k turns."""
    basis = np.zeros((len(direction), 1 + len(turns), 6))
    basis[:, 0, :3] = direction
    basis[:, 1:, 3:] = turns
    return np.asarray(basis @ curvature @ np.swapaxes(basis, -1, -2))


def _log(slack: Array) -> Array:
    """Σ log of the slacks that have a bound."""
    return np.asarray(np.log(np.where(np.isinf(slack), 1.0, slack)).sum(axis=(-2, -1)))


def _descend(hessian: Array, gradient: Array, longest: Array) -> tuple[Array, Array]:
    """Newton step with |eigenvalues|, limited in length, and its decrement.

    `longest` (N,) is the greatest length along the rays.
    """
    value, vector = np.linalg.eigh(hessian)
    value = np.maximum(np.abs(value), 1e-9 * np.abs(value).max(axis=-1, keepdims=True))
    inner = np.einsum("...ij,...i->...j", vector, gradient)
    step = -np.einsum("...ij,...j->...i", vector, inner / value)
    decrement = (inner * inner / value).sum(axis=-1)
    limit = np.full(step.shape, LONGEST_BARRIER_STEP)
    limit[..., 0] = longest
    length = (np.abs(step) / limit).max(axis=-1)
    return step / np.maximum(1.0, length)[:, None], decrement
