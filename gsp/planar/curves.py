"""Circles and lines in the plane on which a leg is at a limit, and where they cross."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, frozen, norm
from gsp.limits.labels import Active
from gsp.workspace.exact.spheres import SAME_TOLERANCE, common_chord

# Longest step between drawn points of a circle [rad], and the least number of them.
DRAWN_STEP, LEAST_DRAWN = 2.0 * np.pi / 128.0, 17
# Arcs are cut into pieces of at most this before angles are taken [rad].
SEEN_STEP = 0.5 * np.pi


@dataclass(frozen=True, eq=False)
class Curve(ReadOnly):
    """A circle or a line with a direction, which has the feasible side on its left.

    Attributes
    ----------
    point : (2,) array [length]
        The centre of a circle, a point of a line.
    radius : float [length]
        0 for a line.
    along : (2,) array [1]
        Direction of a line.
    turn : float
        1: a circle is counter-clockwise; −1: clockwise.
    active : tuple of (leg, side)
        The limits that it stands for.
    """

    point: Array
    radius: float
    along: Array
    turn: float
    active: Active

    @classmethod
    def of_limit(
        cls, centre: Array, normal: Array, reach: float, key: tuple[int, int]
    ) -> list[Curve]:
        """Return the circle, or the two lines, on which a leg has a length.

        The point of a line is the foot of the origin on it.
        """
        inward = 1.0 if key[1] == 0 else -1.0
        if not normal.any():
            return [cls(centre, reach, np.zeros(2), -inward, (key,))]
        lines = []
        for side in (1.0, -1.0):
            left = inward * side * normal
            lines.append(
                cls(
                    (centre @ normal + side * reach) * normal,
                    0.0,
                    np.array([left[1], -left[0]]),
                    0.0,
                    (key,),
                )
            )
        return lines

    @property
    def closed(self) -> bool:
        """Whether it is a circle."""
        return self.radius > 0.0

    def with_limits(self, active: Active) -> Curve:
        """Return the curve for more limits."""
        return replace(self, active=tuple(sorted({*self.active, *active})))

    def moved(self, far: float) -> Curve:
        """Return the curve moved to its feasible side, so that its side becomes smaller."""
        if self.closed:
            return replace(self, radius=self.radius - self.turn * far)
        return replace(self, point=self.point + far * self.left)

    @property
    def left(self) -> Array:
        """The normal (2,) of a line on its feasible side."""
        return np.array([-self.along[1], self.along[0]])

    def margin(self, points: Array) -> Array:
        """Return how far points (..., 2) are on the feasible side, negative on the other."""
        if self.closed:
            return np.asarray(self.turn * (self.radius - norm(points - self.point)))
        return np.asarray((points - self.point) @ self.left)

    def at(self, parameter: float | Array) -> Array:
        """Return points (..., 2) at parameters: an angle in its direction, or a length."""
        t = np.asarray(parameter)[..., None]
        if not self.closed:
            return np.asarray(self.point + t * self.along)
        t = self.turn * t
        circle = np.concatenate((np.cos(t), np.sin(t)), axis=-1)
        return np.asarray(self.point + self.radius * circle)

    def parameter(self, point: Array) -> float:
        """Return the parameter of a point of the curve; angles are in [0, 2π)."""
        x, y = point - self.point
        if not self.closed:
            return float(self.along @ (x, y))
        return float((self.turn * np.arctan2(y, x)) % (2.0 * np.pi))

    def direction(self, parameter: float) -> Array:
        """Return the unit direction (2,) at a parameter."""
        if not self.closed:
            return self.along
        t = self.turn * parameter
        return np.asarray(self.turn * np.array([-np.sin(t), np.cos(t)]))

    def drawn(self, start: float, stop: float) -> Array:
        """Return points (q, 2) from one parameter to another, to draw it."""
        steps = int(np.ceil((stop - start) / DRAWN_STEP)) if self.closed else 0
        return frozen(self.at(np.linspace(start, stop, max(LEAST_DRAWN, steps + 1))))

    def area(self, start: float, stop: float, origin: Array) -> float:
        """Return ½ ∫ (x dy − y dx) from one parameter to another, about an origin."""
        first, last = self.at(start) - origin, self.at(stop) - origin
        if not self.closed:
            return float(0.5 * (first[0] * last[1] - first[1] * last[0]))
        x, y = self.point - origin
        step = last - first
        turned = self.turn * (stop - start)
        return float(0.5 * (self.radius**2 * turned + x * step[1] - y * step[0]))

    def angle_seen(self, start: float, stop: float, points: Array) -> Array:
        """Return the angle that points (...) see a piece turn about them [rad]."""
        steps = int(np.ceil((stop - start) / SEEN_STEP)) if self.closed else 1
        total = np.zeros(points.shape[:-1])
        within = norm(points - self.point) < self.radius
        side = self.turn if self.closed else 1.0
        for first, last in pairwise(self.at(np.linspace(start, stop, steps + 1))):
            a, b = first - points, last - points
            # Between the chord and its arc, or on the chord, a point sees the arc pass on the other
            # side.
            sine = side * (a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
            seen = np.arctan2(np.where(sine == 0.0, 0.0, sine), (a * b).sum(axis=-1))
            total += side * (seen + 2.0 * np.pi * (within & (sine < 0.0)))
        return total


def same_curve(one: Curve, other: Curve, slack: float) -> bool:
    """Return whether two curves with one side are the same up to a slack [length].

    Lines are compared where positions are, near the origin: each has its foot as its point.
    """
    if one.closed != other.closed or one.turn != other.turn:
        return False
    offset = other.point - one.point
    if one.closed:
        return float(norm(offset)) + abs(one.radius - other.radius) <= slack
    sine = one.along[0] * other.along[1] - one.along[1] * other.along[0]
    near = float(norm(offset)) <= slack and abs(sine) <= SAME_TOLERANCE
    return bool(near and one.along @ other.along > 0.0)


def crossings(one: Curve, other: Curve) -> list[Array]:
    """Return the points (2,) where two curves cross: none, one of two lines, or two.

    Two are in the same order for curves that are moved by `Curve.moved`.
    """
    if not one.closed and not other.closed:
        sine = one.along[0] * other.along[1] - one.along[1] * other.along[0]
        if sine == 0.0:
            return []
        x, y = other.point - one.point
        return [one.point + (x * other.along[1] - y * other.along[0]) / sine * one.along]
    if not one.closed:
        one, other = other, one
    if other.closed:
        offset = other.point - one.point
        gap = float(norm(offset))
        if gap == 0.0:
            return []
        along, square = common_chord(np.float64(gap), one.radius, other.radius)  # type: ignore[arg-type]
        foot, chord = one.point + along * offset / gap, offset / gap
        chord = np.array([-chord[1], chord[0]])
    else:
        chord = other.along
        foot = other.point + ((one.point - other.point) @ chord) * chord
        far = float(norm(foot - one.point))
        square = np.asarray((one.radius - far) * (one.radius + far))
    if not square > 0.0:
        return []
    half = np.sqrt(square)
    return [foot + half * chord, foot - half * chord]


def touching(one: Curve, other: Curve) -> tuple[float, Array]:
    """Return by how much two curves overlap, and the point (2,) where they are nearest.

    At least one of them is a circle. An overlap [length] is negative if they are apart, and the
    point is in the middle between them; NaN if no direction is defined.
    """
    if not one.closed:
        one, other = other, one
    if not other.closed:
        foot = other.point + ((one.point - other.point) @ other.along) * other.along
        gap = float(norm(foot - one.point))
        overlap, reach, toward = one.radius - gap, 0.5 * (one.radius + gap), foot - one.point
    else:
        toward = other.point - one.point
        gap = float(norm(toward))
        r, s = one.radius, other.radius
        outside, inside = r + s - gap, gap - abs(r - s)
        overlap = min(outside, inside)
        if outside <= inside:
            reach = 0.5 * (r + gap - s)
        else:
            reach = 0.5 * (r + gap + s if r >= s else gap - r - s)
    if gap == 0.0:
        return overlap, np.full(2, np.nan)
    return overlap, one.point + reach / gap * toward
