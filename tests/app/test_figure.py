"""`design.show()`: the scene as an HTML page that needs nothing else, in notebooks and files."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

import gsp
from tests.app import chromium

pytest.importorskip("nicegui", reason="the extra `app` is not installed")

TOZ = "toz-kucuk-2016-d3-6"
in_browser = pytest.mark.skipif(
    chromium.executable() is None, reason="no Chromium is installed: the figure is not tested in it"
)


def test_a_notebook_shows_it():
    formatters = pytest.importorskip("IPython.core.formatters")
    design = gsp.catalogue.design(TOZ)
    shown, _ = formatters.DisplayFormatter().format(design.show())
    assert shown["text/html"].startswith('<iframe title="toz-kucuk-2016-d3-6: platform at 10, -10')
    assert shown["text/plain"] == f"SceneFigure('{TOZ}: platform at 10, -10, 138 mm')"


def test_facts_are_those_of_the_library():
    design = gsp.catalogue.design(TOZ)
    pose = design.home.moved([0, 0, 5.0, 0, 0, 0.1])
    wanted = np.linalg.det(design.at(pose).jacobian)
    assert f"det J = {wanted:.7g} mm³ · CTN = " in design.show(pose).html


def test_facts_of_a_redundant_design():
    toz = gsp.catalogue.design(TOZ)
    design = toz.replace(
        legs=[*toz.legs, "D1"],
        base_points=[*toz.base_points, (0.0, 0.0, 0.0)],
        platform_points=[*toz.platform_points, (0.0, 0.0, 10.0)],
        base_directions=[*toz.base_directions, (0.0, 0.0, 1.0)],
        platform_directions=[*toz.platform_directions, (0.0, 0.0, 1.0)],
        strokes=None,
    )
    values = np.linalg.svd(design.at(design.home).jacobian, compute_uv=False)
    assert f"|det J| = {values.prod():.7g} mm³ · CTN = " in design.show().html


def test_names_are_no_markup():
    name = "</script><script>alert(1)</script>@facts@<!--"
    html = gsp.catalogue.design(TOZ).replace(name=name, unit="<b>").show().html
    assert html.count("<script") == html.count("</script>") == 1
    assert "alert(1)</script>" not in html
    assert "<b>" not in html
    assert "<!--" not in html


def test_nothing_is_loaded_from_elsewhere():
    html = gsp.catalogue.design("lee-2000-3-3").show().html
    assert "http" not in html
    assert "src=" not in html
    assert len(html) < 400_000


def test_what_cannot_be_shown(tmp_path):
    design = gsp.catalogue.design(TOZ)
    with pytest.raises(gsp.GspError, match="a single pose"):
        design.show(gsp.Pose(np.zeros((2, 3))))
    with pytest.raises(gsp.GspError, match="pose: expected"):
        design.show([0, 0, 1])
    with pytest.raises(gsp.GspError, match=r"ends in \.html"):
        design.show().write(tmp_path / "scene.png")
    for no_path in (None, 5, b"x.html", "", "a\0.html"):
        with pytest.raises(gsp.GspError, match="path: expected"):
            design.show().write(no_path)
    design.show().write(tmp_path / "scene.html")
    with pytest.raises(gsp.GspError, match="exists"):
        design.show().write(tmp_path / "scene.html")


@in_browser
def test_it_is_drawn_and_turned_without_a_network(browsed, tmp_path):
    """As a file, and in the output of a notebook, which is a frame in another page."""
    shown = gsp.catalogue.design(TOZ).show()
    shown.write(tmp_path / "scene.html")
    page = f"<!doctype html><body><p>Out[1]</p>{shown._repr_html_()}</body>"
    (tmp_path / "notebook.html").write_text(page)
    frame = "document.querySelector('iframe')?.contentDocument?"
    numbers = "[...{}.querySelectorAll('.gsp-label-number')]"

    async def one(opened, name, document):
        tab = await opened((tmp_path / name).as_uri(), 900, 700)
        labels = numbers.format(document)
        places = f"JSON.stringify({labels}.map(e => e.style.transform))"
        await tab.until(f"{document}.querySelectorAll('.gsp-label-number').length === 6")
        assert sorted(await tab.run(f"{labels}.map(e => e.innerText)")) == list("123456")
        await tab.send("Page.bringToFront")
        frames = "requestAnimationFrame", f"{document}.defaultView.requestAnimationFrame"
        count = chromium.COLOURS.replace("document.query", f"{document}.query").replace(*frames)
        assert await tab.run(count) > 50
        await tab.run(f"{document}.querySelector('[aria-label=\"space view\"]').click()")
        before = await tab.until(places)
        await tab.run(f"{document}.querySelector('.gsp-scene').focus()")
        await tab.key("ArrowRight", 39)
        await tab.until(f"{places} !== {before!r}")
        await tab.run(f"{document}.querySelector('input').click()")
        await tab.until(f"{labels}[0].style.display === 'none'")
        assert tab.errors == []
        assert {url.split(":")[0] for url in tab.requests} <= {"about", "file", "blob", "data"}

    async def work():
        async with chromium.tabs(browsed, tmp_path) as opened:
            await one(opened, "scene.html", "document")
            await one(opened, "notebook.html", frame)

    asyncio.run(work())
