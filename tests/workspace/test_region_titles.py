"""Pictures of regions state what they are of, unless the axes have a title."""

import numpy as np
import pytest

import gsp
from gsp.errors import InvalidInput
from gsp.figures import new_axes, set_space_ticks

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
    name = "".join(lines(region)[:2])
    assert name.replace(r"\$", "$").replace(" ", "") == design.name.replace(" ", "")
    assert len(lines(region)[0]) <= 62


def test_numbers_in_the_corners_of_axes_in_space_are_those_of_one_axis():
    ax = new_axes(projection="3d")
    ax.set(xlim=(-180, 180), ylim=(-90, 58), zlim=(-180, 180))
    set_space_ticks(ax, (6, 2, 6), (1, 1.5, 3, 4.5, 6, 9, 10))
    x, y, z = (axis.get_majorticklocs() for axis in (ax.xaxis, ax.yaxis, ax.zaxis))
    assert -90.0 in y
    assert x.max() == 120.0
    assert {x.min(), z.min(), z.max()} == {-180.0, 180.0}
    # No corner has two numbers here.
    ax.set(ylim=(-100, 58))
    set_space_ticks(ax, (6, 2, 6), (1, 1.5, 3, 4.5, 6, 9, 10))
    assert 180.0 in ax.xaxis.get_majorticklocs()


def test_wrong_points_are_refused_with_the_numbers_that_are_expected():
    solid = gsp.workspace.fixed_orientation(SIX_THREE, **COARSE)
    flat = gsp.workspace.fixed_orientation(SIX_THREE, plane=VERTICAL, **COARSE)
    turns = gsp.workspace.orientations(SIX_THREE, [0, 0, 8], resolution=2.0)
    for region, words in (
        (solid, r"x, y, z: shape \(\.\.\., 3\)"),
        (
            flat,
            r"x, y, z, or two coordinates along the plane: shape \(\.\.\., 3\) or \(\.\.\., 2\)",
        ),
        (turns, r"three angles \[rad\]: shape \(\.\.\., 3\)"),
    ):
        for points in (3.0, [1.0, 2.0, 3.0, 4.0], [[1.0]]):
            with pytest.raises(InvalidInput, match=f"points: expected {words}, received shape"):
                region.contains(points)
