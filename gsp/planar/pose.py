"""Planar poses: a position in the plane and an angle."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_type
from gsp.geometry.frames.placements import common_shape
from gsp.geometry.pose import Batched, Pose
from gsp.geometry.pose.poses import check_position
from gsp.geometry.vectors import Array, frozen


@dataclass(frozen=True, eq=False, init=False)
class PlanarPose(Batched):
    """Position and angle of a platform in the plane, for one pose or a batch.

    Parameters
    ----------
    position : (..., 2) array_like [unit of the design]
        The platform origin (x, y) in base axes.
    angle : (...) array_like [rad, or degrees], default 0
        φ, from the x-axis of the base to the x-axis of the platform, counter-clockwise.
    degrees : bool

    Raises
    ------
    InvalidInput
        On shapes that do not broadcast, or numbers that are not finite.

    Examples
    --------
    >>> PlanarPose([[0.0, 0.0], [1.0, 0.0]], 90.0, degrees=True).rotation.round(3)[0, 0]
    array([ 0., -1.])
    """

    ARRAYS = MappingProxyType({"position": 1, "angle": 0})

    position: Array
    angle: Array

    def __init__(
        self, position: ArrayLike, angle: ArrayLike = 0.0, *, degrees: bool = False
    ) -> None:
        p = check_position("pose.position", position, 2)
        turn = check_array("pose.angle", angle, ())
        shape = common_shape("pose", p.shape[:-1], turn.shape)
        radians = np.deg2rad(turn) if arguments.flag("degrees", degrees) else turn
        object.__setattr__(self, "position", frozen(np.broadcast_to(p, (*shape, 2))))
        object.__setattr__(self, "angle", frozen(np.broadcast_to(radians, shape)))

    @property
    def rotation(self) -> Array:
        """R(φ), platform axes to base axes, shape (..., 2, 2) [1].

        *Source: Murray1994, chapter 2: rotations about one axis*
        """
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.stack((np.stack((c, -s), -1), np.stack((s, c), -1)), -2)

    def compose(self, other: PlanarPose) -> PlanarPose:
        """Return the pose of `other` given in the axes of this one.

        Parameters
        ----------
        other : PlanarPose, batch shape (...)
            Its shape and that of this pose broadcast.

        Raises
        ------
        InvalidInput
            If `other` is not a PlanarPose.

        *Source: Murray1994, chapter 2: products of rigid motions*
        """
        check_type("other", other, PlanarPose)
        turned = (self.rotation @ other.position[..., None])[..., 0]
        return PlanarPose(self.position + turned, self.angle + other.angle)

    def inverse(self) -> PlanarPose:
        """Return the pose of the base in the platform.

        *Source: Murray1994, chapter 2: the inverse of a rigid motion*
        """
        back = np.swapaxes(self.rotation, -1, -2)
        return PlanarPose(-(back @ self.position[..., None])[..., 0], -self.angle)

    def spatial(self) -> Pose:
        """Return the same poses in space: z = 0, turned about the z-axis."""
        zero = np.zeros_like(self.angle)
        position = np.concatenate((self.position, zero[..., None]), axis=-1)
        return Pose.from_rpy(position, np.stack((zero, zero, self.angle), axis=-1))

    def __repr__(self) -> str:
        if self.shape:
            return f"PlanarPose(shape={self.shape})"
        return f"PlanarPose(position={self.position.tolist()}, angle={float(self.angle)})"


def distance(move: Array, turn: Array, size: float) -> Array:
    """Return |Δp| / L + |Δφ| of the differences of poses.

    Parameters
    ----------
    move : (..., 2) array [unit of the size]
        Δp.
    turn : (...) array [rad]
        Δφ, of any number of turns.
    size : float
        L.

    Returns
    -------
    (...) array [1]
    """
    return np.asarray(np.hypot(move[..., 0], move[..., 1]) / size + np.abs(wrapped(turn)))


def wrapped(angle: Array) -> Array:
    """Return equal angles in [−π, π) [rad]."""
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)
