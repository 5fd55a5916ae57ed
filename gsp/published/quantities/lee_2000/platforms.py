"""Anchor points, lines and leg lengths of the platforms of `Lee2000`, and its program."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType

import numpy as np

from gsp.errors import InvalidInput, expected
from gsp.families import lee
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, dot
from gsp.model.design import Design
from gsp.published.quantities.common import numbered

LETTERS = MappingProxyType(
    {
        "lee-3-3": (),
        "lee-3-6": ("beta",),
        "lee-6-6": ("alpha", "beta"),
        "lee-centre": ("rho",),
        "lee-side": ("rho",),
    }
)
# What stands for the letters that a point on one side does not depend on.
ANY = 0.37


def platform(family: str, a: float, b: float, **letters: float) -> Design:
    """Return a platform of a family, which takes all of its letters and no others."""
    wanted = LETTERS.get(family)
    if wanted is None:
        raise InvalidInput(expected("family", "one of " + ", ".join(LETTERS), repr(family)))
    if set(letters) != set(wanted):
        needs = ", ".join(wanted) or "no letters"
        raise InvalidInput(expected(family, needs, ", ".join(sorted(letters)) or "none"))
    return lee.FAMILIES[family](a, b, **letters)


def pose(h: float, theta: float = 0.0, x: float = 0.0, y: float = 0.0) -> Pose:
    """Return the pose of a platform parallel to its base."""
    return Pose.from_rpy([x, y, h], [0.0, 0.0, theta])


def points(family: str, a: float | None = None, b: float | None = None, **letters: float) -> Array:
    """Coordinates x, y of the six anchors on the platform, if a is given, or on the base: (6, 2).

    Of the other side nothing is given, as these anchors do not depend on it.
    """
    if (a is None) == (b is None):
        raise InvalidInput(expected("points", "either a or b", "both" if a else "none"))
    others = {letter: ANY for letter in LETTERS.get(family, ()) if letter not in letters}
    design = platform(family, a or 1.0, b or 1.0, **letters, **others)
    return np.asarray((design.platform_points if b is None else design.base_points)[:, :2])


def turned_points(family: str, a: float, rho: float, theta: float) -> Array:
    """Coordinates x, y of the platform anchors in base axes, turned by theta: (6, 2)."""
    flat = platform(family, a, 1.0, rho=rho).platform_points
    return np.asarray((flat @ pose(0.0, theta).rotation.T)[:, :2])


def ends(leg: int, a: float, b: float, h: float) -> Array:
    """Return the ends (1, x, y, z) of a leg of the 3-3, about its platform's centre: (2, 4)."""
    design = lee.octahedral_3_3(a, b)
    (at,) = numbered("leg", [leg], design.n_legs)
    low = np.append(design.base_points[at, :2], -h)
    return np.column_stack((np.ones(2), np.stack((low, design.platform_points[at]))))


def similarity_error(alpha: float, beta: float) -> float:
    """Largest distance of the joints of a 6-6 platform, a = b = 1, from its base made smaller.

    Turned and scaled about the centre as fits best, by least squares in the complex plane.
    """
    design = platform("lee-6-6", 1.0, 1.0, alpha=alpha, beta=beta)
    top, low = (p[:, 0] + 1j * p[:, 1] for p in (design.platform_points, design.base_points))
    return float(np.abs(top - low * (np.vdot(low, top) / np.vdot(low, low))).max())


def line_of(x1: float, y1: float, z1: float, x2: float, y2: float, z2: float) -> Array:
    """Line coordinates (L, M, N; P, Q, R) of two points, as a force and its moment: (6,)."""
    return lee.line_coordinates([x1, y1, z1], [x2, y2, z2])


def lines(
    family: str,
    a: float,
    b: float,
    h: float,
    x: float = 0.0,
    y: float = 0.0,
    origin: str = "base",
    reversed: Sequence[int] = (),
    **letters: float,
) -> Array:
    """Line coordinates (L, M, N; P, Q, R) of the six legs, not normalised: (6, 6).

    From base to platform, and from platform to base in the legs that are reversed; about the
    centre of the base, or about the point at the height h above it ("platform").
    """
    if origin not in ("base", "platform"):
        raise InvalidInput(expected("origin", '"base" or "platform"', repr(origin)))
    design = platform(family, a, b, **letters)
    low = np.array([0.0, 0.0, -h if origin == "platform" else 0.0])
    found = lee.line_coordinates(design.base_points + low, design.platform_points + low + [x, y, h])
    sign = np.ones(6)
    sign[numbered("reversed", reversed, design.n_legs)] = -1.0
    return np.asarray(found * sign[:, None])


def leg_lengths(
    family: str,
    a: float,
    b: float,
    h: float,
    theta: float = 0.0,
    x: float = 0.0,
    y: float = 0.0,
    **letters: float,
) -> Array:
    """Lengths of the six legs."""
    return platform(family, a, b, **letters).at(pose(h, theta, x, y)).joints


def program_matrix(a: float, b: float, h: float, inverse_root: float | None = None) -> Array:
    """Matrix of figure 42: lines of the 3-3 with 1/√3 as given, by default in full.

    Legs are directed from the base to the platform, and moments have the other sign than (4).
    """
    design = lee.octahedral_3_3(a, b)
    shrink = [1.0, 1.0 if inverse_root is None else inverse_root * np.sqrt(3.0), 1.0]
    top = design.platform_points * shrink + [0.0, 0.0, h]
    found = lee.line_coordinates(design.base_points * shrink, top)
    found = found / np.sqrt(dot(found[:, :3], found[:, :3]))[:, None]
    return np.asarray((found * np.repeat([1.0, -1.0], 3)).T)


def program_determinant(a: float, b: float, h: float, inverse_root: float | None = None) -> float:
    """Return the determinant of the matrix of figure 42."""
    return float(np.linalg.det(program_matrix(a, b, h, inverse_root)))


QUANTITIES = (
    points,
    turned_points,
    similarity_error,
    ends,
    line_of,
    lines,
    leg_lengths,
    program_matrix,
    program_determinant,
)
