"""The outer faces of the cells of a region that are proven inside."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.errors import MissingSoftware
from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE

if TYPE_CHECKING:
    import trimesh


def mesh(region: Any) -> trimesh.Trimesh:
    """Return the closed surface of the inside cells, as triangles."""
    try:
        import trimesh
    except ImportError as error:
        raise MissingSoftware("trimesh", "the surface of a region", "shapes") from error
    quads = surface(region)
    faces = np.arange(4 * len(quads)).reshape(-1, 4)
    triangles = np.concatenate((faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]))
    # Corners are merged at size 1: the tolerance of trimesh is absolute.
    start = quads.reshape(-1, 3).min(axis=0, initial=np.inf)
    size = float((quads - start).max(initial=0.0)) or 1.0
    joined = trimesh.Trimesh((quads.reshape(-1, 3) - start) / size, triangles, process=True)
    return trimesh.Trimesh(joined.vertices * size + start, joined.faces, process=False)


def surface(region: Any) -> Array:
    """Return the outer faces of the inside cells, as quadrangles (n, 4, 3), seen from outside."""
    inside = region.codes == INSIDE
    quads = [np.zeros((0, 4, 3))]
    for k, side, low, high in free_faces(region.low[inside], region.high[inside]):
        i, j = (k + 1) % 3, (k + 2) % 3
        corners = np.empty((len(low), 4, 3))
        corners[..., k] = (high if side else low)[:, None, k]
        corners[..., i] = np.stack((low[:, i], high[:, i], high[:, i], low[:, i]), axis=1)
        corners[..., j] = np.stack((low[:, j], low[:, j], high[:, j], high[:, j]), axis=1)
        quads.append(corners if side else corners[:, ::-1])
    return np.concatenate(quads)


def free_faces(low: Array, high: Array) -> list[tuple[int, int, Array, Array]]:
    """Return the faces of boxes (n, d) that are no face of another one.

    Per direction and side (0 low, 1 high) the boxes that the faces belong to. Boxes come from one
    domain by halving; they are divided to the size of the smallest one first.
    """
    if not len(low):
        return []
    step = (high - low).min(axis=0)
    start = low.min(axis=0)
    first = np.rint((low - start) / step).astype(np.int64) + 1
    last = np.rint((high - start) / step).astype(np.int64) + 1
    grid = np.zeros(last.max(axis=0) + 1, dtype=np.bool_)
    for a, b in zip(first, last, strict=True):
        grid[tuple(map(slice, a, b))] = True
    faces = []
    for k in range(grid.ndim):
        for side in (0, 1):
            corner = np.argwhere(grid & ~np.roll(grid, -1 if side else 1, axis=k)) - 1
            # The same double for the same corner of two boxes.
            faces.append((k, side, start + corner * step, start + (corner + 1) * step))
    return faces
