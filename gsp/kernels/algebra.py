"""The formulas of the compiled kernels, for one pose, in plain scalars.

They work on floats, on numbers of any precision, and on the symbols of `gsp.kernels.trace`, from
which the vectorised code is made. None of them branches: a case distinction is a `choose`.
Vectors are lists of three scalars, matrices are lists of rows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from gsp.geometry.vectors import EPS
from gsp.kernels.trace import choose, root
from gsp.model.constraints import ZERO

Vector = list[Any]
Matrix = list[list[Any]]

# Laguerre's steps end when what is left is below this share of the eigenvalue; see `laguerre`.
ENOUGH = 1e-14
# Roundings of the discriminant are made harmless by this share of it; see `laguerre`.
SAFETY = 1024 * EPS


def dot(x: Vector, y: Vector) -> Any:
    """Scalar product."""
    total = x[0] * y[0]
    for a, b in zip(x[1:], y[1:], strict=True):
        total = total + a * b
    return total


def cross(x: Vector, y: Vector) -> Vector:
    """Vector product."""
    return [
        x[1] * y[2] - x[2] * y[1],
        x[2] * y[0] - x[0] * y[2],
        x[0] * y[1] - x[1] * y[0],
    ]


def times(factor: Any, x: Vector) -> Vector:
    """Return a vector multiplied by a scalar."""
    return [factor * a for a in x]


def plus(x: Vector, y: Vector) -> Vector:
    """Sum of two vectors."""
    return [a + b for a, b in zip(x, y, strict=True)]


def minus(x: Vector, y: Vector) -> Vector:
    """Difference of two vectors."""
    return [a - b for a, b in zip(x, y, strict=True)]


def turned(rotation: Vector, x: Vector) -> Vector:
    """R x, with R as nine scalars in C order."""
    return [dot(rotation[3 * i : 3 * i + 3], x) for i in range(3)]


def line_row(direction: Vector, arm: Vector) -> Vector:
    """Row [x, r × x] of the velocity, along x, of the platform point at r."""
    return [*direction, *cross(arm, direction)]


def spin_row(axis: Vector) -> Vector:
    """Row [0, x] of the angular velocity about x."""
    return [0.0, 0.0, 0.0, *axis]


@dataclass(frozen=True)
class Leg:
    """The lines of one leg and the segment that it acts along, as in `gsp.model.constraints`."""

    s: Vector
    t: Vector
    direction: Vector
    length: Any
    arm: Vector
    defined: Any
    measure: Any


def _placed(pose: Vector, geometry: Vector) -> tuple[Vector, Vector, Vector, Vector, Any]:
    """d, arm, s, t and the scale of d, from p, R, |p| (13) and a, b, s, t, |a| + |b| (13)."""
    position, rotation, reach = pose[:3], pose[3:12], pose[12]
    a, b, s, t = geometry[:3], geometry[3:6], geometry[6:9], geometry[9:12]
    arm = turned(rotation, b)
    return minus(plus(position, arm), a), arm, s, turned(rotation, t), reach + geometry[12]


def _pointed(vector: Vector, arm: Vector, s: Vector, t: Vector, scale: Any) -> Leg:
    length = root(dot(vector, vector))
    return Leg(s, t, times(1.0 / length, vector), length, arm, length > ZERO * scale, length)


def point_point(pose: Vector, geometry: Vector) -> Leg:
    """D1. *Source: TozKucuk2016, eq. (2)*."""
    d, arm, s, t, scale = _placed(pose, geometry)
    return _pointed(d, arm, s, t, scale)


def point_line(pose: Vector, geometry: Vector) -> Leg:
    """D2. *Source: TozKucuk2016, eq. (3)*."""
    d, arm, s, t, scale = _placed(pose, geometry)
    return _pointed(cross(t, cross(d, t)), minus(arm, times(dot(d, t), t)), s, t, scale)


def line_point(pose: Vector, geometry: Vector) -> Leg:
    """D3. *Source: TozKucuk2016, eq. (4)*."""
    d, arm, s, t, scale = _placed(pose, geometry)
    return _pointed(cross(s, cross(d, s)), arm, s, t, scale)


def line_line(pose: Vector, geometry: Vector) -> Leg:
    """D4 and A1. *Source: TozKucuk2016, eq. (5)*."""
    d, arm, s, t, _ = _placed(pose, geometry)
    normal = cross(t, s)
    sine = root(dot(normal, normal))
    per_sine = 1.0 / sine
    offset = dot(d, normal) * per_sine
    slide = -dot(cross(d, s), normal) / (sine * sine)
    sign = choose(offset < 0.0, -per_sine, per_sine)
    length = choose(offset < 0.0, -offset, offset)
    foot = plus(arm, times(slide, t))
    return Leg(s, t, times(sign, normal), length, foot, sine > ZERO, sine)


def _distance_row(leg: Leg, length: Any) -> Vector:
    return line_row(leg.direction, leg.arm)


def _angle_row(leg: Leg, length: Any) -> Vector:
    """Row of A1 multiplied by the length: an angular actuator counts with the speed L θ̇."""
    return spin_row(times(-length / leg.measure, cross(leg.t, leg.s)))


def _normals(u: Vector) -> tuple[Vector, Vector]:
    x, y, z = u
    sign = choose(z < 0.0, -1.0, 1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    return [1.0 + sign * x * x * a, sign * b, -(sign * x)], [b, sign + y * y * a, -y]


def _sps(leg: Leg, length: Any) -> Matrix:
    rows = []
    for e in _normals(leg.direction):
        rate = times(1.0 / leg.length, line_row(e, leg.arm))
        rows += [rate, minus(rate, spin_row(cross(leg.direction, e)))]
    return rows


def _spc(leg: Leg, length: Any) -> Matrix:
    e2 = cross(leg.direction, leg.t)
    tilt = spin_row(e2)
    rate = times(1.0 / leg.length, line_row(e2, leg.arm))
    slide = minus(times(leg.length, tilt), line_row(leg.t, leg.arm))
    seen = minus(rate, spin_row(cross(leg.direction, e2)))
    return [tilt, rate, seen, times(1.0 / length, slide)]


def _cps(leg: Leg, length: Any) -> Matrix:
    u, s = leg.direction, leg.s
    e2 = cross(u, s)
    rate = times(1.0 / leg.length, line_row(e2, leg.arm))
    turns = [rate, spin_row(e2), minus(rate, spin_row(cross(u, e2)))]
    return [*turns, times(1.0 / length, line_row(s, leg.arm))]


def _ccc(leg: Leg, length: Any) -> Matrix:
    u, s, t = leg.direction, leg.s, leg.t
    m = cross(u, s)
    per_sine = 1.0 / dot(m, t)
    rate = times(-per_sine, spin_row(cross(t, u)))
    slide_t = times(per_sine, minus(times(leg.length, rate), line_row(m, leg.arm)))
    slide_s = plus(line_row(s, leg.arm), times(dot(t, s), slide_t))
    slides = [times(1.0 / length, slide) for slide in (slide_s, slide_t)]
    return [spin_row(m), rate, minus(rate, spin_row(cross(u, m))), *slides]


def _ccc_angle(leg: Leg, length: Any) -> Matrix:
    normal = line_row(leg.direction, leg.arm)
    return [*_ccc(leg, length), times(1.0 / length, normal)]


@dataclass(frozen=True)
class Kind:
    """A kind of leg: its segment, the rows of its actuators and of its passive joints.

    The passive rows are those of `gsp.model.legs` up to sign, without those that are always zero.
    """

    name: str
    segment: Callable[[Vector, Vector], Leg]
    rows: tuple[Callable[[Leg, Any], Vector], ...]
    passive: Callable[[Leg, Any], Matrix]
    n_passive: int


# In the order of gsp.model.legs.LEGS.
KINDS = (
    Kind("D1", point_point, (_distance_row,), _sps, 4),
    Kind("D2", point_line, (_distance_row,), _spc, 4),
    Kind("D3", line_point, (_distance_row,), _cps, 4),
    Kind("D4", line_line, (_distance_row,), _ccc, 5),
    Kind("A1", line_line, (_angle_row,), _ccc_angle, 6),
    Kind("D4 A1", line_line, (_distance_row, _angle_row), _ccc, 5),
)


def ellipsoid_frame(rotation: Vector, center: Vector, axes: Vector) -> Vector:
    """R c, and R times the axes that are divided by the roots of their inertia: 3 + 9 scalars."""
    columns = [turned(rotation, axes[j::3]) for j in range(3)]
    return [*turned(rotation, center), *(columns[j][i] for i in range(3) for j in range(3))]


def ellipsoid_row(row: Vector, frame: Vector) -> Vector:
    """Row of J X, with D⁻¹ = X Xᵀ. *Source: Nawratil, eqs. (12), (17)*."""
    about_center = minus(row[3:], cross(frame[:3], row[:3]))
    columns = [frame[3 + j :: 3] for j in range(3)]
    return [*times(6.0**-0.5, row[:3]), *(dot(about_center, column) for column in columns)]


def solved_row(row: Vector, upper: Vector) -> Vector:
    """Row of M R⁻¹, for the upper triangle of R by rows (21 scalars)."""
    place = {(i, j): i * 6 - i * (i - 1) // 2 + j - i for i in range(6) for j in range(i, 6)}
    result: Vector = []
    for j in range(6):
        rest = row[j]
        for k in range(j):
            rest = rest - result[k] * upper[place[k, j]]
        result.append(rest / upper[place[j, j]])
    return result


def reflection(first: Any, size: Any) -> tuple[Any, Any, Any]:
    """Return ±|x|, v₁ and 2/vᵀv of the Householder reflection that ends x on its first axis.

    I − 2 v vᵀ / vᵀv, where v is x but for v₁ = x₁ ± |x|, the sign being that of x₁.
    """
    signed = choose(first < 0.0, -size, size)
    head = first + signed
    scale = signed * head
    return signed, head, choose(scale > 0.0, 1.0 / scale, 0.0)


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
    per = choose(total > 0.0, 1.0 / total, 0.0)
    q, e, n = times(per, q), times(per, e), len(q)
    entries = [q[0], *(q[i + 1] + e[i] for i in range(n - 1))]
    squares = dot(entries, entries) + 2.0 * dot(q[:-1], e)
    variance = squares - 1.0 / n
    excess = (n - 1) / n * choose(variance < 0.0, 0.0, variance) + SAFETY
    high = choose(total > 0.0, 1.0 / n + root(excess), 0.0)
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
    the stop asks for more than a small step. With ρ = 2 P P″ / (2 P′²), which is 1 − H/G² of the
    sums G of 1/(λ_i − t) and H of their squares, what is left after a step is below 2 ρ² of it
    where one eigenvalue dominates, and ρ > 1/4 where none does. There it is below 3/4 of the step,
    so a stop at 2 ρ² step < ENOUGH · t bounds the error in all cases.
    """
    n = len(q)
    p, p1, p2 = characteristic(q, e, t)
    per_slope = 1.0 / p1  # the quotients stay in range where products of p, p1, p2 would not
    newton = -side * p * per_slope
    half_rho = p * per_slope * (p2 * per_slope)
    discriminant = (n - 1) * (n - 1 - 2 * n * half_rho)
    spread = root(choose(discriminant > 0.0, discriminant, 0.0) + SAFETY)
    step = n * newton / (1.0 + spread)
    forward = choose(step > 0.0, step, 0.0)
    moved = t + side * forward
    left = 8.0 * half_rho * half_rho * forward
    return moved, choose(ENOUGH * moved < left, 1.0, 0.0)
