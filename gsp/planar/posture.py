"""PlanarPosture: a planar design at poses, evaluated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from gsp.model.posture import Evaluated
from gsp.planar.pose import PlanarPose

if TYPE_CHECKING:
    from gsp.planar.design import PlanarDesign


@dataclass(frozen=True, eq=False)
class PlanarPosture(Evaluated):
    """A planar design at a pose or a batch of poses; made by `PlanarDesign.at`.

    Attributes
    ----------
    design : PlanarDesign
    pose : PlanarPose
        Batch shape (...).
    joints : (..., n) array [unit of the design, rad]
        Actuated distances ≥ 0 and oriented angles in (−π, π].
    jacobian : (..., n, 3) array
        Inverse Jacobian: actuator rates = J · (v_x, v_y, ω), with v the velocity of the platform
        origin in base axes.

    NaN marks an element that is not defined; `undefined` gives the reason.
    """

    design: PlanarDesign
    pose: PlanarPose
