"""`gsp explore`: what it computes, prints and writes, resumption, and its errors."""

from __future__ import annotations

import json

import pandas as pd
import pytest

import gsp as library
from gsp.evaluation.parts import Parts
from gsp.families.lee import platform_6_6

SPACE = """make = "hexapod"
[ranges]
platform_radius = [0.5, 1.5]
platform_angle = [5.0, 60.0]
[fixed]
base_radius = 2.0
base_angle = 20.0
height = 1.5
"""
TASK = """samples = 10
length = 0.8
[[wanted]]
index = "CTN"
[[wanted]]
index = "CDN_CL"
of = "worst"
[box]
position = [[-0.1, 0.1], [-0.1, 0.1], [1.4, 1.6]]
angles_deg = [[-5.0, 5.0], [-5.0, 5.0], 0.0]
"""
WORDS = ("explore", "space.toml", "--task", "task.toml", "--samples", 6)


@pytest.fixture
def files(tmp_path):
    (tmp_path / "space.toml").write_text(SPACE)
    (tmp_path / "task.toml").write_text(TASK)
    return tmp_path


def test_the_table_is_that_of_the_library(gsp, files):
    result = gsp(*WORDS, "--seed", 3, "--method", "sobol", "--samples", 8, "--out", "t.parquet")
    assert (result.status, result.err) == (0, "")

    def make(**given):
        return library.hexapod(2.0, 20.0, height=1.5, degrees=True, **given)

    space = library.Space(make, {"platform_radius": (0.5, 1.5), "platform_angle": (5.0, 60.0)})
    task = library.read_task("task.toml")
    wanted = library.exploration.explore(space, task, 8, seed=3, method="sobol")
    found = pd.read_parquet("t.parquet")
    pd.testing.assert_frame_equal(
        found.drop(columns="design"), wanted.drop(columns="design"), check_exact=True
    )
    record = json.loads((files / "t.parquet.json").read_text())
    assert (record["seed"], record["method"]) == (3, "sobol")
    assert record["space"]["make"] == "gsp.families.texts.hexapod"
    assert record["space"]["fixed"] == {"base_radius": "2.0", "base_angle": "20.0", "height": "1.5"}


def test_the_best_are_printed_in_order(gsp, files):
    lines = gsp(*WORDS).out.splitlines()
    table = pd.read_csv("results/exploration.csv").sort_values("rank")
    assert lines[0] == "6 designs of space.toml (halton, seed 0), task task.toml"
    for line, (_, row) in zip(lines[3:9], table.iterrows(), strict=True):
        rank, radius, _, score = line.split()[:4]
        assert int(rank) == row["rank"]
        assert float(radius) == pytest.approx(row["platform_radius"], rel=1e-3)
        assert float(score) == pytest.approx(row["score"], rel=1e-3)
    assert lines[9].startswith("Table      results/exploration.csv (6 rows)")
    assert "results/exploration-2.csv" in gsp(*WORDS).out


@pytest.mark.parametrize("out", [(), ("--out", "t.csv")])
def test_an_interrupted_exploration_is_continued(gsp, files, monkeypatch, out):
    write, stored = Parts.write_row, []

    def stop(parts, number, row):
        if len(stored) == 3:
            raise KeyboardInterrupt
        write(parts, number, row)
        stored.append(number)

    assert gsp(*WORDS, "--out", "whole.csv").status == 0
    monkeypatch.setattr(Parts, "write_row", stop)
    result = gsp(*WORDS, *out)
    monkeypatch.undo()
    monkeypatch.chdir(files)
    path = out[1] if out else "results/exploration.csv"
    assert result.status == 130
    assert result.err == f"gsp: stopped; 3 finished parts are kept in {path}.parts; " + (
        "--resume continues\n"
    )
    assert "those of another run" in gsp(*WORDS, *out, "--seed", 1, "--resume").error
    assert gsp(*WORDS, *out, "--resume").status == 0
    assert (files / path).read_bytes() == (files / "whole.csv").read_bytes()
    assert not (files / f"{path}.parts").exists()


def test_parameters_of_families_are_taken_by_name(gsp, files):
    """In any order in the file; the functions of `gsp.families.lee` are called by position."""
    (files / "space.toml").write_text(
        'make = "lee-6-6"\n[ranges]\nbeta = [0.1, 0.4]\nalpha = [0.1, 0.4]\n'
        "[fixed]\nb = 2.0\na = 1.0\n"
    )
    assert gsp(*WORDS).status == 0
    table = pd.read_csv("results/exploration.csv")
    task = library.read_task("task.toml")
    for row in table.to_dict("records"):
        design = platform_6_6(1.0, 2.0, row["alpha"], row["beta"])
        found = library.exploration.assess(design, task)
        assert found["control_number_mean"][0] == pytest.approx(row["control_number_mean"])


def test_placements_are_a_choice(gsp, files):
    legs = ["D1-D2-D1-D2-D1-D2", "D2-D1-D1-D1-D2-D2"]
    (files / "space.toml").write_text(
        f'make = "place"\n[choices]\nlegs = {legs}\n[fixed]\ntemplate = "toz-kucuk-2016-d3-6"\n'
    )
    (files / "task.toml").write_text(TASK.replace("1.4, 1.6", "130.0, 140.0"))
    assert gsp(*WORDS).status == 0
    assert set(pd.read_csv("results/exploration.csv")["legs"]) == set(legs)


def test_parameters_without_a_design_and_designs_without_a_score_are_counted(gsp, files):
    (files / "space.toml").write_text(SPACE.replace("[0.5, 1.5]", "[-0.5, 1.5]"))
    result = gsp(*WORDS)
    table = pd.read_csv("results/exploration.csv")
    bad = int((table["platform_radius"] < 0.0).sum())
    assert 0 < bad < 6
    assert result.err.startswith(f"gsp: no design for {bad} of 6; the first error: platform_radius")
    (files / "space.toml").write_text(SPACE)
    (files / "task.toml").write_text(TASK + "[limits]\nposition = [[5, 6], [5, 6], [5, 6]]\n")
    assert gsp(*WORDS).err.startswith("gsp: 6 designs without a score: no pose is within")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            '"hexapod"',
            '"hexapot"',
            "space.toml, line 1, key 'make': unknown make 'hexapot'; nearest: hexapod",
        ),
        ('"hexapod"', "3", "space.toml, line 1, key 'make': value: expected a text, received 3"),
        ('make = "hexapod"', "", "space.toml: expected the key 'make', one of lee-3-3, "),
        ("[fixed]", "[fixes]", "space.toml, line 5, key 'fixes': key: expected one of make, "),
        ("height = 1.5", "", "space.toml, line 1, key 'make': expected a function that takes"),
        (
            "[0.5, 1.5]",
            "[1.5, 0.5]",
            "space.toml, line 3, key 'ranges.platform_radius': expected two",
        ),
        ("[0.5, 1.5]", "[0.5,", "space.toml: not TOML"),
        ("[0.5, 1.5]", "[-1.5, -0.5]", "gsp: space.toml: expected a space with a design"),
    ],
)
def test_errors_of_a_space(gsp, files, old, new, message):
    (files / "space.toml").write_text(SPACE.replace(old, new))
    assert message in gsp(*WORDS).error
    assert not (files / "results").exists()


def test_files_that_are_not_there(gsp, files):
    assert "--task" in gsp("explore", "space.toml").error
    assert "no.toml: expected" in gsp("explore", "no.toml", "--task", "task.toml").error
    assert "no.toml: expected" in gsp("explore", "space.toml", "--task", "no.toml").error
    (files / "t.csv").write_text("mine")
    assert "exists already" in gsp(*WORDS, "--out", "t.csv").error
