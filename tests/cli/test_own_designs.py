"""`gsp import` and `gsp new`: design files from tables, options and questions."""

import sys
from pathlib import Path

import numpy as np
import pytest

from gsp import Design, catalogue, hexapod, read_design
from gsp.cli.outputs import waiting

LIFT = hexapod(2, 20, 1, 30, 1.5, degrees=True, strokes=(1.5, 2.5))
NUMBERS = ("--base-radius", 2, "--base-angle", 20, "--platform-radius", 1,
           "--platform-angle", 30, "--height", 1.5)  # fmt: skip


def same(path, design):
    found = read_design(path)
    np.testing.assert_array_equal(found.base_points, design.base_points)
    np.testing.assert_array_equal(found.platform_points, design.platform_points)
    np.testing.assert_array_equal(found.platform_directions, design.platform_directions)
    if design.strokes is not None:
        np.testing.assert_array_equal(found.strokes, design.strokes)
    return found


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".xlsx"])
def test_tables_give_the_same_numbers(gsp, suffix):
    legs = ["D1", "D1", "D2", "D3", "D4 A1", "D1"]
    rng = np.random.default_rng(3)
    strokes = np.sort(np.abs(rng.normal(size=(7, 2))), axis=1)
    strokes[2] = np.nan
    design = Design(legs, *rng.normal(size=(4, 6, 3)), strokes=strokes)
    if suffix == ".xlsx":  # such files are written with 16 digits, which are not all of a number
        points = [np.round(p, 6) for p in (design.base_points, design.platform_points)]
        lines = [np.sign(p) * [1.0, 0.0, 0.0] for p in rng.normal(size=(2, 6, 3))]
        design = Design(legs, *points, *lines, strokes=np.round(strokes, 6))
    frame, path = design.to_frame(), f"mine{suffix}"
    write = {".csv": frame.to_csv, ".parquet": frame.to_parquet, ".xlsx": frame.to_excel}
    write[suffix](path, index=False)
    assert gsp("import", path, "--unit", "mm", "--home", 0, 0, 9).out.strip() == "mine.toml"
    found = same("mine.toml", design)
    assert (found.unit, found.name, found.home.position.tolist()) == ("mm", "mine", [0, 0, 9])
    assert "exists already, and --force replaces it" in gsp("import", path).error
    assert gsp("import", path, "--force", "--name", "other").status == 0
    assert read_design("mine.toml").name == "other"


@pytest.mark.parametrize(
    "header",
    [
        "bx,by,bz,px,py,pz", "x_base;y_base;z_base;x_platform;y_platform;z_platform",
        "Base X\tBase Y\tBase Z\tPlatform-X\tPlatform-Y\tPlatform-Z", "b_x,b_y,b_z,p.x,p.y,p.z",
    ],
)  # fmt: skip
def test_common_headers_and_separators(gsp, header):
    mark = next(mark for mark in ";\t," if mark in header)
    rows = np.hstack((LIFT.base_points, LIFT.platform_points)).tolist()
    lines = [f"leg{mark}{header}{mark}Lmin{mark}Lmax"]
    lines += [mark.join(map(repr, [i, *row, 1.5, 2.5])) for i, row in enumerate(rows)]
    Path("a.csv").write_text("# anchors\n\n" + "\n".join(lines) + "\n")
    assert gsp("import", "a.csv", "--out", "b.toml").status == 0
    same("b.toml", LIFT)


def table(line, old, new):
    lines = LIFT.to_frame().to_csv(index=False).splitlines()
    assert old in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(old, new, 1)
    return "\n".join(lines[:2] + [""] + lines[2:])  # an empty line counts


WRONG = {
    "number": (table(3, "D1,", "D1,a"), "bad.csv: line 4, column 'base_x': expected a number"),
    "empty": (table(2, ",1.5,", ",,").replace("D1,", "D1,nan ", 1), "line 2, column 'base_x'"),
    "leg": (table(7, "D1", "D7"), "line 8, column 'constraints': expected one of 'D1'"),
    "limits": (table(4, "1.5", "3.5"), "line 5, column 'stroke_low': expected at most"),
    "cells": (table(5, "D1", "D1,1"), "line 6: expected 9 cells, as in the header, received 10"),
    "column": (table(1, "base_y", "bass_y"), "line 1; unknown|unknown column 'bass_y'"),
    "missing": (table(1, "base_y", "leg"), "line 1): expected|none named 'base_y'"),
    "nothing": ("\n\n", "expected a header and rows"),
    "large": (
        table(3, "1.5", "1e101"),
        "line 4, column 'stroke_low': expected a number of at most 1e+100 in size, received 1e+101",
    ),
    "quote": (table(4, "D1", '"D1'), "bad.csv, line 5: expected a closing quote"),
    "last quote": (table(7, "2.5", '"2.5'), "bad.csv, line 8: expected a closing quote"),
    "again": (
        table(2, "D1", "D1") + "\n" + table(4, "D1", "D1").splitlines()[4],
        "bad.csv: line 9: expected another leg than that of line 5, received the same",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_errors_name_line_and_column(gsp, case):
    text, wanted = WRONG[case]
    Path("bad.csv").write_text(text)
    error = gsp("import", "bad.csv").error
    assert any(part in error for part in wanted.split("|")), error
    assert not Path("bad.toml").exists()


def test_quotes_in_comments_and_in_cells_do_not_matter(gsp):
    rows = LIFT.to_frame().to_csv(index=False).splitlines()
    rows[1:2] = ['# a, "comment', rows[1].replace("D1", '"D1" ')]
    Path("a.csv").write_text("\n".join(rows))
    assert gsp("import", "a.csv").status == 0
    same("a.toml", LIFT)


@pytest.mark.parametrize("axis", ["x", "z"])
def test_the_arm_of_a_slider_is_refused(gsp, axis):
    frame = catalogue.design("lane-modified-paradex").to_frame()
    assert set(frame["drive"]) == {"slider"}
    frame[f"arm_{axis}"] = 0.5
    frame.to_csv("a.csv", index=False)
    wanted = f"line 2, column 'arm_{axis}': expected nothing, as a slider has no arm, received 0.5"
    assert wanted in gsp("import", "a.csv").error


def test_other_files_are_refused(gsp):
    error = gsp("import", "lift.toml").error
    assert "expected a table (.csv, .parquet, .xlsx), or a model or package (.xml, " in error
    assert "a.csv" in gsp("import", "a.csv").error
    Path("a.xlsx").write_text("no table")
    assert "a.xlsx: expected a table" in gsp("import", "a.xlsx").error


def test_a_new_hexapod_from_options(gsp):
    options = ("--unit", "m", "--strokes", 1.5, 2.5, "--name", "lift")
    assert gsp("new", *NUMBERS, *options).out.strip() == "lift.toml"
    assert same("lift.toml", LIFT).unit == "m"
    assert "exists already" in gsp("new", *NUMBERS, "--name", "lift").error
    assert gsp("new", *NUMBERS, "--out", "z.toml", "--arrangement", "zigzag").status == 0
    same("z.toml", hexapod(2, 20, 1, 30, 1.5, degrees=True, arrangement="zigzag"))


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("../up", "up.toml"),
        ("a/b", "a-b.toml"),
        (".h", "h.toml"),
        ("/", "design.toml"),
        ("my lift", "my-lift.toml"),
    ],
)
def test_the_file_of_a_new_design_is_here_and_not_hidden(gsp, name, file):
    assert gsp("new", *NUMBERS, "--name", name).out.strip() == file
    assert read_design(file).name == name


def test_a_new_hexapod_from_questions(gsp, monkeypatch):
    answers = iter(["mm", "2", "20", "1", "30", "1.5", "y", "1.5", "2.5"])
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.prompt", lambda text, **_: _typed(next(answers), **_))
    monkeypatch.setattr("typer.confirm", lambda text, **_: next(answers) == "y")
    assert gsp("new").status == 0
    assert same("hexapod.toml", LIFT).unit == "mm"
    assert next(answers, None) is None


def test_what_names_no_unit_is_refused(gsp, monkeypatch):
    """Users answer the first question, that of the unit, with the radius."""
    assert "--unit: expected the name of a unit" in gsp("new", *NUMBERS, "--unit", "2").error
    answers = iter("2 2,5 1e3 20° x mm 2 20 1 30 1.5 n".split())
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.prompt", lambda text, **_: next(answers))
    monkeypatch.setattr("typer.confirm", lambda text, **_: next(answers) == "y")
    result = gsp("new")
    assert read_design("hexapod.toml").unit == "mm"
    wanted = "gsp: answer: expected the name of a unit of length: um, µm, μm, mm, cm, dm, m, in, "
    said = [f"{wanted}inch, ft, received {text!r}" for text in ("2", "2,5", "1e3", "20°", "x")]
    assert result.err.splitlines() == said


def test_a_file_that_exists_is_refused_before_any_question(gsp, monkeypatch):
    Path("old.toml").touch()
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.prompt", lambda text, **_: pytest.fail("a question"))
    assert "old.toml: exists already" in gsp("new", "--out", "old.toml").error


def test_wrong_answers_are_said_and_asked_again(gsp, monkeypatch):
    typed = "mm two -3 0 nan 2 200 -1 20 1 1e 30 0 1e101 1.5 y -1 1.5 1 inf 2.5"
    answers = iter(typed.split())
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.prompt", lambda text, **_: next(answers))
    monkeypatch.setattr("typer.confirm", lambda text, **_: next(answers) == "y")
    result = gsp("new")
    assert result.status == 0
    same("hexapod.toml", LIFT)
    lines = result.err.splitlines()
    assert len(lines) == 12
    assert all(line.startswith("gsp: answer: expected ") for line in lines)
    assert lines[0] == "gsp: answer: expected a number, received 'two'"
    assert lines[4] == "gsp: answer: expected an angle in [0, 120] degrees, received 200"
    assert lines[-2] == "gsp: answer: expected at least 1.5, the least length, received 1"


def test_a_wrong_option_is_said_before_any_question(gsp, monkeypatch):
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.prompt", lambda text, **_: pytest.fail("asked in vain"))
    assert "--base-radius: expected" in gsp("new", "--base-radius", -2).error


def test_no_line_on_the_work_is_printed_while_a_question_is_open(monkeypatch, capsys):
    """The clock is that of the test: 100 s of an answer, then 12 s of work."""
    now = [0.0]
    monkeypatch.setattr(waiting.time, "monotonic", lambda: now[0])

    class Ended:
        def __init__(self):
            self.question = waiting.question()
            self.question.__enter__()

        def wait(self, seconds):
            assert seconds > 0.0
            now[0] += seconds
            if self.question and now[0] >= 100.0:
                self.question.__exit__(None, None, None)
                assert not capsys.readouterr().err
                self.question = None
            return now[0] >= 112.0

    waiting._print(Ended(), 10.0, "new")
    assert capsys.readouterr().err == "gsp: working for 10 s: new\n"


def _typed(text, type=str, **_):
    return type(text)


def test_without_a_terminal_the_missing_options_are_named(gsp, monkeypatch):
    monkeypatch.setattr(sys.stdin, "isatty", lambda: False, raising=False)
    error = gsp("new", *NUMBERS[:6]).error
    assert "--platform-angle, --height: expected a number" in error
    assert "--base-angle: expected an angle" in gsp("new", *NUMBERS, "--base-angle", 130).error
    assert not Path("hexapod.toml").exists()


@pytest.mark.parametrize(
    ("base", "platform", "arrangement", "singular"),
    [
        (20, 100, "pairs", True),
        (0, 120, "pairs", True),
        (20, 100, "zigzag", False),
        (35, 35, "zigzag", True),
        (60, 61, "pairs", False),
    ],
)
def test_a_new_hexapod_that_is_singular_in_every_pose_is_said(
    gsp, base, platform, arrangement, singular
):
    angles = ("--base-angle", base, "--platform-angle", platform, "--arrangement", arrangement)
    result = gsp("new", *NUMBERS, *angles)
    assert (result.status, result.out.strip()) == (0, "hexapod.toml")
    assert ("singular in every pose" in result.err) is singular
    assert singular or not result.err


@pytest.mark.parametrize(("strokes", "beyond"), [((1.5, 2.5), False), ((3, 4), True)])
def test_strokes_that_the_home_pose_violates_are_said(gsp, strokes, beyond):
    result = gsp("new", *NUMBERS, "--strokes", *strokes)
    assert result.status == 0
    words = "in the home pose, beyond the stroke: d1, d2, d3, d4, d5, d6"
    assert result.err.strip() == (f"gsp: {words}" if beyond else "")


def test_missing_and_wrong_numbers_are_said_before_an_existing_file(gsp, monkeypatch):
    monkeypatch.setattr(sys.stdin, "isatty", lambda: False, raising=False)
    Path("hexapod.toml").write_text("mine", encoding="utf-8")
    assert "--platform-angle, --height: expected a number" in gsp("new", *NUMBERS[:6]).error
    assert "--base-angle: expected an angle" in gsp("new", *NUMBERS, "--base-angle", 130).error
    assert "--strokes: expected" in gsp("new", *NUMBERS, "--strokes", 2, 1).error
    assert "exists already" in gsp("new", *NUMBERS).error
    assert ".toml" in gsp("new", *NUMBERS, "--out", "a.txt").error
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.prompt", lambda text, **_: pytest.fail("asked in vain"))
    assert "exists already" in gsp("new").error
    assert Path("hexapod.toml").read_text(encoding="utf-8") == "mine"


HEADER = "base_x,base_y,base_z,platform_x,platform_y,platform_z"


def table_of_lift(more, first, other):
    """Write a table whose first leg has other cells in some columns than the others."""
    points = np.hstack((LIFT.base_points, LIFT.platform_points)).tolist()
    cells = [",".join(map(repr, row)) for row in points]
    lines = [f"{row},{first if i == 0 else other}" for i, row in enumerate(cells)]
    Path("a.csv").write_text("\n".join([f"{HEADER},{more}", *lines]) + "\n", encoding="utf-8")


@pytest.mark.parametrize(
    ("more", "first", "other", "message"),
    [
        ("stroke_low,stroke_high", "-5,2", "1,2", "line 2, column 'stroke_low': expected 0 or"),
        ("stroke_low,stroke_high", "-5,-2", "1,2", "line 2, column 'stroke_low': expected 0 or"),
        (
            "stroke_low,stroke_high",
            "\u0661,2",
            "1,2",
            "line 2, column 'stroke_low': expected a num",
        ),
        (
            "stroke_low,stroke_high",
            "1_0,20",
            "1,2",
            "line 2, column 'stroke_low': expected a number",
        ),
        ("stroke_low_2,stroke_high_2", "1,2", ",", "a leg D1 has one actuated joint"),
    ],
)
def test_strokes_of_a_table_that_mean_nothing_are_refused(gsp, more, first, other, message):
    table_of_lift(more, first, other)
    assert message in gsp("import", "a.csv").error
    assert not Path("a.toml").exists()


@pytest.mark.filterwarnings("default")  # the command prints warnings
def test_directions_that_are_not_used_are_named(gsp):
    table_of_lift("base_dx,base_dy,base_dz", "0,0,1", ",,")
    done = gsp("import", "a.csv")
    assert done.status == 0
    assert "not used: directions of the base of leg 1, which have no line there" in done.err
    same("a.toml", LIFT.replace(strokes=None))


@pytest.mark.parametrize("strokes", [(-1, 1), ("nan", 1), (2, 1)])
def test_strokes_of_new_designs_are_lengths(gsp, strokes):
    assert "--strokes: expected 0 ≤ LOW ≤ HIGH" in gsp("new", *NUMBERS, "--strokes", *strokes).error


def test_a_home_position_that_is_no_number_names_the_option(gsp):
    table_of_lift("stroke_low", "1", "1")
    for home in ("nan", "1e300"):
        assert gsp("import", "a.csv", "--home", home, 0, 1).error.startswith(
            "gsp: --home: expected"
        )


@pytest.mark.parametrize("form", ["mjcf", "urdf", "sdf"])
def test_models_become_design_files(gsp, form):
    design = hexapod(2, 20, 1, 30, 1.5, degrees=True, strokes=(1.5, 2.5), unit="m", name="lift")
    design.write("lift.toml")
    written = gsp("export", "lift.toml", "--to", form).out.split()
    assert gsp("import", written[0], "--unit", "mm", "--force").out.strip() == "lift.toml"
    found = read_design("lift.toml")
    assert (found.name, found.unit) == ("lift", "mm")
    np.testing.assert_allclose(found.base_points, 1e3 * design.base_points, atol=1e-9)
    np.testing.assert_allclose(found.strokes, 1e3 * design.strokes, rtol=1e-12)
    np.testing.assert_allclose(found.home.position, [0, 0, 1500], atol=1e-9)
    error = gsp("import", written[0], "--platform", "plate", "--out", "x.toml").error
    assert "unknown platform 'plate'" in error


def test_options_of_models_are_refused_for_tables(gsp):
    Path("a.csv").write_text(LIFT.to_frame().to_csv(index=False))
    assert "--platform" in gsp("import", "a.csv", "--platform", "top").error
