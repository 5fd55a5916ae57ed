"""The page for people who use a keyboard alone, or a screen reader: names, roles, contrast."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

import gsp
from gsp.app.state import choices, motion
from gsp.app.state.session import started
from tests.app import chromium
from tests.app.visiting import FACTS, SIX_THREE

pytest.importorskip("nicegui", reason="the extra `app` is not installed")
pytestmark = pytest.mark.skipif(
    chromium.executable() is None, reason="no Chromium is installed: the page is not tested in it"
)

# Roles of what a user operates: each needs a name.
OPERATED = {
    "button", "checkbox", "combobox", "dialog", "img", "link", "menuitem", "progressbar", "region",
    "slider", "spinbutton", "switch", "tab", "tablist", "textbox",
}  # fmt: skip
# Visible texts whose contrast to what is behind them is below that of WCAG 2.1, AA: 4.5, and 3 for
# large ones. Colours behind are blended; pictures and gradients are not looked at.
FAINT = """(() => {
  const parsed = (text) => {
    const found = text.match(/[\\d.]+/g).map(Number);
    return found.length > 3 ? found : [...found.slice(0, 3), 1];
  };
  const over = (top, below) => [0, 1, 2].map((k) => top[3] * top[k] + (1 - top[3]) * below[k]);
  const behind = (element) => {
    const layers = [];
    for (let one = element; one; one = one.parentElement)
      layers.push(parsed(getComputedStyle(one).backgroundColor));
    return layers.reverse().reduce((below, top) => over(top, below), [255, 255, 255]);
  };
  const luminance = (colour) => {
    const linear = (x) => (x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
    const [r, g, b] = colour.map((x) => linear(x / 255));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), faint = [];
  let seen = 0;
  while (walker.nextNode()) {
    const element = walker.currentNode.parentElement, text = walker.currentNode.textContent.trim();
    const options = { opacityProperty: true, visibilityProperty: true };
    if (!text || !element.checkVisibility(options)) continue;
    if (element.closest('script, style, [aria-disabled=true], :disabled')) continue;
    const style = getComputedStyle(element), back = behind(element);
    const pair = [over(parsed(style.color), back), back].map(luminance).sort((a, b) => b - a);
    const size = parseFloat(style.fontSize), bold = parseFloat(style.fontWeight) >= 700;
    const least = size >= 24 || (bold && size >= 18.66) ? 3 : 4.5;
    const ratio = (pair[0] + 0.05) / (pair[1] + 0.05);
    seen++;
    if (ratio < least) faint.push([text.slice(0, 40), Math.round(100 * ratio) / 100]);
  }
  return { seen, faint };
})()"""


async def unnamed(tab):
    """What a user operates and has no name in the accessibility tree."""
    nodes = (await tab.send("Accessibility.getFullAXTree"))["nodes"]
    operated = [
        node
        for node in nodes
        if not node["ignored"] and node.get("role", {}).get("value") in OPERATED
    ]
    assert len(operated) > 5
    return [
        (node["role"]["value"], node.get("backendDOMNodeId"))
        for node in operated
        if not node.get("name", {}).get("value", "").strip()
    ]


async def check(tab):
    await tab.still()
    assert await unnamed(tab) == []
    found = await tab.run(FAINT)
    assert found["faint"] == []
    return found["seen"]


async def announced(tab, name):
    """Role, value, ends and whether it can be used of a slider that is given the focus."""
    await tab.send("DOM.focus", backendNodeId=await tab.named("slider", name))
    answer = await tab.send("Runtime.evaluate", expression="document.activeElement")
    found = await tab.send(
        "Accessibility.getPartialAXTree", objectId=answer["result"]["objectId"],
        fetchRelatives=False,
    )  # fmt: skip
    (node,) = found["nodes"]
    facts = {one["name"]: one["value"].get("value") for one in node["properties"]}
    ends = facts.get("valuemin"), facts.get("valuemax")
    return (node["role"]["value"], node["name"]["value"]), float(node["value"]["value"]), ends


def test_the_part_of_a_slider_that_has_the_focus_is_announced(visit):
    async def work(tab):
        await tab.click("tab", "Motion")
        who, _, (low, high) = await announced(tab, "yaw")
        assert (who, low, high) == (("slider", "yaw"), -180.0, 180.0)
        await tab.enter("textbox", "yaw value", "12.5")
        await tab.until("document.querySelector('[aria-valuenow=\"12.5\"]') !== null")
        for _ in range(100):  # the tree of what is announced follows the page
            if (value := (await announced(tab, "yaw"))[1]) == 12.5:
                break
            await asyncio.sleep(0.05)
        assert value == 12.5
        await tab.click("tab", "Legs")
        design = gsp.catalogue.design(SIX_THREE)
        turned = motion.with_coordinate(started(design), "yaw", 12.5)
        joint = design.at(turned.pose).joints[2]
        who, value, (low, high) = await announced(tab, "joint d3")
        assert who == ("slider", "joint d3")
        assert value == pytest.approx(joint, rel=1e-4)
        assert low <= joint <= high
        # One that cannot be used states it, and does so no more once it can.
        await tab.click("tab", "Motion")
        off = "document.querySelector('[aria-label=\"time of the motion\"]')?.ariaDisabled"
        await tab.until(f"{off} === 'true'")
        await tab.click("button", "Record a motion")
        await tab.click("button", "position z minus")
        await asyncio.sleep(0.1)
        await tab.click("button", "Record a motion")
        await tab.until(f"{off} === null")
        # None is announced twice.
        assert await tab.run("document.querySelectorAll('.q-slider[role]').length") == 0

    visit(work)


@pytest.mark.parametrize("width", [1366, 390])
def test_names_and_contrast(visit, width):
    async def work(tab):
        await tab.resize(width, 800)
        assert await check(tab) > 40
        for name in ("Legs", "Indices", "Plots", "Catalogue"):
            await tab.click("tab", name)
            assert await check(tab) > 20
        for name in ("Configuration", "Jacobian matrix"):
            await tab.click("button", name)
            await tab.named("dialog", name)
            await check(tab)
            await tab.key("Escape", 27)
            await tab.until("!document.querySelector('.q-dialog')")
        await tab.click("button", "File")
        for name in ("Open a design file …", "Save the design, with this pose"):
            await tab.named("menuitem", name)
        await check(tab)
        # Quasar's bar of requests has a role and no name while there are some.
        bars = "[...document.querySelectorAll('.q-loading-bar')]"
        assert await tab.run(f"{bars}.map((one) => getComputedStyle(one).display)") == ["none"]
        # One main landmark, one heading of the first level, a language.
        facts = "[...['main', 'h1', 'html[lang]']].map(e => document.querySelectorAll(e).length)"
        assert await tab.run(facts) == [1, 1, 1]

    visit(work)


def test_on_a_phone_the_scene_stays_in_view(visit):
    """Above the sliders, and it covers no control that has the focus."""

    async def work(tab):
        await tab.resize(390, 800)
        await tab.send("Page.bringToFront")
        boxes = (
            "[document.querySelector('.gsp-scene canvas'), document.activeElement]"
            ".map((one) => one.getBoundingClientRect()).flatMap((box) => [box.top, box.bottom])"
        )
        await tab.until("document.documentElement.scrollWidth <= 390")
        for name in ("yaw value", "position x value"):  # down, and up again
            field = await tab.named("textbox", name)
            if name == "yaw value":
                await tab.run("window.scrollTo(0, document.documentElement.scrollHeight)")
            await tab.send("DOM.focus", backendNodeId=field)
            await asyncio.sleep(0.3)
            assert await tab.run("window.scrollY") > 200.0
            top, bottom, first, last = await tab.run(boxes)
            assert 0.0 <= top < 8.0
            assert 200.0 < bottom < 0.4 * 800.0
            assert bottom <= first < last <= 800.0

    visit(work)


def test_states_are_seen_in_high_contrast(visit):
    """What is shown by a colour alone has it where the system replaces colours."""
    kept = (
        "(name) => [...document.querySelectorAll(name)].map("
        "(one) => getComputedStyle(one).forcedColorAdjust).join()"
    )

    async def work(tab):
        await tab.send(
            "Emulation.setEmulatedMedia", features=[{"name": "forced-colors", "value": "active"}]
        )
        for name in (".q-slider__track", ".q-checkbox__inner--truthy", "[aria-pressed=true]"):
            assert set((await tab.run(f"({kept})({name!r})")).split(",")) == {"none"}, name
        await tab.click("tab", "Indices")
        await tab.until("document.querySelector('.gsp-gauge') !== null")
        assert set((await tab.run(f"({kept})('.gsp-gauge span')")).split(",")) == {"none"}

    visit(work)


def test_faint_texts_are_found(visit):
    """The check of contrast can fail."""

    async def work(tab):
        await tab.run("document.querySelector('h2').style.color = '#999'")
        assert len((await tab.run(FAINT))["faint"]) == 1

    visit(work)


ACTIVE = """(() => {
  const one = document.activeElement;
  const text = one.innerText.trim().split('\\n').at(-1); // icons are texts in front
  const named = (element) => element?.getAttribute('aria-label');
  return named(one) || text || named(one.closest('[aria-label]'));
})()"""


# Whether the focus can be seen: an opaque outline of three pixels around what has it, in view, of
# which the luminance is not that of the page behind it.
SEEN = """(() => {
  const active = document.activeElement;
  const field = active.matches('.q-select__focus-target') && active.closest('.q-field__control');
  const one = field || active;
  const style = getComputedStyle(one);
  const box = one.getBoundingClientRect();
  const drawn = style.outlineStyle === 'solid' && parseFloat(style.outlineWidth) >= 3;
  const inside = box.width > 4 && box.height > 4 && box.bottom > 0 && box.top < innerHeight;
  const bar = Boolean(one.closest('.gsp-bar'));
  const colour = style.outlineColor === (bar ? 'rgb(255, 255, 255)' : 'rgb(0, 95, 153)');
  const opaque = one.checkVisibility({opacityProperty: true, visibilityProperty: true});
  return [drawn, inside, colour, opaque].every(Boolean) || one.outerHTML.slice(0, 200);
})()"""


# Mark what has had the focus.
WATCHED = """(() => {
  document.querySelectorAll('[data-met]').forEach((one) => one.removeAttribute('data-met'));
  document.addEventListener('focusin', (event) => event.target.setAttribute('data-met', ''));
  document.activeElement?.setAttribute('data-met', '');
})()"""
# The controls in view that have not had it; of tabs and toggles, arrow keys reach the others.
LEFT_OUT = """[...document.querySelectorAll(
    'button, input:not([type=file]), [role=slider], [role=checkbox], [role=tab], .gsp-scene')]
  .filter((one) => one.checkVisibility({ opacityProperty: true, visibilityProperty: true }))
  .filter((one) => !one.matches(':disabled, [aria-disabled=true], [tabindex="-1"] *'))
  .filter((one) => !one.matches('[data-met]') && !one.querySelector('[data-met]'))
  .filter((one) => !one.parentElement.closest('[data-met]'))
  .map((one) => one.outerHTML.slice(0, 160))"""


def test_the_focus_is_seen_at_every_stop(visit):
    async def stops(tab):
        """Press Tab from the first control to the last one; how many, and those without a mark."""
        await tab.run("document.querySelector('header input').focus()")
        hidden = []
        for count in range(150):
            await tab.key("Tab", 9)
            await asyncio.sleep(0.02)  # the page scrolls to what has the focus
            if await tab.run("document.activeElement === document.body"):
                return count, hidden
            seen = await tab.run(SEEN)
            hidden += [] if seen is True else [(await tab.run(ACTIVE), seen)]
        raise AssertionError("Tab does not come to an end")

    async def work(tab):
        await tab.send("Emulation.setFocusEmulationEnabled", enabled=True)
        for name in ("Motion", "Legs", "Indices", "Plots", "Catalogue"):
            await tab.click("tab", name)
            await asyncio.sleep(0.3)
            await tab.run(WATCHED)
            count, hidden = await stops(tab)
            assert count >= 15
            assert hidden == []
            assert await tab.run(LEFT_OUT) == []

    visit(work)


def test_escape_closes_dialogs_and_the_focus_returns(visit):
    async def work(tab):
        await tab.send("Emulation.setFocusEmulationEnabled", enabled=True)
        for name in ("Configuration", "Jacobian matrix"):
            button = await tab.named("button", name)
            await tab.send("DOM.focus", backendNodeId=button)
            await tab.key("Enter", 13)
            await tab.named("dialog", name)
            inside = "Boolean(document.activeElement.closest('.q-dialog'))"
            await tab.until(inside)
            for _ in range(40):  # nothing behind the dialog gets the focus
                await tab.key("Tab", 9)
                await tab.until(f"{inside} || document.activeElement === document.body", 2.0)
            await tab.key("Escape", 27)
            await tab.until("!document.querySelector('.q-dialog')")
            await tab.until(f"{ACTIVE} === '{name}'")
        # A menu, and a dialog that it opens.
        await tab.send("DOM.focus", backendNodeId=await tab.named("button", "File"))
        await tab.key("Enter", 13)
        await tab.named("menuitem", "Open a design file …")
        await tab.key("Escape", 27)
        await tab.until("!document.querySelector('.q-menu')")
        await tab.until(f"{ACTIVE} === 'File'")
        await tab.key("Enter", 13)
        await tab.named("menuitem", "Open a design file …")
        await tab.until("document.activeElement.matches('.q-menu')")
        await tab.key("ArrowDown", 40)
        await tab.until("document.activeElement.matches('[role=menuitem]')")
        await tab.key("Enter", 13)
        await tab.named("dialog", "Open a design file")
        await tab.key("Escape", 27)
        await tab.until("!document.querySelector('.q-dialog')")
        await tab.until(f"{ACTIVE} === 'File'")

    visit(work)


def test_by_keyboard_alone(visit):
    """Tab reaches every control in view; a motion and a dialog are used without a mouse."""
    design = gsp.catalogue.design(SIX_THREE)

    async def reach(tab, name, most=120):
        """Press Tab until the focus is on a control; the names on the way."""
        names = []
        for _ in range(most):
            await tab.key("Tab", 9)
            names.append(await tab.run(ACTIVE))
            if names[-1] == name:
                return names
        raise AssertionError(f"{name} is not among {names}")

    async def work(tab):
        names = await reach(tab, "Open a motion from a table")
        wanted = {
            "Design or mechanism", "Configuration", "Jacobian matrix", "File", "plan view",
            "Leg numbers", "Workspace", "Save the picture", "Motion", "position x", "yaw value",
            "position z plus", "Motion reset", "Record a motion",
        }  # fmt: skip
        assert wanted - set(names) == set()
        await tab.run("document.activeElement.blur(), window.scrollTo(0, 0)")
        await reach(tab, "position z plus")
        await tab.key("Enter", 13)
        moved = motion.nudged(started(design), "z", 1)
        wanted = np.linalg.det(design.at(moved.pose).jacobian)
        await tab.until(f"{FACTS}.includes('{wanted:.7g}')")
        await tab.run("document.activeElement.blur(), window.scrollTo(0, 0)")
        await reach(tab, "Configuration")
        await tab.key("Enter", 13)
        await tab.named("dialog", "Configuration")
        await reach(tab, "OK: this platform")
        await tab.key("Enter", 13)
        top, base = (
            choices.Half(kind=choices.TRIANGLE, size=size, separation=choices.EDGES, percent=0.0)
            for size in (choices.TOP_SIZE, choices.BASE_SIZE)
        )
        other = started(choices.configured(top, base))
        wanted = f"{np.linalg.det(other.design.at(other.pose).jacobian):.7g}"
        await tab.until(f"{FACTS}.includes('{wanted.replace('-', '−')}')")

    visit(work)
