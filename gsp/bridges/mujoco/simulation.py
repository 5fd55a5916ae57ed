"""A design simulated by MuJoCo."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.bridges.mujoco.mjcf import SERVO_FREQUENCY, to_mjcf
from gsp.bridges.solids import Solids, check_solids
from gsp.checks import check_array, check_positive, optional
from gsp.errors import InvalidInput, apart, brief, expected
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.model.design import Design
from gsp.progress import Progress, meter
from gsp.statics.weights import GRAVITY

if TYPE_CHECKING:
    import mujoco

# Most steps of a simulation, and steps after which their number is reported.
MOST_SIMULATED, STEPS_PER_REPORT = 10**8, 100


@read_only_tuple
class Simulation(NamedTuple):
    """The state at the end of a simulation.

    Attributes
    ----------
    pose : Pose of shape () [unit of the design]
        Of the platform.
    joints : (n,) array [unit of the design, rad]
        Joint variables, in the order of `design.joint_names`.
    gap : float
        Largest violation of a loop [m, or rad], by the compliance of MuJoCo's constraints.
    speed : float
        Largest joint speed that is left [m/s, rad/s].
    """

    pose: Pose
    joints: Array
    gap: float
    speed: float


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
        to these in the first half of the time.
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
    mujoco = load_mujoco()
    model, data = load(design, pose, solids, gravity, servo_frequency)
    scale = metres_of(design, solids)
    change = np.zeros(model.nu)
    if joints is not None:
        given = check_array("joints", joints, (model.nu,))
        if given.ndim != 1:
            raise InvalidInput(expected("joints", f"shape ({model.nu},)", f"shape {given.shape}"))
        change = given * scale - data.actuator_length
    longest = MOST_SIMULATED * model.opt.timestep
    if seconds > longest:
        got, most = apart(seconds, longest)
        raise InvalidInput(expected("duration", f"at most {most} s", got))
    steps = int(np.ceil(seconds / model.opt.timestep))
    with meter(progress, "simulate") as report:
        for step in range(steps):
            data.ctrl[:] = change * min(1.0, 2.0 * step / steps)
            mujoco.mj_step(model, data)
            if not (step + 1) % STEPS_PER_REPORT or step + 1 == steps:
                report(step + 1, steps)
    mujoco.mj_forward(model, data)
    placed = data.body("platform")
    found = Pose.from_quaternion(placed.xpos, np.roll(placed.xquat, -1))
    return Simulation(
        Pose(found.position / check_solids(solids).unit(design), found.rotation),
        np.array(data.actuator_length) / scale,
        largest_gap(data),
        float(np.abs(data.qvel).max()),
    )


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


def compiled(text: str) -> mujoco.MjModel:
    """Return the model of a text, or raise InvalidInput with MuJoCo's reason."""
    try:
        return load_mujoco().MjModel.from_xml_string(text)
    except ValueError as error:
        reason = " ".join(str(error).split())
        wanted = "bodies and legs of which MuJoCo can make a model"
        raise InvalidInput(expected("design, solids", wanted, brief(reason))) from error


def metres_of(design: Design, solids: Solids | None) -> Array:
    """Return per joint the length of the design's unit in metres, 1 for angles: (n,)."""
    metres = check_solids(solids).unit(design)
    return np.where(design.angular, 1.0, metres)


def largest_gap(data: mujoco.MjData) -> float:
    """Return the largest violation of a loop [m, or rad]."""
    return float(np.abs(data.efc_pos[loop_rows(data)]).max())


def loop_rows(data: mujoco.MjData) -> Mask:
    """Return which rows of the constraints close loops (the others are limits of joints)."""
    return np.asarray(data.efc_type == load_mujoco().mjtConstraint.mjCNSTR_EQUALITY)


def load_mujoco() -> Any:
    """Import MuJoCo, or raise MissingSoftware."""
    with optional("mujoco", "a simulation", "mujoco"):
        import mujoco
    return mujoco
