"""Dimensions for a mechanism: its legs on the anchor lines of a template design."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gsp.checks import check_items, check_type, is_a, plain_text
from gsp.errors import InvalidDesign, brief, expected
from gsp.geometry.vectors import Array
from gsp.model.design import Design, check_undriven
from gsp.model.legs import LEG, LEGS, check_leg
from gsp.model.mechanism import Mechanism

# The published design on whose anchor lines commands and the app place mechanisms by default.
TEMPLATE = "toz-kucuk-2016-d3-6"
# A position without a leg in the name of a placement, and what is between positions.
NO_LEG, BETWEEN_LEGS = "0", "-"
# The name of a leg for each position of a template, "" for none.
Word = tuple[str, ...]
_BY_LETTERS = {leg.name.replace(" ", ""): leg.name for leg in LEGS}


def instantiate(mechanism: Mechanism, template: Design) -> Design:
    """Return a design of the mechanism on the anchor points and lines of a template.

    The legs take positions of the template (its legs, in their order) that are spread as evenly
    as the positions allow, and legs of one kind are spread as evenly among them as the other kinds
    allow; `placements` has all other ways. Where a leg needs a line and the template has none at
    that position, the line runs from the anchor point to the origin of its platform, as all the
    lines of `TozKucuk2016` do.

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
    return on_template(spread(mechanism, template), template, mechanism.name)


def place(legs: str | Sequence[str], template: Design) -> Design:
    """Return the design that has given legs on the positions of a template.

    Parameters
    ----------
    legs : str or sequence of str
        One entry per leg of the template, in their order: the name of a leg, or "0" (in a sequence
        also "") for a position without one; in a text joined by hyphens, as "D1-D2-0-D4A1-D1-D2".
    template : Design
        Lines that it does not have are as for `instantiate`.

    Returns
    -------
    Design
        Its name is this text, by which it is the same as that of `placements`.

    Raises
    ------
    InvalidInput
        If an argument is not of its type.
    InvalidDesign
        If there is not one leg or "0" for each position, there are fewer than six constraints, or
        an anchor point lies at the origin of its platform and has no line.

    Examples
    --------
    >>> from gsp.catalogue import design
    >>> place("D1-D1-D1-D2-D2-D2", design("toz-kucuk-2016-d3-6")).mechanism.name
    'D1^3 D2^3'
    """
    check_type("template", template, Design, "a gsp.Design (see catalogue.design)")
    check_undriven("template", template)
    word = read_word(legs)
    if len(word) != template.n_legs:
        wanted = f"{template.n_legs} legs, one per position of the template, {NO_LEG} for none"
        raise InvalidDesign(expected("legs", wanted, f"{len(word)}: {brief(legs)}"))
    return on_template(word, template, name_of(word))


def read_word(legs: str | Sequence[str]) -> Word:
    """Return the legs of positions that are named one by one; see `place`.

    Raises
    ------
    InvalidInput, InvalidDesign
    """
    wanted = 'legs such as "D1-D2-0-D4A1-D1-D2", or a sequence of them'
    legs = plain_text(legs)
    given = legs.split(BETWEEN_LEGS) if is_a(legs, str) else legs
    texts = check_items("legs", given, wanted)
    return tuple(_read_leg(text, f"legs[{i}]") for i, text in enumerate(texts))


def _read_leg(text: str, where: str) -> str:
    if is_a(text, str) and text.strip() in ("", NO_LEG):
        return ""
    letters = text.replace(" ", "").upper() if is_a(text, str) else ""
    return _BY_LETTERS.get(letters) or check_leg(text, where).name


def name_of(word: Word) -> str:
    """Return the name of a placement: the legs of its positions, joined by hyphens."""
    return BETWEEN_LEGS.join(name.replace(" ", "") or NO_LEG for name in word)


def on_template(word: Word, template: Design, name: str) -> Design:
    """Return the design of legs on the positions of a template; the arguments are checked."""
    places = [i for i, name in enumerate(word) if name]
    legs = [LEG[name] for name in word if name]
    base, platform = lines_of(template)
    for side, lines, needed in (
        ("base", base, [leg.base_line for leg in legs]),
        ("platform", platform, [leg.platform_line for leg in legs]),
    ):
        for place, leg, need in zip(places, legs, needed, strict=True):
            if need and not lines[place].any():
                what = f"template, {side} line of leg {place + 1} ({leg.name})"
                got = "none, and its point is the origin"
                raise InvalidDesign(expected(what, "a direction", got))
    return Design(
        legs=legs,
        base_points=template.base_points[places],
        platform_points=template.platform_points[places],
        base_directions=base[places],
        platform_directions=platform[places],
        unit=template.unit,
        name=name,
        source=f"on the anchor lines of {template.name or 'a template'}",
        characteristic_length=template.characteristic_length,
        ellipsoid=template.ellipsoid,
        home=template.home,
    )


def spread(mechanism: Mechanism, template: Design) -> Word:
    """Return the legs of a mechanism on the positions of a template, spread as `instantiate` does.

    Legs of one kind are far apart: the j-th of c is placed at (j + ½)/c.

    Raises
    ------
    InvalidInput
        If an argument is not of its type.
    InvalidDesign
        If the template has too few legs.
    """
    check_type("mechanism", mechanism, Mechanism, "a gsp.Mechanism (see catalogue.mechanism)")
    check_type("template", template, Design, "a gsp.Design (see catalogue.design)")
    check_undriven("template", template)
    legs, n = mechanism.legs, template.n_legs
    if n < len(legs):
        raise InvalidDesign(expected("template", f"at least {len(legs)} legs for {mechanism}", n))
    kinds = list(dict.fromkeys(legs))
    wishes = [
        ((j + 0.5) / legs.count(kind), kinds.index(kind))
        for kind in kinds
        for j in range(legs.count(kind))
    ]
    word = [""] * n
    for i, (_, k) in enumerate(sorted(wishes)):
        word[(i * n) // len(legs)] = kinds[k].name
    return tuple(word)


def lines_of(template: Design) -> tuple[Array, Array]:
    """Return directions at all anchors of base and platform, (n, 3) each, of any length.

    Where the template has none, towards the origin of its body; 0 at the origin.
    """
    base, platform = (
        np.where(np.isfinite(directions).all(axis=1, keepdims=True), directions, -points)
        for points, directions in (
            (template.base_points, template.base_directions),
            (template.platform_points, template.platform_directions),
        )
    )
    return base, platform
