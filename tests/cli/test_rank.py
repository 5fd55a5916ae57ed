"""`gsp rank`: what it computes, prints and writes, and its errors."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest

import gsp as library
from gsp.cli.ranking import files as ranking_files
from gsp.cli.ranking.plan import Plan, make_plan
from gsp.files.claims import Claim

FEW = ("--samples", 8, "--no-plot")
TWO = ("D1^6", "D1^3D2^3")
FIRST, SECOND = (
    library.catalogue.design(name)
    for name in ("toz-kucuk-2016-d3-6", "toz-kucuk-2016-d1-d2-d3-d4-a1-2")
)


def test_no_arguments_rank_the_catalogue(gsp, tmp_path):
    result = gsp("rank", "--samples", 4)
    assert result.status == 0
    table = pd.read_csv(tmp_path / "results/ranking.csv")
    assert sorted(table["mechanism"]) == sorted(m.name for m in library.catalogue.mechanisms())
    for name, index in library.indices.INDICES.items():
        assert (f"{name}_mean" in table) == index.routine
    assert (tmp_path / "results/ranking.png").read_bytes().startswith(b"\x89PNG")
    assert result.err == ""


def test_best_twenty_are_printed_in_order(gsp, tmp_path):
    result = gsp("rank", *FEW)
    table = pd.read_csv(tmp_path / "results/ranking.csv")
    lines = result.out.splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("rank ")) + 1
    printed = lines[start : start + 20]
    for line, (_, row) in zip(printed, table.head(20).iterrows(), strict=True):
        assert line.split()[0] == str(row["rank"])
        assert row["design"] in line
    assert lines[start + 20].startswith("Table")


def test_every_assumption_is_printed(gsp):
    out = gsp("rank", *TWO, *FEW).out
    for words in ("8 poses (Halton, seed 0)", "95 mm", "94.34 × 94.34 × 47.17 mm", "|det J|"):
        assert words in out


def test_table_is_that_of_the_library(gsp, tmp_path):
    """The default box written out by hand: both homes, ± 20 mm and ± 10°."""
    gsp("rank", "--samples", 5, "--seed", 3, "--out", "r.parquet", "--no-plot")
    places = np.stack((FIRST.home.position, SECOND.home.position))
    low, high = places.min(axis=0) - 20.0, places.max(axis=0) + 20.0
    angles = [(2 - 10, 5 + 10), (-5 - 10, 5 + 10), (-10 - 10, -5 + 10)]
    box = library.PoseBox(list(zip(low, high, strict=True)), angles, degrees=True)
    radius = np.linalg.norm(FIRST.platform_points, axis=1).max()
    wanted = library.rank(
        [library.catalogue.instantiate(m, FIRST) for m in library.catalogue.mechanisms()],
        box.sample(5, rng=3),
        ellipsoid=library.Ellipsoid((radius, radius, radius / 2)),
        maximum="sample",
    )
    got = pd.read_parquet(tmp_path / "r.parquet").set_index("design").sort_index()
    wanted = wanted.set_index("design").sort_index()
    assert list(got.columns) == list(wanted.columns)
    numbers = wanted.select_dtypes("number").drop(columns="rank").columns
    np.testing.assert_allclose(got[numbers], wanted[numbers], rtol=1e-8)


def test_seed_decides(gsp, tmp_path):
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        assert gsp("rank", *TWO, *FEW, "--seed", seed, "--out", f"{name}.csv").status == 0
    a, b, c = ((tmp_path / f"{name}.csv").read_bytes() for name in "abc")
    assert a == b
    assert a != c


def test_workers_do_not_change_the_result(gsp, tmp_path):
    for workers in (1, 3):
        gsp("rank", *TWO, *FEW, "--workers", workers, "--out", f"{workers}.csv")
    assert (tmp_path / "1.csv").read_bytes() == (tmp_path / "3.csv").read_bytes()


def test_running_twice_keeps_both(gsp, tmp_path):
    for _ in range(3):
        assert gsp("rank", *TWO, *FEW).status == 0
    names = sorted(path.name for path in (tmp_path / "results").iterdir())
    stems = ("ranking", "ranking-2", "ranking-3")
    assert names == sorted(f"{s}{e}" for s in stems for e in (".csv", ".csv.json"))


def test_metadata_make_the_table_again(gsp, tmp_path):
    gsp("rank", *TWO, "--samples", 6, "--seed", 9, "--out", "r.csv", "--no-plot")
    facts = json.loads((tmp_path / "r.csv.json").read_text())
    assert facts["library"] == f"gsp {library.__version__}"
    assert facts["unit_of_length"] == "mm"
    assert facts["length"] == 95.0
    assert facts["template"] == FIRST.name
    poses = facts["poses"]
    ends = np.stack((poses["low"], poses["high"]), axis=-1)
    box = library.PoseBox(ends[:3].tolist(), ends[3:].tolist(), order=poses["order"])
    again = library.rank(
        [library.catalogue.instantiate(library.catalogue.mechanism(t), FIRST) for t in TWO],
        box.sample(poses["number"], rng=poses["seed"]),
        facts["indices"],
        facts["by"],
        length=facts["length"],
        ellipsoid=library.Ellipsoid(**facts["ellipsoid"]),
        maximum=facts["maximum"],
    )
    table = pd.read_csv(tmp_path / "r.csv")
    assert set(facts["columns"]) == set(table.columns[5:])
    pd.testing.assert_frame_equal(table, again, check_dtype=False, rtol=1e-12)


def test_units_of_columns(gsp, tmp_path):
    """|det J| is in the unit of the design, with a length as without one."""
    design = FIRST.replace(characteristic_length=None)
    design.write(tmp_path / "d.toml")
    gsp("rank", "d.toml", *FEW, "--out", "without.csv")
    gsp("rank", "d.toml", *FEW, "--out", "with.csv", "--length", 95)
    tables = [pd.read_csv(tmp_path / f"{name}.csv") for name in ("without", "with")]
    units = [
        json.loads((tmp_path / f"{name}.csv.json").read_text())["columns"]["manipulability_mean"]
        for name in ("without", "with")
    ]
    assert [u["unit"] for u in units] == ["mm^3", "mm^3"]
    np.testing.assert_allclose(*(t["manipulability_mean"] for t in tables), rtol=1e-9)


def test_what_is_left_out_is_said(gsp, tmp_path):
    FIRST.replace(characteristic_length=None).write(tmp_path / "d.toml")
    result = gsp("rank", "d.toml", *FEW)
    assert result.status == 0
    assert "condition_number is left out: it needs --length" in result.err
    assert "condition_number_mean" not in pd.read_csv(tmp_path / "results/ranking.csv")


def test_all_indices_are_computed_when_asked_for(gsp, tmp_path):
    gsp("rank", *TWO, *FEW, "--indices", "all", "--out", "r.csv")
    table = pd.read_csv(tmp_path / "r.csv")
    assert all(f"{name}_mean" in table for name in library.indices.INDICES)


def test_indices_for_six_actuators_are_left_out_for_redundant_designs(gsp, tmp_path):
    legs = [leg.name for leg in FIRST.legs]
    more = {
        name: [*getattr(FIRST, name), getattr(FIRST, name)[0] + 9.0]
        for name in ("base_points", "platform_points", "base_directions")
    }
    FIRST.replace(legs=[*legs, "D3"], **more, platform_directions=None).write(tmp_path / "d.toml")
    assert gsp("rank", "d.toml", *FEW).status == 0
    result = gsp("rank", "d.toml", *FEW, "--indices", "rigidity_rate")
    assert "expected 6 actuators, received 7" in result.error


def test_by_and_indices_take_names_and_symbols(gsp, tmp_path):
    gsp("rank", *TWO, *FEW, "--by", "ctn", "--indices", "CDN_CL,control_number", "--out", "r.csv")
    table = pd.read_csv(tmp_path / "r.csv")
    assert {c.removesuffix("_mean") for c in table if c.endswith("_mean")} == {
        "condition_number",
        "control_number",
    }
    assert table["control_number_mean"].is_monotonic_decreasing
    assert json.loads((tmp_path / "r.csv.json").read_text())["by"] == "control_number"


def test_box_order_and_length(gsp, tmp_path):
    box = "-5:5, 0:0, 120:140, -3:3, 0, 0"
    gsp("rank", "D1^6", *FEW, "--box", box, "--length", 60, "--order", "ZYX", "--out", "r.csv")
    facts = json.loads((tmp_path / "r.csv.json").read_text())
    np.testing.assert_allclose(facts["poses"]["low"], [-5, 0, 120, -np.deg2rad(3), 0, 0])
    np.testing.assert_allclose(facts["poses"]["high"], [5, 0, 140, np.deg2rad(3), 0, 0])
    assert (facts["length"], facts["poses"]["order"]) == (60.0, "ZYX")


def test_ellipsoid_changes_its_index_only(gsp, tmp_path):
    gsp("rank", *TWO, *FEW, "--out", "a.csv")
    gsp("rank", *TWO, *FEW, "--out", "b.csv", "--ellipsoid", 10, 20, 30)
    a, b = (
        pd.read_csv(tmp_path / name).set_index("design").sort_index() for name in ("a.csv", "b.csv")
    )
    changed = {c for c in a if not np.array_equal(a[c], b[c])}
    assert changed == {c for c in a if c.startswith("condition_number_ellipsoid")}


def test_template_places_mechanisms(gsp, tmp_path):
    gsp("rank", "D1^6", *FEW, "--template", SECOND.name, "--out", "bad.csv")
    assert not (tmp_path / "bad.csv").exists()  # five legs only
    FIRST.scaled(2.0).replace(name="twice").write(tmp_path / "t.toml")
    gsp("rank", "D1^6", *FEW, "--template", "t.toml", "--out", "r.csv")
    facts = json.loads((tmp_path / "r.csv.json").read_text())
    assert (facts["template"], facts["length"]) == ("twice", 190.0)


def test_recorded_ellipsoids_are_used(tmp_path):
    own = FIRST.replace(ellipsoid=library.Ellipsoid((1.0, 2.0, 3.0)))
    own.write(tmp_path / "own.toml")
    plan = make_plan([str(tmp_path / "own.toml")], samples=4)
    assert plan.ellipsoid is None
    assert plan.designs[0].ellipsoid.semi_axes.tolist() == [1.0, 2.0, 3.0]


@pytest.mark.parametrize("suffix", ["csv", "parquet", "md", "tex"])
def test_formats(gsp, tmp_path, suffix):
    assert gsp("rank", *TWO, *FEW, "--out", f"r.{suffix}").status == 0
    data = (tmp_path / f"r.{suffix}").read_bytes()
    assert (data[:4] == b"PAR1") == (suffix == "parquet")
    if suffix != "parquet":
        assert ("D_1" if suffix == "tex" else "D1") in data.decode()
    assert json.loads((tmp_path / f"r.{suffix}.json").read_text())["by"] == "condition_number"


def test_headings_in_latex_are_symbols_with_units(gsp, tmp_path):
    given = ("--columns", "rank,design,CTN,manipulability_q05")
    assert gsp("rank", *TWO, *FEW, *given, "--out", "r.tex").status == 0
    header = (tmp_path / "r.tex").read_text().splitlines()[2]
    assert header == (r"rank & design & $\mathrm{CTN}$ mean & $|\det J|$ 5\,\% [mm$^{3}$] \\")
    assert gsp("rank", *TWO, *FEW, "--out", "m.tex").status == 0
    header = (tmp_path / "m.tex").read_text().splitlines()[2]
    for symbol in (r"$\mathrm{CDN}_\mathrm{CL}$", r"$\lambda$", r"$\sigma_\mathrm{min}$"):
        assert f" & {symbol} mean" in header


@pytest.mark.parametrize("suffix", ["csv", "tex"])
def test_drives_are_printed_and_written(gsp, tmp_path, suffix):
    pair = ("lane-rotary", "lane-modified-paradex", "--length", 1, "--indices", "CTN")
    result = gsp("rank", *pair, *FEW, "--box", "0 0 11 0 0 0", "--out", f"d.{suffix}")
    lines = [line.split() for line in result.out.splitlines()]
    heads = next(line for line in lines if line[:1] == ["rank"])
    assert heads[:4] == ["rank", "design", "class", "drives"]
    assert any(line[1:5] == ["lane-rotary", "6D", "6", "cranks"] for line in lines)
    text = (tmp_path / f"d.{suffix}").read_text()
    assert "6 sliders" in text
    mixed = gsp("rank", *pair, *FEW, "--columns", "design,drives", "--out", "e.csv")
    assert mixed.status == 0
    assert pd.read_csv(tmp_path / "e.csv").columns.tolist() == ["design", "drives"]


def test_infinite_means_are_said(gsp, tmp_path):
    """At the pose the anchors of this design coincide in a plane; of the other one they do not."""
    box = ("--box", "0 0 0 0 0 0", "--samples", 1, "--no-plot", "--length", 1)
    pair = ("lee-2000-3-3", "workspace-6-3")
    result = gsp("rank", *pair, *box, "--indices", "CDN_CL,CTN", "--out", "r.csv")
    table = pd.read_csv(tmp_path / "r.csv")
    named = ", ".join(table.loc[np.isinf(table["condition_number_mean"]), "design"])
    assert "lee-2000-3-3" in named
    line = f"infinite means of condition_number, as poses are singular: {named}; the table has "
    assert result.err.startswith(f"gsp: {line}")
    facts = json.loads((tmp_path / "r.csv.json").read_text())
    assert list(facts["infinite_means"]) == ["condition_number"]


def test_nothing_is_overwritten_unless_forced(gsp, tmp_path):
    for name in ("r.csv", "r.csv.json", "r.png"):
        path = tmp_path / name
        path.write_text("precious")
        plot = ["--no-plot"] if name != "r.png" else ["--plot"]
        assert "exists already" in gsp("rank", *TWO, "--samples", 4, *plot, "--out", "r.csv").error
        assert path.read_text() == "precious"
        assert list(tmp_path.iterdir()) == [path]
        path.unlink()
    (tmp_path / "r.csv").write_text("old")
    assert gsp("rank", *TWO, *FEW, "--out", "r.csv", "--force").status == 0
    assert (tmp_path / "r.csv").read_text().startswith("rank,")


def test_if_the_name_is_taken_during_the_computation_nothing_is_lost(gsp, tmp_path, monkeypatch):
    def slow(self, *arguments):
        (tmp_path / "r.csv").write_text("precious")
        return compute(self, *arguments)

    compute = Plan.compute
    monkeypatch.setattr(Plan, "compute", slow)
    result = gsp("rank", *TWO, *FEW, "--out", "r.csv")
    assert result.status == 0
    assert (tmp_path / "r.csv").read_text() == "precious"
    assert len(pd.read_csv(tmp_path / "r-2.csv")) == 2
    assert "r-2.csv" in result.out


def test_files_are_written_whole_or_not_at_all(gsp, tmp_path, monkeypatch):
    def breaks(self, path, **options):
        path.write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pd.DataFrame, "to_csv", breaks)
    assert "No space left" in gsp("rank", *TWO, *FEW, "--out", "r.csv").error
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def no_work(monkeypatch):
    def work(*arguments, **options):
        raise AssertionError("the work started")

    monkeypatch.setattr("gsp.cli.ranking.plan.rank", work)


@pytest.mark.usefixtures("no_work")
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--out", "nowhere/r.csv"], "folder nowhere does not exist"),
        (["--out", "r.ods"], "a name ending in .csv, .parquet, .xlsx, .md, .tex"),
        (["--out", "."], "expected"),
        (["--by", "beauty"], "unknown index 'beauty'"),
        (["--indices", "CTN,controll_number"], "nearest: control_number"),
        (["--box", "1 2 3"], "--box: expected six intervals low:high"),
        (["--box", "a b c d e f"], "--box: expected six intervals low:high"),
        (["--box", "5:1 0 0 0 0 0"], "low ≤ high"),
        (["--order", "sideways"], "order: expected rpy"),
        (["--ellipsoid", "1", "0", "1"], "--ellipsoid: expected"),
        (["--template", "nobody"], "unknown design 'nobody'"),
        (["--samples", "0"], "--samples"),
        (["--seed", "-1"], "--seed"),
        (["--seed", "1", "--box", "0 0 9 0 0 0"], "--seed: not used beside --box with a single"),
        (["--workers", "0"], "--workers"),
        (["D1^5"], "unknown mechanism 'D1^5'"),
        (["toz-kucuk"], "nearest: toz-kucuk-2016-d3-6"),
        (["missing.toml"], "missing.toml"),
        (["--nonsense"], "unknown option '--nonsense'"),
    ],
)
def test_bad_input_is_one_line_before_the_work(gsp, arguments, words):
    assert words in gsp("rank", "--no-plot", *arguments).error


def test_bad_lengths_and_choices(gsp):
    assert "length: expected a positive number" in gsp("rank", *TWO, *FEW, "--length", -1).error
    line = gsp("rank", *TWO, *FEW, "--by", "CTN", "--indices", "CDN_CL").error
    assert "by: expected one of the indices condition_number" in line


def test_malformed_design_names_line_and_key(gsp, tmp_path):
    (tmp_path / "d.toml").write_text('unit = "mm"\ncolour = "red"\n')
    line = gsp("rank", "d.toml", *FEW).error
    assert "line 2" in line
    assert "colour" in line


def test_units_must_agree(gsp, tmp_path):
    FIRST.scaled(1e-3).replace(unit="m").write(tmp_path / "d.toml")
    assert "one unit of length" in gsp("rank", FIRST.name, "d.toml", *FEW).error


def test_no_home_needs_a_box(gsp, tmp_path):
    FIRST.replace(home=None).write(tmp_path / "d.toml")
    assert "--box" in gsp("rank", "d.toml", *FEW).error
    assert gsp("rank", "d.toml", *FEW, "--box", "0 0 130:140 0 0 0").status == 0


def test_unnamed_file_takes_its_own_name(gsp, tmp_path):
    FIRST.replace(name="").write(tmp_path / "mine.toml")
    gsp("rank", "mine.toml", *FEW, "--out", "r.csv")
    assert pd.read_csv(tmp_path / "r.csv")["design"].tolist() == ["mine"]


def test_without_matplotlib(gsp, tmp_path, monkeypatch):
    monkeypatch.setattr("gsp.installed.is_installed", lambda package: False)
    result = gsp("rank", *TWO, "--samples", 4)
    assert result.status == 0
    assert 'pip install "gsp-mechanisms[plots]"' in result.err
    assert not (tmp_path / "results/ranking.png").exists()
    assert "matplotlib" in gsp("rank", *TWO, "--samples", 4, "--plot").error


def test_default_folder_that_cannot_be_made(gsp, tmp_path):
    (tmp_path / "results").write_text("a file")
    assert "cannot be made" in gsp("rank", *TWO, *FEW).error


def test_no_progress_without_a_terminal(gsp, monkeypatch):
    monkeypatch.setattr("gsp.progress.SECONDS_BEFORE_BAR", -1.0)
    assert gsp("rank", *TWO, *FEW).err == ""


def press(path, **changes):
    """Write a design of half the size of the default template, with strokes and a home pose."""
    joints = FIRST.scaled(0.5).at(FIRST.scaled(0.5).home).joints
    strokes = np.stack((joints - 6.0, joints + 6.0), axis=-1)
    design = FIRST.scaled(0.5).replace(name="press", strokes=strokes, **changes)
    design.write(path)
    return design


def test_mechanisms_beside_a_design_are_put_on_its_anchors(gsp, tmp_path):
    design = press(tmp_path / "press.toml")
    result = gsp("rank", "press.toml", "D1^3 D2^3", *FEW, "--out", "r.parquet")
    assert "2 designs, 1 of them on the anchor lines of press" in result.out
    facts = json.loads((tmp_path / "r.parquet.json").read_text())
    assert facts["sizes"] == pytest.approx([design.rms_radius] * 2, rel=1e-12)
    both = gsp("rank", "press.toml", FIRST.name, "D1^6", *FEW)
    assert "--template: expected the design on whose anchors" in both.error
    given = ("rank", "press.toml", "D1^6", *FEW, "--template", FIRST.name, "--box", "0 0 100 0 0 0")
    result = gsp(*given)
    assert f"1 of them on the anchor lines of {FIRST.name}" in result.out
    assert "rms radius of the anchors); all at the same poses" in result.out


def test_units_are_converted_on_demand(gsp, tmp_path):
    design = press(tmp_path / "press.toml")
    design.scaled(1e-3).replace(unit="m", name="metres").write(tmp_path / "m.toml")
    line = gsp("rank", "press.toml", "m.toml", *FEW).error
    for words in ("'mm' (press) and 'm' (metres)", "in_unit(design, unit)", "--unit mm"):
        assert words in line
    assert gsp("rank", "press.toml", "m.toml", *FEW, "--unit", "mm", "--out", "r.csv").status == 0
    table = pd.read_csv(tmp_path / "r.csv")
    numbers = table.select_dtypes("number").drop(columns="rank")
    np.testing.assert_allclose(numbers.iloc[0], numbers.iloc[1], rtol=1e-9)
    assert "unknown unit of length 'parsec'" in gsp("rank", "press.toml", "--unit", "parsec").error


def test_feasible_poses_only(gsp, tmp_path):
    press(tmp_path / "press.toml")
    box = ("--box", "-8:8 -8:8 60:75 0:4 -7:-3 -7:-3")
    out = gsp("rank", "press.toml", *box, "--samples", 50, "--no-plot", "--out", "a.csv").out
    assert "within_strokes" in out
    gsp("rank", "press.toml", *box, "--samples", 50, "--no-plot", "--out", "b.csv", "--feasible")
    a, b = (pd.read_csv(tmp_path / f"{name}.csv").iloc[0] for name in "ab")
    assert 0.0 < a["within_strokes"] == b["within_strokes"] == b["feasible"] < 1.0
    assert a["control_number_mean"] != b["control_number_mean"]
    facts = json.loads((tmp_path / "b.csv.json").read_text())["columns"]
    assert facts["feasible"]["meaning"].startswith("share of feasible poses")


def test_columns_are_chosen(gsp, tmp_path):
    chosen = ("--columns", "rank,design,CTN,control_number_min")
    gsp("rank", *TWO, *FEW, "--out", "r.xlsx", *chosen)
    wanted = ["rank", "design", "control_number_mean", "control_number_min"]
    assert pd.read_excel(tmp_path / "r.xlsx").columns.tolist() == wanted
    gsp("rank", *TWO, *FEW, "--out", "r.tex")
    text = (tmp_path / "r.tex").read_text()
    assert r"$D_1^{6}$" in text
    assert r"$D_1^{3}\,D_2^{3}$" in text
    assert r"$\mathrm{CTN}$ mean" in text
    assert "q05" not in text
    assert "unknown column 'beauty'" in gsp("rank", *TWO, "--columns", "beauty").error


def test_an_interrupted_ranking_is_resumed(gsp, tmp_path, monkeypatch):
    """Ctrl-C after the first design: one line, status 130, and its row is kept."""
    from gsp.ranking import order

    real = order.row_of_design

    def one_row(request, asked, values):
        if list(tmp_path.glob("results/ranking.csv.parts/part-*")):
            raise KeyboardInterrupt
        return real(request, asked, values)

    monkeypatch.setattr(order, "row_of_design", one_row)
    result = gsp("rank", *TWO, *FEW, "--workers", 1)
    assert result.status == 130
    assert result.err.splitlines() == [
        "gsp: stopped; the rows of 1 designs are kept in results/ranking.csv.parts; "
        "--resume continues"
    ]
    monkeypatch.setattr(order, "row_of_design", real)
    beside = ("--out", "results/ranking.csv")
    for words in ((), ("--resume", "--seed", 1)):  # not resumed, and parts of another run
        refused = gsp("rank", *TWO, *FEW, *beside, *words)
        assert "ranking.csv.parts" in refused.error
        assert refused.out == ""
    assert "results/ranking-2.csv" in gsp("rank", *TWO, *FEW).out
    resumed = gsp("rank", *TWO, *FEW, "--resume")
    assert "Table      results/ranking.csv (2 rows)" in resumed.out
    one, two = ((tmp_path / f"results/ranking{n}.csv").read_bytes() for n in ("", "-2"))
    assert one == two
    assert not (tmp_path / "results/ranking.csv.parts").exists()
    monkeypatch.setattr(order, "row_of_design", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    result = gsp("rank", *TWO, *FEW, "--out", "x.csv")
    assert (result.status, result.err) == (130, "gsp: stopped; nothing was written\n")
    assert not list(tmp_path.glob("x.csv*"))


def test_a_name_is_free_if_no_file_has_it_and_no_other_run(tmp_path):
    (tmp_path / "a.png").touch()
    claims = [ranking_files.free_claim(tmp_path / "a.csv", picture=p) for p in (True, False, True)]
    assert [claim.folder.name for claim in claims] == [
        "a-2.csv.parts",
        "a.csv.parts",
        "a-3.csv.parts",
    ]
    for claim in claims:
        claim.release()
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_a_ranking_leaves_one_that_is_in_progress_alone(gsp, tmp_path):
    claim = Claim(tmp_path / "ranking.csv.parts")
    claim.begin("of another process")
    part = claim.folder / "part-00000000.json"
    part.write_text("{}")
    (tmp_path / "results").symlink_to(tmp_path)
    in_use = "results/ranking.csv.parts: another process or thread is writing there"
    for words in (["--resume"], *(["--out", "results/ranking.csv", *w] for w in ([], ["--force"]))):
        refused = gsp("rank", *TWO, *FEW, *words)
        assert in_use in refused.error
        assert refused.out == ""
    assert "results/ranking-2.csv" in gsp("rank", *TWO, *FEW).out
    assert part.read_text() == "{}"
    assert claim.record() == {"job": "of another process"}
    claim.release()  # as the end of its process does: the run was interrupted
    assert "those of another run" in gsp("rank", *TWO, *FEW, "--resume").error
    assert gsp("rank", *TWO, *FEW, "--out", "results/ranking.csv", "--force").status == 0
    assert not claim.folder.exists()


def test_poses_within_strokes_need_strokes(gsp):
    error = gsp("rank", "workspace-6-3", FIRST.name, "--feasible", "--samples", 4).error
    assert f"--feasible: expected strokes of each design, received none of '{FIRST.name}'" in error


def test_nothing_is_printed_or_made_before_an_error(gsp, tmp_path):
    for words in (
        (FIRST.name, "--feasible"),
        (FIRST.name, "--workers", 10**26),
        (*TWO, "--by", "CTN", "--indices", "CDN_CL"),
        (*TWO, "--box", "0 0 1"),
        (*TWO, "--columns", ""),
        (*TWO, "--columns", "beauty"),
        (FIRST.name, "--template", FIRST.name),
        (FIRST.name, "--seed", 10**26),
        (FIRST.name, "--box", "0:1e308 0 0 0 0 0"),
    ):
        result = gsp("rank", *words, "--samples", 4, "--no-plot")
        assert result.error
        assert result.out == ""
        assert list(tmp_path.iterdir()) == []


def test_platforms_in_one_point_are_ranked_without_an_ellipsoid(gsp, tmp_path):
    FIRST.replace(
        legs=["D2"] * 6,
        platform_points=np.zeros((6, 3)),
        base_directions=None,
        platform_directions=np.random.default_rng(0).normal(size=(6, 3)),
        name="joined",
    ).write(tmp_path / "d.toml")
    result = gsp("rank", "d.toml", *FEW, "--out", "r.csv")
    assert result.status == 0
    assert "condition_number_ellipsoid is left out: it needs --ellipsoid" in result.err
    assert "Ellipsoid  none" in result.out
    assert "control_number_mean" in pd.read_csv("r.csv")
    assert "ellipsoid" in gsp("rank", "d.toml", *FEW, "--indices", "CDN_OE").error
    given = gsp("rank", "d.toml", *FEW, "--indices", "CDN_OE", "--ellipsoid", 9, 9, 9)
    assert given.status == 0


def test_equal_names_and_missing_units_are_said(gsp, tmp_path):
    (tmp_path / "b").mkdir()
    FIRST.replace(name="press").write("press.toml")
    changes = {"name": "press", "unit": "", "characteristic_length": None}
    FIRST.scaled(1.1).replace(**changes).write("b/press.toml")
    result = gsp("rank", "press.toml", "b/press.toml", *FEW, "--out", "r.csv")
    assert "gsp: no unit of length in press (2): taken to be in mm" in result.err.splitlines()
    assert "gsp: design 2 has the name of another one: listed as press (2)" in result.err
    assert "Length     95 mm, none, as the designs record it" in result.out
    assert set(pd.read_csv("r.csv")["design"]) == {"press", "press (2)"}
    facts = json.loads((tmp_path / "r.csv.json").read_text())
    assert set(facts["sources"]) == {"press", "press (2)"}
    assert facts["unitless"] == ["press (2)"]
    one = gsp("rank", "press.toml", *FEW)
    assert one.err == ""


def test_a_column_chosen_twice_is_written_once(gsp):
    result = gsp("rank", *TWO, *FEW, "--out", "r.parquet", "--columns", "CTN,rank,CTN,rank")
    assert result.status == 0
    assert list(pd.read_parquet("r.parquet")) == ["control_number_mean", "rank"]


def test_too_many_poses_for_the_memory_are_one_line(gsp, monkeypatch):
    def sample(self, *arguments, **options):
        raise MemoryError("Unable to allocate 4.00 TiB\nfor an array")

    monkeypatch.setattr(library.PoseBox, "sample", sample)
    message = "gsp: not enough memory: Unable to allocate 4.00 TiB for an array"
    assert gsp("rank", *TWO, "--no-plot").error == message


def test_messages_name_options(gsp):
    error = gsp("rank", "nawratil-k-plus", "--by", "CDN_CL", "--samples", 4, "--no-plot").error
    assert "expected --length, received none" in error


def test_columns_of_indices_without_their_parameters_are_left_out(gsp, tmp_path):
    design = library.catalogue.design("lee-2000-3-3")
    design.write("bare.toml")
    words = (
        "bare.toml",
        "--samples",
        "20",
        "--columns",
        "rank,design,CTN,CDN_CL",
        "--out",
        "t.csv",
    )
    done = gsp("rank", *words)
    assert done.status == 0
    assert "columns left out: condition_number_mean: not among --indices, or without a" in done.err
    header = (tmp_path / "t.csv").read_text().splitlines()[0]
    assert header == "rank,design,control_number_mean"


def test_placements_are_ranked(gsp, tmp_path):
    out = gsp("rank", "D1^3 D2^3", "D4^3A1^3", *FEW, "--placements", "--out", "p.csv").out
    template = library.catalogue.design(library.catalogue.placement.TEMPLATE)
    designs = [
        design
        for name in ("D1^3 D2^3", "D4^3 A1^3")
        for design in library.catalogue.placements(library.catalogue.mechanism(name), template)
    ]
    assert (
        f"{len(designs)} designs ({len(designs)} placements of 2 mechanisms) on the anchor" in out
    )
    table = pd.read_csv(tmp_path / "p.csv")
    assert sorted(table["design"]) == sorted(design.name for design in designs)
    facts = json.loads((tmp_path / "p.csv.json").read_text())
    assert (facts["template"], facts["placements"]) == (template.name, "all distinct ones")
    one = gsp("rank", "D4^3A1^3", *FEW, "--placements", "--template", SECOND.name)
    assert "(10 placements of 1 mechanism)" in one.out  # 3 of 5 positions, no symmetry
    assert "not used" not in one.err


def test_placements_need_mechanisms(gsp):
    result = gsp("rank", FIRST.name, *FEW, "--placements")
    assert result.status == 2
    assert (
        "--placements: expected mechanisms, which are placed on a template, received designs only"
        in result.error
    )
