"""Tools of the page in a real browser, by role and name: modes, workspace, motions, files."""

from __future__ import annotations

import asyncio
import re
from io import BytesIO

import numpy as np
import pandas as pd
import pytest

import gsp
from tests.app import chromium
from tests.app.visiting import FACTS, SIX_THREE, TEXT
from tests.app.webm import pictures

pytest.importorskip("nicegui", reason="the extra `app` is not installed")
pytestmark = pytest.mark.skipif(
    chromium.executable() is None, reason="no Chromium is installed: the page is not tested in it"
)


async def downloaded(tmp_path, name):
    """The bytes of a file that the page saves."""
    for _ in range(int(chromium.PATIENCE / 0.05)):
        if (tmp_path / name).exists():
            return (tmp_path / name).read_bytes()
        await asyncio.sleep(0.05)
    raise AssertionError([path.name for path in tmp_path.iterdir()])


def number(text, name):
    return float(re.search(rf"{re.escape(name)}[^\n]*\n(\S+)", text)[1].replace("−", "-"))


# The note on the recorded motion.
NOTE = """document.querySelector('[aria-label="Open a motion from a table"]')
  .closest('.gsp-row').nextElementSibling.innerText"""


# What the scene has beside the mechanism, from its labels and surfaces.
GHOSTS = "[...document.querySelectorAll('.gsp-label-ghost')].map(e => e.innerText)"


# The assembly modes whose names are not inside of the scene.
CUT = """(() => {
  const stage = document.querySelector('.gsp-scene').getBoundingClientRect();
  const outside = (box) => box.left < stage.left || box.right > stage.right
    || box.top < stage.top || box.bottom > stage.bottom;
  return [...document.querySelectorAll('.gsp-label-ghost')]
    .filter((one) => outside(one.getBoundingClientRect())).map((one) => one.innerText);
})()"""


@pytest.mark.parametrize("width", [1366, 390])
def test_all_assembly_modes_are_in_the_picture(visit, width):
    async def work(tab):
        await tab.resize(width, 800)
        before = "document.querySelector('.gsp-label-number').style.transform"
        await tab.click("tab", "Legs")
        await asyncio.sleep(0.5)
        place = await tab.run(before)
        await tab.click("button", "Find all assembly modes")
        await tab.until(f"{GHOSTS}.length === 7")
        await tab.until(f"{before} !== '{place}'")
        assert await tab.run(CUT) == []
        await tab.click("button", "plan view")
        await asyncio.sleep(0.2)
        assert await tab.run(CUT) == []
        await tab.click("button", "space view")
        await tab.click("button", "Hide the assembly modes")
        await tab.until(f"{GHOSTS}.length === 0")
        await tab.until(f"{before} === '{place}'")  # the former view

    visit(work)


def test_modes_workspace_and_motion(visit, tmp_path):
    design = gsp.catalogue.design(SIX_THREE)
    joints = design.at(design.home).joints
    modes = gsp.assembly_modes(design, joints)

    async def work(tab):
        # Assembly modes: the others are ghosts, and a choice jumps.
        await tab.click("tab", "Legs")
        await tab.click("button", "Find all assembly modes")
        here = int(np.abs(modes.poses.position - design.home.position).sum(axis=1).argmin())
        others = [str(i + 1) for i in range(8) if i != here]
        await tab.until(f"{GHOSTS}.length === 7")
        assert sorted(await tab.run(GHOSTS)) == others
        other = (here + 3) % 8
        sign = {-1.0: "<", 1.0: ">"}[modes.side[other]]
        await tab.click("button", f"assembly mode {other + 1}, det J {sign} 0")
        wanted = np.linalg.det(design.at(modes.poses[other]).jacobian)
        text = await tab.until(f"{TEXT}.includes('assembly mode {other + 1} of 8') && {FACTS}")
        assert number(text, "det J") == pytest.approx(wanted, rel=1e-6)
        await tab.until(f"!{GHOSTS}.includes('{other + 1}')")
        # Other joint values have other modes.
        await tab.click("button", "joint d1 plus")
        await tab.until(f"{GHOSTS}.length === 0")
        # The workspace at the present rotation, with its volume.
        await tab.click("tab", "Motion")
        await tab.click("button", "Motion reset")
        await tab.click("checkbox", "Workspace")
        text = await tab.until(f"{TEXT}.includes('volume ≈') && {TEXT}")
        shells = gsp.workspace.exact_shells(design, design.home.rotation, gsp.Limits())
        exact = shells.volume((0.0, np.inf)).value
        assert float(re.search(r"volume ≈ (\S+)", text)[1]) == pytest.approx(exact, rel=0.02)
        # A motion is recorded, played and saved.
        await tab.click("button", "Record a motion")
        for _ in range(3):
            await tab.click("button", "position z minus")
            await asyncio.sleep(0.1)
        await tab.click("button", "Record a motion")
        await tab.until(f"/[3-9] samples in/.test({TEXT})")
        lowest = number(await tab.run(FACTS), "det J")
        await tab.click("button", "Motion reset")
        await tab.until(f"!{FACTS}.includes('{lowest}')")
        await tab.click("button", "Play the motion")
        await tab.until(f"{FACTS}.replace('−', '-').includes('{lowest:.7g}')")
        await tab.click("button", "Save the motion as a table")
        table = (await downloaded(tmp_path, f"{SIX_THREE}-motion.csv")).decode()
        rows = [line.split(",") for line in table.splitlines()]
        assert rows[0][:4] == ["time", "x", "y", "z"]
        assert float(rows[1][3]) == pytest.approx(design.home.position[2])
        assert 0.2 < float(rows[-1][0]) - float(rows[1][0])

    visit(work)


def test_films_of_a_motion(visit, tmp_path):
    """Of a motion from a table: one that is recorded lasts as long as the browser needs for it."""
    image = pytest.importorskip("PIL.Image", reason="Pillow is not installed")
    home, times = gsp.catalogue.design(SIX_THREE).home, np.linspace(0.0, 0.3, 7)
    table = pd.DataFrame({"time": times})
    table[["x", "y", "z"]] = home.position - np.outer(times, [0.0, 0.0, 2.0])
    table[["angle_1", "angle_2", "angle_3"]] = home.angles("rpy", degrees=True)
    table.to_csv(tmp_path / "down.csv", index=False)

    async def saved(tab, kind):
        """Save a film, once the page is in view: before, it is not begun, and a note states why."""
        hidden = "Object.defineProperty(document, 'hidden', {configurable: true, get: () => %s})"
        await tab.run(hidden % "true" + ".hidden")
        await tab.click("button", f"Save the motion as {kind}")
        await tab.until(f"{NOTE}.includes('the page was not in view')")
        await tab.run(hidden % "false" + ".hidden")
        await tab.click("button", f"Save the motion as {kind}")
        # How long it takes depends on the browser: its end is awaited, whatever is noted then.
        await tab.until(f"!{NOTE}.includes('not in view') && !{NOTE}.startsWith('processing')")

    async def work(tab):
        await tab.resize(1000, 600)
        await tab.click("tab", "Motion")
        await tab.click("button", "Open a motion from a table")
        await tab.give_file(tmp_path / "down.csv", "Open a motion")
        await tab.until(f"{NOTE}.startsWith('7 samples in 0.3 s')")
        await saved(tab, "GIF")
        assert (await tab.run(NOTE)).endswith("frames were saved")
        film = image.open(BytesIO(await downloaded(tmp_path, f"{SIX_THREE}.gif")))
        frames = []
        for i in range(film.n_frames):
            film.seek(i)
            frames.append(np.array(film.convert("RGB")))
        assert len(frames) > 3
        for one in (frames[0], frames[-1]):
            assert len(np.unique(one.reshape(-1, 3), axis=0)) > 100
        assert (frames[0] != frames[-1]).any(axis=-1).mean() > 0.005
        await saved(tab, "video")
        film = await downloaded(tmp_path, f"{SIX_THREE}.webm")
        assert film[:4] == bytes([0x1A, 0x45, 0xDF, 0xA3])  # EBML
        # As large as the pictures of the GIF.
        width, height, shown = pictures(film)
        assert (height, width) == frames[0].shape[:2]
        assert shown == sorted({*shown})
        # As long as the motion at least, or the note states what a busy browser has lost.
        whole = shown[-1] - shown[0] >= 300.0 * (1.0 - 1.0 / len(frames)) and len(shown) > 3
        note = await tab.run(NOTE)
        assert whole or "the browser was too slow" in note, (shown, note)

    visit(work)
