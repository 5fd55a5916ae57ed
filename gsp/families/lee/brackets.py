"""det J of a general octahedron as brackets of its vertices: Lee2000, chapter 3, and its shears."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.arguments import bounded_array
from gsp.errors import InvalidInput, expected
from gsp.families.fitting import fitting
from gsp.families.lee.platforms import ROOT3
from gsp.geometry.vectors import Array, cross

# Lengths and coordinates up to it have finite ninth powers.
NINTH_ROOT = 1e33
SIDE = arguments.one(
    arguments.within(1 / NINTH_ROOT, NINTH_ROOT, "a positive number from 1e-33 to 1e33")
)
HEIGHT = arguments.one(arguments.within(-NINTH_ROOT, NINTH_ROOT))
TURNED = {"a": SIDE, "b": SIDE, "h": HEIGHT, "theta": arguments.moderate}


@fitting
def bracket(*points: ArrayLike) -> Array:
    """Return [p q r s]: the determinant of four points (1, x, y, z), 6 × a tetrahedron's volume.

    Parameters
    ----------
    points : four (..., 3) array_like [unit]

    Returns
    -------
    (...) array [unit³]

    Raises
    ------
    InvalidInput
        On a wrong shape, or numbers that are not finite or beyond 1e100.

    *Source: Lee2000, below eq. (25).*
    """
    if len(points) != 4:
        raise InvalidInput(expected("points", "four points", f"{len(points)}"))
    p, q, r, s = (bounded_array(f"points[{i}]", point, (3,)) for i, point in enumerate(points))
    return np.asarray(np.linalg.det(np.stack(np.broadcast_arrays(q - p, r - p, s - p), axis=-2)))


@fitting
def bracket_determinant(base: ArrayLike, platform: ArrayLike) -> Array:
    """Det J* of a general octahedron: the legs' lines not normalised, in the order of the 3-3.

    `det J* = [E_B E_A A C][E_A E_C C B][E_C E_B B A] + [E_B E_A A B][E_A E_C C A][E_C E_B B C]`,
    so |det J| is its absolute value over the product of the six leg lengths.

    Parameters
    ----------
    base, platform : (..., 3, 3) array_like [unit]
        E_A, E_B, E_C and A, B, C, in the same axes.

    Returns
    -------
    (...) array [unit⁹]

    Raises
    ------
    InvalidInput
        On a wrong shape, or numbers that are not finite or beyond 1e33.

    *Source: Lee2000, eq. (25).*
    """
    base = bounded_array("base", base, (3, 3), NINTH_ROOT)
    platform = bounded_array("platform", platform, (3, 3), NINTH_ROOT)
    e_a, e_b, e_c = (base[..., i, :] for i in range(3))
    a, b, c = (platform[..., i, :] for i in range(3))
    first = bracket(e_b, e_a, a, c) * bracket(e_a, e_c, c, b) * bracket(e_c, e_b, b, a)
    second = bracket(e_b, e_a, a, b) * bracket(e_a, e_c, c, a) * bracket(e_c, e_b, b, c)
    return np.asarray(first + second)


@arguments.validated(**TURNED)
def turned_brackets(a: float, b: float, h: float, theta: ArrayLike) -> tuple[Array, Array]:
    r"""Return the brackets of the first and of the second product, turned by θ about the vertical.

    Each product of `bracket_determinant` has three equal brackets.

    Parameters
    ----------
    a, b, h : float [unit]
        Sides of platform and base triangle, > 0, and height; each at most 1e33 in size.
    theta : (...) array_like [rad]

    Returns
    -------
    two (...) arrays [unit³]

    Raises
    ------
    InvalidInput
        On numbers outside of their range.

    *Source: Lee2000, eqs. (34), (35); θ in rad. Both are printed for
    the heights of eq. (27), the platform below its base, which gives both the other sign; with the
    points of eq. (2) they are these. |det J\*| is the same.*
    """
    t = np.asarray(theta, dtype=np.float64)
    sine, cosine = 0.5 * np.sin(t), 0.5 * ROOT3 * np.cos(t)
    return (cosine - sine) * a * b * h, (cosine + sine) * a * b * h


@arguments.validated(**TURNED)
def turned_determinant(a: float, b: float, h: float, theta: ArrayLike) -> Array:
    """|det J*| of the 3-3 platform turned by θ about the vertical [unit⁹].

    Parameters
    ----------
    a, b, h : float [unit]
        Sides of platform and base triangle, > 0, and height; each at most 1e33 in size.
    theta : (...) array_like [rad]

    Returns
    -------
    (...) array [unit⁹]

    Raises
    ------
    InvalidInput
        On numbers outside of their range.

    *Source: Lee2000, eqs. (26), (36), which hold for |θ| ≤ 90°; with |cos θ| for any θ in rad.*
    """
    return np.asarray(0.75 * ROOT3 * (a * b * h) ** 3 * np.abs(np.cos(theta)))


@arguments.validated(x=arguments.number, y=arguments.number, h=arguments.size)
def shear(x: float, y: float, h: float) -> Array:
    """Return T (4, 4), which moves points (1, x, y, z) of the plane z = −h by (x, y).

    Parameters
    ----------
    x, y : float [unit]
        Translation of the plane z = −h.
    h : float [unit]
        > 0.

    Returns
    -------
    (4, 4) array [1]
        For points in homogeneous coordinates.

    Raises
    ------
    InvalidInput
        If `x` or `y` is not a number, or `h` is not a number > 0.

    *Source: Lee2000, eq. (31).*
    """
    matrix = np.eye(4)
    matrix[1, 3], matrix[2, 3] = -x / h, -y / h
    return matrix


@arguments.validated(x=arguments.number, y=arguments.number, h=arguments.size)
def shear_of_lines(x: float, y: float, h: float) -> Array:
    """Return the map of line coordinates (L, M, N; P, Q, R) by `shear`: (6, 6), determinant one.

    Parameters
    ----------
    x, y : float [unit]
        Translation of the plane z = −h.
    h : float [unit]
        > 0.

    Returns
    -------
    (6, 6) array [1]

    Raises
    ------
    InvalidInput
        If `x` or `y` is not a number, or `h` is not a number > 0.

    *Source: Lee2000, eq. (33).*
    """
    matrix = np.eye(6)
    matrix[0, 2], matrix[1, 2] = -x / h, -y / h
    matrix[5, 3], matrix[5, 4] = x / h, y / h
    return matrix


@fitting
def line_coordinates(start: ArrayLike, end: ArrayLike) -> Array:
    """Line coordinates (L, M, N; P, Q, R) of the join of two points, not normalised: (..., 6).

    Parameters
    ----------
    start, end : (..., 3) array_like [unit]

    Returns
    -------
    (..., 6) array [unit, unit²]
        Direction, then moment about the origin.

    Raises
    ------
    InvalidInput
        On a wrong shape, or numbers that are not finite or beyond 1e100.

    *Source: Lee2000, eqs. (3), (4).*
    """
    p, q = bounded_array("start", start, (3,)), bounded_array("end", end, (3,))
    p, q = np.broadcast_arrays(p, q)
    return np.concatenate((q - p, cross(p, q)), axis=-1)
