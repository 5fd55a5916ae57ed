"""Robust losses: how much residuals count that are larger than their standard errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from gsp.geometry.vectors import Array


class Loss(NamedTuple):
    """A robust loss ρ(z) of a square z, and its derivative, the weight of that square."""

    value: Callable[[Array], Array]
    weight: Callable[[Array], Array]


LOSSES = MappingProxyType(
    {
        "linear": Loss(lambda z: z, np.ones_like),
        "soft_l1": Loss(lambda z: 2.0 * (np.sqrt(1.0 + z) - 1.0), lambda z: (1.0 + z) ** -0.5),
        "huber": Loss(
            lambda z: np.where(z <= 1.0, z, 2.0 * np.sqrt(z) - 1.0),
            lambda z: np.maximum(z, 1.0) ** -0.5,
        ),
        "cauchy": Loss(np.log1p, lambda z: 1.0 / (1.0 + z)),
        "arctan": Loss(np.arctan, lambda z: 1.0 / (1.0 + z**2)),
    }
)


@dataclass(frozen=True, eq=False, kw_only=True)
class Robust:
    """A loss of residuals r, c² ρ((r/c)²), as in `scipy.optimize.least_squares`.

    Attributes
    ----------
    name : str
        A key of `LOSSES`.
    scale : float [standard errors]
        c.
    """

    name: str
    scale: float

    def sum(self, residuals: Array) -> float:
        """Return the sum of the loss, infinite where a residual is undefined."""
        total = self.scale**2 * LOSSES[self.name].value((residuals / self.scale) ** 2).sum()
        return float(total) if np.isfinite(total) else float("inf")

    def weights(self, residuals: Array) -> Array:
        """Return the weights of the squares of residuals."""
        return np.asarray(LOSSES[self.name].weight((residuals / self.scale) ** 2))
