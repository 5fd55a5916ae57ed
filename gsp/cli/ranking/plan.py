"""What `gsp rank` computes: designs, poses and parameters, read from its options."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gsp.catalogue import design as published_design
from gsp.catalogue import instantiate, mechanisms, placements
from gsp.catalogue.placement import TEMPLATE
from gsp.checks import check_integer, check_memory, check_rng
from gsp.cli.inputs.defaults import anchor_spheroid, neighbourhood
from gsp.cli.inputs.designs import find_design, find_mechanism_or_design
from gsp.cli.inputs.poses import read_box
from gsp.errors import InvalidInput, brief, expected
from gsp.evaluation.parts import check_parts
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.model.mechanism import Mechanism
from gsp.ranking import in_unit, rank
from gsp.ranking.comparison import check_units, distinct_names
from gsp.ranking.order import fingerprint, prepared

if TYPE_CHECKING:
    import pandas as pd

# The second pose that TozKucuk2016 studies belongs to this design on the same base and platform.
NEIGHBOUR = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"


@dataclass(frozen=True, eq=False, kw_only=True)
class Plan:
    """A ranking, ready to be computed.

    Attributes
    ----------
    designs : list of Design
        With one unit of length.
    template : str
        Name of the design on whose anchors mechanisms are placed; "" if there are none.
    placed : int
        Number of the designs that are mechanisms on the template.
    box, samples, seed :
        The poses: a Halton sample of the box.
    length, ellipsoid :
        As `gsp.rank` takes them.
    feasible : bool
        Whether only poses within the strokes count.
    spare : int
        Number of positions of the template that no mechanism uses.
    mechanisms : int
        Number of mechanisms whose placements are the designs on the template; 0 if each mechanism
        is placed in one way.
    """

    designs: list[Design]
    template: str
    placed: int
    box: PoseBox
    samples: int
    seed: int
    length: float | None
    ellipsoid: Ellipsoid | None
    feasible: bool
    spare: int = 0
    mechanisms: int = 0

    @property
    def unit(self) -> str:
        """The unit of length of the designs; "" if none of them names one."""
        return check_units(self.designs)

    def given(self, design: Design) -> tuple[str, ...]:
        """Return the names of the parameters that indices of a design are given."""
        length = self.length or design.characteristic_length
        ellipsoid = self.ellipsoid or design.ellipsoid
        there = {"maximum": True, "ellipsoid": ellipsoid is not None, "length": length is not None}
        return tuple(name for name, given in there.items() if given)

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

    def check(self, indices: tuple[str, ...] | None, by: str | None) -> None:
        """Raise an error of `gsp.rank`, if the plan gives one, before anything is printed.

        Raises
        ------
        InvalidInput, MissingParameter
        """
        if self.feasible:
            _check_strokes(self.designs)
        check_memory("--samples", check_integer("--samples", self.samples), POSE_BYTES, "poses")
        check_rng("--seed", self.seed)
        prepared(
            self.designs,
            Pose([self.box.low[:3], self.box.high[:3]]),
            indices,
            by,
            length=self.length,
            ellipsoid=self.ellipsoid,
            maximum="sample",
            limits=Limits() if self.feasible else None,
        )

    def check_parts(
        self, indices: tuple[str, ...] | None, by: str | None, folder: Path, resume: bool
    ) -> None:
        """Raise an error if a folder holds parts that this run would not continue.

        Raises
        ------
        UnwritableOutput, InvalidInput
        """
        request, decides, _ = prepared(
            self.designs,
            self._poses(),
            indices,
            by,
            length=self.length,
            ellipsoid=self.ellipsoid,
            maximum="sample",
            limits=self._limits(),
        )
        check_parts(folder, fingerprint(request, decides, self._limits()), resume=resume)

    def _poses(self) -> Pose:
        return self.box.sample(self.samples, rng=self.seed)

    def _limits(self) -> Limits | None:
        return Limits() if self.feasible else None

    def compute(
        self,
        indices: tuple[str, ...] | None,
        by: str | None,
        workers: int | None,
        parts: Path | None = None,
        resume: bool = False,
    ) -> pd.DataFrame:
        """Return the ranking; a bar is drawn meanwhile, where stderr is a terminal."""
        poses = self.box.sample(self.samples, rng=self.seed)
        return rank(
            self.designs,
            poses,
            indices,
            by,
            length=self.length,
            ellipsoid=self.ellipsoid,
            maximum="sample",
            limits=Limits() if self.feasible else None,
            workers=workers,
            parts=parts,
            resume=resume,
        )


def make_plan(
    texts: list[str],
    *,
    template: str | None = None,
    box: str | None = None,
    order: str = "rpy",
    samples: int = 4000,
    seed: int = 0,
    length: float | None = None,
    semi_axes: tuple[float, float, float] | None = None,
    unit: str | None = None,
    feasible: bool = False,
    every_placement: bool = False,
) -> Plan:
    """Return the plan for the options of `gsp rank`."""
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
    homes = [*designs, published_design(NEIGHBOUR)] if base and base.name == TEMPLATE else designs
    poses = neighbourhood(homes, order) if box is None else read_box(box, order)
    most_legs = max((len(f.legs) for f in placed), default=0)
    return Plan(
        designs=designs,
        template=base.name if base else "",
        placed=len(designs) - len(named),
        box=poses,
        samples=samples,
        seed=seed,
        length=length,
        ellipsoid=_ellipsoid(designs, semi_axes),
        feasible=feasible,
        spare=0 if every_placement or base is None else base.n_legs - most_legs,
        mechanisms=len(placed) if every_placement else 0,
    )


def _placed(mechanism: Mechanism, template: Design, every: bool) -> Sequence[Design]:
    """Return a mechanism where `instantiate` places it, or all of its placements."""
    return placements(mechanism, template) if every else [instantiate(mechanism, template)]


def _check_strokes(designs: list[Design]) -> None:
    """Raise an error if --feasible has no effect on a design."""
    for design in designs:
        if design.strokes is None or not np.isfinite(design.strokes).any():
            name = brief(design.name or "unnamed")
            raise InvalidInput(expected("--feasible", "strokes of each design", f"none of {name}"))


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


def _ellipsoid(
    designs: list[Design], semi_axes: tuple[float, float, float] | None
) -> Ellipsoid | None:
    """Return the ellipsoid for all designs, or None.

    None if they record their own, and if all platform anchors are at the platform origin.
    """
    if semi_axes is not None:
        return Ellipsoid(semi_axes)
    own = all(design.ellipsoid is not None for design in designs)
    extended = any(design.platform_points.any() for design in designs)
    return anchor_spheroid(designs) if extended and not own else None
