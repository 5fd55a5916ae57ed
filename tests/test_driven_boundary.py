"""Every public callable works with legs that are driven at the base, or refuses them with an error.

The callables are found by enumeration, with the examples of `tests/boundary.py`, whose designs and
postures are replaced by driven ones. What works is listed here with the test that compares its
results with an independent computation; a callable that is neither listed nor refuses fails.
"""

from types import MappingProxyType

import matplotlib.pyplot as plt
import pytest

import gsp
from gsp.errors import GspError
from tests import boundary, driven

DESIGN = driven.hexaglide().replace(strokes=[[-3.0, 3.0]] * 6, ellipsoid=gsp.Ellipsoid(0.5))
POSTURE = DESIGN.at(DESIGN.home)
NEAR = gsp.PoseBox.around(DESIGN.home, [0.01] * 6)

TABLES = "tests/evaluation/test_driven_designs.py"
ROWS = "tests/model/test_drives.py"
MODELS = "tests/bridges/test_driven_exports.py"
WEIGHTS = "tests/statics/test_weights.py"
WORKS = MappingProxyType({
    "evaluations.evaluate": TABLES, "order.rank": TABLES, "feasibility.feasible": TABLES,
    "gradients.gradient": TABLES, "derivatives.sensitivities": TABLES,
    "stiffness_matrix.stiffness": TABLES, "stiffness_matrix.compliance": ROWS,
    "stiffness_matrix.directional_stiffness": "here",
    "assessing.assess": "here", "tables.sweep": "here", "maps.index_map": "here",
    "accuracy.pose_errors": "here", "motion.instantaneous_motion": "here",
    "characteristic_length.characteristic_length": "here", "comparison.in_unit": ROWS,
    "forward_solution.forward": "tests/kinematics/test_driven_forward.py",
    "modes.modes.assembly_modes": "tests/kinematics/test_driven_modes.py",
    "tracks.track": "tests/kinematics/test_driven_track.py",
    **{f"prepared.{name}": "tests/kinematics/test_driven_track.py"
       for name in ("prepare", "Prepared")},
    "travels.travel": "tests/kinematics/test_driven_limits.py",
    "nearest_pose.nearest": "tests/kinematics/test_driven_limits.py",
    "plots.modes.assembly_modes": "tests/plots/test_modes_plot.py",
    "mechanisms.mechanism": "tests/plots/test_mechanism_plot.py", "motions.animate": "here",
    **{f"{module}.{name}": MODELS for module, name in (
        ("agreements", "agreement"), ("exports", "export"), ("mjcf", "to_mjcf"),
        ("mujoco.rates", "mujoco_rates"), ("simulation", "simulate"), ("model", "to_pinocchio"),
        ("pinocchio.rates", "pinocchio_rates"), ("sdf", "to_sdf"), ("Solids", "unit"),
        ("solids", "masses"), ("urdf", "to_urdf"))},
    "weights.gravity_wrench": WEIGHTS, "weights.holding_forces": WEIGHTS,
    # Facts of the design, and indices, which are functions of the rows.
    "Index.missing": TABLES, "Index.missing_message": TABLES, "Index.unit": ROWS,
    **{f".{name}": ROWS for name in gsp.indices.INDICES if name != "singularity_distance"},
})  # fmt: skip


def replaced(value):
    """An example argument with driven designs and postures in the place of others."""
    if isinstance(value, gsp.Design):
        return DESIGN
    if isinstance(value, gsp.Posture):
        return POSTURE
    if isinstance(value, list) and value and all(isinstance(x, gsp.Design) for x in value):
        return [DESIGN]
    if isinstance(value, gsp.Pose):
        return DESIGN.home
    if isinstance(value, gsp.PoseBox):
        return NEAR
    return value


def _designs(value):
    return isinstance(value, gsp.Design | gsp.Posture) or (
        isinstance(value, list) and value and isinstance(value[0], gsp.Design)
    )


KEYS = {"design", "designs", "posture", "template", "of"}
NAMES = [name for name in boundary.names(*KEYS) if name not in boundary.WITHOUT_EXAMPLE]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    boundary.write_files()
    yield
    plt.close("all")


@pytest.mark.parametrize("name", NAMES)
def test_driven_designs_work_or_are_refused(name, folder):
    given = boundary.arguments(name)
    if not any(map(_designs, given.values())):
        return  # of the plane
    function = boundary.public_callables()[name]
    changed = {key: replaced(value) for key, value in given.items()}
    listed = any(f".{name}".endswith(end) for end in WORKS)
    if listed:
        if "task" in given:
            changed["task"] = gsp.Task(poses=NEAR, wanted="mean CTN", samples=2)
        if name.endswith(".simulate"):
            changed["joints"] = POSTURE.joints  # within the strokes
        boundary.call(function, changed)
        return
    with pytest.raises(GspError, match="driven at the base"):
        boundary.call(function, changed)


def test_the_browser_tool_and_reports_refuse_driven_designs():
    from gsp.app.report import report
    from gsp.app.server import serve
    from gsp.app.state.choices import from_file, published_names
    from gsp.app.state.session import started
    from gsp.model.design import toml_from_design

    calls = [
        lambda: started(DESIGN),
        lambda: report(DESIGN),
        lambda: serve(DESIGN, "127.0.0.1", 0),
        lambda: from_file(toml_from_design(DESIGN)),
        DESIGN.show,
        DESIGN.exchanged,
    ]
    for call in calls:
        with pytest.raises(GspError, match="driven at the base"):
            call()
    assert not any(gsp.catalogue.design(name).driven for name in published_names())
