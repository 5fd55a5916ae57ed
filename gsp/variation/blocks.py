"""Stages that bound extreme singular values with their exact derivatives.

For a unit vector v, u = J_c v/|J_c v| and P = I − u uᵀ, the numbers u·J(x) v, |uᵀ J(x) (I − v vᵀ)|,
|P J(x) v| and the singular values of P J(x) on v⊥ make a matrix of order 2, whose singular values
bound those of J(x). With v near to the singular vector of an extreme singular value, only the first
of the four numbers changes to first order, and its derivative is that of the singular value. Any v
gives bounds that hold. See `docs/proofs.md`, exact derivatives.
"""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import choose, dot, minus, root, times
from gsp.kernels.stages import UPPER_SCALARS, Stage, store
from gsp.kernels.trace import Graph
from gsp.variation.jets import largest, least, magnitude
from gsp.variation.layout import HIGH, LOW, MID_HIGH, MID_LOW, PARTS, QUANTITY_SCALARS
from gsp.variation.legs import PATCH_SCALARS, Patch
from gsp.variation.matrices import (
    GRAM_NEAR,
    GRAM_REST,
    GRAM_SCALARS,
    INVERSE_SCALARS,
    INWARD,
    PAIRS,
    PLACE,
    SPECTRAL_ROUNDING,
    variation,
)
from gsp.variation.quantities import (
    INFINITE,
    OUTWARD,
    ROW_SCALARS,
    ROW_SLOPES,
    positive,
    shares_of,
)

# Scalars of a direction: v, 1/|J_c v|, |J_c v|, |uᵀ J_c (I − v vᵀ)|, and a bound of P J_c on v⊥.
PER, MIDDLE, OFF, OTHERS, DIRECTION_SCALARS = 6, 7, 8, 9, 10
# Sums of a direction: uᵀ J_k v, uᵀ J_k, and the upper triangle of the products of the J_k v.
ALONG, ACROSS, DOWN, DIRECTION_SUMS_SCALARS = 0, 6, 42, 63
# Arrays of both directions, that of σ_min first.
DIRECTIONS_SCALARS, BLOCK_SUMS_SCALARS = 2 * DIRECTION_SCALARS, 2 * DIRECTION_SUMS_SCALARS
# Products of a column of M¹⁶ with M¹⁶: then it is one of M⁶⁴, for M of trace 1.
PRODUCTS_TO_VECTOR = 3
# Roundings of u, relative to |J_c|/|J_c v|, in terms of the linear variation.
DIRECTION_ROUNDING = 16.0

Matrix = list[list[Any]]


def _symmetric(rows: Matrix) -> Matrix:
    """Products of all rows with each other."""
    upper = {(i, j): dot(rows[i], rows[j]) for i, j in PAIRS}
    return [[upper[min(i, j), max(i, j)] for j in range(6)] for i in range(6)]


def _size(x: list[Any]) -> Any:
    return root(dot(x, x))


def _powers(rows: Matrix) -> tuple[Matrix, Matrix, Any]:
    """Return M and M⁴ for M = X Xᵀ over its trace, and the trace."""
    square, trace = _symmetric(rows), 0.0
    for i in range(6):
        trace = trace + square[i][i]
    per = 1.0 / trace
    first = [times(per, row) for row in square]
    return first, _symmetric(_symmetric(first)), trace


def _eigenvector(fourth: Matrix) -> list[Any]:
    """Return a unit vector near to the first eigenvector of M from M⁴: a column of M⁶⁴."""
    power = _symmetric(_symmetric(fourth))
    best, column = power[0][0], power[0]
    for k in range(1, 6):
        more = best < power[k][k]
        column = [choose(more, x, y) for x, y in zip(power[k], column, strict=True)]
        best = choose(more, power[k][k], best)
    for _ in range(PRODUCTS_TO_VECTOR):
        column = _applied(power, column)
    return times(1.0 / _size(column), column)


def _norm_across(trace: Any, power: Matrix, unit: list[Any], roots: int) -> Any:
    """Bound of |Xᵀ y| over the unit vectors y ⊥ x, from Mⁿ for M = X Xᵀ over its trace.

    |Xᵀ y|² = trace · y·M y, and (y·M y)²ⁿ ≤ y·M²ⁿ y, which is at most tr M²ⁿ less x·M²ⁿ x.
    `roots` is the logarithm of 2n to the base 2.
    """
    along = _applied(power, unit)
    total = SPECTRAL_ROUNDING - dot(along, along)
    for row in power:
        total = total + dot(row, row)
    for _ in range(roots):
        total = root(total)
    return root(trace * total) * OUTWARD


def _full(upper: list[Any]) -> Matrix:
    return [[upper[PLACE[i, j]] if j >= i else 0.0 for j in range(6)] for i in range(6)]


def _applied(rows: Matrix, x: list[Any]) -> list[Any]:
    return [dot(row, x) for row in rows]


def _transposed(rows: Matrix) -> Matrix:
    return [list(column) for column in zip(*rows, strict=True)]


def _directions() -> Stage:
    """Directions near to the singular vectors of the least and the greatest singular value."""
    graph = Graph()
    upper, inverse = graph.lanes("upper", UPPER_SCALARS), graph.lanes("inverse", INVERSE_SCALARS)
    r, t = _full(upper), _full(inverse)
    size, spread = _size(upper[:INVERSE_SCALARS]), _size(inverse)
    margin = SPECTRAL_ROUNDING * size * OUTWARD

    def seen(v: list[Any]) -> tuple[list[Any], list[Any], Any, Any]:
        image = _applied(r, v)
        middle = _size(image)
        u = times(1.0 / middle, image)
        off = minus(_applied(_transposed(r), u), times(middle, v))
        # u is rounded by the margin over |J_c v|, and what it multiplies is J_c.
        rounding = margin * (2.0 + size / middle)
        return u, [*v, 1.0 / middle, middle], _size(off) + rounding, rounding

    first, fourth, trace = _powers(t)
    v = _eigenvector(fourth)
    _, known, off, _ = seen(v)
    # P J_c is at least one over the norm of (I − v vᵀ) T on v⊥, but for rounding.
    exact = positive(1.0 - 16.0 * (margin * spread))
    # M⁴ is sharper, but its trace hides the others where σ_min is below a sixth of them.
    across = least(_norm_across(trace, fourth, v, 3), _norm_across(trace, first, v, 1))
    others = exact / (across + SPECTRAL_ROUNDING * spread) * INWARD
    small = [*known, off, others]

    _, fourth, trace = _powers(r)
    along = _applied(_transposed(r), _eigenvector(fourth))
    u, known, off, error = seen(times(1.0 / _size(along), along))
    great = [*known, off, _norm_across(trace, fourth, u, 3) + 4.0 * error]
    return Stage(
        "proof directions",
        ("upper", "inverse", "directions"),
        (),
        store("directions", [*small, *great]),
    )


def _block_rows(n: int) -> Stage:
    """Add what n rows add to the derivatives of the blocks."""
    graph = Graph()
    rows = [graph.lanes("rows", ROW_SCALARS, ROW_SCALARS * i) for i in range(n)]
    directions = graph.lanes("directions", DIRECTIONS_SCALARS)
    # Six rows are all there are: the sums begin with them.
    sums = [0.0] * BLOCK_SUMS_SCALARS if n == 6 else graph.lanes("sums", BLOCK_SUMS_SCALARS)
    values: list[Any] = []
    for side in range(2):
        own = directions[side * DIRECTION_SCALARS :]
        v, per = own[:6], own[PER]
        some = sums[side * DIRECTION_SUMS_SCALARS :]
        u = [per * dot(row[:6], v) for row in rows]
        along: list[Any] = []
        across: list[Any] = []
        downs: list[Any] = []
        for k in range(6):
            total, across_k = some[ALONG + k], some[ACROSS + 6 * k :][:6]
            down: list[Any] = []
            for row, share in zip(rows, u, strict=True):
                slope, rate = row[ROW_SLOPES + 6 * k :][:6], 0.0
                for j in range(6):
                    rate = rate + slope[j] * v[j]
                    across_k[j] = across_k[j] + share * slope[j]
                total = total + share * rate
                down.append(rate)
            along.append(total)
            across += across_k
            downs.append(down)
        products = zip(some[DOWN:DIRECTION_SUMS_SCALARS], PAIRS, strict=True)
        values += [*along, *across, *(x + dot(downs[i], downs[j]) for x, (i, j) in products)]
    return Stage(f"proof block rows {n}", ("rows", "directions", "sums"), (), store("sums", values))


def _squares(first: Any, other: Any, across: Any, down: Any) -> tuple[Any, Any, Any]:
    """Return det M of [[first, −across], [−down, other]], φ = ‖M‖², and sqrt(φ² − 4 det²)."""
    far, near = first - other, first + other
    much, little = across + down, across - down
    disc = root((far * far + much * much) * (near * near + little * little))
    squares = first * first + other * other + across * across + down * down
    return first * other - across * down, squares, disc


def _from_below(first: Any, other: Any, across: Any, down: Any) -> Any:
    """Bound of the least singular value; 0 where the blocks off the diagonal are too large."""
    determinant, squares, disc = _squares(first, other, across, down)
    value = determinant * root(2.0 / (squares + disc)) * INWARD
    return choose(determinant > 0.0, choose(first > 0.0, value, 0.0), 0.0)


def _from_above(first: Any, other: Any, across: Any, down: Any) -> Any:
    """Bound of the greatest singular value."""
    _, squares, disc = _squares(first, other, across, down)
    return root(0.5 * (squares + disc)) * OUTWARD


class _Blocks:
    """The four numbers of one direction on the patch, without the rests of the rows."""

    def __init__(self, direction: list[Any], sums: list[Any], margin: Any) -> None:
        v, self.middle = direction[:6], direction[MIDDLE]
        self.slopes = sums[ALONG:ACROSS]
        self.linear: Any = 0.0
        for x in self.slopes:
            self.linear = self.linear + magnitude(x)
        rows = [sums[ACROSS + 6 * k :][:6] for k in range(6)]
        apart = [minus(row, times(x, v)) for row, x in zip(rows, self.slopes, strict=True)]
        across, _ = variation([dot(apart[i], apart[j]) for i, j in PAIRS])
        products = zip(sums[DOWN:DIRECTION_SUMS_SCALARS], PAIRS, strict=True)
        down, _ = variation([x - self.slopes[i] * self.slopes[j] for x, (i, j) in products])
        # The differences are rounded relative to the products, and u by the margin over |J_c v|.
        whole: Any = 0.0
        for k in range(6):
            whole = whole + sums[DOWN + PLACE[k, k]]
        self.down = root(down * down + margin * direction[PER] * whole) * OUTWARD
        self.across = across + direction[OFF]

    def from_below(self, first: Any, other: Any) -> Any:
        """Bound of the least singular value on the patch."""
        return _from_below(first, other, self.across, self.down)

    def from_above(self, first: Any, other: Any) -> Any:
        """Bound of the greatest singular value on the patch."""
        return _from_above(first, other, self.across, self.down)


def _apart(great: _Blocks, small: _Blocks, ratio: Any) -> tuple[list[Any], Any]:
    """Return A_k − κ a_k, and the sum of their magnitudes with the rounding of both terms."""
    slopes = [x - ratio * y for x, y in zip(great.slopes, small.slopes, strict=True)]
    total = SPECTRAL_ROUNDING * (great.linear + ratio * small.linear)
    for x in slopes:
        total = total + magnitude(x)
    return slopes, total


def _at_centre(directions: list[Any], error: Any) -> tuple[list[Any], list[Any]]:
    """Bounds of σ_min and of the condition number at the centre, where P J v is 0."""
    small, great = directions[:DIRECTION_SCALARS], directions[DIRECTION_SCALARS:]
    low = _from_below(small[MIDDLE], small[OTHERS], small[OFF], 0.0) - error
    high = (small[MIDDLE] + error) * OUTWARD
    most = (_from_above(great[MIDDLE], great[OTHERS], great[OFF], 0.0) + error) * OUTWARD
    ratio_low = (great[MIDDLE] - error) / high * INWARD
    return [low, high], [ratio_low, choose(low > 0.0, most / low * OUTWARD, INFINITE)]


def _blocks() -> Stage:
    """Narrow the bounds of σ_min and of the condition number."""
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH_SCALARS))
    upper, gram = graph.lanes("upper", UPPER_SCALARS), graph.lanes("gram", GRAM_SCALARS)
    directions = graph.lanes("directions", DIRECTIONS_SCALARS)
    sums = graph.lanes("sums", BLOCK_SUMS_SCALARS)
    quantity = graph.lanes("quantity", 2 * QUANTITY_SCALARS)
    shares = shares_of(patch, graph.scalar("length"))
    straight, split = variation(gram)
    rest, near = root(gram[GRAM_REST]) * OUTWARD, root(gram[GRAM_NEAR]) * OUTWARD
    margin = SPECTRAL_ROUNDING * _size(upper[:INVERSE_SCALARS]) * OUTWARD
    small = _Blocks(directions[:DIRECTION_SCALARS], sums[:DIRECTION_SUMS_SCALARS], margin)
    great = _Blocks(directions[DIRECTION_SCALARS:], sums[DIRECTION_SUMS_SCALARS:], margin)
    # What the rests and the rounding of u and v change.
    turned = DIRECTION_ROUNDING * margin * straight
    error = (rest + 2.0 * margin + turned * directions[PER]) * OUTWARD
    error_of_great = (rest + 2.0 * margin + turned * directions[DIRECTION_SCALARS + PER]) * OUTWARD

    first_low = small.middle - small.linear
    first_high = (small.middle + small.linear) * OUTWARD
    others = positive(directions[OTHERS] - straight)
    certain = small.from_below(first_low, others)
    low = certain - error
    high = root(first_high * first_high + small.down * small.down) * OUTWARD + error
    # How far σ_min is below u·J v at most, for all x; it is farthest for the greatest u·J v.
    lost = choose(certain > 0.0, first_high - small.from_below(first_high, others), INFINITE)

    most = directions[DIRECTION_SCALARS + OTHERS] + straight
    other_low = great.middle - great.linear
    excess = great.from_above(other_low, most) - other_low

    # σ_max ≤ a + Σ δ_k a_k and σ_min ≥ b + Σ δ_k b_k; the ratio, for all δ at once.
    top, bottom = great.middle + excess + error_of_great, small.middle - lost - error
    ratio = top / bottom
    joint, away = _apart(great, small, ratio)
    descent = bottom - small.linear * OUTWARD
    ratio_high = (ratio + away / descent * OUTWARD) * OUTWARD
    ratio_high = choose(descent > 0.0, ratio_high, INFINITE)

    # The same from below: σ_max ≥ u·J v of the one, σ_min ≤ |J v| of the other.
    beyond = root(first_low * first_low + small.down * small.down) * OUTWARD - first_low
    top_low, bottom_high = great.middle - error_of_great, small.middle + beyond + error
    quotient = top_low / bottom_high
    _, apart = _apart(great, small, quotient)
    slow = bottom_high - small.linear * OUTWARD
    ratio_low = (quotient - apart / slow * OUTWARD) * INWARD
    ratio_low = choose(first_low > 0.0, choose(slow > 0.0, ratio_low, 0.0), 0.0)

    own = quantity[:QUANTITY_SCALARS], quantity[QUANTITY_SCALARS:]
    per = choose(straight > 0.0, 1.0 / straight, 0.0)
    weights = (lost + beyond) * per, (excess + ratio * lost) * per
    rests = error, error_of_great + ratio * error
    parts = [
        [
            magnitude(x) + weight * y + one * share
            for x, y, share in zip(slopes, split, shares, strict=True)
        ]
        for slopes, weight, one in zip((small.slopes, joint), weights, rests, strict=True)
    ]
    lows, highs = (low, ratio_low), (high, ratio_high)
    middles = _at_centre(directions, (near + 2.0 * margin) * OUTWARD)
    outputs = []
    for k, better in enumerate((own[0][LOW] < low, ratio_high < own[1][HIGH])):
        old = own[k]
        values = [largest(old[LOW], lows[k]), least(highs[k], old[HIGH])]
        values += [largest(old[MID_LOW], middles[k][0]), least(middles[k][1], old[MID_HIGH])]
        kept = [choose(better, x, y) for x, y in zip(parts[k], old[PARTS:], strict=True)]
        outputs += store("quantity", values, k * QUANTITY_SCALARS)
        outputs += store("quantity", kept, k * QUANTITY_SCALARS + PARTS)
    arrays = ("patch", "upper", "gram", "directions", "sums", "quantity")
    return Stage("proof blocks", arrays, ("length",), outputs)


DIRECTIONS_STAGE, BLOCKS = _directions(), _blocks()
BLOCK_ROWS = _block_rows(1), _block_rows(6)
ALL = DIRECTIONS_STAGE, *BLOCK_ROWS, BLOCKS
