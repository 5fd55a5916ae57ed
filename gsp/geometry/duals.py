"""Dual numbers: values with their derivatives along several directions."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.geometry.vectors import Array


class Dual:
    """A number of `gsp.geometry.scalars` that carries its derivatives.

    Attributes
    ----------
    real : (...) array
        Values.
    slope : (k, ...) array
        Their derivatives along k directions; axes after the first broadcast with `real`.
    """

    __slots__ = ("real", "slope")
    # Products with an array on the left are made here, not element by element.
    __array_ufunc__ = None

    def __init__(self, real: Array, slope: Array) -> None:
        self.real, self.slope = real, slope

    def __add__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.real + other.real, self.slope + other.slope)
        return Dual(self.real + other, self.slope)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.real - other.real, self.slope - other.slope)
        return Dual(self.real - other, self.slope)

    def __rsub__(self, other: Any) -> Dual:
        return Dual(other - self.real, -self.slope)

    def __neg__(self) -> Dual:
        return Dual(-self.real, -self.slope)

    def __mul__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            slope = self.slope * other.real + other.slope * self.real
            return Dual(self.real * other.real, slope)
        return Dual(self.real * other, self.slope * other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            ratio = self.real / other.real
            return Dual(ratio, (self.slope - other.slope * ratio) / other.real)
        return Dual(self.real / other, self.slope / other)

    def __rtruediv__(self, other: Any) -> Dual:
        ratio = other / self.real
        return Dual(ratio, -self.slope * (ratio / self.real))

    def sqrt(self) -> Dual:
        """Return the square root."""
        root = np.sqrt(self.real)
        return Dual(root, self.slope * (0.5 / root))

    def atan2(self, cosine: Dual) -> Dual:
        """Return the angle of which this number is the sine."""
        square = self.real * self.real + cosine.real * cosine.real
        slope = self.slope * (cosine.real / square) - cosine.slope * (self.real / square)
        return Dual(np.asarray(np.arctan2(self.real, cosine.real)), slope)

    def where(self, condition: Any, other: Any) -> Dual:
        """Return this number where a condition holds, else another one."""
        if not isinstance(other, Dual):
            other = Dual(np.asarray(other, dtype=np.float64), np.zeros_like(self.slope))
        real = np.where(condition, self.real, other.real)
        return Dual(real, np.where(condition, self.slope, other.slope))
