"""The quantities that limits may bound: the name and the kind of each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

from gsp.limits.legs import leg_pairs
from gsp.model.design import AnchoredDesign, Design

Kind = Literal["joint", "position", "cone", "clearance", "index"]


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """One quantity that limits may bound.

    The functions of this module make all of them, so that no name is read to find what it means.

    Attributes
    ----------
    name : str
        "d1", "theta4"; "x"; "base cone 2"; "clearance 1-3"; or the name of an index. Legs are
        counted from 1.
    kind : "joint", "position", "cone", "clearance" or "index"
    angular : bool
        Whether its values are angles.
    """

    name: str
    kind: Kind
    angular: bool = False


def joint_quantities(design: AnchoredDesign[Any]) -> tuple[Quantity, ...]:
    """Return the actuated joints of a design in space or in the plane, in their order."""
    return tuple(
        Quantity(name=name, kind="joint", angular=bool(angular))
        for name, angular in zip(design.joint_names, design.angular, strict=True)
    )


def position_quantities() -> tuple[Quantity, ...]:
    """Return the coordinates of the platform origin."""
    return tuple(Quantity(name=axis, kind="position") for axis in "xyz")


def cone_quantities(design: Design, side: str) -> tuple[Quantity, ...]:
    """Return the angles between the legs and the axes of their cones on "base" or "platform"."""
    return tuple(
        Quantity(name=f"{side} cone {i + 1}", kind="cone", angular=True)
        for i in range(design.n_legs)
    )


def clearance_quantities(design: Design) -> tuple[Quantity, ...]:
    """Return the distances of legs without a common anchor, in the order of `leg_pairs`."""
    return tuple(
        Quantity(name=f"clearance {i + 1}-{j + 1}", kind="clearance") for i, j in leg_pairs(design)
    )


def index_quantities(names: Iterable[str]) -> tuple[Quantity, ...]:
    """Return the indices of some names."""
    return tuple(Quantity(name=name, kind="index") for name in names)
