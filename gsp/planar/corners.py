"""Poses of a planar platform with given joints: all of them at a limit, or in the middle."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_integer, check_memory, check_rng
from gsp.errors import EmptyWorkspace, InvalidInput, MissingParameter, expected
from gsp.geometry.frames import exp3
from gsp.geometry.matrices import RESIDUAL_TOLERANCE, newton, solve_least_squares
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.vectors import Array, Mask, norm
from gsp.limits.quantities import BoundedQuantities
from gsp.planar.bounds import planar_bounds
from gsp.planar.design import PlanarDesign
from gsp.planar.pose import PlanarPose, distance, wrapped
from gsp.workspace.boundary.tracing import POSE_TOLERANCE

# Rotation vector of a turn by 1 rad in the plane.
PLANE_NORMAL = np.eye(3)[2:]
# Steps of Newton's method, and the longest of them [share of the scale, rad].
CORNER_STEPS, LONGEST_CORNER_STEP = 60, 0.5
# Residual at which iterations end [share of the scale]. Where two assembly modes meet, the error of
# a pose is the square root of it, and the modes are separated by POSE_TOLERANCE.
CORNER_RESIDUAL = 1e-15


def radiating_point(design: PlanarDesign, guess: ArrayLike) -> PlanarPose:
    """Return the pose near a guess in which every joint is in the middle of its stroke.

    Parameters
    ----------
    design : PlanarDesign
        With three legs and strokes.
    guess : (2,) array_like [length]

    Returns
    -------
    PlanarPose of batch shape ()

    Raises
    ------
    EmptyWorkspace
        If Newton's method finds no such pose from the guess.
    MissingParameter
        If the design has no strokes, or some without one of its bounds.
    InvalidInput
        If `design` is not a PlanarDesign, or `guess` is not a point.

    *Source: Workspace-A, eqs. (A.1), (A.2)*
    """
    bounds = planar_bounds(design)
    start = check_array("guess", guess, (2,))
    if start.ndim != 1:
        raise InvalidInput(expected("guess", "a single point", f"shape {start.shape}"))
    middle = 0.5 * (bounds.low + bounds.high)
    if not np.isfinite(middle).all():
        names = ", ".join(np.array(design.joint_names)[~np.isfinite(middle)])
        raise MissingParameter(expected("strokes", "both limits of each", f"open ones of {names}"))
    angles = np.linspace(-np.pi, np.pi, 24, endpoint=False)
    poses, ok = _assemble(bounds, middle, np.broadcast_to(start, (24, 2)), angles)
    if not ok.any():
        wanted = f"a point near a pose with the joints {middle.tolist()}"
        raise EmptyWorkspace(
            expected("guess", wanted, f"{start.tolist()}, from which none is found")
        )
    best = np.flatnonzero(ok)[np.argmin(norm(poses[ok, :2] - start))]
    return PlanarPose(poses[best, :2], poses[best, 2])


def corner_poses(
    design: PlanarDesign, *, starts: int = 300, rng: np.random.Generator | int = 0
) -> dict[str, PlanarPose]:
    """Return all poses with every joint at a limit, by label: the 2³ bifurcation points.

    Each label may have several poses (assembly modes), or none.

    Parameters
    ----------
    design : PlanarDesign
        With three legs and strokes.
    starts : int
        Newton's method starts from as many random poses per label.
    rng : numpy.random.Generator or int
        Generator or seed of these poses.

    Returns
    -------
    mapping from label ("0 1 1") to PlanarPose of batch shape (n,)

    Raises
    ------
    MissingParameter
        If the design has no strokes.
    InvalidInput
        If it does not have three legs with both limits, or on arguments of other types.

    *Source: Workspace-A, §A.2 and eq. (A.12)*
    """
    bounds = planar_bounds(design)
    if design.n_legs != 3 or not np.isfinite([bounds.low, bounds.high]).all():
        raise InvalidInput(expected("design", "three legs with both limits", design.n_legs))
    generator, starts = check_rng("rng", rng), check_integer("starts", starts)
    check_memory("starts", starts, POSE_BYTES, "poses")
    reach = bounds.scale + float(np.abs(bounds.high).max())
    result = {}
    for sides in product((0, 1), repeat=3):
        target = np.where(sides, bounds.high, bounds.low)
        centre = design.base_points.mean(axis=0)
        position = centre + generator.uniform(-reach, reach, (starts, 2))
        angle = generator.uniform(-np.pi, np.pi, starts)
        poses, ok = _assemble(bounds, target, position, angle)
        single = _unique(poses[ok], bounds.scale)
        text = " ".join(str(side) for side in sides)
        result[text] = PlanarPose(single[:, :2], single[:, 2])
    return result


def _assemble(
    bounds: BoundedQuantities, target: Array, position: Array, angle: Array
) -> tuple[Array, Mask]:
    """Poses (N, 3) with joints at a target, by damped Newton steps, and which are solved."""
    scale = np.array([bounds.scale, bounds.scale, 1.0])

    def equations(poses: Array) -> tuple[Array, Array]:
        place = np.concatenate((poses[:, :2], np.zeros((len(poses), 1))), axis=1)
        values, rows = bounds.evaluate(place, exp3(poses[:, 2:] * PLANE_NORMAL))
        gap = np.nan_to_num((values - target) / bounds.scale, nan=1.0)
        return gap, np.nan_to_num(rows[..., [0, 1, 5]]) * scale / bounds.scale

    poses, residual = newton(
        np.concatenate((position, angle[:, None]), axis=1),
        equations,
        lambda poses, step: poses + step * scale,
        solve=solve_least_squares,
        longest=LONGEST_CORNER_STEP,
        most=CORNER_STEPS,
        rest=CORNER_RESIDUAL,
    )
    poses[:, 2] = wrapped(poses[:, 2])
    return poses, np.asarray(residual < RESIDUAL_TOLERANCE)


def _unique(poses: Array, size: float) -> Array:
    kept: list[Array] = []
    for pose in poses:
        apart = (distance(pose[:2] - other[:2], pose[2] - other[2], size) for other in kept)
        if min(apart, default=np.inf) >= POSE_TOLERANCE:
            kept.append(pose)
    return np.array(kept).reshape(-1, 3)
