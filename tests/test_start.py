"""What is imported when: the first use of each part loads what it needs and no more.

No times here; `make bench` measures them, and docs/performance.md has the table.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import gsp

ROOT = Path(__file__).parents[1]
HEAVY = (
    "scipy", "pandas", "networkx", "numba", "sqlalchemy", "pinocchio", "matplotlib", "mujoco",
    "pyarrow", "dask", "nicegui", "rich", "typer",
)  # fmt: skip
# Packages of which a part needs these while it is imported; pandas imports pyarrow if it is there.
TABLES = {"scipy", "pandas", "pyarrow"}
NEEDS = {"published": TABLES, "plots": TABLES}


def loaded(*statements: str) -> list[set[str]]:
    """Heavy packages that are loaded after each of the statements, in one new process."""
    report = f"print(*(m for m in {HEAVY!r} if m in sys.modules))"
    code = "\n".join(["import sys", *(f"{s}\n{report}" for s in statements)])
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert done.returncode == 0, done.stderr
    return [set(line.split()) for line in done.stdout.split("\n")[:-1]]


def test_designs_poses_and_the_catalogue_need_numpy_only():
    design = "gsp.Design(['D1'] * 6, [[1, 2, 0]] * 6, [[2, 1, 0]] * 6)"
    statements = (
        "import gsp",
        "gsp.Design; gsp.Pose; gsp.Mechanism; gsp.Posture; gsp.Limits; gsp.Ellipsoid",
        f"design = {design}",
        "posture = design.at(gsp.Pose([0, 0, 1])); posture.joints; posture.jacobian",
        "gsp.indices.condition_number(posture, 1.0)",
        "gsp.catalogue.mechanisms(); gsp.catalogue.mechanism('D1^6')",
    )
    read = "gsp.catalogue.design('toz-kucuk-2016-d3-6')"
    *bare, with_pose = loaded(*statements, read)
    assert bare == [set()] * len(statements)
    assert with_pose <= {"scipy"}  # for the rotation of its pose


def test_packages_are_light_until_they_are_used():
    """All that need none of the heavy packages in one process, which then has loaded none."""
    light = [name for name in gsp.PACKAGES if name not in NEEDS]
    after = loaded("import gsp", *(f"gsp.{name}" for name in light))[1:]
    assert dict(zip(light, after, strict=True)) == {name: set() for name in light}


@pytest.mark.parametrize("name", NEEDS)
def test_a_package_loads_what_it_needs(name):
    assert loaded(f"import gsp; gsp.{name}")[0] <= NEEDS[name]


def test_help_imports_no_command():
    code = "import gsp.cli\ntry: gsp.cli.main(['--help'])\nexcept SystemExit: pass"
    modules = "gsp_modules = [m for m in sys.modules if m.startswith('gsp.')]"
    text = subprocess.run(
        [sys.executable, "-c", f"import sys\n{code}\n{modules}\nprint(*gsp_modules)"],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    ).stdout
    assert set(text.splitlines()[-1].split()) <= {
        "gsp.cli",
        "gsp.cli.app",
        "gsp.cli.interrupts",
        "gsp.cli.outputs",
        "gsp.cli.outputs.messages",
        "gsp.cli.outputs.pipes",
        "gsp.cli.outputs.waiting",
        "gsp.errors",
        "gsp.progress",
        "gsp.version",
    }


def test_show_needs_neither_tables_nor_compiled_code(tmp_path, monkeypatch):
    """And no database where there is no store, which it does not make."""
    store = tmp_path / "folder" / "maxima.sqlite"
    monkeypatch.setenv("GSP_STORE", str(store))
    calls = [
        f"import gsp.cli\ntry: gsp.cli.main(['show', {name!r}])\nexcept SystemExit: pass"
        for name in ("D1^6", "toz-kucuk-2016-d3-6")
    ]
    assert loaded(*calls)[-1] <= {"scipy", "networkx", "rich", "typer"}
    assert not store.parent.exists()
