"""The platforms of Lee's dissertation, and its closed forms for them.

Designs: `octahedral_3_3`, `platform_3_6`, `platform_6_6`, `separated_to_centre`,
`separated_along_side`, and `separated_by_kinds`, which separates the joints of the platform in
another way than those of the base. Their base origin is the centre of the base triangle; the
platform origin is the centre of the platform triangle, and both planes are z = 0 of their axes. So
`gsp.Pose([x, y, h])` is the pose that the text describes by (x, y) and the height h, and
rotations about the platform origin are those of the pose.
"""

from gsp.families.lee.brackets import (
    bracket,
    bracket_determinant,
    line_coordinates,
    shear,
    shear_of_lines,
    turned_brackets,
    turned_determinant,
)
from gsp.families.lee.hexagons import (
    absolute_maximum,
    best_height,
    best_ratio,
    central_determinant,
    central_maximum,
    leg_length,
    octahedron_volume,
    quality_at_height,
    regulus_factor,
)
from gsp.families.lee.kinds import best_pose_by_kinds, by_kinds, separated_by_kinds
from gsp.families.lee.platforms import (
    FAMILIES,
    joint_names,
    octahedral_3_3,
    platform_3_6,
    platform_6_6,
    separated_along_side,
    separated_to_centre,
)
from gsp.families.lee.separated import (
    Separated,
    along_side,
    best_central_pose,
    to_centre,
)
from gsp.families.lee.translations import (
    quality_polar,
    quality_polar_bound,
    translated_determinant,
    translated_leg_lengths,
    translated_quality,
)

__all__ = [
    "FAMILIES",
    "Separated",
    "absolute_maximum",
    "along_side",
    "best_central_pose",
    "best_height",
    "best_pose_by_kinds",
    "best_ratio",
    "bracket",
    "bracket_determinant",
    "central_determinant",
    "central_maximum",
    "by_kinds",
    "joint_names",
    "leg_length",
    "line_coordinates",
    "octahedral_3_3",
    "octahedron_volume",
    "platform_3_6",
    "platform_6_6",
    "quality_at_height",
    "quality_polar",
    "quality_polar_bound",
    "regulus_factor",
    "separated_along_side",
    "separated_by_kinds",
    "separated_to_centre",
    "shear",
    "shear_of_lines",
    "to_centre",
    "translated_determinant",
    "translated_leg_lengths",
    "translated_quality",
    "turned_brackets",
    "turned_determinant",
]
