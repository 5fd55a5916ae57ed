"""Indices over a workspace: maps on grids, global indices, singularity-free parts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from gsp.checks import check_type
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.evaluation.evaluations import evaluate
from gsp.geometry.copies import ReadOnly, kept_property
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.matrices import determinant_sign
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.pose.intervals import middle_measure
from gsp.geometry.rotations import moving_places
from gsp.geometry.vectors import Array, Mask, frozen
from gsp.limits.feasibility import feasible
from gsp.limits.limits import Limits
from gsp.model.design import Design
from gsp.progress import Progress
from gsp.workspace.sets.inside.summaries import index_summary, satisfied

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False)
class IndexMap(ReadOnly):
    """Indices on a grid of poses.

    Attributes
    ----------
    design : Design
    box : PoseBox
    pose : Pose of the batch shape of the grid, (n1, …, n6)
    feasible : (...) bool array of the shape of the grid
    values : mapping from index name to (...) array of the shape of the grid [unit of the index]
        NaN where a pose is not feasible, or the index is not defined.
    """

    design: Design
    box: PoseBox
    pose: Pose
    feasible: Mask
    values: dict[str, Array]

    @kept_property
    def weight(self) -> Array:
        """Share of the box that each pose stands for: of those poses that are nearest to it [1].

        Of the shape of the grid, with the sum 1. The measure is that of `Region.poses`: volume
        times the invariant (Haar) measure of the rotations. So a mean over a region and one over
        a grid of the same poses are the same mean, whatever the angles are.

        *Source: ours; see docs/sets.md*
        """
        ends = zip(self.box.low, self.box.high, self.pose.shape, strict=True)
        middle = 3 + moving_places(self.box.order)[1]
        parts = [
            _shares(low, high, n, self.box.order if axis == middle else None)
            for axis, (low, high, n) in enumerate(ends)
        ]
        return frozen(math.prod(np.ix_(*parts)))

    @property
    def share(self) -> float:
        """Share of the box that is feasible, by the weights of the poses, from 0 to 1 [1].

        *Source: ours*
        """
        return min(float(self.weight[self.feasible].sum()), 1.0)  # sums are rounded

    def summary(self) -> pd.DataFrame:
        """Return global indices: one row per index, over the feasible poses where it is defined.

        Columns: mean, min, max, worst, std, uniformity (least over greatest value, 1 for an
        index that does not vary), global (the mean of the reciprocal for indices of which less is
        better and 1 is best, as the global conditioning index of the condition number; else the
        mean), undefined (share of the feasible poses).

        Means are those of the feasible poses with `weight`: uniform over positions and, by the
        invariant measure, over orientations, as the poses of `Region.poses` are. *Source: the five
        papers average over poses (TozKucuk2016, §4.3); the reciprocal mean is the usual global
        conditioning index.*
        """
        import pandas as pd

        weight = self.weight[self.feasible]
        rows = {n: index_summary(n, v[self.feasible], weight) for n, v in self.values.items()}
        return pd.DataFrame.from_dict(rows, orient="index")

    def share_where(self, bound: str) -> float:
        """Return the share of the feasible poses where an index satisfies a bound, 0 to 1 [1].

        By `weight`; poses where the index is undefined do not satisfy it.

        Parameters
        ----------
        bound : str
            An index of the map, by name or symbol, and a bound: "λ >= 0.3", "CDN_CL <= 20".

        Raises
        ------
        InvalidInput
            On another text, or an index that the map does not have.
        UnknownIndex
            If the text names no index.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> box = gsp.PoseBox([(-3, 3), 0, (4, 12)], [0, 0, 0])
        >>> found = index_map(d, box, (5, 1, 9, 1, 1, 1), ["CDN_CL"], length=1.0)
        >>> found.share_where("CDN_CL <= 1e9"), found.share_where("CDN_CL <= 1")
        (1.0, 0.0)

        *Source: ours*
        """
        hits, weight = satisfied(self.values, bound), self.weight[self.feasible]
        return min(float(weight @ hits[self.feasible] / weight.sum()), 1.0)

    def singularity_free(self, home: Pose | None = None) -> Mask:
        """Return the part of the grid that can be reached from a pose without a singularity.

        Feasible nodes with det J of the sign that it has at the home pose, connected with the
        node nearest to it along the axes of the grid. Poses between the nodes are not checked: a
        singular set or a passage thinner than the grid is not found.

        Parameters
        ----------
        home : Pose of batch shape (), a single pose, or None
            Default the home pose of the design.

        Returns
        -------
        (...) bool array of the shape of the grid

        Raises
        ------
        EmptyWorkspace
            If the node nearest to the home pose is not feasible, or is singular
            (`Posture.singular`).
        InvalidInput
            Without a single home pose, or if the design does not have six actuators.

        *Source: ours*
        """
        if home is not None:
            check_type("home", home, Pose)
        pose = self.design.home if home is None else home
        if pose is None or pose.shape:
            raise InvalidInput(expected("home", "a single pose", pose))
        if len(self.design.joint_names) != 6:
            raise InvalidInput(expected("design", "six actuators", len(self.design.joint_names)))
        flat = self.pose.reshape(self.pose.size)
        signs = determinant_sign(self.design.at(flat).about_centre).reshape(self.pose.shape)
        from scipy import ndimage

        node = self._nearest(pose)
        if not (self.feasible[node] and abs(signs[node]) == 1.0):
            wanted = "a pose whose nearest node is feasible and regular"
            raise EmptyWorkspace(expected("home", wanted, self._fault(node)))
        parts, _ = ndimage.label(self.feasible & (signs == signs[node]))
        return np.asarray(parts == parts[node])

    def _fault(self, node: tuple[int, ...]) -> str:
        """Return what is wrong with a node that is infeasible, singular or undefined."""
        if self.feasible[node]:
            posture = self.design.at(self.pose[node])
            return "an undefined one" if posture.undefined else "a singular one"
        strokes = self.design.strokes
        if strokes is None or not np.isfinite(strokes).any():
            return "an infeasible one"
        return feasible(self.design, self.pose[node]).reason or "an infeasible one"

    def _nearest(self, pose: Pose) -> tuple[int, ...]:
        values = np.concatenate((pose.position, pose.angles(self.box.order)))
        place = []
        for low, high, n, value in zip(
            self.box.low, self.box.high, self.pose.shape, values, strict=True
        ):
            step = (high - low) / (n - 1) if n > 1 else 1.0
            share = (value - low) / step if n > 1 and step > 0.0 else 0.0
            place.append(int(np.clip(np.rint(share), 0, n - 1)))
        return tuple(place)


def cell_edges(low: float, high: float, number: int) -> Array:
    """Return the ends of the parts of an interval nearest to equally spaced points: (number + 1,).

    The points include both ends of the interval, whose parts are half as long as the others.
    """
    nodes = np.linspace(low, high, number)
    return np.concatenate(([low], 0.5 * (nodes[1:] + nodes[:-1]), [high]))


def _shares(low: float, high: float, number: int, order: str | None) -> Array:
    """Shares of an interval that are nearest to each of its equally spaced points: (number,).

    By the measure of the middle angle of an angle set, where its name is given.
    """
    edges = cell_edges(low, high, number)
    size = np.diff(edges) if order is None else middle_measure(edges[:-1], edges[1:], order)
    total = float(size.sum())
    return size / total if number > 1 and total > 0.0 else np.full(number, 1.0 / number)


def index_map(
    design: Design,
    box: PoseBox,
    counts: int | Sequence[int],
    indices: Iterable[str] | None = None,
    *,
    limits: Limits | None = None,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | Literal["sample"] | None = None,
    backend: Literal["compiled", "numpy"] = "compiled",
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
) -> IndexMap:
    """Evaluate indices at the feasible poses of a grid.

    Parameters
    ----------
    design : Design
    box : PoseBox
    counts : one or six integers ≥ 1
        As in `PoseBox.grid`.
    indices : iterable of str or None
        Names; default all whose parameters are given.
    limits : Limits or None
        Default: the strokes of the design.
    length : float or None [unit of the design]
    ellipsoid : Ellipsoid or None
    maximum : float, "sample" or None [unit of |det J|]
        Parameters of the indices: see `gsp.evaluate`.
    backend : "compiled" or "numpy"
    workers : int or None
    executor : concurrent.futures.Executor or None
    progress : function (done, total), bool or None
        How they are computed: see `gsp.evaluate`.

    Returns
    -------
    IndexMap

    Raises
    ------
    EmptyWorkspace
        If no pose of the grid is feasible.
    MissingParameter
        If nothing limits the design, or an index misses a parameter.
    InvalidInput
        On arguments of other types or shapes.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> box = gsp.PoseBox([(-3, 3), (-3, 3), 8.0], [0, 0, 0])
    >>> found = index_map(d, box, (5, 5, 1, 1, 1, 1), ["condition_number"], length=7.5)
    >>> round(found.share, 2)
    1.0
    """
    check_type("box", box, PoseBox)
    pose = box.grid(counts)
    inside = feasible(design, pose, limits).ok
    if not inside.any():
        raise EmptyWorkspace(
            f"grid of {pose.size} poses: expected at least one feasible pose, received none"
        )
    flat = np.flatnonzero(inside.ravel())
    frame = evaluate(
        design,
        pose.reshape(pose.size)[flat],
        indices,
        length=length,
        ellipsoid=ellipsoid,
        maximum=maximum,
        backend=backend,
        workers=workers,
        executor=executor,
        progress=progress,
    )
    values = {}
    for name in frame.columns:
        column = np.full(pose.size, np.nan)
        column[flat] = frame[name].to_numpy()
        values[str(name)] = column.reshape(pose.shape)
    return IndexMap(design, box, pose, inside, values)
