"""Two ways to move through poses: by small twists, or by the coordinates of a box.

A chart holds no state: a state is a row of numbers, and six steps without a unit change it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gsp.determinant.gradient import log_determinant
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import angle_axes
from gsp.geometry.screws import exp3
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design


class Chart(Protocol):
    """What the ascent needs to know of the space that it climbs in."""

    def start(self, n: int, rng: np.random.Generator) -> Array:
        """Return n random states."""

    def move(self, state: Array, step: Array) -> Array:
        """Return the states after steps (n, 6)."""

    def evaluate(self, state: Array) -> tuple[Array, Array]:
        """Return log |det J| (n,) and its slope along the six steps (n, 6)."""

    def pose(self, state: Array) -> Pose:
        """Return the poses of states."""


@dataclass(frozen=True)
class AllPoses:
    """Every pose: a step is a twist, its translation in units of the size of the design."""

    design: Design

    def start(self, n: int, rng: np.random.Generator) -> Array:
        """Return poses of any rotation, half of them with the centres of the anchors near.

        For the other half the two anchors of some leg are near. Near means at most twice a
        length between the sizes of base and platform, for there are maxima at either scale.
        """
        from scipy.spatial.transform import Rotation

        a, b = self.design.base_points, self.design.platform_points
        turns = np.asarray(Rotation.random(n, rng).as_matrix())
        leg = rng.integers(len(a), size=n)
        centres = (rng.random(n) < 0.5)[:, None]
        base, platform = (
            np.where(centres, a.mean(axis=0), a[leg]),
            np.where(centres, b.mean(axis=0), b[leg]),
        )
        away = rng.normal(size=(n, 3))
        away *= (self._lengths(n, rng) * rng.random(n) ** (1 / 3) / norm(away))[:, None]
        position = base + away - (turns @ platform[:, :, None])[..., 0]
        return self.state(Pose(position, turns))

    def _lengths(self, n: int, rng: np.random.Generator) -> Array:
        sides = (self.design.base_points, self.design.platform_points)
        radii = sorted(float(norm(side - side.mean(axis=0)).max()) for side in sides)
        low, high = np.log(max(radii[0], 1e-3 * radii[1])), np.log(radii[1])
        return np.asarray(2.0 * np.exp(low + (high - low) * rng.random(n)))

    def state(self, pose: Pose) -> Array:
        """Return the states of poses."""
        return np.concatenate((pose.position, pose.rotation.reshape(-1, 9)), axis=1)

    def move(self, state: Array, step: Array) -> Array:
        """Return the states after twists."""
        turned = exp3(step[:, 3:]) @ state[:, 3:].reshape(-1, 3, 3)
        moved = state[:, :3] + self.design.size * step[:, :3]
        return np.concatenate((moved, turned.reshape(-1, 9)), axis=1)

    def evaluate(self, state: Array) -> tuple[Array, Array]:
        """Return log |det J| and its slopes."""
        value, gradient = log_determinant(self.design, self.pose(state))
        return value, gradient * np.repeat([self.design.size, 1.0], 3)

    def pose(self, state: Array) -> Pose:
        """Return the poses of states."""
        return Pose(state[:, :3], state[:, 3:].reshape(-1, 3, 3))


@dataclass(frozen=True)
class Box:
    """The poses of a box: coordinates are middle + half-width · sin(state), so none leaves it."""

    design: Design
    box: PoseBox

    def start(self, n: int, rng: np.random.Generator) -> Array:
        """Return states whose coordinates are uniform in the box."""
        return np.arcsin(rng.uniform(-1.0, 1.0, (n, 6)))

    def move(self, state: Array, step: Array) -> Array:
        """Return the states after steps."""
        return state + step

    def evaluate(self, state: Array) -> tuple[Array, Array]:
        """Return log |det J| and its slopes."""
        value, gradient = log_determinant(self.design, self.pose(state))
        half = (self.box.high - self.box.low) / 2.0
        axes = angle_axes(self._coordinates(state)[:, 3:], self.box.order)
        turns = np.einsum("nij,ni->nj", axes, gradient[:, 3:])
        return value, np.concatenate((gradient[:, :3], turns), axis=1) * half * np.cos(state)

    def pose(self, state: Array) -> Pose:
        """Return the poses of states."""
        return self.box.pose(self._coordinates(state))

    def _coordinates(self, state: Array) -> Array:
        middle, half = (self.box.high + self.box.low) / 2.0, (self.box.high - self.box.low) / 2.0
        return middle + half * np.sin(state)
