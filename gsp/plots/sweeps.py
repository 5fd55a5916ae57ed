"""Sweeps: indices along a line, and contours over a plane."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from gsp.errors import InvalidInput, expected
from gsp.indices import INDICES
from gsp.plots.style import BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILION, new_axes, style
from gsp.sweeps import check_sweep, index_columns

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LINES = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)
LEVELS = tuple(np.round(np.arange(0.1, 1.0, 0.1), 1))
_NAMES = {"turn_deg": "turn [°]", "distance": "distance", "u": "u", "v": "v"}


def along(
    frame: pd.DataFrame, indices: Iterable[str] | str | None = None, ax: Axes | None = None
) -> Axes:
    """Draw indices against the coordinate of a sweep along a line.

    Parameters
    ----------
    frame : pandas.DataFrame
        As `gsp.sweep` returns it for a path with one coordinate.
    indices : names, default all in the table
    ax : matplotlib Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the table is no such sweep, or has no such index.
    MissingSoftware
        Without matplotlib.
    """
    (coordinate,) = check_sweep(frame, 1)
    names = _chosen(frame, indices)
    with style():
        ax = ax or new_axes(5.2, 3.4)
        for name, colour in zip(names, _cycle(len(names)), strict=True):
            label = INDICES[name].symbol
            ax.plot(frame[coordinate], frame[name], color=colour, label=label)
        ax.set_xlabel(_label(frame, coordinate))
        ax.set_ylabel(INDICES[names[0]].symbol if len(names) == 1 else "index")
        ax.margins(x=0.0)
        _from_zero(ax, names)
        if len(names) > 1:
            ax.legend()
        ax.grid(visible=True)
        ax.set_title(frame.attrs.get("motion", ""), loc="left", fontsize=9)
    return ax


def over_plane(
    frame: pd.DataFrame,
    index: str = "quality_index",
    levels: Sequence[float] = LEVELS,
    ax: Axes | None = None,
) -> Axes:
    """Draw the contours of an index over the plane of a sweep.

    Parameters
    ----------
    frame : pandas.DataFrame
        As `gsp.sweep` returns it for `gsp.sweeps.plane`.
    index : str
    levels : increasing numbers
        Contours, each labelled.
    ax : matplotlib Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the table is no such sweep, or has no such index.
    MissingSoftware
        Without matplotlib.
    """
    u, v = check_sweep(frame, 2)
    (name,) = _chosen(frame, index)
    shape = tuple(frame.attrs["shape"])
    x, y, z = (frame[c].to_numpy().reshape(shape) for c in (u, v, name))
    with style():
        ax = ax or new_axes(4.6, 4.4)
        lines = ax.contour(x, y, z, levels=list(levels), cmap="viridis", linewidths=1.2)
        ax.clabel(lines, fmt="%g", fontsize=7, colors=INK)
        ax.set_aspect("equal")
        ax.set_xlabel(_label(frame, u))
        ax.set_ylabel(_label(frame, v))
        ax.set_title(
            f"{INDICES[name].symbol}, {frame.attrs.get('motion', '')}", loc="left", fontsize=9
        )
    return ax


def _chosen(frame: pd.DataFrame, indices: Iterable[str] | str | None) -> list[str]:
    known = index_columns(frame)
    names = known if indices is None else [indices] if isinstance(indices, str) else list(indices)
    if not names or any(name not in known for name in names):
        raise InvalidInput(expected("indices", "some of " + ", ".join(known), names))
    return names


def _label(frame: pd.DataFrame, coordinate: str) -> str:
    text = _NAMES.get(coordinate, coordinate)
    length = frame.attrs.get("unit", "") if coordinate in ("distance", "u", "v") else ""
    return f"{text} [{length}]" if length else text


def _from_zero(ax: Axes, names: Sequence[str]) -> None:
    """Let the axis of indices between 0 and 1 show both."""
    if all(sorted((INDICES[n].best, INDICES[n].worst)) == [0.0, 1.0] for n in names):
        ax.set_ylim(0.0, 1.05)


def _cycle(n: int) -> list[str]:
    return [LINES[i % len(LINES)] for i in range(n)]
