"""Fits with unknown poses reach the minimum that a dense trust region reaches from there."""

import numpy as np
import pytest
from scipy.optimize import least_squares

import gsp
from gsp.calibration.measurements import Linear
from gsp.calibration.reduction import LinearProblem, filtered
from tests.support import turn

# 1 % of the size.
ERROR = 0.01
# Distances that a reading is, from d (k, n, 3), base lines (n, 3) and platform lines (k, n, 3).
DISTANCES = {
    "D1": lambda d, s, t: d,
    "D2": lambda d, s, t: np.cross(d, t),
    "D3": lambda d, s, t: np.cross(d, s),
}
CASES = [
    (["D1"] * 7, 0, 1.0, 60),
    (["D1"] * 7, 1, 1e-3, 60),
    (["D1"] * 7, 2, 1e4, 60),
    (["D1"] * 7, 0, 1.0, 40),
    (["D1"] * 8, 0, 1.0, 60),
    (["D1"] * 8, 1, 1e4, 60),
    (["D1"] * 8, 2, 1.0, 40),
    (["D3"] * 7, 0, 1.0, 60),
    (["D3"] * 7, 1, 1e-3, 60),
    (["D3"] * 7, 2, 1e4, 60),
    (["D2"] * 7, 0, 1.0, 60),
    (["D1", "D2", "D3", "D1", "D2", "D3", "D1"], 0, 1.0, 60),
    (["D1", "D2", "D3", "D1", "D2", "D3", "D1"], 1, 1e4, 60),
    (["D2", "D3"] * 4, 0, 1e-3, 60),
]


def unit(x):
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


class Machine:
    """A nominal design and a real one of unit size 1, and readings at poses, by own formulas."""

    def __init__(self, legs, seed, poses):
        rng, n = np.random.default_rng(seed), len(legs)
        self.legs = legs
        at = rng.uniform(0.0, 2.0 * np.pi, n)
        base = np.column_stack((2.0 * np.cos(at), 2.0 * np.sin(at), 0.3 * rng.normal(size=n)))
        top = np.column_stack((np.cos(at + 0.6), np.sin(at + 0.6), 0.2 * rng.normal(size=n)))
        lines = unit(rng.normal(size=(2, n, 3)))
        self.nominal = (base, top, *lines)
        self.real = tuple(x + ERROR * rng.normal(size=x.shape) for x in self.nominal)
        self.zeros = ERROR * rng.normal(size=n)
        self.poses, self.others = (self.drawn(rng, k) for k in (poses, 30))

    def drawn(self, rng, k):
        place = rng.uniform(-0.5, 0.5, (k, 3)) + [0.0, 0.0, 1.6]
        return place, rng.uniform(-0.5, 0.5, (k, 3))

    def readings(self, parts, zeros, poses):
        """Values (k, n) less zero points, by definition of the distances."""
        base, top, s, t = parts[0], parts[1], unit(parts[2]), unit(parts[3])
        rotation = turn(poses[1])
        t = np.einsum("kij,nj->kni", rotation, t)
        d = poses[0][:, None] + np.einsum("kij,nj->kni", rotation, top) - base
        found = [DISTANCES[leg](d[:, i], s[i], t[:, i]) for i, leg in enumerate(self.legs)]
        return np.linalg.norm(found, axis=-1).T - zeros

    def design(self, size):
        base, top, s, t = self.nominal
        home = gsp.Pose([0.0, 0.0, 1.6 * size])
        return gsp.Design(self.legs, base * size, top * size, s, t, home=home)


def pose(poses, size):
    return gsp.Pose(poses[0] * size, turn(poses[1]))


@pytest.mark.parametrize(("legs", "seed", "size", "poses"), CASES)
def test_readings_alone_are_fitted_exactly(legs, seed, size, poses):
    """Exact readings, and what they predict at the poses of others, up to motions of the frames."""
    machine = Machine(legs, seed, poses)
    given = machine.readings(machine.real, machine.zeros, machine.poses) * size
    guess = pose(machine.poses, size)
    found = gsp.calibrate(machine.design(size), given, guess=guess)
    assert found.converged
    assert found.iterations < 30
    assert np.abs(found.residuals).max() < 1e-9 * size
    # The real machine at other poses: some pose of the design that was found has these readings.
    wanted = machine.readings(machine.real, machine.zeros, machine.others) * size
    others = gsp.calibrate(
        found.design, wanted + found.zero_points, guess=pose(machine.others, size), free="joints"
    )
    assert np.abs(others.zero_points).max() < 1e-9 * size
    assert np.abs(others.residuals).max() < 1e-9 * size


def test_the_least_cost_with_noise_is_that_of_scipy():
    """All unknowns together, by differences of own residuals; the base is known."""
    machine = Machine(["D1"] * 8, 3, 24)
    machine.nominal = (machine.real[0], *machine.nominal[1:])
    noise = 1e-4
    exact = machine.readings(machine.real, machine.zeros, machine.poses)
    given = exact + np.random.default_rng(0).normal(0.0, noise, exact.shape)
    found = gsp.calibrate(
        machine.design(1.0), given, guess=pose(machine.poses, 1.0), joint_errors=noise,
        free=["platform_points", "joints"],
    )  # fmt: skip

    def residuals(x):
        top, zeros, poses = np.split(x, [24, 32])
        parts = (machine.nominal[0], top.reshape(8, 3), *machine.nominal[2:])
        place, angles = np.split(poses.reshape(-1, 6), 2, axis=1)
        return ((machine.readings(parts, zeros, (place, angles)) - given) / noise).ravel()

    start = (machine.nominal[1].ravel(), np.zeros(8), np.hstack(machine.poses).ravel())
    start = np.concatenate(start)
    theirs = least_squares(residuals, start, xtol=1e-9, ftol=1e-9, gtol=1e-9, max_nfev=60)
    assert found.converged
    assert found.degrees_of_freedom == 8 * 24 - 6 * 24 - 32 + 6
    np.testing.assert_allclose(found.chi_squared, 2.0 * theirs.cost, rtol=1e-6)


@pytest.mark.parametrize("seed", [1, 2])
def test_places_without_a_guess(seed):
    """Lines of mixed legs, from the home pose."""
    machine = Machine(["D1", "D2", "D3"] * 2, seed, 60)
    given = machine.readings(machine.real, machine.zeros, machine.poses)
    point = np.array([0.1, 0.2, 0.3])
    places = machine.poses[0] + turn(machine.poses[1]) @ point
    found = gsp.calibrate(machine.design(1.0), given, places, point=point)
    assert found.converged
    assert np.abs(found.residuals).max() < 1e-9


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.5, 30.0])
def test_a_damped_step_is_that_of_all_unknowns_together(damping):
    """Poses are eliminated: as dense least squares with rows μ I; one pose is singular."""
    rng = np.random.default_rng(0)
    k, m, p = 4, 9, 5
    by_pose = rng.normal(size=(k, m, 6))
    by_pose[1, :, 5] = by_pose[1, :, 4]
    linear = Linear(rng.normal(size=(k, m)), by_pose, rng.normal(size=(k, m, p)))
    step = LinearProblem.of(linear, np.ones((k, m)), exact=False).step(damping)
    dense = np.zeros((k, m, 6 * k + p))
    for i in range(k):
        dense[i, :, 6 * i : 6 * i + 6] = by_pose[i]
    dense[:, :, 6 * k :] = linear.by_dimensions
    flat, r = dense.reshape(k * m, -1), linear.residuals.ravel()
    rows = np.vstack((flat, damping * np.eye(6 * k + p)))
    wanted = np.linalg.lstsq(rows, np.concatenate((-r, np.zeros(6 * k + p))))[0]
    found = np.concatenate((step.poses.ravel(), step.dimensions))
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-11)
    change = (r**2).sum() - ((r + flat @ wanted) ** 2).sum()
    np.testing.assert_allclose(step.predicted, change, rtol=1e-10)


def test_rounding_and_zeros_are_not_inverted():
    inverse, left = filtered(np.array([2.0, 1e-12, 0.0]), 0.0)
    np.testing.assert_array_equal(inverse, [0.5, 0.0, 0.0])
    np.testing.assert_array_equal(left, [0.0, 1.0, 1.0])
    np.testing.assert_allclose(filtered(np.array([3.0]), 4.0), [[3 / 25], [4 / 5]], rtol=1e-15)
