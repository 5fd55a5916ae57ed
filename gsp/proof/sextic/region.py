"""The search over all poses of a design of six D1 legs: its coordinates, symmetries, and boxes."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import ArrayLike

from gsp.determinant.symmetry import symmetries
from gsp.geometry.pose import Pose
from gsp.geometry.scalars import rotation_from_quaternion
from gsp.geometry.vectors import EPS, Array, norm
from gsp.model.design import Design
from gsp.progress import Report
from gsp.proof.sextic.coefficients import (
    POSITION,
    ROTATION,
    SINGLE,
    Legs,
    Powers,
    along,
    charts,
    coefficients,
)
from gsp.proof.sextic.space import MOST_FREE_LEGS, Tables, space_of

# Half-width of the boxes of rotations that the search begins with, in coordinates in [−1, 1].
ROTATION_HALF_WIDTH = 0.25
# Boxes of positions that are kept at the same time.
MOST_POSITION_BOXES = 1 << 21
# Anchors that a symmetry moves onto each other to this share of the size count as symmetric.
SYMMETRY_TOLERANCE = 1e-11
# Distances of anchors that differ by less than this share of the platform count as equal.
EQUAL_DISTANCE_SHARE = 0.05
# Quaternions of images that agree to this are the same.
IMAGE_TOLERANCE = 1e-8
# The quaternion of a rotation without symmetry, whose images divide the rotations.
GENERIC_QUATERNION = np.array([0.71, 0.31, -0.46, 0.43])


@dataclass(frozen=True, eq=False, kw_only=True)
class Sextic:
    """A design in the coordinates of the search.

    Attributes
    ----------
    anchors : (2, 6, 3) array
        Of base and platform about their centroids, exchanged if the platform is larger, in `unit`.
    unit : float [length]
        A power of two.
    tolerance : float [unit]
        Distance within which the anchors of the design and of its symmetric images are.
    polynomials : (4, m, 84, 20) array
        Coefficients of P and its cofactors, for each chart.
    free : tuple of tuples of int
        The legs of these cofactors.
    majorants : (m, 4) array
        Sums of their magnitudes, for each degree in the position.
    images : (m, 4) array
        The quaternions of the images of one rotation, the first its own.
    """

    anchors: Array
    unit: float
    tolerance: float
    polynomials: Array
    free: tuple[Legs, ...]
    majorants: Array
    images: Array


def sextic(design: Design) -> Sextic:
    """Return a design of six D1 legs in the coordinates of the search.

    Parameters
    ----------
    design : Design

    Returns
    -------
    Sextic
    """
    bodies = [design.base_points, design.platform_points]
    bodies.sort(key=lambda points: -float(((points - points.mean(axis=0)) ** 2).sum()))
    size = float(np.abs(bodies).max())
    arms = [points - points.mean(axis=0) for points in bodies]
    unit = float(2.0 ** np.round(np.log2(norm(arms[1]).max())))
    anchors = np.array(arms) / unit
    turned, apart = images(anchors)
    free = (*SINGLE, *short_together(anchors))
    polynomials = charts(coefficients(anchors[0], anchors[1], free))
    return Sextic(
        anchors=anchors,
        unit=unit,
        # The differences of the anchors of a leg are rounded once more.
        tolerance=16.0 * EPS * (size / unit + float(np.abs(anchors).max())) + apart,
        polynomials=polynomials,
        free=free,
        majorants=majorants(polynomials[0]),
        images=turned,
    )


def bounded(
    problem: Sextic, radius: float, bound: float, budget: int, report: Report
) -> tuple[bool, int]:
    """Return whether |det J| ≤ bound is proven at all poses within a radius, and the boxes tried.

    Parameters
    ----------
    problem : Sextic
    radius : float [length]
        Greatest distance of the centroids.
    bound : float [length³]
    budget : int
        Most boxes.
    report : function (done, total)
        Called after each of the boxes of rotations that the search begins with.
    """
    count, far, pool = 0, radius / problem.unit, np.empty((MOST_POSITION_BOXES, 6))
    middles = np.arange(-1.0 + ROTATION_HALF_WIDTH, 1.0, 2.0 * ROTATION_HALF_WIDTH)
    roots = list(product(range(4), product(middles, repeat=3)))
    for done, (chart, middle) in enumerate(roots):
        box = np.array(
            [
                0.0,
                0.0,
                0.0,
                *middle,
                far,
                far,
                far,
                ROTATION_HALF_WIDTH,
                ROTATION_HALF_WIDTH,
                ROTATION_HALF_WIDTH,
            ]
        )
        tried = halved(problem, chart, box, far, bound / problem.unit**3, budget - count, pool)
        count += abs(tried)
        if tried < 0:
            return False, count
        report(done + 1, len(roots))
    return True, count


def halved(
    problem: Sextic, chart: int, box: Array, radius: float, bound: float, budget: int, pool: Array
) -> int:
    """Return how many boxes prove |det J| ≤ bound in a box, or less than 0 if it is not proven.

    Parameters
    ----------
    problem : Sextic
        Lengths are in its unit.
    chart : int
        Which coordinate of q is 1.
    box : (12,) array
        Centre of (p, x), x being the other coordinates of q, then the half-widths.
    radius : float
        Poses with |p| above it do not count, nor do all images of a pose but one.
    bound : float
    budget : int
    pool : (n, 6) array
        Space for boxes of positions.
    """
    # It loads numba.
    from gsp.proof.sextic.halving import search

    places, first = np.full(64, -1), 0
    for some in problem.free:
        places[sum(1 << i for i in some)] = first
        first += 3 ** len(some)
    tables = Tables(
        anchors=problem.anchors,
        coefficients=problem.polynomials[chart],
        places=places,
        majorants=problem.majorants,
        images=problem.images,
        facts=np.array([0.0, *norm(problem.anchors).max(axis=1), problem.tolerance]),
        order=_ORDER,
        x_steps=_STEPS[6],
        p_steps=_STEPS[3],
        rotation=_EXPONENTS[6],
        position=_EXPONENTS[3],
    )
    return int(search(tables, radius, bound, box, chart, budget, pool, space_of(first)))


def majorants(polynomials: Array) -> Array:
    """Return sums of magnitudes of coefficients (m, 84, 20) of each degree in p, (m, 4)."""
    sums, degree = np.abs(polynomials).sum(axis=1), np.array(POSITION).sum(axis=1)
    return np.stack([sums[:, degree == k].sum(axis=1) for k in range(4)], axis=1)


def short_together(anchors: Array) -> list[Legs]:
    """Return the pairs and triples of legs that may be short in the same pose.

    Two legs of the length ε are only if the distances of their anchors on base and platform differ
    by at most 2 ε.

    Parameters
    ----------
    anchors : (2, 6, 3) array
    """
    apart = norm(anchors[:, :, None] - anchors[:, None])
    near = np.abs(apart[0] - apart[1]) <= EQUAL_DISTANCE_SHARE * norm(anchors[1]).max()
    many = [some for n in range(2, MOST_FREE_LEGS + 1) for some in combinations(range(6), n)]
    return [some for some in many if all(near[i, j] for i, j in combinations(some, 2))]


def images(anchors: Array) -> tuple[Array, float]:
    """Return quaternions of the images of a rotation, and how far the images of anchors are off.

    Parameters
    ----------
    anchors : (2, 6, 3) array
        About their centroids.

    Returns
    -------
    (m, 4) array, float
        The rotation is `GENERIC_QUATERNION`, the first image its own.
    """
    # The formula multiplies by the square of the norm.
    generic = rotation_from_quaternion([*(GENERIC_QUATERNION / norm(GENERIC_QUATERNION))])
    rotation, size = np.reshape(generic, (3, 3)), float(norm(anchors).max())
    group = [s for s in symmetries(Design(["D1"] * 6, *anchors))]
    moved = [
        max(
            float(norm(x @ g[:, :3].T + g[:, 3] - x[list(s.legs)]).max())
            for x, g in zip(anchors, (s.base, s.platform), strict=True)
        )
        for s in group
    ]
    group = [s for s, apart in zip(group, moved, strict=True) if apart <= SYMMETRY_TOLERANCE * size]
    turned = [s.base[:, :3] @ rotation @ s.platform[:, :3].T for s in group]
    result = _quaternions(turned)
    for s in group:  # images of images are images, or the group is not one
        for r in turned:
            near = np.abs(result @ _quaternions(s.base[:, :3] @ r @ s.platform[:, :3].T))
            if near.max() < 1.0 - IMAGE_TOLERANCE:
                return result[:1], 0.0
    return result, 4.0 * max(a for a in moved if a <= SYMMETRY_TOLERANCE * size) + 64.0 * EPS * size


def _quaternions(rotations: ArrayLike) -> Array:
    """Return the quaternions (w, x, y, z) of rotation matrices, w ≥ 0."""
    rotation = np.asarray(rotations)
    return np.roll(Pose(np.zeros(rotation.shape[:-1]), rotation).quaternion, 1, axis=-1)


def _steps(monomials: list[Powers], degree: int) -> Array:
    """Return the steps (axis, to, of) that expand a polynomial about another centre, in order."""
    place = {e: n for n, e in enumerate(monomials)}
    steps = []
    for axis in range(3):
        for e in monomials:
            if e[axis] == 0:
                line = [place[point] for point in along(e, axis, degree)]
                for low in range(len(line) - 1):
                    for i in range(len(line) - 2, low - 1, -1):
                        steps.append((axis, line[i], line[i + 1]))
    return np.array(steps)


_EXPONENTS = {6: np.array(ROTATION), 3: np.array(POSITION)}
_STEPS = {6: _steps(ROTATION, 6), 3: _steps(POSITION, 3)}
# The monomials of the rotation up to degree 2: 1, the three coordinates, squares, products.
_ORDER = np.array(
    [
        ROTATION.index(e)
        for e in (
            (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 0, 0), (0, 2, 0), (0, 0, 2),
            (1, 1, 0), (1, 0, 1), (0, 1, 1),
        )
    ]
)  # fmt: skip
