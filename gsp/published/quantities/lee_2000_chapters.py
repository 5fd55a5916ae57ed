"""Quantities of single chapters of `Lee2000`: brackets, separated joints, figures' statements."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from gsp.families import lee
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, dot
from gsp.indices import manipulability
from gsp.model.design import Design

_SEPARATED = MappingProxyType(
    {
        "lee-centre": (lee.separated_to_centre, lee.to_centre),
        "lee-side": (lee.separated_along_side, lee.along_side),
    }
)


def planar_maximum(l1: float, l2: float, l3: float) -> float:
    """Largest |det J| of three lines in a plane through the corners of a triangle of these sides.

    Each line in turn is turned to its best direction, from many directions to begin with.
    """
    x = (l1 * l1 + l2 * l2 - l3 * l3) / (2.0 * l1)
    corners = np.array([[0.0, 0.0], [l1, 0.0], [x, np.sqrt(l2 * l2 - x * x)]])
    angles = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (64, 3))
    lines = np.stack((np.cos(angles), np.sin(angles)), axis=-1)
    for _ in range(2000):
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            others = cross(_ray(corners[j], lines[:, j]), _ray(corners[k], lines[:, k]))
            x, y = corners[i]
            best = np.stack(
                (others[:, 0] - y * others[:, 2], others[:, 1] + x * others[:, 2]), axis=-1
            )
            lines[:, i] = best / np.hypot(*best.T)[:, None]
    rays = [_ray(corners[i], lines[:, i]) for i in range(3)]
    return float(np.abs(dot(rays[0], cross(rays[1], rays[2]))).max())


def _ray(corner: Array, direction: Array) -> Array:
    moment = corner[0] * direction[:, 1] - corner[1] * direction[:, 0]
    return np.column_stack((direction, moment))


def _corners(a: float, b: float, h: float, theta: float = 0.0) -> tuple[Array, Array]:
    """E_A, E_B, E_C and A, B, C about the centre of the platform, as eq. (2)."""
    design = lee.octahedral_3_3(a, b)
    turn = Pose.from_rpy([0.0, 0.0, 0.0], [0.0, 0.0, theta]).rotation
    return design.base_points[[0, 2, 4]] - [0.0, 0.0, h], design.platform_points[[0, 2, 4]] @ turn.T


def octahedron_volume(a: float, b: float, h: float) -> float:
    """Volume of the octahedron: tetrahedra from an inner point to its eight faces."""
    (p, q, r), (k, m, n) = _corners(a, b, h)
    middle = np.mean([p, q, r, k, m, n], axis=0)
    faces = ((p, q, r), (k, m, n), (p, q, k), (q, k, m), (q, r, m), (r, m, n), (r, p, n), (p, n, k))
    return sum(abs(float(lee.bracket(middle, *face))) / 6.0 for face in faces)


def bracket_form_error() -> float:
    """Largest difference of eq. (25) from the determinant of the lines of random octahedra."""
    base, top = np.random.default_rng(0).normal(size=(2, 100, 3, 3))
    legs = ((0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (0, 2))
    lines = np.stack([lee.line_coordinates(base[:, i], top[:, j]) for i, j in legs], axis=1)
    both = np.abs(np.linalg.det(lines)), np.abs(lee.bracket_determinant(base, top))
    return float(np.abs(both[0] / both[1] - 1.0).max())


def brackets(product: int, a: float, b: float, h: float, theta: float = 0.0) -> Array:
    """Return the three brackets of the first or of the second product of eq. (25)."""
    (ea, eb, ec), (pa, pb, pc) = _corners(a, b, h, theta)
    points = (
        ((eb, ea, pa, pc), (ea, ec, pc, pb), (ec, eb, pb, pa)),
        ((eb, ea, pa, pb), (ea, ec, pc, pa), (ec, eb, pb, pc)),
    )[product - 1]
    return np.array([float(lee.bracket(*four)) for four in points])


def bracket_vanishes_at(product: int) -> float:
    """Turn about the vertical [deg] at which the brackets of a product vanish."""
    return float(
        brentq(lambda t: float(brackets(product, 1.0, 2.0, 1.0, np.deg2rad(t))[0]), -85.0, 85.0)
    )


def heights(h: float) -> Array:
    """Heights of two base points and two platform points of eq. (2)."""
    base, top = _corners(1.0, 2.0, h)
    return np.array([base[0, 2], base[1, 2], top[0, 2], top[1, 2]])


def sheared_bracket_error(x: float, y: float, h: float) -> float:
    """Change of the brackets of the octahedron when its platform is moved by (x, y)."""
    base, top = _corners(1.3, 2.1, h)
    moved = top + np.array([x, y, 0.0])
    change = lee.bracket(base[1], base[0], moved[0], moved[2])
    return float(change - lee.bracket(base[1], base[0], top[0], top[2]))


def sheared_lines_error(x: float, y: float, h: float) -> float:
    """Largest difference of eq. (33) from the lines of sheared points, eq. (31)."""
    p, q = np.random.default_rng(0).normal(size=(2, 20, 3))
    moved = [(np.c_[np.ones(20), v] @ lee.shear(x, y, h).T)[:, 1:] for v in (p, q)]
    lines = lee.line_coordinates(p, q) @ lee.shear_of_lines(x, y, h).T
    return float(np.abs(lee.line_coordinates(*moved) - lines).max())


def singular_about_parallel_axes(angle: float) -> float:
    """Largest |det J| of the octahedral platform turned about random verticals [deg]."""
    design = lee.octahedral_3_3(1.0, 2.0)
    foot = np.random.default_rng(0).uniform(-2.0, 2.0, (50, 3)) * [1.0, 1.0, 0.0]
    turn = Pose.from_rpy([0.0, 0.0, 0.0], [0.0, 0.0, np.deg2rad(angle)]).rotation
    position = foot + ([0.0, 0.0, 1.0] - foot) @ turn.T
    return float(manipulability(design.at(Pose(position, turn))).max())


def singular_turns(family: str, rho: float, axis: str, about: str) -> Array:
    """Return the turns [deg] from the best configuration to singularity, backward and forward.

    a = 1, b = 2; about a line through the platform's own centre, or through the base origin, in
    the direction of an axis of the base.
    """
    design, best = _best(family, rho)
    unit = np.eye(3)["xyz".index(axis)]

    def signed(angle: ArrayLike) -> Array:
        turn = _turn(unit, np.deg2rad(angle))
        position = turn @ best.position if about == "base" else best.position
        posture = design.at(Pose(position, turn @ best.rotation))
        rows = np.where(posture.defined[..., None, None], posture.jacobian, 0.0)
        return np.where(posture.defined, np.linalg.det(rows), np.nan)

    return np.array([_first_zero(signed, -1.0), _first_zero(signed, 1.0)])


def _turn(axis: Array, angle: ArrayLike) -> Array:
    return Pose.from_rpy(
        np.zeros(3), np.asarray(angle, dtype=np.float64)[..., None] * axis
    ).rotation


def _first_zero(signed: Callable[[ArrayLike], Array], way: float) -> float:
    angles = way * np.linspace(0.0, 179.5, 719)
    values = signed(angles)
    changes = np.flatnonzero(values[:-1] * values[1:] <= 0.0)
    if not changes.size:
        return float("nan")
    at = int(changes[0])
    return float(brentq(lambda t: float(signed(t)), angles[at], angles[at + 1], xtol=1e-12))


def _best(family: str, rho: float) -> tuple[Design, Pose]:
    if family == "lee-3-3":
        return lee.octahedral_3_3(1.0, 2.0), Pose([0.0, 0.0, 1.0])
    make, closed_form = _SEPARATED[family]
    return make(1.0, 2.0, rho), lee.best_central_pose(closed_form, 1.0, 2.0, rho)[2]


def best_central(family: str, rho: float, what: str) -> float:
    """Of the best central configuration for a = 1, b = 2: "value", "theta" [deg] or "h"."""
    value, theta, pose = lee.best_central_pose(_SEPARATED[family][1], 1.0, 2.0, rho)
    found = {"value": value, "theta": np.rad2deg(theta), "h": pose.position[2]}
    return float(found[what])


def best_height_expression(rho: float, theta: float) -> float:
    """Best height of `separated_to_centre` for a = 1, b = 2 at a twist theta [rad]."""
    return float(lee.to_centre(1.0, 2.0, rho, theta).height)


def turning_rho(family: str) -> float:
    """Where the best twist, as a function of rho, turns back."""
    rho = np.linspace(0.02, 0.48, 47)
    twist = [best_central(family, r, "theta") for r in rho]
    at = int(np.argmax(np.abs(twist)))
    slope = np.polynomial.Polynomial.fit(rho[at - 3 : at + 4], twist[at - 3 : at + 4], 6).deriv()
    return float(brentq(slope, rho[at - 1], rho[at + 1]))


def program_matrix(rows: list[int]) -> Array:
    """Rows of the Jacobian of figure 42: lines of the octahedral platform a = h = 15, b = 30.

    In the signs of the figure: legs from the base to the platform, moments the other way round.
    """
    design = lee.octahedral_3_3(15.0, 30.0)
    lines = lee.line_coordinates(
        design.base_points, design.platform_points + np.array([0.0, 0.0, 15.0])
    )
    lines /= np.sqrt(dot(lines[:, :3], lines[:, :3]))[:, None]
    return np.asarray((lines * np.repeat([1.0, -1.0], 3)).T[rows])


def program_determinant() -> float:
    """Return the determinant of the matrix of figure 42."""
    return float(np.linalg.det(program_matrix(list(range(6)))))


CHAPTERS: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        f.__name__: f
        for f in (
            planar_maximum, octahedron_volume, bracket_form_error, brackets, bracket_vanishes_at,
            heights, sheared_bracket_error, sheared_lines_error, singular_about_parallel_axes,
            singular_turns, best_central, best_height_expression, turning_rho, program_matrix,
            program_determinant,
        )
    }
)  # fmt: skip
