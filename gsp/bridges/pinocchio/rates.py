"""Joint rates by Pinocchio: its constraint Jacobian, without formulas of `gsp`."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from gsp.bridges.links.linkage import linkage
from gsp.bridges.links.motions import Chain
from gsp.bridges.pinocchio.model import PinocchioModel, joint_of_link, machine_of
from gsp.bridges.rates import LegRates, Rates, check_drives, slide_joints
from gsp.geometry.frames.software import import_pinocchio
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design


def pinocchio_rates(design: Design, pose: Pose) -> Rates:
    """Return the rates of all joints for the six unit twists of the platform, by Pinocchio.

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
    InvalidInput
        If a drive at the base is singular at the pose.
    UndefinedPosture, InvalidInput
        See `to_pinocchio`.
    """
    chains = linkage(design, pose)
    check_drives(design, pose)
    machine = machine_of(design, pose, chains)
    data = machine.model.createData()
    closure = closure_residual(machine, data, design.rms_radius)
    rates = loop_rates(machine, data, pose)
    actuators = np.stack([_row(machine.model, rates, name) for name in design.joint_names])
    legs = tuple(_leg(machine, data, rates, chain) for chain in chains)
    return Rates(closure, actuators, legs)


def closure_residual(machine: PinocchioModel, data: Any, scale: float = 1.0) -> float:
    """Largest gap of a loop: translations divided by `scale`, rotations entrywise from I."""
    pin = import_pinocchio()
    pin.forwardKinematics(machine.model, data, machine.configuration)
    gaps = []
    for loop in machine.constraints:
        first = data.oMi[loop.joint1_id] * loop.joint1_placement
        second = data.oMi[loop.joint2_id] * loop.joint2_placement
        gap = first.actInv(second)
        gaps += [np.abs(gap.translation).max() / scale, np.abs(gap.rotation - np.eye(3)).max()]
    return float(max(gaps))


def loop_rates(machine: PinocchioModel, data: Any, pose: Pose) -> Array:
    """Rates of all joints that keep the loops closed, for the six unit twists, shape (nv, 6).

    Of the platform's unit twists (v, ω) in base axes. The turn of an SPS leg about itself, which
    they leave open, takes its least value.
    """
    pin = import_pinocchio()
    model, loops = machine.model, machine.constraints
    pin.computeJointJacobians(model, data, machine.configuration)
    rows = pin.getConstraintsJacobian(model, data, loops, [loop.createData() for loop in loops])
    platform = np.kron(np.eye(2), pose.rotation.T)  # its velocity is counted in its own axes
    rates = np.zeros((model.nv, 6))
    rates[:6] = platform
    for i, columns in enumerate(_leg_columns(machine)):
        at = slice(6 * i, 6 * i + 6)
        rates[columns] = _solved(rows[at, columns], -rows[at, :6] @ platform)
    return rates


def _solved(rows: Array, right: Array) -> Array:
    """Return the least x with rows · x = right; where lengths are large or small numbers, too."""
    heights = _or_one(np.abs(rows).max(axis=1, keepdims=True))
    even = rows / heights
    widths = _or_one(np.sqrt(np.sum(even**2, axis=0)))
    found = np.linalg.lstsq(even / widths, right / heights)[0]
    return np.asarray(found / widths[:, None])


def _or_one(sizes: Array) -> Array:
    return np.where(sizes > 0.0, sizes, 1.0)


def _leg_columns(machine: PinocchioModel) -> list[slice]:
    """Where the velocities of each leg are."""
    joints, ends = machine.model.joints, [loop.joint1_id for loop in machine.constraints]
    bounds = [6] + [joints[end].idx_v + joints[end].nv for end in ends]
    return [slice(a, b) for a, b in pairwise(bounds)]


def _row(model: Any, rates: Array, name: str) -> Array:
    """Rate of a joint; of a composite one, of its slide, which comes first."""
    return np.asarray(rates[model.joints[model.getJointId(name)].idx_v])


def _leg(machine: PinocchioModel, data: Any, rates: Array, chain: Chain) -> LegRates:
    pin = import_pinocchio()
    model, name = machine.model, chain.name
    world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED

    def spin(link: str) -> Array:
        joint = model.getJointId(joint_of_link(chain, link))
        return np.asarray((pin.getJointJacobian(model, data, joint, world) @ rates)[3:])

    names = {"base": f"{name}_base", "platform": f"{name}_platform", "middle": f"{name}_slide"}
    slides = [_row(model, rates, names[joint]) for joint in slide_joints(chain.leg)]
    return LegRates(
        data.oMi[model.getJointId(joint_of_link(chain, "upper"))].rotation[:, 2],
        spin("upper"),
        np.array(slides).reshape(-1, 6),
        np.zeros((3, 6)) if chain.turns_from_base else spin("lower"),
    )
