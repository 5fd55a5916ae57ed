"""The legs SPS, SPC, CPS and CCC: joints, constraints, and how their passive joints move."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np

from gsp.errors import InvalidDesign, brief, expected
from gsp.geometry.vectors import Array, cross, dot
from gsp.model.constraints import CONSTRAINT, Constraint, Lines, Segment, line_row, spin_row

FREEDOMS = MappingProxyType({"S": 3, "P": 1, "C": 2})


@dataclass(frozen=True)
class Joint:
    """A joint of a leg: its kind, and which of its freedoms an actuator drives."""

    kind: Literal["S", "P", "C"]
    active: Literal["", "slide", "turn", "slide and turn"] = ""

    @property
    def freedoms(self) -> int:
        """Number of freedoms: 3 for S, 2 for C, 1 for P."""
        return FREEDOMS[self.kind]


@dataclass(frozen=True)
class Leg:
    """One kind of leg.

    Attributes
    ----------
    name : str
        Its constraints as text: "D1", "D2", "D3", "D4", "A1" or "D4 A1".
    chain : str
        Its joints from base to platform: "SPS", "SPC", "CPS" or "CCC".
    constraints : tuple of Constraint
        In row order.
    joints : tuple of Joint
        From base to platform.
    idle : int
        Freedoms that move neither platform nor actuator (the turn of an SPS leg about itself).
    passive : Lines, Segment -> turns (..., k, 4, 6), slides (..., k, j, 6)
        Rows that give the rates of the passive joints from a twist: see `passive_rates`.
    """

    name: str
    chain: str
    constraints: tuple[Constraint, ...]
    joints: tuple[Joint, Joint, Joint]
    idle: int
    passive: Callable[[Lines, Segment], tuple[Array, Array]]

    def __reduce__(self) -> tuple[object, ...]:
        # In another process it is that process's leg of the same name, so that `is` still holds.
        return check_leg, (self.name,)

    @property
    def base_line(self) -> bool:
        """Whether the leg sits on a line of the base."""
        return self.constraints[0].base == "line"

    @property
    def platform_line(self) -> bool:
        """Whether the leg sits on a line of the platform."""
        return self.constraints[0].platform == "line"

    @property
    def cylindrical(self) -> bool:
        """Whether a passive joint slides."""
        return "C" in self.chain


def _scaled(row: Array, factor: Array) -> Array:
    return row * factor[..., None]


def _turns(u: Array, e1: Array, e2: Array, rate1: Array, rate2: Array) -> Array:
    """Rows of u̇ along the normals e1, e2 of u, seen from the base, then from the platform."""
    return np.stack(
        (rate1, rate2, rate1 - spin_row(cross(u, e1)), rate2 - spin_row(cross(u, e2))), axis=-2
    )


def _normals(u: Array) -> tuple[Array, Array]:
    """Two unit vectors that complete u to an orthonormal frame, continuous away from u_z = 0-."""
    x, y, z = u[..., 0], u[..., 1], u[..., 2]
    sign = np.where(z < 0.0, -1.0, 1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    return (
        np.stack((1.0 + sign * x * x * a, sign * b, -sign * x), axis=-1),
        np.stack((b, sign + y * y * a, -y), axis=-1),
    )


def _no_slides(rows: Array) -> Array:
    return np.zeros((*rows.shape[:-2], 0, 6))


def _sps(lines: Lines, segment: Segment) -> tuple[Array, Array]:
    u, arm, per_length = segment.direction, segment.arm, 1.0 / segment.length
    e1, e2 = _normals(u)
    rates = (_scaled(line_row(e, arm), per_length) for e in (e1, e2))
    turns = _turns(u, e1, e2, *rates)
    return turns, _no_slides(turns)


def _spc(lines: Lines, segment: Segment) -> tuple[Array, Array]:
    u, arm, t = segment.direction, segment.arm, lines.t
    e2 = cross(u, t)
    tilt = spin_row(e2)  # u̇ · t = −u · (ω × t)
    turns = _turns(u, t, e2, tilt, _scaled(line_row(e2, arm), 1.0 / segment.length))
    slide = _scaled(tilt, segment.length) - line_row(t, arm)
    return turns, slide[..., None, :]


def _cps(lines: Lines, segment: Segment) -> tuple[Array, Array]:
    u, arm = segment.direction, segment.arm
    s = np.broadcast_to(lines.s, u.shape)
    e2 = cross(u, s)
    rate = _scaled(line_row(e2, arm), 1.0 / segment.length)
    return _turns(u, s, e2, np.zeros_like(rate), rate), line_row(s, arm)[..., None, :]


def _ccc(lines: Lines, segment: Segment) -> tuple[Array, Array]:
    u, arm, t = segment.direction, segment.arm, lines.t
    s = np.broadcast_to(lines.s, u.shape)
    m = cross(u, s)
    per_sine = 1.0 / dot(m, t)
    rate = -_scaled(spin_row(cross(t, u)), per_sine)
    slide_t = _scaled(_scaled(rate, segment.length) - line_row(m, arm), per_sine)
    slide_s = line_row(s, arm) + _scaled(slide_t, dot(t, s))
    turns = _turns(u, s, m, np.zeros_like(rate), rate)
    return turns, np.stack((slide_s, slide_t), axis=-2)


def _ccc_angle(lines: Lines, segment: Segment) -> tuple[Array, Array]:
    turns, slides = _ccc(lines, segment)
    normal = line_row(segment.direction, segment.arm)[..., None, :]
    return turns, np.concatenate((slides, normal), axis=-2)


_S, _C, _P = Joint("S"), Joint("C"), Joint("P", "slide")
_D1, _D2, _D3, _D4, _A1 = CONSTRAINT.values()

LEGS = (
    Leg("D1", "SPS", (_D1,), (_S, _P, _S), 1, _sps),
    Leg("D2", "SPC", (_D2,), (_S, _P, _C), 0, _spc),
    Leg("D3", "CPS", (_D3,), (_C, _P, _S), 0, _cps),
    Leg("D4", "CCC", (_D4,), (_C, Joint("C", "slide"), _C), 0, _ccc),
    Leg("A1", "CCC", (_A1,), (_C, Joint("C", "turn"), _C), 0, _ccc_angle),
    Leg("D4 A1", "CCC", (_D4, _A1), (_C, Joint("C", "slide and turn"), _C), 0, _ccc),
)

LEG = MappingProxyType({leg.name: leg for leg in LEGS})


def check_leg(text: str | Iterable[str], where: str = "leg") -> Leg:
    """Return the leg that carries the named constraint(s); "A1 D4" and ("D4", "A1") work too.

    Raises
    ------
    InvalidDesign
        If no leg carries just these constraints.
    """
    words = (text,) if isinstance(text, str) or not isinstance(text, Iterable) else tuple(text)
    parts = " ".join(map(str, words)).replace(",", " ").upper().split()
    name = " ".join(sorted(parts, key=lambda part: (part[0] != "D", part)))
    if name not in LEG:
        raise InvalidDesign(expected(where, "one of " + ", ".join(map(repr, LEG)), brief(text)))
    return LEG[name]
