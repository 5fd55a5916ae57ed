"""The page through NiceGUI's own simulation of users: every control, errors.

The pages are made by the code that the server runs; there is no browser. See test_browser.py.
"""

from __future__ import annotations

import asyncio
import re

import numpy as np
import pytest

import gsp
from gsp.app import searches as searching
from gsp.app.state import choices, links
from gsp.app.state import session as sessions
from gsp.app.state.reading import COMPILED, compile_slow
from gsp.app.state.session import started
from tests.app.test_state import figure_42
from tests.campaign import some

nicegui = pytest.importorskip("nicegui", reason="the extra `app` is not installed")
testing = pytest.importorskip("nicegui.testing")

from gsp.app.server import page  # noqa: E402

TOZ = "toz-kucuk-2016-d3-6"


class Known:
    """Searches that are done at once, or never."""

    def __init__(self, done=True):
        self.done, self.asked, self.left = done, [], []

    def ask(self, design, client):
        self.asked.append(client)
        if not self.done:
            return searching.Search(design=design, status=searching.PROCESSING, done=3, total=12)
        best = gsp.determinant.Maximum(value=5.0e6, pose=design.home)
        return searching.Search(design=design, status=searching.KNOWN, maximum=best)

    def leave(self, search, client):
        self.left.append(client)


class Visit:
    """A page that a simulated user has open."""

    def __init__(self, user):
        self.user = user

    def element(self, name, kind=None):
        """The element with an aria-label, or with a label."""
        with self.user:
            found = [
                one
                for one in nicegui.ElementFilter(kind=kind or nicegui.ui.element)
                if name
                in (one.props.get("aria-label"), one.props.get("label"), one.props.get("name"))
            ]
        assert len(found) == 1, f"{name}: {len(found)} elements"
        return found[0]

    def click(self, name):
        with self.user:
            one = self.element(name, nicegui.ui.button)
            for listener in one._event_listeners.values():
                if listener.type == "click":
                    nicegui.events.handle_event(
                        listener.handler,
                        nicegui.events.ClickEventArguments(sender=one, client=one.client),
                    )

    def enter(self, name, entry):
        """Type an entry into a field and press Enter."""
        with self.user:
            field = self.element(name, nicegui.ui.input)
            field.value = str(entry)
            for listener in field._event_listeners.values():
                if listener.type == "keydown.enter":
                    nicegui.events.handle_event(
                        listener.handler,
                        nicegui.events.GenericEventArguments(
                            sender=field, client=field.client, args=None
                        ),
                    )

    def shown(self, name):
        """The number that a field shows."""
        return float(self.element(name, nicegui.ui.input).value)

    def tab(self, name):
        """Show a panel: the others are not kept up to date."""
        with self.user:
            next(iter(nicegui.ElementFilter(kind=nicegui.ui.tabs, marker="panels"))).value = name

    def slide(self, name, value):
        with self.user:
            self.element(name, nicegui.ui.slider).value = value

    def choose(self, name, value):
        with self.user:
            self.element(name).value = value

    @property
    def html(self):
        """All tables and texts of the page."""
        with self.user:
            texts = [one.content for one in nicegui.ElementFilter(kind=nicegui.ui.html)]
            texts += [one.text for one in nicegui.ElementFilter(kind=nicegui.ui.label)]
        return "\n".join(texts)

    def fact(self, name):
        """A number below the scene."""
        found = re.search(rf"<dt>{re.escape(name)}.*?</dt><dd>(.*?)</dd>", self.html)
        return found[1].replace("−", "-")


def visit(work, *, searches=None, path="/", design=TOZ):
    """Run an async function with a user of the page."""

    async def run():
        root = page(choices.named(design), searches or Known())
        async with testing.user_simulation(root=root) as user:
            await user.open(path)
            await work(Visit(user))

    asyncio.run(run())


async def until(condition):
    """Wait for work in the background, at most half a minute."""
    for _ in range(600):
        if condition():
            return
        await asyncio.sleep(0.05)
    assert condition()


def pose_of(page):
    """The pose that the fields show."""
    page.tab("motion")
    names = ("position x", "position y", "position z", "roll", "pitch", "yaw")
    values = [page.shown(f"{name} value") for name in names]
    return gsp.Pose.from_rpy(values[:3], values[3:], degrees=True)


def test_controls_of_the_pose():
    """Every button, slider and field; what is shown below the scene is that of the library."""
    design = choices.named(TOZ)

    async def work(page):
        assert page.fact("det J") == "-2674321"
        pose = design.home
        for number, name in enumerate(("position x", "position y", "position z")):
            page.click(f"{name} plus")
            page.click(f"{name} plus")
            page.click(f"{name} minus")
            pose = pose.moved(6.0 * np.eye(6)[number])  # 5 % of 123 mm, one digit
        for number, name in enumerate(("roll", "pitch", "yaw"), 3):
            page.click(f"{name} minus")
            pose = pose.moved(np.deg2rad(-5.0) * np.eye(6)[number])
        shown = pose_of(page)  # fields have six digits, of mm and of degrees
        assert shown.position == pytest.approx(pose.position, abs=1e-3)
        assert shown.rotation == pytest.approx(pose.rotation, abs=2e-6)
        wanted = np.linalg.det(design.at(pose).jacobian)
        assert float(page.fact("det J")) == pytest.approx(wanted, rel=1e-6)
        wanted = gsp.indices.control_number(design.at(pose), 95.0)
        assert float(page.fact("CTN")) == pytest.approx(float(wanted), rel=1e-4)
        page.slide("position z", 150.0)
        page.enter("yaw value", 12.5)
        assert page.shown("position z value") == 150.0
        assert page.element("yaw").value == pytest.approx(12.5)
        page.click("Motion reset")
        assert pose_of(page).position == pytest.approx(design.home.position)
        page.enter("Increment of positions", -3.0)
        assert "increment of positions: expected a number from" in page.html
        assert page.shown("Increment of positions") == 6.0
        page.enter("position x value", 1e300)
        assert "expected a position within" in page.html
        assert pose_of(page).position == pytest.approx(design.home.position)

    visit(work)


@pytest.mark.parametrize("entry", some(["", "abc", "1e400", "nan"], 2))
def test_entries_that_are_no_numbers(entry):
    """Each field of the panels states what it takes, and shows its value again."""

    async def work(page):
        before = page.fact("det J")
        for tab, names in (
            ("motion", ["position x value", "yaw value", "Increment of positions"]),
            ("motion", ["Increment of rotations [°]"]),
            ("legs", ["joint d1 value"]),
        ):
            page.tab(tab)
            for name in names:
                value = page.shown(name)
                page.enter(name, entry)
                what = name.removesuffix(" value").removesuffix(" [°]").replace("Inc", "inc")
                assert f"{what}: expected a finite number" in page.html
                assert page.shown(name) == value
        page.tab("indices")
        page.enter("Characteristic length", entry)
        if entry:
            assert "characteristic length: expected a finite number" in page.html
            assert page.shown("Characteristic length") == 95.0
        assert page.fact("det J") == before

    visit(work)


def test_limits_below_zero_are_refused():
    async def work(page):
        page.tab("legs")
        for low, high in (("-1", "3"), ("3", "1")):
            page.choose("Least", low)
            page.choose("Greatest", high)
            page.click("Set limits")
            assert "limits of all distances: expected 0 ≤ least ≤ greatest" in page.html
            assert page.element("Least", nicegui.ui.input).value == ""
        page.choose("Least", "x")
        page.click("Set limits")
        assert "least: expected a finite number" in page.html
        page.choose("Least", "0")
        page.choose("Greatest", "200")
        page.click("Set limits")
        assert (page.shown("Least"), page.shown("Greatest")) == (0.0, 200.0)
        assert "… 200</td>" in page.html

    visit(work)


def test_joints_and_limits():
    """A joint moves the platform; limits stop both, and are named."""
    design = choices.named("workspace-6-3")

    async def work(page):
        joints = design.at(design.home).joints
        page.tab("legs")
        page.enter("joint d2 value", float(joints[1]) + 0.05)
        found = design.at(pose_of(page)).joints
        assert found == pytest.approx(joints + 0.05 * (np.arange(6) == 1), abs=1e-4)
        page.tab("legs")
        page.enter("joint d1 value", 1e6)
        assert "stopped at the limit d1 = " in page.html
        page.click("Motion reset")
        page.tab("legs")
        page.choose("Least", "1")
        page.choose("Greatest", str(float(joints.max()) + 0.5))
        page.click("Set limits")
        page.tab("motion")
        page.slide("position z", page.element("position z").props["max"])
        assert re.search(r"stopped at the limit d\d = ", page.html)
        assert design.at(pose_of(page)).joints.max() == pytest.approx(joints.max() + 0.5, abs=1e-4)

    visit(work, design="workspace-6-3")


def test_other_limits_keep_a_recorded_motion():
    async def work(page):
        page.click("Record a motion")
        for _ in range(3):
            await asyncio.sleep(0.06)
            page.click("position x plus")
        page.click("Record a motion")
        (said,) = re.findall(r"\d+ samples in [\d.]+ s", page.html)
        page.tab("legs")
        page.choose("Greatest", "1e3")
        page.click("Set limits")
        assert said in page.html
        page.click("Configuration")
        page.choose("Top size", "15")
        page.click("OK: this platform")
        assert said not in page.html
        assert "no motion yet" in page.html

    visit(work, design="workspace-6-3")


def test_the_dialogs_of_figures_41_and_42():
    async def work(page):
        page.click("Configuration")
        page.choose("Top size", "0")
        page.click("OK: this platform")
        assert "size of the top: expected a number" in page.html
        assert page.fact("det J") == "-2674321"
        page.choose("Top size", "1e400")
        page.click("OK: this platform")
        assert "Top size: expected a finite number" in page.html
        assert page.fact("det J") == "-2674321"
        # The message follows the fields: what is mended is not in it.
        page.choose("Base size", "-1")
        page.choose("Top size", "15")
        assert "Top size" not in page.html
        assert "size of the base: expected a number" in page.html
        page.choose("Base size", "30")
        assert "size of the base" not in page.html
        page.click("OK: this platform")
        assert pose_of(page).position == pytest.approx([0.0, 0.0, 15.0])
        page.click("Jacobian matrix")
        page.choose("Form", "lines")
        with page.user:
            tables = [one.content for one in nicegui.ElementFilter(kind=nicegui.ui.html)]
        (table,) = [one for one in tables if ">L</th>" in one]
        entries = re.findall(r'<td class="n">(.*?)</td>', table.replace("−", "-"))
        # The print has three decimals, as the dialog has.
        assert [float(x) for x in entries] == figure_42().ravel().tolist()
        wanted = 0.75 * 3**0.5 * 15**3
        assert float(page.fact("det J")) == pytest.approx(wanted, rel=1e-6)
        # The matrix of figure 42 has the negative sign, in the print as well.
        (text,) = re.findall(r"determinant of this matrix: −([\d.]+)<", table)
        assert float(text) == pytest.approx(wanted, rel=1e-6)
        assert np.linalg.det(figure_42()) == pytest.approx(-wanted, rel=1e-3)
        await until(lambda: page.fact("λ") == "1")
        page.choose("Form", "homogeneous")
        assert "expected a characteristic length" in page.html

    visit(work)


def test_the_maximum_is_asked_for():
    async def work(page):
        assert page.fact("λ") == "—"
        page.tab("indices")
        page.click("Get maximum")
        await until(lambda: page.fact("λ") != "—")
        assert float(page.fact("λ")) == pytest.approx(2674320.69 / 5.0e6, rel=1e-4)

    visit(work)
    slow = Known(done=False)

    async def wait(page):
        page.tab("indices")
        page.click("Get maximum")
        await until(lambda: "processing: 3 of 12 rounds" in page.html)
        page.tab("motion")
        page.slide("position z", 150.0)
        assert page.shown("position z value") == 150.0
        page.tab("indices")
        page.click("Stop")
        assert slow.left == slow.asked
        assert "not known yet" in page.html

    visit(wait, searches=slow)


def test_a_link_opens_its_state():
    state = started(choices.named("lee-2000-3-3"), gsp.Pose([0.1, 0.2, 1.3]))

    async def work(page):
        assert pose_of(page).position == pytest.approx([0.1, 0.2, 1.3])

    visit(work, path=f"/?{links.query(state)}")

    async def wrong(page):
        assert "the link cannot be used: unknown design" in page.html
        assert page.fact("det J") == "-2674321"

    visit(wrong, path="/?design=../../etc/passwd")


@pytest.mark.parametrize(
    ("query", "message"),
    some(
        [
            ("rpy=0,0,30", "unknown parameter of a link 'rpy'; nearest: rpy_deg"),
            ("position=0,0,150&colour=red", "unknown parameter of a link 'colour'"),
            ("position=0,150", "position: expected 3 numbers"),
            ("rpy_deg=0,0,x", "rpy_deg: expected 3 numbers"),
            ("length=3&length=4", "link: expected one length, received '3' and '4'"),
            (
                "position=0,0,150&length=3&length=3",
                "link: expected one length, received '3' and '3'",
            ),
            ("length=-1", "characteristic length: expected a number from"),
        ],
        3,
    ),
)
def test_a_link_that_cannot_be_used_gives_a_message(query, message):
    async def work(page):
        assert f"the link cannot be used: {message}" in page.html
        assert page.fact("det J") == "-2674321"

    visit(work, path=f"/?{query}")


def test_indices_and_plots():
    """A length, the distance to singularity, a curve and a map, and motions beyond limits."""
    design = choices.named("workspace-6-3")
    COMPILED.clear()

    async def work(page):
        page.tab("indices")
        assert page.fact("CDN_CL") == "—"
        page.enter("Characteristic length", 7.5)
        wanted = gsp.indices.condition_number(design.at(design.home), 7.5)
        assert float(page.fact("CDN_CL")) == pytest.approx(float(wanted), rel=1e-4)
        page.enter("Characteristic length", -1.0)
        assert "characteristic length: expected a number from" in page.html
        assert 'SD</th><td class="n">—' in page.html
        compile_slow()
        page.enter("Characteristic length", 7.0)
        wanted = float(gsp.indices.singularity_distance(design.at(design.home), 7.0))
        shown = float(page.fact("to singularity").removeprefix("≥ "))
        assert wanted * (1.0 - 1e-3) <= shown <= wanted
        assert f'SD</th><td class="n">{wanted:.5g}' in page.html
        found = re.search(
            r"to the nearest singular pose: at least (\S+) % of the characteristic length"
            r'"[^>]*aria-valuenow="(\d+)"', page.html,
        )  # fmt: skip
        share = 100.0 * wanted / 7.0
        assert 0.9 * share <= float(found[1]) <= share
        assert float(found[2]) == pytest.approx(share, abs=0.51)
        # The nearest limit is a gauge too, below the scene and in the panel of motions.
        joints = design.at(design.home).joints
        left = np.minimum(joints - design.strokes[:, 0], design.strokes[:, 1] - joints)
        half = 0.5 * np.ptp(design.strokes, axis=1)[left.argmin()]
        page.tab("motion")
        gauges = re.findall(r'left of \w+: (\S+) % of half the stroke"', page.html)
        assert len(gauges) == 2
        for gauge in gauges:
            assert 0.9 <= float(gauge) / (100.0 * left.min() / half) <= 1.0 + 1e-12
        page.tab("plots")
        with page.user:
            line, field = nicegui.ElementFilter(kind=nicegui.ui.echart)
        values = dict(line.options["series"][0]["data"])
        here = line.options["series"][0]["markLine"]["data"][0]["xAxis"]
        assert here == design.home.position[2]
        wanted = gsp.indices.control_number(design.at(design.home))
        assert values[here] == pytest.approx(float(wanted), rel=1e-4)
        middle = {tuple(cell[:2]): cell[2] for cell in field.options["series"][0]["data"]}[15, 15]
        assert middle == pytest.approx(float(wanted), rel=1e-4)
        # Its contours have the values of their labels, and each line has its label once at most.
        lines, labels = field.options["series"][1:3]
        texts = [float(one["label"]["formatter"]) for one in labels["data"]]
        assert len(set(texts)) == len(texts) >= 3
        cells = {tuple(cell[:2]): cell[2] for cell in field.options["series"][0]["data"]}
        grid = np.array([[cells[i, j] for j in range(31)] for i in range(31)])
        # Axes have coordinates; a cell has its value in its middle.
        axes = [field.options[name][1] for name in ("xAxis", "yAxis")]
        assert [axis["type"] for axis in axes] == ["value", "value"]
        first, last = (np.array([axis[end] for axis in axes]) for end in ("min", "max"))
        size = sessions.started(design).size
        assert 0.5 * (first + last) == pytest.approx(design.home.position[:2], abs=1e-9)
        assert last - first == pytest.approx([2.0 * size * 31 / 30] * 2)
        for one, text in zip(labels["data"], texts, strict=True):
            steps = 31.0 * (np.array(one["value"]) - first) / (last - first) - 0.5
            (i, j), (a, b) = np.divmod(steps.round(3), 1.0)
            i, j = int(i), int(j)
            ends = grid[i : i + 2, j : j + 2][: 1 + (a > 0), : 1 + (b > 0)]
            assert ends.min() - 1e-3 <= text <= ends.max() + 1e-3
            assert any(one["value"] in line["coords"] for line in lines["data"])
        assert line.props["aria-label"] == "CTN along z"
        assert field.props["aria-label"] == "CTN over x and y"
        page.choose("Index to plot", "quality_index")
        assert "λ: the maximum of |det J| is not known yet" in page.html
        assert line.props["aria-label"] == "λ along z: no plot"
        assert line.options == field.options == {"series": []}  # none of the index before
        page.choose("Index to plot", "condition_number_ellipsoid")
        assert "CDN_OE: needs an operation ellipsoid" in page.html

    visit(work, design="workspace-6-3")


def test_the_catalogue_is_ranked_and_a_mechanism_loaded():
    async def work(page):
        page.click("Rank at this pose")
        with page.user:
            table = next(iter(nicegui.ElementFilter(kind=nicegui.ui.table)))
        await until(lambda: table.rows)
        assert [row["rank"] for row in table.rows] == list(range(1, 196))
        name = table.rows[0]["name"]
        with page.user:
            load = next(e for e in table._event_listeners.values() if e.type == "load")
            load.handler(
                nicegui.events.GenericEventArguments(sender=table, client=table.client, args=name)
            )
        best = gsp.catalogue.instantiate(gsp.catalogue.mechanism(name), choices.named(TOZ))
        wanted = gsp.indices.control_number(best.at(best.home), 95.0)
        assert table.rows[0]["value"] == pytest.approx(float(wanted), rel=1e-4)
        assert float(page.fact("CTN")) == pytest.approx(float(wanted), rel=1e-4)

    visit(work)
