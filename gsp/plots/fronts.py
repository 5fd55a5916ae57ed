"""Pictures of tables: a front among all designs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from gsp.errors import InvalidInput, expected
from gsp.exploration.fronts import knee, merits_of, nondominated
from gsp.exploration.sides import Objectives, better_sides, index_column
from gsp.figures import style
from gsp.geometry.vectors import Array
from gsp.indices.table import ARROWS
from gsp.plots.common.scales import spans_much
from gsp.plots.common.style import GREY, axes_or_new, plain, symbol_text
from gsp.plots.common.tables import check_frame, column

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Places of rows in a table.
Places = NDArray[np.intp]

FRONT_COLOUR, KNEE_COLOUR = "#0072b2", "#d55e00"


def front(table: pd.DataFrame, objectives: Objectives, ax: Axes | None = None) -> Axes:
    """Return axes with two objectives of designs, their Pareto front, and its knee.

    The better end of both is at the top right.

    Parameters
    ----------
    table : pandas.DataFrame
        Such as of `gsp.exploration.explore` or `optimise`.
    objectives : two columns, or mapping from two columns to "higher" or "lower"
        See `gsp.exploration.pareto`.
    ax : matplotlib Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        As `gsp.exploration.pareto`, on more than two objectives, or if no row of the front has
        finite ones.
    MissingSoftware
        Without matplotlib.
    """
    check_frame("table", table)
    sides = better_sides(table, objectives)
    if len(sides) != 2:
        raise InvalidInput(expected("objectives", "two columns", len(sides)))
    kept, place = front_rows(table, objectives)
    ends = [column(table, name) for name in sides]
    there = np.isfinite(ends).all(axis=0)
    with style():
        ax = axes_or_new(ax, 6.4, 4.8)
        infinite = int((~there & ~np.isnan(ends).any(axis=0)).sum())
        label = f"designs ({infinite} with infinite values not drawn)" if infinite else "designs"
        ax.scatter(ends[0][there], ends[1][there], s=12, color=GREY, label=label, zorder=1)
        along = [end[kept] for end in ends]
        ax.plot(*along, "o-", color=FRONT_COLOUR, markersize=4, linewidth=1, label="front")
        ax.plot(
            *(end[place] for end in ends),
            "D",
            color=KNEE_COLOUR,
            markersize=7,
            label="knee",
            zorder=3,
        )
        ax.set_xscale("log" if is_log(ends[0][there]) else "linear")
        ax.set_yscale("log" if is_log(ends[1][there]) else "linear")
        for axis, (name, side) in zip((ax.xaxis, ax.yaxis), sides.items(), strict=True):
            axis.set_inverted(side == "lower")
            axis.set_label_text(f"{label_of(name)} {ARROWS[side]}")
        ax.legend(loc="best", handletextpad=0.3)
        return ax


def front_rows(table: pd.DataFrame, objectives: Objectives) -> tuple[Places, int]:
    """Return the places of the rows of a front, from the worst first objective on, and of its knee.

    Rows with an objective that is not finite have no place in a picture, but those that they beat
    are not on the front.

    Raises
    ------
    InvalidInput
        As `gsp.exploration.pareto`, or if no row of the front has finite objectives.
    """
    merits = merits_of(table, objectives)
    there = np.flatnonzero(~np.isnan(merits).any(axis=1))
    kept = there[nondominated(merits[there])]
    kept = kept[np.isfinite(merits[kept]).all(axis=1)]
    if not kept.size:
        wanted = "a row with finite objectives that no row beats"
        raise InvalidInput(expected("table", wanted, "none"))
    place = knee(table.iloc[kept].reset_index(drop=True), objectives)
    return kept[np.argsort(merits[kept, 0], kind="stable")], int(kept[place])


def is_log(values: Array) -> bool:
    """Return whether finite numbers get a logarithmic axis: all are positive, and span much."""
    return bool(values.size and values.min() > 0.0 and spans_much(values))


def label_of(name: str) -> str:
    """Return the label of a column: "CTN, mean" for control_number_mean, else its words."""
    found = index_column(name)
    return f"{symbol_text(found[0])}, {found[1]}" if found else plain(name.replace("_", " "))
