"""`gsp certify`: exit status, and the pose that refutes."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

import gsp as library

NAME = "toz-kucuk-2016-d3-6"
DESIGN = library.catalogue.design(NAME)
SMALL = "5:15 -15:-5 133:143 0:8 -8:0 -12:-8"


def test_proven(gsp, tmp_path):
    done = gsp("certify", NAME, "--box", SMALL, "--require", "CDN_CL <= 100", "--out", "c.json")
    assert done.status == 0
    assert done.out.startswith("proven")
    assert library.proof.read_certificate("c.json").status == "proven"
    again = gsp("certify", NAME, "--box", SMALL, "--out", "c.json")
    assert again.status == 2


def test_refuted_and_the_pose_is_read_by_other_commands(gsp):
    done = gsp("certify", NAME, "--box", SMALL, "--require", "CDN_CL <= 1.5")
    assert done.status == 1
    options = next(x for x in done.out.splitlines() if x.startswith("at ")).split(maxsplit=1)[1]
    words = shlex.split(options)
    shown = gsp("jacobian", NAME, *words)
    assert shown.status == 0
    pose = library.Pose.from_rpy(
        [float(x) for x in words[1:4]], [float(x) for x in words[5:8]], degrees=True
    )
    limits = library.Limits(indices=["CDN_CL <= 1.5"])
    assert not library.feasible(DESIGN, pose, limits)


@pytest.mark.parametrize("order", ["rpy", "approach-roll"])
def test_a_refuting_corner_is_printed_as_the_box_states_it(gsp, order):
    """Angles of its rotation matrix would be an ulp outside of the box."""
    ends = "-1:1 -1:1 7:9 -10.1:10 -1.5:10 7.3:9.7"
    given = ("--box", ends, "--order", order, "--require", "CTN >= 0.9")
    done = gsp("certify", "workspace-6-3", *given)
    words = shlex.split(next(x for x in done.out.splitlines() if x.startswith("at ")))
    corner = [*words[2:5], *words[6:9]]
    pairs = [text.split(":") for text in ends.split()]
    assert all(float(x) in map(float, pair) for x, pair in zip(corner, pairs, strict=True))
    assert words[9:] == ([] if order == "rpy" else ["--order", order])
    assert gsp("jacobian", "workspace-6-3", *words[1:]).status == 0


def test_undecided(gsp):
    wide = "5:15 -15:-5 133:143 -20:20 -20:20 -30:10"
    done = gsp("certify", NAME, "--box", wide, "--budget", 3)
    assert done.status == 3
    assert done.out.startswith("undecided")


@pytest.mark.parametrize(
    ("options", "word"),
    [
        (["--box", "1:2"], "--box"),
        (["--box", SMALL, "--require", "CDN_CL"], "CDN_CL"),
        (["--box", SMALL, "--strokes"], "--strokes"),
        (["--box", "5 5 133 -200:200 0 0"], "π"),
        (["--box", SMALL, "--singular"], "--singular: expected --require or --strokes"),
        (["--box", SMALL, "--require", "CTN >"], "--require: expected texts"),
    ],
)
def test_errors(gsp, options, word):
    done = gsp("certify", NAME, *options)
    assert done.status == 2
    assert word in done.err


# --- paths ---

POSES = "x,y,z,angle_1,angle_2,angle_3\n10,-10,130,0,0,0\n12,-8,138,5,5,0\n0,0,142,0,5,5\n"


@pytest.fixture
def poses(tmp_path):
    file = tmp_path / "poses.csv"
    file.write_text(POSES)
    return file


def test_paths_are_proven_and_written(gsp, poses):
    options = ["--motion", "spline", "--times", "0 0.5 1", "--speeds", "60", "--out", "p.json"]
    done = gsp("certify", NAME, "--path", poses, *options, "--require", "CDN_CL <= 60")
    assert done.status == 0
    assert done.out.startswith("proven")
    found = library.proof.read_certificate("p.json")
    assert list(found.claims["bounds"]["condition_number"]) == [None, 60.0]
    assert list(found.claims["bounds"]["speed of d1"]) == [-60.0, 60.0]
    assert list(found.path["times"]) == [0.0, 0.5, 1.0]
    assert len(found.path["nodes"]["position"]) == 3


def test_the_pose_that_refutes_a_path_is_read_by_other_commands(gsp, poses):
    done = gsp("certify", NAME, "--path", poses, "--require", "CDN_CL <= 1.5", "--motion", "screw")
    assert done.status == 1
    lines = dict(line.split(maxsplit=1) for line in done.out.splitlines())
    assert 0.0 <= float(lines["parameter"]) <= 2.0
    words = shlex.split(lines["at"])
    assert gsp("jacobian", NAME, *words).status == 0
    place, angles = ([float(x) for x in words[i : i + 3]] for i in (1, 5))
    pose = library.Pose.from_rpy(place, angles, degrees=True)
    assert not library.feasible(DESIGN, pose, library.Limits(indices=["CDN_CL <= 1.5"]))
    assert gsp("certify", NAME, "--path", poses, "--times", "0 1 2", "--speeds", 1).status == 1


def test_a_path_is_undecided_when_its_budget_is_used_up(gsp, tmp_path):
    far = tmp_path / "far.csv"
    far.write_text(POSES.replace("5,5,0", "5,5,40"))
    done = gsp("certify", NAME, "--path", far, "--budget", 1)
    assert done.status == 3
    assert done.out.startswith("undecided")


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ([], "--box, --path"),
        (["--box", SMALL, "--path", "poses.csv"], "--box, --path"),
        (["--box", SMALL, "--speeds", "1"], "--speeds"),
        (["--path", "poses.csv", "--workers", "1"], "--workers"),
        (["--path", "poses.csv", "--times", "0 1"], "--times"),
        (["--path", "poses.csv", "--speeds", "1"], "--speeds: expected --times beside it"),
        (
            ["--path", "poses.csv", "--accelerations", "1", "--times", "0 1 2"],
            "--accelerations: expected --motion spline",
        ),
        (["--path", "poses.csv", "--speeds", "1 2", "--times", "0 1 2"], "--speeds"),
        (["--path", "poses.csv", "--motion", "jump"], "--motion"),
        (["--path", "none.csv"], "none.csv"),
        (["--path", "one.csv"], "--path: expected two poses"),
        (["--path", "gap.csv"], "column 'angle_1': expected a finite number, received 'nan'"),
        (["--path", "poses.csv", "--times", "0 2 1"], "--times: expected numbers that increase"),
        (
            ["--path", "poses.csv", "--times", "0 1 2", "--speeds", "-1"],
            "--speeds: expected numbers",
        ),
        (["--box", "0 0 1:0 0 0 0"], "--box: expected six"),
        (["--box", "0 0 \u0661 0 0 0"], "--box: expected six"),
    ],
)
def test_errors_of_paths(gsp, poses, options, word, monkeypatch):
    monkeypatch.chdir(poses.parent)
    rows = POSES.splitlines()
    Path("one.csv").write_text("\n".join(rows[:2]))
    Path("gap.csv").write_text("\n".join([*rows[:2], "0,0,138,nan,0,0"]))
    done = gsp("certify", NAME, *options)
    assert done.status == 2
    assert word in done.err


def test_the_proven_part_of_a_refuted_path_is_not_all_of_it(gsp, tmp_path):
    (tmp_path / "half.csv").write_text(
        "x,y,z,angle_1,angle_2,angle_3\n10,-10,138,0,0,0\n10,-10,138,180,0,0\n"
    )
    done = gsp("certify", NAME, "--path", "half.csv", "--motion", "spline")
    assert done.status == 1
    assert "99.9999 % of the path proven" in done.out
