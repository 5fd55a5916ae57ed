"""Poses between frames of other origins and another unit."""

from __future__ import annotations

from gsp.geometry.pose.batch import unchecked
from gsp.geometry.pose.poses import Pose
from gsp.geometry.vectors import Array


def centred_pose(pose: Pose, size: float, base: Array, platform: Array) -> Pose:
    """Return poses between frames with other origins, in another unit.

    Parameters
    ----------
    pose : Pose, batch shape (...)
    size : float [length]
        The new unit.
    base, platform : (3,) arrays [length]
        The new origins, in the axes of the old frames.

    Returns
    -------
    Pose, batch shape (...)
        Positions in units of `size`.
    """
    position = (pose.position - base + pose.rotation @ platform) / size
    return unchecked(Pose, position, pose.rotation.view())


def original_pose(pose: Pose, size: float, base: Array, platform: Array) -> Pose:
    """Return poses between the frames before: the inverse of `centred_pose`.

    Parameters
    ----------
    pose : Pose, batch shape (...)
        Positions in units of `size`.
    size : float [length]
        The unit.
    base, platform : (3,) arrays [length]
        The origins of its frames, in the axes of the frames before.

    Returns
    -------
    Pose, batch shape (...)
    """
    position = pose.position * size + base - pose.rotation @ platform
    return unchecked(Pose, position, pose.rotation.view())
