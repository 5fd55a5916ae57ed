"""Tables from values: statistics of a design, the ranking, and how poses are numbered."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from gsp.design import Design
from gsp.indices import INDICES
from gsp.pose import Pose
from gsp.vectors import Array, Mask

STATISTICS = ("mean", "min", "q05", "median", "q95", "max")


def ranked(frame: pd.DataFrame, by: str) -> pd.DataFrame:
    """Return designs sorted by the mean of an index, best first, with their rank."""
    ascending = INDICES[by].better == "lower"
    order = frame[f"{by}_mean"].rank(method="min", ascending=ascending, na_option="bottom")
    frame.insert(0, "rank", order.astype(int))
    return frame.sort_values("rank", kind="stable", ignore_index=True)


def summary(design: Design, values: Mapping[str, Array], singular: Mask) -> dict[str, Any]:
    """Return the row of a design: statistics of each index, shares of singular and undefined."""
    row: dict[str, Any] = {
        "design": design.name,
        "mechanism": design.mechanism.name,
        "class": design.mechanism.group,
        "n_legs": design.n_legs,
    }
    undefined = np.zeros(singular.shape, dtype=bool)
    for name, column in values.items():
        undefined |= np.isnan(column)
        for statistic, value in zip(STATISTICS, _statistics(column), strict=True):
            row[f"{name}_{statistic}"] = value
    row["singular"] = float(singular.mean())
    row["undefined"] = float(undefined.mean())
    return row


def _statistics(column: Array) -> tuple[float, ...]:
    """Mean, min, 5 %, 50 %, 95 % quantiles (observed values, so that inf is allowed), max."""
    known = column[~np.isnan(column)]
    if not known.size:
        return (float("nan"),) * len(STATISTICS)
    mean = known.mean()
    shares = (0.05, 0.5, 0.95)
    low, middle, high = np.quantile(known, shares, method="nearest", overwrite_input=True)
    return tuple(map(float, (mean, known.min(), low, middle, high, known.max())))


def pose_index(pose: Pose) -> pd.Index:
    """Return 0 … n − 1, or a level an axis for a batch of several axes."""
    if len(pose.shape) < 2:
        return pd.RangeIndex(pose.size)
    levels = [range(n) for n in pose.shape]
    return pd.MultiIndex.from_product(levels, names=[f"pose_{i}" for i in range(len(levels))])


def divide_by_largest(column: Array) -> None:
    """Divide values by the largest of them, in place, unless all are zero or undefined."""
    largest = np.fmax.reduce(column, initial=0.0)
    if largest > 0.0:
        column /= largest
