"""Shares of a variance that the errors of single parts have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from gsp.geometry.vectors import Array
from gsp.model.dimensions import Dimensions

if TYPE_CHECKING:
    import pandas as pd


def shares(dimensions: Dimensions, variances: Mapping[str, Array]) -> pd.DataFrame:
    """Return the shares of variances of the parts of each leg, the greatest of the first on top.

    Parameters
    ----------
    dimensions : Dimensions
    variances : mapping from name of a column to (p,) array
        What each coordinate adds to a variance, to first order.

    Returns
    -------
    pandas.DataFrame
        One row per part and leg (from 1) that has coordinates; columns part, leg, and one per
        variance with the sum 1.
    """
    import pandas as pd

    rows = {(one.part, one.leg + 1): None for one in dimensions.coordinates}
    table = pd.DataFrame(list(rows), columns=["part", "leg"])
    places = {key: i for i, key in enumerate(rows)}
    of = [places[one.part, one.leg + 1] for one in dimensions.coordinates]
    for name, values in variances.items():
        total = values.sum()
        added = np.bincount(of, values, len(rows))
        table[name] = added / total if total > 0.0 else np.full(len(rows), np.nan)
    first = next(iter(variances))
    return table.sort_values(first, ascending=False, kind="stable", ignore_index=True)
