"""Which solutions the ends of paths are: regular ones, multiple ones, and those at infinity."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kinematics.modes.beside import told_apart
from gsp.kinematics.modes.equations import (
    Complex,
    Layout,
    coordinates,
    distinct,
    linear,
    normal,
)
from gsp.kinematics.modes.starts import (
    FIRST_CORRECTION,
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
# Smallest singular value of a regular solution as a share of the largest one, of equations and
# unknowns in their own scales; and of a pose beside a multiple solution, which is reached with
# about half of the digits.
REGULAR_SHARE, NEARLY_REGULAR_SHARE = 1e-9, 1e-4
# Distance below which two multiple solutions are one.
SAME_MULTIPLE = 1e-2
# Other general systems from which paths are followed if those of the first are lost or diverge.
OTHER_SYSTEMS = 4
# Step along a possible motion, and Newton steps back to the solutions.
MOTION_STEP, RETURN_STEPS = 1e-2, 20
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
        Whether a multiple solution lies on a curve of solutions.
    """

    poses: Complex
    beside: NDArray[np.bool_]
    singular: NDArray[np.bool_]
    multiplicity: NDArray[np.int64]
    at_infinity: int
    lost: int
    excess: int
    moving: bool


@dataclass(frozen=True, eq=False, kw_only=True)
class _Route:
    """Ends of all paths from one general system: regular solutions, singular poses, diverged."""

    regular: Complex
    singular: Complex
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
    for seed in range(OTHER_SYSTEMS):
        settled = not ends.lost and (len(routes) > 1 or not ends.at_infinity)
        if settled or ends.moving:
            break
        other = other_system(start, seed)
        if other is not None:
            routes.append(_route(other, parameters))
            ends = _together(layout, parameters, routes, total)
    return ends


@lru_cache(maxsize=128)
def other_system(start: Start, seed: int) -> Start | None:
    """Return another general system with as many solutions; None if paths to it were lost."""
    parameters = start.layout.random(np.random.default_rng(seed))
    found = followed(start.layout, start.parameters, parameters, start.poses)
    if not found.arrived.all() or len(distinct(found.poses)) < len(start.poses):
        return None
    return replace(start, parameters=parameters, poses=found.poses)


def _route(start: Start, parameters: Complex) -> _Route:
    layout = start.layout
    found = follow(
        layout, start.parameters, parameters, start.poses, tight=FIRST_CORRECTION, most=PATH_STEPS
    )
    diverged = _diverged(start, parameters, found)
    doubtful = ~found.arrived & ~diverged | clashing(found)
    if doubtful.any():
        _again(start, parameters, found, np.flatnonzero(doubtful))
        diverged |= _diverged(start, parameters, found)
    left = found.numbers[:, 1]
    regular = found.arrived & is_regular(layout, parameters, found.poses)
    near = ~regular & ~diverged & (found.arrived | (left < NEAR_END))
    near[near] = _singular_beside(layout, parameters, found.poses[near])
    poses = found.poses[regular]
    return _Route(
        regular=poses[distinct(poses)],
        singular=found.poses[near],
        diverged=int(diverged.sum()),
    )


def _together(layout: Layout, parameters: Complex, routes: list[_Route], total: int) -> Ends:
    """Return the solutions of routes: their regular ones, and the singular ones of the last."""
    regular = np.vstack([route.regular for route in routes])
    regular = regular[distinct(regular)]
    shares = regular_shares(layout, parameters, regular)
    last = routes[-1].regular
    found = told_apart(layout, parameters, regular, shares, last, *_clusters(routes[-1].singular))
    regular, clusters, numbers = found.regular, found.clusters, found.numbers
    known = len(regular) + int(numbers.sum())
    infinite = max(min(max(route.diverged for route in routes), total - known), 0)
    return Ends(
        poses=np.vstack((regular, clusters)),
        beside=np.concatenate((found.beside, np.zeros(len(clusters), dtype=bool))),
        singular=np.repeat([False, True], [len(regular), len(clusters)]),
        multiplicity=np.concatenate((np.ones(len(regular), dtype=np.int64), numbers)),
        at_infinity=infinite,
        lost=max(total - known - infinite, 0),
        excess=max(known - total, 0),
        moving=bool(moves(layout, parameters, clusters).any()),
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


def is_regular(layout: Layout, parameters: Complex, poses: Complex) -> NDArray[np.bool_]:
    """Whether the derivatives at poses (m, 7) have full rank, in the scales of rows and columns."""
    return np.asarray(regular_shares(layout, parameters, poses) > REGULAR_SHARE)


def regular_shares(layout: Layout, parameters: Complex, poses: Complex) -> Array:
    """Return the smallest singular value at poses (m, 7) as a share of the largest one, (m,).

    Of derivatives in the scales of rows and columns; 0 where these are not defined.
    """
    slopes = linear(layout, parameters, poses)[1]
    with np.errstate(invalid="ignore", divide="ignore"):
        for axis in (2, 1, 2):
            slopes = slopes / np.linalg.norm(slopes, axis=axis, keepdims=True)
    defined = np.asarray(np.isfinite(slopes).all(axis=(1, 2)))
    values = np.linalg.svd(slopes[defined], compute_uv=False)
    shares = np.zeros(len(poses))
    shares[defined] = values[:, -1] / values[:, 0]
    return shares


def _singular_beside(layout: Layout, parameters: Complex, poses: Complex) -> NDArray[np.bool_]:
    """Whether there are singular solutions beside poses (m, 7)."""
    if not len(poses):
        return np.zeros(0, dtype=bool)
    _, error, values = returned(layout, parameters, poses)
    return np.asarray(
        (error < SINGULAR_RESIDUAL) & (values[:, -1] < NEARLY_REGULAR_SHARE * values[:, 0])
    )


def clashing(found: Paths) -> NDArray[np.bool_]:
    """Whether a path came to the solution of another one, (n,)."""
    same, arrived = np.zeros(len(found.poses), dtype=bool), np.flatnonzero(found.arrived)
    kept = distinct(found.poses[arrived])
    if len(kept) < len(arrived):
        points = coordinates(found.poses[arrived])
        for i in np.setdiff1d(np.arange(len(arrived)), kept):
            apart = np.abs(points - points[i]).max(axis=1)
            same[arrived[apart < 1e-5 * np.abs(points[i]).max()]] = True
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


def _clusters(poses: Complex) -> tuple[Complex, NDArray[np.int64]]:
    """Return the first pose of each cluster, and the numbers of poses."""
    points, waiting = coordinates(poses), np.ones(len(poses), dtype=bool)
    kept, numbers = [], []
    for i in range(len(poses)):
        if waiting[i]:
            apart = np.abs(points - points[i]).max(axis=1)
            near = waiting & (apart < SAME_MULTIPLE * max(1.0, np.abs(points[i]).max()))
            waiting[near] = False
            kept.append(poses[i])
            numbers.append(near.sum())
    return np.array(kept).reshape(-1, 7), np.array(numbers, dtype=np.int64)


def returned(layout: Layout, parameters: Complex, poses: Complex) -> tuple[Complex, Array, Array]:
    """Return the solutions near poses (m, 7) by Newton's method with least steps.

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
        poses -= (np.linalg.pinv(slopes, rcond=1e-5) @ error[..., None])[..., 0]
    error, slopes = linear(layout, parameters, poses)
    values = np.linalg.svd(slopes, compute_uv=False)
    return poses, np.asarray(np.abs(error).max(axis=1, initial=0.0)), np.asarray(values)


def moves(layout: Layout, parameters: Complex, poses: Complex) -> NDArray[np.bool_]:
    """Whether singular solutions (m, 7) lie on curves of solutions, (m,).

    A step along the kernel is taken, and Newton's method with least steps leads back to solutions:
    to the same one if it is isolated, and to one that is singular again if it is not. All of them
    are computed together: degenerate joint values have hundreds of singular solutions.
    """
    if not len(poses):
        return np.zeros(0, dtype=bool)
    here, error, spread = returned(layout, parameters, poses)
    rank = (spread > NEARLY_REGULAR_SHARE * spread[:, :1]).sum(axis=1)
    chosen = np.flatnonzero((error < SINGULAR_RESIDUAL) & (rank < 7))
    if not chosen.size:
        return np.zeros(len(poses), dtype=bool)
    here, rank = here[chosen], rank[chosen]
    kernels = np.linalg.svd(linear(layout, parameters, here)[1])[2].conj()
    step = np.array([_along(kernel[r:]) for kernel, r in zip(kernels, rank, strict=True)])
    poses_after, error, spread = returned(layout, parameters, here + step)
    apart = np.linalg.norm(poses_after - here, axis=1)
    moving = np.zeros(len(poses), dtype=bool)
    moving[chosen] = (
        (error < SINGULAR_RESIDUAL)
        & (apart > 0.3 * MOTION_STEP)
        & (spread[:, -1] < 1e-6 * spread[:, 0])
    )
    return moving


def _along(kernel: Complex) -> Complex:
    """Return a step within a kernel, whose rows (k, 7) are mixed."""
    mixed = normal(np.random.default_rng(0), len(kernel)) @ kernel
    return np.asarray(MOTION_STEP * mixed / np.linalg.norm(mixed))


def real_poses(layout: Layout, parameters: Complex, ends: Ends) -> tuple[Array, NDArray[np.int64]]:
    """Return the real solutions, (m, 7), refined, and their places among the solutions.

    Newton's method in real numbers decides of regular solutions, and how they were told apart of
    those beside each other.
    """
    size = np.abs(ends.poses).max(axis=1, initial=1.0, keepdims=True)
    small = np.where(ends.singular, REAL_MOVE_TOLERANCE, IMAGINARY_TOLERANCE)
    imaginary = (np.abs(ends.poses.imag) / size).max(axis=1, initial=0.0)
    places = np.flatnonzero(np.where(ends.beside, imaginary == 0.0, imaginary < small))
    poses, singular = ends.poses[places].real.astype(np.complex128), ends.singular[places]
    kept = ends.beside[places]
    free = ~singular & ~kept
    refined = follow(
        layout, parameters, parameters, poses[free], tight=FIRST_CORRECTION, most=PATH_STEPS
    )
    moved = np.abs(refined.poses - poses[free]).max(axis=1, initial=0.0)
    near = moved < REAL_MOVE_TOLERANCE * size[places][free, 0]
    kept[free], poses[free] = near & refined.arrived, refined.poses
    if singular.any():
        poses[singular], error, _ = returned(layout, parameters, poses[singular])
        flat = np.abs(poses[singular].imag).max(axis=1) < IMAGINARY_TOLERANCE
        kept[singular] = (error < SINGULAR_RESIDUAL) & flat
    return poses[kept].real, places[kept]
