"""Regions: proven sets of positions or of orientations."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.checks import check_array
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.geometry.copies import kept_property
from gsp.geometry.vectors import Array
from gsp.rounding import rounded_down, rounded_up
from gsp.workspace.sets.region.posed import Posed
from gsp.workspace.sets.tree.boxes import components

if TYPE_CHECKING:
    from gsp.workspace.sets.shapes.inscribed import Body, Inscribed

# Sides of cells differ by at most this share of themselves from halves of the domain: rounding.
SIDE_ROUNDING = 1e-12
# Name of the measure of a region, by its kind.
MEASURES = {"space": "volume", "plane": "area", "orientations": "volume"}


@dataclass(frozen=True, eq=False)
class Region(Posed):
    """A set of positions or orientations, as cells that are proven; made by `reachable` and others.

    All that is in no cell is proven to be outside.

    Attributes
    ----------
    kind : str
        "space", "plane" or "orientations".
    problem : Bounded
        Design and limits, and the axes of the plane.
    low, high : (n, d) arrays [length, or rad]
        The cells: d = 3, or 2 for a plane, along its two directions. Of orientations, roll, pitch
        and yaw.
    codes : (n,) int8 array
        1 inside, 0 undecided.
    cuts : (n, 8) array [1, length]
        Parts of undecided cells that are proven: n, c, n, c, where n · δ ≤ c is outside and
        n · δ ≥ c is inside, δ from the middle of the cell; c is infinite for no part.
    domain : (2, d) array [length, or rad]
        Least and greatest coordinates of the box that was searched.
    levels, nodes : int
        How often the domain was halved, and how many rotation cells were decided.
    all_rotations : bool
        Whether a position is inside only with all orientations of the range, or there is only one.
    wanted : float or None [length, or rad]
        The resolution that was asked for; `reached` states whether the search came so far.
    """

    wanted: float | None = None

    @property
    def reached(self) -> bool:
        """Whether nothing wider than the resolution that was asked for is undecided.

        False where the budget ended the search before: `resolution` is what was reached. True where
        no resolution was asked for.

        *Source: ours; see docs/sets.md*
        """
        return self.wanted is None or self.resolution <= self.wanted * (1.0 + SIDE_ROUNDING)

    @kept_property
    def parts(self) -> tuple[Region, ...]:
        """The parts that are proven not to be connected, the largest first.

        Cells that touch, inside or undecided, are one part, so a part may consist of several.
        Angles are connected across ±180°.
        """
        if self.empty:
            return ()
        labels = components(self.low, self.high, self._turn())
        regions = (self._some(labels == number) for number in np.unique(labels))
        return tuple(sorted(regions, key=lambda part: -part.bracket[1]))

    def _some(self, chosen: NDArray[np.bool_]) -> Region:
        return replace(
            self,
            low=self.low[chosen],
            high=self.high[chosen],
            codes=self.codes[chosen],
            cuts=self.cuts[chosen],
        )

    def _turn(self) -> Array:
        """Length after which a coordinate repeats, 0 if it does not."""
        d = self.low.shape[1]
        full = self.kind == "orientations"
        return np.array([2.0 * np.pi if full and k != 1 else 0.0 for k in range(d)])

    def part_of(self, point: ArrayLike) -> Region:
        """Return the part that a point is in.

        Parameters
        ----------
        point : (3,) array_like [length, or rad]
            As in `contains`, for instance the position of a home pose.

        Returns
        -------
        Region

        Raises
        ------
        EmptyWorkspace
            If it is in no part.
        InvalidInput
            On a wrong shape.
        """
        where = check_array("point", point, (None,))
        if where.ndim != 1 or len(where) not in (3, self.low.shape[1]):
            raise InvalidInput(expected("point", "a single point", f"shape {where.shape}"))
        local, beside = self._local(where.reshape(1, -1))
        for part in self.parts:
            inside = (local >= part.low) & (local <= part.high)
            if inside.all(axis=1).any() and not beside[0]:
                return part
        raise EmptyWorkspace(expected("point", "a point of the region", where.tolist()))

    def largest(
        self, body: Body = "ball", proportions: ArrayLike | None = None, tolerance: float = 0.01
    ) -> Inscribed:
        """Return the largest ball, cylinder or box in a region of positions.

        In a region of `dextrous` it is the largest in which the platform takes all orientations
        of the range.

        Parameters
        ----------
        body : str
            "ball", "cylinder" with its axis along z, or "box" along the axes of the base. In a
            plane "ball" is a disc and "box" a rectangle along its directions.
        proportions : (3,) array_like or None [any length]
            Half-widths of the body of factor 1, two numbers in a plane; default all 1. The radii
            of a ball are equal, as are the first two of a cylinder.
        tolerance : float [1]
            Relative gap to the largest body in the cells at which the search ends, at the latest
            after 100,000 centres: `Inscribed.reached` states which. The gap between `factor` and
            `above` is that of the undecided cells too, which only a finer resolution makes
            smaller. Most of the time goes into the faces of the cells: with 0.001 it takes up to
            twice the time of 0.01.

        Returns
        -------
        Inscribed
            The body is proven inside; no body of more than `above` is.

        Raises
        ------
        EmptyWorkspace
            If no cell is inside.
        InvalidInput
            For orientations, or on another body, shape or number.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=2.0)
        >>> found = region.largest("cylinder")
        >>> region.contains(found.centre), bool(found.factor < found.above)
        (array(1, dtype=int8), True)
        """
        from gsp.workspace.sets.shapes.inscribed import largest

        return largest(self, body, proportions, tolerance)

    def __repr__(self) -> str:
        low, high = self.bracket
        ends = f"[{rounded_down(low, 6):.6g}, {rounded_up(high, 6):.6g}]"
        measure = f"{self.kind}, {MEASURES[self.kind]} in {ends}"
        if self.reached:
            return f"Region({measure})"
        found = rounded_up(self.resolution, 3)
        return f"Region({measure}, resolution {found:.3g}: {self.wanted:.3g} is not reached)"
