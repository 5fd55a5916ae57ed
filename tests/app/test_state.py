"""The view-model of the browser tool: poses, joints, limits, readings, links, drawings."""

from __future__ import annotations

import json
import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import gsp
from gsp.app.page import tables
from gsp.app.scene import drawing
from gsp.app.state import choices, links, matrices, motion
from gsp.app.state import session as sessions
from gsp.app.state.reading import read
from gsp.errors import GspError
from gsp.files.knowledge import knowledge
from gsp.indices import INDICES

TOZ = "toz-kucuk-2016-d3-6"


@pytest.fixture
def toz():
    return sessions.started(choices.named(TOZ))


def limited(low, high, **changes):
    design = choices.named(TOZ)
    strokes = np.tile([low, high], (6, 1))
    return replace(sessions.started(design.replace(strokes=strokes)), **changes)


# --- configuration and Jacobian of the dissertation ---


def figure_42():
    """The printed matrix of figure 42.

    Four entries are printed with 0.5774 for 1/√3, and differ in the last digit by 1 (the ledger):
    they are corrected.
    """
    text = (knowledge("indices") / "published" / "lee-2000.toml").read_text(encoding="utf-8")
    entries = tomllib.loads(text)["value"]
    printed = next(e["printed"] for e in entries if e["place"] == "figures 40, 41, 42")
    corrected = next(e["correct"] for e in entries if e["place"] == "figure 42, rows 4 and 5")
    wanted = np.array(printed, dtype=float)
    for i, row in enumerate(corrected):
        for j, entry in enumerate(row):
            wanted[i, j] = float(entry) if entry else wanted[i, j]
    return wanted


def test_the_dialog_of_figure_42():
    """Its configuration (figure 41), its pose (40) and its matrix, entry by entry."""
    wanted = figure_42()
    top, base = choices.Half(size=15.0), choices.Half(size=30.0)
    state = sessions.started(choices.configured(top, base))
    assert motion.coordinates(state.pose) == pytest.approx([0, 0, 15, 0, 0, 0], abs=1e-12)
    found = matrices.matrix(state, matrices.LINES)
    assert np.abs(found - wanted).max() < 0.00051
    assert abs(np.linalg.det(found)) == pytest.approx(0.75 * 3**0.5 * 15.0**3, rel=1e-12)
    assert abs(read(state).determinant) == pytest.approx(0.75 * 3**0.5 * 15.0**3, rel=1e-12)


@pytest.mark.parametrize(
    ("top", "base", "family"),
    [
        ({}, {}, "lee-3-3"),
        ({}, {"kind": "hexagon", "percent": 20.0}, "lee-3-6"),
        ({"kind": "hexagon", "percent": 10.0}, {}, "lee-6-6"),
        ({"kind": "hexagon", "percent": 10.0}, {"kind": "hexagon", "percent": 30.0}, "lee-6-6"),
        *(
            ({"kind": "hexagon", "percent": 20.0, "separation": way},) * 2 + (name,)
            for way, name in ((choices.CENTRE, "lee-centre"), (choices.SIDE, "lee-side"))
        ),
        ({"kind": "hexagon", "percent": 20.0, "separation": choices.SIDE}, {}, "lee-side-edges"),
        (
            {"kind": "hexagon", "percent": 20.0},
            {"kind": "hexagon", "percent": 30.0, "separation": choices.CENTRE},
            "lee-edges-centre",
        ),
    ],
    ids=["3-3", "3-6", "6-3", "6-6", "centre", "side", "side-triangle", "edges-centre"],
)
def test_home_of_the_dialog_is_the_best_height(top, base, family):
    """No neighbouring height or twist has a larger |det J|."""
    design = choices.configured(choices.Half(size=1.0, **top), choices.Half(size=2.0, **base))
    assert design.name.startswith(family)
    for axis in (2, 5):
        near = design.home.moved([np.eye(6)[axis] * h for h in (-1e-3, 0.0, 1e-3)])
        values = np.abs(np.linalg.det(design.at(near).jacobian))
        assert values[1] > max(values[0], values[2]) > 0.0


@pytest.mark.parametrize("top", choices.SEPARATIONS)
@pytest.mark.parametrize("base", choices.SEPARATIONS)
def test_top_and_base_of_the_dialog_are_independent(top, base):
    """Each half has the points that it has with the same separation on both."""
    halves = [("platform", top, 15.0, 12.5), ("base", base, 30.0, 40.0)]
    columns = [
        choices.Half(kind="hexagon", size=size, separation=way, percent=percent)
        for _, way, size, percent in halves
    ]
    design = choices.configured(*columns)
    for side, way, size, percent in halves:
        both = choices.Half(kind="hexagon", size=size, separation=way, percent=percent)
        alone = choices.configured(both, both)
        points = f"{side}_points"
        assert (getattr(design, points) == getattr(alone, points)).all()


@pytest.mark.parametrize(
    ("top", "base"),
    [
        ({"size": 0.0}, {}),
        ({"size": float("nan")}, {}),
        ({"kind": "square"}, {}),
        ({"kind": "hexagon", "percent": 101.0}, {}),
        ({"kind": "hexagon", "separation": "along no edge"}, {"kind": "hexagon"}),
    ],
)
def test_configurations_that_there_are_not(top, base):
    with pytest.raises(GspError, match="expected"):
        choices.configured(choices.Half(**top), choices.Half(**base))


def test_every_mechanism_can_be_chosen():
    driven = [n for n in gsp.catalogue.design_names() if gsp.catalogue.design(n).driven]
    assert len(choices.names()) == 195 + len(gsp.catalogue.design_names()) - len(driven)
    for refused in driven:
        with pytest.raises(GspError, match="driven at the base"):
            choices.named(refused)
    name = gsp.catalogue.mechanisms()[100].name
    assert choices.named(name).mechanism.name == name
    with pytest.raises(GspError, match="unknown"):
        choices.named("/etc/passwd")


# --- poses ---


def test_buttons_move_along_and_about_the_chosen_axes(toz):
    start = toz.pose
    r = start.rotation
    for number, name in enumerate(motion.COORDINATES):
        for frame, axis in (("base", np.eye(3)), ("platform", r.T)):
            state = sessions.with_frame(toz, frame)
            after = motion.nudged(state, name, -1).pose
            if number < 3:
                assert after.position == pytest.approx(start.position - toz.step * axis[number])
                assert (after.rotation == r).all()
            else:
                turn = Rotation.from_rotvec(-np.deg2rad(toz.turn_deg) * axis[number - 3])
                assert after.rotation == pytest.approx(turn.as_matrix() @ r, abs=1e-12)
                assert (after.position == start.position).all()


def test_increments_about_platform_axes_are_not_those_about_base_axes(toz):
    poses = [
        motion.nudged(sessions.with_frame(toz, frame), "roll", 1).pose
        for frame in ("base", "platform")
    ]
    assert np.abs(poses[0].rotation - poses[1].rotation).max() > 1e-3


def test_coordinates_are_what_was_set(toz):
    for name, value in (("x", 3.0), ("yaw", 17.0), ("pitch", -4.0)):
        toz = motion.with_coordinate(toz, name, value)
        assert motion.coordinates(toz.pose)[motion.COORDINATES.index(name)] == pytest.approx(value)
    again = motion.reset(toz)
    assert (again.pose.position == toz.design.home.position).all()


@pytest.mark.parametrize("name", ["roll", "yaw"])
@pytest.mark.parametrize("start", [-0.1, 0.0, 0.1])
def test_a_large_turn_goes_toward_its_end(name, start):
    """From 0.1° to −180° the shorter turn is the other way."""
    six_three = sessions.started(gsp.catalogue.design("workspace-6-3"))
    state = motion.with_coordinate(six_three, name, start)
    for end, sign in ((-89.0, -1.0), (-180.0, -1.0), (180.0, 1.0), (3000.0, 1.0)):
        after = motion.with_coordinate(state, name, end)
        turned = motion.coordinates(after.pose)[motion.COORDINATES.index(name)] - start
        assert "stopped at the limit" in after.message
        assert 1.0 < sign * turned < 89.0


def test_axis_and_angle():
    axis, angle = motion.axis_and_angle(gsp.Pose.from_rpy([0, 0, 1], [0, 0, 30], degrees=True))
    assert (axis.round(12).tolist(), angle) == ([0, 0, 1], pytest.approx(30.0))
    assert motion.axis_and_angle(gsp.Pose([0, 0, 1]))[1] == 0.0


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1.0, 0.0, 1e-320, 1e-30, 1e300])
def test_increments_out_of_range_change_nothing(toz, value):
    for change in (sessions.with_step, sessions.with_turn):
        with pytest.raises(GspError, match="expected a number"):
            change(toz, value)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 1e200])
def test_coordinates_out_of_range_are_an_error(toz, value):
    with pytest.raises(GspError, match="expected"):
        motion.with_coordinate(toz, "x", value)


@pytest.mark.parametrize("value", [1e99, -3601.0, 1e17])
def test_angles_of_more_than_ten_turns_are_an_error(toz, value):
    for change in (
        lambda: motion.with_coordinate(toz, "yaw", value),
        lambda: links.restored({"design": toz.design.name, "rpy_deg": f"0,{value},0"}, toz.design),
    ):
        with pytest.raises(GspError, match="angles between -3600° and 3600°"):
            change()
    turned = motion.with_coordinate(toz, "yaw", 365.0)
    assert motion.coordinates(turned.pose)[5] == pytest.approx(5.0, abs=1e-9)


def test_what_is_rounding_in_a_singular_posture_is_shown_as_zero():
    design = gsp.catalogue.design("lee-2000-3-3")
    state = sessions.started(design, gsp.Pose.from_rpy([0, 0, 1], [0, 0, 90], degrees=True))
    reading = read(state)
    assert reading.singular
    assert reading.determinant != 0.0
    shown = re.findall(r"<dt>(.*?)</dt><dd>(.*?)</dd>", tables.facts(state, reading))
    assert dict(shown)["det J [length³]"] == "0"
    assert dict(shown)["CTN"] == "0"
    assert "determinant of this matrix: 0<" in tables.matrix(reading.jacobian, state, "plain")
    assert "e−1" not in tables.indices(reading.indices)


# --- joints ---


@pytest.mark.parametrize("name", [TOZ, "toz-kucuk-2016-d1-d2-d3-d4-a1-2", "workspace-6-3"])
def test_the_platform_follows_a_joint(name):
    state = sessions.started(choices.named(name))
    joints = state.design.at(state.pose).joints
    for number in range(6):
        change = -0.001 if state.design.angular[number] else 0.01 * state.size
        after = motion.with_joint(state, number, joints[number] + change)
        wanted = joints + change * (np.arange(6) == number)
        assert after.message == ""
        assert after.design.at(after.pose).joints == pytest.approx(wanted, rel=1e-9)


def test_a_joint_out_of_reach_changes_nothing(toz):
    for value in (1e4 * toz.size, 0.0, -1.0, float("nan")):
        after = motion.with_joint(toz, 0, value)
        assert after.message.startswith("no pose with d1 = ")
        assert "nothing was changed" in after.message
        assert after.pose is toz.pose


def test_a_joint_that_a_limit_holds_out_of_reach_names_the_entry_and_the_limit():
    state = limited(0.5, 1e4)
    after = motion.with_joint(state, 3, 0.2)
    assert after.message.startswith("no pose with d4 = 0.2, nor with its limit 0.5: ")
    assert after.pose is state.pose


# --- limits ---


def test_motion_stops_at_the_limit_and_the_limit_is_named():
    """d3 is 155.2 and the greatest at home; upward it is the first one to reach 160."""
    state = limited(100.0, 160.0)
    after = motion.with_coordinate(state, "z", 1000.0)
    joints = after.design.at(after.pose).joints
    assert after.message == "stopped at the limit d3 = 160"
    assert joints.argmax() == 2
    assert 160.0 - 1e-5 < joints[2] <= 160.0


def test_a_motion_at_a_limit_can_be_reversed_and_repeated():
    state = limited(100.0, 160.0)
    high = motion.with_coordinate(state, "z", 1000.0)
    assert motion.with_coordinate(high, "z", 1000.0).message == "stopped at the limit d3 = 160"
    back = motion.with_coordinate(high, "z", 137.0)
    assert back.message == ""
    assert back.pose.position[2] == pytest.approx(137.0)


def test_a_start_outside_of_the_limits_can_be_left():
    state = limited(100.0, 140.0)  # d3 is 155 at home
    after = motion.with_coordinate(state, "z", 130.0)
    assert after.pose.position[2] == pytest.approx(130.0)
    assert after.message.startswith("outside of the limits: d3 = ")
    inside = motion.with_coordinate(after, "z", 115.0)
    assert (inside.pose.position[2], inside.message) == (pytest.approx(115.0), "")
    free = motion.with_coordinate(replace(state, stops=False), "z", 200.0)
    assert (free.pose.position[2], free.message) == (pytest.approx(200.0), "")


@pytest.mark.parametrize("value", [138.0001, 139.0, 200.0])
def test_a_start_outside_of_the_limits_gets_no_farther_outside(value):
    """By an entry, by a button, or by a joint value; z is 138 at home, and d3 155."""
    state = limited(100.0, 140.0)
    joints = state.design.at(state.pose).joints
    words = "is beyond its limit 140, and would get farther away"
    after = motion.with_coordinate(state, "z", value)
    assert after.message in [f"stopped: {name} {words}" for name in ("d1", "d3")]
    for change in (after, motion.nudged(state, "z", 1), motion.with_coordinate(state, "x", 1e3)):
        assert words in change.message
        beyond = np.maximum(change.design.at(change.pose).joints - 140.0, 0.0)
        assert (beyond <= np.maximum(joints - 140.0, 0.0) + 1e-9).all()
    far = motion.with_joint(state, 2, value + 20.0)
    assert far.message == f"stopped: d3 {words}"
    assert far.design.at(far.pose).joints == pytest.approx(joints, rel=1e-9)
    less = motion.with_joint(state, 2, 150.0)  # still outside, and less so
    assert less.design.at(less.pose).joints[2] == pytest.approx(150.0)
    assert motion.with_joint(state, 2, 10.0).message == "stopped at the limit d3 = 100"


def test_once_inside_a_motion_ends_at_limits():
    """Down from a start that is too high, through the poses within the limits, to their low end."""
    state = limited(120.0, 150.0)  # d3 is 155 at home
    after = motion.with_coordinate(state, "z", 10.0)
    joints = after.design.at(after.pose).joints
    assert after.message.startswith("stopped at the limit d")
    assert after.message.endswith(" = 120")
    assert joints.min() == pytest.approx(120.0, abs=1e-6)


def test_at_a_limit_a_number_moves_no_farther():
    """At both ends of motions the joint is at its limit up to rounding; entries change nothing."""
    for name, value in (("z", 300.0), ("z", -300.0), ("x", 300.0), ("pitch", 60.0), ("yaw", 90.0)):
        state = motion.with_coordinate(limited(120.0, 160.0), name, value)
        again = motion.with_coordinate(state, name, value)
        assert "stopped at the limit" in again.message
        apart = motion.coordinates(again.pose) - motion.coordinates(state.pose)
        assert np.abs(apart).max() < 1e-5


def test_limits_of_angles_are_in_degrees():
    state = sessions.started(choices.named("D1^3 A1^3"))
    joints = state.design.at(state.pose).joints
    strokes = np.stack((joints - 0.1, joints + 0.1), axis=1)
    strokes[~state.design.angular] = np.nan
    state = replace(state, design=state.design.replace(strokes=strokes))
    after = motion.with_coordinate(state, "yaw", 80.0)
    bounds = zip(state.design.joint_names, np.rad2deg(state.design.strokes).tolist(), strict=True)
    wanted = [f"{name} = {bound:.6g}°" for name, both in bounds for bound in both]
    assert after.message.removeprefix("stopped at the limit ") in wanted


def test_a_singular_pose_does_not_stall_the_platform():
    """The 3-3 turned by 90° about z is singular (Lee2000, chapter 4); it turns on to 120°."""
    design = choices.configured(choices.Half(size=1.0), choices.Half(size=2.0))
    state = sessions.started(design.replace(strokes=[[0.01, 50.0]] * 6))
    past = motion.with_coordinate(state, "yaw", 120.0)
    assert motion.coordinates(past.pose)[5] == pytest.approx(120.0)
    assert past.message == "passed a singular pose"
    at = motion.with_coordinate(state, "yaw", 90.0)
    assert read(at).singular
    assert motion.coordinates(motion.with_coordinate(at, "yaw", 60.0).pose)[5] == pytest.approx(60)


def test_a_motion_within_singular_poses_passes_none():
    """Similar hexagons at a yaw of 90° (Fichter): rounding gives det J both signs."""
    angle = np.deg2rad([-10, 10, 110, 130, 230, 250])
    ring = np.stack((np.cos(angle), np.sin(angle), 0.0 * angle), axis=1)
    home = gsp.Pose.from_rpy([0.0, 0.0, 2.0], [0.0, 0.0, np.pi / 2])
    state = sessions.started(gsp.Design(["D1"] * 6, 2.0 * ring, ring, home=home))
    assert motion.with_coordinate(state, "x", 0.3).message == ""


def test_redundant_platforms_stop_at_limits_too(toz):
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    base = np.concatenate((design.base_points, [[0.1, 0.0, 0.0]]))
    top = np.concatenate((design.platform_points, [[0.0, 0.1, 0.0]]))
    seven = gsp.Design(["D1"] * 7, base, top, home=design.home, strokes=[[0.5, 2.5]] * 7)
    after = motion.with_coordinate(sessions.started(seven), "z", 9.0)
    joints = seven.at(after.pose).joints
    assert 2.5 - 1e-7 < joints.max() <= 2.5
    assert after.message.endswith(" = 2.5")
    assert "redundant" in motion.with_joint(after, 0, 1.0).message
    assert math.isnan(read(after).determinant)


def test_joints_stop_at_their_strokes():
    state = limited(100.0, 160.0)
    after = motion.with_joint(state, 2, 200.0)
    assert after.message == "stopped at the limit d3 = 160"
    assert after.design.at(after.pose).joints[2] == pytest.approx(160.0)


def test_strokes_are_set_for_distances_alone():
    state = sessions.started(choices.named("toz-kucuk-2016-d1-d2-d3-d4-a1-2"))
    after = sessions.with_strokes(state, 50.0, None)
    strokes = after.design.strokes
    assert np.isnan(strokes[after.design.angular]).all()
    assert (strokes[~after.design.angular][:, 0] == 50.0).all()
    assert sessions.common_strokes(after) == (50.0, None)
    assert sessions.common_strokes(state) == (None, None)
    assert sessions.common_strokes(sessions.with_strokes(state, 0.0, 99.0)) == (0.0, 99.0)
    for low, high in ((2.0, 1.0), (-1.0, 3.0), (None, -1.0)):
        with pytest.raises(GspError, match="limits of all distances: expected 0 ≤ least ≤"):
            sessions.with_strokes(state, low, high)


def test_limits_that_differ_are_not_common():
    design = choices.named("workspace-6-3")
    strokes = np.array([[1.0, 30.0 + i] for i in range(6)])
    state = sessions.started(design.replace(strokes=strokes))
    assert sessions.common_strokes(state) == (1.0, None)


# --- entries ---


@pytest.mark.parametrize("text", ["", "  ", "abc", "nan", "inf", "1e400", "1,5", "1_0", "--1", "١"])
def test_entries_that_are_no_finite_numbers_are_refused(text):
    with pytest.raises(GspError, match="position x: expected a finite number"):
        sessions.entered("position x", text)


def test_entries_of_numbers():
    assert [sessions.entered("x", text) for text in ("2", " -1.5e-1 ", "+.5")] == [2.0, -0.15, 0.5]
    assert sessions.entered_or_none("x", " ") is None
    assert sessions.entered_or_none("x", "3") == 3.0


# --- readings ---


def test_what_is_left_of_a_stroke():
    joint = read(limited(100.0, 160.0)).joints[0]
    assert joint.value == pytest.approx(
        gsp.catalogue.design(TOZ).at(limited(1, 999).pose).joints[0]
    )
    assert joint.left == pytest.approx(min(joint.value - 100.0, 160.0 - joint.value))
    assert joint.share == pytest.approx((joint.value - 100.0) / 60.0)
    assert math.isnan(read(sessions.started(choices.named(TOZ))).joints[0].share)


def test_a_joint_in_the_middle_of_its_stroke_has_100_percent_left():
    state = sessions.started(choices.named(TOZ))
    joints = state.design.at(state.pose).joints
    strokes = np.stack((joints - 8.0, joints + 8.0), axis=1)
    middle = replace(state, design=state.design.replace(strokes=strokes))
    assert "100 % of half the stroke" in tables.least_left(read(middle))
    strokes[2, 1] += 8.0 - 1e-3  # all but the third are in the middle
    strokes[2, 0] += 8.0 - 4.321
    near = replace(state, design=state.design.replace(strokes=strokes))
    half = (16.0 - 1e-3 + 4.321) / 2.0
    assert f"{int(100.0 * 4.321 / half)} % of half the stroke" in tables.least_left(read(near))


def test_a_redundant_design_shows_the_root_of_the_gram_determinant_and_names_it():
    six = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    base = np.concatenate((six.base_points, [[0.1, 0.0, 0.0]]))
    top = np.concatenate((six.platform_points, [[0.0, 0.1, 0.0]]))
    state = sessions.started(gsp.Design(["D1"] * 7, base, top, home=six.home))
    rows = state.design.at(state.pose).jacobian
    wanted = np.sqrt(np.linalg.det(rows.T @ rows))
    shown = tables.facts(state, read(state))
    found = re.search(r"<dt>\|det J\|.*?</dt><dd>(.*?)</dd>(.*?)</div>", shown)
    assert float(found[1]) == pytest.approx(wanted, rel=1e-6)
    assert "√det JᵀJ of 7 rows" in found[2]


@pytest.mark.parametrize(
    ("unit", "power"),
    [("mm", "mm³"), ("", "length³"), ("furlong / fortnight", "(furlong / fortnight)³"),
     ("10 mm", "(10 mm)³"), ("x^2", "(x^2)³")],
)  # fmt: skip
def test_compound_units_are_in_parentheses_below_a_power(unit, power):
    state = sessions.started(choices.named("lee-2000-3-3").replace(unit=unit))
    assert f"<dt>det J [{power}]</dt>" in tables.facts(state, read(state))


def test_indices_are_those_of_the_library(toz):
    reading = read(toz, slow=True)
    table = gsp.evaluate(
        toz.design, toz.pose.reshape(1), ["CDN_CL", "CTN", "σ_min", "SD"], backend="numpy"
    )
    for name in ("condition_number", "control_number", "minimum_singular_value"):
        assert reading.index(name).value == pytest.approx(table[name][0], rel=1e-12)
    assert reading.index("singularity_distance").value == pytest.approx(
        table["singularity_distance"][0], rel=1e-9
    )
    assert [one.index.name for one in reading.indices] == list(INDICES)
    assert reading.index("condition_number_ellipsoid").reason.startswith("needs an operation ell")
    assert read(toz).index("singularity_distance").reason.endswith("not compiled yet")


def test_quality_needs_the_maximum_and_is_a_share_of_it(toz):
    assert read(toz).index("quality_index").reason == "the maximum of |det J| is not known yet"
    octahedron = sessions.started(choices.named("lee-2000-3-3"))
    known = replace(octahedron, maximum=gsp.determinant.maximum(octahedron.design))
    shown = read(known).index("quality_index")
    assert (shown.value, shown.gauge, shown.reason) == (pytest.approx(1.0), pytest.approx(1.0), "")


def test_undefined_joints_have_a_reason():
    design = choices.configured(choices.Half(size=1.0), choices.Half(size=1.0))
    flat = sessions.started(design, gsp.Pose(design.base_points[0] - design.platform_points[0]))
    reading = read(flat)
    assert reading.undefined
    assert math.isnan(reading.determinant)
    assert reading.screw is None
    assert reading.index("control_number").reason == "undefined at this pose"
    assert "cannot be changed" in motion.with_joint(flat, 0, 1.0).message
    json.dumps(drawing.placement(flat, reading, "#000000"), allow_nan=False)


# --- matrices as text ---


@pytest.mark.parametrize("form", [matrices.PLAIN, matrices.HOMOGENEOUS])
def test_texts_of_the_matrix_read_back(toz, form):
    rows = matrices.matrix(toz, form)
    found: dict = {"np": np}
    exec(matrices.as_text(toz, form, "numpy"), found)
    assert (found["J"] == rows).all()
    lines = matrices.as_text(toz, form, "CSV").splitlines()
    assert lines[0] == "v_x,v_y,v_z,omega_x,omega_y,omega_z"
    assert (np.array([line.split(",") for line in lines[1:]], dtype=float) == rows).all()
    tex = matrices.as_text(toz, form, "LaTeX")
    assert (tex.count("&"), tex.count(r"\\")) == (30, 5)


def test_lines_are_for_legs_of_points_only(toz):
    with pytest.raises(GspError, match="SPS"):
        matrices.matrix(toz, matrices.LINES)
    with pytest.raises(GspError, match="characteristic length"):
        matrices.matrix(replace(toz, length=None), matrices.HOMOGENEOUS)


# --- links ---


@pytest.mark.parametrize("published", [True, False])
def test_a_link_restores_the_state_bit_by_bit(toz, published):
    state = motion.nudged(motion.nudged(toz, "x", 1), "yaw", -1)
    if not published:
        state = sessions.with_strokes(state, 10.0, 999.0)
    words = dict(pair.split("=", 1) for pair in links.query(state).split("&"))
    from urllib.parse import unquote

    again = links.restored({k: unquote(v) for k, v in words.items()}, choices.named("lee-2000-3-3"))
    assert ("design" in words) is published
    assert (again.pose.position == state.pose.position).all()
    assert again.pose.rotation == pytest.approx(state.pose.rotation, abs=1e-15)
    assert (again.design.base_points == state.design.base_points).all()
    assert again.design.name == TOZ


def test_a_link_with_angles():
    """The same state as by a quaternion; without a rotation there is none."""
    default = choices.named("lee-2000-3-3")
    state = links.restored({"position": "0,0,1.2", "rpy_deg": "10,-20,30"}, default)
    wanted = gsp.Pose.from_rpy([0.0, 0.0, 1.2], [10.0, -20.0, 30.0], degrees=True)
    assert (state.pose.position == wanted.position).all()
    assert (state.pose.rotation == wanted.rotation).all()
    assert links.restored({"rpy_deg": "0,0,5"}, default).pose.position == pytest.approx([0, 0, 1])
    flat = links.restored({"position": "1,2,3"}, default)
    assert (flat.pose.rotation == np.eye(3)).all()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"rpy": "0,0,30"}, "unknown parameter of a link 'rpy'; nearest: rpy_deg"),
        ({"desing": "lee-2000-3-3"}, "unknown parameter of a link 'desing'; nearest: design"),
        ({"design": "lee-2000-3-3", "x": "1"}, "unknown parameter of a link 'x'; known: design"),
        ({"rpy_deg": "0,0,0", "rotation": "0,0,0,1"}, "link: expected rotation or rpy_deg"),
        ({"design": "lee-2000-3-3", "file": ""}, "link: expected design or file"),
        ({"template": "lee-2000-3-3"}, "link: expected a design with the template"),
    ],
)
def test_links_have_no_other_parameters(words, message):
    with pytest.raises(GspError, match=message):
        links.restored(words, choices.named("lee-2000-3-3"))


def test_every_parameter_of_a_link_is_documented():
    text = (Path(__file__).parents[2] / "docs" / "app.md").read_text(encoding="utf-8")
    section = text.split("## Links", 1)[1].split("## ", 1)[0]
    assert set(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)) == set(links.WORDS)


def test_the_address_follows_a_state_at_rest(toz):
    address = links.Address(toz)
    assert address.due(toz) == ""  # the address with which the page was opened stays
    first = motion.nudged(toz, "x", 1)
    assert address.due(first) == ""
    second = motion.nudged(first, "x", 1)
    assert address.due(second) == ""  # still in motion
    assert address.due(second.saying("words")) == links.query(second)
    assert address.due(second) == ""  # it is there
    for other in (
        sessions.with_length(second, 3.0),
        sessions.with_strokes(second, 1.0, 400.0),
        sessions.started(choices.named("lee-2000-3-3")),
    ):
        assert address.due(other) == ""
        assert address.due(other) == links.query(other)


def test_designs_that_no_link_can_hold(toz, monkeypatch):
    state = sessions.with_strokes(toz, 1.0, 400.0)
    monkeypatch.setattr(links, "LONGEST_LINK", 100)
    with pytest.raises(GspError, match="link: expected a design of which the link has at most 100"):
        links.query(state)
    address = links.Address(toz)
    assert address.due(state) == address.due(state) == ""
    monkeypatch.undo()
    monkeypatch.setattr(choices, "MOST_UPLOADED_LEGS", 5)
    with pytest.raises(GspError, match="link: expected at most 5 legs"):
        links.query(state)


NUMBERS = ["0", "-1", "1e308", "-1e308", "1e20", "nan", "inf", "-inf", "9" * 400]
NO_NUMBERS = [
    "",
    "x",
    ",",
    "0,0,2,",
    "0;0;1",
    "none ",
    "../../etc/passwd",
    "\x00",
    "<b>é",
    "\ud800",
]
TUPLES = [",".join([one] * count) for one in NUMBERS for count in range(2, 7)]
NONSENSE = {
    "design": [*NUMBERS, *NO_NUMBERS, *TUPLES],
    "file": [*NUMBERS, *NO_NUMBERS, links.packed("x" * 300_000), links.packed("name = 1")],
    "template": [*NUMBERS, *NO_NUMBERS],
    "position": [*NUMBERS, *NO_NUMBERS, *TUPLES, "0,0,1e20", "0,0,nan"],
    "rotation": [*NUMBERS, *NO_NUMBERS, *TUPLES, "0,0,nan,1"],
    "rpy_deg": [*NUMBERS, *NO_NUMBERS, *TUPLES, "0,0,nan"],
    "length": [*NUMBERS, *NO_NUMBERS, *TUPLES],
}
# The only one of these texts that are values.
VALUES = {(name, text) for name in ("position", "rpy_deg") for text in ("0,0,0", "-1,-1,-1")}
VALUES |= {("rotation", ",".join([one] * 4)) for one in ("-1", "1e20", "1e308", "-1e308")}


@pytest.mark.parametrize(
    ("field", "text"),
    [(field, text) for field, texts in NONSENSE.items() for text in texts],
    ids=lambda text: ascii(text)[:20],
)
def test_links_take_only_what_the_controls_take(field, text):
    words = {"design": "D1^6"} if field == "template" else {}
    default = choices.named("lee-2000-3-3")
    if (field, text) in VALUES:  # lengths of a quaternion do not matter
        state = links.restored({**words, field: text}, default)
        assert np.isfinite(read(state).jacobian).all()
        return
    with pytest.raises(GspError) as found:
        links.restored({**words, field: text}, default)
    assert len(str(found.value).splitlines()) == 1
    assert len(str(found.value)) < 600


def test_an_upload_has_limits():
    with pytest.raises(GspError, match="at most 200000 letters"):
        choices.from_file("#" * 200_001)
    leg = '[[legs]]\nconstraints="D1"\nbase_point=[1,2,3]\nplatform_point=[0,1,0]\n'
    with pytest.raises(GspError, match="at most 60 legs"):
        choices.from_file(leg * 61)


# --- drawings ---


@pytest.mark.parametrize("side", ["base", "platform"])
def test_an_anchor_far_away_on_its_line_leaves_the_mechanism_its_size(side):
    design = choices.named("toz-kucuk-2016-d1-d2-d3-d4-a1-2")
    leg = next(i for i, kind in enumerate(design.legs) if kind.name.startswith("D4"))
    points = getattr(design, f"{side}_points").copy()
    line = getattr(design, f"{side}_directions")[leg]
    points[leg] += 1e3 * design.rms_radius * line
    state = sessions.started(design.replace(**{f"{side}_points": points}))
    picture = drawing.drawing(state)
    assert picture["size"] < 1.5 * drawing.drawing(sessions.started(design))["size"]
    # The anchor that is drawn is on the same line.
    off = np.array(picture["legs"][leg][side]) - getattr(design, f"{side}_points")[leg]
    assert np.linalg.norm(np.cross(off, line)) < 1e-3 * design.rms_radius


@pytest.mark.parametrize("name", [*choices.published_names(), "D4^3 A1^3"])
def test_a_drawing_is_plain_numbers(name):
    state = sessions.started(choices.named(name))
    picture = drawing.drawing(state)
    place = drawing.placement(state, read(state), "#112233")
    assert len(json.dumps(place, allow_nan=False)) < 1000
    json.dumps(picture, allow_nan=False)
    assert [leg["kinds"] for leg in picture["legs"]] == [
        [j.kind for j in leg.joints] for leg in state.design.legs
    ]
    segments = state.design.at(state.pose).segments
    for foot, low, high in zip(
        place["feet"], segments.base_feet, segments.platform_feet, strict=True
    ):
        assert foot == pytest.approx([*low, *high], rel=1e-4, abs=1e-4 * picture["size"])
    assert len(picture["base"]["faces"]) % 3 == 0


def test_colours_go_from_bad_to_good():
    ends = [drawing.merit_colour(x) for x in (0.0, 1.0)]
    assert ends == ["#D55E00", "#0072B2"]
    assert drawing.merit_colour(float("nan")) == "#7A8AA0"
