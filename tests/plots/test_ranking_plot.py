"""The picture of a ranking: where its parts are, and in which direction values are better."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from scipy.stats import spearmanr

import gsp
from gsp.errors import InvalidInput, MissingSoftware
from gsp.indices import INDICES
from gsp.plots import against, panels, ranges, ranking
from gsp.plots.common.style import CLASSES, save_figure
from gsp.plots.rankings import first_names
from tests import campaign, driven
from tests.plots.ink import assert_ink, ink


@pytest.fixture(scope="module")
def table() -> pd.DataFrame:
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    designs = [gsp.catalogue.instantiate(m, template) for m in gsp.catalogue.mechanisms()[::7]]
    box = gsp.PoseBox.around(template.home, [20.0] * 3 + [0.1] * 3)
    sphere = gsp.Ellipsoid(90.0)
    return gsp.rank(
        designs, box.sample(10, rng=0), list(INDICES), ellipsoid=sphere, maximum="sample"
    )


def points(ax, table):
    """Points of the classes, in the order of the table's rows of each class."""
    found = []
    for group in CLASSES:
        offsets = next(c for c in ax.collections[list(CLASSES).index(group) :]).get_offsets()
        found.append(pd.DataFrame(np.asarray(offsets), index=table.index[table["class"] == group]))
    return pd.concat(found).sort_index().to_numpy()


def test_large_axes_have_numbers_enough_and_ranks_are_integers(table):
    for names in (("control_number", "condition_number"), ("rank", "control_number")):
        ax = against(table, *names)
        ax.figure.canvas.draw()
        for axis in (ax.xaxis, ax.yaxis):
            low, high = sorted(axis.get_view_interval())
            assert sum(low <= x <= high for x in axis.get_majorticklocs()) >= 3
    assert all(float(x).is_integer() for x in ax.get_xticks())


def test_points_are_the_means(table):
    ax = against(table, "condition_number", "control_number")
    wanted = table[["condition_number_mean", "control_number_mean"]].to_numpy()
    np.testing.assert_array_equal(points(ax, table), wanted)


@pytest.mark.parametrize("name", list(INDICES))
def test_better_is_right_and_up(table, name):
    ax = against(table, name, name)
    better_is_low = INDICES[name].better == "lower"
    assert ax.xaxis_inverted() == better_is_low
    assert ax.yaxis_inverted() == better_is_low
    assert INDICES[name].better in ax.get_xlabel()


def test_classes_differ_by_colour_and_marker(table):
    assert len({colour for colour, _ in CLASSES.values()}) == len(CLASSES)
    assert len({marker for _, marker in CLASSES.values()}) == len(CLASSES)
    assert set(CLASSES) == {m.group for m in gsp.catalogue.mechanisms()}


def test_matrix_shows_every_pair(table):
    names = list(INDICES)[:5]
    figure = ranking(table, names)
    n = len(names)
    panels = [ax for ax in figure.axes if ax.axison]
    assert len(panels) == n * (n - 1) // 2
    texts = [t.get_text() for ax in figure.axes for t in ax.texts]
    assert sum("is better" in text for text in texts) == n


def test_many_indices_show_the_first_six_with_the_deciding_one(table):
    names = list(INDICES)
    assert first_names(names[:4], names[2]) == names[:4]
    assert first_names(names, names[0]) == names[:6]
    assert first_names(names, names[8]) == [*names[:5], names[8]]


def test_correlations_are_of_goodness(table):
    """CDN_CL and CTN rank alike when low values of one belong to high values of the other."""
    names = ["condition_number", "control_number", "quality_index"]
    figure = ranking(table, names)
    rho = spearmanr(-table["condition_number_mean"], table["control_number_mean"]).statistic
    shown = figure.axes[1].texts[0].get_text().replace("−", "-")
    assert float(shown) == pytest.approx(rho, abs=0.005)


def test_legend_names_classes_and_the_first(table):
    texts = [t.get_text() for t in ranking(table).legends[0].get_texts()]
    assert texts[:-1] == [g for g in CLASSES if (table["class"] == g).any()]
    first = gsp.catalogue.mechanism(table["design"].iloc[0]).latex
    assert first in texts[-1]


@pytest.mark.parametrize("names", [["control_number"], ["control_number", "condition_number"]])
def test_few_indices_are_one_panel(table, names):
    figure = ranking(table, names)
    assert len(figure.axes) == 1
    label = figure.axes[0].get_xlabel()
    assert label == "rank" if len(names) == 1 else "CTN" in label


def test_worst_values_stay_in_the_picture(table):
    """Singular in the mean: inf and 0 are beyond the worst finite value, NaN is left out."""
    broken = table.copy()
    broken.loc[3, "condition_number_mean"] = np.inf
    broken.loc[4, "control_number_mean"] = 0.0
    broken.loc[5, "control_number_mean"] = np.nan
    ax = against(broken, "condition_number", "control_number")
    got = points(ax, broken)
    known = broken["condition_number_mean"][np.isfinite(broken["condition_number_mean"])]
    assert known.max() < got[3, 0] < np.inf
    assert 0.0 < got[4, 1] < broken["control_number_mean"][broken["control_number_mean"] > 0].min()
    assert np.isnan(got[5, 1])


def test_all_singular_draws(tmp_path, table):
    broken = table.assign(condition_number_mean=np.inf, control_number_mean=0.0)
    names = ["condition_number", "control_number", "quality_index"]
    save_figure(ranking(broken, names), tmp_path / "x.png")
    assert (tmp_path / "x.png").stat().st_size > 1000


def test_given_axes_are_used(table):
    import matplotlib.pyplot as plt

    _, ax = plt.subplots()
    assert against(table, "rank", "control_number", ax) is ax


def test_invalid_tables_are_errors(table, monkeypatch):
    with pytest.raises(InvalidInput, match="beauty"):
        ranking(table, ["beauty"])
    with pytest.raises(InvalidInput, match="a ranking"):
        ranking(pd.DataFrame({"x": [1.0]}))
    monkeypatch.setattr("gsp.installed.is_installed", lambda package: False)
    with pytest.raises(MissingSoftware, match="matplotlib"):
        ranking(table)


@pytest.mark.parametrize("number", [1, 2, 3, 8])
def test_few_designs_show_how_their_indices_are_distributed(table, number):
    """A correlation of three points has no meaning: panels of quantiles, the best design on top."""
    few = table.head(number)
    names = ["condition_number", "control_number", "manipulability"]
    figure = ranking(few, names)
    assert [ax.get_xscale() for ax in figure.axes] == ["log", "linear", "log"]
    assert_ink(figure)
    for ax, name in zip(figure.axes, names, strict=True):
        ranges, dots = ax.lines[0::4], ax.lines[2::4]
        assert len(ranges) == number
        for i, (line, dot) in enumerate(zip(ranges, dots, strict=True)):
            row = few.iloc[i]
            np.testing.assert_array_equal(line.get_xdata(), row[[f"{name}_min", f"{name}_max"]])
            assert dot.get_xdata() == row[f"{name}_median"]
            assert (line.get_ydata() == number - 1 - i).all()
    assert len(figure.axes[0].get_yticklabels()) == number


CHANGES = {
    "constant": lambda v: 0.0 * v + 0.5,
    "zero": lambda v: 0.0 * v,
    "infinite": lambda v: 0.0 * v + np.inf,
    "undefined": lambda v: 0.0 * v + np.nan,
    "half undefined": lambda v: v.where(v.index % 2 == 0),
    "one infinite": lambda v: v.where(v.index != 0, np.inf),
    "scales apart": lambda v: v * 10.0 ** (6.0 * v.index),
}


@pytest.mark.parametrize("kind", campaign.some(CHANGES, 3))
@pytest.mark.parametrize(("number", "width"), [(3, 1), (12, 3)])
def test_unusual_rankings_are_drawn(table, kind, number, width):
    names = ["condition_number", "control_number", "manipulability"][:width]
    few = table.head(number).copy()
    for name in few.columns:
        if name.rsplit("_", 1)[0] in names:
            few[name] = CHANGES[kind](few[name])
    few["note"] = "mine"
    if kind == "undefined" and number == 12:
        with pytest.raises(InvalidInput, match="a defined mean"):
            ranking(few, names)
        return
    figure = ranking(few, names)
    seen = ink(figure)
    assert max(seen) >= 8
    if kind not in ("undefined", "half undefined"):
        assert min(seen) >= 8


@pytest.mark.parametrize("draw", [ranking, lambda t: against(t, "rank", "control_number")])
@pytest.mark.parametrize("bad", [None, 3, "x", pd.DataFrame(), pd.DataFrame({"rank": [1]}), []])
def test_a_table_that_is_not_a_ranking_is_an_error(draw, bad):
    with pytest.raises(InvalidInput, match="table"):
        draw(bad)


def test_wrong_arguments_are_errors(table):
    for call in (
        lambda: ranking(table, 3),
        lambda: ranking(table, [3]),
        lambda: ranking(table, []),
        lambda: ranking(table.drop(columns="class")),
        lambda: ranking(table.assign(control_number_mean="x"), ["control_number"]),
        lambda: against(table, "rank", "beauty"),
        lambda: against(table, None, "rank"),
        lambda: against(table, "rank", "control_number", 3),
    ):
        with pytest.raises(InvalidInput):
            call()


@pytest.mark.parametrize("suffix", campaign.some([".png", ".pdf", ".svg"], 2))
def test_files_are_the_same_twice(tmp_path, table, suffix):
    names = ["control_number", "condition_number"]
    for stem in ("a", "b"):
        save_figure(ranking(table, names), tmp_path / (stem + suffix))
    a, b = ((tmp_path / (stem + suffix)).read_bytes() for stem in ("a", "b"))
    assert a == b


def test_other_classes_and_odd_names_draw(tmp_path, table):
    odd = table.assign(**{"class": "7D", "design": "a$_b$ $c"})
    ax = against(odd, "rank", "control_number")
    assert "other" in [t.get_text() for t in ax.get_legend().get_texts()]
    save_figure(ax.get_figure(), tmp_path / "x.png")


def test_a_design_that_is_singular_everywhere_has_a_note_in_each_row(table):
    few = table.head(3).copy()
    for key in ("mean", "min", "q05", "median", "q95", "max"):
        few.loc[few.index[2], f"condition_number_{key}"] = np.inf
        few.loc[few.index[2], f"manipulability_{key}"] = 0.0
    figure = ranking(few, ["condition_number", "manipulability"])
    written = [[text.get_text() for text in ax.texts] for ax in figure.axes]
    assert written == [["∞"], ["0"]]


def test_unnamed_and_long_names_have_short_labels(table):
    few = table.head(3).copy()
    few["design"] = ["", "a name of very many words " * 9, "mine"]
    few["rank"] = [1, 2, 3]
    ax = ranking(few, ["control_number"]).axes[0]
    first, second, third = (label.get_text() for label in ax.get_yticklabels())
    assert (first, third) == ("unnamed, rank 1", "mine")
    assert max(map(len, second.split("\n"))) <= 26
    assert second.count("\n") == 1


def test_a_design_without_a_rank_is_not_the_first(table):
    few = table.head(3).copy()
    few["rank"] = [np.nan, 2.0, 1.0]
    assert panels._best(few) == 2


@pytest.mark.parametrize("wrong", [np.zeros(2), pd.Series([1, 2]), 3, None, ["rank"]])
def test_names_of_axes_are_texts(table, wrong):
    with pytest.raises(InvalidInput):
        against(table, wrong, "rank")
    with pytest.raises(InvalidInput):
        against(table, "rank", wrong)


def test_indices_of_unlike_units_are_left_out_unless_named(table):
    """|det J| is in mm³, mm², mm or 1 here: its means do not compare."""
    assert "," in table.attrs["units"]["manipulability"]
    text = {t.get_text() for ax in ranking(table).axes for t in ax.texts}
    assert not any("det" in label for label in text)
    named = ranking(table, ["manipulability", "condition_number", "control_number"])
    assert any("det" in t.get_text() for ax in named.axes for t in ax.texts)


def test_indices_are_given_by_symbol(table):
    by_name = against(table, "condition_number", "control_number")
    by_symbol = against(table, "CDN_CL", "CTN")
    np.testing.assert_array_equal(points(by_name, table), points(by_symbol, table))
    assert len(ranking(table, "CTN").axes) == len(ranking(table, "control_number").axes)
    with pytest.raises(InvalidInput, match="one index"):
        against(table, "all", "CTN")


def test_values_beyond_the_axes_are_on_a_line_with_their_name(table):
    broken = table.copy()
    broken.loc[3, "condition_number_mean"] = np.inf
    ax = against(broken, "condition_number", "control_number")
    assert [text.get_text() for text in ax.texts] == ["∞"]
    assert ax.texts[0].get_position()[0] == pytest.approx(points(ax, broken)[3, 0])
    alone = against(table.assign(condition_number_mean=np.inf), "condition_number", "rank")
    assert [text.get_text() for text in alone.texts] == ["∞"]
    assert len(alone.get_xticks()) == 0  # a number would be a value of the index
    assert not against(table, "condition_number", "control_number").texts


@pytest.mark.parametrize("name", ["condition_number", "control_number"])
def test_ranges_are_of_all_placements_of_a_mechanism(name):
    template = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    names = ("D1^5 D2", "D1^4 D2^2", "D4^3 A1^3")
    designs = [
        design
        for text in names
        for design in gsp.catalogue.placements(gsp.catalogue.mechanism(text), template)
    ]
    table = gsp.rank(designs, template.home, name)
    table.loc[table["design"] == designs[1].name, f"{name}_mean"] = np.nan  # of several: left out
    ax = ranges(table)
    means = table.groupby("mechanism")[f"{name}_mean"]
    low, high = means.min(), means.max()
    better_is_low = INDICES[name].better == "lower"
    best = low if better_is_low else high
    order = best.sort_values(ascending=better_is_low).index
    drawn, marks = {}, {}
    for lines in (c for c in ax.collections if hasattr(c, "get_segments")):
        drawn |= {round(s[0][0]): sorted(s[:, 1]) for s in lines.get_segments()}
    for dots in (c for c in ax.collections if not hasattr(c, "get_segments")):
        marks |= {round(x): y for x, y in dots.get_offsets()}
    for place, mechanism in enumerate(order, 1):
        np.testing.assert_allclose(drawn[place], [low[mechanism], high[mechanism]], rtol=1e-12)
        np.testing.assert_allclose(marks[place], best[mechanism], rtol=1e-12)
    assert len(drawn) == len(marks) == len(names)
    assert ax.yaxis_inverted() == better_is_low
    assert [t.get_text() for t in ax.get_legend().get_texts()] == ["6D, best", "3D3A, best"]


@pytest.fixture(scope="module")
def drives():
    """A rotary platform, a hexaglide, and a telescopic hexapod on the anchors of the first."""
    rotary = driven.rotary()
    plain = gsp.Design(["D1"] * 6, rotary.base_points, rotary.platform_points, unit="m", name="t")
    names = ["CTN", "CDN_CL"]
    few = [rotary.replace(name="r"), driven.hexaglide().replace(name="h"), plain]
    many = [plain.replace(name=f"t{i}").scaled(1.0 + 0.01 * i) for i in range(6)]
    return [gsp.rank(x, rotary.home, names, length=1.0) for x in (few, [*few, *many])]


def test_designs_with_drives_have_hollow_marks_and_their_drives_as_labels(drives):
    few, many = drives
    labels = [t.get_text() for t in ranking(few).axes[0].get_yticklabels()]
    assert sorted(labels) == ["h\n6 sliders", "r\n6 cranks", "t"]
    figure = ranking(many)
    assert "drives" in [t.get_text() for t in figure.legends[0].get_texts()]
    rings = next(c for c in figure.axes[0].collections if not len(c.get_facecolors()))
    wanted = many.loc[many["drives"] != "", ["condition_number_mean", "control_number_mean"]]
    found = np.asarray(rings.get_offsets())
    if figure.axes[0].get_xlabel().startswith("CTN"):
        found = found[:, ::-1]
    np.testing.assert_allclose(np.sort(found, axis=0), np.sort(wanted.to_numpy(), axis=0))
    assert len(rings.get_offsets()) == 2


def test_ranges_of_legs_with_drives_are_apart(drives):
    values = drives[1]["control_number_mean"]
    ax = ranges(drives[1], "CTN")
    lines = [x for c in ax.collections if hasattr(c, "get_segments") for x in c.get_segments()]
    assert len(lines) == 2
    hollow = drives[1]["drives"] != ""
    ends = sorted([x[:, 1].min(), x[:, 1].max()] for x in lines)
    wanted = sorted([values[m].min(), values[m].max()] for m in (hollow, ~hollow))
    np.testing.assert_allclose(ends, wanted)


def test_ranges_need_a_mechanism_and_a_mean(table):
    with pytest.raises(InvalidInput, match="table: expected a ranking with the column"):
        ranges(table.drop(columns="mechanism"))
    with pytest.raises(InvalidInput, match="a defined mean of control_number"):
        ranges(table.assign(control_number_mean=np.nan), "CTN")
    with pytest.raises(InvalidInput):
        ranges(None)


def test_a_link_may_lead_to_a_file_of_another_name(tmp_path):
    (tmp_path / "plain").touch()
    (tmp_path / "picture.png").symlink_to(tmp_path / "plain")
    figure, _ = plt.subplots()
    gsp.plots.save(figure, tmp_path / "picture.png", overwrite=True)
    assert (tmp_path / "plain").read_bytes().startswith(b"\x89PNG")
