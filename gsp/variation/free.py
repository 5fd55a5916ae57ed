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
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.model.legs import LEGS
from gsp.variation.designs import geometry_of
from gsp.variation.quantities import OUTWARD, ROW_REST, ROW_SLOPES

# A radius and its excess.
Point = tuple[Array, Array]
# Poses that are worked on at once: their arrays fit in the cache.
POSES_IN_CACHE = 512
# Rounding of products of rows and T, relative to ‖J‖ ‖T‖, and of results: see `docs/proofs.md`.
PRODUCT_ROUNDING = 2.0**-40
# Largest radius, in lengths L: beyond, turns count several times.
LARGEST_FREE_RADIUS = 1e6
# Steps of the search for the radius, and its relative width at which it ends.
RADIUS_STEPS, RADIUS_WIDTH = 80, 2e-14


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
        _radii(design, position[i : i + POSES_IN_CACHE], rotation[i : i + POSES_IN_CACHE], length)
        for i in range(0, len(position), POSES_IN_CACHE)
    ]
    return np.concatenate([np.zeros(0), *parts])


def _radii(design: Design, position: Array, rotation: Array, length: float) -> Array:
    poses = _Poses(
        # Copies can be written to: numba compiles again for arrays that cannot.
        position=np.array(position, order="C"),
        rotation=np.array(rotation, order="C"),
        length=length,
        kinds=np.array([LEGS.index(leg) for leg in design.legs], dtype=np.int64),
        geometry=geometry_of(design).ravel(),
        n_rows=len(design.joint_names),
    )
    with np.errstate(all="ignore"):
        centre, slopes = poses.rows()
        known = np.isfinite(centre).all(axis=(1, 2))
        inverse, least = _preconditioner(np.where(known.reshape(-1, 1, 1), centre, 0.0))
        known &= least > 0.0

        size = _size(inverse)
        slope = _slope(slopes, inverse) / length
        slope = np.where(np.isfinite(slope), slope, 0.0) * OUTWARD

        def excess(radius: Array) -> Array:
            bound = slope * radius + poses.rest(radius) * size * OUTWARD
            return np.where(np.isfinite(bound), bound - least, np.inf)

        most = np.minimum(least / slope, LARGEST_FREE_RADIUS * length) * OUTWARD
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
    fine = values[:, -1] > PRODUCT_ROUNDING * values[:, 0]
    # T may be any matrix: how far (J T)ᵀ J T is from I is measured below, so an inaccurate SVD
    # makes the bound smaller, not wrong.
    inverse = right.swapaxes(-1, -2) / np.where(fine, values.T, 1.0).T[:, None, :]
    product = rows @ inverse
    off = (product.swapaxes(-1, -2) @ product - np.eye(6)).reshape(len(rows), -1)
    eta = norm(off) + PRODUCT_ROUNDING * _size(rows) * _size(inverse)
    return inverse, np.where(fine, np.sqrt(np.maximum(1.0 - eta, 0.0)), 0.0)


def _size(matrices: Array) -> Array:
    """Frobenius norms, (n,)."""
    return norm(matrices.reshape(len(matrices), -1))


@dataclass(frozen=True, eq=False, kw_only=True)
class _Poses:
    """A design at n poses, as compiled code takes them."""

    position: Array
    rotation: Array
    length: float
    kinds: NDArray[np.int64]
    geometry: Array
    n_rows: int

    def rows(self) -> tuple[Array, Array]:
        """Rows (n, m, 6), and their derivatives (n, 6, m, 6) for displacements by the length."""
        n = len(self.position)
        found = np.empty((n, self.n_rows, ROW_REST))
        self._fill(np.full(n, self.length), found)
        slopes = found[..., ROW_SLOPES:].reshape(n, -1, 6, 6).swapaxes(1, 2)
        return found[..., :ROW_SLOPES], slopes

    def rest(self, radius: Array) -> Array:
        """Norms of the rests of the rows on balls, (n,)."""
        return self._fill(radius, np.empty((0, 0, 0)))

    def _fill(self, radius: Array, found: Array) -> Array:
        from gsp.variation.balls import rows_on_balls  # compiled code loads on first use

        rests = np.empty(len(radius))
        where = self.position, self.rotation, radius, self.length
        rows_on_balls(*where, self.kinds, self.geometry, found, rests)
        return rests


def _root(excess: Callable[[Array], Array], most: Array, least: Array) -> Array:
    """Return the largest radii with excess < 0 that a search finds in (0, most).

    The excess is −least at 0 and grows. Interpolation after Chandrupatla, by a parabola where that
    is safe, else halving.
    """
    low, below = np.zeros_like(most), -least
    high, above = most, excess(most)
    last, share = high, np.full_like(most, 0.5)
    after = above
    for _ in range(RADIUS_STEPS):
        middle = low + share * (high - low)
        value = excess(middle)
        inside = value < 0.0
        last, after = np.where(inside, low, high), np.where(inside, below, above)
        low, below = np.where(inside, middle, low), np.where(inside, value, below)
        high, above = np.where(inside, high, middle), np.where(inside, above, value)
        if ((high - low) <= RADIUS_WIDTH * high).all():
            break
        share = _share((low, below), (high, above), (last, after))
    return low


def _share(low: Point, high: Point, last: Point) -> Array:
    """Where the parabola of the radius through three excesses has its zero, in shares of a gap."""
    (a, f), (b, g), (c, h) = low, high, last
    zero = f * g / (f - h) / (g - h) * c
    share = (zero + f * h / (f - g) / (h - g) * b + g * h / (g - f) / (h - f) * a - a) / (b - a)
    # Away from both ends, so that either end moves soon.
    edge = 0.5 * RADIUS_WIDTH * b / (b - a)
    fine = np.isfinite(share) & (share > 0.0) & (share < 1.0)
    return np.where(fine, np.clip(share, edge, 1.0 - edge), 0.5)
