"""Controls as they are used in a real browser: mouse, keys, a finger, copies, the ranking, axe."""

from __future__ import annotations

import asyncio
import importlib.resources
import json
import re
import urllib.error
import urllib.request

import numpy as np
import pytest

import gsp
from gsp.app.state import links, matrices, motion
from gsp.app.state.session import started, with_frame
from tests.app import chromium
from tests.app.visiting import FACTS, SIX_THREE, TEXT

pytest.importorskip("nicegui", reason="the extra `app` is not installed")
pytestmark = pytest.mark.skipif(
    chromium.executable() is None, reason="no Chromium is installed: the page is not tested in it"
)

MESSAGE = "document.querySelector('.gsp-message[role=status]').innerText"


def value(name):
    return f"Number(document.querySelector('[aria-label=\"{name} value\"]').value)"


async def phone(tab):
    """Make the tab that of a phone with a touch screen."""
    await tab.resize(390, 844)
    await tab.send("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=5)
    await tab.send("Page.reload")  # pages look for touch screens when they are loaded
    for _ in range(int(chromium.PATIENCE / 0.05)):
        await asyncio.sleep(0.05)
        answer = await tab.send(
            "Runtime.evaluate", expression=f"'ontouchstart' in window && {FACTS}"
        )
        if answer.get("result", {}).get("value"):
            break
    await tab.send("Page.bringToFront")


async def swipe(tab, places):
    """Put a finger on the first place, draw it to the others, and lift it once it rests there.

    A finger lifted in motion has the page scroll on: a tap then ends that, and clicks nothing.
    """
    for number, (x, y) in enumerate(places):
        kind = "touchMove" if number else "touchStart"
        await tab.send("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y}])
        await asyncio.sleep(0.02)
    if len(places) > 1:
        await asyncio.sleep(0.2)
    await tab.send("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])


def test_a_slider_by_mouse_keys_and_numbers(visit):
    state = started(gsp.catalogue.design(SIX_THREE))
    first = float(state.pose.position[2])
    top = motion.with_coordinate(state, "z", 1e3)
    bottom = motion.with_coordinate(state, "z", -1e3)

    async def work(tab):
        await tab.send("Page.bringToFront")
        x, y = await tab.middle("slider", "position z")
        mouse = {"button": "left", "clickCount": 1, "y": y}
        await tab.send("Input.dispatchMouseEvent", type="mousePressed", x=x, **mouse)
        for step in range(1, 9):
            await tab.send(
                "Input.dispatchMouseEvent", type="mouseMoved", buttons=1, x=x + 3 * step, **mouse
            )
        await tab.until(f"{value('position z')} > {first + 1.0}")
        await tab.send("Input.dispatchMouseEvent", type="mouseReleased", x=x + 24, **mouse)
        await asyncio.sleep(0.5)  # the browser sends the last value of a drag with a delay
        # The slider has the focus: its keys go to its ends, and the motion ends at limits.
        for key, code, end in (("Home", 36, bottom), ("End", 35, top)):
            await tab.key(key, code)
            await tab.until(f"Math.abs({value('position z')} - {end.pose.position[2]}) < 1e-3")
            bound = end.message.split(" = ")[1]  # which joint is the first one is rounding
            assert re.fullmatch(rf"stopped at the limit d\d = {bound}", await tab.run(MESSAGE))
        # A number does not get farther either, nor does a button.
        await tab.enter("textbox", "position z value", "200")
        await asyncio.sleep(0.3)
        assert (await tab.run(MESSAGE)).endswith(f" = {bound}")
        assert await tab.run(value("position z")) == pytest.approx(top.pose.position[2], rel=1e-5)
        assert "least left" in (facts := await tab.run(FACTS))
        assert "e−" not in facts  # of rounding nothing is left
        # Axes of the platform, and back.
        await tab.click("button", "Motion reset")
        await tab.enter("textbox", "yaw value", "30")
        await tab.click("button", "Platform axes")
        await tab.click("button", "position x plus")
        turned = with_frame(motion.with_coordinate(state, "yaw", 30.0), "platform")
        wanted = motion.nudged(turned, "x", 1).pose.position
        await tab.until(f"Math.abs({value('position y')} - {wanted[1]}) < 1e-4")
        assert await tab.run(value("position x")) == pytest.approx(wanted[0], rel=1e-5)
        await tab.click("button", "Motion reset")
        await tab.until(f"{value('position y')} === 0")
        # A slider that the value is beyond.
        await tab.click("checkbox", "Screw axis")
        await tab.click("tab", "Legs")
        await tab.click("checkbox", "Motions stop at limits")
        await tab.click("tab", "Motion")
        note = "[...document.querySelectorAll('.gsp-outside')].map(e => e.innerText).join('')"
        assert await tab.run(note) == ""
        await tab.enter("textbox", "position z value", "25")
        await tab.until(f"{note} === 'above the slider ▸'")
        # The label of the screw axis is in the picture, wherever the axis is.
        inside = """(() => {
          const [stage, text] = ['.gsp-scene', '.gsp-label-screw'].map(
            (name) => document.querySelector(name).getBoundingClientRect());
          return text.width > 20 && text.left >= stage.left && text.right <= stage.right
            && text.top >= stage.top && text.bottom <= stage.bottom;
        })()"""
        for place in ("-40", "60"):
            await tab.enter("textbox", "position x value", place)
            await tab.until(inside)

    visit(work)


def test_a_finger_moves_sliders_and_the_panel_of_a_tab_comes_into_view(visit):
    first = float(gsp.catalogue.design(SIX_THREE).home.position[2])

    async def work(tab):
        await phone(tab)
        x, y = await tab.middle("slider", "position z")
        await swipe(tab, [(x - 2 * step, y) for step in range(11)])
        await tab.until(f"{value('position z')} < {first - 1.0}")
        # Across the slider it scrolls the page, and moves nothing.
        x, y = await tab.middle("slider", "roll")
        before = await tab.run("scrollY")
        await swipe(tab, [(x, y - 8 * step) for step in range(11)])
        await tab.until(f"scrollY > {before + 20}")
        assert await tab.run(value("roll")) == 0.0
        # The tabs are below the scene, and what they show is on the screen.
        scene = "document.querySelector('.gsp-scene').getBoundingClientRect().bottom"
        tabs = "document.querySelector('.gsp-tabs').getBoundingClientRect().top"
        await tab.run("scrollTo(0, 0)")
        for name in ("Indices", "Plots"):
            await swipe(tab, [await tab.middle("tab", name)])
            await tab.until(f"{tabs} - {scene} < 40 && {tabs} - {scene} >= 0")
        assert await tab.run("document.documentElement.scrollWidth") == 390

    visit(work)


# Pages of other machines by http have no such clipboard.
NO_CLIPBOARD = """window.board = navigator.clipboard;
Object.defineProperty(Navigator.prototype, 'clipboard', { value: undefined });0"""


NOTES = "(document.querySelector('.q-notifications')?.innerText ?? '')"
# Buttons of the dialog that are behind something, such as a note.
COVERED = """[...document.querySelectorAll('.gsp-dialog button')].filter((one) => {
  const { x, y, width, height } = one.getBoundingClientRect();
  return !one.contains(document.elementFromPoint(x + width / 2, y + height / 2));
})"""


def test_copies_and_a_hexapod_of_the_dialog(visit):
    state = motion.nudged(started(gsp.catalogue.design(SIX_THREE)), "x", 1)

    async def work(tab):
        await tab.send("Emulation.setFocusEmulationEnabled", enabled=True)
        await tab.click("button", "position x plus")
        await tab.until(f"{value('position x')} > 0")
        await tab.click("button", "Jacobian matrix")
        await tab.until("document.querySelector('.gsp-matrix')?.innerText")
        copied = "(window.board ?? navigator.clipboard).readText()"
        for kind in matrices.FORMATS:
            await tab.click("button", f"Copy as {kind}")
            await tab.until(f"{NOTES}.includes('Copied as {kind}')")
            assert await tab.run(copied) == matrices.as_text(state, matrices.PLAIN, kind)
            assert await tab.run(f"{COVERED}.map(one => one.innerText)") == []
            if "numpy" in kind:  # the first one
                await tab.run(NO_CLIPBOARD)
        assert await tab.run("navigator.clipboard === undefined")
        await tab.key("Escape", 27)
        await tab.until("!document.querySelector('.q-dialog')")
        await tab.click("button", "File")
        await tab.click("menuitem", "Copy a link to this state")
        await tab.until(f"{NOTES}.includes('The link to this state was copied')")
        assert (await tab.run(copied)).endswith(f"/?{links.query(state)}")
        await tab.click("button", "Configuration")
        await tab.click("tab", "Hexapod on circles")
        await tab.enter("textbox", "Base radius", "3")
        await tab.click("button", "OK: this hexapod")
        design = gsp.hexapod(3.0, 20.0, 1.0, 20.0, 1.5, degrees=True)
        wanted = f"{np.linalg.det(design.at(design.home).jacobian):.7g}".replace("-", "−")
        await tab.until(f"{FACTS}.includes('{wanted}')")

    visit(work)


def test_the_ranking_is_sorted_by_keyboard(visit):
    rows = "[...document.querySelectorAll('.q-table tbody tr')].map(e => e.innerText)"
    sort = "document.querySelector('th[aria-sort]')?.ariaSort"
    names = sorted(mechanism.name for mechanism in gsp.catalogue.mechanisms())

    async def work(tab):
        await tab.send("Emulation.setFocusEmulationEnabled", enabled=True)
        await tab.click("tab", "Catalogue")
        await tab.until(f"{TEXT}.includes('Not ranked yet')")
        assert "No data" not in await tab.run(TEXT)
        await tab.click("button", "Rank at this pose")
        await tab.until(f"{rows}.length > 5")
        # Without a length one mechanism has a value: it is first in both directions.
        firsts = {"Mechanism": (names[0], names[-1]), "CTN": ("D1^6", "D1^6")}
        for head, wanted in firsts.items():
            for way, first in zip(("ascending", "descending"), wanted, strict=True):
                await tab.send("DOM.focus", backendNodeId=await tab.named("button", head))
                await tab.key("Enter", 13)
                await tab.until(f"{sort} === '{way}'")
                await tab.until(f"{rows}[0].split('\\t')[1].trim() === '{first}'")

    visit(work)


@pytest.mark.parametrize("path", ["nonsense", "report/1", "index.html"])
def test_an_unknown_address_is_no_page_of_the_tool(served, path):
    with pytest.raises(urllib.error.HTTPError) as found:
        urllib.request.urlopen(f"{served}/{path}")
    page = found.value.read().decode()
    assert found.value.code == 404
    assert "There is no page at this address." in page
    assert "href='/'" in page
    with urllib.request.urlopen(f"{served}/?design=lee-2000-3-3") as answer:
        assert answer.status == 200


# Lines of each number below the scene, if det J has as many letters as it can.
LINES = """(() => {
  const facts = [...document.querySelectorAll('.gsp-facts')].find((e) => e.offsetWidth);
  facts.querySelector('dd').innerText = '−1.234568e−05';
  return [...facts.querySelectorAll('.gsp-fact > dd:not(.gsp-share)')].map((e) => {
    const range = document.createRange();
    range.selectNodeContents(e);
    return new Set([...range.getClientRects()].map((box) => box.top)).size;
  });
})()"""
# Whether what is in the column of notes, and below the names, is seen in the ranking.
RANKING_NOTES = """['td:nth-child(5)', '.gsp-under'].map(
  (part) => [...document.querySelectorAll(`.gsp-ranking ${part}`)].some((e) => e.offsetWidth))"""


# Fields beside sliders that cut a long number: a part of it looks like another one.
CUT = """[...document.querySelectorAll('.gsp-control input')].map((field) => {
  const shown = field.value;
  field.value = '-2.88888e-100';
  const cut = field.scrollWidth > field.clientWidth;
  field.value = shown;
  return cut;
})"""


@pytest.mark.parametrize("width", [1366, 390, 320])
def test_fields_beside_sliders_hold_all_digits_and_the_exponent(visit, width):
    async def work(tab):
        await tab.resize(width, 844)
        for name in ("Motion", "Legs"):
            await tab.click("tab", name)
            await tab.until(f"{CUT}.length === 6")
            await tab.still()
            assert await tab.run(CUT) == [False] * 6
        assert await tab.run("document.documentElement.scrollWidth") == width

    visit(work)


def test_numbers_are_not_broken_and_notes_have_a_place_at_the_width_of_a_phone(visit):
    async def work(tab):
        await tab.click("tab", "Catalogue")
        await tab.click("button", "Rank at this pose")
        await tab.until(f"{TEXT}.includes('have no value')")
        for width, notes in ((1366, [True, False]), (390, [False, True])):
            size = {"width": width, "height": 844, "deviceScaleFactor": 1, "mobile": False}
            await tab.send("Emulation.setDeviceMetricsOverride", **size)
            await tab.until(f"window.innerWidth === {width}")
            assert set(await tab.run(LINES)) == {1}
            assert await tab.run(RANKING_NOTES) == notes
            assert await tab.run("document.documentElement.scrollWidth") == width

    visit(work)


def test_a_body_of_megabytes_gets_an_answer(served):
    request = urllib.request.Request(f"{served}/api/evaluate", b"x" * 3_000_000, method="POST")
    with pytest.raises(urllib.error.HTTPError) as found:
        urllib.request.urlopen(request)
    assert found.value.code == 413
    assert "at most" in json.loads(found.value.read())["error"]


# Faults that axe finds, with the elements.
AXE = """axe.run(document, {resultTypes: ['violations']}).then(
  (found) => found.violations.map((one) => [one.id, one.nodes.map((node) => node.html)]))"""


def test_an_accessibility_checker_finds_nothing(visit):
    axe = pytest.importorskip("axe_core_python", reason="axe-core-python is not installed")
    script = importlib.resources.files(axe).joinpath("axe.min.js").read_text("utf-8")

    async def work(tab):
        async def check():
            await tab.still()
            assert await tab.run(AXE) == []

        await tab.run(f"{script};0")
        await check()
        for name in ("Legs", "Indices", "Plots", "Catalogue"):
            await tab.click("tab", name)
            await check()
        for name in ("Configuration", "Jacobian matrix"):
            await tab.click("button", name)
            await tab.named("dialog", name)
            await check()
            await tab.key("Escape", 27)
            await tab.until("!document.querySelector('.q-dialog')")
        await tab.click("button", "File")
        await tab.named("menuitem", "Copy a link to this state")
        await check()
        await tab.key("Escape", 27)
        await tab.still()
        # It can find something.
        await tab.run("document.querySelector('[aria-label=\"Save the picture\"]').ariaLabel = ''")
        assert [rule for rule, _ in await tab.run(AXE)] == ["button-name"]

    visit(work)
