"""Small-matrix numerics over stacks, against numpy one by one and against definitions."""

import mpmath
import numpy as np
import pytest

from gsp.geometry.matrices import (
    RESIDUAL_TOLERANCE,
    absolute_determinant,
    condition,
    defined_matrices,
    determinant_sign,
    full_rank,
    newton,
    reciprocal_condition,
    singular_values,
    solve_least_squares,
    solve_linear,
    solve_right_triangular,
    whiten,
)

SHAPES = [(), (1,), (3, 1, 2), (0,)]


def stack(shape, rows=6, seed=0):
    return np.random.default_rng(seed).standard_normal((*shape, rows, 6))


@pytest.mark.parametrize("rows", [6, 9])
@pytest.mark.parametrize("shape", SHAPES)
def test_singular_values(shape, rows):
    matrices = stack(shape, rows)
    values = singular_values(matrices)
    assert values.shape == (*shape, 6)
    for index in np.ndindex(shape):
        np.testing.assert_array_equal(
            values[index], np.linalg.svd(matrices[index], compute_uv=False)
        )
    assert reciprocal_condition(values).shape == shape
    assert absolute_determinant(matrices).shape == shape


def test_the_sign_of_a_determinant_is_zero_where_the_rank_is_not_full():
    matrices = stack((40,))
    np.testing.assert_array_equal(determinant_sign(matrices), np.sign(np.linalg.det(matrices)))
    # The determinants of these are below the least number.
    np.testing.assert_array_equal(determinant_sign(1e-60 * matrices), determinant_sign(matrices))
    matrices[:, 5] = matrices[:, :5].sum(axis=1)
    assert np.linalg.det(matrices).any()
    assert not determinant_sign(matrices).any()
    assert determinant_sign(np.empty((0, 3, 3))).shape == (0,)
    assert determinant_sign(np.zeros((3, 3))) == 0.0


FUNCTIONS = {
    "singular_values": singular_values,
    "reciprocal_condition": lambda m: reciprocal_condition(singular_values(m)),
    "absolute_determinant": absolute_determinant,
    "determinant_sign": determinant_sign,
    "whiten (matrix)": lambda m: whiten(m, stack((5,), 12, seed=1)),
    "whiten (metric)": lambda m: whiten(
        stack((5,), 6, seed=1), np.concatenate((m, m + 1.0), axis=-2)
    ),
}


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("bad", range(5))
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_nan_stays_in_its_matrix(name, bad, value):
    matrices = stack((5,))
    dirty = matrices.copy()
    dirty[bad, 1, 2] = value
    one, two = FUNCTIONS[name](matrices), FUNCTIONS[name](dirty)
    if name == "reciprocal_condition" and value == np.inf:  # the row of a singular drive
        assert two[bad] == 0.0
    else:
        assert not np.isfinite(two[bad]).all()
    good = np.arange(5) != bad
    np.testing.assert_array_equal(two[good], one[good])
    np.testing.assert_array_equal(defined_matrices(dirty), good)


def test_all_nan_raises_nothing():
    for function in FUNCTIONS.values():
        assert np.isnan(function(np.full((5, 6, 6), np.nan))).all()


def test_reciprocal_condition():
    values = np.array([
        [1, 1, 1, 1, 1, 1], [8, 4, 4, 4, 4, 2], [1, 1, 1, 1, 1, 0], [0, 0, 0, 0, 0, 0],
        [1, 1, 1, 1, 1, 1e-15], [1, 1, 1, 1, 1, 2e-15], [1e300, 1, 1, 1, 1, 1e290], [np.nan] * 6,
    ])  # fmt: skip
    expected = [1, 0.25, 0, 0, 0, 2e-15, 1e-10, np.nan]
    np.testing.assert_allclose(reciprocal_condition(values), expected, rtol=1e-15)
    np.testing.assert_array_equal(full_rank(values), np.array(expected) > 0.0)
    wanted = [1, 4, np.inf, np.inf, np.inf, 5e14, 1e10, np.nan]
    np.testing.assert_allclose(condition(values), wanted, rtol=1e-15)


@pytest.mark.parametrize("rows", [6, 7, 12])
def test_absolute_determinant(rows):
    """Against 50 digits, also where the matrix is nearly singular."""
    matrices = stack((4,), rows)
    matrices[1:, :, 5] = matrices[1:, :, 4] + matrices[1:, :, 5] * 1e-6
    for matrix, value in zip(matrices, absolute_determinant(matrices), strict=True):
        with mpmath.workdps(50):
            exact = mpmath.matrix(matrix.tolist())
            expected = mpmath.sqrt(mpmath.det(exact.T * exact))
        assert value == pytest.approx(float(expected), rel=1e-9)


@pytest.mark.parametrize("shape", SHAPES)
def test_solve_right_triangular(shape):
    upper = np.triu(stack(shape)) + 3.0 * np.eye(6)
    matrix = stack(shape, 4, seed=1)
    np.testing.assert_allclose(solve_right_triangular(matrix, upper) @ upper, matrix, atol=1e-12)


def test_zero_on_the_diagonal_touches_its_element_only():
    upper = np.stack((np.eye(6), np.eye(6)))
    upper[0, 3, 3] = 0.0
    result = solve_right_triangular(stack((2,), 4), upper)
    assert not np.isfinite(result[0]).all()
    np.testing.assert_array_equal(result[1], stack((2,), 4)[1])


@pytest.mark.parametrize("shape", SHAPES)
def test_whiten_by_its_definition(shape):
    """(M R⁻¹)ᵀ (M R⁻¹) = R⁻ᵀ N R⁻¹ has the eigenvalues of (N, WᵀW)."""
    matrix, root = stack(shape, 7), stack(shape, 12, seed=1)
    values = singular_values(whiten(matrix, root))
    for index in np.ndindex(shape):
        n, metric = matrix[index].T @ matrix[index], root[index].T @ root[index]
        expected = np.sort(np.linalg.eigvals(np.linalg.solve(metric, n)).real)[::-1]
        np.testing.assert_allclose(values[index] ** 2, expected, rtol=1e-9)


# --- Newton's method ---


def circles(points):
    """Where the unit circle meets the line y = c x, c = 0, 1, 2, …: two equations each."""
    x, y = points.T
    slope = np.arange(len(points))
    f = np.stack((x**2 + y**2 - 1.0, y - slope * x), axis=-1)
    rows = np.array([[[2 * a, 2 * b], [-c, 1.0]] for a, b, c in zip(x, y, slope, strict=True)])
    return f, rows


@pytest.mark.parametrize("solve", [solve_linear, solve_least_squares])
def test_newton_solves_each_system_of_a_batch(solve):
    start = np.array([[3.0, 0.5], [0.1, 2.0], [5.0, 5.0], [-2.0, -1.0]])
    found, residual = newton(
        start, circles, lambda p, step: p + step, solve=solve, longest=0.5, most=60
    )
    slope = np.arange(4.0)
    x = np.where(start[:, 0] < 0.0, -1.0, 1.0) / np.sqrt(1.0 + slope**2)
    np.testing.assert_allclose(found, np.stack((x, slope * x), axis=-1), atol=1e-14)
    assert (residual < RESIDUAL_TOLERANCE).all()


def test_newton_never_takes_longer_steps_and_leaves_what_is_undefined():
    moves = []

    def equations(points):
        f, rows = circles(points)
        f[1] = np.nan
        return f, rows

    def move(points, step):
        moves.append(np.abs(step).max(axis=1))
        return points + step

    start = np.array([[9.0, 1.0], [3.0, 3.0], [0.3, 0.6]])
    found, residual = newton(start, equations, move, solve=solve_linear, longest=0.25, most=100)
    assert np.max(moves) <= 0.25 * (1 + 1e-15)
    assert np.max(moves, axis=0)[0] == pytest.approx(0.25)
    assert (found[1] == start[1]).all()
    assert np.isnan(residual[1])
    assert (residual[[0, 2]] < RESIDUAL_TOLERANCE).all()


def test_newton_leaves_what_has_no_defined_step():
    """Residuals are finite, but no step is: neither a warning nor a move."""

    def equations(points):
        return points - 1.0, np.full((len(points), 1, 1), np.nan)

    start = np.array([[3.0], [0.5]])
    found, residual = newton(
        start, equations, lambda p, s: p + s, solve=solve_linear, longest=0.5, most=5
    )
    assert (found == start).all()
    assert residual.tolist() == [2.0, 0.5]


def test_newton_without_a_solution_returns_a_large_residual():
    def equations(points):
        x = points[:, 0]
        return (x**2 + 1.0)[:, None], (2.0 * x)[:, None, None]

    _, residual = newton(
        np.array([[3.0]]), equations, lambda p, s: p + s, solve=solve_linear, longest=0.5, most=50
    )
    assert residual[0] >= 1.0


def test_newton_returns_the_residual_of_the_returned_state():
    """The last step is a long one, away from a small residual: an almost singular matrix."""

    def equations(points):
        x = points[:, 0]
        return (1e-9 * (1.0 + x))[:, None], np.full((1, 1, 1), 1e-15)

    found, residual = newton(
        np.array([[-0.5]]), equations, lambda p, s: p + s, solve=solve_linear, longest=9.0, most=3
    )
    assert residual[0] == 1e-9 * abs(1.0 + found[0, 0])


def test_least_squares_takes_repeated_equations():
    """Equations that repeat each other, as those of symmetric designs: the shortest step."""
    rows = np.array([[[1.0, 1.0, 0.0], [2.0, 2.0, 0.0], [0.0, 0.0, 3.0]]])
    step = solve_least_squares(rows, np.array([[2.0, 4.0, 6.0]]))
    np.testing.assert_allclose(step, [[1.0, 1.0, 2.0]], rtol=1e-14)
