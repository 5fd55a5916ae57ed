"""Tables of designs: statistics of each index, and the order by one of them."""

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
    """Return the table sorted by the mean of an index, best first, with the column "rank".

    Equal means share a rank, the least of theirs; undefined means come last.
    """
    ascending = INDICES[by].better == "lower"
    order = frame[f"{by}_mean"].rank(method="min", ascending=ascending, na_option="bottom")
    frame.insert(0, "rank", order.astype(int))
    return frame.sort_values("rank", kind="stable", ignore_index=True)


def summary(design: Design, values: Mapping[str, Array], singular: Mask) -> dict[str, Any]:
    """Return the row of a design: statistics of each index, shares of singular and undefined.

    Parameters
    ----------
    design : Design
    values : mapping from name of an index to (n,) array
    singular : (n,) bool array
        Whether a pose is singular. Without any pose, n = 0, shares and statistics are NaN.
    """
    row: dict[str, Any] = {
        "design": design.name,
        "mechanism": design.mechanism.name,
        "class": design.mechanism.group,
        "n_legs": design.n_legs,
    }
    undefined = np.zeros(singular.shape, dtype=bool)
    for name, column in values.items():
        undefined |= np.isnan(column)
        for statistic, value in zip(STATISTICS, statistics(column), strict=True):
            row[f"{name}_{statistic}"] = value
    row["singular"] = share(singular)
    row["undefined"] = share(undefined)
    return row


def share(flags: Mask) -> float:
    """Return the share of flags that are set, NaN if there are none."""
    return float(flags.mean()) if flags.size else float("nan")


def statistics(column: Array) -> tuple[float, ...]:
    """Return mean, min, 5 %, 50 %, 95 % quantile and max of the numbers that are not NaN.

    All are NaN if there is no such number. Quantiles are observed values, the nearest ones, so that
    inf is allowed. The order of `column` may be changed.
    """
    unknown = np.isnan(column)
    known = column[~unknown] if unknown.any() else column
    if not known.size:
        return (float("nan"),) * len(STATISTICS)
    mean = known.mean()
    low, middle, high = np.rint(np.multiply((0.05, 0.5, 0.95), known.size - 1)).astype(int)
    # Three partitions at one place each, as numpy takes 4.7 times as long for one at three places.
    # A later one moves the numbers of its part, so that the median is read first.
    known.partition(middle)
    median = known[middle]
    below, above = known[: middle + 1], known[middle:]
    below.partition(low)
    above.partition(high - middle)
    least, largest = below[: low + 1].min(), above[high - middle :].max()
    return tuple(map(float, (mean, least, below[low], median, known[high], largest)))
