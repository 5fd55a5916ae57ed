"""A design as a certificate records it, evaluated in balls: rows, joint values, cones."""

from __future__ import annotations

import tomllib
from typing import Any

from gsp.errors import MissingSoftware
from gsp.proof.verification.balls import PAIRS, Number, Vector, cross, dot, minus, times, unit


class Model:
    """A design and the claims about it."""

    def __init__(self, record: dict[str, Any]) -> None:
        try:
            import flint
        except ImportError as error:
            raise MissingSoftware(
                "python-flint", "verification of certificates", "verify"
            ) from error
        self.flint = flint
        self.ball = flint.arb
        self.order = record["box"]["order"]
        self.claims = record["claims"]
        self.bends = 0
        self.legs = tomllib.loads(record["design"])["legs"]

    def constant(self, x: float, tolerance: float = 0.0) -> Number:
        """Return a constant, known up to a tolerance."""
        return Number(self.ball(x, tolerance), [0] * 6, [0] * self.bends)

    def point(self, x: list[float], tolerance: float) -> Vector:
        """Return a constant vector; each coordinate has the tolerance."""
        return [self.constant(a, tolerance) for a in x]

    def rotation(self, angles: list[Number]) -> list[Vector]:
        """Three turns about coordinate axes, multiplied in the order of its name."""
        sequence, places = {
            "rpy": ("xyz", (0, 1, 2)), "approach-roll": ("YXZ", (1, 0, 2)),
        }.get(self.order, (self.order, (0, 1, 2)))  # fmt: skip
        turns = [
            self._turn(axis.upper(), angles[place])
            for axis, place in zip(sequence, places, strict=True)
        ]
        # Capitals turn about moving axes, R = R1 R2 R3; small letters about fixed ones.
        first, second, third = turns if sequence.isupper() else turns[::-1]
        return _matrix_product(_matrix_product(first, second), third)

    def _turn(self, axis: str, angle: Number) -> list[Vector]:
        sine, cosine = angle.sine_cosine()
        one, zero = self.constant(1.0), self.constant(0.0)
        i = "XYZ".index(axis)
        j, k = (i + 1) % 3, (i + 2) % 3
        matrix = [[zero] * 3 for _ in range(3)]
        matrix[i][i], matrix[j][j], matrix[k][k] = one, cosine, cosine
        matrix[j][k], matrix[k][j] = zero - sine, sine
        return matrix

    def evaluate(
        self, point: list[Any], *, second: bool = False
    ) -> tuple[list[Vector], dict[str, Number]]:
        """Rows of the homogeneous Jacobian, and the bounded quantities, with derivatives."""
        self.bends = len(PAIRS) if second else 0
        coordinates = [
            Number(x, [int(k == m) for m in range(6)], [0] * self.bends)
            for k, x in enumerate(point)
        ]
        position, rotation = coordinates[:3], self.rotation(coordinates[3:])
        per_length = self.constant(1.0) / self.constant(self.claims["length"])
        rows, values = [], dict(zip("xyz", position, strict=True))
        for i, leg in enumerate(self.legs):
            rows += self._leg(i, leg, position, rotation, per_length, values)
        return rows, values

    def _leg(
        self, i: int, leg: dict[str, Any], position: Vector, rotation: list[Vector],
        per_length: Number, values: dict[str, Number],
    ) -> list[Vector]:  # fmt: skip
        """Rows of one leg; its joint values and cosines of cones are put into `values`."""
        near = self.claims["tolerances"][i]
        kinds = leg["constraints"].replace(",", " ").split()
        a = self.point(leg["base_point"], near[0])
        arm = [dot(row, self.point(leg["platform_point"], near[1])) for row in rotation]
        d = [p + r - x for p, r, x in zip(position, arm, a, strict=True)]
        s: Vector = []
        t: Vector = []
        if "base_direction" in leg:
            s = unit(self.point(leg["base_direction"], near[2]))
        if "platform_direction" in leg:
            along = unit(self.point(leg["platform_direction"], near[3]))
            t = [dot(row, along) for row in rotation]
        if kinds[0] in ("D4", "A1"):
            normal = cross(t, s)
            u = unit(normal)
            foot = minus(arm, times(dot(cross(d, s), normal) / dot(normal, normal), t))
            distance = dot(d, u)
        else:
            vector, foot = d, arm
            if kinds[0] == "D2":
                vector = minus(d, times(dot(d, t), t))
                foot = minus(arm, times(dot(d, t), t))
            if kinds[0] == "D3":
                vector = minus(d, times(dot(d, s), s))
            u, distance = unit(vector), dot(vector, vector).root()
        self._directions(i, kinds[0], u, distance, rotation, values)
        rows = []
        for kind in kinds:
            if kind == "A1":
                values[f"theta{i + 1}"] = dot(s, t)
                rows.append([*[self.constant(0.0)] * 3, *u])
            else:
                values[f"d{i + 1}"] = distance
                rows.append([*u, *times(per_length, cross(foot, u))])
        return rows

    def _directions(
        self, i: int, kind: str, u: Vector, distance: Number, rotation: list[Vector],
        values: dict[str, Number],
    ) -> None:  # fmt: skip
        """Cosines of the angles between a leg and the axes of its cones."""
        on_base, on_platform = ([self.constant(x) for x in axis] for axis in self.claims["axes"][i])
        if kind in ("D4", "A1") and distance.value < 0:
            u = times(self.constant(-1.0), u)
        values[f"distance {i + 1}"] = distance
        values[f"base cone {i + 1}"] = dot(u, on_base)
        turned = [dot(row, on_platform) for row in rotation]
        values[f"platform cone {i + 1}"] = dot(u, turned)


def _matrix_product(x: list[Vector], y: list[Vector]) -> list[Vector]:
    columns = [[row[j] for row in y] for j in range(3)]
    return [[dot(row, column) for column in columns] for row in x]
