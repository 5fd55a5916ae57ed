"""Joint rates by MuJoCo: its Jacobian of the equality constraints, without formulas of `gsp`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gsp.bridges.links.linkage import linkage
from gsp.bridges.links.motions import Chain
from gsp.bridges.links.solids import Solids
from gsp.bridges.mujoco.program import largest_gap, load_mujoco, loop_rows
from gsp.bridges.mujoco.simulation import load, metres_of
from gsp.bridges.rates import LegRates, Rates, check_drives, slide_joints
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.units import METRES_PER_UNIT

if TYPE_CHECKING:
    import mujoco


def mujoco_rates(design: Design, pose: Pose) -> Rates:
    """Return the rates of all joints for the six unit twists of the platform, by MuJoCo.

    MuJoCo's Jacobian of the equality constraints determines the joint rates of the legs, and its
    actuators the rates of the actuated joints.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (), a single pose
        At which all legs are defined.

    Returns
    -------
    Rates

    Raises
    ------
    MissingSoftware
        If MuJoCo is not installed.
    InvalidInput
        If a drive at the base is singular at the pose.
    UndefinedPosture, InvalidInput, MissingParameter
        See `to_mjcf`.
    """
    mujoco = load_mujoco()
    chains, solids = linkage(design, pose), _solids(design)
    check_drives(design, pose)
    try:
        model, data = load(design.replace(strokes=None), pose, solids)
    except InvalidInput as error:
        if not str(error).startswith("solids"):
            raise
        wanted = "one whose links are heavy enough for MuJoCo (design.scaled makes it larger)"
        size = f"a size of {solids.unit(design) * design.rms_radius:.3g} m"
        raise InvalidInput(expected("design", wanted, size)) from error
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    mujoco.mj_forward(model, data)
    metres = solids.unit(design)
    rates = _loop_rates(model, data, pose, metres)
    speeds = np.empty((model.nu, 6))
    for column in range(6):
        data.qvel[:] = rates[:, column]
        mujoco.mj_fwdVelocity(model, data)
        speeds[:, column] = data.actuator_velocity
    return Rates(
        largest_gap(data) / min(metres * design.rms_radius, 1.0),
        speeds / metres_of(design, solids)[:, None],
        tuple(_leg(model, data, rates, chain, metres) for chain in chains),
    )


def _solids(design: Design) -> Solids:
    """Return solids in metres, where rates need a unit: one that is not known counts as a metre."""
    return Solids(metres=METRES_PER_UNIT.get(design.unit, 1.0))


def _loop_rates(model: mujoco.MjModel, data: mujoco.MjData, pose: Pose, metres: float) -> Array:
    """Rates of all joints that keep the loops closed, shape (nv, 6)."""
    twists = np.kron(np.diag([metres, 1.0]), np.eye(3))
    twists[3:, 3:] = pose.rotation.T  # a free joint turns about its own axes
    rows = data.efc_J.reshape(-1, model.nv)[loop_rows(data)]
    first = model.joint("platform").dofadr[0]
    platform = np.arange(first, first + 6)
    legs = np.setdiff1d(np.arange(model.nv), platform)
    rates = np.zeros((model.nv, 6))
    rates[platform] = twists
    rates[legs] = np.linalg.lstsq(rows[:, legs], -rows[:, platform] @ twists)[0]
    return rates


def _leg(
    model: mujoco.MjModel, data: mujoco.MjData, rates: Array, chain: Chain, metres: float
) -> LegRates:
    name = chain.name

    def spin(link: str) -> Array:
        rows = np.empty((3, model.nv))
        load_mujoco().mj_jacBody(model, data, None, rows, model.body(f"{name}_{link}").id)
        return np.asarray(rows @ rates)

    names = {
        "base": f"{name}_base_slide",
        "platform": f"{name}_platform_slide",
        "middle": f"{name}_slide",
    }
    slides = [rates[model.joint(names[joint]).dofadr[0]] for joint in slide_joints(chain.leg)]
    return LegRates(
        data.body(f"{name}_upper").xmat.reshape(3, 3)[:, 2],
        spin("upper"),
        np.array(slides).reshape(-1, 6) / metres,
        np.zeros((3, 6)) if chain.turns_from_base else spin("lower"),
    )
