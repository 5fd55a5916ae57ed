"""Poses of the platform, and boxes of poses."""

from gsp.geometry.pose.batch import Batched, unchecked
from gsp.geometry.pose.boxes import PoseBox
from gsp.geometry.pose.poses import Pose

__all__ = ["Batched", "Pose", "PoseBox", "unchecked"]
