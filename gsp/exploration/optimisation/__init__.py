"""Optimisation over spaces of designs."""

from gsp.exploration.optimisation.derivatives import gradient
from gsp.exploration.optimisation.optimising import optimise

__all__ = ["gradient", "optimise"]
