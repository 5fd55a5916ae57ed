import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest

mpl.use("Agg")

import gsp
from gsp import plots
from gsp.errors import InvalidInput
from gsp.families import nawratil
from gsp.families.nawratil.motion import compare_screws
from tests.plots.ink import assert_ink


def test_contours_show_the_grid_and_the_best_point():
    alpha, h = np.linspace(0, 0.5, 9), np.linspace(0.1, 1.0, 7)
    values = nawratil.over_example_set(gsp.indices.control_number, alpha, h)
    axes = plots.contours(
        values, np.rad2deg(alpha), h, best=(4.0, 0.39), ridge=([0, 10], [0.5, 0.3]), title="CTN"
    )
    assert axes.get_title() == "CTN"
    assert axes.get_xlabel() == "α [°]"
    ridge, best = axes.lines
    np.testing.assert_array_equal(best.get_xydata(), [[4.0, 0.39]])
    np.testing.assert_array_equal(ridge.get_ydata(), [0.5, 0.3])


def test_contours_of_shapes_that_do_not_fit_are_errors():
    with pytest.raises(InvalidInput, match="shape"):
        plots.contours(np.zeros((3, 4)), np.arange(3.0), np.arange(4.0))


GRID = np.add.outer(np.arange(3.0), np.arange(4.0))
AXES = np.array([0.0, 1.0, 0.0, 0.1, 0.0, 0.2])


@pytest.mark.parametrize(
    "values",
    [
        GRID,
        0.0 * GRID + 2.0,
        np.where(GRID == 2.0, np.nan, GRID),
        np.where(GRID == 5.0, np.inf, GRID),
        1e200 * GRID,
        1e-200 * GRID,
        -GRID,
    ],
)
def test_contours_of_unusual_values_have_ink(values):
    assert_ink(plots.contours(values, np.arange(4.0), np.arange(3.0)).figure)


@pytest.mark.parametrize(
    "call",
    [
        lambda: plots.contours(GRID * np.nan, np.arange(4.0), np.arange(3.0)),
        lambda: plots.contours(GRID[:1], np.arange(4.0), [1.0]),
        lambda: plots.contours("x", np.arange(4.0), np.arange(3.0)),
        lambda: plots.contours(GRID, None, np.arange(3.0)),
        lambda: plots.contours(GRID, np.arange(4.0), np.arange(3.0), 3),
        lambda: plots.contours(GRID, np.arange(4.0), np.arange(3.0), levels=0),
        lambda: plots.contours(GRID, np.arange(4.0), np.arange(3.0), levels=[2, 1]),
        lambda: plots.contours(GRID, np.arange(4.0), np.arange(3.0), best=3.0),
        lambda: plots.contours(GRID, np.arange(4.0), np.arange(3.0), ridge=([1.0], [1.0, 2.0])),
        lambda: plots.screws(3, ["pitch_c"]),
        lambda: plots.screws(pd.DataFrame({"pitch_c": [1.0]}), ["pitch_c"]),
        lambda: plots.screws(pd.DataFrame({"pitch_c": [1.0], "angle": ["x"]}), ["pitch_c"]),
        lambda: plots.screws(pd.DataFrame({"pitch_c": [1.0], "angle": [1.0]}), 3),
        lambda: plots.screw_axes({}, (0, 1)),
        lambda: plots.screw_axes(AXES, (0, 1)),
        lambda: plots.screw_axes({"a": AXES[:5]}, (0, 1)),
        lambda: plots.screw_axes({"a": AXES}, (0, 0)),
        lambda: plots.screw_axes({"a": AXES}, 3),
        lambda: plots.screw_axes({"a": AXES}, (0, 1), half_length=-1.0),
    ],
)
def test_wrong_arguments_are_errors(call):
    with pytest.raises(InvalidInput):
        call()


def test_screws_draws_the_columns_that_are_asked_for():
    table = compare_screws("x", np.linspace(0.9, 1.3, 5))
    axes = plots.screws(table, ["pitch_c", "pitch_p"])
    for line, column in zip(axes.lines, ["pitch_c", "pitch_p"], strict=True):
        np.testing.assert_array_equal(line.get_ydata(), table[column])
    with pytest.raises(InvalidInput, match="columns"):
        plots.screws(table, ["nothing"])


def test_screw_axes_are_drawn_through_their_points():
    line = np.array([0.0, 1.0, 0.0, *np.cross([0.3, 0.0, 0.7], [0.0, 1.0, 0.0])])
    axes = plots.screw_axes({"known": line}, (0, 2))
    middle = axes.lines[-1].get_xydata()
    np.testing.assert_allclose(middle, [[0.3, 0.7]], atol=1e-12)


@pytest.mark.parametrize(
    "options",
    [{"labels": wrong} for wrong in (None, 3, "ab", ("a",), ("a", 1), {}, np.zeros(2))]
    + [{"ridge": wrong} for wrong in (3, object(), [1, 2], np.zeros((2, 2, 2)), "ab")]
    + [{"best": wrong} for wrong in (np.zeros((2, 2)), "ab", 1)]
    + [{"title": wrong} for wrong in (None, 3)],
)
def test_wrong_options_of_contours_are_errors(options):
    with pytest.raises(InvalidInput):
        plots.contours(np.arange(6.0).reshape(2, 3), [0, 1, 2], [0, 1], **options)
