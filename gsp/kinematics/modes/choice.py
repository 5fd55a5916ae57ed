"""The assembly mode nearest to a pose."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.frames import log3
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.kinematics.modes.modes import assembly_modes
from gsp.kinematics.newton.centred import centred
from gsp.model.design import Design


class Mode(NamedTuple):
    """One assembly mode: its pose, of batch shape (), and its greatest joint error [1, rad]."""

    pose: Pose
    residual: float


def nearest_mode(design: Design, joints: Array, guess: Pose, tolerance: float) -> Mode | None:
    """Return the regular mode nearest to a pose, on the stated branches; None if there is none.

    Parameters
    ----------
    design : Design
        With six actuators.
    joints : (6,) array [unit of the design, rad]
    guess : Pose of batch shape () [unit of the design]
        Distances from it are those of `gsp.nearest`.
    tolerance : float [1, rad]
        Greatest joint error of a mode, as in `gsp.forward`.
    """
    # In the centred frames, as residuals are rounded in those of a design that is far from them.
    system = centred(design)
    modes = assembly_modes(system.design, system.joints_from(joints))
    regular = np.flatnonzero(
        (modes.side != 0.0) & (modes.residual <= tolerance) & modes.on_branches
    )
    if regular.size == 0:
        return None
    chosen = regular[_distances(modes.poses[regular], system.pose_from(guess)).argmin()]
    return Mode(system.pose_to(modes.poses[int(chosen)]), float(modes.residual[chosen]))


def _distances(poses: Pose, pose: Pose) -> Array:
    """Return the distances of poses (n,) of centred frames from one, (n,) [1]."""
    turns = log3(pose.rotation.T @ poses.rotation)
    return np.asarray(np.hypot(norm(poses.position - pose.position), norm(turns)))
