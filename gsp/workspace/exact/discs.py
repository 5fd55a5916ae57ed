"""Plane regions bounded by circles: arcs and areas, for many planes at once.

A region is the intersection of discs (side 1) with the outsides of discs (side 0). Its boundary
is made of arcs between the points where circles cross, so nothing is approximated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp.geometry.vectors import Array, Mask

FULL_TURN = 2.0 * np.pi  # rad
# Circles whose centers and radii differ by less [share of the largest radius] are the same circle.
CIRCLE_TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class Circles:
    """n circles in each of Z planes.

    Attributes
    ----------
    center : (Z, n, 2) array
    radius : (Z, n) array
        NaN where the sphere misses the plane.
    side : (n,) array
        1: the region lies inside; 0: outside.
    """

    center: Array
    radius: Array
    side: Array

    @property
    def empty(self) -> Mask:
        """Whether a plane misses a ball that the region lies in: shape (Z,)."""
        return np.asarray((np.isnan(self.radius) & (self.side == 1)).any(axis=1))

    def contains(self, point: Array, but: Mask | None = None) -> Mask:
        """Whether points (Z, q, 2) lie in the region; circle `but` (q,) of each is not asked."""
        gap = np.linalg.norm(point[:, :, None] - self.center[:, None], axis=-1)
        excess = (gap - self.radius[:, None]) * np.where(self.side == 1, 1.0, -1.0)
        fine = ~(excess > 0.0)
        if but is not None:
            fine |= but
        return np.asarray(fine.all(axis=-1) & ~self.empty[:, None])


@dataclass(frozen=True, eq=False)
class Arcs:
    """Candidate arcs: per plane, circle and place, the angles, and which bound the region."""

    start: Array
    stop: Array
    real: Mask


def arcs(circles: Circles) -> Arcs:
    """Return the arcs of all circles, shape (Z, n, 2 n), and which of them bound the region."""
    crossing = _crossings(circles)
    number = crossing.shape[-1]
    none = np.isnan(crossing).all(axis=-1)
    crossing[..., 0] = np.where(none, 0.0, crossing[..., 0])
    ordered = np.sort(crossing, axis=-1)  # NaN last
    known = (~np.isnan(ordered)).sum(axis=-1)
    following = np.roll(ordered, -1, axis=-1)
    last = np.arange(number) == known[..., None] - 1
    following = np.where(last, ordered[..., :1] + FULL_TURN, following)
    middle = 0.5 * (ordered + following)
    reach = circles.radius[..., None, None] * np.stack((np.cos(middle), np.sin(middle)), axis=-1)
    z, n = circles.radius.shape
    points = (circles.center[:, :, None] + reach).reshape(z, n * number, 2)
    own = np.repeat(np.eye(n, dtype=bool), number, axis=0)
    inside = circles.contains(np.nan_to_num(points), own).reshape(z, n, number)
    real = inside & ~np.isnan(middle) & ~np.isnan(circles.radius)[..., None] & _unrepeated(circles)
    return Arcs(ordered, following, np.asarray(real & (following > ordered)))


def areas(circles: Circles) -> Array:
    """Areas of the regions, by Green's theorem over their arcs: shape (Z,)."""
    found = arcs(circles)
    x, y, r = circles.center[..., :1], circles.center[..., 1:], circles.radius[..., None]
    a, b = found.start, found.stop
    with np.errstate(invalid="ignore"):
        piece = r * r * (b - a) + r * x * (np.sin(b) - np.sin(a)) - r * y * (np.cos(b) - np.cos(a))
    sign = np.where(circles.side == 1, 0.5, -0.5)[:, None]
    return np.asarray(np.where(found.real, sign * piece, 0.0).sum(axis=(1, 2)))


def _crossings(circles: Circles) -> Array:
    """Angles in [0, 2π) on each circle where the others cross it: (Z, n, 2 n), NaN for none."""
    c, r = circles.center, circles.radius
    offset = c[:, None] - c[:, :, None]
    gap = np.linalg.norm(offset, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = (gap**2 + r[:, :, None] ** 2 - r[:, None] ** 2) / (2.0 * gap * r[:, :, None])
        half = np.where(np.abs(cosine) < 1.0, np.arccos(np.clip(cosine, -1.0, 1.0)), np.nan)
    heading = np.arctan2(offset[..., 1], offset[..., 0])
    return np.concatenate((heading - half, heading + half), axis=-1) % FULL_TURN


def _unrepeated(circles: Circles) -> Mask:
    """Whether no earlier circle of the same side is the same one: (Z, n, 1)."""
    c, r = circles.center, circles.radius
    size = np.nanmax(np.where(np.isnan(r), 0.0, r)) + 1e-300
    same = np.linalg.norm(c[:, None] - c[:, :, None], axis=-1) < CIRCLE_TOLERANCE * size
    with np.errstate(invalid="ignore"):
        same &= np.abs(r[:, None] - r[:, :, None]) < CIRCLE_TOLERANCE * size
    same &= circles.side[:, None] == circles.side
    return np.asarray(~np.tril(same, -1).any(axis=-1)[..., None])
