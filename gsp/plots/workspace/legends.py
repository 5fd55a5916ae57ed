"""The legend of curves: beside axes or below them, so long that the axes keep half of the room."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.geometry.vectors import Array
from gsp.plots.workspace.notes import LABEL_SIZE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.transforms import Transform

# Share of the room that the axes keep, in the direction in which the legend is; greatest width of a
# legend below them, as a share of the room: one that is wider than axes makes them narrower.
AXES_SHARE, GREATEST_WIDTH = 0.5, 0.75
# About what labels of ticks and axes take, right and upward, and how far a legend below the axes
# is from them without the pad of their label [points]; the space between columns [letters].
AROUND, BELOW, COLUMN_SPACE = (50.0, 45.0), 30.0, 2.0


class _Grid(NamedTuple):
    """Columns and rows of a legend, and the side of the axes [points per unit of its data]."""

    below: bool
    columns: int
    rows: int
    scale: float

    @property
    def room(self) -> int:
        return self.columns * self.rows


def write_legend(
    ax: Axes, before: Mapping[str, Any], curves: Mapping[str, Any], after: Mapping[str, Any]
) -> None:
    """Write the legend beside the axes or below them, where the axes are larger then.

    Entries of curves that leave the axes less than half of the room are counted by the last one.

    Parameters
    ----------
    before, curves, after : mappings
        The line of each entry.
    """
    from matplotlib.lines import Line2D

    everything = {**before, **curves, **after}
    if not everything:  # All curves have their names beside them.
        return
    grids = _grids(ax, len(everything), _entry(ax, everything))
    best = max(grids, key=lambda grid: (min(grid.room, len(everything)), grid.scale))
    if best.room < len(everything):
        kept = max(best.room - len(before) - len(after) - 1, 0)
        rest = {f"and {len(curves) - kept} more": Line2D([], [], linestyle="none")}
        everything = {**before, **dict(list(curves.items())[:kept]), **rest, **after}
    if best.below:
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0)}
        _draw(ax, everything, best.columns, **place, bbox_transform=below_labels(ax))
    else:
        _draw(ax, everything, best.columns, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def below_labels(ax: Axes) -> Transform:
    """Return the coordinates of axes, moved down by the height of the labels of the x-axis."""
    from matplotlib.transforms import ScaledTranslation

    away = (BELOW + ax.xaxis.labelpad) / 72.0
    return ax.transAxes + ScaledTranslation(0.0, -away, ax.figure.dpi_scale_trans)


def _draw(ax: Axes, handles: Mapping[str, Any], columns: int, **place: Any) -> Any:
    return ax.legend(
        list(handles.values()),
        list(handles),
        fontsize=LABEL_SIZE,
        handlelength=4.0,  # long enough for the dashes
        ncols=columns,
        columnspacing=COLUMN_SPACE,
        **place,
    )


def _entry(ax: Axes, handles: Mapping[str, Any]) -> Array:
    """Return width and height of the widest entry, with the space to the next [points]."""
    legend = _draw(ax, handles, 1, loc="upper left")
    wide, high = legend.get_window_extent().size * 72.0 / ax.figure.dpi
    return np.array((wide + COLUMN_SPACE * LABEL_SIZE, high / len(handles)))


def _grids(ax: Axes, count: int, entry: Array) -> list[_Grid]:
    """Return the legends beside the axes and below them that leave them their share."""
    room = _room(ax)
    inner = room - AROUND
    data = np.array([np.ptp(ax.get_xlim()), np.ptp(ax.get_ylim())])
    share = AXES_SHARE * room
    most = np.array(
        [[inner[0] - share[0], inner[1]], [GREATEST_WIDTH * room[0], inner[1] - share[1]]]
    )
    fit_beside = bool(most[0, 0] >= entry[0])
    fit = np.maximum(most // entry, 1.0).astype(int)
    grids = []
    for below, (columns, rows) in zip((False, True), fit.tolist(), strict=True):
        columns = min(columns, count) if below else min(columns, -(-count // rows))
        rows = min(rows, -(-count // columns))
        taken = np.where([not below, below], np.array((columns, rows)) * entry, 0.0)
        grids.append(_Grid(below, columns, rows, float(((inner - taken) / data).min())))
    # Beside axes that would keep less than their share there is none.
    return grids if fit_beside else grids[1:]


def _room(ax: Axes) -> Array:
    """Return width and height of the part of the figure that is for axes [points]."""
    whole = np.asarray(ax.figure.bbox.size) * 72.0 / ax.figure.dpi
    spec = ax.get_subplotspec()
    if spec is None:
        return np.asarray(whole)
    rows, columns = spec.get_gridspec().get_geometry()
    return np.asarray(whole * (len(spec.colspan) / columns, len(spec.rowspan) / rows))
