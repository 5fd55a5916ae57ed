"""Hooks of mkdocs: the pages of the site, and changes of their text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from website import gallery, notebooks
from website.cache import WORK
from website.designs import draw
from website.mathml import with_mathml
from website.navigation import made, navigation, written
from website.reference import with_references, without_dashes

ROOT = Path(__file__).parents[1]
# Files of the repository that pages link to.
STATIC = (
    "LICENSE",
    "CITATION.cff",
    "environment.yml",
    "catalogue/mechanisms.csv",
    "catalogue/designs/*.toml",
    "docs/images/*",
    "docs/gallery/*.py",
    "notebooks/*.ipynb",
)
# Folders that pages link to, and the pages that show what is in them.
FOLDERS = {"notebooks/": "notebooks/index.md", "catalogue/designs/": "designs/index.md"}


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Set the navigation, and replace the script that the offline plugin takes from a network."""
    config.nav = navigation()
    config.extra["polyfills"] = ["search-offline.js"]
    return config


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Add the pages of the repository, those made from records, pictures and static files."""
    WORK.mkdir(parents=True, exist_ok=True)
    texts, paths = made(), written()
    paths |= draw(WORK / "designs")
    for name in notebooks.NOTEBOOKS:
        text, pictures = notebooks.convert(name, notebooks.executed(name), WORK)
        texts[notebooks.page(name)] = text
        paths |= pictures
    paths |= gallery.draw(WORK / "gallery")
    texts |= {notebooks.OVERVIEW: notebooks.overview(), gallery.PAGE: gallery.text()}
    for pattern in STATIC:
        paths |= {p.relative_to(ROOT).as_posix(): p for p in ROOT.glob(pattern)}
    for path, text in texts.items():
        files.append(File.generated(config, path, content=text))
    for path, file in paths.items():
        files.append(File.generated(config, path, abs_src_path=str(file)))
    return files


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Adapt links between files of the repository to the site, and link names to the reference."""
    path = page.file.src_uri
    markdown = (
        markdown.replace(".ipynb)", ".md)") if not path.startswith("notebooks/") else markdown
    )
    for folder, shown in FOLDERS.items():
        markdown = markdown.replace(f"]({folder})", f"]({shown})")
    markdown = with_mathml(markdown)
    return markdown if path.startswith("reference/") else with_references(markdown)


def on_page_content(html: str, **_: Any) -> str:
    """Adapt the text of a page that mkdocstrings has made."""
    return without_dashes(html)
