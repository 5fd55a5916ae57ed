"""How poses are numbered in tables, and columns that refer to their own largest value."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array

if TYPE_CHECKING:
    import pandas as pd


def pose_index(pose: Pose) -> pd.Index:
    """Return 0 … n − 1, or a level an axis for a batch of several axes."""
    import pandas as pd

    if len(pose.shape) < 2:
        return pd.RangeIndex(pose.size)
    levels = [range(n) for n in pose.shape]
    return pd.MultiIndex.from_product(levels, names=[f"pose_{i}" for i in range(len(levels))])


def divide_by_largest(column: Array) -> None:
    """Divide values by the largest of them, in place, unless all are zero or undefined."""
    largest = np.fmax.reduce(column, initial=0.0)
    if largest > 0.0:
        column /= largest
