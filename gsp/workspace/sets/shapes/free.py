"""The faces of boxes that no other box shares."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array


def outer_faces(low: Array, high: Array) -> tuple[Array, Array]:
    """Return the faces between boxes (n, d) and what is in none, as boxes of no width."""
    lows, highs = [np.zeros((0, low.shape[1]))], [np.zeros((0, low.shape[1]))]
    for k, side, a, b in _free_faces(low, high):
        near, far = a.copy(), b.copy()
        near[:, k] = far[:, k] = (b if side else a)[:, k]
        lows.append(near)
        highs.append(far)
    return np.concatenate(lows), np.concatenate(highs)


def _free_faces(low: Array, high: Array) -> list[tuple[int, int, Array, Array]]:
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
