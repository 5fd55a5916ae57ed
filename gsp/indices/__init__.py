"""Performance indices of postures, and the table of them."""

from gsp.indices.cdn_cl import condition_number, local_conditioning, minimum_singular_value
from gsp.indices.cdn_oe import condition_number_ellipsoid
from gsp.indices.cdn_plain import condition_number_plain
from gsp.indices.cdn_points import condition_number_points
from gsp.indices.ctn import control_number
from gsp.indices.det_j import manipulability, quality_index
from gsp.indices.forces import greatest_force
from gsp.indices.gradients import Gradient, gradient
from gsp.indices.linear_complex import (
    complex_deviation_rotation,
    complex_deviation_translation,
)
from gsp.indices.record import Index, Invariance, Properties
from gsp.indices.rigidity import rigidity_rate
from gsp.indices.singularity import singularity_distance
from gsp.indices.stiffness import stiffness_x, stiffness_y, stiffness_z
from gsp.indices.table import INDICES, index_name, index_names

__all__ = [
    "INDICES",
    "Gradient",
    "Index",
    "Invariance",
    "Properties",
    "complex_deviation_rotation",
    "complex_deviation_translation",
    "condition_number",
    "condition_number_ellipsoid",
    "condition_number_plain",
    "condition_number_points",
    "control_number",
    "gradient",
    "greatest_force",
    "index_name",
    "index_names",
    "local_conditioning",
    "manipulability",
    "minimum_singular_value",
    "quality_index",
    "rigidity_rate",
    "singularity_distance",
    "stiffness_x",
    "stiffness_y",
    "stiffness_z",
]
