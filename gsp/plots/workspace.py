"""Workspaces: plane sections with labelled curves, shells and surfaces in space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.geometry.vectors import Array
from gsp.plots.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    new_axes,
    style,
)
from gsp.workspace.boundary.sections import Section
from gsp.workspace.exact.shells import Arc, Shells
from gsp.workspace.surfaces import Surface

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY, INK)
DASHES = ("-", (0, (6, 1.5)), (0, (1.5, 1)))


def section(
    section: Section,
    ax: Axes | None = None,
    *,
    curves: Sequence[int] | None = None,
    axes: ArrayLike = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    labels: bool = True,
) -> Axes:
    """Draw the curves of a plane section, coloured by label, and its bifurcation points.

    Thick where a curve is a local maximum along its normal, thin where it only connects.

    Parameters
    ----------
    section : Section
    ax : matplotlib Axes, optional
    curves : numbers of curves, default all
    axes : (2, 3) array_like
        What is drawn to the right and upward.
    labels : bool
        Whether to write the labels of the bifurcation points.

    Returns
    -------
    matplotlib.axes.Axes

    *Source: Workspace-3, figures 3.2–3.4, drawn so*
    """
    chosen = range(len(section.curves)) if curves is None else curves
    frame = check_array("axes", axes, (2, 3))
    with style():
        ax = new_axes(6.4, 6.4) if ax is None else ax
        styles = _styles([section.curves[i].label for i in chosen])
        named: set[str] = set()
        for i in chosen:
            curve = section.curves[i]
            flat = curve.pose.position @ frame.T
            colour, dash = styles[curve.label]
            text = "" if curve.label in named else f"[{curve.label}]"
            named.add(curve.label)
            ax.plot(*flat.T, color=colour, linestyle=dash, linewidth=0.7, alpha=0.7)
            thick = np.where(curve.maximal[:, None], flat, np.nan)
            ax.plot(*thick.T, color=colour, linestyle=dash, linewidth=2.0, label=text)
        _points(ax, section, chosen, frame, labels)
        start = section.origin @ frame.T
        ax.plot(*start, "+", color=INK, markersize=9)
        _finish(ax, frame, legend=len(named) <= 16)
    return ax


def arcs(
    arcs: Sequence[Arc],
    ax: Axes | None = None,
    *,
    axes: ArrayLike = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
) -> Axes:
    """Draw the arcs of a section of a fixed-orientation workspace, coloured by label.

    *Source: Workspace-A, figure D.1, drawn so*
    """
    frame = check_array("axes", axes, (2, 3))
    with style():
        ax = new_axes(5.2, 5.2) if ax is None else ax
        styles = _styles([arc.label for arc in arcs])
        named: set[str] = set()
        for arc in arcs:
            flat = arc.points @ frame.T
            colour, dash = styles[arc.label]
            text = "" if arc.label in named else f"[{arc.label}]"
            named.add(arc.label)
            ax.plot(*flat.T, color=colour, linestyle=dash, linewidth=2.0, label=text)
            ax.plot(*flat[[0, -1]].T, "o", color=INK, markersize=3.5)
        _finish(ax, frame, legend=True)
    return ax


def shells(shells: Shells, ax: Axes3D | None = None, *, planes: int = 12) -> Axes3D:
    """Draw a fixed-orientation workspace in space: its edges, and sections through the z-axis.

    *Source: Workspace-3, figures of chapter 4 as chapter 3 and appendix D describe them*
    """
    with style():
        space: Axes3D = new_axes(6.4, 6.4, projection="3d") if ax is None else ax
        for theta in np.arange(planes) * np.pi / planes:
            across = ((np.cos(theta), np.sin(theta), 0.0), (0.0, 0.0, 1.0))
            for arc in shells.section((0.0, 0.0, 0.0), across):
                space.plot(*arc.points.T, color=GREY, linewidth=0.6)
        for edge in shells.edges():
            space.plot(*edge.points.T, color=BLUE, linewidth=1.6)
        corners = np.array([corner.position for corner in shells.vertices()]).reshape(-1, 3)
        space.plot(*corners.T, "o", color=INK, markersize=3.5)
        space.set_aspect("equal")
        space.set(xlabel="x", ylabel="y", zlabel="z")
    return space


def surface(surface: Surface, ax: Axes3D | None = None) -> Axes3D:
    """Draw the surface that rays in all directions end on, coloured by height.

    Directions whose end was not certified are left open.

    Parameters
    ----------
    surface : Surface
        As `gsp.workspace.surface` returns it.
    ax : matplotlib Axes3D, optional

    Returns
    -------
    mpl_toolkits.mplot3d.axes3d.Axes3D
    """
    points = surface.points
    x, y, z = np.moveaxis(np.concatenate((points, points[:1])), -1, 0)
    with style():
        space: Axes3D = new_axes(6.4, 6.4, projection="3d") if ax is None else ax
        space.plot_surface(
            x, y, z, cmap="viridis", rstride=1, cstride=1, linewidth=0.2, edgecolor=INK, alpha=0.85
        )
        space.plot(*surface.origin[:, None], "o", color=VERMILION, markersize=3.5)
        space.set_aspect("equal")
        space.set(xlabel="x", ylabel="y", zlabel="z")
    return space


def _styles(labels: Sequence[str]) -> dict[str, tuple[str, object]]:
    unique = list(dict.fromkeys(labels))
    n = len(COLOURS)
    return {text: (COLOURS[i % n], DASHES[i // n % len(DASHES)]) for i, text in enumerate(unique)}


def _points(ax: Axes, section: Section, chosen: Sequence[int], frame: Array, labels: bool) -> None:
    used = {
        end
        for i in chosen
        for end in (section.curves[i].first, section.curves[i].last)
        if end is not None
    }
    for number in sorted(used):
        point = section.bifurcations[number]
        flat = point.pose.position @ frame.T
        ax.plot(*flat, "o", color=INK, markersize=4)
        if labels:
            text = point.label.replace(" ", "").replace("-", "–")
            ax.annotate(
                text, (flat[0], flat[1]), (4, 4), textcoords="offset points", fontsize=7, color=INK
            )


def _finish(ax: Axes, frame: Array, *, legend: bool) -> None:
    names = [_axis_name(direction) for direction in frame]
    ax.set(xlabel=names[0], ylabel=names[1], aspect="equal")
    ax.grid(visible=True)
    if legend and ax.get_legend_handles_labels()[0]:
        ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=7)


def _axis_name(direction: Array) -> str:
    for name, axis in zip("xyz", np.eye(3), strict=True):
        if np.allclose(direction, axis):
            return name
    return "along (" + ", ".join(f"{x:.3g}" for x in direction) + ")"
