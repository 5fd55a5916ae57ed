"""A design as a certificate records it, evaluated in balls: rows, joint values, cones."""

from __future__ import annotations

import tomllib
from copy import copy
from dataclasses import dataclass
from typing import Any

from gsp.errors import MissingSoftware
from gsp.proof.verification.balls import (
    Number,
    Rate,
    Vector,
    cross,
    dot,
    minus,
    times,
    unit,
)
from gsp.proof.verification.motions import Axes, Piece

# The motion of a model before a piece of its path is chosen.
NOWHERE = Axes("XYZ")


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
        self.motion: Axes | Piece = Axes(record["box"]["order"]) if "box" in record else NOWHERE
        # Coordinates of the poses: six of a box, one of a piece of a path, which takes `span`.
        self.coordinates = 6
        self.span: Any = None
        self.claims = record["claims"]
        self.bends = 0
        self.legs = tomllib.loads(record["design"])["legs"]

    def nominal(self) -> Model:
        """Return the design itself, without tolerances."""
        model = copy(self)
        model.claims = {**self.claims, "tolerances": [[0.0] * 4 for _ in self.legs]}
        return model

    def on(self, piece: Piece, span: Any) -> Model:
        """Return the design on a piece of a path."""
        model = copy(self)
        model.motion, model.span, model.coordinates = piece, span, 1
        return model

    def constant(self, x: float, tolerance: float = 0.0) -> Number:
        """Return a constant, known up to a tolerance."""
        return Number(self.ball(x, tolerance), [0] * self.coordinates, [0] * self.bends)

    def point(self, x: list[float], tolerance: float) -> Vector:
        """Return a constant vector; each coordinate has the tolerance."""
        return [self.constant(a, tolerance) for a in x]

    def evaluate(self, point: list[Any], *, second: bool = False) -> Evaluated:
        """Rows and bounded quantities, with derivatives."""
        n = self.coordinates
        self.bends = n * (n + 1) // 2 if second else 0
        position, rotation = self.motion.platform(
            [
                Number(x, [int(k == m) for m in range(n)], [0] * self.bends)
                for k, x in enumerate(point)
            ]
        )
        length = self.constant(self.claims["length"])
        result = Evaluated([], [], [], dict(zip("xyz", position, strict=True)), [])
        for i, record in enumerate(self.legs):
            self._leg(i, record, position, rotation, length, result)
        return result

    def _leg(
        self,
        i: int,
        record: dict[str, Any],
        position: Vector,
        rotation: list[Vector],
        length: Number,
        result: Evaluated,
    ) -> None:
        """Add what one leg gives."""
        kinds = record["constraints"].replace(",", " ").split()
        near = self.claims["tolerances"][i]
        a = self.point(record["base_point"], near[0])
        arm = [dot(row, self.point(record["platform_point"], near[1])) for row in rotation]
        d = [p + r - x for p, r, x in zip(position, arm, a, strict=True)]
        s: Vector = []
        t: Vector = []
        if "base_direction" in record:
            s = unit(self.point(record["base_direction"], near[2]))
        if "platform_direction" in record:
            along = unit(self.point(record["platform_direction"], near[3]))
            t = [dot(row, along) for row in rotation]
        leg = place(kinds[0], d, s, t)
        foot = arm if leg.top is None else [x + leg.top * y for x, y in zip(arm, t, strict=True)]
        self._directions(i, kinds[0], leg.u, leg.distance, rotation, result.values)
        above = [p + x for p, x in zip(position, foot, strict=True)]
        below = a if leg.bottom is None else [x + leg.bottom * y for x, y in zip(a, s, strict=True)]
        result.feet.append((below, above))
        for kind in kinds:
            if kind == "A1":
                result.values[f"theta{i + 1}"] = dot(s, t)
                force, moment = [self.constant(0.0)] * 3, times(length, leg.u)
            else:
                result.values[f"d{i + 1}"] = leg.distance
                force, moment = leg.u, cross(foot, leg.u)
            result.rows.append([*force, *(x / length for x in moment)])
            if self.wants("condition_number_ellipsoid"):
                result.ellipsoid.append(self._seen(force, moment, rotation))
        if self.wants("control_number"):
            result.passive.extend(self._rates(kinds, d, s, t, arm, length))

    def wants(self, name: str) -> bool:
        """Whether a quantity is claimed to be within bounds."""
        return name in self.claims["bounds"]

    def _seen(self, force: Vector, moment: Vector, rotation: list[Vector]) -> Vector:
        """Row for the speeds of the ellipsoid: Nawratil, eqs. (12) and (17)."""
        given = self.claims["ellipsoid"]
        centre = [dot(row, [self.constant(x) for x in given["center"]]) for row in rotation]
        about = minus(moment, cross(centre, force))
        a, b, c = (self.constant(x) for x in given["semi_axes"])
        two = self.constant(2.0)
        inertia = [two * (y * y + z * z) for y, z in ((b, c), (a, c), (a, b))]
        row = [x / self.constant(6.0).root() for x in force]
        for j in range(3):
            axis = [self.constant(given["rotation"][i][j]) for i in range(3)]
            turned = [dot(line, axis) for line in rotation]
            row.append(dot(about, turned) / inertia[j].root())
        return row

    def _rates(
        self, kinds: list[str], d: Vector, s: Vector, t: Vector, arm: Vector, length: Number
    ) -> list[Vector]:
        """Rows of the passive rates, by the rates of u and of the slides along the six twists."""
        zero, one = self.constant(0.0), self.constant(1.0)
        columns = []
        for k in range(6):
            axis = [one if k % 3 == i else zero for i in range(3)]
            # The twist is (v, L ω).
            spin = [zero] * 3 if k < 3 else [x / length for x in axis]
            velocity = axis if k < 3 else cross(spin, arm)
            moving = [Rate(x, v) for x, v in zip(d, velocity, strict=True)]
            still = [Rate(x, zero) for x in s]
            turning = [Rate(x, v) for x, v in zip(t, cross(spin, t), strict=True)] if t else []
            leg = place(kinds[0], moving, still, turning)
            u, rate = [x.value for x in leg.u], [x.rate for x in leg.u]
            slides = [x.rate / length for x in (leg.top, leg.bottom) if x is not None]
            if kinds == ["A1"]:
                slides.append(leg.distance.rate / length)
            columns.append([*rate, *minus(rate, cross(spin, u)), *slides])
        return [list(row) for row in zip(*columns, strict=True)]

    def _directions(
        self,
        i: int,
        kind: str,
        u: Vector,
        distance: Number,
        rotation: list[Vector],
        values: dict[str, Number],
    ) -> None:
        """Cosines of the angles between a leg and the axes of its cones."""
        # Axes are unit vectors to rounding; where there is no cone they are 0, and not used.
        on_base, on_platform = (
            unit([self.constant(x) for x in axis]) for axis in self.claims["axes"][i]
        )
        if kind in ("D4", "A1") and distance.value < 0:
            u = times(self.constant(-1.0), u)
        values[f"distance {i + 1}"] = distance
        values[f"base cone {i + 1}"] = dot(u, on_base)
        turned = [dot(row, on_platform) for row in rotation]
        values[f"platform cone {i + 1}"] = dot(u, turned)


@dataclass(frozen=True)
class Evaluated:
    """A pose or a box: rows, for the ellipsoid too, of passive rates; quantities; feet of legs."""

    rows: list[Vector]
    ellipsoid: list[Vector]
    passive: list[Vector]
    values: dict[str, Number]
    feet: list[tuple[Vector, Vector]]


@dataclass(frozen=True)
class Place:
    """Direction and distance of a leg, and how far its feet are from the anchors along lines."""

    u: Vector
    distance: Any
    bottom: Any
    top: Any


def place(kind: str, d: Vector, s: Vector, t: Vector) -> Place:
    """Return where a leg is; `d` is from base anchor to platform anchor."""
    if kind in ("D4", "A1"):
        # With d + y t − x s = k u and u across s and t.
        u = unit(cross(t, s))
        m = cross(u, s)
        zero = dot(d, m) - dot(d, m)
        y = zero - dot(d, m) / dot(t, m)
        x = dot(d, s) + y * dot(t, s)
        return Place(u, dot(d, u), x, y)
    x = dot(d, s) if kind == "D3" else None
    along = dot(d, t) if kind == "D2" else None
    y = along - along - along if along is not None else None
    vector = d
    if kind == "D2":
        vector = [a + y * b for a, b in zip(d, t, strict=True)]
    if kind == "D3":
        vector = minus(d, times(x, s))
    return Place(unit(vector), dot(vector, vector).root(), x, y)
