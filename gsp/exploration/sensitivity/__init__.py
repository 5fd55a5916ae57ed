"""Sensitivities of what a task wants: local ones by gradients, global ones by Sobol indices."""

from gsp.exploration.sensitivity.derivatives import sensitivities
from gsp.exploration.sensitivity.variances import sobol_indices

__all__ = ["sensitivities", "sobol_indices"]
