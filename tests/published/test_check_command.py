"""`gsp check` on the command line."""

import csv
import sys

import pytest

from gsp import published
from gsp.cli import main

MODULE = sys.modules["gsp.published.check"]
WRONG = """\
[[value]]
paper = "Nawratil"
place = "eq. (25)"
quantity = "k_plus"
arguments = { letter = "h" }
printed = "0.5"
verdict = "reproduced"
"""


def run(monkeypatch, *arguments):
    monkeypatch.setattr("sys.argv", ["gsp", "check", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        main()
    return ended.value.code or 0


def test_all_is_well(monkeypatch, capsys):
    assert run(monkeypatch) == 0
    out = capsys.readouterr().out
    assert "all verdicts hold" in out
    assert "eq. (24)" in out
    assert "36 agree" in out


@pytest.mark.parametrize("width", ["60", "100", "200"])
def test_proofs_are_there_at_any_width(monkeypatch, capsys, width):
    monkeypatch.setenv("COLUMNS", width)
    assert run(monkeypatch, "--paper", "TozKucuk2016") == 0
    assert "134 mm" in " ".join(capsys.readouterr().out.split())


def test_a_verdict_that_no_longer_holds(monkeypatch, capsys, tmp_path):
    (tmp_path / "wrong.toml").write_text(WRONG, encoding="utf-8")
    monkeypatch.setattr(MODULE, "record_files", lambda: (tmp_path / "wrong.toml",))
    assert run(monkeypatch) == 1
    out = capsys.readouterr().out
    assert "NO" in out
    assert "1 verdicts NO LONGER HOLD" in out


def test_a_damaged_file(monkeypatch, capsys, tmp_path):
    (tmp_path / "bad.toml").write_text(WRONG.replace("verdict", "verdikt"), encoding="utf-8")
    monkeypatch.setattr(MODULE, "record_files", lambda: (tmp_path / "bad.toml",))
    assert run(monkeypatch) == 2
    error = capsys.readouterr().err
    assert error.startswith("gsp: ")
    assert "bad.toml, line 7, record 1, key 'verdikt'" in error
    assert "Traceback" not in error
    assert len(error.strip().splitlines()) == 1


def test_an_unknown_paper(monkeypatch, capsys):
    assert run(monkeypatch, "--paper", "Nawratill") == 2
    assert "Nawratil" in capsys.readouterr().err


def test_every_entry_to_csv(monkeypatch, tmp_path):
    out = tmp_path / "numbers.csv"
    assert run(monkeypatch, "--all", "--out", out) == 0
    rows = list(csv.DictReader(out.read_text(encoding="utf-8").splitlines()))
    assert len(rows) == len(published.check())
    assert {row["holds"] for row in rows} == {"True"}


def test_to_markdown_and_errata(monkeypatch, tmp_path):
    out, page = tmp_path / "numbers.md", tmp_path / "errata.md"
    assert run(monkeypatch, "--paper", "Nawratil", "--out", out, "--errata", page) == 0
    assert len(out.read_text(encoding="utf-8").splitlines()) == 2 + len(
        published.select("Nawratil")
    )
    assert page.read_text(encoding="utf-8").startswith("# Errata")


def test_outputs_are_not_overwritten_unasked(monkeypatch, capsys, tmp_path):
    out = tmp_path / "numbers.csv"
    out.write_text("mine", encoding="utf-8")
    assert run(monkeypatch, "--out", out) == 2
    assert out.read_text(encoding="utf-8") == "mine"
    assert run(monkeypatch, "--out", out, "--overwrite", "--paper", "Nawratil") == 0
    assert out.read_text(encoding="utf-8") != "mine"
    assert run(monkeypatch, "--out", tmp_path / "numbers.xlsx") == 2
    assert ".csv or .md" in capsys.readouterr().err
