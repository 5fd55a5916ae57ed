"""Plots and the ranking of the browser tool agree with the library."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import gsp.app
from gsp.app.page.panels import contours
from gsp.app.page.panels.plots import MAP_MARGINS, curve_options, map_options, plot_names
from gsp.app.state import choices, curves, motion
from gsp.app.state import session as sessions
from gsp.app.state.session import started
from gsp.errors import GspError

TOZ = "toz-kucuk-2016-d3-6"


@pytest.fixture
def toz():
    return started(choices.named(TOZ))


@pytest.mark.parametrize("where", curves.MOTIONS)
def test_a_curve_has_the_values_of_postures(toz, where):
    toz = motion.with_coordinate(toz, "x", 3.0)
    found = curves.curve(toz, "condition_number", where)
    axis, turning = "xyz".index(where[-1]), where.startswith("turn")
    assert found.here == (0.0 if turning else toz.pose.position[axis])
    for i in (0, len(found.places) // 2, 100):
        twist, way = np.zeros(6), found.places[i] - found.here
        twist[axis + 3 * turning] = np.deg2rad(way) if turning else way
        posture = toz.design.at(toz.pose.moved(twist))
        wanted = gsp.indices.condition_number(posture, toz.length)
        assert found.values[i] == pytest.approx(float(wanted), rel=1e-9)


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1.0])
def test_the_line_at_the_present_pose_keeps_its_digits(size):
    """ECharts rounds the place of a line to its `precision`, by default to two decimals."""
    state = started(gsp.catalogue.design("dehaeze-general").scaled(size))
    options = curve_options(curves.curve(state, "control_number", "z"))
    mark = options["series"][0]["markLine"]
    (place,) = mark["data"]
    drawn = float(f"{place['xAxis']:.{mark['precision']}f}") * factor_of(options["xAxis"]["name"])
    assert drawn == pytest.approx(state.pose.position[2], rel=1e-9)


def factor_of(label):
    """The power of ten in the label of an axis."""
    found = re.search(r"\[10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", label)
    return (
        10.0 ** int(found[1].translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")))
        if found
        else 1.0
    )


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_axes_of_plots_have_the_values_whatever_the_unit(size):
    state = started(gsp.catalogue.design("dehaeze-general").scaled(size))
    along = curves.curve(state, "manipulability", "z")
    options = curve_options(along)
    drawn = np.array(options["series"][0]["data"])
    axes = options["xAxis"]["name"], options["yAxis"]["name"]
    for found, wanted, label in zip(drawn.T, (along.places, along.values), axes, strict=True):
        assert found * factor_of(label) == pytest.approx(wanted, rel=1e-4)
        assert 1e-3 <= np.abs(found).max() < 1e5


@pytest.mark.parametrize("shift", [0.0, 1e4])
def test_contours_are_where_their_values_are(toz, shift):
    """Also far from the origin of the frames, in units of the grid."""
    away = np.array([shift, -2.0 * shift, 0.0])
    moved = toz.design.replace(
        base_points=toz.design.base_points + away,
        home=gsp.Pose(toz.pose.position + away, toz.pose.rotation),
    )
    plain, far = (
        curves.map_over(started(one), "manipulability", "xy") for one in (toz.design, moved)
    )
    lines = []
    for found in (plain, far):
        options = map_options(found)
        across, up = (options[axis][1]["name"] for axis in ("xAxis", "yAxis"))
        factors = factor_of(across), factor_of(up)
        points = np.concatenate([line["coords"] for line in options["series"][1]["data"]])
        lines.append(points * factors - [found.first[0], found.second[0]])
    step = plain.first[1] - plain.first[0]
    assert np.abs(lines[1] - lines[0]).max() < 0.01 * step


@pytest.mark.parametrize("axes", curves.PLANES)
def test_a_map_has_the_values_of_postures(toz, axes):
    found = curves.map_over(toz, "manipulability", axes)
    for i, j in ((0, 3), (15, 15), (30, 7)):
        place = np.array(toz.pose.position)
        place[["xyz".index(a) for a in axes]] = found.first[i], found.second[j]
        posture = toz.design.at(gsp.Pose(place, toz.pose.rotation))
        wanted = abs(np.linalg.det(posture.jacobian))
        assert found.values[i, j] == pytest.approx(wanted, rel=1e-9)


def test_the_ranking_is_that_of_the_library(toz):
    state = motion.with_coordinate(toz, "yaw", 3.0)
    found = curves.ranking(state, "control_number", toz.design)
    assert len(found) == 195
    values = [one.value for one in found]
    assert values == sorted(values, reverse=True)
    for one in (found[0], found[57], found[-1]):
        design = gsp.catalogue.instantiate(gsp.catalogue.mechanism(one.name), toz.design)
        wanted = gsp.indices.control_number(design.at(state.pose), toz.length)
        assert one.value == pytest.approx(float(wanted), rel=1e-12)


@pytest.mark.parametrize("radius", [1.0, 0.0])
def test_plots_without_a_value_state_why_as_figures_of_sweeps_do(radius):
    """Two similar hexagons are singular at every pose, and so is a platform of one point."""
    angle = np.arange(6) * np.pi / 3.0
    ring = np.stack((np.cos(angle), np.sin(angle), 0.0 * angle), axis=1)
    home = gsp.Pose([0.0, 0.0, 1.5])
    design = gsp.Design(["D1"] * 6, 2.0 * ring, radius * ring, home=home)
    state = sessions.with_length(started(design), 1.0)
    along = curves.curve(state, "condition_number", "z")
    over = curves.map_over(state, "condition_number", "xy")
    path = gsp.sweeps.translation(home, "z", along.places - 1.5)
    figure = gsp.plots.sweep(gsp.sweep(design, path, "condition_number", length=1.0))
    (written,) = figure.axes[0].texts
    for options in (curve_options(along), map_options(over)):
        words = options["title"]["text"]
        assert words == "CDN_CL is infinite at every pose"
        assert written.get_text().endswith(words.removeprefix("CDN_CL"))
    assert not map_options(over)["visualMap"]["show"]  # colours of no value
    some = replace(along, values=np.where(along.places < 1.5, 2.0, np.nan))
    assert "title" not in curve_options(some)


def test_plots_are_named_by_index_and_axes():
    names = plot_names("condition_number", "z", "xz")
    assert names == ("CDN_CL along z", "CDN_CL over x and z")
    assert plot_names("control_number", "turn about x", "yz")[0] == "CTN by a turn about x"


def test_ends_of_the_colours_of_a_map_are_stated(toz):
    over = curves.map_over(toz, "control_number", "xy")
    ramp = np.linspace(0.0, 1.0, over.values.size).reshape(over.values.shape)
    cases = (
        (ramp, ["CTN\n≥ 0.98", "≤ 0.02"]),
        (0.0 * ramp, ["CTN\n0", "0"]),
        (3e-20 * ramp, ["CTN\n[10⁻²⁰]\n≥ 2.94", "≤ 0.06"]),
    )
    for values, wanted in cases:
        assert map_options(replace(over, values=values))["visualMap"]["text"] == wanted


def test_lengths_of_a_map_are_as_large_along_both_axes():
    css = (Path(gsp.app.__file__).parent / "page/style.css").read_text(encoding="utf-8")
    narrower = int(re.search(r"height: calc\(100cqi - (\d+)px\)", css).group(1))
    left, right, top, bottom = (MAP_MARGINS[side] for side in ("left", "right", "top", "bottom"))
    assert left + right - narrower == top + bottom


def test_wrong_words_are_errors(toz):
    for call in (
        lambda: curves.curve(toz, "nothing", "x"),
        lambda: curves.curve(toz, "control_number", "w"),
        lambda: curves.map_over(toz, "control_number", "yx"),
        lambda: curves.map_over(toz, "condition_number_ellipsoid", "xy"),
        lambda: curves.curve(toz, "quality_index", "x"),
        lambda: curves.ranking(toz, "quality_index", toz.design),
    ):
        with pytest.raises(GspError, match="expected"):
            call()


def test_contours_of_a_plane_field_are_straight_lines():
    values = np.add.outer(np.arange(7.0), 2.0 * np.arange(5.0))
    for level in (0.5, 3.25, 9.1):
        (line,) = contours.contour(values, level)
        assert line @ [1.0, 2.0] == pytest.approx(level, rel=1e-14)
        ends = line[[0, -1]] / [6.0, 4.0]
        assert ((ends == 0.0) | (ends == 1.0)).any(axis=1).all()  # from frame to frame
    assert contours.contour(values, -1.0) == contours.contour(values, 15.0) == []


def test_contours_are_closed_and_pass_no_undefined_cell():
    steps = np.linspace(-1.0, 1.0, 21)
    values = np.add.outer(steps**2, steps**2)
    (line,) = contours.contour(values, 0.4)
    assert (line[0] == line[-1]).all()
    # Linear interpolation of a square: within h²/4 of the level.
    assert np.sum((line / 10.0 - 1.0) ** 2, axis=1) == pytest.approx(0.4, abs=0.1**2 / 4.0)
    values[16, 10] = np.nan
    (line,) = contours.contour(values, 0.4)
    assert (line[0] != line[-1]).any()
    assert not (np.abs(line - [16.0, 10.0]) < 1.0).all(axis=1).any()
    # At a saddle, two lines that do not cross.
    saddle = np.array([[1.0, 0.0], [0.0, 1.1]])
    for level, joined in ((0.5, True), (0.6, False)):
        lines = contours.contour(saddle, level)
        assert len(lines) == 2
        assert (sorted(abs(line.sum() - 2.0) < 0.5 for line in lines) == [True, True]) is joined


def test_labels_of_contours_are_clear_of_the_frame():
    lines = contours.contour(np.add.outer(np.arange(21.0), np.zeros(21)), 5.5)
    place = contours.label_place(lines, (21, 21), [np.array([5.5, 17.0])])
    assert place == pytest.approx([5.5, 3.0])
    assert contours.label_place(lines, (400, 21), [place]) is None
    assert contours.round_levels(2.0, 2.0) == []
    assert contours.round_levels(-3.0, 3.0) == [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]
