"""Designs of `Nawratil`: the example set S_K, and the sets M and N with the isotropic designs."""

from gsp.families.nawratil import motion
from gsp.families.nawratil.control_optima import control_optimum, leg_levels
from gsp.families.nawratil.example_set import (
    BEST_ALPHA,
    BEST_CONTROL_NUMBER,
    BEST_H,
    example_design,
    example_determinant,
    example_pose,
    over_example_set,
)
from gsp.families.nawratil.symmetric_sets import (
    isotropic,
    isotropic_parameters,
    line_configuration,
    set_m,
    set_n,
)

__all__ = [
    "BEST_ALPHA",
    "BEST_CONTROL_NUMBER",
    "BEST_H",
    "control_optimum",
    "example_design",
    "example_determinant",
    "example_pose",
    "over_example_set",
    "isotropic",
    "isotropic_parameters",
    "leg_levels",
    "line_configuration",
    "motion",
    "set_m",
    "set_n",
]
