"""Generalized Stewart–Gough mechanisms, catalogued and ranked."""

from gsp import catalogue, determinant, families, indices, published, sweeps
from gsp.design import Design, read_design
from gsp.ellipsoid import Ellipsoid
from gsp.errors import GspError
from gsp.kinematics import ForwardSolution, forward
from gsp.mechanism import Mechanism
from gsp.pose import Pose, PoseBox
from gsp.posture import Posture
from gsp.ranking import evaluate, rank
from gsp.sweeps import sweep
from gsp.version import __version__

__all__ = [
    "Design",
    "Ellipsoid",
    "ForwardSolution",
    "GspError",
    "Mechanism",
    "Pose",
    "PoseBox",
    "Posture",
    "__version__",
    "catalogue",
    "determinant",
    "evaluate",
    "families",
    "forward",
    "indices",
    "published",
    "rank",
    "read_design",
    "sweep",
    "sweeps",
]
