"""The stages of the compiled proof: boxes to patches, patches to rows, rows to bounded quantities.

As in `gsp.kernels.stages`, a stage works on LANES patches at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from gsp.geometry.scalars import choose, dot, norm, root, times, turned
from gsp.kernels.spectrum import reflection
from gsp.kernels.stages import HIGH as SPECTRUM_HIGH
from gsp.kernels.stages import LOW as SPECTRUM_LOW
from gsp.kernels.stages import SPECTRUM, TRACE, Outputs, Stage
from gsp.kernels.trace import Graph
from gsp.model.legs import LEGS
from gsp.proof.variation.jets import Jet, constant, inner, magnitude
from gsp.proof.variation.layout import PARTS
from gsp.proof.variation.legs import (
    GEOMETRY,
    KINDS,
    PATCH,
    ROUNDING,
    Kind,
    Patch,
    Segment,
    signed_distance,
)

# Scalars of a box: least and greatest value of p and of the angles, in the order of moving axes.
BOX = 12
# Scalars of the frame of angles that all boxes share: three axes, and a rotation applied first.
FRAME = 18
# Scalars of a row: the row, its six derivatives, bounds of the rest and of the error at the centre.
ROW_SLOPES, ROW_REST, ROW_NEAR, ROW_SCALARS = 6, 42, 43, 44
# Upper triangle of the products of the derivatives, and the sums of squares of rests and errors.
GRAM_REST, GRAM_NEAR, GRAM = 21, 22, 23
# Roundings of singular values, relative to the Frobenius norm: 2⁻⁴⁰ is 4096 units.
SPECTRAL = 2.0**-40
# Roundings of bounds, relative to them.
OUTWARD = 1.0 + 2.0**-30
INFINITE = float("inf")
# Kinds of legs whose direction changes its sign where their lines meet.
SIGNED = ("D4", "A1", "D4 A1")
# Halvings of an angle before its sine is summed up as a series.
HALVINGS = 3


def store(array: str, values: Sequence[Any], start: int = 0) -> Outputs:
    """Return outputs that stand one after the other."""
    return [(array, k, value) for k, value in enumerate(values, start)]


def sine_cosine(angle: Any) -> tuple[Any, Any]:
    """Sine and cosine for |angle| ≤ 2π, to some 10 units of rounding: series, then doublings."""
    x = angle * 0.5**HALVINGS
    square = x * x
    s: Any = 0.0
    c: Any = 0.0
    for k in range(19, 1, -2):
        s = square * (s + 1.0) * (-1.0 / (k * (k - 1)))
        c = square * (c + 1.0) * (-1.0 / ((k - 1) * (k - 2))) if k > 3 else c
    s, c = x * (s + 1.0), -0.5 * square * (c + 1.0)
    # cos − 1 is doubled instead of the cosine, whose small changes would be lost.
    for _ in range(HALVINGS):
        s, c = 2.0 * s * (1.0 + c), -2.0 * s * s
    return s, 1.0 + c


def _rotation(axis: list[Any], angle: Any) -> list[Any]:
    """Rotation matrix by rows, after Rodrigues."""
    s, c = sine_cosine(angle)
    x, y, z = axis
    v = 1.0 - c
    return [
        c + v * x * x, v * x * y - s * z, v * x * z + s * y,
        v * x * y + s * z, c + v * y * y, v * y * z - s * x,
        v * x * z - s * y, v * y * z + s * x, c + v * z * z,
    ]  # fmt: skip


def _composed(x: list[Any], y: list[Any]) -> list[Any]:
    return [dot(x[3 * i : 3 * i + 3], y[j::3]) for i in range(3) for j in range(3)]


def _boxes() -> Stage:
    """Patch of a box of coordinates: see `docs/proofs.md`, boxes."""
    graph = Graph()
    box, frame = graph.lanes("box", BOX), graph.uniform("frame", FRAME)
    low, high = box[:6], box[6:]
    middle = [0.5 * (x + y) for x, y in zip(low, high, strict=True)]
    half = []
    for x, m, y in zip(low, middle, high, strict=True):
        half.append(choose(m - x < y - m, y - m, m - x) * OUTWARD)
    axes = [frame[3 * i : 3 * i + 3] for i in range(3)]
    first, second, third = (_rotation(e, m) for e, m in zip(axes, middle[3:], strict=True))
    both = _composed(first, second)
    units = [axes[0], turned(first, axes[1]), turned(both, axes[2])]
    rotation = _composed(_composed(both, third), frame[9:])
    h1, h2, h3 = half[3:]
    skewed = magnitude(dot(units[0], units[2])) + h2
    skewed = choose(skewed < 1.0, skewed, 1.0)
    spin = root(h1 * h1 + h2 * h2 + h3 * h3 + 2.0 * (h1 * h3 * skewed)) * OUTWARD
    twist = (h1 * h2 + h2 * h3 + h1 * h3) * OUTWARD
    turns = [x for h, e in zip(half[3:], units, strict=True) for x in times(h, e)]
    position = middle[:3]
    values = [
        *position, *rotation, *half[:3], *turns, norm(half[:3]) * OUTWARD, 0.0,
        spin, twist, norm(position),
    ]  # fmt: skip
    return Stage("proof boxes", ("box", "frame", "patch"), (), store("patch", values))


def _shares(patch: Patch, length: Any) -> list[Any]:
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
    error = ROUNDING * (jet.most + jet.first)
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


def leg_of(kind: Kind) -> tuple[Graph, Patch, list[Any], Segment]:
    """Trace a kind of leg on a patch."""
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH))
    geometry = graph.uniform("geometry", GEOMETRY)
    return graph, patch, geometry, kind.segment(patch, geometry)


def row_scalars(row: Jet) -> list[Any]:
    """Return the scalars of a row from its jet."""
    error = ROUNDING * (row.most + row.first)
    rest, near = (row.rest + error) * OUTWARD, (row.slack + error) * OUTWARD
    return [*row.value, *(x for slope in row.slopes for x in slope), rest, near]


def _rows(kind: Kind) -> Stage:
    graph, _, _, leg = leg_of(kind)
    scalars = [row_scalars(row(leg, graph.scalar("per_length"))) for row in kind.rows]
    outputs = store("rows", [x for row in scalars for x in row])
    return Stage(f"proof rows {kind.name}", ("patch", "geometry", "rows"), ("per_length",), outputs)


def _values(kind: Kind) -> Stage:
    graph, patch, _, leg = leg_of(kind)
    shares = _shares(patch, graph.scalar("length"))
    quantities = []
    for value in kind.values:
        quantity = bounded(value(leg), shares)
        distance = kind.name in SIGNED and value is signed_distance
        quantities += folded(quantity) if distance else quantity
    outputs = store("quantity", quantities)
    return Stage(
        f"proof values {kind.name}", ("patch", "geometry", "quantity"), ("length",), outputs
    )


def _cones(kind: Kind) -> Stage:
    """Cosines of the angles between a leg and the axes of its joints: on base, on platform."""
    graph, patch, _, leg = leg_of(kind)
    shares = _shares(patch, graph.scalar("length"))
    axes = graph.uniform("axes", 6)
    on_base = bounded(inner(leg.direction, constant(axes[:3], 1.0)), shares)
    turned_axis = patch.carried_direction(axes[3:], 0.0)
    on_platform = bounded(inner(leg.direction, turned_axis), shares)
    if kind.name in SIGNED:
        distance = bounded(leg.length, shares)
        on_base, on_platform = (directed(x, distance) for x in (on_base, on_platform))
    outputs = store("quantity", [*on_base, *on_platform])
    return Stage(
        f"proof cones {kind.name}", ("patch", "geometry", "axes", "quantity"), ("length",), outputs
    )


def _gram() -> Stage:
    """Add the products of the derivatives of one row, and the square of its rest."""
    graph = Graph()
    row, sums = graph.lanes("row", ROW_SCALARS), graph.lanes("gram", GRAM)
    slopes = [row[ROW_SLOPES + 6 * k : ROW_SLOPES + 6 * k + 6] for k in range(6)]
    pairs = [(k, m) for k in range(6) for m in range(k, 6)]
    values = [total + dot(slopes[k], slopes[m]) for total, (k, m) in zip(sums, pairs, strict=False)]
    values.append(sums[GRAM_REST] + row[ROW_REST] * row[ROW_REST])
    values.append(sums[GRAM_NEAR] + row[ROW_NEAR] * row[ROW_NEAR])
    return Stage("proof gram", ("row", "gram"), (), store("gram", values))


def variation(gram: list[Any], shares: list[Any]) -> tuple[Any, list[Any]]:
    """Bound of the Frobenius norm of the variation, and the part of each coordinate."""
    place: dict[tuple[int, int], int] = {}
    for k in range(6):
        for m in range(k, 6):
            place[k, m] = place[m, k] = len(set(place.values()))
    sums: list[Any] = []
    for k in range(6):
        part: Any = 0.0
        for m in range(6):
            part = part + magnitude(gram[place[k, m]])
        sums.append(part)
    square: Any = 0.0
    for part in sums:
        square = square + part
    straight, rest = root(square), root(gram[GRAM_REST])
    per = choose(straight > 0.0, 1.0 / straight, 0.0)
    parts = [per * x + rest * share for x, share in zip(sums, shares, strict=True)]
    return (straight + rest) * OUTWARD, parts


def _extremes() -> Stage:
    """Quantities from the extreme singular values: the least, and the condition number."""
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH))
    s, gram = graph.lanes("spectrum", SPECTRUM), graph.lanes("gram", GRAM)
    reach, parts = variation(gram, _shares(patch, graph.scalar("length")))
    margin = SPECTRAL * root(s[TRACE])
    near = root(gram[GRAM_NEAR]) * OUTWARD + margin
    low, high = root(s[SPECTRUM_LOW] * s[TRACE]), root(s[SPECTRUM_HIGH] * s[TRACE])
    wide = reach + margin
    least = [positive(low - wide), low + wide, positive(low - near), low + near]
    ratios = [*_ratios(low, high, wide), *_ratios(low, high, near)]
    outputs = store("quantity", [*least, *parts, *ratios, *parts])
    arrays = ("patch", "spectrum", "gram", "quantity")
    return Stage("proof extremes", arrays, ("length",), outputs)


def positive(x: Any) -> Any:
    """Return x, or 0 if it is negative; NaN stays."""
    return choose(x < 0.0, 0.0, x)


def _ratios(low: Any, high: Any, error: Any) -> list[Any]:
    """Bounds of high / low, each of them known but for an error."""
    below = low - error
    least = positive(high - error) / (low + error) * (2.0 - OUTWARD)
    most = choose(below > 0.0, (high + error) / below * OUTWARD, INFINITE)
    return [choose(least < 1.0, 1.0, least), choose(most < 1.0, 1.0, most)]


def _orientation() -> Stage:
    """Sign of the determinant of a 6 × 6 matrix by Householder reflections; 0 if it is 0."""
    graph = Graph()
    m = graph.lanes("matrix", 36)
    rows = [m[6 * i : 6 * i + 6] for i in range(6)]
    sign: Any = 1.0
    for k in range(6):
        x = [rows[i][k] for i in range(k, 6)]
        signed, head, factor = reflection(x[0], norm(x))
        v = [head, *x[1:]]
        for j in range(k + 1, 6):
            part = factor * dot(v, [rows[i][j] for i in range(k, 6)])
            for i in range(k, 6):
                rows[i][j] = rows[i][j] - part * v[i - k]
        sign = sign * choose(signed < 0.0, -1.0, choose(signed > 0.0, 1.0, 0.0))
    return Stage("proof orientation", ("matrix", "result"), (), [("result", 0, sign)])


BOXES = _boxes()
# In the order of `LEGS`, as a kind of leg has its number there in compiled code.
_IN_ORDER = tuple(KINDS[leg.name] for leg in LEGS)
ROWS = tuple(map(_rows, _IN_ORDER))
VALUES = tuple(map(_values, _IN_ORDER))
CONES = tuple(map(_cones, _IN_ORDER))
GRAM_ROW = _gram()
EXTREMES = _extremes()
ORIENTATION = _orientation()
ALL = (BOXES, *ROWS, *VALUES, *CONES, GRAM_ROW, EXTREMES, ORIENTATION)
