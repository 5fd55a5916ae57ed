"""Pareto fronts of tables, and help to choose from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, brief, expected
from gsp.exploration.sides import Objectives, better_sides
from gsp.geometry.vectors import Array, Mask

if TYPE_CHECKING:
    import pandas as pd

# Differences of numbers up to this size are finite.
MOST_DIFFERENT = 0.25 * float(np.finfo(np.float64).max)


def nondominated(values: Array) -> Mask:
    """Return which rows (n, m) no other row beats: at least as high in all, higher in one."""
    kept = np.ones(len(values), dtype=bool)
    for i, row in enumerate(values):
        kept[i] = not ((values >= row).all(axis=1) & (values > row).any(axis=1)).any()
    return kept


def pareto(table: pd.DataFrame, objectives: Objectives) -> pd.DataFrame:
    """Return the rows of a table that no other row beats.

    A row beats another one if it is at least as good in all objectives and better in one. Rows with
    a missing objective are left out; of equal rows all stay.

    Parameters
    ----------
    table : pandas.DataFrame
        Such as of `gsp.exploration.explore`.
    objectives : sequence of str, or mapping from str to "higher" or "lower"
        Columns. Of columns of indices such as "control_number_mean", and of score, feasible and
        within_strokes, it is known which side is better; others need a mapping.

    Returns
    -------
    pandas.DataFrame
        Some of the rows, in their order and with their index.

    Raises
    ------
    InvalidInput
        On what is not a table, columns of one name, columns that it does not have or that are no
        numbers, fewer than two objectives, or a column of which the better side is not known.

    Examples
    --------
    >>> import pandas as pd
    >>> table = pd.DataFrame({"cost": [1, 2, 3, 2], "reach": [1.0, 3.0, 3.5, 2.0]})
    >>> pareto(table, {"cost": "lower", "reach": "higher"}).index.tolist()
    [0, 1, 2]
    """
    values = merits_of(table, objectives)
    there = np.flatnonzero(~np.isnan(values).any(axis=1))
    return table.iloc[there[nondominated(values[there])]]


def knee(table: pd.DataFrame, objectives: Objectives) -> Any:
    """Return the label of the row of a front that is farthest above the plane through its ends.

    Objectives are scaled to [0, 1] over the rows, 1 for the best value; the plane is that where
    their sum is 1, through the best rows of the single objectives if each is the worst in the
    others. At a knee a gain in one objective costs much in another one. Rows with a missing or
    infinite objective, such as the condition number of a singular pose, are left out.

    Parameters
    ----------
    table : pandas.DataFrame
        A front, such as `pareto` returns.
    objectives : see `pareto`

    Returns
    -------
    label of the table's index

    Raises
    ------
    InvalidInput
        As `pareto`, and if no row has all objectives as finite numbers.

    Examples
    --------
    >>> import pandas as pd
    >>> front = pd.DataFrame({"x": [0.0, 0.8, 1.0], "y": [1.0, 0.7, 0.0]}, index=["a", "b", "c"])
    >>> knee(front, {"x": "higher", "y": "higher"})
    'b'
    """
    values = _shrunk(merits_of(table, objectives))[0]
    there = np.flatnonzero(np.isfinite(values).all(axis=1))
    heights = ((values[there] - _complete(values).min(axis=0)) / _spans(values)).sum(axis=1)
    return table.index[int(there[heights.argmax()])]


def distances(
    table: pd.DataFrame, objectives: Objectives, wish: Mapping[str, float]
) -> pd.Series[float]:
    """Return how far the rows of a front are from a wish.

    Objectives are scaled by their ranges over the rows where all are finite. The distance is the
    Euclidean norm of what is missing: a value that is better than wished counts as 0, and so does
    an objective whose range is 0, as nothing scales it.

    Parameters
    ----------
    table : pandas.DataFrame
    objectives : see `pareto`
    wish : mapping from objective to number [unit of the column]

    Returns
    -------
    pandas.Series
        One distance ≥ 0 per row [1]; NaN where an objective is missing, inf where one is infinitely
        bad.

    Raises
    ------
    InvalidInput
        As `pareto`, and if the wish has other names than the objectives.

    Examples
    --------
    >>> import pandas as pd
    >>> front = pd.DataFrame({"x": [0.0, 0.8, 1.0], "y": [1.0, 0.7, 0.0]})
    >>> better = {"x": "higher", "y": "higher"}
    >>> distances(front, better, {"x": 0.9, "y": 0.6}).round(3).tolist()
    [0.9, 0.1, 0.6]
    """
    import pandas as pd

    sides = better_sides(table, objectives)
    given = arguments.mapping("wish", wish)
    if set(given) != set(sides):
        wanted = "a number for each of " + ", ".join(sides)
        raise InvalidInput(expected("wish", wanted, brief(wish)))
    values = merits_of(table, objectives)
    target = np.array([
        arguments.number(f"wish[{name!r}]", given[name]) * (1.0 if side == "higher" else -1.0)
        for name, side in sides.items()
    ])  # fmt: skip
    values, target = _shrunk(values, target)
    spans = np.ptp(_complete(values), axis=0)
    with np.errstate(over="ignore"):  # inf: farther than all numbers
        missing = np.maximum(target - values, 0.0) / _spans(values)
        missing[:, spans == 0.0] = np.where(np.isfinite(missing), 0.0, missing)[:, spans == 0.0]
        found = np.sqrt((missing**2).sum(axis=1))
    return pd.Series(found, index=table.index, name="distance")


def losses(table: pd.DataFrame, objectives: Objectives) -> pd.DataFrame:
    """Return what each step along a front gains and loses.

    Rows are sorted from the best to the worst value of the first objective; a step goes from a row
    to the next one. Rows with a missing objective are left out. A change from or to an infinite
    value is infinite, and NaN between two that are equal.

    Parameters
    ----------
    table : pandas.DataFrame
        A front, such as `pareto` returns.
    objectives : see `pareto`

    Returns
    -------
    pandas.DataFrame
        One row per step with the columns "from" and "to" (labels of the table), and per objective
        the change, positive where it becomes better [unit of the column].

    Raises
    ------
    InvalidInput
        As `pareto`.

    Examples
    --------
    >>> import pandas as pd
    >>> front = pd.DataFrame({"x": [0.0, 0.8, 1.0], "y": [1.0, 0.7, 0.0]})
    >>> losses(front, {"x": "higher", "y": "higher"}).round(3).to_dict("list")
    {'from': [2, 1], 'to': [1, 0], 'x': [-0.2, -0.8], 'y': [0.7, 0.3]}
    """
    import pandas as pd

    sides, values = better_sides(table, objectives), merits_of(table, objectives)
    there = np.flatnonzero(~np.isnan(values).any(axis=1))
    places = there[np.argsort(-values[there, 0], kind="stable")]
    labels = table.index[places]
    steps = pd.DataFrame({"from": labels[:-1], "to": labels[1:]})
    with np.errstate(invalid="ignore", over="ignore"):  # inf − inf, and steps beyond all numbers
        changes = np.diff(values[places], axis=0).T
    for name, change in zip(sides, changes, strict=True):
        steps[name] = change
    return steps


def merits_of(table: pd.DataFrame, objectives: Objectives) -> Array:
    """Return the objectives (n, m) as numbers of which higher is better."""
    columns = []
    for name, side in better_sides(table, objectives).items():
        try:
            numbers = table[name].to_numpy(dtype=np.float64, na_value=np.nan)
        except (TypeError, ValueError) as error:
            raise InvalidInput(expected(f"column {name}", "numbers", brief(table[name]))) from error
        columns.append(numbers if side == "higher" else -numbers)
    return np.stack(columns, axis=1)


def _complete(values: Array) -> Array:
    """Return the rows of finite numbers; ranges of objectives are those of these rows."""
    rows = values[np.isfinite(values).all(axis=1)]
    if not len(rows):
        raise InvalidInput(expected("table", "a row with all objectives", "none"))
    return rows


def _shrunk(values: Array, other: Array | float = 0.0) -> tuple[Array, Array]:
    """Return columns divided by powers of two, so that differences of finite numbers are finite.

    Columns of ordinary numbers are left as they are.

    Parameters
    ----------
    values : (n, m) array
    other : (m,) array
        Divided by the same powers.
    """
    sizes = np.where(np.isfinite(values), np.abs(values), 0.0).max(axis=0, initial=0.0)
    powers = np.where(np.maximum(sizes, np.abs(other)) > MOST_DIFFERENT, 0.25, 1.0)
    return values * powers, other * powers


def _spans(values: Array) -> Array:
    span = np.ptp(_complete(values), axis=0)
    return np.where(span > 0.0, span, 1.0)
