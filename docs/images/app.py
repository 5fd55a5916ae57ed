"""Make app.png: the page of `gsp app` in Chromium, with a curve and a map of the control number."""

import asyncio
import base64
import tempfile
from pathlib import Path

from tests.app import chromium
from tests.app.serving import server
from tests.app.visiting import FACTS

DESIGN = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"
WIDTH, HEIGHT = 1366, 860
# Both plots are drawn.
PLOTS = "[...document.querySelectorAll('.gsp-plot, .gsp-map > *')]"
DRAWN = f"{PLOTS}.filter((plot) => plot.querySelector('canvas')).length === 2"
chromium.DOTS = 1.0


async def picture(address: str, folder: Path) -> bytes:
    """Return the page as PNG, with the maximum of |det J| known and the panel of plots."""
    async with chromium.browser(folder) as opened:
        tab = await opened(address, WIDTH, HEIGHT)
        await tab.until(FACTS)
        await tab.click("tab", "Indices")
        await tab.click("button", "Get maximum")
        await tab.until("document.body.innerText.includes('|det J|max =')", 600.0)
        await tab.click("tab", "Plots")
        await tab.until(DRAWN)
        await tab.send("Page.bringToFront")
        await asyncio.sleep(2.0)  # the notes that pass
        shot = await tab.send("Page.captureScreenshot", format="png")
        return base64.b64decode(shot["data"])


def main() -> None:
    """Write the picture beside this file."""
    with tempfile.TemporaryDirectory() as name, server(Path(name), DESIGN) as address:
        data = asyncio.run(picture(address, Path(name)))
    Path(__file__).with_name("app.png").write_bytes(data)


if __name__ == "__main__":
    main()
