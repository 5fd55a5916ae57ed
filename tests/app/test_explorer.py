"""`gsp.plots.explorer`: a table of designs as a page with linked points, lines and designs."""

from __future__ import annotations

import asyncio
import base64
import gzip
import json
import re

import numpy as np
import pandas as pd
import pytest

import gsp
from gsp.errors import InvalidInput, MissingSoftware, UnwritableOutput
from tests.app import chromium

pytest.importorskip("plotly", reason="the extra `plots` is not installed")
pytest.importorskip("nicegui", reason="the extra `app` is not installed")

in_browser = pytest.mark.skipif(
    chromium.executable() is None, reason="no Chromium is installed: the page is not tested in it"
)
MARKUP = "</script><b>@title@</b> & $a$<!--"
SPACE = gsp.Space(
    gsp.hexapod,
    {"platform_radius": (0.5, 1.5), "height": (1.0, 2.0)},
    fixed={"base_radius": 2.0, "base_angle": 0.3, "platform_angle": 0.4},
)
TABLE = pd.DataFrame({
    "platform_radius": [1.2, 0.6, 1.4, 0.9, 1.0, 0.8],
    "height": [1.0, 2.0, 1.5, 1.2, 1.8, 1.1],
    "score": [0.3, 0.1, 0.2, 0.5, 0.4, np.nan],
    "design": [f"hexapod {i}" for i in range(5)] + [MARKUP],
    "control_number_mean": [0.1, 0.4, 0.2, 0.3, 0.35, 0.15],
    "condition_number_max": [2.0, 8.0, 3.0, np.inf, np.nan, 7.0],
    "cost": [10, 20, 30, 40, 50, 60],
    "maker": ["a", MARKUP, None, "a", "b", "b"],
}, index=[7, 7, 3, 2, 1, 0])  # fmt: skip
COLUMNS = ["control_number_mean", "condition_number_max"]


def spec_of(figure):
    return json.loads(re.search(r"const spec = (.*);\n", figure.html)[1])


def spaces_of(figure):
    sources = json.loads(re.search(r"const sources = (.*);\n", figure.html)[1])
    return json.loads(gzip.decompress(base64.b64decode(sources["spaces"])))


def column_of(spec, name):
    (found,) = (one for one in spec["columns"] if one["name"] == name)
    return found


def test_the_page_has_the_values_of_the_table_in_its_order():
    spec = spec_of(gsp.plots.explorer(TABLE, COLUMNS))
    assert [one["name"] for one in spec["columns"]] == list(TABLE.columns)
    assert spec["names"] == TABLE["design"].tolist()
    for name in ("platform_radius", "height", "control_number_mean", "cost"):
        assert column_of(spec, name)["values"] == TABLE[name].tolist()
    assert column_of(spec, "maker")["values"] == ["a", MARKUP, "", "a", "b", "b"]
    condition = column_of(spec, "condition_number_max")
    assert condition["values"] == [2.0, 8.0, 3.0, None, None, 7.0]
    assert condition["odd"] == {"3": "∞", "4": "undefined"}
    words = "CDN_CL, max is infinite at 1 and undefined at 1 of 6 designs"
    assert condition["gap"] == words
    axes = [spec["columns"][spec[axis]]["label"] for axis in ("x", "y", "by")]
    assert axes == ["CTN, mean", "CDN_CL, max", "score"]


def test_own_columns_are_hovered_before_other_indices():
    more = {f"{name}_mean": 0.5 for name in ("manipulability", "rigidity_rate", "quality_index")}
    spec = spec_of(gsp.plots.explorer(TABLE.assign(rank=1, **more), COLUMNS))
    order = [spec["columns"][i]["name"] for i in spec["order"]]
    assert order[:7] == [*COLUMNS, "score", "platform_radius", "height", "cost", "maker"]
    assert order[-1] == "rank"
    assert set(order) == {*TABLE.columns, *more, "rank"} - {"design"}


def test_the_front_and_its_knee_are_those_of_the_picture():
    rng = np.random.default_rng(3)
    table = pd.DataFrame(rng.integers(0, 12, (60, 2)).astype(float), columns=COLUMNS)
    spec = spec_of(gsp.plots.explorer(table, COLUMNS))
    high, low = table.to_numpy().T
    beaten = (high[:, None] <= high) & (low[:, None] >= low)
    beaten &= (high[:, None] < high) | (low[:, None] > low)
    assert sorted(spec["front"]) == np.flatnonzero(~beaten.any(axis=1)).tolist()
    assert (np.diff(high[spec["front"]]) >= 0.0).all()
    line, knee = gsp.plots.front(table, COLUMNS).lines
    np.testing.assert_array_equal(line.get_xdata(), high[spec["front"]])
    assert (knee.get_xdata()[0], knee.get_ydata()[0]) == (high[spec["knee"]], low[spec["knee"]])


def test_of_three_objectives_the_front_is_that_of_all():
    sides = {"platform_radius": "lower", "cost": "lower", "score": "higher"}
    figure = gsp.plots.explorer(TABLE, sides)
    kept = gsp.exploration.pareto(TABLE, sides)["design"]
    names = TABLE["design"].to_numpy()
    assert set(names[spec_of(figure)["front"]]) == set(kept)
    assert repr(figure) == f"ExplorerFigure('6 designs, {len(kept)} on the front')"


def test_parallel_lines_are_those_of_the_picture():
    names = ["platform_radius", "maker", *COLUMNS]
    table = TABLE.assign(maker=["a", "b", "b", "a", "b", "c"])
    shown = spec_of(gsp.plots.explorer(table, COLUMNS, columns=names))["parallel"]
    drawn = gsp.plots.parallel(table, names).collections[0].get_segments()
    np.testing.assert_allclose([line[:, 1] for line in drawn], np.transpose(shown["heights"]))
    # By the score: 0.1, 0.2, 0.3; the others lack a value.
    assert shown["rows"] == [1, 2, 0]
    assert shown["marks"][1] == [[0.0, "a"], [0.5, "b"], [1.0, "c"]]


def test_heights_and_their_numbers_have_the_stated_side():
    spec = spec_of(gsp.plots.explorer(TABLE, {"score": "higher", "cost": "lower"}))
    lines, place = spec["parallel"], [one["name"] for one in spec["columns"]].index("cost")
    axis = lines["columns"].index(place)
    assert spec["columns"][place]["side"] == "lower"
    assert lines["marks"][axis] == [[1.0, "10"], [0.0, "60"]]
    costs = TABLE["cost"].to_numpy()[lines["rows"]]
    np.testing.assert_allclose(lines["heights"][axis], (60 - costs) / 50, atol=1e-9)


def test_columns_that_the_table_records_are_the_parameters():
    table = TABLE.copy()
    table.attrs["space"] = {"ranges": {"height": [1, 2]}, "choices": {"lost": ["a"], "maker": []}}
    for space, names in ((None, ["height", "maker"]), (SPACE, ["platform_radius", "height"])):
        spec = spec_of(gsp.plots.explorer(table, COLUMNS, designs=space))
        shown = [spec["columns"][i]["name"] for i in spec["parallel"]["columns"]]
        assert shown == [*names, *COLUMNS, "score"]


def test_designs_are_those_of_the_rows():
    table = TABLE.assign(platform_radius=[*TABLE["platform_radius"][:5], -1.0])
    figure = gsp.plots.explorer(table, COLUMNS, designs=SPACE)
    spaces = spaces_of(figure)
    assert "expected" in spaces[5]
    for row in range(5):
        radius, height = table["platform_radius"].iloc[row], table["height"].iloc[row]
        anchors = np.array(spaces[row]["platform"])
        np.testing.assert_allclose(np.hypot(anchors[:, 0], anchors[:, 1]), radius, rtol=1e-5)
        np.testing.assert_allclose(np.linalg.norm(spaces[row]["base"], axis=1), 2.0, rtol=1e-5)
        assert spaces[row]["place"]["position"] == [0.0, 0.0, height]
    assert spec_of(figure)["drawn"] == 5
    pose = gsp.Pose([0.1, 0.2, 1.3])
    moved = spaces_of(gsp.plots.explorer(table, COLUMNS, designs=SPACE, pose=pose))
    assert {tuple(one["place"]["position"]) for one in moved[:5]} == {(0.1, 0.2, 1.3)}


def test_designs_are_found_by_their_names_or_by_order():
    designs = [
        SPACE.design(platform_radius=0.5 + 0.1 * i, height=1.0).replace(name=f"hexapod {i}")
        for i in range(6)
    ]
    spaces = spaces_of(gsp.plots.explorer(TABLE, COLUMNS, designs=designs[::-1]))
    assert spaces[5] == "no design of this name was given"
    for row, one in enumerate(spaces[:5]):
        assert np.isclose(np.linalg.norm(one["platform"][0]), 0.5 + 0.1 * row, rtol=1e-5)
    unnamed = TABLE.drop(columns="design")
    figure = gsp.plots.explorer(unnamed, COLUMNS, designs=designs[::-1])
    assert np.isclose(np.linalg.norm(spaces_of(figure)[0]["platform"][0]), 1.0, rtol=1e-5)
    assert spec_of(figure)["names"][:3] == ["row 7", "row 7", "row 3"]


def test_few_designs_are_those_of_the_front_and_others_evenly():
    figure = gsp.plots.explorer(TABLE, COLUMNS, designs=SPACE, most=4)
    drawn = [row for row, one in enumerate(spaces_of(figure)) if one is not None]
    assert drawn == [0, 1, 2, 3]
    assert spec_of(figure)["front"] == [0, 2, 1]


def test_names_are_no_markup():
    html = gsp.plots.explorer(TABLE, COLUMNS, designs=SPACE).html
    assert html.count("<script") == html.count("</script>") == 1
    assert "<b>@" not in html
    assert "<!--" not in html


def test_nothing_is_loaded_from_elsewhere():
    html = gsp.plots.explorer(TABLE, COLUMNS).html
    assert "default-src 'none'" in html
    assert "src=" not in html
    assert set(re.findall(r"https?://[^\"]*", html)) == {"http://www.w3.org/2000/svg"}
    assert len(html) < 2_500_000


def test_files_are_not_replaced(tmp_path):
    figure = gsp.plots.explorer(TABLE, COLUMNS)
    figure.write(tmp_path / "designs.html")
    assert (tmp_path / "designs.html").read_text(encoding="utf-8") == figure.html
    with pytest.raises(UnwritableOutput, match="exists"):
        figure.write(tmp_path / "designs.html")
    with pytest.raises(InvalidInput, match=r"ends in \.html"):
        figure.write(tmp_path / "designs.png")
    assert [path.name for path in tmp_path.iterdir()] == ["designs.html"]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"table": TABLE.iloc[:0]}, "a table with rows"),
        ({"table": [1, 2]}, r"a pandas\.DataFrame"),
        ({"objectives": COLUMNS[:1]}, "at least two columns"),
        ({"objectives": ["height", "score"]}, '"higher" or "lower"'),
        ({"objectives": {"maker": "lower", "score": "higher"}}, "numbers"),
        ({"table": TABLE.assign(condition_number_max=np.inf)}, "a row with finite objectives that"),
        ({"columns": ["height"]}, "from 2 to 12 columns"),
        ({"columns": ["height", "mass"]}, "columns of the table"),
        ({"by": "maker"}, "numbers"),
        ({"by": "mass"}, "a column mass"),
        ({"designs": 3}, r"a gsp\.Space, or designs"),
        ({"designs": [3]}, r"a gsp\.Space, or designs"),
        ({"designs": []}, "a design for some of the rows"),
        ({"designs": [SPACE.design(platform_radius=1.0, height=1.0)] * 2}, "different names"),
        ({"designs": SPACE, "table": TABLE.drop(columns="height")}, "no column height"),
        ({"designs": SPACE, "table": TABLE.assign(height=-1.0)}, "a design for some"),
        ({"pose": gsp.Pose(np.zeros((2, 3)))}, "a single pose"),
        ({"pose": [0, 0, 1]}, "pose: expected"),
        ({"most": 0}, "most: expected"),
    ],
)
def test_bad_calls(given, message):
    with pytest.raises(InvalidInput, match=message):
        gsp.plots.explorer(**{"table": TABLE, "objectives": COLUMNS, **given})


def test_without_plotly_the_extra_is_named(monkeypatch):
    monkeypatch.setattr("gsp.installed.is_installed", lambda package: package != "plotly")
    with pytest.raises(MissingSoftware, match=r"plotly.*gsp-mechanisms\[plots\]"):
        gsp.plots.explorer(TABLE, COLUMNS)


NAME = "document.getElementById('name').textContent"
VALUES = "document.getElementById('values').textContent"
# Where a row of the first visible coordinates is on the screen.
PLACE = """(row => {{
  const plot = document.getElementById('points'), {{ left, top }} = plot.getBoundingClientRect();
  const {{ xaxis: x, yaxis: y }} = plot._fullLayout;
  const at = name => spec.columns[spec[name]].values[row];
  return [left + x._offset + x.d2p(at('x')), top + y._offset + y.d2p(at('y'))];
}})({})"""


# A page as notebooks show it: in a frame of another page.
FRAME = "document.querySelector('iframe')?.contentWindow"


@in_browser
def test_a_click_shows_the_design_and_a_range_dims_the_others(browsed, tmp_path):
    """In the output of a notebook, which is a frame in another page."""
    shown = gsp.plots.explorer(TABLE, COLUMNS, designs=SPACE)._repr_html_()
    page = f"<!doctype html><style>body {{ margin: 0 }}</style>{shown}"
    (tmp_path / "notebook.html").write_text(page, encoding="utf-8")

    async def mouse(tab, place, *kinds):
        for kind in kinds:
            given = {"button": "left", "clickCount": 1, "x": place[0], "y": place[1]}
            await tab.send("Input.dispatchMouseEvent", type=kind, **given)

    async def points(tab, until):
        """Point at two designs and click on them."""
        for row in (5, 1):
            design, radius, cost = TABLE.iloc[row][["design", "platform_radius", "cost"]]
            place = await until(PLACE.format(row))
            await mouse(tab, place, "mouseMoved")
            hover = "document.querySelector('#points .hovertext')?.textContent"
            label = await until(f"{hover}?.includes({json.dumps(design)}) && {hover}")
            assert f"cost: {cost}" in label
            await mouse(tab, place, "mousePressed", "mouseReleased")
            values = await until(f"{NAME} === {json.dumps(design)} && {VALUES}")
            assert f"platform radius{radius:g}" in values
            drawn = await until("Math.hypot(...scene.drawing.legs[0].platform)")
            assert np.isclose(drawn, radius, rtol=1e-4)

    async def work():
        async with chromium.tabs(browsed, tmp_path) as opened:
            tab = await opened((tmp_path / "notebook.html").as_uri(), 1000, 1000)
            await tab.send("Page.bringToFront")

            async def until(script):
                return await tab.until(f"{FRAME}?.eval({json.dumps(script)})")

            await until("document.getElementById('kept')?.textContent")
            assert await until(NAME) == "hexapod 2"  # the knee
            gaps = await until("document.getElementById('gaps').textContent")
            assert "CDN_CL, max is infinite at 1 and undefined at 1 of 6 designs" in gaps
            assert "2 of 6 designs have no place here" in gaps
            assert await until("document.querySelectorAll('.gsp-label-number').length") == 6
            await points(tab, until)
            await until("document.querySelector('#lines .grip').focus() || true")
            for _ in range(12):
                await tab.key("ArrowUp", 38)
            # From 60 % of 0.6 to 1.4 on: two of the three rows that have a line.
            kept = "document.getElementById('kept').textContent"
            await until(f"{kept}.includes('2 of 6 designs: platform radius 1.2 to 1.4')")
            await until("document.getElementById('points').data[1].selectedpoints.length === 2")
            assert tab.errors == []
            assert {url.split(":")[0] for url in tab.requests} <= {"about", "file", "blob", "data"}

    asyncio.run(work())
