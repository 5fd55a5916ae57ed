"""The stages of the compiled proof: boxes to patches, patches to rows, rows to bounded quantities.

As in `gsp.kernels.stages`, a stage works on LANES patches at once.
"""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import choose, dot, minus, norm, plus, root, times, turned
from gsp.kernels.stages import Stage, store
from gsp.kernels.trace import Graph
from gsp.model.legs import LEG, LEGS
from gsp.variation import matrices
from gsp.variation.jets import Jet, Vector, constant, inner, largest, least, magnitude, scaled
from gsp.variation.legs import (
    KINDS,
    PATCH_LEG_SCALARS,
    PATCH_SCALARS,
    Kind,
    Patch,
    SegmentOnPatch,
    signed_distance,
)
from gsp.variation.passive import WEIGHTS_SCALARS, ellipsoid_row, passive_rows
from gsp.variation.quantities import (
    INFINITE,
    OUTWARD,
    ROW_SCALARS,
    bounded,
    directed,
    folded,
    guarded,
    row_scalars,
    shares_of,
)

# Scalars of a box: least and greatest value of p and of the angles, in the order of moving axes.
BOX_SCALARS = 12
# Scalars of the frame of angles that all boxes share: three axes, and a rotation applied first.
BOX_FRAME_SCALARS = 18
# Scalars of a foot: the place, its six derivatives, bounds of the rest and of the error.
FOOT_SLOPES, FOOT_REST, FOOT_NEAR, FOOT_SCALARS = 3, 21, 22, 23
# Halvings of an angle before its sine is summed up as a series.
ANGLE_HALVINGS = 3


def sine_cosine(angle: Any) -> tuple[Any, Any]:
    """Sine and cosine for |angle| ≤ 2π, to some 10 units of rounding: series, then doublings."""
    x = angle * 0.5**ANGLE_HALVINGS
    square = x * x
    s: Any = 0.0
    c: Any = 0.0
    for k in range(19, 1, -2):
        s = square * (s + 1.0) * (-1.0 / (k * (k - 1)))
        c = square * (c + 1.0) * (-1.0 / ((k - 1) * (k - 2))) if k > 3 else c
    s, c = x * (s + 1.0), -0.5 * square * (c + 1.0)
    # cos − 1 is doubled instead of the cosine, whose small changes would be lost.
    for _ in range(ANGLE_HALVINGS):
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
    box, frame = graph.lanes("box", BOX_SCALARS), graph.uniform("frame", BOX_FRAME_SCALARS)
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
        *position,
        *rotation,
        *half[:3],
        *turns,
        norm(half[:3]) * OUTWARD,
        0.0,
        spin,
        twist,
        norm(position),
    ]
    return Stage("proof boxes", ("box", "frame", "patch"), (), store("patch", values))


def leg_of(kind: Kind) -> tuple[Graph, Patch, list[Any], SegmentOnPatch]:
    """Trace a kind of leg on a patch."""
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH_SCALARS))
    geometry = graph.uniform("geometry", PATCH_LEG_SCALARS)
    return graph, patch, geometry, kind.segment(patch, geometry)


def _rows(kind: Kind) -> Stage:
    graph, _, _, leg = leg_of(kind)
    scalars = [row_scalars(row(leg, graph.scalar("per_length"))) for row in kind.rows]
    outputs = store("rows", [x for row in scalars for x in row])
    return Stage(f"proof rows {kind.name}", ("patch", "geometry", "rows"), ("per_length",), outputs)


def _values(kind: Kind) -> Stage:
    graph, patch, _, leg = leg_of(kind)
    shares = shares_of(patch, graph.scalar("length"))
    quantities = []
    for value in kind.values:
        quantity = bounded(value(leg), shares)
        distance = kind.signed and value is signed_distance
        quantities += folded(quantity) if distance else quantity
    outputs = store("quantity", quantities)
    return Stage(
        f"proof values {kind.name}", ("patch", "geometry", "quantity"), ("length",), outputs
    )


def _cones(kind: Kind) -> Stage:
    """Cosines of the angles between a leg and the axes of its joints: on base, on platform."""
    graph, patch, _, leg = leg_of(kind)
    shares = shares_of(patch, graph.scalar("length"))
    axes = graph.uniform("axes", 6)
    on_base = bounded(inner(leg.direction, constant(axes[:3], 1.0)), shares)
    turned_axis = patch.carried_direction(axes[3:], 0.0)
    on_platform = bounded(inner(leg.direction, turned_axis), shares)
    if kind.signed:
        distance = bounded(leg.length, shares)
        on_base, on_platform = (directed(x, distance) for x in (on_base, on_platform))
    outputs = store("quantity", [*on_base, *on_platform])
    return Stage(
        f"proof cones {kind.name}", ("patch", "geometry", "axes", "quantity"), ("length",), outputs
    )


def _ellipsoid_rows(kind: Kind) -> Stage:
    graph, patch, _, leg = leg_of(kind)
    weights, length = graph.uniform("weights", WEIGHTS_SCALARS), graph.scalar("length")
    rows = []
    for constraint in LEG[kind.name].constraints:
        if constraint.quantity == "angle":
            rows.append(ellipsoid_row(patch, weights, None, scaled(length, leg.direction)))
        else:
            rows.append(ellipsoid_row(patch, weights, leg.direction, leg.moment))
    outputs = store("rows", [x for row in rows for x in row_scalars(row)])
    arrays = ("patch", "geometry", "weights", "rows")
    return Stage(f"proof ellipsoid rows {kind.name}", arrays, ("length",), outputs)


def _passive_rows(kind: Kind) -> Stage:
    graph, _, _, leg = leg_of(kind)
    rows = passive_rows(kind.name, leg, graph.scalar("per_length"))
    outputs = store("rows", [x for row in rows for x in row_scalars(row)])
    arrays = ("patch", "geometry", "rows")
    return Stage(f"proof passive rows {kind.name}", arrays, ("per_length",), outputs)


def _feet(kind: Kind) -> Stage:
    _, patch, geometry, leg = leg_of(kind)
    outputs = store(
        "feet", [x for foot in kind.feet(patch, geometry, leg) for x in row_scalars(foot)]
    )
    return Stage(f"proof feet {kind.name}", ("patch", "geometry", "feet"), (), outputs)


def _foot(scalars: Vector) -> Jet:
    """Return a foot from its scalars; `second` is what its rest is, `slack` its error."""
    slopes = [scalars[FOOT_SLOPES + 3 * k : FOOT_SLOPES + 3 * k + 3] for k in range(6)]
    return Jet(scalars[:3], slopes, scalars[FOOT_NEAR], 0.0, scalars[FOOT_REST], 0.0)


def _nearest(w: Vector, u: Vector, v: Vector) -> tuple[Any, Any]:
    """Shares s, t in [0, 1] of nearly the nearest points of w + s u and t v."""

    def clipped(x: Any) -> Any:
        return choose(x > 0.0, choose(x < 1.0, x, 1.0), 0.0)

    a, b, c, d, e = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    s = clipped((b * e - c * d) / (a * c - b * b))
    t = clipped((b * s + e) / c)
    s = clipped((b * t - d) / a)
    return s, clipped((b * s + e) / c)


def _clearance() -> Stage:
    """Distance of two legs: from below by a separating direction, from above by two points.

    For any unit vector n, the distance of two segments is at least the least n · (x − y) of their
    ends; and at most |x − y| for any two of their points.
    """
    graph = Graph()
    patch = Patch.of(graph.lanes("patch", PATCH_SCALARS))
    shares = shares_of(patch, graph.scalar("length"))
    one, other = (
        [_foot(graph.lanes(name, FOOT_SCALARS, start)) for start in (0, FOOT_SCALARS)]
        for name in ("feet", "others")
    )
    s, t = _nearest(
        minus(one[0].value, other[0].value),
        minus(one[1].value, one[0].value),
        minus(other[1].value, other[0].value),
    )

    def between(x: Any, y: Any, share: Any) -> Any:
        return plus(times(1.0 - share, x), times(share, y))

    gap = minus(between(one[0].value, one[1].value, s), between(other[0].value, other[1].value, t))
    size = norm(gap)
    n = times(choose(size > 0.0, 1.0 / size, 0.0), gap)
    low, low_near, parts = _separations(one, other, n)
    far, reach, contributions = size, 0.0, []
    for k in range(6):
        step = minus(
            between(one[0].slopes[k], one[1].slopes[k], s),
            between(other[0].slopes[k], other[1].slopes[k], t),
        )
        along = dot(n, step)
        far = far + magnitude(along)
        reach = reach + norm(minus(step, times(along, n)))
        contributions.append(largest(parts[k], magnitude(along)))
    rest, near = (
        largest(getattr(one[0], name), getattr(one[1], name))
        + largest(getattr(other[0], name), getattr(other[1], name))
        for name in ("second", "slack")
    )
    high = (root(far * far + reach * reach) + rest) * OUTWARD
    values = [guarded(low, rest), high, guarded(low_near, rest), (size + near) * OUTWARD]
    values += [x + rest * share for x, share in zip(contributions, shares, strict=True)]
    arrays = ("patch", "feet", "others", "quantity")
    return Stage("proof clearance", arrays, ("length",), store("quantity", values))


def _separations(one: list[Jet], other: list[Jet], n: Vector) -> tuple[Any, Any, list[Any]]:
    """Least n · (x − y) of the ends of two legs: on the patch, at its centre, and its parts."""
    low: Any = INFINITE
    near: Any = INFINITE
    parts: list[Any] = [0.0] * 6
    for x in one:
        for y in other:
            value = dot(n, minus(x.value, y.value))
            steps = [
                magnitude(dot(n, minus(a, b))) for a, b in zip(x.slopes, y.slopes, strict=True)
            ]
            reach = x.second + y.second
            for step in steps:
                reach = reach + step
            low = least(value - reach * OUTWARD, low)
            near = least(value - (x.slack + y.slack) * OUTWARD, near)
            parts = [largest(a, b) for a, b in zip(parts, steps, strict=True)]
    return low * (2.0 - OUTWARD), near * (2.0 - OUTWARD), parts


BOXES = _boxes()
# In the order of `LEGS`, as a kind of leg has its number there in compiled code.
_IN_ORDER = tuple(KINDS[leg.name] for leg in LEGS)
ROWS = tuple(map(_rows, _IN_ORDER))
VALUES = tuple(map(_values, _IN_ORDER))
CONES = tuple(map(_cones, _IN_ORDER))
ELLIPSOID_ROWS = tuple(map(_ellipsoid_rows, _IN_ORDER))
PASSIVE_ROWS = tuple(map(_passive_rows, _IN_ORDER))
FEET, CLEARANCE = tuple(map(_feet, _IN_ORDER)), _clearance()
# Rows of the passive rates of a leg of each kind.
N_PASSIVE = tuple(len(stage.outputs) // ROW_SCALARS for stage in PASSIVE_ROWS)
ALL = (
    BOXES,
    *ROWS,
    *VALUES,
    *CONES,
    *ELLIPSOID_ROWS,
    *PASSIVE_ROWS,
    *FEET,
    CLEARANCE,
    *matrices.ALL,
)
