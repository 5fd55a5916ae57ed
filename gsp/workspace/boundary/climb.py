"""Farthest points on rays, many rays at once, by an interior-point method.

Along u = u0 + r e the distance r is maximised over r and the orientation under the constraints.
The iterates stay strictly inside, so that a ray ends on the branch that its start leads to: no
jump between branches is possible within a step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp.geometry.vectors import Array
from gsp.limits.quantities import Restraints, moved

# Barrier weights, relative to the size of the design, and Newton steps at each.
BARRIERS = tuple(10.0**-p for p in range(1, 8))
STEPS = 6
BACKTRACKS = 12
_REACH = 0.25
# Fewer rays than this are not worth loading compiled code.
MANY = 200


@dataclass(frozen=True, eq=False)
class Interior:
    """Poses that have climbed N rays: position (N, 3), rotation (N, 3, 3), slack (N, m, 2)."""

    position: Array
    rotation: Array
    slack: Array


def climb(
    restraints: Restraints, turns: Array, position: Array, rotation: Array, direction: Array
) -> Interior:
    """Move feasible poses outward along rays until the barrier holds them.

    Parameters
    ----------
    restraints : Restraints
    turns : (k, 3) array
        Axes of the free turns.
    position, rotation : (N, 3) and (N, 3, 3) arrays
        Strictly feasible poses.
    direction : (N, 3) array
        Unit vectors.
    """
    position, rotation = position.copy(), rotation.copy()
    if restraints.quantities.points is not None and len(position) >= MANY:
        return _compiled(restraints, turns, position, rotation, direction)
    return _stacked(restraints, turns, position, rotation, direction)


def _compiled(
    restraints: Restraints, turns: Array, position: Array, rotation: Array, direction: Array
) -> Interior:
    """Climb in compiled code, where all quantities are distances of points."""
    from gsp.kernels.ascent import climb_points

    assert restraints.quantities.points is not None
    base, platform = restraints.quantities.points
    slack = np.empty((len(position), len(base), 2))
    base, platform, low, high, turns, direction, barriers, control = (
        np.ascontiguousarray(x, dtype=np.float64)
        for x in (
            base, platform, restraints.low, restraints.high, turns, direction, BARRIERS,
            (STEPS, BACKTRACKS, _REACH),
        )
    )  # fmt: skip
    climb_points(
        base, platform, low, high, restraints.size, turns, direction, barriers, control,
        position, rotation, slack,
    )  # fmt: skip
    return Interior(position, rotation, slack)


def _stacked(
    restraints: Restraints, turns: Array, position: Array, rotation: Array, direction: Array
) -> Interior:
    """Climb with numpy, all rays at once."""
    for barrier in BARRIERS:
        going = np.arange(len(position))
        for _ in range(STEPS):
            part = _Rays(restraints, turns, direction[going])
            p, r, decrement = part.step(position[going], rotation[going], barrier)
            position[going], rotation[going] = p, r
            going = going[decrement > 0.1 * barrier]
            if not going.size:
                break
    slack, _ = _Rays(restraints, turns, direction).slack(position, rotation)
    return Interior(position, rotation, slack)


@dataclass(frozen=True, eq=False)
class _Rays:
    restraints: Restraints
    turns: Array
    direction: Array

    def slack(self, position: Array, rotation: Array) -> tuple[Array, Array]:
        """Slacks (..., m, 2) ≥ 0 inside, and gradients of the quantities (..., m, 1 + k)."""
        values, rows = self.restraints.evaluate(position, rotation)
        along = (rows[..., :3] @ self.direction[..., None])[..., 0]
        about = rows[..., 3:] @ self.turns.T / self.restraints.size
        gradient = np.concatenate((along[..., None], about), axis=-1)
        return -self.restraints.excess(values) / self.restraints.size, gradient

    def moved(self, position: Array, rotation: Array, step: Array) -> tuple[Array, Array]:
        v = step[..., :1] * self.direction
        twist = np.concatenate((v, step[..., 1:] @ self.turns), axis=-1)
        return moved(position, rotation, twist, self.restraints.size)

    def step(self, position: Array, rotation: Array, barrier: float) -> tuple[Array, Array, Array]:
        """One damped Newton step: new poses, and the Newton decrement before it."""
        slack, gradient = self.slack(position, rotation)
        multiplier = barrier / slack
        pull = np.einsum("...m,...mk->...k", multiplier[..., 1] - multiplier[..., 0], gradient)
        pull[..., 0] -= 1.0
        stiffness = (multiplier / slack).sum(axis=-1)
        hessian = np.einsum("...m,...mi,...mj->...ij", stiffness, gradient, gradient)
        net = multiplier[..., 1] - multiplier[..., 0]
        hessian += self._bend(position, rotation, net)
        step, decrement = _descend(hessian, pull)
        return *self._search(position, rotation, step, slack, barrier, decrement), decrement

    def _bend(self, position: Array, rotation: Array, net: Array) -> Array:
        """Second derivatives of the weighted quantities, shape (N, 1 + k, 1 + k)."""
        size = self.restraints.size
        bend = self.restraints.curvature(position, rotation, net)
        basis = np.zeros((len(net), 1 + len(self.turns), 6))
        basis[:, 0, :3] = size * self.direction
        basis[:, 1:, 3:] = self.turns
        return np.asarray(basis @ bend @ np.swapaxes(basis, -1, -2)) / size

    def _search(
        self, position: Array, rotation: Array, step: Array, slack: Array, barrier: float,
        decrement: Array,
    ) -> tuple[Array, Array]:  # fmt: skip
        """Shorten steps until they stay inside and lower the barrier function."""
        log = _log(slack)
        factor = np.ones(len(step))
        best_p, best_r = position.copy(), rotation.copy()
        going = np.arange(len(step))
        for _ in range(BACKTRACKS):
            part = _Rays(self.restraints, self.turns, self.direction[going])
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
    factor = np.minimum(1.0, _REACH / np.maximum(length, 1e-300))
    return step * factor[:, None], decrement
