"""`gsp show` and `gsp jacobian`: what they print is what the library computes."""

from __future__ import annotations

import json
import re

import numpy as np
import pandas as pd
import pytest

import gsp as library
from gsp.geometry.pose.texts import pose_text
from gsp.model.constraints import CONSTRAINT

NAME = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"
DESIGN = library.catalogue.design(NAME)
FLAT = DESIGN.home.position.tolist()


def numbers(line: str) -> list[float]:
    return [float(x) for x in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e[+-]?\d+)?(?![\w.])", line)]


def test_show_mechanism(gsp):
    out = gsp("show", "A1A1D4D2D1D1").out
    assert out.startswith("D1^2 D2 D4 A1^2, class 4D2A")
    for words in (
        "5, 4 independent loops",
        "Mobility   6",
        "D1^2 D3 D4 A1^2",
        "[C: slide and turn]",
    ):
        assert words in out
    shown = {name for name in CONSTRAINT if CONSTRAINT[name].source in out}
    assert shown == {"D1", "D2", "D4", "A1"}


def test_show_symmetric(gsp):
    out = gsp("show", "D4^6").out
    assert "Symmetric  yes" in out
    assert "exchanged: itself" in out


def test_show_design(gsp):
    out = gsp("show", NAME).out
    posture = DESIGN.at(DESIGN.home)
    for name, value in zip(posture.joint_names, posture.joints, strict=True):
        line = next(x for x in out.splitlines() if re.match(rf"{name} +\d", x))
        assert numbers(line)[0] == pytest.approx(value, rel=1e-6)
    line = next(x for x in out.splitlines() if x.startswith("condition_number "))
    wanted = library.indices.condition_number(posture, 160.0)
    assert numbers(line)[0] == pytest.approx(float(wanted), rel=1e-5)
    assert DESIGN.source in out


@pytest.mark.parametrize("name", library.catalogue.design_names())
def test_every_published_design_shows_and_ranks(gsp, tmp_path, name):
    assert gsp("show", name).status == 0
    assert gsp("jacobian", name).status == 0
    result = gsp("rank", name, "--samples", 3, "--no-plot", "--out", "r.csv")
    assert result.status == 0, result
    assert pd.read_csv(tmp_path / "r.csv")["design"].tolist() == [name]


def test_negative_numbers_are_values(gsp):
    assert gsp("jacobian", NAME, "--position", -10, -1, -150.5, "--angles", -1, 0, -2).status == 0


def test_show_at_another_pose(gsp):
    out = gsp("show", NAME, "--position", 0, 0, 120, "--angles", 1, 2, 3).out
    posture = DESIGN.at(library.Pose.from_rpy([0, 0, 120], [1, 2, 3], degrees=True))
    line = next(x for x in out.splitlines() if re.match(r"d1 +\d", x))
    assert numbers(line)[0] == pytest.approx(posture.joints[0], rel=1e-6)


def test_show_draws(gsp, tmp_path):
    assert gsp("show", NAME, "--plot", "d.png").status == 0
    assert gsp("show", "D2^6", "--plot", "m.svg").status == 0
    assert (tmp_path / "d.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in (tmp_path / "m.svg").read_text()
    assert "exists already" in gsp("show", NAME, "--plot", "d.png").error
    assert gsp("show", NAME, "--plot", "d.png", "--force").status == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["D5^6"], "unknown mechanism"),
        (["nothing"], "unknown design or mechanism 'nothing'"),
        (["nothing.toml"], "nothing.toml"),
        ([NAME, "--plot", "x.txt"], ".png, .pdf, .svg"),
        ([NAME, "--plot", "no/x.png"], "folder no does not exist"),
        ([NAME, "--position", 1, 2], "--position"),
        ([NAME, "--position", 0, 0, "nan"], "finite"),
        ([], "NAME: expected a mechanism"),
    ],
)
def test_invalid_arguments_of_show_are_errors(gsp, arguments, words):
    assert words in gsp("show", *arguments).error


def test_design_without_home(gsp, tmp_path):
    DESIGN.replace(home=None).write(tmp_path / "d.toml")
    assert gsp("show", "d.toml").status == 0
    assert "--position" in gsp("show", "d.toml", "--plot", "d.png").error.replace("\n", " ")
    assert "--position" in gsp("jacobian", "d.toml").error
    assert "--position" in gsp("jacobian", "d.toml", "--angles", 0, 0, 0).error
    assert gsp("jacobian", "d.toml", "--position", 0, 0, 120).status == 0


@pytest.mark.parametrize("length", [None, 160.0])
def test_jacobian(gsp, tmp_path, length):
    option = [] if length is None else ["--length", length]
    out = gsp("jacobian", NAME, *option, "--out", "j.csv").out
    posture = DESIGN.at(DESIGN.home)
    rows = posture.jacobian if length is None else posture.homogeneous(length)
    table = pd.read_csv(tmp_path / "j.csv")
    np.testing.assert_array_equal(table.iloc[:, 5:], rows)
    np.testing.assert_array_equal(table["value"], posture.joints)
    assert tuple(table["joint"]) == posture.joint_names
    for i, name in enumerate(posture.joint_names):
        line = next(x for x in out.splitlines() if x.startswith(f"{name} "))
        np.testing.assert_allclose(numbers(line)[-6:], rows[i], rtol=1e-5)
    facts = json.loads((tmp_path / "j.csv.json").read_text())
    assert facts["position"] == FLAT
    assert facts["length"] == length


def test_jacobian_pose_options(gsp, tmp_path):
    """(α, β, γ) of rpy is Rz(γ) Ry(β) Rx(α): as moving axes ZYX the angles are γ, β, α."""
    at = ("--position", 1, 2, 130)
    gsp("jacobian", NAME, *at, "--angles", 3, 4, 5, "--out", "a.csv")
    gsp("jacobian", NAME, *at, "--angles", 5, 4, 3, "--order", "ZYX", "--out", "b.csv")
    gsp("jacobian", NAME, *at, "--out", "c.csv")
    a, b, c = (pd.read_csv(tmp_path / f"{n}.csv").iloc[:, 5:].to_numpy() for n in "abc")
    np.testing.assert_allclose(a, b, atol=1e-14)
    pose = library.Pose([1.0, 2.0, 130.0])
    np.testing.assert_array_equal(c, DESIGN.at(pose).jacobian)


def test_undefined_rows_have_a_reason(gsp, tmp_path):
    design = library.catalogue.design("toz-kucuk-2016-d3-6").replace(legs=["D1"] * 6, name="touch")
    points = design.base_points.copy()
    points[0] = design.platform_points[0]
    design.replace(base_points=points).write(tmp_path / "d.toml")
    result = gsp("jacobian", "d.toml", "--position", 0, 0, 0)
    assert result.status == 0
    assert "d1 is undefined: the anchor points coincide" in result.err
    line = next(x for x in result.out.splitlines() if x.startswith("d1 "))
    assert line.count("–") == 7


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nobody"], "unknown design 'nobody'"),
        (["D1^6"], "unknown design 'D1^6'"),
        ([NAME, "--length", 0], "--length: expected a positive number"),
        ([NAME, "--order", "wx"], "order"),
        ([NAME, "--angles", "a", "b", "c"], "--angles"),
        ([NAME, "--out", "j.pdf"], "a name ending in"),
    ],
)
def test_invalid_arguments_of_jacobian_are_errors(gsp, arguments, words):
    assert words in gsp("jacobian", *arguments).error


def test_joints_beyond_their_strokes_are_marked(gsp, tmp_path):
    joints = DESIGN.at(DESIGN.home).joints
    strokes = np.stack((joints - 1.0, joints + 1.0), axis=-1)
    strokes[1] = joints[1] + 10.0, joints[1] + 20.0
    strokes[2] = np.nan
    DESIGN.replace(strokes=strokes).write(tmp_path / "d.toml")
    name = DESIGN.joint_names[1]
    for command in ("show", "jacobian"):
        result = gsp(command, "d.toml")
        assert result.err == f"gsp: beyond the stroke: {name}\n"
        line = next(x for x in result.out.splitlines() if re.match(rf"{name} +[\d1]", x))
        assert f"{strokes[1, 0]:.6g} … {strokes[1, 1]:.6g} (beyond)" in line
        assert result.out.count("(beyond)") == 1
    gsp("jacobian", "d.toml", "--out", "j.csv")
    table = pd.read_csv(tmp_path / "j.csv")
    np.testing.assert_allclose(table["stroke_high"][:2], strokes[:2, 1])
    assert "stroke" not in gsp("jacobian", NAME).out


def test_all_indices_are_shown_on_request(gsp):
    """λ is |det J| over the maximum; the others are those of `gsp.indices`."""
    name = "toz-kucuk-2016-d3-6"
    design = library.catalogue.design(name)
    posture = design.at(design.home)
    out = gsp("show", name, "--indices", "all").out
    for index in library.indices.INDICES:
        assert re.search(rf"^{index} ", out, re.MULTILINE)
    for index, value in (
        ("quality_index", library.indices.quality_index(posture)),
        ("condition_number", library.indices.condition_number(posture, 95.0)),
        ("rigidity_rate", library.indices.rigidity_rate(posture)),
    ):
        line = next(x for x in out.splitlines() if x.startswith(f"{index} "))
        assert numbers(line)[0] == pytest.approx(float(value), rel=1e-5)
    few = gsp("show", name, "--indices", "CTN,λ").out
    assert "condition_number" not in few
    assert "unknown index" in gsp("show", name, "--indices", "beauty").error


def test_what_an_index_needs_is_said_before_anything_is_printed(gsp, tmp_path):
    DESIGN.replace(characteristic_length=None).write(tmp_path / "d.toml")
    result = gsp("show", "d.toml", "--indices", "CDN_CL")
    assert "length" in result.error
    assert result.out == ""
    DESIGN.replace(home=None).write(tmp_path / "h.toml")
    result = gsp("show", "h.toml", "--indices", "CTN")
    assert "--position" in result.error
    assert result.out == ""


def test_jacobian_prints_the_determinant(gsp, tmp_path):
    value = np.linalg.det(DESIGN.at(DESIGN.home).jacobian)
    lines = gsp("jacobian", NAME).out.splitlines()
    assert f"det J  {value:#.7g} mm" in lines
    points = np.array([[np.cos(t), np.sin(t), 0.0] for t in np.arange(6) * np.pi / 3])
    flat = library.Design(["D1"] * 6, 2 * points, points)
    flat.write(tmp_path / "flat.toml")
    lines = gsp("jacobian", "flat.toml", "--position", 0, 0, 1).out.splitlines()
    assert any(line.startswith("det J") and line.endswith(", singular") for line in lines)


@pytest.mark.parametrize("command", ["show", "jacobian"])
def test_all_that_is_known_is_shown(gsp, command):
    """Every index that needs nothing more, λ by the closed form, and what is left out and why."""
    name = "lee-2000-3-3"
    design = library.catalogue.design(name)
    posture = design.at(design.home)
    out = gsp(command, name).out
    for index, value in (
        ("quality_index", library.indices.quality_index(posture)),
        ("rigidity_rate", library.indices.rigidity_rate(posture)),
        ("complex_deviation_rotation", library.indices.complex_deviation_rotation(posture)),
    ):
        line = next(x for x in out.splitlines() if x.startswith(f"{index} "))
        assert numbers(line)[0] == pytest.approx(float(value), rel=1e-5)
    assert "CDN_CL, σ_min, SD, F_max, LCI: with --length" in out
    assert "with --indices all" not in out  # which needs a length
    out = gsp(command, name, "--length", 1.0).out
    assert re.search("^local_conditioning ", out, re.MULTILINE)
    assert "SD: with --indices all" in out


@pytest.mark.parametrize("command", ["show", "jacobian"])
def test_families_have_parameters(gsp, command):
    family = "lee-3-6(a=15, b=30, beta=0.2)"
    design = library.families.lee.platform_3_6(15.0, 30.0, 0.2)
    height = float(library.families.lee.best_height(15.0, 30.0, 0.0, 0.2))
    value = np.linalg.det(design.at(library.Pose([0.0, 0.0, height])).jacobian)
    assert f"det J  {value:#.7g} length^3" in gsp(command, family).out.splitlines()
    assert "expected lee-3-6(a=…, b=…, beta=…)" in gsp(command, "lee-3-6(a=1)").error
    assert "unknown family" in gsp(command, "lee-7(a=1)").error


def test_show_a_platform_in_one_point(gsp, tmp_path):
    changes = {
        "legs": ["D2"] * 6,
        "platform_points": np.zeros((6, 3)),
        "base_directions": None,
        "platform_directions": np.random.default_rng(0).normal(size=(6, 3)),
    }
    library.catalogue.design("toz-kucuk-2016-d3-6").replace(**changes).write(tmp_path / "d.toml")
    result = gsp("show", "d.toml")
    assert result.status == 0
    assert "control_number" in result.out
    assert "CDN_OE" not in result.out


def test_a_design_of_many_legs_is_shown(gsp, tmp_path):
    rng = np.random.default_rng(0)
    design = library.Design(["D1"] * 3000, *rng.normal(size=(2, 3000, 3)))
    design.write(tmp_path / "many.toml")
    out = gsp("show", "many.toml", "--position", 0, 0, 5).out
    assert re.search(r"^ *3000  D1 +SPS", out, re.MULTILINE)
    assert re.search(r"^d3000 +\d", out, re.MULTILINE)


def test_what_is_not_a_number_is_in_the_message(gsp):
    assert "--position" in gsp("show", NAME, "--position", "x", 0, 0).error
    assert "received 'x'" in gsp("show", NAME, "--position", "x", 0, 0).error
    assert "received '1e4'" in gsp("rank", NAME, "--samples", "1e4").error


def test_show_prints_the_ellipsoid_only_with_an_index_of_it(gsp):
    assert "ellipsoid " in gsp("show", NAME, "--indices", "CDN_OE").out.splitlines()[-1]
    assert "ellipsoid " not in gsp("show", NAME, "--indices", "CTN").out


def test_a_design_without_a_home_pose_is_shown_without_a_posture(gsp):
    DESIGN.replace(home=None).write("d.toml")
    shown = gsp("show", "d.toml")
    assert shown.status == 0
    assert "no posture" in shown.out + shown.err


def test_positions_of_rounding_size_are_printed_as_zero():
    pose = library.Pose([-4.7e-17, 3e-13, 1.0])
    assert pose_text(pose, "m").startswith("position (0, 0, 1) m")
    assert pose_text(library.Pose([0.0, 0.0, 3e-13]), "").startswith("position (0, 0, 3e-13)")


def test_legs_of_a_template_without_use_are_named(gsp):
    seven = library.Design(
        ["D1"] * 7,
        *np.random.default_rng(1).normal(size=(2, 7, 3)),
        home=library.Pose([0, 0, 5]),
        name="seven",
    )
    seven.write("d.toml")
    options = ("--template", "d.toml", "--samples", 5, "--length", 1, "--no-plot")
    found = gsp("rank", "D1^6", *options)
    assert found.status == 0, found
    assert "the last 1 of the legs of seven are not used" in found.out + found.err


def test_export_warns_of_a_design_without_a_unit_and_writes_no_hidden_file(gsp):
    DESIGN.replace(name="..", unit="").write("d.toml")
    found = gsp("export", "d.toml", "--to", "mjcf")
    assert found.status == 0, found
    assert "taken as metres" in found.out + found.err
    assert found.out.split()[-1] == "design.xml"
    assert "Value error" not in gsp("export", "d.toml", "--to", "bogus").error


def test_show_takes_a_characteristic_length(gsp):
    done = gsp("show", "lee-2000-3-3", "--indices", "CDN_CL", "--length", "2")
    assert done.status == 0
    line = next(x for x in done.out.splitlines() if x.startswith("condition_number"))
    design = library.catalogue.design("lee-2000-3-3")
    value = library.indices.condition_number(design.at(design.home), 2.0)
    assert float(line.split()[2]) == pytest.approx(value, rel=1e-5)
    assert gsp("show", "lee-2000-3-3", "--indices", "CDN_CL").status == 2
    assert gsp("show", "lee-2000-3-3", "--length", "0").status == 2
    assert gsp("show", "D1^6", "--length", "2").status == 2


def test_all_indices_are_those_of_so_many_actuators(gsp, tmp_path):
    rng = np.random.default_rng(1)
    points = rng.normal(size=(2, 7, 3))
    home = library.Pose([0.0, 0.0, 2.0])
    design = library.Design(["D1"] * 7, *points, home=home, characteristic_length=1.0)
    design.write(tmp_path / "seven.toml")
    shown = gsp("show", "seven.toml", "--indices", "all")
    assert shown.status == 0, shown.error
    assert "control_number" in shown.out
    assert "rigidity_rate" not in shown.out
    words = ("--translate", "z", "--span", "0:0.1", "--steps", "2", "--indices", "all")
    assert gsp("sweep", "seven.toml", *words, "--ellipsoid", "1", "1", "1").status == 0
    box = "0 0 2:2.1 0 0 0"
    found = gsp("rank", "seven.toml", "--indices", "all", "--samples", "3", "--box", box)
    assert found.status == 0, found.error


def test_placements_are_designs(gsp, tmp_path):
    """By legs and template, by mechanism and template, and by legs on the default template."""
    template = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"
    own = gsp("show", template).out.splitlines()
    placed = gsp("show", f"D1-D2-D3-D4A1-A1@{template}").out.splitlines()
    assert (
        own[own.index("At position (7, -8, 124) mm, roll, pitch, yaw (2, 5, -5)°") :]
        == (placed[placed.index("At position (7, -8, 124) mm, roll, pitch, yaw (2, 5, -5)°") :])
    )
    assert "D1^3 D2^3" in gsp("jacobian", "D1^3D2^3@toz-kucuk-2016-d3-6").out
    alone = gsp("jacobian", "d1-d1-d1-d2-d2-d2").out
    assert alone == gsp("jacobian", "D1-D1-D1-D2-D2-D2@toz-kucuk-2016-d3-6").out
    other = library.catalogue.design(template).replace(name="")
    other.write(tmp_path / "own@home.toml")
    assert gsp("show", "own@home.toml").status == 0
    assert gsp("show", "D1-0-D2-D3-D4A1-A1@own@home.toml").status == 2
    assert gsp("show", "D1-D2-D3-D4A1-A1@own@home.toml").status == 0
    wrong = gsp("jacobian", "D1-D2@toz-kucuk-2016-d3-6")
    assert "legs: expected 6 legs, one per position" in wrong.error
    assert "unknown design 'nobody'" in gsp("show", "D1-D1-D1-D1-D1-D1@nobody").error


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("D1^6", ("show", "{}")),
        ("lee-2000-3-3", ("show", "{}")),
        ("lee-2000-planar", ("planar", "{}", "--stroke", 0.3, 0.9, "--rays", 2, "--no-connecting")),
    ],
)
def test_a_file_does_not_replace_a_name_of_the_library(gsp, tmp_path, name, words):
    before = gsp(*(word.format(name) if word == "{}" else word for word in words))
    (tmp_path / name).write_text("no design", encoding="utf-8")
    taken = gsp(*(word.format(name) if word == "{}" else word for word in words))
    assert taken.out == before.out
    assert f"gsp: {name} is taken from the library; the file of this name is ./{name}" in taken.err
    path = gsp(*(word.format(f"./{name}") if word == "{}" else word for word in words))
    assert (path.status, path.out) == (2, "")
    assert "not TOML" in path.err or "line 1" in path.err


@pytest.mark.parametrize(
    "design", ["lee-centre-side(a=1, b=2, alpha=0.1, beta=0.3)", "lane-modified-paradex"]
)
def test_the_indices_that_are_left_out_are_found_as_it_is_stated(gsp, design):
    out = gsp("show", design).out
    assert not re.search(r"(^|\s)-0(\s|$)", out)
    hints = [line.split(": with ")[1] for line in out.splitlines() if ": with --" in line]
    assert "--length" in hints
    named = [hint for hint in hints if hint.startswith("--indices")]
    assert named == ([] if design.startswith("lane") else ["--indices λ"])
    assert all(gsp("show", design, *hint.split()).status == 0 for hint in named)


def test_of_designs_with_drives_nothing_is_advised_that_is_refused(gsp):
    """SD and λ have no values for them; their drives are in the first line."""
    shown = gsp("show", "lane-rotary", "--length", 1)
    assert shown.out.startswith("lane-rotary, D1^6, class 6D, 6 cranks\n")
    assert "SD" not in shown.out
    assert "--indices" not in shown.out
    assert "SD" not in gsp("show", "lane-rotary").out


def test_tables_in_latex_have_symbols_and_units(gsp, tmp_path):
    assert gsp("jacobian", "lane-rotary", "--out", "j.tex").status == 0
    lines = (tmp_path / "j.tex").read_text().splitlines()
    twist = r"$v_x$ & $v_y$ & $v_z$ & $\omega_x$ & $\omega_y$ & $\omega_z$ \\"
    assert lines[2] == f"joint & leg & constraint & value & unit & {twist}"
    assert lines[4].startswith(r"$\theta_{1}$ & 1 & $D_1$ & ")
    design = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"
    assert gsp("inverse", design, "--out", "i.tex").status == 0
    heads = (tmp_path / "i.tex").read_text().splitlines()[2].removesuffix(r" \\").split(" & ")
    assert heads[:4] == ["$x$ [mm]", "$y$ [mm]", "$z$ [mm]", r"angle 1 [$^\circ$]"]
    assert heads[6] == "$d_{1}$ [mm]"
    assert heads[-1] == r"$\theta_{5}$ [rad]"
