"""Sets of poses that the platform crosses without a limit or a singular pose, proven."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.checks import check_integer, check_type
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import angles_from_rotation, moving_places
from gsp.geometry.vectors import Array, Mask
from gsp.limits import Limits
from gsp.progress import Progress, Report, meter
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import problem_of
from gsp.proof.extremes import halved
from gsp.variation.layout import LOW, PARTS
from gsp.workspace.sets.codes import INSIDE, OUTSIDE, UNDECIDED, Codes
from gsp.workspace.sets.inside.patches import patches
from gsp.workspace.sets.problem import Bounded
from gsp.workspace.sets.tree.boxes import components, located
from gsp.workspace.sets.tree.cells import first_cells
from gsp.workspace.sets.tree.verdicts import verdicts

# Angles that are less than this beyond a box count as in it [rad], as do positions beyond it by
# this share of their size: the rounding of poses.
POSE_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False, kw_only=True)
class RegularPart(ReadOnly):
    """Boxes of poses that are connected, feasible and regular; see `Region.regular_parts`.

    Attributes
    ----------
    low, high : (n, 6) arrays [length, rad]
        The boxes: positions in base axes or along the directions of the plane (the third is 0),
        and angles about moving axes.
    sign : int [1]
        The sign of det J, 0 for redundant designs.
    size : float [length³ or length²; times rad for each angle with a range]
        Product of the widths that are not 0, summed over the boxes: for one orientation the volume
        or the area.
    origin, frame : (3,) and (3, 3) arrays [length, 1]
        Origin and axes (rows) of the positions, in base axes.
    order : str
        The angle set; `low` and `high` have its angles in the order of moving axes.
    """

    low: Array
    high: Array
    sign: int
    size: float
    origin: Array
    frame: Array
    order: str

    def contains(self, pose: Pose) -> Mask:
        """Return which poses are in a box of the part.

        From one such pose the platform reaches every other one without crossing a singularity or a
        limit: for instance another assembly mode. Poses that are in no box are not decided.

        Parameters
        ----------
        pose : Pose of shape (...)

        Returns
        -------
        (...) bool array

        Raises
        ------
        InvalidInput
            If it is not a pose.

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("workspace-6-3")
        >>> parts = gsp.workspace.fixed_orientation(d, resolution=2.0).regular_parts()
        >>> sum(bool(part.contains(d.home)) for part in parts)
        1

        *Source: ours; see docs/sets.md*
        """
        check_type("pose", pose, Pose)
        place = ((pose.position - self.origin) @ self.frame.T).reshape(-1, 3)
        angles = angles_from_rotation(pose.rotation, self.order)[..., moving_places(self.order)]
        found = [self._holds(*at) for at in zip(place, angles.reshape(-1, 3), strict=True)]
        return np.array(found, dtype=bool).reshape(pose.shape)

    def _holds(self, place: Array, angles: Array) -> bool:
        slack = POSE_ROUNDING * (1.0 + np.abs(place).max())
        here = (self.low[:, :3] - slack <= place) & (place <= self.high[:, :3] + slack)
        wide = self.high[:, 3:] - self.low[:, 3:] + 2.0 * POSE_ROUNDING
        beyond = np.mod(angles - self.low[:, 3:] + POSE_ROUNDING, 2.0 * np.pi)
        return bool((here.all(axis=1) & (beyond <= wide).all(axis=1)).any())


def regular_parts(region: Any, budget: int, progress: Progress = None) -> tuple[RegularPart, ...]:
    """Return the parts of a region without a singular pose: see `Region.regular_parts`."""
    most = check_integer("budget", budget, 1)
    with meter(progress, "parts") as report:
        boxes, signs = _search(region.problem, *_first(region), most, report)
    if region.kind != "orientations" and not region.all_rotations and len(boxes):
        # All positions of a box are in one part of the region, as they are connected.
        middle = 0.5 * (boxes[:, :6] + boxes[:, 6:])[:, : region.low.shape[1]]
        code = located(middle, region.low, region.high, region.codes, region.domain)
        boxes, signs = boxes[code != OUTSIDE], signs[code != OUTSIDE]
    return _parts(region.problem, boxes, signs)


def _first(region: Any) -> tuple[Array, Mask]:
    """Return boxes of poses to begin with, (n, 12), and which of them are known to be feasible."""
    problem = region.problem
    if region.kind == "orientations" or region.all_rotations:
        boxes = patches(region)[region.codes == INSIDE]
        return boxes, np.ones(len(boxes), dtype=bool)
    turns = first_cells(problem)
    hull = np.pad(region.extents[1], ((0, 0), (0, 3 - region.low.shape[1])))
    low, high = (np.tile(end, (len(turns), 1)) for end in hull)
    boxes = np.hstack((low, turns[:, :3], high, turns[:, 3:]))
    return boxes[: 0 if region.empty else None], np.zeros(len(turns), dtype=bool)


def _search(
    problem: Bounded, boxes: Array, feasible: Mask, most: int, report: Report
) -> tuple[Array, Array]:
    """Halve boxes until all poses of one are feasible and regular; return those, and their signs.

    The largest boxes come first, `most` in all, some at a time, which are reported.
    """
    regular = problem_of(problem.design_in_frame, Limits(), regular=True)
    place = regular.names.index("minimum_singular_value")
    kept, signs, tried = [boxes[:0]], [np.zeros(0)], 0
    while len(boxes) and tried < most:
        largest = np.argsort(-_sizes(boxes), kind="stable")[: most - tried]
        boxes, feasible = boxes[largest], feasible[largest]
        report(tried, most)
        tried += len(boxes)
        codes = _verdicts(problem, boxes, feasible)
        inside, open_ = boxes[codes == INSIDE], boxes[codes == UNDECIDED]
        out, sign = enclose(regular, problem.turns.flatten(), inside)
        proven = out[:, place, LOW] > 0.0
        kept.append(inside[proven])
        signs.append(sign[proven])
        inner, _ = halved(inside[~proven], out[~proven, place, PARTS:], regular.length)
        # Positions and turns that move the platform anchors equally far are as wide.
        outer, _ = halved(open_, np.full((len(open_), 6), np.inf), problem.arm)
        boxes = np.concatenate((inner, outer))
        feasible = np.arange(len(boxes)) < len(inner)
    report(tried, tried)
    return np.concatenate(kept), np.concatenate(signs)


def _verdicts(problem: Bounded, boxes: Array, feasible: Mask) -> Codes:
    codes = np.full(len(boxes), INSIDE, dtype=np.int8)
    some = boxes[~feasible]
    turns = np.hstack((some[:, 3:6], some[:, 9:]))
    codes[~feasible] = verdicts(problem, some[:, :3], some[:, 6:9], turns)
    return codes


def _sizes(boxes: Array) -> Array:
    """Products of the widths of boxes (n, 12) that are not 0."""
    width = boxes[:, 6:] - boxes[:, :6]
    return np.asarray(np.where(width > 0.0, width, 1.0).prod(axis=1))


def _parts(problem: Bounded, boxes: Array, signs: Array) -> tuple[RegularPart, ...]:
    if not len(boxes):
        return ()
    low, high = boxes[:, :6], boxes[:, 6:]
    sizes = _sizes(boxes)
    # Angles repeat after a turn, whatever the range is.
    turn = np.repeat((0.0, 2.0 * np.pi), 3)
    labels = components(low, high, turn)
    signed = len(problem.design.joint_names) == 6
    parts = []
    for number in np.unique(labels):
        # det J has no zero on connected regular boxes, so the sign of one is that of all.
        some = labels == number
        parts.append(
            RegularPart(
                low=low[some],
                high=high[some],
                sign=int(np.sign(signs[some][0])) if signed else 0,
                size=float(sizes[some].sum()),
                origin=problem.origin,
                frame=problem.frame,
                order=problem.order,
            )
        )
    return tuple(sorted(parts, key=lambda part: -part.size))
