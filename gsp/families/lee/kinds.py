"""Platforms with joints separated in one way on the platform, in another on the base.

The dialog of figure 41 of the dissertation has a kind and a percentage for each of both.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.families.fitting import fitting
from gsp.families.lee.platforms import KINDS, base_pairs, design_of, platform_pairs
from gsp.families.lee.separated import Separated, assembled, best_of
from gsp.geometry.pose import Pose
from gsp.model.design import Design


@arguments.validated(
    a=arguments.size,
    b=arguments.size,
    alpha=arguments.share,
    beta=arguments.share,
    top=arguments.one_of(*KINDS),
    base=arguments.one_of(*KINDS),
)
def separated_by_kinds(
    a: float, b: float, alpha: float, beta: float, *, top: str, base: str, unit: str = ""
) -> Design:
    """Return the platform with joints separated in one way on the platform, in another on the base.

    Legs E_A1 A1, E_A2 A2, …, with the joints of a side as the design has them that is separated in
    one way on both: `platform_6_6`, `separated_to_centre`, `separated_along_side`.

    Parameters
    ----------
    a, b : float [unit]
        Sides of the triangles, from 1e-100 to 1e100.
    alpha, beta : float [1]
        Shares of platform and base, in [0, 1]; with 0 and 0 it is the octahedral 3-3.
    top, base : "edges", "centre" or "side"
        Along both edges, one joint toward the centre, one joint along one side.
    unit : str
        Name of the unit of length, for the record.

    Raises
    ------
    InvalidInput

    Examples
    --------
    >>> separated_by_kinds(15.0, 30.0, 0.1, 0.2, top="centre", base="side").name
    'lee-centre-side (a=15, b=30, alpha=0.1, beta=0.2)'

    *Source: Lee2000, figure 41, whose dialog has a kind and a percentage for top and for base; the
    points of eqs. (60), (69), (74).*
    """
    points = base_pairs(b, base, beta), platform_pairs(a, top, alpha)
    extra = f", alpha={alpha:g}, beta={beta:g}"
    return design_of(f"lee-{top}-{base}", *points, a, b, unit, "figure 41", extra)


@fitting
@arguments.validated(
    a=arguments.size,
    b=arguments.size,
    alpha=arguments.share,
    beta=arguments.share,
    theta=arguments.moderate,
    h=arguments.optional(arguments.moderate),
    top=arguments.one_of(*KINDS),
    base=arguments.one_of(*KINDS),
)
def by_kinds(
    a: float,
    b: float,
    alpha: float,
    beta: float,
    theta: ArrayLike,
    h: ArrayLike | None = None,
    *,
    top: str,
    base: str,
) -> Separated:
    """Leg lengths and |det J| of `separated_by_kinds` in the central configuration.

    The legs are two triples with a three-fold symmetry. With the joints of one leg of each as
    complex numbers p_k and q_k = exp(iθ) q'_k, |det J| is 27/4 h³ |Im(p̄₂q₂ − p̄₁q₁)|
    |p₂q₁ − p₁q₂|² / (l_1 l_2)³, of which the last factor of the numerator does not depend on θ.

    Parameters
    ----------
    a, b : float [unit]
        Sides of platform and base triangle, from 1e-100 to 1e100.
    alpha, beta : float [1]
        Shares of platform and base, in [0, 1].
    theta : array_like, shape (...) [rad]
        Twist.
    h : array_like, shape (...), or None [unit]
        Height; None takes the best one, (l_1² − h²)^¼ (l_2² − h²)^¼.
    top, base : "edges", "centre" or "side"

    Returns
    -------
    Separated
        Height, lengths of legs 1, 3, 5 then 2, 4, 6, and |det J|, each of shape (...); |det J| is
        NaN where a leg has no length.

    Raises
    ------
    InvalidInput
        On sides or shares outside of their range, or other kinds.

    *Source: ours; it is Lee2000, eqs. (61), (72), (77) where both sides are separated in one way.*
    """
    turn = np.exp(1j * np.asarray(theta, dtype=np.float64))
    (p1, p2), (q1, q2) = (
        points[0, :, 0] + 1j * points[0, :, 1]
        for points in (base_pairs(1.0, base, beta), platform_pairs(1.0, top, alpha))
    )
    moment = ((np.conj(p2) * q2 - np.conj(p1) * q1) * turn).imag
    factor = 6.75 * moment * abs(p2 * q1 - p1 * q2) ** 2
    first, second = (np.abs(a * q * turn - b * p) for p, q in ((p1, q1), (p2, q2)))
    return assembled(a, b, factor, first, second, h)


def best_pose_by_kinds(
    a: float, b: float, alpha: float, beta: float, *, top: str, base: str
) -> tuple[float, float, Pose]:
    """Return the best central configuration of `separated_by_kinds`, over heights and twists.

    Parameters
    ----------
    a, b : float [unit]
        Sides of platform and base triangle, from 1e-100 to 1e100.
    alpha, beta : float [1]
        Shares of platform and base, in [0, 1].
    top, base : "edges", "centre" or "side"

    Returns
    -------
    value : float [unit³]
        |det J|, 0 where each is singular.
    theta : float [rad]
        In (−180°, 180°]; NaN where each is singular.
    pose : Pose

    Raises
    ------
    InvalidInput
        See `separated_by_kinds`.

    Examples
    --------
    >>> found = best_pose_by_kinds(1.0, 2.0, 0.2, 0.2, top="centre", base="centre")
    >>> round(float(np.rad2deg(found[1])), 1), found[2].position.round(4)
    (-3.7, array([0.    , 0.    , 0.8938]))

    *Source: ours, as `best_central_pose`*
    """

    def closed(twist: ArrayLike) -> Separated:
        return by_kinds(a, b, alpha, beta, twist, top=top, base=base)

    return best_of(closed, np.linspace(-np.pi, np.pi, 1441)[1:])
