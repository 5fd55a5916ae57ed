"""Clients of the page without a browser: they load it, and use the WebSocket of the server."""

from __future__ import annotations

import asyncio
import html
import json
import re
import urllib.request
import uuid
from contextlib import asynccontextmanager


class Page:
    """An open page.

    Attributes
    ----------
    elements : dict
        The elements of the page by their numbers, as the server last sent them.
    """

    def __init__(self, text, socket, client):
        raw = re.search(r"String\.raw`(.*?)`\)", text, re.DOTALL)[1]
        self.elements = json.loads(html.unescape(raw))
        self.socket, self.client = socket, client
        self.news = asyncio.Event()
        self.reader = asyncio.create_task(self._read())
        self.reader.add_done_callback(lambda _: self.news.set())

    def number(self, name):
        """The number of the element with an aria-label."""
        found = [
            k for k, e in self.elements.items() if e.get("props", {}).get("aria-label") == name
        ]
        assert len(found) == 1, (name, found)
        return found[0]

    @property
    def facts(self):
        """The texts of all elements."""
        return " ".join(
            str(e.get("props", {}).get("innerHTML", "")) for e in self.elements.values()
        )

    async def set(self, name, value):
        """Move a slider."""
        number = self.number(name)
        listener = next(
            one for one in self.elements[number]["events"] if one["type"] == "update:modelValue"
        )
        message = {
            "id": int(number),
            "client_id": self.client,
            "listener_id": listener["listener_id"],
            "args": [json.dumps(value)],
        }
        await self.socket.send("42" + json.dumps(["event", message]))

    async def until(self, condition, seconds=60.0):
        """Wait until a condition holds."""
        async with asyncio.timeout(seconds):
            while not condition():
                assert not self.reader.done(), "the server has closed the socket"
                self.news.clear()
                await self.news.wait()

    async def _read(self):
        async for text in self.socket:
            if text == "2":
                await self.socket.send("3")  # a ping
            elif text.startswith("42"):
                name, data = json.loads(text[2:])
                if name == "update":
                    found = {k: e for k, e in data.items() if isinstance(e, dict) and "tag" in e}
                    self.elements.update(found)
                    self.news.set()


@asynccontextmanager
async def opened(address):
    """A client with a page of its own."""
    import websockets

    text = await asyncio.to_thread(lambda: urllib.request.urlopen(address).read().decode())
    client = re.search(r"'client_id': '([^']+)'", text)[1]
    words = {
        "EIO": 4, "transport": "websocket", "client_id": client, "next_message_id": 0,
        "implicit_handshake": "true", "tab_id": uuid.uuid4(), "document_id": uuid.uuid4(),
    }  # fmt: skip
    query = "&".join(f"{key}={value}" for key, value in words.items())
    place = f"{address.replace('http', 'ws')}/_nicegui_ws/socket.io/?{query}"
    async with websockets.connect(place, max_size=None, origin=address) as socket:
        assert (await socket.recv()).startswith("0")
        await socket.send("40")
        page = Page(text, socket, client)
        yield page
        page.reader.cancel()
