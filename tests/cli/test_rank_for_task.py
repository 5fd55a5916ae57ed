"""`gsp rank --task`: the poses, limits, indices and weights of a task decide."""

from __future__ import annotations

import json

import pandas as pd
import pytest

import gsp as library
from gsp.evaluation.parts import Parts

TASK = """unit = "mm"
samples = 12
[[wanted]]
index = "CTN"
weight = 2.0
[[wanted]]
index = "CDN_CL"
of = "worst"
[box]
position = [[-10.0, 30.0], [-30.0, 10.0], [120.0, 150.0]]
angles_deg = [[-5.0, 5.0], [-5.0, 5.0], 0.0]
"""
WORDS = ("rank", "--task", "task.toml")
TEMPLATE = library.catalogue.design("toz-kucuk-2016-d3-6")
# No pose of the box is within them.
FAR = "[limits]\nposition = [[900, 901], [0, 1], [0, 1]]\n"


@pytest.fixture(autouse=True)
def file(tmp_path):
    path = tmp_path / "task.toml"
    path.write_text(TASK)
    return path


def assessed(path, designs):
    return library.exploration.assess(designs, library.read_task(path))


def test_the_195_mechanisms_are_ranked_for_a_task(gsp, file):
    result = gsp(*WORDS, "--out", "t.parquet")
    assert (result.status, result.err) == (0, "")
    catalogue = library.catalogue
    designs = [catalogue.instantiate(m, TEMPLATE) for m in catalogue.mechanisms()]
    found, wanted = pd.read_parquet("t.parquet"), assessed(file, designs)
    pd.testing.assert_frame_equal(found, wanted, check_exact=True)
    lines = result.out.splitlines()
    assert lines[0] == f"195 designs on the anchor lines of {TEMPLATE.name}, task task.toml"
    for line, (_, row) in zip(lines[3:23], wanted.iterrows(), strict=False):
        assert line.startswith(f"{row['rank']:>4}  {row['design']} ")
        score, mean, worst = map(float, line.split()[-3:])
        assert score == pytest.approx(row["score"], rel=1e-3)
        assert mean == pytest.approx(row["control_number_mean"], rel=1e-3)
        assert worst == pytest.approx(row["condition_number_max"], rel=1e-3)
    record = json.loads((file.parent / "t.parquet.json").read_text())
    assert record["task"]["wanted"][0] == {"index": "control_number", "of": "mean", "weight": 2.0}
    assert (record["by"], record["template"]) == ("score", TEMPLATE.name)
    assert (file.parent / "t.png").read_bytes().startswith(b"\x89PNG")


def test_all_placements_and_given_designs_are_ranked_for_a_task(gsp, file):
    result = gsp(*WORDS, "D1^3 D2^3", TEMPLATE.name, "--placements", "--no-plot", "--out", "a.csv")
    assert "(4 placements of 1 mechanism)" in result.out
    mechanism = library.catalogue.mechanism("D1^3 D2^3")
    wanted = assessed(file, [*library.catalogue.placements(mechanism, TEMPLATE), TEMPLATE])
    table = pd.read_csv("a.csv")
    assert table["design"].tolist() == wanted["design"].tolist()
    assert json.loads((file.parent / "a.csv.json").read_text())["placements"] == "all distinct ones"


def test_proven_values_are_columns_that_can_be_chosen(gsp, file):
    file.write_text(TASK.replace('of = "worst"', 'of = "proven worst"'))
    columns = ("--columns", "rank,score,CTN,condition_number_proven,condition_number_closed")
    assert gsp(*WORDS, "D1^6", *columns, "--no-plot", "--out", "a.csv").status == 0
    proven = [f"condition_number_{end}" for end in ("proven", "closed")]
    assert list(pd.read_csv("a.csv")) == ["rank", "score", "control_number_mean", *proven]
    error = gsp(*WORDS, "D1^6", "--columns", "control_number_proven").error
    assert "unknown column 'control_number_proven'" in error
    assert "condition_number_proven, condition_number_found" in error
    assert "unknown column 'score'" in gsp("rank", "--columns", "score").error


def test_forces_and_violations_are_columns(gsp, file):
    limits = "[limits]\nposition = [[-10, 0], [-50, 50], [0, 200]]\n"
    file.write_text("wrench = [0, 0, -10, 0, 0, 0]\n" + TASK + limits)
    columns = ("--columns", "design,actuator_force,actuator_torque,violated_position,feasible")
    words = (*WORDS, "D1^6", "D1^5 A1", *columns, "--no-plot")
    result = gsp(*words, "--out", "a.csv")
    assert "actuator_force" in result.out
    table = pd.read_csv("a.csv").set_index("design")
    assert (table["violated_position"] + table["feasible"] == 1.0).all()
    assert table["actuator_torque"].isna()["D1^6"]
    assert table["actuator_torque"]["D1^5 A1"] > 0.0


def test_a_text_in_latex_has_score_and_what_is_wanted(gsp, file):
    assert gsp(*WORDS, "D1^6", "--no-plot", "--out", "a.tex").status == 0
    head = (file.parent / "a.tex").read_text().splitlines()[2]
    indices = [r"$\mathrm{CTN}$ mean", r"$\mathrm{CDN}_\mathrm{CL}$ max"]
    names = ["rank", "design", "class", "score", *indices]
    assert head.rstrip("\\ ").split(" & ") == names


@pytest.mark.parametrize(
    ("words", "options"),
    [
        (("--samples", 4), "--samples"),
        (("--box", "0 0 0 0 0 0", "--seed", 1), "--box, --seed"),
        (("--by", "CTN", "--indices", "CTN"), "--by, --indices"),
        (("--order", "ZYX"), "--order"),
        (("--length", 80), "--length"),
        (("--ellipsoid", 1, 1, 1), "--ellipsoid"),
        (("--feasible",), "--feasible"),
    ],
)
def test_options_whose_values_the_task_has_are_refused(gsp, file, words, options):
    error = gsp(*WORDS, *words).error
    assert error == f"gsp: {options}: not used beside --task, which states it"
    assert list(file.parent.iterdir()) == [file]


def test_unlike_units_are_an_error_and_converted_on_demand(gsp, file):
    file.write_text(TASK.replace('"mm"', '"m"'))
    error = gsp(*WORDS, "D1^6").error
    assert error.startswith("gsp: designs: expected the unit of the task, 'm' (convert them: ")
    assert error.endswith("received 'mm'")
    small = "position = [[-0.01, 0.03], [-0.03, 0.01], [0.12, 0.15]]"
    old = "position = [[-10.0, 30.0], [-30.0, 10.0], [120.0, 150.0]]"
    file.write_text(file.read_text().replace(old, small))
    assert gsp(*WORDS, "D1^6", "--unit", "m", "--no-plot", "--out", "m.csv").status == 0
    file.write_text(TASK)
    assert gsp(*WORDS, "D1^6", "--no-plot", "--out", "mm.csv").status == 0
    found, wanted = (pd.read_csv(name)["control_number_mean"][0] for name in ("m.csv", "mm.csv"))
    assert found == pytest.approx(wanted, rel=1e-12)


def test_a_parameter_that_the_task_does_not_have_is_named(gsp, file):
    file.write_text(TASK.replace('"CTN"', '"CDN_OE"'))
    assert "expected ellipsoid in the task, received none" in gsp(*WORDS, "D1^6").error


def test_designs_without_a_score_are_counted(gsp, file):
    file.write_text(TASK + FAR)
    result = gsp(*WORDS, "D1^6", "D2^6")
    assert result.err.startswith("gsp: 2 designs without a score: no pose is within the limits")
    assert "gsp: no picture: no mean is defined" in result.err
    assert pd.read_csv("results/ranking.csv")["feasible"].tolist() == [0.0, 0.0]


def test_an_interrupted_ranking_for_a_task_is_continued(gsp, file, monkeypatch):
    write, stored = Parts.write_row, []

    def stop(parts, number, row):
        if stored:
            raise KeyboardInterrupt
        write(parts, number, row)
        stored.append(number)

    words = (*WORDS, "D1^6", "D2^6", "D1^3 D2^3", "--no-plot", "--out")
    assert gsp(*words, "whole.csv").status == 0
    monkeypatch.setattr(Parts, "write_row", stop)
    result = gsp(*words, "t.csv")
    monkeypatch.undo()
    monkeypatch.chdir(file.parent)
    assert result.status == 130
    assert "1 finished parts are kept in t.csv.parts; --resume continues" in result.err
    assert gsp(*words, "t.csv", "--resume").status == 0
    assert (file.parent / "t.csv").read_bytes() == (file.parent / "whole.csv").read_bytes()
