"""Forward kinematics in numpy: the same search as the compiled one, on arrays of postures.

It is used for designs with more than six actuators; for others tests compare compiled code with it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.pose import Pose, unchecked
from gsp.geometry.scalars import components
from gsp.geometry.vectors import Array, Mask, dot, norm
from gsp.kinematics.newton.centred import Centred
from gsp.kinematics.newton.control import UNDEFINED, Step, ending, next_share, stopped, taken
from gsp.kinematics.newton.stages import bend
from gsp.model.design import Design
from gsp.model.posture import Posture
from gsp.variation.drives import RODS
from gsp.variation.jets import Jet
from gsp.variation.legs import KINDS, Patch

# Elements solved at once; their arrays stay in the cache.
POSES_PER_SOLUTION = 8192
TURN = 2.0 * np.pi
# The arrays of `Points` that steps change.
CHANGING = ("rows", "inverse", "error", "step", "undefined", "scale")


@dataclass(eq=False)
class Points:
    """States of m searches, now or after a step: all lengths in sizes of the design.

    Attributes
    ----------
    pose : Pose of batch shape (m,)
    signs : (m, n) array
        −1 where the distance of two lines is along s × t, else 1.
    rows, inverse : (m, n, 6) and (m, 6, n) arrays
        The Jacobian with the signs of the guess, and its (pseudo-)inverse. The rows of legs that
        are driven at the base are those of their rods: the Jacobian times `scale`.
    error, step : (m, n) and (m, 6) arrays
        Joint errors, and the Newton step (v, ω).
    undefined : (m,) array
        1.0 where a leg is undefined, or a drive at the base is singular.
    scale : (m, n) array
        As `Posture.drive_scales`, in sizes of the design.
    """

    pose: Pose
    signs: Array
    rows: Array
    inverse: Array
    error: Array
    step: Array
    undefined: Array
    scale: Array

    def put(self, at: NDArray[np.bool_], other: Points) -> None:
        """Replace some elements by those of other points."""
        choose = at[:, None]
        self.pose = unchecked(
            Pose,
            np.where(choose, other.pose.position, self.pose.position),
            np.where(choose[..., None], other.pose.rotation, self.pose.rotation),
        )
        for name in CHANGING:
            getattr(self, name)[at] = getattr(other, name)[at]


def solve(
    design: Centred, joints: Array, guess: Pose, tolerance: float, most: int
) -> tuple[Pose, Array]:
    """Return poses and numbers of m searches as the compiled `solve` does; NaN where not found.

    Parameters
    ----------
    design : Centred
    joints : (m, n) array
    guess : Pose of batch shape (m,)
    tolerance : float
    most : int

    Returns
    -------
    Pose of batch shape (m,), and an (m, 3) array
        How the searches ended, their largest errors and numbers of steps.
    """
    target, start = design.joints_from(joints), design.pose_from(guess)
    possible = design.possible(target)
    m = len(target)
    position, rotation = np.full((m, 3), np.nan), np.full((m, 3, 3), np.nan)
    numbers = np.full((m, 3), (UNDEFINED, np.nan, 0.0))
    for at in np.array_split(np.flatnonzero(possible), max(1, m // POSES_PER_SOLUTION)):
        with np.errstate(all="ignore"):
            pose, numbers[at] = _search(design, target[at], start[at], tolerance, most)
        position[at], rotation[at] = pose.position, pose.rotation
    return design.pose_to(unchecked(Pose, position, rotation)), numbers


def _search(
    design: Centred, target: Array, start: Pose, tolerance: float, most: int
) -> tuple[Pose, Array]:
    """Step until every search has ended."""
    m = len(target)
    now = points_at(design, start, target, None)
    fresh, share, took = np.ones(m), np.zeros(m), np.ones(m)
    step = Step(fresh, now.undefined, np.zeros(m), share, *(_size(now.error),) * 2)
    share = next_share(step, took, _sizes(now.step, now.step))
    ends = _ending(step, took, now, share, tolerance)
    counts = np.zeros(m)
    for _ in range(most):
        at = np.flatnonzero(ends == 0.0)
        if not at.size:
            break
        counts[at] += 1
        here = part(now, at)
        move = share[at, None] * here.step
        there = points_at(design, here.pose.moved(move), target[at], here.signs)
        bends = row_bends(design, here.pose, move)
        change = there.rows - here.rows
        step = Step(
            np.zeros(at.size),
            there.undefined,
            np.maximum(change_bound(here, change, bends), change_bound(there, change, bends)),
            share[at],
            _size(here.error),
            _size(there.error),
        )
        took = taken(step)
        old = here.step.copy()
        here.put(took > 0.5, there)
        share[at] = next_share(step, took, _sizes(old, here.step))
        ends[at] = _ending(step, took, here, share[at], tolerance)
        _write(now, at, here)
    open_ = ends == 0.0
    ends[open_] = stopped(_square(now.inverse[open_]))
    return _report(now, ends, counts)


def _report(now: Points, ends: Array, counts: Array) -> tuple[Pose, Array]:
    found = (ends == 1.0)[:, None]
    position = np.where(found, now.pose.position, np.nan)
    rotation = np.where(found[..., None], now.pose.rotation, np.nan)
    residual = np.where(ends == UNDEFINED, np.nan, np.abs(now.error).max(axis=-1))
    return unchecked(Pose, position, rotation), np.stack((ends, residual, counts), axis=1)


def points_at(design: Centred, pose: Pose, target: Array, signs: Array | None) -> Points:
    """Evaluate poses with the signs of the guess; None at the guess itself.

    The rows of legs that are driven at the base are those of their rods; a posture with a singular
    drive counts as undefined.
    """
    posture = design.design.at(pose)
    own = _signs(posture)
    kept = own if signs is None else signs
    side = own * kept
    scale = posture.drive_scales.copy()
    regular = posture.defined & ~posture.drive_is_singular.any(axis=-1)
    undefined = (~regular).astype(float)
    rows = np.nan_to_num((side * scale)[..., None] * posture.jacobian)
    error = np.nan_to_num(side * posture.joints - target)
    turns = _cranks(design.design) & (np.abs(error) > np.pi)
    error = np.where(turns, error - TURN * np.sign(error), error)
    inverse = _inverse(rows)
    step = -np.einsum("mij,mj->mi", inverse, scale * error)
    return Points(pose, kept, rows, inverse, error, step, undefined, scale)


def _cranks(design: Design) -> Mask:
    """Whether joint values are angles of cranks, shape (n,), of which full turns are the same."""
    return np.array([c.driven and c.quantity == "angle" for _, c in design.rows])


def _inverse(rows: Array) -> Array:
    """Inverses, or left inverses for more than six rows; infinite where there is none."""
    if rows.shape[-2] > 6:
        return _left_inverse(rows)
    regular = np.linalg.det(rows) != 0.0
    result = np.full(rows.shape, np.inf)
    result[regular] = np.linalg.inv(rows[regular])
    return result


def _left_inverse(rows: Array) -> Array:
    """Pseudo-inverses without a cut: with a cut, a rank deficiency would not be detected."""
    left, values, right = np.linalg.svd(rows, full_matrices=False)
    inverse = (right.swapaxes(-1, -2) / values[..., None, :]) @ left.swapaxes(-1, -2)
    inverse[values[..., -1] == 0.0] = np.inf
    return np.asarray(inverse, dtype=np.float64)


def _signs(posture: Posture) -> Array:
    """−1 where the common normal of two lines is along s × t in a distance, else 1: (m, n)."""
    signs = np.ones(posture.joints.shape)
    for i, row in enumerate(posture.design.rows):
        leg = posture.design.legs[row.leg]
        if leg.base_line and leg.platform_line and row.constraint.quantity == "distance":
            segments = posture.segments
            along = dot(segments.direction[:, row.leg], segments.normal[:, row.leg])
            signs[:, i] = np.where(along < 0.0, -1.0, 1.0)
    return signs


def row_bends(design: Centred, pose: Pose, move: Array, curved: float = 0.0) -> Array:
    """Return `bend` of the rows on steps from poses, (m, n); see `patch_of`."""
    rows, _ = jets_of(design, patch_of(pose, move, curved))
    bends = [np.broadcast_to(bend(row), (pose.size,)) for row in rows]
    return np.asarray(np.stack(bends, axis=-1), dtype=np.float64)


def jets_of(design: Centred, patch: Patch) -> tuple[list[Jet], list[Jet]]:
    """Return the n rows of `Points` on a patch, and the n joint values or cosines of angles.

    The value of a crank is (cos q, sin q).
    """
    rows: list[Jet] = []
    values: list[Jet] = []
    for leg, numbers in zip(design.design.legs, design.paths.reshape(-1, 18), strict=True):
        geometry = list(numbers)
        if leg.drive is not None:
            rod = RODS[type(leg.drive)](patch, geometry, leg.drive)
            rows.append(rod.row)
            values.append(rod.joint)
            continue
        kind = KINDS[leg.name]
        moving = kind.segment(patch, geometry)
        rows += [row(moving, 1.0) for row in kind.rows]
        values += [value(moving) for value in kind.values]
    return rows, values


def patch_of(pose: Pose, move: Array, curved: float = 0.0) -> Patch:
    """Return steps (m, 6) from poses (m,) as patches of one direction.

    They are straight, or their second derivative of the position is at most `curved`.
    """
    p, r = components(pose.position), components(pose.rotation.reshape(-1, 9))
    zero = np.zeros(pose.size)
    numbers = [
        *p,
        *r,
        *components(move[:, :3]),
        *components(move[:, 3:]),
        *[zero] * 6,
        norm(move[:, :3]) + curved,
        zero + curved,
        norm(move[:, 3:]),
        zero,
        norm(pose.position),
    ]
    # Arithmetic of numbers takes a third of the time of arrays of one number, with the same bits.
    patch = Patch.of([x[0] for x in numbers] if pose.size == 1 else numbers)
    return replace(patch, turns=patch.turns[:1])


def change_bound(point: Points, change: Array, bends: Array) -> Array:
    """Bound of ‖A⁻¹ J(s) − I‖ on the half of the step next to a point: see `control`."""
    straight = np.linalg.norm(point.inverse @ change, axis=(-2, -1))
    return np.asarray(0.5 * straight + (norm(point.inverse.swapaxes(-1, -2)) * bends).sum(axis=-1))


def _size(error: Array) -> Array:
    return norm(error)


def _sizes(old: Array, new: Array) -> tuple[Array, Array, Array]:
    return norm(old), norm(new), np.maximum(norm(new[:, :3]), norm(new[:, 3:]))


def _ending(step: Step, took: Array, now: Points, share: Array, tolerance: float) -> Array:
    largest = np.abs(now.error).max(axis=-1)
    error = (largest, norm(now.error))
    ends = ending(step, took, error, _square(now.inverse), share, tolerance)
    return np.array(np.broadcast_to(ends, largest.shape), dtype=float)


def _square(inverse: Array) -> Array:
    return np.asarray((inverse**2).sum(axis=(-2, -1)))


def part(points: Points, at: NDArray[np.int64]) -> Points:
    """Return some of the points."""
    names = ("signs", *CHANGING)
    return Points(points.pose[at], *(getattr(points, name)[at] for name in names))


def _write(points: Points, at: NDArray[np.int64], some: Points) -> None:
    position, rotation = points.pose.position.copy(), points.pose.rotation.copy()
    position[at], rotation[at] = some.pose.position, some.pose.rotation
    points.pose = unchecked(Pose, position, rotation)
    for name in CHANGING:
        getattr(points, name)[at] = getattr(some, name)
