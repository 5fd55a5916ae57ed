"""Labelled curves on the boundary of a region in a plane, and the cells that none passes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp import arguments
from gsp.checks import check_integer, check_rng, check_type
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, Mask
from gsp.limits.bounds import bounded_quantities
from gsp.progress import Progress, Steps, meter
from gsp.workspace.boundary.climb import CLIMB_STEPS
from gsp.workspace.boundary.critical import Chart
from gsp.workspace.boundary.mapping import section_of
from gsp.workspace.boundary.network import CURVE_STEPS, MOST_CURVES, Network, everywhere
from gsp.workspace.boundary.rays import RayEnds, ray_ends
from gsp.workspace.boundary.sections import Section
from gsp.workspace.boundary.tracing import Tracer
from gsp.workspace.passed_cells import PassedCells
from gsp.workspace.seeds import Seeds
from gsp.workspace.sets.codes import UNDECIDED
from gsp.workspace.sets.region.regions import Region

# Cells in which rays are climbed at the same time; the curves of some pass most of the others.
CELLS_PER_ROUND = 24


@dataclass(frozen=True, eq=False, kw_only=True)
class LabelledBoundary(ReadOnly):
    """Labelled curves on the boundary of a region in a plane.

    Attributes
    ----------
    region : Region
    section : Section
        The curves with their labels, and bifurcation points.
    outer : tuple of (N,) bool arrays
        For each curve which of its points are on the boundary of the region: local maxima in
        undecided cells, and a point just beyond them is not inside. Elsewhere the curve goes on
        inside of the region.
    unlabelled : (n,) bool array
        For each cell of the region whether it is undecided and no curve passes it there.
    missed : (n,) bool array
        Which of the unlabelled cells the boundary is proven to pass. In the others it may or may
        not.
    """

    region: Region
    section: Section
    outer: tuple[Mask, ...]
    unlabelled: Mask
    missed: Mask

    @property
    def waiting(self) -> int:
        """Number of curves that are not followed: that of the section.

        Curves that are followed in part have the status "budget".

        *Source: ours*
        """
        return self.section.waiting

    @property
    def stopped_by(self) -> str | None:
        """What ended the search while cells or curves were left: "most", "budget", or None.

        *Source: ours*
        """
        return self.section.stopped_by

    @property
    def incomplete(self) -> tuple[int, ...]:
        """Numbers of the curves that were lost, or that the budget ended.

        *Source: ours*
        """
        ended = ("lost", "budget")
        return tuple(i for i, c in enumerate(self.section.curves) if c.status in ended)

    @property
    def labelled(self) -> float:
        """Share of the cells with a curve among these and the missed ones [1]; NaN without any.

        *Source: ours*
        """
        passed = int(((self.region.codes == UNDECIDED) & ~self.unlabelled).sum())
        known = passed + int(self.missed.sum())
        return passed / known if known else float("nan")


@arguments.validated(connecting=arguments.flag, interior=arguments.flag)
def boundary_curves(
    region: Region,
    *,
    interior: bool = False,
    connecting: bool = False,
    most: int = MOST_CURVES,
    budget: int = CURVE_STEPS,
    rng: np.random.Generator | int = 0,
    progress: Progress = None,
) -> LabelledBoundary:
    """Return labelled curves on the boundary of a region, sought in each of its undecided cells.

    In a cell that no curve passes yet, a ray is climbed from a feasible pose toward a point that
    is not feasible. The curve through its end is followed both ways, and so are those that leave
    the bifurcation points on the boundary. Then the next cells are chosen, until none is left.
    Curves end at the border of a `half_space`. So the curves are those of all families of
    orientations that bound the region, and cells without one are known.

    Parameters
    ----------
    region : Region
        In a plane: of `reachable` without a range of rotations, or of `fixed_orientation`. With a
        range the boundary may have angles at the ends of it, which no label names.
    interior : bool
        Whether to follow the curves that leave bifurcation points inside of the region as well:
        there a family of orientations ends, and another one reaches farther.
    connecting : bool
        Whether to follow the curves between complete bifurcation points as well.
    most : int
        Greatest number of curves; see `LabelledBoundary.stopped_by`.
    budget : int
        Greatest number of steps along curves, also of those that are repeated with half of the
        length: about 3 ms each where strokes of SPS legs are the limits, up to a second where an
        index is. What is not followed then is stated in `waiting` and in the status of the curves.
    rng : numpy.random.Generator or int
        Generator or seed. Poses are drawn only where there are other limits than strokes of SPS
        legs, and more than one orientation.
    progress : function (done, known so far), bool or None
        As in `section`.

    Returns
    -------
    LabelledBoundary

    Raises
    ------
    EmptyWorkspace
        If the region is empty.
    InvalidInput
        For another region, and on arguments of other types or ranges.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> plane = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
    >>> region = gsp.workspace.fixed_orientation(d, plane=plane, resolution=0.5)
    >>> int(gsp.workspace.boundary_curves(region).missed.sum())
    0

    *Source: ours; the labels are those of Workspace-3, §3.4*
    """
    turns = _free_turns(region)
    number, generator = check_integer("most", most), check_rng("rng", rng)
    steps_left = check_integer("budget", budget)
    problem = region.problem
    bounds = bounded_quantities(problem.design, problem.limits)
    with meter(progress, "boundary") as report:
        chart = Chart(bounds, problem.frame[:2], turns)
        steps = Steps(report, ahead=CLIMB_STEPS)
        cells = PassedCells(region, Seeds.of(region, bounds, generator))
        tracer = Tracer(chart, _faces(region))
        wanted = everywhere if interior else cells.undecided_at
        network = Network(tracer, number, steps, wanted, steps_left)
        ends = _search(network, cells)
        if connecting:
            network.connect()
        section = section_of(network, problem.origin, ends)
        outer = [*cells.outer]
        outer += [np.zeros(len(c.weight), dtype=bool) for c in section.curves[len(outer) :]]
    unlabelled = (region.codes == UNDECIDED) & ~cells.passed
    missed = unlabelled.copy()
    missed[unlabelled] = cells.seeds.crossed(np.flatnonzero(unlabelled))
    return LabelledBoundary(
        region=region,
        section=section,
        outer=tuple(_kept(mask) for mask in outer),
        unlabelled=_kept(unlabelled),
        missed=_kept(missed),
    )


def _search(network: Network, cells: PassedCells) -> RayEnds:
    """Follow curves from cells that none passes, some at a time; return the ray ends."""
    chart = network.tracer.chart
    waiting = cells.region.codes == UNDECIDED
    nothing = np.zeros((0, 3))
    found = [ray_ends(chart.bounds, chart.turns, nothing, np.zeros((0, 3, 3)), nothing)]
    while waiting.any():
        left = np.flatnonzero(waiting)
        some = left[:: -(-len(left) // CELLS_PER_ROUND)]
        waiting[some] = False
        rays = cells.seeds.across(some)
        if not len(rays.cell) or network.stops():
            continue
        ends = ray_ends(chart.bounds, chart.turns, *rays[:3], network.steps)
        found.append(ends)
        for i in np.flatnonzero(ends.maximal):
            if not cells.passed[rays.cell[i]]:
                cells.passed[rays.cell[i]] = network.add_seed(*ends.seed(int(i)))
                for number in range(len(cells.outer), len(network.branches)):
                    branch = cells.pass_along(network.tracer, network.branches[number])
                    network.branches[number] = branch
        waiting &= ~cells.passed
    return RayEnds.joined(found)


def _faces(region: Region) -> Array:
    """Half-spaces (f, 4) of a region in base axes."""
    problem = region.problem
    normal = problem.side[:, :3] @ problem.frame
    level = problem.side[:, 3] + normal @ problem.origin
    return np.concatenate((normal, level[:, None]), axis=1)


def _kept(mask: Mask) -> Mask:
    """Return a mask that cannot be written."""
    mask.flags.writeable = False
    return mask


def _free_turns(region: Any) -> Array:
    """Axes of the turns that are free: all, or none of a fixed orientation."""
    check_type("region", region, Region)
    if region.kind != "plane":
        raise InvalidInput(expected("region", "a region in a plane", region.kind))
    if region.empty:
        raise EmptyWorkspace(expected("region", "a cell or more", "an empty region"))
    if region.problem.single_rotation:
        return np.zeros((0, 3))
    if region.all_rotations or not region.problem.free:
        wanted = "a region of any orientation, or of one, as labels name no ends of angles"
        raise InvalidInput(expected("region", wanted, "one of a range of rotations"))
    return np.eye(3)
