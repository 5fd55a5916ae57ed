"""The path of a travel in centred frames, and how far it is searched where no end is given."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from gsp.geometry.copies import ReadOnly
from gsp.geometry.frames import exp3
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.kinematics.newton.centred import Centred

# Default search distance, at the speed of the start, in the same units.
DEFAULT_DISTANCE = 10.0
# Bound of the way of the centre within it, in sizes of the design. Steps are about 0.1 sizes long;
# turns by 10 rad about an origin within 6 sizes of the centre are shorter, whatever the direction.
DEFAULT_WAY = 100.0
# Halvings of the interval in which the default is sought: all digits of a double.
DEFAULT_HALVINGS = 64


@dataclass(frozen=True, eq=False)
class TravelPath(ReadOnly):
    """The motion in centred frames: while the platform turns, its centre moves on a curve.

    Its speed or that of its turn is 1 at the start: the distance counts sizes of the design or rad.

    Attributes
    ----------
    start : Pose of batch shape (1,)
    twist : (6,) array
        (v, ω) of the frame in which the path is straight, per distance.
    arm : (3,) array
        From the origin of that frame to the centre, at the start.
    rate : float
        Distance for each unit of the factor of the direction.
    """

    start: Pose
    twist: Array
    arm: Array
    rate: float

    @classmethod
    def of(cls, design: Centred, start: Pose, direction: Array) -> Self:
        """Return the path of a design along a direction [unit of the design, rad]."""
        size = float(design.frame[0])
        twist = direction / np.repeat([size, 1.0], 3)
        arm = start.rotation @ design.frame[4:] / size
        rate = float(max(norm(twist[:3] + np.cross(twist[3:], arm)), norm(twist[3:])))
        return cls(design.pose_from(start.reshape(1)), twist / rate, arm, rate)

    def pose(self, distance: float) -> Pose:
        """Return the pose at a distance."""
        step = distance * self.twist
        step[:3] += self._arm(distance) - self.arm
        return self.start.moved(step)

    def velocity(self, distance: float) -> Array:
        """Return the velocity (6,) at a distance."""
        v, w = self.twist[:3], self.twist[3:]
        return np.concatenate((v + np.cross(w, self._arm(distance)), w))

    def _arm(self, distance: float) -> Array:
        return np.asarray(exp3(distance * self.twist[3:]) @ self.arm)

    @property
    def default(self) -> float:
        """Greatest distance to search where none is given."""
        least, most = 0.0, DEFAULT_DISTANCE
        if self._way(most) <= DEFAULT_WAY:
            return most
        for _ in range(DEFAULT_HALVINGS):
            middle = 0.5 * (least + most)
            least, most = (middle, most) if self._way(middle) <= DEFAULT_WAY else (least, middle)
        return least

    def _way(self, distance: float) -> float:
        """Return a bound of the length of the curve of the centre up to a distance."""
        turn = float(norm(self.twist[3:]))
        half_turns, rest = divmod(0.5 * turn * distance, np.pi)
        # The integral of |sin| from 0, with 1 − cos written without cancellation.
        sines = 2.0 * half_turns + 2.0 * np.sin(0.5 * rest) ** 2
        across = float(norm(np.cross(self.twist[3:], self.arm))) / turn if turn else 0.0
        return distance * float(norm(self.velocity(0.0)[:3])) + 4.0 * across * float(sines)

    @property
    def curved(self) -> float:
        """Greatest second derivative of the position."""
        return float((self.twist[3:] ** 2).sum() * norm(self.arm))
