"""A design in units of its size, with the origins of the frames at the centres of its anchors."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Self

import numpy as np
from numpy.typing import NDArray

from gsp.arguments import LARGEST_NUMBER
from gsp.geometry.pose import Pose
from gsp.geometry.pose.centring import centred_pose, original_pose
from gsp.geometry.vectors import Array, Mask, norm
from gsp.model.design import Design
from gsp.model.drives import scaled
from gsp.model.legs import LEGS


@dataclass(frozen=True, eq=False, kw_only=True)
class Centred:
    """A centred design, and the transformations from and to the frames of the original.

    Steps turn the platform about its origin. Far from the anchors the rows would look singular, and
    small turns would move the anchors far; and distances would be rounded as their coordinates are.

    Attributes
    ----------
    design : Design
        Scaled to size 1, frames at the centres.
    frame : (7,) array
        Size [unit of the original]; centres of base and platform anchors in their own axes.
    kinds : (n_legs,) int array
        Places in `gsp.model.legs.LEGS`; −1 for legs that are driven at the base.
    geometry, paths : (n_legs * 13,) and (n_legs * 18,) arrays
        a, b, s, t, |a| + |b|; and a, b, s, t, |a|, |b|, four tolerances of zero.
    units : (n,) array
        The size for distances, 1 for angles.
    """

    design: Design
    frame: Array
    kinds: NDArray[np.int64]
    geometry: Array
    paths: Array
    units: Array

    @classmethod
    def of(cls, design: Design) -> Self:
        """Return the centred form of a design."""
        size = design.rms_radius
        centres = [points.mean(axis=0) for points in (design.base_points, design.platform_points)]
        a = (design.base_points - centres[0]) / size
        b = (design.platform_points - centres[1]) / size
        lines = np.nan_to_num(np.hstack((design.base_directions, design.platform_directions)))
        sizes = np.stack((norm(a), norm(b)), axis=1)
        reach = sizes.sum(axis=1, keepdims=True)
        legs = [leg if leg.drive is None else scaled(leg.drive, 1.0 / size) for leg in design.legs]
        small = Design(
            legs,
            a,
            b,
            design.base_directions,
            design.platform_directions,
        )
        return cls(
            design=small,
            frame=np.concatenate(([size], *centres)),
            kinds=np.array(
                [LEGS.index(leg) if leg.drive is None else -1 for leg in design.legs],
                dtype=np.int64,
            ),
            geometry=np.hstack((a, b, lines, reach)).ravel(),
            paths=np.hstack((a, b, lines, sizes, np.zeros((len(a), 4)))).ravel(),
            units=np.where(design.angular, 1.0, size),
        )

    def joints_from(self, joints: Array) -> Array:
        """Return joint values in units of the size."""
        return np.asarray(joints / self.units)

    def possible(self, target: Array) -> Mask:
        """Whether values are ones that the joints can have: distances ≥ 0, angles in (0, π).

        Those of drives at the base may be all numbers, up to the squares of extreme ones.
        """
        with np.errstate(invalid="ignore"):
            least = np.where(self.design.angular, target > 0.0, target >= 0.0)
            most = target < np.where(self.design.angular, np.pi, np.inf)
            moderate = np.abs(target) <= LARGEST_NUMBER**0.5
        drives = np.array([row.constraint.driven for row in self.design.rows])
        return np.asarray(np.where(drives, moderate, least & most).all(axis=-1))

    def pose_from(self, pose: Pose) -> Pose:
        """Return poses of the centred frames."""
        return centred_pose(pose, self.frame[0], self.frame[1:4], self.frame[4:])

    def pose_to(self, pose: Pose) -> Pose:
        """Return poses of the original frames: the inverse of `pose_from`."""
        return original_pose(pose, self.frame[0], self.frame[1:4], self.frame[4:])


@lru_cache(maxsize=256)
def centred(design: Design) -> Centred:
    """Return the centred form of a design; made once."""
    return Centred.of(design)
