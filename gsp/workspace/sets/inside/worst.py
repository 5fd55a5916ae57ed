"""The worst value of an index over a region, proven."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.checks import check_integer, check_positive
from gsp.errors import EmptyWorkspace, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import moving_places, rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.indices import INDICES, index_name
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.progress import Progress, Report, meter
from gsp.proof.branching.claims import value_at
from gsp.proof.branching.requirements import with_maximum
from gsp.proof.extremes import bounded_name, extreme, index_problem, is_closed
from gsp.workspace.sets.codes import INSIDE, OUTSIDE
from gsp.workspace.sets.inside.patches import patches
from gsp.workspace.sets.tree.cuts import boxes_beyond
from gsp.workspace.sets.tree.verdicts import verdicts

# The index that is σ_min of the homogeneous Jacobian; what rounding of a power may add to it.
SMALLEST, POWER_ROUNDING = index_name("σ_min"), 1e-14


@dataclass(frozen=True, eq=False, kw_only=True)
class Worst(ReadOnly):
    """The worst value of an index over a region; made by `gsp.workspace.Region.worst`.

    Attributes
    ----------
    value : float [of the index]
        Of a pose in the region.
    bound : float [of the index]
        No pose of the region is worse, proven: the poses of undecided cells count.
    pose : Pose of shape ()
        Where `value` occurs.
    closed : bool
        Whether value and bound are within the tolerance.
    """

    value: float
    bound: float
    pose: Pose
    closed: bool


def worst(
    region: Any,
    index: str,
    tolerance: float,
    length: float | None,
    ellipsoid: Ellipsoid | None,
    maximum: float | None,
    budget: int,
    progress: Progress,
) -> Worst:
    """Return the worst value of an index over a region: see `gsp.workspace.Region.worst`."""
    name, share = bounded_name(index), check_positive("tolerance", tolerance)
    most = check_integer("budget", budget, 1)
    boxes = _possible(region, patches(region))
    if not (region.codes == INSIDE).any():
        raise EmptyWorkspace(expected("region", "a whole cell that is proven inside", "none"))
    # That of the design itself: in the frame of the region it has no home pose.
    design = region.problem.design
    limits = with_maximum(design, Limits(indices=f"{name} >= 1", maximum=maximum))
    given = {"length": length, "ellipsoid": ellipsoid, "maximum": limits.maximum}
    side = 1.0 if INDICES[name].better == "lower" else -1.0
    turns = region.problem.turns.flatten()

    # Undecided cells count for the bound, except for their halves that are proven infeasible.
    def keep(boxes: Array) -> Array:
        p, q = boxes[:, :3], boxes[:, 6:9]
        rotations = np.concatenate((boxes[:, 3:6], boxes[:, 9:]), axis=1)
        return np.asarray(verdicts(region.problem, p, q, rotations) != OUTSIDE)

    # Only a pose that is proven to be in the region gives a value that occurs there.
    def counts(points: Array) -> Array:
        return np.asarray(region._decide(_coordinates(region, points)) == INSIDE)

    def search(quantity: str, options: dict[str, Any], report: Report) -> tuple[float, Pose]:
        problem, place, factor = index_problem(region.problem.design_in_frame, quantity, options)
        end = extreme(
            problem, turns, boxes, place, side, share, most + len(boxes), report=report,
            keep=keep, counts=counts,
        )  # fmt: skip
        return end.bound / factor, _pose(region.problem, end.point)

    with meter(progress, "boxes") as report:
        bound, pose = search(name, given, report)
        value = value_at(design, pose, name, given)
        # All indices are worst at singular poses, which the search for the least σ_min finds.
        if name != SMALLEST and not is_closed(bound, value, share):
            scale = length or design.characteristic_length or design.rms_radius
            least, other = search(SMALLEST, {**given, "length": scale}, report)
            if INDICES[name].of_determinant:
                bound = max(bound, _determinant_from(least, scale, design, limits.maximum, name))
            if side * (there := value_at(design, other, name, given)) > side * value:
                value, pose = there, other
    return Worst(value=value, bound=bound, pose=pose, closed=is_closed(bound, value, share))


def _determinant_from(
    least: float, length: float, design: Design, maximum: float | None, name: str
) -> float:
    """Return what |det J|, or λ, is not below where σ_min is not below `least`.

    |det J| = L^(3 − a) σ_1 … σ_6 ≥ L^(3 − a) σ_min⁶, where a counts angular actuators.

    *Source: Golub and Van Loan, Matrix Computations, §2.4, for the product; the bound is ours*
    """
    power = 3 - sum(design.angular)
    product = length**power * least**6 * (1.0 - POWER_ROUNDING)
    return product / (maximum or 1.0) if INDICES[name].share_of else product


def _possible(region: Any, boxes: Array) -> Array:
    """Return the boxes of poses without what the cuts of their cells prove to be outside."""
    if region.kind == "orientations":
        return boxes
    d = region.low.shape[1]
    low, high = boxes_beyond(region.low, region.high, region.cuts[:, :4])
    boxes[:, :d], boxes[:, 6 : 6 + d] = low, high
    return np.asarray(boxes[((high > low) | (region.high == region.low)).all(axis=1)])


def _coordinates(region: Any, points: Array) -> Array:
    """Coordinates of poses (n, 6) as the region decides them: (n, 3)."""
    result, d = np.zeros((len(points), 3)), region.low.shape[1]
    if region.kind == "orientations":
        result[:, moving_places(region.problem.order)] = points[:, 3:]
    else:
        result[:, :d] = points[:, :d]
    return result


def _pose(problem: Any, point: Array) -> Pose:
    angles = np.empty(3)
    angles[moving_places(problem.order)] = point[3:]
    return Pose(problem.outward(point[:3]), rotation_from_angles(angles, problem.order))
