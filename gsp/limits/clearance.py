"""Distances between legs, each taken as a segment from its base foot to its platform foot."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from gsp.geometry.vectors import Array, dot, norm
from gsp.model.design import Design
from gsp.model.posture import Posture

# Squared sine of the angle of two lines [1] up to which rounding decides where they are nearest,
# so that only ends of the segments are compared: an angle of 1e-7.
PARALLEL_SINE_SQUARED = 1e-14


def segment_distance(p: Array, u: Array, q: Array, v: Array) -> Array:
    """Distance of the segments p + [0, 1] u and q + [0, 1] v: (..., 3) to (...).

    The closest points of the lines if they lie on both segments, else the best of the four
    distances from an end to the other segment.
    """
    w = p - q
    a, b, c, d, e = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    n = a * c - b * b
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = (b * e - c * d) / n, (a * e - b * d) / n
    crossing = (
        (n > PARALLEL_SINE_SQUARED * a * c) & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    )
    s, t = np.where(crossing, s, 0.0), np.where(crossing, t, 0.0)
    middle = np.where(crossing, norm(w + s[..., None] * u - t[..., None] * v), np.inf)
    ends = (
        _to_segment(p, q, v),
        _to_segment(p + u, q, v),
        _to_segment(q, p, u),
        _to_segment(q + v, p, u),
    )
    return np.asarray(np.minimum.reduce([middle, *ends]))


def _to_segment(point: Array, start: Array, along: Array) -> Array:
    square = dot(along, along)
    share = dot(point - start, along) / np.where(square > 0.0, square, 1.0)
    return norm(point - start - np.clip(share, 0.0, 1.0)[..., None] * along)


def leg_pairs(design: Design) -> tuple[tuple[int, int], ...]:
    """Pairs of legs that can collide: those that do not meet in a common anchor point."""
    return tuple(
        (i, j) for i, j in combinations(range(design.n_legs), 2) if not _common_anchor(design, i, j)
    )


def _common_anchor(design: Design, i: int, j: int) -> bool:
    return bool(
        (design.base_points[i] == design.base_points[j]).all()
        or (design.platform_points[i] == design.platform_points[j]).all()
    )


def clearances(posture: Posture, pairs: tuple[tuple[int, int], ...]) -> Array:
    """Distances between the segments of pairs of legs, shape (..., number of pairs)."""
    start = posture.segments.base_feet
    along = posture.segments.along
    one, two = [i for i, _ in pairs], [j for _, j in pairs]
    return segment_distance(
        start[..., one, :], along[..., one, :], start[..., two, :], along[..., two, :]
    )
