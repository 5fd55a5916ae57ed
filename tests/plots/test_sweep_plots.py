"""Figures of sweeps: one axis per index, ink in every panel, and no value passed off as another."""

from __future__ import annotations

from itertools import pairwise

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text

import gsp
from gsp import plots, sweeps
from gsp.errors import GspError, InvalidInput
from gsp.indices import INDICES
from gsp.plots.common.scales import CONTOURED, levels_of, number_format, scale_of
from gsp.plots.common.style import log_ticks
from tests import campaign
from tests.plots.ink import assert_ink, ink

DESIGN = gsp.catalogue.design("toz-kucuk-2016-d3-6")
NAMES = ["condition_number", "control_number", "quality_index", "manipulability"]


@pytest.fixture(scope="module")
def line() -> pd.DataFrame:
    path = sweeps.turn(DESIGN.home, "z", np.linspace(-90, 90, 41))
    return gsp.sweep(DESIGN, path, NAMES, maximum=3.0)


@pytest.fixture(scope="module")
def area() -> pd.DataFrame:
    steps = np.linspace(-60, 60, 9)
    return gsp.sweep(DESIGN, sweeps.plane(DESIGN.home, steps, steps), NAMES, maximum=3.0)


def test_every_index_has_a_panel_and_an_axis_of_its_own(line):
    figure = plots.sweep(line)
    assert [ax.get_yscale() for ax in figure.axes] == ["log", "linear", "linear", "log"]
    for ax, name in zip(figure.axes, NAMES, strict=True):
        np.testing.assert_array_equal(ax.lines[0].get_ydata(), line[name])
        low, high = ax.get_ylim()
        assert low <= line[name].min() < line[name].max() <= high
        assert line[name].max() > 0.4 * high  # no flat line at the bottom
    assert_ink(figure)


def test_axes_name_the_motion_and_its_unit(line, area):
    assert plots.along(line, "control_number").get_xlabel() == "rotation about z [°]"
    ax = plots.over_plane(area)
    assert ax.get_xlabel() == "displacement along x [mm]"
    assert ax.get_ylabel() == "displacement along y [mm]"
    path = sweeps.translation(DESIGN.home, [1, 0, 1], [0.0, 1.0])
    tilted = gsp.sweep(DESIGN, path, "control_number")
    label = plots.along(tilted).get_xlabel()
    assert label == "displacement along (1, 0, 1) [mm]"


@pytest.mark.parametrize(
    ("unit", "label"), [(1e6, " [10⁶ mm]"), (1e-6, " [10⁻⁶ mm]"), (1.0, " [mm]")]
)
def test_lengths_of_any_size_have_one_power_of_ten_in_the_label(unit, label):
    design = DESIGN.scaled(unit)
    steps = unit * np.array([-3.0, 0.0, 3.0])
    plane = gsp.sweep(design, sweeps.plane(design.home, steps, steps), "CTN")
    lift = gsp.sweep(design, sweeps.translation(design.home, "z", steps), "CTN")
    over, along = plots.over_plane(plane), plots.along(lift)
    for axis, name in ((over.xaxis, "x"), (over.yaxis, "y"), (along.xaxis, "z")):
        axis.get_figure().canvas.draw()
        assert axis.get_label_text() == f"displacement along {name}{label}"
        assert axis.get_offset_text().get_text() == ""
        numbers = [text.get_text().replace("−", "-") for text in axis.get_ticklabels()]
        assert {"-2", "0", "2"} <= set(numbers)
    plt.close("all")


def test_figures_state_the_pose_that_is_moved(line, area):
    text = "from position (10, -10, 138) mm, roll, pitch, yaw (5, -5, -10)°"
    for table in (line, area):
        assert text in plots.sweep(table).get_suptitle()
    assert text in plots.along(line, "CTN").get_title(loc="left")
    unknown = line.copy()
    del unknown.attrs["pose"]
    assert "from" not in plots.sweep(unknown).get_suptitle()


def test_a_plane_is_drawn_for_every_index(area):
    assert "CDN" in plots.over_plane(area).get_title(loc="left")
    figure = plots.sweep(area)
    panels = [ax for ax in figure.axes if ax.get_xlabel()]
    assert len(panels) == len(NAMES)
    assert_ink(figure)
    ax = plots.over_plane(area, "control_number", levels=[0.1])
    assert ax.collections


@pytest.mark.parametrize("name", INDICES)
@pytest.mark.parametrize("seed", range(3))
def test_levels_increase_and_lie_among_the_values(name, seed):
    values = np.exp(np.random.default_rng(seed).normal(0, (0.01, 1, 9)[seed], 400))
    bounded = np.isfinite(INDICES[name].best) and np.isfinite(INDICES[name].worst)
    if bounded:
        values /= values.max()
    levels = levels_of(values, scale_of(values, name))
    assert (np.diff(levels) > 0).all()
    inside = (levels > values.min()) & (levels < values.max())
    assert 3 <= inside.sum() <= 15
    # Not almost all poses lie between the same two levels, unless the scale is that of the bounds.
    counts = np.histogram(values, [-np.inf, *levels, np.inf])[0]
    assert bounded or counts.max() < 0.5 * values.size


@pytest.mark.parametrize("width", [1e-7, 1e-4, 0.03, 1.0, 1e3])
@pytest.mark.parametrize("name", ["condition_number", "control_number", "manipulability"])
def test_numbers_of_levels_show_their_differences(name, width):
    values = 0.7 + width * np.linspace(0.0, 0.2, 50)
    if name == "condition_number":
        values += 1.0
    levels = levels_of(values, scale_of(values, name))
    for shown in (levels, levels[::2]):
        texts = [number_format(shown) % level for level in shown]
        assert len(set(texts)) == len(texts)
        errors = np.abs(np.array([float(text) for text in texts]) - shown)
        assert errors.max() <= 0.02 * np.diff(shown).min()
    assert number_format(np.array([0.1, 0.25, 0.5])) == "%.4g"


def test_numbers_of_a_narrow_plane_differ():
    path = sweeps.plane(DESIGN.home, [-1e-3, 0.0, 1e-3], [-1e-3, 0.0, 1e-3])
    ax = plots.over_plane(gsp.sweep(DESIGN, path, "CTN"))
    bar = ax.figure.axes[1]
    ax.figure.canvas.draw()
    texts = [text.get_text() for text in bar.get_yticklabels() if text.get_text()]
    assert len(texts) > 3
    assert len(set(texts)) == len(texts)
    plt.close(ax.figure)


@pytest.mark.parametrize("seed", range(4))
def test_levels_of_logarithmic_axes_are_positive_over_ranges_of_any_width(seed):
    rng = np.random.default_rng(seed)
    for _ in range(500):
        low = 10.0 ** rng.uniform(-8, 8)
        ratio = (rng.uniform(1.0, 12.0), rng.uniform(9.5, 10.5), 10.0 ** rng.uniform(-4, 9))[
            int(rng.integers(3))
        ]
        values = low * np.array([1.0, *ratio ** rng.uniform(0, 1, 30), max(ratio, 1.0 + 1e-6)])
        levels = levels_of(values, scale_of(values, "condition_number"))
        assert levels[0] > 0.0, (low, ratio)
        assert (np.diff(levels) > 0.0).all(), (low, ratio)
        assert ((levels > values.min()) & (levels < values.max())).sum() >= 2, (low, ratio)
        # No value is below the first level unless the levels are cut near the median.
        cut = values.min() < np.median(values) / CONTOURED
        assert cut or levels[0] <= values.min(), (low, ratio)


@pytest.mark.parametrize("ratio", [1.5, 9.8, 40.0])
def test_colour_bars_have_arrows_only_where_values_lie_beyond(area, ratio):
    values = np.geomspace(1.0, ratio, len(area))
    for last, extend in ((values[-1], "neither"), (np.inf, "max")):
        values[-1] = last
        figure = plots.sweep(changed(area, "condition_number", values))
        figure.canvas.draw()
        bars = [ax for ax in figure.axes if not ax.get_xlabel()]
        levels = levels_of(values, scale_of(values, "condition_number"))
        assert levels[0] == 1.0
        (filled,) = [c for c in figure.axes[0].collections if getattr(c, "filled", False)]
        assert filled.extend == extend
        assert len(bars) == 1
        plt.close(figure)


def changed(table: pd.DataFrame, name: str, values) -> pd.DataFrame:
    new = table[[*table.attrs["coordinates"], name]].copy()
    new[name] = values
    return new


def awkward(n: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(0)
    spread = rng.uniform(0.1, 0.9, n)
    return {
        "constant": np.full(n, 0.5),
        "constant to rounding": 0.5 + 1e-15 * rng.normal(size=n),
        "zeros": np.zeros(n),
        "infinite": np.full(n, np.inf),
        "undefined": np.full(n, np.nan),
        "half undefined": np.where(np.arange(n) % 2, np.nan, spread),
        "one defined": np.where(np.arange(n) == n // 2, 0.5, np.nan),
        "one infinite": np.where(np.arange(n) == n // 2, np.inf, spread),
        "huge and tiny": 10.0 ** rng.uniform(-300, 300, n),
        "tiny": 1e-310 * spread,
        "huge": 1e300 * spread,
        "beyond the bounds": 3.0 * spread,
        "spike": np.where(np.arange(n) == 3, 1e16, 1.0 + spread),
        "two values": np.where(np.arange(n) < n // 2, 1.0, 2.0),
    }


@pytest.mark.parametrize("kind", campaign.some(awkward(2), 5))
@pytest.mark.parametrize(
    ("which", "name"), [("line", NAMES[0]), ("line", NAMES[1]), ("area", NAMES[0])]
)
def test_unusual_values_are_drawn_or_stated(request, which, name, kind):
    source = request.getfixturevalue(which)
    table = changed(source, name, awkward(len(source))[kind])
    draw = plots.along if which == "line" else plots.over_plane
    nothing = scale_of(table[name].to_numpy(), name) is None
    assert nothing == (
        kind in ("undefined", "infinite") or (kind == "zeros" and name == "condition_number")
    )
    if nothing:
        state = {"undefined": "undefined", "infinite": "infinite", "zeros": "0"}[kind]
        for axes in (draw(table, name), plots.sweep(table, name).axes[0]):
            (note,) = axes.texts
            assert note.get_text().endswith(f" is {state} at every pose")
            assert_ink(axes.figure)
        return
    figure = draw(table, name).figure
    assert ink(figure)[0] >= 8
    if which == "line":
        (low, high), shown = figure.axes[0].get_ylim(), figure.axes[0].lines[0].get_ydata()
        assert ((shown >= low) & (shown <= high)).any()


def test_a_panel_without_values_states_the_reason(line):
    table = line.assign(control_number=np.nan)
    figure = plots.sweep(table)
    assert [t.get_text() for t in figure.axes[1].texts] == ["CTN is undefined at every pose"]
    assert_ink(figure)


def test_one_pose_is_a_point():
    table = gsp.sweep(DESIGN, sweeps.turn(DESIGN.home, "z", [3.0]), "control_number")
    assert_ink(plots.along(table).figure)


def test_infinite_values_leave_the_picture(line):
    values = line["condition_number"].to_numpy().copy()
    values[20] = np.inf
    ax = plots.along(changed(line, "condition_number", values))
    assert ax.lines[0].get_ydata()[20] > ax.get_ylim()[1]


def test_columns_of_the_user_are_left_alone(line, area):
    for table in (line, area):
        mine = table.assign(note="a", other=1j)
        assert_ink(plots.sweep(mine))
        for name in ("note", "other", "u$"):
            with pytest.raises(InvalidInput, match="indices"):
                plots.sweep(mine, name)


@pytest.mark.parametrize(
    "table",
    [None, 3, "x", np.zeros((3, 3)), pd.DataFrame(), pd.DataFrame({"a": [1.0]}), {"u": [1]}],
)
@pytest.mark.parametrize("draw", [plots.sweep, plots.along, plots.over_plane])
def test_a_table_that_is_not_a_sweep_is_an_error(draw, table):
    with pytest.raises(GspError):
        draw(table)


def test_wrong_arguments_are_errors(line, area):
    space = plt.figure().add_subplot(projection="3d")
    for call, message in (
        (lambda: plots.along(area), "1 coordinate"),
        (lambda: plots.over_plane(line), "2 coordinates"),
        (lambda: plots.along(line, "beauty"), "indices"),
        (lambda: plots.along(line, NAMES), "one index"),
        (lambda: plots.sweep(line, 3), "indices"),
        (lambda: plots.sweep(line, []), "indices"),
        (lambda: plots.along(line, ax=3), "ax"),
        (lambda: plots.along(line, ax=space), "ax"),
        (lambda: plots.over_plane(area, levels=[0.5, 0.2]), "levels"),
        (lambda: plots.over_plane(area, levels="x"), "levels"),
        (lambda: plots.over_plane(area.head(5)), "all rows"),
        (lambda: plots.along(line.assign(control_number="x"), "control_number"), "numbers"),
        (lambda: plots.along(line.assign(turn_deg=np.nan)), "turn_deg"),
    ):
        with pytest.raises(InvalidInput, match=message):
            call()


@pytest.mark.parametrize(("low", "high"), [(4.1, 5.9), (0.6, 1.1), (1.0, 9.0), (1.0, 2e5)])
def test_numbers_of_logarithmic_axes_do_not_overlap(low, high):
    figure, ax = plt.subplots(figsize=(3.0, 1.0))
    ax.set_xscale("log")
    log_ticks(ax.xaxis, low, high)
    ax.set_xlim(low, high)
    figure.canvas.draw()
    numbers = [label for label in ax.get_xticklabels(which="both") if label.get_text()]
    boxes = [label.get_window_extent() for label in numbers]
    assert len(boxes) >= 2
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_a_bounded_index_that_is_0_everywhere_is_seen(line):
    worst = line.copy()
    worst["control_number"] = 0.0
    ax = plots.along(worst, "control_number")
    assert ax.get_ylim()[0] < 0.0
    assert [text.get_text() for text in ax.texts] == ["constant: 0"]
    steps = worst[worst.columns[0]]
    assert ax.get_xlim() == (steps.min(), steps.max())


@pytest.mark.parametrize("given", ["CTN, λ", ["CTN", "λ"], ["control_number", "quality_index"]])
def test_indices_are_given_by_name_or_symbol(line, given):
    wanted = [column for name in ("control_number", "quality_index") for column in line[name]]
    figure = plots.sweep(line, given)
    assert [y for ax in figure.axes for y in ax.lines[0].get_ydata()] == wanted


def test_all_and_one(line, area):
    assert len(plots.sweep(line, "all").axes) == len(NAMES)
    np.testing.assert_array_equal(plots.along(line, "ctn").lines[0].get_ydata(), line[NAMES[1]])
    assert "CTN" in plots.over_plane(area, "CTN").get_title(loc="left")
    for bad in ("CTN, λ", "all", "σ_min", "beauty"):
        with pytest.raises(InvalidInput):
            plots.along(line, bad)


def test_the_title_of_a_narrow_plane_is_inside_the_figure():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    steps = np.linspace(-15, 15, 4), np.linspace(-80, 80, 5)
    ax = plots.over_plane(gsp.sweep(design, gsp.sweeps.plane(design.home, *steps), "CTN"))
    ax.figure.canvas.draw()
    title = next(t for t in ax.findobj(Text) if "translation" in t.get_text())
    assert title.get_window_extent().x1 <= ax.figure.bbox.width


def test_a_dollar_sign_in_a_unit_begins_no_formula():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6").replace(unit="$a_$b_")
    path = gsp.sweeps.translation(design.home, "z", [0.0, 1.0, 2.0])
    ax = plots.along(gsp.sweep(design, path, "|det J|"))
    ax.figure.canvas.draw()
    assert r"\$a_\$b_" in ax.get_ylabel()


def test_long_numbers_on_the_axis_of_a_plane_do_not_touch():
    design = gsp.catalogue.design("toz-kucuk-2016-d3-6").replace(strokes=None).scaled(1e4)
    steps = np.linspace(-1e6, 1e6, 4)
    ax = plots.over_plane(gsp.sweep(design, gsp.sweeps.plane(design.home, steps, steps), "CTN"))
    ax.figure.canvas.draw()
    places = [label.get_window_extent() for label in ax.get_xticklabels() if label.get_text()]
    assert len(places) >= 3
    assert all(left.x1 < right.x0 for left, right in pairwise(places))


@pytest.mark.parametrize("ends", [(1.8e8, 1.4e9), (2.7e7, 1.4e8), (1.83e8, 1.93e8)])
def test_long_numbers_on_a_logarithmic_axis_do_not_touch(ends):
    figure, ax = plt.subplots(figsize=(3.2, 1.0))
    ax.set_xscale("log")
    ax.set_xlim(*ends)
    log_ticks(ax.xaxis, *ends)
    figure.canvas.draw()
    shown = zip(ax.get_xticks(), ax.get_xticklabels(), strict=True)
    places = [label.get_window_extent() for x, label in shown if ends[0] <= x <= ends[1]]
    assert len(places) >= 2
    assert all(left.x1 < right.x0 for left, right in pairwise(places))


@pytest.mark.parametrize("steps", [3, 5, 7, 9])
@pytest.mark.parametrize("index", ["CTN", "CDN_CL"])
def test_texts_of_contours_are_not_cut_by_the_frame(steps, index):
    design = gsp.hexapod(2.0, 20.0, 1.0, 20.0, 1.5, degrees=True, unit="m")
    path = gsp.sweeps.plane(design.home, np.linspace(-1, 1, steps), np.linspace(-1, 1, steps))
    ax = gsp.plots.over_plane(gsp.sweep(design, path, index, length=1.0))
    ax.figure.canvas.draw()
    box = ax.get_window_extent()
    for text in ax.texts:
        extent = text.get_window_extent()
        assert box.x0 < extent.x0 < extent.x1 < box.x1, text.get_text()
        assert box.y0 < extent.y0 < extent.y1 < box.y1, text.get_text()
    assert len(ax.texts) >= (steps >= 5)


def test_the_axis_reaches_the_best_value_and_is_cut_near_singular_poses():
    values = np.array([20.0, *np.full(9, 2e5), 1e30])
    scale = scale_of(values, "condition_number")
    assert scale.low < 20.0
    assert scale.high < 1e20
    values = np.array([1e-30, *np.full(9, 2e-5), 0.5])
    scale = scale_of(values, "minimum_singular_value")
    assert scale.low > 1e-20
    assert scale.high > 0.5


@pytest.mark.parametrize("unit", [1.0, 1e-6, 1e7])
def test_titles_of_panels_do_not_cover_that_of_the_figure(unit):
    """Coordinates of small and of large units have a power of ten between axes and title."""
    design = gsp.hexapod(2.0 * unit, 0.3, unit, 0.3, 1.5 * unit)
    steps = np.linspace(-unit, unit, 3)
    table = gsp.sweep(design, sweeps.plane(design.home, steps, steps), ["CTN"])
    figure = plots.sweep(table)
    figure.canvas.draw()
    above = figure._suptitle.get_window_extent().y0
    lines = figure._suptitle.get_text().rstrip("\n").count("\n") + 1
    if figure._suptitle.get_text().endswith("\n"):
        above += figure._suptitle.get_window_extent().height / (lines + 1)
    for ax in figure.axes:
        if ax._left_title.get_text():
            assert ax._left_title.get_window_extent().y1 <= above + 1.0
