"""Quantities that `TozKucuk2016` prints, beside joints and Jacobians."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import comb
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp import catalogue
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.published.quantities.toz_kucuk_2016 import rows


def _pose(position: Sequence[float], rpy_deg: Sequence[float]) -> Pose:
    return Pose.from_rpy(position, rpy_deg, degrees=True)


def row_error(
    equation: int,
    leg: int,
    design: str,
    position: Sequence[float],
    rpy_deg: Sequence[float],
    length: float,
    reading: str = "as printed",
) -> float:
    """Largest difference between a printed row vector and its derivative."""
    placed, pose = catalogue.design(design), _pose(position, rpy_deg)
    return rows.row_error(placed, leg, pose, equation, reading, length)


def angle_rate_error(design: str, position: Sequence[float], rpy_deg: Sequence[float]) -> float:
    """Largest change of a row (12)–(16) if ω stood for the rates of (α, β, γ), homogenised.

    With R = Rz Ry Rx the angular velocity is E (α̇, β̇, γ̇), so the rows for those rates are J_ω E.
    """
    placed = catalogue.design(design)
    _, beta, gamma = np.deg2rad(rpy_deg)
    turning = np.array(
        [
            [np.cos(gamma) * np.cos(beta), -np.sin(gamma), 0.0],
            [np.sin(gamma) * np.cos(beta), np.cos(gamma), 0.0],
            [-np.sin(beta), 0.0, 1.0],
        ]
    )
    rows = placed.at(_pose(position, rpy_deg)).homogeneous(placed.characteristic_length or 1.0)
    return float(np.abs(rows[:, 3:] @ (turning - np.eye(3))).max())


def value_error(
    equation: int,
    leg: int,
    joint: str,
    design: str,
    position: Sequence[float],
    rpy_deg: Sequence[float],
) -> float:
    """Difference of a joint variable by a printed equation from ours, relative to its value."""
    posture = catalogue.design(design).at(_pose(position, rpy_deg))
    if joint not in posture.joint_names:
        raise InvalidInput(expected("joint", "one of " + ", ".join(posture.joint_names), joint))
    ours = float(posture.joints[posture.joint_names.index(joint)])
    return rows.joint_value(posture.design, leg, posture.pose, equation) / ours - 1.0


def number_of_mechanisms(distances: int, angles: int) -> int:
    """Multisets of six constraints out of so many kinds, three angular ones at most."""
    return sum(comb(distances + 5 - k, 6 - k) * comb(angles + k - 1, k) for k in range(4))


def number_in_catalogue(symmetric: bool) -> int:
    """Count those of the 195 mechanisms of the catalogue that are symmetric, or are not."""
    return sum(m.symmetric is symmetric for m in catalogue.mechanisms())


def number_of_classes() -> int:
    """Count the classes of the catalogue."""
    return len({m.group for m in catalogue.mechanisms()})


def constraints(mechanism: str) -> list[int]:
    """Numbers of distance and of angular constraints of a mechanism."""
    angles = catalogue.mechanism(mechanism).n_angles
    return [6 - angles, angles]


def number_of_constraints(mechanism: str, constraint: str) -> int:
    """Count how often a constraint occurs in a mechanism."""
    return catalogue.mechanism(mechanism).constraints.count(constraint)


def number_of_legs(mechanism: str, chain: str = "") -> int:
    """Count the legs of a mechanism, or those of one chain."""
    legs = catalogue.mechanism(mechanism).legs
    return sum(chain in ("", leg.chain) for leg in legs)


def _jacobian(mechanism: str) -> tuple[tuple[str, ...], Array]:
    """Constraints of the rows, and J, of a mechanism on the anchor lines of the first example."""
    template = catalogue.design("toz-kucuk-2016-d3-6")
    placed = catalogue.instantiate(catalogue.mechanism(mechanism), template)
    names = tuple(row.constraint.name for row in placed.rows)
    return names, placed.at(Pose([10.0, -10.0, 138.0])).jacobian


def jacobian_rows(mechanism: str) -> list[int]:
    """Count the rows of D1, D2, D3, D4 and A1 of the inverse Jacobian, and its columns."""
    names, jacobian = _jacobian(mechanism)
    return [*(names.count(name) for name in ("D1", "D2", "D3", "D4", "A1")), jacobian.shape[1]]


def zeros_and_entries(mechanism: str, row: int) -> list[int]:
    """Count the leading zeros and all entries of a row of the inverse Jacobian, from 1."""
    _, jacobian = _jacobian(mechanism)
    if not 1 <= row <= len(jacobian):
        raise InvalidInput(expected("row", f"1 to {len(jacobian)}", row))
    values = jacobian[row - 1]
    return [int(np.argmax(values != 0.0)), values.size]


def unit_exponents(
    joint: str, design: str, position: Sequence[float], rpy_deg: Sequence[float]
) -> Array:
    """Exponents of the unit of length in the row of a joint, by a change of the unit.

    An entry that is zero in every unit has the exponent 0.
    """
    placed, pose, factor = catalogue.design(design), _pose(position, rpy_deg), 1000.0
    at = placed.joint_names.index(joint)
    row = placed.at(pose).jacobian[at]
    larger = placed.scaled(factor).at(Pose(pose.position * factor, pose.rotation)).jacobian[at]
    some = row != 0.0
    ratio = np.divide(larger, row, where=some, out=np.ones(6))
    return np.asarray(np.log(ratio) / np.log(factor))


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        "row_error": row_error,
        "angle_rate_error": angle_rate_error,
        "number_of_mechanisms": number_of_mechanisms,
        "number_in_catalogue": number_in_catalogue,
        "value_error": value_error,
        "number_of_classes": number_of_classes,
        "constraints": constraints,
        "number_of_constraints": number_of_constraints,
        "number_of_legs": number_of_legs,
        "jacobian_rows": jacobian_rows,
        "zeros_and_entries": zeros_and_entries,
        "unit_exponents": unit_exponents,
    }
)
