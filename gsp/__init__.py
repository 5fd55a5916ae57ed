"""Generalized Stewart–Gough mechanisms, catalogued and ranked."""

from __future__ import annotations

from importlib import import_module

# Nothing else is imported: until the command line runs, Ctrl-C is a traceback.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from gsp import (
        bridges,
        calibration,
        catalogue,
        determinant,
        evaluation,
        exploration,
        families,
        geometry,
        indices,
        kinematics,
        limits,
        planar,
        plots,
        proof,
        published,
        ranking,
        statics,
        sweeps,
        workspace,
    )
    from gsp.calibration import Calibration, calibrate
    from gsp.errors import GspError
    from gsp.evaluation.evaluations import evaluate
    from gsp.exploration import Space, Task, read_task
    from gsp.families.circular import hexapod
    from gsp.geometry.ellipsoid import Ellipsoid
    from gsp.geometry.pose import Pose, PoseBox, PosePath
    from gsp.indices.characteristic_length import characteristic_length
    from gsp.indices.motion import instantaneous_motion
    from gsp.kinematics.forward_solution import ForwardSolution, forward
    from gsp.kinematics.modes import AssemblyModes, assembly_modes
    from gsp.kinematics.nearest_pose import Nearest, nearest
    from gsp.kinematics.prepared import prepare
    from gsp.kinematics.tracks import Track, track
    from gsp.kinematics.travels import Travel, travel
    from gsp.limits import Feasibility, Limits, feasible
    from gsp.model.design import Design, read_design
    from gsp.model.drives import Crank, Slider
    from gsp.model.mechanism import Mechanism
    from gsp.model.posture import Posture
    from gsp.proof.boxes import certify
    from gsp.proof.certificate import Certificate
    from gsp.proof.distance import singularity_distance
    from gsp.proof.extremes import bounds
    from gsp.proof.largest import largest_box
    from gsp.proof.maximum import certify_maximum
    from gsp.proof.paths import certify_path
    from gsp.proof.tolerances import Tolerances
    from gsp.ranking import rank
    from gsp.statics.stiffness_matrix import stiffness
    from gsp.sweeps import sweep
    from gsp.version import __version__

PACKAGES = (
    "bridges",
    "calibration",
    "catalogue",
    "determinant",
    "evaluation",
    "exploration",
    "families",
    "geometry",
    "indices",
    "kinematics",
    "limits",
    "planar",
    "plots",
    "proof",
    "published",
    "ranking",
    "statics",
    "sweeps",
    "workspace",
)

# Where each public name is defined. A module is imported when one of its names is first used.
HOMES = {
    "Calibration": "gsp.calibration",
    "Certificate": "gsp.proof",
    "Crank": "gsp.model.drives",
    "Design": "gsp.model.design",
    "Ellipsoid": "gsp.geometry.ellipsoid",
    "Feasibility": "gsp.limits",
    "ForwardSolution": "gsp.kinematics.forward_solution",
    "GspError": "gsp.errors",
    "Limits": "gsp.limits",
    "Mechanism": "gsp.model.mechanism",
    "Pose": "gsp.geometry.pose",
    "PoseBox": "gsp.geometry.pose",
    "PosePath": "gsp.geometry.pose",
    "Posture": "gsp.model.posture",
    "Slider": "gsp.model.drives",
    "Space": "gsp.exploration",
    "Task": "gsp.exploration",
    "Tolerances": "gsp.proof",
    "bounds": "gsp.proof",
    "calibrate": "gsp.calibration",
    "certify": "gsp.proof",
    "certify_maximum": "gsp.proof",
    "certify_path": "gsp.proof",
    "largest_box": "gsp.proof",
    "singularity_distance": "gsp.proof",
    "characteristic_length": "gsp.indices.characteristic_length",
    "evaluate": "gsp.evaluation",
    "feasible": "gsp.limits",
    "forward": "gsp.kinematics.forward_solution",
    "hexapod": "gsp.families.circular",
    "instantaneous_motion": "gsp.indices.motion",
    "prepare": "gsp.kinematics.prepared",
    "rank": "gsp.ranking",
    "read_design": "gsp.model.design",
    "read_task": "gsp.exploration",
    "stiffness": "gsp.statics",
    "sweep": "gsp.sweeps",
    "AssemblyModes": "gsp.kinematics.modes",
    "assembly_modes": "gsp.kinematics.modes",
    "Track": "gsp.kinematics.tracks",
    "track": "gsp.kinematics.tracks",
    "Nearest": "gsp.kinematics.nearest_pose",
    "Travel": "gsp.kinematics.travels",
    "nearest": "gsp.kinematics.nearest_pose",
    "travel": "gsp.kinematics.travels",
    "__version__": "gsp.version",
}

__all__ = [
    "AssemblyModes",
    "Calibration",
    "Certificate",
    "Crank",
    "Design",
    "Ellipsoid",
    "Feasibility",
    "ForwardSolution",
    "GspError",
    "Limits",
    "Mechanism",
    "Nearest",
    "Pose",
    "PoseBox",
    "PosePath",
    "Posture",
    "Slider",
    "Space",
    "Task",
    "Tolerances",
    "Track",
    "Travel",
    "__version__",
    "assembly_modes",
    "bounds",
    "bridges",
    "calibrate",
    "calibration",
    "catalogue",
    "certify",
    "certify_maximum",
    "certify_path",
    "characteristic_length",
    "determinant",
    "evaluate",
    "evaluation",
    "exploration",
    "families",
    "feasible",
    "forward",
    "geometry",
    "hexapod",
    "indices",
    "instantaneous_motion",
    "kinematics",
    "largest_box",
    "limits",
    "nearest",
    "planar",
    "plots",
    "prepare",
    "proof",
    "published",
    "rank",
    "ranking",
    "read_design",
    "read_task",
    "singularity_distance",
    "statics",
    "stiffness",
    "sweep",
    "sweeps",
    "track",
    "travel",
    "workspace",
]


def __getattr__(name: str) -> Any:
    if name in PACKAGES:
        return import_module(f"gsp.{name}")
    if name in HOMES:
        value = getattr(import_module(HOMES[name]), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'gsp' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
