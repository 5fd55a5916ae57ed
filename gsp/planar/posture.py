"""PlanarPosture: a planar design at poses, evaluated."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from gsp.geometry.vectors import Array, norm
from gsp.model.evaluated import Evaluated
from gsp.planar.constraints import PLANAR_CONSTRAINTS, PlanarConstraint, PlanarLines
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

    NaN marks an element that is not defined; `undefined` says why.
    """

    design: PlanarDesign
    pose: PlanarPose

    @cached_property
    def lines(self) -> PlanarLines:
        """Anchor points and lines of all legs, in base axes."""
        design, p = self.design, self.pose.position
        back = np.swapaxes(self.pose.rotation, -1, -2)
        arm = design.platform_points @ back
        t = design.platform_directions @ back
        d = p[..., None, :] + arm - design.base_points
        reach = norm(design.platform_points) + norm(design.base_points)
        s = np.broadcast_to(design.base_directions, d.shape)
        return PlanarLines(d, arm, s, t, norm(p)[..., None] + reach)

    def _kinds(self) -> Iterator[tuple[PlanarConstraint, list[int], PlanarLines]]:
        for kind in PLANAR_CONSTRAINTS:
            legs = [i for i, leg in enumerate(self.design.legs) if leg is kind]
            if legs:
                yield kind, legs, self.lines[legs]

    @cached_property
    def _assembled(self) -> tuple[Array, Array]:
        n = self.design.n_legs
        joints, rows = np.empty((*self.shape, n)), np.empty((*self.shape, n, 3))
        for kind, legs, lines in self._kinds():
            ok = kind.defined(lines)
            value, row = kind.value_and_row(lines)
            joints[..., legs] = np.where(ok, value, np.nan)
            rows[..., legs, :] = np.where(ok[..., None], row, np.nan)
        joints.flags.writeable = rows.flags.writeable = False
        return joints, rows

    def _passive_rates(self, length: float) -> Array:
        blocks = []
        for kind, _, lines in self._kinds():
            turns, slides = kind.passive(lines)
            rows = np.concatenate((turns, slides / length), axis=-2)
            rows = np.where(kind.defined(lines)[..., None, None], rows, np.nan)
            blocks.append(rows.reshape(*self.shape, -1, 3))
        return np.concatenate(blocks, axis=-2)
