import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")

import gsp
from gsp import plots
from gsp.errors import InvalidInput
from gsp.families import nawratil
from gsp.families.nawratil_motion import compare_screws


@pytest.fixture(autouse=True)
def _close():
    yield
    import matplotlib.pyplot as plt

    plt.close("all")


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


def test_contours_refuse_shapes_that_do_not_fit():
    with pytest.raises(InvalidInput, match="shape"):
        plots.contours(np.zeros((3, 4)), np.arange(3.0), np.arange(4.0))


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
