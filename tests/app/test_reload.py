"""Pages that are loaded again, after a restart of the server too, and slow networks."""

from __future__ import annotations

import asyncio
import json
from contextlib import suppress
from urllib.parse import parse_qsl

import numpy as np
import pytest

import gsp
from gsp.app.page.tables import number as text_of
from gsp.app.state import links, motion
from gsp.app.state import session as sessions
from gsp.app.state.session import started
from tests.app import chromium
from tests.app.serving import free_port, server
from tests.app.visiting import FACTS, SIX_THREE, TEXT

pytest.importorskip("nicegui", reason="the extra `app` is not installed")
pytestmark = pytest.mark.skipif(
    chromium.executable() is None, reason="no Chromium is installed: the page is not tested in it"
)
OTHER = "lee-2000-3-3"
# Bytes per second and milliseconds of a slow network of phones.
SLOW = {"offline": False, "downloadThroughput": 50_000, "uploadThroughput": 20_000, "latency": 400}
NOT_CONNECTED = f"{TEXT}.includes('Not connected: changes are not taken.')"
# Sockets are not among the addresses that a browser blocks.
NO_SOCKETS = """window.WebSocket = class extends WebSocket {
  constructor(...words) {
    if (!window.open_to_sockets) throw new Error("blocked");
    super(...words);
  }
};"""


def determinant(state):
    """The det J of a state, as the page shows it."""
    return json.dumps(text_of(np.linalg.det(state.design.at(state.pose).jacobian), 7))


def test_a_restarted_server_loses_no_state(browsed, tmp_path):
    """An open page loads itself again: with its own design and limits, pose and length."""
    port = free_port()
    state = started(gsp.catalogue.design(SIX_THREE))
    least, _ = sessions.common_strokes(state)  # stays
    state = sessions.with_strokes(sessions.with_length(state, 7.5), least, 99.0)
    state = motion.nudged(motion.nudged(state, "x", 1), "yaw", 1)
    loaded = "performance.timeOrigin"

    async def work():
        async with chromium.tabs(browsed, tmp_path) as opened:
            with server(tmp_path, SIX_THREE, killed=True, port=port) as address:
                tab = await opened(address, 1366, 768)
                await tab.until(FACTS)
                assert await tab.run("location.search") == ""
                await tab.click("tab", "Indices")
                await tab.enter("textbox", "Characteristic length", "7.5")
                await tab.click("tab", "Legs")
                await tab.enter("textbox", "Greatest", "99")
                await tab.click("button", "Set limits")
                await tab.until(f"{TEXT}.includes('… 99')")
                await tab.click("tab", "Motion")
                await tab.click("button", "position x plus")
                await tab.click("button", "yaw plus")
                await tab.until(f"{FACTS}.includes({determinant(state)})")
                query = await tab.until(
                    "location.search.includes('rotation=0.0%2C0.0%2C0.04') && location.search"
                )
                words = dict(parse_qsl(query.removeprefix("?")))
                kept = links.restored(words, gsp.catalogue.design(OTHER))
                assert kept.pose.position == pytest.approx(state.pose.position, abs=1e-12)
                assert kept.pose.rotation == pytest.approx(state.pose.rotation, abs=1e-12)
                assert np.array_equal(kept.design.strokes, state.design.strokes, equal_nan=True)
                assert kept.length == 7.5
                first = await tab.run(loaded)
            with server(tmp_path, OTHER, port=port):
                await tab.until(f"{loaded} !== {first} && Boolean({FACTS})")
                await tab.until(f"{FACTS}.includes({determinant(state)})")
                wanted = gsp.indices.condition_number(state.design.at(state.pose), 7.5)
                assert text_of(float(wanted)) in await tab.run(FACTS)

    asyncio.run(work())


def test_a_reloaded_page_has_its_state(visit):
    """The address stays while nothing changes, and follows another design."""

    async def work(tab):
        await asyncio.sleep(1.0)
        assert await tab.run("location.search") == ""
        address = await tab.run("location.origin")
        await tab.send("Page.navigate", url=f"{address}/?design={OTHER}&rpy_deg=0,0,20")
        design = gsp.catalogue.design(OTHER)
        pose = gsp.Pose.from_rpy(design.home.position, [0.0, 0.0, 20.0], degrees=True)
        state = started(design, pose)
        await tab.until(f"{FACTS}?.includes({determinant(state)})")
        await tab.click("button", "position z plus")
        state = motion.nudged(state, "z", 1)
        await tab.until("location.search.includes('rotation=')")
        await tab.send("Page.reload")
        await asyncio.sleep(0.5)
        await tab.until(f"{FACTS}?.includes({determinant(state)})")

    visit(work)


def test_a_page_that_cannot_connect_states_it(visit):
    """What was loaded is shown, but no connection is opened afterwards."""

    async def work(tab):
        address = await tab.run("location.origin")
        await tab.send("Network.setBlockedURLs", urls=["*/socket.io/*"])
        await tab.send("Page.addScriptToEvaluateOnNewDocument", source=NO_SOCKETS)
        await tab.send("Page.navigate", url=f"{address}/?design={OTHER}")
        await tab.until(f"document.body && {NOT_CONNECTED}")
        assert await tab.run("document.querySelector('#popup').ariaHidden") == "true"
        assert await tab.run("Boolean(document.querySelector('#app').inert)")
        await tab.send("Network.setBlockedURLs", urls=[])
        await tab.run("window.open_to_sockets = true")
        await tab.until("!document.querySelector('#app').inert")
        assert not await tab.run(f"{TEXT}.includes('Not connected')")
        tab.errors.clear()  # of requests that were blocked

    visit(work)


def test_a_slow_network(visit):
    """The page is loaded, a slider ends where it was left, and a break is overcome."""

    async def work(tab):
        await tab.send("Network.setCacheDisabled", cacheDisabled=False)
        await tab.send("Network.emulateNetworkConditions", **SLOW)
        address = await tab.run("location.origin")
        await tab.send("Page.navigate", url=f"{address}/?design={OTHER}")
        state = started(gsp.catalogue.design(OTHER))
        await tab.until(f"{FACTS}?.includes({determinant(state)})")
        slider = 'document.querySelector(\'[aria-label="yaw"][tabindex="0"]\')'
        await tab.until(f"{slider} !== null")
        await tab.run(f"{slider}.focus()")
        for _ in range(30):
            await tab.key("ArrowRight", 39)
        value = await tab.until(
            f"{slider}.closest('[aria-valuenow]')?.ariaValueNow || {slider}.ariaValueNow"
        )
        turned = motion.with_coordinate(state, "yaw", float(value))
        await tab.until(f"{FACTS}.includes({determinant(turned)})")
        await tab.send("Network.emulateNetworkConditions", **{**SLOW, "offline": True})
        # The page states that it has no connection, and nothing can be changed meanwhile.
        await tab.until(NOT_CONNECTED)
        await tab.named("alert", "")
        assert await tab.run("Boolean(document.querySelector('#app').inert)")
        assert await tab.run(f"{slider}.focus(), document.activeElement === document.body")
        await tab.send("Network.emulateNetworkConditions", **SLOW)
        await tab.until("!document.querySelector('#app').inert")
        assert not await tab.run(f"{TEXT}.includes('Not connected')")
        # Afterwards it works again, also where it had to be loaded again meanwhile.
        turned = motion.with_coordinate(turned, "yaw", 12.5)
        for _ in range(30):
            with suppress(AssertionError):
                await tab.enter("textbox", "yaw value", "12.5")
                await tab.until(f"{FACTS}?.includes({determinant(turned)})", seconds=3.0)
                break
        assert await tab.run(f"{FACTS}.includes({determinant(turned)})")
        tab.errors.clear()  # of requests while there was no network

    visit(work)
