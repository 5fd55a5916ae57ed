"""The equations (3.3) to (3.7) of `Workspace-3`, term by term as printed."""

from __future__ import annotations

import numpy as np

from gsp.catalogue import design as published_design
from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import Array
from gsp.published.quantities.workspace.six_three import NAME, leg_lengths_at

A, B, D = 10.0, 15.0, 1.0
PLACE, ANGLES = np.array([0.3, -0.7, 6.0]), np.array([0.2, -0.3, 0.4])


def _corner(number: int) -> Array:
    """X, Y, Z of T1, T2 or T3: eqs. (3.4) and (3.6), which differ in letters only."""
    alpha, beta, gamma = ANGLES
    turn, sign = ((np.pi / 3, 1), (0.0, -1), (-np.pi / 3, 1))[number - 1]
    s, c = np.sin(gamma + turn), np.cos(gamma + turn)
    offset = np.array(
        [
            np.sin(alpha) * np.sin(beta) * s + np.cos(beta) * c,
            np.cos(alpha) * s,
            np.sin(alpha) * np.cos(beta) * s - np.sin(beta) * c,
        ]
    )
    return np.asarray(PLACE + sign * A / np.sqrt(3.0) * offset)


def _squared(leg: int, sixth: bool) -> float:
    """Square of a length; with the term of eq. (3.7) in leg 6, or that of (3.3) and (3.5)."""
    r3 = np.sqrt(3.0)
    x, y, z = _corner((leg + 1) // 2)
    last = y + D / 2 + B / 2 if sixth else y + D / 2
    terms = (
        (x - D / (2 * r3) - B / r3, y - D / 2),
        (x - D / (2 * r3) + B / (2 * r3), y - D / 2 - B / 2),
        (x + D / r3 + B / (2 * r3), y - B / 2),
        (x + D / r3 + B / (2 * r3), y + B / 2),
        (x - D / (2 * r3) + B / (2 * r3), y + D / 2 + B / 2),
        (x - D / (2 * r3) - B / r3, last),
    )
    return float(terms[leg - 1][0] ** 2 + terms[leg - 1][1] ** 2 + z**2)


def formula_errors(equation: str) -> Array:
    """Errors of a printed equation for the six legs at a general pose, against the design.

    For (3.3) and (3.7) of the lengths, for (3.5) of its six left sides, which should vanish.
    """
    if equation not in ("(3.3)", "(3.5)", "(3.7)"):
        raise InvalidInput(expected("equation", '"(3.3)", "(3.5)" or "(3.7)"', repr(equation)))
    lengths = leg_lengths_at(PLACE.tolist(), np.rad2deg(ANGLES).tolist())
    squares = np.array([_squared(leg, equation == "(3.7)") for leg in range(1, 7)])
    return np.asarray(lengths**2 - squares if equation == "(3.5)" else np.sqrt(squares) - lengths)


def base_sides() -> Array:
    """Sides of the base hexagon of eq. (3.3), the short one and the long one."""
    points = published_design(NAME).base_points
    sides = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)
    return np.array([sides.min(), sides.max()])


QUANTITIES = (formula_errors, base_sides)
