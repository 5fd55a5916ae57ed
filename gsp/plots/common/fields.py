"""Values over two coordinates: filled and labelled contours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from gsp.figures import INK
from gsp.figures.gaps import undrawable_words
from gsp.geometry.vectors import Array, Mask
from gsp.plots.common.scales import Scale, levels_of, number_format
from gsp.plots.common.style import GREY

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colorbar import Colorbar
    from matplotlib.colors import Normalize
    from matplotlib.contour import QuadContourSet

# Half the size of a text on a line over that of the axes, with some space beside it.
BESIDE_FRAME = 0.07
# Dark is better: one for indices of which a higher value is better, one for the others.
COLOURS, REVERSED = "YlGnBu", "YlGnBu_r"


def draw_field(
    ax: Axes,
    x: Array,
    y: Array,
    values: Array,
    scale: Scale,
    levels: Array | None = None,
    *,
    colours: str = COLOURS,
) -> QuadContourSet:
    """Return the filled contours of values that are not constant, with lines and their labels.

    A pose whose neighbours are undefined is not a corner of a contour; it is drawn as a square.

    Parameters
    ----------
    x, y, values : (n, m) arrays, n and m ≥ 2
        NaN is left white; infinite values take the colour of their end.
    levels : increasing values, default those of the colours
        Where the lines are.
    colours : name of a colour map
    """
    steps = levels_of(values, scale)
    norm = _norm(steps, scale)
    shown = np.ma.masked_invalid(scale.clipped(values))
    ends_beyond = _extend(shown, steps)
    filled = ax.contourf(x, y, shown, levels=steps, norm=norm, cmap=colours, extend=ends_beyond)
    at = steps if levels is None else levels
    lines = ax.contour(x, y, shown, levels=at, colors=INK, linewidths=0.5)
    _label(ax, lines)
    alone = ~np.ma.getmaskarray(shown) & ~_corners(shown)
    if alone.any():
        ax.scatter(
            x[alone],
            y[alone],
            c=shown[alone].filled(np.nan),
            marker="s",
            s=16,
            norm=norm,
            cmap=colours,
            edgecolors=INK,
            linewidths=0.4,
        )
    return filled


def draw_cells(
    ax: Axes,
    edges: tuple[Array, Array],
    values: Array,
    scale: Scale,
    label: str,
    *,
    colours: str = COLOURS,
) -> Colorbar:
    """Return the labelled colour bar of values that each fill a cell of a grid.

    Parameters
    ----------
    edges : (n + 1,) and (m + 1,) arrays
        Where the cells end along the first coordinate, to the right, and along the second.
    values : (n, m) array
        NaN is left white; infinite values take the colour of their end.
    label : str
        Of the colour bar.
    colours : name of a colour map
    """
    steps = levels_of(values, scale)
    shown = np.ma.masked_invalid(scale.clipped(values))
    mesh = ax.pcolormesh(*edges, shown.T, norm=_norm(steps, scale), cmap=colours)
    bar = ax.figure.colorbar(
        mesh,
        ax=ax,
        shrink=0.8,
        format=number_format(steps),
        ticks=steps,
        extend=_extend(shown, steps),
    )
    bar.minorticks_off()
    bar.set_label(label)
    return bar


def _norm(steps: Array, scale: Scale) -> Normalize:
    """Return how values between the first and the last level take the colours."""
    from matplotlib.colors import LogNorm, Normalize

    ends = float(steps[0]), float(steps[-1])
    return LogNorm(*ends) if scale.log else Normalize(*ends)


def _label(ax: Axes, lines: QuadContourSet) -> None:
    """Write values on every second line, where the frame does not cut them."""
    from matplotlib.patheffects import withStroke

    def write(**places: Any) -> Any:
        levels = np.asarray(lines.levels)[::2]
        return ax.clabel(lines, levels, fmt=number_format(levels), fontsize=7, **places) or ()

    first = write(inline=False)
    kept = [text.get_position() for text in first if _clear(ax, text.get_position())]
    for text in first:
        text.remove()
    for text in write(manual=kept):
        text.set_path_effects([withStroke(linewidth=1.5, foreground="white")])


def _clear(ax: Axes, place: tuple[float, float]) -> bool:
    """Whether a text with its middle at a place is clear of the frame."""
    inside = ax.transAxes.inverted().transform(ax.transData.transform(place))
    return bool(((inside >= BESIDE_FRAME) & (inside <= 1.0 - BESIDE_FRAME)).all())


def draw_constant(ax: Axes, x: Array, y: Array, values: Array) -> None:
    """Draw a field of one value in grey, which no colour map holds, with that value.

    A colour would be a place on a scale that does not exist.

    Parameters
    ----------
    x, y, values : (n, m) arrays, n and m ≥ 2
        NaN is left white.
    """
    known = np.ma.masked_invalid(0.0 * values)
    ax.contourf(x, y, known, levels=[-1.0, 1.0], colors=[GREY], alpha=0.25)
    alone = np.isfinite(values) & ~_corners(known)
    ax.scatter(x[alone], y[alone], marker="s", s=16, color=GREY, alpha=0.5)
    write_constant(ax, values)


def write_constant(ax: Axes, values: Array) -> None:
    """Write the one value of an index in the middle of its axes."""
    finite = np.isfinite(values)
    value = f"{values[finite][0]:.6g}"
    alone = finite.sum() == 1 < values.size or np.isinf(values).any()
    ax.text(
        0.5,
        0.5,
        f"{value} where it is finite" if alone else f"constant: {value}",
        ha="center",
        va="center",
        transform=ax.transAxes,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8},
    )


def write_undrawable(ax: Axes, symbol: str, values: Array) -> None:
    """Write into empty axes why there is nothing to draw, such as "CTN is 0 at every pose"."""
    text = undrawable_words(symbol, values)
    frame: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8}
    place: dict[str, Any] = {"ha": "center", "va": "center", "transform": ax.transAxes}
    ax.text(0.5, 0.5, text, color=GREY, bbox=frame, **place)


def _corners(values: Any) -> Mask:
    """Return which points are a corner of a cell with three or four finite corners."""
    known = ~np.ma.getmaskarray(values)
    quads = known[:-1, :-1].astype(int) + known[1:, :-1] + known[:-1, 1:] + known[1:, 1:]
    full = np.pad(quads >= 3, 1)
    return np.asarray(full[1:, 1:] | full[:-1, 1:] | full[1:, :-1] | full[:-1, :-1])


def _extend(values: Any, steps: Array) -> Literal["neither", "min", "max", "both"]:
    """Return on which ends values lie beyond the levels, where the colour bar gets an arrow."""
    below, above = bool((values < steps[0]).any()), bool((values > steps[-1]).any())
    if below and above:
        return "both"
    return "min" if below else "max" if above else "neither"
