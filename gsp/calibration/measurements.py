"""What was measured, and how it differs from what a design at poses predicts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gsp.geometry.frames.screws import exp3_rates, log3
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, skew
from gsp.model.dimensions import Dimensions
from gsp.model.posture import Posture


class State(NamedTuple):
    """Where a fit stands.

    Attributes
    ----------
    values : (p,) array [unit, rad]
        Coordinates of the dimensions.
    pose : Pose of batch shape (k,)
    """

    values: Array
    pose: Pose


class Linear(NamedTuple):
    """Residuals, each over its standard error, and their derivatives.

    Attributes
    ----------
    residuals : (k, m) array [1]
        NaN where a posture is undefined.
    by_pose : (k, m, 6) array [1]
        By steps (v, size · ω) in sizes of the design, as in `Pose.moved`.
    by_dimensions : (k, m, p) array [1]
        By the coordinates of the dimensions in sizes of the design and in rad.
    """

    residuals: Array
    by_pose: Array
    by_dimensions: Array


@dataclass(frozen=True, eq=False, kw_only=True)
class Measurements:
    """Readings of joints at k poses, and what was measured of these poses.

    Attributes
    ----------
    joints : (k, n) array [unit, rad]
        Readings: joint values less zero points.
    joint_errors : (n,) array [unit, rad]
        Standard errors of the readings.
    position : (k, 3) array [unit] or None
        Measured places of `point`, in base axes.
    rotation : (k, 3, 3) array or None
        Measured rotations.
    point : (3,) array [unit]
        In platform axes.
    position_error, rotation_error : float [unit], [rad]
        Standard errors of each coordinate.
    exact : bool
        Whether the poses are known without errors, so that there is nothing to fit of them.
    """

    joints: Array
    joint_errors: Array
    position: Array | None
    rotation: Array | None
    point: Array
    position_error: float
    rotation_error: float
    exact: bool

    def linear(self, dimensions: Dimensions, state: State) -> Linear:
        """Return residuals and derivatives of a state."""
        posture = dimensions.at(state.values).at(state.pose)
        errors = self.joint_errors[:, None]
        steps = np.repeat([dimensions.design.rms_radius, 1.0], 3)
        slopes = dimensions.reading_slopes(posture) * dimensions.sizes
        residuals = self._of_joints(dimensions, state, posture)
        parts = [(residuals, posture.jacobian * steps / errors, slopes / errors)]
        still = np.zeros((len(self.joints), 3, len(dimensions)))
        if not self.exact:
            parts += [(r, by_pose * steps, still) for r, by_pose in self._of_poses(state.pose)]
        joined = zip(*parts, strict=True)
        return Linear(*(np.concatenate(each, axis=1) for each in joined))

    def residuals(self, dimensions: Dimensions, state: State) -> Array:
        """Return the residuals (k, m) of a state."""
        posture = dimensions.at(state.values).at(state.pose)
        parts = [self._of_joints(dimensions, state, posture)]
        if not self.exact:
            parts += [r for r, _ in self._of_poses(state.pose)]
        return np.concatenate(parts, axis=1)

    def _of_joints(self, dimensions: Dimensions, state: State, posture: Posture) -> Array:
        """Return residuals (k, n) of the readings."""
        predicted = posture.joints - dimensions.zero_points(state.values)
        return np.asarray((predicted - self.joints) / self.joint_errors)

    def _of_poses(self, pose: Pose) -> list[tuple[Array, Array]]:
        """Return residuals (k, 3) of positions and of rotations, and derivatives by (v, ω)."""
        found = []
        if self.position is not None:
            arm = pose.rotation @ self.point
            by_shift = np.broadcast_to(np.eye(3), (*arm.shape, 3))
            by_pose = np.concatenate((by_shift, -skew(arm)), axis=-1)
            apart = pose.position + arm - self.position
            found.append((apart / self.position_error, by_pose / self.position_error))
        if self.rotation is not None:
            turn = log3(pose.rotation @ np.swapaxes(self.rotation, -1, -2))
            rates = np.linalg.inv(exp3_rates(turn))
            by_pose = np.concatenate((np.zeros_like(rates), rates), axis=-1)
            found.append((turn / self.rotation_error, by_pose / self.rotation_error))
        return found
