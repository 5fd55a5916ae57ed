"""Tables of designs: statistics of each index, and the ranking by one of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.geometry.vectors import Array, Mask
from gsp.indices import INDICES
from gsp.model.design import Design

if TYPE_CHECKING:
    import pandas as pd

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
