"""Parts of a region that the platform crosses without a singular pose, proven."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.checks import check_integer
from gsp.geometry.vectors import Array
from gsp.limits import Limits
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import problem_of
from gsp.proof.extremes import halved
from gsp.variation.layout import LOW, PARTS
from gsp.workspace.sets.codes import INSIDE
from gsp.workspace.sets.inside.patches import patches
from gsp.workspace.sets.tree.boxes import components


@dataclass(frozen=True, eq=False, kw_only=True)
class RegularPart:
    """Cells that are connected, inside, and without a singular pose; see `Region.regular_parts`.

    Attributes
    ----------
    low, high : (n, 6) arrays [length, rad]
        The cells: positions in base axes or along the directions of the plane (the third is 0),
        and angles about moving axes.
    sign : int [1]
        The sign of det J, 0 for redundant designs.
    size : float [length³ or length²; times rad for each angle with a range]
        Product of the widths that are not 0, summed over the cells: for one orientation the volume
        or the area.
    """

    low: Array
    high: Array
    sign: int
    size: float


def regular_parts(region: Any, budget: int) -> tuple[RegularPart, ...]:
    """Return the parts of a region without a singular pose: see `Region.regular_parts`."""
    most = check_integer("budget", budget, 1)
    boxes = patches(region)[region.codes == INSIDE]
    design = region.problem.design_in_frame
    problem = problem_of(design, Limits(), regular=True)
    place = problem.names.index("minimum_singular_value")
    turns = region.problem.turns.ravel()
    kept, signs, tried = [boxes[:0]], [np.zeros(0)], 0
    while len(boxes) and tried + len(boxes) <= most:
        out, sign = enclose(problem, turns, boxes)
        tried += len(boxes)
        regular = out[:, place, LOW] > 0.0
        kept.append(boxes[regular])
        signs.append(sign[regular])
        boxes, _ = halved(boxes[~regular], out[~regular, place, PARTS:], problem.length)
    return _parts(np.concatenate(kept), np.concatenate(signs), len(design.joint_names) == 6)


def _parts(boxes: Array, signs: Array, signed: bool) -> tuple[RegularPart, ...]:
    if not len(boxes):
        return ()
    low, high = boxes[:, :6], boxes[:, 6:]
    width = high - low
    sizes = np.where(width > 0.0, width, 1.0).prod(axis=1)
    labels = components(low, high, np.zeros(6))
    parts = []
    for number in np.unique(labels):
        # det J has no zero on connected regular cells, so the sign of one is that of all.
        some = labels == number
        parts.append(
            RegularPart(
                low=low[some],
                high=high[some],
                sign=int(np.sign(signs[some][0])) if signed else 0,
                size=float(sizes[some].sum()),
            )
        )
    return tuple(sorted(parts, key=lambda part: -part.size))
