"""Quantities that `Nawratil` prints."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from numpy.typing import ArrayLike

from gsp.published.quantities.nawratil import figures, optima, remarks

QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {**optima.QUANTITIES, **figures.QUANTITIES, **{f.__name__: f for f in remarks.QUANTITIES}}
)
