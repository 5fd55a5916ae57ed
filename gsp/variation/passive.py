"""Rows of the passive rates of legs on patches, and of the speeds of an operation ellipsoid.

As in `gsp.model.formulas`, but for SPS legs: there the turns of u enter by all three components of
the projector I − u uᵀ instead of two directions across u. The sum of squares is the same, and the
directions across u that the formula takes are not continuous.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from gsp.geometry.scalars import cross, dot, minus, plus, turned
from gsp.variation.jets import (
    JET_ROUNDING,
    Jet,
    Vector,
    constant,
    inner,
    inverse,
    joined,
    least,
    multiple,
    outer,
    scaled,
    size,
    total,
)
from gsp.variation.legs import Patch, SegmentOnPatch

# Scalars of an ellipsoid: c and |c|; the middle and half of the span of the weights; and the matrix
# by rows that is to be added to the middle weight, in platform axes.
WEIGHTS_SCALARS = 15
# Weight of the speeds, 1/√6.
PER_ROOT_SIX = 6.0**-0.5


def _less(x: Jet, y: Jet) -> Jet:
    return total(x, y, -1.0)


@dataclass(frozen=True)
class _Rows:
    """Rows for the twist (v, L ω): moments are divided by the length L."""

    leg: SegmentOnPatch
    per_length: Any

    def spin(self, axis: Jet) -> Jet:
        """[0, x/L]."""
        return joined(constant([0.0] * 3, 0.0), scaled(self.per_length, axis))

    def line(self, direction: Jet) -> Jet:
        """[x, f × x / L] for the foot f."""
        return joined(direction, scaled(self.per_length, outer(self.leg.foot, direction)))

    def turns(self, rate: Jet, across: Jet) -> Jet:
        """Rate of u along a direction, seen from the platform."""
        return _less(rate, self.spin(outer(self.leg.direction, across)))

    def slide(self, row: Jet) -> Jet:
        """Slide over the length."""
        return scaled(self.per_length, row)


def _sps(leg: SegmentOnPatch, rows: _Rows) -> list[Jet]:
    u, per = leg.direction, inverse(leg.length)
    result = []
    for k in range(3):
        e = constant([float(i == k) for i in range(3)], 1.0)
        rate = multiple(per, rows.line(_less(e, multiple(inner(u, e), u))))
        result += [rate, rows.turns(rate, e)]
    return result


def _spc(leg: SegmentOnPatch, rows: _Rows) -> list[Jet]:
    e = outer(leg.direction, leg.t)
    rate, tilt = multiple(inverse(leg.length), rows.line(e)), rows.spin(e)
    slide = _less(multiple(leg.length, tilt), rows.line(leg.t))
    return [tilt, rate, rows.turns(rate, e), rows.slide(slide)]


def _cps(leg: SegmentOnPatch, rows: _Rows) -> list[Jet]:
    e = outer(leg.direction, leg.s)
    rate = multiple(inverse(leg.length), rows.line(e))
    return [rate, rows.spin(e), rows.turns(rate, e), rows.slide(rows.line(leg.s))]


def _ccc(leg: SegmentOnPatch, rows: _Rows) -> list[Jet]:
    u, s, t = leg.direction, leg.s, leg.t
    m = outer(u, s)
    per_sine = inverse(inner(m, t))
    rate = multiple(per_sine, rows.spin(outer(u, t)))
    slide_t = multiple(per_sine, _less(multiple(leg.length, rate), rows.line(m)))
    slide_s = total(rows.line(s), multiple(inner(t, s), slide_t))
    return [rows.spin(m), rate, rows.turns(rate, m), rows.slide(slide_s), rows.slide(slide_t)]


def _ccc_angle(leg: SegmentOnPatch, rows: _Rows) -> list[Jet]:
    return [*_ccc(leg, rows), rows.slide(rows.line(leg.direction))]


# By the name of the leg.
PASSIVE: MappingProxyType[str, Callable[[SegmentOnPatch, _Rows], list[Jet]]] = MappingProxyType(
    {"D1": _sps, "D2": _spc, "D3": _cps, "D4": _ccc, "A1": _ccc_angle, "D4 A1": _ccc}
)


def passive_rows(name: str, leg: SegmentOnPatch, per_length: Any) -> list[Jet]:
    """Rows of the passive rates of a leg, by its name."""
    return PASSIVE[name](leg, _Rows(leg, per_length))


def _turned(patch: Patch, weights: Vector, m: Jet) -> Jet:
    """R E Rᵀ m for the symmetric matrix E of the weights, whose eigenvalues are within ±half."""
    matrix, half = weights[6:], weights[5]
    columns = [patch.rotation[j::3] for j in range(3)]

    def applied(x: Vector) -> Vector:
        seen = [dot(column, x) for column in columns]
        return turned(patch.rotation, turned(matrix, seen))

    value = applied(m.value)
    slopes = [applied(slope) for slope in m.slopes[:3]]
    for turn, slope in zip(patch.turns, m.slopes[3:], strict=True):
        slopes.append(plus(cross(turn, value), applied(minus(slope, cross(turn, m.value)))))
    first = half * m.first + 2.0 * half * patch.spin * m.most
    bend = 2.0 * half * (patch.twist + 2.0 * (patch.spin * patch.spin))
    return Jet(
        value,
        slopes,
        half * m.slack + JET_ROUNDING * (half * m.most + first),
        first,
        half * m.second + 4.0 * half * patch.spin * m.first + bend * m.most,
        least(half * m.most, size(value) + first),
    )


def ellipsoid_row(patch: Patch, weights: Vector, direction: Jet | None, moment: Jet) -> Jet:
    """Row for speeds of the ellipsoid, but for a rotation of its last three components.

    Parameters
    ----------
    weights : WEIGHTS_SCALARS scalars
    direction : Jet or None
        u; None for a pure couple.
    moment : Jet
        About the platform origin.
    """
    still = constant([0.0] * 3, 0.0)
    force = still
    if direction is not None:
        centre = patch.carried(weights[:3], weights[3], 0.0)
        moment = _less(moment, outer(centre, direction))
        force = scaled(PER_ROOT_SIX, direction)
    weighted = total(scaled(weights[4], moment), _turned(patch, weights, moment))
    return joined(force, weighted)
