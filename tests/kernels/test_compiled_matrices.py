"""The compiled solver against 50 digits: ordinary, clustered, symmetric, singular matrices."""

import mpmath
import numpy as np
import pytest
from scipy.stats import ortho_group

from tests.kernels.matrices import exact, solved

EPS = np.finfo(float).eps
FLOOR = 1e-13


def with_values(values, seed, rows=6):
    left = ortho_group.rvs(rows, random_state=seed)[:, :6]
    right = ortho_group.rvs(6, random_state=seed + 1000)
    return left * np.asarray(values, dtype=float) @ right


def check(matrices):
    for got, matrix in zip(solved(matrices), matrices, strict=True):
        wanted = exact(matrix)
        allowed = max(FLOOR, 5 * EPS / float(wanted[0]))
        for value, truth in zip(got, wanted, strict=True):
            with mpmath.workdps(50):
                assert abs(value - truth) <= allowed * truth


@pytest.mark.parametrize("exponent", range(15))
def test_graded_spectra_up_to_condition_1e14(exponent):
    check([with_values(np.geomspace(1, 10.0**-exponent, 6), seed) for seed in range(3)])


@pytest.mark.parametrize("exponent", [1, 5, 9, 13, 14])
def test_one_small_singular_value(exponent):
    check([with_values([3, 2, 2, 1, 1, 10.0**-exponent], seed) for seed in range(3)])


@pytest.mark.parametrize("size", [2, 3, 4, 5])
@pytest.mark.parametrize("spread", [0.0, 1e-15, 1e-12, 1e-8, 1e-6, 1e-4, 1e-2])
def test_clusters_at_both_ends(size, spread):
    cluster = 1 + spread * np.arange(size)
    rest = 6 - size
    low = np.concatenate((np.linspace(2, 7, rest), cluster))
    high = np.concatenate((10 * cluster, np.linspace(1, 7, rest)))
    tiny = np.concatenate((np.linspace(2, 7, rest), 1e-7 * cluster))
    check([with_values(values, size) for values in (low, high, tiny)])


@pytest.mark.parametrize("spread", [0.0, 1e-16, 1e-14, 1e-10, 1e-8, 1e-6, 1e-3])
def test_isotropic_matrices(spread):
    check([with_values(5 * (1 + spread * np.arange(6)), seed) for seed in range(3)])


def test_exact_doubles_of_matrices_without_rounding():
    check(
        [
            np.eye(6),
            7 * np.eye(6)[::-1],
            np.diag([1.0, 1, 2, 2, 3, 3]),
            np.diag([8.0, 8, 8, 1, 1, 1]),
        ]
    )


@pytest.mark.parametrize("rows", [7, 8, 12])
def test_redundant_matrices(rows):
    check([with_values(np.geomspace(1, 1e-6, 6), seed, rows) for seed in range(3)])


@pytest.mark.parametrize("factor", [1e-100, 1e100])
def test_extreme_scales(factor):
    matrix = with_values([3, 2, 2, 1, 1, 0.5], 1)
    ratio, least, _ = solved([factor * matrix])[0]
    wanted = exact(matrix)
    assert ratio == pytest.approx(float(wanted[0]), rel=FLOOR)
    assert least == pytest.approx(factor * float(wanted[1]), rel=FLOOR)


@pytest.mark.parametrize("rank", range(6))
def test_deficient_matrices_are_singular(rank):
    values = np.concatenate((np.linspace(1, 3, rank), np.zeros(6 - rank)))
    assert (solved([with_values(values, seed) for seed in range(3)]) == 0.0).all()
    assert (solved([np.diag(values)]) == 0.0).all()


def test_random_matrices_agree_with_lapack():
    matrices = np.random.default_rng(5).normal(size=(2000, 6, 6))
    values = np.linalg.svd(matrices, compute_uv=False)
    condition = values[:, 0] / values[:, -1]
    ratio, least, volume = solved(matrices).T
    bound = np.maximum(FLOOR, 10 * EPS * condition)
    assert (np.abs(ratio * condition - 1) <= bound).all()
    assert (np.abs(least / values[:, -1] - 1) <= bound).all()
    assert (np.abs(volume / np.abs(np.linalg.det(matrices)) - 1) <= bound).all()
