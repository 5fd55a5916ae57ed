"""Balls with derivatives, and vectors of them, for the independent check of certificates."""

from __future__ import annotations

from typing import Any

# The second derivatives along six coordinates; of one coordinate it is the first of them.
PAIRS = tuple((k, m) for k in range(6) for m in range(k, 6))


class Number:
    """A ball, its derivatives along six coordinates or one, and its second ones, if wanted."""

    __slots__ = ("bends", "slopes", "value")

    def __init__(self, value: Any, slopes: list[Any], bends: list[Any]) -> None:
        self.value, self.slopes, self.bends = value, slopes, bends

    def __add__(self, other: Number) -> Number:
        slopes = [x + y for x, y in zip(self.slopes, other.slopes, strict=True)]
        bends = [x + y for x, y in zip(self.bends, other.bends, strict=True)]
        return Number(self.value + other.value, slopes, bends)

    def __sub__(self, other: Number) -> Number:
        slopes = [x - y for x, y in zip(self.slopes, other.slopes, strict=True)]
        bends = [x - y for x, y in zip(self.bends, other.bends, strict=True)]
        return Number(self.value - other.value, slopes, bends)

    def __mul__(self, other: Number) -> Number:
        x, y, a, b = self.value, other.value, self.slopes, other.slopes
        bends = [
            y * aa + x * bb + a[k] * b[m] + a[m] * b[k]
            for (k, m), aa, bb in zip(PAIRS, self.bends, other.bends, strict=False)
        ]
        return Number(x * y, [y * p + x * q for p, q in zip(a, b, strict=True)], bends)

    def __truediv__(self, other: Number) -> Number:
        # x = r y gives x_k = r_k y + r y_k, and so on.
        y, b, ratio = other.value, other.slopes, self.value / other.value
        r = [(p - ratio * q) / y for p, q in zip(self.slopes, b, strict=True)]
        bends = [
            (aa - ratio * bb - r[k] * b[m] - r[m] * b[k]) / y
            for (k, m), aa, bb in zip(PAIRS, self.bends, other.bends, strict=False)
        ]
        return Number(ratio, r, bends)

    def constant(self, value: Any) -> Number:
        """Return a constant with as many derivatives as this number has."""
        return Number(value, [0] * len(self.slopes), [0] * len(self.bends))

    def unknown(self, ball: Any) -> Number:
        """Return a function of this number that is in a ball, with its two derivatives."""
        a = self.slopes
        pairs = zip(PAIRS, self.bends, strict=False)
        bends = [ball * (a[k] * a[m]) + ball * aa for (k, m), aa in pairs]
        return Number(ball, [ball * x for x in a], bends)

    def root(self) -> Number:
        """Square root."""
        # x = v² gives x_k = 2 v v_k, and so on.
        v = self.value.sqrt()
        w = [a / (2 * v) for a in self.slopes]
        bends = [
            (aa - 2 * w[k] * w[m]) / (2 * v) for (k, m), aa in zip(PAIRS, self.bends, strict=False)
        ]
        return Number(v, w, bends)

    def arccosine(self) -> Number:
        """Angle in [0, π] of a cosine."""
        # x = cos v gives x_k = −sin v v_k, and so on.
        x, sine = self.value, (1 - self.value * self.value).sqrt()
        w = [-a / sine for a in self.slopes]
        pairs = zip(PAIRS, self.bends, strict=False)
        return Number(x.acos(), w, [-(aa + x * w[k] * w[m]) / sine for (k, m), aa in pairs])

    def sine_cosine(self) -> tuple[Number, Number]:
        """Sine and cosine."""
        s, c, a = self.value.sin(), self.value.cos(), self.slopes
        squares = [a[k] * a[m] for k, m in PAIRS]
        waves = [
            [x * aa - y * q for aa, q in zip(self.bends, squares, strict=False)]
            for x, y in ((c, s), (-s, c))
        ]
        return Number(s, [c * x for x in a], waves[0]), Number(c, [-s * x for x in a], waves[1])


class Rate:
    """A number and its rate along a twist of the platform."""

    __slots__ = ("rate", "value")

    def __init__(self, value: Number, rate: Number) -> None:
        self.value, self.rate = value, rate

    def __add__(self, other: Rate) -> Rate:
        return Rate(self.value + other.value, self.rate + other.rate)

    def __sub__(self, other: Rate) -> Rate:
        return Rate(self.value - other.value, self.rate - other.rate)

    def __mul__(self, other: Rate) -> Rate:
        return Rate(self.value * other.value, self.rate * other.value + self.value * other.rate)

    def __truediv__(self, other: Rate) -> Rate:
        ratio = self.value / other.value
        return Rate(ratio, (self.rate - ratio * other.rate) / other.value)

    def root(self) -> Rate:
        """Square root."""
        v = self.value.root()
        return Rate(v, self.rate / (v + v))


Vector = list[Any]


def dot(x: Vector, y: Vector) -> Any:
    """Scalar product."""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


def cross(x: Vector, y: Vector) -> Vector:
    """Vector product."""
    pairs = ((1, 2), (2, 0), (0, 1))
    return [x[i] * y[j] - x[j] * y[i] for i, j in pairs]


def plus(x: Vector, y: Vector) -> Vector:
    """Sum."""
    return [a + b for a, b in zip(x, y, strict=True)]


def minus(x: Vector, y: Vector) -> Vector:
    """Difference."""
    return [a - b for a, b in zip(x, y, strict=True)]


def times(factor: Any, x: Vector) -> Vector:
    """Return a vector multiplied by a number."""
    return [factor * a for a in x]


def unit(x: Vector) -> Vector:
    """Return a vector divided by its length."""
    length = dot(x, x).root()
    return [a / length for a in x]
