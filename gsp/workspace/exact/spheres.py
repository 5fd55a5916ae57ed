"""Where two and three spheres meet."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array, cross, dot, norm, unit


def frame_of(normal: Array) -> tuple[Array, Array]:
    """Two unit vectors that complete a unit vector to a right-handed frame."""
    other = np.eye(3)[int(np.argmin(np.abs(normal)))]
    first = unit(cross(normal, other))
    return first, cross(normal, first)


def two_spheres(centers: Array, radii: Array) -> tuple[Array, float, Array] | None:
    """Circle in which two spheres meet: center, radius, unit normal; None if they do not."""
    offset = centers[1] - centers[0]
    gap = float(norm(offset))
    if gap <= 1e-14 * float(radii.max()):
        return None
    along = (gap * gap + radii[0] ** 2 - radii[1] ** 2) / (2.0 * gap)
    square = radii[0] ** 2 - along**2
    if square <= 0.0:
        return None
    normal = offset / gap
    return centers[0] + along * normal, float(np.sqrt(square)), normal


def three_spheres(centers: Array, radii: Array) -> list[Array]:
    """Points in which three spheres meet: none or two (one where they touch)."""
    circle = two_spheres(centers[:2], radii[:2])
    if circle is None:
        return []
    center, radius, normal = circle
    offset = centers[2] - center
    flat = offset - dot(offset, normal) * normal
    reach = float(norm(flat))
    if reach <= 1e-12 * float(radii.max()):
        return []
    e1 = flat / reach
    cosine = (radius**2 + float(dot(offset, offset)) - radii[2] ** 2) / (2.0 * radius * reach)
    if abs(cosine) > 1.0:
        return []
    sine = float(np.sqrt(1.0 - cosine**2))
    e2 = cross(normal, e1)
    return [center + radius * (cosine * e1 + s * sine * e2) for s in (1.0, -1.0)]
