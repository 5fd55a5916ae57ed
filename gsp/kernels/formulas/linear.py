"""Inverses of small square matrices, and short motions, in plain scalars (see `spectrum`)."""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import Vector, cross, dot, norm, plus, times, turned
from gsp.kernels.formulas.spectrum import Matrix, reflection

# Terms of the series of sin θ / θ and (1 − cos θ) / θ²: for θ ≤ 1/2 the first that is left out is
# below 2⁻¹⁸ / 19! = 4e-23.
TURN_SERIES_TERMS = 8


def inverse(matrix: Matrix) -> Matrix:
    """Return the inverse of a square matrix by Householder reflections; not finite if singular.

    Stable without a choice of pivots, which would differ from lane to lane.
    """
    n = len(matrix)
    columns = [[row[j] for row in matrix] for j in range(n)]
    columns += [[1.0 if i == j else 0.0 for i in range(n)] for j in range(n)]
    for k in range(n):
        x = columns[k][k:]
        signed, head, factor = reflection(x[0], norm(x))
        v = [head, *x[1:]]
        columns[k] = [*columns[k][:k], -signed]
        for j in range(k + 1, 2 * n):
            part = factor * dot(v, columns[j][k:])
            below = [y - part * z for y, z in zip(columns[j][k:], v, strict=True)]
            columns[j] = [*columns[j][:k], *below]
    per = [1.0 / columns[k][k] for k in range(n)]
    solved = [_substituted(columns[:n], per, column) for column in columns[n:]]
    return [[column[i] for column in solved] for i in range(n)]


def _substituted(upper: list[Vector], per: Vector, right: Vector) -> Vector:
    """Solve R x = y from the columns of R and one over its diagonal."""
    x = list(right)
    for i in range(len(per) - 1, -1, -1):
        x[i] = per[i] * x[i]
        for k in range(i):
            x[k] = x[k] - upper[i][k] * x[i]
    return x


def rotated(turn: Vector, rotation: Vector) -> Vector:
    """Return exp([ω]×) R for |ω| ≤ 1/2, made orthogonal to second order.

    R has nine scalars by rows. Rodrigues' formula, with series that need no functions of angles.
    """
    square = dot(turn, turn)
    sine: Any = 1.0  # sin θ / θ
    cosine: Any = 1.0  # 2 (1 − cos θ) / θ²
    for k in range(TURN_SERIES_TERMS, 0, -1):
        sine = 1.0 - square * sine * (1.0 / (2 * k * (2 * k + 1)))
        cosine = 1.0 - square * cosine * (1.0 / ((2 * k + 1) * (2 * k + 2)))
    cosine = 0.5 * cosine
    columns = []
    for j in range(3):
        column = rotation[j::3]
        along = dot(turn, column)
        kept = times(1.0 - cosine * square, column)
        columns.append(
            plus(plus(kept, times(sine, cross(turn, column))), times(cosine * along, turn))
        )
    return orthogonal([columns[j][i] for i in range(3) for j in range(3)])


def orthogonal(rotation: Vector) -> Vector:
    """Return R (3 − RᵀR) / 2: the error of an almost orthogonal matrix is squared."""
    columns = [rotation[j::3] for j in range(3)]
    mixed = [
        [(1.5 if i == j else 0.0) - 0.5 * dot(columns[i], columns[j]) for i in range(3)]
        for j in range(3)
    ]
    turned_columns = [turned(rotation, mixed[j]) for j in range(3)]
    return [turned_columns[j][i] for i in range(3) for j in range(3)]
