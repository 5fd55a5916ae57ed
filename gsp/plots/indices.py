"""Indices over two parameters as contours, and screws near a singular posture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle, permutations
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import (
    check_array,
    check_integer,
    check_items,
    check_positive,
    check_text,
    is_a,
    is_iterable,
)
from gsp.errors import InvalidInput, brief, expected
from gsp.figures import INK, style
from gsp.geometry.vectors import Array, nearest_to_origin
from gsp.plots.common.fields import COLOURS, draw_constant
from gsp.plots.common.scales import Scale, levels_of, scale_of
from gsp.plots.common.style import BLUE, GREY, VERMILION, axes_or_new
from gsp.plots.common.tables import check_frame, column, coordinates_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Two different coordinates: across and up.
PLANES = tuple(permutations(range(3), 2))
# How the columns of a comparison of screws are drawn: legend and line style.
SCREWS: Mapping[str, tuple[str, str, str]] = MappingProxyType(
    {
        "sigma_r": (r"σ$_\mathrm{r}$", GREY, "-"),
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
    """Return axes with values over two parameters drawn as labelled contours.

    Parameters
    ----------
    values : (n, m) array_like [any unit]
        One row per value of y, one column per value of x; NaN is left white.
    x, y : (m,) and (n,) array_like [stated in `labels`]
        The parameters; n and m at least 2.
    ax : matplotlib Axes or None
        Default a new figure.
    levels : int or sequence of float [unit of the values]
        About how many contours, or where they are, increasing.
    labels : (str, str)
        Of the axes of x and y.
    title : str
        Of the axes.
    best : (x, y) or None [units of x and y]
        A point to mark.
    ridge : two (k,) array_like or None [units of x and y]
        A curve to mark, such as a set of equally good points.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        On wrong types or shapes, or if no value is finite.
    MissingSoftware
        Without matplotlib.
    """
    across, up = check_array("x", x, (None,)), check_array("y", y, (None,))
    heights = check_array("values", values, (None, None), finite=False)
    if across.ndim != 1 or up.ndim != 1 or heights.shape != (len(up), len(across)):
        wanted, got = f"shape ({len(up)}, {len(across)})", f"shape {heights.shape}"
        raise InvalidInput(expected("values", wanted, got))
    scale = scale_of(heights)
    if scale is None or min(heights.shape) < 2:
        wanted = "finite numbers over 2 × 2 points or more"
        raise InvalidInput(expected("values", wanted, brief(values)))
    chosen = _levels(levels, heights, scale)
    point = None if best is None else check_array("best", best, (2,))
    if point is not None and point.ndim != 1:
        raise InvalidInput(expected("best", "two numbers", brief(best)))
    curve = None if ridge is None else _curve(ridge)
    names = [check_text("labels", text) for text in arguments.sequence(2)("labels", labels)]
    heading = check_text("title", title)
    with style():
        axes = axes_or_new(ax, 4.8, 4.0)
        if scale.constant:
            draw_constant(axes, *np.meshgrid(across, up), heights)
        else:
            filled = axes.contourf(across, up, heights, levels=chosen, cmap=COLOURS)
            lines = axes.contour(across, up, heights, levels=chosen, colors=INK, linewidths=0.5)
            axes.clabel(lines, np.asarray(filled.levels)[::2], fontsize=7)
        if curve is not None:
            axes.plot(*curve, color=VERMILION, linewidth=1.8, label="best")
        if point is not None:
            axes.plot(*point, "o", color=VERMILION, markersize=6)
        axes.set(xlabel=names[0], ylabel=names[1], title=heading)
    return axes


def _curve(ridge: tuple[ArrayLike, ArrayLike]) -> list[Array]:
    """Return the coordinates of a curve, two arrays of shape (k,)."""
    several = is_a(ridge, tuple | list | np.ndarray) and is_iterable(ridge)
    if not several or len(ridge) != 2:
        raise InvalidInput(expected("ridge", "two arrays of one length", brief(ridge)))
    curve = [check_array("ridge", part, (None,)) for part in ridge]
    if curve[0].ndim != 1 or curve[0].shape != curve[1].shape:
        raise InvalidInput(expected("ridge", "two arrays of one length", brief(ridge)))
    return curve


def _levels(levels: int | Sequence[float], values: Array, scale: Scale) -> Array:
    """Return increasing levels, from their number or as they are given."""
    from matplotlib.ticker import MaxNLocator

    if scale.constant:
        return levels_of(values, scale)
    if isinstance(levels, int | np.integer) and not isinstance(levels, bool):
        count = check_integer("levels", levels)
        finite = values[np.isfinite(values)]
        return np.asarray(MaxNLocator(count + 1).tick_values(finite.min(), finite.max()))
    chosen = check_array("levels", levels, (None,))
    if chosen.ndim != 1 or len(chosen) < 2 or (np.diff(chosen) <= 0.0).any():
        raise InvalidInput(expected("levels", "two increasing numbers or more", brief(levels)))
    return chosen


@arguments.validated(columns=arguments.sequence())
def screws(table: pd.DataFrame, columns: Sequence[str], ax: Axes | None = None) -> Axes:
    """Return axes with columns of a comparison of screws over the angle of the platform [rad].

    Parameters
    ----------
    table : pandas.DataFrame
        As `gsp.families.nawratil.motion.compare_screws` returns it.
    columns : sequence of str
        Names of columns.
    ax : matplotlib Axes or None
        Default a new figure.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the table is not such a comparison, or has no such column.
    MissingSoftware
        Without matplotlib.
    """
    check_frame("table", table)
    wanted = "some of " + ", ".join(SCREWS)
    names = arguments.names("columns", columns)
    unknown = [name for name in names if name not in SCREWS or name not in table]
    if unknown or not names:
        raise InvalidInput(expected("columns", wanted, brief(unknown or columns)))
    angles = coordinates_of(table, "angle")
    with style():
        axes = axes_or_new(ax, 5.2, 3.6)
        for name in names:
            label, colour, line = SCREWS[name]
            axes.plot(angles, column(table, name), line, color=colour, label=label)
        axes.set_xlabel("angle [rad]")
        axes.grid(True)
        axes.legend(fontsize=7)
    return axes


@arguments.validated(
    axes_of=arguments.mapping, plane=arguments.sequence(2), half_length=arguments.positive
)
def screw_axes(
    axes_of: Mapping[str, Array],
    plane: tuple[int, int],
    ax: Axes | None = None,
    half_length: float = 0.6,
) -> Axes:
    """Return axes with screw axes projected along a coordinate axis.

    Parameters
    ----------
    axes_of : mapping from a label to an (n, 6) or (6,) array [1, length]
        Plücker coordinates (c, ĉ), as `InstantaneousMotion.axis`.
    plane : two of 0, 1, 2
        The coordinates that are drawn across and up.
    ax : matplotlib Axes or None
        Default a new figure.
    half_length : float [length]
        How much of a line is drawn on both sides of its point nearest the origin.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        On wrong types or shapes.
    MissingSoftware
        Without matplotlib.
    """
    colours = cycle((BLUE, VERMILION, INK, GREY))
    lines = arguments.mapping("axes_of", axes_of)
    if not lines:
        raise InvalidInput(expected("axes_of", "a mapping from labels to lines", brief(axes_of)))
    wanted = "two of 0, 1, 2"
    pair = tuple(check_integer("plane", k, least=0) for k in check_items("plane", plane, wanted))
    if pair not in PLANES:
        raise InvalidInput(expected("plane", wanted, brief(plane)))
    half = check_positive("half_length", half_length)
    given = [(str(k), np.atleast_2d(check_array(str(k), v, (6,)))) for k, v in lines.items()]
    with style():
        axes = axes_or_new(ax, 4.6, 4.2)
        for colour, (label, rows) in zip(colours, given, strict=False):
            points = nearest_to_origin(rows[:, :3], rows[:, 3:])
            ends = points + half * np.array([-1.0, 1.0])[:, None, None] * rows[:, :3]
            across, up = (ends[..., k] for k in pair)
            axes.plot(across, up, color=colour, linewidth=0.9, alpha=0.8)
            middle = [points[:, k] for k in plane]
            axes.plot(*middle, ".", color=colour, markersize=4, label=label)
        names = ("x", "y", "z")
        axes.set(xlabel=names[plane[0]], ylabel=names[plane[1]])
        axes.set_aspect("equal", adjustable="datalim")
        axes.legend(fontsize=7)
        axes.grid(True)
    return axes
