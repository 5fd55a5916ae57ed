"""Every notebook runs from top to bottom and shows its figures; it is committed without outputs."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

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


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """Environment of kernels: this checkout, short forms, warnings are errors in the library."""
    with pytest.MonkeyPatch.context() as patch:
        path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
        patch.setenv("PYTHONPATH", path)
        patch.setenv("IPYTHONDIR", str(tmp_path_factory.mktemp("ipython")))
        patch.setenv("PYTHONWARNINGS", "error:::gsp")
        patch.setenv("GSP_NOTEBOOKS", "short")
        # The kernel chooses the backend, as in Jupyter.
        patch.delenv("MPLBACKEND", raising=False)
        yield


@contextmanager
def started() -> Iterator[NotebookClient]:
    """Start a real kernel, in which figures are counted."""
    notebook = nbformat.v4.new_notebook()
    client = NotebookClient(notebook, timeout=SECONDS, kernel_name="python3")
    with client.setup_kernel():
        execute(client, [COUNTER])
        yield client


@pytest.fixture(scope="module")
def shared(environment):
    """One kernel for the notebooks, as to start one takes longer than most of them."""
    with started() as client:
        yield client


@pytest.fixture
def own(environment):
    """A new kernel."""
    with started() as client:
        yield client


def execute(client: NotebookClient, sources: list[str]) -> list[Any]:
    """Return executed cells."""
    cells = [nbformat.v4.new_code_cell(source) for source in sources]
    client.nb = nbformat.v4.new_notebook(cells=cells)
    client.reset_execution_trackers()
    return [client.execute_cell(cell, i) for i, cell in enumerate(cells)]


def counted(client: NotebookClient, sources: list[str], folder: Path) -> list[tuple[int, int]]:
    """Return the numbers of figures that each cell made and showed, in an empty folder.

    Without a name, figure or folder of what ran before in the kernel.
    """
    execute(client, [RESET, f"import os\nos.chdir({str(folder)!r})\ndel os"])
    cells = execute(client, [text for source in sources for text in (source, "_figures_made()")])
    return [
        (int(count.outputs[0]["data"]["text/plain"]), images(cell))
        for cell, count in zip(cells[::2], cells[1::2], strict=True)
    ]


RESET = "%reset -f"
# Counts the figures that each cell makes, without an import of pyplot: who imports that first
# decides when the backend of the kernel is set.
COUNTER = """
def _count():
    import builtins

    from matplotlib.figure import Figure

    numbers, original = [0], Figure.__init__

    def counting(self, *arguments, **options):
        numbers[-1] += 1
        original(self, *arguments, **options)

    def made():
        numbers.append(0)
        return numbers[-2]

    Figure.__init__, builtins._figures_made = counting, made


_count()
"""


def images(cell) -> int:
    """Return how many pictures and films are shown."""
    shown = [output.get("data", {}) for output in cell.outputs]
    return sum("image/png" in data or "<img" in data.get("text/html", "") for data in shown)


def code(path) -> list[str]:
    return [c.source for c in nbformat.read(path, as_version=4).cells if c.cell_type == "code"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs_and_shows_every_figure(path, shared, tmp_path):
    sources = code(path)
    counts = counted(shared, sources, tmp_path)
    for source, (made, shown) in zip(sources, counts, strict=True):
        assert shown == made, source
    assert any(made for made, _ in counts) == any(
        "plots" in text or "plt" in text for text in sources
    )


def test_figures_of_the_user_are_shown_and_styled_as_before(own, tmp_path):
    """The first figure of the session is one of the library; the user's own follow."""
    counts = counted(
        own,
        [
            "import matplotlib as mpl\nimport gsp\nbefore = dict(mpl.rcParams)",
            "gsp.plots.mechanism(gsp.catalogue.design('toz-kucuk-2016-d3-6'));",
            "import matplotlib.pyplot as plt\nplt.plot([1, 2]);",
            "gsp.plots.contours([[0, 1], [1, 2]], [0, 1], [0, 1]);",
            "plt.plot([1, 2]);",
            "changed = {k for k in before if mpl.rcParams[k] != before[k]}\n"
            "assert changed <= {'backend', 'interactive'}, changed",
        ],
        tmp_path,
    )
    assert counts == [(0, 0), (1, 1), (1, 1), (1, 1), (1, 1), (0, 0)]


def test_a_figure_that_is_the_value_of_a_cell_is_shown_once(shared, tmp_path):
    counts = counted(
        shared,
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
        ],
        tmp_path,
    )
    made = [0, 1, 1, 0, 1, 1, 2, 0, 1, 1]
    shown = [0, 1, 1, 1, 1, 1, 2, 0, 1, 1]
    assert counts == list(zip(made, shown, strict=True))
