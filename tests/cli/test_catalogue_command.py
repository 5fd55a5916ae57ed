"""`gsp catalogue`: the lists, their filters, and the generated files."""

from __future__ import annotations

import pandas as pd
import pytest

import gsp as library
from gsp.catalogue import pages
from gsp.files.knowledge import knowledge


def test_all_mechanisms(gsp):
    out = gsp("catalogue").out
    for mechanism in library.catalogue.mechanisms():
        assert mechanism.name in out
    assert "195 of 195 mechanisms" in out


@pytest.mark.parametrize(
    ("arguments", "number"),
    [
        (["--class", "6D"], 84),
        (["--class", "3d3a", "--class", "4D2A"], 55),
        (["--symmetric"], 4),
        (["--constraint", "D1", "--constraint", "A1"], 35 + 20 + 10),
        (["--class", "3D3A", "--constraint", "D2"], 10),
    ],
)
def test_filters(gsp, tmp_path, arguments, number):
    """Multisets of k with one (two) kinds given: those of k − 1 (k − 2) of all kinds."""
    result = gsp("catalogue", *arguments, "--out", "c.csv")
    assert f"{number} of 195" in result.out
    assert len(pd.read_csv(tmp_path / "c.csv")) == number


def test_designs(gsp, tmp_path):
    out = gsp("catalogue", "--designs", "--out", "d.csv").out
    table = pd.read_csv(tmp_path / "d.csv")
    assert tuple(table["name"]) == library.catalogue.design_names()
    drives = table.set_index("name")["drives"].dropna().to_dict()
    assert drives == {"lane-modified-paradex": "6 sliders", "lane-rotary": "6 cranks"}
    assert "6 cranks" in next(line for line in out.splitlines() if line.startswith("lane-rotary"))
    assert all(name in out for name in table["name"])


def test_out_is_the_whole_table(gsp, tmp_path):
    gsp("catalogue", "--out", "c.csv")
    pd.testing.assert_frame_equal(
        pd.read_csv(tmp_path / "c.csv"), library.catalogue.table(), check_dtype=False
    )
    assert "exists already" in gsp("catalogue", "--out", "c.csv").error
    assert gsp("catalogue", "--out", "c.csv", "--force").status == 0


def test_bad_filters(gsp):
    assert "Known: 6D, 5D1A, 4D2A, 3D3A" in gsp("catalogue", "--class", "7D").error
    assert "unknown constraint 'D5'" in gsp("catalogue", "--constraint", "D5").error
    assert "a name ending in" in gsp("catalogue", "--out", "c.doc").error


def test_generated_files_are_up_to_date():
    assert pages.stale(knowledge()) == [], "run: gsp catalogue --write"


def test_stale_files_are_found_and_written(tmp_path):
    assert pages.write(tmp_path / "") == [pages.CSV, pages.PAGE]
    assert pages.stale(tmp_path) == []
    page = tmp_path / pages.PAGE
    page.write_text(page.read_text().replace("D1^6", "D1^7"))
    assert pages.stale(tmp_path) == [pages.PAGE]
    (tmp_path / pages.CSV).unlink()
    assert pages.write(tmp_path) == [pages.CSV, pages.PAGE]


def test_check_and_write_commands(gsp, tmp_path, monkeypatch):
    monkeypatch.setattr("gsp.cli.library.catalogue.knowledge", lambda: tmp_path)
    assert "expected a checkout" in gsp("catalogue", "--check").error
    (tmp_path / "pyproject.toml").touch()
    result = gsp("catalogue", "--check")
    assert (result.status, "mechanisms.csv" in result.out) == (1, True)
    assert gsp("catalogue", "--write").status == 0
    assert gsp("catalogue", "--check").status == 0


def test_page_counts_the_catalogue():
    text = pages.generated()[pages.PAGE]
    for mechanism in library.catalogue.mechanisms():
        assert f"| {mechanism.name} " in text
    for name in library.catalogue.design_names():
        assert f"`{name}`" in text
    assert text.count("(symmetric)") == 4
