"""A Chromium that tests drive by its remote debugging protocol; no further package is needed."""

from __future__ import annotations

import asyncio
import json
import shutil
import subprocess
import time
import urllib.request
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = (
    "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing", "--hide-scrollbars", "--no-first-run", "--remote-debugging-port=0",
    "about:blank",
)  # fmt: skip
# How long to wait for what is to happen soon [s]; a busy machine needs many times as long.
PATIENCE = 90.0
# Dots that are rendered for a pixel of the layout.
DOTS = 0.4

# How many colours the scene has: it is drawn anew, as its canvas keeps no picture.
COLOURS = """new Promise(done => requestAnimationFrame(() => {
  window.dispatchEvent(new Event('resize'));
  const from = document.querySelector('.gsp-scene canvas'), to = document.createElement('canvas');
  [to.width, to.height] = [from.width, from.height];
  document.querySelector('[aria-label="plan view"]').click();
  const look = () => {
    const pen = to.getContext('2d');
    pen.drawImage(from, 0, 0);
    const data = new Uint32Array(pen.getImageData(0, 0, to.width, to.height).data.buffer);
    const count = new Set(data).size;
    count > 50 ? done(count) : requestAnimationFrame(look);
  };
  look();
}))"""


# Where an element is, once it is in view, rests for two frames, and is what a click there hits.
MIDDLE = """async function () {
  this.addEventListener("click", () => (this.wasClicked = true), { capture: true, once: true });
  let before = null;
  for (const end = Date.now() + 60000; Date.now() < end;) {
    this.scrollIntoViewIfNeeded();
    const { x, y, width, height } = this.getBoundingClientRect();
    const place = [x + width / 2, y + height / 2], hit = document.elementFromPoint(...place);
    const free = hit && (this.contains(hit) || hit.contains(this));
    if (free && before?.join() === place.join()) return place;
    before = free ? place : null;
    await new Promise(requestAnimationFrame);
  }
  throw new Error(`behind ${document.elementFromPoint(...before ?? [0, 0])?.outerHTML}`);
}"""


def executable():
    """The path of a browser on this machine, or None."""
    return next(filter(None, map(shutil.which, NAMES)), None)


class Tab:
    """One page of the browser.

    Attributes
    ----------
    requests : list of str
        The addresses that the page loaded.
    errors : list of str
        Exceptions, and errors on the console.
    """

    def __init__(self, socket):
        self.socket, self.number = socket, 0
        self.requests, self.errors, self.answers = [], [], {}
        self.reader = asyncio.create_task(self._read())

    async def _read(self):
        async for text in self.socket:
            word = json.loads(text)
            if "id" in word:
                self.answers.pop(word["id"]).set_result(word.get("result", word))
            elif word["method"] == "Network.requestWillBeSent":
                self.requests.append(word["params"]["request"]["url"])
            elif word["method"] == "Network.webSocketCreated":
                self.requests.append(word["params"]["url"])
            elif word["method"] == "Runtime.exceptionThrown":
                self.errors.append(json.dumps(word["params"]["exceptionDetails"])[:500])
            elif word["method"] == "Log.entryAdded" and word["params"]["entry"]["level"] == "error":
                self.errors.append(json.dumps(word["params"]["entry"])[:500])

    async def send(self, method, *, seconds=PATIENCE, **parameters):
        self.number += 1
        self.answers[self.number] = future = asyncio.get_running_loop().create_future()
        message = {"id": self.number, "method": method, "params": parameters}
        await self.socket.send(json.dumps(message))
        return await asyncio.wait_for(future, seconds)

    async def run(self, script):
        """The value of a script in the page."""
        answer = await self.send(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    async def resize(self, width, height):
        """Show the page in so many pixels; of a narrow one, as a phone does.

        Pictures are rendered with fewer dots, as this has no effect on the layout and WebGL without
        a graphics processor takes most of the time.
        """
        await self.send(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=height, deviceScaleFactor=DOTS, mobile=width < 600,
        )  # fmt: skip

    async def still(self):
        """Wait until transitions have ended."""
        moving = "document.getAnimations().some((one) => one.playState === 'running')"
        classes = "[class*=-enter-active], [class*=-leave-active]"
        await self.until(f"!{moving} && !document.querySelector('{classes}')")

    async def until(self, script, seconds=PATIENCE):
        """Wait until a script has a value that counts as true, and return it."""
        for _ in range(int(seconds / 0.05)):
            value = await self.run(script)
            if value:
                return value
            await asyncio.sleep(0.05)
        notes = await self.run("document.querySelector('.q-notifications')?.innerText")
        raise AssertionError(f"{script} is still {value!r}; {notes=}; errors: {self.errors}")

    async def named(self, role, name, seconds=PATIENCE):
        """The one element with a role and a name in the accessibility tree: its DOM node."""
        for _ in range(int(seconds / 0.05)):
            root = (await self.send("DOM.getDocument", depth=0))["root"]["nodeId"]
            found = await self.send(
                "Accessibility.queryAXTree", nodeId=root, role=role, accessibleName=name
            )
            nodes = [one for one in found.get("nodes", []) if not one["ignored"]]
            if len(nodes) == 1:
                return nodes[0]["backendDOMNodeId"]
            await asyncio.sleep(0.05)
        raise AssertionError(f"{role} {name!r}: {len(nodes)} elements; errors: {self.errors}")

    async def placed(self, role, name, *, again=True):
        """An element, and its middle while it is in view, at rest, and not behind another."""
        await self.send("Page.bringToFront")
        node = await self.send("DOM.resolveNode", backendNodeId=await self.named(role, name))
        answer = await self.call(node, MIDDLE)
        place = answer.get("result", {}).get("value")
        if not place and again:  # the page was laid out anew meanwhile
            return await self.placed(role, name, again=False)
        assert place, f"{role} {name!r} is not at rest: {answer}"
        return node, place

    async def call(self, node, function):
        return await self.send(
            "Runtime.callFunctionOn", objectId=node["object"]["objectId"],
            functionDeclaration=function, awaitPromise=True, returnByValue=True,
        )  # fmt: skip

    async def middle(self, role, name):
        """The middle of the element of a role and a name."""
        _, place = await self.placed(role, name)
        return place

    async def click(self, role, name, *, again=True):
        """Click with the mouse on the middle of the element of a role and a name.

        Tabs behind others are not laid out, and have no accessibility tree. Where the page was laid
        out anew between the look and the click, the click missed the element, and is made again.
        """
        node, (x, y) = await self.placed(role, name)
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            await self.send(
                "Input.dispatchMouseEvent", type=kind, button="left", clickCount=1, x=x, y=y
            )
        answer = await self.call(node, "function () { return this.wasClicked ?? false; }")
        if answer.get("result", {}).get("value") is False and again:
            await self.click(role, name, again=False)

    async def enter(self, role, name, text):
        """Replace the text of a field, and press Enter."""
        await self.send("DOM.focus", backendNodeId=await self.named(role, name))
        await self.run("document.activeElement.select()")
        await self.send("Input.insertText", text=text)
        await self.key("Enter", 13)

    async def give_file(self, path, dialog):
        """Choose a file in the upload of a dialog, by the heading of the dialog."""
        script = (
            "[...document.querySelectorAll('.q-dialog')].find(one => one.innerText.includes("
            f"{json.dumps(dialog)}))?.querySelector('input[type=file]')"
        )
        for _ in range(100):
            answer = await self.send("Runtime.evaluate", expression=script)
            if "objectId" in answer["result"]:
                break
            await asyncio.sleep(0.05)
        place = answer["result"]["objectId"]
        await self.send("DOM.setFileInputFiles", files=[str(path)], objectId=place)

    async def key(self, name, code):
        """Press a key, as a user does."""
        letter = {"text": "\r"} if name == "Enter" else {}  # buttons of the browser need it
        for kind, more in (("keyDown", letter), ("keyUp", {})):
            await self.send(
                "Input.dispatchKeyEvent", type=kind, key=name, code=name,
                windowsVirtualKeyCode=code, **more,
            )  # fmt: skip


@contextmanager
def launched(folder):
    """The port of the debugging protocol of a browser with a profile of its own."""
    process = subprocess.Popen(
        [executable(), f"--user-data-dir={folder}", *FLAGS],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    told = Path(folder) / "DevToolsActivePort"  # the port, and a line on an address
    try:
        while not (told.exists() and "\n" in told.read_text()):
            assert process.poll() is None, "the browser has ended"
            time.sleep(0.05)
        yield int(told.read_text().split("\n")[0])
    finally:
        process.terminate()
        process.wait(20)


@asynccontextmanager
async def tabs(port, downloads):
    """A function that opens a tab at an address.

    The tabs share what a window without a history shares, save files in a folder, and may read
    what was copied.
    """
    import websockets

    with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/version") as answer:
        place = json.load(answer)["webSocketDebuggerUrl"]
    whole = Tab(await websockets.connect(place, max_size=None))
    context = (await whole.send("Target.createBrowserContext"))["browserContextId"]
    await whole.send(
        "Browser.setDownloadBehavior",
        behavior="allow", browserContextId=context, downloadPath=str(downloads),
    )  # fmt: skip
    await whole.send(
        "Browser.grantPermissions",
        browserContextId=context, permissions=["clipboardReadWrite", "clipboardSanitizedWrite"],
    )  # fmt: skip
    seen = [whole]

    async def opened(address, width=1280, height=800):
        target = await whole.send(
            "Target.createTarget", url="about:blank", browserContextId=context
        )
        place = f"ws://127.0.0.1:{port}/devtools/page/{target['targetId']}"
        tab = Tab(await websockets.connect(place, max_size=None))
        seen.append(tab)
        for part in ("Runtime", "Log", "Network", "Page", "DOM", "Accessibility"):
            await tab.send(f"{part}.enable")
        await tab.resize(width, height)
        await tab.send("Page.navigate", url=address)
        return tab

    try:
        yield opened
        await whole.send("Target.disposeBrowserContext", browserContextId=context)
    finally:
        for tab in seen:
            tab.reader.cancel()
            await tab.socket.close()


@asynccontextmanager
async def browser(folder):
    """A function that opens a tab at an address, in a browser of its own."""
    with launched(folder / "profile") as port:
        async with tabs(port, folder) as opened:
            yield opened
