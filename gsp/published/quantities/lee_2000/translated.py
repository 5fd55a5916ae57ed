"""The octahedral platform translated parallel to its base: chapter 4 of `Lee2000`."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from gsp.determinant import log_determinant
from gsp.families import lee
from gsp.geometry.pose import Pose
from gsp.published.quantities.lee_2000.determinants import quality


def translated_quality(
    r: float, theta: float, a: float = 1.0, b: float = 2.0, h: float = 1.0
) -> float:
    """λ of the octahedral platform translated by r in the direction theta."""
    return quality("lee-3-3", a, b, h, x=r * np.cos(theta), y=r * np.sin(theta))


def share_of_sixth_power(r: float) -> float:
    """Share of the term in r⁶ in the sum under the root of eq. (41), for cos 6θ = 0.

    The sum is 64/λ², a polynomial in r² whose coefficients are found from seven values of λ.
    """
    theta = np.pi / 12.0
    radii = np.linspace(0.0, 1.8, 7)
    sums = [64.0 / translated_quality(float(radius), theta) ** 2 for radius in radii]
    coefficients = np.linalg.solve(np.vander(radii**2, increasing=True), sums)
    terms = coefficients * float(r) ** (2 * np.arange(7))
    return float(terms[3] / terms.sum())


def deviation(r: float) -> float:
    """λ in the direction 0° less λ in the direction 30°."""
    return translated_quality(r, 0.0) - translated_quality(r, np.pi / 6.0)


def most_deviating_radius() -> float:
    """Radius at which λ differs most between the directions 0° and 30°."""
    return float(brentq(_deviation_slope, 1.0, 2.0, xtol=1e-14))


def _deviation_slope(r: float) -> float:
    design = lee.octahedral_3_3(1.0, 2.0)
    slopes = []
    for theta in (0.0, np.pi / 6.0):
        along = np.array([np.cos(theta), np.sin(theta), 0.0])
        value, gradient = log_determinant(design, Pose(r * along + [0.0, 0.0, 1.0]))
        slopes.append(float(np.exp(value) * (gradient[:3] @ along)))
    return slopes[0] - slopes[1]


QUANTITIES = (translated_quality, share_of_sixth_power, deviation, most_deviating_radius)
