"""The design of a linkage."""

from __future__ import annotations

import numpy as np

from gsp.bridges.reading.chains import find_platform, paths
from gsp.bridges.reading.driven import in_axes
from gsp.bridges.reading.ends import FoundLeg, anchors_on_platform
from gsp.bridges.reading.legs import leg_of
from gsp.bridges.reading.linkages import Linkage
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import norm
from gsp.model.design import Design

FREEDOMS = 6


def design_of(linkage: Linkage, name: str | None = None) -> Design:
    """Return the design of a linkage, in metres, with the pose of the file as its home pose.

    Parameters
    ----------
    linkage : Linkage
    name : str or None
        Of the design; default that of the model.

    Returns
    -------
    Design

    Raises
    ------
    InvalidInput, UnknownName
        If there is no platform, or a chain is not a leg of the catalogue.
    """
    platform = find_platform(linkage)
    chains = paths(linkage, platform)
    base, place = linkage.places[linkage.base], linkage.places[platform]
    points = np.array([x.point for chain in chains for x in chain.freedoms])
    size = float(norm(points - points.mean(axis=0)).max())
    legs = [leg_of(chain, i + 1, size) for i, chain in enumerate(chains)]
    count = sum(len(leg.constraints.split()) for leg in legs)
    if count < FREEDOMS:
        wanted = f"legs with at least {FREEDOMS} constraints between base and {brief(platform)}"
        raise InvalidInput(expected("model", wanted, f"{len(legs)} legs with {count}"))
    heads = [
        anchors_on_platform(leg.platform, chain.shift, place)
        for leg, chain in zip(legs, chains, strict=True)
    ]
    feet = [anchors_on_platform(leg.base, Pose(np.zeros(3)), base) for leg in legs]
    return Design(
        [in_axes(leg.drive, base.rotation) if leg.drive else leg.constraints for leg in legs],
        np.array([x.point for x in feet]),
        np.array([x.point for x in heads]),
        base_directions=np.array([x.line for x in feet]),
        platform_directions=np.array([x.line for x in heads]),
        strokes=_strokes(legs),
        home=base.inverse().compose(place),
        unit="m",
        name=linkage.name if name is None else name,
    )


def _strokes(legs: list[FoundLeg]) -> list[tuple[float, float]] | None:
    strokes = [pair for leg in legs for pair in leg.strokes]
    return None if np.isnan(strokes).all() else strokes
