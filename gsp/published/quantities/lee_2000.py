"""Quantities that `Lee2000` prints, from the assembled rows of its platforms.

Letters are those of the text: sides a and b, height h, separations alpha, beta, rho, twist theta
[rad], displacement x, y. Equations are records of expressions in these letters.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from gsp.determinant import log_determinant, upper_bound
from gsp.families import lee
from gsp.geometry.matrices import singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.indices import manipulability
from gsp.model.design import Design
from gsp.published.quantities.lee_2000_chapters import CHAPTERS

_OPTIONS = {
    "lee-3-3": (),
    "lee-3-6": ("beta",),
    "lee-6-6": ("alpha", "beta"),
    "lee-centre": ("rho",),
    "lee-side": ("rho",),
}


def platform(family: str, a: float, b: float, **letters: float) -> Design:
    """Return a platform of a family; letters that it does not have are left out."""
    return lee.FAMILIES[family](a, b, **{k: letters[k] for k in _OPTIONS[family]})


def point(family: str, side: str, number: int, a: float, b: float, **letters: float) -> Array:
    """Coordinates x, y of an anchor in its own axes, numbered by legs from 1."""
    design = platform(family, a, b, **letters)
    points = design.base_points if side == "base" else design.platform_points
    return np.asarray(points[number - 1, :2])


def turned_point(number: int, family: str, a: float, b: float, theta: float, rho: float) -> Array:
    """Coordinates x, y of a platform anchor in base axes, the platform turned by theta."""
    rotation = Pose.from_rpy([0.0, 0.0, 0.0], [0.0, 0.0, theta]).rotation
    return np.asarray((rotation @ platform(family, a, b, rho=rho).platform_points[number - 1])[:2])


def line(
    family: str, leg: int, a: float, b: float, h: float,
    x: float = 0.0, y: float = 0.0, origin: str = "base", reversed: bool = False, **letters: float,
) -> Array:  # fmt: skip
    """Line coordinates (L, M, N; P, Q, R) of a leg, not normalised, from base to platform.

    About the centre of the base, or about the point at the height h above it.
    """
    design = platform(family, a, b, **letters)
    low = np.array([0.0, 0.0, -h if origin == "platform" else 0.0])
    start = design.base_points[leg - 1] + low
    end = design.platform_points[leg - 1] + low + [x, y, h]
    return lee.line_coordinates(end, start) if reversed else lee.line_coordinates(start, end)


def _pose(h: float, theta: float = 0.0, x: float = 0.0, y: float = 0.0) -> Pose:
    return Pose.from_rpy([x, y, h], [0.0, 0.0, theta])


def leg_length(
    family: str, leg: int, a: float, b: float, h: float,
    theta: float = 0.0, x: float = 0.0, y: float = 0.0, **letters: float,
) -> float:  # fmt: skip
    """Length of a leg, numbered from 1."""
    posture = platform(family, a, b, **letters).at(_pose(h, theta, x, y))
    return float(posture.joints[leg - 1])


def determinant(
    family: str, a: float, b: float, h: float,
    theta: float = 0.0, x: float = 0.0, y: float = 0.0, normalised: bool = True, **letters: float,
) -> float:  # fmt: skip
    """|det J| with the platform parallel to the base; |det J*| if not normalised."""
    posture = platform(family, a, b, **letters).at(_pose(h, theta, x, y))
    scale = 1.0 if normalised else float(posture.joints.prod())
    return float(manipulability(posture)) * scale


def best_height(family: str, a: float, b: float, theta: float = 0.0, **letters: float) -> float:
    """Height at which the slope of |det J| along the vertical vanishes."""
    design = platform(family, a, b, **letters)

    def slope(h: float) -> float:
        return float(log_determinant(design, _pose(h, theta))[1][2])

    size = design.size
    return float(brentq(slope, 1e-3 * size, 5.0 * size, xtol=1e-15, rtol=1e-15))


def central_maximum(family: str, a: float, b: float, **letters: float) -> float:
    """Largest |det J| along the vertical, without twist."""
    if _singular(family, a, b, **letters):
        return 0.0
    h = best_height(family, a, b, **letters)
    return determinant(family, a, b, h, normalised=True, **letters)


def _singular(family: str, a: float, b: float, **letters: float) -> bool:
    posture = platform(family, a, b, **letters).at(_pose(0.77 * a))
    values = singular_values(posture.homogeneous(a))
    return bool(values[-1] < 1e-13 * values[0])


def best_ratio(alpha: float = 0.0, beta: float = 0.0) -> float:
    """Ratio b/a at which the lines stand on the tangents of the platform circle.

    There |det J| reaches its bound for any lines through the platform anchors.
    """
    design = lee.platform_6_6(1.0, 1.0, alpha, beta)
    base, top = design.base_points[0, :2], design.platform_points[0, :2]
    return float(norm(top) ** 2 / (base @ top))


def share_of_bound(family: str, a: float, b: float, **letters: float) -> float:
    """Return the largest |det J| along the vertical over the bound that no pose exceeds."""
    design = platform(family, a, b, **letters)
    return central_maximum(family, a, b, **letters) / upper_bound(design)


def rank(family: str, a: float, b: float, h: float, **letters: float) -> int:
    """Rank of J in the central configuration."""
    posture = platform(family, a, b, **letters).at(_pose(h))
    return int((singular_values(posture.homogeneous(a)) > 1e-12).sum())


def quality_at_height(height_ratio: float) -> float:
    """λ of the octahedral platform at h / h_m."""
    a, b = 1.3, 1.9
    h = best_height("lee-3-3", a, b)
    return determinant("lee-3-3", a, b, height_ratio * h) / determinant("lee-3-3", a, b, h)


def translated_quality(
    r: float, theta: float, a: float = 1.0, b: float = 2.0, h: float = 1.0
) -> float:
    """λ of the octahedral platform translated by r in the direction theta."""
    x, y = r * np.cos(theta), r * np.sin(theta)
    return determinant("lee-3-3", a, b, h, x=x, y=y) / central_maximum("lee-3-3", a, b)


def quality_translated(a: float, b: float, x: float, y: float, h: float) -> float:
    """λ of the octahedral platform with its centre at (x, y, h)."""
    return determinant("lee-3-3", a, b, h, x=x, y=y) / central_maximum("lee-3-3", a, b)


def most_deviating_radius() -> float:
    """Radius at which λ differs most between the directions 0° and 30°."""
    return float(brentq(lambda r: _deviation_slope(r), 1.0, 2.0, xtol=1e-14))


def deviation(r: float) -> float:
    """λ in the direction 0° less λ in the direction 30°."""
    return translated_quality(r, 0.0) - translated_quality(r, np.pi / 6.0)


def _deviation_slope(r: float) -> float:
    design = lee.octahedral_3_3(1.0, 2.0)
    slopes = []
    for theta in (0.0, np.pi / 6.0):
        along = np.array([np.cos(theta), np.sin(theta), 0.0])
        value, gradient = log_determinant(design, Pose(r * along + [0.0, 0.0, 1.0]))
        slopes.append(float(np.exp(value) * (gradient[:3] @ along)))
    return slopes[0] - slopes[1]


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        f.__name__: f
        for f in (
            point, turned_point, line, leg_length, determinant, best_height, central_maximum,
            best_ratio, share_of_bound, rank, quality_at_height, translated_quality,
            quality_translated, most_deviating_radius, deviation,
        )
    }
    | dict(CHAPTERS)
)  # fmt: skip
