"""Poses of the platform, boxes of poses, and paths."""

from gsp.geometry.pose.batch import Batched, unchecked
from gsp.geometry.pose.boxes import PoseBox
from gsp.geometry.pose.paths import PosePath
from gsp.geometry.pose.poses import Pose

__all__ = ["Batched", "Pose", "PoseBox", "PosePath", "unchecked"]
