"""Angles, inverses and rotations of the kernels, against mpmath, numpy and scipy."""

import math

import mpmath
import numpy as np
import pytest

from gsp.geometry import exp3
from gsp.kernels.formulas.arcs import arc
from gsp.kernels.formulas.linear import inverse, rotated

EPS = np.finfo(float).eps


def test_arcs_are_right_to_rounding():
    angles = np.concatenate((np.linspace(1e-9, math.pi - 1e-9, 999), [math.pi / 2, 1e-300]))
    for angle in angles.tolist():
        sine, cosine = 3.0 * math.sin(angle), 3.0 * math.cos(angle)
        exact = mpmath.atan2(mpmath.mpf(sine), mpmath.mpf(cosine))
        assert abs(arc(sine, cosine) - exact) <= 4 * EPS * max(float(exact), 0.5)


@pytest.mark.parametrize("condition", [1.0, 1e3, 1e8])
def test_inverses_are_backward_stable(condition):
    rng = np.random.default_rng(1)
    for _ in range(20):
        u, v = (np.linalg.qr(rng.normal(size=(6, 6)))[0] for _ in range(2))
        matrix = u @ np.diag(np.geomspace(1, 1 / condition, 6)) @ v
        found = np.array(inverse(matrix.tolist()))
        assert np.abs(found @ matrix - np.eye(6)).max() < 100 * EPS * condition


def test_a_singular_matrix_has_no_finite_inverse():
    matrix = [[np.array([float(i + j)]) for j in range(6)] for i in range(6)]
    matrix[5] = [np.zeros(1)] * 6
    with np.errstate(all="ignore"):
        assert not np.isfinite(inverse(matrix)).all()


def test_rotations_are_exponentials():
    rng = np.random.default_rng(2)
    for size in (0.0, 1e-9, 1e-3, 0.1, 0.5):
        turn = rng.normal(size=3)
        turn *= size / np.linalg.norm(turn)
        start = exp3(rng.normal(size=3))
        found = np.reshape(rotated(turn.tolist(), start.ravel().tolist()), (3, 3))
        np.testing.assert_allclose(found, exp3(turn) @ start, rtol=0, atol=4 * EPS)


def test_small_errors_of_a_rotation_are_removed():
    start = exp3([0.3, -0.4, 0.5]) + 1e-9 * np.random.default_rng(3).normal(size=(3, 3))
    found = np.reshape(rotated([0.0, 0.0, 0.0], start.ravel().tolist()), (3, 3))
    assert np.abs(found.T @ found - np.eye(3)).max() < 1e-15
