"""Designs to choose from: published, mechanisms of the catalogue, hexapods, Lee's dialog, files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from types import MappingProxyType

from gsp.catalogue import design as published
from gsp.catalogue import design_names, instantiate, mechanism, mechanisms
from gsp.catalogue.placement import TEMPLATE
from gsp.errors import InvalidDesign, InvalidInput, UnknownDesign, expected
from gsp.families.lee.platforms import KINDS
from gsp.families.texts import best_placed, best_placed_by_kinds, design_of_family, is_family
from gsp.model.design import Design, check_undriven
from gsp.model.design.designs import design_from_toml

# The design of figures 40 and 41 of the dissertation opens with these.
TOP_SIZE, BASE_SIZE = 15.0, 30.0
# Sizes of both, and what they are.
SIZE_RANGE = (1e-6, 1e6)
SIZES = (
    "The size of top and base is the side of its triangle, from 1e-6 to 1e6. The joints of a "
    "hexagon are separated at the vertices of that triangle."
)
TRIANGLE, HEXAGON = "triangle", "hexagon"
TYPES = (TRIANGLE, HEXAGON)
EDGES, CENTRE, SIDE = "along both edges", "toward the centre", "along one side"
SEPARATIONS = (EDGES, CENTRE, SIDE)
# Words of the families.
KIND_OF: Mapping[str, str] = MappingProxyType(dict(zip(SEPARATIONS, KINDS, strict=True)))
# Letters of an uploaded design file; redundant designs of a thousand legs have fewer.
LARGEST_FILE = 200_000
# Legs of an uploaded design, so that a reading stays quick.
MOST_UPLOADED_LEGS = 60


@dataclass(frozen=True, kw_only=True)
class Half:
    """One column of the dialog of figure 41: the top or the base.

    Attributes
    ----------
    kind : "triangle" or "hexagon"
    size : float [unit]
        Side of the triangle; of a hexagon that of the triangle from whose vertices its joints are
        separated. In `SIZE_RANGE`, for top and base.
    separation : one of `SEPARATIONS`
        Of the two joints at a vertex; without effect for a triangle.
    percent : float [%]
        In [0, 100].
    """

    kind: str = TRIANGLE
    size: float = 1.0
    separation: str = EDGES
    percent: float = 0.0

    @property
    def share(self) -> float:
        """The separation as a share of the side, 0 for a triangle [1]."""
        return 0.0 if self.kind == TRIANGLE else self.percent / 100.0


def names() -> tuple[str, ...]:
    """Return the names that can be chosen: published designs, then the 195 mechanisms."""
    return (*published_names(), *(m.name for m in mechanisms()))


@cache
def published_names() -> tuple[str, ...]:
    """Return the names of the published designs without legs that are driven at the base."""
    return tuple(name for name in design_names() if not published(name).driven)


@lru_cache(maxsize=512)
def named(name: str, template: str = TEMPLATE) -> Design:
    """Return a published design, a mechanism on a published template, or one of a family.

    Files are not read.

    Raises
    ------
    UnknownDesign, UnknownMechanism, InvalidDesign
    """
    if name in design_names():
        return check_undriven("design", published(name))
    if is_family(name):
        return design_of_family(name)
    if name not in names():
        raise UnknownDesign("design or mechanism", name, names())
    return instantiate(mechanism(name), named_template(template))


def named_template(name: str) -> Design:
    """Return a published design.

    Raises
    ------
    UnknownDesign
    """
    if name not in design_names():
        raise UnknownDesign("template", name, published_names())
    return check_undriven("template", published(name))


def from_file(text: str, origin: str = "design file") -> Design:
    """Return the design of the text of a TOML file of limited size.

    Raises
    ------
    MalformedFile, InvalidInput
    """
    if len(text) > LARGEST_FILE:
        got = f"{len(text)} letters"
        raise InvalidInput(expected(origin, f"at most {LARGEST_FILE} letters", got))
    design = check_undriven(origin, design_from_toml(text, origin))
    if design.n_legs > MOST_UPLOADED_LEGS:
        raise InvalidDesign(expected(origin, f"at most {MOST_UPLOADED_LEGS} legs", design.n_legs))
    return design


def configured(top: Half, base: Half) -> Design:
    """Return the design of the dissertation's dialog, with its best central pose as home.

    Parameters
    ----------
    top, base : Half
        Sizes are the sides a and b. Each hexagon has a kind of separation and a percentage of its
        own.

    Returns
    -------
    Design

    Raises
    ------
    InvalidInput
        On other types or separations, sizes or percentages out of range.

    Examples
    --------
    >>> design = configured(Half(size=15.0), Half(size=30.0))
    >>> design.name, design.home.position.round(9).tolist()
    ('lee-3-3 (a=15, b=30)', [0.0, 0.0, 15.0])

    *Source: Lee2000, figure 41; eqs. (2), (44), (60), (69), (74) for the designs, (16), (54), (63)
    for the height. Different separations are combined leg by leg, A_1 with E_A1 and so on (ours).*
    """
    for half, what in ((top, "top"), (base, "base")):
        _check_half(half, what)
    ways = [half.separation if half.kind == HEXAGON else EDGES for half in (top, base)]
    if ways == [EDGES, EDGES]:
        return _hexagonal(top, base)
    kinds = [KIND_OF[way] for way in ways]
    if kinds[0] == kinds[1] and top.share == base.share:
        return best_placed(f"lee-{kinds[0]}", top.size, base.size, top.share)
    sizes = top.size, base.size, top.share, base.share
    return best_placed_by_kinds(*sizes, top=kinds[0], base=kinds[1])


def _hexagonal(top: Half, base: Half) -> Design:
    if top.kind == HEXAGON:
        return best_placed("lee-6-6", top.size, base.size, top.share, base.share)
    if base.kind == HEXAGON:
        return best_placed("lee-3-6", top.size, base.size, base.share)
    return best_placed("lee-3-3", top.size, base.size)


def _check_half(half: Half, what: str) -> None:
    if half.kind not in TYPES or half.separation not in SEPARATIONS:
        wanted = f"{' or '.join(TYPES)}; {', '.join(SEPARATIONS)}"
        raise InvalidInput(expected(what, wanted, f"{half.kind}, {half.separation}"))
    least, most = SIZE_RANGE
    if not least <= half.size <= most:
        wanted = f"a number from {least:g} to {most:g}"
        raise InvalidInput(expected(f"size of the {what}", wanted, half.size))
    if not 0.0 <= half.percent <= 100.0:
        raise InvalidInput(
            expected(f"joint separation of the {what}", "a percentage in [0, 100]", half.percent)
        )


def shortened(name: str) -> str:
    """Return a name that fits in a title."""
    return name if len(name) <= 48 else name[:45] + "…"
