"""Sweeps along motions and over designs."""

from __future__ import annotations

import numpy as np
import pytest

import gsp
from gsp import sweeps
from gsp.errors import InvalidInput
from gsp.families import lee
from gsp.geometry.pose import Pose

HOME = Pose.from_rpy([0.3, -0.2, 1.1], [0.1, 0.2, 0.3])


@pytest.fixture(autouse=True)
def _no_store(monkeypatch):
    monkeypatch.setenv("GSP_STORE", "off")


def test_translation_keeps_the_rotation():
    path = sweeps.translation(HOME, [0.0, 3.0, 4.0], [-1.0, 0.0, 2.0])
    np.testing.assert_allclose(path.pose.position[2], HOME.position + np.array([0.0, 1.2, 1.6]))
    assert (path.pose.rotation == HOME.rotation).all()


def test_turns_about_own_centre_keep_the_position_and_about_the_base_origin_the_distance():
    own = sweeps.turn(HOME, "y", [0.0, 30.0, -90.0])
    base = sweeps.turn(HOME, "y", [0.0, 30.0, -90.0], through="base origin")
    assert (own.pose.position == HOME.position).all()
    np.testing.assert_allclose(own.pose.rotation, base.pose.rotation)
    distance = np.linalg.norm(base.pose.position, axis=1)
    np.testing.assert_allclose(distance, np.linalg.norm(HOME.position))
    np.testing.assert_allclose(base.pose.position[2], [-1.1, -0.2, 0.3], atol=1e-12)
    for path in (own, base):
        np.testing.assert_allclose(path.pose[0].rotation, HOME.rotation, atol=1e-15)


def test_a_turn_about_any_line_leaves_the_points_of_the_line():
    point, axis = np.array([0.4, 0.5, 0.6]), np.array([1.0, 2.0, -1.0])
    path = sweeps.turn(HOME, axis, [77.0], through=point)
    carried = path.pose[0].compose(HOME.inverse())
    for share in (0.0, 1.7):
        on_line = point + share * axis
        np.testing.assert_allclose(carried.rotation @ on_line + carried.position, on_line)


def test_sweep_over_a_plane_is_the_closed_form():
    design, pose = lee.octahedral_3_3(1.0, 2.0), Pose([0.0, 0.0, 1.0])
    frame = gsp.sweep(design, sweeps.plane(pose, [-1.0, 0.0, 0.5], [0.0, 0.7]))
    assert frame.shape == (6, 3)
    expected = lee.translated_quality(1.0, 2.0, frame["distance_x"], frame["distance_y"], 1.0)
    np.testing.assert_allclose(frame["quality_index"], expected, rtol=1e-10)
    assert frame.attrs["maximum"]["method"] == "closed form"
    assert frame.attrs["shape"] == [3, 2]


def test_sweep_takes_any_index_and_a_given_maximum():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    path = sweeps.turn(design.home, "z", [0.0, 5.0])
    names = ["control_number", "quality_index"]
    frame = gsp.sweep(design, path, names, maximum=1e6)
    assert list(frame.columns) == ["turn_deg", *names]
    for name in names:
        direct = gsp.evaluate(design, path.pose, [name], maximum=1e6)
        np.testing.assert_allclose(frame[name], direct[name], rtol=1e-12)


def test_a_design_that_is_singular_in_every_pose_has_no_quality_index():
    frame = gsp.sweep(lee.platform_3_6(1.0, 2.0, 0.5), sweeps.translation(HOME, "x", [0.0, 0.1]))
    assert frame["quality_index"].isna().all()


def test_a_table_has_the_pose_that_is_moved():
    start = gsp.Pose.from_rpy([0.1, 0.2, 1.0], [10.0, -20.0, 30.0], degrees=True)
    path = sweeps.turn(start, "x", [30.0, 60.0], through=[1.0, 0.0, 0.0])
    assert path.motion == "turn about x through the point (1, 0, 0)"
    design = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    frames = [
        gsp.sweep(design, path, "CTN"),
        sweeps.over_designs(lambda b: design.scaled(b), "b", [1.0, 2.0], start, "CTN"),
    ]
    for frame in frames:
        given = frame.attrs["pose"]
        found = gsp.Pose.from_rpy(given["position"], given["roll_pitch_yaw_deg"], degrees=True)
        np.testing.assert_allclose(found.position, start.position)
        np.testing.assert_allclose(found.rotation, start.rotation, atol=1e-14)


def test_over_designs_and_their_maxima():
    def make(beta):
        return lee.platform_3_6(1.0, 2.0, beta)

    def central(design):
        return gsp.determinant.maximum(design).pose

    best = sweeps.maxima(make, "beta", [0.0, 0.2, 0.9])
    np.testing.assert_allclose(best["value"], lee.absolute_maximum(1.0), rtol=1e-10)
    np.testing.assert_allclose(best["z"].abs(), [1.0, 0.6, 0.8], rtol=1e-9)
    frame = sweeps.over_designs(make, "beta", [0.0, 0.2, 0.9], central)
    np.testing.assert_allclose(frame["quality_index"], 1.0, rtol=1e-10)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: sweeps.turn(HOME, "w", [1.0]), "axis"),
        (lambda: sweeps.turn(HOME, [0.0, 0.0, 0.0], [1.0]), "not zero"),
        (lambda: sweeps.turn(HOME, "x", [1.0], through="somewhere"), "platform origin"),
        (lambda: sweeps.translation(HOME, "x", []), "distances"),
        (lambda: sweeps.translation(HOME.reshape(1), "x", [1.0]), "single pose"),
        (lambda: gsp.sweep(lee.octahedral_3_3(1, 2), HOME), "path"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(InvalidInput, match=message):
        call()


def test_plots_of_sweeps():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from gsp import plots

    design, pose = lee.octahedral_3_3(1.0, 2.0), Pose([0.0, 0.0, 1.0])
    line = gsp.sweep(design, sweeps.turn(pose, "z", np.linspace(-90, 90, 19)))
    axes = plots.along(line)
    np.testing.assert_allclose(axes.lines[0].get_ydata(), line["quality_index"])
    assert axes.get_xlabel() == "rotation about z [°]"
    area = gsp.sweep(design, sweeps.plane(pose, *[np.linspace(-2, 2, 21)] * 2))
    filled, lines = plots.over_plane(area, levels=[0.25, 0.5]).collections
    np.testing.assert_array_equal(lines.levels, [0.25, 0.5])
    assert len(filled.levels) > 5
    with pytest.raises(InvalidInput, match="1 coordinate"):
        plots.along(area)
    with pytest.raises(InvalidInput, match="indices"):
        plots.over_plane(area, "control_number")


def test_symbols_and_a_maximum_of_zero():
    octahedron = gsp.families.lee.octahedral_3_3(1.0, 2.0)
    path = sweeps.translation(gsp.Pose([0.0, 0.0, 1.0]), "z", [0.0, 0.5])
    table = gsp.sweep(octahedron, path, "CTN, λ")
    assert list(table) == ["distance", "control_number", "quality_index"]
    assert table.notna().all().all()
    with pytest.raises(gsp.GspError, match="maximum: expected a positive number"):
        gsp.sweep(octahedron, path, "λ", maximum=0.0)
