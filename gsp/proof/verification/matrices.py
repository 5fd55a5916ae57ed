"""Matrices on a box, in balls: singular values, determinants and control numbers.

J(x) of n ≥ 6 rows is J(c) + Σ_k ±r_k J_k(c) + E, where the Frobenius norm of E is at most `rest`.
For a matrix T of exact numbers, near to the inverse of a triangle of J(c), J(x) T is near to
orthonormal columns, and its change is small in all directions.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.proof.verification.balls import PAIRS, Vector
from gsp.proof.verification.blocks import Direction, excess, least_value, ratio

# A lower and an upper bound, and what each coordinate contributes to their difference.
Range = tuple[Any, Any, list[float]]


def most(x: Any) -> Any:
    """Return a number that no |element| of a ball exceeds."""
    return x.abs_upper() if hasattr(x, "abs_upper") else abs(x)


def size(x: Any) -> float:
    """Return the size of a ball as a float, 1e300 if it has none."""
    value = float(x.abs_upper()) if x.is_finite() else 1e300
    return min(value, 1e300)


def rest_of(half: list[Any], wide: Vector) -> Any:
    """½ Σ_kl r_k r_l ‖f_kl(X)‖ of some entries f."""
    rest = 0 * half[0]
    n = len(half)
    for i, (k, m) in enumerate(PAIRS[: n * (n + 1) // 2]):
        norm = sum((most(x.bends[i]) ** 2 for x in wide), 0 * half[0]).sqrt()
        rest += half[k] * half[m] * norm / (2 if k == m else 1)
    return rest


def shares_of(parts: list[Any], rest: Any, half: list[Any]) -> list[float]:
    """How much each coordinate contributes to a bound that is too wide."""
    return [size(p) + float(h) * size(rest) for p, h in zip(parts, half, strict=True)]


class Rows:
    """Rows on a box: at its centre, their derivatives times half-widths, and the rest."""

    def __init__(
        self, flint: Any, centre: Any, steps: list[Any], rest: Any, half: list[Any]
    ) -> None:
        self.flint, self.centre, self.steps, self.rest, self.half = flint, centre, steps, rest, half
        self.zero = flint.arb(0)
        entries = [step.entries() for step in steps]
        self.parts = [
            sum((abs(self._inner(a, b)) for b in entries), self.zero).sqrt() for a in entries
        ]
        self.linear = most(sum((part * part for part in self.parts), self.zero)).sqrt()
        # No matrix of the box differs by more from the centre.
        self.reach = self.linear + rest

    @classmethod
    def of(cls, flint: Any, rows: list[Vector], wide: list[Vector], half: list[Any]) -> Rows:
        """Return rows from numbers at the centre, and on the whole box with second derivatives."""
        entries = [x for row in rows for x in row]
        mat, n = flint.arb_mat, len(rows)
        steps = [mat(n, 6, [h * x.slopes[k] for x in entries]) for k, h in enumerate(half)]
        # What the entries at the centre are uncertain by (tolerances) is part of the change.
        unsure = sum((x.value.rad() ** 2 for x in entries), flint.arb(0)).sqrt()
        rest = rest_of(half, [x for row in wide for x in row]) + unsure
        return cls(flint, mat(n, 6, [x.value.mid() for x in entries]), steps, rest, half)

    def _inner(self, a: list[Any], b: list[Any]) -> Any:
        return sum((x * y for x, y in zip(a, b, strict=True)), self.zero)

    def times(self, t: Any) -> Rows:
        """Return the rows times a matrix."""
        norm = self._inner(t.entries(), t.entries()).sqrt()
        steps = [step * t for step in self.steps]
        return Rows(self.flint, self.centre * t, steps, self.rest * most(norm), self.half)

    def drift(self) -> Any:
        """Bound of |⟨Q, D⟩| for the matrix Q at the centre and its change D."""
        q = self.centre.entries()
        steps = sum((abs(self._inner(q, step.entries())) for step in self.steps), self.zero)
        return steps + self._inner(q, q).sqrt() * self.rest

    def floats(self) -> Any:
        """Return the matrix at the centre as floats."""
        shape = self.centre.nrows(), self.centre.ncols()
        return np.array([float(x.mid()) for x in self.centre.entries()]).reshape(shape)

    def preconditioner(self) -> Any:
        """Return T as exact numbers, and 1/|det T|; None if the matrix at the centre has none."""
        values = self.floats()
        if not np.isfinite(values).all() or np.linalg.cond(values) > 1e12:
            return None
        inverse = np.linalg.inv(np.linalg.qr(values)[1])
        return self.flint.arb_mat(6, 6, [self.flint.arb(float(x)) for x in inverse.ravel()])

    def departure(self) -> Any:
        """Return ‖QᵀQ − I‖ at the centre: its singular values are within sqrt(1 ± that)."""
        square = self.centre.transpose() * self.centre
        one = self.flint.arb_mat(6, 6, [int(i % 7 == 0) for i in range(36)])
        difference = (square - one).entries()
        return self._inner(difference, difference).sqrt()

    def shares_of(self) -> list[float]:
        """Return what each coordinate contributes to the change."""
        return shares_of(self.parts, self.rest, self.half)


def singular_values(rows: Rows) -> tuple[Range, Range]:
    """Bounds of σ_min and of σ_max / σ_min on a box."""
    ball, shares = rows.flint.arb, rows.shares_of()
    nothing = (ball(0), ball("inf"), shares)
    if not rows.reach.is_finite():
        return nothing, nothing
    _, sigma, right = np.linalg.svd(rows.floats())
    # Floats serve as a guess, with their rounding; what follows proves it.
    guess = float(sigma[-1]) * (1 - 1e-9) - 1e-14 * float(sigma[0])
    low, high = ball(max(guess, 0.0)), ball(float(sigma[0]) * (1 + 1e-9))
    square = rows.centre.transpose() * rows.centre
    one = rows.flint.arb_mat(6, 6, [int(i % 7 == 0) for i in range(36)])
    if not (definite(square - one * (low * low)) and definite(one * (high * high) - square)):
        return nothing, nothing
    share = relative_change(rows)
    short = stretch(rows, right[-1]) * (1 + share)
    long = stretch(rows, right[0]) * (1 - share)
    least, above = low * (1 - share), high + rows.reach
    other, quotient = with_derivatives(rows, sigma, right, square, one)
    # Of two bounds the better one.
    least = other if other > least else least
    if not least > 0:
        return (ball(0), short, shares), (ball(1), ball("inf"), shares)
    quotient = quotient if quotient < above / least else above / least
    return (least, short, shares), (long / short, quotient, shares)


def with_derivatives(rows: Rows, sigma: Any, right: Any, square: Any, one: Any) -> tuple[Any, Any]:
    """Bounds of σ_min from below and of σ_max / σ_min from above with their exact derivatives."""
    ball = rows.flint.arb
    small, great = (
        Direction(rows.flint, rows.centre, rows.steps, right[i].tolist()) for i in (-1, 0)
    )

    def across(way: Direction) -> Any:
        return square - rows.flint.arb_mat(6, 6, [x * y for x in way.seen for y in way.seen])

    # Also estimates: the second singular values from both ends.
    d, most_d = ball(float(sigma[-2]) * (1 - 1e-9)), ball(float(sigma[1]) * (1 + 1e-9))
    along = rows.flint.arb_mat(6, 6, [x * y for x in small.v for y in small.v])
    size = float(sigma[0]) ** 2
    if not definite(across(small) + along * size - one * (d * d)):
        d = ball(0)
    if not definite(one * (most_d * most_d) - across(great)):
        return ball(0), ball("inf")
    least, lost = least_value(small, d - rows.linear, rows.rest)
    if not least > 0:
        return ball(0), ball("inf")
    return least, ratio(small, lost, great, excess(great, most_d + rows.linear, rows.rest))


def relative_change(rows: Rows) -> Any:
    """Return s such that |(J − J_c) x| ≤ s |J_c x| for all x on the box; inf if none is known."""
    ball = rows.flint.arb
    t = rows.preconditioner()
    if t is None:
        return ball("inf")
    q = rows.times(t)
    least = 1 - q.departure()
    return q.reach / least.sqrt() if least > 0 else ball("inf")


def volume(rows: Rows) -> Range:
    """Bounds of sqrt det JᵀJ on a box: see `docs/proofs.md`, determinants."""
    ball, shares = rows.flint.arb, rows.shares_of()
    t = rows.preconditioner()
    if t is None or not rows.reach.is_finite():
        return ball(0), ball("inf"), shares
    q, scale = rows.times(t), 1 / abs(t.det())
    entries = q.centre.entries()
    trace = sum((x * x for x in entries), ball(0))
    drift, far = q.drift(), q.departure()
    high = ((trace + 2 * drift + q.reach * q.reach) / 6) ** 3
    change = far + 2 * (1 + far).sqrt() * q.reach
    if not change < 1:
        return ball(0), scale * high, shares
    low = (trace / 2 - 3 - drift - change * change / (4 * (1 - change))).exp()
    return scale * low, scale * high, shares


def control(rows: Rows, passive: Rows) -> Range:
    """Bounds of the control number of rows and of the rows of the passive rates."""
    ball = rows.flint.arb
    shares = [x + y for x, y in zip(rows.shares_of(), passive.shares_of(), strict=True)]
    t = passive.preconditioner()
    if t is None or not (rows.reach.is_finite() and passive.reach.is_finite()):
        return ball(0), ball("inf"), shares
    q, j = passive.times(t), rows.times(t)
    far = q.departure()
    slow, fast = (1 - far).sqrt() - q.reach, (1 + far).sqrt() + q.reach
    (low, _, _), _ = singular_values(j)
    _, sigma, right = np.linalg.svd(j.floats())
    most_high = ball(float(sigma[0]) * (1 + 1e-9))
    square = j.centre.transpose() * j.centre
    one = rows.flint.arb_mat(6, 6, [int(i % 7 == 0) for i in range(36)])
    long, short = stretch(j, right[0]) - j.reach, stretch(j, right[-1]) + j.reach
    worst = ball(0)
    if definite(one * (most_high * most_high) - square) and slow > 0:
        worst = low * slow / ((most_high + j.reach) * fast)
    best = short * fast / (long * slow) if long > 0 and slow > 0 else ball("inf")
    return worst, best, shares


def definite(matrix: Any) -> bool:
    """Whether a symmetric matrix of balls is positive definite: all pivots are positive."""
    n = matrix.nrows()
    rows = [[matrix[i, j] for j in range(n)] for i in range(n)]
    for k in range(n):
        if not rows[k][k] > 0:
            return False
        for i in range(k + 1, n):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return True


def stretch(rows: Rows, direction: Any) -> Any:
    """|J x| / |x| at the centre: at least σ_min and at most σ_max, for every x."""
    x = rows.flint.arb_mat([[rows.flint.arb(float(a))] for a in direction])
    image, zero = (rows.centre * x).entries(), rows.zero
    square = sum((y * y for y in image), zero)
    return (square / sum((y * y for y in x.entries()), zero)).sqrt()
