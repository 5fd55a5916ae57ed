"""What is recomputed: per paper, a table from the name of a quantity to its function."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from numpy.typing import ArrayLike

from gsp.published.quantities import nawratil, toz_kucuk_2016

PAPERS: Mapping[str, Mapping[str, Callable[..., ArrayLike]]] = MappingProxyType(
    {
        "TozKucuk2016": toz_kucuk_2016.QUANTITIES,
        "Nawratil": nawratil.QUANTITIES,
    }
)
