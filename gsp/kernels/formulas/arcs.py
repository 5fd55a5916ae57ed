"""Angles by sums and products, for code on vectors: processors have no such instruction."""

from __future__ import annotations

from math import pi
from typing import Any

from gsp.geometry.scalars import choose, less, root
from gsp.kernels.trace import Graph

# After two halvings the tangent is at most tan(π/16) = 0.199, and the first term that is left out
# below 0.199²⁴ / 25 = 6e-19.
TANGENT_HALVINGS, ARC_SERIES_TERMS = 2, 12


def arctangent(tangent: Any) -> Any:
    """Angle of a tangent in [−1, 1] [rad], to a few units of rounding: halvings, then a series."""
    t = tangent
    for _ in range(TANGENT_HALVINGS):
        t = t / (1.0 + root(1.0 + t * t))
    square = t * t
    total: Any = 1.0 / (2 * ARC_SERIES_TERMS - 1)
    for k in range(ARC_SERIES_TERMS - 2, -1, -1):
        total = 1.0 / (2 * k + 1) - square * total
    return (2.0**TANGENT_HALVINGS) * t * total


def arc(sine: Any, cosine: Any) -> Any:
    """Angle in (0, π) [rad] from multiples of its sine, which is positive, and of its cosine.

    The quotient of the smaller by the larger has the angle from the nearest of 0, π/2 and π.
    """
    behind = less(cosine, 0.0)
    size = choose(behind, -cosine, cosine)
    steep = less(size, sine)
    angle = arctangent(choose(steep, cosine, sine) / choose(steep, sine, size))
    flat = choose(behind, pi - angle, angle)
    return choose(steep, pi / 2 - angle, flat)


# The same as a graph of the inputs (sine, cosine), for the writer of compiled code.
ARC = arc(*Graph().lanes("arguments", 2))
