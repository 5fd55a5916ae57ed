"""Quantities of `Dehaeze2020`, page on the kinematics: strokes and bending for small motions.

The combinations of signs are those of the page: the binary digits of 0 to 24.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp import catalogue
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.published.quantities.common import posture

COMBINATIONS, ANGLES_OF_DIRECTIONS = 2**5, 50


def pure_strokes(design: str, translation: float, rotation: float) -> Array:
    """Least, greatest and total extension of a leg for single small motions [unit]: (3,).

    Translations along x, y, z and turns about x and y [rad], by the Jacobian.
    """
    steps = np.array([translation] * 3 + [rotation] * 2)
    return _range(posture(design).jacobian[:, :5] * steps)


def combined_strokes(design: str, translation: float, rotation: float) -> Array:
    """Least, greatest and total extension of a leg for combined motions [unit]: (3,)."""
    placed, home = _with_home(design)
    moved = placed.at(_combinations(home, translation, rotation))
    return _range(moved.joints - placed.at(home).joints)


def bending(design: str, translation: float, rotation: float, point: Sequence[float]) -> float:
    """Greatest turn of a leg in combined motions about a point of the platform [mrad]."""
    placed, home = _with_home(design)
    placed, home = placed.with_origin(point), home.compose(Pose(point))
    moved = placed.at(_combinations(home, translation, rotation)).jacobian[..., :3]
    start = placed.at(home).jacobian[:, :3]
    # For angles of 1 mrad the chord is more accurate than the arc cosine.
    return float(2e3 * np.arcsin(norm(moved - start) / 2.0).max())


def mobility(design: str, stroke: float) -> float:
    """Radius of the largest ball of translations that extensions of ± stroke allow [unit].

    The directions are those of the page, of which some are along legs to 1e-4.
    """
    polar, azimuth = np.meshgrid(
        np.linspace(0.0, np.pi, ANGLES_OF_DIRECTIONS),
        np.linspace(0.0, 2.0 * np.pi, ANGLES_OF_DIRECTIONS),
    )
    ways = np.stack(
        (np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)), axis=-1
    )
    rates = np.abs(ways @ posture(design).jacobian[:, :3].T)
    return float((stroke / rates.max(axis=-1)).min())


def _with_home(design: str) -> tuple[Design, Pose]:
    placed = catalogue.design(design)
    if placed.home is None:
        raise InvalidInput(expected("design", "one with a home pose", design))
    return placed, placed.home


def _combinations(home: Pose, translation: float, rotation: float) -> Pose:
    """Return the poses of all combinations of five signs: (32,)."""
    digits = np.arange(COMBINATIONS)[:, None] >> np.arange(4, -1, -1) & 1
    steps = (2 * digits - 1) * np.array([translation] * 3 + [rotation] * 2)
    turns = np.concatenate((steps[:, 3:], np.zeros((COMBINATIONS, 1))), axis=1)
    return Pose.from_rpy(home.position + steps[:, :3], turns)


def _range(values: Array) -> Array:
    least, greatest = values.min(), values.max()
    return np.array([least, greatest, greatest - least])


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {f.__name__: f for f in (pure_strokes, combined_strokes, bending, mobility)}
)
