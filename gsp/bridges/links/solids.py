"""Simple bodies for the links: capsules along them, with their masses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from gsp import arguments
from gsp.bridges.links.linkage import linkage
from gsp.bridges.links.motions import Chain, Span, X, spans
from gsp.bridges.links.shapes import Body, Capsule
from gsp.bridges.links.stock import Stock, plate_ends
from gsp.checks import check_positive, is_a
from gsp.errors import InvalidInput, MissingParameter, apart, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import norm
from gsp.model.design import Design
from gsp.model.units import METRES_PER_UNIT
from gsp.statics import Masses

# Sizes and densities up to it, and down to its inverse, give inertias that double precision holds.
LARGEST_SOLID = 1e20


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
        Of each of the two links of a leg, a carriage or crank and its rod among them.
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

    @arguments.validated(design=arguments.kind(Design, "a gsp.Design"))
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

    The two links of a leg overlap like a cylinder and its rod. Those of a leg that is driven at the
    base are its carriage or crank and its rod. A cylindrical joint gets a rail along its line, and
    so does a drive: the base's is part of the base, the platform's is a link of its own. A
    spherical joint at the platform gets a ball, "leg1_ball". Rails and balls are fixed to the
    platform, and `solids.platform_mass` does not include them. "split" is a link between parts of
    one joint.

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
    stock = Stock(
        size, stuff.radius or 0.02 * size, stuff.density * stuff.unit(design) ** 3, stuff.link_mass
    )
    over = spans([chains]) if over is None else over
    legs = list(zip(chains, over, strict=True))
    base = [stock.rod(start, end) for start, end in plate_ends(design.base_points)]
    base += [stock.base_rail(chain, span) for chain, span in legs if chain.leg.base_line]
    plate = [stock.rod(start, end) for start, end in plate_ends(design.platform_points)]
    if stuff.platform_mass is not None:
        plate = [replace(rod, mass=stuff.platform_mass / len(plate)) for rod in plate]
    bodies = {"base": tuple(base), "platform": tuple(plate), "split": (stock.split(),)}
    for chain, span in legs:
        bodies |= stock.links(chain, span)
    return MappingProxyType(bodies)


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
    # From the base foot of a leg, or the axis of its crank, and from its platform foot.
    below = [float(norm(body.centre - (body.centre @ X) * X)) for body in links["lower"]]
    ends = [chain.platform[0].offset for chain in chains]
    above = [float(norm(body.centre - x)) for body, x in zip(links["upper"], ends, strict=True)]
    return Masses(
        platform=platform.mass,
        centre=platform.centre,
        lower=[body.mass for body in links["lower"]],
        lower_centre=below,
        upper=[body.mass for body in links["upper"]],
        upper_centre=above,
    )
