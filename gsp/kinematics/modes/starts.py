"""Generic systems with all their solutions, found by monodromy."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kinematics.modes.equations import (
    Complex,
    Layout,
    coordinates,
    distinct,
    normal,
    refined,
    residual,
)

# First corrections that steps aim at: for loops and as a rule, and for paths that are traced again.
FIRST_CORRECTION, RETRACED_CORRECTION = 3e-3, 3e-5
# Steps of a path, and of one that is traced again.
PATH_STEPS, RETRACED_PATH_STEPS = 1000, 3000
# A solution of a start system is kept if its last correction is below this share of it.
LAST_CORRECTION = 1e-8
# Last corrections of large poses that rounding explains, at most: these ends are refined.
MOST_ROUNDING = 1e-4
# Loops without a new solution after which a system of unknown number is taken to be complete, and
# loops at most.
QUIET_LOOPS, MOST_LOOPS = 6, 200
# Systems that are tried for an expected number of solutions.
MOST_SYSTEMS = 3
# Points on the circle of the trace test; a sum is linear if its other coefficients are below this
# share of the largest one.
TRACE_POINTS, TRACE_TOLERANCE = 16, 1e-8


@dataclass(frozen=True, eq=False, kw_only=True)
class Start:
    """A generic system and its solutions.

    Attributes
    ----------
    layout : Layout
    parameters : (6, 13) complex array
    poses : (n, 7) complex array
    loops : int
        Loops that it took to find them.
    """

    layout: Layout
    parameters: Complex
    poses: Complex
    loops: int


@dataclass(frozen=True, eq=False, kw_only=True)
class Paths:
    """Ends of paths.

    Attributes
    ----------
    poses : (n, 7) complex array
    ends : (n,) int array
        See `gsp.kinematics.modes.tracking`.
    numbers : (n, 3) array
        Steps, share of the line that is left, last correction.
    """

    poses: Complex
    ends: NDArray[np.int64]
    numbers: Array

    @property
    def arrived(self) -> NDArray[np.bool_]:
        """Which paths came to a solution, (n,)."""
        return np.asarray((self.ends == 0) & (self.numbers[:, 2] < LAST_CORRECTION))


def follow(
    layout: Layout, start: Complex, end: Complex, poses: Complex, *, tight: float, most: int
) -> Paths:
    """Return the ends of the paths of poses from parameters to others."""
    from gsp.kinematics.modes.tracking import track

    n = len(poses)
    out, ends, numbers = np.empty_like(poses), np.empty(n, dtype=np.int64), np.empty((n, 3))
    track(layout.kinds, start, end, np.ascontiguousarray(poses), tight, most, out, ends, numbers)
    size, last = np.abs(out).max(axis=1, initial=0.0), numbers[:, 2]
    rounding = np.minimum(np.finfo(float).eps * size**2, MOST_ROUNDING)  # of residuals, a share
    rough = np.flatnonzero((ends == 0) & (last >= LAST_CORRECTION) & (last < rounding))
    if rough.size:
        fine, after = refined(layout, end, out[rough])
        moved = np.abs(fine - out[rough]).max(axis=1) / size[rough]
        good = (after < LAST_CORRECTION) & (moved < rounding[rough])
        out[rough[good]], numbers[rough[good], 2] = fine[good], after[good]
    return Paths(poses=out, ends=ends, numbers=numbers)


def followed(layout: Layout, start: Complex, end: Complex, poses: Complex) -> Paths:
    """Return the ends of paths; those that did not arrive are traced again with shorter steps."""
    found = follow(layout, start, end, poses, tight=FIRST_CORRECTION, most=PATH_STEPS)
    again = np.flatnonzero(~found.arrived)
    if len(again):
        second = follow(
            layout, start, end, poses[again], tight=RETRACED_CORRECTION, most=RETRACED_PATH_STEPS
        )
        found.poses[again], found.ends[again] = second.poses, second.ends
        found.numbers[again] = second.numbers
    return found


def around(
    start: Start, poses: Complex, corners: list[Complex], *, patient: bool = False
) -> Complex:
    """Return the ends of paths around a loop of parameters.

    Paths that are lost are left out; if `patient`, they are followed again with shorter steps.
    """
    for here, there in pairwise([start.parameters, *corners, start.parameters]):
        if patient:
            found = followed(start.layout, here, there, poses)
        else:
            found = follow(
                start.layout, here, there, poses, tight=FIRST_CORRECTION, most=PATH_STEPS
            )
        poses = found.poses[found.arrived]
    return poses


def seeded(layout: Layout, rng: np.random.Generator) -> Start:
    """Return random parameters with one pose, from which the last parameter of each row follows."""
    parameters = layout.random(rng)
    pose = normal(rng, 1, 7)
    pose[:, :4] /= np.sqrt((pose[:, :4] ** 2).sum())
    parameters[:, 12] = values(layout, parameters, pose[0])
    return Start(layout=layout, parameters=parameters, poses=pose, loops=0)


def values(layout: Layout, parameters: Complex, pose: Complex) -> Complex:
    """Return the last parameter of each row with which a pose solves the equations, (6,)."""
    pairs = [
        [residual(form, [*row[:12], value], pose) for value in (0.0, 1.0)]
        for form, row in zip(layout.forms, parameters, strict=True)
    ]
    zero, one = np.array(pairs).T
    return np.asarray(zero / (zero - one))


def solved(
    layout: Layout,
    rng: np.random.Generator,
    *,
    expected: int | None = None,
    quiet: int = QUIET_LOOPS,
) -> Start:
    """Return a generic system with its solutions; see `completed`."""
    return completed(seeded(layout, rng), rng, expected=expected, quiet=quiet)


def completed(
    start: Start,
    rng: np.random.Generator,
    *,
    expected: int | None = None,
    quiet: int = QUIET_LOOPS,
    patient: bool = False,
) -> Start:
    """Return a system with more of its solutions, by loops of its parameters.

    The poses and parameters that satisfy the equations are the graph of a function: the last
    parameter of each row follows from the pose and the rest. So they are one irreducible variety,
    and loops of the parameters lead from one solution to all. The loops end as soon as `expected`
    solutions are known, or after `quiet` loops without a new one. `patient`: as for `around`.
    """
    layout, without = start.layout, 0
    while len(start.poses) != expected and without < quiet and start.loops < MOST_LOOPS:
        corners = [layout.random(rng), layout.random(rng)]
        ends = around(start, start.poses, corners, patient=patient)
        both = np.vstack((start.poses, ends))
        kept = both[distinct(both)]
        without = 0 if len(kept) > len(start.poses) else without + 1
        start = replace(start, poses=kept, loops=start.loops + 1)
    return start


@lru_cache(maxsize=64)
def start_of(legs: tuple[str, ...], expected: int | None, seed: int = 1) -> Start:
    """Return the generic system of legs; made once in a process.

    Some systems have solutions so badly conditioned that loops do not come to them. If there are
    fewer than `expected`, the system of another seed is taken, and that with most solutions if none
    has as many.
    """
    best = solved(Layout.of(legs), np.random.default_rng(seed), expected=expected)
    for other in range(seed + 1, seed + MOST_SYSTEMS):
        if expected is None or len(best.poses) >= expected:
            break
        start = solved(best.layout, np.random.default_rng(other), expected=expected)
        best = max(best, start, key=lambda system: len(system.poses))
    return best


def trace(start: Start, rng: np.random.Generator, *, angles: bool = False) -> float:
    """Return how far the sum of all solutions is from a linear function of the parameters.

    The squared distances (or cosines, with `angles`) move on a line k + λ c, with λ once around the
    unit circle. If the solutions are complete, their sum is a polynomial of λ; here it is linear.
    If some are missing, the sum of the others has branch points. So the Fourier coefficients of the
    sum but those of 1 and λ vanish if the solutions are complete. One that is missing may be nearly
    linear in λ: then they are small, of 1e-7 in two cases that are known.

    Parameters
    ----------
    start : Start
    rng : numpy.random.Generator
    angles : bool
        Move the cosines, and sum the rotations only: positions may have poles.

    Returns
    -------
    float [1]
        The largest coefficient that should vanish, as a share of the number of solutions; inf if
        paths were lost.

    *Source: the linear trace test of Sommese, Verschelde and Wampler.*
    """
    layout = start.layout
    moved = np.zeros((6, 13), np.complex128)
    moved[:, 12] = normal(rng, 6) * (layout.angular if angles else layout.moved)
    circle = np.exp(2j * np.pi * np.arange(TRACE_POINTS) / TRACE_POINTS)
    here, poses, sums = start.parameters, start.poses, []
    for factor in circle:
        there = start.parameters + factor * moved
        found = followed(layout, here, there, poses)
        if not found.arrived.all():
            return float("inf")
        here, poses = there, found.poses
        sums.append(coordinates(poses)[:, : 9 if angles else 12].sum(axis=0))
    coefficients = np.fft.fft(np.array(sums), axis=0) / TRACE_POINTS
    return float(np.abs(coefficients[2:]).max() / len(poses))
