"""The report of a design: its numbers, what it says where there are none, and the page itself."""

from __future__ import annotations

import asyncio
import re
import subprocess
import sys
import urllib.error
import urllib.request
from dataclasses import replace
from html import unescape
from pathlib import Path

import numpy as np
import pytest

import gsp
from tests.app import chromium

pytest.importorskip("nicegui", reason="the extra `app` is not installed")
pytest.importorskip("matplotlib", reason="the extra `plots` is not installed")

from gsp.app.report import page, report
from gsp.app.report.meanings import MEANINGS
from gsp.app.report.study import PLANES, study_of
from gsp.app.report.summary import met, place_text, summary
from gsp.app.reports import BUSY

ROOT = Path(__file__).parents[2]
SIX_THREE, OCTAHEDRAL = "workspace-6-3", "lee-2000-3-3"


@pytest.fixture(scope="module")
def study():
    """Of a design whose texts are markup."""
    texts = {"name": "<x-name>", "unit": "<x-unit>", "source": "<x-source>"}
    return study_of(gsp.catalogue.design(SIX_THREE).replace(**texts), None, None, None)


@pytest.fixture(scope="module")
def small():
    """The report of a design without strokes."""
    return report(gsp.catalogue.design(OCTAHEDRAL), progress=False)


def text_of(html):
    return unescape(
        re.sub(r"<[^>]*>", " ", re.sub(r"(?s)<style>.*?</style>|<iframe.*?>", "", html))
    )


def test_meanings_are_those_of_the_documentation():
    text = (ROOT / "docs/choosing-an-index.md").read_text(encoding="utf-8")
    rows = re.findall(
        r"^\| \S+(?: J\\\|)? \| `(\w+)` \| ((?:[^|\\]|\\\|)+?) \|", text, re.MULTILINE
    )
    assert {name: meaning.replace(r"\|", "|") for name, meaning in rows} == dict(MEANINGS)


def test_what_is_proven_holds(study):
    design, home = study.state.design, study.state.pose
    box = study.around.box
    assert gsp.certify(design, box, gsp.Limits()).status == "proven"
    wider = gsp.PoseBox.around(home, 1.1 * 0.5 * (box.high - box.low))
    assert gsp.certify(design, wider, gsp.Limits()).status == "refuted"
    poses = box.sample(2000, rng=3)
    assert gsp.feasible(design, poses, gsp.Limits()).ok.all()
    # No pose nearer than the lower end is singular: det J has one sign on the way to any.
    near = float(study.distance.lower)
    turns = np.random.default_rng(4).standard_normal((2000, 6))
    turns *= 0.999 * near / np.linalg.norm(turns, axis=1)[:, None]
    turns[:, 3:] /= study.length
    signs = np.sign(np.linalg.det(design.at(home.moved(turns)).jacobian))
    assert (signs == signs[0]).all()


def test_brackets_hold_the_exact_measures(study):
    design, home = study.state.design, study.state.pose
    shells = gsp.workspace.exact_shells(design, home.rotation, gsp.Limits())
    low, high = study.space.volume
    assert low <= shells.volume((-np.inf, np.inf)).value <= high
    assert set(study.sections) == {name for name, _ in PLANES}
    for name, (u, v) in PLANES:
        low, high = study.sections[name].area
        # An estimate by points of the plane, of which a fifth is feasible.
        side, grid = 24.0, np.linspace(-24.0, 24.0, 241)
        points = home.position + np.stack(np.meshgrid(grid, grid), -1) @ np.array([u, v])
        poses = gsp.Pose(points, home.rotation)
        share = gsp.feasible(design, poses, gsp.Limits()).ok.mean()
        assert low * 0.97 < share * (2.0 * side) ** 2 < high * 1.03


def test_forces_balance_the_loads(study):
    found = study.posture.wrench(study.forces)
    assert found == pytest.approx(np.eye(6)[:3], abs=1e-9)


def test_places_are_counted(study):
    design, home = study.state.design, study.state.pose
    mine = gsp.indices.control_number(design.at(home))
    values = []
    for mechanism in gsp.catalogue.mechanisms():
        other = gsp.catalogue.instantiate(mechanism, design).at(home)
        if not other.singular():
            value = gsp.indices.control_number(other, length=study.length)
            values += [] if np.isnan(value) else [float(value)]
    place = study.places["control_number"]
    assert place.total == len(values) > 10
    assert place.better == sum(value > mine * (1 + 1e-9) for value in values)


def test_the_summary_states_what_was_found(study):
    """With three digits, rounded to the side on which the statement stays true."""
    first, box, load, *_ = summary(study)
    half = 0.5 * (study.around.box.high - study.around.box.low)
    side, angle = re.search(r"±(\S+) .* ±(\S+)° of roll", box).groups()
    for shown, exact in (
        (re.search(r"no singular pose is nearer than (\S+)", first)[1], study.distance.lower),
        (side, half[0]),
        (angle, np.rad2deg(half[3])),
    ):
        assert 0.99 * exact < float(shown) <= exact * (1.0 + 1e-15)
    greatest = 100.0 * np.abs(study.forces[2]).max()
    most = float(re.search(r"at most (\S+) N", load)[1])
    assert greatest * (1.0 - 1e-15) <= most < 1.01 * greatest


@pytest.mark.parametrize(
    ("pose", "said"),
    [
        (gsp.Pose([0.0, 0.0, 0.0]), "it is singular"),
        (gsp.Pose([0.0, 0.0, 40.0]), "would pass the stroke"),
    ],
)
def test_poses_that_cannot_be_used(pose, said):
    found = study_of(gsp.catalogue.design(SIX_THREE), pose, None, None)
    assert said in summary(found)[0]


def test_every_section_is_there_or_says_why_not(small):
    for title, _ in page.SECTIONS:
        assert f"<h2>{title}</h2>" in small
    text = text_of(small)
    assert "Nothing bounds the workspace: the design has no strokes" in text
    assert "The design states no strokes." in text
    assert "No task was given" in text
    assert "nan" not in text.lower().split()


def test_names_are_no_markup(monkeypatch):
    monkeypatch.setattr(page, "SECTIONS", page.SECTIONS[1:3])
    name = "<b>@@sections@@</b>"
    html = report(gsp.catalogue.design(OCTAHEDRAL).replace(name=name), progress=False)
    assert "<b>" not in html
    assert html.count("<section") == 2
    assert "&lt;b&gt;@@sections@@" in html


def test_texts_of_a_design_are_no_markup(study):
    seen = "".join(make(study) for _, make in page.SECTIONS)
    assert "<x-" not in seen
    assert seen.count("&lt;x-unit&gt;") > 10
    assert "&lt;x-source&gt;" in seen


def test_a_task_is_proven_and_compared():
    design = gsp.catalogue.design(OCTAHEDRAL)
    box = gsp.PoseBox([(-0.1, 0.1), 0.0, (0.9, 1.1)], [0, 0, (-0.1, 0.1)])
    task = gsp.Task(poses=box, wanted=["worst CTN", "proven worst CTN"], samples=20)
    found = study_of(design, None, task, None)
    assert found.certificate.status == "proven"
    assert "all poses of the task are regular" in " ".join(summary(found))
    text = text_of(page.tasks.task(found))
    worst = gsp.exploration.assess(design, task, progress=False)["control_number_proven"][0]
    assert f"{worst:.5g}" in text
    assert f"{OCTAHEDRAL} (this design)" in text
    metres = design.replace(unit="m")
    other = gsp.Task(poses=box, wanted=["worst CTN"], unit="mm")
    with pytest.raises(gsp.GspError, match="unit of the task"):
        report(metres, task=other, progress=False)


LIFT = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, strokes=[1.2, 2.6], unit="m", name="lift")
STROKES = gsp.Limits(strokes=[[1.2, 2.6]] * 6)
HIGH = [[0.0, 0.0, 9.0], [0.0, 0.1, 9.5]]


def test_a_task_that_the_design_cannot_meet_is_said_first():
    task = gsp.Task(poses=gsp.Pose(HIGH), wanted="worst CTN", limits=STROKES, length=0.8)
    found = study_of(LIFT, None, task, None)
    first = summary(found)[0]
    assert first.startswith("None of the 2 poses of the task is within the limits. At position (0,")
    leg = np.linalg.norm(LIFT.platform_points[0] + HIGH[0] - LIFT.base_points[0])
    assert f"d1 = {leg:.6g} > 2.6, and 5 more." in first
    assert text_of(page.tasks.at_each(found)).count(" > 2.6") == 12
    assert "0 of 2 (0 %)" in text_of(page.tasks.task(found))
    # Strokes are not compared, other limits are.
    limits = gsp.Limits(position=[(-1.0, 1.0), (-1.0, 1.0), (0.0, 0.5)])
    found = study_of(LIFT, None, replace(task, limits=limits), None)
    text = text_of(page.tasks.task(found))
    assert "0 of 2 (0 %)" in text
    assert "None of the 196 designs has a place" in text
    assert "1 of 196" not in text


@pytest.mark.parametrize(
    ("positions", "limits", "said"),
    [
        ([*HIGH, [0, 0, 1.5]], STROKES, "Only 1 of the 3 poses of the task is within the limits"),
        ([[0, 0, 1.5]], STROKES, "At the pose of the task the actuators control all motions"),
        ([[0, 0, 1.5]] * 2, STROKES, "At all 2 poses .*, and all limits are satisfied"),
        ([[0, 0, 0], [0, 0, 1.5]], None, "cannot be used at 1 of the 2 poses .*: singular"),
    ],
)
def test_single_poses_are_in_or_out(positions, limits, said):
    design = LIFT if limits else LIFT.replace(strokes=None)
    task = gsp.Task(poses=gsp.Pose(positions), wanted="worst CTN", limits=limits, length=0.8)
    found = study_of(design, None, task, None)
    assert re.search(said, met(found))
    text = text_of(page.tasks.at_each(found))
    assert text.count("regular") == len(positions) - (limits is None)


def test_sampled_poses_out_of_the_limits_are_counted():
    box = gsp.PoseBox([0.0, 0.0, (1.5, 9.0)], [0.0, 0.0, 0.0])
    task = gsp.Task(poses=box, wanted="mean CTN", limits=gsp.Limits(), samples=40)
    left = int(gsp.feasible(LIFT, task.pose(), STROKES).ok.sum())
    found = met(study_of(LIFT, None, task, None))
    assert 1 < left < 20
    assert found.startswith(f"Only {left} of the 40 sampled poses of the task are within")


def test_mechanisms_without_strokes_are_compared_without_limits():
    box = gsp.PoseBox([0.0, 0.0, (1.5, 2.5)], [0.0, 0.0, 0.0])
    loads = gsp.statics.Masses(platform=60.0)
    wanted = ["mean CTN", "proven worst CTN"]
    task = gsp.Task(poses=box, wanted=wanted, limits=gsp.Limits(), samples=8, payload=loads)
    unnamed = LIFT.replace(name="")
    text = text_of(page.tasks.task(study_of(unnamed, None, task, None)))
    assert "design (this design)" in text
    row = gsp.exploration.assess(LIFT, task, progress=False).iloc[0]
    assert 0.0 < row["feasible"] < 1.0
    for column in ("control_number_mean", "control_number_proven", "actuator_force"):
        assert f"{row[column]:.5g}" in text
    assert "compared without strokes" in text
    free = gsp.Task(poses=box, wanted=["mean CTN", "worst CTN"], samples=8, length=LIFT.rms_radius)
    own = gsp.exploration.assess(LIFT.replace(strokes=None), free, progress=False).iloc[0]
    assert f"{own['control_number_mean']:.4g} {own['control_number_min']:.4g}" in (
        re.sub(r"\s+", " ", text)
    )


def test_progress_counts_the_sections(monkeypatch):
    monkeypatch.setattr(page, "SECTIONS", page.SECTIONS[2:4])
    heard = []
    design = gsp.catalogue.design(OCTAHEDRAL)
    report(design, progress=lambda done, total: heard.append((done, total)))
    assert heard == [(0, 2), (1, 2), (2, 2)]


@pytest.mark.skipif(chromium.executable() is None, reason="no Chromium is installed")
@pytest.mark.parametrize("width", [1366, 390])
def test_the_page_in_a_browser(browsed, tmp_path, small, width):
    """It is drawn, no wider than the screen, loads nothing, and on paper has a picture."""
    path = tmp_path / "report.html"
    path.write_text(small, encoding="utf-8")

    async def work():
        async with chromium.tabs(browsed, tmp_path) as opened:
            tab = await opened(path.as_uri(), width, 800)
            await tab.until("document.readyState === 'complete' && document.images.length > 1")
            scene = "document.querySelector('iframe').contentDocument"
            await tab.run("document.querySelector('iframe').loading = 'eager'")
            await tab.until(f"!!{scene}?.querySelector('.gsp-scene canvas')")
            assert await tab.run("document.documentElement.scrollWidth") <= width
            images = "[...document.querySelectorAll('img')]"
            assert await tab.run(f"{images}.every(one => one.alt && one.naturalWidth > 0)")
            await tab.send("Emulation.setEmulatedMedia", media="print")
            shown = "getComputedStyle(document.querySelector('{}')).display"
            assert await tab.run(shown.format(".scene")) == "none"
            assert await tab.run(shown.format(".paper")) == "block"
            printed = await tab.send("Page.printToPDF", preferCSSPageSize=True)
            assert len(printed["data"]) > 10_000
            assert tab.errors == []
            local = ("file:", "data:", "blob:", "about:")
            assert all(url.startswith(local) for url in tab.requests)

    asyncio.run(work())


def asked(address, query, method="POST"):
    request = urllib.request.Request(f"{address}/report?{query}", method=method)
    try:
        with urllib.request.urlopen(request) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()


NONE = "design=none"  # its report ends at once


async def until(address, wanted):
    """Wait until a report is computed, or none is, and return what a further one would get."""
    for _ in range(2400):
        status, text = await asyncio.to_thread(asked, address, NONE)
        if (status == BUSY) is wanted:
            return text
        await asyncio.sleep(0.05)
    raise AssertionError(text)


@pytest.mark.skipif(chromium.executable() is None, reason="no Chromium is installed")
def test_the_tool_opens_the_report_of_its_state(served, browsed, tmp_path):
    """In another tab, at the pose that is shown; sliders go on, and a second report waits."""

    async def work(tab, address, opened):
        await tab.click("button", "position z plus")
        await tab.until("document.querySelector('.gsp-facts').innerText.includes('singular')")
        await tab.run("window.open = (url) => { window.asked = url; }")
        await tab.click("button", "Report")
        query = (await tab.until("window.asked")).partition("?")[2]
        first = await opened(f"{address}/report?{query}")
        status, page = await asyncio.to_thread(asked, address, query, "GET")
        assert status == 200
        assert f"The report of {OCTAHEDRAL} is computed, which takes seconds" in page
        assert "Another report is computed first …" in await until(address, True)
        await tab.click("button", "position z plus")
        await until(address, False)  # a tab that loads its next page answers later
        await first.until(f"document.querySelector('h1')?.innerText === '{OCTAHEDRAL}'")
        assert "Report at position (0, 0, 0)" in await first.run("document.body.innerText")
        # Read again, it is the same report; with a key that is not known, the page waits.
        finished = await first.run("location.search.slice(1)")
        status, page = await asyncio.to_thread(asked, address, finished, "GET")
        assert status == 200
        assert f"<h1>{OCTAHEDRAL}</h1>" in page
        status, page = await asyncio.to_thread(asked, address, finished + "0", "GET")
        assert "is computed, which takes seconds" in page
        await first.send("Page.bringToFront")
        await first.run("document.querySelector('iframe').scrollIntoView()")
        scene = "document.querySelector('iframe').contentDocument"
        await first.until(f"!!{scene}?.querySelector('.gsp-scene canvas')")
        assert first.errors == []

    async def closed(address, opened):
        """A report ends with its tab, and with the page in its tab."""
        for method, words in (("Page.close", {}), ("Page.navigate", {"url": "about:blank"})):
            tab = await opened(f"{address}/report?design={SIX_THREE}")
            await until(address, True)
            await tab.send(method, **words)
            await asyncio.wait_for(until(address, False), 5.0)

    async def run(address):
        async with chromium.tabs(browsed, tmp_path) as opened:
            # One step below a singular pose, whose report is short.
            tab = await opened(f"{address}/?design={OCTAHEDRAL}&position=0,0,-0.05", 1366, 768)
            await tab.until("document.querySelector('.gsp-facts')?.innerText")
            await closed(address, opened)
            await work(tab, address, opened)

    asyncio.run(run(served))
    for method in ("GET", "POST"):
        status, page = asked(served, "design=no-such-design", method)
        assert status == 422
        assert "no-such-design" in page
        status, page = asked(served, "length=3&length=4", method)
        assert status == 422
        assert "link: expected one length" in page


KILLED = """
import multiprocessing, threading, time
from gsp.app import reports

def work():
    threading.Thread(target=reports.end_with_server, daemon=True).start()
    print("working", flush=True)
    time.sleep(600.0)

if __name__ == "__main__":
    process = multiprocessing.get_context("spawn").Process(target=work)
    process.start()
    process.join()
"""


def test_a_report_ends_with_a_killed_server(tmp_path):
    """The processes share an output, which ends with the last of them."""
    script = tmp_path / "server.py"
    script.write_text(KILLED)
    words = [sys.executable, str(script)]
    with subprocess.Popen(words, cwd=ROOT, stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout.readline() == "working\n"
        parent.kill()
        assert parent.communicate(timeout=30.0)[0] == ""


def test_strokes_of_the_task_are_those_of_all_sections():
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, strokes=(1.4, 2.4), unit="m")
    box = gsp.PoseBox.around(design.home, [0.01] * 3 + [0.0] * 3)
    value = float(np.linalg.norm(design.platform_points[0] + [0, 0, 1.5] - design.base_points[0]))
    for ends, left in (((2.0, 2.1), value - 2.0), ((0.1, 0.2), 0.2 - value)):
        limits = gsp.Limits(strokes=[ends] * 6)
        found = study_of(
            design, None, gsp.Task(poses=box, limits=limits, wanted=["mean CTN"], samples=4), None
        )
        shown = text_of(page.parts.joints(found)).replace("−", "-")
        numbers = re.findall(r"d\d\s+([\d.]+) m\s+([\d.]+) … ([\d.]+)\s+(-?[\d.]+) m", shown)
        expected = [value, *ends, left]
        np.testing.assert_allclose(np.array(numbers, dtype=float), [expected] * 6, rtol=1e-3)
        assert "The limits are the strokes of the task." in shown
        assert ("would pass the stroke" in " ".join(summary(found))) == (left < 0)
    assert "No position in this plane is within the limits." in page.proofs.workspace(found)


def test_strokes_of_a_task_are_no_limits_of_other_actuators():
    """The other mechanisms are compared without them, and so is a design with seven legs."""
    design = gsp.hexapod(200.0, 0.3, 100.0, 0.4, 250.0, unit="mm")
    box = gsp.PoseBox.around(design.home, [5.0] * 3 + [0.03] * 3)
    limits = gsp.Limits(strokes=[(143.0, 429.0)] * 6)
    wanted = {"wanted": ["mean CTN"], "samples": 10, "unit": "mm"}
    with_strokes = study_of(design, None, gsp.Task(poses=box, limits=limits, **wanted), None)
    without = study_of(design, None, gsp.Task(poses=box, **wanted), None)
    scores = [
        one.ranked.set_index("design")["score"].sort_index() for one in (with_strokes, without)
    ]
    assert scores[0].equals(scores[1])
    assert "compared without strokes" in text_of(page.tasks.task(with_strokes))
    rng = np.random.default_rng(3)
    seven = gsp.Design(["D1"] * 7, *rng.normal(size=(2, 7, 3)), home=gsp.Pose([0.0, 0.0, 3.0]))
    limits = gsp.Limits(strokes=[(0.0, 9.0)] * 7)
    box = gsp.PoseBox.around(seven.home, [0.01] * 6)
    task = gsp.Task(poses=box, limits=limits, wanted=["mean CTN"], samples=4)
    assert study_of(seven, None, task, None).ranked["score"].notna().sum() > 1


def test_length_and_ellipsoid_of_a_task_are_those_of_the_report():
    design = gsp.catalogue.design(OCTAHEDRAL)
    task = gsp.Task(
        poses=design.home[None], wanted=["mean CTN"], length=1.25,
        ellipsoid=gsp.Ellipsoid([1.0, 1.0, 0.5]),
    )  # fmt: skip
    found = study_of(design, None, task, None)
    shown = text_of(page.parts.dimensions(found))
    assert re.search(r"characteristic length\s+1.25[^,]*, of the task", shown)
    assert "1 × 1 × 0.5" in shown
    assert found.reading.index("condition_number_ellipsoid").reason == ""


@pytest.mark.parametrize(("own", "of_task"), [(0.2, 1.0), (1.0, 0.2)])
def test_limits_have_the_ellipsoid_of_the_design(own, of_task):
    """Not that of the task, as in `gsp.exploration.assess` and `gsp.certify`."""
    axes = np.array([1.0, 1.0, 0.5])
    design = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5).replace(
        characteristic_length=1.0, ellipsoid=gsp.Ellipsoid(own * axes)
    )
    box = gsp.PoseBox.around(design.home, [0.05] * 3 + [0.02] * 3)
    limits = gsp.Limits(indices=["CDN_OE <= 5"])
    task = gsp.Task(
        poses=box, wanted=["mean CDN_OE"], samples=20, limits=limits,
        ellipsoid=gsp.Ellipsoid(of_task * axes),
    )  # fmt: skip
    found = study_of(design, None, task, None)
    table = gsp.exploration.assess([design], task, progress=False)
    assert found.within.ok.mean() == table["feasible"][0] == (own == 1.0)
    assert found.certificate.status == gsp.certify(design, box, limits).status
    value = gsp.indices.condition_number_ellipsoid(design.at(design.home), task.ellipsoid)
    assert found.reading.index("condition_number_ellipsoid").value == pytest.approx(float(value))


def test_a_score_that_is_not_that_of_the_task_is_stated():
    design = gsp.catalogue.design(OCTAHEDRAL)
    box = gsp.PoseBox.around(design.home, [0.01] * 6)
    said = "The score of this table takes the worst values"
    for wanted in (["proven worst CTN", "mean CTN"], ["mean CTN"]):
        task = gsp.Task(poses=box, wanted=wanted, samples=4)
        text = text_of(page.tasks.task(study_of(design, None, task, None)))
        assert (said in text) == (len(wanted) == 2)


def test_limits_that_bound_no_position_are_said():
    design = gsp.catalogue.design(OCTAHEDRAL).replace(strokes=None)
    task = gsp.Task(
        poses=design.home[None], limits=gsp.Limits(leg_radius=1e-3), wanted=["mean CTN"]
    )
    assert "Nothing bounds the workspace" in page.proofs.workspace(
        study_of(design, None, task, None)
    )


def test_the_distance_to_singular_poses_has_one_bound(study):
    shown = text_of(page.parts.indices(study))
    value = float(re.search(r"SD\s+singularity distance.*?\s([\d.]+)\s", shown)[1])
    assert 0.0 <= study.distance.lower - value <= 1e-4 * value


def test_an_undefined_design_is_not_compared():
    design = gsp.catalogue.design(OCTAHEDRAL)
    apart = design.base_points[0] - design.platform_points[0]
    found = study_of(design, gsp.Pose(apart), None, None)
    assert "as the design is undefined at this pose" in page.proofs.comparison(found)


def test_a_length_of_a_task_that_does_not_fit_names_the_task():
    task = gsp.Task(poses=gsp.Pose([[0.0, 0.0, 1.0]]), wanted=["mean CTN"], length=1e9)
    with pytest.raises(gsp.GspError, match="task, length: characteristic length: expected"):
        study_of(gsp.catalogue.design(OCTAHEDRAL), None, task, None)


def test_designs_far_from_their_frame_keep_the_digits_of_their_size():
    away = np.array([1e6, -1e6, 5e5])
    plain = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5, strokes=[1.2, 2.6])
    home = gsp.Pose(plain.home.position + away + [0.05, -0.03, 0.0])
    far = plain.replace(base_points=plain.base_points + away, home=home)
    found = study_of(far, None, None, None)
    shown = text_of(page.parts.dimensions(found)).replace("−", "-")
    for point in far.base_points:
        assert ", ".join(f"{x:.12g}" for x in point) in shown
    assert "1000000.05, -1000000.03, 500001.5" in summary_text(found)
    box = found.around.box
    text = text_of(page.proofs.certificates(found)).replace("−", "-")
    ends = re.findall(r"\b[xyz]\s+(-?[\d.]+)\s+(-?[\d.]+)", text)
    for (low, high), a, b in zip(ends, box.low, box.high, strict=False):
        assert a <= float(low) < float(high) <= b
        assert float(high) - float(low) == pytest.approx(b - a, rel=1e-4)
    assert len(ends) == 3


def summary_text(study):
    return place_text(study.state.pose, "", study.state.size).replace("−", "-")


def test_a_design_with_more_legs_is_counted_among_the_others():
    """Its mechanism is none of the 195."""
    rng = np.random.default_rng(7)
    base, top = rng.uniform(-2.0, 2.0, (7, 3)), rng.uniform(-1.0, 1.0, (7, 3))
    design = gsp.Design(["D1"] * 7, base, top, home=gsp.Pose([0.0, 0.1, 1.5]))
    found = study_of(design, None, None, None)
    place = found.places["control_number"]
    assert place is not None
    assert place.total == len(found.others) + 1
    found.__dict__["distance"] = type("", (), {"upper": np.inf, "lower": 1.0})()
    assert "a singular pose none was found" in " ".join(
        text_of(page.proofs.singularity(found)).split()
    )
