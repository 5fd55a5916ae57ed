"""Texts of poses, for tables and figures."""

from __future__ import annotations

import numpy as np

from gsp.geometry.pose.poses import Pose
from gsp.geometry.vectors import Array
from gsp.rounding import digits_within

# Coordinates below this share of the largest one are printed as zero.
ZERO_SHARE = 1e-12
# Columns of poses in tables: position, and angles in degrees.
POSE_COLUMNS = ("x", "y", "z", "angle_1", "angle_2", "angle_3")


def pose_text(pose: Pose, unit: str, size: float = 0.0) -> str:
    """Return a pose as position and roll, pitch, yaw in degrees, with six digits of a size."""
    places = rounded(pose.position).tolist()
    place = ", ".join(f"{x:.{digits_within(x, size)}g}" for x in places)
    turn = ", ".join(f"{x:.6g}" for x in np.round(pose.angles(degrees=True), 9) + 0.0)
    return f"position ({place}) {unit}".rstrip() + f", roll, pitch, yaw ({turn})°"


def rounded(coordinates: Array) -> Array:
    """Return coordinates of which those of rounding size, as a search leaves them, are zero."""
    small = ZERO_SHARE * np.nanmax(np.abs(coordinates), initial=0.0)
    return np.where(np.abs(coordinates) <= small, 0.0, coordinates)
