"""Quantities that `Nawratil` prints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from numpy.typing import ArrayLike

QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType({})
