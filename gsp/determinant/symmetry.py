"""Symmetries of designs of D1 legs: poses that are equally good, and poses that map to themselves.

A symmetry moves the base anchors onto each other by an isometry g, and the platform anchors in
the same order by an isometry k; then T and g T k⁻¹ have the same |det J|. Both may be reflections
if both are: a plane base and a plane platform always allow the reflection in both planes.
"""

from __future__ import annotations

import numpy as np

from gsp.determinant.canonical import MOST_ORDERED_LEGS
from gsp.geometry.congruence import Figure
from gsp.geometry.matrices import singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import nearest_rotations
from gsp.model.design import Design
from gsp.model.design.symmetry import Symmetry, symmetries_between

# Anchors that agree to this share of the size of the design are the same.
SAME_PLACE = 1e-9
# Singular values of the mean of rotations [1] up to which it is near no single rotation.
LEAST_MEAN = 1e-3


def symmetries(design: Design) -> tuple[Symmetry, ...]:
    """Return the symmetries of a design of at most seven D1 legs, the identity first.

    Other designs have their identity only.
    """
    n = design.n_legs
    found: list[Symmetry] = []
    if design.between_points and n <= MOST_ORDERED_LEGS:
        base, platform = (
            Figure.of(points, design.rms_radius)
            for points in (design.base_points, design.platform_points)
        )
        found = symmetries_between((base, base), (platform, platform), SAME_PLACE)
    still = np.eye(3, 4)
    identity = Symmetry(tuple(range(n)), still, still)
    others = [
        s for s in found if s.legs != identity.legs or np.abs(s.base - still).max() > SAME_PLACE
    ]
    return (identity, *others)


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
