"""Quantities that records of any paper may name: joints, Jacobians, indices, stiffness, poses.

With them the numbers of another paper need no code, only its design and its records as text.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp import catalogue, statics
from gsp.errors import InvalidInput, expected
from gsp.evaluation.evaluations import evaluate
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.kinematics import assembly_modes as all_modes
from gsp.kinematics import travel as travelled
from gsp.model.posture import Posture


def posture(
    design: str, position: Sequence[float] | None = None, rpy_deg: Sequence[float] = (0, 0, 0)
) -> Posture:
    """Return a published design at a pose, by default at its home pose."""
    placed = catalogue.design(design)
    if position is not None:
        return placed.at(Pose.from_rpy(position, rpy_deg, degrees=True))
    if placed.home is None:
        raise InvalidInput(expected("design", "one with a home pose", design))
    return placed.at(placed.home)


def joint(
    design: str,
    joint: str,
    position: Sequence[float] | None = None,
    rpy_deg: Sequence[float] = (0, 0, 0),
) -> float:
    """Actuated distance [unit of the design] or angle [deg], by name."""
    placed = posture(design, position, rpy_deg)
    if joint not in placed.joint_names:
        raise InvalidInput(expected("joint", "one of " + ", ".join(placed.joint_names), joint))
    row = placed.joint_names.index(joint)
    value = placed.joints[row]
    return float(np.rad2deg(value) if placed.angular[row] else value)


def jacobian(
    design: str,
    position: Sequence[float] | None = None,
    rpy_deg: Sequence[float] = (0, 0, 0),
    negated: Sequence[int] = (),
) -> Array:
    """Inverse Jacobian, with some rows (numbered from 1) negated."""
    return _negated(posture(design, position, rpy_deg).jacobian, negated)


def homogeneous_jacobian(
    design: str,
    length: float,
    position: Sequence[float] | None = None,
    rpy_deg: Sequence[float] = (0, 0, 0),
    negated: Sequence[int] = (),
) -> Array:
    """Homogeneous inverse Jacobian, with some rows (numbered from 1) negated."""
    return _negated(posture(design, position, rpy_deg).homogeneous(length), negated)


def numbered(what: str, numbers: Sequence[int], most: int) -> list[int]:
    """Return indices from 0 of numbers from 1 to `most`; another number is an error."""
    for number in numbers:
        if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= most:
            raise InvalidInput(expected(what, f"integers from 1 to {most}", repr(number)))
    return [number - 1 for number in numbers]


def _negated(rows: Array, negated: Sequence[int]) -> Array:
    sign = np.ones(len(rows))
    sign[numbered("negated", negated, len(rows))] = -1.0
    return rows * sign[:, None]


def index(
    design: str,
    index: str,
    position: Sequence[float] | None = None,
    rpy_deg: Sequence[float] = (0, 0, 0),
    length: float | None = None,
    maximum: float | None = None,
) -> float:
    """Return a performance index, with the length of the design unless one is given."""
    placed = posture(design, position, rpy_deg)
    table = evaluate(
        placed.design, placed.pose, index, length=length, maximum=maximum, backend="numpy"
    )
    return float(table[index].iloc[0])


def stiffness(
    design: str,
    k: float,
    point: Sequence[float] = (0.0, 0.0, 0.0),
    position: Sequence[float] | None = None,
    rpy_deg: Sequence[float] = (0, 0, 0),
) -> Array:
    """Stiffness matrix about a point of the platform, for equal springs of all actuators."""
    placed = posture(design, position, rpy_deg)
    pose = placed.pose.compose(Pose(point))
    return statics.stiffness(placed.design.with_origin(point), pose, k)


def extensions(
    design: str,
    reference: float | Sequence[float] | None = None,
    scale: float | Sequence[float] = 1.0,
    position: Sequence[float] | None = None,
    rpy_deg: Sequence[float] = (0, 0, 0),
) -> Array:
    """Actuated distances less `reference` (default: at the home pose), times `scale`: (n,)."""
    placed = posture(design, position, rpy_deg)
    start = posture(design).joints if reference is None else np.asarray(reference)
    return np.asarray((placed.joints - start) * np.asarray(scale))


def assembly_modes(design: str, joints: Sequence[float]) -> int:
    """Return the number of real poses with given joint values."""
    return len(all_modes(catalogue.design(design), joints).poses.position)


def travel(design: str, most: Sequence[float]) -> Array:
    """Return how far strokes let a platform move both ways from home, along and about each axis.

    Along x, y and z of the base [unit of the design] and about them [°], each alone, through the
    platform origin, and at most as far as `most` (6,).
    """
    placed = posture(design)
    reached = [
        min(travelled(placed.design, placed.pose, sign * twist).distance for sign in (1.0, -1.0))
        for twist in np.eye(6)
    ]
    return np.minimum(most, np.concatenate((reached[:3], np.rad2deg(reached[3:]))))


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        "joint": joint,
        "jacobian": jacobian,
        "homogeneous_jacobian": homogeneous_jacobian,
        "index": index,
        "stiffness": stiffness,
        "extensions": extensions,
        "assembly_modes": assembly_modes,
        "travel": travel,
    }
)
