"""From a step of a slider to the new number on the page of `gsp app`, in a real browser.

`python -m benchmarks --only app`
"""

from __future__ import annotations

import asyncio
import json
import random
import tempfile
import time
import urllib.request
from contextlib import AsyncExitStack, suppress
from pathlib import Path

import numpy as np

import gsp
from benchmarks.timing import markdown
from gsp.app.page.tables import facts
from gsp.app.state import motion
from gsp.app.state.reading import read
from gsp.app.state.session import started
from tests.app import chromium, sockets
from tests.app.serving import server

DESIGN = "toz-kucuk-2016-d3-6"
# Steps of a tab alone, and open tabs with the steps of each and the pause between them in ms.
STEPS, PAUSE = 200, 150
TABS, STEPS_OF_EACH, PAUSE_OF_EACH = 20, 20, 1000
# Presses an arrow key on the slider and waits until the number of det J is another one.
MOVED = """(async () => {
  const slider = document.querySelector('[aria-label="yaw"] [tabindex="0"]');
  const shown = () => document.querySelector('.gsp-facts dd').innerText;
  const press = (kind) => slider.dispatchEvent(
    new KeyboardEvent(kind, {key: 'ArrowRight', keyCode: KEY, bubbles: true}));
  const times = [];
  for (let i = 0; i < STEPS; i++) {
    await new Promise((done) => setTimeout(done, PAUSE * (0.5 + Math.random())));
    const before = shown(), start = performance.now();
    await new Promise((done) => {
      const watch = new MutationObserver(() => {
        if (shown() === before) return;
        watch.disconnect();
        done();
      });
      watch.observe(document.querySelector('.gsp-facts').parentElement.parentElement,
        {subtree: true, childList: true, characterData: true});
      press('keydown');
      press('keyup');
    });
    times.push(performance.now() - start);
  }
  return times;
})()"""


def reading(steps: int) -> np.ndarray:
    """Return seconds of the computation of each step, without a page."""
    state, times = started(gsp.catalogue.design(DESIGN)), np.empty(steps)
    for i in range(steps):
        start = time.perf_counter()
        value = motion.coordinates(state.pose)[5] + 0.1
        state = motion.with_coordinate(state, "yaw", value)
        facts(state, read(state))
        times[i] = time.perf_counter() - start
    return times


async def moved(tab: chromium.Tab, steps: int, pause: int, right: bool = True) -> np.ndarray:
    """Return seconds of each step of the slider in one tab."""
    script = MOVED.replace("STEPS", str(steps)).replace("PAUSE", str(pause))
    script = script.replace("KEY", "39" if right else "37")
    answer = await tab.send(
        "Runtime.evaluate", seconds=600.0, expression=script, awaitPromise=True, returnByValue=True
    )
    return np.array(answer["result"]["value"]) / 1e3


async def sent(page: sockets.Page, steps: int, pause: int) -> np.ndarray:
    """Return seconds from each step of a client without a browser to the number that it is sent."""
    times = np.empty(steps)
    for i in range(steps):
        await asyncio.sleep(pause / 1e3 * (0.5 + random.random()))
        before, start = page.facts, time.perf_counter()
        await page.set("yaw", -10.0 + 0.1 * (i + 1))
        await page.until(lambda before=before: page.facts != before)
        times[i] = time.perf_counter() - start
    return times


async def without_browser(address: str) -> np.ndarray:
    """Return the times of many clients that draw nothing."""
    async with AsyncExitStack() as stack:
        pages = [await stack.enter_async_context(sockets.opened(address)) for _ in range(TABS)]
        each = (sent(page, STEPS_OF_EACH, PAUSE_OF_EACH) for page in pages)
        return np.concatenate(await asyncio.gather(*each))


def rank(address: str) -> None:
    """Rank the catalogue for another program."""
    request = urllib.request.Request(
        f"{address}/api/rank",
        json.dumps({"index": "CTN"}).encode(),
        {"Content-Type": "application/json"},
    )
    urllib.request.urlopen(request).close()


async def measured(address: str, folder: Path) -> dict[str, np.ndarray]:
    """Return the times of the steps of a tab alone, beside rankings, and of many tabs."""
    found = {}
    async with chromium.browser(folder) as opened:
        first = await ready(opened, address)
        await moved(first, 5, PAUSE)
        found["one tab"] = await moved(first, STEPS, PAUSE)
        stop = asyncio.Event()

        async def ranked() -> None:
            while not stop.is_set():
                await asyncio.to_thread(rank, address)

        busy = asyncio.create_task(ranked())
        found["one tab, while another client ranks the catalogue again and again"] = await moved(
            first, STEPS, PAUSE, right=False
        )
        stop.set()
        await busy
        tabs = [first] + [await ready(opened, address) for _ in range(TABS - 1)]
        await asyncio.gather(*(moved(tab, 2, PAUSE_OF_EACH) for tab in tabs))
        times = await asyncio.gather(*(moved(tab, STEPS_OF_EACH, PAUSE_OF_EACH) for tab in tabs))
        found[f"{TABS} tabs, one step per second in each"] = np.concatenate(times)
    return found


async def ready(opened, address: str) -> chromium.Tab:
    """Return a tab that shows the numbers of the design."""
    tab = await opened(address, 1366, 768)
    with suppress(KeyError):
        await tab.send("Emulation.setFocusEmulationEnabled", enabled=True)
    await tab.until("document.querySelector('.gsp-facts dd')?.innerText", 120.0)
    return tab


def section() -> str:
    """Return the table of docs/performance.md."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        with server(place, DESIGN) as address:
            times = asyncio.run(measured(address, place / "profile"))
            times[f"{TABS} clients without a browser, one step per second in each"] = asyncio.run(
                without_browser(address)
            )
    alone = "the computation alone, without a page"
    times = {alone: reading(STEPS), **times}
    rows = [
        (
            name,
            f"{1e3 * np.median(each):.1f}",
            f"{1e3 * each.min():.1f}",
            f"{1e3 * np.quantile(each, 0.95):.1f}",
            f"{np.median(each) / np.median(times[alone]):.1f}",
        )
        for name, each in times.items()
    ]
    head = ("what", "median, ms", "least", "95 %", "median over that of the computation")
    return markdown(head, rows)
