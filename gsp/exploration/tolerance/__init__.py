"""Effects of manufacturing errors on indices and on the pose."""

from gsp.exploration.tolerance.deviations import Deviations
from gsp.exploration.tolerance.of_indices import IndexTolerance, index_tolerance
from gsp.exploration.tolerance.of_poses import PoseTolerance, pose_tolerance

__all__ = ["Deviations", "IndexTolerance", "PoseTolerance", "index_tolerance", "pose_tolerance"]
