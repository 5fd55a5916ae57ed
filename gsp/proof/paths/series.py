"""Taylor polynomials of functions of one variable, with balls as coefficients.

The coefficients of a `Series` at a ball of the variable hold those of the function at every point
of the ball. For a function f, the coefficients c at the middle m and C at the ball of radius h give

    f(m + δ) = c_0 + c_1 δ + … + c_{K−1} δ^{K−1} + C_K δ^K,    |δ| ≤ h,

by Taylor's formula, and so for the derivatives of f. The formulas of `gsp.model` run on this kind
of number: see `gsp.geometry.scalars`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import comb, factorial
from typing import Any

import numpy as np

from gsp.geometry.vectors import Array, Mask

# Rounding of a sum of a few products, relative to the sum of their sizes: 16 units.
SUM_ROUNDING = 2.0**-49
SUM_OUTWARD = 1.0 + SUM_ROUNDING
# Squares of angles beyond which `turning` uses bounds instead of the power series, and its terms.
SERIES_SQUARE, SERIES_TERMS = 45.0, 40

# A ball: its middle and its radius.
Ball = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class Series:
    """Balls of the coefficients of 1, δ, δ², …, along the first axis.

    Attributes
    ----------
    mid, rad : (k, ...) arrays
    """

    mid: Array
    rad: Array

    # Operators of numpy arrays leave the work to those of this class.
    __array_ufunc__ = None

    @classmethod
    def constant(cls, value: Array, radius: Any, size: int) -> Series:
        """Return the series of a constant that is known to within a radius."""
        mid = np.zeros((size, *np.shape(value)))
        rad = np.zeros_like(mid)
        mid[0], rad[0] = value, radius
        return cls(mid, rad)

    @classmethod
    def variable(cls, value: Array, radius: Array, size: int) -> Series:
        """Return the series of the variable itself at balls."""
        result = cls.constant(value, radius, size)
        result.mid[1] = 1.0
        return result

    def __getitem__(self, place: Any) -> Series:
        """Return a part of all axes but the first."""
        some = (slice(None), *(place if isinstance(place, tuple) else (place,)))
        return Series(self.mid[some], self.rad[some])

    def __neg__(self) -> Series:
        return Series(-self.mid, self.rad)

    def __add__(self, other: Any) -> Series:
        if isinstance(other, Series):
            mid = self.mid + other.mid
            rad = self.rad + other.rad
        else:
            mid, rad = self.mid.copy(), self.rad
            mid[0] += other
        return Series(mid, (rad + SUM_ROUNDING * np.abs(mid)) * SUM_OUTWARD)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Series:
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Series:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Series:
        if not isinstance(other, Series):
            mid = self.mid * other
            return Series(mid, (self.rad * abs(other) + SUM_ROUNDING * np.abs(mid)) * SUM_OUTWARD)
        one, two = np.abs(self.mid), np.abs(other.mid)
        rad = _product(one, other.rad + SUM_ROUNDING * two) + _product(self.rad, two + other.rad)
        return Series(_product(self.mid, other.mid), rad * SUM_OUTWARD)

    __rmul__ = __mul__

    def __truediv__(self, other: Series) -> Series:
        return self * other.inverse()

    def __rtruediv__(self, other: Any) -> Series:
        return self.inverse().__mul__(other)

    def __lt__(self, other: Any) -> Condition:
        gap = self - other
        return Condition(gap.mid[0] + gap.rad[0] < 0.0, gap.mid[0] - gap.rad[0] >= 0.0)

    def __gt__(self, other: Any) -> Condition:
        return (-self).__lt__(-other)

    def inverse(self) -> Series:
        """1/x; balls that may hold 0 have no bounds."""
        x = _inverse((self.mid[0], self.rad[0]))
        powers = [x]
        for _ in range(len(self.mid) - 1):
            mid, rad = _times(powers[-1], x)
            powers.append((-mid, rad))
        return self.composed(powers)

    def sqrt(self) -> Series:
        """Square root; balls that may hold 0 have no bounds."""
        mid, rad = self.mid[0], self.rad[0]
        root = np.sqrt(mid)
        # |√x − √m| = |x − m|/(√x + √m).
        known = rad < mid
        ball = root, (np.where(known, rad / root, np.inf) + SUM_ROUNDING * root) * SUM_OUTWARD
        inverse = _inverse(ball)
        square, powers, factor = _times(inverse, inverse), [ball], 1.0
        last = _times(ball, square)
        for k in range(1, len(self.mid)):
            factor *= (1.5 - k) / k
            powers.append((last[0] * factor, last[1] * abs(factor)))
            last = _times(last, square)
        return self.composed([(m, r * SUM_OUTWARD + SUM_ROUNDING * np.abs(m)) for m, r in powers])

    def atan2(self, other: Series) -> Series:
        """Angle of the vector (other, self): its derivative is that of both over |…|²."""
        y, x, size = self, other, len(self.mid)
        short = [Series(v.mid[:-1], v.rad[:-1]) for v in (y, x)]
        rate = (short[1] * y.derivative() - short[0] * x.derivative()) / (
            short[1] * short[1] + short[0] * short[0]
        )
        length, reach = np.hypot(x.mid[0], y.mid[0]), np.hypot(x.rad[0], y.rad[0])
        per = 1.0 / np.arange(1.0, size)[(slice(None), *[None] * (rate.mid.ndim - 1))]
        first = np.arctan2(y.mid[0], x.mid[0])
        # asin(q) ≤ q/(1 − q).
        off = np.where(reach < length, reach / (length - reach), np.inf)
        rad = np.concatenate(
            ((off + 4.0 * SUM_ROUNDING)[None] * SUM_OUTWARD, rate.rad * per * SUM_OUTWARD)
        )
        mid = np.concatenate((first[None], rate.mid * per))
        return Series(mid, rad + SUM_ROUNDING * np.abs(mid))

    def derivative(self) -> Series:
        """Return the series of the derivative, which has one coefficient less."""
        k = np.arange(1.0, len(self.mid))[(slice(None), *[None] * (self.mid.ndim - 1))]
        return Series(
            self.mid[1:] * k, self.rad[1:] * k * SUM_OUTWARD + SUM_ROUNDING * np.abs(self.mid[1:])
        )

    def composed(self, outer: list[Ball]) -> Series:
        """Return the series of a function whose coefficients at the ball of self[0] are given."""
        inner = Series(self.mid.copy(), self.rad.copy())
        inner.mid[0] = inner.rad[0] = 0.0
        result = Series.constant(*outer[-1], len(self.mid))
        for mid, rad in outer[-2::-1]:
            result = result * inner
            result = Series(result.mid.copy(), result.rad.copy())
            result.mid[0], result.rad[0] = mid, rad
        return result

    def turning(self, start: int) -> Series:
        """Σ_n (−x)ⁿ/(2n + start)! for x ≥ 0: with x = θ² and start = 1, sin θ/θ.

        start = 2 gives (1 − cos θ)/θ², 3 gives (θ − sin θ)/θ³. These functions are means of
        cos(y√x), 0 ≤ y ≤ 1, whose derivatives, and so theirs, are greatest at x = 0.
        """
        mid, rad = self.mid[0], self.rad[0]
        near = np.minimum(mid, SERIES_SQUARE)
        powers = near[None] ** np.arange(SERIES_TERMS).reshape(-1, *[1] * mid.ndim)
        outer = []
        for k in range(len(self.mid)):
            weights = _weights(k, start)
            terms = weights.reshape(-1, *[1] * mid.ndim) * powers[: SERIES_TERMS - k]
            most, slope = abs(weights[0]), abs(_weights(k + 1, start)[0]) * (k + 1)
            off = rad * slope + 16.0 * SUM_ROUNDING * np.abs(terms).sum(axis=0)
            far = mid > SERIES_SQUARE
            outer.append(
                (
                    np.where(far, 0.0, terms.sum(axis=0)),
                    np.where(far, most, np.minimum(off * SUM_OUTWARD, 2.0 * most)),
                )
            )
        return self.composed(outer)


@dataclass(frozen=True, eq=False)
class Condition:
    """Whether a condition holds at all points of balls, and whether it holds at none."""

    always: Mask
    never: Mask

    def choose(self, yes: Any, no: Any) -> Series:
        """Return `yes` or `no`; where neither is certain, what holds both.

        A function that changes from one to the other has one-sided first derivatives, which the
        hull of both holds, and no second one.
        """
        one, two = (np.stack((x.mid - x.rad, x.mid + x.rad)) for x in (yes, no))
        low, high = np.minimum(one[0], two[0]), np.maximum(one[1], two[1])
        both = (
            0.5 * (low + high),
            (0.5 * (high - low)) * SUM_OUTWARD + SUM_ROUNDING * np.abs(low + high),
        )
        both[1][2:] = np.inf
        mid = np.where(self.always, yes.mid, np.where(self.never, no.mid, both[0]))
        rad = np.where(self.always, yes.rad, np.where(self.never, no.rad, both[1]))
        return Series(mid, rad)


@cache
def _weights(k: int, start: int) -> Array:
    """Coefficients of the k-th derivative of Σ_n (−x)ⁿ/(2n + start)!, n < SERIES_TERMS, over k!."""
    return np.array(
        [(-1) ** n * comb(n, k) / factorial(2 * n + start) for n in range(k, SERIES_TERMS)]
    )


def _product(x: Array, y: Array) -> Array:
    """Coefficients of a product, as far as both have them."""
    result = x[0] * y
    for k in range(1, len(x)):
        result[k:] += x[k] * y[:-k]
    return np.asarray(result)


def _times(x: Ball, y: Ball) -> Ball:
    one, two = np.abs(x[0]), np.abs(y[0])
    rad = one * (y[1] + SUM_ROUNDING * two) + x[1] * (two + y[1])
    return x[0] * y[0], rad * SUM_OUTWARD


def _inverse(x: Ball) -> Ball:
    mid, rad = 1.0 / x[0], x[1]
    size = np.abs(x[0])
    off = np.where(rad < size, rad / (size * (size - rad)), np.inf)
    return mid, (off + SUM_ROUNDING * np.abs(mid)) * SUM_OUTWARD


def constant_product(left: Array, x: Series, right: Array) -> Series:
    """Matrices left X right; entries of the constant ones are rounded to 16 units.

    Parameters
    ----------
    left, right : (n, 3, 3) arrays
        Entries of size at most 1.
    x : Series of matrices, shape (k, 3, 3, n)
    """
    rule = "nij,kjln,nlm->kimn"
    mid = np.einsum(rule, left, x.mid, right)
    one, two = np.abs(left) + SUM_ROUNDING, np.abs(right) + SUM_ROUNDING
    size = np.abs(x.mid) + x.rad
    rad = np.einsum(rule, one, x.rad + 4.0 * SUM_ROUNDING * size, two)
    # A rounding of an entry counts where the entry is 0, too.
    spread = np.einsum(rule, np.ones_like(one), size, two) + np.einsum(
        rule, one, size, np.ones_like(two)
    )
    return Series(mid, (rad + SUM_ROUNDING * spread) * SUM_OUTWARD)
