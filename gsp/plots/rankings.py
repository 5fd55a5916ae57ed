"""Indices of a ranking against each other, classes by colour."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from gsp import arguments
from gsp.errors import InvalidInput, brief, expected
from gsp.figures import new_axes, style
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.plots.common.style import CLASSES, GREY, axes_or_new
from gsp.plots.common.tables import check_frame, chosen_indices, column, driven
from gsp.plots.distributions import draw_distributions
from gsp.plots.panels import (
    correlation,
    goodness,
    index_name_panel,
    labelled_panel,
    mark_beyond,
    marks,
    mean_label,
    panel,
    places,
    values_of,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PathCollection
    from matplotlib.figure import Figure

# Up to so many designs their distributions are drawn: a correlation of so few has no meaning.
FEW_DESIGNS = 8
# More indices than this are too many for one picture.
MOST_INDICES = 6
# Inches: side of a panel, margin around the panels, and height above them.
RANKING_PANEL_SIDE, PANELS_MARGIN, PANELS_HEAD = 1.75, 0.5, 0.7


def ranking(table: pd.DataFrame, indices: Iterable[str] | str | None = None) -> Figure:
    """Return a new figure of a ranking.

    For up to eight designs it has one panel per index: how the index is distributed over the poses
    for each design. For more it shows the mean indices against each other: below the diagonal one
    panel per pair, with the better end of both indices at the top and on the right; above it
    Spearman's rank correlation, 1 for equal rank orders. One index is drawn against its rank. Marks
    of designs with drives at the base are hollow.

    Parameters
    ----------
    table : pandas.DataFrame
        As `gsp.rank` returns it.
    indices : str, iterable of str or None
        Names or symbols, default the first six in the table, the one that it is ranked by among
        them. Those whose unit differs between the designs are left out unless they are named:
        |det J| of mechanisms with different numbers of angular actuators cannot be compared.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InvalidInput
        If the table is not a ranking, does not hold the named indices, or no mean is defined.
    MissingSoftware
        Without matplotlib.
    """
    names = _names(table, indices)
    with style():
        if len(table) <= FEW_DESIGNS:
            return draw_distributions(table, names)
        if all(np.isnan(values_of(table, name)).all() for name in names):
            wanted, got = "a defined mean", f"none of {', '.join(names)}"
            raise InvalidInput(expected("table", wanted, got))
        if len(names) < 3:
            x = names[0] if len(names) == 2 else "rank"
            axes = new_axes()
            labelled_panel(axes, table, x, names[-1])
            figure = axes.get_figure()
        else:
            figure = _matrix(table, names)
            note = "circles: Spearman's rank correlation of two indices, 1 for equal rank orders"
            figure.text(0.5, 0.0, note, ha="center", va="bottom", fontsize=8, color=GREY)
        _head(figure, table, matrix=len(names) > 2)
    return figure  # type: ignore[return-value]


@arguments.validated(x=arguments.text, y=arguments.text)
def against(table: pd.DataFrame, x: str, y: str, ax: Axes | None = None) -> Axes:
    """Return axes with the mean of one index of a ranking drawn against that of another.

    The better end of both is at the top right.

    Parameters
    ----------
    table : pandas.DataFrame
        As `gsp.rank` returns it.
    x, y : str
        Names or symbols of indices; "rank" works as well.
    ax : matplotlib Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the table is not a ranking, or holds no such index.
    MissingSoftware
        Without matplotlib.
    """
    _names(table, None)
    x, y = (name if name == "rank" else _one(table, name) for name in (x, y))
    with style():
        ax = axes_or_new(ax, 6.4, 4.8)
        labelled_panel(ax, table, x, y, alone=True)
        ax.legend(handles=marks(table), loc="best", handletextpad=0.3)
        return ax


def ranges(table: pd.DataFrame, index: str | None = None, ax: Axes | None = None) -> Axes:
    """Return axes with the means of an index for all designs of each mechanism, the best first.

    A line leads from the best to the worst design of the mechanism, such as of all its placements,
    and a mark is at the best one. The better end is at the top.

    Parameters
    ----------
    table : pandas.DataFrame
        As `gsp.rank` returns it.
    index : str or None
        Name or symbol of an index; default the one that the table is ranked by.
    ax : matplotlib Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the table is not a ranking with the column "mechanism", or holds no such index or no
        defined mean of it.
    MissingSoftware
        Without matplotlib.
    """
    given = table.attrs.get("by") if index is None and isinstance(table, pd.DataFrame) else index
    name = _names(table, None)[0] if given is None else _one(table, given)
    there = places(table, name)
    if "mechanism" not in table or np.isnan(there.values).all():
        wanted = f"a ranking with the column 'mechanism' and a defined mean of {name}"
        raise InvalidInput(expected("table", wanted, "none"))
    with style():
        ax = axes_or_new(ax, 9.0, 4.2)
        ax.set_yscale("log" if there.log else "linear")
        handles = _draw_ranges(ax, table, there.values, lower=INDICES[name].better == "lower")
        mark_beyond(ax, ax.yaxis, there)
        ax.set_ylabel(mean_label(table, name))
        ax.set_xlabel("mechanisms, by their best design")
        ax.set_xlim(0.0, ax.get_xlim()[1])
        ax.legend(handles=handles, loc="best", handletextpad=0.3)
        return ax


def _draw_ranges(
    ax: Axes, table: pd.DataFrame, values: Array, *, lower: bool
) -> list[PathCollection]:
    """Draw a line and a mark for each mechanism, and return a mark of each class."""
    frame = pd.DataFrame(
        {"mechanism": table["mechanism"], "class": table["class"], "value": values}
    ).assign(driven=driven(table))
    groups = frame.dropna(subset=["value"]).groupby(["mechanism", "driven"], sort=False)
    ends = groups.agg(group=("class", "first"), low=("value", "min"), high=("value", "max"))
    best, worst = ("low", "high") if lower else ("high", "low")
    ends = ends.sort_values([best, worst], ascending=lower, kind="stable")
    place = np.arange(1, len(ends) + 1)
    handles = []
    for group in dict.fromkeys(ends["group"]):
        colour, marker = CLASSES.get(str(group), (GREY, "o"))
        mine = (ends["group"] == group).to_numpy()
        low, high = ends["low"][mine], ends["high"][mine]
        ax.vlines(place[mine], low, high, color=colour, linewidth=1.2, alpha=0.6)
        ends_there = ends[best][mine]
        label = f"{group}, best"
        handles.append(
            ax.scatter(place[mine], ends_there, s=12, color=colour, marker=marker, label=label)
        )
    if lower:
        ax.invert_yaxis()
    return handles


def _one(table: pd.DataFrame, text: str) -> str:
    found = _names(table, text)
    if len(found) != 1:
        raise InvalidInput(expected("x, y", "the name of one index each", brief(text)))
    return found[0]


def _names(table: pd.DataFrame, indices: Iterable[str] | str | None) -> list[str]:
    """Return the indices to draw, after a check that the table is a ranking with them."""
    check_frame("table", table)
    there = [name for name in INDICES if f"{name}_mean" in table]
    missing = [key for key in ("rank", "design", "class") if key not in table]
    if missing or not there:
        wanted, got = "a ranking, as gsp.rank returns it", f"no column {(missing or ['*_mean'])[0]}"
        raise InvalidInput(expected("table", wanted, got))
    if indices is None:
        chosen = first_names(_comparable(table, there), table.attrs.get("by"))
    else:
        chosen = chosen_indices(indices, there)
    for key in ("rank", *(f"{name}_mean" for name in chosen)):
        column(table, key)
    return chosen


def _comparable(table: pd.DataFrame, names: list[str]) -> list[str]:
    """Return the indices that have one unit for all designs; all of them if there is none."""
    units = arguments.attribute(table, "units", arguments.mapping, {})
    several = len(table) > 1
    kept = [
        name
        for name in names
        if not several or ("," not in str(units.get(name, "")) and units.get(name) != "mixed")
    ]
    return kept or names


def first_names(names: list[str], by: str | None) -> list[str]:
    """Return the first names of many, with `by` in place of the last if it is not among them."""
    few = names[:MOST_INDICES]
    return [*few[:-1], by] if by in names[MOST_INDICES:] else few


def _matrix(table: pd.DataFrame, names: list[str]) -> Figure:
    import matplotlib.pyplot as plt

    from gsp.figures.shown import ShownOnce

    n = len(names)
    width, height = (
        RANKING_PANEL_SIDE * n + 2 * PANELS_MARGIN,
        RANKING_PANEL_SIDE * n + PANELS_MARGIN + PANELS_HEAD,
    )
    figure, grid = plt.subplots(n, n, figsize=(width, height), FigureClass=ShownOnce)
    figure.subplots_adjust(
        left=PANELS_MARGIN / width,
        right=1 - PANELS_MARGIN / width,
        bottom=PANELS_MARGIN / height,
        top=1 - PANELS_HEAD / height,
        wspace=0.08,
        hspace=0.08,
    )
    for i, row in enumerate(names):
        for j, other in enumerate(names):
            ax = grid[i, j]
            if i > j:
                panel(ax, table, other, row)
                ax.tick_params(labelleft=j == 0, labelbottom=i == n - 1)
            elif i == j:
                index_name_panel(ax, table, row)
            else:
                correlation(ax, goodness(table, row), goodness(table, other))
    return figure


def _head(figure: Any, table: pd.DataFrame, *, matrix: bool) -> None:
    """Put title and legend above the panels."""
    handles, poses = marks(table), table.attrs.get("poses")
    number = f"{poses:,} poses" if isinstance(poses, int) else "the poses"
    figure.legend(
        handles=handles,
        loc="upper center" if matrix else "outside upper center",
        ncols=len(handles),
        fontsize=10,
        handletextpad=0.3,
        columnspacing=1.4,
        title=f"{len(table)} designs, mean over {number}; better is up and to the right",
        title_fontproperties={"size": 12, "weight": "bold"},
    )
