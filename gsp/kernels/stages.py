"""The stages of the compiled evaluation: which formula, from which arrays to which.

A stage works on LANES poses at once. Its arrays are flat: scalar number k of the poses lies at
k · LANES … (k + 1) · LANES − 1, so that neighbours in memory are the same scalar of neighbouring
poses.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from zlib import crc32

from gsp.geometry.ellipsoid import ellipsoid_frame, ellipsoid_row
from gsp.geometry.matrices import rounding_of_rank
from gsp.geometry.scalars import choose, less, minus, norm, root, times
from gsp.kernels.formulas.spectrum import (
    bidiagonal,
    laguerre,
    laguerre_start,
    reflection,
    solved_row,
)
from gsp.kernels.trace import Graph, Traced, needed
from gsp.model.formulas import Segment, placement
from gsp.model.legs import LEGS, Leg

LANES = 8

# Scalars of a pose: p, R by rows, |p|, and how many of its legs are undefined.
POSE_SCALARS, POSE_REACH, POSE_UNDEFINED = 14, 12, 13
# Scalars of a leg that all poses share: a, b, s, t, |a| + |b|.
LEG_SCALARS = 13
# Scalars of a spectrum: q (6), e (5), |det|, trace, bounds from below and above, unfinished.
SPECTRUM_SCALARS = 16
SPECTRUM_DETERMINANT = 11
SPECTRUM_TRACE = 12
SPECTRUM_LOW = 13
SPECTRUM_HIGH = 14
SPECTRUM_ACTIVE = 15
# Laguerre's steps converge by 0.42 each or better, so that fewer than 40 are needed.
MOST_LAGUERRE_STEPS = 60
# Rows of a tall matrix that are read at once by the QR factorisation.
QR_ROWS_AT_ONCE = 4
# Scalars of an upper triangle by rows, then one over its diagonal.
UPPER_SCALARS, PER_DIAGONAL = 27, 21

Outputs = list[tuple[str, int, Any]]


@dataclass(frozen=True)
class Stage:
    """A formula from arrays to arrays.

    Attributes
    ----------
    name : str
    arrays : tuple of str
        Its arguments, before those in `scalars`.
    scalars : tuple of str
    outputs : list of (array, place, value)
    repeat : int
        How often it is done again, at most, while the last output is not zero in some lane.
    """

    name: str
    arrays: tuple[str, ...]
    scalars: tuple[str, ...]
    outputs: Outputs
    repeat: int = 0


def store(array: str, values: Sequence[Any], start: int = 0) -> Outputs:
    """Return outputs that are stored one after the other."""
    return [(array, k, value) for k, value in enumerate(values, start)]


def _flat(rows: Sequence[Sequence[Any]]) -> list[Any]:
    return [x for row in rows for x in row]


def _reach() -> Stage:
    p = Graph().lanes("pose", 3)
    return Stage("reach", ("pose",), (), store("pose", [norm(p), 0.0], POSE_REACH))


def _segment(leg: Leg) -> tuple[Graph, list[Any], Segment]:
    graph = Graph()
    pose, geometry = graph.lanes("pose", POSE_SCALARS), graph.uniform("geometry", LEG_SCALARS)
    at = placement(
        pose[:3],
        pose[3:12],
        (geometry[:3], geometry[3:6]),
        (geometry[6:9], geometry[9:12]),
        pose[POSE_REACH] + geometry[12],
    )
    return graph, pose, leg.segment(at)


def _actuators(leg: Leg) -> Stage:
    graph, pose, segment = _segment(leg)
    rows = [c.row(segment, graph.scalar("length")) for c in leg.constraints]
    missing = pose[POSE_UNDEFINED] + choose(segment.defined, 0.0, 1.0)
    outputs = store("rows", _flat(rows)) + store("pose", [missing], POSE_UNDEFINED)
    return Stage(f"actuators {leg.name}", ("pose", "geometry", "rows"), ("length",), outputs)


def _values(leg: Leg) -> Stage:
    _, pose, segment = _segment(leg)
    missing = pose[POSE_UNDEFINED] + choose(segment.defined, 0.0, 1.0)
    outputs = store("values", [c.measure(segment) for c in leg.constraints])
    outputs += store("pose", [missing], POSE_UNDEFINED)
    return Stage(f"values {leg.name}", ("pose", "geometry", "values"), (), outputs)


def _passive(leg: Leg) -> Stage:
    graph, _, segment = _segment(leg)
    rows = [rate.row for rate in leg.passive(segment, graph.scalar("length"))]
    outputs = store("rows", _flat(rows))
    return Stage(f"passive {leg.name}", ("pose", "geometry", "rows"), ("length",), outputs)


def _frame() -> Stage:
    graph = Graph()
    rotation, given = graph.lanes("pose", 9, 3), graph.uniform("ellipsoid", 12)
    values = ellipsoid_frame(rotation, given[:3], given[3:])
    return Stage("ellipsoid_frame", ("pose", "ellipsoid", "frame"), (), store("frame", values))


def _row_stages() -> tuple[Stage, ...]:
    graph = Graph()
    row, per_length = graph.lanes("row", 6), graph.scalar("per_length")
    scaled = [*row[:3], *times(per_length, row[3:])]
    turned = ellipsoid_row(row, graph.lanes("frame", 12))
    upper = graph.lanes("upper", UPPER_SCALARS)
    solved = solved_row(row, upper[:PER_DIAGONAL], upper[PER_DIAGONAL:])
    return (
        Stage("homogeneous_row", ("row", "result"), ("per_length",), store("result", scaled)),
        Stage("ellipsoid_row", ("row", "frame", "result"), (), store("result", turned)),
        Stage("solved_row", ("row", "upper", "result"), (), store("result", solved)),
    )


def _bidiagonal() -> Stage:
    m = Graph().lanes("matrix", 36)
    q, e, determinant = bidiagonal([m[6 * i : 6 * i + 6] for i in range(6)])
    q, e, trace, high = laguerre_start(q, e)
    values = [*q, *e, determinant, trace, 0.0, high, 1.0]
    return Stage("bidiagonal", ("matrix", "spectrum"), (), store("spectrum", values))


def _laguerre() -> Stage:
    s = Graph().lanes("spectrum", SPECTRUM_SCALARS)
    low, more_below = laguerre(s[:6], s[6:11], s[SPECTRUM_LOW], 1.0)
    high, more_above = laguerre(s[:6], s[6:11], s[SPECTRUM_HIGH], -1.0)
    unfinished = less(0.0, s[SPECTRUM_ACTIVE])
    values = [
        choose(unfinished, low, s[SPECTRUM_LOW]),
        choose(unfinished, high, s[SPECTRUM_HIGH]),
        choose(unfinished, more_below + more_above, 0.0),
    ]
    return Stage(
        "laguerre", ("spectrum",), (), store("spectrum", values, SPECTRUM_LOW), MOST_LAGUERRE_STEPS
    )


def _extremes() -> Stage:
    """σ_min / σ_max, σ_min and |det|; all 0 by the rank rule of `gsp.geometry.matrices`."""
    s = Graph().lanes("spectrum", SPECTRUM_SCALARS)
    low, high = (
        root(s[SPECTRUM_LOW] * s[SPECTRUM_TRACE]),
        root(s[SPECTRUM_HIGH] * s[SPECTRUM_TRACE]),
    )
    full = less(rounding_of_rank(high), low)
    values = [choose(full, x, 0.0) for x in (low / high, low, s[SPECTRUM_DETERMINANT])]
    return Stage("extremes", ("spectrum", "result"), (), store("result", values))


def _sweep(column: int) -> Stage:
    """Apply the last reflection to QR_ROWS_AT_ONCE rows, and collect products for the next one.

    The rows start below the row of the last reflection; `sums` are the products of this column
    with itself and with those to its right.
    """
    graph = Graph()
    width = 6 - column
    sums, factors = graph.lanes("sums", width), graph.lanes("factors", width)
    outputs: Outputs = []
    for r in range(QR_ROWS_AT_ONCE):
        row = graph.lanes("rows", width, 6 * r + column)
        if column:
            (head,) = graph.lanes("rows", 1, 6 * r + column - 1)
            row = minus(row, times(head, factors))
            outputs += store("rows", row, 6 * r + column)
        sums = [total + row[0] * x for total, x in zip(sums, row, strict=True)]
    outputs += store("sums", sums)
    return Stage(f"sweep {column}", ("rows", "factors", "sums"), (), outputs)


def _pivot(column: int) -> Stage:
    """Row of R, one over its first entry, and the factors that the rows below are changed by.

    `sums` become zero.
    """
    graph = Graph()
    width = 6 - column
    sums, row = graph.lanes("sums", width), graph.lanes("rows", width, column)
    signed, head, per = reflection(row[0], root(sums[0]))
    factors = [per * (s + signed * x) for s, x in zip(sums[1:], row[1:], strict=True)]
    upper = [-signed, *(x - head * f for x, f in zip(row[1:], factors, strict=True))]
    place = column * 6 - column * (column - 1) // 2
    outputs = store("factors", factors) + store("upper", upper, place)
    outputs += store("upper", [-1.0 / signed], PER_DIAGONAL + column)
    outputs += store("sums", [0.0] * width)
    return Stage(f"pivot {column}", ("rows", "sums", "factors", "upper"), (), outputs)


REACH_STAGE = _reach()
ACTUATORS = tuple(map(_actuators, LEGS))
PASSIVE = tuple(map(_passive, LEGS))
VALUES = tuple(map(_values, LEGS))
ELLIPSOID_FRAME = _frame()
HOMOGENEOUS_ROW, ELLIPSOID_ROW, SOLVED_ROW = _row_stages()
BIDIAGONAL, LAGUERRE, EXTREMES = _bidiagonal(), _laguerre(), _extremes()
# Rows that a leg of each kind gives: of its actuators, of its passive joints.
N_ACTUATORS = tuple(len(leg.constraints) for leg in LEGS)
N_PASSIVE = tuple(len(stage.outputs) // 6 for stage in PASSIVE)
SWEEPS = tuple(map(_sweep, range(6)))
PIVOTS = tuple(map(_pivot, range(6)))


ALL = (
    REACH_STAGE,
    *ACTUATORS,
    *PASSIVE,
    ELLIPSOID_FRAME,
    HOMOGENEOUS_ROW,
    ELLIPSOID_ROW,
    SOLVED_ROW,
    BIDIAGONAL,
    LAGUERRE,
    EXTREMES,
    *SWEEPS,
    *PIVOTS,
)


def checksum(stages: Sequence[Stage] = ()) -> int:
    """Checksum of stages, by default all of this module: it changes with the code made of them."""
    number = 0
    for stage in stages or ALL:
        nodes = needed(value for _, _, value in stage.outputs)
        text = [(n.number, n.op, tuple(map(_printed, n.args))) for n in nodes]
        outputs = [(array, k, _printed(value)) for array, k, value in stage.outputs]
        facts = (stage.name, stage.arrays, stage.scalars, stage.repeat)
        number = crc32(repr((facts, text, outputs)).encode(), number)
    return number


def _printed(value: Any) -> str:
    return f"t{value.number}" if isinstance(value, Traced) else repr(value)
