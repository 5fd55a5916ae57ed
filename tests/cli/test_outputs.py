"""Files that commands write: their suffixes are checked first, and what exists stays."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from gsp import PoseBox, catalogue
from gsp.cli.outputs import console
from gsp.cli.outputs.postures import box_text

NAME = "toz-kucuk-2016-d3-6"
TABLES = ".csv, .parquet, .xlsx, .md, .tex"
PICTURES = ".png, .pdf, .svg"
# Commands, their option for a file, and the suffixes that it has.
OUTPUTS = (
    (("rank", "D1^6", "--no-plot", "--samples", 2), "--out", TABLES),
    (("catalogue",), "--out", TABLES),
    (("jacobian", NAME), "--out", TABLES),
    (("sweep", NAME, "--rotate", "z", "--steps", 2, "--indices", "CTN"), "--out", TABLES),
    (("check",), "--out", TABLES),
    (("workspace", "workspace-6-3", "--angles", "0 0 0"), "--out", TABLES),
    (("check",), "--errata", ".md"),
    (("prove", "D1^6", "--poses", 1), "--out", ".md"),
    (("certify", NAME, "--box", "10 -10 138 5 -5 -10"), "--out", ".json"),
    (("export", NAME, "--to", "mjcf"), "--out", ".xml"),
    (("export", NAME, "--to", "urdf"), "--out", ".urdf"),
    (("export", NAME, "--to", "pinocchio"), "--out", ".xml"),
    (("show", NAME), "--plot", PICTURES),
    (("sweep", NAME, "--rotate", "z", "--steps", 2, "--indices", "CTN"), "--plot", PICTURES),
    (("workspace", "workspace-6-3", "--angles", "0 0 0"), "--plot", PICTURES),
)
IDS = [f"{words[0]}{option}{i}" for i, (words, option, _) in enumerate(OUTPUTS)]
QUICK = [o for o in OUTPUTS if o[0][0] not in ("check", "workspace")]


@pytest.mark.parametrize(("words", "option", "suffixes"), OUTPUTS, ids=IDS)
def test_error_of_an_unknown_suffix_names_the_known_ones(gsp, tmp_path, words, option, suffixes):
    for name in ("file.doc", "file", ".csv.d", "a b.CSV.x"):
        error = gsp(*words, option, name).error
        assert f"a name ending in {suffixes}, received" in error
        assert option != "--plot" or "--plot: expected" in error
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("words", "option", "suffixes"), OUTPUTS, ids=IDS)
def test_paths_that_cannot_be_written_are_errors_before_the_computation(
    gsp, tmp_path, words, option, suffixes
):
    end = suffixes.split(", ", maxsplit=1)[0]
    there = tmp_path / f"there{end}"
    there.write_text("precious")
    (tmp_path / f"folder{end}").mkdir()
    for name, message in (
        (there, "exists already"),
        (f"folder{end}", "received a folder"),
        (f"none/a{end}", "folder none does not exist"),
        (f"there{end}/a{end}", "does not exist"),
        ("n" * 300 + end, "File name too long"),
    ):
        assert message in gsp(*words, option, name).error
    assert there.read_text() == "precious"


@pytest.mark.parametrize(
    ("words", "option", "suffixes"), QUICK, ids=[f"{q[0][0]}{q[1]}{i}" for i, q in enumerate(QUICK)]
)
def test_names_with_spaces_and_umlauts(gsp, tmp_path, words, option, suffixes):
    end = suffixes.split(", ", maxsplit=1)[0].upper()
    (tmp_path / "grüne Mühle λ").mkdir()
    result = gsp(*words, option, f"grüne Mühle λ/größe 1{end}")
    assert result.status == 0, result.err
    assert (tmp_path / f"grüne Mühle λ/größe 1{end}").stat().st_size > 0


def test_errors_on_paths_name_the_option_and_the_wrong_ending_first(gsp, tmp_path):
    (tmp_path / "empty.toml").touch()
    error = gsp("show", "toz-kucuk-2016-d3-6", "--plot", "empty.toml").error
    assert "--plot: expected a name ending in .png" in error
    error = gsp("check", "--out", "\x1b[31m").error
    assert error.startswith("gsp: --out: \\x1b[31m: expected a name")


def test_a_table_of_a_workspace_has_its_facts_beside_it(gsp, tmp_path):
    for end in ("csv", "md", "parquet"):
        words = ("workspace", "workspace-6-3", "--angles", "0 0 -30", "--theta", 15)
        assert gsp(*words, "--out", f"a.{end}").status == 0
        assert '"theta_deg": 15.0' in Path(f"a.{end}.json").read_text()
    table, same = pd.read_csv("a.csv"), pd.read_parquet("a.parquet")
    pd.testing.assert_frame_equal(table, same, check_dtype=False)


def test_an_export_without_a_unit_warns_and_makes_no_hidden_file(gsp, tmp_path):
    catalogue.design(NAME).replace(unit="", name="..").write(tmp_path / "given.toml")
    export = ("export", "given.toml", "--to", "mjcf")
    result = gsp(*export)
    assert result.status == 0
    assert "taken as metres" in result.err
    assert (tmp_path / "design.xml").exists()
    assert not gsp(*export, "--metres", 1, "--out", "other.xml").err


@pytest.mark.parametrize(
    ("columns", "width"), [("72", 72), ("", console.UNBROKEN_WIDTH), ("x", console.UNBROKEN_WIDTH)]
)
def test_a_pipe_has_the_requested_width(monkeypatch, columns, width):
    monkeypatch.setenv("COLUMNS", columns)
    assert console.stdout().width == width


def test_boxes_and_poses_have_no_numbers_of_rounding_size():
    box = PoseBox([(-1e-15, 20), (5, 5), (-3, 100)], np.deg2rad([(-5, 1e-14), (0, 2), (-20, 20)]))
    assert box_text(box, "mm") == "x 0…20, y 5, z -3…100 mm; α -5…0, β 0…2, γ -20…20°"
