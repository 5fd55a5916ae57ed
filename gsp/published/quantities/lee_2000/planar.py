"""The planar manipulator of chapter 1 of `Lee2000`: three lines in a plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gsp.geometry.vectors import Array, cross, dot
from gsp.planar.pose import PlanarPose

# Turns closer to zero are the central location.
ZERO_ANGLE = 1e-9
STARTS = 64
SEARCH_ROUNDS = 400


def planar_maximum(l1: float, l2: float, l3: float) -> float:
    """Largest |det J| of three lines in a plane through the corners of a triangle of these sides.

    Each line in turn is turned to its best direction, from many directions to begin with.
    """
    x = (l1 * l1 + l2 * l2 - l3 * l3) / (2.0 * l1)
    corners = np.array([[0.0, 0.0], [l1, 0.0], [x, np.sqrt(l2 * l2 - x * x)]])
    angles = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (STARTS, 3))
    lines = np.stack((np.cos(angles), np.sin(angles)), axis=-1)
    for _ in range(SEARCH_ROUNDS):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            others = cross(_ray(corners[j], lines[:, j]), _ray(corners[k], lines[:, k]))
            x, y = corners[i]
            best = np.stack(
                (others[:, 0] - y * others[:, 2], others[:, 1] + x * others[:, 2]), axis=-1
            )
            lines[:, i] = best / np.hypot(*best.T)[:, None]
    rays = [_ray(corners[i], lines[:, i]) for i in range(3)]
    return float(np.abs(dot(rays[0], cross(rays[1], rays[2]))).max())


def _ray(corner: Array, direction: Array) -> Array:
    moment = corner[..., 0] * direction[..., 1] - corner[..., 1] * direction[..., 0]
    return np.concatenate((direction, moment[..., None]), axis=-1)


def planar_determinant(
    side: float,
    shares: Sequence[float],
    x: float = 0.0,
    y: float = 0.0,
    theta: float = 0.0,
) -> float:
    """|det J| of the equilateral platform of figure 1, moved from its central location.

    Its base points lie on the sides of the larger triangle, each at a share of its own side from
    the corner of the platform that it is joined with.
    """
    angle = np.deg2rad([90.0, 210.0, 330.0])
    corners = side / np.sqrt(3.0) * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    along = np.stack((-np.sin(angle), np.cos(angle)), axis=1)
    base = corners + side * np.asarray(shares)[:, None] * along
    top = corners @ PlanarPose([x, y], theta).rotation.T + [x, y]
    leg = top - base
    return float(abs(np.linalg.det(_ray(base, leg / np.hypot(*leg.T)[:, None]))))


def planar_best_poses(side: float, shares: Sequence[float]) -> int:
    """Return how many poses of the platform of figure 1 have |det J| = 3/2 of its side.

    The lines of the legs are then the sides of the larger triangle, turned with the platform; they
    pass through the base points at θ = 0 and where tan(θ/2) = Σ shares / √3.
    """
    angle = np.deg2rad([90.0, 210.0, 330.0])
    radius = side / np.sqrt(3.0)
    base = radius * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    base += side * np.asarray(shares)[:, None] * np.stack((-np.sin(angle), np.cos(angle)), axis=1)
    other = 2.0 * np.arctan(sum(shares) / np.sqrt(3.0))
    found = []
    for theta in (0.0, other) if abs(other) > ZERO_ANGLE else (0.0,):
        outward = np.stack((np.cos(angle + theta), np.sin(angle + theta)), axis=1)
        x, y = np.linalg.lstsq(outward, dot(base, outward) - radius, rcond=None)[0]
        found.append(planar_determinant(side, shares, x, y, theta))
    return sum(abs(value - 1.5 * side) < 1e-9 * side for value in found)


QUANTITIES = (planar_maximum, planar_determinant, planar_best_poses)
