"""The surface of what is proven inside of a region in space."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.geometry.vectors import Array, Mask, cross, norm
from gsp.installed import optional
from gsp.workspace.sets.codes import Numbers
from gsp.workspace.sets.surfaces.manifold import manifold, united
from gsp.workspace.sets.surfaces.outer import Edges, outer
from gsp.workspace.sets.surfaces.pieces import pieces

if TYPE_CHECKING:
    import trimesh

# Vertices nearer than this share of the size of a region are one: planes pass through corners to
# rounding.
SAME_VERTEX = 1e-9
# Triangles of a quadrangle with less than this share of its area are too thin: it is divided from
# its middle.
THIN_SHARE = 0.01


class Surface(NamedTuple):
    """Polygons that enclose what is proven inside.

    Attributes
    ----------
    vertices : (v, 3) array [length; of orientations rad]
    loops : tuple of (m, n) int arrays
        Numbers of vertices around polygons, counterclockwise from outside: one array for each n.
    """

    vertices: Array
    loops: tuple[Numbers, ...]


def mesh(region: Any, near: float = SAME_VERTEX, gap: float = 0.0) -> trimesh.Trimesh:
    """Return the closed surface of what is proven inside, as triangles.

    Parameters
    ----------
    region : Region
    near : float [1]
        Vertices nearer than this share of the size of the surface are one.
    gap : float [1]
        As in `gsp.workspace.sets.surfaces.manifold.manifold`.
    """
    with optional("trimesh", "the surface of a region", "shapes"):
        import trimesh
    vertices, faces = triangles(surface(region))
    return trimesh.Trimesh(*manifold(*united(vertices, faces, near), gap), process=False)


def surface(region: Any) -> Surface:
    """Return the polygons around inside cells and the inside parts of undecided ones.

    Each edge has two polygons, of opposite directions, or four where pieces meet in an edge only.
    """
    vertices, edges = outer(pieces(region))
    return Surface(vertices, _loops(edges) if len(edges.start) else ())


def triangles(found: Surface) -> tuple[Array, Numbers]:
    """Return vertices (m, 3) and triangles (k, 3) of polygons.

    Most of them are divided from a vertex in their middle: others may be between two corners of
    one side.
    """
    vertices, faces = [found.vertices], [np.zeros((0, 3), dtype=np.int64)]
    number = len(found.vertices)
    for loop in found.loops:
        n = loop.shape[1]
        whole = _plain(found.vertices[loop])
        faces += [loop[whole][:, [0, i, i + 1]] for i in range(1, n - 1)]
        rest = loop[~whole]
        middle = np.broadcast_to(number + np.arange(len(rest))[:, None], rest.shape)
        ring = np.stack((rest, np.roll(rest, -1, axis=1), middle), axis=-1)
        faces.append(ring.reshape(-1, 3))
        vertices.append(found.vertices[rest].mean(axis=1))
        number += len(rest)
    return np.concatenate(vertices), np.concatenate(faces)


def _plain(corners: Array) -> Mask:
    """Return which polygons (m, n, 3) are triangles, or quadrangles that two good ones make."""
    n = corners.shape[1]
    if n != 4:
        return np.full(len(corners), n == 3)
    sides = np.roll(corners, -1, axis=1) - corners
    areas = norm(cross(sides, np.roll(sides, -1, axis=1)))
    return np.asarray(areas.min(axis=1) > THIN_SHARE * areas.sum(axis=1))


def _loops(edges: Edges) -> tuple[Numbers, ...]:
    """Return the vertices around polygons, those of each number of corners in one array."""
    order = np.lexsort((edges.start, edges.polygon))
    start, end, polygon = (x[order] for x in (edges.start, edges.end, edges.polygon))
    size = np.int64(max(start.max(), end.max()) + 1)
    _, polygon, count = np.unique(polygon, return_inverse=True, return_counts=True)
    following = np.searchsorted(polygon * size + start, polygon * size + end)
    first = np.cumsum(count) - count
    loops = []
    for n in np.unique(count):
        at = first[count == n]
        loop = np.empty((len(at), n), dtype=np.int64)
        for i in range(n):
            loop[:, i] = start[at]
            at = following[at]
        loops.append(loop)
    return tuple(loops)
