"""Numbers as they are printed: read from text, and compared digit by digit."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import ROUND_DOWN, ROUND_HALF_EVEN, Context, Decimal, InvalidOperation
from types import MappingProxyType
from typing import Literal

from gsp.errors import InvalidInput, expected

Rounding = Literal["rounded", "cut", "exact"]

# What "exact" means in double precision, relative to values above one, and as decimal digits.
EXACT_TOLERANCE = 1e-12
EXACT_DIGITS = 12
# Relative rounding of a computed value that may lie on a rounding boundary.
NOISE = Decimal("1e-12")
# Digits enough for every double, down to any unit.
_WIDE = Context(prec=1200)

_OPERATIONS: Mapping[type[ast.operator], Callable[[float, float], float]] = MappingProxyType(
    {
        ast.Add: operator.add,
        ast.Sub: operator.sub,
        ast.Mult: operator.mul,
        ast.Div: operator.truediv,
        ast.Pow: operator.pow,
    }
)
_FUNCTIONS: Mapping[str, Callable[[float], float]] = MappingProxyType(
    {
        "sqrt": math.sqrt,
        "sin": math.sin,
        "cos": math.cos,
        "arctan": math.atan,
        "arcsin": math.asin,
        "arccos": math.acos,
    }
)


@dataclass(frozen=True)
class Agreement:
    """The comparison of a computed value with a printed one.

    Attributes
    ----------
    agrees : bool
        Whether it is the printed value, as far as that is printed.
    digits, of : int
        Leading digits that are the same, and digits that are printed; both 0 if unreadable.
    readable : bool
        Whether the print is a number at all.
    """

    agrees: bool
    digits: int
    of: int
    readable: bool = True


UNREADABLE = Agreement(False, 0, 0, readable=False)


def evaluate(text: str, names: Mapping[str, float] | None = None) -> float:
    """Return the value of an expression of numbers, `pi`, + − * / ^, roots and arc functions.

    Parameters
    ----------
    text : str
    names : mapping from str to float, optional
        Values of the letters in it.

    Raises
    ------
    InvalidInput
        If it is not such an expression, or has a letter without a value.

    Examples
    --------
    >>> evaluate("sqrt(2*sqrt(5) - 4)") == (2 * 5**0.5 - 4) ** 0.5
    True
    """
    try:
        tree = ast.parse(text.strip().replace("^", "**").replace("−", "-"), mode="eval").body
        return _value(tree, {"pi": math.pi, **(names or {})})
    except (SyntaxError, KeyError, ArithmeticError, ValueError, TypeError) as error:
        raise InvalidInput(
            expected("printed number", "a number or an expression", repr(text))
        ) from error


def _value(node: ast.expr, names: Mapping[str, float]) -> float:
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return float(number)
        case ast.Name(id=name):
            return float(names[name])
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand, names)
        case ast.BinOp(left=left, op=op, right=right):
            return float(_OPERATIONS[type(op)](_value(left, names), _value(right, names)))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]):
            return _FUNCTIONS[name](_value(argument, names))
        case _:
            raise ValueError(ast.dump(node))


def compare(
    text: str,
    computed: float,
    rounding: Rounding = "rounded",
    decimals: int | None = None,
    names: Mapping[str, float] | None = None,
) -> Agreement:
    """Compare a computed value with a printed one.

    Parameters
    ----------
    text : str
        As printed.
    computed : float
    rounding : "rounded", "cut" or "exact"
        Whether the print was rounded (the value lies within half a unit of the last digit), cut
        toward zero, or is meant exactly (the value agrees to 1e-12).
    decimals : int or None
        Digits after the point that the print has, where it leaves out zeros at the end.
    names : mapping from str to float, optional
        Letters in an exact expression.

    Examples
    --------
    >>> compare("0.687", 0.68712).agrees, compare("0.68", 0.687, "cut").agrees
    (True, True)
    """
    if rounding == "exact":
        return _compare_exactly(text, computed, names)
    try:
        printed = Decimal(text.strip().replace("−", "-"))
    except InvalidOperation:
        return UNREADABLE
    if not printed.is_finite():
        return UNREADABLE
    places = max(0, -int(printed.as_tuple().exponent)) if decimals is None else decimals
    unit = Decimal(1).scaleb(-places)
    of = _digits(printed, unit)
    if not math.isfinite(computed):
        return Agreement(False, 0, of)
    value = Decimal(computed)
    if rounding == "cut":
        ways = [(value * (1 + k * NOISE)).quantize(unit, ROUND_DOWN, _WIDE) for k in (0, 1)]
        near = next((way for way in ways if way == printed), ways[0])
        agrees = near == printed
    else:
        near = value.quantize(unit, ROUND_HALF_EVEN, _WIDE)
        agrees = abs(value - printed) <= unit / 2 * (1 + NOISE)
    return Agreement(agrees, of if agrees else _same_digits(printed, near, unit), of)


def _compare_exactly(text: str, computed: float, names: Mapping[str, float] | None) -> Agreement:
    try:
        value = evaluate(text, names)
    except InvalidInput:
        return UNREADABLE
    error = abs(computed - value) / max(1.0, abs(value))
    if not error < 1.0:
        return Agreement(False, 0, EXACT_DIGITS)
    digits = (
        EXACT_DIGITS if error <= EXACT_TOLERANCE else min(EXACT_DIGITS - 1, int(-math.log10(error)))
    )
    return Agreement(error <= EXACT_TOLERANCE, digits, EXACT_DIGITS)


def _digits(value: Decimal, unit: Decimal) -> int:
    """Digits of a value down to a unit, without zeros in front."""
    return len(str(int(abs(value) / unit)))


def _same_digits(printed: Decimal, near: Decimal, unit: Decimal) -> int:
    """Leading digits that two values share, counted as `_digits` counts them."""
    if (printed < 0) != (near < 0):
        return 0
    ours, theirs = (str(int(abs(x) / unit)) for x in (near, printed))
    if len(ours) != len(theirs):
        return 0
    return next((i for i, (x, y) in enumerate(zip(ours, theirs, strict=True)) if x != y), len(ours))
