"""Bounds of every quantity on a box, in balls, by the mean value theorem: see `check`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gsp.proof.verification.claims import is_angle, pairs_of
from gsp.proof.verification.matrices import (
    Range,
    Rows,
    control,
    most,
    rest_of,
    shares_of,
    singular_values,
    volume,
)
from gsp.proof.verification.model import Evaluated, Model

SPECTRAL = ("minimum_singular_value", "condition_number")


def claimed(model: Model, name: str) -> tuple[Any, Any]:
    """Bounds that are claimed of a quantity; of angles, in [0, π], those of the cosine."""
    if name == "regular":
        return model.ball(0), None
    lower, upper = model.claims["bounds"][name]
    if not is_angle(name):
        return lower, upper
    pi = model.ball.pi()
    least = None if upper is None or upper >= pi else model.ball(2 if upper < 0 else upper)
    greatest = None if lower is None or lower <= 0 else model.ball(lower)
    return (
        None if least is None else model.ball(2) if upper < 0 else least.cos(),
        None if greatest is None else model.ball(-2) if lower > pi else greatest.cos(),
    )


def ranges(model: Model, low: list[float], high: list[float]) -> Iterable[tuple[str, Range]]:
    """Yield bounds on a box of each quantity that something is claimed of."""
    ball, flint = model.ball, model.flint
    least, greatest = [ball(x) for x in low], [ball(x) for x in high]
    middle = [(x + y) / 2 for x, y in zip(least, greatest, strict=True)]
    half = [(y - x) / 2 for x, y in zip(least, greatest, strict=True)]
    whole = [m.union(x).union(y) for m, x, y in zip(middle, least, greatest, strict=True)]
    here, wide = model.evaluate(middle), model.evaluate(whole, second=True)
    names, pairs = list(model.claims["bounds"]), pairs_of(model)
    for name in names:
        if " of " in name:
            yield name, _rate(model, name, here, wide, half)
        elif name in here.values:
            yield name, _scalar(model, name, here, wide, half)
        elif name in pairs:
            yield name, _clearance(model, pairs[name], here, wide, half)
    rows = Rows.of(flint, here.rows, wide.rows, half)
    if model.claims["regular"] or any(name in names for name in SPECTRAL):
        smallest, ratio = singular_values(rows)
        if model.claims["regular"]:
            positive = ball(1) if smallest[0] > 0 else ball(-1)
            yield "regular", (positive, ball(1), smallest[2])
        for name, found in zip(SPECTRAL, (smallest, ratio), strict=True):
            if name in names:
                yield name, found
    if "manipulability" in names:
        below, above, parts = volume(rows)
        angles = sum("A1" in leg["constraints"] for leg in model.legs)
        unit = ball(model.claims["length"]) ** (3 - angles)
        yield "manipulability", (unit * below, unit * above, parts)
    if "condition_number_ellipsoid" in names:
        seen = Rows.of(flint, here.ellipsoid, wide.ellipsoid, half)
        yield "condition_number_ellipsoid", singular_values(seen)[1]
    if "control_number" in names:
        yield "control_number", control(rows, Rows.of(flint, here.passive, wide.passive, half))


def _scalar(model: Model, name: str, here: Evaluated, wide: Evaluated, half: list[Any]) -> Range:
    """Bounds of a joint, a coordinate or the cosine of a cone, by the mean value theorem."""
    parts = [abs(h * g) for h, g in zip(half, here.values[name].slopes, strict=True)]
    rest = rest_of(half, [wide.values[name]])
    reach, value = sum(parts, model.ball(0)) + rest, here.values[name].value
    shares = shares_of(parts, rest, half)
    if not (wide.values[name].value.is_finite() and _signed(model, name, wide)):
        return -model.ball("inf"), model.ball("inf"), shares
    low, high = value - reach, value + reach
    if name.startswith("d"):
        # The distance of a D4 leg has a sign here.
        low, high = (
            (low, high)
            if low > 0
            else (-high, -low)
            if high < 0
            else (
                model.ball(0),
                most(low).max(most(high)),
            )
        )
    return low, high, shares


def _rate(model: Model, name: str, here: Evaluated, wide: Evaluated, half: list[Any]) -> Range:
    """Bounds of the speed of a joint along a path, by the mean value theorem, or acceleration."""
    ball, (kind, joint) = model.ball, name.split(" of ")
    middle, whole, shares = here.values[joint], wide.values[joint], [1.0]
    if joint.startswith("theta"):
        middle, whole = middle.arccosine(), whole.arccosine()
    (bend,) = whole.bends
    low = high = bend / model.span**2
    if kind == "speed":
        (slope,) = middle.slopes
        reach = most(half[0] * bend)
        low, high = (slope - reach) / model.span, (slope + reach) / model.span
    if not (bend.is_finite() and low.is_finite()):
        return ball("-inf"), ball("inf"), shares
    if joint.startswith("theta") or whole.value > 0:
        return low, high, shares
    if whole.value < 0:
        return -high, -low, shares
    # Where the lines of a D4 leg meet, the speed jumps and the acceleration has no bound.
    far = most(low).max(most(high)) if kind == "speed" else ball("inf")
    return -far, far, shares


def _signed(model: Model, name: str, wide: Evaluated) -> bool:
    """Whether the direction of a leg keeps its sign: CCC legs turn about where lines meet."""
    if "cone" not in name:
        return True
    i = int(name.split()[-1])
    if model.legs[i - 1]["constraints"].split()[0] not in ("D4", "A1"):
        return True
    return not wide.values[f"distance {i}"].value.contains(0)


def _clearance(
    model: Model, legs: tuple[int, int], here: Evaluated, wide: Evaluated, half: list[Any]
) -> Range:
    """Distance of two legs: at least the least n · (x − y) of their ends for a unit vector n."""
    ball, (i, j) = model.ball, legs
    feet = [[[float(c.value.mid()) for c in x] for x in here.feet[k]] for k in (i, j)]
    s, t, n = nearest(*feet)
    low, shares = ball("inf"), [0.0] * len(half)
    for x, wide_x in zip(here.feet[i], wide.feet[i], strict=True):
        for y, wide_y in zip(here.feet[j], wide.feet[j], strict=True):
            gap = [a - b for a, b in zip(x, y, strict=True)]
            slopes = [
                sum((ball(c) * g.slopes[k] for c, g in zip(n, gap, strict=True)), ball(0))
                for k in range(len(half))
            ]
            parts = [abs(h * g) for h, g in zip(half, slopes, strict=True)]
            rest = rest_of(half, [a - b for a, b in zip(wide_x, wide_y, strict=True)])
            value = sum((ball(c) * g.value for c, g in zip(n, gap, strict=True)), ball(0))
            value = value - sum(parts, ball(0)) - rest
            low = low.min(value)
            shares = [max(a, b) for a, b in zip(shares, shares_of(parts, rest, half), strict=True)]
    size = sum((ball(c) * ball(c) for c in n), ball(0)).sqrt()
    one, other = (
        [a.value * (1 - ball(share)) + b.value * share for a, b in zip(*wide.feet[k], strict=True)]
        for k, share in ((i, s), (j, t))
    )
    high = sum(((a - b) ** 2 for a, b in zip(one, other, strict=True)), ball(0)).sqrt()
    return low / size if size > 0 else ball(0), high, shares


def nearest(one: list[list[float]], other: list[list[float]]) -> tuple[float, float, list[float]]:
    """Shares of the nearest points on two segments, and the difference of the points.

    By alternation between the segments, which need not be exact.
    """
    s = t = 0.5

    def at(segment: list[list[float]], share: float) -> list[float]:
        return [a + share * (b - a) for a, b in zip(*segment, strict=True)]

    def foot(point: list[float], segment: list[list[float]]) -> float:
        along = [b - a for a, b in zip(*segment, strict=True)]
        square = sum(c * c for c in along)
        ahead = sum(c * (p - a) for c, p, a in zip(along, point, segment[0], strict=True))
        return min(max(ahead / square, 0.0), 1.0) if square > 0.0 else 0.0

    for _ in range(200):
        s = foot(at(other, t), one)
        t = foot(at(one, s), other)
    return s, t, [a - b for a, b in zip(at(one, s), at(other, t), strict=True)]
