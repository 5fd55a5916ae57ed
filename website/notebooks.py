"""The notebooks, executed, as pages with their figures."""

from __future__ import annotations

import base64
import json
import os
import re
import tempfile
from html import unescape
from pathlib import Path
from typing import Any

from website.cache import WORK, kept
from website.markdown import fence, table
from website.markdown import page as make

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "notebooks"
NOTEBOOKS = tuple(sorted(path.stem for path in FOLDER.glob("*.ipynb")))
OVERVIEW = "notebooks/index.md"
SECONDS = 600
# A page that a notebook shows in a frame.
FRAME = re.compile(r'<iframe title="(?P<title>[^"]*)" srcdoc="(?P<page>[^"]*)"')
ANSI = re.compile(r"\x1b\[[0-9;]*m")


def page(name: str) -> str:
    """Return the path of the page of a notebook."""
    return f"notebooks/{name}.md"


def overview() -> str:
    """Return the page with one row per notebook."""
    rows = [(name[:2], f"[{title(name)}]({name}.md)") for name in NOTEBOOKS]
    return make(
        "# Notebooks",
        "One claim each. They are executed when the site is built, and by the tests, where some "
        "have a short form.",
        table(("", "notebook"), rows),
    )


def title(name: str) -> str:
    """Return the heading of a notebook."""
    cells = json.loads((FOLDER / f"{name}.ipynb").read_text(encoding="utf-8"))["cells"]
    return "".join(cells[0]["source"]).partition("\n")[0].lstrip("# ")


def executed(name: str) -> dict[str, Any]:
    """Return a notebook with its outputs."""
    return json.loads(result(name).read_text(encoding="utf-8"))


def result(name: str) -> Path:
    """Return the file of a notebook with its outputs.

    It is executed, in full, if it or the library has changed.
    """
    source = FOLDER / f"{name}.ipynb"
    return kept(source, WORK, ".ipynb", lambda new: run(source, new))


def run(source: Path, target: Path) -> None:
    """Execute a notebook in an empty folder, and write it with its outputs."""
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(source, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        os.environ |= {"PYTHONPATH": str(ROOT), "GSP_STORE": str(Path(folder) / "maxima.sqlite")}
        os.environ.pop("GSP_NOTEBOOKS", None)
        resources = {"metadata": {"path": folder}}
        client = NotebookClient(
            notebook, timeout=SECONDS, kernel_name="python3", resources=resources
        )
        client.execute()
    nbformat.write(notebook, target)


def convert(name: str, notebook: dict[str, Any], folder: Path) -> tuple[str, dict[str, Path]]:
    """Return the page of an executed notebook, and its pictures: path on the site, and file."""
    parts, pictures = [], {}
    for i, one in enumerate(notebook["cells"]):
        if one["cell_type"] == "markdown":
            parts.append("".join(one["source"]))
            continue
        parts.append(fence("".join(one["source"]).rstrip(";"), "python"))
        for j, output in enumerate(one["outputs"]):
            data = output.get("data", {})
            if "image/png" in data:
                file = folder / f"{name}-{i}-{j}.png"
                file.write_bytes(base64.b64decode(data["image/png"]))
                pictures[f"notebooks/{file.name}"] = file
                parts.append(f"![Figure made by the code above]({file.name})")
            elif framed := FRAME.match("".join(data.get("text/html", ""))):
                file = folder / f"{name}-{i}-{j}.html"
                file.write_text(unescape(framed["page"]), encoding="utf-8")
                pictures[f"notebooks/{file.name}"] = file
                parts.append(f"[The page: {unescape(framed['title'])}]({file.name})")
            else:
                parts.append(shown(output))
    parts.insert(1, f"[Download the notebook]({name}.ipynb)")
    return make(*parts), pictures


def shown(output: dict[str, Any]) -> str:
    """Return one output other than a picture as Markdown."""
    data = output.get("data", {})
    if "text/html" in data:
        html = "".join(data["text/html"])
        html = re.sub(r"<style.*?</style>", "", html, flags=re.DOTALL)
        html = re.sub(r'\s(border="1"|class="dataframe"|style="[^"]*")', "", html)
        return '<div class="output">' + re.sub(r"\n\s*", "", html) + "</div>"
    text = "".join(output.get("text", data.get("text/plain", "")))
    return fence(ANSI.sub("", text)) if text.strip() else ""


if __name__ == "__main__":
    for one in NOTEBOOKS:
        print(result(one), flush=True)
