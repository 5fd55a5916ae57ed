"""Panels of a ranking: one index against another, a correlation, the name of an index, marks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd

from gsp.figures import INK
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.plots.common.scales import spans_much
from gsp.plots.common.style import CLASSES, GREY, VERMILION, design_label, log_ticks, symbol_text
from gsp.plots.common.tables import column, driven, index_label

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.lines import Line2D

# Values that the axis cannot show (inf, or 0 on a logarithmic axis) are drawn this share outside.
OUTSIDE_SHARE = 0.08


def labelled_panel(ax: Axes, table: pd.DataFrame, x: str, y: str, *, alone: bool = False) -> None:
    """Draw a panel with the names of both indices on its axes, which have more numbers if alone."""
    panel(ax, table, x, y, alone=alone)
    ax.set_xlabel(mean_label(table, x))
    ax.set_ylabel(mean_label(table, y))


class Places(NamedTuple):
    """Where designs are on the axis of an index.

    Attributes
    ----------
    values : (n,) array [of the index]
        NaN where the index is undefined.
    log : bool
        Whether the axis is logarithmic.
    beyond : float [of the index]
        Where values are drawn that the axis cannot show; NaN if there are none.
    name : str
        What these values are: "∞" or "0".
    """

    values: Array
    log: bool
    beyond: float
    name: str


def panel(ax: Axes, table: pd.DataFrame, x: str, y: str, *, alone: bool = False) -> None:
    """Draw the mean of one index against that of another, the better end at the top right.

    Infinite means, and 0 on a logarithmic axis, are on a dotted line beyond the others.
    """
    across, up = (places(table, name) for name in (x, y))
    ax.set_xscale("log" if across.log else "linear")
    ax.set_yscale("log" if up.log else "linear")
    hollow = driven(table)
    for group, (colour, marker) in CLASSES.items():
        mine = (table["class"] == group).to_numpy()
        filled, rings = mine & ~hollow, mine & hollow
        _dots(ax, across.values[filled], up.values[filled], marker, colour, alpha=0.75)
        if rings.any():
            edges: dict[str, Any] = {"facecolors": "none", "edgecolors": colour, "zorder": 2}
            ax.scatter(across.values[rings], up.values[rings], s=16, marker=marker, **edges)
    others = ~table["class"].isin(list(CLASSES)).to_numpy()
    _dots(ax, across.values[others], up.values[others], "o", GREY)
    best = _best(table)
    star: dict[str, Any] = {
        "s": 90,
        "marker": "*",
        "color": VERMILION,
        "edgecolor": "white",
        "zorder": 3,
    }
    ax.scatter(across.values[best], up.values[best], linewidths=0.6, **star)
    for axis, there, name in ((ax.xaxis, across, x), (ax.yaxis, up, y)):
        _set_ticks(axis, there.log, alone=alone, integer=name == "rank")
        mark_beyond(ax, axis, there)
    ax.grid(True, which="major")
    ax.set_axisbelow(True)
    ax.tick_params(which="both", length=0, labelsize=8)
    ax.spines[["top", "right"]].set_visible(False)
    if _lower(x):
        ax.invert_xaxis()
    if _lower(y):
        ax.invert_yaxis()


def _dots(
    ax: Axes, x: Array, y: Array, marker: str, colour: str, alpha: float | None = None
) -> None:
    ax.scatter(x, y, s=14, marker=marker, color=colour, alpha=alpha, linewidths=0)


def mark_beyond(ax: Axes, axis: Axis, places: Places) -> None:
    """Draw a line through the values that the axis cannot show, with their name."""
    if np.isnan(places.beyond):
        return
    flat = axis is ax.xaxis
    line = ax.axvline if flat else ax.axhline
    line(places.beyond, color=GREY, linestyle=":", linewidth=0.8, zorder=0)
    where = (places.beyond, 1.01) if flat else (1.01, places.beyond)
    ax.text(
        *where,
        places.name,
        transform=ax.get_xaxis_transform() if flat else ax.get_yaxis_transform(),
        ha="center" if flat else "left",
        va="bottom" if flat else "center",
        color=GREY,
        fontsize=9,
    )
    if not (np.isfinite(places.values) & (places.values != places.beyond)).any():
        axis.set_ticks([])


def _set_ticks(axis: Axis, log: bool, *, alone: bool, integer: bool) -> None:
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

    if log and alone:
        low, high = sorted(axis.get_view_interval())
        log_ticks(axis, low, high)
    elif log:
        axis.set_major_locator(LogLocator(numticks=4))
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_locator(MaxNLocator(6 if alone else 3, integer=integer))


def places(table: pd.DataFrame, name: str) -> Places:
    """Return the places of the designs on the axis of an index."""
    values = values_of(table, name)
    log = name != "rank" and spans_much(values[np.isfinite(values) & (values > 0.0)])
    shown = np.isfinite(values) & ((values > 0.0) | (not log))
    hidden = ~shown & ~np.isnan(values)
    if not hidden.any():
        return Places(values, log, np.nan, "")
    label = "∞" if np.isinf(values[hidden]).any() else "0"
    if not shown.any():
        return Places(np.where(hidden, 0.0, np.nan), False, 0.0, label)
    scaled = np.log(values[shown]) if log else values[shown]
    margin = OUTSIDE_SHARE * (np.ptp(scaled) or 1.0)
    edge = scaled.max() + margin if _lower(name) else scaled.min() - margin
    beyond = float(np.exp(edge) if log else edge)
    return Places(np.where(hidden, beyond, values), log, beyond, label)


def correlation(ax: Axes, x: Array, y: Array) -> None:
    """Draw Spearman's rank correlation as a circle with its number."""
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


def index_name_panel(ax: Axes, table: pd.DataFrame, name: str) -> None:
    """Write the name of an index, and which end of it is better."""
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


def marks(table: pd.DataFrame) -> list[Line2D]:
    """Entries of the legend: classes, hollow marks for drives, and the design that ranks first."""
    from matplotlib.lines import Line2D

    def mark(marker: str, colour: str, size: float, label: str, fill: str = "full") -> Line2D:
        how: Any = {"linestyle": "", "marker": marker, "color": colour, "fillstyle": fill}
        return Line2D([], [], markersize=size, label=label, **how)

    there = set(table["class"])
    found = [mark(m, colour, 6, g) for g, (colour, m) in CLASSES.items() if g in there]
    if there - set(CLASSES):
        found.append(mark("o", GREY, 6, "other"))
    if driven(table).any():
        found.append(mark("o", INK, 6, "drives", "none"))
    by = str(table.attrs.get("by"))
    symbol = symbol_text(by) if by in INDICES else "rank"
    label = design_label(str(table["design"].iloc[_best(table)]))
    return [*found, mark("*", VERMILION, 11, f"first by {symbol}: {label}")]


def _best(table: pd.DataFrame) -> int:
    # Designs without a score have no rank.
    return int(np.nan_to_num(column(table, "rank"), nan=np.inf).argmin())


def values_of(table: pd.DataFrame, name: str) -> Array:
    """Return the means of an index, or the ranks."""
    return column(table, "rank" if name == "rank" else f"{name}_mean")


def _lower(name: str) -> bool:
    return name == "rank" or INDICES[name].better == "lower"


def goodness(table: pd.DataFrame, name: str) -> Array:
    """Return the means of an index with the sign that makes greater ones better."""
    values = values_of(table, name)
    return -values if _lower(name) else values


def mean_label(table: pd.DataFrame, name: str) -> str:
    """Return the name of an index, or "rank", for an axis, and which end of it is better."""
    if name == "rank":
        return "rank"
    return f"{index_label(table, name)} ({INDICES[name].better} is better)"
