"""The stages of the compiled evaluation: which formula, on which arrays.

A stage works on LANES poses at once. Its arrays are flat: scalar number k of the poses lies at
k · LANES … (k + 1) · LANES − 1, so that neighbours in memory are the same scalar of neighbouring
poses. `generate` prints the stages as Python for numba; other printers can use them as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from gsp.kernels import algebra
from gsp.kernels.trace import Graph, choose, root, straight_line

LANES = 32

# Scalars of a pose: p, R by rows, |p|, and how many of its legs are undefined.
POSE, REACH, UNDEFINED = 14, 12, 13
# Scalars of a leg that all poses share: a, b, s, t, |a| + |b|.
GEOMETRY = 13
# Scalars of a spectrum: q (6), e (5), |det|, trace, bounds from below and above, unfinished.
SPECTRUM, DETERMINANT, TRACE, LOW, HIGH, ACTIVE = 16, 11, 12, 13, 14, 15
# Rows of a tall matrix that are read at once by the QR factorisation.
CHUNK = 4
UPPER = 21


@dataclass(frozen=True)
class Stage:
    """A function over the lanes of some arrays.

    Attributes
    ----------
    name : str
    arrays : tuple of str
        Its arguments, of which those in `scalars` are numbers.
    scalars : tuple of str
    outputs : sequence of (statement, value)
        What it stores; "{}" in the statement is the value.
    """

    name: str
    arrays: tuple[str, ...]
    scalars: tuple[str, ...]
    outputs: Sequence[tuple[str, Any]]

    def code(self, language: MappingProxyType[str, str]) -> tuple[list[str], list[str]]:
        """Lines before the loop over the lanes, and lines of its body: see `straight_line`."""
        return straight_line(self.outputs, language, "geometry[")


def _lanes(graph: Graph, array: str, count: int, start: int = 0) -> list[Any]:
    return [graph.symbol(_at(array, k)) for k in range(start, start + count)]


def _at(array: str, k: int) -> str:
    return f"{array}[i + {k * LANES}]" if k else f"{array}[i]"


def _store(array: str, values: Sequence[Any], start: int = 0) -> list[tuple[str, Any]]:
    return [(_at(array, k) + " = {}", value) for k, value in enumerate(values, start)]


def _flat(rows: Sequence[Sequence[Any]]) -> list[Any]:
    return [x for row in rows for x in row]


def _uniform(graph: Graph, count: int) -> list[Any]:
    return [graph.symbol(f"geometry[{k}]") for k in range(count)]


def _reach() -> Stage:
    graph = Graph()
    p = _lanes(graph, "pose", 3)
    size = root(algebra.dot(p, p))
    return Stage("reach", ("pose",), (), _store("pose", [size, 0.0], REACH))


def _leg(kind: algebra.Kind, number: int) -> tuple[Stage, Stage]:
    graph = Graph()
    pose, length = _lanes(graph, "pose", POSE), graph.symbol("length")
    leg = kind.segment(pose[:UNDEFINED], _uniform(graph, GEOMETRY))
    missing = pose[UNDEFINED] + choose(leg.undefined, 0.0, 1.0)
    rows = _store("rows", _flat([row(leg, length) for row in kind.rows]))
    arrays = ("pose", "geometry", "rows")
    return (
        Stage(
            f"rows_{number}",
            arrays,
            ("length",),
            [*rows, (_at("pose", UNDEFINED) + " = {}", missing)],
        ),
        Stage(
            f"passive_{number}",
            arrays,
            ("length",),
            _store("rows", _flat(kind.passive(leg, length))),
        ),
    )


def _frame() -> Stage:
    graph = Graph()
    pose, given = _lanes(graph, "pose", POSE), _uniform(graph, 12)
    values = algebra.ellipsoid_frame(pose[3:12], given[:3], given[3:])
    return Stage("ellipsoid_frame", ("pose", "geometry", "frame"), (), _store("frame", values))


def _row_stages() -> tuple[Stage, ...]:
    graph = Graph()
    row, per_length = _lanes(graph, "row", 6), graph.symbol("per_length")
    scaled = [*row[:3], *algebra.times(per_length, row[3:])]
    turned = algebra.ellipsoid_row(row, _lanes(graph, "frame", 12))
    solved = algebra.solved_row(row, _lanes(graph, "upper", UPPER))
    return (
        Stage("homogeneous_row", ("row", "result"), ("per_length",), _store("result", scaled)),
        Stage("ellipsoid_row", ("row", "frame", "result"), (), _store("result", turned)),
        Stage("solved_row", ("row", "upper", "result"), (), _store("result", solved)),
    )


def _bidiagonal() -> Stage:
    graph = Graph()
    m = _lanes(graph, "matrix", 36)
    q, e, determinant = algebra.bidiagonal([m[6 * i : 6 * i + 6] for i in range(6)])
    q, e, trace, high = algebra.laguerre_start(q, e)
    values = [*q, *e, determinant, trace, 0.0, high, 1.0]
    return Stage("bidiagonal", ("matrix", "spectrum"), (), _store("spectrum", values))


def _laguerre() -> Stage:
    graph = Graph()
    s = _lanes(graph, "spectrum", SPECTRUM)
    low, more_below = algebra.laguerre(s[:6], s[6:11], s[LOW], 1.0)
    high, more_above = algebra.laguerre(s[:6], s[6:11], s[HIGH], -1.0)
    active = s[ACTIVE]
    values = [
        choose(active > 0.0, low, s[LOW]),
        choose(active > 0.0, high, s[HIGH]),
        choose(active > 0.0, more_below + more_above, 0.0),
    ]
    return Stage("laguerre", ("spectrum",), (), _store("spectrum", values, LOW))


def _extremes() -> Stage:
    """σ_min / σ_max and σ_min, by the rank rule of `reference.reciprocal_condition`; σ_max."""
    graph = Graph()
    s = _lanes(graph, "spectrum", SPECTRUM)
    low, high = root(s[LOW] * s[TRACE]), root(s[HIGH] * s[TRACE])
    singular = 6.0 * algebra.EPS * high
    full = singular < low
    values = [choose(full, low / high, 0.0), choose(full, low, 0.0), high]
    return Stage("extremes", ("spectrum", "result"), (), _store("result", values))


def _sweep(column: int) -> Stage:
    """Apply the reflection of the last column to CHUNK rows, and collect products for the next.

    The rows start below the row of the last reflection; `sums` are the products of this column
    with itself and those to its right.
    """
    graph = Graph()
    width = 6 - column
    sums = _lanes(graph, "sums", width)
    factors = _lanes(graph, "factors", width)
    outputs = []
    for r in range(CHUNK):
        head = graph.symbol(_at("rows", 6 * r + column - 1)) if column else 0.0
        row = _lanes(graph, "rows", width, 6 * r + column)
        if column:
            row = algebra.minus(row, [f * head for f in factors])
            outputs += _store("rows", row, 6 * r + column)
        sums = [total + row[0] * x for total, x in zip(sums, row, strict=True)]
    return Stage(
        f"sweep_{column}",
        ("rows", "factors", "sums"),
        (),
        [*outputs, *_store("sums", sums)],
    )


def _pivot(column: int) -> Stage:
    """Row of R, and the factors that the rows below are to be changed by."""
    graph = Graph()
    width = 6 - column
    sums, row = _lanes(graph, "sums", width), _lanes(graph, "rows", width, column)
    size = root(sums[0])
    large = choose(row[0] < 0.0, size - row[0], size + row[0])
    head = choose(row[0] < 0.0, -large, large)
    scale = size * large
    per = choose(scale > 0.0, 1.0 / scale, 0.0)
    signed = choose(row[0] < 0.0, -size, size)
    factors = [per * (s + signed * x) for s, x in zip(sums[1:], row[1:], strict=True)]
    upper = [-signed, *(x - head * f for x, f in zip(row[1:], factors, strict=True))]
    place = column * 6 - column * (column - 1) // 2
    outputs = _store("factors", factors) + _store("upper", upper, place)
    zeros = _store("sums", [0.0] * max(width - 1, 1))
    return Stage(f"pivot_{column}", ("rows", "sums", "factors", "upper"), (), outputs + zeros)


def stages() -> tuple[Stage, ...]:
    """Return all stages, in a fixed order."""
    legs = [_leg(kind, number) for number, kind in enumerate(algebra.KINDS)]
    return (
        _reach(),
        *(rows for rows, _ in legs),
        *(passive for _, passive in legs),
        _frame(),
        *_row_stages(),
        _bidiagonal(),
        _laguerre(),
        _extremes(),
        *(_sweep(column) for column in range(6)),
        *(_pivot(column) for column in range(6)),
    )
