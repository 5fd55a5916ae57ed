"""What an index is: a function, and the facts that tables, rankings and docs are made from."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Literal

from gsp.design import Design
from gsp.vectors import Array


@dataclass(frozen=True)
class Index:
    """A performance index.

    Attributes
    ----------
    name : str
        Name of its function in `gsp.indices`.
    symbol : str
        As the literature writes it.
    function : posture, … -> (...) array
    better : "higher" or "lower"
    best, worst : float
        Range; `worst` is the value at singular postures, inf where there is no bound.
    parameters : tuple of str
        Which of "length", "ellipsoid", "maximum" the function takes.
    needs : tuple of str
        Those of them that it cannot do without, for any mechanism.
    length_for : "" or "angular" or "cylindrical"
        The legs for which it needs a length as well: those with A1 actuators, or those with
        cylindrical joints.
    unit_power : str
        How a value changes with the unit of length when the parameters keep their meaning:
        "1" (not at all), or a power of the length.
    source : str
    """

    name: str
    symbol: str
    function: Callable[..., Array]
    better: Literal["higher", "lower"]
    best: float
    worst: float
    parameters: tuple[str, ...]
    needs: tuple[str, ...]
    length_for: Literal["", "angular", "cylindrical"]
    unit_power: str
    source: str

    def missing(self, design: Design, given: Collection[str]) -> tuple[str, ...]:
        """Return the parameters that it needs for a design and that are not among the given."""
        legs = {
            "": False,
            "angular": any(c.quantity == "angle" for leg in design.legs for c in leg.constraints),
            "cylindrical": any(leg.cylindrical for leg in design.legs),
        }
        needs = (*self.needs, "length") if legs[self.length_for] else self.needs
        return tuple(name for name in dict.fromkeys(needs) if name not in given)
