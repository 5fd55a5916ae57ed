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
from gsp.variation.layout import HIGH, LOW, PARTS, QUANTITY_SCALARS
from gsp.variation.legs import PATCH_SCALARS, Patch
from gsp.variation.matrices import (
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
# Squarings of a matrix whose columns are then near to its first eigenvector, and for a norm.
SQUARINGS_TO_VECTOR, SQUARINGS_TO_NORM = 6, 2
# Roundings of u, relative to |J_c|/|J_c v|, in terms of the linear variation.
DIRECTION_ROUNDING = 16.0

Matrix = list[list[Any]]


def _symmetric(rows: Matrix) -> Matrix:
    """Products of all rows with each other."""
    upper = {(i, j): dot(rows[i], rows[j]) for i, j in PAIRS}
    return [[upper[min(i, j), max(i, j)] for j in range(6)] for i in range(6)]


def _size(x: list[Any]) -> Any:
    return root(dot(x, x))


def _trace(square: Matrix) -> Any:
    total: Any = 0.0
    for i in range(6):
        total = total + square[i][i]
    return total


def _normalised(square: Matrix) -> tuple[Matrix, Any]:
    """Return a matrix over its trace, and the trace."""
    trace = _trace(square)
    return [times(1.0 / trace, row) for row in square], trace


def _eigenvector(square: Matrix) -> list[Any]:
    """Return a unit vector near to the first eigenvector of a positive matrix of trace 1."""
    for _ in range(SQUARINGS_TO_VECTOR):
        square = _symmetric(square)
    best, column = square[0][0], square[0]
    for k in range(1, 6):
        more = best < square[k][k]
        column = [choose(more, x, y) for x, y in zip(square[k], column, strict=True)]
        best = choose(more, square[k][k], best)
    return times(1.0 / _size(column), column)


def _norm(rows: Matrix) -> Any:
    """Bound of the greatest singular value by the sum of their sixteenth powers."""
    square, trace = _normalised(_symmetric(rows))
    for _ in range(SQUARINGS_TO_NORM):
        square = _symmetric(square)
    total: Any = 0.0
    for row in square:
        total = total + dot(row, row)
    for _ in range(SQUARINGS_TO_NORM + 1):
        total = root(total)
    return root(trace * total) * OUTWARD


def _full(upper: list[Any]) -> Matrix:
    return [[upper[PLACE[i, j]] if j >= i else 0.0 for j in range(6)] for i in range(6)]


def _applied(rows: Matrix, x: list[Any]) -> list[Any]:
    return [dot(row, x) for row in rows]


def _transposed(rows: Matrix) -> Matrix:
    return [list(column) for column in zip(*rows, strict=True)]


def _without(rows: Matrix, unit: list[Any]) -> Matrix:
    """Return the rows of (I − x xᵀ) M."""
    along = _applied(_transposed(rows), unit)
    return [minus(row, times(x, along)) for row, x in zip(rows, unit, strict=True)]


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

    v = _eigenvector(_normalised(_symmetric(t))[0])
    _, known, off, _ = seen(v)
    # P J_c is at least one over the norm of (I − v vᵀ) T on v⊥, but for rounding.
    exact = positive(1.0 - 16.0 * (margin * spread))
    others = exact / (_norm(_without(t, v)) + SPECTRAL_ROUNDING * spread) * INWARD
    small = [*known, off, others]

    u, known, off, error = seen(_eigenvector(_normalised(_symmetric(_transposed(r)))[0]))
    great = [*known, off, _norm(_without(r, u)) + 4.0 * error]
    return Stage(
        "proof directions",
        ("upper", "inverse", "directions"),
        (),
        store("directions", [*small, *great]),
    )


def _block_row() -> Stage:
    """Add what one row adds to the derivatives of the blocks."""
    graph = Graph()
    row, directions = graph.lanes("row", ROW_SCALARS), graph.lanes("directions", DIRECTIONS_SCALARS)
    sums = graph.lanes("sums", BLOCK_SUMS_SCALARS)
    slopes = [row[ROW_SLOPES + 6 * k : ROW_SLOPES + 6 * k + 6] for k in range(6)]
    values: list[Any] = []
    for side in range(2):
        v, per = (
            directions[side * DIRECTION_SCALARS :][:6],
            directions[side * DIRECTION_SCALARS + PER],
        )
        some = sums[side * DIRECTION_SUMS_SCALARS :]
        u, down = per * dot(row[:6], v), _applied(slopes, v)
        values += [x + u * y for x, y in zip(some[ALONG:ACROSS], down, strict=True)]
        across = [u * x for slope in slopes for x in slope]
        values += [x + y for x, y in zip(some[ACROSS:DOWN], across, strict=True)]
        products = zip(some[DOWN:DIRECTION_SUMS_SCALARS], PAIRS, strict=True)
        values += [x + down[i] * down[j] for x, (i, j) in products]
    return Stage("proof block row", ("row", "directions", "sums"), (), store("sums", values))


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

    def squares(self, first: Any, other: Any) -> tuple[Any, Any, Any]:
        """Return det M of [[first, −across], [−down, other]], φ = ‖M‖², and sqrt(φ² − 4 det²)."""
        product = self.across * self.down
        far, near = first - other, first + other
        much, little = self.across + self.down, self.across - self.down
        disc = root((far * far + much * much) * (near * near + little * little))
        squares = first * first + other * other + self.across * self.across
        return first * other - product, squares + self.down * self.down, disc

    def from_below(self, first: Any, other: Any) -> Any:
        """Bound of the least singular value; 0 where the blocks off the diagonal are too large."""
        determinant, squares, disc = self.squares(first, other)
        value = determinant * root(2.0 / (squares + disc)) * INWARD
        return choose(determinant > 0.0, choose(first > 0.0, value, 0.0), 0.0)

    def from_above(self, first: Any, other: Any) -> Any:
        """Bound of the greatest singular value."""
        _, squares, disc = self.squares(first, other)
        return root(0.5 * (squares + disc)) * OUTWARD


def _apart(great: _Blocks, small: _Blocks, ratio: Any) -> tuple[list[Any], Any]:
    """Return A_k − κ a_k, and the sum of their magnitudes with the rounding of both terms."""
    slopes = [x - ratio * y for x, y in zip(great.slopes, small.slopes, strict=True)]
    total = SPECTRAL_ROUNDING * (great.linear + ratio * small.linear)
    for x in slopes:
        total = total + magnitude(x)
    return slopes, total


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
    rest = root(gram[GRAM_REST]) * OUTWARD
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
    outputs = []
    for k, better in enumerate((own[0][LOW] < low, ratio_high < own[1][HIGH])):
        old = own[k]
        values = [largest(old[LOW], lows[k]), least(highs[k], old[HIGH])]
        kept = [choose(better, x, y) for x, y in zip(parts[k], old[PARTS:], strict=True)]
        outputs += store("quantity", values, k * QUANTITY_SCALARS)
        outputs += store("quantity", kept, k * QUANTITY_SCALARS + PARTS)
    arrays = ("patch", "upper", "gram", "directions", "sums", "quantity")
    return Stage("proof blocks", arrays, ("length",), outputs)


DIRECTIONS_STAGE, BLOCK_ROW, BLOCKS = _directions(), _block_row(), _blocks()
ALL = DIRECTIONS_STAGE, BLOCK_ROW, BLOCKS
