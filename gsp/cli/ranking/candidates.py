"""Designs that `gsp rank` compares: given ones, and mechanisms on the anchors of a template."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gsp.catalogue import instantiate, mechanisms, placements
from gsp.catalogue.placement import TEMPLATE
from gsp.cli.inputs.designs import find_design, find_mechanism_or_design
from gsp.errors import InvalidInput, expected
from gsp.model.design import Design
from gsp.model.mechanism import Mechanism
from gsp.ranking import in_unit
from gsp.ranking.comparison import check_units, distinct_names


@dataclass(frozen=True, eq=False, kw_only=True)
class Candidates:
    """Designs to compare, and how they were found.

    Attributes
    ----------
    designs : list of Design
        With one unit of length.
    template : str
        Name of the design on whose anchors mechanisms are placed; "" if there are none.
    placed : int
        Number of the designs that are mechanisms on the template.
    spare : int
        Number of positions of the template that no mechanism uses.
    mechanisms : int
        Number of mechanisms whose placements are the designs on the template; 0 if each mechanism
        is placed in one way.
    """

    designs: list[Design]
    template: str
    placed: int
    spare: int = 0
    mechanisms: int = 0

    @property
    def unit(self) -> str:
        """The unit of length of the designs; "" if none of them names one."""
        return check_units(self.designs)

    def notes(self) -> Iterator[str]:
        """Return legs without use, assumed units, and names for designs of equal names.

        One line each.
        """
        if self.spare:
            yield f"the last {self.spare} of the legs of {self.template} are not used"
        pairs = list(zip(self.designs, distinct_names(self.designs), strict=True))
        without = ", ".join(name for design, name in pairs if not design.unit)
        if self.unit and without:
            yield f"no unit of length in {without}: taken to be in {self.unit}"
        for i, (design, name) in enumerate(pairs, 1):
            if name != design.name:
                yield f"design {i} has the name of another one: listed as {name}"


def find_candidates(
    texts: list[str],
    template: str | None = None,
    unit: str | None = None,
    every_placement: bool = False,
) -> Candidates:
    """Return the designs that arguments and options of `gsp rank` name.

    Raises
    ------
    InvalidInput, UnknownDesign, UnknownMechanism, MalformedFile
    """
    found = [find_mechanism_or_design(text) for text in texts] or list(mechanisms())
    named = [f if unit is None else in_unit(f, unit) for f in found if isinstance(f, Design)]
    placed = [f for f in found if isinstance(f, Mechanism)]
    for option, given in (("--template", template is not None), ("--placements", every_placement)):
        if given and not placed:
            wanted = "mechanisms, which are placed on a template"
            raise InvalidInput(expected(option, wanted, "designs only"))
    base = _template(template, named, unit) if placed else None
    beside = iter(named)
    groups = [
        _placed(f, base, every_placement) if base and isinstance(f, Mechanism) else [next(beside)]
        for f in found
    ]
    designs = [design for group in groups for design in group]
    check_units(designs)
    most_legs = max((len(f.legs) for f in placed), default=0)
    return Candidates(
        designs=designs,
        template=base.name if base else "",
        placed=len(designs) - len(named),
        spare=0 if every_placement or base is None else base.n_legs - most_legs,
        mechanisms=len(placed) if every_placement else 0,
    )


def _placed(mechanism: Mechanism, template: Design, every: bool) -> Sequence[Design]:
    """Return a mechanism where `instantiate` places it, or all of its placements."""
    return placements(mechanism, template) if every else [instantiate(mechanism, template)]


def _template(given: str | None, named: list[Design], unit: str | None) -> Design:
    """Return the template of mechanisms: the one given, else the design given with them.

    Mechanisms on the anchors of a design can be compared with that design; on another template
    they would have another size.
    """
    if given is None and len({design.name for design in named}) > 1:
        names = ", ".join(design.name for design in named)
        wanted = "the design on whose anchors the mechanisms are put"
        raise InvalidInput(expected("--template", wanted, f"none, beside the designs {names}"))
    if given is None and named:
        return named[0]
    base = find_design(TEMPLATE if given is None else given)
    return base if unit is None else in_unit(base, unit)
