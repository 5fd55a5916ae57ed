"""Frames: placements, screw motions, and changes of axes and reference points."""

from gsp.geometry.frames.changes import (
    act_jacobian,
    act_twist,
    act_wrench,
    action_matrix,
    dual_action_matrix,
    jacobian_at,
    twist_at,
    wrench_at,
)
from gsp.geometry.frames.placements import Placement, force, frame, motion, placement_of, se3
from gsp.geometry.frames.screws import (
    compose,
    exp3,
    exp6,
    interpolate,
    inverse,
    log3,
    log6,
)

__all__ = [
    "Placement",
    "act_jacobian",
    "act_twist",
    "act_wrench",
    "action_matrix",
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
    "se3",
    "twist_at",
    "wrench_at",
]
