"""Regions: proven sets of positions or of orientations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.checks import check_array, check_integer, check_rng
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.geometry.rotations import angles_from_rotation, rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.workspace.sets.boxes import FACE, components, located, turn_measure
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes
from gsp.workspace.sets.cuts import shares
from gsp.workspace.sets.problem import Bounded
from gsp.workspace.sets.sampling import Estimate, drawn
from gsp.workspace.sets.tree import Leaves

if TYPE_CHECKING:
    from os import PathLike

    import pandas as pd
    from matplotlib.axes import Axes
    from trimesh import Trimesh

    from gsp.geometry.ellipsoid import Ellipsoid
    from gsp.geometry.pose import Pose
    from gsp.workspace.sets.inside.regular import RegularPart
    from gsp.workspace.sets.inside.worst import Worst
    from gsp.workspace.sets.shapes.inscribed import Body, Inscribed
    from gsp.workspace.sets.shapes.polygons import Polygons

# Sums of volumes are widened by this share for rounding.
ROUNDING = 1e-12
# Name of the measure of a region, by its kind.
MEASURES = {"space": "volume", "plane": "area", "orientations": "volume"}


@dataclass(frozen=True, eq=False)
class Region:
    """A set of positions or orientations, as cells that are proven; made by `reachable` and others.

    All that is in no cell is proven to be outside.

    Attributes
    ----------
    kind : str
        "space", "plane" or "orientations".
    problem : Bounded
        Design and limits, and the axes of the plane.
    low, high : (n, d) arrays [length, or rad]
        The cells: d = 3, or 2 for a plane, along its two directions.
    codes : (n,) int8 array
        1 inside, 0 undecided.
    cuts : (n, 8) array [1, length]
        Parts of undecided cells that are proven: n, c, n, c, where n · δ ≤ c is outside and
        n · δ ≥ c is inside, δ from the middle of the cell; c is infinite for no part.
    domain : (2, d) array [length, or rad]
        Least and greatest coordinates of the box that was searched.
    levels, nodes : int
        How often the domain was halved, and how many rotation cells were decided.
    decide : function
        Decides single points (m, 3) in the axes of the problem.
    all_rotations : bool
        Whether a position is inside only with all orientations of the range, or there is only one.
    """

    kind: str
    problem: Bounded
    low: Array
    high: Array
    codes: Codes
    cuts: Array
    domain: Array
    levels: int
    nodes: int
    decide: Callable[[Array], Codes]
    all_rotations: bool

    @cached_property
    def sizes(self) -> Array:
        """Volumes or areas of the cells, shape (n,) [length³ or length²; of orientations rad³]."""
        if self.kind == "orientations":
            return turn_measure(self.low, self.high)
        return np.asarray((self.high - self.low).prod(axis=1))

    @property
    def volume(self) -> tuple[float, float]:
        """Least and greatest volume, proven [length³; of orientations rad³, at most 8π²].

        Raises InvalidInput for a region in a plane, which has an area.
        """
        if self.kind == "plane":
            raise InvalidInput(expected("region", "a region in space; this has an area", self.kind))
        return self.bracket

    @property
    def area(self) -> tuple[float, float]:
        """Least and greatest area of a region in a plane, proven [length²].

        Raises InvalidInput for any other region.
        """
        if self.kind != "plane":
            wanted = "a region in a plane; this has a volume"
            raise InvalidInput(expected("region", wanted, self.kind))
        return self.bracket

    @property
    def bracket(self) -> tuple[float, float]:
        """Least and greatest volume or area, proven [length³ or length²; of orientations rad³]."""
        low, high = self._shares
        return (
            float((self.sizes * low).sum()) * (1.0 - ROUNDING),
            float((self.sizes * high).sum()) * (1.0 + ROUNDING),
        )

    @cached_property
    def _shares(self) -> tuple[Array, Array]:
        """Shares of the cells that are inside, and that are not outside."""
        inside, outside = shares(self.low, self.high, self.cuts)
        settled = self.codes == INSIDE
        return np.where(settled, 1.0, inside), np.where(settled, 1.0, 1.0 - outside)

    @property
    def empty(self) -> bool:
        """Whether it is proven that nothing is in the set."""
        return not len(self.codes)

    def contains(self, points: ArrayLike) -> NDArray[np.int8]:
        """Return the codes of points: 1 inside, 0 undecided, −1 outside.

        Points in undecided cells are decided one by one, which leaves very few undecided.

        Parameters
        ----------
        points : (..., 3) array_like [length]
            In base axes; for a plane also (..., 2), along its directions, and points beside it are
            outside. Of orientations three angles [rad] as `Region.problem.order` says, "rpy".

        Returns
        -------
        (...) int8 array

        Raises
        ------
        InvalidInput
            On a wrong shape, or numbers that are not finite.
        """
        given = check_array("points", points, (None,))
        shape, width = given.shape[:-1], given.shape[-1]
        if width != 3 and not (width == 2 and self.kind == "plane"):
            raise InvalidInput(expected("points", "shape (..., 3)", f"shape {given.shape}"))
        flat = given.reshape(-1, width)
        local, beside = self._local(flat)
        codes = located(local, self.low, self.high, self.codes, self.domain)
        codes[beside] = OUTSIDE
        open_ = np.flatnonzero(codes == UNDECIDED)
        if open_.size:
            codes[open_] = self.decide(_padded(local[open_]))
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
            beside = np.abs(local[:, 2]) > FACE * scale
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
        low, _ = self.bracket
        open_ = np.flatnonzero(self.codes == UNDECIDED)
        slabs = (self.sizes * (self._shares[1] - self._shares[0]))[open_]
        if not slabs.sum() > 0.0:
            return Estimate(low, 0.0, 0)
        turning = self.kind == "orientations"
        points = drawn(
            self.low[open_], self.high[open_], self.cuts[open_], slabs, samples, generator, turning
        )
        codes = self.decide(_padded(points))
        share = np.where(codes == INSIDE, 1.0, np.where(codes == OUTSIDE, 0.0, 0.5))
        unsure = 0.5 * float((codes == UNDECIDED).mean())
        # With one more hit and one more miss: samples that agree do not prove the rest.
        spread = np.append(share, (0.0, 1.0)).std(ddof=1)
        error = float(spread) / np.sqrt(samples) + unsure
        size = slabs.sum()
        return Estimate(float(low + size * share.mean()), float(size * error), samples)

    @property
    def extents(self) -> tuple[Array, Array]:
        """Two boxes (2, d): one that inside cells fill to its faces, one that holds all [length].

        Coordinates of the cells: base axes, directions of the plane, or angles. The first is NaN
        if no cell is inside, and both are NaN if the region is empty.
        """
        return self._hull(self.codes == INSIDE), self._hull(self.codes >= UNDECIDED)

    def _hull(self, chosen: NDArray[np.bool_]) -> Array:
        if not chosen.any():
            return np.full((2, self.low.shape[1]), np.nan)
        return np.stack((self.low[chosen].min(axis=0), self.high[chosen].max(axis=0)))

    @property
    def centroid(self) -> Array:
        """Centroid of the cells, undecided ones with half of their weight, (3,) [length].

        In base axes; NaN if the region is empty. It is not proven. Raises InvalidInput for
        orientations, which have none.
        """
        if self.kind == "orientations":
            raise InvalidInput(expected("region", "a region of positions", self.kind))
        weight = self.sizes * np.where(self.codes == INSIDE, 1.0, 0.5)
        if not weight.sum() > 0.0:
            return np.full(3, np.nan)
        middle = weight @ (0.5 * (self.low + self.high)) / weight.sum()
        return np.asarray(self.problem.outward(_padded(middle[None])[0]))

    @cached_property
    def parts(self) -> tuple[Region, ...]:
        """The parts that are proven not to be connected, the largest first.

        Cells that touch, inside or undecided, are one part, so a part may be several in truth.
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

    def to_dataframe(self) -> pd.DataFrame:
        """Return the cells as a table: their coordinates, and "inside" or "undecided"."""
        import pandas as pd

        names = {"plane": ("u", "v"), "orientations": ("alpha", "beta", "gamma")}.get(
            self.kind, ("x", "y", "z")
        )
        columns: dict[str, Any] = {}
        for k, name in enumerate(names):
            columns[f"{name}_low"], columns[f"{name}_high"] = self.low[:, k], self.high[:, k]
        columns["status"] = np.where(self.codes == INSIDE, "inside", "undecided")
        return pd.DataFrame(columns)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the region; return the axes.

        A plane is filled, its outline bold, and what is undecided hatched; in space, and for
        orientations, the outer faces of the inside cells are drawn.

        Parameters
        ----------
        ax : matplotlib Axes or None
            Default a new figure.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        EmptyWorkspace
            If there is nothing to draw.
        InvalidInput
            If `ax` is no axes of the kind that is needed.
        MissingSoftware
            Without matplotlib.
        """
        from gsp.workspace.sets.shapes.drawing import draw

        return draw(self, ax)

    def polygons(self) -> Polygons:
        """Return the outline of a region in a plane, with its holes.

        Returns
        -------
        Polygons [length]
            `inside`, what is proven inside, and `possible`, what is not proven outside: shapes of
            the package shapely, in coordinates along the two directions of the plane.

        Raises
        ------
        InvalidInput
            For a region that is not in a plane.
        MissingSoftware
            Without shapely.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> plane = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
        >>> region = gsp.workspace.fixed_orientation(d, plane=plane, resolution=0.5)
        >>> shape = region.polygons().inside
        >>> bool(0.9 < shape.area / region.area[0] < 1.1), len(shape.geoms)
        (True, 2)
        """
        from gsp.workspace.sets.shapes.polygons import polygons

        if self.kind != "plane":
            raise InvalidInput(expected("region", "a region in a plane", self.kind))
        return polygons(self)

    def mesh(self) -> Trimesh:
        """Return the surface of what is proven inside: the outer faces of the inside cells.

        Returns
        -------
        trimesh.Trimesh [length; of orientations rad]
            Closed, in base axes.

        Raises
        ------
        InvalidInput
            For a region in a plane.
        MissingSoftware
            Without trimesh.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=1.0)
        >>> bool(abs(region.mesh().volume / region.sizes[region.codes == 1].sum() - 1) < 1e-9)
        True
        """
        from gsp.workspace.sets.shapes.meshes import mesh

        if self.kind == "plane":
            raise InvalidInput(expected("region", "a region in space", self.kind))
        return mesh(self)

    def write(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the region to a file.

        Parameters
        ----------
        path : path
            In a plane .svg or .dxf: the outlines of what is proven inside and of what is possible,
            in the unit of the design. In space .stl, .obj, .ply or .glb: the surface of what is
            proven inside. For all, the cells as a table: .csv, .parquet, .xlsx, .md or .tex.
        overwrite : bool
            Whether a file that exists may be replaced.

        Raises
        ------
        EmptyWorkspace
            If nothing is proven inside, but for tables.
        MissingSoftware
            Without shapely, ezdxf or trimesh: the extra "shapes".
        UnwritableOutput
            If the suffix is unknown, the file exists, or the folder cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=1.0)
        >>> region.write(Path(tempfile.mkdtemp(), "region.stl"))
        """
        from gsp.workspace.sets.shapes.files import write

        write(self, path, overwrite=overwrite)

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
            Relative gap to the largest body in the cells at which the search ends.

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
        >>> region = gsp.workspace.fixed_orientation(d, resolution=0.5)
        >>> found = region.largest("cylinder")
        >>> region.contains(found.centre), bool(found.factor < found.above)
        (array(1, dtype=int8), True)
        """
        from gsp.workspace.sets.shapes.inscribed import largest

        return largest(self, body, proportions, tolerance)

    def poses(self, count: int = 1000, *, rng: np.random.Generator | int = 0) -> Pose:
        """Return feasible poses of a region of positions, evenly distributed.

        Positions are even by volume and orientations by the measure of the rotations over the
        range, so shares and means over them are shares and means of the poses: for instance the
        share with λ ≥ 0.5, or the mean of 1/κ (the global conditioning index).

        Parameters
        ----------
        count : int
        rng : numpy.random.Generator or int
            Generator or seed.

        Returns
        -------
        Pose of shape (count,)

        Raises
        ------
        EmptyWorkspace
            If fewer are found among 2000 draws for each.
        InvalidInput
            For orientations, or on another number or generator.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=1.0)
        >>> table = gsp.evaluate(d, region.poses(200), "CDN_CL", length=1.0)
        >>> bool(0.0 < (1.0 / table["condition_number"]).mean() < 1.0)
        True
        """
        from gsp.workspace.sets.inside.poses import poses

        return poses(self, count, rng)

    def worst(
        self,
        index: str,
        tolerance: float = 0.05,
        *,
        length: float | None = None,
        ellipsoid: Ellipsoid | None = None,
        maximum: float | None = None,
        budget: int = 100_000,
    ) -> Worst:
        """Return the worst value of an index over the region, with a proven bound.

        Parameters
        ----------
        index : str
            Name or symbol of CDN_CL, σ_min, |det J|, λ, CDN_OE or CTN.
        tolerance : float [1]
            Relative gap of value and bound at which the search ends.
        length : float or None [unit of the design]
            Characteristic length; default that of the design.
        ellipsoid : Ellipsoid or None
            For CDN_OE; default that of the design.
        maximum : float or None [unit of |det J|]
            For λ; default `gsp.determinant.reference(design).value`.
        budget : int
            Most boxes of the search.

        Returns
        -------
        Worst [of the index]
            The greatest value, or the least one of an index that is better if greater.

        Raises
        ------
        EmptyWorkspace
            If no cell is inside.
        InvalidInput
            For a region whose positions need only one of several orientations.
        UnknownIndex
            For an index that has no bounds over boxes.
        MissingParameter
            If the index needs a length or an ellipsoid and there is none.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> above = gsp.Limits(position=[None, None, (5, None)])
        >>> region = gsp.workspace.fixed_orientation(d, limits=above, resolution=1.0)
        >>> found = region.worst("σ_min", length=1.0, budget=2000)
        >>> bool(0.0 <= found.bound <= found.value)
        True
        """
        from gsp.workspace.sets.inside.worst import worst

        return worst(self, index, tolerance, length, ellipsoid, maximum, budget)

    def regular_parts(self, budget: int = 50_000) -> tuple[RegularPart, ...]:
        """Return parts of the region that the platform crosses without a singular pose, proven.

        A part consists of inside cells that touch and in which every pose is regular. det J has
        one sign on a part. Two parts of different signs are separated by singular poses; two of
        the same sign need not be.

        Parameters
        ----------
        budget : int
            Most boxes of poses to bound.

        Returns
        -------
        tuple of RegularPart
            The largest first; empty if nothing is proven.

        Raises
        ------
        InvalidInput
            For a region whose positions need only one of several orientations.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=1.0)
        >>> [part.sign for part in region.regular_parts()[:2]]
        [1, -1]
        """
        from gsp.workspace.sets.inside.regular import regular_parts

        return regular_parts(self, budget)

    def __repr__(self) -> str:
        low, high = self.bracket
        return f"Region({self.kind}, {MEASURES[self.kind]} in [{low:.6g}, {high:.6g}])"


def region_of(
    kind: str,
    problem: Bounded,
    leaves: Leaves,
    domain: Array,
    decide: Callable[[Array], Codes],
    *,
    all_rotations: bool = False,
) -> Region:
    """Return the region of the leaves of a tree."""
    d = 2 if kind == "plane" else 3
    return Region(
        kind,
        problem,
        leaves.low[:, :d],
        leaves.high[:, :d],
        leaves.codes,
        leaves.cuts,
        domain[:, :d],
        leaves.levels,
        leaves.nodes,
        decide,
        all_rotations,
    )


def _padded(points: Array) -> Array:
    """Points (n, 3) from (n, 2): in the plane."""
    return np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
