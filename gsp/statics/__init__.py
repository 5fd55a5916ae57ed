"""Statics: stiffness and compliance, eigenscrews, errors of the pose, weights."""

from gsp.statics.accuracy import PoseErrors, pose_errors
from gsp.statics.screws import Eigenscrews, eigenscrews
from gsp.statics.stiffness_matrix import compliance, directional_stiffness, stiffness
from gsp.statics.weights import Masses, gravity_wrench, holding_forces

__all__ = [
    "Eigenscrews",
    "Masses",
    "PoseErrors",
    "compliance",
    "directional_stiffness",
    "eigenscrews",
    "gravity_wrench",
    "holding_forces",
    "pose_errors",
    "stiffness",
]
