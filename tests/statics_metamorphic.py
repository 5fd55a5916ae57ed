"""Quantities of statics and proven bounds for the metamorphic suite: see `tests.quantities`."""

from __future__ import annotations

import numpy as np

import gsp

# A stiffness has the square of the condition number of the rows: above this one, and for a frame
# that is far away, too few digits are left to compare eigenscrews.
CONDITION = 1e3


def springs(given):
    """Stiffnesses per row, those of the old numbers of the rows, in the unit of the case."""
    k = (1.0 + 0.3 * np.arange(len(given.rows)))[given.rows]
    return k * np.where(given.design.angular, given.unit, 1.0 / given.unit)


def errors(given):
    """Errors of the joint values: a thousandth of a length, and of a radian."""
    return np.where(given.design.angular, 1e-3, 1e-3 * given.length)


def condition(given):
    """Condition numbers of the rows about the centre of the platform anchors."""
    centre = given.design.platform_points.mean(axis=0)
    posture = given.design.with_origin(centre).at(given.pose.compose(gsp.Pose(centre)))
    return gsp.indices.condition_number(posture, given.design.rms_radius)


def _regular(given, values):
    """Values at poses with a moderate condition number, which no change crosses by rounding."""
    shape = (-1,) + (1,) * (values.ndim - 1)
    return np.where((condition(given) < CONDITION).reshape(shape), values, np.nan)


def actuator_forces(given):
    """Forces against the wrench that equal springs make of all joints, in units of rows."""
    load = (0.5 + np.arange(len(given.rows)))[given.rows]
    load = load * np.where(given.design.angular, given.unit, 1.0)
    posture = given.posture
    sign = np.where(given.reversed, -1.0, 1.0)
    wrench = (posture.jacobian * (load * sign)[:, None]).sum(axis=-2)
    wrench = np.where(posture.defined[:, None], wrench, 0.0)
    return _regular(given, posture.actuator_forces(wrench))


def forces_if_anchors_slide(value, given, _):
    """The size, which weights torques against forces where there is a choice, changes."""
    return None if value.shape[-1] > 6 and given.design.angular.any() else value


def force_scale(expected, given, other):
    """Forces of loads of some units lose digits by the condition number."""
    most = 10.0 * np.where(other.design.angular, other.design.rms_radius, 1.0)
    return np.minimum(condition(given), CONDITION)[:, None] * most


def stiffness(given):
    """The stiffness matrices."""
    return gsp.stiffness(given.design, given.pose, springs(given))


def compliance(given):
    """The compliance matrices."""
    return _regular(given, gsp.statics.compliance(given.design, given.pose, springs(given)))


def directional(given):
    """The stiffness along an oblique direction."""
    values = gsp.statics.directional_stiffness(
        given.design, given.pose, springs(given), [0.3, -0.4, 0.8]
    )
    return _regular(given, values)


def force_size(expected, given, other):
    """A stiffness loses digits by the condition number of the rows."""
    return np.abs(expected) * np.minimum(condition(given), CONDITION)


def covariance(given):
    """The covariance of errors of the pose."""
    return _regular(given, gsp.statics.pose_errors(given.posture, errors(given)).covariance)


def eigenvalues(given):
    """Values of the eigenscrews, NaN at poses whose condition number is not moderate."""
    matrix = _regular(given, stiffness(given))
    return gsp.statics.eigenscrews(matrix).values


def block_scale(expected, given, other):
    """The largest entry of each of the four blocks of 3 × 3, times the condition number."""
    scale = np.empty(expected.shape)
    for rows in (slice(3), slice(3, 6)):
        for columns in (slice(3), slice(3, 6)):
            block = np.abs(expected[..., rows, columns])
            scale[..., rows, columns] = block.max(axis=(-2, -1), keepdims=True)
    return scale * np.minimum(condition(given), CONDITION)[:, None, None]


def eigenvalue_scale(expected, given, other):
    """Eigenvalues of a stiffness about an origin that is far away lose its square."""
    lost = other.distance * np.minimum(condition(given), CONDITION) ** 2
    return lost[:, None] * np.abs(expected).max(axis=-1, keepdims=True)


def bounded(given):
    """Whether bounds over a small box of positions hold the values there, and are narrow."""
    pose, size = given.pose[0], given.design.rms_radius
    box = gsp.PoseBox.around(pose, 1e-6 * size * np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]))
    posture, found = given.design.at(pose), []
    for index, value in (
        ("CTN", gsp.indices.control_number(posture, given.length)),
        ("|det J|", gsp.indices.manipulability(posture)),
        (given.design.joint_names[0], posture.joints[0]),
    ):
        low, high = gsp.bounds(given.design, box, index, length=given.length, budget=100)
        narrow = high - low < 1e-2 * value or given.distance > 1e3
        found += [low <= value <= high, narrow]
    return np.array(found, dtype=float)


def distance_bracket(given):
    """Lower and upper end of the distance to the nearest singular pose."""
    found = gsp.singularity_distance(given.design, given.pose[0], given.length, budget=500)
    return np.array([float(found.lower), float(found.upper)])
