"""Distributions of the indices of a few designs over the poses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from gsp.figures import INK
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.plots.common.scales import Scale, scale_of, unbounded
from gsp.plots.common.style import CLASSES, GREY, design_label, log_ticks, new_panels, plain
from gsp.plots.common.tables import column, driven, index_label

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Columns of a ranking that are drawn, from left to right.
DRAWN = ("min", "q05", "median", "q95", "max")
# Extremes farther than this factor from all quantiles are beyond the axis.
FAR_FACTOR = 100.0
# Inches: width of a panel, height of a design in it, and height of axes and title.
PANEL_WIDTH, DESIGN_HEIGHT, AXES_HEIGHT = 4.2, 0.34, 1.0
# Intervals between the ticks of an axis that is not logarithmic: labels such as 0.0025 fit.
LINEAR_TICKS = 4
# Letters in a line of the name of a design.
NAME_LETTERS = 26


def draw_distributions(table: pd.DataFrame, names: Sequence[str]) -> Figure:
    """Return a figure with a panel per index: its distribution for each design.

    From the least to the greatest value a thin line, from the 5 % to the 95 % quantile a thick
    one; a dot is the median, a cross the mean. An index without a bound has a logarithmic axis;
    infinite values lie outside the axes.
    """
    height = AXES_HEIGHT + DESIGN_HEIGHT * len(table)
    figure, panels = new_panels(len(names), PANEL_WIDTH, height, columns=3)
    columns = 2 if len(names) == 4 else 3
    for i, (ax, name) in enumerate(zip(panels, names, strict=True)):
        _panel(ax, table, name, labels=i % columns == 0)
    figure.suptitle(
        "thick: 5 % to 95 % of the poses, thin: all, dot: median, cross: mean; best design on top",
        fontsize=9,
    )
    _classes(figure, table)
    return figure


def _classes(figure: Figure, table: pd.DataFrame) -> None:
    """Write the legend of the classes below the panels, if there are several."""
    from matplotlib.lines import Line2D

    there = set(table["class"])
    colours = {group: colour for group, (colour, _) in CLASSES.items() if group in there}
    if there - set(CLASSES):
        colours["other"] = GREY
    if len(colours) > 1:
        bars = [
            Line2D([], [], color=colour, linewidth=5.0, alpha=0.6, label=group)
            for group, colour in colours.items()
        ]
        figure.legend(handles=bars, loc="outside lower center", ncols=len(bars), fontsize=8)


def _label(design: str, place: int) -> str:
    """Return a design's name in two lines of `NAME_LETTERS` letters, its rank without a name."""
    if not design:
        return f"unnamed, rank {place}"
    name = design_label(design)
    if name.startswith("$"):
        return name
    return plain("\n".join(wrap(design, NAME_LETTERS, max_lines=2, placeholder=" …")))


def _panel(ax: Axes, table: pd.DataFrame, name: str, *, labels: bool) -> None:
    ordered = table.sort_values("rank", kind="stable")
    rows = np.arange(len(ordered))[::-1]
    values = {key: column(ordered, f"{name}_{key}") for key in (*DRAWN, "mean")}
    scale = _scale(values, name)
    _grid(ax, ordered, rows, name, labels=labels)
    if scale is None:
        for row, mean in zip(rows, values["mean"], strict=True):
            _note(ax, row, "undefined" if np.isnan(mean) else f"{mean:g}")
        ax.set_xticks([])
        return
    ax.set_xscale("log" if scale.log else "linear")
    if scale.log:
        log_ticks(ax.xaxis, scale.low, scale.high)
    else:
        ax.locator_params(axis="x", nbins=LINEAR_TICKS)
    ax.set_xlim(scale.low, scale.high)
    low, q05, median, q95, high, mean = (scale.clipped(v) for v in values.values())
    for i, row in enumerate(rows):
        if np.isnan(mean[i]):
            _note(ax, row, "undefined")
            continue
        if scale.log and _beyond(values["min"][i]) and values["min"][i] == values["max"][i]:
            _note(ax, row, f"{values['min'][i]:g}")
            continue
        colour = CLASSES.get(str(ordered["class"].iloc[i]), (GREY, ""))[0]
        ax.plot([low[i], high[i]], [row, row], color=colour, linewidth=1.0)
        ax.plot([q05[i], q95[i]], [row, row], color=colour, linewidth=5.0, alpha=0.6)
        ax.plot(median[i], row, "o", color=colour, markeredgecolor="white", markersize=6)
        ax.plot(mean[i], row, "x", color=INK, markersize=5)


def _beyond(value: float) -> bool:
    """Return whether a value is outside the range of a logarithmic axis."""
    return bool(value == 0.0 or np.isinf(value))


def _scale(values: Mapping[str, Array], name: str) -> Scale | None:
    """Return the axis for all designs; extremes far beyond all quantiles lie outside the axes."""
    everything = np.concatenate(list(values.values()))
    quantiles = np.concatenate([values["q05"], values["q95"]])
    inner = quantiles[np.isfinite(quantiles) & (quantiles > 0.0)]
    if inner.size and unbounded(name):
        near = (everything >= inner.min() / FAR_FACTOR) & (everything <= inner.max() * FAR_FACTOR)
        everything = everything[near]
    return scale_of(everything, name, beyond=np.inf)


def _grid(
    ax: Axes, ordered: pd.DataFrame, rows: NDArray[np.int64], name: str, *, labels: bool
) -> None:
    ax.set_xlabel(f"{index_label(ordered, name)} ({INDICES[name].better} is better)")
    ax.set_ylim(-0.6, len(ordered) - 0.4)
    names = [_label(str(d), i + 1) for i, d in enumerate(ordered["design"])]
    for i in np.flatnonzero(driven(ordered)):
        names[i] += f"\n{plain(str(ordered['drives'].iloc[i]))}"
    ax.set_yticks(rows, names if labels else [])
    ax.grid(visible=True, axis="x")
    ax.set_axisbelow(True)


def _note(ax: Axes, row: float, text: str) -> None:
    ax.text(
        0.5,
        row,
        text.replace("inf", "∞"),
        transform=ax.get_yaxis_transform(),
        ha="center",
        va="center",
        color=GREY,
        fontsize=8,
    )
