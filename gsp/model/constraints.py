"""The constraints D1–D4 and A1: records of the formulas of their segments, values and rows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from gsp.geometry.scalars import Scalar, Vector
from gsp.model.formulas import (
    Placement,
    Segment,
    angle,
    angle_row,
    distance,
    distance_row,
    line_line,
    line_point,
    point_line,
    point_point,
)


@dataclass(frozen=True, kw_only=True)
class Constraint:
    """One kind of constraint between base and platform.

    Attributes
    ----------
    name : str
        "D1" … "D4", "A1".
    base, platform : "point" or "line"
        The primitives that it relates.
    quantity : "distance" or "angle"
        The actuated quantity; a distance has the unit of the design, an angle is in radians.
    exchanged : str
        Name of the constraint that it becomes where base and platform are exchanged.
    segment : Placement -> Segment
        The segment between its feet.
    measure : Segment -> scalar
        Its value: a distance ≥ 0, or an angle in (0, π).
    row : Segment, weight -> six scalars
        Gradient of that value with respect to the twist (v, ω), times the weight for an angle.
    undefined : str
        Why there is no row, where there is none.
    source : str
        Equations of value and row.
    """

    name: str
    base: Literal["point", "line"]
    platform: Literal["point", "line"]
    quantity: Literal["distance", "angle"]
    exchanged: str
    segment: Callable[[Placement], Segment]
    measure: Callable[[Segment], Scalar]
    row: Callable[[Segment, Scalar], Vector]
    undefined: str
    source: str

    @property
    def symbol(self) -> str:
        """Letter of the joint variable: d for a distance, theta for an angle."""
        return "d" if self.quantity == "distance" else "theta"

    @property
    def two_lines(self) -> bool:
        """Whether it relates two lines: undefined where they are parallel, not where they meet."""
        return self.base == self.platform == "line"


# ERRATUM: in eq. (14) one bracket is unbalanced; the moment part is ((d × s) × s) × R b up to sign.
CONSTRAINTS = (
    Constraint(
        name="D1",
        base="point",
        platform="point",
        quantity="distance",
        exchanged="D1",
        segment=point_point,
        measure=distance,
        row=distance_row,
        undefined="the anchor points coincide",
        source="TozKucuk2016, eqs. (2), (12)",
    ),
    Constraint(
        name="D2",
        base="point",
        platform="line",
        quantity="distance",
        exchanged="D3",
        segment=point_line,
        measure=distance,
        row=distance_row,
        undefined="the base point lies on the platform line",
        source="TozKucuk2016, eqs. (3), (13)",
    ),
    Constraint(
        name="D3",
        base="line",
        platform="point",
        quantity="distance",
        exchanged="D2",
        segment=line_point,
        measure=distance,
        row=distance_row,
        undefined="the platform point lies on the base line",
        source="TozKucuk2016, eqs. (4), (14)",
    ),
    Constraint(
        name="D4",
        base="line",
        platform="line",
        quantity="distance",
        exchanged="D4",
        segment=line_line,
        measure=distance,
        row=distance_row,
        undefined="the base line and the platform line are parallel",
        source="TozKucuk2016, eqs. (5), (15)",
    ),
    Constraint(
        name="A1",
        base="line",
        platform="line",
        quantity="angle",
        exchanged="A1",
        segment=line_line,
        measure=angle,
        row=angle_row,
        undefined="the base line and the platform line are parallel",
        source="TozKucuk2016, eqs. (6), (16)",
    ),
)

CONSTRAINT = MappingProxyType({constraint.name: constraint for constraint in CONSTRAINTS})
