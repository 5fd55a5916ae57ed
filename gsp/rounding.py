"""Numbers with few digits that are still true: ends of what is proven, rounded in one direction."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal

# A value that differs less from a number with few digits [share of it] is that number: rounding.
SHORT_WITHIN = 1e-15
# At most so many: more of a number in double precision are rounding.
COORDINATE_DIGITS = 15


def digits_within(value: float, size: float, digits: int = 6) -> int:
    """Return the significant digits of a coordinate that tell places of a size apart.

    >>> digits_within(0.3, 2.0), digits_within(10000.0279, 2.0), digits_within(1e6, 0.0)
    (6, 10, 6)
    """
    ratio = abs(value) / size if size > 0.0 else 0.0
    more = math.ceil(math.log10(ratio)) if 1.0 < ratio < math.inf else 0
    return min(digits + more, COORDINATE_DIGITS)


def rounded_down(value: float, digits: int) -> float:
    """Return the greatest number with so many significant digits that is not above a value.

    >>> rounded_down(6.9829, 2), rounded_down(-6.9829, 2), rounded_down(0.1 + 0.2, 3)
    (6.9, -7.0, 0.3)
    """
    return _rounded(value, digits, ROUND_FLOOR)


def rounded_up(value: float, digits: int) -> float:
    """Return the least number with so many significant digits that is not below a value.

    >>> rounded_up(6.9129, 2), rounded_up(-6.9829, 2), rounded_up(float("inf"), 2)
    (7.0, -6.9, inf)
    """
    return _rounded(value, digits, ROUND_CEILING)


def _rounded(value: float, digits: int, way: str) -> float:
    if not math.isfinite(value):
        return value
    exact = Decimal(value)
    near = Context(prec=digits, rounding=ROUND_HALF_EVEN).create_decimal(exact)
    if abs(near - exact) <= abs(exact) * Decimal(SHORT_WITHIN):
        return float(near)
    return float(Context(prec=digits, rounding=way).create_decimal(exact))
