"""Small-matrix numerics over batches in plain numpy, and Newton's method for systems of them.

LAPACK raises an error for a whole stack if one matrix has a NaN. So undefined matrices are
replaced before the call, and their results are NaN.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import EPS, Array, Mask

# Systems count as solved where no residual is larger [1]: some hundred roundings of equations that
# are scaled to numbers of order one.
RESIDUAL_TOLERANCE = 1e-12
# Newton steps below this [1] move nothing but rounding.
LEAST_NEWTON_STEP = 1e-15

State = TypeVar("State")


def defined_matrices(matrix: Array) -> Mask:
    """Which matrices of a stack have finite entries only: (..., m, k) to (...)."""
    return np.asarray(np.isfinite(matrix).all(axis=(-2, -1)))


def singular_values(matrix: Array) -> Array:
    """Singular values, descending: (..., m, 6) to (..., 6); NaN where the matrix has a NaN.

    Where entries are infinite the largest is infinite and the others are zero: relative to it they
    are below rounding.
    """
    defined = defined_matrices(matrix)
    safe = np.where(defined[..., None, None], matrix, 0.0)
    values = np.where(defined[..., None], np.linalg.svd(safe, compute_uv=False), np.nan)
    if not defined.all():
        endless = ~defined & ~np.isnan(matrix).any(axis=(-2, -1))
        values[endless] = [np.inf] + [0.0] * (values.shape[-1] - 1)
    return values


def reciprocal_condition(values: Array) -> Array:
    """σ_min / σ_max of descending singular values (..., k): in [0, 1], NaN where undefined.

    It is zero where the rank is not full (`full_rank`), because σ_min then has no correct digit.
    """
    largest, smallest = values[..., 0], values[..., -1]
    with np.errstate(invalid="ignore"):
        ratio = smallest / np.where(largest > 0.0, largest, 1.0)
    return np.where(smallest <= rounding_of_rank(largest, values.shape[-1]), 0.0, ratio)


def condition(values: Array) -> Array:
    """σ_max / σ_min of descending singular values (..., k): in [1, ∞], NaN where undefined."""
    with np.errstate(divide="ignore"):
        return 1.0 / reciprocal_condition(values)


def full_rank(values: Array) -> Mask:
    """Whether σ_min of descending singular values (..., k) is above rounding; False for NaN."""
    return np.asarray(values[..., -1] > rounding_of_rank(values[..., 0], values.shape[-1]))


def rounding_of_rank(size: Any, count: int = 6) -> Any:
    """Return what singular values count as rounding up to, by the rank rule of numpy.

    Parameters
    ----------
    size : (...) array, or a symbol of a traced stage
        Largest singular value, or that of the terms of which the entries are sums.
    count : int
        Number of singular values.

    Returns
    -------
    as `size`, in its unit
    """
    return count * EPS * size


def absolute_determinant(matrix: Array) -> Array:
    """|det| of square matrices, else sqrt(det MᵀM): (...)."""
    defined = defined_matrices(matrix)
    safe = np.where(defined[..., None, None], matrix, 0.0)
    square = matrix.shape[-2] == matrix.shape[-1]
    return np.where(defined, np.abs(np.linalg.det(safe)) if square else _volume(safe), np.nan)


def log_and_inverse(rows: Array) -> tuple[Array, Array]:
    """Log |det| (½ log det MᵀM) and (pseudo-)inverse of a stack, −inf and 0 where there is none.

    Parameters
    ----------
    rows : (..., n, 6) array, n ≥ 6
    """
    defined = defined_matrices(rows)
    safe = np.where(defined[..., None, None], rows, np.eye(rows.shape[-2], 6))
    if rows.shape[-2] == 6:
        left, square = None, safe
    else:
        # R has the singular values of J; det JᵀJ would lose half of the digits.
        left, square = _graded_qr(safe)
    sign, value = np.linalg.slogdet(square)
    usable = defined & (sign != 0.0) & np.isfinite(value)
    inverse = np.linalg.inv(np.where(usable[..., None, None], square, np.eye(6)))
    if left is not None:
        inverse = (inverse @ np.swapaxes(left, -1, -2))[..., ::-1, :]
    return np.where(usable, value, -np.inf), np.asarray(inverse)


def _graded_qr(rows: Array) -> tuple[Array, Array]:
    """Q and R of (..., n, 6) rows with their columns in reverse order, the moments first.

    Reflections lose the digits of small rows above large ones. Rows of angles and of distances
    differ by the unit in their moments alone, so the rows are sorted by these.
    """
    order = np.argsort(-np.linalg.norm(rows[..., 3:], axis=-1), axis=-1)[..., None]
    left, right = np.linalg.qr(np.take_along_axis(rows, order, axis=-2)[..., ::-1])
    return np.take_along_axis(left, np.argsort(order, axis=-2), axis=-2), right


def determinant_sign(matrix: Array) -> Array:
    """Sign of det of square matrices (..., k, k): (...); 0 where the rank is not full, else ±1.

    The rank is that of `full_rank`. It depends on the units of the entries, so matrices are
    dimensionless ones, such as `Posture.about_centre`. NaN where the matrix is not finite.
    """
    defined = defined_matrices(matrix)
    safe = np.where(defined[..., None, None], matrix, 0.0)
    # The sign of slogdet does not underflow, as det of small entries does.
    sign = np.where(full_rank(singular_values(safe)), np.linalg.slogdet(safe)[0], 0.0)
    return np.where(defined, sign, np.nan)


def _volume(matrix: Array) -> Array:
    """Sqrt(det MᵀM) of matrices with more rows than columns, as the product of the diagonal of R.

    QR by reflections, with the longest column and its largest entry in front at each step: so
    rows and columns of very unlike units, as those of angles and distances, cost no digits.
    """
    m = matrix.reshape(-1, *matrix.shape[-2:]).copy()
    each, volume = np.arange(len(m)), np.ones(len(m))
    for _ in range(matrix.shape[-1]):
        _to_front(m.swapaxes(1, 2), each, np.linalg.norm(m, axis=1).argmax(axis=-1))
        _to_front(m, each, np.abs(m[:, :, 0]).argmax(axis=-1))
        normal = m[:, :, 0].copy()
        size = np.linalg.norm(normal, axis=-1)
        normal[:, 0] += np.copysign(size, normal[:, 0])
        square = size * np.abs(normal[:, 0])
        share = normal / np.where(square > 0.0, square, 1.0)[:, None]
        m = (m - share[:, :, None] * (normal[:, None, :] @ m))[:, 1:, 1:]
        volume *= size
    return volume.reshape(matrix.shape[:-2])


def _to_front(m: Array, each: NDArray[np.int64], row: NDArray[np.int64]) -> None:
    """Exchange row `row` of each matrix with its first, in place."""
    m[each, 0], m[each, row] = m[each, row].copy(), m[each, 0].copy()


def solve_right_triangular(matrix: Array, upper: Array) -> Array:
    """X = M U⁻¹ for upper triangular U: (..., n, k), (..., k, k) to (..., n, k).

    A zero on the diagonal gives infinities or NaN in that element only, without an error.
    """
    result = np.empty(np.broadcast_shapes(matrix.shape, (*upper.shape[:-2], *matrix.shape[-2:])))
    with np.errstate(all="ignore"):
        for j in range(upper.shape[-1]):
            known = (result[..., :j] @ upper[..., :j, j, None])[..., 0]
            result[..., j] = (matrix[..., j] - known) / upper[..., j, j, None]
    return result


def whiten(matrix: Array, metric_root: Array) -> Array:
    """Return M R⁻¹ with WᵀW = RᵀR, so that its σ⁻² are the eigenvalues of (WᵀW, MᵀM).

    Parameters
    ----------
    matrix : (..., n, 6) array
    metric_root : (..., m, 6) array
        W, m ≥ 6. R is its QR factor: neither WᵀW nor MᵀM is ever formed.

    Returns
    -------
    (..., n, 6) array; NaN where either is NaN, infinite or NaN where W does not have full rank.
    """
    defined = defined_matrices(metric_root)[..., None, None]
    return solve_right_triangular(np.where(defined, matrix, np.nan), triangular_root(metric_root))


def triangular_root(metric_root: Array) -> Array:
    """R of the QR factors of W, so that WᵀW = RᵀR: (..., m, k) to (..., k, k), m ≥ k.

    Where W is not finite it is the identity.
    """
    defined = defined_matrices(metric_root)[..., None, None]
    safe = np.where(defined, metric_root, np.eye(*metric_root.shape[-2:]))
    upper: Array = np.linalg.qr(safe, mode="r")  # type: ignore[assignment]
    return upper


def newton(
    state: State,
    equations: Callable[[State], tuple[Array, Array]],
    move: Callable[[State, Array], State],
    *,
    solve: Callable[[Array, Array], Array],
    longest: float,
    most: int,
    rest: float = 0.1 * RESIDUAL_TOLERANCE,
) -> tuple[State, Array]:
    """Return where Newton's method with bounded steps ends from N starts, and the residuals.

    A step that is too long is shortened to `longest`. There is no other condition, so the
    residuals may increase. (Forward kinematics accepts only steps that are proven
    regular, and has a method of its own.)

    Parameters
    ----------
    state : any
        N starts.
    equations : state -> residuals (N, q), matrices (N, q, d)
        Residuals that are not finite, or matrices, make an element stay where it is.
    move : state, steps (N, d) -> state
    solve : matrices, right sides (N, q) -> steps (N, d)
        `solve_linear`, or `solve_least_squares` where systems have more equations than unknowns,
        or singular matrices.
    longest : float
        Largest component of a step [1].
    most : int
        Greatest number of steps.
    rest : float
        An element stays where its residual is as small as this [1].

    Returns
    -------
    state
    residuals : (N,) array [1]
        Largest residual at the returned state, up to a last step of rounding.
    """
    for number in range(most + 1):
        f, matrix = equations(state)
        residual = np.abs(f).max(axis=1)
        going = np.isfinite(residual) & (residual > rest)
        # The last step is evaluated as well: with an almost singular matrix it may be a long one
        # away from a small residual.
        if number == most or not going.any():
            break
        step = solve(matrix, -f)
        length = np.abs(step).max(axis=1)
        going &= np.isfinite(length)
        share = np.minimum(1.0, longest / np.maximum(length, np.finfo(np.float64).tiny))
        state = move(state, np.where(going[:, None], step * share[:, None], 0.0))
        if np.where(going, length, 0.0).max() < LEAST_NEWTON_STEP:
            break
    return state, residual


def solve_linear(matrix: Array, right: Array) -> Array:
    """Solutions (N, d) of square systems, by least squares where one of them is singular.

    Undefined systems, with entries that are not finite, have NaN.
    """
    finite = defined_matrices(matrix) & np.isfinite(right).all(axis=1)
    safe = np.where(finite[:, None, None], matrix, np.eye(matrix.shape[1], matrix.shape[2]))
    known = np.where(finite[:, None], right, np.nan)
    try:
        return np.asarray(np.linalg.solve(safe, known[..., None])[..., 0])
    except np.linalg.LinAlgError:
        return np.asarray((np.linalg.pinv(safe, rcond=1e-13) @ known[..., None])[..., 0])


def solve_least_squares(matrix: Array, right: Array, least: float = 1e-12) -> Array:
    """Shortest least-squares solutions (N, d) of systems (N, q, d).

    Singular values below `least` of the largest count as zero: equations of symmetric designs
    repeat each other up to rounding.
    """
    return np.asarray((np.linalg.pinv(matrix, rcond=least) @ right[..., None])[..., 0])
