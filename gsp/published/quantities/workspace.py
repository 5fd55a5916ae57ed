"""Quantities that `Workspace-3` and `Workspace-A` print."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp.catalogue import design as published_design
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.limits.labels import active_from_label
from gsp.workspace import BifurcationPoint, Shells, bifurcation_point, fixed_orientation

ORDER = "approach-roll"
NAME = "workspace-6-3"


def _point(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float],
    fixed: bool = False,
) -> BifurcationPoint:  # fmt: skip
    """Solve a point of the vertical plane from a guess in a few digits."""
    guess = Pose.from_angles(near, angles_deg, ORDER, degrees=True)
    rotation = guess.rotation if fixed else None
    return bifurcation_point(published_design(NAME), label, guess, held=held, rotation=rotation)


def position(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float],
    fixed: bool = False,
) -> Array:  # fmt: skip
    """Coordinates (x, y, z) of a point at which the joints of a label are at their limits."""
    return _point(label, near, angles_deg, held, fixed).pose.position


def orientation(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float]
) -> Array:
    """Angles (α, β, γ) [deg] of such a point."""
    return _point(label, near, angles_deg, held).pose.angles(ORDER, degrees=True)


def tilt(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float]
) -> float:
    """Angle β [deg] of such a point."""
    return float(_point(label, near, angles_deg, held).pose.angles(ORDER, degrees=True)[1])


def leg_lengths(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float],
    fixed: bool = False,
) -> Array:  # fmt: skip
    """Leg lengths of such a point."""
    return _point(label, near, angles_deg, held, fixed).joints


def leg_lengths_at(position: Sequence[float], angles_deg: Sequence[float]) -> Array:
    """Leg lengths at a pose."""
    pose = Pose.from_angles(position, angles_deg, ORDER, degrees=True)
    return published_design(NAME).at(pose).joints


def radiating_height(lowest: str) -> float:
    """z0 = (z_max + z_min) / 2 of eq. (3.13), for a reading of the lowest position.

    "horizontal": all legs shortest without a turn; "point A": the flipped platform.
    """
    top = position("111111", (0, 0, 13), (0, 0, 0), {})[2]
    if lowest == "horizontal":
        bottom = position("000000", (0, 0, 2.6), (0, 0, 0), {})[2]
    else:
        bottom = position("-0000-", (0, 0, 2.4), (0, -54, 0), {"x": 0.0, "y": 0.0})[2]
    return float(0.5 * (top + bottom))


def lowest_on_axis() -> float:
    """Lowest height z on OZ at which some orientation is within the strokes.

    The lengths do not change if a pose is mirrored in the plane z = 0 of the base points, where
    the platform points lie in a plane too; so the lowest height is minus the highest.
    """
    return -float(position("111111", (0, 0, 13), (0, 0, 0), {})[2])


def ray_angle(
    label: str, near: Sequence[float], angles_deg: Sequence[float], unit: str = "deg"
) -> float:
    """Inclination φ of the ray from u0 through a point, from the negative z-axis: eq. (3.14)."""
    x, y, z = position(label, near, angles_deg, {"y": 0.0})
    phi = np.arctan2(np.hypot(x, y), radiating_height("horizontal") - z)
    return float(np.rad2deg(phi) if unit == "deg" else phi)


def half_turn_less(angle: float) -> float:
    """π − angle: the range of eq. (B.2)."""
    return float(np.pi - angle)


def number_of_corners(legs: int) -> int:
    """Labels with every leg at one of its two extremes."""
    return int(2**legs)


def section_legs(theta_deg: float, gamma_deg: float) -> Array:
    """Legs that bound A[0, 0, γ] in the half-plane at θ, above and below its outermost point.

    Above it lies the arc of a greatest length, below it that of a least length, as the
    workspace above the base.
    """
    shells = _shells(gamma_deg)
    theta = np.deg2rad(theta_deg)
    outward = np.array([np.cos(theta), np.sin(theta), 0.0])
    arcs = [
        arc
        for arc in shells.section((0.0, 0.0, 0.0), np.stack((outward, (0.0, 0.0, 1.0))))
        if (arc.points @ outward).max() > 1e-9 and arc.points[:, 2].max() > 0.0
    ]
    tip = max((point for arc in arcs for point in (arc.first, arc.last)), key=lambda p: p @ outward)
    legs = {}
    for arc in arcs:
        if min(np.linalg.norm(arc.first - tip), np.linalg.norm(arc.last - tip)) < 1e-9:
            ((leg, side), *_) = active_from_label(arc.label, 6)
            legs[side] = leg + 1
    return np.array([legs[1], legs[0]])


def legs_at_corner(gamma_deg: float, near: Sequence[float]) -> int:
    """Legs at a limit in the bifurcation point of A[0, 0, γ] nearest a place."""
    corners = _shells(gamma_deg).vertices()
    nearest = min(corners, key=lambda v: float(np.linalg.norm(v.position - near)))
    return len(active_from_label(nearest.label, 6))


def formula_error(equation: str, leg: int) -> float:
    """Error of a printed formula for a leg length, against the points of the design.

    At a general pose; the terms are written as printed.
    """
    a, b, d, r3 = 10.0, 15.0, 1.0, np.sqrt(3.0)
    place, angles = np.array([0.3, -0.7, 6.0]), np.array([0.2, -0.3, 0.4])
    alpha, beta, gamma = angles
    turn, sign = ((np.pi / 3, 1), (0.0, -1), (-np.pi / 3, 1))[(leg - 1) // 2]
    s, c = np.sin(gamma + turn), np.cos(gamma + turn)
    x, y, z = place + sign * a / r3 * np.array(
        [
            np.sin(alpha) * np.sin(beta) * s + np.cos(beta) * c,
            np.cos(alpha) * s,
            np.sin(alpha) * np.cos(beta) * s - np.sin(beta) * c,
        ]
    )
    sixth = y + d / 2 + b / 2 if equation == "(3.7)" else y + d / 2
    terms = (
        (x - d / (2 * r3) - b / r3, y - d / 2),
        (x - d / (2 * r3) + b / (2 * r3), y - d / 2 - b / 2),
        (x + d / r3 + b / (2 * r3), y - b / 2),
        (x + d / r3 + b / (2 * r3), y + b / 2),
        (x - d / (2 * r3) + b / (2 * r3), y + d / 2 + b / 2),
        (x - d / (2 * r3) - b / r3, sixth),
    )
    printed = np.sqrt(terms[leg - 1][0] ** 2 + terms[leg - 1][1] ** 2 + z**2)
    return float(printed - leg_lengths_at(place.tolist(), np.rad2deg(angles).tolist())[leg - 1])


def base_sides() -> Array:
    """Sides of the base hexagon of eq. (3.3), the short one and the long one."""
    points = published_design(NAME).base_points
    sides = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)
    return np.array([sides.min(), sides.max()])


def _shells(gamma_deg: float) -> Shells:
    turn = rotation_from_angles((0.0, 0.0, gamma_deg), ORDER, degrees=True)
    return fixed_orientation(published_design(NAME), turn)


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        "position": position,
        "orientation": orientation,
        "tilt": tilt,
        "leg_lengths": leg_lengths,
        "leg_lengths_at": leg_lengths_at,
        "radiating_height": radiating_height,
        "lowest_on_axis": lowest_on_axis,
        "ray_angle": ray_angle,
        "half_turn_less": half_turn_less,
        "number_of_corners": number_of_corners,
        "section_legs": section_legs,
        "legs_at_corner": legs_at_corner,
        "formula_error": formula_error,
        "base_sides": base_sides,
    }
)
