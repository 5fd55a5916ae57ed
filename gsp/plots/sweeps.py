"""Sweeps: an index along a line, or over a plane, one panel per index."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from gsp import arguments
from gsp.checks import check_array, is_a
from gsp.errors import InvalidInput, brief, expected
from gsp.figures import name_lengths, style
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import pose_text
from gsp.geometry.vectors import Array
from gsp.indices import INDICES
from gsp.plots.common.fields import (
    COLOURS,
    REVERSED,
    draw_constant,
    draw_field,
    write_constant,
    write_undrawable,
)
from gsp.plots.common.scales import number_format, scale_of
from gsp.plots.common.style import (
    BLUE,
    SHORT_NAME,
    axes_or_new,
    few_marks,
    log_ticks,
    new_panels,
    plain,
    symbol_text,
    title_text,
)
from gsp.plots.common.tables import (
    check_frame,
    chosen_indices,
    column,
    coordinates_of,
    index_label,
)
from gsp.sweeps import check_sweep, index_columns

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# A coordinate that is an angle, and how the names of those begin that are lengths.
DEGREES = "turn_deg"
LENGTH = "distance"


def sweep(table: pd.DataFrame, indices: Iterable[str] | str | None = None) -> Figure:
    """Return a new figure of a sweep, with one panel and one axis of values per index.

    A panel in which no value can be drawn states why, such as "CTN is undefined at every pose".

    Parameters
    ----------
    table : pandas.DataFrame
        As `gsp.sweep` returns it, over one coordinate (lines) or two (contours).
    indices : str, iterable of str or None
        Names or symbols; default all in the table.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InvalidInput
        If the table is not such a sweep, or has no such index.
    MissingSoftware
        Without matplotlib.
    """
    check_frame("table", table)
    two = len(check_sweep(table, *_count(table))) == 2
    names = _chosen(table, indices)
    draw = _over_plane if two else _along
    with style():
        size = (4.6, 4.0) if two else (5.6, 2.1 if len(names) > 1 else 3.4)
        figure, panels = new_panels(len(names), *size, columns=3 if two else 1 + (len(names) > 4))
        for ax, name in zip(panels, names, strict=True):
            draw(table, name, ax, None)
        figure.suptitle(_title(table), fontsize=10)
    return figure


def along(table: pd.DataFrame, index: str | None = None, ax: Axes | None = None) -> Axes:
    """Return axes with an index drawn against the coordinate of a sweep along a line.

    The axis of values is linear where the index has two bounds, and begins at a bound that is near
    the values; it is logarithmic where the index has no bound. There infinite values lie outside
    the axes. Where no value can be drawn, the axes state why.

    Parameters
    ----------
    table : pandas.DataFrame
        As `gsp.sweep` returns it for a path with one coordinate.
    index : str or None
        Name or symbol; default the first index in the table.
    ax : matplotlib Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the table is not such a sweep, or has no such index.
    MissingSoftware
        Without matplotlib.
    """
    check_frame("table", table)
    check_sweep(table, 1)
    name = _one(table, index)
    with style():
        return _along(table, name, axes_or_new(ax, 5.2, 3.4), _motion(table))


def over_plane(
    table: pd.DataFrame,
    index: str | None = None,
    levels: Sequence[float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Return axes with the contours of an index over the plane of a sweep, dark where it is better.

    Where no value can be drawn, the axes state why.

    Parameters
    ----------
    table : pandas.DataFrame
        As `gsp.sweep` returns it for `gsp.sweeps.plane`.
    index : str or None
        Name or symbol; default the first index in the table.
    levels : increasing numbers or None [unit of the index]
        Where the contours are; default round numbers over the range of the values.
    ax : matplotlib Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the table is not such a sweep, has no such index, or the levels do not increase.
    MissingSoftware
        Without matplotlib.
    """
    check_frame("table", table)
    check_sweep(table, 2)
    name = _one(table, index)
    chosen = None if levels is None else check_array("levels", levels, (None,))
    if chosen is not None and (chosen.ndim != 1 or len(chosen) < 1 or (np.diff(chosen) <= 0).any()):
        raise InvalidInput(expected("levels", "increasing numbers", brief(levels)))
    with style():
        return _over_plane(table, name, axes_or_new(ax, 5.0, 4.2), _motion(table), chosen)


def _along(table: pd.DataFrame, name: str, ax: Axes, title: str | None) -> Axes:
    (coordinate,) = check_sweep(table, 1)
    steps, values = coordinates_of(table, coordinate), column(table, name)
    ax.set_ylabel(index_label(table, name))
    if title:
        ax.set_title(title, loc="left", fontsize=9)
    if np.ptp(steps) > 0.0:
        ax.set_xlim(steps.min(), steps.max())
    scale = scale_of(values, name)
    if scale is None:
        write_undrawable(ax, symbol_text(name), values)
        ax.set_yticks([])
        return _named(ax, table)
    shown = scale.clipped(values)
    ax.set_yscale("log" if scale.log else "linear")
    if scale.log:
        log_ticks(ax.yaxis, scale.low, scale.high)
    # A line on the edge, such as that of a constant 0, would be hidden by the frame.
    ax.plot(steps, shown, color=BLUE, zorder=3)
    if scale.constant:
        write_constant(ax, values)
    # A value between two undefined ones makes no line.
    gaps = np.pad(np.isnan(shown), 1, constant_values=True)
    alone = gaps[:-2] & gaps[2:] & ~np.isnan(shown)
    if alone.any():
        ax.plot(steps[alone], shown[alone], "o", color=BLUE, markersize=4)
    low = scale.low if scale.log else scale.low - 0.02 * (scale.high - scale.low)
    ax.set_ylim(low, scale.high)
    ax.grid(visible=True)
    return _named(ax, table)


def _over_plane(
    table: pd.DataFrame, name: str, ax: Axes, title: str | None, levels: Array | None = None
) -> Axes:
    coordinates = check_sweep(table, 2)
    shape = _grid(table)
    x, y = (coordinates_of(table, c).reshape(shape) for c in coordinates)
    values = column(table, name).reshape(shape)
    heading = f"{index_label(table, name)}{', ' + title if title else ''}"
    ax.set_title(heading, loc="left", fontsize=9, wrap=True)  # the axes may be narrow
    ax.set_xlim(x.min(), x.max())
    ax.set_ylim(y.min(), y.max())
    ax.set_aspect("equal")
    few_marks(ax)
    _named(ax, table)
    scale = scale_of(values, name)
    if scale is None:
        write_undrawable(ax, symbol_text(name), values)
        return ax
    if scale.constant:
        draw_constant(ax, x, y, values)
        return ax
    colours = COLOURS if INDICES[name].better == "higher" else REVERSED
    filled = draw_field(ax, x, y, values, scale, levels, colours=colours)
    ax.figure.colorbar(filled, ax=ax, shrink=0.8, format=number_format(np.asarray(filled.levels)))
    return ax


def _grid(table: pd.DataFrame) -> tuple[int, int]:
    shape = arguments.attribute(table, "shape", arguments.array(None), np.zeros(0))
    if len(shape) != 2 or np.prod(shape) != len(table) or min(shape) < 2:
        got = f"shape {list(shape)}, {len(table)} rows"
        raise InvalidInput(expected("table", "all rows of a sweep over 2 × 2 poses or more", got))
    return int(shape[0]), int(shape[1])


def _count(table: pd.DataFrame) -> tuple[int]:
    """Return the number of coordinates, 1 or 2."""
    names = arguments.attribute(table, "coordinates", arguments.names, ())
    return (2,) if len(names) == 2 else (1,)


def _chosen(table: pd.DataFrame, indices: Iterable[str] | str | None) -> list[str]:
    return chosen_indices("all" if indices is None else indices, index_columns(table))


def _one(table: pd.DataFrame, index: str | None) -> str:
    """Return the name of the index to draw, by default the first of the table."""
    if index is not None and not is_a(index, str):
        raise InvalidInput(expected("index", "the name of one index", brief(index)))
    names = _chosen(table, index)
    if index is not None and len(names) > 1:
        raise InvalidInput(expected("index", "the name of one index", brief(index)))
    return names[0]


def _motion(table: pd.DataFrame) -> str:
    """Return what moves, and below it from which pose."""
    lines = [plain(str(table.attrs.get("motion", ""))), _pose(table)]
    return "\n".join(line for line in lines if line)


def _pose(table: pd.DataFrame) -> str:
    known = table.attrs.get("pose")
    if not isinstance(known, dict) or not {"position", "roll_pitch_yaw_deg"} <= known.keys():
        return ""
    pose = Pose.from_rpy(known["position"], known["roll_pitch_yaw_deg"], degrees=True)
    return "from " + plain(pose_text(pose, str(table.attrs.get("unit", ""))))


def _title(table: pd.DataFrame) -> str:
    name = title_text(str(table.attrs.get("design", "")), SHORT_NAME)
    return ": ".join(text for text in (name, _motion(table)) if text)


def _named(ax: Axes, table: pd.DataFrame) -> Axes:
    """Return axes, which have their limits, with the names of the coordinates."""
    labels = arguments.attribute(table, "labels", arguments.mapping, {})
    unit = str(table.attrs.get("unit", ""))
    of_unit: dict[str, dict[str, str]] = {}
    for axis, coordinate in zip("xy", check_sweep(table, *_count(table)), strict=False):
        turns = coordinate == DEGREES
        name = "rotation" if turns and not labels else labels.get(coordinate, coordinate)
        its = "°" if turns else unit if coordinate.startswith(LENGTH) else ""
        of_unit.setdefault(its, {})[axis] = plain(str(name))
    for its, names in of_unit.items():
        name_lengths(ax, names, its)
    return ax
