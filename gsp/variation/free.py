"""Balls of poses around a pose that are proven to have no singular pose.

The distance of two poses is sqrt(|p − p′|² + (L θ)²). A pose at a distance ≤ r is reached by a path
with constant velocities, |p′|² + (L |ω|)² ≤ r². On it the rows are those of a patch, whose jets
bound J(x) T = Q + D: T is the inverse of the triangle of J, and Q is orthonormal to rounding. With
the derivatives D_k for displacements and turns by r, and rests E,

    ‖D‖ ≤ G(r) = sqrt(λ_max(⟨D_k, D_l⟩)) + ‖E‖ ‖T‖,

as the coordinates are within a ball, too. No pose with G(r) < sqrt(1 − ‖QᵀQ − I‖) is singular.
Nothing depends on the axes. See `docs/proofs.md`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from gsp.geometry.scalars import components
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.model.legs import LEGS
from gsp.variation.designs import geometry_of
from gsp.variation.legs import KINDS, Patch
from gsp.variation.quantities import ROW_REST, ROW_SLOPES, row_scalars

# A radius and its excess.
Point = tuple[Array, Array]
# Poses that are worked on at once: their arrays fit in the cache.
POSES_AT_ONCE = 512
# Rounding of products of rows and T, relative to ‖J‖ ‖T‖, and of results: see `docs/proofs.md`.
PRODUCT, OUTWARD = 2.0**-40, 1.0 + 2.0**-30
# Largest radius, in lengths L: beyond, turns count several times.
FARTHEST = 1e6
# Steps of the search for the radius, and its relative width at which it ends.
STEPS, WIDTH = 80, 2e-14


def free_radii(design: Design, position: Array, rotation: Array, length: float) -> Array:
    """Return radii of balls without singular or undefined poses; 0 where nothing is proven.

    Parameters
    ----------
    design : Design
    position : (n, 3) array [length]
    rotation : (n, 3, 3) array
    length : float [length]
        L, which turns angles into displacements.

    Returns
    -------
    (n,) array [length]
    """
    parts = [
        _radii(design, position[i : i + POSES_AT_ONCE], rotation[i : i + POSES_AT_ONCE], length)
        for i in range(0, len(position), POSES_AT_ONCE)
    ]
    return np.concatenate([np.zeros(0), *parts])


def _radii(design: Design, position: Array, rotation: Array, length: float) -> Array:
    with np.errstate(all="ignore"):
        one = np.full(len(position), length)
        centre = _rows(design, position, rotation, length, 0.0 * one)[0]
        known = np.isfinite(centre).all(axis=(1, 2))
        inverse, least = _preconditioner(np.where(known.reshape(-1, 1, 1), centre, 0.0))
        known &= least > 0.0

        size = _size(inverse)
        slope = _slope(_rows(design, position, rotation, length, one)[1], inverse) / length
        slope = np.where(np.isfinite(slope), slope, 0.0) * OUTWARD

        def excess(radius: Array) -> Array:
            rest = _rest(design, position, rotation, length, radius)
            bound = slope * radius + rest * size * OUTWARD
            return np.where(np.isfinite(bound), bound - least, np.inf)

        most = np.minimum(least / slope, FARTHEST * length) * OUTWARD
        radius = _root(excess, np.where(known, most, 1.0), least)
    return np.where(known, radius, 0.0)


def _slope(slopes: Array, inverse: Array) -> Array:
    """Bounds of ‖D‖ over the unit ball of coordinates, for their derivatives (n, 6, m, 6)."""
    n = len(slopes)
    turned = (slopes @ inverse[:, None]).reshape(n, 6, -1)
    gram = turned @ turned.swapaxes(-1, -2)
    fine = np.isfinite(gram).all(axis=(1, 2))
    most = np.linalg.eigvalsh(np.where(fine.reshape(-1, 1, 1), gram, 0.0))[:, -1]
    return np.where(fine, np.sqrt(np.maximum(most, 0.0)), np.inf)


def _preconditioner(rows: Array) -> tuple[Array, Array]:
    """Return T (n, 6, 6), and lower bounds of the least singular value of J T, (n,)."""
    _, values, right = np.linalg.svd(rows, full_matrices=False)
    fine = values[:, -1] > PRODUCT * values[:, 0]
    inverse = right.swapaxes(-1, -2) / np.where(fine, values.T, 1.0).T[:, None, :]
    product = rows @ inverse
    off = (product.swapaxes(-1, -2) @ product - np.eye(6)).reshape(len(rows), -1)
    eta = norm(off) + PRODUCT * _size(rows) * _size(inverse)
    return inverse, np.where(fine, np.sqrt(np.maximum(1.0 - eta, 0.0)), 0.0)


def _size(matrices: Array) -> Array:
    """Frobenius norms, (n,)."""
    return norm(matrices.reshape(len(matrices), -1))


def _rows(
    design: Design, position: Array, rotation: Array, length: float, radius: Array
) -> tuple[Array, Array]:
    """Rows (n, m, 6) at poses, and their derivatives (n, 6, m, 6) times radii."""
    n = len(position)
    found = _scalars(design, position, rotation, length, radius, slice(0, ROW_REST))
    rows = np.concatenate([np.stack(row, axis=-1) for row in found]).swapaxes(0, 1)
    slopes = rows[..., ROW_SLOPES:].reshape(n, -1, 6, 6).swapaxes(1, 2)
    return rows[..., :ROW_SLOPES], slopes


def _rest(design: Design, position: Array, rotation: Array, length: float, radius: Array) -> Array:
    """Norms of the rests of the rows on balls, (n,)."""
    found = _scalars(design, position, rotation, length, radius, slice(ROW_REST, ROW_REST + 1))
    return norm(np.concatenate([row[0] for row in found]).T)


def _scalars(
    design: Design, position: Array, rotation: Array, length: float, radius: Array, some: slice
) -> list[list[Array]]:
    """Return some of the scalars of the rows of each kind of leg, (legs, n) each."""
    zero = np.zeros(len(position))
    p, r = components(position), components(rotation.reshape(-1, 9))
    angle = radius / length
    turns = [angle if i == k else zero for k in range(3) for i in range(3)]
    size = norm(position)
    patch = Patch.of([*p, *r, *[radius] * 3, *turns, radius, zero, angle, zero, size])
    geometry, found = geometry_of(design), []
    for kind in LEGS:
        legs = np.array([i for i, leg in enumerate(design.legs) if leg is kind], dtype=np.int64)
        if not legs.size:
            continue
        each: list[Any] = list(geometry[legs].T[..., None])
        segment = KINDS[kind.name].segment(patch, each)
        for row in KINDS[kind.name].rows:
            scalars = row_scalars(row(segment, 1.0 / length))[some]
            found.append([np.broadcast_to(x, (len(legs), len(zero))) for x in scalars])
    return found


def _root(excess: Callable[[Array], Array], most: Array, least: Array) -> Array:
    """Return the largest radii with excess < 0 that a search finds in (0, most).

    The excess is −least at 0 and grows. Interpolation after Chandrupatla, by a parabola where that
    is safe, else halving.
    """
    low, below = np.zeros_like(most), -least
    high, above = most, excess(most)
    last, share = high, np.full_like(most, 0.5)
    after = above
    for _ in range(STEPS):
        middle = low + share * (high - low)
        value = excess(middle)
        inside = value < 0.0
        last, after = np.where(inside, low, high), np.where(inside, below, above)
        low, below = np.where(inside, middle, low), np.where(inside, value, below)
        high, above = np.where(inside, high, middle), np.where(inside, above, value)
        if ((high - low) <= WIDTH * high).all():
            break
        share = _share((low, below), (high, above), (last, after))
    return low


def _share(low: Point, high: Point, last: Point) -> Array:
    """Where the parabola of the radius through three excesses has its zero, in shares of a gap."""
    (a, f), (b, g), (c, h) = low, high, last
    zero = f * g / (f - h) / (g - h) * c
    share = (zero + f * h / (f - g) / (h - g) * b + g * h / (g - f) / (h - f) * a - a) / (b - a)
    # Away from both ends, so that either end moves soon.
    edge = 0.5 * WIDTH * b / (b - a)
    fine = np.isfinite(share) & (share > 0.0) & (share < 1.0)
    return np.where(fine, np.clip(share, edge, 1.0 - edge), 0.5)
