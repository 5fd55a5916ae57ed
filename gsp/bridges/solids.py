"""Simple bodies for the links: capsules along them, with their masses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from gsp.bridges.linkage import X, Chain
from gsp.design import Design
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.pose import Pose
from gsp.vectors import Array, check_positive, cross, norm, unit

METRES = MappingProxyType(
    {"": 1.0, "m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
)
OVERLAP = 0.6  # of the length of a leg, taken by each of its two links


@dataclass(frozen=True)
class Solids:
    """What the links are made of.

    Parameters
    ----------
    radius : float or None [unit of the design]
        Of the links of a leg; default 2 % of `design.size`.
    density : float [kg/m³]
        Where no mass is given; default that of aluminium.
    link_mass : float or None [kg]
        Of each of the two links of a leg.
    platform_mass : float or None [kg]
        Of the platform.
    metres : float or None [m]
        Length of the design's unit; default by its name ("mm", "m" …; none counts as metres).

    Raises
    ------
    InvalidInput
        If one of them is not positive.
    """

    radius: float | None = None
    density: float = 2700.0
    link_mass: float | None = None
    platform_mass: float | None = None
    metres: float | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None:
                check_positive(f"solids.{name}", value)

    def unit(self, design: Design) -> float:
        """Return the length of the design's unit [m].

        Raises
        ------
        MissingParameter
            If the unit is not one of those known by name, and `metres` was not given.
        """
        if self.metres is not None:
            return self.metres
        if design.unit not in METRES:
            known = ", ".join(repr(name) for name in METRES)
            raise MissingParameter(
                expected("solids.metres", f"a length, or a design.unit of {known}", design.unit)
            )
        return METRES[design.unit]


@dataclass(frozen=True, eq=False)
class Capsule:
    """A rod with round ends, in the frame of its link [unit of the design, kg]."""

    start: Array
    end: Array
    radius: float
    mass: float

    @property
    def length(self) -> float:
        """Distance of the centres of its round ends."""
        return float(norm(self.end - self.start))

    @property
    def frame(self) -> Pose:
        """Frame in its middle, with z along it."""
        z = unit(self.end - self.start) if self.length else np.array([0.0, 0.0, 1.0])
        x = unit(cross(np.eye(3)[np.argmin(np.abs(z))], z))
        return Pose((self.start + self.end) / 2.0, np.stack((x, cross(z, x), z), axis=-1))


def capsules(
    design: Design, chains: Sequence[Chain], solids: Solids | None = None
) -> Mapping[str, tuple[Capsule, ...]]:
    """Return the capsules of "base", "platform" and of "leg1_lower", "leg1_upper", "leg1_rail" ….

    The two links of a leg overlap like a cylinder and its rod; a cylindrical joint gets a rail
    along its line: the base's is part of the base, the platform's is a link of its own.

    Raises
    ------
    InvalidInput
        If `solids` is not a Solids.
    """
    stuff = Solids() if solids is None else solids
    if not isinstance(stuff, Solids):
        raise InvalidInput(expected("solids", "a Solids or None", type(stuff).__name__))
    size = design.size or max(chain.length for chain in chains) or 1.0
    radius, weight = stuff.radius or 0.02 * size, stuff.density * stuff.unit(design) ** 3

    def rod(start: Array, end: Array, r: float, mass: float | None = None) -> Capsule:
        volume = np.pi * r**2 * (float(norm(end - start)) + 4.0 / 3.0 * r)
        return Capsule(start, end, r, float(weight * volume) if mass is None else mass)

    bodies: dict[str, tuple[Capsule, ...]] = {}
    base_rails = []
    for chain in chains:
        along = chain.middle[0].axis * max(OVERLAP * chain.length, 2.0 * radius)
        mass = stuff.link_mass
        bodies[f"{chain.name}_lower"] = (rod(np.zeros(3), along, radius, mass),)
        bodies[f"{chain.name}_upper"] = (rod(-along, np.zeros(3), 0.6 * radius, mass),)
        if chain.leg.platform_line:
            ends = _rail(float(chain.platform[0].value), size)
            bodies[f"{chain.name}_rail"] = (rod(*ends, 0.5 * radius),)
        if chain.leg.base_line:
            ends = _rail(float(chain.base[0].value), size)
            base_rails.append(rod(*(chain.foot.rotation @ e + chain.foot.position for e in ends),
                                  0.5 * radius))  # fmt: skip
    bodies["base"] = (*(rod(*e, radius) for e in _plate(design.base_points)), *base_rails)
    plate = [rod(*ends, radius) for ends in _plate(design.platform_points)]
    share = None if stuff.platform_mass is None else stuff.platform_mass / len(plate)
    bodies["platform"] = tuple(
        Capsule(c.start, c.end, c.radius, c.mass if share is None else share) for c in plate
    )
    return MappingProxyType(bodies)


def _rail(value: float, size: float) -> tuple[Array, Array]:
    """Ends of a rail that holds the anchor and the foot, with room to slide."""
    return X * (min(0.0, value) - 0.3 * size), X * (max(0.0, value) + 0.3 * size)


def _plate(points: Array) -> list[tuple[Array, Array]]:
    """Ends of the rods from the middle of some points to each, and around."""
    middle = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - middle)
    flat = (points - middle) @ axes[:2].T
    around = points[np.argsort(np.arctan2(flat[:, 1], flat[:, 0]), kind="stable")]
    pairs = [(middle, p) for p in points]
    pairs += list(zip(around, np.roll(around, -1, axis=0), strict=True))
    return [(a, b) for a, b in pairs if norm(a - b) > 0.0] or [(middle, middle)]
