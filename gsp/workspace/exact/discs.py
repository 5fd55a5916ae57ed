"""Plane regions bounded by circles: arcs and areas, for many planes at once.

A region is the intersection of discs (side 1) with the outsides of discs (side 0). Its boundary
is made of arcs between the points where circles cross, so nothing is approximated.

Symmetric designs have circles that touch, are concentric, or are the same up to rounding. So
each relation of a pair of circles is decided once, and both circles use the result: whether
they are the same, whether they cross, and where. Outlines then close in spite of rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp.geometry.copies import kept_property
from gsp.geometry.vectors import Array, Mask
from gsp.workspace.exact.spheres import SAME_TOLERANCE, common_chord

FULL_TURN = 2.0 * np.pi  # rad
# Circles whose common chord is shorter [share of the smaller radius] touch, but do not cross: half
# the digits of a chord are lost where circles touch up to rounding.
SHORTEST_CHORD = 1e-7


@dataclass(frozen=True, eq=False)
class Circles:
    """n circles in each of Z planes.

    Attributes
    ----------
    centre : (Z, n, 2) array [length]
    radius : (Z, n) array [length]
        NaN where the sphere misses the plane.
    side : (n,) array
        1: the region lies inside; 0: outside.
    """

    centre: Array
    radius: Array
    side: Array

    @kept_property
    def gap(self) -> Array:
        """Distances of the centres, shape (Z, n, n)."""
        return np.asarray(np.linalg.norm(self.centre[:, None] - self.centre[:, :, None], axis=-1))

    @kept_property
    def same(self) -> Mask:
        """Whether two circles are the same within SAME_TOLERANCE: shape (Z, n, n)."""
        r = self.radius
        slack = SAME_TOLERANCE * np.fmax.reduce(r, axis=1, initial=0.0)[:, None, None]
        with np.errstate(invalid="ignore"):
            return np.asarray(self.gap + np.abs(r[:, None] - r[:, :, None]) <= slack)

    @property
    def bounding(self) -> Mask:
        """Which circles can bound the region, each of the same ones once: shape (Z, n)."""
        alike = self.same & (self.side[:, None] == self.side)
        return np.asarray(~np.isnan(self.radius) & ~np.tril(alike, -1).any(axis=-1))

    @property
    def empty(self) -> Mask:
        """Whether a plane misses a ball, or lies in and out of the same circle: shape (Z,)."""
        opposite = self.same & (self.side[:, None] != self.side)
        missed = (np.isnan(self.radius) & (self.side == 1)).any(axis=1)
        return np.asarray(missed | opposite.any(axis=(1, 2)))


@dataclass(frozen=True, eq=False)
class Arcs:
    """Candidate arcs: per plane, circle and place, the angles, and which bound the region."""

    start: Array
    stop: Array
    real: Mask


def arcs(circles: Circles) -> Arcs:
    """Return the arcs of all circles, shape (Z, n, 2 n), and which of them bound the region."""
    low, width, cross = _allowed(circles)
    start = low % FULL_TURN
    stop = start + width
    wraps = cross & (stop > FULL_TURN)
    ends = np.concatenate((start, np.where(wraps, stop - FULL_TURN, stop)), axis=-1)
    ends = np.where(np.tile(cross, 2), ends, np.inf)
    order = np.argsort(ends, axis=-1)
    ordered = np.take_along_axis(ends, order, axis=-1)
    # After each end: how many of the n arcs, that the n circles allow, cover the angle.
    n = low.shape[-1]
    always = ~cross & (width > 0.0)
    step = np.where(order < n, 1, -1) * np.isfinite(ordered)
    cover = (wraps | always).sum(axis=-1, keepdims=True) + np.cumsum(step, axis=-1)
    number = 2 * cross.sum(axis=-1, keepdims=True)
    ordered[..., :1] = np.where(number == 0, 0.0, ordered[..., :1])
    last = np.arange(2 * n) == np.maximum(number, 1) - 1
    following = np.where(last, ordered[..., :1] + FULL_TURN, np.roll(ordered, -1, axis=-1))
    bounding = circles.bounding & ~circles.empty[:, None]
    real = bounding[..., None] & (cover == n) & np.isfinite(ordered) & (following > ordered)
    return Arcs(np.where(real, ordered, 0.0), np.where(real, following, 0.0), real)


def areas(circles: Circles) -> Array:
    """Areas of the regions, by Green's theorem over their arcs: shape (Z,) [length²]."""
    found = arcs(circles)
    x, y, r = circles.centre[..., :1], circles.centre[..., 1:], circles.radius[..., None]
    a, b = found.start, found.stop
    piece = r * r * (b - a) + r * x * (np.sin(b) - np.sin(a)) - r * y * (np.cos(b) - np.cos(a))
    sign = np.where(circles.side == 1, 0.5, -0.5)[:, None]
    return np.asarray(np.where(found.real, sign * piece, 0.0).sum(axis=(1, 2)))


def _allowed(circles: Circles) -> tuple[Array, Array, Mask]:
    """Return the arc of each circle i that circle j allows: (Z, n, n) each.

    First angle [rad], width in [0, 2π] [rad], and whether the two circles cross, so that the arc
    has ends.

    The part of circle i inside disc j is |θ − heading| ≤ φ with tan φ = h / a: a is the distance
    of the common chord from the centre of i, h half its length. For circle j the chord is at
    gap − a. Both read the same a and h, so that both end in the same points.
    """
    c, r, gap = circles.centre, circles.radius, circles.gap
    n = r.shape[-1]
    upper = np.triu(np.ones((n, n), dtype=bool), 1)
    with np.errstate(invalid="ignore", divide="ignore"):
        along, square = common_chord(gap, r[:, :, None], r[:, None])
        along, square = np.where(upper, along, 0.0), np.where(upper, square, 0.0)
        along = np.where(upper, along, gap - np.swapaxes(along, 1, 2))
        square = square + np.swapaxes(square, 1, 2)
        smaller = np.fmin(r[:, :, None], r[:, None])
        cross = square > (SHORTEST_CHORD * smaller) ** 2
        chord = np.sqrt(np.where(cross, square, 0.0))
        half = np.where(cross, np.arctan2(chord, along), np.where(along > 0.0, 0.0, np.pi))
    offset = c[:, None] - c[:, :, None]
    heading = np.arctan2(offset[..., 1], offset[..., 0])
    outside = (circles.side == 0)[None, None, :]
    low = np.where(outside, heading + half, heading - half)
    width = np.where(outside, FULL_TURN - 2.0 * half, 2.0 * half)
    # No bound: the circle itself, its repetitions, and spheres that miss the plane.
    free = np.eye(n, dtype=bool) | np.isnan(r)[:, None, :] | np.isnan(r)[:, :, None]
    free |= circles.same & (circles.side[:, None] == circles.side)
    width = np.where(free, FULL_TURN, width)
    return np.where(free, 0.0, low), width, np.asarray(cross & ~free)
