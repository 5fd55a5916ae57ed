"""How far our rows agree with what Pinocchio derives from the multibody model alone.

Pinocchio gets joints, placements and a configuration. That the loops close says that the
configuration is the posture; the null space of its constraint Jacobian then gives the rates of all
joints for any motion of the platform, without a line of our algebra.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from gsp.bridges.pinocchio_model import PinocchioModel, to_pinocchio
from gsp.design import Design
from gsp.legs import LEGS, Leg
from gsp.pose import Pose
from gsp.posture import Posture
from gsp.vectors import Array, cross


class Agreement(NamedTuple):
    """Largest differences between Pinocchio and our rows at one posture.

    Attributes
    ----------
    closure : float
        Residual of the loops: distances as a share of `design.size`, rotation matrices entrywise.
    actuators : float
        Rates of the actuators for the six unit twists, relative to the largest entry of the row
        (of the homogeneous Jacobian of length `design.size`).
    passive : float
        Rates of the passive joints in the control number, relative to the largest of the leg: the
        turning of the unit vector of the leg seen from base and from platform, compared as sums of
        squares (as 6 × 6 forms, so that no choice of axes enters), and each slide.
    """

    closure: float
    actuators: float
    passive: float


def agreement(design: Design, pose: Pose) -> Agreement:
    """Compare a posture with Pinocchio's kinematics of the same mechanism.

    Parameters
    ----------
    design : Design
    pose : Pose
        A single pose, at which all legs are defined.

    Raises
    ------
    UndefinedPosture, InvalidInput
        See `to_pinocchio`.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> max(agreement(design, design.home)) < 1e-12
    True
    """
    machine = to_pinocchio(design, pose)
    posture = design.at(pose)
    data = machine.model.createData()
    scale = design.size or 1.0
    rates = loop_rates(machine, data, pose)
    weights = np.repeat([1.0, 1.0 / scale], 3)
    theirs = np.stack([_row(machine.model, rates, name) for name in design.joint_names])
    theirs = theirs * np.where(posture.angular, scale, 1.0)[:, None] * weights
    ours = posture.homogeneous(scale)
    return Agreement(
        closure_residual(machine, data, scale),
        float((np.abs(theirs - ours).max(axis=1) / np.abs(ours).max(axis=1)).max()),
        _passive_difference(posture, machine, data, rates, scale),
    )


def closure_residual(machine: PinocchioModel, data: Any, scale: float = 1.0) -> float:
    """Largest gap of a loop: translations divided by `scale`, rotations entrywise from I."""
    import pinocchio as pin

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
    import pinocchio as pin

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


def _row(model: Any, rates: Array, name: str, place: int = 0) -> Array:
    return np.asarray(rates[model.joints[model.getJointId(name)].idx_v + place])


def _passive_difference(
    posture: Posture, machine: PinocchioModel, data: Any, rates: Array, scale: float
) -> float:
    """Compare leg by leg; columns of ω are divided by `scale`, turns multiplied by it."""
    ours = posture.passive_rates(scale)
    weights = np.repeat([1.0, 1.0 / scale], 3)
    differences, start = [], 0
    for i, leg in _in_order_of_kinds(posture.design):
        stop = start + 4 + leg.base_line + leg.platform_line + (leg.name == "A1")
        rows = ours[start:stop] * scale * weights
        turns, slides = _passive_of_leg(leg, i, machine, data, rates, scale)
        turns, slides = turns * weights, slides * weights
        largest = np.abs(rows).max()
        forms = (rows[:2].T @ rows[:2], rows[2:4].T @ rows[2:4])
        gaps = [
            np.abs(t.T @ t - form).max() / largest**2 for t, form in zip(turns, forms, strict=True)
        ]
        gaps.append(np.abs(slides - rows[4:]).max(initial=0.0) / largest)
        differences.append(max(gaps))
        start = stop
    return float(max(differences))


def _in_order_of_kinds(design: Design) -> list[tuple[int, Leg]]:
    """Legs as `Posture.passive_rates` stacks them."""
    return [(i, leg) for kind in LEGS for i, leg in enumerate(design.legs) if leg is kind]


def _passive_of_leg(
    leg: Leg, i: int, machine: PinocchioModel, data: Any, rates: Array, scale: float
) -> tuple[Array, Array]:
    """u̇ · scale seen from base and platform (2, 3, 6), and passive slides (j, 6), by Pinocchio."""
    import pinocchio as pin

    model, name = machine.model, f"leg{i + 1}"
    link = model.getJointId(f"{name}_base")
    world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    spin = (pin.getJointJacobian(model, data, link, world) @ rates)[3:]
    u = data.oMi[link].rotation[:, 2]
    seen = [cross(w.T, u).T * scale for w in (spin, spin - np.eye(6)[3:])]
    slides = []
    if leg.base_line:
        slides.append(_row(model, rates, f"{name}_base"))
    if leg.platform_line:
        slides.append(_row(model, rates, f"{name}_platform"))
    if leg.name == "A1":
        slides.append(_row(model, rates, f"{name}_slide"))
    return np.stack(seen), np.array(slides).reshape(-1, 6)
