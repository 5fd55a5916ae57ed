"""Comparison of the rows of `gsp` with rates that a multibody program computes from its model.

Pinocchio or MuJoCo get joints, placements and a configuration. If the loops close, the
configuration is the posture. The null space of their constraint Jacobian then gives the rates of
all joints for any motion of the platform, without a formula of `gsp`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from gsp.bridges.mujoco.rates import mujoco_rates
from gsp.bridges.pinocchio.rates import pinocchio_rates
from gsp.bridges.rates import LegRates, Rates
from gsp.checks import check_text
from gsp.errors import UnknownName
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross
from gsp.model.design import Design
from gsp.model.legs import LEGS
from gsp.model.posture import Posture

PROGRAMS: Mapping[str, Callable[[Design, Pose], Rates]] = MappingProxyType(
    {"pinocchio": pinocchio_rates, "mujoco": mujoco_rates}
)


class Agreement(NamedTuple):
    """Largest differences between a multibody program and our rows at one posture.

    Attributes
    ----------
    closure : float [1, rad]
        Residual of the loops: distances as a share of `design.rms_radius`, rotations in rad.
    actuators : float [1]
        Rates of the actuators for the six unit twists, relative to the largest entry of the row
        (of the homogeneous Jacobian of length `design.rms_radius`).
    passive : float [1]
        Rates of the passive joints in the control number, relative to the largest of the leg: the
        turning of the unit vector of the leg seen from base and from platform, compared as sums of
        squares (as 6 × 6 forms, so that no choice of axes enters), and each slide.
    """

    closure: float
    actuators: float
    passive: float


def agreement(design: Design, pose: Pose, program: str = "pinocchio") -> Agreement:
    """Compare a posture with another program's kinematics of the same mechanism.

    Parameters
    ----------
    design : Design
    pose : Pose
        A single pose, at which all legs are defined.
    program : "pinocchio" or "mujoco"

    Raises
    ------
    UnknownName
        If there is no such program here.
    MissingSoftware
        If it is not installed.
    UndefinedPosture, InvalidInput, MissingParameter
        See `to_pinocchio` and `to_mjcf`.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> max(agreement(design, design.home)) < 1e-12
    True
    """
    if check_text("program", program) not in PROGRAMS:
        raise UnknownName("program", program, PROGRAMS)
    rates = PROGRAMS[program](design, pose)
    posture, scale = design.at(pose), design.rms_radius
    weights = np.repeat([1.0, 1.0 / scale], 3)
    theirs = rates.actuators * np.where(posture.angular, scale, 1.0)[:, None] * weights
    ours = posture.homogeneous(scale)
    return Agreement(
        rates.closure,
        float((np.abs(theirs - ours).max(axis=1) / np.abs(ours).max(axis=1)).max()),
        max(_passive_differences(posture, rates, scale)),
    )


def _passive_differences(posture: Posture, rates: Rates, scale: float) -> list[float]:
    """Compare leg by leg; columns of ω are divided by `scale`, turns multiplied by it."""
    ours = posture.passive_rates(scale) * np.repeat([scale, 1.0], 3)
    differences, start = [], 0
    for i in _in_order_of_kinds(posture.design):
        theirs = rates.legs[i]
        stop = start + 4 + len(theirs.slides)
        differences.append(_leg_difference(ours[start:stop], theirs, scale))
        start = stop
    return differences


def _in_order_of_kinds(design: Design) -> list[int]:
    """Legs as `Posture.passive_rates` stacks them."""
    return [i for kind in LEGS for i, leg in enumerate(design.legs) if leg is kind]


def _leg_difference(ours: Array, theirs: LegRates, scale: float) -> float:
    """Two rows of turns seen from the base, two from the platform, then slides."""
    largest = np.abs(ours).max()
    weights = np.repeat([1.0, 1.0 / scale], 3)
    gaps = [np.abs(theirs.slides * weights - ours[4:]).max(initial=0.0) / largest]
    for rows, spin in ((ours[:2], theirs.spin), (ours[2:4], theirs.spin - np.eye(6)[3:])):
        turning = cross(spin.T, theirs.axis).T * scale * weights  # u̇ = ω × u
        gaps.append(np.abs(turning.T @ turning - rows.T @ rows).max() / largest**2)
    return float(max(gaps))
