"""A MuJoCo model that is drawn at several poses, with links and rails that reach at each of them.

Only the drawing has these shapes: masses and inertias stay those of the model.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gsp.bridges.links.linkage import linkage
from gsp.bridges.links.motions import Chain, spans
from gsp.bridges.links.shapes import Capsule
from gsp.bridges.links.solids import Solids, capsules, check_solids
from gsp.bridges.mujoco.elements import SHORTEST_CAPSULE, configuration, wxyz
from gsp.bridges.mujoco.mjcf import to_mjcf
from gsp.bridges.mujoco.program import compiled, load_mujoco
from gsp.errors import UndefinedPosture
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, perpendicular, unit
from gsp.model.design import Design

if TYPE_CHECKING:
    from collections.abc import Sequence


class Scene:
    """A model and its state; `show` puts it at one of the poses.

    The two links of a leg take 0.6 of its greatest length over the poses each, but never more than
    its length at the pose that is shown: they meet at every pose, and end at the feet of the leg.

    Parameters
    ----------
    design : Design
    poses : Pose of shape (n,), n ≥ 1
    solids : Solids or None

    Attributes
    ----------
    model : mujoco.MjModel
        At the first pose.
    data : mujoco.MjData
    """

    def __init__(self, design: Design, poses: Pose, solids: Solids | None) -> None:
        # A picture has no unit, strokes or masses; the size is one at which MuJoCo is accurate.
        solids = Solids(radius=check_solids(solids).radius, metres=1.0 / design.rms_radius)
        self._design, self._poses, self._solids = design, poses, solids
        self._unit = solids.unit(design)
        self._legs = [self._linkage(i) for i in range(poses.size)]
        self._spans = spans(self._legs)
        free = design.replace(strokes=None)
        self.model = compiled(to_mjcf(free, poses[0], solids))
        self.data = load_mujoco().MjData(self.model)
        for name, parts in self._bodies(0).items():
            if name == "base" or name.endswith("_rail"):
                self._shape("world" if name == "base" else name, parts)

    def _linkage(self, frame: int) -> tuple[Chain, ...]:
        try:
            return linkage(self._design, self._poses[frame])
        except UndefinedPosture as error:
            if self._poses.size == 1:
                raise
            undefined = [one._replace(pose=(frame,)) for one in error.undefined]
            raise UndefinedPosture(self._design.name, undefined) from error

    def show(self, frame: int) -> None:
        """Put the model at a pose."""
        mujoco = load_mujoco()
        legs = self._legs[frame]
        bodies = self._bodies(frame)
        for chain in legs:
            for name in (f"{chain.name}_lower", f"{chain.name}_upper"):
                self._shape(name, bodies[name])
        self.data.qpos[:] = configuration(self._legs[0], legs, self._poses[frame], self._unit)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def balls(self) -> tuple[Array, Array]:
        """Return the round ends of all parts at all poses.

        Returns
        -------
        centres : (m, 3) array [m]
            In base axes.
        radii : (m,) array [m]
        """
        centres = []
        radii = np.tile(self.model.geom_size[:, 0], 2 * self._poses.size)
        for frame in range(self._poses.size):
            self.show(frame)
            half = self.model.geom_size[:, 1:2] * self.data.geom_xmat[:, 2::3]
            centres += [self.data.geom_xpos - half, self.data.geom_xpos + half]
        return np.concatenate(centres), radii

    def anchors(self) -> Array:
        """Return the anchors of the base, and those of the platform at all poses: (m, 3) [m]."""
        turned = self._design.platform_points @ self._poses.rotation.swapaxes(-2, -1)
        above = self._poses.position[:, None] + turned
        points = np.concatenate((self._design.base_points, above.reshape(-1, 3)))
        return np.asarray(points * self._unit)

    def _bodies(self, frame: int) -> dict[str, tuple[Capsule, ...]]:
        return dict(capsules(self._design, self._legs[frame], self._solids, self._spans))

    def _shape(self, body: str, parts: Sequence[Capsule]) -> None:
        """Set the parts of a body, which the model has in the same order."""
        model = self.model
        first = int(model.body(body).geomadr[0])
        for geom, part in enumerate(parts, first):
            half = 0.5 * part.length * self._unit
            if 2.0 * half <= SHORTEST_CAPSULE:  # a sphere in the model, too
                continue
            model.geom_pos[geom] = part.centre * self._unit
            model.geom_quat[geom] = wxyz(_along(part))
            model.geom_size[geom, 1] = half
            model.geom_rbound[geom] = half + part.radius * self._unit
            # Else MuJoCo takes the place of a geom that was alone in its body from the body's
            # inertia, and not from what is set here.
            model.geom_sameframe[geom] = 0


def _along(part: Capsule) -> Pose:
    """Return a frame at the middle of a capsule, with z along it."""
    z = unit(part.end - part.start)
    x = perpendicular(z)
    return Pose(part.centre, np.stack((x, cross(z, x), z), axis=-1))
