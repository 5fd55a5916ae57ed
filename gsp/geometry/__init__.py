"""Vectors, rotations, frames, poses, boxes of poses, the operation ellipsoid."""

from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.frames import (
    act_jacobian,
    act_twist,
    act_wrench,
    action_matrix,
    dual_action_matrix,
    jacobian_at,
    twist_at,
    wrench_at,
)
from gsp.geometry.placements import Placement, force, frame, motion, placement_of, se3
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import angles_from_rotation, rotation_from_angles
from gsp.geometry.screws import compose, exp3, exp6, interpolate, inverse, log3, log6

__all__ = [
    "Ellipsoid",
    "Placement",
    "Pose",
    "PoseBox",
    "act_jacobian",
    "act_twist",
    "act_wrench",
    "action_matrix",
    "angles_from_rotation",
    "compose",
    "dual_action_matrix",
    "exp3",
    "exp6",
    "force",
    "frame",
    "interpolate",
    "inverse",
    "jacobian_at",
    "log3",
    "log6",
    "motion",
    "placement_of",
    "rotation_from_angles",
    "se3",
    "twist_at",
    "wrench_at",
]
