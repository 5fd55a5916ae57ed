"""Closed forms of the 3-3, 3-6 and 6-6 platforms in their central configuration.

One set of functions serves the three: α = β = 0 is the octahedral 3-3, α = 0 the 3-6. "Central"
means: platform parallel to the base at the height h, not turned, centres above each other.

What the dissertation calls |det J|m is the maximum over the height h alone. Whether it is the
maximum over all poses depends on the design: it is for b/a = `best_ratio` (then no six lines
through the platform's joints do better, see `gsp.determinant.upper_bound`), and it is not, for
example, for the 3-3 platform with b = 20 a. `gsp.determinant.maximum` answers this for any design.

Sides are numbers from 1e-100 to 1e100, shares are in [0, 1]; others raise InvalidInput.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.errors import InvalidInput, expected
from gsp.families.fitting import fitting
from gsp.families.lee.platforms import ROOT3
from gsp.geometry.vectors import EPS, Array

HEIGHTS = arguments.within(0.0, arguments.LARGEST_NUMBER)
CHECKS = {
    "a": arguments.sizes,
    "b": arguments.sizes,
    "alpha": arguments.shares,
    "beta": arguments.shares,
}


def _shape(share: ArrayLike) -> Array:
    """3α² − 3α + 1: squared circumradius of a separated triangle over that of the whole."""
    s = np.asarray(share, dtype=np.float64)
    return np.asarray(3.0 * s * s - 3.0 * s + 1.0)


def _offset(a: ArrayLike, b: ArrayLike, alpha: ArrayLike, beta: ArrayLike) -> Array:
    """Horizontal distance of the joints of a leg, sqrt(l² − h²) of eqs. (13), (52) and (61).

    From its two components: the printed sum is negative by rounding where it is zero, and
    overflows for large sides.
    """
    a, b, al, be = (np.asarray(v, dtype=np.float64) for v in (a, b, alpha, beta))
    along = ROOT3 * (a * (1.0 - al) - b * (1.0 - be))
    across = a * (1.0 - 3.0 * al) + b * (1.0 - 3.0 * be)
    return np.asarray(np.hypot(along, across) / (2.0 * ROOT3))


@fitting
@arguments.validated(alpha=arguments.shares, beta=arguments.shares)
def regulus_factor(alpha: ArrayLike, beta: ArrayLike) -> Array:
    """Return f(α, β) = 3αβ − 2α − 2β + 1, zero where the platform is singular in every pose.

    Parameters
    ----------
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated, in [0, 1].

    Returns
    -------
    (...) array [1]

    Raises
    ------
    InvalidInput
        On shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, below eq. (62), figure 14; for the 3-6 it is the 1 − 2β of eq. (55).*
    """
    al, be = np.asarray(alpha, dtype=np.float64), np.asarray(beta, dtype=np.float64)
    return np.asarray(3.0 * al * be - 2.0 * al - 2.0 * be + 1.0)


@fitting
@arguments.validated(**CHECKS, h=arguments.moderate)
def leg_length(
    a: ArrayLike, b: ArrayLike, h: ArrayLike, alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0
) -> Array:
    """Length of the six legs in the central configuration [unit].

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle, > 0.
    h : (...) array_like [unit]
        Height, of any sign.
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated, in [0, 1].

    Returns
    -------
    (...) array [unit]

    Raises
    ------
    InvalidInput
        On sides, heights or shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eqs. (13), (52), (61).*

    >>> leg_length(1.0, 2.0, 1.0).round(12)
    np.float64(1.414213562373)
    """
    return np.hypot(_offset(a, b, alpha, beta), np.asarray(h, dtype=np.float64))


@fitting
@arguments.validated(**CHECKS, h=arguments.moderate)
def central_determinant(
    a: ArrayLike, b: ArrayLike, h: ArrayLike, alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0
) -> Array:
    """|det J| in the central configuration at the height h [unit³].

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle, > 0.
    h : (...) array_like [unit]
        Height, of any sign.
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated, in [0, 1].

    Returns
    -------
    (...) array [unit³]
        NaN where the legs have no length.

    Raises
    ------
    InvalidInput
        On sides, heights or shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eqs. (14), (62). Eq. (53), for the 3-6, is (62) at α = 0.*
    """
    length, factor = leg_length(a, b, h, alpha, beta), regulus_factor(alpha, beta)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.asarray(a) * (np.asarray(b) / length) * (np.asarray(h) / length)
    return np.asarray((3.0 * ROOT3 / 4.0) * np.abs(ratio * factor) ** 3)


@fitting
@arguments.validated(**CHECKS)
def best_height(a: ArrayLike, b: ArrayLike, alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0) -> Array:
    """Height at which the central configuration has its largest |det J| [unit].

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle, > 0.
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated, in [0, 1].

    Returns
    -------
    (...) array [unit]

    Raises
    ------
    InvalidInput
        On sides or shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eqs. (16), (54), (63). ERRATUM: below eq. (59) the 3-6 with b = 2a is given
    h = a √(3β² − 3β + 1); eq. (54) gives a |2β − 1|.*
    """
    return _offset(a, b, alpha, beta)


@fitting
@arguments.validated(**CHECKS)
def central_maximum(
    a: ArrayLike, b: ArrayLike, alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0
) -> Array:
    """Largest |det J| of the central configuration over the height, |det J|m [unit³].

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle, > 0.
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated, in [0, 1].

    Returns
    -------
    (...) array [unit³]
        NaN where the anchors coincide at the height 0, which is the best one there.

    Raises
    ------
    InvalidInput
        On sides or shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eqs. (17), (18), (55), (56), (64), (65), with the absolute value that those
    from (55) on leave out.*
    """
    with np.errstate(invalid="ignore", divide="ignore"):  # anchors that coincide: undefined
        ratio = np.asarray(a) * (np.asarray(b) / _offset(a, b, alpha, beta))
        return np.asarray((3.0 * ROOT3 / 32.0) * np.abs(ratio * regulus_factor(alpha, beta)) ** 3)


@fitting
@arguments.validated(alpha=arguments.shares, beta=arguments.shares)
def best_ratio(alpha: ArrayLike = 0.0, beta: ArrayLike = 0.0) -> Array:
    """Ratio γ = b/a that makes |det J|m largest for a given platform.

    Where 3αβ ≥ 1 there is none: |det J|m grows with the base.

    Parameters
    ----------
    alpha, beta : (...) array_like [1]
        Shares by which the joints of platform and base are separated, in [0, 1], with 3αβ < 1.

    Returns
    -------
    (...) array [1]
        > 0.

    Raises
    ------
    InvalidInput
        On shares outside of [0, 1], or with 3αβ ≥ 1.

    *Source: Lee2000, eqs. (20), (58), (67).*
    """
    mixed = 3.0 * np.asarray(alpha, dtype=np.float64) * np.asarray(beta, dtype=np.float64)
    # Products of shares as 3 · 1/2 · 2/3 are 1 up to rounding.
    if (mixed >= 1.0 - 4.0 * EPS).any():
        raise InvalidInput(expected("alpha, beta", "shares with 3αβ < 1", f"3αβ = {mixed.max():g}"))
    return np.asarray(2.0 * _shape(alpha) / (1.0 - mixed))


@fitting
@arguments.validated(a=arguments.sizes, alpha=arguments.shares)
def absolute_maximum(a: ArrayLike, alpha: ArrayLike = 0.0) -> Array:
    """Largest |det J|m over all bases, |det J|am: at b/a = `best_ratio` [unit³].

    Parameters
    ----------
    a : (...) array_like [unit]
        Side of the platform triangle, > 0.
    alpha : (...) array_like [1]
        Share by which the joints of the platform are separated, in [0, 1].

    Returns
    -------
    (...) array [unit³]

    Raises
    ------
    InvalidInput
        On sides or shares outside of their range, or shapes that do not broadcast.

    *Source: Lee2000, eqs. (21), (59), (68).*

    >>> absolute_maximum(1.0).round(12)
    np.float64(1.299038105677)
    """
    return np.asarray(0.75 * ROOT3 * (np.asarray(a) * np.sqrt(_shape(alpha))) ** 3)


@fitting
@arguments.validated(a=arguments.sizes, b=arguments.sizes, h=HEIGHTS)
def octahedron_volume(a: ArrayLike, b: ArrayLike, h: ArrayLike) -> Array:
    """Volume of the octahedron between platform and base triangle [unit³].

    With b = 2a and h = a it is the `absolute_maximum` of the 3-3 platform.

    Parameters
    ----------
    a, b : array_like that broadcast, shape (...) [unit]
        Sides of platform and base triangle, > 0.
    h : (...) array_like [unit]
        Height, ≥ 0.

    Returns
    -------
    (...) array [unit³]

    Raises
    ------
    InvalidInput
        On sides or heights outside of their range.

    *Source: Lee2000, eqs. (22), (23).*
    """
    return np.asarray(ROOT3 / 12.0 * np.asarray(h) * (np.asarray(a) + np.asarray(b)) ** 2)


@fitting
@arguments.validated(height_ratio=HEIGHTS)
def quality_at_height(height_ratio: ArrayLike) -> Array:
    """λ of the central configuration at h / h_m, with |det J|m for maximum [1].

    8 (h/h_m)³ / (1 + (h/h_m)²)³, for the 3-3, and for the 3-6 and 6-6 as well.

    Parameters
    ----------
    height_ratio : (...) array_like [1]
        h / h_m, the height over the best one, ≥ 0.

    Returns
    -------
    (...) array [1]
        In [0, 1].

    Raises
    ------
    InvalidInput
        On a ratio < 0 or not finite.

    *Source: Lee2000, eq. (24). ERRATUM: the cube is missing in its numerators, and its two
    forms then differ; eqs. (14) and (17) give it with the cube.*
    """
    x = np.asarray(height_ratio, dtype=np.float64)
    return np.asarray((2.0 * x / (1.0 + x * x)) ** 3)
