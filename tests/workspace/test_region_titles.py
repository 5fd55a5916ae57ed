"""Pictures of regions state what they are of, unless the axes have a title."""

import numpy as np

import gsp
from gsp.figures import new_axes

SIX_THREE = gsp.catalogue.design("workspace-6-3")
TURN = np.deg2rad(15.0)
VERTICAL = ([0.0, 0.0, 0.0], [[np.cos(TURN), np.sin(TURN), 0.0], [0.0, 0.0, 1.0]])
LEVEL = ([0.0, 0.0, 8.0], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
TILTS = gsp.PoseBox([0, 0, 0], [(-5, 5), (-5, 5), 0], degrees=True, order="approach-roll")
COARSE = {"resolution": 2.0, "budget": 20_000}


def lines(region):
    return region.plot().get_title().split("\n")


def test_the_title_has_design_plane_and_orientations():
    some = gsp.workspace.reachable(SIX_THREE, plane=VERTICAL, rotations=TILTS, **COARSE)
    turned = gsp.geometry.rotation_from_angles([0, 0, -30], "rpy", degrees=True)
    one = gsp.workspace.fixed_orientation(SIX_THREE, turned, plane=LEVEL, **COARSE)
    every = gsp.workspace.dextrous(SIX_THREE, TILTS, **COARSE)
    assert lines(some)[:3] == [
        "workspace-6-3",
        "vertical plane at 15°",
        "some of the angles -5°…5° -5°…5° 0° (approach-roll)",
    ]
    assert lines(one)[:3] == ["workspace-6-3", "plane x, y", "angles 0° 0° -30° (rpy)"]
    assert lines(every)[:2] == [
        "workspace-6-3",
        "all of the angles -5°…5° -5°…5° 0° (approach-roll)",
    ]


def test_the_title_of_orientations_has_their_position():
    region = gsp.workspace.orientations(SIX_THREE, [0, -0.0, 8], resolution=0.8)
    assert lines(region)[:2] == ["workspace-6-3", "orientations at (0, 0, 8)"]


def test_axes_keep_a_title_that_they_have():
    region = gsp.workspace.fixed_orientation(SIX_THREE, plane=VERTICAL, **COARSE)
    ax = new_axes(6.0, 5.4)
    ax.set_title("mine")
    assert region.plot(ax).get_title() == "mine"
    assert region.plot(new_axes(6.0, 5.4)).get_title().startswith("workspace-6-3\n")


def test_names_of_designs_neither_start_formulas_nor_widen_the_picture():
    design = SIX_THREE.replace(name="a $x$ " + 80 * "b")
    region = gsp.workspace.fixed_orientation(design, plane=VERTICAL, **COARSE)
    name = lines(region)[0]
    assert name.startswith(r"a \$x\$ b")
    assert len(name) == 62
