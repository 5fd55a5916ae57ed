"""What `gsp rank` computes: designs, poses and parameters, read from its options."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from gsp.catalogue import design as published_design
from gsp.catalogue import instantiate, mechanisms
from gsp.cli.console import progress_bar
from gsp.cli.defaults import anchor_spheroid, neighbourhood
from gsp.cli.designs import find_design, find_mechanism_or_design
from gsp.cli.options import TEMPLATE, read_box
from gsp.errors import InvalidInput, expected
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import PoseBox
from gsp.model.design import Design
from gsp.model.mechanism import Mechanism
from gsp.ranking import rank

if TYPE_CHECKING:
    import pandas as pd

# The second pose that TozKucuk2016 studies belongs to this design on the same base and platform.
NEIGHBOUR = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"


@dataclass(frozen=True, eq=False)
class Plan:
    """A ranking, ready to be computed.

    Attributes
    ----------
    designs : list of Design
        With one unit of length.
    template : str
        Name of the design that mechanisms were put on; "" if there were none.
    box, samples, seed :
        The poses: a Halton sample of the box.
    length, ellipsoid :
        As `gsp.rank` takes them.
    """

    designs: list[Design]
    template: str
    box: PoseBox
    samples: int
    seed: int
    length: float | None
    ellipsoid: Ellipsoid | None

    @property
    def unit(self) -> str:
        """The unit of length of all the designs."""
        return self.designs[0].unit

    def given(self, design: Design) -> tuple[str, ...]:
        """Return the names of the parameters that indices of a design are given."""
        length = self.length or design.characteristic_length
        return ("maximum", "ellipsoid") + (("length",) if length else ())

    def compute(
        self, indices: tuple[str, ...] | None, by: str | None, workers: int | None
    ) -> pd.DataFrame:
        """Return the ranking, with a progress bar meanwhile."""
        poses = self.box.sample(self.samples, rng=self.seed)
        with progress_bar("Ranking") as progress:
            return rank(
                self.designs, poses, indices, by,
                length=self.length, ellipsoid=self.ellipsoid, maximum="sample",
                workers=workers, progress=progress,
            )  # fmt: skip


def make_plan(
    texts: list[str],
    template: str,
    box: str | None,
    order: str,
    samples: int,
    seed: int,
    length: float | None,
    semi_axes: tuple[float, float, float] | None,
) -> Plan:
    """Return the plan that the options of `gsp rank` ask for."""
    base = find_design(template)
    found = [find_mechanism_or_design(text) for text in texts] or list(mechanisms())
    designs = [instantiate(f, base) if isinstance(f, Mechanism) else f for f in found]
    placed = any(isinstance(f, Mechanism) for f in found)
    _check_units(designs)
    homes = [*designs, published_design(NEIGHBOUR)] if placed and template == TEMPLATE else designs
    poses = neighbourhood(homes, order) if box is None else read_box(box, order)
    ellipsoid = _ellipsoid(designs, semi_axes)
    return Plan(designs, base.name if placed else "", poses, samples, seed, length, ellipsoid)


def _ellipsoid(
    designs: list[Design], semi_axes: tuple[float, float, float] | None
) -> Ellipsoid | None:
    """Return the ellipsoid for all designs, or None if they record their own."""
    if semi_axes is not None:
        return Ellipsoid(semi_axes)
    own = all(design.ellipsoid is not None for design in designs)
    return None if own else anchor_spheroid(designs)


def _check_units(designs: list[Design]) -> None:
    units = list(dict.fromkeys(design.unit for design in designs))
    if len(units) > 1:
        got = " and ".join(repr(unit) for unit in units)
        raise InvalidInput(expected("designs", "one unit of length, as they share poses", got))
