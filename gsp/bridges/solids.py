"""Simple bodies for the links: capsules along them, with their masses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from gsp import arguments
from gsp.bridges.linkage import Chain, Span, X, linkage, spans
from gsp.bridges.shapes import Body, Capsule
from gsp.checks import check_positive, is_a
from gsp.errors import InvalidInput, MissingParameter, apart, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design, check_undriven
from gsp.model.units import METRES_PER_UNIT
from gsp.statics import Masses

# Sizes and densities up to it, and down to its inverse, give inertias that double precision holds.
LARGEST_SOLID = 1e20
OVERLAP_SHARE = 0.6  # of the length of a leg, taken by each of its two links
# Mass of the links between the turns and slides into which a joint is split where a format has no
# joint of several freedoms, as a share of a ball of the radius of the legs. Larger shares change
# the motion: the platform's acceleration by about 2e-6 of g for a share of 0.01.
SPLIT_SHARE = 0.001
# The reader of Gazebo leaves out links of 1e-6 kg and less of a URDF, with all that they carry. In
# small machines these links are heavier than that, up to a share of a ball.
LEAST_SPLIT = 1.2e-6  # kg
LARGEST_SPLIT_SHARE = 0.1


@dataclass(frozen=True)
class Solids:
    """Sizes and masses of the links.

    Parameters
    ----------
    radius : float or None [unit of the design]
        Of the links of a leg; default 2 % of `design.rms_radius`.
    density : float [kg/m³]
        Where no mass is given; default that of aluminium.
    link_mass : float or None [kg]
        Of each of the two links of a leg.
    platform_mass : float or None [kg]
        Of the platform, without the balls and rails of joints that are fixed to it.
    metres : float or None [m]
        Length of the design's unit; default by its name ("mm", "m" …; none counts as metres).

    Raises
    ------
    InvalidInput
        If one of them is not positive, or so large or small that inertias are not numbers.
    """

    radius: float | None = None
    density: float = 2700.0
    link_mass: float | None = None
    platform_mass: float | None = None
    metres: float | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None or name == "density":
                number = check_positive(f"solids.{name}", value)
                if not 1.0 / LARGEST_SOLID <= number <= LARGEST_SOLID:
                    got, low, high = apart(number, 1.0 / LARGEST_SOLID, LARGEST_SOLID)
                    wanted = f"a number from {low} to {high}"
                    raise InvalidInput(expected(f"solids.{name}", wanted, got))
                # A number of numpy would be written as "np.float64(1.0)".
                object.__setattr__(self, name, number)

    @arguments.validated(design=check_undriven)
    def unit(self, design: Design) -> float:
        """Return the length of the design's unit.

        Parameters
        ----------
        design : Design

        Returns
        -------
        float [m]

        Raises
        ------
        MissingParameter
            If the unit is not one of those known by name, and `metres` was not given.
        """
        if self.metres is not None:
            return self.metres
        if not design.unit:
            return 1.0
        if design.unit not in METRES_PER_UNIT:
            known = ", ".join(repr(name) for name in METRES_PER_UNIT)
            raise MissingParameter(
                expected("solids.metres", f"a length, or a design.unit of {known}", design.unit)
            )
        return METRES_PER_UNIT[design.unit]


def check_solids(solids: Solids | None) -> Solids:
    """Return the solids, those of thin aluminium for None, or raise InvalidInput."""
    if solids is None:
        return Solids()
    if not is_a(solids, Solids):
        raise InvalidInput(expected("solids", "a Solids or None", type(solids).__name__))
    return solids


def capsules(
    design: Design,
    chains: Sequence[Chain],
    solids: Solids | None = None,
    over: Sequence[Span] | None = None,
) -> Mapping[str, tuple[Capsule, ...]]:
    """Return the capsules of "base", "platform", "leg1_lower", "leg1_upper", "leg1_rail" ….

    The two links of a leg overlap like a cylinder and its rod. A cylindrical joint gets a rail
    along its line: the base's is part of the base, the platform's is a link of its own. A spherical
    joint at the platform gets a ball, "leg1_ball". Rails and balls are fixed to the platform, and
    `solids.platform_mass` does not include them. "split" is a link between parts of one joint.

    Parameters
    ----------
    design : Design
    chains : sequence of Chain
        Those of `linkage`.
    solids : Solids or None
        Sizes and masses; default thin aluminium.
    over : sequence of Span or None
        Those of `spans` over the poses of a film. Rails hold the feet at all of them, and the links
        of a leg have lengths that meet at all of them, but are never longer than the leg at the
        pose of `chains`. Default: that pose alone.

    Returns
    -------
    mapping from the name of a link to its Capsules, in the frame of the link

    Raises
    ------
    InvalidInput
        If `solids` is not a Solids, or the design is too large or too small for inertias.
    MissingParameter
        If a density is to be used, and the unit of the design is unknown.
    """
    stuff = check_solids(solids)
    size = design.rms_radius
    if not 1.0 / LARGEST_SOLID <= size * stuff.unit(design) <= LARGEST_SOLID:
        metres = size * stuff.unit(design)
        got, low, high = apart(metres, 1.0 / LARGEST_SOLID, LARGEST_SOLID)
        raise InvalidInput(expected("design", f"a size from {low} to {high} m", f"{got} m"))
    stock = _Stock(
        size, stuff.radius or 0.02 * size, stuff.density * stuff.unit(design) ** 3, stuff.link_mass
    )
    over = spans([chains]) if over is None else over
    legs = list(zip(chains, over, strict=True))
    base = [stock.rod(start, end) for start, end in _plate(design.base_points)]
    base += [stock.base_rail(chain, span) for chain, span in legs if chain.leg.base_line]
    plate = [stock.rod(start, end) for start, end in _plate(design.platform_points)]
    if stuff.platform_mass is not None:
        plate = [replace(rod, mass=stuff.platform_mass / len(plate)) for rod in plate]
    bodies = {"base": tuple(base), "platform": tuple(plate), "split": (stock.split(),)}
    for chain, span in legs:
        bodies |= stock.links(chain, span)
    return MappingProxyType(bodies)


@dataclass(frozen=True)
class _Stock:
    """Size of rods in the unit of the design, and their density in kg per unit cubed."""

    size: float
    radius: float
    weight: float
    link_mass: float | None

    def rod(
        self, start: Array, end: Array, share: float = 1.0, mass: float | None = None
    ) -> Capsule:
        """Make a rod of a share of the full radius, and of its natural mass if none is given."""
        r = self.radius * share
        volume = np.pi * r**2 * (float(norm(end - start)) + 4.0 / 3.0 * r)
        return Capsule(start, end, r, float(self.weight * volume) if mass is None else mass)

    def links(self, chain: Chain, span: Span) -> dict[str, tuple[Capsule, ...]]:
        """Make the two links of a leg, and its rail or ball on the platform."""
        length = min(OVERLAP_SHARE * span.longest, chain.length)
        reach = chain.middle[0].axis * max(length, 2.0 * self.radius)
        zero, mass = np.zeros(3), self.link_mass
        parts: dict[str, tuple[Capsule, ...]] = {
            f"{chain.name}_lower": (self.rod(zero, reach, mass=mass),),
            f"{chain.name}_upper": (self.rod(-reach, zero, 0.6, mass),),
        }
        if chain.leg.platform_line:
            start, end = _rail(span.platform, self.size)
            parts[f"{chain.name}_rail"] = (self.rod(start, end, 0.5),)
        else:
            parts[f"{chain.name}_ball"] = (self.ball(),)
        return parts

    def ball(self, share: float = 1.0) -> Capsule:
        """Make a ball of the radius of the legs, and of a share of its natural mass."""
        natural = self.rod(np.zeros(3), np.zeros(3))
        return replace(natural, mass=share * natural.mass)

    def split(self) -> Capsule:
        """Make a link between the turns and slides of one joint."""
        share = LEAST_SPLIT / self.ball().mass
        return self.ball(min(max(SPLIT_SHARE, share), LARGEST_SPLIT_SHARE))

    def base_rail(self, chain: Chain, span: Span) -> Capsule:
        """Make the rail of a leg on the base, in base axes."""
        start, end = _rail(span.base, self.size)
        turn, origin = chain.foot.rotation, chain.foot.position
        return self.rod(origin + turn @ start, origin + turn @ end, 0.5)


def _rail(feet: tuple[float, float], size: float) -> tuple[Array, Array]:
    """Return the ends of a rail that holds the anchor and the feet, and some length to slide."""
    return X * (min(0.0, feet[0]) - 0.3 * size), X * (max(0.0, feet[1]) + 0.3 * size)


def _plate(points: Array) -> list[tuple[Array, Array]]:
    """Return the ends of rods from the middle of some points to each, and around."""
    middle = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - middle)
    flat = (points - middle) @ axes[:2].T
    around = points[np.argsort(np.arctan2(flat[:, 1], flat[:, 0]), kind="stable")]
    pairs = [(middle, p) for p in points]
    pairs += list(zip(around, np.roll(around, -1, axis=0), strict=True))
    return [(a, b) for a, b in pairs if norm(a - b) > 0.0] or [(middle, middle)]


def fixed_to_platform(
    chains: Sequence[Chain], bodies: Mapping[str, tuple[Capsule, ...]]
) -> tuple[Capsule, ...]:
    """Return the platform with the rails and balls that are fixed to it, in platform axes.

    Parameters
    ----------
    chains : sequence of Chain
        Those of `linkage`.
    bodies : mapping
        That of `capsules`.
    """
    parts = list(bodies["platform"])
    for chain in chains:
        turn, origin = chain.head.rotation, chain.head.position
        for part in bodies[f"{chain.name}_{'rail' if chain.leg.platform_line else 'ball'}"]:
            start, end = origin + turn @ part.start, origin + turn @ part.end
            parts.append(replace(part, start=start, end=end))
    return tuple(parts)


def masses(design: Design, pose: Pose, solids: Solids | None = None) -> Masses:
    """Return the masses of exported models, as `gsp.statics.holding_forces` takes them.

    Parameters
    ----------
    design : Design
    pose : Pose
        The single pose of the export, from which the sizes of the links follow.
    solids : Solids or None
        Sizes and masses of the links; default thin aluminium.

    Returns
    -------
    gsp.statics.Masses

    Raises
    ------
    UndefinedPosture, MissingParameter, InvalidInput
        See `to_urdf`.

    Examples
    --------
    >>> import gsp
    >>> design = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> masses(design, design.home, Solids(link_mass=0.5)).lower.tolist()
    [0.5, 0.5, 0.5, 0.5, 0.5, 0.5]
    """
    chains = linkage(design, pose)
    bodies = capsules(design, chains, solids)
    links = {
        end: [Body.of(bodies[f"{chain.name}_{end}"]) for chain in chains]
        for end in ("lower", "upper")
    }
    platform = Body.of(fixed_to_platform(chains, bodies))
    distances = {end: [float(norm(body.centre)) for body in links[end]] for end in links}
    return Masses(
        platform=platform.mass,
        centre=platform.centre,
        lower=[body.mass for body in links["lower"]],
        lower_centre=distances["lower"],
        upper=[body.mass for body in links["upper"]],
        upper_centre=distances["upper"],
    )
