import pandas as pd
import pytest
from typer.testing import CliRunner

import gsp
from gsp.cli.app import app
from gsp.errors import GspError

NAME = "workspace-6-3"


def run(*arguments):
    return CliRunner().invoke(app, ["workspace", *map(str, arguments)])


def test_fixed_orientation_prints_the_exact_volume_and_corners(tmp_path):
    out = tmp_path / "arcs.csv"
    result = run(NAME, "--angles", "0 0 -30", "--theta", 15, "--out", out)
    assert result.exit_code == 0
    assert "96.5664" in result.stdout
    assert "- 1 - 1 - 1" in result.stdout
    assert "-0.000000" not in result.stdout
    assert str(out) in result.stdout
    table = pd.read_csv(out)
    assert set(table["label"]) >= {"- 1 - - - -", "0 - - - - -"}


def test_an_interval_selects_the_dextrous_volume():
    result = run(NAME, "--angles", "0 0 -5:5", "--resolution", 1.0)
    assert result.exit_code == 0
    assert "proven" in result.stdout


def test_a_section_of_other_limits_is_mapped_and_drawn(tmp_path):
    picture, out = tmp_path / "a.png", tmp_path / "a.csv"
    result = run(
        NAME,
        "--angles",
        "0 0 0",
        "--index",
        "manipulability >= 1000",
        "--rays",
        6,
        "--plot",
        picture,
        "--out",
        out,
    )
    assert result.exit_code == 0, result.exception
    assert "manipulability=0" in result.stdout
    assert picture.stat().st_size > 1000
    assert pd.read_csv(out)["maximal"].any()


def test_the_picture_states_plane_and_orientation(tmp_path):
    run(NAME, "--angles", "0 0 -30", "--theta", 15, "--plot", tmp_path / "a.svg")
    text = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert "vertical plane at 15°" in text
    assert "angles 0° 0° -30° (approach-roll)" in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((NAME, "--angles", "0 0"), "three angles"),
        ((NAME, "--angles", "0 0 9:1"), "three angles"),
        ((NAME, "--out", "a.txt"), "csv"),
        ((NAME, "--stroke", 9, 9), "least < greatest"),
        ((NAME, "--stroke", 0, 1e200), "--stroke"),
        ((NAME, "--angles", "0 0 0", "--theta", "inf"), "--theta"),
        ((NAME, "--angles", "0 0 0", "--position", "nan", 0, 0), "--position"),
        ((NAME, "--order", "q"), "order"),
        ((NAME, "--position", 0, 0, 50), "feasible orientation"),
        (("toz-kucuk-2016-d3-6",), "strokes or other limits"),
        ((NAME, "--angles", "0 0 -5:5", "--plot", "a.png"), "only the volume"),
    ],
)
def test_bad_input_is_an_error(arguments, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*arguments)
    assert isinstance(result.exception, GspError)
    assert message in str(result.exception)


def test_a_workspace_without_a_point_has_no_volume():
    result = run(NAME, "--angles", "0 0 -1:1", "--stroke", 1, 2)
    assert result.exit_code == 0
    assert "Volume  between 0 and 0, proven" in result.stdout


def test_existing_files_are_kept(tmp_path):
    out = tmp_path / "arcs.csv"
    out.write_text("mine")
    result = run(NAME, "--angles", "0 0 0", "--out", out)
    assert isinstance(result.exception, GspError)
    assert out.read_text() == "mine"


def test_a_limit_of_the_quality_index_finds_its_maximum():
    result = run(NAME, "--angles", "0 0 0", "--index", "λ >= 0.01", "--rays", 1, "--starts", 1)
    assert result.exit_code == 0, result.exception


def test_small_designs_are_printed_with_their_digits(tmp_path):
    small = gsp.catalogue.design(NAME).scaled(1e-9)
    small.write(tmp_path / "small.toml")
    result = run(tmp_path / "small.toml", "--angles", "0 0 -30", "--theta", 15)
    assert result.exit_code == 0, result.exception
    assert "e-09" in result.stdout
    assert "0.000000 " not in result.stdout.replace("0.000000e+00", "")
