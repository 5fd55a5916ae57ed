from dataclasses import replace

import numpy as np
import pytest

import gsp
from gsp.limits.bounds import bounded_quantities
from gsp.limits.quantities import Quantities, moved


@pytest.fixture
def poses():
    rng = np.random.default_rng(1)
    place = rng.normal(loc=(0, 0, 8), size=(5, 3))
    return gsp.Pose.from_quaternion(place, rng.normal(size=(5, 4)))


def test_rows_of_distances_are_those_of_the_posture(platform, poses):
    values, rows = bounded_quantities(platform).evaluate(poses.position, poses.rotation)
    posture = platform.at(poses)
    assert np.allclose(values, posture.joints, rtol=1e-15)
    assert np.allclose(rows, posture.jacobian, atol=1e-14)


def test_curvature_against_second_differences_of_the_lengths(platform, poses):
    bounds = bounded_quantities(platform)
    weight = np.random.default_rng(2).normal(size=(5, 6))
    bend = bounds.curvature(poses.position, poses.rotation, weight)
    step = 1e-3

    def total(x):
        p, r = moved(poses.position, poses.rotation, np.broadcast_to(x, (5, 6)), 1.0)
        return (bounds.quantities.values(p, r) * weight).sum(axis=-1)

    for i in range(6):
        for j in range(6):
            e, f = step * np.eye(6)[[i, j]]
            second = (total(e + f) + total(-e - f) - total(e - f) - total(f - e)) / (4 * step**2)
            assert np.allclose(second, bend[:, i, j], atol=2e-5 * np.abs(bend).max())


def test_curvature_without_a_formula_agrees(platform, poses):
    bounds = bounded_quantities(platform)
    q = bounds.quantities
    plain = replace(bounds, quantities=Quantities(q.values, q.evaluate))
    weight = np.random.default_rng(3).normal(size=(5, 6))
    exact = bounds.curvature(poses.position, poses.rotation, weight)
    found = plain.curvature(poses.position, poses.rotation, weight)
    assert np.allclose(found, exact, atol=1e-8)
