"""Quantities of `BasicRobotics`: rows of wrenches about the base origin, points of legs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp import catalogue
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, norm
from gsp.published.quantities.common import posture


def space_jacobian(design: str, position: Sequence[float], turn: Sequence[float]) -> Array:
    """Moments about the base origin, then directions of the legs: (n, 6).

    The orientation is a rotation vector `turn` [rad].
    """
    placed, half = catalogue.design(design), np.asarray(turn, dtype=float) / 2.0
    angle = float(norm(half))  # of half the turn
    quaternion = [*(half * np.sinc(angle / np.pi)), np.cos(angle)]
    u = placed.at(Pose.from_quaternion(position, quaternion)).jacobian
    return np.concatenate((cross(placed.base_points, u[:, :3]), u[:, :3]), axis=1)


def point_of_leg(design: str, leg: int, distance: float, position: Sequence[float]) -> Array:
    """Point of a leg, numbered from 1, at a distance from its base anchor: (3,)."""
    placed = posture(design, position)
    foot = placed.design.base_points[leg - 1]
    return np.asarray(foot + distance * placed.jacobian[leg - 1, :3])


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {"space_jacobian": space_jacobian, "point_of_leg": point_of_leg}
)
