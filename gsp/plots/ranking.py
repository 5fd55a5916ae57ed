"""Indices of a ranking against each other, classes by colour."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from gsp import arguments
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.plots.common.style import (
    CLASSES,
    GREY,
    INK,
    VERMILION,
    axes_or_new,
    design_label,
    new_axes,
    style,
    symbol_text,
)
from gsp.plots.common.tables import check_frame, chosen_indices, column, index_label
from gsp.plots.distributions import draw_distributions

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

# Values that span more than this ratio are drawn on a logarithmic axis.
WIDE = 30.0
# Values that the axis cannot show (inf, or 0 on a logarithmic axis) are drawn this share outside.
BEYOND = 0.08
# Up to so many designs their distributions are drawn: a correlation of so few has no meaning.
FEW = 8
# More indices than this are too many for one picture.
MOST = 6
# Inches: side of a panel, margin around the panels, and height above them.
CELL, MARGIN, HEAD = 1.75, 0.5, 0.7


def ranking(table: pd.DataFrame, indices: Iterable[str] | str | None = None) -> Figure:
    """Return a new figure of a ranking.

    For up to eight designs it has one panel per index: how the index is distributed over the poses
    for each design. For more it shows the mean indices against each other: below the diagonal one
    panel per pair, with the better end of both indices at the top and on the right; above it
    Spearman's rank correlation, 1 for equal rank orders. One index is drawn against its rank.

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
        if len(table) <= FEW:
            return draw_distributions(table, names)
        if all(np.isnan(_values(table, name)).all() for name in names):
            wanted, got = "a defined mean", f"none of {', '.join(names)}"
            raise InvalidInput(expected("table", wanted, got))
        if len(names) < 3:
            x = names[0] if len(names) == 2 else "rank"
            axes = new_axes()
            _single(axes, table, x, names[-1])
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
        _single(ax, table, x, y)
        ax.legend(handles=_marks(table), loc="best", handletextpad=0.3)
        return ax


def _single(ax: Axes, table: pd.DataFrame, x: str, y: str) -> None:
    _panel(ax, table, x, y)
    ax.set_xlabel(_label(table, x))
    ax.set_ylabel(_label(table, y))


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
    units = table.attrs.get("units", {})
    several = len(table) > 1
    kept = [
        name
        for name in names
        if not several or ("," not in units.get(name, "") and units.get(name) != "mixed")
    ]
    return kept or names


def first_names(names: list[str], by: str | None) -> list[str]:
    """Return the first names of many, with `by` in place of the last if it is not among them."""
    few = names[:MOST]
    return [*few[:-1], by] if by in names[MOST:] else few


def _matrix(table: pd.DataFrame, names: list[str]) -> Figure:
    import matplotlib.pyplot as plt

    from gsp.plots.common.figures import ShownOnce

    n = len(names)
    width, height = CELL * n + 2 * MARGIN, CELL * n + MARGIN + HEAD
    figure, grid = plt.subplots(n, n, figsize=(width, height), FigureClass=ShownOnce)
    figure.subplots_adjust(
        left=MARGIN / width,
        right=1 - MARGIN / width,
        bottom=MARGIN / height,
        top=1 - HEAD / height,
        wspace=0.08,
        hspace=0.08,
    )
    for i, row in enumerate(names):
        for j, other in enumerate(names):
            ax = grid[i, j]
            if i > j:
                _panel(ax, table, other, row)
                ax.tick_params(labelleft=j == 0, labelbottom=i == n - 1)
            elif i == j:
                _name(ax, table, row)
            else:
                _correlation(ax, _goodness(table, row), _goodness(table, other))
    return figure


def _panel(ax: Axes, table: pd.DataFrame, x: str, y: str) -> None:
    (across, wide), (up, tall) = (_positions(table, name) for name in (x, y))
    ax.set_xscale("log" if wide else "linear")
    ax.set_yscale("log" if tall else "linear")
    for group, (colour, marker) in CLASSES.items():
        mine = (table["class"] == group).to_numpy()
        ax.scatter(
            across[mine], up[mine], s=14, marker=marker, color=colour, alpha=0.75, linewidths=0
        )
    best = _best(table)
    others = ~table["class"].isin(list(CLASSES)).to_numpy()
    ax.scatter(across[others], up[others], s=14, marker="o", color=GREY, linewidths=0)
    ax.scatter(
        across[best],
        up[best],
        s=90,
        marker="*",
        color=VERMILION,
        edgecolor="white",
        linewidths=0.6,
        zorder=3,
    )
    _ticks(ax, wide, tall)
    if _lower(x):
        ax.invert_xaxis()
    if _lower(y):
        ax.invert_yaxis()


def _ticks(ax: Axes, wide: bool, tall: bool) -> None:
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

    for axis, log in ((ax.xaxis, wide), (ax.yaxis, tall)):
        axis.set_major_locator(LogLocator(numticks=4) if log else MaxNLocator(3))
        if log:
            axis.set_minor_formatter(NullFormatter())
    ax.grid(True, which="major")
    ax.set_axisbelow(True)
    ax.tick_params(which="both", length=0, labelsize=8)
    ax.spines[["top", "right"]].set_visible(False)


def _positions(table: pd.DataFrame, name: str) -> tuple[Array, bool]:
    """Positions of the designs on the axis of an index, and whether it is logarithmic."""
    values = _values(table, name)
    positive = values[np.isfinite(values) & (values > 0.0)]
    log = name != "rank" and positive.size > 1 and positive.max() > WIDE * positive.min()
    shown = np.isfinite(values) & ((values > 0.0) | (not log))
    if not shown.any():
        return np.where(np.isnan(values), np.nan, 0.0), False
    scaled = np.log(values[shown]) if log else values[shown]
    margin = BEYOND * (np.ptp(scaled) or 1.0)
    edge = scaled.max() + margin if _lower(name) else scaled.min() - margin
    beyond = float(np.exp(edge) if log else edge)
    return np.where(shown | np.isnan(values), values, beyond), log


def _correlation(ax: Axes, x: Array, y: Array) -> None:
    import matplotlib as mpl
    from scipy.stats import spearmanr

    ax.set_axis_off()
    both = ~np.isnan(x) & ~np.isnan(y)
    if np.unique(x[both]).size < 2 or np.unique(y[both]).size < 2:
        return
    rho = float(spearmanr(x[both], y[both]).statistic)
    colour = mpl.colormaps["RdBu"](0.5 + 0.2 * rho)
    ax.scatter(0.5, 0.5, s=4000 * abs(rho), color=colour, linewidths=0, transform=ax.transAxes)
    ax.text(
        0.5,
        0.5,
        f"{rho:.2f}".replace("-", "−"),
        transform=ax.transAxes,
        ha="center",
        va="center",
        color=INK,
    )


def _name(ax: Axes, table: pd.DataFrame, name: str) -> None:
    ax.set_axis_off()
    index = INDICES[name]
    ax.text(
        0.5,
        0.58,
        index_label(table, name),
        transform=ax.transAxes,
        ha="center",
        va="center",
        fontsize=15,
        fontweight="bold",
        color=INK,
    )
    ax.text(
        0.5,
        0.34,
        f"{index.better} is better",
        transform=ax.transAxes,
        ha="center",
        va="center",
        fontsize=8,
        color=GREY,
    )


def _marks(table: pd.DataFrame) -> list[Line2D]:
    """Entries of the legend: the classes that are there, and the design that ranks first."""
    from matplotlib.lines import Line2D

    def mark(marker: str, colour: str, size: float, label: str) -> Line2D:
        return Line2D(
            [], [], linestyle="", marker=marker, color=colour, markersize=size, label=label
        )

    there = set(table["class"])
    marks = [mark(m, colour, 6, g) for g, (colour, m) in CLASSES.items() if g in there]
    if there - set(CLASSES):
        marks.append(mark("o", GREY, 6, "other"))
    by = str(table.attrs.get("by"))
    symbol = symbol_text(by) if by in INDICES else "rank"
    label = design_label(str(table["design"].iloc[_best(table)]))
    return [*marks, mark("*", VERMILION, 11, f"first by {symbol}: {label}")]


def _best(table: pd.DataFrame) -> int:
    return int(table["rank"].to_numpy().argmin())


def _head(figure: Any, table: pd.DataFrame, *, matrix: bool) -> None:
    """Put title and legend above the panels."""
    marks, poses = _marks(table), table.attrs.get("poses")
    number = f"{poses:,} poses" if isinstance(poses, int) else "the poses"
    figure.legend(
        handles=marks,
        loc="upper center" if matrix else "outside upper center",
        ncols=len(marks),
        fontsize=10,
        handletextpad=0.3,
        columnspacing=1.4,
        title=f"{len(table)} designs, mean over {number}; better is up and to the right",
        title_fontproperties={"size": 12, "weight": "bold"},
    )


def _values(table: pd.DataFrame, name: str) -> Array:
    return column(table, "rank" if name == "rank" else f"{name}_mean")


def _lower(name: str) -> bool:
    return name == "rank" or INDICES[name].better == "lower"


def _goodness(table: pd.DataFrame, name: str) -> Array:
    values = _values(table, name)
    return -values if _lower(name) else values


def _label(table: pd.DataFrame, name: str) -> str:
    if name == "rank":
        return "rank"
    return f"{index_label(table, name)} ({INDICES[name].better} is better)"
