"""Extreme singular values and determinants of small matrices, in plain scalars.

The formulas work on floats, on numbers of any precision, and on the symbols of
`gsp.kernels.trace`, from which the vectorised code is made. None of them branches: a case
distinction is a `choose`. Vectors are lists of scalars, matrices are lists of rows.
"""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import Vector, choose, dot, less, minus, root, times
from gsp.geometry.vectors import EPS

Matrix = list[Vector]

# Laguerre's steps end when what is left is below this share of the eigenvalue; see `laguerre`.
EIGENVALUE_TOLERANCE = 1e-14
# Added to the discriminant, so that its rounding never makes a step too long; see `laguerre`.
DISCRIMINANT_ROUNDING = 1024 * EPS


def solved_row(row: Vector, upper: Vector, per_diagonal: Vector) -> Vector:
    """Row of M R⁻¹.

    Parameters
    ----------
    row : six scalars
        Row of M.
    upper : 21 scalars
        The upper triangle of R by rows.
    per_diagonal : six scalars
        One over the diagonal of R; computed once for all rows, as divisions are slow.
    """
    place = {(i, j): i * 6 - i * (i - 1) // 2 + j - i for i in range(6) for j in range(i, 6)}
    result: Vector = []
    for j in range(6):
        rest = row[j]
        for k in range(j):
            rest = rest - result[k] * upper[place[k, j]]
        result.append(rest * per_diagonal[j])
    return result


def reflection(first: Any, size: Any) -> tuple[Any, Any, Any]:
    """Return ±|x|, v₁ and 2/vᵀv of the Householder reflection that ends x on its first axis.

    I − 2 v vᵀ / vᵀv, where v is x but for v₁ = x₁ ± |x|, the sign being that of x₁.
    """
    signed = choose(less(first, 0.0), -size, size)
    head = first + signed
    scale = signed * head
    return signed, head, choose(less(0.0, scale), 1.0 / scale, 0.0)


def _reflector(x: Vector) -> tuple[Vector, Any, Any, Any]:
    """v, 2/vᵀv, |x| and |x|² of the reflection of x."""
    square = dot(x, x)
    size = root(square)
    _, head, factor = reflection(x[0], size)
    return [head, *x[1:]], factor, size, square


def bidiagonal(matrix: Matrix) -> tuple[Vector, Vector, Any]:
    """Squares of diagonal and superdiagonal of U M V, upper bidiagonal; and |det M|.

    U and V are products of Householder reflections; M is 6 × 6.
    """
    m = [list(row) for row in matrix]
    n = len(m)
    diagonal, above = [], []
    determinant: Any = 1.0
    for k in range(n):
        v, factor, size, square = _reflector([m[i][k] for i in range(k, n)])
        diagonal.append(square)
        determinant = determinant * size
        for j in range(k + 1, n):
            column = [m[i][j] for i in range(k, n)]
            part = factor * dot(v, column)
            for i in range(k, n):
                m[i][j] = m[i][j] - part * v[i - k]
        if k < n - 1:
            w, factor, _, square = _reflector(m[k][k + 1 :])
            above.append(square)
            for i in range(k + 1, n):
                part = factor * dot(m[i][k + 1 :], w)
                m[i][k + 1 :] = minus(m[i][k + 1 :], times(part, w))
    return diagonal, above, determinant


def laguerre_start(q: Vector, e: Vector) -> tuple[Vector, Vector, Any, Any]:
    """Scale q and e to the sum 1; return the old sum too, and an upper bound of the eigenvalues.

    The upper bound is that of Laguerre and Samuelson from the traces of BᵀB and of its square,
    m + s √(n − 1), raised so that it stays a bound when the variance s² is all rounding.
    """
    total = q[0]
    for x in (*q[1:], *e):
        total = total + x
    per = choose(less(0.0, total), 1.0 / total, 0.0)
    q, e, n = times(per, q), times(per, e), len(q)
    entries = [q[0], *(q[i + 1] + e[i] for i in range(n - 1))]
    squares = dot(entries, entries) + 2.0 * dot(q[:-1], e)
    variance = squares - 1.0 / n
    excess = (n - 1) / n * choose(less(variance, 0.0), 0.0, variance) + DISCRIMINANT_ROUNDING
    high = choose(less(0.0, total), 1.0 / n + root(excess), 0.0)
    return q, e, total, high


def characteristic(q: Vector, e: Vector, t: Any) -> tuple[Any, Any, Any]:
    """P, P′ and P″/2 of P(t) = det(BᵀB − t), without subtractions other than the one by t.

    P_i = q_i P_{i−1} − t Q_{i−1}, Q_i = P_i + e_i Q_{i−1}: the differential qd recurrence without
    its divisions, so a rounding acts like a relative change of the q and e, which changes no
    singular value of B by more than about as much, however small it is.
    """
    p, p1, p2 = 1.0, 0.0, 0.0
    s, s1, s2 = 1.0, 0.0, 0.0
    for i in range(len(q)):
        p, p1, p2 = q[i] * p - t * s, q[i] * p1 - t * s1 - s, q[i] * p2 - t * s2 - s1
        if i < len(e):
            s, s1, s2 = p + e[i] * s, p1 + e[i] * s1, p2 + e[i] * s2
    return p, p1, p2


def laguerre(q: Vector, e: Vector, t: Any, side: float) -> tuple[Any, Any]:
    """One step toward the nearest eigenvalue of BᵀB, and whether another is needed.

    With n = 6 even, side = 1 from below the least eigenvalue, −1 from above the greatest. Steps
    never pass the eigenvalue, and cubic convergence becomes linear where eigenvalues cluster. So
    a small step alone does not end it. With ρ = 2 P P″ / (2 P′²), which is 1 − H/G² of the
    sums G of 1/(λ_i − t) and H of their squares, what is left after a step is below 2 ρ² of it
    where one eigenvalue dominates, and ρ > 1/4 where none does. There it is below 3/4 of the step,
    so a stop at 2 ρ² step < EIGENVALUE_TOLERANCE · t bounds the error in all cases.
    """
    n = len(q)
    p, p1, p2 = characteristic(q, e, t)
    per_slope = 1.0 / p1  # the quotients stay in range where products of p, p1, p2 would not
    newton = -side * p * per_slope
    half_rho = p * per_slope * (p2 * per_slope)
    discriminant = (n - 1) * (n - 1 - 2 * n * half_rho)
    spread = root(choose(less(0.0, discriminant), discriminant, 0.0) + DISCRIMINANT_ROUNDING)
    step = n * newton / (1.0 + spread)
    forward = choose(less(0.0, step), step, 0.0)
    moved = t + side * forward
    left = 8.0 * half_rho * half_rho * forward
    return moved, choose(less(EIGENVALUE_TOLERANCE * moved, left), 1.0, 0.0)
