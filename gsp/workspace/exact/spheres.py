"""Spheres that bound a set: each once, and where two and three of them meet."""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from gsp.geometry.copies import read_only_tuple
from gsp.geometry.vectors import Array, Mask, cross, dot, norm, perpendicular
from gsp.limits.labels import Active

# Spheres, circles and points nearer than this [share of the greatest radius] are the same.
# Symmetric designs have many that are equal up to rounding. The intersections of nearer ones are
# not accurate; merging them moves the boundary by less than this.
SAME_TOLERANCE = 1e-9


@read_only_tuple
class Circle(NamedTuple):
    """A circle in space: centre (3,) [length], radius [length], unit normal (3,) of its plane."""

    centre: Array
    radius: float
    normal: Array


@read_only_tuple
class Spheres(NamedTuple):
    """Spheres, each once.

    Attributes
    ----------
    centres : (m, 3) array [length]
    radii : (m,) array [length]
    sides : (m,) array [1]
        1: the set lies inside; 0: outside.
    bounds : tuple of Active
        Per sphere the (leg, side) of all bounds that it stands for.
    """

    centres: Array
    radii: Array
    sides: Array
    bounds: tuple[Active, ...]


def merged_spheres(centres: Array, low: Array, high: Array) -> Spheres:
    """Return the spheres that bound shells, those of one side that are the same merged.

    Parameters
    ----------
    centres : (n, 3) array [length]
    low, high : (n,) arrays [length]
        Radii; a low of zero bounds nothing.
    """
    bounds = [(i, 0) for i in range(len(low)) if low[i] > 0.0]
    bounds += [(i, 1) for i in range(len(high))]
    radius = {(i, side): float((low, high)[side][i]) for i, side in bounds}
    groups: list[list[tuple[int, int]]] = []
    for bound in bounds:
        for group in groups:
            gap = float(norm(centres[bound[0]] - centres[group[0][0]]))
            apart = gap + abs(radius[bound] - radius[group[0]])
            if group[0][1] == bound[1] and apart <= SAME_TOLERANCE * high.max():
                group.append(bound)
                break
        else:
            groups.append([bound])
    return Spheres(
        centres[[group[0][0] for group in groups]],
        np.array([radius[group[0]] for group in groups]),
        np.array([group[0][1] for group in groups]),
        tuple(map(tuple, groups)),
    )


def touching(spheres: Spheres, points: Array, slack: float) -> Mask:
    """Whether spheres pass all of some points (q, 3) within a distance: shape (m,)."""
    far = norm(points[:, None] - spheres.centres)
    return np.asarray((np.abs(far - spheres.radii) <= slack).all(axis=0))


def frame_of(normal: Array) -> tuple[Array, Array]:
    """Two unit vectors that complete a unit vector to a right-handed frame."""
    first = perpendicular(normal)
    return first, cross(normal, first)


def common_chord(gap: Array, r0: Array, r1: Array) -> tuple[Array, Array]:
    """Return where two circles or spheres meet, in a plane through their centres.

    Parameters
    ----------
    gap : (...) array [length]
        Distances of the centres.
    r0, r1 : (...) arrays [length]
        Radii.

    Returns
    -------
    along : (...) array [length]
        Distances of the common chord from the first centres, toward the second ones.
    square : (...) array [length²]
        Squares of half its length; negative where they do not meet.

    *Source: ours*
    """
    along = 0.5 * (gap + (r0 - r1) * (r0 + r1) / gap)
    return along, (r0 - along) * (r0 + along)


def two_spheres(centres: Array, radii: Array) -> Circle | None:
    """Circle in which two spheres meet; None if they do not."""
    offset = centres[1] - centres[0]
    gap = norm(offset)
    if gap <= SAME_TOLERANCE * float(radii.max()):
        return None
    along, square = common_chord(gap, radii[0], radii[1])
    if square <= 0.0:
        return None
    normal = offset / gap
    return Circle(centres[0] + along * normal, float(np.sqrt(square)), normal)


def three_spheres(centres: Array, radii: Array) -> list[Array]:
    """Points in which three spheres meet: none or two (one where they touch)."""
    circle = two_spheres(centres[:2], radii[:2])
    if circle is None:
        return []
    centre, radius, normal = circle
    offset = centres[2] - centre
    flat = offset - dot(offset, normal) * normal
    reach = float(norm(flat))
    if reach <= SAME_TOLERANCE * float(radii.max()):  # all three meet in one circle, or nowhere
        return []
    e1 = flat / reach
    cosine = (radius**2 + float(dot(offset, offset)) - radii[2] ** 2) / (2.0 * radius * reach)
    # A common tangent has a cosine of 1 up to rounding, on either side.
    if (abs(cosine) - 1.0) * radius * reach > (SAME_TOLERANCE * radii.max()) * radii[2]:
        return []
    cosine = min(max(cosine, -1.0), 1.0)
    sine = float(np.sqrt(1.0 - cosine**2))
    e2 = cross(normal, e1)
    return [centre + radius * (cosine * e1 + s * sine * e2) for s in (1.0, -1.0)]


def pair_circles(spheres: Spheres) -> list[Circle]:
    """Return the circles in which two of the spheres meet."""
    pairs = (list(pair) for pair in combinations(range(len(spheres.radii)), 2))
    circles = (two_spheres(spheres.centres[pair], spheres.radii[pair]) for pair in pairs)
    return [circle for circle in circles if circle is not None]


def triple_points(spheres: Spheres) -> Array:
    """Return the points in which three of the spheres meet, (q, 3) [length]."""
    triples = (list(three) for three in combinations(range(len(spheres.radii)), 3))
    found = [p for t in triples for p in three_spheres(spheres.centres[t], spheres.radii[t])]
    return np.array(found).reshape(-1, 3)
