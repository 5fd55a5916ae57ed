"""Quantities that `Workspace-3` and `Workspace-A` print."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

from numpy.typing import ArrayLike

from gsp.published.quantities.workspace import formulas, planar_program, six_three

QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {f.__name__: f for module in (six_three, formulas, planar_program) for f in module.QUANTITIES}
)
