"""Tables as files, with their metadata."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest

from gsp import catalogue
from gsp.determinant.store import Store
from gsp.errors import GspError, MissingSoftware, UnwritableOutput
from gsp.files.tables import FORMATS, check_table, sidecar, write_table
from gsp.limits import Limits
from gsp.version import __version__

FRAME = pd.DataFrame(
    {"name": ["D1^6", "a & b"], "value": [1.0 / 3.0, np.inf], "none": [np.nan] * 2}
)


@pytest.mark.parametrize(("suffix", "read"), [(".csv", pd.read_csv), (".parquet", pd.read_parquet)])
def test_numbers_come_back_bit_by_bit(tmp_path, suffix, read):
    path = tmp_path / f"t{suffix}"
    write_table(FRAME, path)
    pd.testing.assert_frame_equal(read(path), FRAME, check_exact=True, check_dtype=False)


def test_markdown_and_latex(tmp_path):
    for suffix in (".md", ".tex"):
        write_table(FRAME, tmp_path / f"t{suffix}")
    assert (tmp_path / "t.md").read_text().splitlines()[0].startswith("| name")
    latex = (tmp_path / "t.tex").read_text()
    assert r"a \& b" in latex
    assert r"\toprule" in latex
    assert "0.333333" in latex


def test_numbers_that_are_not_finite_in_latex(tmp_path):
    frame = FRAME.assign(low=[-np.inf, 2], mixed=[1.5, "a_b"], count=[3, 4], also=[np.nan, True])
    write_table(frame, tmp_path / "t.tex", headings={"value": "$x$ [mm$^{2}$]", "count": "#"})
    lines = (tmp_path / "t.tex").read_text().splitlines()
    assert lines[0] == r"\begin{tabular}{lrrrlrl}"
    assert lines[2] == r"name & $x$ [mm$^{2}$] & none & low & mixed & # & also \\"
    assert lines[4] == r"$D_1^{6}$ & 0.3333333 & -- & $-\infty$ & 1.5 & 3 & -- \\"
    assert lines[5] == r"a \& b & $\infty$ & -- & 2 & a\_b & 4 & True \\"


def test_columns_of_one_name_in_latex(tmp_path):
    """Two columns may have one heading."""
    frame = pd.DataFrame({"a": [1.0], "b": [2]})
    write_table(frame, tmp_path / "t.tex", headings={"a": "x", "b": "x"})
    assert r"x & x \\" in (tmp_path / "t.tex").read_text()


def test_metadata(tmp_path):
    path = tmp_path / "t.csv"
    write_table(FRAME, path, {"unit": "mm"})
    facts = json.loads(sidecar(path).read_text())
    assert facts == {"library": f"gsp {__version__}", "unit": "mm"}
    assert sidecar(path).name == "t.csv.json"


def test_the_metadata_are_beside_the_file_to_which_a_link_leads(tmp_path):
    """Those that are there are of the table that is replaced."""
    link, file = tmp_path / "link.csv", tmp_path / "elsewhere" / "t.csv"
    file.parent.mkdir()
    write_table(FRAME, file, {"unit": "mm"})
    link.symlink_to(file)
    write_table(FRAME, link, {"unit": "m"}, overwrite=True)
    assert json.loads(sidecar(file).read_text())["unit"] == "m"
    assert sidecar(link) == sidecar(file)
    assert sorted(p.name for p in tmp_path.rglob("*")) == [
        "elsewhere",
        "link.csv",
        "t.csv",
        "t.csv.json",
    ]


@pytest.mark.parametrize("name", ["t.csv", "t.csv.json"])
def test_nothing_is_overwritten(tmp_path, name):
    (tmp_path / name).write_text("precious")
    with pytest.raises(UnwritableOutput, match="exists already"):
        write_table(FRAME, tmp_path / "t.csv")
    assert [p.name for p in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "precious"
    write_table(FRAME, tmp_path / "t.csv", overwrite=True)
    assert len(pd.read_csv(tmp_path / "t.csv")) == 2


def test_unknown_suffix_and_missing_software(tmp_path, monkeypatch):
    with pytest.raises(UnwritableOutput, match=r"\.csv, \.parquet, \.xlsx, \.md, \.tex"):
        check_table(tmp_path / "t.xls")
    monkeypatch.setattr("gsp.installed.is_installed", lambda package: False)
    check_table(tmp_path / "t.csv")
    for form in FORMATS.values():
        if form.package:
            with pytest.raises(MissingSoftware, match=form.package):
                check_table(tmp_path / f"t{form.suffix}")


def test_unusual_texts_and_small_numbers_are_kept_in_every_format(tmp_path):
    frame = pd.DataFrame({"design": ["=1+1", "a | b"], "x": [5.4e-21, 2.0]})
    for suffix in (".xlsx", ".md", ".tex"):
        write_table(frame, tmp_path / f"t{suffix}", columns=["design", "x", "design"])
    read = pd.read_excel(tmp_path / "t.xlsx")
    assert read["design"].tolist() == ["=1+1", "a | b"]
    assert read["x"].tolist() == [5.4e-21, 2.0]
    assert r"a \| b" in (tmp_path / "t.md").read_text(encoding="utf-8")
    assert "5.4e-21" in (tmp_path / "t.tex").read_text(encoding="utf-8")


HIDDEN = ["a\x1b[31m", "\x00", "a\u200bb", "\u202egpj", "a\ufeff", "a\u2066b", "a\xadb", "a\u2028b"]


@pytest.mark.parametrize("name", ["a\nb", "a\tb", *HIDDEN])
def test_names_of_designs_hold_no_control_characters(name):
    design = catalogue.design("toz-kucuk-2016-d3-6")
    with pytest.raises(GspError, match="control characters"):
        design.replace(name=name)


@pytest.mark.parametrize("text", HIDDEN)
def test_no_text_holds_hidden_characters(text):
    design = catalogue.design("toz-kucuk-2016-d3-6")
    for given in ({"source": text}, {"unit": text}):
        with pytest.raises(GspError, match="control characters"):
            design.replace(**given)
    with pytest.raises(GspError, match="control characters"):
        Limits(indices=[text])
    with pytest.raises(GspError, match="control characters"):
        Store(text)
    assert design.replace(source="two\nlines").source == "two\nlines"
    assert design.replace(name="größer λ °").name == "größer λ °"
