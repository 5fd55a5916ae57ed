"""Volumes of sets of positions, with estimates of their errors."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from gsp.checks import check_array
from gsp.errors import InvalidInput, brief, expected


class Volume(NamedTuple):
    """A volume and an estimate of its error.

    Attributes
    ----------
    value, error : float [unit³]
    """

    value: float
    error: float


def check_heights(value: Any) -> tuple[float, float]:
    """Return two heights, which may be infinite, or raise InvalidInput."""
    pair = check_array("heights", value, (2,), finite=False)
    if pair.ndim != 1 or np.isnan(pair).any():
        raise InvalidInput(expected("heights", "two numbers", brief(value)))
    return float(pair[0]), float(pair[1])
