"""Which solutions the ends of paths are: regular ones, multiple ones, and those at infinity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kinematics.modes.equations import (
    Complex,
    Layout,
    coordinates,
    distinct,
    linear,
    normal,
)
from gsp.kinematics.modes.starts import (
    PATH_STEPS,
    RETRACED_PATH_STEPS,
    TIGHT,
    TIGHTER,
    Paths,
    Start,
    follow,
)

# Share of the line that is left at most at the end of a path to a multiple solution. Its end is
# taken to lie at infinity if the pose is larger than FAR_AT_END; where the quaternion is, rounding
# ends the path earlier.
NEAR_END, NEAR_INFINITY, FAR_AT_END = 1e-4, 1e-2, 100.0
# Distance below which two multiple solutions are one.
SAME_MULTIPLE = 1e-2
# Other parameters through which lost paths are followed.
CORNERS = 4
# Step along a possible motion, and Newton steps back to the solutions.
MOTION, BACK = 1e-2, 20
# Residual below which a singular pose is a solution.
SOLVED = 1e-9
# Imaginary part below which a pose may be real, and how far Newton's method may move it then.
REAL, MOVED = 1e-6, 1e-4


@dataclass(frozen=True, eq=False, kw_only=True)
class Ends:
    """The solutions of a system.

    Attributes
    ----------
    poses : (n, 7) complex array
        Each once.
    singular : (n,) bool array
        Which of them are not regular: they are multiple, or lie on curves.
    multiplicity : (n,) int array
        Numbers of paths that ended there.
    at_infinity, lost : int
        Numbers of paths that diverged, and of those of which nothing is known.
    moving : bool
        Whether a multiple solution lies on a curve of solutions.
    """

    poses: Complex
    singular: NDArray[np.bool_]
    multiplicity: NDArray[np.int64]
    at_infinity: int
    lost: int
    moving: bool


def ends_of(start: Start, parameters: Complex) -> Ends:
    """Return the solutions of the equations with parameters (6, 13)."""
    found = follow(
        start.layout, start.parameters, parameters, start.poses, tight=TIGHT, most=PATH_STEPS
    )
    doubtful = ~found.arrived & ~_diverged(found) | clashing(found)
    if doubtful.any():
        _again(start, parameters, found, np.flatnonzero(doubtful))
    if _lost(found).any():
        found = _through_corners(start, parameters, found)
    return _sorted(start.layout, parameters, found)


def _diverged(found: Paths) -> NDArray[np.bool_]:
    sizes, left = np.abs(found.poses), found.numbers[:, 1]
    far = (sizes.max(axis=1, initial=0.0) > FAR_AT_END) & (left < NEAR_END)
    far |= (sizes[:, :4].max(axis=1, initial=0.0) > FAR_AT_END) & (left < NEAR_INFINITY)
    return np.asarray(~found.arrived & far)


def _lost(found: Paths) -> NDArray[np.bool_]:
    return np.asarray(~found.arrived & ~_diverged(found) & (found.numbers[:, 1] > NEAR_END))


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
        tight=TIGHTER,
        most=RETRACED_PATH_STEPS,
    )
    found.poses[paths], found.ends[paths] = second.poses, second.ends
    found.numbers[paths] = second.numbers


def _through_corners(start: Start, parameters: Complex, found: Paths) -> Paths:
    """Return the ends of all paths through other parameters, if fewer of them are lost."""
    layout, best = start.layout, found
    for seed in range(CORNERS):
        corner = layout.random(np.random.default_rng(seed))
        half = follow(layout, start.parameters, corner, start.poses, tight=TIGHT, most=PATH_STEPS)
        if half.arrived.all():
            other = follow(layout, corner, parameters, half.poses, tight=TIGHT, most=PATH_STEPS)
            if _lost(other).sum() < _lost(best).sum() and not clashing(other).any():
                best = other
        if not _lost(best).any():
            break
    return best


def _sorted(layout: Layout, parameters: Complex, found: Paths) -> Ends:
    lost, diverged, clash = _lost(found), _diverged(found), clashing(found)
    regular = found.arrived & ~clash
    clusters, numbers = _clusters(found.poses[~regular & ~lost & ~diverged])
    return Ends(
        poses=np.vstack((found.poses[regular], clusters)),
        singular=np.repeat([False, True], [regular.sum(), len(clusters)]),
        multiplicity=np.concatenate((np.ones(regular.sum(), dtype=np.int64), numbers)),
        at_infinity=int(diverged.sum()),
        lost=int(lost.sum()),
        moving=any(moves(layout, parameters, pose) for pose in clusters),
    )


def _clusters(poses: Complex) -> tuple[Complex, NDArray[np.int64]]:
    """Return one pose of each cluster, the mean, and the numbers of poses."""
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


def returned(layout: Layout, parameters: Complex, pose: Complex) -> tuple[Complex, float, Array]:
    """Return the solution near a pose by Newton's method with least steps.

    Returns
    -------
    pose : (7,) complex array
    error : float
        Last residual.
    values : (7,) array
        Singular values there.
    """
    pose = pose.copy()
    for _ in range(BACK):
        error, slopes = linear(layout, parameters, pose[None])
        pose -= np.linalg.pinv(slopes[0], rcond=1e-5) @ error[0]
    error, slopes = linear(layout, parameters, pose[None])
    return pose, float(np.abs(error).max()), np.linalg.svd(slopes[0], compute_uv=False)


def moves(layout: Layout, parameters: Complex, pose: Complex) -> bool:
    """Whether a singular solution lies on a curve of solutions.

    A step along the kernel is taken, and Newton's method with least steps leads back to solutions:
    to the same one if it is isolated, and to one that is singular again if it is not.
    """
    here, error, values = returned(layout, parameters, pose)
    if not error < SOLVED:
        return False
    kernel = np.linalg.svd(linear(layout, parameters, here[None])[1][0])[2].conj()
    rank = int((values > 1e-4 * values[0]).sum())
    if rank == 7:
        return False
    mixed = normal(np.random.default_rng(0), 7 - rank) @ kernel[rank:]
    step = MOTION * mixed / np.linalg.norm(mixed)
    there, error, values = returned(layout, parameters, here + step)
    apart = np.linalg.norm(there - here)
    return bool(error < SOLVED and apart > 0.3 * MOTION and values[-1] < 1e-6 * values[0])


def real_poses(layout: Layout, parameters: Complex, ends: Ends) -> tuple[Array, NDArray[np.int64]]:
    """Return the real solutions, (m, 7), refined, and their places among the solutions."""
    size = np.abs(ends.poses).max(axis=1, initial=1.0, keepdims=True)
    small = np.where(ends.singular, MOVED, REAL)
    places = np.flatnonzero((np.abs(ends.poses.imag) / size).max(axis=1, initial=0.0) < small)
    poses, singular = ends.poses[places].real.astype(np.complex128), ends.singular[places]
    kept = np.zeros(len(poses), dtype=bool)
    refined = follow(layout, parameters, parameters, poses[~singular], tight=TIGHT, most=PATH_STEPS)
    near = np.abs(refined.poses - poses[~singular]).max(axis=1, initial=0.0) < MOVED
    kept[~singular], poses[~singular] = near & refined.arrived, refined.poses
    for i in np.flatnonzero(singular):
        pose, error, _ = returned(layout, parameters, poses[i])
        poses[i], kept[i] = pose, error < SOLVED and np.abs(pose.imag).max() < REAL
    return poses[kept].real, places[kept]
