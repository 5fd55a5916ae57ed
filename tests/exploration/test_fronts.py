"""Pareto fronts: against all pairs of rows; knees, distances and losses of known fronts."""

import numpy as np
import pandas as pd
import pytest

from gsp.errors import InvalidInput
from gsp.exploration import distances, knee, losses, pareto

SIDES = {"cost": "lower", "reach": "higher", "speed": "higher"}

BETTER = {"x": "higher", "y": "higher"}


def beats(one, other):
    better = [one["cost"] <= other["cost"], one["reach"] >= other["reach"],
              one["speed"] >= other["speed"]]  # fmt: skip
    return all(better) and any(one[name] != other[name] for name in SIDES)


def test_a_front_is_what_no_pair_excludes():
    numbers = np.random.default_rng(4).integers(0, 6, (80, 3)).astype(float)
    table = pd.DataFrame(numbers, columns=list(SIDES), index=range(100, 180))
    table.loc[110, "reach"] = np.nan
    rows = table.dropna()
    others = [row for _, row in rows.iterrows()]
    wanted = [i for i, row in rows.iterrows() if not any(beats(other, row) for other in others)]
    found = pareto(table, SIDES)
    assert found.index.tolist() == wanted
    assert 1 < len(wanted) < 60
    pd.testing.assert_frame_equal(found, table.loc[wanted])


def test_columns_of_indices_know_their_better_side():
    table = pd.DataFrame({
        "control_number_mean": [0.2, 0.3, 0.1], "condition_number_max": [4.0, 5.0, 6.0],
        "score": [1.0, 0.5, 0.2],
    })  # fmt: skip
    assert pareto(table, ["control_number_mean", "condition_number_max"]).index.tolist() == [0, 1]
    assert pareto(table, ["condition_number_max", "score"]).index.tolist() == [0]


def test_equal_and_infinite_rows():
    table = pd.DataFrame({"a": [1.0, 1.0, np.inf], "b": [2.0, 2.0, 0.0]})
    assert pareto(table, {"a": "higher", "b": "higher"}).index.tolist() == [0, 1, 2]


def test_the_knee_of_a_circle_is_at_45_degrees():
    angle = np.linspace(0.0, np.pi / 2, 91)
    table = pd.DataFrame({"x": 7.0 * np.cos(angle), "y": -3.0 * np.sin(angle)})
    assert knee(table, {"x": "higher", "y": "lower"}) == 45


def test_the_knee_is_among_finite_rows():
    """Singular poses give infinite worst values, which once moved the origin of the scale."""
    angle = np.linspace(0.0, np.pi / 2, 91)
    table = pd.DataFrame({"x": np.cos(angle), "condition_number_max": -np.sin(angle)})
    better = {"x": "higher", "condition_number_max": "lower"}
    rows = {"x": [1e3, 1.1, np.inf], "condition_number_max": [np.inf, np.nan, -0.5]}
    longer = pd.concat([pd.DataFrame(rows, index=["a", "b", "c"]), table])
    assert knee(longer, better) == knee(table, better) == 45


def test_distances_count_what_is_missing():
    table = pd.DataFrame({"x": [0.0, 5.0, 10.0], "y": [2.0, 1.5, 0.0]}, index=list("abc"))
    found = distances(table, {"x": "higher", "y": "lower"}, {"x": 5.0, "y": 1.0})
    np.testing.assert_allclose(found, [np.hypot(0.5, 0.5), 0.25, 0.0])
    assert found.index.tolist() == list("abc")


def test_losses_are_signed_by_what_is_better():
    table = pd.DataFrame({"x": [3.0, 1.0, 2.0], "y": [9.0, 1.0, 4.0]})
    steps = losses(table, {"x": "higher", "y": "lower"})
    assert steps.to_dict("list") == {
        "from": [0, 2], "to": [2, 1], "x": [-1.0, -1.0], "y": [5.0, 3.0],
    }  # fmt: skip


def test_losses_with_infinite_and_missing_values():
    """Warnings are errors in all tests."""
    rows = {"x": [np.inf, np.inf, 1.0, np.nan, -1.5e308], "y": [1.0, 2.0, -np.inf, 0.0, 1.5e308]}
    steps = losses(pd.DataFrame(rows), BETTER)
    assert steps[["from", "to"]].to_numpy().tolist() == [[0, 1], [1, 2], [2, 4]]
    assert steps["x"].fillna(7.0).tolist() == [7.0, -np.inf, -1.5e308]
    assert steps["y"].tolist() == [1.0, -np.inf, np.inf]


def test_knee_and_distances_of_the_greatest_numbers():
    """Those of a table divided by a power of two."""
    front = pd.DataFrame({"x": [-1.0, 0.6, 1.0], "y": [1.0, 0.5, -1.0]})
    large = front * 2.0**1023
    assert knee(large, BETTER) == knee(front, BETTER) == 1
    wish = {"x": 0.0, "y": 0.0}
    np.testing.assert_array_equal(distances(large, BETTER, wish), distances(front, BETTER, wish))
    small = front * 2.0**-1000
    assert np.isinf(distances(small, BETTER, {"x": 1e100, "y": 0.0})).all()


def test_an_objective_without_a_range_has_no_distance():
    table = pd.DataFrame({"x": [0.0, 0.5, 1.0, 1.0], "y": [3.0, 3.0, 3.0, np.nan]})
    found = distances(table, BETTER, {"x": 1.0, "y": 1000.0})
    assert found.fillna(9.0).tolist() == [1.0, 0.5, 0.0, 9.0]
    table.loc[3, "y"] = -np.inf
    assert distances(table, BETTER, {"x": 1.0, "y": 1000.0})[3] == np.inf


@pytest.mark.parametrize(
    ("objectives", "message"),
    [
        (["score"], "at least two columns"),
        (["score", "mass"], "columns of the table"),
        (["score", "price"], '"higher" or "lower"'),
        ({"score": "higher", "price": "cheap"}, '"higher" or "lower"'),
        ({"score": "higher", "design": "lower"}, "column design: expected numbers"),
        (3, "objectives: expected"),
    ],
)
def test_bad_objectives(objectives, message):
    table = pd.DataFrame({"score": [1.0], "price": [2.0], "design": ["a"]})
    with pytest.raises(InvalidInput, match=message):
        pareto(table, objectives)


def test_bad_tables_and_wishes():
    with pytest.raises(InvalidInput, match=r"table: expected a pandas\.DataFrame"):
        pareto([1, 2], ["score", "feasible"])
    empty = pd.DataFrame({"x": [np.nan], "y": [1.0]})
    with pytest.raises(InvalidInput, match="a row with all objectives"):
        knee(empty, {"x": "higher", "y": "higher"})
    with pytest.raises(InvalidInput, match="wish: expected a number for each of x, y"):
        distances(empty, {"x": "higher", "y": "higher"}, {"x": 1.0})
