"""Every notebook runs from top to bottom and shows its figures; it is committed without outputs."""

from __future__ import annotations

import os
import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
SECONDS = 300


def test_notebooks_are_numbered_in_order():
    assert NOTEBOOKS
    numbers = [f"{number:02d}-" for number in range(1, len(NOTEBOOKS) + 1)]
    assert [path.name[:3] for path in NOTEBOOKS] == numbers


@pytest.mark.parametrize("folder", ["docs", "indices", "gsp"])
def test_notebooks_that_are_named_exist(folder):
    named = re.compile(r"notebooks/(\d\d-[\w-]+\.ipynb)")
    pages = [p for p in (ROOT / folder).rglob("*") if p.suffix in (".md", ".toml", ".py")]
    for path in pages:
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"notebook \d", text), f"{path.name}: a number without a name"
        assert set(named.findall(text)) <= {notebook.name for notebook in NOTEBOOKS}, path.name


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_is_committed_without_outputs(path):
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "code":
            assert cell.outputs == []
            assert cell.execution_count is None


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Return a function that runs cells in a real kernel and counts figures made and shown.

    In an empty folder, with this checkout and with warnings as errors in the library.
    """
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("PYTHONWARNINGS", "error:::gsp")
    # The kernel chooses the backend, as in Jupyter.
    monkeypatch.delenv("MPLBACKEND", raising=False)

    def counted(sources: list[str]) -> list[tuple[int, int]]:
        cells = [nbformat.v4.new_code_cell(COUNTER)]
        for source in sources:
            cells += [nbformat.v4.new_code_cell(text) for text in (source, "_figures_made()")]
        notebook = nbformat.v4.new_notebook(cells=cells)
        NotebookClient(
            notebook,
            timeout=SECONDS,
            kernel_name="python3",
            resources={"metadata": {"path": tmp_path}},
        ).execute()
        return [
            (int(count.outputs[0]["data"]["text/plain"]), images(cell))
            for cell, count in zip(notebook.cells[1::2], notebook.cells[2::2], strict=True)
        ]

    return counted


# Counts the figures that each cell makes, without an import of pyplot: who imports that first
# decides when the backend of the kernel is set.
COUNTER = """
from matplotlib.figure import Figure as _Figure

_numbers, _original = [0], _Figure.__init__


def _counting(self, *arguments, **options):
    _numbers[-1] += 1
    _original(self, *arguments, **options)


_Figure.__init__ = _counting


def _figures_made():
    _numbers.append(0)
    return _numbers[-2]
"""


def images(cell) -> int:
    return sum("image/png" in output.get("data", {}) for output in cell.outputs)


def code(path) -> list[str]:
    return [c.source for c in nbformat.read(path, as_version=4).cells if c.cell_type == "code"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs_and_shows_every_figure(path, run):
    sources = code(path)
    counts = run(sources)
    for source, (made, shown) in zip(sources, counts, strict=True):
        assert shown == made, source
    assert any(made for made, _ in counts) == any(
        "plots" in text or "plt" in text for text in sources
    )


def test_figures_of_the_user_are_shown_and_styled_as_before(run):
    """The first figure of the session is one of the library; the user's own follow."""
    counts = run(
        [
            "import matplotlib as mpl\nimport gsp\nbefore = dict(mpl.rcParams)",
            "gsp.plots.mechanism(gsp.catalogue.design('toz-kucuk-2016-d3-6'));",
            "import matplotlib.pyplot as plt\nplt.plot([1, 2]);",
            "gsp.plots.contours([[0, 1], [1, 2]], [0, 1], [0, 1]);",
            "plt.plot([1, 2]);",
            "changed = {k for k in before if mpl.rcParams[k] != before[k]}\n"
            "assert changed <= {'backend', 'interactive'}, changed",
        ]
    )
    assert counts == [(0, 0), (1, 1), (1, 1), (1, 1), (1, 1), (0, 0)]


def test_a_figure_that_is_the_value_of_a_cell_is_shown_once(run):
    counts = run(
        [
            "import gsp\nimport matplotlib.pyplot as plt\n"
            "home = gsp.Pose([0, 0, 1])\ndesign = gsp.families.lee.octahedral_3_3(1.0, 2.0)\n"
            "table = gsp.sweep(design, gsp.sweeps.turn(home, 'z', range(-30, 31, 20)), ['CTN'])",
            "gsp.plots.sweep(table)",
            "figure = gsp.plots.sweep(table)",
            "figure",
            "gsp.plots.sweep(table);",
            "gsp.plots.along(table, 'CTN')",
            "plt.plot([1, 2])\ngsp.plots.sweep(table)",
            "designs = [design, design.replace(name='b')]\n"
            "poses = gsp.PoseBox.around(home, [0.1] * 6).sample(20, rng=1)\n"
            "ranks = gsp.rank(designs, poses, ['CTN', '|det J|'], progress=False)",
            "gsp.plots.ranking(ranks)",
            "gsp.plots.ranking(ranks);",
        ]
    )
    made = [0, 1, 1, 0, 1, 1, 2, 0, 1, 1]
    shown = [0, 1, 1, 1, 1, 1, 2, 0, 1, 1]
    assert counts == list(zip(made, shown, strict=True))
