"""Many clients at once, foreign sockets, a killed server, uploads and entries that are none."""

from __future__ import annotations

import asyncio
import json
import time
import urllib.request
from contextlib import AsyncExitStack

import numpy as np
import pytest

import gsp
from gsp.app.page.panels.controls import NAMES
from gsp.app.page.tables import number as text_of
from gsp.app.state import motion
from gsp.app.state.session import started
from tests import campaign
from tests.app import chromium, sockets
from tests.app.serving import server
from tests.app.visiting import FACTS, SIX_THREE, TEXT

websockets = pytest.importorskip("websockets", reason="the extra `app` is not installed")
pytest.importorskip("nicegui", reason="the extra `app` is not installed")
in_browser = pytest.mark.skipif(
    chromium.executable() is None, reason="no Chromium is installed: the page is not tested in it"
)

CLIENTS, STEPS = campaign.count(8, 20), campaign.count(3, 5)


def test_many_clients_move_sliders_at_once(served):
    """Each has a motion of its own, and sees the number of the library at each of its poses."""
    start = started(gsp.catalogue.design(SIX_THREE))

    async def one(page, client):
        state = start
        for step in range(STEPS):
            number = (2, 5, 0)[step % 3]
            value = motion.coordinates(state.pose)[number] + 0.01 * (client + 1)
            state = motion.with_coordinate(state, motion.COORDINATES[number], value)
            await page.set(NAMES[number], float(value))
            shown = f"<dd>{text_of(np.linalg.det(state.design.at(state.pose).jacobian), 7)}</dd>"
            await page.until(lambda shown=shown: shown in page.facts)

    async def work(address):
        async with AsyncExitStack() as stack:
            pages = [
                await stack.enter_async_context(sockets.opened(address)) for _ in range(CLIENTS)
            ]
            await asyncio.gather(*(one(page, i) for i, page in enumerate(pages)))

    asyncio.run(work(served))


def test_sockets_of_other_origins_are_refused(served):
    async def status(address, **headers):
        place = f"{address.replace('http', 'ws')}/_nicegui_ws/socket.io/?EIO=4&transport=websocket"
        try:
            async with websockets.connect(place, **headers) as socket:
                return (await socket.recv())[:1]
        except websockets.exceptions.InvalidStatus as error:
            return error.response.status_code

    async def work(address):
        assert await status(address, origin=address) == "0"
        assert await status(address, origin="http://evil.example") == 403
        assert await status(address, origin=address.replace("127.0.0.1", "localhost")) == 403
        foreign = {"additional_headers": {"Host": "evil.example"}}
        assert await status(address, origin="http://evil.example", **foreign) == 403

    asyncio.run(work(served))


def asked(address, path, body):
    request = urllib.request.Request(
        f"{address}/api/{path}",
        json.dumps(body).encode(),
        {"Content-Type": "application/json"},
    )
    with urllib.request.urlopen(request) as answer:
        return json.load(answer)


def until_known(address, body):
    """Ask for a maximum until it is known; the status of the first answer, and the last answer."""
    first = found = asked(address, "maximum", body)
    for _ in range(int(chromium.PATIENCE / 0.05)):
        if found["status"] == "known":
            break
        assert found["status"] in ("waiting", "processing"), found
        time.sleep(0.1)
        found = asked(address, "maximum", body)
    return first["status"], found["maximum"]


def until_begun(address, body):
    """Ask for a maximum until its search has sent something from its own process."""
    for _ in range(1200):
        found = asked(address, "maximum", body)
        if found["done"] or found["status"] == "known":
            return
        time.sleep(0.05)
    raise AssertionError("the search has not begun")


def test_a_killed_server_keeps_its_store(tmp_path):
    """Also where it was killed during the search of another maximum."""
    body = {"design": "dehaeze-cubic-low"}
    other = {"design": "toz-kucuk-2016-d1-d2-d3-d4-a1-2"}  # takes seconds
    with server(tmp_path, SIX_THREE, killed=True) as address:
        status, found = until_known(address, body)
        assert status != "known"
        until_begun(address, other)
    with server(tmp_path, SIX_THREE) as address:
        assert until_known(address, body) == ("known", found)
        _, again = until_known(address, other)
        assert again["value"] > 0.0


@in_browser
def test_files_and_entries_that_are_none_change_nothing(visit, tmp_path):
    """Each gives a message; afterwards a good file is loaded, and its number is shown."""
    files = {
        "broken.toml": b"[[legs]\n",
        "picture.toml": bytes(range(256)),
        "empty.toml": b"",
        "great.toml": b"# \n" * 1_000_000,
    }
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    good = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    good.write(tmp_path / "good.toml")

    async def work(tab):
        before = await tab.run(FACTS)
        shown = "document.querySelector('[aria-label=\"position x value\"]').value"
        value = await tab.run(shown)
        for entry in ("1e300", "abc", "-1e300", "1e400", "", "nan"):
            wanted = (
                "pose: expected a position within"
                if "300" in entry
                else ("position x: expected a finite number")
            )
            await tab.enter("textbox", "position x value", entry)
            await tab.until(f"{TEXT}.includes('{wanted}')")
            await tab.until(f"{shown} === '{value}'")
            assert await tab.run(FACTS) == before
        await tab.enter("textbox", "Increment of rotations [°]", "-5")
        await tab.until(f"{TEXT}.includes('increment of rotations: expected a number from')")
        await tab.click("button", "File")
        await tab.click("menuitem", "Open a design file …")
        for name in files:
            await tab.give_file(tmp_path / name, "Open a design file")
            message = "of at most 800,000 bytes" if name == "great.toml" else name
            notes = "[...document.querySelectorAll('.q-notification')].map(e => e.innerText).join()"
            await tab.until(f"{notes}.includes({json.dumps(message)})")
            assert await tab.run(FACTS) == before
        await tab.give_file(tmp_path / "good.toml", "Open a design file")
        wanted = np.linalg.det(good.at(good.home).jacobian)
        await tab.until(f"{FACTS}.includes({json.dumps(text_of(wanted, 7))})")

    visit(work)
