"""Forward kinematics of single poses, batches and logs, with little delay."""

from gsp.kinematics.forward_solution import ForwardSolution, forward
from gsp.kinematics.modes import AssemblyModes, assembly_modes
from gsp.kinematics.nearest_pose import Nearest, nearest
from gsp.kinematics.planar import PlanarModes, planar_forward, planar_modes
from gsp.kinematics.prepared import prepare
from gsp.kinematics.tracks import Track, track
from gsp.kinematics.travels import Travel, travel

__all__ = [
    "AssemblyModes",
    "ForwardSolution",
    "Nearest",
    "PlanarModes",
    "Track",
    "Travel",
    "assembly_modes",
    "forward",
    "nearest",
    "planar_forward",
    "planar_modes",
    "prepare",
    "track",
    "travel",
]
