"""The cells of a region: what they measure, which points they contain, and what encloses them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.checks import check_array, check_integer, check_memory, check_rng
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly, kept_property
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.rotations import angles_from_rotation, rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes
from gsp.workspace.sets.problem import Bounded
from gsp.workspace.sets.region.sampling import Estimate, drawn, share_error
from gsp.workspace.sets.tree.boxes import ALL_ROTATIONS, FACE_TOLERANCE, located, turn_measure
from gsp.workspace.sets.tree.cuts import shares, undecided_boxes

# Sums of volumes are widened by this share for rounding.
VOLUME_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class Measured(ReadOnly):
    """Proven cells of a set, with the attributes that `Region` documents."""

    kind: str
    problem: Bounded
    low: Array
    high: Array
    codes: Codes
    cuts: Array
    domain: Array
    levels: int
    nodes: int
    _decide: Callable[[Array], Codes]  # of single points (m, 3), in the coordinates of the cells
    all_rotations: bool

    @kept_property
    def sizes(self) -> Array:
        """Volumes or areas of the cells, shape (n,) [length³ or length²; of orientations rad³].

        *Source: ours; see docs/sets.md*
        """
        if self.kind == "orientations":
            return turn_measure(self.low, self.high)
        return np.asarray((self.high - self.low).prod(axis=1))

    @property
    def volume(self) -> tuple[float, float]:
        """Least and greatest volume, proven [length³; of orientations rad³, at most 8π²].

        The least one includes the proven parts of undecided cells (`cuts`), so it may be above
        zero though no whole cell is inside, which `worst` needs.

        Raises
        ------
        InvalidInput
            For a region in a plane, which has an area.

        *Source: ours; see docs/sets.md*
        """
        if self.kind == "plane":
            raise InvalidInput(expected("region", "a region in space; this has an area", self.kind))
        return self.bracket

    @property
    def area(self) -> tuple[float, float]:
        """Least and greatest area of a region in a plane, proven [length²].

        Raises
        ------
        InvalidInput
            For any other region.

        *Source: ours; see docs/sets.md*
        """
        if self.kind != "plane":
            wanted = "a region in a plane; this has a volume"
            raise InvalidInput(expected("region", wanted, self.kind))
        return self.bracket

    @property
    def bracket(self) -> tuple[float, float]:
        """Least and greatest volume or area, proven [length³ or length²; of orientations rad³].

        *Source: ours; see docs/sets.md*
        """
        low, high = self._shares
        return (
            float((self.sizes * low).sum()) * (1.0 - VOLUME_ROUNDING),
            float((self.sizes * high).sum()) * (1.0 + VOLUME_ROUNDING),
        )

    @property
    def share(self) -> tuple[float, float]:
        """Least and greatest share of all orientations, proven [1].

        Raises
        ------
        InvalidInput
            For a region of positions.

        *Source: ours; see docs/sets.md*
        """
        if self.kind != "orientations":
            wanted = "a region of orientations; this has a volume or an area"
            raise InvalidInput(expected("region", wanted, self.kind))
        low, high = self.bracket
        return low / ALL_ROTATIONS, min(high / ALL_ROTATIONS, 1.0)

    @kept_property
    def _shares(self) -> tuple[Array, Array]:
        """Shares of the cells that are inside, and that are not outside."""
        inside, outside = shares(self.low, self.high, self.cuts)
        settled = self.codes == INSIDE
        return np.where(settled, 1.0, inside), np.where(settled, 1.0, 1.0 - outside)

    @property
    def resolution(self) -> float:
        """Longest side of what stays undecided, 0 if nothing does [length; of orientations rad].

        Of an undecided cell only the part counts that no plane of `cuts` decides: the longest side
        of the box around it. It is above the resolution that was wanted where the budget ended the
        search.

        *Source: ours; see docs/sets.md*
        """
        open_ = self.codes == UNDECIDED
        low, high = undecided_boxes(self.low[open_], self.high[open_], self.cuts[open_])
        sides = high - low
        # A box without width holds nothing, but for cells that are no wider.
        none = ((sides <= 0.0) & (self.high[open_] > self.low[open_])).any(axis=1)
        return float(sides[~none].max(initial=0.0))

    @property
    def empty(self) -> bool:
        """Whether it is proven that nothing is in the set."""
        return not len(self.codes)

    def contains(self, points: ArrayLike) -> NDArray[np.int8]:
        """Return the codes of points: 1 inside, 0 undecided, −1 outside.

        Points of undecided cells that are in no proven part are decided one by one, which leaves
        very few undecided.

        Parameters
        ----------
        points : (..., 3) array_like [length]
            In base axes; for a plane also (..., 2), along its directions, and points beside it are
            outside. Of orientations three angles [rad] in the order of `Region.problem.order`, by
            default "rpy".

        Returns
        -------
        (...) int8 array

        Raises
        ------
        InvalidInput
            On a wrong shape, or numbers that are not finite.

        *Source: ours; see docs/sets.md*
        """
        given = check_array("points", points, ())
        width = given.shape[-1] if given.ndim else 0
        if width != 3 and not (width == 2 and self.kind == "plane"):
            wanted = {"space": "x, y, z", "orientations": "three angles [rad]"}
            numbers = wanted.get(self.kind, "x, y, z, or two coordinates along the plane")
            shapes = "(..., 3) or (..., 2)" if self.kind == "plane" else "(..., 3)"
            got = f"shape {given.shape}"
            raise InvalidInput(expected("points", f"{numbers}: shape {shapes}", got))
        shape = given.shape[:-1]
        flat = given.reshape(-1, width)
        local, beside = self._local(flat)
        codes = located(local, self.low, self.high, self.codes, self.domain, self.cuts)
        codes[beside] = OUTSIDE
        open_ = np.flatnonzero(codes == UNDECIDED)
        if open_.size:
            codes[open_] = self._decide(_padded(local[open_]))
        return codes.reshape(shape)

    def _local(self, points: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Coordinates along the axes of the cells, and which points are beside the plane."""
        beside = np.zeros(len(points), dtype=np.bool_)
        if self.kind == "orientations":
            # Within [−π, π] × [−π/2, π/2] × [−π, π].
            return angles_from_rotation(rotation_from_angles(points)), beside
        if points.shape[1] == 2:
            return points, beside
        local = self.problem.inward(points)
        if self.kind == "plane":
            scale = np.abs(self.domain).max(initial=0.0) + np.abs(points).max(initial=0.0)
            beside = np.abs(local[:, 2]) > FACE_TOLERANCE * scale
            local = local[:, :2]
        return local, beside

    def estimate(self, samples: int = 1000, *, rng: np.random.Generator | int = 0) -> Estimate:
        """Return an estimate of volume or area, by sampling the undecided parts of cells.

        It is unbiased if all samples are decided; one that stays undecided counts half.

        Parameters
        ----------
        samples : int
            ≥ 2
        rng : numpy.random.Generator or int
            Generator or seed.

        Returns
        -------
        Estimate [as the volume or the area]

        Raises
        ------
        InvalidInput
            On another number of samples or generator.
        """
        samples, generator = check_integer("samples", samples, 2), check_rng("rng", rng)
        check_memory("samples", samples, POSE_BYTES, "points")
        low, _ = self.bracket
        open_ = np.flatnonzero(self.codes == UNDECIDED)
        slabs = (self.sizes * (self._shares[1] - self._shares[0]))[open_]
        if not slabs.sum() > 0.0:
            return Estimate(low, 0.0, 0)
        turning = self.kind == "orientations"
        points = drawn(
            self.low[open_], self.high[open_], self.cuts[open_], slabs, samples, generator, turning
        )
        codes = self._decide(_padded(points))
        share = np.where(codes == INSIDE, 1.0, np.where(codes == OUTSIDE, 0.0, 0.5))
        unsure = 0.5 * float((codes == UNDECIDED).mean())
        error = share_error(share) + unsure
        size = slabs.sum()
        return Estimate(float(low + size * share.mean()), float(size * error), samples)

    @property
    def extents(self) -> tuple[Array, Array]:
        """Two boxes (2, d): one that inside cells fill to its faces, one that holds all [length].

        Coordinates of the cells: base axes, directions of the plane, or angles. The first is NaN
        if no cell is inside, and both are NaN if the region is empty.

        *Source: ours; see docs/sets.md*
        """
        return self._hull(self.codes == INSIDE), self._hull(self.codes >= UNDECIDED)

    def _hull(self, chosen: NDArray[np.bool_]) -> Array:
        if not chosen.any():
            return np.full((2, self.low.shape[1]), np.nan)
        return np.stack((self.low[chosen].min(axis=0), self.high[chosen].max(axis=0)))

    @property
    def centroid(self) -> Array:
        """Centroid of the cells, undecided ones with half of their weight, (3,) [length].

        In base axes; NaN if the region is empty. It is not proven.

        Raises
        ------
        InvalidInput
            For orientations, which have none.

        *Source: ours; see docs/sets.md*
        """
        if self.kind == "orientations":
            raise InvalidInput(expected("region", "a region of positions", self.kind))
        weight = self.sizes * np.where(self.codes == INSIDE, 1.0, 0.5)
        if not weight.sum() > 0.0:
            return np.full(3, np.nan)
        middle = weight @ (0.5 * (self.low + self.high)) / weight.sum()
        return np.asarray(self.problem.outward(_padded(middle[None])[0]))


def _padded(points: Array) -> Array:
    """Points (n, 3) from (n, 2): in the plane."""
    return np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
