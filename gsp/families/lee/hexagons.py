"""Closed forms of the 3-3, 3-6 and 6-6 platforms in their central configuration.

One set of functions serves the three: α = β = 0 is the octahedral 3-3, α = 0 the 3-6. "Central"
means: platform parallel to the base at the height h, not turned, centres above each other.

What the dissertation calls |det J|m is the maximum over the height h alone. Whether it is the
maximum over all poses depends on the design: it is for b/a = `best_ratio` (then no six lines
through the platform's joints do better, see `gsp.determinant.upper_bound`), and it is not, for
example, for the 3-3 platform with b = 20 a. `gsp.determinant.maximum` answers this for any design.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.families.fitting import fitting
from gsp.families.lee.platforms import ROOT3
from gsp.geometry.vectors import Array


def _number(value: ArrayLike) -> Array:
    return check_array("argument of a closed form", value, ())


def _shape(share: ArrayLike) -> Array:
    """3α² − 3α + 1: squared circumradius of a separated triangle over that of the whole."""
    s = _number(share)
    return 3.0 * s * s - 3.0 * s + 1.0


def _spread(a: ArrayLike, b: ArrayLike, alpha: ArrayLike, beta: ArrayLike) -> Array:
    """3 (l² − h²), what eqs. (13), (52) and (61) have under the root beside 3 h²."""
    a, b = _number(a), _number(b)
    mixed = 3.0 * _number(alpha) * _number(beta) - 1.0
    return np.asarray(a * a * _shape(alpha) + a * b * mixed + b * b * _shape(beta))


@fitting
def regulus_factor(alpha: ArrayLike, beta: ArrayLike) -> Array:
    """Return f(α, β) = 3αβ − 2α − 2β + 1, zero where the platform is singular in every pose.

    Parameters
    ----------
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated.

    Returns
    -------
    (...) array [1]

    *Source: Lee2000, below eq. (62), figure 14; for the 3-6 it is the 1 − 2β of eq. (55).*
    """
    al, be = _number(alpha), _number(beta)
    return np.asarray(3.0 * al * be - 2.0 * al - 2.0 * be + 1.0)


@fitting
def leg_length(
    a: ArrayLike, b: ArrayLike, h: ArrayLike, alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0
) -> Array:
    """Length of the six legs in the central configuration [unit].

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle.
    h : (...) array_like [unit]
        Height.
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated.

    Returns
    -------
    (...) array [unit]

    *Source: Lee2000, eqs. (13), (52), (61).*

    >>> leg_length(1.0, 2.0, 1.0).round(12)
    np.float64(1.414213562373)
    """
    return np.sqrt(_spread(a, b, alpha, beta) / 3.0 + _number(h) ** 2)


@fitting
def central_determinant(
    a: ArrayLike, b: ArrayLike, h: ArrayLike, alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0
) -> Array:
    """|det J| in the central configuration at the height h [unit³].

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle.
    h : (...) array_like [unit]
        Height.
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated.

    Returns
    -------
    (...) array [unit³]

    *Source: Lee2000, eqs. (14), (62). Eq. (53), for the 3-6, is (62) at α = 0.*
    """
    a, b, h = _number(a), _number(b), _number(h)
    top = (3.0 * ROOT3 / 4.0) * np.abs(a * b * h * regulus_factor(alpha, beta)) ** 3
    return np.asarray(top / leg_length(a, b, h, alpha, beta) ** 6)


@fitting
def best_height(a: ArrayLike, b: ArrayLike, alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0) -> Array:
    """Height at which the central configuration has its largest |det J| [unit].

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle.
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated.

    Returns
    -------
    (...) array [unit]

    *Source: Lee2000, eqs. (16), (54), (63). ERRATUM: below eq. (59) the 3-6 with b = 2a is given
    h = a √(3β² − 3β + 1); eq. (54) gives a |2β − 1|.*
    """
    return np.sqrt(_spread(a, b, alpha, beta) / 3.0)


@fitting
def central_maximum(
    a: ArrayLike, b: ArrayLike, alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0
) -> Array:
    """Largest |det J| of the central configuration over the height, |det J|m [unit³].

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle.
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated.

    Returns
    -------
    (...) array [unit³]

    *Source: Lee2000, eqs. (17), (18), (55), (56), (64), (65), with the absolute value that those
    from (55) on leave out.*
    """
    a, b = _number(a), _number(b)
    top = (27.0 / 32.0) * np.abs(a * b * regulus_factor(alpha, beta)) ** 3
    with np.errstate(invalid="ignore", divide="ignore"):  # anchors that coincide: undefined
        return np.asarray(top / _spread(a, b, alpha, beta) ** 1.5)


@fitting
def best_ratio(alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0) -> Array:
    """Ratio γ = b/a that makes |det J|m largest for a given platform.

    Positive, and so a ratio, where 3αβ < 1.

    Parameters
    ----------
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated.

    Returns
    -------
    (...) array [1]

    *Source: Lee2000, eqs. (20), (58), (67).*
    """
    return np.asarray(2.0 * _shape(alpha) / (1.0 - 3.0 * _number(alpha) * _number(beta)))


@fitting
def absolute_maximum(a: ArrayLike, alpha: ArrayLike = 0.0) -> Array:
    """Largest |det J|m over all bases, |det J|am: at b/a = `best_ratio` [unit³].

    Parameters
    ----------
    a : (...) array_like [unit]
        Side of the platform triangle.
    alpha : (...) array_like [1]
        Share by which the joints of the platform are separated.

    Returns
    -------
    (...) array [unit³]

    *Source: Lee2000, eqs. (21), (59), (68).*

    >>> absolute_maximum(1.0).round(12)
    np.float64(1.299038105677)
    """
    return np.asarray(0.75 * ROOT3 * _number(a) ** 3 * _shape(alpha) ** 1.5)


@fitting
def octahedron_volume(a: ArrayLike, b: ArrayLike, h: ArrayLike) -> Array:
    """Volume of the octahedron between platform and base triangle [unit³].

    With b = 2a and h = a it is the `absolute_maximum` of the 3-3 platform.

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle.
    h : (...) array_like [unit]
        Height.

    Returns
    -------
    (...) array [unit³]

    *Source: Lee2000, eqs. (22), (23).*
    """
    return np.asarray(ROOT3 / 12.0 * _number(h) * (_number(a) + _number(b)) ** 2)


@fitting
def quality_at_height(height_ratio: ArrayLike) -> Array:
    """λ of the central configuration at h / h_m, with |det J|m for maximum [1].

    8 (h/h_m)³ / (1 + (h/h_m)²)³, for the 3-3, and for the 3-6 and 6-6 as well.

    Parameters
    ----------
    height_ratio : (...) array_like [1]
        h / h_m, the height over the best one.

    Returns
    -------
    (...) array [1]
        In [0, 1] for heights ≥ 0.

    *Source: Lee2000, eq. (24). ERRATUM: the cube is missing in its numerators, and its two
    forms then differ; eqs. (14) and (17) give it with the cube.*
    """
    x = _number(height_ratio)
    return np.asarray(8.0 * x**3 / (1.0 + x * x) ** 3)
