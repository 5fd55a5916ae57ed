"""Coordinates of anchors in frames that the anchors themselves define."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp.determinant.domain import Neighbourhood
from gsp.geometry.vectors import Array, cross, dot, norm, perpendicular, unit
from gsp.model.design import Design

# An axis of a frame is the first vector that is longer than this share of the longest one. No
# ratio of simple dimensions is near to it, so that rounding does not decide which is the first.
LONG_SHARE = 0.0810259
# Vectors shorter than this share of the size give no axis: points in one place, or in a line.
SHORT_SHARE = 1e-8


@dataclass(frozen=True, eq=False)
class Framed:
    """Coordinates (m, n, 6) of points and directions, and the frames (m, 3, 4)."""

    rows: Array
    frames: Array


def framed(points: Array, directions: Array, orders: Array, length: float) -> Framed:
    """Coordinates of a body in the frame of the first vectors that span it, for every order."""
    centre = points.mean(axis=0)
    arms = ((points - centre) / length)[orders]
    lines = np.nan_to_num(directions)[orders]
    axes = _axes(np.concatenate((arms, lines), axis=1))
    return Framed(np.concatenate((arms @ axes, lines @ axes), axis=-1), _frames(axes, centre))


def together(
    side: Design, region: Neighbourhood, exchanged: bool, orders: Array, length: float
) -> tuple[Framed, Framed]:
    """Coordinates of both bodies at home in one frame at the centre of a neighbourhood."""
    home = region.home.inverse() if exchanged else region.home
    centre = region.centre
    if exchanged:
        centre = region.home.rotation.T @ (centre - region.home.position)
    points = np.stack((side.base_points, side.platform_points @ home.rotation.T + home.position))
    lines = np.stack((side.base_directions, side.platform_directions @ home.rotation.T))
    arms, lines = ((points - centre) / length)[:, orders], np.nan_to_num(lines)[:, orders]
    axes = _axes(np.concatenate((*arms, *lines), axis=1))
    inner = home.rotation.T @ (centre - home.position)
    frames = (_frames(axes, centre), _frames(home.rotation.T @ axes, inner))
    low, high = (
        Framed(np.concatenate((arms[i] @ axes, lines[i] @ axes), axis=-1), frames[i])
        for i in range(2)
    )
    return low, high


def _axes(vectors: Array) -> Array:
    """Return right-handed axes (m, 3, 3), as columns, from the first long vectors of (m, k, 3)."""
    x = _first(vectors)
    x = np.where(norm(x)[:, None] > 0.0, x, np.eye(3)[0])
    y = _first(vectors - dot(vectors, x[:, None, :])[..., None] * x[:, None, :])
    y = np.where(norm(y)[:, None] > 0.0, y, perpendicular(x))
    y = unit(y - dot(y, x)[:, None] * x)
    return np.stack((x, y, cross(x, y)), axis=-1)


def _frames(axes: Array, origin: Array) -> Array:
    shift = np.broadcast_to(origin[:, None], (len(axes), 3, 1))
    return np.concatenate((axes, shift), axis=-1)


def _first(vectors: Array) -> Array:
    """First vector of each list that is long enough, normalised; zero if there is none."""
    lengths = norm(vectors)
    longest = lengths.max(axis=1)
    first = vectors[
        np.arange(len(vectors)), (lengths > LONG_SHARE * longest[:, None]).argmax(axis=1)
    ]
    there = np.asarray(longest > SHORT_SHARE)[:, None]
    return np.where(there, unit(np.where(there, first, 1.0)), 0.0)
