"""Extreme singular values on a box with their exact derivatives, in balls.

For a unit vector v, u = J_c v/|J_c v| and P = I − u uᵀ, let on all matrices J = J_c + Σ ±J_k of a
box

    u·J v = a ± Σ |a_k|,    |uᵀJ y| ≤ b |y|,    |P J v| ≤ c,    |P J y| ≥ d |y|    for y ⊥ v.

If a d > b c for the least a, no singular value of J is below the least one of [[a, −b], [−c, d]].
With a bound d of |P J y| from above, none exceeds the greatest one of [[a, b], [c, d]]. Both are
monotonic in a, and change by no more than a does. The rest of the rows changes no singular value by
more than its norm.
"""

from __future__ import annotations

from typing import Any

Balls = list[Any]


def inner(x: Balls, y: Balls) -> Any:
    """Scalar product of two lists of balls."""
    return sum((a * b for a, b in zip(x, y, strict=True)), 0 * x[0])


def without(x: Balls, unit: Balls) -> Balls:
    """Return the part of x across a unit vector."""
    along = inner(x, unit)
    return [a - along * b for a, b in zip(x, unit, strict=True)]


def spread(some: list[Balls]) -> Any:
    """Bound of |Σ ±x_k| of vectors."""
    return sum((abs(inner(x, y)) for x in some for y in some), 0 * some[0][0]).sqrt()


class Direction:
    """The numbers a, a_k, b and c of a direction v, and what J_cᵀP J_c is made of."""

    def __init__(self, flint: Any, centre: Any, steps: list[Any], v: list[float]) -> None:
        raw = [flint.arb(float(x)) for x in v]
        self.v = [x / inner(raw, raw).sqrt() for x in raw]
        column = flint.arb_mat([[x] for x in self.v])
        image = (centre * column).entries()
        self.a = inner(image, image).sqrt()
        u = [x / self.a for x in image]
        row = flint.arb_mat([u])
        self.seen = (row * centre).entries()
        turned = [(step * column).entries() for step in steps]
        self.slopes = [inner(u, x) for x in turned]
        self.linear = sum((abs(x) for x in self.slopes), 0 * self.a)
        off = without(self.seen, self.v)
        across = [without((row * step).entries(), self.v) for step in steps]
        self.b = inner(off, off).sqrt() + spread(across)
        self.c = spread([without(x, u) for x in turned])

    def extremes(self, a: Any, d: Any) -> tuple[Any, Any]:
        """Return the extreme singular values of [[a, −b], [−c, d]], the least 0 if b c ≥ a d."""
        det = a * d - self.b * self.c
        squares = a * a + d * d + self.b * self.b + self.c * self.c
        # φ ± 2 det as sums of squares, which are not negative.
        less = (a - d) * (a - d) + (self.b + self.c) * (self.b + self.c)
        more = (a + d) * (a + d) + (self.b - self.c) * (self.b - self.c)
        root = squares + (less * more).sqrt()
        least = det * (2 / root).sqrt() if det > 0 and a > 0 and d > 0 else 0 * a
        return least, (root / 2).sqrt()


def least_value(way: Direction, d: Any, rest: Any) -> tuple[Any, Any]:
    """Lower bound of σ_min, and e with σ_min ≥ u·J v − e for every J; infinite if none is known."""
    below, _ = way.extremes(way.a - way.linear, d)
    most = way.a + way.linear
    lost = most - way.extremes(most, d)[0] + rest
    return below - rest, lost if below > 0 else lost * 0 + float("inf")


def excess(way: Direction, d: Any, rest: Any) -> Any:
    """Return e with σ_max ≤ u·J v + e for every J."""
    least = way.a - way.linear
    return way.extremes(least, d)[1] - least + rest


def ratio(small: Direction, lost: Any, great: Direction, more: Any) -> Any:
    """Upper bound of σ_max/σ_min: the same ±1 in both, so that their changes are taken together."""
    top, bottom = great.a + more, small.a - lost
    if not bottom - small.linear > 0:
        return bottom * 0 + float("inf")
    first = top / bottom
    pairs = zip(great.slopes, small.slopes, strict=True)
    away = sum((abs(x - first * y) for x, y in pairs), 0 * first)
    return first + away / (bottom - small.linear)
