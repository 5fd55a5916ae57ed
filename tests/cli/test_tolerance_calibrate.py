"""`gsp tolerance` and `gsp calibrate`: the numbers of the library, files, and bad input."""

import functools
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import gsp as library

NOMINAL = library.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, unit="m", name="nominal")
TASK = """samples = 4
length = 0.8
[[wanted]]
index = "CTN"
[box]
position = [[-0.1, 0.1], [-0.1, 0.1], [1.4, 1.6]]
angles_deg = [[-5.0, 5.0], [-5.0, 5.0], 0.0]
"""


@pytest.fixture
def machine(tmp_path):
    """A real machine, poses, and its readings as a table with positions and angles."""
    NOMINAL.write(tmp_path / "nominal.toml")
    (tmp_path / "task.toml").write_text(TASK)
    rng = np.random.default_rng(3)
    real = NOMINAL.replace(
        base_points=NOMINAL.base_points + rng.normal(0.0, 0.01, (6, 3)),
        platform_points=NOMINAL.platform_points + rng.normal(0.0, 0.01, (6, 3)),
    )
    poses = library.PoseBox.around(NOMINAL.home, [0.3] * 6).sample(30, rng=1)
    zero = np.linspace(-0.02, 0.02, 6)
    table = pd.DataFrame(real.at(poses).joints - zero, columns=list(NOMINAL.joint_names))
    table[["x", "y", "z"]] = poses.position
    table[["angle_1", "angle_2", "angle_3"]] = poses.angles("rpy", degrees=True)
    table.to_csv(tmp_path / "log.csv", index=False)
    return real, poses, zero, table


def test_a_calibration_recovers_the_machine(gsp, machine):
    real, _, zero, _ = machine
    result = gsp("calibrate", "nominal.toml", "log.csv", "--write", "found.toml", "--out", "r.csv")
    assert (result.status, result.err) == (0, "")
    assert "30 poses of log.csv: 42 of 42 coordinates" in result.out
    found = library.read_design("found.toml")
    np.testing.assert_allclose(found.base_points, real.base_points, atol=1e-9)
    np.testing.assert_allclose(found.platform_points, real.platform_points, atol=1e-9)
    report, facts = pd.read_csv("r.csv"), json.loads(Path("r.csv.json").read_text())
    assert len(report) == 42
    np.testing.assert_allclose(facts["zero_points"], zero, atol=1e-9)
    np.testing.assert_allclose(report["value"][:3], real.base_points[0], atol=1e-9)
    assert (
        "nominal.toml"
        in gsp("calibrate", "nominal.toml", "log.csv", "--write", "nominal.toml").error
    )


def test_places_alone_leave_the_platform_frame_open(gsp, machine):
    machine[3].drop(columns=["angle_1", "angle_2", "angle_3"]).to_csv("places.csv", index=False)
    result = gsp("calibrate", "nominal.toml", "places.csv", "--joint-errors", 1e-6,
                 "--pose-errors", 1e-6, 1e-6)  # fmt: skip
    assert result.status == 0
    assert "Not known  3 motions of the platform frame" in result.out


def test_guessed_poses_are_those_of_the_library(gsp, machine):
    _, poses, _, table = machine
    table.iloc[:, :6].to_csv("readings.csv", index=False)
    near = library.Pose.from_angles(poses.position + 0.01, poses.angles("zyx"), "zyx")
    guess = pd.DataFrame(near.position, columns=["x", "y", "z"])
    guess[["angle_1", "angle_2", "angle_3"]] = near.angles("zyx", degrees=True)
    guess.to_csv("near.csv", index=False)
    call = ("calibrate", "nominal.toml", "readings.csv", "--order", "zyx", "--out", "r.csv")
    for rows, given in ((30, near), (1, near[0])):
        guess.iloc[:rows].to_csv("near.csv", index=False)
        assert gsp(*call, "--guess", "near.csv", "--force").status == 0
        found = library.calibrate(NOMINAL, table.iloc[:, :6], guess=given)
        np.testing.assert_allclose(pd.read_csv("r.csv")["value"], found.table()["value"], atol=1e-9)
    guess.iloc[:2].to_csv("near.csv", index=False)
    error = gsp(*call, "--guess", "near.csv", "--force").error
    assert "guess: expected batch shape () or (30,)" in error
    error = gsp("calibrate", "nominal.toml", "log.csv", "--guess", "near.csv").error
    assert "--guess: not used beside measured angles" in error


def test_tables_that_cannot_be_used(gsp, machine):
    table = machine[3]
    table.drop(columns="d3").to_csv("a.csv", index=False)
    assert "one column 'd3'" in gsp("calibrate", "nominal.toml", "a.csv").error
    table.drop(columns="angle_2").to_csv("b.csv", index=False)
    assert "or x, y, z alone" in gsp("calibrate", "nominal.toml", "b.csv").error
    table.assign(d7=1.0).to_csv("d.csv", index=False)
    assert (
        "d.csv: d7: no joint of nominal, not used" in gsp("calibrate", "nominal.toml", "d.csv").err
    )
    table.assign(d1="long").to_csv("c.csv", index=False)
    assert (
        "column 'd1': expected a finite number" in gsp("calibrate", "nominal.toml", "c.csv").error
    )
    assert "expected a file" in gsp("calibrate", "nominal.toml", "log.txt").error
    assert gsp("calibrate", "nominal.toml", "log.csv", "--loss", "huber").error.startswith(
        "gsp: --joint-errors: expected standard errors"
    )


def test_options_that_measurements_leave_without_an_effect(gsp, machine):
    call = ("calibrate", "nominal.toml", "log.csv")
    assert gsp(*call, "--point", 0, 0, 1).error.startswith("gsp: --point: not used beside measured")
    machine[3].iloc[:, :9].to_csv("log.csv", index=False)
    assert "--order: not used beside a table without angles" in gsp(*call, "--order", "zyz").error
    machine[3].iloc[:, :6].to_csv("log.csv", index=False)
    errors = gsp(*call, "--pose-errors", 1, 1, "--point", 0, 0, 1).error
    assert errors == "gsp: --point, --pose-errors: not used beside a table without places"


def test_a_search_that_has_not_converged_is_stated(gsp, machine, monkeypatch):
    short = functools.partial(library.calibrate, max_iterations=1)
    monkeypatch.setattr("gsp.cli.design.calibrate.calibrate", short)
    result = gsp("calibrate", "nominal.toml", "log.csv")
    stated = "not converged. Where the search ended, the data determine 42 of 42 coordinates"
    assert stated in result.out.replace("\n", " ")
    assert "not converged after 1 iteration: dimensions, errors and what is not" in result.err


def test_the_tolerance_of_a_pose_is_that_of_the_library(gsp, machine):
    result = gsp("tolerance", "nominal.toml", "--base", 1e-4, "--joints", 5e-5, "--samples", 64,
                 "--point", 0, 0, 0.2, "--out", "copies.csv")  # fmt: skip
    assert (result.status, result.err) == (0, "")
    errors = library.exploration.Deviations(base_points=1e-4, joints=5e-5)
    found = library.exploration.pose_tolerance(
        NOMINAL, NOMINAL.home, errors, point=[0, 0, 0.2], samples=64
    )
    copies = pd.read_csv("copies.csv")
    np.testing.assert_array_equal(copies.iloc[:, -6:].to_numpy(), found.displacements)
    assert f"{found.quantiles(0.95)[0]:#.4g}" in result.out
    assert "nominal: 64 copies" in result.out


def test_the_tolerance_of_a_task_is_that_of_the_library(gsp, machine):
    result = gsp(
        "tolerance", "nominal.toml", "--base", 1e-3, "--task", "task.toml", "--samples", 16
    )
    assert (result.status, result.err) == (0, "")
    errors = library.exploration.Deviations(base_points=1e-3)
    task = library.read_task("task.toml")
    found = library.exploration.index_tolerance(NOMINAL, task, errors, samples=16)
    line = next(x for x in result.out.splitlines() if x.startswith("control_number_mean"))
    assert line.split()[1] == f"{found.table['nominal'].iloc[0]:#.4g}"
    assert line.split()[3] == f"{found.table['deviation'].iloc[0]:#.4g}"


def test_options_without_an_effect_are_refused(gsp, machine):
    words = ("tolerance", "nominal.toml", "--base", 1e-3)
    assert "--workers: not used beside" in gsp(*words, "--workers", 2).error
    assert "--joints: not used beside" in gsp(*words, "--task", "task.toml", "--joints", 1).error
    for more in ((), ("--task", "task.toml"), ("--base", 0)):
        assert "an error > 0 by one of --base, " in gsp("tolerance", "nominal.toml", *more).error
    assert gsp("tolerance", "nominal.toml", "--base", -1).status == 2
