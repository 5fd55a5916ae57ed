"""Tables of designs: statistics of each index, and the order by one of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.geometry.vectors import Array, Mask
from gsp.indices import INDICES
from gsp.model.design import Design
from gsp.model.drives import drives_text

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


def infinite_means(frame: pd.DataFrame, names: Sequence[str]) -> dict[str, dict[str, int]]:
    """Return what `attrs` of a table records about infinite means; nothing if there are none.

    One singular pose makes the mean of a condition number infinite; quantiles need not be.
    """
    means = {name: frame[f"{name}_mean"] for name in names if f"{name}_mean" in frame}
    counts = {name: int(np.isinf(mean.astype(float)).sum()) for name, mean in means.items()}
    found = {name: count for name, count in counts.items() if count}
    return {"infinite_means": found} if found else {}


def summary(design: Design, names: Sequence[str], columns: Array, singular: Mask) -> dict[str, Any]:
    """Return the row of a design: statistics of each index, shares of singular and undefined.

    Parameters
    ----------
    design : Design
    names : sequence of str
        Of m indices.
    columns : (m, n) array
        Their values; the order of a row may be changed.
    singular : (n,) bool array
        Whether a pose is singular. Without any pose, n = 0, shares and statistics are NaN.
    """
    row: dict[str, Any] = {
        "design": design.name,
        "mechanism": design.mechanism.name,
        "class": design.mechanism.group,
        "n_legs": design.n_legs,
    }
    undefined = np.asarray(np.isnan(columns).any(axis=0))
    for name, numbers in zip(names, statistics(columns), strict=True):
        for statistic, value in zip(STATISTICS, numbers, strict=True):
            row[f"{name}_{statistic}"] = value
    row["singular"] = share(singular)
    row["undefined"] = share(undefined)
    return row


def with_drives(rows: Sequence[dict[str, Any]], designs: Sequence[Design]) -> list[dict[str, Any]]:
    """Return rows of designs with the column "drives" after "n_legs", if one has drives."""
    texts = [drives_text(design.drives) for design in designs]
    if not any(texts):
        return list(rows)
    found = []
    for row, text in zip(rows, texts, strict=True):
        items = list(row.items())
        place = list(row).index("n_legs") + 1
        found.append(dict([*items[:place], ("drives", text), *items[place:]]))
    return found


def share(flags: Mask) -> float:
    """Return the share of flags that are set, NaN if there are none."""
    return np.count_nonzero(flags) / flags.size if flags.size else float("nan")


def statistics(columns: Array) -> list[list[float]]:
    """Return mean, min, 5 %, 50 %, 95 % quantile and max of the numbers that are not NaN.

    One list per row of an array (m, n), in the order of STATISTICS. All are NaN if there is no such
    number. Quantiles are observed values, the nearest ones, so that inf is allowed. The order of
    the numbers may be changed.
    """
    unknown = np.isnan(columns)
    if unknown.any() and len(columns) > 1:
        return [statistics(column[None])[0] for column in columns]
    # Rows are contiguous: those of another order are summed in another order.
    known = columns[~unknown][None] if unknown.any() else np.ascontiguousarray(columns)
    size = known.shape[1]
    if not size:
        return [[float("nan")] * len(STATISTICS) for _ in columns]
    mean = known.mean(axis=1)
    low, middle, high = np.rint(np.multiply((0.05, 0.5, 0.95), size - 1)).astype(int)
    # Three partitions at one place each, as numpy takes 4.7 times as long for one at three places.
    # A later one moves the numbers of its part, so that the median is read first.
    known.partition(middle, axis=1)
    median = known[:, middle].copy()
    below, above = known[:, : middle + 1], known[:, middle:]
    below.partition(low, axis=1)
    above.partition(high - middle, axis=1)
    least, largest = below[:, : low + 1].min(axis=1), above[:, high - middle :].max(axis=1)
    found = np.stack((mean, least, below[:, low], median, known[:, high], largest), axis=1)
    rows: list[list[float]] = found.tolist()
    return rows
