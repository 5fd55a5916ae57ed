"""Forward kinematics of single poses, batches and logs, with little delay."""

from gsp.kinematics.forward import ForwardSolution, forward
from gsp.kinematics.planar import PlanarModes, planar_forward, planar_modes
from gsp.kinematics.prepared import prepare
from gsp.kinematics.track import Track, track

__all__ = [
    "ForwardSolution",
    "PlanarModes",
    "Track",
    "forward",
    "planar_forward",
    "planar_modes",
    "prepare",
    "track",
]
