"""Pictures of fronts and parallel coordinates: what is drawn where."""

import numpy as np
import pandas as pd
import pytest

from gsp import plots
from gsp.errors import InvalidInput

TABLE = pd.DataFrame({
    "radius": [1.0, 2.0, 3.0, 4.0], "legs": ["D1", "D2", "D1", "D3"],
    "control_number_mean": [0.1, 0.4, 0.2, 0.3], "condition_number_max": [2.0, 8.0, 3.0, 4.0],
    "score": [0.4, 0.1, 0.3, 0.2],
})  # fmt: skip
COLUMNS = ["control_number_mean", "condition_number_max"]


def test_a_front_has_its_designs_in_order_and_better_up_and_right():
    table = pd.concat([TABLE, TABLE.assign(condition_number_max=9.0)], ignore_index=True)
    ax = plots.front(table, COLUMNS)
    line, knee = ax.lines
    np.testing.assert_array_equal(line.get_xdata(), [0.1, 0.2, 0.3, 0.4])
    np.testing.assert_array_equal(line.get_ydata(), [2.0, 3.0, 4.0, 8.0])
    # Shares of the ranges: 0 + 1, 1/3 + 5/6, 2/3 + 4/6, 1 + 0.
    assert (knee.get_xdata()[0], knee.get_ydata()[0]) == (0.3, 4.0)
    assert ax.yaxis.get_inverted()
    assert not ax.xaxis.get_inverted()
    assert len(ax.collections[0].get_offsets()) == 8
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("CTN, mean ↑", "CDN$_\\mathrm{CL}$, max ↓")


@pytest.mark.parametrize("index", [[7, 7, 7, 7], [0, 0, 1, 1]])
def test_labels_of_rows_do_not_move_the_knee(index):
    knee = plots.front(TABLE.set_axis(index), COLUMNS).lines[1]
    assert (knee.get_xdata()[0], knee.get_ydata()[0]) == (0.3, 4.0)


def test_rows_without_a_number_are_left_out():
    table = TABLE.assign(condition_number_max=[2.0, np.inf, np.nan, 4.0])
    ax = plots.front(table, COLUMNS)
    np.testing.assert_array_equal(ax.lines[0].get_xdata(), [0.1, 0.3])
    lines = plots.parallel(table, ["radius", *COLUMNS]).collections[0].get_segments()
    assert len(lines) == 2


def test_lines_of_parallel_coordinates_go_through_the_values():
    ax = plots.parallel(TABLE, ["radius", "legs", *COLUMNS])
    drawn = ax.collections[0]
    # The best score comes last, on top.
    np.testing.assert_array_equal(drawn.get_array(), [0.1, 0.2, 0.3, 0.4])
    best = drawn.get_segments()[-1]
    np.testing.assert_allclose(best, [[0, 0.0], [1, 0.0], [2, 0.0], [3, 1.0]], atol=1e-15)
    texts = {(note.xy[0], round(float(note.xy[1]), 9)): note.get_text() for note in ax.texts}
    assert texts[0, 0.0] == "1"
    assert texts[1, 0.5] == "D2"
    assert (texts[3, 0.0], texts[3, 1.0]) == ("8", "2")


@pytest.mark.parametrize("name", ["radius", "control_number_mean"])
def test_a_stated_side_turns_an_axis_its_numbers_and_its_order(name):
    """Also where the usual side of an index is another one."""
    ax = plots.parallel(TABLE, [name, "score"], by=name, better={name: "lower"})
    values = TABLE[name].to_numpy()
    heights = (values.max() - values) / np.ptp(values)
    lines = ax.collections[0]
    np.testing.assert_array_equal(lines.get_array(), sorted(values, reverse=True))
    drawn = [line[0][1] for line in lines.get_segments()]
    np.testing.assert_allclose(drawn, sorted(heights), atol=1e-15)
    texts = {float(note.xy[1]): note.get_text() for note in ax.texts if note.xy[0] == 0}
    assert texts == {0.0: f"{values.max():.4g}", 1.0: f"{values.min():.4g}"}
    assert ax.get_xticklabels()[0].get_text().endswith("↓")


def test_a_stated_side_turns_axes_of_texts_and_of_bools():
    table = TABLE.assign(leaks=[True, False, True, False])
    ax = plots.parallel(table, ["legs", "leaks"], better={"legs": "lower", "leaks": "lower"})
    texts = {(note.xy[0], float(note.xy[1])): note.get_text() for note in ax.texts}
    assert (texts[0, 1.0], texts[0, 0.0]) == ("D1", "D3")
    assert (texts[1, 1.0], texts[1, 0.0]) == ("False", "True")
    for line, row in zip(ax.collections[0].get_segments(), (1, 3, 2, 0), strict=True):
        assert texts[0, line[0][1]] == table["legs"][row]
        assert texts[1, line[1][1]] == str(table["leaks"][row])


def test_long_texts_keep_their_ends():
    table = TABLE.assign(maker=[f"a very long name of a maker, number {i}" for i in range(4)])
    ax = plots.parallel(table, ["maker", "score"])
    texts = [note.get_text() for note in ax.texts if note.xy[0] == 0]
    assert texts == [f"a very l… number {i}" for i in range(4)]


def test_ends_of_an_axis_that_differ_have_different_numbers():
    table = TABLE.assign(radius=[0.9, 0.9000001, 0.90000005, 0.9])
    ax = plots.parallel(table, ["radius", "score"])
    texts = [note.get_text() for note in ax.texts if note.xy[0] == 0]
    assert texts == ["0.9", "0.9000001"]


def test_a_design_that_an_infinite_value_beats_is_not_on_the_front():
    table = pd.DataFrame({"a": [np.inf, 1.0, 2.0, 3.0], "b": [1.0, 0.0, 2.0, 1.0]})
    sides = {"a": "higher", "b": "lower"}
    ax = plots.front(table, sides)
    line, shown = ax.lines[0], [text.get_text() for text in ax.get_legend().get_texts()]
    assert shown[0] == "designs (1 with infinite values not drawn)"
    assert list(zip(line.get_xdata(), line.get_ydata(), strict=True)) == [(1.0, 0.0)]
    with pytest.raises(InvalidInput, match="a row with finite objectives that no row beats"):
        plots.front(table.assign(b=[0.0, 0.0, 2.0, 1.0]), sides)


def test_values_near_the_largest_number_have_heights():
    table = TABLE.assign(radius=[-1e308, 1e308, 0.0, 5e307])
    lines = plots.parallel(table, ["radius", "score"]).collections[0].get_segments()
    np.testing.assert_allclose(sorted(line[0][1] for line in lines), [0.0, 0.5, 0.75, 1.0])


def test_few_very_large_values_make_a_scale_logarithmic():
    table = TABLE.assign(condition_number_max=[1.0, 1.0, 10.0, 1e6])
    assert plots.front(table, COLUMNS).get_yscale() == "log"
    assert plots.front(TABLE, COLUMNS).get_yscale() == "linear"
    lines = plots.parallel(table, COLUMNS).collections[0].get_segments()
    heights = sorted(line[1][1] for line in lines)
    np.testing.assert_allclose(heights, [0.0, 5 / 6, 1.0, 1.0], atol=1e-12)


@pytest.mark.parametrize(
    ("draw", "given", "message"),
    [
        (plots.front, {"objectives": [*COLUMNS, "score"]}, "two columns"),
        (plots.front, {"objectives": ["radius", "score"]}, '"higher" or "lower"'),
        (plots.parallel, {"columns": ["radius"]}, "from 2 to 12 columns"),
        (plots.parallel, {"columns": ["radius", "mass"]}, "columns of the table"),
        (plots.parallel, {"columns": COLUMNS, "by": "legs"}, "numbers"),
        (plots.parallel, {"columns": COLUMNS, "better": {"mass": "lower"}}, "columns of the table"),
        *(
            (plots.parallel, {"columns": COLUMNS, "better": one}, "better: expected")
            for one in ("", 0, [], np.zeros((2, 2)), pd.Series([1.0]), pd.DataFrame(), pd.NA)
        ),
        (plots.parallel, {"columns": COLUMNS, "better": {"radius": "up"}}, '"higher" or "lower"'),
    ],
)
def test_bad_calls(draw, given, message):
    with pytest.raises(InvalidInput, match=message):
        draw(TABLE, **given)
    with pytest.raises(InvalidInput, match=r"a pandas\.DataFrame"):
        draw([1, 2], **given)
