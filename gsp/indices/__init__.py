"""Performance indices of postures, and the table of them."""

from types import MappingProxyType

from gsp.indices.cdn_cl import (
    CONDITION_NUMBER,
    MINIMUM_SINGULAR_VALUE,
    condition_number,
    minimum_singular_value,
)
from gsp.indices.cdn_oe import CONDITION_NUMBER_ELLIPSOID, condition_number_ellipsoid
from gsp.indices.ctn import CONTROL_NUMBER, control_number
from gsp.indices.det_j import MANIPULABILITY, QUALITY_INDEX, manipulability, quality_index
from gsp.indices.record import Index

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
        )
    }
)

__all__ = [
    "INDICES",
    "Index",
    "condition_number",
    "condition_number_ellipsoid",
    "control_number",
    "manipulability",
    "minimum_singular_value",
    "quality_index",
]
