"""The compiled indices of UPS designs against 50 digits, from the pose to the value."""

import mpmath
import numpy as np
import pytest
from mpmath import matrix, mpf

import gsp

EPS = np.finfo(float).eps
LENGTH = 1.25
AXES, CENTRE = (0.5, 0.25, 0.75), (0.125, -0.25, 0.5)


def cross(x, y):
    return [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]


def skew(x):
    return matrix([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])


def exact_legs(design, position, rotation):
    """(direction, length, arm) of each leg."""
    r = matrix(rotation.tolist())
    for a, b in zip(design.base_points, design.platform_points, strict=True):
        arm = list(r * matrix(b.tolist()))
        d = [
            mpf(p) + x - mpf(y) for p, x, y in zip(position.tolist(), arm, a.tolist(), strict=True)
        ]
        size = mpmath.sqrt(sum(x * x for x in d))
        yield [x / size for x in d], size, arm


def exact_jacobian(legs):
    return matrix([[*u, *cross(arm, u)] for u, _, arm in legs])


def exact_passive(legs):
    """T of Nawratil: rates of the leg directions seen from base and from platform, squared."""
    total = matrix(6, 6)
    for u, size, arm in legs:
        project = mpmath.eye(3) - matrix(u) * matrix(u).T
        velocity, seen = matrix(3, 6), matrix(3, 6)
        velocity[:, :3], velocity[:, 3:] = project / size, -project * skew(arm) / size
        seen[:, :3], seen[:, 3:] = velocity[:, :3], velocity[:, 3:] + skew(u)
        total += velocity.T * velocity + seen.T * seen
    return total


def exact_vertices(rotation):
    """D of Nawratil: squared speeds of the six vertices of the ellipsoid."""
    r, total = matrix(rotation.tolist()), matrix(6, 6)
    for axis in range(3):
        for sign in (1, -1):
            point = [mpf(c) for c in CENTRE]
            point[axis] += sign * mpf(AXES[axis])
            row = matrix(3, 6)
            row[:, :3], row[:, 3:] = mpmath.eye(3), -skew(list(r * matrix(point)))
            total += row.T * row
    return total


def exact_condition(jacobian, metric=None):
    """√(λ⁺/λ⁻) of (metric, JᵀJ)."""
    normal = jacobian.T * jacobian
    if metric is not None:
        inverse = mpmath.cholesky(metric) ** -1
        normal = inverse * normal * inverse.T
    values = mpmath.eigsy(normal, eigvals_only=True)
    return mpmath.sqrt(values[5] / values[0])


def exact_values(design, position, rotation):
    legs = list(exact_legs(design, position, rotation))
    jacobian = exact_jacobian(legs)
    scaled = jacobian * mpmath.diag([1, 1, 1] + [1 / mpf(LENGTH)] * 3)
    return {
        "condition_number": exact_condition(scaled),
        "condition_number_ellipsoid": exact_condition(jacobian, exact_vertices(rotation)),
        "control_number": 1 / exact_condition(jacobian, exact_passive(legs)),
        "quality_index": abs(mpmath.det(jacobian)),
    }


def hexapod(seed):
    rng = np.random.default_rng(seed)
    base, platform = rng.normal(size=(2, 6, 3)) * [1, 1, 0]
    return gsp.Design(["D1"] * 6, 3 * base, platform)


def check(design, pose):
    frame = gsp.evaluate(
        design,
        pose,
        [*GATES],
        length=LENGTH,
        maximum=1.0,
        ellipsoid=gsp.Ellipsoid(AXES, CENTRE),
    )
    for i, row in frame.iterrows():
        with mpmath.workdps(50):
            wanted = exact_values(design, pose.position[i], pose.rotation[i])
            conditions = {**wanted, "control_number": 1 / wanted["control_number"]}
            conditions["quality_index"] = wanted["condition_number"]
            for name, gate in GATES.items():
                allowed = max(1e-13, gate * EPS * float(conditions[name]))
                error = abs(mpf(row[name]) / wanted[name] - 1)
                assert error <= allowed, (name, i, float(conditions[name]))


GATES = {
    "condition_number": 5,
    "quality_index": 5,
    "condition_number_ellipsoid": 10,
    "control_number": 10,
}


@pytest.mark.parametrize("seed", range(3))
def test_ordinary_postures(seed):
    rng = np.random.default_rng(seed)
    pose = gsp.Pose.from_rpy(rng.normal((0, 0, 4), size=(4, 3)), rng.normal(size=(4, 3)) / 3)
    check(hexapod(seed), pose)


@pytest.mark.parametrize("seed", range(3))
def test_postures_up_to_condition_1e14(seed):
    """Base and platform are plane, and singular when they lie in one plane."""
    heights = np.geomspace(1e-4, 3e-13, 9)
    position = np.stack((0.3 + 0 * heights, 0.2 + 0 * heights, heights), axis=1)
    check(hexapod(seed), gsp.Pose(position))


def test_postures_on_a_symmetry_axis():
    """Singular values are double there."""
    thirds = np.repeat(np.arange(3) * 2 * np.pi / 3, 2)
    base, platform = (thirds + np.tile([-half, half], 3) for half in (0.25, 0.875))
    rings = (np.stack((np.cos(x), np.sin(x), 0 * x), axis=1) for x in (base, platform))
    design = gsp.Design(["D1"] * 6, *rings)
    check(design, gsp.Pose.from_rpy([0, 0, 1.5], [[0, 0, 0.25], [0, 0, 0.5], [0, 0, 1.0]]))
