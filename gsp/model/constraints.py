"""The constraints D1–D4 and A1: records of the formulas of their segments, values and rows.

Those of legs that are driven at the base are D1 constraints, whose value is that of the drive.
"""

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
from gsp.model.rods import crank, driven_row, joint_value, slider, slider_row


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
        The actuated quantity; a distance has the unit of the design, an angle is in radians. The
        travel of a slider counts as a distance.
    exchanged : str
        Name of the constraint that it becomes where base and platform are exchanged; "" where
        that is none of ours.
    segment : Placement -> Segment
        The segment between its feet.
    measure : Segment -> scalar
        Its value: a distance ≥ 0, or an angle in (0, π); of a drive of either sign.
    row : Segment, weight -> six scalars
        Gradient of that value with respect to the twist (v, ω), times the weight for an angle.
    undefined : str
        Why there is no row, where there is none.
    source : str
        Equations of value and row.
    driven : bool
        Whether it is the value of a drive at the base.
    singular : str
        Where the row is infinite, of a drive.
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
    driven: bool = False
    singular: str = ""

    @property
    def signed(self) -> bool:
        """Whether its value may be negative, as far as its bounds state it."""
        return self.driven or self.quantity == "angle"

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

# The values of drives at the base. A leg of fixed length is a D1 constraint whose base anchor the
# drive moves.
BY_SLIDER = Constraint(
    name="D1",
    base="line",
    platform="point",
    quantity="distance",
    exchanged="",
    segment=slider,
    measure=joint_value,
    row=slider_row,
    undefined="the rod does not reach from the rail to the platform anchor",
    source="docs/drives.md",
    driven=True,
    singular="the rod is perpendicular to the rail",
)
BY_CRANK = Constraint(
    name="D1",
    base="line",
    platform="point",
    quantity="angle",
    exchanged="",
    segment=crank,
    measure=joint_value,
    row=driven_row,
    undefined="crank and rod do not reach the platform anchor, or it is on the axis",
    source="docs/drives.md",
    driven=True,
    singular="the rod is in the plane of the axis and the crank",
)
