"""Indices over many poses in one row: means, extremes, and shares where a bound holds."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.vectors import Array, Mask
from gsp.indices import INDICES
from gsp.limits.limits import threshold


def index_summary(name: str, values: Array, weight: Array) -> dict[str, float]:
    """Return the row of an index of `IndexMap.summary`: values (n,), NaN for undefined ones.

    `weight` are the shares of the poses, (n,).
    """
    defined = ~np.isnan(values)
    known, share = values[defined], weight[defined] / max(weight[defined].sum(), 1e-300)
    index = INDICES[name]
    lower = index.better == "lower"
    if not known.size:
        nothing = dict.fromkeys(
            ("mean", "min", "max", "worst", "std", "uniformity", "global"), np.nan
        )
        return {**nothing, "undefined": 1.0 if values.size else np.nan}
    low, high = float(known.min()), float(known.max())
    with np.errstate(invalid="ignore"):
        mean = float(share @ known)
        overall = float(share @ overall_values(name, known))
        uniformity = low / high if np.isfinite(high) and high != 0.0 else 0.0
        spread = float(np.sqrt(share @ (known - mean) ** 2)) if np.isfinite(high) else np.inf
    return {
        "mean": mean,
        "min": low,
        "max": high,
        "worst": high if lower else low,
        "std": spread,
        "uniformity": uniformity,
        "global": overall,
        "undefined": float(weight[~defined].sum() / weight.sum()),
    }


def overall_values(name: str, values: Array) -> Array:
    """Return what the global index is the mean of: reciprocals where 1 is best and less better."""
    index = INDICES[name]
    if index.better == "lower" and index.best == 1.0:
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / values)
    return values


def satisfied(values: Mapping[str, Array], bound: str) -> Mask:
    """Return where an index of a table satisfies a bound such as "λ >= 0.3"; nowhere undefined."""
    index, least, most = threshold("bound", bound)
    if index.name not in values:
        wanted = "a bound of one of " + ", ".join(values)
        raise InvalidInput(expected("bound", wanted, brief(bound)))
    with np.errstate(invalid="ignore"):
        return np.asarray((values[index.name] >= least) & (values[index.name] <= most))
