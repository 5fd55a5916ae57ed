"""The outer faces of the cells of a region that are proven inside."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gsp.checks import optional
from gsp.geometry.vectors import Array, cross
from gsp.workspace.sets.codes import INSIDE

if TYPE_CHECKING:
    import trimesh


def mesh(region: Any, gap: float = 0.0) -> trimesh.Trimesh:
    """Return the closed surface of the inside cells, as triangles; `gap` as in `closed`."""
    with optional("trimesh", "the surface of a region", "shapes"):
        import trimesh
    inside = region.codes == INSIDE
    if not inside.any():
        return trimesh.Trimesh()
    step = (region.high[inside] - region.low[inside]).min(axis=0)
    vertices, faces = closed(surface(region), step, gap)
    return trimesh.Trimesh(vertices, faces, process=False)


def closed(quads: Array, step: Array, gap: float = 0.0) -> tuple[Array, NDArray[np.int64]]:
    """Return vertices (m, 3) and triangles (k, 3) of the outer faces of cells of sides `step`.

    Each edge has two triangles, of opposite directions. Where two cells meet in an edge only, four
    faces do: there each cell gets a vertex of its own in the middle of the edge. These vertices
    are moved by `gap` of the way to the middle of their cell, so that programs which unite equal
    vertices keep them apart.
    """
    grid = np.rint((quads - quads.min(axis=(0, 1))) / step).astype(np.int64)
    corners, first, ids = np.unique(
        grid.reshape(-1, 3), axis=0, return_index=True, return_inverse=True
    )
    vertices, ids = quads.reshape(-1, 3)[first], ids.reshape(-1, 4)
    ends = np.stack((ids, np.roll(ids, -1, axis=1)), axis=-1)
    _, edge, count = np.unique(
        np.sort(ends.reshape(-1, 2), axis=1), axis=0, return_inverse=True, return_counts=True
    )
    edge = edge.reshape(-1, 4)
    shared = count[edge] > 2
    # Twice the middle of the cell that a face belongs to: half a side behind the face.
    behind = cross(grid[:, 1] - grid[:, 0], grid[:, 2] - grid[:, 1])
    cells = grid[:, 0] + grid[:, 2] - behind
    plain = np.asarray(~shared.any(axis=1))
    quad, side = np.nonzero(shared)
    _, chosen, middle = np.unique(
        np.column_stack((edge[quad, side], cells[quad])),
        axis=0,
        return_index=True,
        return_inverse=True,
    )
    divided = ends[quad, side][chosen]
    inward = 0.5 * cells[quad][chosen] - corners[divided].mean(axis=1)
    middles = vertices[divided].mean(axis=1) + gap * step * inward
    centres = quads[~plain].mean(axis=1)
    number = np.full((len(quads), 4), -1)
    number[shared] = len(vertices) + middle.reshape(-1)
    centre = np.full(len(quads), -1)
    centre[~plain] = len(vertices) + len(middles) + np.arange(len(centres))
    at, k = np.nonzero(~plain[:, None] & ~shared)
    faces = [
        ids[plain][:, [0, 1, 2]],
        ids[plain][:, [0, 2, 3]],
        np.column_stack((ends[at, k], centre[at])),
        np.column_stack((ends[quad, side, 0], number[quad, side], centre[quad])),
        np.column_stack((number[quad, side], ends[quad, side, 1], centre[quad])),
    ]
    return np.concatenate((vertices, middles, centres)), np.concatenate(faces)


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
    """Return the faces of boxes (n, d) that no other box shares.

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
            # Equal corners of two boxes get equal bits.
            faces.append((k, side, start + corner * step, start + (corner + 1) * step))
    return faces
