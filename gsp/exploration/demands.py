"""What a task demands besides indices and limits: the forces of its loads."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.exploration.task import Task
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.model.design import Design
from gsp.statics import gravity_wrench

# Columns: the greatest actuator force and torque.
FORCE, TORQUE = "actuator_force", "actuator_torque"


def demands(design: Design, feasible: Mask | None, pose: Pose, task: Task) -> dict[str, Any]:
    """Return the columns of the loads of a task for a design.

    Parameters
    ----------
    design : Design
    feasible : (n,) bool array or None
        Which poses are within the limits of the task; None if it has none.
    pose : Pose of batch shape (n,)
        All poses of the task.
    task : Task

    Returns
    -------
    dict
        "actuator_force" and "actuator_torque": the greatest magnitudes at the poses within the
        limits, if the task has loads.
    """
    row: dict[str, Any] = {}
    if is_loaded(task):
        forces = greatest_forces(design, pose if feasible is None else pose[feasible], task)
        for column, chosen in ((FORCE, ~design.angular), (TORQUE, design.angular)):
            if chosen.any():
                row[column] = _largest(forces[:, chosen])
    return row


def is_loaded(task: Task) -> bool:
    """Return whether a task has loads, which the actuators hold."""
    return task.payload is not None or task.wrench is not None


def greatest_forces(design: Design, pose: Pose, task: Task) -> Array:
    """Return the magnitudes of the actuator forces that balance the loads of a task.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (n,)
    task : Task

    Returns
    -------
    (n, number of actuators) array [N; N · unit of the design for A1 actuators]
        inf at singular poses, NaN at undefined ones.

    Raises
    ------
    InvalidInput
        If masses of links do not fit the number of legs.
    """
    load = np.zeros((pose.size, 6)) if task.wrench is None else np.tile(task.wrench, (pose.size, 1))
    if task.payload is not None:
        load += gravity_wrench(design, pose, task.payload)
    posture = design.at(pose)
    known = np.asarray(np.isfinite(load).all(axis=-1))
    forces = np.abs(posture.actuator_forces(np.where(known[:, None], load, 0.0)))
    forces[posture.singular()] = np.inf
    forces[~known] = np.nan
    return np.asarray(forces)


def _largest(values: Array) -> float:
    known = values[~np.isnan(values)]
    return float(known.max()) if known.size else float("nan")
