"""Joints separated toward the centre or along a side: chapter 8 of `Lee2000`, for a = 1, b = 2."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar, root

from gsp.determinant import log_determinant, maximum
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices import manipulability
from gsp.model.design import Design
from gsp.published.quantities.lee_2000.platforms import platform, pose

# Starts of the search: twists within 90° and heights; below it |det J| counts as zero.
TWISTS = np.deg2rad(np.arange(-87.0, 88.0, 3.0))
HEIGHTS = np.geomspace(0.02, 1.6, 24)
ZERO_DETERMINANT = 1e-12


@lru_cache(maxsize=256)
def _best(family: str, rho: float) -> tuple[float, float, float]:
    """|det J|, twist [rad] and height of the best central configuration, in the assembled rows."""
    design = _design(family, rho)
    theta, height = (values.ravel() for values in np.meshgrid(TWISTS, HEIGHTS))
    turns = np.stack((np.zeros_like(theta), np.zeros_like(theta), theta), axis=-1)
    places = np.stack((np.zeros_like(height), np.zeros_like(height), height), axis=-1)
    values = np.nan_to_num(manipulability(design.at(Pose.from_rpy(places, turns))))
    at = int(values.argmax())
    if values[at] < ZERO_DETERMINANT:
        return 0.0, float("nan"), float("nan")

    def slopes(u: Array) -> Array:
        return np.asarray(log_determinant(design, pose(u[1], u[0]))[1][[5, 2]])

    found = root(slopes, [theta[at], height[at]], tol=1e-13).x
    best = float(manipulability(design.at(pose(found[1], found[0]))))
    return best, float(found[0]), float(found[1])


def _design(family: str, rho: float) -> Design:
    return platform(family, 1.0, 2.0, **({} if family == "lee-3-3" else {"rho": rho}))


def best_central(family: str, rho: float, what: str) -> float:
    """Of the best central configuration: |det J| ("value"), twist [deg] ("theta") or height ("h").

    Searched over twists within 90° and heights.
    """
    value, theta, h = _best(family, rho)
    found = {"value": value, "theta": float(np.rad2deg(theta)), "h": h}
    if what not in found:
        raise InvalidInput(expected("what", "one of " + ", ".join(found), repr(what)))
    return found[what]


def trend(family: str, what: str, rho: Sequence[float]) -> Array:
    """Return how `best_central` changes from each ρ to the next: 1 rises, −1 falls."""
    values = [best_central(family, float(value), what) for value in rho]
    return np.asarray(np.sign(np.diff(values)))


def turning_rho(family: str) -> float:
    """Where the best twist, as a function of ρ < 1/2, is largest."""
    found = minimize_scalar(
        lambda rho: -abs(best_central(family, float(rho), "theta")),
        bounds=(0.02, 0.48),
        method="bounded",
        options={"xatol": 1e-6},
    )
    return float(found.x)


def singular_turns(
    family: str, axis: str, about: str, rho: float = 0.0, step: float = 0.0
) -> Array:
    """Return the turns [deg] from the best configuration to singularity, backward and forward.

    About a line through the platform origin, or through the base origin, in the direction
    of an axis of the base. With a step [deg], the nearest multiples of it.
    """
    if axis not in ("x", "y", "z") or about not in ("own", "base"):
        raise InvalidInput(expected("axis, about", '"x", "y", "z"; "own", "base"', (axis, about)))
    design, (_, theta, h) = _design(family, rho), _best(family, rho)
    best, unit = pose(h, theta), np.eye(3)["xyz".index(axis)]

    def signed(angle: ArrayLike) -> Array:
        turn = _turn(unit, np.deg2rad(angle))
        position = turn @ best.position if about == "base" else best.position
        posture = design.at(Pose(position, turn @ best.rotation))
        rows = np.where(posture.defined[..., None, None], posture.jacobian, 0.0)
        return np.where(posture.defined, np.linalg.det(rows), np.nan)

    turns = np.array([_first_zero(signed, -1.0), _first_zero(signed, 1.0)])
    return step * np.round(turns / step) if step else turns


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


def _around(family: str, rho: float, r: float, directions: Array) -> Array:
    """λ around the best configuration, at a distance r in directions [rad] parallel to the base."""
    value, theta, h = _best(family, rho)
    place = np.stack(
        (r * np.cos(directions), r * np.sin(directions), np.full_like(directions, h)), axis=-1
    )
    rotation = np.broadcast_to(pose(h, theta).rotation, (*directions.shape, 3, 3))
    return manipulability(_design(family, rho).at(Pose(place, rotation))) / value


def contour_asymmetry(family: str, rho: float, r: float) -> Array:
    """Largest difference of λ at a distance r, after a third of a turn, and if mirrored.

    Mirrored in the line through the centre for which this difference is least.
    """
    steps = 1800
    values = _around(family, rho, r, 2.0 * np.pi * np.arange(steps) / steps)
    turned = np.abs(np.roll(values, steps // 3) - values).max()
    mirrored = [np.abs(np.roll(values[::-1], k) - values).max() for k in range(steps // 3)]
    return np.array([turned, min(mirrored)])


def contour_spread(family: str, rho: float, r: float) -> float:
    """Greatest less least λ at a distance r around the best configuration."""
    return float(np.ptp(_around(family, rho, r, 2.0 * np.pi * np.arange(360) / 360)))


def height_trend(family: str, rho: float, ratios: Sequence[float]) -> Array:
    """Return how λ changes from each multiple of the best height to the next: 1 rises, −1 falls."""
    _, theta, h = _best(family, rho)
    design = _design(family, rho)
    values = [float(manipulability(design.at(pose(ratio * h, theta)))) for ratio in ratios]
    return np.asarray(np.sign(np.diff(values)))


@lru_cache(maxsize=16)
def largest_over_central(family: str, rho: float) -> float:
    """Return the largest |det J| of all poses over that of the best central configuration."""
    return maximum(_design(family, rho), seed=1, store=False).value / _best(family, rho)[0]


QUANTITIES = (
    best_central,
    trend,
    largest_over_central,
    turning_rho,
    singular_turns,
    contour_asymmetry,
    contour_spread,
    height_trend,
)
