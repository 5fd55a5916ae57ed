"""The page in a real browser, where one is installed: controls, scene, two clients, requests."""

from __future__ import annotations

import asyncio
import re
import urllib.error
import urllib.request

import numpy as np
import pytest

import gsp
from tests.app import chromium

pytest.importorskip("nicegui", reason="the extra `app` is not installed")
pytestmark = pytest.mark.skipif(
    chromium.executable() is None, reason="no Chromium is installed: the page is not tested in it"
)

TOZ = "toz-kucuk-2016-d3-6"
FACT = "[...document.querySelectorAll('.gsp-facts')].map(e => e.innerText).join()"


def number(text, name):
    return float(re.search(rf"{re.escape(name)}[^\n]*\n(\S+)", text)[1].replace("−", "-"))


def test_the_page_in_a_browser(served, browsed, tmp_path):
    design = gsp.catalogue.design(TOZ)

    async def work(address):
        page = f"{address}/?design={TOZ}"
        async with chromium.tabs(browsed, tmp_path) as opened:
            one, two = await asyncio.gather(opened(page), opened(page, 390, 800))
            await asyncio.gather(*(tab.until(f"{FACT}.includes('−2674321')") for tab in (one, two)))
            # Buttons by their names; the numbers are those of the library.
            await one.run("document.querySelector('[aria-label=\"position x plus\"]').click()")
            text = await one.until(f"!{FACT}.includes('−2674321') && {FACT}")
            pose = design.home.moved([6.0, 0, 0, 0, 0, 0])
            wanted = np.linalg.det(design.at(pose).jacobian)
            assert number(text, "det J") == pytest.approx(wanted, rel=1e-6)
            # Sliders by the keyboard alone.
            await one.run('document.querySelector(\'[aria-label="yaw"][tabindex="0"]\').focus()')
            await one.key("ArrowRight", 39)
            await one.until(f"!{FACT}.includes('{text.split()[3]}') && {FACT}")
            value = await one.run("document.querySelector('[aria-label=\"yaw value\"]').value")
            assert -10.0 < float(value) < -9.0
            # Another client has its own pose, and no wider page than its screen.
            assert "−2674321" in await two.run(FACT)
            assert await two.run("document.documentElement.scrollWidth") <= 390
            await one.send("Page.bringToFront")  # pictures of tabs behind are not drawn
            assert await one.run(chromium.COLOURS) > 50
            assert await one.run("document.querySelector('.gsp-scene-note').hidden")
            # Every control has a name.
            unnamed = await one.run(
                "[...document.querySelectorAll('button, input, [role=slider], [role=checkbox]')]"
                ".filter(e => !(e.getAttribute('aria-label') || e.innerText || e.labels?.length"
                " || e.type === 'file' || e.classList.contains('hidden')))"
                ".map(e => e.outerHTML.slice(0, 200))"
            )
            assert unnamed == []
            for tab in (one, two):
                assert tab.errors == []
                foreign = [
                    url
                    for url in tab.requests
                    if not url.startswith(
                        (address, address.replace("http", "ws"), "data:", "blob:")
                    )
                ]
                assert foreign == ["about:blank"] * len(foreign)

    asyncio.run(work(served))
    # A page of another origin gets no socket.
    request = urllib.request.Request(served, headers={"Origin": "http://evil.example"})
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen(request)
