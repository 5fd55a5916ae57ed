"""The pages of the site and their order."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from website import designs, indices, notebooks, reference

ROOT = Path(__file__).parents[1]

# The order of the pages of docs/. One that is in no list comes at the end of the guide.
GUIDE = (
    "docs/own-designs.md",
    "docs/drives.md",
    "docs/choosing-an-index.md",
    "docs/exploration.md",
    "docs/kinematics.md",
    "docs/assembly-modes.md",
    "docs/statics.md",
    "docs/calibration.md",
    "docs/workspaces.md",
    "docs/proofs.md",
    "docs/sets.md",
    "docs/quality-index.md",
    "docs/bridges.md",
    "docs/planar.md",
    "docs/app.md",
    "docs/report.md",
    "docs/command-line.md",
    "docs/performance.md",
)
BACKGROUND = (
    "docs/conventions.md",
    "docs/glossary.md",
    "docs/design.md",
    "docs/proof.md",
    "docs/published-numbers.md",
    "docs/errata.md",
    "docs/references.md",
)
PROJECT = ("CONTRIBUTING.md", "CHANGELOG.md")

Navigation = list[dict[str, Any] | str]


def navigation() -> Navigation:
    """Return the navigation as mkdocs takes it: titles with pages or with sections."""
    return [
        {"Start": "README.md"},
        {"Guide": [*GUIDE, *others(), "gallery.md"]},
        {"Notebooks": [notebooks.OVERVIEW, *map(notebooks.page, notebooks.NOTEBOOKS)]},
        {"Indices": [indices.OVERVIEW, *map(indices.page, indices.INDICES)]},
        {
            "Designs": [
                designs.OVERVIEW,
                *map(designs.page, designs.design_names()),
                "docs/catalogue.md",
            ]
        },
        {"Reference": [reference.OVERVIEW, *map(reference.page, reference.public_modules())]},
        {"Background": [*BACKGROUND, *PROJECT]},
    ]


def others() -> list[str]:
    """Return the pages of docs/ that no list names."""
    elsewhere = {*GUIDE, *BACKGROUND, "docs/catalogue.md"}
    return sorted(path for path in written() if path.startswith("docs/") and path not in elsewhere)


def listed(part: Any = None) -> list[str]:
    """Return the paths of all pages in the navigation, in order."""
    part = navigation() if part is None else part
    if isinstance(part, str):
        return [part]
    values = part.values() if isinstance(part, dict) else part
    return [path for value in values for path in listed(value)]


def written() -> dict[str, Path]:
    """Return the pages that are files of the repository: path on the site, and file."""
    files = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / p for p in PROJECT)]
    return {path.relative_to(ROOT).as_posix(): path for path in files}


def made() -> dict[str, str]:
    """Return the pages that are made from records: path on the site, and Markdown."""
    return {
        **indices.pages(),
        **designs.pages(),
        **reference.pages(),
    }
