"""Designs of Lee's dissertation: points, pairings, names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from gsp import arguments
from gsp.geometry.vectors import Array
from gsp.model.design import Design

ROOT3 = float(np.sqrt(3.0))
# How the two joints at a vertex are separated: along both edges (α, β; figure 13), one of them
# toward the centre (figure 18), one of them along one side (figure 28).
EDGES, CENTRE, SIDE = "edges", "centre", "side"
KINDS = (EDGES, CENTRE, SIDE)


def platform_triangle(a: float) -> Array:
    """Return A, B, C of a platform of side a, centred: (3, 3).

    *Source: Lee2000, eq. (2).*
    """
    return a * np.array(
        [[0.5, 0.5 / ROOT3, 0.0], [-0.5, 0.5 / ROOT3, 0.0], [0.0, -1.0 / ROOT3, 0.0]]
    )


def base_triangle(b: float) -> Array:
    """Return E_A, E_B, E_C of a base of side b, centred: (3, 3).

    *Source: Lee2000, eq. (2).*
    """
    return -platform_triangle(b)[[1, 2, 0]]


def platform_pairs(a: float, kind: str, share: float) -> Array:
    """Return A_1, A_2, then B and C: (3, 2, 3); with the share 0 both are the vertex.

    *Source: Lee2000, eqs. (60), (69), (74).*
    """
    vertex = platform_triangle(a)
    if kind == EDGES:  # A1 lies toward C, A2 toward B
        return np.stack((_toward(vertex, 2, share), _toward(vertex, 1, share)), axis=1)
    if kind == CENTRE:
        return np.stack((vertex, (1.0 - share) * vertex), axis=1)
    return np.stack((_toward(vertex, 2, share), vertex), axis=1)


def base_pairs(b: float, kind: str, share: float) -> Array:
    """Return E_A1, E_A2, then E_B and E_C: (3, 2, 3); with the share 0, E_A and E_B.

    *Source: Lee2000, eqs. (60), (69), (74).*
    """
    first = base_triangle(b)
    second = first[[1, 2, 0]]
    if kind == CENTRE:
        return np.stack((first, (1.0 - share) * second), axis=1)
    moved = _toward(second, 2, share)
    # E_A1 lies toward E_B, E_A2 on the same side next to E_B.
    return np.stack((_toward(first, 1, share) if kind == EDGES else first, moved), axis=1)


@arguments.validated(a=arguments.size, b=arguments.size)
def octahedral_3_3(a: float, b: float, *, unit: str = "") -> Design:
    """Return the octahedral 3-3 platform: a platform triangle of side a on a base triangle of b.

    Legs E_A A, E_B A, E_B B, E_C B, E_C C, E_A C.

    Parameters
    ----------
    a, b : float [unit]
        Sides, from 1e-100 to 1e100.
    unit : str
        Name of the unit of length, for the record.

    Raises
    ------
    InvalidInput

    Examples
    --------
    >>> octahedral_3_3(a=1.0, b=2.0).name
    'lee-3-3 (a=1, b=2)'

    *Source: Lee2000, eq. (2), figure 2.*
    """
    return _hexagonal("lee-3-3", a, b, 0.0, 0.0, unit, "eq. (2)", "")


@arguments.validated(a=arguments.size, b=arguments.size, beta=arguments.share)
def platform_3_6(a: float, b: float, beta: float, *, unit: str = "") -> Design:
    """Return the 3-6 platform: base joints separated by βb along the sides of the base triangle.

    Legs E_A1 A, E_A2 A, E_B1 B, E_B2 B, E_C1 C, E_C2 C.

    Parameters
    ----------
    a, b : float [unit]
        Sides of the triangles, from 1e-100 to 1e100.
    beta : float [1]
        In [0, 1]; 0 is the octahedral 3-3, at 1/2 it is singular in every pose.
    unit : str
        Name of the unit of length, for the record.

    Raises
    ------
    InvalidInput

    *Source: Lee2000, eq. (44), figure 11; with E_A1 as eq. (60) has it. ERRATUM: eq. (44) prints
    its second coordinate without the √3.*
    """
    return _hexagonal("lee-3-6", a, b, 0.0, beta, unit, "eq. (44)", f", beta={beta:g}")


@arguments.validated(
    a=arguments.size, b=arguments.size, alpha=arguments.share, beta=arguments.share
)
def platform_6_6(a: float, b: float, alpha: float, beta: float, *, unit: str = "") -> Design:
    """Return the 6-6 platform: joints separated by αa on the platform and by βb on the base.

    Legs E_A1 A1, E_A2 A2, E_B1 B1, E_B2 B2, E_C1 C1, E_C2 C2.

    Parameters
    ----------
    a, b : float [unit]
        Sides of the triangles, from 1e-100 to 1e100.
    alpha, beta : float [1]
        In [0, 1]; where 3αβ − 2α − 2β + 1 = 0 it is singular in every pose.
    unit : str
        Name of the unit of length, for the record.

    Raises
    ------
    InvalidInput

    *Source: Lee2000, eq. (60), figure 13.*
    """
    extra = f", alpha={alpha:g}, beta={beta:g}"
    return _hexagonal("lee-6-6", a, b, alpha, beta, unit, "eq. (60)", extra)


@arguments.validated(a=arguments.size, b=arguments.size, rho=arguments.share)
def separated_to_centre(a: float, b: float, rho: float, *, unit: str = "") -> Design:
    """Return the platform with one of each pair of joints moved toward the centre by the share ρ.

    The outer legs E_A1 A1, E_B1 B1, E_C1 C1 join E_A A, E_B B, E_C C; the inner ones join the
    shrunk E_B, E_C, E_A with the shrunk A, B, C.

    Parameters
    ----------
    a, b : float [unit]
        Sides of the triangles, from 1e-100 to 1e100.
    rho : float [1]
        In [0, 1]; 0 is the octahedral 3-3.
    unit : str
        Name of the unit of length, for the record.

    Raises
    ------
    InvalidInput

    *Source: Lee2000, eq. (69), figure 18.*
    """
    points = base_pairs(b, CENTRE, rho), platform_pairs(a, CENTRE, rho)
    return design_of("lee-centre", *points, a, b, unit, "eq. (69)", f", rho={rho:g}")


@arguments.validated(a=arguments.size, b=arguments.size, rho=arguments.share)
def separated_along_side(a: float, b: float, rho: float, *, unit: str = "") -> Design:
    """Return the platform with one of each pair of joints moved along a side of the triangle.

    Legs E_A1 A1, E_A2 A2, …: from a vertex of the base to a moved joint of the platform, and from
    a moved joint of the base to a vertex of the platform.

    Parameters
    ----------
    a, b : float [unit]
        Sides of the triangles, from 1e-100 to 1e100.
    rho : float [1]
        In [0, 1], share of the side; 0 is the octahedral 3-3, at 1/2 it is singular in every pose.
    unit : str
        Name of the unit of length, for the record.

    Raises
    ------
    InvalidInput

    *Source: Lee2000, eq. (74), figure 28.*
    """
    points = base_pairs(b, SIDE, rho), platform_pairs(a, SIDE, rho)
    return design_of("lee-side", *points, a, b, unit, "eq. (74)", f", rho={rho:g}")


FAMILIES: Mapping[str, Callable[..., Design]] = MappingProxyType(
    {
        "lee-3-3": octahedral_3_3,
        "lee-3-6": platform_3_6,
        "lee-6-6": platform_6_6,
        "lee-centre": separated_to_centre,
        "lee-side": separated_along_side,
    }
)


def joint_names(family: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the names of the joints of the six legs on base and platform, such as "E_A1" and "A1".

    Parameters
    ----------
    family : str
        A key of `FAMILIES`.

    Returns
    -------
    two tuples of str

    Raises
    ------
    InvalidInput
        If there is no such family.

    Examples
    --------
    >>> joint_names("lee-3-6")[1]
    ('A', 'A', 'B', 'B', 'C', 'C')

    *Source: Lee2000, figures 2, 11, 13, 18, 28.*
    """
    family = arguments.one_of(*FAMILIES)("family", family)
    single_ended = tuple(letter for letter in "ABC" for _ in range(2))
    double = tuple(f"{letter}_{k}" for letter in "ABC" for k in (1, 2))
    if family == "lee-3-3":
        return ("E_A", "E_B", "E_B", "E_C", "E_C", "E_A"), single_ended
    base = tuple(f"E_{name.replace('_', '')}" for name in double)
    return base, single_ended if family == "lee-3-6" else double


def _hexagonal(
    family: str, a: float, b: float, alpha: float, beta: float, unit: str, place: str, extra: str
) -> Design:
    points = base_pairs(b, EDGES, beta), platform_pairs(a, EDGES, alpha)
    return design_of(family, *points, a, b, unit, place, extra)


def _toward(points: Array, step: int, share: float) -> Array:
    """Move the points of a triangle toward the next (1) or the previous (2) by a share."""
    return points + share * (np.roll(points, -step, axis=0) - points)


def design_of(
    family: str,
    base: Array,
    platform: Array,
    a: float,
    b: float,
    unit: str,
    place: str,
    extra: str,
) -> Design:
    """Return a design of six SPS legs from pairs of points, (3, 2, 3) each, with its name."""
    return Design(
        legs=["D1"] * 6,
        base_points=base.reshape(6, 3),
        platform_points=platform.reshape(6, 3),
        unit=unit,
        name=f"{family} (a={a:g}, b={b:g}{extra})",
        source=f"Lee2000, {place}",
    )
