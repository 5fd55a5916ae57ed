"""Workspaces as proven sets, beside a plain branch and prune and beside Monte Carlo: the 6–3.

Times are CPU times of one thread. The plain way is `plain_tree`, to a fixed depth; ours is then
timed to a bracket at least as narrow. Monte Carlo decides points of the same box one after the
other, as `tests/reference/workspace_samples.py` does; its time is that of as many points as give
the standard error of our estimate.

`python -m benchmarks.bench_sets`
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import gsp
from benchmarks import plain_tree
from benchmarks.timing import markdown
from tests.reference import workspace_samples

DESIGN = gsp.catalogue.design("workspace-6-3")
ABOVE = gsp.Limits(position=[None, None, (0.0, None)])
PLANE = ([0.0, 0.0, 0.0], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
RANGE = gsp.PoseBox([0.0, 0.0, 0.0], [(-20.0, 20.0)] * 3, degrees=True)
# Samples of undecided cells for an estimate, and of Monte Carlo for the time of a point.
SAMPLES, POINTS = 300, 40
# Random rotations of a range at each of these points.
ROTATIONS = 400


@dataclass(frozen=True, kw_only=True)
class Case:
    """A question: ours, the depth of the plain tree, and how Monte Carlo decides points."""

    name: str
    find: Callable[..., Any]
    depth: int
    every: bool
    flat: bool
    decide: Callable[[np.ndarray, np.random.Generator], np.ndarray]


def _some(points: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return workspace_samples.reachable(DESIGN, points, *DESIGN.strokes.T, rng)


def _all(points: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    found = []
    for point in points:
        angles = rng.uniform(RANGE.low[3:], RANGE.high[3:], (ROTATIONS, 3))
        angles[: ROTATIONS // 2] = np.where(
            angles[: ROTATIONS // 2] < 0.0, RANGE.low[3:], RANGE.high[3:]
        )
        turns = workspace_samples.product_of_turns(angles, "rpy")
        place = np.repeat(point[None], ROTATIONS, 0)
        found.append(workspace_samples.feasible(DESIGN, place, turns, *DESIGN.strokes.T).all())
    return np.array(found)


CASES = (
    Case(
        name="reachable, in space",
        find=lambda **more: gsp.workspace.reachable(DESIGN, ABOVE, **more),
        depth=3,
        every=False,
        flat=False,
        decide=_some,
    ),
    Case(
        name="reachable, y = 0",
        find=lambda **more: gsp.workspace.reachable(DESIGN, ABOVE, plane=PLANE, **more),
        depth=4,
        every=False,
        flat=True,
        decide=_some,
    ),
    Case(
        name="dextrous, ±20° in three angles",
        find=lambda **more: gsp.workspace.dextrous(DESIGN, RANGE, ABOVE, **more),
        depth=6,
        every=True,
        flat=False,
        decide=_all,
    ),
)


def timed(run: Callable[[], Any]) -> tuple[Any, float]:
    """Return a result and its CPU time [s]."""
    start = time.process_time()
    return run(), time.process_time() - start


def half_width(bracket: tuple[float, float]) -> float:
    """Half the width of a bracket over its middle."""
    return (bracket[1] - bracket[0]) / (bracket[1] + bracket[0])


def box_of(flat: bool) -> tuple[np.ndarray, np.ndarray]:
    """Corners of the box of all positions above the base, from the lengths alone."""
    reach = (DESIGN.strokes[:, 1] + np.linalg.norm(DESIGN.platform_points, axis=1))[:, None]
    low = (DESIGN.base_points - reach).max(axis=0)
    high = (DESIGN.base_points + reach).min(axis=0)
    low[2] = 0.0
    if flat:
        low[1] = high[1] = 0.0
    return low, high


def plain(case: Case, depth: int) -> tuple[float, float, int]:
    """Bracket of the plain tree, and the balls that it looked at."""
    roots = plain_tree.all_rotations()
    if case.every:
        roots = plain_tree.rotations_between(RANGE.low[3:], RANGE.high[3:])
    axes = np.array([0, 2] if case.flat else [0, 1, 2])
    points = (np.ascontiguousarray(x) for x in (DESIGN.base_points, DESIGN.platform_points))
    strokes = (np.ascontiguousarray(x) for x in DESIGN.strokes.T)
    return plain_tree.bracket(*box_of(case.flat), axes, depth, roots, case.every, *points, *strokes)


def as_narrow(case: Case, width: float) -> float:
    """CPU time of ours to a bracket no wider, from the first resolution that gives one."""
    resolution = 4.0
    while True:
        region, seconds = timed(
            lambda r=resolution: case.find(resolution=r, workers=1, progress=False)
        )
        if region.bracket[1] > 0.0 and half_width(region.bracket) <= width:
            return seconds
        resolution /= 2.0


def samples_for(case: Case, region: Any, error: float) -> float:
    """CPU time of Monte Carlo with a standard error, from the time of some points.

    Its points are in the box of what ours left, which favours it.
    """
    low, high = region.extents[1]
    sides = high - low
    if case.flat:
        low, high = (np.array([end[0], 0.0, end[1]]) for end in (low, high))
    rng = np.random.default_rng(0)
    found, seconds = timed(lambda: case.decide(rng.uniform(low, high, (POINTS, 3)), rng))
    # The share inside is known by ours better than by these points.
    share = sum(region.bracket) / 2.0 / sides.prod()
    needed = share * (1.0 - share) * (sides.prod() / error) ** 2
    return float(seconds / len(found) * needed)


HEAD = (
    "question",
    "bracket",
    "CPU, s",
    "estimate",
    "CPU, s, with it",
    "plain tree",
    "CPU, s",
    "times faster",
    "Monte Carlo, CPU, s",
    "times faster",
)


def section() -> str:
    """Return the table of brackets, estimates and times, with the ratios to the other ways."""
    table = []
    for case in CASES:
        case.find(resolution=8.0, workers=1, progress=False)  # compiled code is loaded
        plain(case, 1)
        region, seconds = timed(lambda c=case: c.find(workers=1, progress=False))
        estimate, more = timed(lambda r=region: r.estimate(SAMPLES))
        other, slow = timed(lambda c=case: plain(c, c.depth))
        bracket = other[:2]
        monte = samples_for(case, region, estimate.error)
        print(f"{case.name}: measured", file=sys.stderr, flush=True)
        table.append(
            (
                case.name,
                _bracket(region.bracket),
                f"{seconds:.1f}",
                f"{estimate.value:.5g} ± {estimate.error:.2g}",
                f"{seconds + more:.1f}",
                f"{_bracket(bracket)}, {other[2]:.2g} balls",
                f"{slow:.1f}",
                f"{slow / as_narrow(case, half_width(bracket)):,.0f}",
                f"{monte:,.0f}",
                f"{monte / (seconds + more):,.0f}",
            )
        )
    return markdown(HEAD, table)


def _bracket(ends: tuple[float, float]) -> str:
    return f"{ends[0]:.4g} … {ends[1]:.4g} (±{100 * half_width(ends):.1f} %)"


if __name__ == "__main__":
    print(section())
