"""Invalid arguments of workspaces and frames raise an error of the library."""

import numpy as np
import pytest

import gsp
from gsp import geometry
from gsp.errors import GspError
from gsp.planar import PlanarDesign, corner_poses, planar_section, radiating_point
from gsp.workspace import (
    Limits,
    Shells,
    bifurcation_point,
    dextrous,
    exact_shells,
    feasible,
    fixed_orientation,
    index_map,
    orientations,
    reachable,
    section,
    surface,
)
from gsp.workspace.surfaces import symmetry
from tests.test_public_boundary import INVALID, SHAPES

DESIGN = gsp.catalogue.design("workspace-6-3")
HERE = gsp.Pose([0.0, 0.0, 13.0])
TOP = "1 1 1 1 1 1"
BOX = gsp.PoseBox([0, 0, 8.0], [0, 0, 0])
PLANE = PlanarDesign(
    ["D1"] * 3, [[0, 0], [4, 0], [2, 3]], [[-0.5, -0.3], [0.5, -0.3], [0, 0.6]],
    strokes=[[1.0, 3.0]] * 3, home=None,
)  # fmt: skip
BALL = Shells([[0.0, 0.0, 0.0]], [0.5], [1.0])
UNTURNED = gsp.PoseBox([0, 0, 0], [0, 0, 0])
SMALL = dextrous(DESIGN, UNTURNED, resolution=6.0)
GRID = index_map(DESIGN, BOX, 1, ["condition_number"], length=7.5)

CALLS = {
    "feasible design": lambda x: feasible(x, HERE),
    "feasible pose": lambda x: feasible(DESIGN, x),
    "feasible limits": lambda x: feasible(DESIGN, HERE, x),
    **{
        f"Limits {name}": lambda x, name=name: Limits(**{name: x})
        for name in (
            "strokes", "base_cone", "platform_cone", "base_axes", "platform_axes", "position",
            "leg_radius", "indices", "length", "ellipsoid", "maximum",
        )
    },
    "section design": section,
    **{
        f"section {name}": lambda x, name=name: section(DESIGN, **{"rays": 1, "starts": 1, name: x})
        for name in (
            "origin", "axes", "rotation", "limits", "rays", "starts", "rng", "most", "progress",
        )
    },
    "surface design": surface,
    **{
        f"surface {name}": lambda x, name=name: surface(
            DESIGN, **{"counts": (1, 1), "starts": 1, name: x}
        )
        for name in ("origin", "rotation", "limits", "counts", "starts", "rng", "progress")
    },
    "symmetry": symmetry,
    "bifurcation design": lambda x: bifurcation_point(x, TOP, HERE),
    "bifurcation text": lambda x: bifurcation_point(DESIGN, x, HERE),
    "bifurcation guess": lambda x: bifurcation_point(DESIGN, TOP, x),
    **{
        f"bifurcation {name}": lambda x, name=name: bifurcation_point(
            DESIGN, TOP, HERE, **{name: x}
        )
        for name in ("held", "rotation", "limits")
    },
    "bifurcation held x": lambda x: bifurcation_point(DESIGN, TOP, HERE, held={"x": x}),
    "exact_shells design": exact_shells,
    "exact_shells rotation": lambda x: exact_shells(DESIGN, x),
    "exact_shells limits": lambda x: exact_shells(DESIGN, None, x),
    "Shells centers": lambda x: Shells(x, [0.5], [1.0]),
    "Shells low": lambda x: Shells([[0, 0, 0]], x, [1.0]),
    "Shells high": lambda x: Shells([[0, 0, 0]], [0.5], x),
    "Shells contains": BALL.contains,
    "Shells slack": lambda x: BALL.contains([0, 0, 0], x),
    "Shells section origin": lambda x: BALL.section(x, np.eye(3)[:2]),
    "Shells section axes": lambda x: BALL.section([0, 0, 0], x),
    "Shells section points": lambda x: BALL.section([0, 0, 0], np.eye(3)[:2], points=x),
    "Shells area": lambda x: BALL.section_area([0, 0, 0], x),
    "Shells volume": BALL.volume,
    "Shells edges": lambda x: BALL.edges(points=x),
    "reachable design": reachable,
    **{
        f"reachable {name}": lambda x, name=name: reachable(
            DESIGN, **{"resolution": 6.0, "rotations": UNTURNED, name: x}
        )
        for name in ("limits", "plane", "rotations", "resolution", "budget", "workers", "progress")
    },
    "dextrous design": lambda x: dextrous(x, UNTURNED, resolution=6.0),
    "dextrous rotations": lambda x: dextrous(DESIGN, x, resolution=6.0),
    "fixed_orientation rotation": lambda x: fixed_orientation(DESIGN, x, resolution=6.0),
    "orientations position": lambda x: orientations(DESIGN, x, resolution=2.0),
    "region contains": SMALL.contains,
    "region part_of": SMALL.part_of,
    "region estimate": SMALL.estimate,
    "region estimate rng": lambda x: SMALL.estimate(2, rng=x),
    "index_map design": lambda x: index_map(x, BOX, 1),
    "index_map box": lambda x: index_map(DESIGN, x, 1),
    "index_map counts": lambda x: index_map(DESIGN, BOX, x),
    "index_map indices": lambda x: index_map(DESIGN, BOX, 1, x, length=7.5),
    "index_map limits": lambda x: index_map(DESIGN, BOX, 1, limits=x, length=7.5),
    "singularity_free": GRID.singularity_free,
    "radiating_point design": lambda x: radiating_point(x, [2, 1]),
    "radiating_point guess": lambda x: radiating_point(PLANE, x),
    "corner_poses design": corner_poses,
    "corner_poses starts": lambda x: corner_poses(PLANE, starts=x),
    "corner_poses rng": lambda x: corner_poses(PLANE, starts=1, rng=x),
    "planar_section design": planar_section,
    **{
        f"planar_section {name}": lambda x, name=name: planar_section(
            PLANE, **{"origin": [2, 1], "rays": 1, "starts": 1, name: x}
        )
        for name in ("origin", "angle", "rays", "starts", "rng", "most", "progress")
    },
    "exp3": geometry.exp3,
    "log3": geometry.log3,
    "exp6": geometry.exp6,
    "log6": geometry.log6,
    "act_twist placement": lambda x: geometry.act_twist(x, np.ones(6)),
    "act_twist twist": lambda x: geometry.act_twist(HERE, x),
    "act_wrench wrench": lambda x: geometry.act_wrench(HERE, x),
    "act_jacobian": lambda x: geometry.act_jacobian(HERE, x),
    "action_matrix": geometry.action_matrix,
    "dual_action_matrix": geometry.dual_action_matrix,
    "twist_at point": lambda x: geometry.twist_at(np.ones(6), x),
    "wrench_at point": lambda x: geometry.wrench_at(np.ones(6), x),
    "jacobian_at": lambda x: geometry.jacobian_at(x, [1, 2, 3]),
    "interpolate share": lambda x: geometry.interpolate(HERE, HERE, x),
    "interpolate end": lambda x: geometry.interpolate(HERE, x, 0.5),
    "compose": lambda x: geometry.compose(HERE, x),
    "se3": geometry.se3,
    "motion": geometry.motion,
    "force": geometry.force,
    "frame name": lambda x: geometry.frame(x, HERE),
    "frame joint": lambda x: geometry.frame("tool", HERE, x),
}  # fmt: skip

# Valid kinds of each argument; all others are errors. "huge" is a positive number.
OPTIONAL, SEQUENCE, SEED = {"None"}, {"empty"}, {"zero"}
PROGRESS = {"None", "bool", "type"}  # a class may be called with two numbers
SIX = {"view of six", "greatest"}  # six numbers each
FINE = {
    "feasible limits": OPTIONAL,
    "Limits strokes": OPTIONAL | {"view", "greatest pairs"},
    **{f"Limits {name}": OPTIONAL for name in (
        "base_axes", "platform_axes", "position", "ellipsoid",
    )},
    **{f"Limits {name}": {"None", "huge"} for name in ("leg_radius", "length", "maximum")},
    "Limits base_cone": {"None", "list", "nan"}, "Limits platform_cone": {"None", "list", "nan"},
    "Limits indices": SEQUENCE,
    **{f"section {name}": OPTIONAL for name in ("origin", "rotation", "limits")},
    "section rays": {"list", "array"}, "section rng": SEED, "section progress": PROGRESS,
    **{f"surface {name}": OPTIONAL for name in ("origin", "rotation", "limits")},
    "surface rng": SEED, "surface progress": PROGRESS,
    **{f"bifurcation {name}": OPTIONAL for name in ("held", "rotation", "limits")},
    "bifurcation held x": {"zero"},
    "exact_shells rotation": OPTIONAL, "exact_shells limits": OPTIONAL,
    "Shells high": {"list"}, "Shells slack": {"negative", "zero", "huge"},
    "Shells volume": {"array"},
    **{f"reachable {name}": OPTIONAL for name in ("limits", "plane", "rotations")},
    "reachable resolution": {"None", "huge"}, "reachable workers": OPTIONAL,
    "reachable progress": PROGRESS, "region estimate rng": SEED,
    "fixed_orientation rotation": OPTIONAL,
    "index_map indices": OPTIONAL, "index_map limits": OPTIONAL, "singularity_free": OPTIONAL,
    "radiating_point guess": {"array"}, "corner_poses rng": SEED,
    "planar_section angle": {"None", "negative", "zero"}, "planar_section rays": {"list", "array"},
    "planar_section rng": SEED, "planar_section progress": PROGRESS,
    # Undefined stays undefined.
    "exp3": {"nans"}, "twist_at point": {"nans"}, "wrench_at point": {"nans"},
    **dict.fromkeys((
        "se3", "compose", "log6", "action_matrix", "dual_action_matrix", "interpolate end",
        "act_twist placement",
    ), SEQUENCE),
    "interpolate share": {
        "negative", "zero", "list", "array", "empty", "nested", "huge", "frame", "view",
        "greatest pairs", *SIX,
    },
    **dict.fromkeys(
        ("exp6", "act_twist twist", "act_wrench wrench", "act_jacobian", "jacobian_at", "motion",
         "force"), SIX,
    ),
    "frame name": {"text", "number as text", "empty text", "long name"}, "frame joint": {"zero"},
}  # fmt: skip


@pytest.mark.parametrize("call", CALLS)
def test_invalid_arguments_are_errors(call):
    for name, value in INVALID.items():
        if name in SHAPES:  # tests/test_public_boundary.py has them
            continue
        if name not in FINE.get(call, ()):  # those are slow; tests/test_public_boundary.py has them
            with pytest.raises(GspError) as caught:
                CALLS[call](value)
            assert 10 < len(str(caught.value)) < 500, f"{call}: {name}"


def test_what_is_fine_belongs_to_a_call():
    assert FINE.keys() <= CALLS.keys()


@pytest.mark.parametrize(
    ("plane", "message"),
    [
        (
            ([0, 0, 0], [[1, 0, 0], [2, 0, 0]]),
            r"directions\): .*received \[\[1.0, 0.0, 0.0\], \[2.0",
        ),
        ("xz", "plane: expected a pair: a point, and two directions, received 'xz'"),
        (([0, 0], [[1, 0, 0], [0, 0, 1]]), r"plane\[0\] \(the point\): expected shape \(..., 3\)"),
    ],
)
def test_messages_on_planes_have_what_was_given(plane, message):
    with pytest.raises(GspError, match=message):
        reachable(gsp.catalogue.design("workspace-6-3"), plane=plane)
