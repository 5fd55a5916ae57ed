"""Where the platform is: angles of a box, or a piece of a path, as numbers with derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial
from typing import Any

from gsp.proof.verification.balls import Number, Vector, cross, dot, plus, times

# Rounding of the coefficients of a path: of each polynomial, and of entries of rotations.
COEFFICIENT_ROUNDING = 2.0**-48
# Size of the terms of a power series that are left out, and the most terms that are taken.
LEAST_TERM, MOST_TERMS = 2.0**-120, 400


@dataclass(frozen=True)
class Axes:
    """Coordinates of a box: a position and three angles of a named set."""

    order: str

    def platform(self, coordinates: list[Number]) -> tuple[Vector, list[Vector]]:
        """Return position and rotation."""
        return coordinates[:3], self.rotation(coordinates[3:])

    def rotation(self, angles: list[Number]) -> list[Vector]:
        """Three turns about coordinate axes, multiplied in the order of its name."""
        sequence, places = {
            "rpy": ("xyz", (0, 1, 2)),
            "approach-roll": ("YXZ", (1, 0, 2)),
        }.get(self.order, (self.order, (0, 1, 2)))
        turns = [
            _turn(axis.upper(), angles[place]) for axis, place in zip(sequence, places, strict=True)
        ]
        # Capitals turn about moving axes, R = R1 R2 R3; small letters about fixed ones.
        first, second, third = turns if sequence.isupper() else turns[::-1]
        return _matrix_product(_matrix_product(first, second), third)


@dataclass(frozen=True)
class Piece:
    """A piece of a path, 0 ≤ u ≤ 1, as a path certificate records it.

    With v = Σ_j turn[j] uʲ, R = rotation exp([v]×), and p = Σ_j position[j] uʲ + rotation s, where
    s = ∫₀¹ exp(y [v]×) dy u slide. Coefficients are known to COEFFICIENT_ROUNDING, the first ones
    also to within `margin` and `slack`.
    """

    flint: Any
    position: list[list[float]]
    turn: list[list[float]]
    rotation: list[list[float]]
    slide: list[float]
    margin: float
    slack: float

    def platform(self, coordinates: list[Number]) -> tuple[Vector, list[Vector]]:
        """Return position and rotation."""
        (u,) = coordinates
        place = self._polynomial(self.position, self.margin, u)
        v = self._polynomial(self.turn, self.slack, u)
        square = dot(v, v)
        # sin θ/θ, (1 − cos θ)/θ², (θ − sin θ)/θ³, with θ² = |v|².
        sine, cosine, rest = (self._series(start, square) for start in (1, 2, 3))
        before = [[self._known(x, COEFFICIENT_ROUNDING, u) for x in row] for row in self.rotation]
        columns = []
        for i in range(3):
            axis = [self._known(float(i == j), 0.0, u) for j in range(3)]
            once = cross(v, axis)
            columns.append(plus(plus(axis, times(sine, once)), times(cosine, cross(v, once))))
        turned = [list(row) for row in zip(*columns, strict=True)]
        if any(self.slide):
            step = [self._known(x, COEFFICIENT_ROUNDING * abs(x), u) * u for x in self.slide]
            once = cross(v, step)
            moved = plus(plus(step, times(cosine, once)), times(rest, cross(v, once)))
            place = plus(place, [dot(row, moved) for row in before])
        return place, _matrix_product(before, turned)

    def _known(self, x: float, radius: float, like: Number) -> Number:
        return like.constant(self.flint.arb(x, radius))

    def _polynomial(self, coefficients: list[list[float]], margin: float, u: Number) -> Vector:
        total = [self._known(0.0, margin, u)] * 3
        power = self._known(1.0, 0.0, u)
        for row in coefficients:
            terms = [self._known(x, COEFFICIENT_ROUNDING * abs(x), u) * power for x in row]
            total, power = plus(total, terms), power * u
        return total

    def _series(self, start: int, x: Number) -> Number:
        """Return Σ_n (−x)ⁿ/(2n + start)!, with a ball for the terms that are left out.

        These terms, and their first and second derivatives, are at most n² Xⁿ/(2n)! each for
        |x| ≤ X, X ≥ 1, and less than half of the one before.
        """
        ball = self.flint.arb
        most, n = ball(1).max(x.value.abs_upper()), 4
        while n < MOST_TERMS and not 2 * n * n * most**n / factorial(2 * n) < LEAST_TERM:
            n += 4
        last = 2 * n * n * most**n / factorial(2 * n)
        known = n < MOST_TERMS and 4 * most < (2 * n) ** 2
        total = x.constant(ball(0))
        for k in reversed(range(n)):
            total = x.constant(ball(1) / factorial(2 * k + start)) - x * total
        return total + x.unknown(ball(0, last) if known else ball("nan"))


def _turn(axis: str, angle: Number) -> list[Vector]:
    sine, cosine = angle.sine_cosine()
    one, zero = angle.constant(1), angle.constant(0)
    i = "XYZ".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    matrix = [[zero] * 3 for _ in range(3)]
    matrix[i][i], matrix[j][j], matrix[k][k] = one, cosine, cosine
    matrix[j][k], matrix[k][j] = zero - sine, sine
    return matrix


def _matrix_product(x: list[Vector], y: list[Vector]) -> list[Vector]:
    columns = [[row[j] for row in y] for j in range(3)]
    return [[dot(row, column) for column in columns] for row in x]
