"""The stages of matrices on patches: singular values, determinants and control numbers.

See `docs/proofs.md`, singular values and determinants.
"""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import choose, dot, minus, root, times
from gsp.kernels.formulas.spectrum import characteristic, reflection
from gsp.kernels.stages import (
    PER_DIAGONAL,
    SPECTRUM_HIGH,
    SPECTRUM_LOW,
    SPECTRUM_SCALARS,
    SPECTRUM_TRACE,
    UPPER_SCALARS,
    Stage,
    store,
)
from gsp.kernels.trace import Graph
from gsp.variation.jets import largest, least, magnitude
from gsp.variation.legs import PATCH_SCALARS, Patch
from gsp.variation.quantities import (
    INFINITE,
    OUTWARD,
    ROW_NEAR,
    ROW_REST,
    ROW_SCALARS,
    ROW_SLOPES,
    guarded,
    positive,
    shares_of,
)

# Upper triangle of the products of the derivatives, and the sums of squares of rests and errors.
GRAM_REST, GRAM_NEAR, GRAM_SCALARS = 21, 22, 23
# After a preconditioner also the upper triangle of QᵀQ, and the products of Q with the derivatives.
SUMS_SQUARE, SUMS_TRACE, SUMS_SCALARS = 23, 44, 50
# Scalars of the upper triangle of a preconditioner, by rows.
INVERSE_SCALARS = 21
# Roundings of singular values, relative to the Frobenius norm: 2⁻⁴⁰ is 4096 units.
SPECTRAL_ROUNDING = 2.0**-40
# Inward, for products of bounds from below.
INWARD = 2.0 - OUTWARD
PAIRS = tuple((i, j) for i in range(6) for j in range(i, 6))
PLACE = {pair: k for k, pair in enumerate(PAIRS)}


def _triangle() -> Stage:
    """R of six rows by Householder reflections, and one over its diagonal, in one piece of code."""
    graph = Graph()
    m = [graph.lanes("rows", 6, ROW_SCALARS * i) for i in range(6)]
    upper, per_diagonal = [], []
    for k in range(6):
        column = [row[k] for row in m[k:]]
        signed, head, per = reflection(column[0], root(dot(column, column)))
        factors = []
        for j in range(k + 1, 6):
            along = dot(column, [row[j] for row in m[k:]])
            factors.append(per * (along + signed * m[k][j]))
        upper += [-signed, *minus(m[k][k + 1 :], times(head, factors))]
        per_diagonal.append(-1.0 / signed)
        for i in range(k + 1, 6):
            m[i][k + 1 :] = minus(m[i][k + 1 :], times(m[i][k], factors))
    return Stage("proof triangle", ("rows", "upper"), (), store("upper", [*upper, *per_diagonal]))


def _inverse() -> Stage:
    """Inverse T of an upper triangle R, and the sign of det R."""
    graph = Graph()
    upper = graph.lanes("upper", UPPER_SCALARS)
    per = upper[PER_DIAGONAL:]
    t: dict[tuple[int, int], Any] = {}
    sign: Any = 1.0
    for j in range(6):
        t[j, j] = per[j]
        sign = sign * choose(per[j] < 0.0, -1.0, choose(per[j] < INFINITE, 1.0, 0.0))
        for i in range(j - 1, -1, -1):
            rest: Any = 0.0
            for k in range(i + 1, j + 1):
                rest = rest + upper[PLACE[i, k]] * t[k, j]
            t[i, j] = -(per[i] * rest)
    outputs = store("inverse", [t[pair] for pair in PAIRS])
    return Stage("proof inverse", ("upper", "inverse", "sign"), (), [*outputs, ("sign", 0, sign)])


def _products(x: list[list[Any]], sums: list[Any]) -> list[Any]:
    return [total + dot(x[i], x[j]) for total, (i, j) in zip(sums, PAIRS, strict=False)]


def _gram() -> Stage:
    """Add the products of the derivatives of one row, and the square of its rest."""
    graph = Graph()
    row, sums = graph.lanes("row", ROW_SCALARS), graph.lanes("gram", GRAM_SCALARS)
    slopes = [row[ROW_SLOPES + 6 * k : ROW_SLOPES + 6 * k + 6] for k in range(6)]
    values = _products(slopes, sums)
    values.append(sums[GRAM_REST] + row[ROW_REST] * row[ROW_REST])
    values.append(sums[GRAM_NEAR] + row[ROW_NEAR] * row[ROW_NEAR])
    return Stage("proof gram", ("row", "gram"), (), store("gram", values))


def _copied() -> Stage:
    """Copy the values of a row to a matrix."""
    row = Graph().lanes("row", ROW_SCALARS)
    return Stage("proof copied", ("row", "matrix"), (), store("matrix", row[:6]))


def _times(x: list[Any], inverse: list[Any]) -> list[Any]:
    """Return a row times the preconditioner T."""
    return [dot(x[: j + 1], [inverse[PLACE[i, j]] for i in range(j + 1)]) for j in range(6)]


def _slopes() -> Stage:
    """Multiply the derivatives of a row by the preconditioner T, and add the products."""
    graph = Graph()
    row, inverse = graph.lanes("row", ROW_SCALARS), graph.lanes("inverse", INVERSE_SCALARS)
    sums = graph.lanes("sums", GRAM_SCALARS)
    slopes = [_times(row[ROW_SLOPES + 6 * k : ROW_SLOPES + 6 * k + 6], inverse) for k in range(6)]
    values = _products(slopes, sums)
    values.append(sums[GRAM_REST] + row[ROW_REST] * row[ROW_REST])
    values.append(sums[GRAM_NEAR] + row[ROW_NEAR] * row[ROW_NEAR])
    return Stage("proof slopes", ("row", "inverse", "sums"), (), store("sums", values))


def _squares() -> Stage:
    """Add what a row adds to QᵀQ; the products of Q with the derivatives stay unknown."""
    graph = Graph()
    row, inverse = graph.lanes("row", ROW_SCALARS), graph.lanes("inverse", INVERSE_SCALARS)
    sums = graph.lanes("sums", SUMS_SCALARS)
    value = _times(row[:6], inverse)
    squares = zip(sums[SUMS_SQUARE:], PAIRS, strict=False)
    values = [total + value[i] * value[j] for total, (i, j) in squares]
    outputs = store("sums", [*values, *[INFINITE] * 6], SUMS_SQUARE)
    return Stage("proof squares", ("row", "inverse", "sums"), (), outputs)


def _solved() -> Stage:
    """Multiply a row and its derivatives by the preconditioner T, and add the products."""
    graph = Graph()
    row, inverse = graph.lanes("row", ROW_SCALARS), graph.lanes("inverse", INVERSE_SCALARS)
    sums = graph.lanes("sums", SUMS_SCALARS)
    value = _times(row[:6], inverse)
    slopes = [_times(row[ROW_SLOPES + 6 * k : ROW_SLOPES + 6 * k + 6], inverse) for k in range(6)]
    values = _products(slopes, sums)
    values.append(sums[GRAM_REST] + row[ROW_REST] * row[ROW_REST])
    values.append(sums[GRAM_NEAR] + row[ROW_NEAR] * row[ROW_NEAR])
    squares = zip(sums[SUMS_SQUARE:], PAIRS, strict=False)
    values += [total + value[i] * value[j] for total, (i, j) in squares]
    values += [x + dot(value, slope) for x, slope in zip(sums[SUMS_TRACE:], slopes, strict=True)]
    outputs = [*store("sums", values), *store("matrix", value)]
    return Stage("proof solved", ("row", "inverse", "sums", "matrix"), (), outputs)


def variation(gram: list[Any]) -> tuple[Any, list[Any]]:
    """Frobenius norm of the linear variation, and the part of each coordinate."""
    sums: list[Any] = []
    for k in range(6):
        part: Any = 0.0
        for m in range(6):
            part = part + magnitude(gram[PLACE[min(k, m), max(k, m)]])
        sums.append(part)
    square: Any = 0.0
    for part in sums:
        square = square + part
    straight = root(square)
    per = choose(straight > 0.0, 1.0 / straight, 0.0)
    return straight * OUTWARD, [per * x for x in sums]


class Preconditioned:
    """What is known of J T for the preconditioner T: J T = Q + D with QᵀQ near I."""

    def __init__(self, sums: list[Any]) -> None:
        self.linear, self.parts = variation(sums)
        square: Any = 0.0
        self.trace: Any = 0.0
        for (i, j), x in zip(PAIRS, sums[SUMS_SQUARE:], strict=False):
            away = x - 1.0 if i == j else x
            square = square + (away * away if i == j else 2.0 * (away * away))
            self.trace = self.trace + (x if i == j else 0.0)
        self.far = root(square) * OUTWARD + SPECTRAL_ROUNDING
        # Bounds of the singular values of Q.
        self.low = root(positive(1.0 - self.far)) * INWARD
        self.high = root(1.0 + self.far) * OUTWARD
        self.drift: Any = 0.0
        for x in sums[SUMS_TRACE:]:
            self.drift = self.drift + magnitude(x)

    def volumes(self, reach: Any, drift: Any) -> tuple[Any, Any]:
        """Bounds of sqrt det (Q + D)ᵀ(Q + D), with ‖D‖ ≤ reach and |⟨Q, D⟩| ≤ drift."""
        mean = (self.trace + 2.0 * drift + reach * reach) * (OUTWARD / 6.0)
        change = self.far + 2.0 * (self.high * reach)
        lost = drift + 0.5 * (6.0 - self.trace)
        lost = (lost + 0.25 * (change * change) / (1.0 - change)) * OUTWARD
        low = choose(change < 1.0, positive(1.0 - lost), 0.0)
        return low * INWARD, mean * mean * mean * OUTWARD


def _extremes() -> Stage:
    """Bound the least singular value, the condition number, and |det J| by a factor."""
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH_SCALARS))
    s, gram = graph.lanes("spectrum", SPECTRUM_SCALARS), graph.lanes("gram", GRAM_SCALARS)
    sums, inverse = graph.lanes("sums", SUMS_SCALARS), graph.lanes("inverse", INVERSE_SCALARS)
    shares = shares_of(patch, graph.scalar("length"))
    straight, slopes = variation(gram)
    rest, near = root(gram[GRAM_REST]) * OUTWARD, root(gram[GRAM_NEAR]) * OUTWARD
    margin = SPECTRAL_ROUNDING * root(s[SPECTRUM_TRACE])
    wide, narrow = straight + rest + margin, near + margin
    low, high = (
        root(s[SPECTRUM_LOW] * s[SPECTRUM_TRACE]),
        root(s[SPECTRUM_HIGH] * s[SPECTRUM_TRACE]),
    )
    q = Preconditioned(sums)
    # |T x| ≤ stretch |x|, since |J T x| ≤ q.high |x|; a second margin is for the rounding of J T.
    stretch = choose(low - 2.0 * margin > 0.0, q.high / (low - 2.0 * margin), INFINITE) * OUTWARD
    reach, error = q.linear + (rest + margin) * stretch, (near + margin) * stretch
    per_base = OUTWARD / positive(q.low - margin * stretch)
    at_patch = _singular(low, high, margin, wide, reach * per_base)
    at_centre = _singular(low, high, margin, narrow, error * per_base)
    least_value = [at_patch[0], at_patch[1], at_centre[0], at_centre[1]]
    ratios = [*_ratios(*at_patch), *_ratios(*at_centre)]
    per: Any = graph.scalar("volume")
    for k in range(6):
        per = per / magnitude(inverse[PLACE[k, k]])
    drift = q.drift + root(q.trace) * ((rest + margin) * stretch) * OUTWARD
    low_volume, high_volume = q.volumes(reach, drift)
    near_volume = q.volumes(error, root(q.trace) * error * OUTWARD)
    rough = _volume(s, wide) * graph.scalar("volume")
    volumes = [
        guarded(per * low_volume, wide),
        least(per * high_volume, rough),
        guarded(per * near_volume[0], narrow),
        least(per * near_volume[1], rough),
    ]
    parts = [x + rest * share for x, share in zip(slopes, shares, strict=True)]
    outputs = store("quantity", [*least_value, *parts, *ratios, *parts, *volumes, *parts])
    arrays = ("patch", "spectrum", "gram", "sums", "inverse", "quantity")
    return Stage("proof extremes", arrays, ("length", "volume"), outputs)


def _singular(
    low: Any, high: Any, margin: Any, reach: Any, share: Any
) -> tuple[Any, Any, Any, Any]:
    """Bounds of σ_min and of σ_max: by Weyl's inequality and by the relative change, the better."""
    fewer, more = positive(1.0 - share), 1.0 + share
    # The order matters where there is no preconditioner, and the other bound is NaN.
    below = largest(positive(low - reach), (low - margin) * fewer * INWARD)
    above = largest(positive(high - reach), (high - margin) * fewer * INWARD)
    return (
        guarded(below, reach),
        least((low + margin) * more * OUTWARD, low + reach),
        guarded(above, reach),
        least((high + margin) * more * OUTWARD, high + reach),
    )


def _ratios(least_low: Any, least_high: Any, most_low: Any, most_high: Any) -> list[Any]:
    """Bounds of σ_max / σ_min from theirs."""
    low = most_low / least_high * INWARD
    high = choose(least_low > 0.0, most_high / least_low * OUTWARD, INFINITE)
    return [
        choose(low < 1.0, choose(low > -INFINITE, 1.0, low), low),
        choose(high < 1.0, 1.0, high),
    ]


def _volume(s: list[Any], reach: Any) -> Any:
    """Upper bound of |det| by the singular values alone.

    Π (σ_i + F) ≤ (1 + ε)³ sqrt(Π (σ_i² + F²/ε)), for two choices of ε.
    """
    result: Any = INFINITE
    size = root(s[SPECTRUM_TRACE])
    for share in (reach / size, reach / root(s[SPECTRUM_LOW] * s[SPECTRUM_TRACE])):
        extra = share + 2.0**-30
        shift = reach * reach / (extra * s[SPECTRUM_TRACE])
        product, _, _ = characteristic(s[:6], s[6:11], -shift)
        more = 1.0 + extra
        scale = s[SPECTRUM_TRACE] * s[SPECTRUM_TRACE] * s[SPECTRUM_TRACE]
        value = more * more * more * root(product) * scale * OUTWARD
        result = least(value, result)
    return choose(reach < INFINITE, result, INFINITE)


def _control() -> Stage:
    """Bound the control number from J T and W T, where T preconditions the passive rates W."""
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH_SCALARS))
    s, sums = graph.lanes("spectrum", SPECTRUM_SCALARS), graph.lanes("sums", SUMS_SCALARS)
    passive, inverse = graph.lanes("passive", SUMS_SCALARS), graph.lanes("inverse", INVERSE_SCALARS)
    shares = shares_of(patch, graph.scalar("length"))
    stretch = root(dot(inverse, inverse)) * OUTWARD
    q = Preconditioned(passive)
    straight, slopes = variation(sums)
    margin = SPECTRAL_ROUNDING * root(s[SPECTRUM_TRACE])
    low, high = (
        root(s[SPECTRUM_LOW] * s[SPECTRUM_TRACE]),
        root(s[SPECTRUM_HIGH] * s[SPECTRUM_TRACE]),
    )

    def bounds(linear: Any, turn: Any, place: int) -> list[Any]:
        row, rate = (root(x[place]) * stretch * OUTWARD for x in (sums, passive))
        # The rounding of rows times T is below that of the rows, which `row` and `rate` hold.
        error, slip = linear + row + margin, turn + rate + SPECTRAL_ROUNDING
        slow, fast = positive(q.low - slip) * INWARD, (q.high + slip) * OUTWARD
        worst = positive(low - error) * slow / ((high + error) * fast) * INWARD
        below = positive(high - error) * slow
        best = choose(below > 0.0, (low + error) * fast / below * OUTWARD, 1.0)
        best = choose(best < 1.0, best, 1.0)
        return [guarded(worst, error + slip), choose(error + slip < INFINITE, best, INFINITE)]

    values = [*bounds(straight, q.linear, GRAM_REST), *bounds(0.0, 0.0, GRAM_NEAR)]
    per = choose(low > 0.0, 1.0 / low, 1.0)
    rest = root(sums[GRAM_REST]) * per + root(passive[GRAM_REST])
    parts = [
        per * x + y + rest * stretch * share
        for x, y, share in zip(slopes, q.parts, shares, strict=True)
    ]
    arrays = ("patch", "spectrum", "sums", "passive", "inverse", "quantity")
    return Stage("proof control", arrays, ("length",), store("quantity", [*values, *parts]))


TRIANGLE, INVERSE_STAGE, GRAM_ROW, SOLVED_ROW = _triangle(), _inverse(), _gram(), _solved()
COPIED_ROW, SLOPES_ROW, SQUARES_ROW = _copied(), _slopes(), _squares()
EXTREMES, CONTROL = _extremes(), _control()
ALL = (
    TRIANGLE,
    INVERSE_STAGE,
    GRAM_ROW,
    SOLVED_ROW,
    COPIED_ROW,
    SLOPES_ROW,
    SQUARES_ROW,
    EXTREMES,
    CONTROL,
)
