"""The stages of compiled forward kinematics: a trial pose, its rows, their inverse, the decision.

As in `gsp.kernels.stages`, a stage works on LANES poses at once. Lengths are in units of the size
of the design, and both frames have their origins at the centres of the anchors.
"""

from __future__ import annotations

from typing import Any

from gsp.geometry.scalars import choose, dot, less, norm, plus, root, times
from gsp.kernels.formulas.linear import inverse, rotated
from gsp.kernels.stages import (
    LEG_SCALARS,
    POSE_REACH,
    POSE_SCALARS,
    POSE_UNDEFINED,
    Outputs,
    Stage,
    store,
)
from gsp.kernels.trace import Graph
from gsp.kinematics.newton.control import Step, ending, next_share, taken
from gsp.model.constraints import Constraint
from gsp.model.formulas import Segment, placement
from gsp.model.legs import LEGS, Leg
from gsp.variation.legs import KINDS, PATCH_LEG_SCALARS, PATCH_SCALARS, Patch
from gsp.variation.quantities import OUTWARD, row_scalars

# Scalars of a point of the search: pose, rows, inverse, norms of its columns, Newton step; largest
# error, norm of the errors, squared norm of the inverse, undefined legs.
POINT_ROWS, POINT_INVERSE, POINT_COLUMNS = POSE_SCALARS, POSE_SCALARS + 36, POSE_SCALARS + 72
POINT_STEP = POINT_COLUMNS + 6
POINT_LARGEST, POINT_SIZE, POINT_SQUARE = POINT_STEP + 6, POINT_STEP + 7, POINT_STEP + 8
POINT_SCALARS = POINT_STEP + 9
# Scalars of a search: share, fresh, steps, how it ended.
SEARCH_SHARE, SEARCH_FRESH, SEARCH_STEPS, SEARCH_ENDING, SEARCH_SCALARS = range(5)


def _move() -> Stage:
    """Find the pose at the end of a step, and the path to it as a patch of one direction."""
    graph = Graph()
    here, search = graph.lanes("here", POINT_SCALARS), graph.lanes("search", SEARCH_SCALARS)
    position, rotation = here[:3], here[3:12]
    share, step = search[SEARCH_SHARE], here[POINT_STEP : POINT_STEP + 6]
    shift, turn = times(share, step[:3]), times(share, step[3:])
    p = plus(position, shift)
    zeros = [0.0] * 12
    patch = [
        *position,
        *rotation,
        *zeros,
        norm(shift) * OUTWARD,
        0.0,
        norm(turn) * OUTWARD,
        0.0,
        norm(position),
    ]
    pose = [*p, *rotated(turn, rotation), norm(p), 0.0]
    outputs = store("there", pose) + store("patch", patch)
    return Stage("newton move", ("here", "search", "there", "patch"), (), outputs)


def signed(segment: Segment, constraint: Constraint) -> Any:
    """Return −1 where the distance of two lines is along s × t, else 1; 1.0 for the others."""
    if not segment.normal or constraint.quantity != "distance":
        return 1.0
    return choose(less(dot(segment.direction, segment.normal), 0.0), -1.0, 1.0)


def _leg(leg: Leg) -> Stage:
    """Rows and errors at the end of a step, with the signs of the guess, and the bends on it."""
    graph = Graph()
    pose, geometry = graph.lanes("there", POSE_SCALARS), graph.uniform("geometry", LEG_SCALARS)
    fresh = graph.lanes("search", 1, SEARCH_FRESH)[0]
    points, lines = (geometry[:3], geometry[3:6]), (geometry[6:9], geometry[9:12])
    at = placement(pose[:3], pose[3:12], points, lines, pose[POSE_REACH] + geometry[12])
    segment = leg.segment(at)
    patch = Patch.of(graph.lanes("patch", PATCH_SCALARS))
    path = graph.uniform("path", PATCH_LEG_SCALARS)
    kind = KINDS[leg.name]
    moving = kind.segment(patch, path)
    outputs: Outputs = []
    for k, constraint in enumerate(leg.constraints):
        sign = signed(segment, constraint)
        kept = choose(less(0.5, fresh), sign, graph.lanes("signs", 1, k)[0])
        side = sign * kept
        target = graph.lanes("target", 1, k)[0]
        error = side * constraint.measure(segment) - target
        outputs += store("rows", times(side, constraint.row(segment, 1.0)), 6 * k)
        outputs += store("errors", [error], k) + store("signs", [kept], k)
        outputs += store("bends", [bend(kind.rows[k](moving, 1.0))], k)
    missing = pose[POSE_UNDEFINED] + choose(segment.defined, 0.0, 1.0)
    outputs += store("there", [missing], POSE_UNDEFINED)
    given = ("there", "search", "patch", "geometry", "path", "target")
    arrays = (*given, "rows", "errors", "signs", "bends")
    return Stage(f"newton leg {leg.name}", arrays, (), outputs)


def bend(row: Any) -> Any:
    """Return S/8 of a row, and what the rounding of the rows at both ends may add."""
    near = row_scalars(row)[-1]
    return (0.125 * row.second + 2.0 * near) * OUTWARD


def _solve() -> Stage:
    """Find the inverse at the end of a step, and the next Newton step."""
    graph = Graph()
    point, errors = graph.lanes("there", POINT_SCALARS), graph.lanes("errors", 6)
    rows = [point[POINT_ROWS + 6 * i : POINT_ROWS + 6 * i + 6] for i in range(6)]
    inv = inverse(rows)
    squares = [dot(column, column) for column in zip(*inv, strict=True)]
    square = squares[0]
    for x in squares[1:]:
        square = square + x
    largest: Any = 0.0
    for x in errors:
        magnitude = choose(less(x, 0.0), -x, x)
        largest = choose(less(magnitude, largest), largest, magnitude)
    step = [-dot(row, errors) for row in inv]
    values = [
        *(x for row in inv for x in row),
        *map(root, squares),
        *step,
        largest,
        norm(errors),
        square,
    ]
    return Stage("newton solve", ("there", "errors"), (), store("there", values, POINT_INVERSE))


def _decide() -> Stage:
    """Decide whether the step is taken, and whether the search continues."""
    graph = Graph()
    here, there = graph.lanes("here", POINT_SCALARS), graph.lanes("there", POINT_SCALARS)
    bends, search = graph.lanes("bends", 6), graph.lanes("search", SEARCH_SCALARS)
    change = [
        [there[POINT_ROWS + 6 * i + j] - here[POINT_ROWS + 6 * i + j] for j in range(6)]
        for i in range(6)
    ]
    first, last = _reach(here, change, bends), _reach(there, change, bends)
    step = Step(
        fresh=search[SEARCH_FRESH],
        undefined=there[POSE_UNDEFINED],
        reach=choose(less(first, last), last, first),
        share=search[SEARCH_SHARE],
        here=here[POINT_SIZE],
        there=there[POINT_SIZE],
    )
    took = taken(step)
    chosen = less(0.5, took)
    now = [choose(chosen, x, y) for x, y in zip(there, here, strict=True)]
    v, w = norm(now[POINT_STEP : POINT_STEP + 3]), norm(now[POINT_STEP + 3 : POINT_STEP + 6])
    sizes = (
        norm(here[POINT_STEP : POINT_STEP + 6]),
        norm(now[POINT_STEP : POINT_STEP + 6]),
        choose(less(v, w), w, v),
    )
    share = next_share(step, took, sizes)
    end = ending(
        step,
        took,
        (now[POINT_LARGEST], now[POINT_SIZE]),
        now[POINT_SQUARE],
        share,
        graph.scalar("tolerance"),
    )
    steps = search[SEARCH_STEPS] + 1.0 - search[SEARCH_FRESH]
    outputs = store("here", now) + store("search", [share, 0.0, steps, end])
    return Stage("newton decide", ("here", "there", "bends", "search"), ("tolerance",), outputs)


def _reach(point: list[Any], change: list[list[Any]], bends: list[Any]) -> Any:
    """Bound of ‖A⁻¹ J(s) − I‖ on the half of the step next to a point: see `control`."""
    total: Any = 0.0
    for i in range(6):
        row = point[POINT_INVERSE + 6 * i : POINT_INVERSE + 6 * i + 6]
        for j in range(6):
            x = dot(row, [change[k][j] for k in range(6)])
            total = total + x * x
    return 0.5 * root(total) + dot(point[POINT_COLUMNS : POINT_COLUMNS + 6], bends)


MOVE, SOLVE, DECIDE = _move(), _solve(), _decide()
LEG_STAGES = tuple(map(_leg, LEGS))
ALL = (MOVE, *LEG_STAGES, SOLVE, DECIDE)
