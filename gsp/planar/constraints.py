"""The planar constraints D1, D2, D3 and A1: their values, their rows, their passive joints.

They are the spatial constraints of the same names with all points, lines and motions in one
plane. A twist is (v_x, v_y, ω), with v the velocity of the platform origin.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np

from gsp.geometry.vectors import Array, Mask, dot, norm, unit
from gsp.model.formulas import ZERO


@dataclass(frozen=True, eq=False)
class PlanarLines:
    """Anchor points and lines of k legs at a batch of planar poses, in base axes.

    Attributes
    ----------
    d : (..., k, 2) array [length]
        p + R b − a, from base anchor to platform anchor.
    arm : (..., k, 2) array [length]
        R b, from platform origin to platform anchor.
    s, t : (..., k, 2) arrays
        Unit directions of the base line and of the platform line; NaN where there is none.
    scale : (..., k) array [length]
        |p| + |b| + |a|, the size of the terms of `d`.
    """

    d: Array
    arm: Array
    s: Array
    t: Array
    scale: Array

    def __getitem__(self, legs: list[int]) -> PlanarLines:
        """Return the lines of some of the legs."""
        d, arm, s, t = (part[..., legs, :] for part in (self.d, self.arm, self.s, self.t))
        return PlanarLines(d, arm, s, t, self.scale[..., legs])


def turned(x: Array) -> Array:
    """Vectors turned by a right angle, counter-clockwise, shape (..., 2)."""
    return np.stack((-x[..., 1], x[..., 0]), axis=-1)


def line_row(direction: Array, arm: Array) -> Array:
    """Rows that give the velocity, along `direction`, of the platform point at `arm`: (..., 3)."""
    return np.concatenate((direction, dot(direction, turned(arm))[..., None]), axis=-1)


def spin_row(rate: Array) -> Array:
    """Rows (0, 0, rate), shape (..., 3): angular velocity times a factor (...)."""
    zero = np.zeros_like(rate)
    return np.stack((zero, zero, rate), axis=-1)


def _normal(line: Array, d: Array) -> tuple[Array, Array]:
    """Return the unit normal of a line on the side of d (the turned line on neither), and |d·n|."""
    offset = dot(d, turned(line))
    return np.where(offset < 0.0, -1.0, 1.0)[..., None] * turned(line), np.abs(offset)


def _always(lines: PlanarLines) -> Mask:
    return np.ones(lines.scale.shape, dtype=bool)


def _apart(lines: PlanarLines) -> Mask:
    return np.asarray(norm(lines.d) > ZERO * lines.scale)


def _point_point(lines: PlanarLines) -> tuple[Array, Array]:
    return norm(lines.d), line_row(unit(lines.d), lines.arm)


def _point_line(lines: PlanarLines) -> tuple[Array, Array]:
    u, distance = _normal(lines.t, lines.d)
    foot = lines.arm - dot(lines.d, lines.t)[..., None] * lines.t
    return distance, line_row(u, foot)


def _line_point(lines: PlanarLines) -> tuple[Array, Array]:
    u, distance = _normal(lines.s, lines.d)
    return distance, line_row(u, lines.arm)


def _angle(lines: PlanarLines) -> tuple[Array, Array]:
    value = np.arctan2(dot(lines.t, turned(lines.s)), dot(lines.s, lines.t))
    return value, spin_row(np.ones_like(value))


def _rpr(lines: PlanarLines) -> tuple[Array, Array]:
    with np.errstate(invalid="ignore", divide="ignore"):
        turn = line_row(turned(unit(lines.d)), lines.arm) / norm(lines.d)[..., None]
    turns = np.stack((turn, turn - spin_row(np.ones(turn.shape[:-1]))), axis=-2)
    return turns, np.zeros((*turns.shape[:-2], 0, 3))


def _rpp(lines: PlanarLines) -> tuple[Array, Array]:
    slide = line_row(lines.t, lines.arm) + spin_row(dot(lines.d, turned(lines.t)))
    return spin_row(np.ones(slide.shape[:-1]))[..., None, :], slide[..., None, :]


def _ppr(lines: PlanarLines) -> tuple[Array, Array]:
    slide = line_row(np.broadcast_to(lines.s, lines.d.shape), lines.arm)
    return spin_row(np.ones(slide.shape[:-1]))[..., None, :], slide[..., None, :]


def _prp(lines: PlanarLines) -> tuple[Array, Array]:
    """Solve d = σ s − τ t, and with it ḋ = σ̇ s − τ̇ t − τ ω t⊥; by the normals of t and s."""
    s, t, d = np.broadcast_to(lines.s, lines.d.shape), lines.t, lines.d
    with np.errstate(invalid="ignore", divide="ignore"):
        per_sine = (1.0 / dot(s, turned(t)))[..., None]
        tau = dot(d, turned(s))[..., None] * per_sine
        moved = tau * spin_row(np.ones(d.shape[:-1]))
        along_s = (line_row(turned(t), lines.arm) + moved) * per_sine
        along_t = (
            line_row(turned(s), lines.arm) + moved * dot(turned(s), turned(t))[..., None]
        ) * per_sine
    slides = np.stack((along_s, along_t), axis=-2)
    return np.zeros((*slides.shape[:-2], 0, 3)), slides


@dataclass(frozen=True)
class PlanarConstraint:
    """One kind of constraint between base and platform in the plane, and the leg that carries it.

    Attributes
    ----------
    name : str
        "D1", "D2", "D3" or "A1", as in space.
    base, platform : "point" or "line"
    quantity : "distance" or "angle"
    chain : str
        Joints of the leg from base to platform, R turning and P sliding; the second is actuated.
    value_and_row : PlanarLines -> (..., k) array, (..., k, 3) array
        A distance ≥ 0 or an oriented angle in (−π, π]; and its gradient for the twist (v, ω).
    passive : PlanarLines -> turns (..., k, i, 3), slides (..., k, j, 3)
        Rows that give the rates of the passive joints, up to sign.
    defined : PlanarLines -> (..., k) bool array
    undefined : str
        Why there is no row, where there is none.
    """

    name: str
    base: Literal["point", "line"]
    platform: Literal["point", "line"]
    quantity: Literal["distance", "angle"]
    chain: str
    value_and_row: Callable[[PlanarLines], tuple[Array, Array]]
    passive: Callable[[PlanarLines], tuple[Array, Array]]
    defined: Callable[[PlanarLines], Mask]
    undefined: str

    @property
    def symbol(self) -> str:
        """Letter of the joint variable: d for a distance, theta for an angle."""
        return "d" if self.quantity == "distance" else "theta"

    @property
    def constraints(self) -> tuple[PlanarConstraint]:
        """The constraints of the leg: this one."""
        return (self,)

    @property
    def base_line(self) -> bool:
        """Whether the leg sits on a line of the base."""
        return self.base == "line"

    @property
    def platform_line(self) -> bool:
        """Whether the leg sits on a line of the platform."""
        return self.platform == "line"

    @property
    def cylindrical(self) -> bool:
        """Whether a passive joint slides; in space that is a cylindrical joint."""
        return self.base_line or self.platform_line


PLANAR_CONSTRAINTS = (
    PlanarConstraint(
        "D1", "point", "point", "distance", "RPR", _point_point, _rpr, _apart,
        "the anchor points coincide",
    ),
    PlanarConstraint("D2", "point", "line", "distance", "RPP", _point_line, _rpp, _always, ""),
    PlanarConstraint("D3", "line", "point", "distance", "PPR", _line_point, _ppr, _always, ""),
    PlanarConstraint("A1", "line", "line", "angle", "PRP", _angle, _prp, _always, ""),
)  # fmt: skip

PLANAR_CONSTRAINT = MappingProxyType({c.name: c for c in PLANAR_CONSTRAINTS})
