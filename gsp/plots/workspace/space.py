"""Workspaces in space: shells of fixed orientation, surfaces on which rays end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gsp.checks import check_integer, check_text, check_type
from gsp.errors import EmptyWorkspace, expected
from gsp.figures import INK, style
from gsp.plots.common.bodies import enclose
from gsp.plots.common.style import BLUE, GREY, VERMILION, space_or_new
from gsp.workspace.exact.shells import Arc, Shells
from gsp.workspace.surfaces import Surface

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D


def shells(shells: Shells, ax: Axes3D | None = None, *, planes: int = 12, unit: str = "") -> Axes3D:
    """Return axes in space with a fixed-orientation workspace: edges, and sections through z.

    Parameters
    ----------
    shells : Shells
        As `gsp.workspace.exact_shells` returns them.
    ax : three-dimensional matplotlib Axes or None
        Default a new figure.
    planes : int
        Number of the planes through the z-axis whose sections are drawn.
    unit : str
        Of lengths, for the labels of the axes.

    Returns
    -------
    mpl_toolkits.mplot3d.Axes3D

    Raises
    ------
    EmptyWorkspace
        If there is nothing to draw.
    InvalidInput
        On wrong types, or no plane.
    MissingSoftware
        Without matplotlib.

    *Source: Workspace-3, figures of chapter 4 as chapter 3 and appendix D describe them*
    """
    check_type("shells", shells, Shells, "shells, as gsp.workspace.exact_shells returns them")
    count, label = check_integer("planes", planes), check_text("unit", unit)
    edges = shells.edges()
    cuts = [arc for turn in np.arange(count) * np.pi / count for arc in _cut(shells, turn)]
    if not edges and not cuts:
        raise EmptyWorkspace(expected("shells", "a workspace with points", "an empty one"))
    with style():
        space = space_or_new(ax, 6.4, 6.4)
        for arc in cuts:
            space.plot(*arc.points.T, color=GREY, linewidth=0.6)
        for edge in edges:
            space.plot(*edge.points.T, color=BLUE, linewidth=1.6)
        corners = np.array([corner.position for corner in shells.vertices()]).reshape(-1, 3)
        space.plot(*corners.T, "o", color=INK, markersize=3.5)
        enclose(space, np.concatenate([line.points for line in (*cuts, *edges)]), label)
    return space


def surface(surface: Surface, ax: Axes3D | None = None, *, unit: str = "") -> Axes3D:
    """Return axes in space with the surface on which rays in all directions end.

    It is coloured by height. Directions whose end is no local maximum are left open.

    Parameters
    ----------
    surface : Surface
        As `gsp.workspace.surface` returns it.
    ax : three-dimensional matplotlib Axes or None
        Default a new figure.
    unit : str
        Of lengths, for the labels of the axes.

    Returns
    -------
    mpl_toolkits.mplot3d.Axes3D

    Raises
    ------
    EmptyWorkspace
        If no end is a local maximum.
    InvalidInput
        On wrong types.
    MissingSoftware
        Without matplotlib.
    """
    check_type("surface", surface, Surface, "a surface, as gsp.workspace.surface returns it")
    label = check_text("unit", unit)
    if not surface.maximal.any():
        raise EmptyWorkspace(expected("surface", "a local maximum or more", "none"))
    points = surface.points
    x, y, z = np.moveaxis(np.concatenate((points, points[:1])), -1, 0)
    with style():
        space = space_or_new(ax, 6.4, 6.4)
        space.plot_surface(
            x, y, z, cmap="viridis", rstride=1, cstride=1, linewidth=0.2, edgecolor=INK, alpha=0.85
        )
        space.plot(*surface.origin[:, None], "o", color=VERMILION, markersize=3.5)
        seen = points.reshape(-1, 3)
        enclose(space, seen[np.isfinite(seen).all(axis=-1)], label)
    return space


def _cut(shells: Shells, turn: float) -> tuple[Arc, ...]:
    """Return the arcs in the plane through the z-axis at an angle [rad] from the x-axis."""
    across = ((np.cos(turn), np.sin(turn), 0.0), (0.0, 0.0, 1.0))
    return shells.section((0.0, 0.0, 0.0), across)
