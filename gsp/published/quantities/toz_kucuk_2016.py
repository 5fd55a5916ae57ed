"""Quantities that `TozKucuk2016` prints."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp.catalogue import design as published_design
from gsp.pose import Pose
from gsp.posture import Posture
from gsp.vectors import Array


def _posture(design: str, position: Sequence[float], rpy_deg: Sequence[float]) -> Posture:
    pose = Pose.from_rpy(position, rpy_deg, degrees=True)
    return published_design(design).at(pose)


def joint(
    design: str, joint: str, position: Sequence[float], rpy_deg: Sequence[float]
) -> ArrayLike:
    """Actuated distance [mm] or angle [deg], by name."""
    posture = _posture(design, position, rpy_deg)
    value = posture.joints[posture.joint_names.index(joint)]
    return float(np.rad2deg(value) if joint.startswith("theta") else value)


def homogeneous_jacobian(
    design: str,
    position: Sequence[float],
    rpy_deg: Sequence[float],
    length: float,
    negated: Sequence[int] = (),
) -> Array:
    """Homogeneous inverse Jacobian, with some rows (numbered from 1) negated."""
    rows = _posture(design, position, rpy_deg).homogeneous(length)
    sign = np.ones(len(rows))
    sign[[row - 1 for row in negated]] = -1.0
    return rows * sign[:, None]


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        "joint": joint,
        "homogeneous_jacobian": homogeneous_jacobian,
    }
)
