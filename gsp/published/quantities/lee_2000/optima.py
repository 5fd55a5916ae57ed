"""Maxima of |det J| in the central configurations of `Lee2000`, searched in the assembled rows."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from gsp.determinant import log_determinant, upper_bound
from gsp.families import lee
from gsp.geometry.matrices import singular_values
from gsp.geometry.vectors import cross
from gsp.indices import manipulability
from gsp.published.quantities.lee_2000.platforms import platform, pose

SINGULAR_RATIO = 1e-13
COMPLEX_STEP = 1e-30
REACHED = 1e-12


def best_height(family: str, a: float, b: float, theta: float = 0.0, **letters: float) -> float:
    """Height at which the slope of |det J| along the vertical vanishes."""
    design = platform(family, a, b, **letters)

    def slope(h: float) -> float:
        return float(log_determinant(design, pose(h, theta))[1][2])

    size = design.rms_radius
    return float(brentq(slope, 1e-3 * size, 5.0 * size, xtol=1e-15, rtol=1e-15))


def central_maximum(family: str, a: float, b: float, **letters: float) -> float:
    """Largest |det J| along the vertical, without twist."""
    design = platform(family, a, b, **letters)
    values = singular_values(design.at(pose(0.77 * a)).homogeneous(a))
    if values[-1] < SINGULAR_RATIO * values[0]:
        return 0.0
    return float(manipulability(design.at(pose(best_height(family, a, b, **letters)))))


def central_maximum_at_ratio(family: str, a: float, gamma: float, **letters: float) -> float:
    """Largest |det J| along the vertical for b = γ a."""
    return central_maximum(family, a, gamma * a, **letters)


def ratio_slope(family: str, gamma: float, **letters: float) -> float:
    """−2/3 of the slope of log |det J|m over γ, by a complex step in the base points.

    |det J|m is stationary in the height, so that the height is held at its best value.
    """
    h = best_height(family, 1.0, gamma, **letters)
    unit = platform(family, 1.0, 1.0, **letters)
    base = (gamma + 1j * COMPLEX_STEP) * unit.base_points
    leg = unit.platform_points + [0.0, 0.0, h] - base
    rows = np.concatenate((leg, cross(base, leg)), axis=1)
    rows = rows / np.sqrt((leg * leg).sum(axis=1))[:, None]
    determinant = np.linalg.det(rows)
    return float(-2.0 / 3.0 * (determinant.imag / determinant.real) / COMPLEX_STEP)


def best_ratio(family: str, **letters: float) -> float:
    """Ratio b/a at which |det J|m is largest for a given platform."""
    return float(brentq(lambda gamma: ratio_slope(family, gamma, **letters), 0.2, 12.0, xtol=1e-14))


def absolute_maximum(family: str, a: float, **letters: float) -> float:
    """Return |det J|am: the largest |det J| along the vertical, at the best ratio b/a."""
    return central_maximum_at_ratio(family, a, best_ratio(family, **letters), **letters)


def share_of_bound(family: str, a: float, b: float, **letters: float) -> float:
    """Return the largest |det J| along the vertical over the bound that no pose exceeds."""
    return central_maximum(family, a, b, **letters) / upper_bound(platform(family, a, b, **letters))


def number_of_best_heights(a: float, b: float) -> int:
    """Return how many heights, above and below the base, give the bound of |det J| of the 3-3."""
    design = lee.octahedral_3_3(a, b)
    bound, best = upper_bound(design), best_height("lee-3-3", a, b)
    values = np.array([float(manipulability(design.at(pose(h)))) for h in (best, -best)])
    return int((values > (1.0 - REACHED) * bound).sum())


QUANTITIES = (
    best_height,
    central_maximum,
    central_maximum_at_ratio,
    ratio_slope,
    best_ratio,
    absolute_maximum,
    share_of_bound,
    number_of_best_heights,
)
