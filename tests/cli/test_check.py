"""`gsp check`: every verdict is printed, broken ones and damaged files are reported."""

from __future__ import annotations

from functools import cache

import pandas as pd
import pytest

from gsp import published

checked = cache(published.check)
WRONG = """\
[[value]]
paper = "Nawratil"
place = "eq. (25)"
quantity = "k_plus"
arguments = { letter = "h" }
printed = "0.5"
verdict = "reproduced"
"""


@pytest.fixture
def records(monkeypatch, tmp_path):
    """Put one file of records in the place of all."""

    def use(text):
        path = tmp_path / "records.toml"
        path.write_text(text, encoding="utf-8")
        monkeypatch.setattr("gsp.published.checking.record_files", lambda: (path,))

    return use


@pytest.fixture
def once(monkeypatch):
    """Check a paper once for all tests that only differ in how the result is written."""
    monkeypatch.setattr(published, "check", lambda papers: checked(*papers).copy())


def test_all_verdicts_hold(gsp):
    """One paper here; all of them are checked in tests/published."""
    result = gsp("check", "--paper", "TozKucuk2016")
    assert result.status == 0
    assert "all verdicts hold" in result.out
    assert "36 agree" in result.out
    assert result.err == ""


@pytest.mark.parametrize("width", ["60", "100", "200"])
@pytest.mark.usefixtures("once")
def test_proofs_are_there_at_any_width(gsp, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", width)
    result = gsp("check", "--paper", "TozKucuk2016")
    assert result.status == 0
    assert "94.339 mm" in " ".join(result.out.split())


def test_a_verdict_that_no_longer_holds(gsp, records):
    records(WRONG)
    result = gsp("check")
    assert result.status == 1
    assert "1 record, 1 printed number: 1 verdict NO LONGER HOLDS (records.toml:1)" in result.out


def test_a_missing_design_file_has_the_status_of_a_damaged_one(gsp, records):
    records(WRONG.replace("k_plus", "home").replace('letter = "h"', 'design = "lost"'))
    result = gsp("check")
    assert result.status == 1
    assert "Not computed: records.toml" in result.out
    assert "a file in catalogue/designs, received none of the name 'lost'" in result.out


def test_a_damaged_file(gsp, records):
    records(WRONG.replace("verdict", "verdikt"))
    assert "records.toml, line 7, record 1, key 'verdikt'" in gsp("check").error


def test_an_unknown_paper(gsp):
    assert "nearest: Nawratil" in gsp("check", "--paper", "Nawratill").error


@pytest.mark.usefixtures("once")
@pytest.mark.usefixtures("once")
def test_every_entry_to_csv(gsp, tmp_path):
    assert gsp("check", "--paper", "Nawratil", "--all", "--out", "numbers.csv").status == 0
    table = pd.read_csv(tmp_path / "numbers.csv")
    assert len(table) == len(checked("Nawratil"))
    assert table["holds"].all()


@pytest.mark.parametrize("name", ["numbers.parquet", "numbers.md", "numbers.tex"])
@pytest.mark.usefixtures("once")
def test_one_line_a_record_to_other_formats(gsp, tmp_path, name):
    assert gsp("check", "--paper", "Nawratil", "--out", name).status == 0
    if name.endswith("parquet"):
        assert len(pd.read_parquet(tmp_path / name)) == len(published.select("Nawratil"))
    assert (tmp_path / name).stat().st_size > 1000


def test_the_page_of_errata(gsp, records, tmp_path):
    records(WRONG.replace('"0.5"', '"0.393"'))
    assert gsp("check", "--errata", "errata.md").status == 0
    page = (tmp_path / "errata.md").read_text(encoding="utf-8")
    assert page == published.errata(published.select(), published.select_slips())


@pytest.mark.usefixtures("once")
def test_outputs_are_not_overwritten_by_default(gsp, tmp_path):
    for option, name in (("--out", "numbers.csv"), ("--errata", "errata.md")):
        path = tmp_path / name
        path.write_text("mine", encoding="utf-8")
        assert name in gsp("check", "--paper", "Nawratil", option, name).error
        assert path.read_text(encoding="utf-8") == "mine"
        assert gsp("check", "--paper", "Nawratil", option, name, "--force").status == 0
        assert path.read_text(encoding="utf-8") != "mine"


def test_two_outputs_of_one_name_are_an_error_before_the_work(gsp, tmp_path):
    error = gsp("check", "--errata", "a.md", "--out", tmp_path / "a.md").error
    assert "--errata: expected another file than --out" in error


def test_an_output_of_an_unknown_format(gsp):
    assert ".csv" in gsp("check", "--out", "numbers.ods").error
