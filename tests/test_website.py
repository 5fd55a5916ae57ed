"""The documentation site: all pages are listed, and generated pages agree with the records."""

from __future__ import annotations

import runpy
from functools import cache
from pathlib import Path

import pytest

import gsp
from gsp.app.scene.pages import PageFigure
from website import designs, gallery, indices, navigation, notebooks, reference
from website.mathml import CODE

ROOT = Path(__file__).parents[1]


@cache
def made():
    """The pages that are made from records, made once."""
    return navigation.made()


def test_navigation_lists_every_page_once():
    """A page of docs/ that is in no list of website/navigation.py is at the end of the guide."""
    pages = {
        *navigation.written(),
        *made(),
        *map(notebooks.page, notebooks.NOTEBOOKS),
        notebooks.OVERVIEW,
        gallery.PAGE,
    }
    listed = navigation.listed()
    assert len(listed) == len(set(listed))
    assert set(listed) == pages


def test_written_pages_are_those_of_the_repository():
    """There is no second copy: the pages of docs/ and the README themselves."""
    written = navigation.written()
    assert set((ROOT / "docs").glob("*.md")) < set(written.values())
    assert all((ROOT / path) == file and file.is_file() for path, file in written.items())


@pytest.mark.parametrize("index", gsp.indices.INDICES.values(), ids=lambda index: index.name)
def test_page_of_an_index_has_its_record(index):
    text = made()[indices.page(index.name)]
    for fact in (index.symbol, index.source, index.better, *index.needs):
        assert fact.replace("|", "\\|") in text
    assert f"::: {index.function.__module__}.{index.function.__name__}" in text
    assert text.count("| yes |") >= sum(
        getattr(index.properties, flag) for flag in indices.PROPERTIES
    )
    assert f"({index.name}.md)" in made()[indices.OVERVIEW]


def test_every_property_of_the_record_is_shown():
    assert set(indices.PROPERTIES) == set(gsp.indices.Properties.__dataclass_fields__)
    assert set(indices.DESCRIPTIONS) == set(gsp.indices.Invariance.__dataclass_fields__)


@pytest.mark.parametrize("name", gsp.catalogue.design_names())
def test_page_of_a_design_has_its_record(name):
    design, text = gsp.catalogue.design(name), made()[designs.page(name)]
    assert design.source in text
    assert design.mechanism.name in text
    assert designs.numbers(design.base_points[-1]) in text
    assert designs.numbers(design.platform_points[-1]) in text
    if design.home is not None:
        for value in design.at(design.home).joints:
            assert f"{value:.7g}" in text
    assert f"({name}.md)" in made()[designs.OVERVIEW]


@pytest.mark.parametrize("name", reference.public_modules())
def test_reference_has_every_public_name(name):
    module = reference.public_modules()[name]
    text = made()[reference.page(name)]
    for member in reference.names(module):
        value = getattr(module, member)
        if isinstance(value, type) or callable(value):
            assert f"{name}.{member}" in text


def test_an_argument_without_description_has_no_dash():
    place = '<li>\n <code>x</code>)\n –\n <div class="doc-md-description">\n{}\n </div></li>'
    assert reference.without_dashes(place.format("")) == "<li>\n <code>x</code>)</li>"
    assert reference.without_dashes(place.format("<p>a</p>")) == place.format("<p>a</p>")


def test_every_package_that_gsp_names_is_in_the_reference():
    assert {f"gsp.{name}" for name in gsp.PACKAGES} < set(reference.public_modules())


def test_public_names_in_running_text_become_links():
    text = reference.with_references("`gsp.Design` and `gsp.nothing`\n```python\n`gsp.Design`\n```")
    assert text.startswith("[`gsp.Design`][gsp.model.design.designs.Design] and `gsp.nothing`")
    assert text.endswith("```python\n`gsp.Design`\n```")


def test_source_is_before_the_sections():
    docstring = "Return x.\n\nReturns\n-------\nfloat\n\n*Source: Paper, eq. (1).*"
    moved = reference.source_first(docstring)
    assert moved.index("*Source: Paper") < moved.index("Returns")
    assert reference.source_first("Return x.") == "Return x."


def test_code_is_not_a_formula():
    assert CODE.split("a `$x$` b")[1] == "`$x$`"


@pytest.mark.parametrize("script", gallery.SCRIPTS)
def test_script_of_the_gallery_draws_its_picture(script, tmp_path, monkeypatch):
    import matplotlib.pyplot as plt

    monkeypatch.chdir(tmp_path)
    with plt.ioff():
        runpy.run_path(str(gallery.FOLDER / f"{script}.py"))
    plt.close("all")
    assert (tmp_path / f"{script}.png").stat().st_size > 5_000
    assert f"(#{script})" in gallery.text()


def test_a_page_that_a_notebook_shows_is_a_file_of_the_site(tmp_path):
    shown = PageFigure(title='"a" & b', html="<p>1 < 2\n// kept as it is</p>")
    output = {"data": {"text/html": shown._repr_html_()}}
    cells = [
        {"cell_type": "markdown", "source": ["# Heading"]},
        {"cell_type": "code", "source": ["shown"], "outputs": [output]},
    ]
    text, files = notebooks.convert("01-some", {"cells": cells}, tmp_path)
    assert '[The page: "a" & b](01-some-1-0.html)' in text
    assert files["notebooks/01-some-1-0.html"].read_text(encoding="utf-8") == shown.html
