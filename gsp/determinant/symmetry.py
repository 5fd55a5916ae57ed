"""Symmetries of designs of D1 legs: poses that are equally good, and poses that map to themselves.

A symmetry moves the base anchors onto each other by an isometry g, and the platform anchors in
the same order by an isometry k; then T and g T k⁻¹ have the same |det J|. Both may be reflections
if both are: a plane base and a plane platform always allow the reflection in both planes.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from gsp.determinant.canonical import MOST_ORDERED_LEGS
from gsp.geometry.matrices import singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import congruences, nearest_rotations
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design

# Distances that agree to this share of the size of the design are the same.
SAME_PLACE = 1e-9
# Singular values of the mean of rotations [1] up to which it is near no single rotation.
LEAST_MEAN = 1e-3


@dataclass(frozen=True, eq=False)
class Symmetry:
    """A symmetry of a design.

    Attributes
    ----------
    legs : tuple of int
        Image of each leg.
    base, platform : (3, 4) arrays
        [Q | shift] of the isometries of base and platform.
    """

    legs: tuple[int, ...]
    base: Array
    platform: Array

    def image(self, position: Array, rotation: Array) -> tuple[Array, Array]:
        """Return the equally good poses of poses (..., 3), (..., 3, 3): g T k⁻¹."""
        g, k = self.base, self.platform
        turned = g[:, :3] @ rotation @ k[:, :3].T
        moved = position @ g[:, :3].T + g[:, 3] - turned @ k[:, 3]
        return moved, turned


def symmetries(design: Design) -> tuple[Symmetry, ...]:
    """Return the symmetries of a design of at most seven D1 legs, the identity first.

    Other designs have their identity only.
    """
    n = design.n_legs
    legs = [tuple(range(n))]
    if not design.between_points:
        legs = []
    elif n <= MOST_ORDERED_LEGS:
        legs = _orders(design)
    found = [
        Symmetry(order, g, k)
        for order in legs
        for g, k in product(
            _isometries(design.base_points, order), _isometries(design.platform_points, order)
        )
        if np.linalg.det(g[:, :3]) * np.linalg.det(k[:, :3]) > 0.0
    ]
    still = np.eye(3, 4)
    identity = Symmetry(tuple(range(n)), still, still)
    others = [
        s for s in found if s.legs != identity.legs or np.abs(s.base - still).max() > SAME_PLACE
    ]
    return (identity, *others)


def _orders(design: Design) -> list[tuple[int, ...]]:
    """Orders of the legs that leave all distances in base and platform as they are."""
    orders = np.array(list(permutations(range(design.n_legs))))
    for points in (design.base_points, design.platform_points):
        apart = norm(points[:, None] - points)
        moved = apart[orders[:, :, None], orders[:, None, :]]
        orders = orders[(np.abs(moved - apart) <= SAME_PLACE * design.rms_radius).all(axis=(1, 2))]
    return [tuple(map(int, order)) for order in orders]


def _isometries(points: Array, order: tuple[int, ...]) -> list[Array]:
    """Isometries [Q | shift] that take points to points[order]: two of them for plane points."""
    middle = points.mean(axis=0)
    arms = points - middle
    images = arms[list(order)]
    result = []
    for q in congruences(arms, images):
        if np.abs(arms @ q.T - images).max() <= 1e3 * SAME_PLACE * np.abs(arms).max():
            result.append(np.column_stack((q, middle - q @ middle)))
    return result


def symmetrised(group: tuple[Symmetry, ...], pose: Pose, rng: np.random.Generator) -> Pose:
    """Return, for each pose of a batch (n,), one that a random symmetry maps to itself.

    The mean over the powers of the symmetry; poses whose mean is not a pose are returned unchanged.
    """
    movers = [s for s in group if s.legs != group[0].legs]
    position, rotation = pose.position.copy(), pose.rotation.copy()
    if not movers:
        return pose
    which = rng.integers(len(movers), size=pose.size)
    for i in np.unique(which):
        some = which == i
        p, r = position[some], rotation[some]
        places, turns = [p], [r]
        for _ in range(_order(movers[i].legs) - 1):
            p, r = movers[i].image(p, r)
            places.append(p)
            turns.append(r)
        middle = np.mean(turns, axis=0)
        good = (singular_values(middle)[:, 2] > LEAST_MEAN) & (np.linalg.det(middle) > 0.0)
        at = np.flatnonzero(some)[good]
        position[at], rotation[at] = np.mean(places, axis=0)[good], nearest_rotations(middle[good])
    return Pose(position, rotation)


def _order(legs: tuple[int, ...]) -> int:
    """How often a permutation must be repeated to give the identity, doubled for reflections."""
    power, count = legs, 1
    while power != tuple(range(len(legs))):
        power, count = tuple(legs[i] for i in power), count + 1
    return 2 * count


def representative(poses: list[Pose], size: float) -> Pose:
    """Return, of equally good poses, that of greatest z, then y, x, then least rotation.

    So the pose of a maximum does not depend on which of its images a search has found.

    Parameters
    ----------
    poses : list of Pose
        Single poses, at least one.
    size : float [unit]
        Positions that agree to 1e-6 of it are the same.

    Returns
    -------
    Pose
    """

    def key(pose: Pose) -> tuple[float, ...]:
        p, r = pose.position[::-1] / size, pose.rotation
        return tuple(round(float(v), 6) + 0.0 for v in (*p, np.trace(r), *r.ravel()))

    return max(poses, key=key)
