"""Closed surfaces of triangles: without triangles of no area, and with two at each edge."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array, Mask, cross
from gsp.workspace.sets.codes import Numbers
from gsp.workspace.sets.surfaces.pieces import numbered, numbered_rows


def united(vertices: Array, faces: Numbers, near: float) -> tuple[Array, Numbers]:
    """Return a surface in which vertices that are `near` are one [share of its size].

    Triangles that have a vertex twice then, and pairs of opposite ones, are left out: what is left
    is as closed as before.
    """
    if not len(faces):
        return np.zeros((0, 3)), faces
    size = float(np.ptp(vertices, axis=0).max())
    number = numbered((vertices - vertices.min(axis=0)) / (near * size))
    _, chosen, number = np.unique(number, return_index=True, return_inverse=True)
    faces = number.reshape(-1)[faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    faces = _without_opposites(faces)
    used, faces = np.unique(faces, return_inverse=True)
    return vertices[chosen][used], faces.reshape(-1, 3)


def _without_opposites(faces: Numbers) -> Numbers:
    """Leave out triangles of the same vertices in opposite directions, two and two."""
    which = numbered_rows(np.sort(faces, axis=1))
    count = np.bincount(which)
    if (count == 1).all():
        return faces
    first = faces.argmin(axis=1)
    rows = np.arange(len(faces))
    sign = np.where(faces[rows, (first + 1) % 3] < faces[rows, (first + 2) % 3], 1, -1)
    left = np.bincount(which, sign).astype(np.int64)
    kept = count[which] == 1
    for triangle in np.flatnonzero((count > 1) & (left != 0)):
        some = np.flatnonzero((which == triangle) & (sign == np.sign(left[triangle])))
        kept[some[: abs(left[triangle])]] = True
    return np.asarray(faces[kept])


def manifold(vertices: Array, faces: Numbers, gap: float = 0.0) -> tuple[Array, Numbers]:
    """Return a closed surface in which each edge has two triangles.

    Where more meet in an edge, the surface is divided there: each two between which the solid is
    get a vertex of their own in the middle of the edge. These vertices are moved by `gap` of the
    way to the other corners of their triangles, so that programs which unite equal vertices keep
    them apart.
    """
    start, end = faces, np.roll(faces, -1, axis=1)
    low, high = np.minimum(start, end), np.maximum(start, end)
    _, edge, count = np.unique(
        low * np.int64(len(vertices) + 1) + high, return_inverse=True, return_counts=True
    )
    edge = edge.reshape(-1, 3)
    shared = count[edge] > 2
    if not shared.any():
        return vertices, faces
    face, side = np.nonzero(shared)
    order = np.argsort(edge[face, side], kind="stable")
    face, side = face[order], side[order]
    ends = np.column_stack((low[face, side], high[face, side]))
    third = faces[face, (side + 2) % 3]
    forward = start[face, side] == ends[:, 0]
    groups = np.flatnonzero(np.r_[True, np.diff(edge[face, side]) != 0])
    pair = np.concatenate(
        [
            first + _paired(vertices, ends[first], third[first:last], forward[first:last])
            for first, last in zip(groups, np.append(groups[1:], len(face)), strict=True)
        ]
    )
    # A pair is numbered by the first of it.
    numbers, which = np.unique(np.minimum(pair, np.arange(len(pair))), return_inverse=True)
    middles = vertices[ends[numbers]].mean(axis=1)
    inward = 0.5 * (vertices[third[numbers]] + vertices[third[pair[numbers]]]) - middles
    middle = np.full(faces.shape, -1)
    middle[face, side] = len(vertices) + which
    return np.concatenate((vertices, middles + gap * inward)), _divided(faces, middle)


def _paired(vertices: Array, ends: Numbers, third: Numbers, forward: Mask) -> Numbers:
    """Return the partner of each triangle at an edge: the solid is between the two."""
    a, b = vertices[ends]
    along = (b - a) / np.linalg.norm(b - a)
    away = vertices[third] - a
    away = away - (away @ along)[:, None] * along
    first = away[np.argmax(np.einsum("ij,ij->i", away, away))]
    angle = np.arctan2(away @ cross(along, first), away @ first)
    order = np.argsort(angle, kind="stable")
    # From outside they are counterclockwise: with growing angles the solid begins at those that
    # run backward along the edge, and ends at the others. Twice around, as it may begin anywhere.
    partner = np.full(len(third), -1)
    opened: list[int] = []
    for i in (*order, *order):
        if partner[i] >= 0 or i in opened:
            continue
        if not forward[i]:
            opened.append(i)
        elif opened:
            j = opened.pop()
            partner[i], partner[j] = j, i
    return partner


def _divided(faces: Numbers, middle: Numbers) -> Numbers:
    """Divide triangles at new vertices on their sides (n, 3), −1 for none."""
    for side in range(3):
        some = middle[:, side] >= 0
        a, b, c = (faces[some, (side + k) % 3] for k in range(3))
        m, p, q = (middle[some, (side + k) % 3] for k in range(3))
        none = np.full(some.sum(), -1)
        halves = [np.column_stack(x) for x in ((m, b, c), (a, m, c))]
        # One half keeps the side after, the other the side before.
        sides = [np.column_stack(x) for x in ((none, p, none), (none, none, q))]
        # Corners stay at their places in a triangle.
        faces = np.concatenate((faces[~some], *(np.roll(x, side, axis=1) for x in halves)))
        middle = np.concatenate((middle[~some], *(np.roll(x, side, axis=1) for x in sides)))
    return faces
