"""Comparison of joint rates by `gsp` with those of a multibody program, Pinocchio or MuJoCo.

The program computes them from a model of the mechanism: its joints, placements and loops, at the
joint positions of the posture. The residual of the loops shows whether the model is in that
posture. The null space of the constraint Jacobian of the program then contains the rates of all
joints for each twist of the platform. No formula of a row of `gsp` is used for them.
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
from gsp.model.posture import Posture

PROGRAMS: Mapping[str, Callable[[Design, Pose], Rates]] = MappingProxyType(
    {"pinocchio": pinocchio_rates, "mujoco": mujoco_rates}
)


class Agreement(NamedTuple):
    """Largest differences between joint rates by a multibody program and by `gsp` at one posture.

    Attributes
    ----------
    closure : float [1, rad]
        Residual of the loops: distances as a share of `design.rms_radius`, rotations in rad.
    actuators : float [1]
        Rates of the actuators for the six unit twists, relative to the largest entry of the row
        (of the homogeneous Jacobian of length `design.rms_radius`).
    passive : float [1]
        Rates of the passive joints that the control number counts, relative to the largest rate
        of the leg: the rates at which the direction of the leg turns, seen from the base and from
        the platform, and the rate of each slide. Rates of turning are compared as quadratic forms
        of the twist (6 × 6 matrices), which do not depend on the choice of axes.
    """

    closure: float
    actuators: float
    passive: float


def agreement(design: Design, pose: Pose, program: str = "pinocchio") -> Agreement:
    """Return how far the joint rates of a posture differ from those of a multibody program.

    Parameters
    ----------
    design : Design
    pose : Pose
        A single pose, shape (), at which all legs are defined [unit of the design].
    program : "pinocchio" or "mujoco"

    Returns
    -------
    Agreement
        Differences ≥ 0; where the formulas are right they are rounding errors.

    Raises
    ------
    UnknownName
        If `program` is neither.
    MissingSoftware
        If the program is not installed.
    InvalidInput
        If a drive at the base is singular at the pose.
    UndefinedPosture, InvalidInput, MissingParameter
        See `to_pinocchio` and `to_mjcf`.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> max(agreement(design, design.home)) < 1e-11
    True
    """
    program = check_text("program", program)
    if program not in PROGRAMS:
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
    """Return the largest differences of the legs.

    Columns of ω are divided by `scale`, rows of turns are multiplied by it.
    """
    ours = posture.passive_rates(scale) * np.repeat([scale, 1.0], 3)
    differences, start = [], 0
    groups, legs = posture.design.groups, np.arange(posture.design.n_legs)
    for i in np.concatenate([legs[group.legs] for group in groups]):  # in this order they stack
        theirs = rates.legs[i]
        stop = start + 4 + len(theirs.slides)
        differences.append(_leg_difference(ours[start:stop], theirs, scale))
        start = stop
    return differences


def _leg_difference(ours: Array, theirs: LegRates, scale: float) -> float:
    """Return the largest relative difference of a leg.

    Its rows are two turns seen from the base, two seen from the platform, then the slides.
    """
    largest = np.abs(ours).max()
    weights = np.repeat([1.0, 1.0 / scale], 3)
    gaps = [np.abs(theirs.slides * weights - ours[4:]).max(initial=0.0) / largest]
    for rows, seen_from in ((ours[:2], theirs.carrier), (ours[2:4], np.eye(6)[3:])):
        spin = theirs.spin - seen_from
        turning = cross(spin.T, theirs.axis).T * scale * weights  # u̇ = ω × u
        gaps.append(np.abs(turning.T @ turning - rows.T @ rows).max() / largest**2)
    return float(max(gaps))
