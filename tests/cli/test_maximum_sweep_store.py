"""`gsp maximum`, `gsp sweep`, `gsp store`."""

from __future__ import annotations

import contextlib
import json
import re
import sqlite3
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import gsp as library
from gsp.determinant import maximum
from gsp.families import lee


@pytest.fixture(autouse=True)
def store(tmp_path, monkeypatch):
    path = tmp_path / "maxima.sqlite"
    monkeypatch.setenv("GSP_STORE", str(path))
    return path


@pytest.fixture
def octahedron(tmp_path):
    lee.octahedral_3_3(1.0, 1.3, unit="m").write(tmp_path / "octahedron.toml")
    return "octahedron.toml"


def test_maximum_prints_value_pose_and_confidence(gsp, octahedron):
    result = gsp("maximum", octahedron)
    assert result.status == 0
    assert "|det J|max  1.13115375719 m^3" in result.out
    assert "all poses" in result.out
    assert "largest local maximum, found" in result.out
    assert not re.search(r"\b1 (local maxima|times|starts|evaluations)", result.out)
    facts = json.loads(gsp("maximum", octahedron, "--json").out)
    assert facts["method"] == "store"
    assert facts["value"] == pytest.approx(float(lee.central_maximum(1.0, 1.3)), rel=1e-12)
    again = json.loads(gsp("maximum", octahedron, "--json", "--seed", 7, "--no-store").out)
    assert (again["method"], again["seed"]) == ("search", 7)


def test_maximum_over_a_box(gsp, octahedron):
    result = gsp("maximum", octahedron, "--box", "0 0 0.1:0.4 0 0 0", "--json")
    facts = json.loads(result.out)
    expected = float(lee.central_determinant(1.0, 1.3, 0.4))
    assert facts["value"] == pytest.approx(expected, rel=1e-10)
    assert facts["domain"]["position"][2] == [0.1, 0.4]
    assert "--box" in gsp("maximum", octahedron, "--box", "nonsense").error


def test_maximum_of_nothing_is_one_line(gsp):
    assert "unknown design" in gsp("maximum", "nope").error
    assert "no dimensions" in gsp("maximum", "D1^6").error


def test_sweep_writes_table_and_picture(gsp, octahedron):
    result = gsp(
        "sweep",
        octahedron,
        "--rotate",
        "z",
        "--through",
        "base",
        "--steps",
        7,
        "--span=-90:90",
        "--out",
        "turn.csv",
        "--plot",
        "turn.png",
    )
    assert result.status == 0, result.err
    assert "base origin" in result.out
    assert "From position (0, 0, 0.680686) m" in result.out
    table = pd.read_csv("turn.csv")
    assert table["turn_deg"].tolist() == [-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0]
    assert table["quality_index"].iloc[3] == pytest.approx(1.0, rel=1e-9)
    assert table["quality_index"].iloc[0] == pytest.approx(0.0, abs=1e-9)
    assert json.loads(Path("turn.csv.json").read_text())["maximum"]["method"] == "search"


def test_sweep_over_a_plane_and_along_a_direction(gsp, octahedron):
    result = gsp("sweep", octahedron, "--over", "xz", "--steps", 3)
    assert result.out.splitlines()[-10].split() == ["distance_x", "distance_z", "quality_index"]
    at = ("--rotate", "z", "--through", "1,2.5,0", "--position", 1, 2, 3, "--angles", 0, 0, 30)
    result = gsp("sweep", octahedron, *at, "--steps", 3, "--indices", "CTN", "--out", "at.csv")
    assert "turn about z through the point (1, 2.5, 0)" in result.out
    assert "From position (1, 2, 3) m, roll, pitch, yaw (0, 0, 30)°" in result.out
    pose = json.loads(Path("at.csv.json").read_text())["pose"]
    assert pose["position"] == [1.0, 2.0, 3.0]
    assert pose["roll_pitch_yaw_deg"] == pytest.approx([0.0, 0.0, 30.0], abs=1e-12)
    result = gsp("sweep", octahedron, "--translate", "1e200,0,1", "--steps", 3, "--indices", "CTN")
    assert "control_number" in result.out


ONE_MOTION = "expected one of these options, received"
DIRECTION = 'expected x, y, z or three numbers "1,0,1"'
POINT = 'expected platform, base or three numbers "x,y,z"'


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ((), f"--translate, --rotate, --over: {ONE_MOTION} none"),
        (("--rotate", "z", "--over", "xy"), f"--rotate, --over: {ONE_MOTION} 2 of them"),
        (("--rotate", "q"), f"--rotate: {DIRECTION}, received 'q'"),
        (("--rotate", "0,0,0"), "--rotate: expected a direction that is not zero"),
        (("--rotate", "1e400,0,0"), f"--rotate: {DIRECTION}"),
        (("--translate", "nan,0,1"), f"--translate: {DIRECTION}"),
        (("--over", "zz"), "--over: expected xy, xz or yz, received 'zz'"),
        (("--rotate", "z", "--span", "1"), "--span: expected numbers low:high, received '1'"),
        (("--rotate", "z", "--span", "nan:1"), "--span: expected numbers low:high"),
        (("--rotate", "z", "--span", "5:5"), "--span: expected low < high"),
        (("--rotate", "z", "--span", "inf:inf"), "--span: expected a finite number"),
        (("--rotate", "z", "--span=-1e308:1e308"), "--span: expected one number of at most 1e+100"),
        (("--rotate", "z", "--through", "1e308,0,0"), "--through: expected one number of at most"),
        (("--rotate", "z", "--through", "1,2"), f"--through: {POINT}, received '1,2'"),
        (("--rotate", "z", "--through", "far"), f"--through: {POINT}, received 'far'"),
    ],
)
def test_sweep_names_bad_options(gsp, octahedron, options, message):
    error = gsp("sweep", octahedron, *options, "--position", 0, 0, 1).error
    assert error.startswith(f"gsp: {message}")


def test_a_sweep_takes_the_ellipsoid_of_other_commands(gsp, octahedron):
    words = ("sweep", octahedron, "--over", "xy", "--steps", 2, "--position", 0, 0, 1)
    names = ("--indices", "condition_number_ellipsoid", "--out")
    result = gsp(*words, *names, "own.csv")
    radius = np.linalg.norm(library.read_design(octahedron).platform_points, axis=1).max()
    assert f"ellipsoid {radius:.4g} × {radius:.4g} × {radius / 2:.4g}" in result.out
    gsp(*words, *names, "given.csv", "--ellipsoid", radius, radius, radius / 2)
    own, given = (pd.read_csv(f"{name}.csv") for name in ("own", "given"))
    pd.testing.assert_frame_equal(own, given, rtol=1e-12)


def test_a_link_to_itself_is_no_missing_store(gsp, tmp_path, monkeypatch):
    (tmp_path / "loop.db").symlink_to("loop.db")
    monkeypatch.setenv("GSP_STORE", str(tmp_path / "loop.db"))
    assert "cannot be opened" in gsp("store", "list").error


def test_store_list_export_import_remove(gsp, store, monkeypatch, tmp_path):
    found = maximum(lee.octahedral_3_3(1.0, 1.0))
    assert str(store) in gsp("store", "path").out
    listing = gsp("store", "list").out
    assert "6×D1" in listing
    assert "1 maximum, of designs" in listing
    assert "1 maximum written" in gsp("store", "export", "maxima.json").out
    assert "exists already" in gsp("store", "export", "maxima.json").error
    monkeypatch.setenv("GSP_STORE", str(tmp_path / "other.sqlite"))
    assert "1 of them new or better" in gsp("store", "import", "maxima.json").out
    known = maximum(lee.octahedral_3_3(2.0, 2.0))
    assert (known.method, known.value) == ("store", pytest.approx(8.0 * found.value, rel=1e-12))
    key = json.loads(Path("maxima.json").read_text())["maxima"][0]["key"]
    assert gsp("store", "remove", key[:10]).status == 0
    assert "0 maxima" in gsp("store", "list").out
    assert "beginning of one key" in gsp("store", "remove", "ff").error


@pytest.mark.parametrize("arguments", [("list",), ("export", "a.json"), ("remove", "ff")])
@pytest.mark.parametrize("other", [False, True])
def test_commands_that_read_make_no_store(gsp, tmp_path, monkeypatch, arguments, other):
    """Neither folders and a file, nor a table in the database of another program."""
    path = tmp_path / "a" / "b" / "maxima.sqlite"
    monkeypatch.setenv("GSP_STORE", str(path))
    if other:
        path.parent.mkdir(parents=True)
        with contextlib.closing(sqlite3.connect(path)) as database, database:
            database.execute("CREATE TABLE others (number)")
    bits = path.read_bytes() if other else None
    result = gsp("store", *arguments)
    message = "no table of maxima in" if other else f"no file {path}"
    if arguments == ("list",):
        assert (result.status, result.out.startswith(f"0 maxima: {message}")) == (0, True)
    else:
        assert message in result.error
    assert path.read_bytes() == bits if other else not (tmp_path / "a").exists()
    assert not Path("a.json").exists()


def test_a_file_that_is_refused_makes_no_store(gsp, octahedron, tmp_path, monkeypatch):
    """Files of another suffix or form, and one with only maxima of an older search."""
    gsp("maximum", octahedron)
    gsp("store", "export", "old.json")
    content = json.loads(Path("old.json").read_text())
    content["maxima"][0].pop("version")
    Path("old.json").write_text(json.dumps(content))
    Path("empty.json").write_text('{"maxima": []}')
    Path("bad.json").write_text('{"maxima": [{"value": 1}]}')
    Path("bad.csv").write_text("key\n")
    path = tmp_path / "a" / "maxima.sqlite"
    monkeypatch.setenv("GSP_STORE", str(path))
    for name, status in (
        *(("bad.json", 2), ("none.json", 2), ("a.ods", 2), (".", 2)),
        *(("old.json", 0), ("empty.json", 0), ("bad.csv", 0)),
    ):
        assert gsp("store", "import", name).status == status, name
        assert not path.parent.exists(), name
    monkeypatch.setenv("GSP_STORE", "off")
    assert "switched it off" in gsp("store", "import", "old.json").error


@pytest.mark.parametrize("column", ["value", "found", "starts", "version", "seed"])
def test_nan_in_a_file_of_maxima_is_named(gsp, octahedron, column):
    gsp("maximum", octahedron)
    gsp("store", "export", "a.json")
    content = json.loads(Path("a.json").read_text())
    content["maxima"][0][column] = float("nan")
    Path("a.json").write_text(json.dumps(content))
    message = f"maximum 1: {column}: expected a finite number, received NaN"
    assert message in gsp("store", "import", "a.json").error


def test_store_errors_are_one_line(gsp, store, monkeypatch):
    store.write_text("not a database, in spite of its name" * 100)
    assert "not a database" in gsp("store", "list").error
    monkeypatch.setenv("GSP_STORE", "off")
    assert "switched it off" in gsp("store", "list").error
    assert gsp("store", "path").out.strip() == "off"


def test_store_remove_of_nothing_is_an_error(gsp, octahedron):
    gsp("maximum", octahedron)
    for key in ("", " "):
        assert "beginning of one key" in gsp("store", "remove", key).error
    assert "1 maximum" in gsp("store", "list").out


@pytest.mark.parametrize("column", ["design", "domain", "found", "starts", "position"])
def test_a_damaged_entry_is_listed_and_can_be_removed(gsp, store, column):
    maximum(lee.octahedral_3_3(1.0, 1.0))
    with contextlib.closing(sqlite3.connect(store)) as database, database:
        database.execute(f"UPDATE gsp_maxima SET {column} = 'xyz'")
        key = database.execute("SELECT key FROM gsp_maxima").fetchone()[0]
    listing = gsp("store", "list")
    assert listing.status == 0
    assert re.search(key[:12] + r"\W+damaged", listing.out)
    assert "0 maxima, of designs" in listing.out
    assert f"{key[:12]} is damaged" in listing.err
    export = gsp("store", "export", "maxima.json")
    assert (export.status, "1 maximum left out as damaged" in export.err) == (0, True)
    assert json.loads(Path("maxima.json").read_text())["maxima"] == []
    assert gsp("store", "remove", key).status == 0


def test_a_plausible_value_that_its_pose_contradicts_is_listed_as_damaged(gsp, store):
    found = maximum(lee.octahedral_3_3(1.0, 1.0))
    assert gsp("store", "export", "good.json").status == 0
    with contextlib.closing(sqlite3.connect(store)) as database, database:
        database.execute("UPDATE gsp_maxima SET value = value * 1.001")
    listing = gsp("store", "list")
    assert "damaged" in listing.out
    assert "which its pose has" in " ".join(listing.err.split())
    assert "1 maximum left out as damaged" in gsp("store", "export", "bad.json").err
    assert "1 of them new or better" in gsp("store", "import", "good.json").out
    listing = gsp("store", "list").out
    assert ("valid" in listing, "damaged" in listing) == (True, False)
    known = maximum(lee.octahedral_3_3(1.0, 1.0))
    assert (known.method, known.value) == ("store", found.value)


def test_a_sweep_of_drives_needs_indices(gsp):
    result = gsp("sweep", "lane-rotary", "--rotate", "z")
    assert result.status == 2
    assert "--indices: expected indices, such as CTN with --length" in result.error
