"""Statics: stiffness and compliance, eigenscrews, errors of the pose."""

from gsp.statics.accuracy import PoseErrors, pose_errors
from gsp.statics.eigenscrews import Eigenscrews, eigenscrews
from gsp.statics.stiffness import compliance, stiffness

__all__ = [
    "Eigenscrews",
    "PoseErrors",
    "compliance",
    "eigenscrews",
    "pose_errors",
    "stiffness",
]
