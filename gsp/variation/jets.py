"""Jets: vectors that move along straight paths out of the middle of a patch, with bounds.

A patch is a set of poses that straight paths x(τ) = centre + τ δ, 0 ≤ τ ≤ 1, reach from its centre;
|δ_k| ≤ 1 for each of its six coordinates. For a vector X(τ) that depends on the pose, a jet holds
the value and the six derivatives at the centre, and numbers that bound X′ and X″ on every path.
By Taylor's formula

    X(1) − X(0) = Σ_k δ_k ∂_k X + E,    |E| ≤ slack + second / 2.

The slack bounds what the six derivatives leave out of X′(0): tolerances of the design, and
rounding, of which every operation adds its own. The rules are derived in `docs/proofs.md`. Scalars
may be floats or the symbols of `gsp.kernels.trace`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

from gsp.geometry.scalars import choose, cross, dot, minus, norm, plus, root, times

Vector = list[Any]

# Rounding of values and derivatives, relative to the terms they are made of: 2⁻⁴⁴ is 256 units.
JET_ROUNDING = 2.0**-44
# Derivatives of unit vectors: |u″| ≤ |n″|/|n| + c (|n′|/|n|)². This is c = 2/√3, rounded up.
UNIT_SECOND_DERIVATIVE = 1.1547005383792517


@dataclass(frozen=True)
class Jet:
    """A vector (or a scalar, as a vector of one) along the paths of a patch.

    Attributes
    ----------
    value : list of scalars
        At the centre.
    slopes : list of six vectors, or of one
        Derivatives at the centre along the coordinates, scaled by the half-widths; on a patch of
        one direction the derivative along it.
    slack, first, second : scalars
        Bounds of the part of X′(0) that is not in `slopes`, of |X′| and of |X″| on the paths.
    most : scalar
        Bound of |X| on the patch.
    """

    value: Vector
    slopes: list[Vector]
    slack: Any
    first: Any
    second: Any
    most: Any

    @property
    def rest(self) -> Any:
        """Bound of the remainder after the value and the slopes."""
        return self.slack + 0.5 * self.second


def largest(x: Any, y: Any) -> Any:
    """Return the larger of two scalars."""
    return choose(x < y, y, x)


def least(x: Any, y: Any) -> Any:
    """Return the smaller of two scalars."""
    return choose(x < y, x, y)


def magnitude(x: Any) -> Any:
    """Absolute value of a scalar."""
    return choose(x < 0.0, -x, x)


def size(x: Vector) -> Any:
    """Euclidean norm of a vector or a scalar."""
    return magnitude(x[0]) if len(x) == 1 else norm(x)


def constant(value: Vector, most: Any) -> Jet:
    """Return the jet of a constant vector."""
    return Jet(value, [[0.0] * len(value)] * 6, 0.0, 0.0, 0.0, most)


def _pairs(x: Jet, y: Jet) -> Iterable[tuple[Vector, Vector]]:
    """Return the slopes of two jets together; one, if one of them has one: constants have six."""
    return zip(x.slopes, y.slopes, strict=False)


def total(x: Jet, y: Jet, sign: float = 1.0) -> Jet:
    """Sum of two jets, or their difference with sign −1."""
    join = plus if sign > 0.0 else minus
    value, first = join(x.value, y.value), x.first + y.first
    return Jet(
        value,
        [join(a, b) for a, b in _pairs(x, y)],
        x.slack + y.slack + JET_ROUNDING * (x.most + y.most + first),
        first,
        x.second + y.second,
        size(value) + first,
    )


def scaled(factor: Any, x: Jet) -> Jet:
    """Return a jet multiplied by a positive constant."""
    return Jet(
        times(factor, x.value),
        [times(factor, slope) for slope in x.slopes],
        factor * x.slack,
        factor * x.first,
        factor * x.second,
        factor * x.most,
    )


def _product(
    join: Callable[[Vector, Vector], Vector], x: Jet, y: Jet, *, close: bool = True
) -> Jet:
    """Return a bilinear product with |x ∘ y| ≤ |x| |y|; `close` takes a root for its bound."""
    value, first = join(x.value, y.value), x.most * y.first + y.most * x.first
    most = x.most * y.most
    return Jet(
        value,
        [plus(join(dx, y.value), join(x.value, dy)) for dx, dy in _pairs(x, y)],
        x.most * y.slack + y.most * x.slack + JET_ROUNDING * (most + first),
        first,
        x.most * y.second + 2.0 * (x.first * y.first) + y.most * x.second,
        # A product may be far below that of the norms: the slide of a leg on its line.
        least(most, size(value) + first) if close else most,
    )


def joined(x: Jet, y: Jet) -> Jet:
    """Return two vectors as one; its bounds are hypotenuses of theirs."""
    return Jet(
        [*x.value, *y.value],
        [[*a, *b] for a, b in _pairs(x, y)],
        _hypotenuse(x.slack, y.slack),
        _hypotenuse(x.first, y.first),
        _hypotenuse(x.second, y.second),
        _hypotenuse(x.most, y.most),
    )


def row_of(x: Jet, y: Jet) -> Jet:
    """Return two vectors as one row, of which |X| and |X′| serve for rounding: these are sums."""
    row = joined(x, y)
    return replace(row, first=x.first + y.first, most=x.most + y.most)


def _hypotenuse(x: Any, y: Any) -> Any:
    return root(x * x + y * y)


def inner(x: Jet, y: Jet) -> Jet:
    """Scalar product."""
    return _product(lambda a, b: [dot(a, b)], x, y)


def outer(x: Jet, y: Jet, *, close: bool = True) -> Jet:
    """Vector product."""
    return _product(cross, x, y, close=close)


def multiple(factor: Jet, x: Jet) -> Jet:
    """Return a vector times a scalar, both of which vary."""
    return _product(lambda a, b: times(a[0], b), factor, x)


def inverse(x: Jet) -> Jet:
    """1/x of a scalar; its bounds are infinite if x may vanish."""
    per, low = 1.0 / x.value[0], magnitude(x.value[0]) - x.first
    most = choose(low > 0.0, 1.0 / low, float("inf"))
    square = most * most
    return Jet(
        [per],
        [[-(per * per * slope[0])] for slope in x.slopes],
        square * (x.slack + JET_ROUNDING * x.first),
        square * x.first,
        square * x.second + 2.0 * square * most * (x.first * x.first),
        most,
    )


def length(x: Jet) -> Jet:
    """|x|; |x|″ ≤ |x″| + |x′|²/|x|."""
    value = size(x.value)
    per, low = 1.0 / value, value - x.first
    most = choose(low > 0.0, 1.0 / low, float("inf"))
    return Jet(
        [value],
        [[per * dot(x.value, slope)] for slope in x.slopes],
        x.slack + JET_ROUNDING * x.first,
        x.first,
        x.second + most * (x.first * x.first),
        value + x.first,
    )


def unit(x: Jet) -> Jet:
    """x/|x|; its bounds are infinite if x may vanish."""
    value = size(x.value)
    per, low = 1.0 / value, value - x.first
    most = choose(low > 0.0, 1.0 / low, float("inf"))
    u, turn = times(per, x.value), most * x.first
    slopes = [times(per, minus(slope, times(dot(u, slope), u))) for slope in x.slopes]
    slack = per * x.slack + JET_ROUNDING * turn
    return Jet(
        u, slopes, slack, turn, most * x.second + UNIT_SECOND_DERIVATIVE * (turn * turn), 1.0
    )


def sharpened(x: Jet) -> Jet:
    """Return a jet with |X′| ≤ |X′(0)| + |X″| as well; only on patches of one direction."""
    if len(x.slopes) != 1:
        return x
    first = least(x.first, size(x.slopes[0]) + x.slack + x.second)
    return replace(x, first=first, most=least(x.most, size(x.value) + first))


def square_root(x: Jet) -> Jet:
    """√x of a scalar; its bounds are infinite if x may vanish."""
    low = x.value[0] - x.first
    regular = low > 0.0
    # The others are not used, and must not divide by zero.
    value, least_value = (root(choose(regular, number, 1.0)) for number in (x.value[0], low))
    per = choose(regular, 0.5 / least_value, float("inf"))
    first = per * x.first
    return Jet(
        [value],
        [[0.5 / value * slope[0]] for slope in x.slopes],
        per * (x.slack + JET_ROUNDING * x.most) + JET_ROUNDING * first,
        first,
        per * x.second + 0.5 * (per / least_value) * (per * 2.0 * x.first) * x.first,
        value + first,
    )


def image(x: Jet, rows: list[Vector], norm_of_rows: Any) -> Jet:
    """Return M x for a constant matrix M, given by rows, whose norm (of M) is at most a number."""
    value, first = [dot(row, x.value) for row in rows], norm_of_rows * x.first
    return Jet(
        value,
        [[dot(row, slope) for row in rows] for slope in x.slopes],
        norm_of_rows * (x.slack + JET_ROUNDING * (x.most + x.first)),
        first,
        norm_of_rows * x.second,
        size(value) + first,
    )
