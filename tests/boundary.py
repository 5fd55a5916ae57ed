"""Every public callable, with example arguments found by the names of its parameters."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FunctionType, ModuleType
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation, RotationSpline

import gsp
from gsp import catalogue, planar, sweeps, workspace
from gsp.families import lee
from gsp.families.nawratil import motion
from gsp.limits import Limits
from gsp.model.design.anchored import PARAMETERS

# --- what is public ---

# Special methods that take what a user gives.
OPERATORS = frozenset({"__getitem__", "__call__", "__contains__", "__matmul__", "__mul__"})

# Records that the library makes: users read them and call their methods, which are tested.
RESULTS = frozenset({
    "Agreement", "BifurcationPoint", "Certificate", "Curve", "Estimate", "Inscribed", "Polygons",
    "Calibration", "Gradient", "IndexTolerance", "PoseTolerance", "Region", "RegularPart", "Sdf",
    "Worst",
    "Bounds", "CertifiedMaximum", "Feasibility", "ForwardSolution", "LargestAround", "LargestBox",
    "Ledger",
    "PathCertificate", "SingularityDistance", "Slip", "Track", "Travel", "Nearest", "AssemblyModes",
    "PlanarModes", "PoseErrors", "Eigenscrews", "LabelledBoundary",
    "Film", "IndexMap", "IndexSample", "LegRates", "Maximum", "Path", "Piece",
    "PinocchioModel", "Placement", "PlanarComponent", "PlanarConstraint", "PlanarPosture",
    "Posture", "Rates", "Record", "Section", "Separated", "Simulation", "Surface", "Urdf", "Volume",
})  # fmt: skip


def modules() -> Iterator[ModuleType]:
    """The public face, its packages, and the modules that these name."""
    found = [gsp, *(importlib.import_module(f"gsp.{name}") for name in gsp.PACKAGES)]
    for module in found:
        yield module
        for name in module.__all__:
            value = getattr(module, name)
            if isinstance(value, ModuleType) and value not in found:
                found.append(value)


def stated(module: ModuleType) -> Iterator[Any]:
    """What a module states in `__all__`, which every public module has."""
    yield from (getattr(module, name) for name in module.__all__)


def members(kind: type) -> Iterator[tuple[str, str]]:
    """Kind ("class" or "instance") and name of the public methods of a class and of its bases."""
    bases = [base for base in kind.__mro__ if base.__module__.startswith("gsp.")]
    for name, value in {k: v for base in reversed(bases) for k, v in vars(base).items()}.items():
        if name.startswith("_") and name not in OPERATORS:
            continue
        if isinstance(value, classmethod | staticmethod):
            yield "class", name
        elif isinstance(value, FunctionType):
            yield "instance", name


class Public(NamedTuple):
    """A public callable, and the name of the class of which it is a method of an instance."""

    function: Callable[..., Any]
    of: str = ""


@cache
def public() -> dict[str, Public]:
    """Functions, constructors and methods, by their full names."""
    found: dict[str, Public] = {}
    for value in (value for module in modules() for value in stated(module)):
        if isinstance(value, FunctionType) or type(value).__name__ == "_lru_cache_wrapper":
            found[f"{value.__module__}.{value.__name__}"] = Public(value)
        elif isinstance(value, type) and not issubclass(value, BaseException):
            place = f"{value.__module__}.{value.__qualname__}"
            if value.__name__ not in RESULTS:
                found[place] = Public(value)
            for kind, name in members(value):
                of = value.__name__ if kind == "instance" else ""
                found[f"{place}.{name}"] = Public(getattr(value, name), of)
    return {name: found[name] for name in sorted(found) if name.startswith("gsp.")}


# --- example arguments ---


def _fields(record: Any) -> dict[str, Any]:
    return {field.name: getattr(record, field.name) for field in fields(record)}


def lee_family(number: float) -> gsp.Design:
    """Return a design of a family of one parameter."""
    return lee.octahedral_3_3(1.0, 1.0 + number)


MIXED = catalogue.design("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
POSE = MIXED.home
JOINTS = MIXED.at(POSE).joints
DESIGN = MIXED.replace(strokes=np.stack((0.9 * JOINTS, 1.1 * JOINTS), axis=1))
SPHERE = gsp.Ellipsoid(100.0)
HEXAPOD = catalogue.design("workspace-6-3")
BOX = gsp.PoseBox.around(POSE, [1, 1, 1, 0.01, 0.01, 0.01])
UNTURNED = gsp.PoseBox([0, 0, 0], [0, 0, 0])
TINY = gsp.PoseBox.around(gsp.Pose([0.0, 0.0, 10.0]), [0.1, 0.1, 0.1, 0.01, 0.01, 0.01])
ANGLE = np.arange(3) * 2 * np.pi / 3
TRIANGLE = np.stack((np.cos(ANGLE), np.sin(ANGLE)), axis=1)
PLANAR = planar.PlanarDesign(
    ["D1"] * 3, 2.0 * TRIANGLE, TRIANGLE @ [[0.9, 0.4], [-0.4, 0.9]], strokes=[[0.5, 2.5]] * 3,
)  # fmt: skip
PLANAR_POSE = planar.PlanarPose([0.1, 0.2], 0.3)
OCTAHEDRON = catalogue.design("lee-2000-3-3")
ONE_MODE = gsp.kinematics.AssemblyModes(
    joints=np.ones(6), on_branches=np.ones(1, dtype=bool),
    poses=gsp.Pose([[0.0, 0.0, 1.0]]), residual=np.zeros(1), side=np.ones(1), condition=np.ones(1),
    multiplicity=np.ones(1, dtype=int), certified=np.zeros(1, dtype=bool), radius=np.zeros(1),
    n_complex=16, n_singular=0, n_infinite=0, n_lost=0, n_paths=16, status="found",
)  # fmt: skip
PATH = sweeps.translation(POSE, "z", [0.0, 1.0])
NODES = {"poses": gsp.Pose([POSE.position, POSE.position + 1.0, POSE.position], POSE.rotation),
         "times": [0.0, 1.0, 2.0], "motion": "spline", "speeds": np.full(6, 1e3),
         "accelerations": np.full(6, 1e5)}  # fmt: skip
SPLINES = {"position": CubicSpline([0.0, 1.0], [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]),
           "rotation": RotationSpline([0.0, 1.0], Rotation.identity(2))}  # fmt: skip


TASK = gsp.Task(poses=BOX, wanted="mean CTN", samples=2)
DEVIATIONS = gsp.exploration.Deviations(base_points=0.01, joints=0.01)
SPACE = gsp.Space(lee_family, {"number": (0.5, 1.5)})
HEXAPODS = gsp.Space(
    gsp.hexapod, {"height": (1.0, 2.0)},
    fixed={"base_radius": 2.0, "base_angle": 0.3, "platform_radius": 1.0, "platform_angle": 0.3},
)  # fmt: skip
FRONT = pd.DataFrame({"score": [1.0, 0.5], "feasible": [0.5, 1.0]})
MASSES = gsp.statics.Masses(platform=2.0, lower=0.5, upper=0.2)


def flat_region() -> Any:
    """Return a region in a plane, of few cells."""
    plane = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
    return workspace.fixed_orientation(HEXAPOD, plane=plane, resolution=2.5)


class Made(Mapping[str, Any]):
    """A mapping whose values are made when they are first read, each once."""

    def __init__(self, makers: Mapping[str, Callable[[], Any]]) -> None:
        self._makers = makers
        self._made: dict[str, Any] = {}

    def __getitem__(self, key: str) -> Any:
        if key not in self._made:
            self._made[key] = self._makers[key]()
        return self._made[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)


@cache
def instances() -> Mapping[str, Any]:
    """An instance of each class whose methods are public."""
    found = Made({
        "Design": lambda: DESIGN, "Pose": lambda: POSE,
        "PosePath": lambda: gsp.PosePath.through(NODES["poses"]),
        "PoseBox": lambda: BOX, "Ellipsoid": lambda: SPHERE,
        "Posture": lambda: DESIGN.at(POSE), "Mechanism": lambda: DESIGN.mechanism,
        "Limits": Limits,
        "Feasibility": lambda: gsp.feasible(HEXAPOD, gsp.Pose([0, 0, 10])),
        "ForwardSolution": lambda: gsp.forward(DESIGN, DESIGN.at(POSE).joints, POSE),
        "Index": lambda: gsp.indices.INDICES["control_number"],
        "Maximum": lambda: gsp.determinant.maximum(OCTAHEDRON),
        "PlanarDesign": lambda: PLANAR, "PlanarPose": lambda: PLANAR_POSE,
        "PlanarPosture": lambda: PLANAR.at(PLANAR_POSE),
        "PlanarMechanism": lambda: planar.mechanisms()[0],
        "PlanarComponent": lambda: planar.planar_components(PLANAR)[0],
        "Shells": lambda: workspace.exact_shells(HEXAPOD),
        "Section": lambda: workspace.section(
            HEXAPOD, rotation=np.eye(3), rays=4, connecting=False
        ),
        "Volume": lambda: found["Shells"].volume(),
        "Region": lambda: workspace.fixed_orientation(HEXAPOD, resolution=2.5),
        "RegularPart": lambda: found["Region"].regular_parts()[0],
        "IndexSample": lambda: found["Region"].index_sample("σ_min", 2, length=1.0),
        "LabelledBoundary": lambda: workspace.boundary_curves(flat_region(), most=2),
        "Film": lambda: gsp.plots.animate(MIXED, PATH, frames=2),
        "IndexMap": lambda: workspace.index_map(DESIGN, BOX, 2, ["CTN"], length=100.0),
        "Surface": lambda: workspace.surface(HEXAPOD, counts=(4, 4), starts=1),
        "Solids": gsp.bridges.Solids, "Urdf": lambda: gsp.bridges.to_urdf(DESIGN, POSE),
        "Sdf": lambda: gsp.bridges.to_sdf(DESIGN, POSE), "Masses": lambda: MASSES,
        "Record": lambda: gsp.published.select("TozKucuk2016")[0],
        "Store": lambda: gsp.determinant.Store("sqlite://"),
        "Tolerances": gsp.proof.Tolerances,
        "Certificate": lambda: gsp.certify(HEXAPOD, TINY),
        "Neighbourhood": lambda: gsp.determinant.Neighbourhood(
            home=POSE, centre=[0.0, 0.0, 1.0], displacement=1.0, angle=0.5
        ),
        "Task": lambda: TASK, "Space": lambda: HEXAPODS, "Deviations": lambda: DEVIATIONS,
        "PoseTolerance": lambda: gsp.exploration.pose_tolerance(
            DESIGN, POSE, DEVIATIONS, samples=4
        ),
        "PathCertificate": lambda: gsp.certify_path(DESIGN, NODES["poses"]),
        "Calibration": lambda: gsp.calibrate(DESIGN, [JOINTS], POSE.reshape(1)),
    })  # fmt: skip
    return found


# Arguments whose examples are instances, computed when they are needed.
COMPUTED = {
    "section": "Section", "boundary": "LabelledBoundary", "mapped": "IndexMap", "shells": "Shells",
    "surface": "Surface",
}  # fmt: skip

EXAMPLES: dict[str, Any] = {
    "design": DESIGN, "designs": [DESIGN], "template": DESIGN, "pose": POSE, "guess": POSE,
    "start": POSE, "end": POSE, "other": POSE, "home": POSE, "box": BOX, "ellipsoid": SPHERE,
    "posture": DESIGN.at(POSE), "length": 100.0, "maximum": 1e7, "radius": 50.0, "limits": None,
    "mechanism": DESIGN.mechanism, "name": "D1^6", "text": "CTN", "indices": "CTN", "by": "CTN",
    "index": "condition_number", "order": "rpy", "degrees": False, "unit": "mm", "source": "x",
    "joints": DESIGN.at(POSE).joints, "tolerance": 1e-9, "max_iterations": 5, "seed": 1, "rng": 1,
    "starts": 1, "rays": 4, "counts": 2, "n": 2, "most": 5, "position": POSE.position,
    "rotation": POSE.rotation, "placement": POSE, "outer": POSE, "inner": POSE, "value": POSE,
    "twist": np.ones(6), "wrench": np.ones(6), "actuator_forces": np.ones(6), "k": 1.0,
    "angles": np.array([0.1, 0.2, 0.3]),
    "preload": None, "joint_errors": 0.1, "stiffness": np.eye(6), "jacobian": np.eye(6),
    "point": np.ones(3), "vector": np.ones(3) / 3, "share": 0.5,
    "xyzw": [0.0, 0.0, 0.0, 1.0], "half_widths": np.ones(6) / 100, "semi_axes": [1.0, 2.0, 3.0],
    "center": [0.0, 0.0, 1.0], "factor": 2.0, "progress": None, "workers": 1, "executor": None,
    "budget": 50, "largest_gap": 0.2, "least_margin": 1e-3, "skip": False,
    "out": None, "parts": None, "resume": False, "backend": "compiled", "method": "halton",
    "legs": ["D1"] * 6, "base_points": HEXAPOD.base_points, "strokes": HEXAPOD.strokes,
    "platform_points": HEXAPOD.platform_points, "base_directions": None, "form": "mjcf",
    "platform_directions": None, "characteristic_length": 1.0, "need": "length", "given": "CTN",
    "values": np.ones((2, 2)), "joint": 0, "constraints": ["D1"] * 6, "counts_of": 1,
    "solids": None, "gravity": (0.0, 0.0, -9.81), "servo_frequency": 300.0,
    "drives": None, "masses": MASSES, "duration": 0.01,
    "program": "pinocchio", "graph": catalogue.kinematic_graph(DESIGN.mechanism), "domain": BOX,
    "store": False, "wait": False, "url": "sqlite://", "key": "x", "seconds": 1.0, "entry": {},
    "position_of": None, "path": PATH, "start_pose": POSE, "direction": "z", "axis": "z",
    "distances": [0.0, 1.0], "u": [0.0, 1.0], "v": [0.0, 1.0], "directions": ("x", "y"),
    "angles_deg": [0.0, 5.0], "through": "platform origin", "make": lee_family, "number": 1,
    "axes": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)), "origin": None, "connecting": False,
    "a": 1.0, "b": 2.0, "h": 0.7, "alpha": 0.1, "beta": 0.2, "rho": 0.2, "theta": 0.3, "x": 0.1,
    "y": 0.2, "z": 0.9, "r": 0.5, "cosine": 0.3, "height_ratio": 0.4, "turn": (0.0, 0.0, 0.1),
    "g": 3, "t": 0.4, "mu": 0.1, "p": 0.5, "swap": None, "points": 9, "slack": 0.0,
    "heights": (0.0, 1.0), "depth": 2, "angle": 0.3, "overwrite": False, "links": None,
    "shape": (1,), "strings": "x", "base_radius": 2.0, "base_angle": 0.3, "platform_radius": 1.0,
    "platform_angle": 0.4, "height": 1.5, "arrangement": "zigzag", "frame": DESIGN.to_frame(),
    "top": "centre", "base": None,
}  # fmt: skip

FLAT = {"posture": PLANAR.at(PLANAR_POSE), "design": PLANAR, "ellipsoid": gsp.Ellipsoid([1, 2, 3])}
SIX = {"design": HEXAPOD, "limits": None}
SETS = {**SIX, "plane": None, "half_space": [0.0, 0.6, 0.8, 1.0], "resolution": 6.0, "budget": 1000}
# One file of few records, as all of them take a minute.
SMALL = [path for path in gsp.published.record_files() if path.stem == "workspace"]
PLAIN = [np.zeros(3), *np.eye(3)]


@cache
def tables() -> dict[str, Any]:
    """Return tables and results that are arguments, which are computed when a test needs them."""
    across = sweeps.plane(POSE, [0.0, 1.0, 2.0], [0.0, 1.0])
    return {
        "ranked": gsp.rank(MIXED, POSE, ["CTN", "CDN_CL"]),
        "swept": sweeps.sweep(MIXED, PATH, ["CTN"]),
        "over": sweeps.sweep(MIXED, across, ["CTN"]),
        "screws": motion.compare_screws("x", angle=[0.9, 1.0]),
        "checked": gsp.published.check("Workspace-A", places="figure", files=SMALL),
        "maximum": instances()["Maximum"],
        "flat": flat_region(),
        "arcs": instances()["Shells"].section(np.zeros(3), EXAMPLES["axes"]),
    }


@dataclass(frozen=True)
class Later:
    """An argument by its name in `tables()`."""

    name: str


# Arguments of single callables, by the end of their full name.
OVERRIDES: dict[str, dict[str, Any]] = {
    "drives.Slider": {"rod": 2.0, "branch": -1},
    "drives.Crank": {"arm": [0.5, 0.0, 0.0], "rod": 2.0, "branch": -1},
    "tolerances.Tolerances": {
        "base_points": 0.1, "platform_points": 0.1, "base_directions": 0.01,
        "platform_directions": 0.01, "joints": np.full(6, 0.1),
    },
    "drives.Drives": {"efforts": 10.0, "speeds": None},
    "to_urdf": {"floating": True},
    "weights.Masses": {
        "platform": 2.0, "centre": np.zeros(3), "lower": 0.5, "upper": 0.2, "lower_centre": 0.1,
        "upper_centre": 0.1,
    },
    "Masses.carrying": {"mass": 1.0, "centre": np.zeros(3)},
    "exports.export": {"path": "model.xml", "overwrite": True},
    "published.design": {"name": "lee-2000-3-3"},
    "Store.remove": {"value": 1.0},
    "modes.planar_modes": {"design": PLANAR, "joints": PLANAR.at(PLANAR_POSE).joints},
    "modes.planar_forward": {
        "design": PLANAR, "joints": PLANAR.at(PLANAR_POSE).joints, "guess": PLANAR_POSE,
    },
    "PlanarPosture.actuator_forces": {"wrench": [1.0, 2.0, 3.0]},
    "PlanarPosture.wrench": {"actuator_forces": [1.0, 2.0, 3.0]},
    "PlanarDesign.with_origin": {"point": [1.0, 2.0]},
    "travels.travel": {"direction": [0, 0, 1, 0, 0, 0], "farthest": 1.0, "strokes": None},
    "directional_stiffness": {"direction": [0, 0, 1]},
    "nearest_pose.nearest": {"limits": Limits(strokes=[[0, 500]] * 6)},
    "deviations.Deviations": {
        "base_points": 0.1, "platform_points": np.full((6, 3), 0.1), "base_directions": 0.01,
        "platform_directions": 0.01, "joints": np.full(6, 0.1), "distribution": "normal",
    },
    "sensitivities": {"of": DESIGN, "task": TASK, "parameters": None},
    "sobol_indices": {
        "space": SPACE, "task": gsp.Task(poses=TINY, wanted="mean CTN", samples=2),
        "confidence": 0.9, "resamples": 2,
    },
    "index_tolerance": {"task": TASK, "deviations": DEVIATIONS, "samples": 4},
    "pose_tolerance": {"deviations": DEVIATIONS, "samples": 4},
    "calibrating.calibrate": {
        "joints": [JOINTS], "poses": POSE.reshape(1), "point": np.zeros(3), "joint_errors": None,
        "pose_errors": None, "free": "joints", "loss": "linear", "loss_scale": 1.0, "guess": None,
    },
    "tracks.track": {"joints": [JOINTS, JOINTS]},
    "Neighbourhood.pose": {"displacement": np.ones(3), "rotation_vector": np.ones(3)},
    "Store.put": {"entry": {"key": "x", "value": 1.0}},
    "line_coordinates": {"start": np.ones(3), "end": np.zeros(3)},
    "bracket_determinant": {"base": np.eye(3), "platform": np.eye(3) + 1.0},
    "PoseBox.pose": {"values": np.zeros(6)},
    "condition_number_points": {"points": None},
    "characteristic_length.characteristic_length": {"method": "sphere"},
    "motion.instantaneous_motion": {"method": "control_number"},
    "limits.Limits": {"indices": ["CTN >= 0.1"], "position": None, "maximum": 1.0},
    "Design.write": {"path": "design.toml", "overwrite": True},
    "Certificate.write": {"path": "proof.json", "overwrite": True},
    "PathCertificate.write": {"path": "path.json", "overwrite": True},
    "Certificate.boxes": {"kind": "proven"},
    "read_design": {"path": "lift.toml"},
    "read_model": {"path": "lift.urdf", "base": ""},
    "kinds.separated_by_kinds": {"base": "side"},
    "kinds.by_kinds": {"base": "side"},
    "kinds.best_pose_by_kinds": {"base": "side"},
    "read_certificate": {"path": "certificate.json"},
    "read_records": {"path": SMALL[0]},
    "read_slips": {"path": SMALL[0]},
    "read_ledger": {"path": gsp.published.ledger_files()[0]},
    "task.Task": {
        "poses": BOX, "wanted": "mean CTN", "samples": 2, "length": None, "ellipsoid": None,
    },
    "task.Wanted": {"index": "CTN", "of": "mean", "weight": 1.0},
    "Task.write": {"path": "task.toml", "overwrite": True},
    "space.Space": {
        "make": lee_family, "ranges": {"number": (0.5, 1.5)}, "choices": {}, "fixed": {},
    },
    "Space.sample": {"seed": 1},
    "database.Store": {"make": True},
    "database.open_store": {"make": True},
    "exploring.explore": {
        "space": SPACE, "task": gsp.Task(poses=TINY, wanted="mean CTN", samples=2),
        "tolerance": 0.1,
    },
    "optimisation.optimising.optimise": {
        "space": SPACE, "task": gsp.Task(poses=TINY, wanted="mean CTN", samples=2),
        "tolerance": 0.1, "method": "gradient", "require": {"mean CTN": 1e-9}, "feasible": 1.0,
        "evaluations": 2, "starts": 1,
    },
    "optimisation.derivatives.gradient": {
        "space": SPACE, "task": gsp.Task(poses=TINY, wanted="mean CTN", samples=2),
        "parameters": {"number": 1.0},
    },
    **{f"exploration.fronts.{name}": {
        "table": FRONT, "objectives": {"score": "higher", "feasible": "higher"},
    } for name in ("pareto", "knee", "losses")},
    "exploration.fronts.distances": {
        "table": FRONT, "objectives": {"score": "higher", "feasible": "higher"},
        "wish": {"score": 1.0, "feasible": 1.0},
    },
    "read_task": {"path": "wish.toml"},
    "read_space": {"path": "space.toml"},
    "Space.write": {"path": "designs.toml", "overwrite": True},
    "assessing.assess": {"task": TASK, "tolerance": 0.1},
    "placement.place": {"legs": "D1-D2-D3-D4A1-A1"},
    "symmetry.symmetries": {"reflections": True, "exchange": False},
    "arrangements.placements": {"reflections": True, "exchange": False},
    "plots.fronts.front": {
        "table": FRONT, "objectives": {"score": "higher", "feasible": "higher"}, "ax": None,
    },
    "plots.explorers.explorer": {
        "table": FRONT, "objectives": {"score": "higher", "feasible": "higher"},
        "designs": None, "columns": ["score", "feasible"], "by": "score", "pose": None, "most": 5,
    },
    "plots.parallels.parallel": {
        "table": FRONT, "columns": ["score", "feasible"], "by": "score", "ax": None,
    },
    "plots.rankings.ranges": {"table": Later("ranked"), "index": "control_number"},
    "mechanism.Mechanism": {"counts": (6, 0, 0, 0, 0)},
    "PlanarMechanism": {"counts": (3, 0, 0, 0)},
    "planar.catalogue.mechanism": {"name": "D1^3"},
    "PlanarDesign": {
        "legs": ["D1"] * 3, "base_points": 2.0 * TRIANGLE, "platform_points": TRIANGLE,
        "strokes": None, "home": PLANAR_POSE, "ellipsoid": None,
    },
    "PlanarDesign.at": {"pose": PLANAR_POSE},
    "rendering.render_motion": {"poses": POSE.reshape(1)},
    "record.Index": _fields(gsp.indices.INDICES["control_number"]),
    "record.Properties": _fields(gsp.indices.INDICES["control_number"].properties),
    "record.Invariance": _fields(gsp.indices.INDICES["control_number"].invariance),
    "PlanarPose": {"position": [0.1, 0.2]},
    "PlanarPose.compose": {"other": PLANAR_POSE},
    **{f"planar.indices.{name}": FLAT for name in (
        "condition_number", "condition_number_ellipsoid", "ellipsoid_root", "control_number",
        "manipulability", "quality_index", "maximum_determinant", "metrics",
    )},
    "cubic_eigenvalues": {"metric": np.eye(3), "rates": np.eye(3)},
    "perimeter": {"triangle": TRIANGLE},
    "corner_poses": {"design": PLANAR, "starts": 20},
    "planar_components": {"design": PLANAR, "angle": 0.3},
    "planar_section": {"design": PLANAR, "origin": [0.1, 0.2]},
    "planar.published.planar_design": {"name": "lee-2000-planar"},
    "PlanarDesign.write": {"path": "design.toml", "overwrite": True},
    "read_planar_design": {"path": "plane.toml"},
    "radiating_point": {"design": PLANAR, "guess": [0.1, 0.2]},
    "planar.families.set_p": {"a": 1.0},
    "plots.modes.assembly_modes": {
        "design": OCTAHEDRON,
        "modes": ONE_MODE,
    },
    "forward_solution.forward": {"fallback": None},
    "Film.save": {"path": "film.gif", "overwrite": True},
    "plots.motions.animate": {
        "design": MIXED, "path": PATH, "indices": "CTN", "maximum": None, "frames": 2,
    },
    "plots.indices.contours": {"x": [0.0, 1.0], "y": [0.0, 1.0]},
    "screw_axes": {"axes_of": {"x": np.ones((2, 6))}, "plane": (0, 1)},
    "plots.indices.screws": {
        "table": Later("screws"), "columns": ["pitch_c"],
    },
    "plots.workspace.maps.index_map": {"index": "CTN", "value": "worst"},
    "plots.workspace.plane.arcs": {"arcs": Later("arcs")},
    **{f"nawratil.motion.{name}": {"axis": "x", "angle": [0.9, 1.0]} for name in (
        "compare_screws", "singular_angle", "turned",
    )},
    "plots.rankings.against": {
        "table": Later("ranked"), "x": "control_number", "y": "condition_number",
    },
    "plots.rankings.ranking": {
        "table": Later("ranked"), "indices": ["control_number", "condition_number"],
    },
    "plots.common.style.save": {"figure": Figure(), "path": "figure.png", "overwrite": True},
    "plots.sweeps.along": {"table": Later("swept"), "index": "control_number"},
    "plots.sweeps.over_plane": {"table": Later("over"), "index": "control_number"},
    "plots.sweeps.sweep": {"table": Later("swept"), "indices": "control_number"},
    "checking.check": {"papers": "Workspace-A", "places": "figure", "files": SMALL},
    "checking.select": {"papers": "Workspace-A", "files": SMALL},
    "checking.select_slips": {"papers": "Workspace-A", "files": SMALL},
    "checking.summary": {"checked": Later("checked")},
    "errata_page.errata": {"records": gsp.published.select("TozKucuk2016")[:2]},
    "quantities_of": {"paper": "Lee2000"},
    "parameters.maxima": {"values": [1.0], "name": "b"},
    "over_designs": {"values": [1.0], "name": "b", "pose": gsp.Pose([0.0, 0.0, 1.0])},
    "check_sweep": {"frame": Later("swept")},
    "index_columns": {"frame": Later("swept")},
    "bifurcation_point": {
        **SIX, "text": "1 1 1 1 1 1", "guess": gsp.Pose([0.0, 0.0, 13.0]), "rotation": None,
    },
    "leg_levels": {"posture": HEXAPOD.at(HEXAPOD.home)},
    "Section.find": {"text": "0 1 0 1 0 1"},
    "Section.on_rays": {"angles": [0.1, 0.2]},
    "questions.reachable": {**SETS, "rotations": UNTURNED},
    "questions.dextrous": {**SETS, "rotations": UNTURNED},
    "chains.curve_chain": {"curve": 2, "start": -3.0, "stop": 1.0},
    "labelled.boundary_curves": {"region": Later("flat"), "most": 2},
    "questions.fixed_orientation": SETS,
    "questions.orientations": {**SETS, "position": np.array([0.0, 0.0, 10.0]), "resolution": 1.0},
    "PlanarComponent.contains": {"position": np.zeros((2, 2))},
    "Region.contains": {"points": np.zeros((2, 3))},
    "Region.write": {"path": "region.csv", "overwrite": True},
    "Region.largest": {"body": "ball", "proportions": np.ones(3), "tolerance": 0.3},
    "Region.poses": {"count": 2},
    "Region.index_sample": {"indices": "σ_min", "count": 2, "length": 1.0},
    "IndexSample.share_where": {"bound": "σ_min >= 0"},
    "IndexMap.share_where": {"bound": "CTN >= 0"},
    "Region.worst": {"index": "CDN_CL", "tolerance": 0.3},
    "Region.part_of": {"point": np.array([0.0, 0.0, 10.0])},
    "Shells.section": {"origin": np.zeros(3)},
    "Shells.section_area": {"origin": np.zeros(3)},
    "Shells.label": {"active": [(0, 1)]},
    "shells.Shells": {"centers": np.zeros((2, 3)), "low": [1.0, 1.0], "high": [2.0, 2.0]},
    "exact_shells": SIX,
    "surfaces.surface": {**SIX, "counts": (4, 4)},
    "mapping.section": SIX,
    "best_central_pose": {"closed_form": lee.to_centre},
    "over_example_set": {
        "function": gsp.indices.control_number, "alpha": [0.1, 0.2], "h": [0.5, 0.9],
    },
    "symmetric_sets.set_m": {"first": np.eye(3)[:2], "second": np.eye(3)[1:] + 1.0},
    "Pose.sample": {"position": [(0, 1)] * 3, "angles": [(0, 0.1)] * 3},
    "Pose.grid": {"position": [(0, 1)] * 3, "angles": [(0, 0.1)] * 3},
    "PoseBox": {"position": [(0, 1)] * 3, "angles": [(0, 0.1)] * 3},
    "Ellipsoid.whiten": {"rotation": np.eye(3)},
    "reference_maxima.mended": {
        "found": Later("maximum"), "design": OCTAHEDRON, "quality": 0.5,
        "pose": gsp.Pose([0.0, 0.0, 1.0]),
    },
    "reference_maxima.outside": {
        "found": Later("maximum"),
        "pose": gsp.Pose([0.0, 0.0, 1.0]),
    },
    "platforms.joint_names": {"family": "lee-3-3"},
    "largest.largest_box": {"tolerance": 0.5, "budget": 5},
    "proof.maximum.certify_maximum": {"budget": 5},
    "Region.estimate": {"samples": 20},
    "around.largest_around": {"shape": "ball", "regular": True, "tolerances": None},
    "certify.certify_path": NODES,
    "PosePath.through": NODES,
    "paths.PosePath": {"position": np.ones((2, 1, 3)), "turn": np.zeros((2, 1, 3)),
                       "rotation": [np.eye(3)] * 2, "times": [0.0, 1.0, 2.0]},
    "PosePath.of_splines": SPLINES,
    "PosePath.pose": {"time": 0.5},
    "domain.Neighbourhood": {"centre": np.zeros(3), "displacement": 1.0, "angle": 0.5},
    "boxes.certify": {"design": HEXAPOD, "box": TINY, "resume": None},
    "Pose.__getitem__": {"index": ()},
    "PlanarPose.__getitem__": {"index": ()},
    "ledger.unaccounted": {
        "ledger": gsp.published.read_ledger(gsp.published.ledger_files()[0]), "records": (),
    },
}  # fmt: skip


# Arguments of callables that take any number of them: a tuple of positions, a mapping of names.
LENGTHS = {"length": 100.0, "ellipsoid": SPHERE, "maximum": 1e7}
KINDS = {key: getattr(DESIGN, key) for key in PARAMETERS if key != "legs"}
VARIADIC: dict[str, Any] = {
    "brackets.bracket": PLAIN,
    "Pose.reshape": (1,),
    "PlanarPose.reshape": (1,),
    "control_optima.control_optimum": {"strokes": None, "unit": "mm"},
    "symmetric_sets.set_m": {"strokes": None, "unit": "mm"},
    "symmetric_sets.set_n": {"strokes": None, "unit": "mm"},
    "families.set_p": {"strokes": None, "unit": "mm"},
    "PlanarDesign.replace": {"legs": ["D1"] * 3, "base_points": 2.0 * TRIANGLE},
    "Space.design": {"height": 1.0},
    "Design.replace": {"legs": [leg.name for leg in DESIGN.legs], **KINDS},
}

# Callables without a valid example: two need a graphics library, one a region in a plane.
WITHOUT_EXAMPLE = (
    "gsp.bridges.mujoco.rendering.render",
    "gsp.bridges.mujoco.rendering.render_motion",
    "gsp.workspace.sets.region.regions.Region.polygons",
)


@cache
def files() -> dict[str, bytes]:
    """Return names and contents of the files that examples read."""
    with TemporaryDirectory() as folder:
        place = Path(folder)
        HEXAPOD.write(place / "lift.toml")
        gsp.bridges.export(HEXAPOD, HEXAPOD.home, "urdf", place / "lift.urdf")
        PLANAR.write(place / "plane.toml")
        TASK.write(place / "wish.toml")
        HEXAPODS.write(place / "space.toml")
        instances()["Certificate"].write(place / "certificate.json")
        return {path.name: path.read_bytes() for path in place.iterdir()}


def write_files() -> None:
    """Write the files that examples read into the current folder."""
    for name, content in files().items():
        Path(name).write_bytes(content)


def call(function: Callable[..., Any], given: dict[str, Any]) -> Any:
    """Call a function with arguments as `arguments` returns them."""
    places = [value for name, value in given.items() if name.startswith("*")]
    return function(*places, **{k: v for k, v in given.items() if not k.startswith("*")})


def _of(table: Mapping[str, Any], name: str, default: Any) -> Any:
    """Return the entry whose key the full name of a callable ends with."""
    return next((v for k, v in table.items() if f".{name}".endswith(f".{k}")), default)


def _variadic(name: str, parameter: inspect.Parameter) -> dict[str, Any]:
    some = _of(VARIADIC, name, None)
    if some is None:
        raise LookupError(f"{name}: no example for {parameter}")
    if parameter.kind == parameter.VAR_KEYWORD:
        return dict(some)
    return {f"*{parameter.name}[{i}]": value for i, value in enumerate(some)}


def arguments(name: str) -> dict[str, Any]:
    """Return example arguments of a public callable; a place of `*args` is named "*args[0]".

    Raises
    ------
    LookupError
        If a parameter without default has no example: add one above.
    """
    own = _of(OVERRIDES, name, {})
    given: dict[str, Any] = {}
    for parameter in inspect.signature(public_callables()[name]).parameters.values():
        if parameter.kind in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL):
            given.update(_variadic(name, parameter))
        elif parameter.name in own:
            given[parameter.name] = own[parameter.name]
        elif parameter.default is not parameter.empty:
            given[parameter.name] = EXAMPLES.get(parameter.name, parameter.default)
        elif parameter.name in EXAMPLES:
            given[parameter.name] = EXAMPLES[parameter.name]
        elif parameter.name in COMPUTED:
            given[parameter.name] = instances()[COMPUTED[parameter.name]]
        else:
            raise LookupError(f"{name}: no example for {parameter.name}")
    return {k: tables()[v.name] if isinstance(v, Later) else v for k, v in given.items()}


@cache
def public_callables() -> Mapping[str, Callable[..., Any]]:
    """Return the public callables; methods are those of example instances.

    Reading a method of a class without an example instance is a KeyError.
    """
    return Made({name: partial(_bound, name, one) for name, one in public().items()})


def _bound(name: str, one: Public) -> Callable[..., Any]:
    return getattr(instances()[one.of], name.rpartition(".")[2]) if one.of else one.function


def names(*parameters: str) -> list[str]:
    """Return the full names of the public callables, of those with one of some parameters."""
    return [
        name
        for name, p in public().items()
        if not parameters or set(parameters) & set(inspect.signature(p.function).parameters)
    ]
