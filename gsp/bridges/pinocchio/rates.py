"""Joint rates by Pinocchio: its constraint Jacobian, without formulas of `gsp`."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from gsp.bridges.pinocchio.model import PinocchioModel, without_masses
from gsp.bridges.rates import LegRates, Rates, slide_joints
from gsp.geometry.frames.software import import_pinocchio
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.legs import Leg


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
    UndefinedPosture, InvalidInput
        See `to_pinocchio`.
    """
    machine = without_masses(design, pose)
    data = machine.model.createData()
    closure = closure_residual(machine, data, design.rms_radius)
    rates = loop_rates(machine, data, pose)
    actuators = np.stack([_row(machine.model, rates, name) for name in design.joint_names])
    legs = tuple(_leg(machine, data, rates, leg, i) for i, leg in enumerate(design.legs, 1))
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
        rates[columns] = np.linalg.lstsq(rows[at, columns], -rows[at, :6] @ platform)[0]
    return rates


def _leg_columns(machine: PinocchioModel) -> list[slice]:
    """Where the velocities of each leg are."""
    joints, ends = machine.model.joints, [loop.joint1_id for loop in machine.constraints]
    bounds = [6] + [joints[end].idx_v + joints[end].nv for end in ends]
    return [slice(a, b) for a, b in pairwise(bounds)]


def _row(model: Any, rates: Array, name: str) -> Array:
    """Rate of a joint; of a composite one, of its slide, which comes first."""
    return np.asarray(rates[model.joints[model.getJointId(name)].idx_v])


def _leg(machine: PinocchioModel, data: Any, rates: Array, leg: Leg, number: int) -> LegRates:
    pin = import_pinocchio()
    model, name = machine.model, f"leg{number}"
    link = model.getJointId(f"{name}_base")
    world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    names = {"base": f"{name}_base", "platform": f"{name}_platform", "middle": f"{name}_slide"}
    slides = [_row(model, rates, names[joint]) for joint in slide_joints(leg)]
    return LegRates(
        data.oMi[link].rotation[:, 2],
        (pin.getJointJacobian(model, data, link, world) @ rates)[3:],
        np.array(slides).reshape(-1, 6),
    )
