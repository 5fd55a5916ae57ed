from dataclasses import replace

import numpy as np
import pytest

import gsp
from gsp.limits.bounds import bounded_quantities
from gsp.limits.quantities import SECOND_DIFFERENCE_STEP, Quantities, moved
from gsp.model.posture.assembly import FEW_POSES
from gsp.workspace import Limits

MIXED = "toz-kucuk-2016-d1-d2-d3-d4-a1-2"


@pytest.fixture
def poses():
    rng = np.random.default_rng(1)
    place = rng.normal(loc=(0, 0, 8), size=(5, 3))
    return gsp.Pose.from_quaternion(place, rng.normal(size=(5, 4)))


def test_joints_are_distances_and_rows_their_lines_about_the_origin(platform, poses):
    values, rows = bounded_quantities(platform).evaluate(poses.position, poses.rotation)
    for p, r, value, row in zip(poses.position, poses.rotation, values, rows, strict=True):
        arm = platform.platform_points @ r.T
        leg = p + arm - platform.base_points
        length = np.linalg.norm(leg, axis=1)
        line = leg / length[:, None]
        np.testing.assert_allclose(value, length, rtol=1e-14)
        np.testing.assert_allclose(row, np.hstack((line, np.cross(arm, line))), atol=1e-13)


@pytest.mark.parametrize("name", ["workspace-6-3", MIXED])
def test_few_poses_have_the_same_bits_as_many(name):
    design = gsp.catalogue.design(name)
    limits = Limits(strokes=[[-np.inf, 1e6]] * 6)
    bounds = bounded_quantities(design, limits)
    box = gsp.PoseBox.around(design.home, [0.1, 0.1, 0.1, 0.2, 0.2, 0.2])
    poses = box.sample(FEW_POSES + 1, rng=2)
    values, rows = bounds.evaluate(poses.position, poses.rotation)
    assert np.array_equal(values, bounds.quantities.values(poses.position, poses.rotation))
    for count in (1, 7, FEW_POSES):
        value, row = bounds.evaluate(poses.position[:count], poses.rotation[:count])
        assert np.array_equal(value, values[:count])
        assert np.array_equal(row, rows[:count])


def test_curvature_against_second_differences_of_the_lengths(platform, poses):
    bounds = bounded_quantities(platform)
    weight = np.random.default_rng(2).normal(size=(5, 6))
    bend = bounds.curvature(poses.position, poses.rotation, weight)
    step = 1e-3

    def total(x):
        p, r = moved(poses.position, poses.rotation, np.broadcast_to(x, (5, 6)), bounds.scale)
        return (bounds.quantities.values(p, r) / bounds.sizes * weight).sum(axis=-1)

    for i in range(6):
        for j in range(6):
            e, f = step * np.eye(6)[[i, j]]
            second = (total(e + f) + total(-e - f) - total(e - f) - total(f - e)) / (4 * step**2)
            assert np.allclose(second, bend[:, i, j], atol=2e-5 * np.abs(bend).max())


@pytest.mark.parametrize("name", ["workspace-6-3", MIXED])
def test_curvature_by_differences_of_values_agrees(name):
    design = gsp.catalogue.design(name)
    poses = gsp.PoseBox.around(design.home, [0.1, 0.1, 0.1, 0.2, 0.2, 0.2]).sample(5, rng=4)
    bounds = bounded_quantities(design, Limits(strokes=[[-np.inf, 1e6]] * 6))
    q = bounds.quantities
    plain = replace(bounds, quantities=Quantities(q.values, q.evaluate))
    weight = np.random.default_rng(3).normal(size=(5, 6))
    exact = bounds.curvature(poses.position, poses.rotation, weight)
    found = plain.curvature(poses.position, poses.rotation, weight)
    # The rounding of the sum is divided by the square of the step; its terms add to `largest`.
    values = q.values(poses.position, poses.rotation) / bounds.sizes
    largest = np.abs(weight * values).sum(axis=-1).max()
    rounding = 8.0 * np.finfo(np.float64).eps * largest / SECOND_DIFFERENCE_STEP**2
    assert np.allclose(found, exact, rtol=0.0, atol=rounding)
    assert rounding < 2e-6 * np.abs(exact).max()
