"""Parts of undecided cells that are proven inside or outside, each beyond a plane.

The cuts of a cell are eight numbers: n and c of the part n · δ ≤ c that is outside, and n and c of
the part n · δ ≥ c that is inside, with δ from the middle of the cell. c is infinite for no part.
"""

from __future__ import annotations

from itertools import product
from math import factorial

import numpy as np

from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes

# Coordinates that move a plane by less than this share of what another does are bounded, not
# integrated: the closed form of the volume divides by them.
BOUNDED_SLOPE_SHARE = 1e-3
# Shares of cells are made smaller by this, for the rounding of that form.
SHARE_ROUNDING = 1e-9


def no_cuts(n: int) -> Array:
    """Return the cuts of n cells without known parts, shape (n, 8)."""
    cuts = np.zeros((n, 8))
    cuts[:, 3], cuts[:, 7] = -np.inf, np.inf
    return cuts


def shares(low: Array, high: Array, cuts: Array) -> tuple[Array, Array]:
    """Return the shares of cells (n, d) that are proven inside and outside, at least: (n,) each."""
    half = 0.5 * (high - low)
    d = low.shape[1]
    inside = _beyond(-cuts[:, 4 : 4 + d], -cuts[:, 7], half)
    return inside, _beyond(cuts[:, :d], cuts[:, 3], half)


def _beyond(normal: Array, c: Array, half: Array) -> Array:
    """Return the share of boxes |δ_k| ≤ half_k with n · δ ≤ c, at least."""
    result = np.zeros(len(normal))
    wide = np.abs(normal) * half
    long = wide > BOUNDED_SLOPE_SHARE * wide.max(axis=1, initial=0.0, keepdims=True)
    c = c - np.where(long, 0.0, wide).sum(axis=1)
    for kept in product((False, True), repeat=normal.shape[1]):
        some = (long == kept).all(axis=1) & (c > -np.inf)
        if any(kept) and some.any():
            result[some] = _corner_sum(2.0 * wide[some][:, kept], c[some])
    return np.clip(result - SHARE_ROUNDING, 0.0, 1.0)


def _corner_sum(side: Array, c: Array) -> Array:
    """Share of the unit cube with Σ side_k (x_k − ½) ≤ c: alternating powers over its corners."""
    d = side.shape[1]
    start = np.minimum(c + 0.5 * side.sum(axis=1), side.sum(axis=1))
    total = np.zeros(len(c))
    for corner in product((0, 1), repeat=d):
        sign = (-1) ** sum(corner)
        total += sign * np.maximum(0.0, start - side @ np.array(corner)) ** d
    return np.asarray(total / (factorial(d) * side.prod(axis=1)))


def boxes_beyond(low: Array, high: Array, plane: Array) -> tuple[Array, Array]:
    """Return the least boxes that contain the parts n · δ ≥ c of boxes (n, d), d = 2 or 3.

    They are wider by the rounding of the sums. Where there is no part they have no width along
    some axis.
    """
    n, c = plane[:, : low.shape[1]], plane[:, 3:]
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    spans = np.abs(n) * half
    total = spans.sum(axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        # What the other coordinates leave for n_k δ_k.
        least = (c - (total - spans) - 1e-12 * (np.abs(c) + total)) / np.abs(n)
    # It is not finite without a plane, and along it.
    least = np.where(np.isfinite(least), least, -half)
    first = np.where(n > 0.0, np.clip(middle + least, low, high), low)
    return first, np.where(n < 0.0, np.clip(middle - least, low, high), high)


def undecided_boxes(low: Array, high: Array, cuts: Array) -> tuple[Array, Array]:
    """Return the least boxes that contain what neither cut of cells (n, d) decides.

    They are least for one cut; for two they are so along each axis as far as one cut after the
    other shows it. Where nothing is left they have no width along some axis.
    """
    planes = np.stack((cuts[:, :4], -cuts[:, 4:]))
    middle = 0.5 * (low + high)
    first, last = low, high
    for plane in (*planes, *planes):  # twice, as each cut may leave less for the other one
        here = plane.copy()
        shift = 0.5 * (first + last) - middle
        here[:, 3] -= (plane[:, : low.shape[1]] * shift).sum(axis=1)
        first, last = boxes_beyond(first, last, here)
    return first, last


def sides(points: Array, low: Array, high: Array, cuts: Array) -> Codes:
    """Return the codes of points in the cuts of their cells: 1 inside, −1 outside, else 0."""
    d = points.shape[1]
    delta = points - 0.5 * (low + high)
    scale = np.abs(low) + np.abs(high)

    def beyond(normal: Array, c: Array) -> Array:
        slack = 1e-14 * (np.abs(normal) * scale).sum(axis=1)
        return np.asarray((normal * delta).sum(axis=1) + slack <= c)

    outside = beyond(cuts[:, :d], cuts[:, 3])
    inside = beyond(-cuts[:, 4 : 4 + d], -cuts[:, 7])
    return np.where(outside, OUTSIDE, np.where(inside, INSIDE, UNDECIDED)).astype(np.int8)


def moved(cuts: Array, shift: Array) -> Array:
    """Return cuts of cells (n, 3) whose middles are moved by `shift`, for the same planes."""
    result = cuts.copy()
    result[:, 3] -= (cuts[:, :3] * shift).sum(axis=1)
    result[:, 7] -= (cuts[:, 4:7] * shift).sum(axis=1)
    return result


def decided(low: Array, high: Array, cuts: Array) -> Codes:
    """Return the codes of cells (n, 3) of which all is in one cut; the others are undecided."""
    half = 0.5 * (high - low)
    slack = 1e-14 * (np.abs(low) + np.abs(high) + half)
    reach = half + slack
    outside = (np.abs(cuts[:, :3]) * reach).sum(axis=1) <= cuts[:, 3]
    inside = (np.abs(cuts[:, 4:7]) * reach).sum(axis=1) <= -cuts[:, 7]
    return np.where(outside, OUTSIDE, np.where(inside, INSIDE, UNDECIDED)).astype(np.int8)
