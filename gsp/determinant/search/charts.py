"""Charts of poses with six dimensionless coordinates: all poses, far poses, and two regions.

A chart holds no state: a state is a row of numbers, and six steps change it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gsp.determinant.domain import Neighbourhood, SearchRegion
from gsp.determinant.search.gradient import log_determinant
from gsp.geometry.frames.changes import about_point
from gsp.geometry.frames.screws import exp3, exp3_rates, log3
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import angle_axes
from gsp.geometry.vectors import Array, dot, norm
from gsp.model.design import Design

# Displacement of far poses, in sizes: |det J| is then within about 1 / FAR_SIZES of its limit.
FAR_SIZES = 1e10
# The same where distances from a line of the platform (D2, D4) have moments that grow with the
# displacement, as their feet slide along that line, and lose digits.
FAR_SIZES_WITH_MOMENTS = 1e6
# Factor that lets poses at that displacement pass in spite of rounding.
FAR_ROUNDING = 1.0 + 1e-6
# Share of the random starts that are far away, and their greatest distance in sizes.
SHARE_AWAY, FARTHEST_START = 0.4, 1e3


class Chart(Protocol):
    """The functions of a set of poses that the ascent uses."""

    def start(self, n: int, rng: np.random.Generator) -> Array:
        """Return n random states."""

    def move(self, state: Array, step: Array) -> Array:
        """Return the states after steps (n, 6)."""

    def evaluate(self, state: Array) -> tuple[Array, Array]:
        """Return log |det J| (n,) and its slope along the six steps (n, 6)."""

    def pose(self, state: Array) -> Pose:
        """Return the poses of states."""

    def state(self, pose: Pose) -> Array:
        """Return the states (n, k) of poses (n,)."""


def chart_of(design: Design, region: SearchRegion) -> Chart:
    """Return the chart of a region of poses, or of all poses."""
    if region is None:
        return AllPoses(design)
    return Box(design, region) if isinstance(region, PoseBox) else Near(design, region)


@dataclass(frozen=True)
class AllPoses:
    """Every pose of a design whose frames lie at the centroids of its anchors.

    A step is a twist. Its translation is in units of the size of the design plus the displacement
    of the platform, so that equal steps lead to infinity by equal factors.
    """

    design: Design

    def start(self, n: int, rng: np.random.Generator) -> Array:
        """Return poses of any rotation, half of them with the centres of the anchors near.

        For the other half the two anchors of some leg are near. Near means at most twice a
        length between the sizes of base and platform, for there are maxima at either scale.
        Where |det J| does not tend to zero far away, some of the poses are far.
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
        away *= (self._lengths(n, rng) / norm(away))[:, None]
        position = base + away - (turns @ platform[:, :, None])[..., 0]
        return self.state(Pose(position, turns))

    def _lengths(self, n: int, rng: np.random.Generator) -> Array:
        sides = (self.design.base_points, self.design.platform_points)
        radii = sorted(float(norm(side - side.mean(axis=0)).max()) for side in sides)
        low, high = np.log(max(radii[0], 1e-3 * radii[1])), np.log(radii[1])
        near = 2.0 * np.exp(low + (high - low) * rng.random(n)) * rng.random(n) ** (1 / 3)
        kinds = [row.constraint for row in self.design.rows]
        if all(kind.base == kind.platform == "point" for kind in kinds):
            return np.asarray(near)
        away = self.design.rms_radius * FARTHEST_START ** rng.random(n)
        return np.where(rng.random(n) < SHARE_AWAY, away, near)

    def state(self, pose: Pose) -> Array:
        """Return the states of poses."""
        return np.concatenate((pose.position, pose.rotation.reshape(-1, 9)), axis=1)

    def move(self, state: Array, step: Array) -> Array:
        """Return the states after twists."""
        turned = exp3(step[:, 3:]) @ state[:, 3:].reshape(-1, 3, 3)
        moved = state[:, :3] + self._scale(state) * step[:, :3]
        return np.concatenate((moved, turned.reshape(-1, 9)), axis=1)

    @property
    def farthest(self) -> float:
        """Displacement up to which log |det J| has digits, and at which it is near its limit."""
        kinds = [row.constraint for row in self.design.rows]
        grow = any(kind.quantity == "distance" and kind.platform == "line" for kind in kinds)
        return self.design.rms_radius * (FAR_SIZES_WITH_MOMENTS if grow else FAR_SIZES)

    def evaluate(self, state: Array) -> tuple[Array, Array]:
        """Return log |det J| and its slopes; −inf beyond `farthest`, where rounding decides."""
        value, gradient = log_determinant(self.design, self.pose(state))
        gradient[:, :3] *= self._scale(state)
        beyond = norm(state[:, :3]) > FAR_ROUNDING * self.farthest
        return np.where(beyond, -np.inf, value), gradient

    def pose(self, state: Array) -> Pose:
        """Return the poses of states."""
        return Pose(state[:, :3], state[:, 3:].reshape(-1, 3, 3))

    def _scale(self, state: Array) -> Array:
        return np.asarray((self.design.rms_radius + norm(state[:, :3]))[:, None])


@dataclass(frozen=True)
class FarPoses(AllPoses):
    """Poses at one very large displacement: |det J| there is its limit toward infinity."""

    def project(self, state: Array) -> Array:
        """Return the states with the displacement that far poses have."""
        far = state.copy()
        far[:, :3] *= (self.farthest / norm(state[:, :3]))[:, None]
        return far

    def move(self, state: Array, step: Array) -> Array:
        """Return the states after twists that leave the displacement as it is."""
        return self.project(super().move(state, step))

    def evaluate(self, state: Array) -> tuple[Array, Array]:
        """Return log |det J| and its slopes across the displacement."""
        value, gradient = super().evaluate(state)
        along = state[:, :3] / norm(state[:, :3])[:, None]
        gradient[:, :3] -= dot(gradient[:, :3], along)[:, None] * along
        return value, gradient


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

    def state(self, pose: Pose) -> Array:
        """Return the states of poses of the box; of others, of near ones on its border."""
        values = np.concatenate((pose.position, pose.angles(self.box.order)), axis=-1)
        middle, half = (self.box.high + self.box.low) / 2.0, (self.box.high - self.box.low) / 2.0
        share = (values - middle) / np.where(half > 0.0, half, 1.0)
        return np.arcsin(np.clip(share, -1.0, 1.0))

    def _coordinates(self, state: Array) -> Array:
        middle, half = (self.box.high + self.box.low) / 2.0, (self.box.high - self.box.low) / 2.0
        return middle + half * np.sin(state)


@dataclass(frozen=True)
class Near:
    """The poses of a neighbourhood: two vectors x with |x| ≤ π/2 stand for x sin|x| / |x|.

    These are the displacement and the rotation vector in units of their bounds, so that no pose
    leaves the neighbourhood and the border is reached with a slope of zero.
    """

    design: Design
    region: Neighbourhood

    def start(self, n: int, rng: np.random.Generator) -> Array:
        """Return states of displacements and rotation vectors that are uniform in their balls."""
        ball = rng.normal(size=(2, n, 3))
        share = np.arcsin(rng.random((2, n)) ** (1.0 / 3.0))
        return np.concatenate(ball * (share / norm(ball))[..., None], axis=1)

    def move(self, state: Array, step: Array) -> Array:
        """Return the states after steps, folded back to |x| ≤ π/2."""
        return np.concatenate(
            (_folded(state[:, :3] + step[:, :3]), _folded(state[:, 3:] + step[:, 3:])), axis=1
        )

    def evaluate(self, state: Array) -> tuple[Array, Array]:
        """Return log |det J| and its slopes."""
        value, gradient = log_determinant(self.design, self.pose(state))
        displacement, vector = self._parts(state)
        # The platform origin moves with the centre and turns about it.
        arm = self.pose(state).position - (self.region.centre + displacement)
        torque = about_point(gradient, -arm)[:, 3:]
        turns = np.einsum("nij,ni->nj", exp3_rates(vector), torque)
        pull = np.einsum("nij,ni->nj", _sine_rates(state[:, :3]), gradient[:, :3])
        twist = np.einsum("nij,ni->nj", _sine_rates(state[:, 3:]), turns)
        slope = (self.region.displacement * pull, self.region.angle * twist)
        return value, np.concatenate(slope, axis=1)

    def pose(self, state: Array) -> Pose:
        """Return the poses of states."""
        return self.region.pose(*self._parts(state))

    def state(self, pose: Pose) -> Array:
        """Return the states of poses of the neighbourhood; of others, those of near ones."""
        home, centre = self.region.home, self.region.centre
        turn = pose.rotation @ home.rotation.T
        away = pose.position - centre - turn @ (home.position - centre)
        vector = log3(turn)
        bounds = (self.region.displacement, self.region.angle)
        return np.concatenate(
            [_arcsine(x / most) for x, most in zip((away, vector), bounds, strict=True)], axis=1
        )

    def _parts(self, state: Array) -> tuple[Array, Array]:
        return (
            self.region.displacement * _sine(state[:, :3]),
            self.region.angle * _sine(state[:, 3:]),
        )


def _folded(x: Array) -> Array:
    """Return the vector of at most π/2 that has the same sine."""
    length = norm(x)
    rest = np.remainder(length, 2.0 * np.pi)
    # sin(π − y) = sin y; beyond π the sine changes its sign, and with it the direction.
    sign = np.where(rest > np.pi, -1.0, 1.0)
    rest = np.where(rest > np.pi, 2.0 * np.pi - rest, rest)
    rest = np.minimum(rest, np.pi - rest)
    factor = np.where(length > 0.5 * np.pi, sign * rest / np.where(length > 0.0, length, 1.0), 1.0)
    return np.asarray(x * factor[:, None])


def _sine(x: Array) -> Array:
    return np.asarray(x * np.sinc(norm(x) / np.pi)[:, None])


def _arcsine(x: Array) -> Array:
    length = norm(x)
    safe = np.where(length > 0.0, length, 1.0)
    return np.asarray(x * (np.arcsin(np.minimum(length, 1.0)) / safe)[:, None])


def _sine_rates(x: Array) -> Array:
    """Return the derivatives (n, 3, 3) of x sin|x| / |x|."""
    length = norm(x)
    safe = np.maximum(length, 1e-4)
    # The series of (cos r − sin r / r) / r² where cancellation would lose digits.
    bend = np.where(
        length > 1e-4,
        (np.cos(safe) - np.sin(safe) / safe) / safe**2,
        -1.0 / 3.0,
    )
    square = x[:, :, None] * x[:, None, :]
    return np.asarray(
        np.sinc(length / np.pi)[:, None, None] * np.eye(3) + bend[:, None, None] * square
    )
