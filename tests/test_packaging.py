"""The wheel and the sdist: built here, installed into an empty environment, used away from here."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from packaging.version import Version

from gsp.files.knowledge import knowledge
from gsp.version import __version__

ROOT = Path(__file__).parents[1]
# The dependencies come from this environment; gsp itself must come from the wheel.
DEPENDENCIES = ("numpy", "scipy", "pinocchio", "networkx", "pandas", "typer", "rich", "matplotlib")

# How often the compiled function was found on disk, and how often it was not.
COMPILED = """
from gsp.kernels.compiled.evaluation import evaluate_block as f
print(sum(f.stats.cache_hits.values()), sum(f.stats.cache_misses.values()))
"""


def run(*command: object, cwd: Path, **environment: str) -> str:
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "COVERAGE"))}
    done = subprocess.run(
        [str(c) for c in command],
        cwd=cwd,
        env={**clean, **environment},
        timeout=300,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def dist(tmp_path_factory) -> Path:
    """Build the sdist, and the wheel from the sdist."""
    out = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "build", "--no-isolation", "--outdir", out, ROOT, cwd=out)
    return out


@pytest.fixture(scope="module")
def elsewhere(dist, tmp_path_factory) -> Path:
    """Install the wheel into an empty environment, and return its python."""
    home = tmp_path_factory.mktemp("empty")
    run(sys.executable, "-m", "venv", "--without-pip", home / "venv", cwd=home)
    python = home / "venv/bin/python"
    wheel = next(dist.glob("*.whl"))
    install = ("install", "--quiet", "--no-index", "--no-deps", wheel)
    run(sys.executable, "-m", "pip", "--python", python, *install, cwd=home)
    folders = {str(Path(importlib.util.find_spec(n).origin).parents[1]) for n in DEPENDENCIES}
    site = next((home / "venv/lib").glob("python*/site-packages"))
    (site / "dependencies.pth").write_text("\n".join(sorted(folders)) + "\n")
    return python


def test_a_checkout_reads_its_own_data():
    """Also after an editable install, which leaves a copy of the data in site-packages."""
    assert knowledge("catalogue") == ROOT / "catalogue"
    assert knowledge("indices") == ROOT / "indices"


def test_wheel_carries_code_and_data(dist):
    names = set(zipfile.ZipFile(next(dist.glob("*.whl"))).namelist())
    kinds = ("*.py", "*.js", "*.css")  # the page of the browser tool has scripts and styles
    code = {p.relative_to(ROOT).as_posix() for kind in kinds for p in (ROOT / "gsp").rglob(kind)}
    data = {
        f"gsp/data/{p.relative_to(ROOT).as_posix()}"
        for folder in ("catalogue", "indices")
        for p in (ROOT / folder).rglob("*")
        if p.is_file()
    }
    assert code <= names
    assert data <= names
    assert "gsp/py.typed" in names
    assert {name.split("/")[0] for name in names} <= {"gsp"} | {
        name.split("/")[0] for name in names if ".dist-info/" in name
    }


@pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")
def test_make_help_lists_the_targets_and_rank_is_the_default():
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = re.search(r"^\.PHONY: (.*)$", text, re.MULTILINE).group(1).split()
    lines = run("make", "--no-print-directory", "help", cwd=ROOT).splitlines()
    # A target, and what it does.
    assert all(re.fullmatch(r"make [a-z-]+ +\S.*", line) for line in lines)
    assert sorted(line.split()[1] for line in lines) == sorted(targets)
    assert re.search(r"^([\w-]+):", text, re.MULTILINE).group(1) == "rank"


def test_sdist_carries_what_the_wheel_is_built_from(dist):
    names = {
        name.split("/", 1)[1]
        for name in tarfile.open(next(dist.glob("*.tar.gz"))).getnames()
        if "/" in name
    }
    for path in ("pyproject.toml", "README.md", "LICENSE", "Makefile", "catalogue/mechanisms.csv"):
        assert path in names
    assert any(name.startswith("indices/published/") for name in names)
    assert not any(name.startswith((".venv", "results")) for name in names)


def test_ranking_away_from_the_checkout(elsewhere, tmp_path):
    place = run(elsewhere, "-c", "import gsp; print(gsp.__file__)", cwd=tmp_path)
    assert Path(place.strip()).is_relative_to(elsewhere.parents[1])
    out = run(elsewhere.parent / "gsp", "rank", "--samples", 20, "--no-plot", cwd=tmp_path)
    assert "195 designs" in out
    table = (tmp_path / "results/ranking.csv").read_text().splitlines()
    assert len(table) == 196
    # What was compiled is kept on disk: the next process compiles nothing.
    again = run(elsewhere, "-c", COMPILED, cwd=tmp_path)
    assert again.split() == ["1", "0"]


def test_published_data_away_from_the_checkout(elsewhere, tmp_path):
    code = "from gsp.files.knowledge import knowledge; print(*knowledge().rglob('*.toml'))"
    found = {Path(p).name for p in run(elsewhere, "-c", code, cwd=tmp_path).split()}
    folders = (ROOT / "catalogue", ROOT / "indices")
    assert found == {path.name for folder in folders for path in folder.rglob("*.toml")}
    out = run(elsewhere.parent / "gsp", "check", "--paper", "TozKucuk2016", cwd=tmp_path)
    assert "all verdicts hold" in out


def test_versions_agree():
    """CITATION.cff has the last release of the CHANGELOG; the code has that or the next."""
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    date = re.search(r"^date-released: (\S+)$", citation, re.MULTILINE)[1]
    version = re.search(r"^version: (\S+)$", citation, re.MULTILINE)[1]
    last = re.search(r"^## \[(\d\S+)\] - (\S+)$", changes, re.MULTILINE)
    assert last.groups() == (version, date)
    if "\n## [Unreleased]\n" in changes:
        assert Version(__version__).is_devrelease
        assert Version(__version__) > Version(version)
    else:
        assert __version__ == version


def test_the_changelog_has_each_heading_once():
    """In the section Unreleased; a conflict that keeps both sides repeats them."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    section = text.partition("## [Unreleased]")[2].partition("\n## [")[0]
    headings = re.findall(r"^### .*", section, re.MULTILINE)
    assert len(headings) == len(set(headings))


def repeated_sentences(text):
    """Sentences and items of a list that occur twice, whatever their lines; short ones may."""
    parts = re.split(r"(?<=[.:;])\s+|\n- |\n\n", text)
    sentences = [" ".join(part.split()).removeprefix("- ") for part in parts]
    return {s for s in sentences if len(s) > 25 and sentences.count(s) > 1}


def test_the_changelog_has_each_sentence_once():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert repeated_sentences(text) == set()
    entry = "- " + text.partition("\n- ")[2].partition("\n- ")[0]
    assert repeated_sentences(f"{text}\n{entry}\n") != set()


def test_conda_installs_the_same_versions():
    """environment.yml has each dependency of pyproject.toml with its lower bound."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    wanted = {*project["dependencies"], *extras["plots"], *extras["tables"]}
    conda = re.findall(r"^  - (\S+) (>=\S+)$", (ROOT / "environment.yml").read_text(), re.MULTILINE)
    names = {"pinocchio": "pin", "matplotlib-base": "matplotlib"}
    found = {names.get(name, name) + bound for name, bound in conda}
    assert {text.partition(";")[0].strip() for text in wanted} <= found
    assert f"python{project['requires-python']}" in found


def test_lowest_versions_are_the_bounds():
    """The constraints of `make matrix` pin each lower bound; another pin has a comment above."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    extras = project["project"]["optional-dependencies"]
    wanted = list(project["project"]["dependencies"])
    used = ("plots", "shapes", "tables", "app", "verify")
    wanted += [text for name in used for text in extras[name]]
    pins = (ROOT / "tests" / "lowest.txt").read_text(encoding="utf-8")
    stated = dict(re.findall(r"^([\w-]+)==(\S+)$", pins, re.MULTILINE))
    bounds = dict(re.match(r"([\w-]+)[^>]*>=([\d.]+)", text).groups() for text in wanted)
    lines = pins.splitlines()
    others = [f"{name}=={stated[name]}" for name in stated.keys() - bounds.keys()]
    assert set(bounds) <= set(stated)
    assert all(lines[lines.index(pin) - 1].startswith("#") for pin in others)
    for name, bound in bounds.items():
        pinned = stated[name].split(".")
        assert pinned[: len(bound.split("."))] == bound.split("."), name
