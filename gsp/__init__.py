"""Generalized Stewart–Gough mechanisms, catalogued and ranked."""

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from gsp import bridges, catalogue, determinant, families, indices, planar, sweeps
from gsp.design import Design, read_design
from gsp.ellipsoid import Ellipsoid
from gsp.errors import GspError
from gsp.indices.characteristic_length import characteristic_length
from gsp.indices.motion import instantaneous_motion
from gsp.kinematics import ForwardSolution, forward
from gsp.mechanism import Mechanism
from gsp.pose import Pose, PoseBox
from gsp.posture import Posture
from gsp.ranking import evaluate, rank
from gsp.realtime import prepare
from gsp.sweeps import sweep
from gsp.version import __version__

if TYPE_CHECKING:
    from gsp import published, workspace

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
    "bridges",
    "catalogue",
    "characteristic_length",
    "determinant",
    "evaluate",
    "families",
    "forward",
    "indices",
    "instantaneous_motion",
    "planar",
    "prepare",
    "published",
    "rank",
    "read_design",
    "sweep",
    "sweeps",
    "workspace",
]

# Rooms that a ranking never enters: they are imported when they are first named.
LATE = frozenset({"published", "workspace"})


def __getattr__(name: str) -> ModuleType:
    if name in LATE:
        return import_module(f"gsp.{name}")
    raise AttributeError(f"module 'gsp' has no attribute {name!r}")
