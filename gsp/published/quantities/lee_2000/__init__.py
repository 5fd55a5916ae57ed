"""Quantities that `Lee2000` prints, from the assembled rows of its platforms.

Letters are those of the text: sides a and b, height h, separations alpha, beta, rho, twist theta
[rad], displacement x, y, ratio gamma = b/a. Equations are records of expressions in these letters.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from numpy.typing import ArrayLike

from gsp.published.quantities.lee_2000 import (
    brackets,
    determinants,
    optima,
    planar,
    platforms,
    separated,
    translated,
)

QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        f.__name__: f
        for module in (planar, platforms, determinants, optima, brackets, translated, separated)
        for f in module.QUANTITIES
    }
)
