"""Dimensions for a mechanism: its legs on the anchor lines of a template design."""

from __future__ import annotations

import numpy as np

from gsp.checks import check_type
from gsp.errors import InvalidDesign, expected
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.model.legs import Leg
from gsp.model.mechanism import Mechanism

# The published design on whose anchor lines commands and the app place mechanisms by default.
TEMPLATE = "toz-kucuk-2016-d3-6"


def instantiate(mechanism: Mechanism, template: Design) -> Design:
    """Return a design of the mechanism on the anchor points and lines of a template.

    The legs take positions of the template (its legs, in their order) that are spread as evenly
    as the positions allow, and legs of one kind are spread as evenly among them as the other kinds
    allow. Where a leg needs a line and the template has none at that position, the line runs from
    the anchor point to the origin of its platform, as all the lines of `TozKucuk2016` do.

    Parameters
    ----------
    mechanism : Mechanism
    template : Design
        With at least as many legs as the mechanism.

    Raises
    ------
    InvalidInput
        If an argument is not of its type, such as a name.
    InvalidDesign
        If the template has too few legs, or an anchor point lies at the origin of its platform and
        has no line.

    Examples
    --------
    >>> from gsp.catalogue import design, mechanism
    >>> hexapod = instantiate(mechanism("D1^3 D2^3"), design("toz-kucuk-2016-d3-6"))
    >>> [leg.name for leg in hexapod.legs]
    ['D1', 'D2', 'D1', 'D2', 'D1', 'D2']
    """
    check_type("mechanism", mechanism, Mechanism, "a gsp.Mechanism (see catalogue.mechanism)")
    check_type("template", template, Design, "a gsp.Design (see catalogue.design)")
    legs = _spread(mechanism.legs)
    n = template.n_legs
    if n < len(legs):
        raise InvalidDesign(expected("template", f"at least {len(legs)} legs for {mechanism}", n))
    places = [(i * n) // len(legs) for i in range(len(legs))]
    base, platform = template.base_points[places], template.platform_points[places]
    s, t = template.base_directions[places], template.platform_directions[places]
    return Design(
        legs=legs,
        base_points=base,
        platform_points=platform,
        base_directions=_lines("base", legs, [leg.base_line for leg in legs], s, base),
        platform_directions=_lines(
            "platform", legs, [leg.platform_line for leg in legs], t, platform
        ),
        unit=template.unit,
        name=mechanism.name,
        source=f"on the anchor lines of {template.name or 'a template'}",
        characteristic_length=template.characteristic_length,
        ellipsoid=template.ellipsoid,
        home=template.home,
    )


def _spread(legs: tuple[Leg, ...]) -> tuple[Leg, ...]:
    """Order legs so that those of one kind are far apart: the j-th of c is placed at (j + ½)/c."""
    kinds = list(dict.fromkeys(legs))
    wishes = [
        ((j + 0.5) / legs.count(kind), kinds.index(kind))
        for kind in kinds
        for j in range(legs.count(kind))
    ]
    return tuple(kinds[k] for _, k in sorted(wishes))


def _lines(
    side: str, legs: tuple[Leg, ...], needed: list[bool], directions: Array, points: Array
) -> Array:
    given = np.asarray(np.isfinite(directions).all(axis=1))
    radial = np.where(given[:, None], directions, -points)
    for i, need in enumerate(needed):
        if need and norm(radial[i]) == 0.0:
            what = f"template, {side} line of leg {i + 1} ({legs[i].name})"
            raise InvalidDesign(expected(what, "a direction", "none, and its point is the origin"))
    return radial
