"""The formulas of a leg, each in this one place: placement, segment, value, row, passive rates.

Every distance constraint acts along one segment, from a foot on the base to a foot on the
platform. Its row of the inverse Jacobian is the line of that segment in Plücker coordinates
about the platform origin, so the five printed formulas of `TozKucuk2016` follow from four formulas
of a segment and two of a row.

The formulas are written for scalars of any kind of number (see `gsp.geometry.scalars`) and have no
branches on values: `Posture` evaluates them on numpy arrays, one array per component, and the
compiled kernels are made from them by tracing. A leg without a line on one body does not read the
direction there, which may then be anything.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

from gsp.geometry.scalars import (
    Scalar,
    Vector,
    arc,
    choose,
    cross,
    dot,
    less,
    minus,
    norm,
    plus,
    times,
    turned,
)
from gsp.geometry.vectors import EPS

# A distance below ZERO × the lengths it was subtracted from, and a sine below ZERO, are rounding.
ZERO = 8 * EPS


class Placement(NamedTuple):
    """Anchor points and lines of a leg at a pose, all in base axes.

    Attributes
    ----------
    d : three scalars [length]
        p + R b − a, from base anchor to platform anchor. *Source: TozKucuk2016, eq. (1)*
    arm : three scalars [length]
        R b, from platform origin to platform anchor.
    s, t : three scalars each
        Unit directions of the base line and (turned by R) of the platform line; t is empty if it
        was left out.
    scale : scalar [length]
        |p| + |b| + |a|, the size of the terms of `d`.
    drive : scalars, or none for a leg that is not driven at the base
        See `gsp.model.rods`.
    """

    d: Vector
    arm: Vector
    s: Vector
    t: Vector
    scale: Scalar
    drive: Vector = []  # noqa: RUF012 - never changed


class Segment(NamedTuple):
    """The segment between the feet of a leg, and the directions of its lines.

    Attributes
    ----------
    s, t : three scalars each
        Of the placement.
    direction : three scalars
        Unit vector from the base foot to the platform foot.
    length : scalar [length]
        Distance of the feet, ≥ 0.
    arm : three scalars [length]
        From the platform origin to the platform foot.
    defined : condition
        False where the direction does not exist; the other attributes are then not valid.
    normal : three scalars, or none for a segment from or to a point
        t × s.
    sine : scalar, or none for a segment from or to a point
        |t × s|.
    driven : gsp.model.rods.Driven, or none for a leg that is not driven at the base
    """

    s: Vector
    t: Vector
    direction: Vector
    length: Scalar
    arm: Vector
    defined: Any
    normal: Vector = []  # noqa: RUF012 - never changed
    sine: Scalar = None
    driven: Any = None


class PassiveRate(NamedTuple):
    """A row that gives the rate of a passive joint from a twist.

    Attributes
    ----------
    kind : "base", "platform" or "slide"
        A turn of the unit vector of the leg seen from the base or from the platform [1/time], or a
        slide over the characteristic length [1/time].
    row : six scalars
    """

    kind: Literal["base", "platform", "slide"]
    row: Vector


def placement(
    position: Sequence[Any],
    rotation: Sequence[Any],
    points: tuple[Sequence[Any], Sequence[Any]],
    directions: tuple[Vector, Vector],
    scale: Scalar,
) -> Placement:
    """Return a leg at a pose.

    Parameters
    ----------
    position : three scalars [length]
        p.
    rotation : nine scalars
        R by rows.
    points : two times three scalars [length]
        a in base axes and b in platform axes.
    directions : two times three scalars
        Unit vectors s in base axes and t in platform axes; t may be left empty where the leg has
        no line on the platform.
    scale : scalar [length]
        |p| + |a| + |b|.

    Returns
    -------
    Placement

    *Source: TozKucuk2016, eq. (1)*
    """
    (a, b), (s, t) = points, directions
    arm = turned(rotation, b)
    d = minus(plus(position, arm), a)
    return Placement(d, arm, s, turned(rotation, t) if len(t) else [], scale)


def _from_feet(vector: Vector, arm: Vector, at: Placement) -> Segment:
    """Return the segment along a vector to the platform foot at `arm`."""
    length = norm(vector)
    direction = times(1.0 / length, vector)
    return Segment(at.s, at.t, direction, length, arm, less(ZERO * at.scale, length))


def point_point(at: Placement) -> Segment:
    """D1: the segment from anchor to anchor.

    *Source: TozKucuk2016, eq. (2)*
    """
    return _from_feet(at.d, at.arm, at)


def point_line(at: Placement) -> Segment:
    """D2: the segment from the base anchor, perpendicular to the platform line.

    *Source: TozKucuk2016, eq. (3)*
    """
    vector = cross(at.t, cross(at.d, at.t))
    return _from_feet(vector, minus(at.arm, times(dot(at.d, at.t), at.t)), at)


def line_point(at: Placement) -> Segment:
    """D3: the segment from the base line, perpendicular to it, to the anchor.

    *Source: TozKucuk2016, eq. (4)*
    """
    return _from_feet(cross(at.s, cross(at.d, at.s)), at.arm, at)


def line_line(at: Placement) -> Segment:
    """D4 and A1: the segment along the common normal of the two lines.

    Where the lines meet the length is zero and the direction is +t × s; only parallel lines
    leave it undefined.

    *Source: TozKucuk2016, eq. (5)*
    """
    d, s, t = at.d, at.s, at.t
    normal = cross(t, s)
    sine = norm(normal)
    per_sine = 1.0 / sine
    offset = dot(d, normal) * per_sine
    slide = -dot(cross(d, s), normal) / (sine * sine)
    behind = less(offset, 0.0)
    per_side = choose(behind, -per_sine, per_sine)
    length, foot = choose(behind, -offset, offset), plus(at.arm, times(slide, t))
    return Segment(s, t, times(per_side, normal), length, foot, less(ZERO, sine), normal, sine)


def distance(segment: Segment) -> Scalar:
    """Value of D1–D4: the length of the segment [length], ≥ 0.

    *Source: TozKucuk2016, eqs. (2)–(5)*
    """
    return segment.length


def angle(segment: Segment) -> Scalar:
    """Value of A1: the angle between the lines [rad], in (0, π).

    *Source: TozKucuk2016, eq. (6)*
    """
    return arc(segment.sine, dot(segment.t, segment.s))


def line_row(direction: Vector, arm: Vector) -> Vector:
    """Row of the velocity, along `direction`, of the platform point at `arm`: six scalars.

    [x, r × x] · (v, ω) = x · (v + ω × r).
    """
    return [*direction, *cross(arm, direction)]


def spin_row(axis: Vector) -> Vector:
    """Row of the angular velocity about `axis`: [0, x] · (v, ω) = x · ω, six scalars."""
    return [0.0, 0.0, 0.0, *axis]


def distance_row(segment: Segment, weight: Scalar) -> Vector:
    """Row of D1–D4: the gradient of the distance for the twist (v, ω), six scalars [1, length].

    `weight` is not used; see `angle_row`.

    *Source: TozKucuk2016, eqs. (12)–(15)*
    """
    return line_row(segment.direction, segment.arm)


def angle_row(segment: Segment, weight: Scalar) -> Vector:
    """Row of A1: the gradient of the angle, times a weight, for the twist (v, ω): six scalars.

    Parameters
    ----------
    segment : Segment
    weight : scalar
        1.0 for a rate in rad; a length L for the speed L θ̇ that the rate counts as.

    *Source: TozKucuk2016, eq. (16)*
    """
    return spin_row(times(-weight / segment.sine, segment.normal))


# Passive rates. u is the direction of the segment; e1 and e2 complete it to an orthonormal frame.
# Along e the tip of u moves with the rate (e · velocity of the platform foot) / length as seen from
# the base, and seen from the platform with ω · (u × e) less. Rows that are zero for every posture
# are left out. The order of the rows does not matter; the compiled QR factorisation uses this one.


def normals(u: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors that complete u to an orthonormal frame, continuous away from u_z = 0−."""
    x, y, z = u
    sign = choose(less(z, 0.0), -1.0, 1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    return [1.0 + sign * x * x * a, sign * b, -(sign * x)], [b, sign + y * y * a, -y]


def _tip(segment: Segment, e: Vector) -> Vector:
    """Row of the rate of u along e, seen from the base."""
    return times(1.0 / segment.length, line_row(e, segment.arm))


def _less_spin(rate: Vector, segment: Segment, e: Vector) -> Vector:
    """Row of the rate of u along e, seen from the platform."""
    return minus(rate, spin_row(cross(segment.direction, e)))


def sps(segment: Segment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of a D1 leg: two turns seen from either body. `length` is not used.

    *Source: Nawratil, eqs. (18)–(20)*
    """
    rates = []
    for e in normals(segment.direction):
        rate = _tip(segment, e)
        rates += [PassiveRate("base", rate)]
        rates += [PassiveRate("platform", _less_spin(rate, segment, e))]
    return rates


def spc(segment: Segment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of a D2 leg, which slides on the platform line.

    With e1 = t, u̇ · t = −u · (ω × t); seen from the platform u does not turn along t.

    *Source: ours, after Nawratil, eqs. (18)–(20)*
    """
    e2 = cross(segment.direction, segment.t)
    tilt = spin_row(e2)
    rate = _tip(segment, e2)
    slide = minus(times(segment.length, tilt), line_row(segment.t, segment.arm))
    return [
        PassiveRate("base", tilt),
        PassiveRate("base", rate),
        PassiveRate("platform", _less_spin(rate, segment, e2)),
        PassiveRate("slide", times(1.0 / length, slide)),
    ]


def cps(segment: Segment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of a D3 leg, which slides on the base line.

    With e1 = −s, u does not turn along e1 seen from the base.

    *Source: ours, after Nawratil, eqs. (18)–(20)*
    """
    e2 = cross(segment.direction, segment.s)
    rate = _tip(segment, e2)
    return [
        PassiveRate("base", rate),
        PassiveRate("platform", spin_row(e2)),
        PassiveRate("platform", _less_spin(rate, segment, e2)),
        PassiveRate("slide", times(1.0 / length, line_row(segment.s, segment.arm))),
    ]


def ccc(segment: Segment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of a D4 leg, which slides on both lines.

    *Source: ours, after Nawratil, eqs. (18)–(20)*
    """
    u, s, t = segment.direction, segment.s, segment.t
    m = cross(u, s)
    per_sine = 1.0 / dot(m, t)
    rate = times(-per_sine, spin_row(cross(t, u)))
    slide_t = times(per_sine, minus(times(segment.length, rate), line_row(m, segment.arm)))
    slide_s = plus(line_row(s, segment.arm), times(dot(t, s), slide_t))
    return [
        PassiveRate("platform", spin_row(m)),
        PassiveRate("base", rate),
        PassiveRate("platform", _less_spin(rate, segment, m)),
        PassiveRate("slide", times(1.0 / length, slide_s)),
        PassiveRate("slide", times(1.0 / length, slide_t)),
    ]


def ccc_angle(segment: Segment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of an A1 leg: those of a D4 leg, and the slide along the common normal.

    *Source: ours, after Nawratil, eqs. (18)–(20)*
    """
    normal = times(1.0 / length, line_row(segment.direction, segment.arm))
    return [*ccc(segment, length), PassiveRate("slide", normal)]
