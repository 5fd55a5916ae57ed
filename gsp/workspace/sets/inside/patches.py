"""The boxes of poses of a region whose cells count with all orientations of its range."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.errors import InvalidInput, expected
from gsp.geometry.rotations import moving_places
from gsp.geometry.vectors import Array


def patches(region: Any) -> Array:
    """Return the boxes of poses of the cells, (n, 12), in the axes of the problem.

    Raises
    ------
    InvalidInput
        If the cells do not count with all orientations of the range.
    """
    if region.kind == "orientations":
        moving = moving_places(region.problem.order)
        at = np.tile(region.problem.low, (len(region.low), 1))
        return np.hstack((at, region.low[:, moving], at, region.high[:, moving]))
    if not region.all_rotations:
        wanted = "a region whose cells count with all orientations of the range"
        raise InvalidInput(expected("region", wanted, repr(region)))
    d, n = region.low.shape[1], len(region.low)
    ends = []
    for side, turns in ((region.low, region.problem.least), (region.high, region.problem.most)):
        ends += [side, np.zeros((n, 3 - d)), np.tile(turns, (n, 1))]
    return np.concatenate(ends, axis=1)
