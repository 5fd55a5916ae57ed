"""The constraints D1–D4 and A1: the segment that each acts along, its value and its row.

Every distance constraint acts along one segment, from a foot on the base to a foot on the
platform. Its row of the inverse Jacobian is the line of that segment in Plücker coordinates
about the platform origin, so the five printed formulas of `TozKucuk2016` are four ways to find
a segment and two ways to read it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np

from gsp.geometry.vectors import EPS, Array, Mask, cross, dot, norm, unit

# A distance below ZERO × the lengths it was subtracted from, and a sine below ZERO, are rounding.
ZERO = 8 * EPS


@dataclass(frozen=True, eq=False)
class Lines:
    """Anchor points and lines of k legs at a batch of poses, all in base axes.

    Attributes
    ----------
    d : (..., k, 3) array [length]
        p + R b − a, from base anchor to platform anchor. *Source: TozKucuk2016, eq. (1)*
    arm : (..., k, 3) array [length]
        R b, from platform origin to platform anchor.
    s, t : (k, 3) and (..., k, 3) arrays
        Unit directions of the base line and (turned by R) of the platform line; NaN where the
        leg has no such line.
    scale : (..., k) array [length]
        |p| + |b| + |a|, the size of the terms of `d`.
    """

    d: Array
    arm: Array
    s: Array
    t: Array
    scale: Array

    def __getitem__(self, legs: list[int] | slice) -> Lines:
        """Return the lines of some of the legs."""
        return Lines(
            self.d[..., legs, :],
            self.arm[..., legs, :],
            self.s[..., legs, :],
            self.t[..., legs, :],
            self.scale[..., legs],
        )


@dataclass(frozen=True, eq=False)
class Segment:
    """The segment between the feet of a leg.

    Attributes
    ----------
    direction : (..., k, 3) array
        Unit vector from the base foot to the platform foot.
    length : (..., k) array [length]
        Distance of the feet, ≥ 0.
    arm : (..., k, 3) array [length]
        From the platform origin to the platform foot.
    defined : (..., k) bool array
        False where the direction does not exist; the other attributes mean nothing there.
    """

    direction: Array
    length: Array
    arm: Array
    defined: Mask


def line_row(direction: Array, arm: Array) -> Array:
    """Rows that give the velocity, along `direction`, of the platform point at `arm`: (..., 6).

    [x, r × x] · (v, ω) = x · (v + ω × r).
    """
    return np.concatenate((direction, cross(arm, direction)), axis=-1)


def spin_row(axis: Array) -> Array:
    """Rows that give the angular velocity about `axis`: [0, x] · (v, ω) = x · ω, shape (..., 6)."""
    return np.concatenate((np.zeros_like(axis), axis), axis=-1)


def _segment(vector: Array, arm: Array, scale: Array) -> Segment:
    length = norm(vector)
    return Segment(unit(vector), length, arm, length > ZERO * scale)


def point_point(lines: Lines) -> Segment:
    """D1: from anchor to anchor.

    *Source: TozKucuk2016, eq. (2)*
    """
    return _segment(lines.d, lines.arm, lines.scale)


def point_line(lines: Lines) -> Segment:
    """D2: from the base anchor, perpendicular to the platform line.

    *Source: TozKucuk2016, eq. (3)*
    """
    d, t = lines.d, lines.t
    foot = lines.arm - dot(d, t)[..., None] * t
    return _segment(cross(t, cross(d, t)), foot, lines.scale)


def line_point(lines: Lines) -> Segment:
    """D3: from the base line, perpendicular to it, to the anchor.

    *Source: TozKucuk2016, eq. (4)*
    """
    d, s = lines.d, lines.s
    return _segment(cross(s, cross(d, s)), lines.arm, lines.scale)


def line_line(lines: Lines) -> Segment:
    """D4 and A1: along the common normal of the two lines.

    Where the lines meet the length is zero and the direction is +t × s; only parallel lines
    leave it undefined.

    *Source: TozKucuk2016, eq. (5)*
    """
    d, s, t = lines.d, lines.s, lines.t
    normal = cross(t, s)
    sine = norm(normal)
    with np.errstate(invalid="ignore", divide="ignore"):
        offset = dot(d, normal) / sine
        direction = normal * (np.where(offset < 0.0, -1.0, 1.0) / sine)[..., None]
        slide = -dot(cross(d, s), normal) / sine**2
    return Segment(direction, np.abs(offset), lines.arm + slide[..., None] * t, sine > ZERO)


def _distance(lines: Lines, segment: Segment) -> Array:
    return segment.length


def _distance_row(lines: Lines, segment: Segment) -> Array:
    return line_row(segment.direction, segment.arm)


def _angle(lines: Lines, segment: Segment) -> Array:
    return np.arctan2(norm(cross(lines.t, lines.s)), dot(lines.t, lines.s))


def _angle_row(lines: Lines, segment: Segment) -> Array:
    return -spin_row(unit(cross(lines.t, lines.s)))


@dataclass(frozen=True)
class Constraint:
    """One kind of constraint between base and platform.

    Attributes
    ----------
    name : str
        "D1" … "D4", "A1".
    base, platform : "point" or "line"
        The primitives that it relates.
    quantity : "distance" or "angle"
        What its actuator changes; a distance has the unit of the design, an angle is in radians.
    segment : Lines -> Segment
        Where it acts.
    measure : Lines, Segment -> (..., k) array
        Its value: a distance ≥ 0, or an angle in (0, π).
    row : Lines, Segment -> (..., k, 6) array
        Gradient of that value with respect to the twist (v, ω).
    undefined : str
        Why there is no row, where there is none.
    source : str
        Equations of value and row.
    """

    name: str
    base: Literal["point", "line"]
    platform: Literal["point", "line"]
    quantity: Literal["distance", "angle"]
    segment: Callable[[Lines], Segment]
    measure: Callable[[Lines, Segment], Array]
    row: Callable[[Lines, Segment], Array]
    undefined: str
    source: str

    @property
    def symbol(self) -> str:
        """Letter of the joint variable: d for a distance, theta for an angle."""
        return "d" if self.quantity == "distance" else "theta"


# ERRATUM: in eq. (14) one bracket is unbalanced; the moment part is ((d × s) × s) × R b up to sign.
CONSTRAINTS = (
    Constraint(
        "D1", "point", "point", "distance", point_point, _distance, _distance_row,
        "the anchor points coincide", "TozKucuk2016, eqs. (2), (12)",
    ),
    Constraint(
        "D2", "point", "line", "distance", point_line, _distance, _distance_row,
        "the base point lies on the platform line", "TozKucuk2016, eqs. (3), (13)",
    ),
    Constraint(
        "D3", "line", "point", "distance", line_point, _distance, _distance_row,
        "the platform point lies on the base line", "TozKucuk2016, eqs. (4), (14)",
    ),
    Constraint(
        "D4", "line", "line", "distance", line_line, _distance, _distance_row,
        "the base line and the platform line are parallel", "TozKucuk2016, eqs. (5), (15)",
    ),
    Constraint(
        "A1", "line", "line", "angle", line_line, _angle, _angle_row,
        "the base line and the platform line are parallel", "TozKucuk2016, eqs. (6), (16)",
    ),
)  # fmt: skip

CONSTRAINT = MappingProxyType({constraint.name: constraint for constraint in CONSTRAINTS})
