"""The formulas of a planar leg, each in this one place: segment, value, row, passive rates.

They are written as those in space (`gsp.model.formulas`): for scalars of any kind of number,
without branches, vectors as lists of two. A twist is (v_x, v_y, ω), with v the velocity of the
platform origin. In the plane a line has one normal, so that a point on a line and lines that are
parallel leave every row defined.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from gsp.geometry.scalars import (
    Scalar,
    Vector,
    arc,
    choose,
    dot,
    less,
    minus,
    norm,
    plus,
    times,
)
from gsp.model.formulas import ZERO, PassiveRate, Placement


class PlanarSegment(NamedTuple):
    """The segment along which a planar leg acts, and the directions of its lines.

    Attributes
    ----------
    s, t : two scalars each
        Of the placement.
    arm : two scalars [length]
        From the platform origin to the platform foot; of an A1 leg to the point where its lines
        cross, infinite where they are parallel.
    direction : two scalars, none for A1
        Unit vector from the base foot to the platform foot. Where a point lies on a line it is
        the line turned counter-clockwise.
    length : scalar, none for A1 [length]
        Distance of the feet, ≥ 0.
    defined : condition
        False where the direction does not exist.
    """

    s: Vector
    t: Vector
    arm: Vector
    direction: Vector = []  # noqa: RUF012 - never changed
    length: Scalar = None
    defined: Any = True


def quarter_turn(x: Vector) -> Vector:
    """Vector turned by a right angle, counter-clockwise."""
    return [-x[1], x[0]]


def point_point(at: Placement) -> PlanarSegment:
    """D1: the segment from anchor to anchor."""
    length = norm(at.d)
    direction = times(1.0 / length, at.d)
    return PlanarSegment(at.s, at.t, at.arm, direction, length, less(ZERO * at.scale, length))


def _from_line(line: Vector, arm: Vector, at: Placement) -> PlanarSegment:
    """Return the segment along the normal of a line, on the side of d, to the foot at `arm`."""
    normal = quarter_turn(line)
    offset = dot(at.d, normal)
    behind = less(offset, 0.0)
    side, length = choose(behind, -1.0, 1.0), choose(behind, -offset, offset)
    return PlanarSegment(at.s, at.t, arm, times(side, normal), length)


def point_line(at: Placement) -> PlanarSegment:
    """D2: the segment from the base anchor, perpendicular to the platform line."""
    return _from_line(at.t, minus(at.arm, times(dot(at.d, at.t), at.t)), at)


def line_point(at: Placement) -> PlanarSegment:
    """D3: the segment from the base line, perpendicular to it, to the anchor."""
    return _from_line(at.s, at.arm, at)


def line_line(at: Placement) -> PlanarSegment:
    """A1: the point where the lines cross, d = σ s − τ t."""
    across = quarter_turn(at.s)
    slide = -dot(at.d, across) / dot(at.t, across)
    return PlanarSegment(at.s, at.t, plus(at.arm, times(slide, at.t)))


def distance(segment: PlanarSegment) -> Scalar:
    """Value of D1–D3: the length of the segment [length], ≥ 0."""
    return segment.length


def angle(segment: PlanarSegment) -> Scalar:
    """Value of A1: the angle from the base line to the platform line [rad], in (−π, π]."""
    sine, cosine = dot(segment.t, quarter_turn(segment.s)), dot(segment.s, segment.t)
    clockwise = less(sine, 0.0)
    size = arc(choose(clockwise, -sine, sine), cosine)
    return choose(clockwise, -size, size)


def line_row(direction: Vector, arm: Vector) -> Vector:
    """Row of the velocity, along `direction`, of the platform point at `arm`: three scalars."""
    return [*direction, dot(direction, quarter_turn(arm))]


def spin_row(rate: Scalar) -> Vector:
    """Row of the angular velocity times a rate: three scalars."""
    return [0.0, 0.0, rate]


def distance_row(segment: PlanarSegment, weight: Scalar) -> Vector:
    """Row of D1–D3: the gradient of the distance, three scalars [1, length].

    `weight` is not used; see `angle_row`.
    """
    return line_row(segment.direction, segment.arm)


def angle_row(segment: PlanarSegment, weight: Scalar) -> Vector:
    """Row of A1: the gradient of the angle times a weight, three scalars."""
    return spin_row(weight)


# Passive rates: turns of the direction of the leg seen from the base and from the platform, then
# slides. In the plane every turn is about the one normal.


def rpr(segment: PlanarSegment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of a D1 leg: a turn seen from either body. `length` is not used.

    *Source: Nawratil, §4.2*
    """
    across = quarter_turn(segment.direction)
    turn = times(1.0 / segment.length, line_row(across, segment.arm))
    return [PassiveRate("base", turn), PassiveRate("platform", minus(turn, spin_row(1.0)))]


def rpp(segment: PlanarSegment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of a D2 leg: it turns on the base and slides on the platform line."""
    turned = segment.length * dot(segment.direction, quarter_turn(segment.t))
    slide = plus(line_row(segment.t, segment.arm), spin_row(turned))
    return [PassiveRate("base", spin_row(1.0)), PassiveRate("slide", times(1.0 / length, slide))]


def ppr(segment: PlanarSegment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of a D3 leg: it turns on the platform and slides on the base line."""
    slide = times(1.0 / length, line_row(segment.s, segment.arm))
    return [PassiveRate("platform", spin_row(1.0)), PassiveRate("slide", slide)]


def prp(segment: PlanarSegment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of an A1 leg: it slides on both lines.

    The point of the platform at the crossing of the lines moves along s by what slides on s, and
    along t by what slides on t. The rows are not finite where the lines are parallel.
    """
    s, t = quarter_turn(segment.s), quarter_turn(segment.t)
    weight = 1.0 / (length * dot(segment.s, t))
    rows = (line_row(t, segment.arm), line_row(s, segment.arm))
    return [PassiveRate("slide", times(weight, row)) for row in rows]
