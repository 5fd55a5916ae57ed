"""The reviewed indices against 50-digit arithmetic, up to conditions of 1e10."""

import mpmath
import numpy as np
import pytest

import gsp
from gsp.families.nawratil.motion import singular_angle, turned
from gsp.indices import INDICES
from gsp.indices.cdn_points import largest_triangles
from tests import exact
from tests.support import random_design, random_pose

LENGTH = 0.8


def condition(metric, rates):
    low, high = exact.extremes(metric, rates)
    return mpmath.sqrt(high / low)


def least(matrix):
    return mpmath.sqrt(min(mpmath.eigsy(mpmath.matrix(matrix), eigvals_only=True)))


def inverse(matrix):
    return np.array((mpmath.matrix(matrix) ** -1).tolist())


def in_fifty_digits(design, pose):
    """The indices by normal equations, which do no harm with so many digits."""
    with mpmath.workdps(exact.DIGITS):
        screws, one = exact.screw_rates(design, pose), exact.identity(6)
        plain = exact.weighted_rows(design, screws, 1)
        rows = exact.weighted_rows(design, screws, LENGTH)
        # v = q̂ − p × ω, with q̂ the velocity of the base origin.
        shift = exact.identity(6)
        shift[:3, 3:] = -exact.skew(exact.exact(pose.position))
        about_base = plain @ shift
        turn = exact.exact(pose.rotation)
        points = [turn @ x for x in exact.exact(largest_triangles(design)[0])]
        velocities = [np.concatenate((one[:3, :3], -exact.skew(x)), axis=1) for x in points]
        v, w = rows[:, :3], rows[:, 3:]
        scale = np.array([mpmath.mpf(1)] * 3 + [mpmath.mpf(LENGTH)] * 3)
        screw_part = w.T @ w - w.T @ v @ inverse(v.T @ v) @ v.T @ w
        legs = [i for i, leg in enumerate(design.legs) for _ in leg.constraints]
        arms = [turn @ b for b in exact.exact(design.platform_points[legs])]
        growth = np.array([row[:3] @ arm for row, arm in zip(plain, arms, strict=True)])
        omega = (inverse(plain) @ growth)[3:]
        return {
            "condition_number_plain": float(condition(one, about_base.T @ about_base)),
            "condition_number_points": float(
                condition(sum(x.T @ x for x in velocities), rows.T @ rows)
            ),
            "complex_deviation_rotation": float(least(screw_part)),
            "complex_deviation_translation": float(least(v.T @ v)),
            "local_conditioning": float(1 / condition(one, (rows / scale).T @ (rows / scale))),
            "greatest_force": float(
                max(mpmath.sqrt(sum(x**2 for x in column)) for column in inverse(rows / scale).T)
            ),
            "rigidity_rate": float(mpmath.atan(1 / mpmath.sqrt(omega @ omega))),
        }


def assert_close(design, pose):
    posture = design.at(pose)
    size = float(gsp.indices.condition_number(posture, LENGTH))
    for name, wanted in in_fifty_digits(design, pose).items():
        index = INDICES[name]
        given = {"length": LENGTH} if "length" in index.parameters else {}
        found = float(index.function(posture, **given))
        bound = 4e-15 * max(size, gsp.indices.condition_number_plain(posture))
        assert found == pytest.approx(wanted, rel=bound), name
    return size


@pytest.mark.parametrize("axis", ["x", "y"])
def test_towards_a_singular_posture(axis):
    largest = 0.0
    for offset in (1e-1, 1e-3, 1e-6, 1e-9):
        posture = turned(axis, singular_angle(axis) + offset)
        largest = max(largest, assert_close(posture.design, posture.pose))
    assert largest > 1e8


@pytest.mark.parametrize("name", ["D1^6", "D2^3 D3^3", "D4^6", "D1^3 D2 D3 A1", "D1 D2 D3 D4 A1^2"])
def test_random_geometry(name):
    rng = np.random.default_rng(len(name))
    legs = [leg.name for leg in gsp.catalogue.mechanism(name).legs]
    for _ in range(3):
        assert_close(random_design(rng, legs), random_pose(rng))
