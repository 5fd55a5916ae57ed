"""Legs on patches: the segments of `gsp.model.formulas` as jets, their rows and passive rates.

Everything is derived in `docs/proofs.md`. The direction of D4 and A1 legs is t × s over its norm,
without the change of sign at meeting lines, so that rows are continuous; the distance of a D4 leg
then has a sign, and its magnitude is the joint value.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from gsp.geometry.scalars import cross, dot, plus, turned
from gsp.variation.jets import (
    JET_ROUNDING,
    Jet,
    Vector,
    constant,
    inner,
    inverse,
    joined,
    length,
    multiple,
    outer,
    row_of,
    scaled,
    size,
    total,
    unit,
)

# Scalars of a patch: p, R by rows, half-widths of the position, three rotation vectors, and bounds
# of |p′|, |p″|, |ω|, |ω′|, then |p|.
PATCH_SCALARS = 29
# Scalars of a leg: a, b, s, t, |a|, |b|, and tolerances of a, b (lengths), s, t (angles).
PATCH_LEG_SCALARS = 18


@dataclass(frozen=True)
class Patch:
    """The motion of the platform on the paths of a patch.

    A patch of one direction may have that one slope: `half` is then p′ and `turns` has ω alone,
    both at its start.
    """

    position: Vector
    rotation: Vector
    half: Vector
    turns: list[Vector]
    speed: Any
    bend: Any
    spin: Any
    twist: Any
    reach: Any

    @classmethod
    def of(cls, lanes: list[Any]) -> Patch:
        """Return the patch of PATCH_SCALARS scalars."""
        turns = [lanes[15 + 3 * k : 18 + 3 * k] for k in range(3)]
        return cls(lanes[:3], lanes[3:12], lanes[12:15], turns, *lanes[24:PATCH_SCALARS])

    def shifts(self) -> list[Vector]:
        """Return the derivatives of p along the six coordinates, or the one direction."""
        if len(self.turns) == 1:
            return [self.half]
        zero = [0.0, 0.0, 0.0]
        return [[self.half[i] if i == k else 0.0 for i in range(3)] for k in range(3)] + [zero] * 3

    def _turned(self, value: Vector) -> list[Vector]:
        turned = [cross(turn, value) for turn in self.turns]
        return turned if len(turned) == 1 else [[0.0, 0.0, 0.0]] * 3 + turned

    def carried(self, arm: Vector, most: Any, tolerance: Any) -> Jet:
        """R b for a vector b of the platform, |b| ≤ most, that may be off by `tolerance`."""
        value, error = turned(self.rotation, arm), JET_ROUNDING * most
        slopes = self._turned(value)
        bound = most + tolerance
        slack = tolerance + error
        return Jet(
            value,
            slopes,
            slack,
            self.spin * bound + slack,
            (self.spin * self.spin + self.twist) * bound + 2.0 * (self.spin * tolerance),
            bound,
        )

    def carried_direction(self, direction: Vector, tolerance: Any) -> Jet:
        """R t for a unit vector t that may be turned by an angle ≤ `tolerance`."""
        value = turned(self.rotation, direction)
        slopes = self._turned(value)
        spin = self.spin + tolerance
        second = spin * spin + self.twist + self.spin * tolerance
        return Jet(value, slopes, tolerance + JET_ROUNDING, spin + JET_ROUNDING, second, 1.0)


@dataclass(frozen=True)
class SegmentOnPatch:
    """A leg on a patch: its lines, the segment between its feet, and its rows.

    Attributes
    ----------
    direction, length, moment : Jet
        u; the signed distance of the feet; f × u for the foot f from the platform origin.
    foot : Jet
        From the platform origin to the foot on the platform.
    s, t : Jet
        Directions of the lines.
    d, arm : Jet
        p + R b − a, and R b.
    """

    direction: Jet
    length: Jet
    moment: Jet
    foot: Jet
    s: Jet
    t: Jet
    d: Jet
    arm: Jet


def lines_of(patch: Patch, geometry: Vector) -> tuple[Jet, Jet, Jet, Jet]:
    """Return d, R b, s, R t."""
    a, b, s, t = (geometry[i : i + 3] for i in range(0, 12, 3))
    size_a, size_b, near_a, near_b, near_s, near_t = geometry[12:18]
    arm = patch.carried(b, size_b, near_b)
    value = [p + r - x for p, r, x in zip(patch.position, arm.value, a, strict=True)]
    slack = near_a + near_b + JET_ROUNDING * (patch.reach + size_a + size_b)
    first = patch.speed + patch.spin * (size_b + near_b) + slack
    slopes = [plus(x, y) for x, y in zip(patch.shifts(), arm.slopes, strict=True)]
    d = Jet(value, slopes, slack, first, patch.bend + arm.second, size(value) + first)
    still = constant(s, 1.0)
    fixed = Jet(s, still.slopes, near_s + JET_ROUNDING, near_s + JET_ROUNDING, near_s * near_s, 1.0)
    return d, arm, fixed, patch.carried_direction(t, near_t)


def across(d: Jet, t: Jet, spin: Any, twist: Any) -> Jet:
    """Return d − (d·t) t for a unit vector t that turns with |ω| ≤ spin, |ω′| ≤ twist."""
    along = dot(d.value, t.value)
    value = [x - along * y for x, y in zip(d.value, t.value, strict=True)]
    slopes = []
    for dd, dt in zip(d.slopes, t.slopes, strict=False):
        rate = dot(dd, t.value) + dot(d.value, dt)
        slopes.append([x - rate * y - along * z for x, y, z in zip(dd, t.value, dt, strict=True)])
    first = d.first + spin * d.most
    slack = d.slack + t.slack * d.most + JET_ROUNDING * first
    second = d.second + 2.0 * (spin * d.first) + (twist + 2.0 * (spin * spin)) * d.most
    return Jet(value, slopes, slack, first, second, size(value) + first)


def _pointed(
    vector: Jet, arm: Jet, foot: Jet, lines: tuple[Jet, ...], slide: Jet | None
) -> SegmentOnPatch:
    d, s, t = lines
    u = unit(vector)
    moment = outer(arm, u, close=False)
    if slide is not None:
        moment = total(moment, multiple(slide, outer(t, u)), -1.0)
    return SegmentOnPatch(u, length(vector), moment, foot, s, t, d, arm)


def point_point(patch: Patch, geometry: Vector) -> SegmentOnPatch:
    """D1."""
    d, arm, s, t = lines_of(patch, geometry)
    return _pointed(d, arm, arm, (d, s, t), None)


def point_line(patch: Patch, geometry: Vector) -> SegmentOnPatch:
    """D2: the foot is R b − (d·t) t."""
    d, arm, s, t = lines_of(patch, geometry)
    near = geometry[17]
    vector = across(d, t, patch.spin + near + JET_ROUNDING, patch.twist + patch.spin * near)
    slide = inner(d, t)
    return _pointed(vector, arm, total(arm, multiple(slide, t), -1.0), (d, s, t), slide)


def line_point(patch: Patch, geometry: Vector) -> SegmentOnPatch:
    """D3."""
    d, arm, s, t = lines_of(patch, geometry)
    vector = across(d, s, geometry[16] + JET_ROUNDING, 0.0)
    return _pointed(vector, arm, arm, (d, s, t), None)


def line_line(patch: Patch, geometry: Vector) -> SegmentOnPatch:
    """D4 and A1: the foot is R b − k t, k = (d × s)·(t × s) / |t × s|²."""
    d, arm, s, t = lines_of(patch, geometry)
    normal = outer(t, s)
    u, per_sine = unit(normal), inverse(length(normal))
    slide = multiple(per_sine, inner(outer(d, s), u))
    moment = total(outer(arm, u), multiple(slide, outer(t, u)), -1.0)
    foot = total(arm, multiple(slide, t), -1.0)
    return SegmentOnPatch(u, inner(d, u), moment, foot, s, t, d, arm)


def _above(patch: Patch, leg: SegmentOnPatch) -> Jet:
    """Return the foot on the platform, in base axes."""
    reach = size(patch.position) + patch.speed
    still = Jet(patch.position, patch.shifts(), 0.0, patch.speed, patch.bend, reach)
    return total(still, leg.foot)


def _base_point(geometry: Vector) -> Jet:
    a, near = geometry[:3], geometry[14]
    return Jet(a, constant(a, 0.0).slopes, near, near, 0.0, geometry[12] + near)


def feet_from_point(patch: Patch, geometry: Vector, leg: SegmentOnPatch) -> tuple[Jet, Jet]:
    """Return the feet on base and platform of a leg from a point of the base, in base axes."""
    above = _above(patch, leg)
    return _base_point(geometry), above


def feet_from_line(patch: Patch, geometry: Vector, leg: SegmentOnPatch) -> tuple[Jet, Jet]:
    """Return the feet of a leg from a line of the base to a point, where a + (d·s) s is one."""
    above = _above(patch, leg)
    return total(_base_point(geometry), multiple(inner(leg.d, leg.s), leg.s)), above


def feet_of_lines(patch: Patch, geometry: Vector, leg: SegmentOnPatch) -> tuple[Jet, Jet]:
    """Return the feet of a leg between two lines, the signed distance apart along u."""
    above = _above(patch, leg)
    return total(above, multiple(leg.length, leg.direction), -1.0), above


def _distance_row(leg: SegmentOnPatch, per_length: Any) -> Jet:
    """[u, (f × u)/L]."""
    return row_of(leg.direction, scaled(per_length, leg.moment))


def _angle_row(leg: SegmentOnPatch, per_length: Any) -> Jet:
    """Row of A1 multiplied by L, [0, u], but for its sign."""
    return joined(constant([0.0] * 3, 0.0), leg.direction)


def signed_distance(leg: SegmentOnPatch) -> Jet:
    """Distance of the feet; of a D4 leg with the sign of d · (t × s)."""
    return leg.length


def _cosine(leg: SegmentOnPatch) -> Jet:
    return inner(leg.t, leg.s)


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A kind of leg on a patch.

    Attributes
    ----------
    name : str
    segment : Patch, geometry -> SegmentOnPatch
    feet : Patch, geometry, SegmentOnPatch -> two of Jet
        Feet on base and platform, in base axes.
    rows : tuple of SegmentOnPatch, 1/L -> Jet
        Rows of the homogeneous Jacobian, up to sign.
    values : tuple of SegmentOnPatch -> Jet
        Per row the signed distance, or the cosine of the angle.
    signed : bool
        Whether direction and distance change their sign where the lines of the leg meet.
    """

    name: str
    segment: Callable[[Patch, Vector], SegmentOnPatch]
    feet: Callable[[Patch, Vector, SegmentOnPatch], tuple[Jet, Jet]]
    rows: tuple[Callable[[SegmentOnPatch, Any], Jet], ...]
    values: tuple[Callable[[SegmentOnPatch], Jet], ...]
    signed: bool


_KINDS = (
    Kind(
        name="D1",
        segment=point_point,
        feet=feet_from_point,
        rows=(_distance_row,),
        values=(signed_distance,),
        signed=False,
    ),
    Kind(
        name="D2",
        segment=point_line,
        feet=feet_from_point,
        rows=(_distance_row,),
        values=(signed_distance,),
        signed=False,
    ),
    Kind(
        name="D3",
        segment=line_point,
        feet=feet_from_line,
        rows=(_distance_row,),
        values=(signed_distance,),
        signed=False,
    ),
    Kind(
        name="D4",
        segment=line_line,
        feet=feet_of_lines,
        rows=(_distance_row,),
        values=(signed_distance,),
        signed=True,
    ),
    Kind(
        name="A1",
        segment=line_line,
        feet=feet_of_lines,
        rows=(_angle_row,),
        values=(_cosine,),
        signed=True,
    ),
    Kind(
        name="D4 A1",
        segment=line_line,
        feet=feet_of_lines,
        rows=(_distance_row, _angle_row),
        values=(signed_distance, _cosine),
        signed=True,
    ),
)

# By the name of the leg.
KINDS = MappingProxyType({kind.name: kind for kind in _KINDS})
