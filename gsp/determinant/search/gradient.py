"""log |det J| and its gradient: the rows of D1–D4 and A1 differentiated once more, by hand.

A row is the line of a segment, (u, q × u), with u = e/|e| and q the arm of its platform foot.
d log |det J| = Σ k_i · d(row_i), with k_i = (κ, χ) the columns of J⁻¹, and
k · d(row) = de · G + dq · c, where G = (g − u (u · g))/|e|, g = κ + χ × q and c = u × χ. Each kind
of constraint passes G and c on to the three things that move: d, the arm, and the platform line t.
Along a twist (v, ω) they move with v + ω × arm, ω × arm and ω × t.
"""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from gsp import arguments
from gsp.geometry.matrices import defined_matrices
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, dot, norm
from gsp.model.design import Design
from gsp.model.posture import Posture


class Pull(NamedTuple):
    """Derivatives of a value with respect to d, to the arm and to t: three (..., k, 3) arrays."""

    d: Array
    arm: Array
    t: Array


def _times(factor: Array, vector: Array) -> Array:
    return factor[..., None] * vector


class _Leg(NamedTuple):
    """Lines and segments of k rows: (..., k, 3) arrays, and `length` (..., k)."""

    d: Array
    arm: Array
    s: Array
    t: Array
    u: Array
    length: Array
    foot: Array


def _legs(posture: Posture, legs: list[int]) -> _Leg:
    lines, segments = posture.lines, posture.segments
    d, arm, t, u, foot = (
        array[..., legs, :]
        for array in (lines.d, lines.arm, lines.t, segments.direction, segments.arm)
    )
    s = np.broadcast_to(lines.s[legs], d.shape)
    return _Leg(d, arm, s, t, u, segments.length[..., legs], foot)


def _on_segment(leg: _Leg, length: Array, column: Array) -> tuple[Array, Array]:
    """Return G and c of a row (u, q × u)."""
    force, turn = column[..., :3], column[..., 3:]
    g = force + cross(turn, leg.foot)
    return _times(1.0 / length, g - _times(dot(leg.u, g), leg.u)), cross(leg.u, turn)


def _d1(leg: _Leg, column: Array) -> Pull:
    g, c = _on_segment(leg, leg.length, column)
    return Pull(g, c, np.zeros_like(g))


def _d2(leg: _Leg, column: Array) -> Pull:
    d, t = leg.d, leg.t
    g, c = _on_segment(leg, leg.length, column)
    both = g + c  # e and q both lose (d · t) t
    along = dot(t, both)
    return Pull(g - _times(along, t), c, -_times(along, d) - _times(dot(d, t), both))


def _d3(leg: _Leg, column: Array) -> Pull:
    g, c = _on_segment(leg, leg.length, column)
    return Pull(g - _times(dot(leg.s, g), leg.s), c, np.zeros_like(g))


def _d4(leg: _Leg, column: Array) -> Pull:
    d, s, t = leg.d, leg.s, leg.t
    m = cross(t, s)
    square = dot(m, m)
    g, c = _on_segment(leg, np.sqrt(square), column)
    side = np.where(dot(leg.u, m) < 0.0, -1.0, 1.0)
    slide = -dot(cross(d, s), m) / square
    share = dot(c, t) / square
    moved = _times(side, g) - _times(share, cross(d, s) + _times(2.0 * slide, m))
    return Pull(-_times(share, cross(s, m)), c, cross(s, moved) + _times(slide, c))


def _a1(leg: _Leg, column: Array) -> Pull:
    s, t, turn = leg.s, leg.t, column[..., 3:]
    m = cross(t, s)
    size = norm(m)
    u = _times(1.0 / size, m)
    none = np.zeros_like(t)
    return Pull(none, none, cross(s, _times(-1.0 / size, turn - _times(dot(u, turn), u))))


PULLS: MappingProxyType[str, Callable[[_Leg, Array], Pull]] = MappingProxyType(
    {"D1": _d1, "D2": _d2, "D3": _d3, "D4": _d4, "A1": _a1}
)


@arguments.validated(
    design=arguments.kind(Design, "a gsp.Design"), pose=arguments.kind(Pose, "a gsp.Pose")
)
def log_determinant(design: Design, pose: Pose) -> tuple[Array, Array]:
    """Return log |det J| and its gradient along the six unit twists at the platform origin.

    For redundant designs it is ½ log det JᵀJ, with J⁺ in the place of J⁻¹.

    Parameters
    ----------
    design : Design
    pose : Pose, batch shape (...)

    Returns
    -------
    value : (...) array
        −inf where J is singular or not defined.
    gradient : (..., 6) array [1/length, 1]
        Along v_x, v_y, v_z, ω_x, ω_y, ω_z; zero where the value is −inf.

    Examples
    --------
    >>> import gsp
    >>> octahedron = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    >>> value, gradient = log_determinant(octahedron, gsp.Pose([0.0, 0.0, 1.0]))
    >>> bool(np.abs(gradient).max() < 1e-12)
    True

    *Source: the rows of TozKucuk2016, eqs. (12)–(16); their derivatives are ours.*
    """
    posture = design.at(pose)
    value, inverse = _log_and_inverse(posture.jacobian)
    usable = np.isfinite(value)
    force, moment = np.zeros((*posture.shape, 3)), np.zeros((*posture.shape, 3))
    names = [row.constraint.name for row in design.rows]
    columns = np.swapaxes(inverse, -1, -2)
    with np.errstate(divide="ignore", invalid="ignore"):
        for name in dict.fromkeys(names):
            rows = [i for i, other in enumerate(names) if other == name]
            leg = _legs(posture, [design.rows[i].leg for i in rows])
            pull = PULLS[name](leg, columns[..., rows, :])
            force += pull.d.sum(axis=-2)
            moment += cross(leg.arm, pull.d + pull.arm).sum(axis=-2)
            if name in ("D2", "D4", "A1"):
                moment += cross(leg.t, pull.t).sum(axis=-2)
    gradient = np.concatenate((force, moment), axis=-1)
    usable &= np.isfinite(gradient).all(axis=-1)
    return np.where(usable, value, -np.inf), np.where(usable[..., None], gradient, 0.0)


def _log_and_inverse(rows: Array) -> tuple[Array, Array]:
    """Log |det| (½ log det MᵀM) and (pseudo-)inverse of a stack, −inf and 0 where there is none."""
    defined = defined_matrices(rows)
    safe = np.where(defined[..., None, None], rows, np.eye(rows.shape[-2], 6))
    if rows.shape[-2] == 6:
        left, square = None, safe
    else:
        left, square = np.linalg.qr(safe)
    sign, value = np.linalg.slogdet(square)
    usable = defined & (sign != 0.0) & np.isfinite(value)
    inverse = np.linalg.inv(np.where(usable[..., None, None], square, np.eye(6)))
    if left is not None:
        inverse = inverse @ np.swapaxes(left, -1, -2)
    return np.where(usable, value, -np.inf), np.asarray(inverse)
