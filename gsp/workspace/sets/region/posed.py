"""The poses inside of a region: drawn evenly, their indices, and parts without singular poses."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gsp.workspace.sets.region.shaped import Shaped

if TYPE_CHECKING:
    from gsp.geometry.ellipsoid import Ellipsoid
    from gsp.geometry.pose import Pose
    from gsp.progress import Progress
    from gsp.workspace.sets.inside.regular import RegularPart
    from gsp.workspace.sets.inside.samples import IndexSample
    from gsp.workspace.sets.inside.worst import Worst


@dataclass(frozen=True, eq=False)
class Posed(Shaped):
    """Proven cells of a set, with the poses inside."""

    def poses(self, count: int = 1000, *, rng: np.random.Generator | int = 0) -> Pose:
        """Return feasible poses of a region, independent and evenly distributed.

        Positions are even by volume and orientations by the measure of the rotations over the
        range, so shares and means over them are shares and means of the poses: see `index_sample`.
        Positions of a region of `dextrous` that stay undecided are left out.

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
            On another number or generator.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=2.0)
        >>> bool(gsp.feasible(d, region.poses(200)).ok.all())
        True
        """
        from gsp.workspace.sets.inside.poses import poses

        return poses(self, count, rng)

    def index_sample(
        self,
        indices: Iterable[str] | str | None = None,
        count: int = 1000,
        *,
        length: float | None = None,
        ellipsoid: Ellipsoid | None = None,
        maximum: float | None = None,
        rng: np.random.Generator | int = 0,
        progress: Progress = None,
    ) -> IndexSample:
        """Return indices at poses of the region, for their means and shares over it.

        Parameters
        ----------
        indices : str, iterable of str or None
            Names or symbols; default the routine ones whose parameters are there.
        count : int
            Number of poses, drawn as `poses` does.
        length : float or None [unit of the design]
            Characteristic length; default that of the design.
        ellipsoid : Ellipsoid or None
            Operation ellipsoid; default that of the design.
        maximum : float or None [unit of |det J|]
            For λ; default `gsp.determinant.reference(design).value`.
        rng : numpy.random.Generator or int
            Generator or seed.
        progress : function (done, total), bool or None
            See `gsp.evaluate`.

        Returns
        -------
        IndexSample

        Raises
        ------
        EmptyWorkspace
            If fewer poses are found among 2000 draws for each.
        UnknownIndex, MissingParameter, InvalidInput
            As of `gsp.evaluate`, and on another number or generator.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=2.0)
        >>> sample = region.index_sample("CDN_CL", 500, length=1.0)
        >>> share = sample.share_where("CDN_CL <= 8.5")
        >>> bool(0.0 < share.value < 1.0), share.samples
        (True, 500)
        >>> bool(0.0 < sample.summary().loc["condition_number", "global"] < 1.0)
        True
        """
        from gsp.workspace.sets.inside.samples import index_sample

        given = {"length": length, "ellipsoid": ellipsoid, "maximum": maximum}
        return index_sample(self, indices, count, given, rng, progress)

    def worst(
        self,
        index: str,
        tolerance: float = 0.05,
        *,
        length: float | None = None,
        ellipsoid: Ellipsoid | None = None,
        maximum: float | None = None,
        budget: int = 100_000,
        progress: Progress = None,
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
            Most boxes of the search, besides those of the cells.
        progress : function (done, total), bool or None
            Called with the number of boxes done, and `budget`. False: no output; else a bar.

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
        >>> region = gsp.workspace.fixed_orientation(d, limits=above, resolution=2.0)
        >>> found = region.worst("σ_min", length=1.0, budget=2000)
        >>> bool(0.0 <= found.bound <= found.value)
        True
        """
        from gsp.workspace.sets.inside.worst import worst

        return worst(self, index, tolerance, length, ellipsoid, maximum, budget, progress)

    def regular_parts(
        self, budget: int = 50_000, *, progress: Progress = None
    ) -> tuple[RegularPart, ...]:
        """Return sets of poses that the platform crosses without a singular pose, proven.

        A part consists of boxes of poses that touch, in which every pose is feasible and regular:
        from each pose of a part the platform reaches every other one without crossing a
        singularity or a limit. det J has one sign on a part. Two parts of different signs are
        separated by singular poses; two of the same sign need not be.

        In a region of `fixed_orientation`, `dextrous` or `orientations` they are made of the
        inside cells. In one of `reachable` they are sought among all poses, positions with
        orientations: so a greater budget proves more, and finds parts connected that were apart.

        Parameters
        ----------
        budget : int
            Most boxes of poses to bound.
        progress : function (done, total), bool or None
            Called with the number of boxes done, and `budget`. False: no output; else a bar.

        Returns
        -------
        tuple of RegularPart
            The largest first; empty if nothing is proven.

        Raises
        ------
        InvalidInput
            On another budget or progress.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> region = gsp.workspace.fixed_orientation(d, resolution=2.0)
        >>> sorted(part.sign for part in region.regular_parts()[:2])
        [-1, 1]
        """
        from gsp.workspace.sets.inside.regular import regular_parts

        return regular_parts(self, budget, progress)
