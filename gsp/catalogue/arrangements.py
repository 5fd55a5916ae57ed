"""All distinct ways to put the legs of a mechanism on the positions of a template."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain

from gsp import arguments
from gsp.catalogue.placement import Word, name_of, on_template, spread
from gsp.catalogue.symmetry import TEMPLATE_TOLERANCE, symmetries
from gsp.model.design import Design
from gsp.model.design.symmetry import Symmetry
from gsp.model.legs import LEG
from gsp.model.mechanism import Mechanism


@arguments.validated(exchange=arguments.flag)
def placements(
    mechanism: Mechanism,
    template: Design,
    *,
    reflections: bool = True,
    exchange: bool = False,
    tolerance: float = TEMPLATE_TOLERANCE,
) -> tuple[Design, ...]:
    """Return all distinct ways to put the legs of a mechanism on the positions of a template.

    Two ways are the same if a symmetry of the template moves one onto the other; then all indices
    but the stiffness along axes of the base have the same values at corresponding poses (see
    `symmetries`). Where the template has more positions than the mechanism has legs, all choices of
    positions are among them.

    Parameters
    ----------
    mechanism : Mechanism
        Its D4 and A1 constraints are paired on legs as `Mechanism.legs` has them.
    template : Design
        With at most eight legs, and at least as many as the mechanism.
    reflections : bool
        Whether mirror images are the same.
    exchange : bool
        Whether ways are the same between which a symmetry exchanges base and platform. It has an
        effect on mechanisms that are their own exchange (as many D2 as D3).
    tolerance : float [1]
        See `symmetries`.

    Returns
    -------
    tuple of Design
        The first one has the legs where `instantiate` puts them; of the others that are the same,
        each is the first in the order of `LEGS`, with empty positions last. The name has the legs
        of all positions, such as "D1-D2-0-D4A1-D1-D2", and `place` makes the design from it.

    Raises
    ------
    InvalidInput
        On arguments of a wrong type or range, or a tolerance at which there is no group.
    InvalidDesign
        If the template has too few or more than eight legs, or an anchor point lies at the origin
        of its platform and has no line.

    *Source: ours; docs/exploration.md*

    Examples
    --------
    >>> from gsp.catalogue import design, mechanism
    >>> template = design("toz-kucuk-2016-d3-6")
    >>> [d.name for d in placements(mechanism("D1^5 D2"), template)]
    ['D1-D1-D1-D2-D1-D1']
    >>> len(placements(mechanism("D1^3 D2^3"), template))
    4
    """
    first = spread(mechanism, template)
    group = symmetries(template, reflections=reflections, exchange=exchange, tolerance=tolerance)
    words = distinct(first, group, exchange=mechanism.exchanged() == mechanism)
    return tuple(on_template(word, template, name_of(word)) for word in words)


def distinct(first: Word, group: Sequence[Symmetry], *, exchange: bool) -> Iterator[Word]:
    """Yield one order of legs for all that the symmetries of a group make of it.

    Parameters
    ----------
    first : Word
        The first order, which has the legs.
    group : sequence of Symmetry
    exchange : bool
        Whether the symmetries that exchange base and platform count.
    """
    used = [s for s in group if exchange or not s.exchanged]
    seen: set[Word] = set()
    for word in chain((first,), _words(first)):
        if word not in seen:
            seen.update(image(word, symmetry) for symmetry in used)
            yield word


def image(word: Word, symmetry: Symmetry) -> Word:
    """Return the legs that a symmetry moves to each position of a template."""
    moved = [""] * len(word)
    for name, place in zip(word, symmetry.legs, strict=True):
        moved[place] = LEG[name].exchanged if name and symmetry.exchanged else name
    return tuple(moved)


def _words(legs: Word) -> Iterator[Word]:
    """Yield all different orders of legs, in the order of LEGS, empty positions last."""
    kinds = [kind for kind in (*LEG, "") if kind in legs]

    def extended(word: Word, left: tuple[int, ...]) -> Iterator[Word]:
        if not any(left):
            yield word
        for k, kind in enumerate(kinds):
            if left[k]:
                yield from extended((*word, kind), (*left[:k], left[k] - 1, *left[k + 1 :]))

    yield from extended((), tuple(legs.count(kind) for kind in kinds))
