"""The row vectors (12)–(16) of `TozKucuk2016` as printed, against derivatives of (2)–(6).

The derivatives are taken by a complex step in the printed equations (2)–(6), which is exact to
rounding and uses no row.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, skew
from gsp.model.design import Design

Vector = NDArray[Any]
COMPLEX_STEP = 1e-30


@dataclass(frozen=True, eq=False)
class Leg:
    """A leg at a pose in the letters of the paper; complex numbers are allowed."""

    d: Vector
    Rb: Vector
    s: Vector
    Rt: Vector

    @property
    def n(self) -> Vector:
        """Rt × s, along the common normal."""
        return cross(self.Rt, self.s)


def leg_at(design: Design, number: int, pose: Pose, twist: Vector) -> Leg:
    """Leg (from 1) after a displacement by an infinitesimal (or complex) twist (v, ω)."""
    if not 1 <= number <= design.n_legs:
        raise InvalidInput(expected("leg", f"1 to {design.n_legs}", number))
    i = number - 1
    turned = (np.eye(3) + np.einsum("ijk,j->ik", _CROSS, twist[3:])) @ pose.rotation
    rb = turned @ design.platform_points[i]
    d = pose.position + twist[:3] + rb - design.base_points[i]
    return Leg(d, rb, design.base_directions[i], turned @ design.platform_directions[i])


_CROSS = np.stack([skew(axis) for axis in np.eye(3)], axis=1)

# Equations (2)–(6): the joint variable.
VALUES: Mapping[int, Callable[[Leg], Any]] = MappingProxyType(
    {
        12: lambda leg: np.sqrt(leg.d @ leg.d),
        13: lambda leg: np.sqrt(cross(leg.d, leg.Rt) @ cross(leg.d, leg.Rt)),
        14: lambda leg: np.sqrt(cross(leg.d, leg.s) @ cross(leg.d, leg.s)),
        15: lambda leg: np.sqrt((leg.d @ leg.n) ** 2 / (leg.n @ leg.n)),
        16: lambda leg: np.arccos(leg.Rt @ leg.s + 0j),
    }
)


def derivative(design: Design, number: int, pose: Pose, equation: int) -> Array:
    """Gradient of a joint variable with respect to the twist (v, ω), by complex steps: (6,)."""
    steps = 1j * COMPLEX_STEP * np.eye(6)
    with np.errstate(invalid="ignore", divide="ignore"):  # a leg without the line: undefined
        values = [VALUES[equation](leg_at(design, number, pose, step)) for step in steps]
    return np.asarray(np.imag(np.array(values)) / COMPLEX_STEP, dtype=np.float64)


def joint_value(design: Design, number: int, pose: Pose, equation: int) -> float:
    """Joint variable of a leg by one of the equations (2)–(6).

    Raises
    ------
    InvalidInput
        If there is no such equation.
    """
    if equation + 10 not in VALUES:
        raise InvalidInput(expected("equation", "2 to 6", equation))
    with np.errstate(invalid="ignore", divide="ignore"):
        return float(np.real(VALUES[equation + 10](leg_at(design, number, pose, np.zeros(6)))))


def _row(force: Vector, moment: Vector, divisor: Any) -> Vector:
    return np.asarray(np.concatenate((force, moment)) / divisor)


def _row_12(leg: Leg) -> Vector:
    return _row(leg.d, cross(leg.Rb, leg.d), VALUES[12](leg))


def _row_13(leg: Leg) -> Vector:
    force = cross(leg.Rt, cross(leg.d, leg.Rt))
    dxt = cross(leg.d, leg.Rt)
    moment = ((leg.d - leg.Rb) @ leg.Rt) * dxt + (dxt @ leg.Rb) * leg.Rt  # P − a = d − R b
    return _row(force, moment, VALUES[13](leg))


def _row_14(leg: Leg) -> Vector:
    dxs = cross(leg.d, leg.s)
    moment = cross(cross(dxs, leg.s), leg.Rb)
    return _row(cross(leg.s, dxs), moment, VALUES[14](leg))


def _row_14_unbalanced(leg: Leg) -> Vector:
    dxs = cross(leg.d, leg.s)
    return _row(cross(leg.s, dxs), cross(dxs, leg.Rb), VALUES[14](leg))


def _row_15(leg: Leg) -> Vector:
    d, rb, s, rt, n = leg.d, leg.Rb, leg.s, leg.Rt, leg.n
    value = VALUES[15](leg)
    moment = (d @ n) * ((rb @ s) * rt - (rb @ rt) * s)
    moment += (d @ n) * (-(s @ rt) * d)
    moment += (d @ n) * ((d @ rt) * s)
    moment -= value**2 * (-(s @ rt) * n + (n @ rt) * s)
    return _row((d @ n) * n, moment, value * (n @ n))


def _row_16(leg: Leg) -> Vector:
    return _row(np.zeros(3), leg.n, -np.sin(np.real(VALUES[16](leg))))


ROWS: Mapping[tuple[int, str], Callable[[Leg], Vector]] = MappingProxyType(
    {
        (12, "as printed"): _row_12,
        (13, "as printed"): _row_13,
        (14, "without the bracket"): _row_14_unbalanced,
        (14, "((d × s) × s) × R b"): _row_14,
        (15, "as printed"): _row_15,
        (16, "as printed"): _row_16,
    }
)


def row_error(
    design: Design, leg: int, pose: Pose, equation: int, reading: str, length: float
) -> float:
    """Largest difference between a printed row vector and the derivative, both homogenised.

    Raises
    ------
    InvalidInput
        If there is no such equation or reading.
    """
    if (equation, reading) not in ROWS:
        known = ", ".join(f"{e} {r!r}" for e, r in ROWS)
        raise InvalidInput(expected("equation and reading", known, f"{equation} {reading!r}"))
    with np.errstate(invalid="ignore", divide="ignore"):
        row = ROWS[equation, reading](leg_at(design, leg, pose, np.zeros(6)))
    scale = np.repeat([1.0, length if equation != 16 else 1.0], 3)
    return float(np.abs((row - derivative(design, leg, pose, equation)) / scale).max())
