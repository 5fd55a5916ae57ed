"""The bounds of a quantity on a patch and at its centre, in a compiled proof."""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import choose, dot
from gsp.variation.jets import JET_ROUNDING, Jet, magnitude
from gsp.variation.layout import PARTS
from gsp.variation.legs import Patch

# Scalars of a row: the row, its six derivatives, bounds of the rest and of the error at the centre.
ROW_SLOPES, ROW_REST, ROW_NEAR, ROW_SCALARS = 6, 42, 43, 44
# Roundings of bounds, relative to them.
OUTWARD = 1.0 + 2.0**-30
INFINITE = float("inf")


def shares_of(patch: Patch, length: Any) -> list[Any]:
    """Share of a remainder attributed to each coordinate: the squares of p_k / L and ω_k."""
    squares = [h * h / (length * length) for h in patch.half] + [dot(w, w) for w in patch.turns]
    total: Any = 0.0
    for x in squares:
        total = total + x
    per = choose(total > 0.0, 1.0 / total, 0.0)
    return [per * x for x in squares]


def bounded(jet: Jet, shares: list[Any]) -> list[Any]:
    """Return the scalars of a quantity from its jet."""
    parts = [magnitude(slope[0]) for slope in jet.slopes]
    error = JET_ROUNDING * (jet.most + jet.first)
    rest = (jet.rest + error) * OUTWARD
    reach = rest
    for part in parts:
        reach = reach + part
    reach, near = reach * OUTWARD, (jet.slack + error) * OUTWARD
    value = jet.value[0]
    split = [part + rest * share for part, share in zip(parts, shares, strict=True)]
    return [value - reach, value + reach, value - near, value + near, *split]


def folded(quantity: list[Any]) -> list[Any]:
    """Bounds of |x| from bounds of x."""

    def folds(low: Any, high: Any) -> list[Any]:
        least = choose(low > 0.0, low, choose(high < 0.0, -high, 0.0))
        # Comparisons of NaN are false: an undefined bound must stay undefined.
        least = choose(low < INFINITE, choose(high > -INFINITE, least, low), low)
        return [least, choose(-low < high, high, -low)]

    return [*folds(quantity[0], quantity[1]), *folds(quantity[2], quantity[3]), *quantity[PARTS:]]


def directed(quantity: list[Any], distance: list[Any]) -> list[Any]:
    """Change the sign of a quantity where a distance is negative; unbounded where it may be 0."""

    def turns(low: Any, high: Any, least: Any, most: Any) -> list[Any]:
        return [
            choose(least > 0.0, low, choose(most < 0.0, -high, -INFINITE)),
            choose(least > 0.0, high, choose(most < 0.0, -low, INFINITE)),
        ]

    return [
        *turns(*quantity[:2], *distance[:2]),
        *turns(*quantity[2:PARTS], *distance[2:PARTS]),
        *(a + b for a, b in zip(quantity[PARTS:], distance[PARTS:], strict=True)),
    ]


def row_scalars(row: Jet) -> list[Any]:
    """Return the scalars of a row from its jet."""
    error = JET_ROUNDING * (row.most + row.first)
    rest, near = (row.rest + error) * OUTWARD, (row.slack + error) * OUTWARD
    return [*row.value, *(x for slope in row.slopes for x in slope), rest, near]


def positive(x: Any) -> Any:
    """Return x, or 0 if it is negative; NaN stays."""
    return choose(x < 0.0, 0.0, x)


def guarded(low: Any, reach: Any) -> Any:
    """Return a lower bound, or −inf where the pose may be undefined: the reach is not finite."""
    return choose(reach < INFINITE, low, -INFINITE)
