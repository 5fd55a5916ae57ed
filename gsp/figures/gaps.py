"""What figures state where values of an index cannot be drawn."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def undrawable_words(symbol: str, values: NDArray[np.float64], each: str = "pose") -> str:
    """Return why there is nothing to draw: each value is 0, infinite or undefined.

    Parameters
    ----------
    symbol : str
        Of the index.
    values : array
        Without one that is finite and not 0, or such an axis has no place for them.
    each : str
        What has a value.

    Examples
    --------
    >>> undrawable_words("CTN", np.array([0.0, 0.0]))
    'CTN is 0 at every pose'
    >>> undrawable_words("CDN_CL", np.array([np.inf, np.nan]))
    'CDN_CL is infinite or undefined at every pose'
    """
    kinds = {"0": values == 0.0, "infinite": np.isinf(values), "undefined": np.isnan(values)}
    states = " or ".join(state for state, where in kinds.items() if where.any())
    return f"{symbol} is {states} at every {each}"


def gap_words(symbol: str, values: NDArray[np.float64], each: str = "pose") -> str:
    """Return at how many poses an index is not finite, "" where it is so at none.

    Parameters
    ----------
    symbol : str
        Of the index.
    values : array
    each : str
        What has a value.

    Examples
    --------
    >>> gap_words("CTN", np.array([0.5, np.inf, np.nan, np.nan]))
    'CTN is infinite at 1 and undefined at 2 of 4 poses'
    >>> gap_words("CTN", np.array([0.5]))
    ''
    """
    counts = {"infinite": np.isinf(values).sum(), "undefined": np.isnan(values).sum()}
    if sum(counts.values()) == values.size:
        return undrawable_words(symbol, values, each)
    parts = " and ".join(f"{state} at {count}" for state, count in counts.items() if count)
    return f"{symbol} is {parts} of {values.size} {each}s" if parts else ""
