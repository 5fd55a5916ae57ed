"""log |det J| and its gradient, from the derivatives of the rows: the second order of D1–D4, A1.

A row is the line of a segment, (u, q × u) with u = e/|e| and q the arm of its platform foot. Along
a twist (v, ω) the anchors and lines of the platform move with ḋ = v + ω × r, ṙ = ω × r, ṫ = ω × t,
and each kind of constraint says how e and q follow.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from gsp.constraints import Lines
from gsp.design import Design
from gsp.kernels.reference import defined_matrices
from gsp.pose import Pose
from gsp.posture import Posture
from gsp.vectors import EPS, Array, cross, dot, norm

# A Jacobian whose condition is beyond this has a determinant of rounding: its log is −∞.
SINGULAR = 32 * EPS


@dataclass(frozen=True, eq=False)
class Rates:
    """How the lines of k legs move along the six unit twists: each (..., 6, k, 3)."""

    d: Array
    arm: Array
    t: Array


def rates(lines: Lines) -> Rates:
    """Return the rates of d, arm and t along the unit twists v_x, v_y, v_z, ω_x, ω_y, ω_z."""
    axes = np.eye(3)[:, None, :]
    arm = np.zeros((*lines.arm.shape[:-2], 6, *lines.arm.shape[-2:]))
    d, t = arm.copy(), arm.copy()
    arm[..., 3:, :, :] = cross(axes, lines.arm[..., None, :, :])
    t[..., 3:, :, :] = cross(axes, lines.t[..., None, :, :])
    d[..., :3, :, :] = axes
    d[..., 3:, :, :] = arm[..., 3:, :, :]
    return Rates(d, arm, t)


# e, ė, q, q̇ of a segment; e and q gain the axis of the twists, so all are (..., 6 or 1, k, 3).
Motion = tuple[Array, Array, Array, Array]


def _times(factor: Array, vector: Array) -> Array:
    return factor[..., None] * vector


def _spread(lines: Lines) -> tuple[Array, Array, Array, Array]:
    return lines.d[..., None, :, :], lines.arm[..., None, :, :], lines.s, lines.t[..., None, :, :]


def _point_point(lines: Lines, rate: Rates) -> Motion:
    d, arm, _, _ = _spread(lines)
    return d, rate.d, arm, rate.arm


def _point_line(lines: Lines, rate: Rates) -> Motion:
    d, arm, _, t = _spread(lines)
    along = _times(dot(d, t), t)
    moved = _times(dot(rate.d, t) + dot(d, rate.t), t) + _times(dot(d, t), rate.t)
    return d - along, rate.d - moved, arm - along, rate.arm - moved


def _line_point(lines: Lines, rate: Rates) -> Motion:
    d, arm, s, _ = _spread(lines)
    return d - _times(dot(d, s), s), rate.d - _times(dot(rate.d, s), s), arm, rate.arm


def _line_line(lines: Lines, rate: Rates) -> Motion:
    d, arm, s, t = _spread(lines)
    m, moved = cross(t, np.broadcast_to(s, t.shape)), cross(rate.t, s)
    square = dot(m, m)
    slide = -dot(cross(d, s), m) / square
    change = -(dot(cross(rate.d, s), m) + dot(cross(d, s), moved)) / square
    change = change - 2.0 * slide * dot(m, moved) / square
    sign = np.where(dot(d, m) < 0.0, -1.0, 1.0)[..., None]
    foot, follows = arm + _times(slide, t), rate.arm + _times(change, t) + _times(slide, rate.t)
    return sign * m, sign * moved, foot, follows


def _distance_rates(e: Array, ė: Array, q: Array, q̇: Array) -> Array:
    u, u̇ = _unit_rate(e, ė)
    return np.concatenate((u̇, cross(q̇, u) + cross(q, u̇)), axis=-1)


def _unit_rate(e: Array, ė: Array) -> tuple[Array, Array]:
    length = norm(e)[..., None]
    u = np.broadcast_to(e / length, ė.shape)
    return u, (ė - _times(dot(u, ė), u)) / length


def _angle_rates(lines: Lines, rate: Rates) -> Array:
    m = cross(lines.t, np.broadcast_to(lines.s, lines.t.shape))[..., None, :, :]
    _, u̇ = _unit_rate(m, cross(rate.t, lines.s))
    return np.concatenate((np.zeros_like(u̇), -u̇), axis=-1)


def _distance(motion: Callable[[Lines, Rates], Motion]) -> Callable[[Lines, Rates], Array]:
    return lambda lines, rate: _distance_rates(*motion(lines, rate))


ROW_RATES: MappingProxyType[str, Callable[[Lines, Rates], Array]] = MappingProxyType(
    {
        "D1": _distance(_point_point),
        "D2": _distance(_point_line),
        "D3": _distance(_line_point),
        "D4": _distance(_line_line),
        "A1": _angle_rates,
    }
)


def row_rates(posture: Posture) -> Array:
    """Return the rates of the rows of J along the six unit twists at the platform origin.

    Parameters
    ----------
    posture : Posture, batch shape (...)

    Returns
    -------
    (..., 6, n, 6) array
        First axis: the twist (v_x … ω_z); then rows and columns of J. NaN where J is NaN.

    *Source: the rows of TozKucuk2016, eqs. (12)–(16), differentiated by us.*
    """
    names = [c.name for leg in posture.design.legs for c in leg.constraints]
    legs = [i for i, leg in enumerate(posture.design.legs) for _ in leg.constraints]
    result = np.empty((*posture.shape, 6, len(names), 6))
    with np.errstate(divide="ignore", invalid="ignore"):
        for name, rule in ROW_RATES.items():
            rows = [i for i, other in enumerate(names) if other == name]
            if rows:
                lines = posture.lines[[legs[i] for i in rows]]
                result[..., rows, :] = rule(lines, rates(lines))
    return np.where(posture.defined[..., None, None, None], result, np.nan)


def log_determinant(design: Design, pose: Pose) -> tuple[Array, Array]:
    """Return log |det J| and its gradient along the six unit twists.

    For redundant designs it is ½ log det JᵀJ; either way the gradient is tr(J⁺ J̇).

    Parameters
    ----------
    pose : Pose, batch shape (...)

    Returns
    -------
    value : (...) array
        −inf where J is singular or not defined.
    gradient : (..., 6) array [1/length, 1]
        Zero where the value is −inf.

    Examples
    --------
    >>> import gsp
    >>> octahedron = gsp.families.lee.octahedral_3_3(a=1.0, b=2.0)
    >>> value, gradient = log_determinant(octahedron, gsp.Pose([0.0, 0.0, 1.0]))
    >>> bool(np.abs(gradient).max() < 1e-12)
    True
    """
    posture = design.at(pose)
    rows, length = posture.jacobian, design.size
    scale = np.repeat([1.0, 1.0 / length], 3)
    usable = defined_matrices(rows)
    left, values, right = np.linalg.svd(
        np.where(usable[..., None, None], rows * scale, 0.0), full_matrices=False
    )
    usable &= values[..., -1] > SINGULAR * values[..., 0]
    with np.errstate(divide="ignore"):
        value = np.log(values).sum(axis=-1) + 3.0 * np.log(length)
    values = np.where(usable[..., None], values, 1.0)
    inverse = scale * np.swapaxes((left / values[..., None, :]) @ right, -1, -2).swapaxes(-1, -2)
    gradient = np.einsum("...ij,...kij->...k", inverse, row_rates(posture))
    return np.where(usable, value, -np.inf), np.where(usable[..., None], gradient, 0.0)
