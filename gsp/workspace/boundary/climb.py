"""Farthest points on rays, many rays at once, by an interior-point method.

Along u = u0 + r e the distance r is maximised over r and the orientation under the constraints.
The iterates stay strictly feasible, and a step that ends outside of the interior is halved. What
lies between two iterates is not examined: where turns are free, a step may pass a gap that is
narrower than it. With a fixed orientation the way is sampled afterwards (`before_gaps`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gsp.geometry.vectors import Array
from gsp.limits.quantities import BoundedQuantities, moved

# Barrier weights [share of the scale], and Newton steps at each of them.
BARRIERS = tuple(10.0**-p for p in range(1, 8))
STEPS_PER_BARRIER = 6
CLIMB_STEPS = len(BARRIERS) * STEPS_PER_BARRIER
# Halvings of a step until it stays inside.
BACKTRACKS = 12
# Of a Newton step [share of the scale, rad].
LONGEST_BARRIER_STEP = 0.25
# Samples of the way of a ray with a fixed orientation, and halvings of the one that leaves.
WAY_SAMPLES, WAY_HALVINGS = 256, 50
# Fewer rays than this take less time in numpy than compiled code takes to load.
RAYS_FOR_COMPILED = 200


@dataclass(frozen=True, eq=False)
class Interior:
    """Poses that have climbed N rays: position (N, 3), rotation (N, 3, 3), slack (N, m, 2)."""

    position: Array
    rotation: Array
    slack: Array


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
    legs, low, high, turns, direction, barriers, control = (
        np.ascontiguousarray(x, dtype=np.float64)
        for x in (
            np.hstack(bounds.quantities.points),
            bounds.low,
            bounds.high,
            turns,
            direction,
            BARRIERS,
            (STEPS_PER_BARRIER, BACKTRACKS, LONGEST_BARRIER_STEP),
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
    )
    return Interior(position, rotation, slack)


def climb_stacked(
    bounds: BoundedQuantities,
    turns: Array,
    position: Array,
    rotation: Array,
    direction: Array,
    count: Callable[[int], object] = lambda _: None,
) -> Interior:
    """Climb with numpy, all rays at once."""
    for barrier in BARRIERS:
        going = np.arange(len(position))
        for left in reversed(range(STEPS_PER_BARRIER)):
            part = _Rays(bounds, turns, direction[going])
            p, r, decrement = part.step(position[going], rotation[going], barrier)
            position[going], rotation[going] = p, r
            going = going[decrement > 0.1 * barrier]
            count(1 if going.size else 1 + left)
            if not going.size:
                break
    slack, _ = _Rays(bounds, turns, direction).slack(position, rotation)
    return Interior(position, rotation, slack)


def before_gaps(bounds: BoundedQuantities, start: Array, climbed: Interior) -> Interior:
    """Return climbed poses, of rays that turn about no axis, moved back to where they first leave.

    A gap that is narrower than the way over `WAY_SAMPLES` may be missed.

    Parameters
    ----------
    bounds : BoundedQuantities
    start : (N, 3) array
        Feasible positions.
    climbed : Interior
    """
    way = climbed.position - start
    share = np.ones(len(start))
    samples = np.linspace(0.0, 1.0, WAY_SAMPLES + 1)[1:]
    for i, turn in enumerate(climbed.rotation):
        inside = bounds.allowed(start[i] + samples[:, None] * way[i], turn)
        if not inside.all():
            share[i] = samples[np.argmin(inside)]
    left = np.flatnonzero(share < 1.0)
    low, high = share[left] - 1.0 / WAY_SAMPLES, share[left]
    for _ in range(WAY_HALVINGS):
        half = 0.5 * (low + high)
        inside = bounds.allowed(start[left] + half[:, None] * way[left], climbed.rotation[left])
        low, high = np.where(inside, half, low), np.where(inside, high, half)
    position, slack = climbed.position.copy(), climbed.slack.copy()
    position[left] = start[left] + low[:, None] * way[left]
    slack[left] = -bounds.comparable(position[left], climbed.rotation[left])[0]
    return Interior(position, climbed.rotation, slack)


@dataclass(frozen=True, eq=False)
class _Rays:
    bounds: BoundedQuantities
    turns: Array
    direction: Array

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
        step, decrement = _descend(hessian, pull)
        return *self._search(position, rotation, step, slack, barrier, decrement), decrement

    def _second_derivatives(self, position: Array, rotation: Array, net: Array) -> Array:
        """Second derivatives of the weighted quantities, shape (N, 1 + k, 1 + k)."""
        curvature = self.bounds.curvature(position, rotation, net)
        basis = np.zeros((len(net), 1 + len(self.turns), 6))
        basis[:, 0, :3] = self.direction
        basis[:, 1:, 3:] = self.turns
        return np.asarray(basis @ curvature @ np.swapaxes(basis, -1, -2))

    def _search(
        self,
        position: Array,
        rotation: Array,
        step: Array,
        slack: Array,
        barrier: float,
        decrement: Array,
    ) -> tuple[Array, Array]:
        """Shorten steps until they stay inside and lower the barrier function."""
        log = _log(slack)
        factor = np.ones(len(step))
        best_p, best_r = position.copy(), rotation.copy()
        going = np.arange(len(step))
        for _ in range(BACKTRACKS):
            part = _Rays(self.bounds, self.turns, self.direction[going])
            scaled = step[going] * factor[going, None]
            p, r = part.moved(position[going], rotation[going], scaled)
            new, _ = part.slack(p, r)
            inside = (new > 0.0).all(axis=(-2, -1))
            with np.errstate(invalid="ignore", divide="ignore"):
                gain = scaled[:, 0] + barrier * (_log(new) - log[going])
            good = inside & (gain >= 1e-4 * factor[going] * decrement[going] - 1e-15)
            best_p[going[good]], best_r[going[good]] = p[good], r[good]
            factor[going] *= 0.5
            going = going[~good]
            if not going.size:
                break
        return best_p, best_r


def _log(slack: Array) -> Array:
    """Σ log of the slacks that have a bound."""
    return np.asarray(np.log(np.where(np.isinf(slack), 1.0, slack)).sum(axis=(-2, -1)))


def _descend(hessian: Array, gradient: Array) -> tuple[Array, Array]:
    """Newton step with |eigenvalues|, limited in length, and its decrement."""
    value, vector = np.linalg.eigh(hessian)
    value = np.maximum(np.abs(value), 1e-9 * np.abs(value).max(axis=-1, keepdims=True))
    inner = np.einsum("...ij,...i->...j", vector, gradient)
    step = -np.einsum("...ij,...j->...i", vector, inner / value)
    decrement = (inner * inner / value).sum(axis=-1)
    length = np.abs(step).max(axis=-1)
    factor = np.minimum(1.0, LONGEST_BARRIER_STEP / np.maximum(length, 1e-300))
    return step * factor[:, None], decrement
