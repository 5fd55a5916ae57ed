"""What each index measures, in the words of docs/choosing-an-index.md."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

_MEANINGS = {
    "condition_number": "the spread of the singular values of J, made dimensionless with a length",
    "condition_number_ellipsoid": ("greatest over least speed of an ellipsoid for unit leg rates"),
    "control_number": "least over greatest turning speed of the legs for unit leg rates",
    "quality_index": "|det J| over its maximum",
    "manipulability": "the product of the singular values",
    "minimum_singular_value": "the least leg rates for a motion of unit size",
    "condition_number_plain": "the spread of the singular values of J without scaling",
    "condition_number_points": "greatest over least speed of three points for unit leg rates",
    "complex_deviation_rotation": "the least leg rates for a motion of unit angular velocity",
    "complex_deviation_translation": "the least leg rates for a translation of unit speed",
    "rigidity_rate": (
        "with all legs locked and a platform that may change its size: how much it would grow "
        "rather than turn"
    ),
    "singularity_distance": "a proven lower bound of the distance to the nearest singular pose",
    "greatest_force": (
        "the greatest force of an actuator over all wrenches sqrt(|f|² + |m|²/L²) = 1 about the "
        "platform origin; torques of A1 actuators are divided by L"
    ),
    "local_conditioning": (
        "1/CDN_CL; its mean in tables is the global conditioning index GCI, in which a singular "
        "pose counts as 0"
    ),
    **{
        f"stiffness_{axis}": (
            f"the stiffness along {axis} of the base, 1/(nᵀ K⁻¹ n), for actuators of stiffness 1 "
            "(of angles L²) and a force through the platform origin"
        )
        for axis in "xyz"
    },
}
MEANINGS: Mapping[str, str] = MappingProxyType(_MEANINGS)
