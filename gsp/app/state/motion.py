"""Motions of the platform: to a pose, by increments, and by joint values; limits end them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from gsp.app.state.session import PLATFORM, Session, check_angles, check_place, started
from gsp.errors import GspError, InvalidInput, expected
from gsp.geometry.frames import log3
from gsp.geometry.matrices import determinant_sign
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.kinematics.forward_solution import forward
from gsp.limits import Feasibility, feasible
from gsp.model.design import Design

COORDINATES = ("x", "y", "z", "roll", "pitch", "yaw")
# Motions of a smaller share of the size, and rad, are none.
LEAST_MOTION = 1e-14
# A motion is sampled at so many points, then so often again between the last two: the end before a
# limit is exact to 32⁻⁶ of the motion.
MOTION_SAMPLES, MOTION_ROUNDS = 33, 6
# Turns by more are made in parts of at most so much [degrees].
TURN_PART = 90.0
PASSED = "passed a singular pose"
# By what a joint may get farther beyond a limit, in sizes of the design and rad: rounding.
MOTION_ROUNDING = 1e-12


def coordinates(pose: Pose) -> Array:
    """Return x, y, z and roll, pitch, yaw in degrees, shape (6,) [unit of the design, degrees]."""
    return np.concatenate((pose.position, pose.angles("rpy", degrees=True)))


def axis_and_angle(pose: Pose) -> tuple[Array, float]:
    """Return the rotation of a pose as an axis (3,) and an angle in [0, 180] degrees.

    *Source: Lee2000, figure 40, which shows the rotation so.*
    """
    turn = log3(pose.rotation)
    angle = float(norm(turn))
    axis = turn / angle if angle > LEAST_MOTION else np.array([0.0, 0.0, 1.0])
    return axis, float(np.rad2deg(angle))


def placed(state: Session, values: ArrayLike) -> Session:
    """Return the state after a straight motion to coordinates, up to the first limit.

    Parameters
    ----------
    state : Session
    values : (6,) array_like [unit of the design, degrees]
        x, y, z, roll, pitch, yaw.

    Raises
    ------
    InvalidInput
        On numbers that are not finite, or what `check_place` and `check_angles` refuse.
    """
    given = np.asarray(values, dtype=np.float64)
    if given.shape != (6,) or not np.isfinite(given).all():
        raise InvalidInput(expected("pose", "six finite numbers", str(given.tolist())))
    check_place(state, given[:3])
    check_angles(given[3:])
    return toward(state, Pose.from_rpy(given[:3], given[3:], degrees=True))


def with_coordinate(state: Session, name: str, value: float) -> Session:
    """Return the state after a motion of one coordinate: of `COORDINATES`, angles in degrees.

    A large turn has several parts, as the straight motion to its end may turn the other way.
    """
    values, number = coordinates(state.pose), COORDINATES.index(name)
    if number < 3 or not np.isfinite(value):
        values[number] = value
        return placed(state, values)
    check_angles(value)
    turn, passed = value - values[number], ""
    parts = int(abs(turn) / TURN_PART) + 1
    for left in range(parts - 1, -1, -1):
        values[number] = value - turn * left / parts
        state = placed(state, values)
        if state.message not in ("", PASSED):
            return state
        passed = passed or state.message
    return replace(state, message=passed)


def nudged(state: Session, name: str, sign: int) -> Session:
    """Return the state after one increment along or about an axis of the base or the platform.

    The platform turns about its origin.

    Parameters
    ----------
    state : Session
    name : str
        "x", "y", "z" for motions along axes; "roll", "pitch", "yaw" for turns about x, y, z.
    sign : 1 or -1

    Raises
    ------
    InvalidInput
        See `check_place`.
    """
    number = COORDINATES.index(name)
    axis = np.eye(3)[number % 3]
    if state.frame == PLATFORM:
        axis = state.pose.rotation @ axis
    twist = np.zeros(6)
    if number < 3:
        twist[:3] = sign * state.step * axis
    else:
        twist[3:] = sign * np.deg2rad(state.turn_deg) * axis
    target = state.pose.moved(twist)
    check_place(state, target.position)
    return toward(state, target)


def reset(state: Session) -> Session:
    """Return the state at the first pose of its design; increments and settings stay."""
    return replace(state, pose=started(state.design).pose, message="")


def toward(state: Session, target: Pose) -> Session:
    """Return the state after the straight motion to a pose, or at the first limit on the way.

    The motion is sampled: violations shorter than 1/32 of it can be missed; for a proof see
    `gsp.travel`. From a pose outside of the limits the motion goes on as long as no joint gets
    farther beyond its limits, so that the platform can always return. A singular pose ends nothing;
    where det J changes its sign the message states it.
    """
    design, start = state.design, state.pose
    twist = np.concatenate(
        (target.position - start.position, log3(target.rotation @ start.rotation.T))
    )
    if np.abs(twist / np.repeat([state.size, 1.0], 3)).max() < LEAST_MOTION:
        return replace(state, message="")
    if state.stops and has_strokes(design):
        share, limit = _reach(state, twist)
        end = target if share == 1.0 else start.moved(share * twist)
        if limit:
            return replace(state, pose=end, message=limit)
        if reason := feasible(design, end).reason:
            return replace(state, pose=end, message=f"outside of the limits: {reason}")
    message = PASSED if _passes_singular(design, start, twist) else ""
    return replace(state, pose=target, message=message)


def _reach(state: Session, twist: Array) -> tuple[float, str]:
    """Return which share of a motion is allowed, and what ends it there, "" for nothing.

    Each joint may be as far beyond its limits as it has been at the least before.
    """
    low, high, words = 0.0, 1.0, ""
    least: Array | None = None  # of how far joints have been beyond their limits, up to `low`
    for _ in range(MOTION_ROUNDS):
        shares = np.linspace(low, high, MOTION_SAMPLES)
        found = feasible(state.design, state.pose.moved(shares[:, None] * twist))
        beyond = _beyond(found)
        if least is None:
            least = beyond[0]
        allowed = np.minimum(np.minimum.accumulate(beyond), least)
        slack = MOTION_ROUNDING * np.where(state.design.angular, 1.0, state.size)
        worse = beyond[1:] > allowed[:-1] + slack
        if not worse.any():
            break
        first = int(worse.any(axis=1).argmax())
        joint = int(worse[first].argmax())
        words = _what_ends(state.design, found, first + 1, joint, allowed[first, joint])
        least = allowed[first]
        low, high = float(shares[first]), float(shares[first + 1])
    return (low, words) if words else (1.0, "")


def _beyond(found: Feasibility) -> Array:
    """Return how far joints are beyond their limits, 0 inside, inf undefined (..., n) [of it]."""
    away = np.maximum(found.low - found.values, found.values - found.high)
    inside = ~found.violated.any(axis=-1)
    return np.asarray(np.where(inside, 0.0, np.nan_to_num(away, nan=np.inf)))


def _what_ends(design: Design, found: Feasibility, number: int, joint: int, allowed: float) -> str:
    """Return why a motion ends before one of several poses: "stopped at the limit d3 = 140".

    Parameters
    ----------
    design : Design
    found : Feasibility
    number, joint : int
        Of the pose, and of the joint that it would bring too far.
    allowed : float
        How far beyond its limits the joint may be.
    """
    name, value = found.names[joint], found.values[number, joint]
    if np.isnan(value):
        return f"stopped: {name} is not defined farther on"
    bound = found.low[joint] if value < found.low[joint] else found.high[joint]
    return _ended(design, joint, bound, beyond=allowed > 0.0)


def _ended(design: Design, joint: int, bound: float, *, beyond: bool) -> str:
    """Return the message of a motion that ends at a limit, or where it is beyond one already."""
    name = design.joint_names[joint]
    limit = f"{np.rad2deg(bound):.6g}°" if design.angular[joint] else f"{bound:.6g}"
    if beyond:
        return f"stopped: {name} is beyond its limit {limit}, and would get farther away"
    return f"stopped at the limit {name} = {limit}"


def _passes_singular(design: Design, start: Pose, twist: Array) -> bool:
    """Whether det J has both signs at samples of a motion; False for redundant designs."""
    if len(design.joint_names) != 6:
        return False
    shares = np.linspace(0.0, 1.0, MOTION_SAMPLES)[:, None]
    signs = determinant_sign(design.at(start.moved(shares * twist)).about_centre)
    return bool((signs < 0.0).any() and (signs > 0.0).any())


def with_joint(state: Session, number: int, value: float) -> Session:
    """Return the state after a change of one joint value: the platform follows.

    The other joints keep their values. Where no pose is found nothing changes, and the message
    states the reason.

    Parameters
    ----------
    state : Session
    number : int
        Of the joint, from 0.
    value : float [unit of the design, rad]

    *Source: Lee2000, figure 40, "Connector Length Change".*
    """
    design = state.design
    posture = design.at(state.pose)
    if posture.undefined:
        reason = posture.undefined[0].reason
        return state.saying(f"joints cannot be changed here: {reason}")
    if len(design.joint_names) != 6:
        return state.saying("one joint alone cannot be changed: the design is redundant")
    joints = posture.joints.copy()
    joints[number], bound = _within(state, number, value, joints[number])
    try:
        found = forward(design, joints, state.pose)
    except GspError as error:
        return state.saying(str(error))
    if not found.converged:
        return state.saying(_unreached(design, number, (value, joints[number]), str(found.status)))
    return replace(state, pose=found.pose, message=bound)


def _within(state: Session, number: int, value: float, now: float) -> tuple[float, str]:
    """Return a joint value within its stroke, or no farther beyond it; a message where it was."""
    strokes = state.design.strokes
    if not state.stops or strokes is None:
        return float(value), ""
    low, high = strokes[number]
    inside = float(np.fmin(np.fmax(value, np.fmin(low, now)), np.fmax(high, now)))
    if inside == value:
        return inside, ""
    bound = float(low if value < inside else high)
    return inside, _ended(state.design, number, bound, beyond=inside != bound)


def _unreached(design: Design, number: int, values: tuple[float, float], status: str) -> str:
    """Return why a joint has not a value: that was requested, and at which a limit held it."""
    angular, name = design.angular[number], design.joint_names[number]
    wanted, held = (f"{np.rad2deg(v):.4g}°" if angular else f"{v:.6g}" for v in values)
    limit = "" if values[0] == values[1] else f", nor with its limit {held}"
    why = {
        "singular": "the way there ends at a singular pose, so the value is out of reach from here",
        "undefined": "the joint cannot have this value",
    }.get(status, "the search did not converge")
    return f"no pose with {name} = {wanted}{limit}: {why}; nothing was changed"


def has_strokes(design: Design) -> bool:
    """Whether a design has a limit of a joint."""
    return design.strokes is not None and bool(np.isfinite(design.strokes).any())
