"""Limits of the actuated joints in exported models: strokes, greatest forces and speeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import LARGEST_NUMBER, bounded_array
from gsp.bridges.links.motions import Motion
from gsp.checks import is_a
from gsp.errors import InvalidInput, apart, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.limits.legs import crank_bounds
from gsp.model.design import Design
from gsp.model.design.checks import open_strokes


@dataclass(frozen=True, init=False, eq=False)
class Drives:
    """Greatest forces and speeds of the actuators.

    Parameters
    ----------
    efforts : float, (n,) array_like or None [N, or N m for A1 actuators and cranks]
        Greatest force or torque; one number is that of each actuator. None: no limit.
    speeds : float, (n,) array_like or None [m/s, or rad/s for A1 actuators and cranks]
        Greatest speed; None: no limit.

    Raises
    ------
    InvalidInput
        If a number is not positive, below 1e-100 or beyond 1e100.

    Examples
    --------
    >>> Drives(efforts=500.0).efforts
    array(500.)
    """

    efforts: Array | None
    speeds: Array | None

    def __init__(self, efforts: ArrayLike | None = None, speeds: ArrayLike | None = None) -> None:
        object.__setattr__(self, "efforts", _checked("efforts", efforts))
        object.__setattr__(self, "speeds", _checked("speeds", speeds))


def _checked(what: str, value: ArrayLike | None) -> Array | None:
    if value is None:
        return None
    given = np.array(bounded_array(f"drives.{what}", value, ()))
    if given.ndim > 1 or not given.size:
        wanted = "one number, or shape (n,)"
        raise InvalidInput(expected(f"drives.{what}", wanted, f"shape {given.shape}"))
    if not (least := float(given.min())) >= 1.0 / LARGEST_NUMBER:
        got, low = apart(least, 1.0 / LARGEST_NUMBER)
        raise InvalidInput(expected(f"drives.{what}", f"positive numbers from {low} on", got))
    given.flags.writeable = False
    return given


class JointLimit(NamedTuple):
    """Limits of one actuated joint; infinite where there is none.

    Attributes
    ----------
    least, greatest : float [m, rad]
        Of the joint variable.
    effort : float [N, N m]
    speed : float [m/s, rad/s]
    """

    least: float
    greatest: float
    effort: float
    speed: float


# How far a joint may be beyond its stroke, as a share of the size or in rad.
STROKE_TOLERANCE = 1e-9
# What URDF has for a limit of a joint where there is none, as it demands numbers [m, rad].
NO_STROKE = 1e9
UNLIMITED = JointLimit(-np.inf, np.inf, np.inf, np.inf)


def joint_limits(
    design: Design, pose: Pose, drives: Drives | None, metres: float
) -> Mapping[str, JointLimit]:
    """Return the limits of the actuated joints by name.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape ()
        Of the model, which must be within the strokes: else it would not stay there.
    drives : Drives or None
    metres : float [m]
        Length of the design's unit.

    Raises
    ------
    InvalidInput
        If `drives` is not a Drives, or has other than one number, or one per actuator, or the pose
        is beyond a stroke.
    """
    check_within(design, "pose", design.at(pose).joints)
    if drives is not None and not is_a(drives, Drives):
        raise InvalidInput(expected("drives", "a Drives or None", type(drives).__name__))
    n = len(design.joint_names)
    strokes = joint_ends(design) * np.where(design.angular, 1.0, metres)[:, None]
    rows = (
        strokes[:, 0],
        strokes[:, 1],
        *(_each(drives, what, n) for what in ("efforts", "speeds")),
    )
    return {
        name: JointLimit(*map(float, numbers))
        for name, *numbers in zip(design.joint_names, *rows, strict=True)
    }


def joint_ends(design: Design) -> Array:
    """Return the strokes of the actuated joints (n, 2), infinite for no end [unit, rad].

    The angle of a crank is in (−π, π], so where it has a stroke, that ends there.
    """
    ends = open_strokes(design.strokes, len(design.joint_names))
    return np.where(cranks(design)[:, None], crank_bounds(ends), ends)


def check_within(design: Design, what: str, joints: Array) -> None:
    """Raise InvalidInput for joint values beyond strokes, or such as no joint can have."""
    margin = STROKE_TOLERANCE * np.where(design.angular, 1.0, design.rms_radius)
    ends, possible = joint_ends(design).T, joint_ranges(design).T
    low, high = np.maximum(ends[0], possible[0]), np.minimum(ends[1], possible[1])
    for row in np.flatnonzero((joints < low - margin) | (joints > high + margin)):
        name = design.joint_names[row]
        wanted = f"{name} within its stroke or range, {low[row]:g} to {high[row]:g}"
        raise InvalidInput(expected(what, wanted, f"{joints[row]:g}"))


def joint_ranges(design: Design) -> Array:
    """Return the values that joints can have (n, 2) [unit, rad].

    Distances are not negative, and angles between lines are at most π.
    """
    between = design.angular & ~cranks(design)
    low = np.where(between | ~np.asarray(design.signed), 0.0, -np.inf)
    return np.stack((low, np.where(between, np.pi, np.inf)), axis=1)


def cranks(design: Design) -> Mask:
    """Return which actuated joints are cranks at the base: (n,)."""
    return np.array([row.constraint.driven for row in design.rows]) & design.angular


def limit_at_zero(limits: Mapping[str, JointLimit], motion: Motion, metres: float) -> JointLimit:
    """Return the limits of a joint that is zero at the pose of its chain.

    Parameters
    ----------
    limits : mapping from names of actuated joints to JointLimit
    motion : Motion
    metres : float [m]
        Length of the design's unit.
    """
    if not motion.active:
        return UNLIMITED
    limit = limits[motion.name]
    value = float(motion.value) * (metres if motion.kind == "slide" else 1.0)
    return limit._replace(least=limit.least - value, greatest=limit.greatest - value)


def _each(drives: Drives | None, what: str, n: int) -> Array:
    value = None if drives is None else getattr(drives, what)
    if value is None:
        return np.full(n, np.inf)
    if value.shape not in ((), (n,)):
        wanted = f"one number, or shape ({n},)"
        raise InvalidInput(expected(f"drives.{what}", wanted, f"shape {value.shape}"))
    return np.broadcast_to(value, n)
