"""Closed forms of the platforms with separated joints: Lee2000, chapter 8.

Both have legs of two lengths, and both are best at a twist θ about the vertical that is not zero.
"Central" means: platform parallel to the base at the height h, centres above each other. The
height that is best for a twist is known in closed form; the best twist is found numerically.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.errors import InvalidInput, brief, expected
from gsp.families.fitting import fitting
from gsp.families.lee.platforms import ROOT3
from gsp.geometry.copies import read_only_tuple
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array

# Any height is as good as its mirror image; sides and share are as for the designs.
CHECKS = {
    "a": arguments.size,
    "b": arguments.size,
    "rho": arguments.shares,
    "theta": arguments.moderate,
    "h": arguments.optional(arguments.moderate),
}


@read_only_tuple
class Separated(NamedTuple):
    """Height, leg lengths and |det J| of a central configuration.

    Attributes
    ----------
    height : (...) array [unit]
    lengths : two (...) arrays [unit]
        Outer then inner legs (`to_centre`), or legs 1, 3, 5 then 2, 4, 6 (`along_side`).
    determinant : (...) array [unit³]
        |det J|.
    """

    height: Array
    lengths: tuple[Array, Array]
    determinant: Array


@fitting
@arguments.validated(**CHECKS)
def to_centre(
    a: float, b: float, rho: ArrayLike, theta: ArrayLike, h: ArrayLike | None = None
) -> Separated:
    """Leg lengths and |det J| of `separated_to_centre` in the central configuration.

    Parameters
    ----------
    a, b : float [unit]
        Sides of platform and base triangle, from 1e-100 to 1e100.
    rho, theta : array_like that broadcast, shape (...) [1, rad]
        Share by which joints are separated, in [0, 1], and twist.
    h : array_like or None [unit]
        Height; None takes the best one, h = (l_i² − h²)^¼ (l_o² − h²)^¼, which eq. (73) is.

    Returns
    -------
    Separated
        Height, leg lengths and |det J|, each of shape (...); |det J| is NaN where a leg has no
        length.

    Raises
    ------
    InvalidInput
        On sides or shares outside of their range.

    *Source: Lee2000, eqs. (70)–(73). ERRATUM: eq. (72) has (ρ² − 2ρ + 2) sin θ; it is
    (ρ² − 2ρ) sin θ, and without it the 3-3, ρ = 0, would not have the cos θ of eq. (36).*
    """
    rho, theta = np.asarray(rho, dtype=np.float64), np.asarray(theta, dtype=np.float64)
    inner = (1.0 - rho) * _third_side(a, b, theta - np.pi / 3.0) / ROOT3
    outer = _third_side(a, b, theta + np.pi / 3.0) / ROOT3
    less = rho**2 - 2.0 * rho
    factor = (ROOT3 * (less + 2.0) * np.cos(theta) - less * np.sin(theta)) * (1.0 - rho) ** 2
    return assembled(a, b, 0.375 * factor, outer, inner, h)


@fitting
@arguments.validated(**CHECKS)
def along_side(
    a: float, b: float, rho: ArrayLike, theta: ArrayLike, h: ArrayLike | None = None
) -> Separated:
    """Leg lengths and |det J| of `separated_along_side` in the central configuration.

    Parameters
    ----------
    a, b : float [unit]
        Sides of platform and base triangle, from 1e-100 to 1e100.
    rho, theta : array_like that broadcast, shape (...) [1, rad]
        Share by which joints are separated, in [0, 1], and twist.
    h : array_like or None [unit]
        Height; None takes the best one, (l_1² − h²)^¼ (l_2² − h²)^¼ (ours, as eq. (73)).

    Returns
    -------
    Separated
        Height, leg lengths and |det J|, each of shape (...); |det J| is NaN where a leg has no
        length.

    Raises
    ------
    InvalidInput
        On sides or shares outside of their range.

    *Source: Lee2000, eqs. (75)–(77).*
    """
    rho, theta = np.asarray(rho, dtype=np.float64), np.asarray(theta, dtype=np.float64)
    # The moved triangle is smaller by this factor, and turned by this angle.
    smaller = np.sqrt(3.0 * rho**2 - 3.0 * rho + 1.0)
    turn = np.arctan(ROOT3 * (2.0 * rho - 1.0))
    odd = _third_side(a * smaller, b, theta - turn) / ROOT3
    even = _third_side(a, b * smaller, theta + turn) / ROOT3
    quintic = np.polyval([6.0, -15.0, 20.0, -15.0, 6.0, -1.0], rho)
    return assembled(a, b, 0.75 * ROOT3 * quintic * np.cos(theta), odd, even, h)


def _third_side(a: ArrayLike, b: ArrayLike, angle: ArrayLike) -> Array:
    """Return sqrt(a² + b² − 2 a b cos) as a sum of squares, which rounding makes not negative."""
    across = 2.0 * np.sqrt(a) * np.sqrt(b) * np.sin(0.5 * np.asarray(angle))
    return np.asarray(np.hypot(np.subtract(a, b), across))


def assembled(
    a: float, b: float, factor: Array, first: Array, second: Array, h: ArrayLike | None
) -> Separated:
    """Return the configuration with legs of two horizontal lengths; |det J| is NaN if one is 0."""
    best = np.sqrt(first) * np.sqrt(second)
    height = best if h is None else np.asarray(h, dtype=np.float64)
    lengths = np.hypot(first, height), np.hypot(second, height)
    # Divided before it is multiplied, so that cubes of large lengths do not overflow.
    short, long = np.minimum(*lengths), np.maximum(*lengths)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = a * (height / short) * (b / long)
    return Separated(height, lengths, np.asarray(np.abs(factor) * np.abs(ratio) ** 3))


@arguments.validated(
    closed_form=arguments.function, a=arguments.size, b=arguments.size, rho=arguments.share
)
def best_central_pose(
    closed_form: Callable[..., Separated], a: float, b: float, rho: float
) -> tuple[float, float, Pose]:
    """Return the best central configuration: |det J|m, the twist θ in (−90°, 90°), and the pose.

    The best over heights and twists, as the dissertation searched; over all poses there may be
    better ones, with a = 1 and b = 2 from ρ ≈ 0.74 on (`to_centre`) and for ρ from 0.325 to 0.675
    (`along_side`): see `gsp.determinant.maximum`.

    Parameters
    ----------
    closed_form : `to_centre` or `along_side`
    a, b : float [unit]
    rho : float [1]

    Returns
    -------
    value : float [unit³]
    theta : float [rad]
    pose : Pose

    Raises
    ------
    InvalidInput
        On another closed form, sides that are not positive, or ρ outside of [0, 1].

    Examples
    --------
    >>> value, theta, pose = best_central_pose(to_centre, 1.0, 2.0, 0.2)
    >>> round(float(np.rad2deg(theta)), 1), pose.position.round(4)
    (-3.7, array([0.    , 0.    , 0.8938]))

    *Source: Lee2000, figures 19–21 and 29–31 show it for a = 1, b = 2.*
    """
    if closed_form is not to_centre and closed_form is not along_side:
        raise InvalidInput(expected("closed_form", "to_centre or along_side", brief(closed_form)))
    twists = np.linspace(-np.pi / 2, np.pi / 2, 722)[1:-1]
    return best_of(lambda twist: closed_form(a, b, rho, twist), twists)


def best_of(closed: Callable[[ArrayLike], Separated], twists: Array) -> tuple[float, float, Pose]:
    """Return the best configuration near the best one of some twists [rad], as a root."""
    from scipy.optimize import brentq

    def slope(angle: float) -> float:
        step = 1e-5
        up, down = closed(np.array([angle + step, angle - step])).determinant
        return float(np.log(up / down))

    values = np.nan_to_num(closed(twists).determinant)
    at = int(np.argmax(values))
    if not 0.0 < values[at] < np.inf:
        return 0.0, float("nan"), Pose([0.0, 0.0, 0.0])
    width = twists[1] - twists[0]
    near = twists[at] - width, twists[at] + width
    theta = float(brentq(slope, *near, xtol=1e-14))
    found = closed(theta)
    pose = Pose.from_rpy([0.0, 0.0, float(found.height)], [0.0, 0.0, theta])
    return float(found.determinant), theta, pose
