"""The closed form: six UPS legs between two circles that reach the bound of `upper_bound`.

Lee's 3-3, 3-6 and 6-6 platforms are of this kind: anchors on two circles, legs in two triples of
threefold symmetry, twisted by +χ and −χ. At the best ratio of the radii, r = R cos χ for the
smaller one, the six lines are inclined by 45° to the tangents of its circle and |det J| = 27/4 r³,
which is the bound for any lines through its anchors.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.pose import Pose
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design

# Share of the radius within which points lie on a circle.
ON_CIRCLE = 1e-9
# Angles [rad], and lengths of sums of unit vectors, that agree to this are the same; angles of
# points are less exact than the points.
SAME_ANGLE = 1e3 * ON_CIRCLE


def central_pose(design: Design) -> Pose | None:
    """Return the best of the poses with parallel circles above each other, if it is such a design.

    Returns
    -------
    Pose or None
        None where the anchors are not two triples on two circles. At the pose |det J| is Lee's
        |det J|m, eqs. (17), (55), (64), or the value after a half turn of the platform where that
        is larger; it is the maximum over all poses only if it reaches `upper_bound`.
    """
    if design.n_legs != 6 or not design.between_points:
        return None
    base, platform = _circle(design.base_points), _circle(design.platform_points)
    if base is None or platform is None:
        return None
    for flip in (1.0, -1.0):
        twist = _twist(base.angles, flip * platform.angles)
        if twist is not None:
            return _raised(base, platform, flip, *twist)
    return None


class _Circle(NamedTuple):
    """Points on a circle: its centre, an orthonormal frame (columns x, y, normal), angles."""

    centre: Array
    frame: Array
    radius: float
    angles: Array


def _circle(points: Array) -> _Circle | None:
    centre = points.mean(axis=0)
    arms = points - centre
    radius = float(norm(arms).mean())
    _, values, right = np.linalg.svd(arms)
    if values[2] > ON_CIRCLE * radius or np.abs(norm(arms) - radius).max() > ON_CIRCLE * radius:
        return None
    frame = right.T * np.array([1.0, 1.0, np.linalg.det(right)])
    if frame[np.argmax(np.abs(frame[:, 2])), 2] < 0.0:
        frame = frame * np.array([1.0, -1.0, -1.0])
    x, y, _ = (arms @ frame).T
    return _Circle(centre, frame, radius, np.arctan2(y, x))


def _twist(base: Array, platform: Array) -> tuple[float, float] | None:
    """Return (turn, χ): after the turn, three legs are twisted by χ, the other three by −χ."""
    twist = np.exp(1j * (platform - base))
    near = np.abs(twist - twist[0]) <= SAME_ANGLE
    if near.sum() != 3 or np.abs(twist[~near] - twist[~near][0]).max() > SAME_ANGLE:
        return None
    for some in (near, ~near):
        if np.abs(np.exp(1j * base[some]).sum()) > SAME_ANGLE:
            return None
    one, two = twist[0], twist[~near][0]
    chi = float(np.angle(one / two)) / 2.0
    turn = float(np.angle(two)) + chi
    # The half turn of the platform gives χ + π: take the one with the shorter legs.
    return (-turn, chi) if np.cos(chi) >= 0.0 else (np.pi - turn, chi + np.pi)


def _raised(base: _Circle, platform: _Circle, flip: float, turn: float, chi: float) -> Pose:
    r, s = base.radius, platform.radius
    height = np.sqrt(max(r * r + s * s - 2.0 * r * s * np.cos(chi), 0.0))
    about = rotation_from_angles([0.0, 0.0, turn])
    upright = np.diag([1.0, flip, flip])
    rotation = base.frame @ about @ upright @ platform.frame.T
    centre = base.centre + height * base.frame[:, 2]
    return Pose(centre - rotation @ platform.centre, rotation)
