"""The design of a linkage."""

from __future__ import annotations

import numpy as np

from gsp.bridges.reading.mechanism.chains import Chains, Path, chains_of
from gsp.bridges.reading.mechanism.driven import in_axes
from gsp.bridges.reading.mechanism.ends import FoundLeg, anchors_on_platform
from gsp.bridges.reading.mechanism.legs import leg_of
from gsp.bridges.reading.mechanism.linkages import Linkage
from gsp.bridges.reading.mechanism.mobility import rank
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import norm
from gsp.model.design import Design
from gsp.model.posture import Posture

FREEDOMS = 6


def design_of(linkage: Linkage, name: str | None = None, *, chosen: bool = False) -> Design:
    """Return the design of a linkage, in metres, with the pose of the file as its home pose.

    Parameters
    ----------
    linkage : Linkage
    name : str or None
        Of the design; default that of the model.
    chosen : bool
        Whether the user has named base or platform: see `chains_of`.

    Returns
    -------
    Design

    Raises
    ------
    InvalidInput, UnknownName
        If there is no platform, a chain is not a leg of the catalogue, or something else holds
        the platform: joints with the base, or joints that are coupled.
    """
    found = chains_of(linkage, chosen=chosen)
    platform, chains = found.platform, found.legs
    if not chains:
        wanted = f"legs between base and {brief(platform)}"
        raise InvalidInput(expected("model", wanted, "none"))
    base, place = linkage.places[linkage.base], linkage.places[platform]
    sizes = [_size(chain) for chain in chains]
    _check_guides(found, max(sizes))
    _check_couplings(linkage, found)
    legs = [leg_of(chain, i + 1, sizes[i]) for i, chain in enumerate(chains)]
    count = sum(len(leg.constraints.split()) for leg in legs)
    if count < FREEDOMS:
        wanted = f"legs with at least {FREEDOMS} constraints between base and {brief(platform)}"
        raise InvalidInput(expected("model", wanted, f"{len(legs)} legs with {count}"))
    heads = [
        anchors_on_platform(leg.platform, chain.shift, place)
        for leg, chain in zip(legs, chains, strict=True)
    ]
    feet = [anchors_on_platform(leg.base, Pose(np.zeros(3)), base) for leg in legs]
    home = base.inverse().compose(place)
    design = Design(
        [in_axes(leg.drive, base.rotation) if leg.drive else leg.constraints for leg in legs],
        np.array([x.point for x in feet]),
        np.array([x.point for x in heads]),
        base_directions=np.array([x.line for x in feet]),
        platform_directions=np.array([x.line for x in heads]),
        strokes=_strokes(legs),
        home=home,
        unit="m",
        name=linkage.name if name is None else name,
    )
    _check_defined(design.at(home))
    return design


def _size(chain: Path) -> float:
    """Return the largest distance of a joint of a leg from the first one [m]."""
    points = np.array([x.point for x in chain.freedoms])
    return float(norm(points - points[0]).max())


def _check_defined(posture: Posture) -> None:
    """Refuse a posture with an undefined leg: what its slide counts is then not known."""
    if posture.undefined:
        got = f"{posture.undefined[0].joint}, where {posture.undefined[0].reason}"
        raise InvalidInput(expected("model", "a pose in which all legs are defined", got))


def _check_guides(chains: Chains, size: float) -> None:
    """Refuse joints between base and platform, but those that leave all motions free."""
    for link in chains.guides:
        driven = [x.name for x in link.freedoms if x.active]
        free = rank(link.freedoms, size)
        if free < FREEDOMS or driven:
            kinds = ", ".join(f"{x.kind} {brief(x.name)}" for x in link.freedoms)
            freedoms = "1 degree" if free == 1 else f"{free} degrees"
            got = f"a joint of {freedoms} of freedom ({kinds})"
            got += ", which is driven" if driven else ""
            wanted = f"nothing but the legs that holds the platform {brief(chains.platform)}"
            raise InvalidInput(expected(link.where or brief(link.name), wanted, got))


def _check_couplings(linkage: Linkage, chains: Chains) -> None:
    """Refuse what couples or holds joints of the mechanism."""
    moved = {x.name for leg in chains.legs for x in leg.freedoms}
    moved |= {x.name for link in chains.guides for x in link.freedoms}
    for coupling in linkage.couplings:
        if moved.intersection(coupling.joints):
            wanted = "joints of the legs that move each on its own"
            raise InvalidInput(expected(coupling.where, wanted, coupling.got))


def _strokes(legs: list[FoundLeg]) -> list[tuple[float, float]] | None:
    strokes = [pair for leg in legs for pair in leg.strokes]
    return None if np.isnan(strokes).all() else strokes
