"""The planar constraints D1, D2, D3 and A1: records of their formulas, and of their legs.

They are the spatial constraints of the same names with all points, lines and motions in one
plane.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from gsp.geometry.scalars import Scalar, Vector
from gsp.model.formulas import PassiveRate, Placement
from gsp.planar.formulas import (
    PlanarSegment,
    angle,
    angle_row,
    distance,
    distance_row,
    line_line,
    line_point,
    point_line,
    point_point,
    ppr,
    prp,
    rpp,
    rpr,
)


@dataclass(frozen=True, kw_only=True)
class PlanarConstraint:
    """One kind of constraint between base and platform in the plane, and its leg.

    Attributes
    ----------
    name : str
        "D1", "D2", "D3" or "A1", as in space.
    base, platform : "point" or "line"
    quantity : "distance" or "angle"
    exchanged : str
        Name of the constraint that it becomes where base and platform are exchanged.
    chain : str
        Joints of the leg from base to platform, R turning and P sliding; the second is actuated.
    segment : Placement -> PlanarSegment
        Where it acts.
    measure : PlanarSegment -> scalar
        Its value: a distance ≥ 0 or an oriented angle in (−π, π].
    row : PlanarSegment, weight -> three scalars
        Gradient of that value for the twist (v, ω), times the weight for an angle.
    passive : PlanarSegment, characteristic length -> list of PassiveRate
        Rows that give the rates of the passive joints, up to sign.
    undefined : str
        Why there is no row, where there is none.
    """

    name: str
    base: Literal["point", "line"]
    platform: Literal["point", "line"]
    quantity: Literal["distance", "angle"]
    exchanged: str
    chain: str
    segment: Callable[[Placement], PlanarSegment]
    measure: Callable[[PlanarSegment], Scalar]
    row: Callable[[PlanarSegment, Scalar], Vector]
    passive: Callable[[PlanarSegment, Scalar], list[PassiveRate]]
    undefined: str = ""

    @property
    def symbol(self) -> str:
        """Letter of the joint variable: d for a distance, theta for an angle."""
        return "d" if self.quantity == "distance" else "theta"

    @property
    def signed(self) -> bool:
        """Whether its value may be negative: angles."""
        return self.quantity == "angle"

    @property
    def constraints(self) -> tuple[PlanarConstraint]:
        """The constraints of the leg: this one."""
        return (self,)

    @property
    def base_line(self) -> bool:
        """Whether the leg is attached to a line of the base."""
        return self.base == "line"

    @property
    def platform_line(self) -> bool:
        """Whether the leg is attached to a line of the platform."""
        return self.platform == "line"

    @property
    def one_line(self) -> bool:
        """Whether it relates a point and a line: its signed distance is linear in the position."""
        return self.base != self.platform

    @property
    def cylindrical(self) -> bool:
        """Whether a passive joint slides; in space that is a cylindrical joint."""
        return self.base_line or self.platform_line

    @property
    def turns(self) -> tuple[int, int]:
        """Numbers of passive turns seen from the base and from the platform."""
        return int(self.chain[0] == "R"), int(self.chain[2] == "R")

    @property
    def slides(self) -> int:
        """Number of passive slides."""
        return (self.chain[0] + self.chain[2]).count("P")


PLANAR_CONSTRAINTS = (
    PlanarConstraint(
        name="D1",
        base="point",
        platform="point",
        quantity="distance",
        exchanged="D1",
        chain="RPR",
        segment=point_point,
        measure=distance,
        row=distance_row,
        passive=rpr,
        undefined="the anchor points coincide",
    ),
    PlanarConstraint(
        name="D2",
        base="point",
        platform="line",
        quantity="distance",
        exchanged="D3",
        chain="RPP",
        segment=point_line,
        measure=distance,
        row=distance_row,
        passive=rpp,
    ),
    PlanarConstraint(
        name="D3",
        base="line",
        platform="point",
        quantity="distance",
        exchanged="D2",
        chain="PPR",
        segment=line_point,
        measure=distance,
        row=distance_row,
        passive=ppr,
    ),
    PlanarConstraint(
        name="A1",
        base="line",
        platform="line",
        quantity="angle",
        exchanged="A1",
        chain="PRP",
        segment=line_line,
        measure=angle,
        row=angle_row,
        passive=prp,
    ),
)

PLANAR_CONSTRAINT = MappingProxyType({c.name: c for c in PLANAR_CONSTRAINTS})
