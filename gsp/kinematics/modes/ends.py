"""Which solutions the ends of paths are: regular ones, multiple ones, and those at infinity."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kinematics.modes.clearance import Clearances
from gsp.kinematics.modes.clusters import clustered, told_apart
from gsp.kinematics.modes.equations import (
    SAME_POSE_SHARE,
    Complex,
    Layout,
    coordinates,
    distinct,
    linear,
    normal,
    refined,
)
from gsp.kinematics.modes.starts import (
    FIRST_CORRECTION,
    LAST_CORRECTION,
    PATH_STEPS,
    RETRACED_CORRECTION,
    RETRACED_PATH_STEPS,
    Paths,
    Start,
    follow,
    followed,
)

# Share of the line that is left at most at the end of a path to a multiple solution, and of one to
# infinity.
NEAR_END, NEAR_INFINITY = 1e-4, 1e-3
# Size of a pose above which its path may diverge. Its growth is measured where LEFT_FACTORS times
# what is left at its end is left of the line (or LEFT_FACTORS times LEAST_LEFT, if that is more).
# There the size grows with a constant power of what is left, of at least LEAST_POWER: the second
# power is at least STEADY_SHARE of the first. At a finite end the power tends to zero.
LARGE_POSE_SIZE = 100.0
LEFT_FACTORS = (64.0, 16.0, 4.0)
LEAST_LEFT = 1e-6
LEAST_POWER = 0.1
STEADY_SHARE = 0.7
# Smallest singular value of a pose beside a multiple solution, which is reached with about half of
# the digits, as a share of the largest one.
NEARLY_REGULAR_SHARE = 1e-4
# Other general systems from which paths are followed if those of the first are lost or diverge, and
# how many random ones are tried for each.
OTHER_SYSTEMS, OTHER_ATTEMPTS, OTHER_SEED = 6, 4, 40
# Step along a possible motion, how many are tried from each pose, Newton steps back to the
# solutions, and their largest residual there, as a share of the size of the pose; the least norm of
# the real part of a quaternion that counts.
MOTION_STEP, MOTION_TRIES, RETURN_STEPS, MOTION_RESIDUAL, LEAST_REAL = 1e-2, 4, 20, 3e-11, 1e-3
# Least singular values that count on the way back, as shares of the greatest one, in turn.
LEAST_VALUES = (1e-5, 1e-7)
# Share of a step that is left of it where the solutions are on a curve.
LEAST_MOVED_SHARE = 0.3
# Random real poses from which real solutions are looked for.
REAL_STARTS = 60
# Residual below which a singular pose is a solution.
SINGULAR_RESIDUAL = 1e-9
# Imaginary part below which a pose may be real, and how far Newton's method may move it then.
IMAGINARY_TOLERANCE, REAL_MOVE_TOLERANCE = 1e-6, 1e-4


@dataclass(frozen=True, eq=False, kw_only=True)
class Ends:
    """The solutions of a system.

    Attributes
    ----------
    poses : (n, 7) complex array
        Each once.
    beside : (n,) bool array
        Which of them are beside others, from which they were told apart; of these the real ones
        have no imaginary part.
    singular : (n,) bool array
        Which of them are not regular: they are multiple, or lie on curves.
    multiplicity : (n,) int array
        Numbers of paths that ended there.
    at_infinity, lost : int
        Numbers of paths that diverged, and of those of which nothing is known.
    excess : int
        Solutions that were found beyond the number of paths; the number of the general system is
        wrong if there are any.
    moving : bool
        Whether a curve of real solutions is found near a multiple one.
    curved : bool
        Whether a multiple one lies on a curve of complex solutions, and no real one is found.
    """

    poses: Complex
    beside: NDArray[np.bool_]
    singular: NDArray[np.bool_]
    multiplicity: NDArray[np.int64]
    at_infinity: int
    lost: int
    excess: int
    moving: bool
    curved: bool


@dataclass(frozen=True, eq=False, kw_only=True)
class _Route:
    """Ends of all paths from one general system.

    Regular solutions with their clearances, singular poses, shares of the line that were left at
    these, and how many diverged.
    """

    regular: Complex
    clear: Clearances
    singular: Complex
    left: Array
    diverged: int


def ends_of(start: Start, parameters: Complex, expected: int | None = None) -> Ends:
    """Return the solutions of the equations with parameters (6, 13).

    If more solutions of the general system are expected than it has, the rest count as lost paths.

    Regular solutions of all routes are put together: each is a solution, however it was found. A
    path that ends at the regular solution of another one has jumped to that path, and is lost.
    Where paths diverge a second route is followed: solutions that it finds in addition are not at
    infinity.
    """
    layout, total = start.layout, max(len(start.poses), expected or 0)
    routes = [_route(start, parameters)]
    ends = _together(layout, parameters, routes, total)
    for number in range(OTHER_SYSTEMS):
        settled = not ends.lost and (len(routes) > 1 or not ends.at_infinity)
        if settled or ends.moving:
            break
        other = other_system(start, number)
        if other is not None:
            routes.append(_route(other, parameters))
            ends = _together(layout, parameters, routes, total)
    return ends


@lru_cache(maxsize=128)
def other_system(start: Start, number: int) -> Start | None:
    """Return another general system with as many solutions; None if paths to all tried were lost.

    The systems of two numbers differ.
    """
    for attempt in range(OTHER_ATTEMPTS):
        parameters = start.layout.random(np.random.default_rng([OTHER_SEED, number, attempt]))
        found = followed(start.layout, start.parameters, parameters, start.poses)
        if found.arrived.all() and len(distinct(found.poses)) == len(start.poses):
            return replace(start, parameters=parameters, poses=found.poses)
    return None


def _route(start: Start, parameters: Complex) -> _Route:
    layout = start.layout
    found = follow(
        layout, start.parameters, parameters, start.poses, tight=FIRST_CORRECTION, most=PATH_STEPS
    )
    diverged = _diverged(start, parameters, found)
    doubtful = ~found.arrived & ~diverged
    clear = Clearances.of(layout, parameters, found.poses)
    doubtful |= _clashing(found, clear)
    if doubtful.any():
        _again(start, parameters, found, np.flatnonzero(doubtful))
        diverged |= _diverged(start, parameters, found)
        clear = Clearances.of(layout, parameters, found.poses)
    regular = found.arrived & clear.regular
    left = found.numbers[:, 1]
    near = ~regular & ~diverged & (found.arrived | (left < NEAR_END))
    near[near] = _singular_beside(layout, parameters, found.poses[near])
    places = np.flatnonzero(regular)
    places = places[_each_once(found.poses[places], clear[places])]
    return _Route(
        regular=found.poses[places],
        clear=clear[places],
        singular=found.poses[near],
        left=left[near],
        diverged=int(diverged.sum()),
    )


def _together(layout: Layout, parameters: Complex, routes: list[_Route], total: int) -> Ends:
    """Return the solutions of routes: their regular ones, and the singular ones of the last."""
    last = routes[-1]
    regular = np.vstack([route.regular for route in reversed(routes)])
    clear = last.clear if len(routes) == 1 else Clearances.of(layout, parameters, regular)
    once = _each_once(regular, clear)
    regular, others = regular[once], once >= len(last.regular)
    found = told_apart(layout, parameters, regular, others, *clustered(last.singular, last.left))
    regular, clusters, numbers = found.regular, found.clusters, found.numbers
    known = len(regular) + int(numbers.sum())
    moving = moves(layout, parameters, clusters)
    infinite = max(min(max(route.diverged for route in routes), total - known), 0)
    return Ends(
        poses=np.vstack((regular, clusters)),
        beside=np.concatenate((found.beside, np.zeros(len(clusters), dtype=bool))),
        singular=np.repeat([False, True], [len(regular), len(clusters)]),
        multiplicity=np.concatenate((np.ones(len(regular), dtype=np.int64), numbers)),
        at_infinity=infinite,
        lost=max(total - known - infinite, 0),
        excess=max(known - total, 0),
        moving=moving,
        curved=not moving and bool(on_curves(layout, parameters, clusters).any()),
    )


def _size(poses: Complex) -> Array:
    """Return the sizes of rotations and positions, (n,)."""
    sizes = np.abs(poses)
    turns, places = sizes[:, :4].max(axis=1, initial=0.0), sizes[:, 4:].max(axis=1, initial=0.0)
    return np.asarray(np.maximum(turns**2, places))


def _diverged(start: Start, parameters: Complex, found: Paths) -> NDArray[np.bool_]:
    """Whether the sizes of paths grow with a constant power of what is left of the line, (n,)."""
    left = found.numbers[:, 1]
    diverged = ~found.arrived & (left < NEAR_INFINITY) & (_size(found.poses) > LARGE_POSE_SIZE)
    for i in np.flatnonzero(diverged):
        diverged[i] = _grows(start, parameters, start.poses[i], max(left[i], LEAST_LEFT))
    return np.asarray(diverged)


def _grows(start: Start, parameters: Complex, pose: Complex, left: float) -> bool:
    sizes = []
    for factor in LEFT_FACTORS:
        there = parameters + factor * left * (start.parameters - parameters)
        found = followed(start.layout, start.parameters, there, pose[None])
        if found.ends[0] != 0:
            return False
        sizes.append(_size(found.poses)[0])
    first, second = np.diff(np.log(sizes)) / -np.diff(np.log(LEFT_FACTORS))
    return bool(second > LEAST_POWER and second > STEADY_SHARE * first)


def _singular_beside(layout: Layout, parameters: Complex, poses: Complex) -> NDArray[np.bool_]:
    """Whether there are singular solutions beside poses (m, 7)."""
    if not len(poses):
        return np.zeros(0, dtype=bool)
    _, error, values = returned(layout, parameters, poses)
    return np.asarray(
        (error < SINGULAR_RESIDUAL) & (values[:, -1] < NEARLY_REGULAR_SHARE * values[:, 0])
    )


def _each_once(poses: Complex, clear: Clearances) -> NDArray[np.int64]:
    """Return the places of solutions (m, 7) that differ from all before them, ascending."""
    return distinct(poses, clear.within(SAME_POSE_SHARE))


def _clashing(found: Paths, clear: Clearances) -> NDArray[np.bool_]:
    """Whether a path came to the solution of another one, (n,)."""
    same, arrived = np.zeros(len(found.poses), dtype=bool), np.flatnonzero(found.arrived)
    poses, reach = found.poses[arrived], clear[arrived].within(SAME_POSE_SHARE)
    kept = distinct(poses, reach)
    if len(kept) < len(arrived):
        points = coordinates(poses)
        for i in np.setdiff1d(np.arange(len(arrived)), kept):
            same[arrived] |= np.abs(points - points[i]).max(axis=1) < 10.0 * reach[i]
    return same


def _again(start: Start, parameters: Complex, found: Paths, paths: NDArray[np.int64]) -> None:
    """Trace paths again with shorter steps."""
    second = follow(
        start.layout,
        start.parameters,
        parameters,
        start.poses[paths],
        tight=RETRACED_CORRECTION,
        most=RETRACED_PATH_STEPS,
    )
    found.poses[paths], found.ends[paths] = second.poses, second.ends
    found.numbers[paths] = second.numbers


def returned(
    layout: Layout, parameters: Complex, poses: Complex, least: float = LEAST_VALUES[0]
) -> tuple[Complex, Array, Array]:
    """Return the solutions near poses (m, 7) by Newton's method with least steps.

    Singular values below the share `least` of the greatest one do not count.

    Returns
    -------
    poses : (m, 7) complex array
    error : (m,) array
        Last residuals.
    values : (m, 7) array
        Singular values there.
    """
    poses = poses.copy()
    for _ in range(RETURN_STEPS):
        error, slopes = linear(layout, parameters, poses)
        poses -= (np.linalg.pinv(slopes, rcond=least) @ error[..., None])[..., 0]
    error, slopes = linear(layout, parameters, poses)
    values = np.linalg.svd(slopes, compute_uv=False)
    return poses, np.asarray(np.abs(error).max(axis=1, initial=0.0)), np.asarray(values)


def _settled(layout: Layout, parameters: Complex, poses: Complex) -> tuple[Complex, Array, Array]:
    """Return what `returned` does, with smaller singular values as well in a second search.

    On a curve of double solutions the first search ends beside the curve.
    """
    for least in LEAST_VALUES:
        poses, error, values = returned(layout, parameters, poses, least)
    return poses, error, values


def moves(layout: Layout, parameters: Complex, poses: Complex) -> bool:
    """Whether a curve of real solutions is found near the real parts of solutions (m, 7).

    `on_curves` starts from these, and from random real poses as far away.
    """
    if not len(poses):
        return False
    rng = np.random.default_rng(0)
    size = float(np.median(np.abs(poses[:, 4:]).max(axis=1)))
    drawn = rng.standard_normal((REAL_STARTS, 7)) * np.repeat([1.0, size], [4, 3])
    here = np.vstack((poses.real, drawn)).astype(np.complex128)
    here[:, :4] /= np.maximum(np.linalg.norm(here[:, :4], axis=1, keepdims=True), LEAST_REAL)
    return bool(on_curves(layout, parameters, here).any())


def on_curves(layout: Layout, parameters: Complex, poses: Complex) -> NDArray[np.bool_]:
    """Whether the solutions next to poses (m, 7) lie on curves of them, (m,); of real ones if real.

    Newton's method with least steps leads to these solutions. From singular ones a step along the
    kernel is taken, and the method leads back to solutions: to the same one if it is isolated, and
    to one that is singular again if it is not. All of them are computed together: degenerate joint
    values have hundreds of singular solutions.
    """
    found = np.zeros(len(poses), dtype=bool)
    if not len(poses):
        return found
    here, error, spread = _settled(layout, parameters, poses)
    rank = (spread > NEARLY_REGULAR_SHARE * spread[:, :1]).sum(axis=1)
    chosen = np.flatnonzero((error < MOTION_RESIDUAL * _size(here)) & (rank < 7))
    if not chosen.size:
        return found
    tried = np.repeat(chosen, MOTION_TRIES)
    here, rank = here[tried], rank[tried]
    slopes = linear(layout, parameters, here)[1]
    real = not here.imag.any()
    kernels = np.linalg.svd(slopes.real if real else slopes)[2].conj()
    rng = np.random.default_rng(0)
    step = [_along(kernel[r:], rng, real=real) for kernel, r in zip(kernels, rank, strict=True)]
    there, error, spread = _settled(layout, parameters, here + np.array(step))
    solutions = error < MOTION_RESIDUAL * _size(there)
    apart = np.linalg.norm(there - here, axis=1) > LEAST_MOVED_SHARE * MOTION_STEP
    moved = solutions & apart & (spread[:, -1] < LEAST_VALUES[-1] * spread[:, 0])
    found[chosen] = moved.reshape(-1, MOTION_TRIES).any(axis=1)
    return found


def _along(kernel: Complex, rng: np.random.Generator, *, real: bool) -> Complex:
    """Return a step within a kernel, whose rows (k, 7) are mixed."""
    drawn = normal(rng, len(kernel))
    mixed = (drawn.real if real else drawn) @ kernel
    return np.asarray(MOTION_STEP * mixed / np.linalg.norm(mixed))


def _newton(
    layout: Layout, parameters: Complex, poses: Complex, clear: Clearances
) -> tuple[Complex, NDArray[np.bool_]]:
    """Return the ends of Newton's method from poses (m, 7), and whether it converged, (m,)."""
    found = follow(layout, parameters, parameters, poses, tight=FIRST_CORRECTION, most=PATH_STEPS)
    ends, arrived = found.poses, found.arrived.copy()
    weak = np.isfinite(clear.distances)
    if weak.any():
        ends[weak], last = refined(layout, parameters, poses[weak])
        arrived[weak] = last < LAST_CORRECTION
    return ends, arrived


def real_poses(layout: Layout, parameters: Complex, ends: Ends) -> tuple[Array, NDArray[np.int64]]:
    """Return the real solutions, (m, 7), refined, and their places among the solutions.

    Regular ones are real if they are nearer to the real poses than to other solutions, and Newton's
    method in real numbers converges beside them; those beside each other as they were told apart.
    """
    imaginary, size = (np.abs(z).max(axis=1, initial=0.0) for z in (ends.poses.imag, ends.poses))
    places = np.flatnonzero(imaginary < REAL_MOVE_TOLERANCE * size)
    clear = Clearances.of(layout, parameters, ends.poses[places])
    small = np.where(ends.beside[places], 0.0, clear.within(IMAGINARY_TOLERANCE))
    real = ends.singular[places] | (imaginary[places] <= small)
    places, clear = places[real], clear[real]
    poses, singular = ends.poses[places].real.astype(np.complex128), ends.singular[places]
    kept = ends.beside[places]
    free = ~singular & ~kept
    refined, arrived = _newton(layout, parameters, poses[free], clear[free])
    moved = np.abs(refined - poses[free]).max(axis=1, initial=0.0)
    near = moved < clear[free].within(REAL_MOVE_TOLERANCE)
    kept[free], poses[free] = near & arrived, refined
    if singular.any():
        poses[singular], error, _ = returned(layout, parameters, poses[singular])
        flat = np.abs(poses[singular].imag).max(axis=1) < IMAGINARY_TOLERANCE
        kept[singular] = (error < SINGULAR_RESIDUAL) & flat
    return poses[kept].real, places[kept]
