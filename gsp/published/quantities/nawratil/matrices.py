"""The matrices D, N and T of `Nawratil` as he writes them, and the equations (30), (33) solved.

They are built from his equations with points and lines in one frame, in his order of a twist,
(ω, v), and use no posture: what `gsp.indices` computes is compared with them.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import eigh
from scipy.optimize import root

from gsp.errors import InvalidInput
from gsp.families.nawratil import line_configuration
from gsp.geometry.vectors import Array, cross, norm, skew, unit

# Places of (ω_z, v_x, v_y), the rates of a motion in the xy-plane.
PLANAR = np.ix_([2, 3, 4], [2, 3, 4])


def velocity_matrix(points: Array) -> Array:
    """Return the maps from a twist to the velocities of points, (n, 3, 6). *Source: eq. (2)*."""
    identity = np.broadcast_to(np.eye(3), (len(points), 3, 3))
    return np.concatenate((-skew(points), identity), axis=-1)


def ellipsoid_matrix(semi_axes: Array, height: float = 0.0) -> Array:
    """D of the six vertices, for a centre at a height on the z-axis. *Source: eq. (12)*."""
    vertices = np.concatenate((np.diag(semi_axes), -np.diag(semi_axes)))
    speeds = velocity_matrix(vertices + np.array([0.0, 0.0, height])).reshape(-1, 6)
    return np.asarray(speeds.T @ speeds)


def normal_matrix(feet: Array, directions: Array) -> Array:
    """N of lines through feet. *Source: eqs. (1), (6)*."""
    u = unit(directions)
    rows = np.concatenate((cross(feet, u), u), axis=-1)
    return np.asarray(rows.T @ rows)


def passive_rows(points: Array, others: Array) -> Array:
    """Rows of the velocity of points across the legs to the others, over the leg lengths.

    Of platform anchors they give the rates of the base joints, and the other way round.
    *Source: eqs. (18)–(20)*.
    """
    length = norm(points - others)[:, None, None]
    u = unit(points - others)
    across = np.eye(3) - u[:, :, None] * u[:, None, :]
    return np.asarray((across @ velocity_matrix(points) / length).reshape(-1, 6))


def angular_matrix(base: Array, platform: Array) -> Array:
    """T of legs between anchor points. *Source: eqs. (18)–(20), (22)*."""
    rows = np.concatenate((passive_rows(platform, base), passive_rows(base, platform)))
    return np.asarray(rows.T @ rows)


def isotropic_lines(g: int, p: float) -> Array:
    """Return [r, h, t] that make D and N similar, by solving the equations (30)."""
    d = np.diag(ellipsoid_matrix(np.array([1.0, 1.0, p])))

    def defects(unknowns: Array) -> Array:
        r, h, t = unknowns
        ratio = d / np.diag(normal_matrix(*line_configuration(g, r, h, t)))
        return ratio[[0, 0, 0]] / ratio[[2, 3, 5]] - 1.0

    return _solved(defects, np.array([0.5, 0.7, 0.7]))


def lines_for(g: int, p: float, mu: float) -> tuple[Array, Array]:
    """Feet and directions of the lines that make D and N similar. *Source: eq. (31)*."""
    r, h, t = isotropic_lines(g, p)
    return line_configuration(g, r, h, t, mu)


def best_anchors(g: int, p: float) -> Array:
    """Return [a, b], a < b, of anchors on those lines that make T and N similar: eqs. (33)."""
    feet, directions = lines_for(g, p, 0.0)
    n = np.diag(normal_matrix(feet, directions))

    def defects(unknowns: Array) -> Array:
        x, y = (feet + place * directions for place in unknowns)
        ratio = np.diag(angular_matrix(x, y)) / n
        return ratio[[0, 0]] / ratio[[2, 3]] - 1.0

    return np.sort(_solved(defects, np.array([-1.0, 0.1])))


def anchors(g: int, p: float, mu: float) -> tuple[Array, Array]:
    """Anchor points x, y of the isotropic designs. *Source: eq. (32); (30) and (33) solved*."""
    feet, directions = lines_for(g, p, mu)
    a, b = best_anchors(g, p)
    return feet + a * directions, feet + b * directions


def root_of_eigenvalue_ratio(matrix: Array, n: Array) -> float:
    """Root of greatest over least generalised eigenvalue of (matrix, N)."""
    values = eigh(matrix, n, eigvals_only=True)
    return float(np.sqrt(values[-1] / values[0]))


def _solved(defects: Callable[[Array], Array], start: Array) -> Array:
    found = root(defects, start, tol=1e-15)
    if np.abs(found.fun).max() > 1e-12:
        raise InvalidInput(f"equations of Nawratil: no solution from {start.tolist()}")
    return np.asarray(found.x, dtype=np.float64)
