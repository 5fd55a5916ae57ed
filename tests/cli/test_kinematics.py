"""`gsp forward` and `gsp inverse`: what they print and write is what the library computes."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import gsp as library

NAME = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"
DESIGN = library.catalogue.design(NAME)
OCTAHEDRON, LEGS = "lee-2000-3-3", "1.4 1.4 1.4 1.4 1.4 1.4"


def test_inverse_then_forward_returns_the_pose(gsp):
    printed = gsp(
        "inverse", NAME, "--position", 12, -8, 140, "--angles", 3, -4, 5, "--out", "joints.csv"
    )
    assert printed.status == 0
    table = pd.read_csv("joints.csv")
    pose = library.Pose.from_rpy([12, -8, 140], [3, -4, 5], degrees=True)
    np.testing.assert_allclose(table[list(DESIGN.joint_names)], [DESIGN.at(pose).joints])
    values = " ".join(map(repr, table[list(DESIGN.joint_names)].iloc[0].tolist()))
    near = ("--position", 11, -8, 141, "--angles", 2, -4, 6)
    back = gsp("forward", NAME, "--joints", values, *near, "--out", "pose.parquet")
    assert back.status == 0
    assert "converged" in back.out
    row = pd.read_parquet("pose.parquet").iloc[0]
    np.testing.assert_allclose(
        row[["x", "y", "z", "angle_1", "angle_2", "angle_3"]].astype(float),
        [12, -8, 140, 3, -4, 5],
        atol=1e-8,
    )


def test_files_of_many_rows_keep_bad_ones(gsp):
    path = DESIGN.home.moved(np.linspace(0, 1, 30)[:, None] * [5, 4, -3, 0.05, 0.04, -0.03])
    angles = path.angles(degrees=True)
    columns = ("x", "y", "z", "angle_1", "angle_2", "angle_3")
    values = np.concatenate((path.position, angles), axis=1)
    pd.DataFrame(values, columns=columns).to_parquet("path.parquet")
    first = gsp("inverse", NAME, "--poses", "path.parquet", "--out", "log.csv")
    assert "10 more rows" in first.out
    log = pd.read_csv("log.csv")
    log.loc[3, DESIGN.joint_names[2]] = np.nan
    log.to_csv("log.csv", index=False)
    assert gsp("forward", NAME, "--joints", "log.csv", "--out", "poses.csv").status == 0
    found = pd.read_csv("poses.csv")
    good = np.arange(30) != 3
    assert (found.status[good] == "converged").all()
    assert found.status[3] == "undefined"
    np.testing.assert_allclose(found.loc[good, list(columns)], values[good], atol=1e-7)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("forward", NAME, "--joints", "1 2 3"), "6 numbers"),
        (("forward", NAME, "--joints", "a b c d e f"), "6 numbers"),
        (("forward", NAME, "--joints", "none.csv"), "none.csv"),
        (("inverse", NAME, "--poses", "none.parquet"), "none.parquet"),
        (
            ("inverse", NAME, "--poses", ""),
            "--poses: expected a file .csv or .parquet or .xlsx, rec",
        ),
        (("inverse", NAME, "--poses", "1 2 3 0 0 0"), "--poses: expected a file .csv"),
        (("inverse", NAME, "--poses", "x.csv", "--position", 1, 2, 3), "neither"),
        (("inverse", NAME, "--out", "x.doc"), "x.doc"),
        (
            ("forward", OCTAHEDRON, "--joints", LEGS, "--fallback", "x"),
            "expected modes",
        ),
        (("forward", OCTAHEDRON, "--joints", LEGS, "--plot", "x.png"), "--plot: not used beside"),
        (("forward", OCTAHEDRON, "--joints", LEGS, "--all", "--position", 0, 0, 1), "--position"),
        (("forward", OCTAHEDRON, "--joints", LEGS, "--all", "--plot", "x.doc"), "x.doc"),
    ],
)
def test_errors_are_one_line(gsp, arguments, message):
    assert message in gsp(*arguments).error


def test_a_table_without_the_columns_is_refused(gsp):
    pd.DataFrame({"a": [1.0]}).to_csv("a.csv", index=False)
    assert "columns" in gsp("forward", NAME, "--joints", "a.csv").error


def test_all_modes_are_printed_drawn_and_written(gsp):
    printed = gsp(
        "forward", OCTAHEDRON, "--joints", LEGS, "--all", "--certify", "--plot", "modes.png",
        "--out", "modes.csv",
    )  # fmt: skip
    assert "8 real of 16 complex assembly modes" in printed.out
    table = pd.read_csv("modes.csv")
    assert table["certified"].all()
    assert sorted(table["side"]) == [-1.0] * 4 + [1.0] * 4
    design = library.catalogue.design(OCTAHEDRON)
    values = table[["x", "y", "z", "angle_1", "angle_2", "angle_3"]].to_numpy()
    poses = library.Pose.from_rpy(values[:, :3], values[:, 3:], degrees=True)
    np.testing.assert_allclose(design.at(poses).joints, 1.4)
    assert Path("modes.png").stat().st_size > 10_000


def test_modes_of_driven_legs_state_whether_they_are_on_the_branches(gsp):
    design = library.catalogue.design("lane-rotary")
    joints = design.at(design.home).joints
    values = " ".join(map(repr, joints.tolist()))
    printed = gsp("forward", design.name, "--joints", values, "--all", "--out", "modes.csv")
    assert "4 real of 40 complex assembly modes" in printed.out
    table = pd.read_csv("modes.csv")
    angles = table[["angle_1", "angle_2", "angle_3"]].to_numpy()
    poses = library.Pose.from_rpy(table[["x", "y", "z"]].to_numpy(), angles, degrees=True)
    own = np.abs(design.at(poses).joints - joints).max(axis=1) < 1e-9
    np.testing.assert_array_equal(table["on_branches"], own)
    assert "on_branches" in printed.out
    far = ("--position", 0, 0, -2, "--angles", 0, 0, 100)
    near = gsp("forward", design.name, "--joints", values, *far, "--fallback", "modes")
    assert "nearest mode" in near.out


def test_values_of_drives_that_are_no_numbers_are_stated(gsp):
    names = library.catalogue.design("lane-rotary").joint_names
    pd.DataFrame([[-0.1, 0.1, np.nan, 0, 0, 0]], columns=names).to_csv("joints.csv", index=False)
    printed = gsp("forward", "lane-rotary", "--joints", "joints.csv")
    assert "theta3: expected a finite number, received nan" in printed.err
    assert "theta1" not in printed.err


def test_joint_values_without_a_mode_are_said_to_have_none(gsp):
    printed = gsp("forward", OCTAHEDRON, "--joints", "2.4 1.1 0.8 1.2 1.8 1.7", "--all")
    assert "0 real of 16 complex assembly modes" in printed.out
    printed = gsp("forward", OCTAHEDRON, "--joints", "1.4 1.4 1.4 1.4 1.4 9", "--all")
    assert "impossible: two joint values contradict each other" in printed.err


def test_without_a_mode_the_table_is_written_and_no_picture(gsp):
    files = "--plot", "none.png", "--out", "none.csv"
    printed = gsp("forward", OCTAHEDRON, "--joints", "1.4 1.4 1.4 1.4 1.4 9", "--all", *files)
    assert printed.status == 0
    assert "none.png is not written: there is no real mode to draw" in printed.err
    assert Path("none.csv").exists()
    assert not Path("none.png").exists()


def test_a_far_guess_gives_the_nearest_mode(gsp):
    far = ("--joints", LEGS, "--position", 0, 0, -1, "--angles", 160, 10, 20)
    assert "singular" in gsp("forward", OCTAHEDRON, *far).out
    assert "nearest mode" in gsp("forward", OCTAHEDRON, *far, "--fallback", "modes").out


@pytest.mark.parametrize(
    ("design", "joints", "said"),
    [
        ("lee-2000-3-3", [1.4, 1.4, 1.4, 1.4, 1.4, -1.4], "d6: expected a finite distance ≥ 0"),
        ("toz-kucuk-2016-d3-6", [146, 120, -3, 128, 126, 135], "d3: expected a finite distance"),
        ("mixed.toml", [1.0, 1.0, 1.0, 1.0, 1.0, 3.5], "theta6: expected an angle between 0 and π"),
    ],
)
def test_the_reason_of_an_undefined_pose_is_stated(gsp, tmp_path, design, joints, said):
    if design == "mixed.toml":
        rng = np.random.default_rng(4)
        mixed = library.Design(
            ["D1"] * 5 + ["A1"],
            *rng.normal(size=(2, 6, 3)),
            *rng.normal(size=(2, 6, 3)),
            home=library.Pose([0.1, 0.2, 3.0]),
        )
        mixed.write(tmp_path / design)
    text = " ".join(str(value) for value in joints)
    result = gsp("forward", design, "--joints", text)
    assert f"gsp: undefined: {said}" in result.err
    assert f"received {min(joints) if min(joints) < 0 else joints[-1]:g}" in result.err


def test_many_undefined_poses_are_counted(gsp, tmp_path):
    rows = ["d1,d2,d3,d4,d5,d6"] + ["1.4,1.4,1.4,1.4,1.4,-1"] * 9
    (tmp_path / "log.csv").write_text("\n".join(rows), encoding="utf-8")
    result = gsp("forward", "lee-2000-3-3", "--joints", "log.csv")
    assert "gsp: undefined: row 1: d6: expected" in result.err
    assert "gsp: undefined: 4 such joint values more" in result.err


def test_the_reason_of_an_undefined_joint_value_is_stated(gsp, tmp_path):
    reason = "is undefined: crank and rod do not reach the platform anchor, or it is on the axis"
    result = gsp("inverse", "lane-rotary", "--position", 0, 0, 0)
    assert result.status == 0
    assert result.err.splitlines() == [f"gsp: theta{i} {reason}" for i in range(1, 7)]
    table = tmp_path / "poses.csv"
    table.write_text("x,y,z,angle_1,angle_2,angle_3\n" + "0,0,0,0,0,0\n" * 2)
    lines = gsp("inverse", "lane-rotary", "--poses", table).err.splitlines()
    assert lines[0] == f"gsp: row 1: theta1 {reason}"
    assert lines[-1] == "gsp: undefined: 6 joint values more"
