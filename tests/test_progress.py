"""Every function with a parameter `progress` takes a function, True, False and None."""

import inspect
import logging
import re
import sys
from functools import cache
from importlib import import_module
from pathlib import Path
from types import FunctionType

import numpy as np
import pytest

import gsp
from gsp import catalogue, determinant, exploration, published, sweeps, workspace
from gsp.bridges import proof, simulate
from gsp.cli.outputs.messages import notices
from gsp.determinant.canonical import canonical
from gsp.determinant.search import search
from gsp.determinant.store import exchange
from gsp.errors import InvalidInput
from gsp.families import lee
from gsp.planar import PlanarDesign, planar_section
from gsp.planar.pose import PlanarPose
from gsp.progress import COMPILATION, check_progress, meter
from tests.test_layers import MODULES

ROOT = Path(gsp.__file__).parents[1]
PLATFORM = lee.octahedral_3_3(a=1.0, b=2.0)
DESIGN = catalogue.design("workspace-6-3")
HOME = DESIGN.home
MIXED = catalogue.design("toz-kucuk-2016-d3-6")
NO_TURN = gsp.PoseBox([0, 0, 0], [0, 0, 0])
BOX = gsp.PoseBox.around(HOME, np.full(6, 1e-3))
TASK = gsp.Task(poses=BOX, wanted=["mean CTN", "proven worst CTN"], samples=2)
DEVIATIONS = exploration.Deviations(base_points=1e-6)
SPACE = gsp.Space(lambda a: DESIGN.scaled(a), {"a": (1.0, 1.1)})
PLANE = PlanarDesign(
    ["D1"] * 3, base_points=[[-3, 0], [3, 0], [0, 4]], platform_points=[[-1, 0], [1, 0], [0, 1]],
    strokes=[(1.0, 4.0)] * 3, home=PlanarPose([0.0, 1.0], 0.0),
)  # fmt: skip
PLANE_Y = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
FEW = {"rays": 2, "starts": 1, "connecting": False, "most": 1}


@cache
def flat(resolution):
    """A region in a plane."""
    return workspace.fixed_orientation(DESIGN, plane=PLANE_Y, resolution=resolution)


def imported(progress):
    exchange.import_maxima(determinant.Store("sqlite:///maxima.sqlite"), "maxima.json", **progress)


# Short calls, each with the keyword `progress` or without.
CALLS = {
    "gsp.bridges.mujoco.simulation.simulate": lambda p: simulate(
        MIXED, MIXED.home, None, 0.01, **p
    ),
    "gsp.bridges.proof.prove": lambda p: proof.prove([catalogue.mechanism("D4^3 A1^3")], 1, **p),
    "gsp.calibration.calibrating.calibrate": lambda p: gsp.calibrate(
        DESIGN, [DESIGN.at(HOME).joints], HOME.reshape(1), **p
    ),
    "gsp.determinant.store.exchange.import_maxima": imported,
    "gsp.determinant.maxima.maximum": lambda p: determinant.maximum(PLATFORM, **p),
    "gsp.determinant.reference_maxima.reference": lambda p: determinant.reference(PLATFORM, **p),
    "gsp.determinant.search.rounds.search": lambda p: search(canonical(PLATFORM), **p),
    "gsp.evaluation.evaluations.evaluate": lambda p: gsp.evaluate(DESIGN, HOME, length=1.0, **p),
    "gsp.exploration.assessing.assess": lambda p: exploration.assess(DESIGN, TASK, **p),
    "gsp.exploration.exploring.explore": lambda p: exploration.explore(SPACE, TASK, 2, **p),
    "gsp.exploration.sensitivity.variances.sobol_indices": lambda p: exploration.sobol_indices(
        SPACE, gsp.Task(poses=BOX, wanted="mean CTN", samples=2), 2, **p
    ),
    "gsp.exploration.tolerance.of_indices.index_tolerance": lambda p: exploration.index_tolerance(
        DESIGN, gsp.Task(poses=BOX, wanted="mean CTN", samples=2), DEVIATIONS, samples=2, **p
    ),
    "gsp.exploration.tolerance.of_poses.pose_tolerance": lambda p: exploration.pose_tolerance(
        DESIGN, HOME, DEVIATIONS, samples=2, **p
    ),
    "gsp.exploration.optimisation.optimising.optimise": lambda p: exploration.optimise(
        SPACE, TASK, evaluations=2, starts=1, **p
    ),
    "gsp.kinematics.nearest_pose.nearest": lambda p: gsp.nearest(
        DESIGN, HOME, gsp.Limits(position=[None, None, (None, HOME.position[2] - 1e-3)]), **p
    ),
    "gsp.planar.workspace.planar_section": lambda p: planar_section(PLANE, **FEW, **p),
    "gsp.proof.boxes.certify": lambda p: gsp.certify(DESIGN, BOX, **p),
    "gsp.proof.maximum.certify_maximum": lambda p: gsp.certify_maximum(PLATFORM, **p),
    "gsp.proof.verification.check.verify": lambda p: gsp.certify(DESIGN, BOX).verify(**p),
    "gsp.proof.worst_values.worst": lambda p: gsp.proof.worst(
        DESIGN, BOX, "CDN_CL", length=1.0, **p
    ),
    "gsp.published.checking.check": lambda p: published.check(files=[], **p),
    "gsp.ranking.order.rank": lambda p: gsp.rank(DESIGN, HOME, length=1.0, **p),
    "gsp.sweeps.parameters.maxima": lambda p: sweeps.maxima(
        lambda b: lee.octahedral_3_3(1.0, b), "b", [2.0], **p
    ),
    "gsp.workspace.labelled.boundary_curves": lambda p: workspace.boundary_curves(
        flat(20.0), most=1, **p
    ),
    "gsp.workspace.boundary.mapping.section": lambda p: workspace.section(DESIGN, **FEW, **p),
    **{
        f"gsp.workspace.sets.questions.{f.__name__}": lambda p, f=f, given=given: f(
            DESIGN, *given, resolution=20.0, **p
        )
        for f, given in (
            (workspace.reachable, ()),
            (workspace.dextrous, (NO_TURN,)),
            (workspace.fixed_orientation, (np.eye(3),)),
        )
    },
    "gsp.workspace.sets.questions.orientations": lambda p: workspace.orientations(
        DESIGN, HOME.position, resolution=2.0, **p
    ),
    "gsp.workspace.sets.inside.regular.regular_parts": lambda p: flat(20.0).regular_parts(**p),
    "gsp.workspace.sets.inside.samples.index_sample": lambda p: flat(20.0).index_sample(
        "CTN", 5, **p
    ),
    "gsp.workspace.sets.inside.worst.worst": lambda p: flat(1.0).worst(
        "σ_min", length=1.0, budget=100, **p
    ),
    "gsp.workspace.maps.index_map": lambda p: workspace.index_map(DESIGN, BOX, 1, ["CTN"], **p),
    "gsp.workspace.surfaces.surface": lambda p: workspace.surface(
        DESIGN, rotation=np.eye(3), counts=(2, 3), starts=1, **p
    ),
}


def with_progress():
    """Names of the functions of all modules that have the parameter."""
    for module in MODULES:
        if not module.endswith("__main__"):
            for name, value in vars(import_module(module)).items():
                if isinstance(value, FunctionType) and value.__module__ == module:
                    if "progress" in inspect.signature(value).parameters and name[0] != "_":
                        yield f"{module}.{name}"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GSP_STORE", str(tmp_path / "store.sqlite"))
    (tmp_path / "maxima.json").write_text('{"maxima": []}')


def test_every_function_with_progress_is_called_here():
    inner = {
        "gsp.app.report.page.report",  # takes seconds: tests/app/test_report.py
        "gsp.evaluation.request.make_request",
        "gsp.progress.check_progress",
        "gsp.progress.meter",
        "gsp.proof.boxes.search_box",
        "gsp.workspace.sets.search.orientation_region",
        "gsp.workspace.sets.search.position_region",
    }
    assert set(with_progress()) - inner == set(CALLS)


@pytest.mark.parametrize("call", [False, True])
def test_progress_whose_comparison_raises_is_refused(call):
    def fails(*_):
        raise RuntimeError("not to be compared")

    content = {"__eq__": fails, "__hash__": object.__hash__}
    hostile = type("Hostile", (), {**content, **({"__call__": fails} if call else {})})()
    with pytest.raises(InvalidInput, match=r"progress: expected a function \(done, total\)"):
        check_progress(hostile)


@pytest.mark.parametrize("name", CALLS)
def test_progress_is_a_function_a_bool_or_none(name):
    heard = []
    CALLS[name]({"progress": lambda done, total: heard.append((done, total))})
    assert all(0 <= done <= total for done, total in heard)
    for value in (True, False, None):
        CALLS[name]({"progress": value})
    for value in (0, 1, "bar", [], np.True_, len, lambda done: None):
        with pytest.raises(InvalidInput, match=r"progress: expected a function \(done, total\)"):
            CALLS[name]({"progress": value})


def test_import_reports_each_maximum(tmp_path):
    store = determinant.Store(f"sqlite:///{tmp_path / 'other.sqlite'}")
    gsp.determinant.maximum(lee.octahedral_3_3(1.0, 1.9), seed=0)
    exchange.export_maxima(determinant.store.open_store(), tmp_path / "some.json")
    heard = []
    exchange.import_maxima(store, tmp_path / "some.json", progress=lambda *at: heard.append(at))
    assert heard == [(1, 1)]


def test_a_simulation_reports_its_steps_and_has_a_limit():
    heard = []
    simulate(MIXED, MIXED.home, duration=0.5, progress=lambda *at: heard.append(at))
    assert len(heard) > 1
    assert heard[-1][0] == heard[-1][1]
    with pytest.raises(InvalidInput, match=r"duration: expected at most .* s, received 1e\+09"):
        simulate(MIXED, MIXED.home, duration=1e9)


@pytest.mark.parametrize(("progress", "lines"), [(None, 1), (True, 1), (False, 0)])
def test_compilations_are_printed_where_a_bar_is_drawn(monkeypatch, capsys, progress, lines):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    log = logging.getLogger(COMPILATION)
    with meter(progress, "x"):
        log.info("formulas are compiled")
    log.info("after it")
    assert capsys.readouterr().err.splitlines() == ["gsp: formulas are compiled"] * lines
    with notices(), meter(progress, "x"):  # a command prints it once
        log.info("formulas are compiled")
    assert capsys.readouterr().err.splitlines() == ["gsp: formulas are compiled"]


def _loaded(module, known):
    """Modules of the library that a module imports, at once or through others."""
    path = ROOT / (module.replace(".", "/") + ".py")
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    for name in re.findall(r"^(?:from|import) (gsp[\w.]*)", text, re.M):
        if name not in known:
            known.add(name)
            _loaded(name, known)
    return known


def test_modules_that_compile_log_it():
    compiling = [
        path.relative_to(ROOT).with_suffix("").as_posix().replace("/", ".")
        for path in (ROOT / "gsp").rglob("*.py")
        if "cache=True" in path.read_text(encoding="utf-8")
    ]
    assert len(compiling) > 8
    for module in compiling:
        loaded = _loaded(module, {module})
        assert any(name.startswith("gsp.kernels.compiled") for name in loaded), module
