"""What `gsp rank` computes: designs, poses and parameters, read from its options."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gsp.catalogue import design as published_design
from gsp.catalogue.placement import TEMPLATE
from gsp.checks import check_integer, check_memory, check_rng
from gsp.cli.inputs.defaults import anchor_spheroid, neighbourhood
from gsp.cli.inputs.poses import read_box
from gsp.cli.ranking.candidates import Candidates, find_candidates
from gsp.errors import InvalidInput, brief, expected
from gsp.evaluation.parts import check_parts
from gsp.files.claims import Claim
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.ranking import rank
from gsp.ranking.order import fingerprint, prepared

if TYPE_CHECKING:
    import pandas as pd

# The second pose that TozKucuk2016 studies belongs to this design on the same base and platform.
NEIGHBOUR = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"


@dataclass(frozen=True, eq=False, kw_only=True)
class Plan(Candidates):
    """A ranking, ready to be computed.

    Attributes
    ----------
    box, samples, seed :
        The poses: a Halton sample of the box.
    length, ellipsoid :
        As `gsp.rank` takes them.
    feasible : bool
        Whether only poses within the strokes count.
    """

    box: PoseBox
    samples: int
    seed: int
    length: float | None
    ellipsoid: Ellipsoid | None
    feasible: bool

    def given(self, design: Design) -> tuple[str, ...]:
        """Return the names of the parameters that indices of a design are given."""
        length = self.length or design.characteristic_length
        ellipsoid = self.ellipsoid or design.ellipsoid
        there = {"maximum": True, "ellipsoid": ellipsoid is not None, "length": length is not None}
        return tuple(name for name, given in there.items() if given)

    def check(
        self, indices: tuple[str, ...] | None, by: str | None, workers: int | None = None
    ) -> None:
        """Raise an error of `gsp.rank`, if the plan gives one, before anything is printed.

        Raises
        ------
        InvalidInput, MissingParameter
        """
        if self.feasible:
            _check_strokes(self.designs)
        check_memory("--samples", check_integer("--samples", self.samples), POSE_BYTES, "poses")
        check_rng("--seed", self.seed)
        if workers is not None:
            check_integer("--workers", workers)
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
        self, indices: tuple[str, ...] | None, by: str | None, claim: Claim, resume: bool
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
        check_parts(claim, fingerprint(request, decides, self._limits()), resume=resume)

    def _poses(self) -> Pose:
        return self.box.sample(self.samples, rng=self.seed)

    def _limits(self) -> Limits | None:
        return Limits() if self.feasible else None

    def compute(
        self,
        indices: tuple[str, ...] | None,
        by: str | None,
        workers: int | None,
        parts: Claim | None = None,
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
    found = find_candidates(texts, template, unit, every_placement)
    designs = found.designs
    published = found.template == TEMPLATE
    homes = [*designs, published_design(NEIGHBOUR)] if published else designs
    return Plan(
        **vars(found),
        box=neighbourhood(homes, order) if box is None else read_box(box, order),
        samples=samples,
        seed=seed,
        length=length,
        ellipsoid=_ellipsoid(designs, semi_axes),
        feasible=feasible,
    )


def _check_strokes(designs: list[Design]) -> None:
    """Raise an error if --feasible has no effect on a design."""
    for design in designs:
        if design.strokes is None or not np.isfinite(design.strokes).any():
            name = brief(design.name or "unnamed")
            raise InvalidInput(expected("--feasible", "strokes of each design", f"none of {name}"))


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
