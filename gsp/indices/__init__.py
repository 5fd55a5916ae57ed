"""Performance indices of postures, and the table of them."""

from types import MappingProxyType

from gsp.indices.cdn_cl import (
    CONDITION_NUMBER,
    MINIMUM_SINGULAR_VALUE,
    condition_number,
    minimum_singular_value,
)
from gsp.indices.cdn_oe import CONDITION_NUMBER_ELLIPSOID, condition_number_ellipsoid
from gsp.indices.cdn_plain import CONDITION_NUMBER_PLAIN, condition_number_plain
from gsp.indices.cdn_points import CONDITION_NUMBER_POINTS, condition_number_points
from gsp.indices.ctn import CONTROL_NUMBER, control_number
from gsp.indices.det_j import MANIPULABILITY, QUALITY_INDEX, manipulability, quality_index
from gsp.indices.linear_complex import (
    COMPLEX_DEVIATION_ROTATION,
    COMPLEX_DEVIATION_TRANSLATION,
    complex_deviation_rotation,
    complex_deviation_translation,
)
from gsp.indices.record import Index, Properties
from gsp.indices.rigidity_rate import RIGIDITY_RATE, rigidity_rate

INDICES = MappingProxyType(
    {
        index.name: index
        for index in (
            CONDITION_NUMBER,
            CONDITION_NUMBER_ELLIPSOID,
            CONTROL_NUMBER,
            QUALITY_INDEX,
            MANIPULABILITY,
            MINIMUM_SINGULAR_VALUE,
            CONDITION_NUMBER_PLAIN,
            CONDITION_NUMBER_POINTS,
            COMPLEX_DEVIATION_ROTATION,
            COMPLEX_DEVIATION_TRANSLATION,
            RIGIDITY_RATE,
        )
    }
)

__all__ = [
    "INDICES",
    "Index",
    "Properties",
    "complex_deviation_rotation",
    "complex_deviation_translation",
    "condition_number",
    "condition_number_ellipsoid",
    "condition_number_plain",
    "condition_number_points",
    "control_number",
    "manipulability",
    "minimum_singular_value",
    "quality_index",
    "rigidity_rate",
]
