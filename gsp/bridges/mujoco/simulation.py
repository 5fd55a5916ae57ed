"""A design simulated by MuJoCo."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.bridges.links.drives import check_within, cranks, joint_ends, joint_ranges
from gsp.bridges.links.solids import Solids, check_solids
from gsp.bridges.mujoco.mjcf import SERVO_FREQUENCY, to_mjcf
from gsp.bridges.mujoco.program import (
    compiled,
    gaps_of,
    largest_speed,
    load_mujoco,
    silent,
)
from gsp.checks import check_array, check_positive, check_type
from gsp.errors import FailedComputation, InvalidInput, apart, expected
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.frames.screws import exp3
from gsp.geometry.matrices import singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, unit
from gsp.model.design import Design
from gsp.model.drives import Crank
from gsp.model.posture import Posture
from gsp.progress import Progress, meter
from gsp.statics.weights import GRAVITY

if TYPE_CHECKING:
    import mujoco

# Most steps of a simulation, and steps after which their number is reported.
MOST_SIMULATED, STEPS_PER_REPORT = 10**8, 100
# Open loops, as a share of the size or in rad, above which a state is none of the design. Under
# gravity, held or moved to what can be reached, they are open by less than 1e-4.
OPEN_LOOP = 3e-4
# How far a rod leans to the other side of a dead centre where a branch is another, or a joint value
# is beyond those that it can have, over the gap of its loop.
DEAD_CENTRE = 4.0
# Least singular value of an end that is on one side of all singular postures, over the same gap.
NEARLY_SINGULAR = 20.0


@read_only_tuple
class Simulation(NamedTuple):
    """The state at the end of a simulation.

    Attributes
    ----------
    pose : Pose of shape () [unit of the design]
        Of the platform.
    joints : (n,) array [unit of the design, rad]
        Joint variables, in the order of `design.joint_names`. They differ from the targets by what
        the servos give way to the weight of the links, and by what the legs cannot reach together.
    gap : float
        How far the most open loop is open [m, or rad], by the compliance of MuJoCo's constraints.
    speed : float
        Largest speed of a joint of a leg that is left [m/s, rad/s]; of a ball that of its turn.
    passed : bool or None
        Whether det J has another sign than at the start: the platform went through a singular
        posture, perhaps to another assembly mode than the one to which `gsp.track` leads. None of
        other than six actuators, and where the start or the end is singular, as far as open loops
        leave that known: the least singular value, of rows of length one, is below 20 gaps (shares
        of the size, or in rad).
    """

    pose: Pose
    joints: Array
    gap: float
    speed: float
    passed: bool | None


@arguments.validated(duration=arguments.positive)
def simulate(
    design: Design,
    pose: Pose,
    joints: ArrayLike | None = None,
    duration: float = 2.0,
    solids: Solids | None = None,
    *,
    gravity: ArrayLike = GRAVITY,
    servo_frequency: float = SERVO_FREQUENCY,
    progress: Progress = None,
) -> Simulation:
    """Return the final state of a design that MuJoCo moves from a pose to joint values.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (), a single pose
        At which all legs are defined; the simulation starts there.
    joints : (n,) array_like or None [unit of the design, rad]
        Targets of the servos; default those of the pose, which are held. They move from the start
        to these in the first half of the time, cranks without strokes the shorter way round.
    duration : float [s]
        At most that of 1e8 steps of the model, which take hours.
    solids : Solids or None
        Sizes and masses of the links; default thin aluminium.
    gravity : (3,) array_like [m/s²]
    servo_frequency : float [rad/s]
        See `to_mjcf`.
    progress : function (done, total), bool or None
        Called with the number of steps: see `gsp.evaluate`.

    Returns
    -------
    Simulation

    Raises
    ------
    MissingSoftware
        If MuJoCo is not installed.
    FailedComputation
        If the motion becomes unstable in MuJoCo, or ends with loops that are open by more than
        3e-4 of the size of the design (rms_radius) or 3e-4 rad, with a drive at the base on its
        other branch, or beyond a distance of zero or an angle of 0 or π between lines. Targets that
        the legs cannot reach together may lead there; else the servos give way, and `joints` are
        not the targets.
    InvalidInput
        If the pose or `joints` is beyond the strokes of the design, or a target is negative for a
        distance, or outside [0, π] for an angle between lines or [−π, π] for a crank with a stroke
        of less than a turn.
    UndefinedPosture, InvalidInput, MissingParameter
        See `to_mjcf`.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> simulate(design, design.home, duration=0.1).gap < 1e-5
    True
    """
    seconds = arguments.number("duration", check_positive("duration", duration))
    check_type("design", design, Design)
    check_type("pose", pose, Pose)
    mujoco = load_mujoco()
    # A body far from its origin would lose digits.
    centre = design.platform_points.mean(axis=0)
    design, pose = design.with_origin(centre), pose.compose(Pose(centre))
    model, data = load(design, pose, solids, gravity, servo_frequency)
    scale = metres_of(design, solids)
    change = np.zeros(model.nu)
    if joints is not None:
        given = check_array("joints", joints, (model.nu,), axes=1)
        check_within(design, "joints", given)
        change = _changes(design, given * scale, data.actuator_length)
    longest = MOST_SIMULATED * model.opt.timestep
    if seconds > longest:
        got, most = apart(seconds, longest)
        raise InvalidInput(expected("duration", f"at most {most} s", got))
    steps = int(np.ceil(seconds / model.opt.timestep))
    with meter(progress, "simulate") as report, silent(mujoco):
        for step in range(steps):
            data.ctrl[:] = change * min(1.0, 2.0 * step / steps)
            mujoco.mj_step(model, data)
            if not (step + 1) % STEPS_PER_REPORT or step + 1 == steps:
                _check_stable(data, (step + 1) * model.opt.timestep)
                report(step + 1, steps)
    mujoco.mj_forward(model, data)
    metres = check_solids(solids).unit(design)
    gaps, turns = gaps_of(data)
    gap, turn = gaps.max(), turns.max(initial=0.0)
    _check_closed(gap, turn, OPEN_LOOP * design.rms_radius * metres)
    placed = data.body("platform")
    found = Pose.from_quaternion(placed.xpos / metres, np.roll(placed.xquat, -1))
    reached = _in_one_turn(design, np.array(data.actuator_length)) / scale
    margins = DEAD_CENTRE * gaps[[leg for leg, _ in design.rows]] / metres
    _check_ranges(design, reached, margins)
    _check_branches(design, found, reached, margins)
    open_by = max(gap / (design.rms_radius * metres), turn)
    return Simulation(
        found.compose(Pose(-centre)),
        reached,
        float(max(gap, turn)),
        largest_speed(model, data),
        _passed(design.at(pose), design.at(found), open_by),
    )


def _check_closed(gap: float, turn: float, longest: float) -> None:
    """Raise FailedComputation if a loop is open by more than a length [m], or than OPEN_LOOP."""
    for open_by, most, name in ((gap, longest, "m"), (turn, OPEN_LOOP, "rad")):
        if open_by > most:
            wanted = "targets that the legs reach together, and time to get there"
            got = f"a loop that is open by {open_by:.3g} {name} (most: {most:.3g})"
            raise FailedComputation(expected("simulate", wanted, got))


def _check_ranges(design: Design, joints: Array, margins: Array) -> None:
    """Raise FailedComputation for distances below zero, and angles not from 0 to π between lines.

    The design has other values at the same pose. What is beyond by less than its margin (n,), in
    the unit of the design, is at the end of the range, as far as that is known with open loops.
    """
    low, high = joint_ranges(design).T
    beyond = np.maximum(low - joints, joints - high)
    for row in np.flatnonzero(beyond * np.where(design.angular, design.rms_radius, 1.0) > margins):
        wanted = "a motion on which distances and angles between lines are positive, angles below π"
        got = f"one on which {design.joint_names[row]} passed {'0' if joints[row] < 0.0 else 'π'}"
        raise FailedComputation(expected("simulate", wanted, got))


def _check_branches(design: Design, pose: Pose, joints: Array, margins: Array) -> None:
    """Raise FailedComputation if a rod leans to the side of the other branch of its drive.

    One that leans by less than its margin is at a dead centre, as far as that is known.
    """
    for row, (leg, constraint) in enumerate(design.rows):
        drive = design.drives[leg]
        if drive is None or not constraint.driven:
            continue
        axis = design.base_directions[leg]
        tip, way = joints[row] * axis, axis
        if isinstance(drive, Crank):
            tip = exp3(tip) @ np.array(drive.arm)
            way = unit(cross(axis, tip))
        head = pose.position + pose.rotation @ design.platform_points[leg]
        lean = drive.branch * float((head - design.base_points[leg] - tip) @ way)
        if lean < -margins[row]:
            wanted = "a motion on which drives keep their branches"
            got = f"one on which {design.joint_names[row]} passed a singular posture of its drive"
            raise FailedComputation(expected("simulate", wanted, got))


def _passed(start: Posture, end: Posture, open_by: float) -> bool | None:
    """Whether det J changed its sign between two postures; None where it is not known.

    `open_by` is how far a loop is open at the end, as a share of the size or in rad.
    """
    matrices = np.stack((start.about_centre, end.about_centre))
    if matrices.shape[-2] != matrices.shape[-1] or start.singular() or end.singular():
        return None
    rows = unit(matrices[1])  # those of cranks are long where the drive is nearly singular
    if not singular_values(rows).min() > NEARLY_SINGULAR * open_by:
        return None
    signs = np.linalg.slogdet(matrices)[0]
    return bool(signs[0] != signs[1])


def _changes(design: Design, targets: Array, start: Array) -> Array:
    """Return how far actuators go; a crank without a stroke takes the shorter way round."""
    change = targets - start
    turning = cranks(design)
    turning &= ~np.isfinite(joint_ends(design)).any(axis=1)
    nearest = change - 2.0 * np.pi * np.round(change / (2.0 * np.pi))
    return np.where(turning, nearest, change)


def _in_one_turn(design: Design, joints: Array) -> Array:
    """Return joint values with angles of cranks in (−π, π], as the design has them."""
    angle = np.pi - np.mod(np.pi - joints, 2.0 * np.pi)
    return np.where(cranks(design), angle, joints)


def _check_stable(data: mujoco.MjData, time: float) -> None:
    """Raise FailedComputation after MuJoCo has found numbers that are not finite, or huge ones.

    It then starts again from the pose of the model, as if nothing had happened.
    """
    kinds = load_mujoco().mjtWarning
    bad = (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC, kinds.mjWARN_BADCTRL)
    if any(data.warning[int(kind)].number for kind in bad):
        wanted = "a motion that MuJoCo can compute (targets within reach, finite forces)"
        got = f"one that became unstable before {time:.3g} s"
        raise FailedComputation(expected("simulate", wanted, got))


def load(
    design: Design,
    pose: Pose,
    solids: Solids | None = None,
    gravity: ArrayLike = GRAVITY,
    servo_frequency: float = SERVO_FREQUENCY,
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return model and data at the pose."""
    mujoco = load_mujoco()
    text = to_mjcf(design, pose, solids, gravity=gravity, servo_frequency=servo_frequency)
    model = compiled(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def metres_of(design: Design, solids: Solids | None) -> Array:
    """Return per joint the length of the design's unit in metres, 1 for angles: (n,)."""
    metres = check_solids(solids).unit(design)
    return np.where(design.angular, 1.0, metres)
