"""The gallery: each script of docs/gallery makes one picture."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from website.cache import kept
from website.markdown import fence
from website.markdown import page as make

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs" / "gallery"
SCRIPTS = tuple(sorted(path.stem for path in FOLDER.glob("*.py")))
PAGE = "gallery.md"


def text() -> str:
    """Return the page: the pictures, each linked to the code below that makes it."""
    cards = [f"- [![{title(s)}](gallery/{s}.png)](#{s})\n  {title(s)}" for s in SCRIPTS]
    parts = [
        "# Gallery",
        "Each picture is a link to the code that makes it.",
        '<div class="gallery" markdown>',
        "\n".join(cards),
        "</div>",
    ]
    for script in SCRIPTS:
        parts += [
            f"## {title(script)} {{ #{script} }}",
            f"![{title(script)}](gallery/{script}.png)",
            fence(code(script), "python"),
            f"[`docs/gallery/{script}.py`](docs/gallery/{script}.py)",
        ]
    return make(*parts)


def title(script: str) -> str:
    """Return the first line of a script's docstring, without the full stop."""
    docstring = ast.get_docstring(ast.parse(source(script))) or script
    return docstring.partition("\n")[0].rstrip(".")


def code(script: str) -> str:
    """Return a script without its docstring."""
    first = ast.parse(source(script)).body[0]
    return "\n".join(source(script).splitlines()[first.end_lineno :]).strip()


def source(script: str) -> str:
    """Return the text of a script."""
    return (FOLDER / f"{script}.py").read_text(encoding="utf-8")


def draw(folder: Path) -> dict[str, Path]:
    """Run the scripts in a folder, and return the pictures: path on the site, and file."""
    return {
        f"gallery/{script}.png": kept(
            FOLDER / f"{script}.py", folder, ".png", lambda new, s=script: run(s, new)
        )
        for script in SCRIPTS
    }


def run(script: str, result: Path) -> None:
    """Run one script in an empty folder, and keep the picture that it writes there."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "agg"}
        environment["GSP_STORE"] = str(Path(folder) / "maxima.sqlite")
        command = (sys.executable, FOLDER / f"{script}.py")
        subprocess.run(command, cwd=folder, env=environment, check=True)
        shutil.move(Path(folder) / f"{script}.png", result)
