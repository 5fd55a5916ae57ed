"""The leg driven at the base that a chain of joints is: PSS with a slider, or RSS with a crank."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gsp.bridges.reading.mechanism.actuated import check_driven
from gsp.bridges.reading.mechanism.ends import NONE, TOLERANCE, End, FoundLeg, joint_at_end
from gsp.bridges.reading.mechanism.linkages import Freedom
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, norm
from gsp.model.drives import Crank, Drive, Slider

# By how much limits of a crank may be beyond π by rounding [rad].
ROUNDED_ANGLE = 1e-9


def is_driven(freedoms: Sequence[Freedom]) -> bool:
    """Return whether a chain begins with one slide or turn, and nothing behind it slides.

    Parameters
    ----------
    freedoms : sequence of Freedom
        From base to platform, not empty.
    """
    behind = freedoms[1:]
    return freedoms[0].kind != "ball" and all(freedom.kind != "slide" for freedom in behind)


def driven_leg(freedoms: Sequence[Freedom], where: str, size: float) -> FoundLeg:
    """Return the leg that a slide or a turn and two spherical joints are.

    The travel or angle counts from where the file has its zero; else from its configuration. Angles
    whose limits are not within (−π, π] count from the middle of them. The branch is that of the
    configuration.

    Parameters
    ----------
    freedoms : sequence of Freedom
        From base to platform.
    where : str
        The leg, for errors.
    size : float [m]
        Of the leg.

    Returns
    -------
    FoundLeg
        In the axes of the world, on the side of the base.

    Raises
    ------
    InvalidInput
        If the joints behind the first are not two spherical joints, no actuator drives it, the tip
        of a crank is on its axis, or the drive is at a dead centre.
    """
    first = freedoms[0]
    tip, rest = joint_at_end(freedoms[1:], where, size, "tip")
    top, rest = joint_at_end(tuple(reversed(rest)), where, size, "platform")
    if rest:
        got = ", ".join(f"{x.kind} {brief(x.name)}" for x in reversed(rest))
        wanted = "two spherical joints behind the first joint"
        raise InvalidInput(expected(where, wanted, f"besides them {got}"))
    check_driven(freedoms, first, where)
    value = _counted(first)
    rod = top.point - tip.point
    if first.kind == "turn":
        off_axis = float(norm(cross(first.axis, tip.point - first.point)))
        if off_axis <= TOLERANCE * size:
            wanted = "a tip beside the axis of the first joint"
            raise InvalidInput(expected(where, wanted, f"one that is {off_axis:.3g} m from it"))
    make = _slider if first.kind == "slide" else _crank
    point, slope, drive = make(first, value, tip.point, float(norm(rod)))
    sense = float(rod @ slope) / float(norm(rod) * norm(slope))
    if abs(sense) <= TOLERANCE:
        wanted = "a rod that is not perpendicular to the way of its tip, which decides the branch"
        raise InvalidInput(expected(where, wanted, f"a cosine of {sense:.2g} between them"))
    if sense < 0.0:
        drive = type(drive)(**{**vars(drive), "branch": -1})
    ends = (first.low, first.high)
    if first.kind == "turn" and not np.isfinite(ends).all():
        ends = (-np.inf, np.inf)  # what turns on without an end comes to every angle
    low, high = (value + x if np.isfinite(x) else np.nan for x in ends)
    return FoundLeg("D1", End(point, first.axis), End(top.point, NONE), [(low, high)], drive)


def _counted(first: Freedom) -> float:
    """Return what the travel or angle counts in the configuration of the file."""
    value = 0.0 if np.isnan(first.value) else first.value
    if first.kind == "slide":
        return value
    value = math.remainder(value, math.tau)
    middle = 0.5 * (first.low + first.high)
    beyond = max(value + first.high, -value - first.low)
    if np.isfinite(middle) and beyond > math.pi + ROUNDED_ANGLE:
        return -middle
    return value


def _slider(first: Freedom, value: float, tip: Array, rod: float) -> tuple[Array, Array, Drive]:
    """Return base point, velocity of the tip per rate of the joint, and the drive."""
    return tip - value * first.axis, first.axis, Slider(rod=rod)


def _crank(first: Freedom, value: float, tip: Array, rod: float) -> tuple[Array, Array, Drive]:
    arm = tip - first.point
    back = Pose(np.zeros(3)).moved(np.concatenate((np.zeros(3), -value * first.axis)))
    drive = Crank(arm=tuple((back.rotation @ arm).tolist()), rod=rod)
    return first.point, cross(first.axis, arm), drive


def in_axes(drive: Drive, rotation: Array) -> Drive:
    """Return a drive in the axes of a body, of which it is given in those of the world.

    Parameters
    ----------
    drive : Slider or Crank
    rotation : (3, 3) array
        Of the body in the world.
    """
    if isinstance(drive, Slider):
        return drive
    arm = rotation.T @ np.array(drive.arm)
    return Crank(arm=tuple(arm.tolist()), rod=drive.rod, branch=drive.branch)
