"""The score of designs for a task, and their order by it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.exploration.task import Task
from gsp.geometry.vectors import Array

if TYPE_CHECKING:
    import pandas as pd


def scored(rows: Sequence[dict[str, Any]], task: Task) -> pd.DataFrame:
    """Return rows as a table with rank and score, best first; see `ranks`."""
    import pandas as pd

    frame = pd.DataFrame(rows)
    frame.insert(0, "score", score(frame, task))
    frame.insert(0, "rank", ranks(frame))
    return frame.sort_values("rank", kind="stable", ignore_index=True)


def ranks(frame: pd.DataFrame) -> pd.Series[Any]:
    """Return the rank of each row by its score, 1 for the greatest; NaN for rows without one.

    Equal scores share a rank. Ranks are integers where all rows have a score.
    """
    found = frame["score"].rank(method="min", ascending=False)
    return found if found.isna().any() else found.astype(int)


def score(frame: pd.DataFrame, task: Task) -> Array:
    """Return the score of each row: see `assess`."""
    total = np.zeros(len(frame))
    weights = np.array([wish.weight for wish in task.wanted])
    for wish, share in zip(task.wanted, weights / weights.sum(), strict=True):
        values = frame[wish.column].to_numpy(dtype=np.float64, na_value=np.nan)
        with np.errstate(divide="ignore"):
            good = np.log(np.maximum(values, 0.0)) * (-1.0 if wish.better == "lower" else 1.0)
        # All at the worst end: none is better than another.
        best = np.fmax.reduce(good, initial=-np.inf)
        total += share * (good - (best if np.isfinite(best) else 0.0))
    return np.asarray(np.exp(total))
