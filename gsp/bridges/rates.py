"""Joint rates of a mechanism, as another program computes them."""

from __future__ import annotations

from typing import NamedTuple

from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.legs import Leg


@read_only_tuple
class LegRates(NamedTuple):
    """Rates of the passive joints of a leg for the six unit twists of the platform.

    Attributes
    ----------
    axis : (3,) array [1]
        The direction of the leg (up to its sign), in base axes.
    spin : (3, 6) array [rad]
        Angular velocity of the link that is joined to the platform, in base axes.
    slides : (j, 6) array [unit of the design]
        Rates of the passive slides: those of `slide_joints`.
    carrier : (3, 6) array [rad]
        Angular velocity of the body from which the turns of the leg are seen: zero for the base;
        of a leg that is driven there that of its carriage or crank.
    """

    axis: Array
    spin: Array
    slides: Array
    carrier: Array


@read_only_tuple
class Rates(NamedTuple):
    """Rates of all joints for the six unit twists (v, ω) of the platform.

    Attributes
    ----------
    closure : float [1, rad]
        Residual of the loops at the posture: distances as a share of `design.rms_radius`, and rad.
    actuators : (n, 6) array [1, unit of the design]
        To be compared with `Posture.jacobian`.
    legs : tuple of LegRates
    """

    closure: float
    actuators: Array
    legs: tuple[LegRates, ...]


def check_drives(design: Design, pose: Pose) -> None:
    """Raise InvalidInput if a drive at the base is singular, as its rate has no bound.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape ()
    """
    for _, joint, reason in design.at(pose).singular_drives:
        wanted = "one at which the rates of all joints are bounded"
        raise InvalidInput(expected("pose", wanted, f"a singular drive of {joint}: {reason}"))


def slide_joints(leg: Leg) -> tuple[str, ...]:
    """Return which passive joints of a leg slide: of "base", "platform" and "middle"."""
    base, middle, platform = leg.joints
    joints = {"base": base, "platform": platform, "middle": middle}
    return tuple(name for name, joint in joints.items() if joint.passive_slide)
