"""Axes in space with equal scales; bodies through their joints, ellipsoids and frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull

from gsp.figures import INK, name_lengths, set_space_ticks
from gsp.geometry.vectors import Array, cross, norm, unit
from gsp.plots.common.labels import SpaceNote

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

# Points that differ by less than this share of the drawing are one point; points whose distances
# from a plane are less than this share of their spread lie in it.
SAME_POINT_SHARE = 1e-6
CIRCLE_ANGLES = np.linspace(0.0, 2.0 * np.pi, 49)


def body(ax: Axes3D, points: Array, colour: str, size: float) -> None:
    """Draw the convex hull of points: a solid, a plate (points in a plane) or a rod (on a line).

    Parameters
    ----------
    points : (n, 3) array [length]
        The joints of the body. If they coincide, nothing is drawn.
    size : float [length]
        Of the drawing.
    """
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    faces, edges = hull(points, size)
    if faces:
        ax.add_collection3d(Poly3DCollection(faces, facecolor=colour, alpha=0.13, linewidth=0.0))
    if edges:
        wide = 1.1 if faces else 3.0
        ax.add_collection3d(Line3DCollection(edges, colors=colour, linewidths=wide, alpha=0.7))


def hull(points: Array, size: float) -> tuple[list[Array], list[Array]]:
    """Return the faces (k, 3) and the edges (2, 3) of the convex hull of points, (n, 3) [length].

    Points in a plane have one face; points on a line have one edge and no face; points that
    coincide have neither.
    """
    centre = points.mean(axis=0)
    spread = np.abs(points - centre).max()
    if not spread > SAME_POINT_SHARE * size:
        return [], []
    # Scaled, as the search for the hull has absolute tolerances.
    own = (points - centre) / spread
    _, sizes, axes = np.linalg.svd(own, full_matrices=True)
    rank = int(np.sum(sizes > SAME_POINT_SHARE * sizes[0]))
    flat = own @ axes.T
    if rank == 1:
        ends = points[[flat[:, 0].argmin(), flat[:, 0].argmax()]]
        return [], [ends]
    if rank == 2:
        outline = points[ConvexHull(flat[:, :2]).vertices]
        return [outline], list(np.stack((outline, np.roll(outline, -1, axis=0)), axis=1))
    return _solid(points, ConvexHull(own))


def _solid(points: Array, found: ConvexHull) -> tuple[list[Array], list[Array]]:
    """Return triangles, and the edges at which their planes meet at an angle."""
    edges = []
    for i, (corners, neighbours) in enumerate(zip(found.simplices, found.neighbors, strict=True)):
        for k, other in enumerate(neighbours):
            bent = found.equations[i, :3] @ found.equations[other, :3] < 1.0 - SAME_POINT_SHARE
            if bent and i < other:
                edges.append(points[np.delete(corners, k)])
    return [points[corners] for corners in found.simplices], edges


def ellipsoid(ax: Axes3D, centre: Array, axes: Array, colour: str) -> None:
    """Draw an ellipsoid: its surface, and its three principal sections.

    Parameters
    ----------
    centre : (3,) array [length]
    axes : (3, 3) array [length]
        The semi-axes as columns.
    """
    around, down = np.meshgrid(CIRCLE_ANGLES, np.linspace(0.0, np.pi, 25))
    sphere = np.stack(
        (np.cos(around) * np.sin(down), np.sin(around) * np.sin(down), np.cos(down)), axis=-1
    )
    x, y, z = np.moveaxis(centre + sphere @ axes.T, -1, 0)
    ax.plot_surface(x, y, z, color=colour, alpha=0.05, linewidth=0.0, shade=False)
    circle = np.stack((np.cos(CIRCLE_ANGLES), np.sin(CIRCLE_ANGLES)), axis=1)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        ring = centre + circle @ axes[:, [i, j]].T
        ax.plot(*ring.T, color=colour, linewidth=0.8, alpha=0.8)


def frame(
    ax: Axes3D, origin: Array, rotation: Array, size: float, name: str, side: float
) -> list[SpaceNote]:
    """Draw the axes of a frame; return their letters, and its name below (`side` 1) or above (−1).

    Letters and name are to be written by `gsp.plots.common.labels.write_in_space`.
    """
    notes = []
    for axis, letter in zip(rotation.T, "xyz", strict=True):
        tip = origin + size * axis
        ax.plot(*np.stack((origin, tip)).T, color=INK, linewidth=0.9)
        beside = [0.15 * size * k * other for other in rotation.T for k in (1.0, -1.0)]
        places = [origin + far * size * axis for far in (1.15, 1.3)] + [tip + b for b in beside]
        notes.append(SpaceNote(letter, np.array(places), {"fontsize": 7, "color": INK}))
    x, y, normal = *rotation.T[:2], cross(rotation[:, 0], rotation[:, 1])
    ways = [normal + x + y, normal + x - y, normal - x + y, normal - x - y, x + y, x - y, y - x]
    places = [origin - 0.2 * side * far * size * unit(w) for far in (1.0, 1.6) for w in ways]
    return [*notes, SpaceNote(name, np.array(places), {"fontsize": 8, "color": INK})]


def enclose(ax: Axes3D, points: Array, unit_name: str, size: float = 0.0) -> None:
    """Set limits around points, (n, 3) [length], with equal scales, and label the axes.

    No side is shorter than a quarter of the longest one, or of `size`.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    longest = max(float((high - low).max()), size) or 1.0
    spans = np.maximum(high - low, 0.25 * longest)
    middle = (low + high) / 2.0
    for name, start, end in zip("xyz", middle - 0.51 * spans, middle + 0.51 * spans, strict=True):
        getattr(ax, f"set_{name}lim")(start, end)
        axis = getattr(ax, f"{name}axis")
        axis.pane.set_facecolor("white")
        axis.pane.set_edgecolor("#E8EAED")
        axis.set_tick_params(labelsize=7, colors="#5B616B")
    name_lengths(ax, {"x": "x", "y": "y", "z": "z"}, unit_name)
    # As many numbers as fit on a side.
    set_space_ticks(ax, [max(round(8.2 * span / spans.max()), 2) for span in spans])
    # matplotlib makes all diagonals equally long: a tall box is drawn smaller, for its labels.
    rise = np.array([0.35, 0.22, 0.91])  # of the axes in this view
    tall = float(rise @ spans / norm(spans) / (rise.sum() / 3.0**0.5))
    ax.set_box_aspect(spans / spans.max(), zoom=1.05 / max(tall, 1.0))
    ax.view_init(elev=24, azim=-58)
