"""Assembly modes of designs with legs that are driven at the base: those of their rods."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from gsp.geometry.matrices import condition, determinant_sign, singular_values
from gsp.geometry.vectors import Array
from gsp.kinematics.driven.locked import held, on_branches, scales_of_held
from gsp.kinematics.newton.centred import centred
from gsp.model.design import Design

if TYPE_CHECKING:
    from gsp.kinematics.modes.modes import AssemblyModes

# A drive is singular at a mode if the cosine of its rod and the velocity of the tip is below this:
# the rod is perpendicular to the velocity up to the square root of the rounding of its length.
SINGULAR_COSINE = 1e-7


def of_drives(design: Design, joints: Array, modes: AssemblyModes) -> AssemblyModes:
    """Return modes with the Jacobian of a driven design, and whether they are on its branches.

    Parameters
    ----------
    design : Design
        With legs that are driven at the base.
    joints : (6,) array [unit of the design, rad]
    modes : AssemblyModes
        Those of the rods, `held(design, joints)`.
    """
    rods, values = held(design, joints)
    error = np.abs(rods.at(modes.poses).joints - values)
    units = np.where(rods.angular, 1.0, design.rms_radius)
    # In sizes of the design, with twists at the centre of the platform anchors.
    system = centred(design)
    small, values = system.pose_from(modes.poses), system.joints_from(joints)
    scales, cosines = scales_of_held(system.design, values, small)
    rows = held(system.design, values)[0].at(small).jacobian
    with np.errstate(divide="ignore", invalid="ignore"):
        rows = rows / scales[..., None]
    singular = (modes.side == 0.0) | (np.abs(cosines) < SINGULAR_COSINE).any(axis=-1)
    rows[singular] = 0.0
    return replace(
        modes,
        joints=joints,
        residual=np.asarray((error / units).max(axis=-1, initial=0.0)),
        side=np.where(singular, 0.0, determinant_sign(rows)),
        condition=np.where(singular, np.inf, condition(singular_values(rows))),
        on_branches=on_branches(cosines),
    )
