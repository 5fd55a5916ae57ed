"""Indices over two parameters as contours, and screws near a singular posture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import Array
from gsp.plots.style import BLUE, GREY, INK, VERMILION, new_axes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# How the columns of a comparison of screws are drawn: legend and line style.
SCREWS: Mapping[str, tuple[str, str, str]] = MappingProxyType(
    {
        "sigma_r": ("σ_r", GREY, "-"),
        "control_number": ("CTN", INK, "-"),
        "pitch_c": ("pitch, control number", BLUE, "-"),
        "pitch_p": ("pitch, linear complex", VERMILION, "--"),
        "pitch_error_c": ("error of the pitch, control number", BLUE, "-."),
        "pitch_error_p": ("error of the pitch, linear complex", VERMILION, ":"),
        "distance_c": ("distance of the axis, control number", BLUE, "-"),
        "distance_p": ("distance of the axis, linear complex", VERMILION, "--"),
        "angle_c": ("angle of the axis [rad], control number", BLUE, "-."),
        "angle_p": ("angle of the axis [rad], linear complex", VERMILION, ":"),
    }
)


def contours(
    values: ArrayLike,
    x: ArrayLike,
    y: ArrayLike,
    ax: Axes | None = None,
    *,
    levels: int | Sequence[float] = 14,
    labels: tuple[str, str] = ("α [°]", "h"),
    title: str = "",
    best: tuple[float, float] | None = None,
    ridge: tuple[ArrayLike, ArrayLike] | None = None,
) -> Axes:
    """Draw an index over two parameters as labelled contours.

    Parameters
    ----------
    values : (n, m) array_like
        A row a value of y, a column a value of x; NaN is left white.
    x, y : (m,) and (n,) array_like
    ax : matplotlib Axes or None
        Default a new figure.
    levels : int or sequence of float
        How many contours, or where.
    labels, title : what the axes and the figure are called
    best : (x, y) or None
        A point to mark.
    ridge : two (k,) array_like or None
        A curve to mark, such as a set of equally good points.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        On shapes that do not fit.
    """
    across, up = check_array("x", x, (None,)), check_array("y", y, (None,))
    heights = check_array("values", values, (len(up), len(across)), finite=False)
    if heights.shape != (len(up), len(across)):
        wanted, got = f"shape ({len(up)}, {len(across)})", f"shape {heights.shape}"
        raise InvalidInput(expected("values", wanted, got))
    with style():
        axes = new_axes(4.8, 4.0) if ax is None else ax
        filled = axes.contourf(across, up, heights, levels=levels, cmap="YlGnBu")
        lines = axes.contour(across, up, heights, levels=filled.levels, colors=INK, linewidths=0.5)
        axes.clabel(lines, np.asarray(lines.levels)[::2], fontsize=7)
        if ridge is not None:
            axes.plot(*ridge, color=VERMILION, linewidth=1.8, label="best")
        if best is not None:
            axes.plot(*best, "o", color=VERMILION, markersize=6)
        axes.set(xlabel=labels[0], ylabel=labels[1], title=title)
    return axes


def screws(table: pd.DataFrame, columns: Sequence[str], ax: Axes | None = None) -> Axes:
    """Draw columns of a comparison of screws over the angle of the platform.

    Parameters
    ----------
    table : pandas.DataFrame
        As `gsp.families.nawratil_motion.compare_screws` returns it.
    columns : names of columns
    ax : matplotlib Axes or None

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the table has no such column.
    """
    unknown = [c for c in columns if c not in SCREWS or c not in table]
    if unknown or not columns:
        raise InvalidInput(expected("columns", "some of " + ", ".join(SCREWS), columns))
    with style():
        axes = new_axes(5.2, 3.6) if ax is None else ax
        for column in columns:
            label, colour, line = SCREWS[column]
            axes.plot(table["angle"], table[column], line, color=colour, label=label)
        axes.set_xlabel("angle [rad]")
        axes.grid(True)
        axes.legend(fontsize=7)
    return axes


def screw_axes(
    axes_of: Mapping[str, Array],
    plane: tuple[int, int],
    ax: Axes | None = None,
    half_length: float = 0.6,
) -> Axes:
    """Draw screw axes as they are seen along a coordinate axis.

    Parameters
    ----------
    axes_of : mapping from a label to an (n, 6) or (6,) array
        Plücker coordinates (c, ĉ), as `InstantaneousMotion.axis`.
    plane : two of 0, 1, 2
        The coordinates that are drawn across and up.
    ax : matplotlib Axes or None
    half_length : float [length]
        How much of a line is drawn on both sides of its point nearest the origin.

    Returns
    -------
    matplotlib.axes.Axes
    """
    colours = (BLUE, VERMILION, INK, GREY)
    with style():
        axes = new_axes(4.6, 4.2) if ax is None else ax
        for colour, (label, lines) in zip(colours, axes_of.items(), strict=False):
            rows = np.atleast_2d(check_array(label, lines, (6,)))
            points = np.cross(rows[:, :3], rows[:, 3:])
            ends = points + half_length * np.array([-1.0, 1.0])[:, None, None] * rows[:, :3]
            across, up = (ends[..., k] for k in plane)
            axes.plot(across, up, color=colour, linewidth=0.9, alpha=0.8)
            middle = [points[:, k] for k in plane]
            axes.plot(*middle, ".", color=colour, markersize=4, label=label)
        names = ("x", "y", "z")
        axes.set(xlabel=names[plane[0]], ylabel=names[plane[1]])
        axes.set_aspect("equal", adjustable="datalim")
        axes.legend(fontsize=7)
        axes.grid(True)
    return axes
