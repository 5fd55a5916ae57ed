"""Forward kinematics: the pose that given actuator values belong to, near a guess."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.checks import check_array, check_integer, check_positive, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.matrices import singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import EPS, Array, Mask, cross, dot, norm
from gsp.model.design import Design
from gsp.model.posture import Posture

# Elements solved at once; their arrays stay in the cache.
POSES_PER_BLOCK = 8192
LARGEST_STEP = 0.5  # of the design's size, and rad
SMALLEST_DAMPING = 2.0**-12
# Newton–Kantorovich: a solution is isolated where (residual / σ_min²) × curvature < 1/2. Rows bend
# by about 1 / (length of the leg / size of the design); this allows for legs of 1/50 of the size.
ISOLATION_BOUND = 0.01

# How often a step is halved, before it is taken to cross a singularity.
HALVINGS = 6
# Rows whose change relative to either end is below this have no singular ones between them. On a
# straight segment 2 is enough; steps are curved: with 1, 6 of 1,499 solutions of random D4⁶ were
# reached across det J = 0, with 0.4 none of 1,484.
NEAR = 0.4
# Lines that turn by less than this share of the sine of their angle turn their common normal by
# less than 24°. Without this bound, pairs that became parallel to 2e-4 within 0.3 % of a step
# passed det J = 0 twice unseen, in 1 of 1,300 solutions of a random D4⁶.
TURN = 0.4

CONVERGED, NOT_CONVERGED, SINGULAR, UNDEFINED = (
    "converged", "not converged", "singular", "undefined",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class ForwardSolution:
    """Result of `forward`, for one pose or a batch.

    Attributes
    ----------
    pose : Pose of batch shape (...)
        The pose found; NaN wherever `status` is not "converged".
    status : (...) array of str
        "converged": joint values reproduced, at an isolated solution on the guess's side of the
        singularities (see `forward`). "singular": the guess, or the last pose of the search, does
        not differ from a singular posture in double precision. "undefined": the guess has an
        undefined leg, or the joint values are NaN or none that a joint can have. "not converged":
        none of these.
    residual : (...) array [1, rad]
        Largest error of a joint value where the search ended, distances as a share of
        `design.rms_radius`, angles in rad.
    iterations : (...) array of int
        Numbers of postures evaluated after the guess.
    """

    pose: Pose
    status: NDArray[np.str_]
    residual: Array
    iterations: NDArray[np.int64]

    @property
    def converged(self) -> Mask:
        """Whether the pose was found, shape (...)."""
        return np.asarray(self.status == CONVERGED)

    @property
    def singular(self) -> Mask:
        """Whether the search met a singular posture, shape (...)."""
        return np.asarray(self.status == SINGULAR)


def forward(
    design: Design,
    joints: ArrayLike,
    guess: Pose,
    *,
    tolerance: float = 1e-12,
    max_iterations: int = 60,
) -> ForwardSolution:
    """Return the pose at which the actuators have given values, near a given pose.

    Damped Newton on the rows of the inverse Jacobian. A step is halved until the joint errors
    shrink, no row turns by 90° or more, and det J keeps its sign along the step. So no leg turns
    over, and the search stays on the side of the singularities on which it began. The step is
    watched at points so close that no matrix on the straight segment between the rows of two
    neighbours is singular and no common normal of two lines turns by 24°; that is no proof for the
    curve between them. Of 22,462 solutions of 12 designs, symmetric and random, with all kinds of
    constraints, none was reached across det J = 0 (65 points per step, 1,025 where it dips).
    The distance of two lines is taken with the sign that it has at the guess. For more than six
    actuators the steps are least-squares ones, det J is not watched, and values that contradict
    each other do not converge.

    Parameters
    ----------
    design : Design
    joints : (..., n) array_like [unit of the design, rad]
        Actuated distances and angles, in the order of `design.joint_names`.
    guess : Pose of batch shape (...)
        Where to start; its batch shape and that of `joints` broadcast.
    tolerance : float [1, rad]
        Largest joint error, distances as a share of `design.rms_radius`. The rounding of distances
        in frames far from the anchors, 2e-16 × their distance / size, is the least that converges.
    max_iterations : int
        Most postures evaluated per element.

    Returns
    -------
    ForwardSolution
        With `pose`, `converged`, `residual`, `iterations` and `status`. A pose that was not found
        is NaN: no other pose stands in for it.

    Raises
    ------
    InvalidInput
        On wrong types or shapes, or a tolerance or count that is not positive.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> joints = d.at(d.home).joints
    >>> found = forward(d, joints, d.home.moved([3, -2, 4, 0.1, -0.05, 0.08]))
    >>> bool(found.converged), found.pose.position.round(9)
    (True, array([ 10., -10., 138.]))
    """
    target, start = _check(design, joints, guess)
    centred, centre = _centred(design)
    start = _seen_from(start, centre)
    limit = check_positive("tolerance", tolerance)
    most = check_integer("max_iterations", max_iterations)
    n = target.shape[-1]
    flat_target, flat_start = target.reshape(start.size, n), start.reshape(start.size)
    blocks = [slice(i, i + POSES_PER_BLOCK) for i in range(0, start.size, POSES_PER_BLOCK)] or [
        slice(0, 0)
    ]
    parts = [_solve(centred, flat_target[b], flat_start[b], limit, most) for b in blocks]
    positions, rotations, status, residual, iterations = (
        np.concatenate(columns) for columns in zip(*parts, strict=True)
    )
    found = _seen_from(Pose._trusted(positions, rotations), -centre).reshape(*start.shape)
    shape = start.shape
    return ForwardSolution(
        found, status.reshape(shape), residual.reshape(shape), iterations.reshape(shape)
    )


def _check(design: Design, joints: ArrayLike, guess: Pose) -> tuple[Array, Pose]:
    """Return joints and guess in one batch shape."""
    check_type("design", design, Design)
    check_type("guess", guess, Pose)
    n = len(design.joint_names)
    target = check_array("joints", joints, (n,), finite=False)
    try:
        shape = np.broadcast_shapes(target.shape[:-1], guess.shape)
    except ValueError as error:
        got = f"{target.shape[:-1]} and {guess.shape}"
        raise InvalidInput(expected("joints, guess", "batch shapes that broadcast", got)) from error
    start = Pose._trusted(
        np.broadcast_to(guess.position, (*shape, 3)),
        np.broadcast_to(guess.rotation, (*shape, 3, 3)),
    )
    return np.broadcast_to(target, (*shape, n)), start


def _centred(design: Design) -> tuple[Design, Array]:
    """Return the design with the platform origin at the centre of its anchors, and that centre.

    Steps turn the platform about its origin. Far from the anchors the rows would look singular, and
    small turns would move the anchors far.
    """
    centre = design.platform_points.mean(axis=0)
    return design.replace(platform_points=design.platform_points - centre, home=None), centre


def _seen_from(pose: Pose, point: Array) -> Pose:
    """Return poses of the platform frame moved to a point of the platform."""
    return Pose._trusted(pose.position + pose.rotation @ point, pose.rotation.view())


@dataclass(eq=False)
class _State:
    """Where the search stands at each of m elements, and its Newton step from there."""

    pose: Pose
    error: Array  # (m, n), dimensionless
    rows: Array  # (m, n, 6), dimensionless
    step: Array  # (m, 6), (v / L, ω)
    side: Array  # (m,) sign of det J, 0 where singular
    facing: Array  # (m, n) sign of the common normals, for D4
    known: Mask  # (m,)


def _solve(
    design: Design, target: Array, start: Pose, tolerance: float, most: int
) -> tuple[Array, Array, NDArray[np.str_], Array, NDArray[np.int64]]:
    possible = _possible(design, target)
    now = _evaluate(design, start, target, None)
    now.known &= possible
    facing, side = now.facing.copy(), now.side.copy()
    singular = now.known & ((side == 0.0) | design.at(start).singular(_scale(design)))
    damping = _largest_damping(now.step)
    iterations = np.zeros(start.size, dtype=np.int64)
    n_rows = target.shape[-1]
    search = now.known & ~singular
    for _ in range(most):
        open_ = search & (_largest(now.error) > tolerance) & (damping > SMALLEST_DAMPING)
        at = np.flatnonzero(open_)
        if not at.size:
            break
        iterations[at] += 1
        move = damping[at, None] * now.step[at] * np.repeat([_scale(design), 1.0], 3)
        trial = _evaluate(design, now.pose[at].moved(move), target[at], facing[at])
        better = norm(trial.error) < (1.0 - 0.25 * damping[at]) * norm(now.error[at])
        steady = (np.einsum("mni,mni->mn", trial.rows, now.rows[at]) > 0.0).all(axis=-1)
        good = trial.known & (trial.side == side[at]) & steady & better
        if n_rows == 6:
            tried = np.flatnonzero(good)
            rows, ends = now.rows[at[tried]], trial.rows[tried]
            good[tried] = _clear(
                design, now.pose[at[tried]], move[tried], rows, ends, facing[at[tried]]
            )
        _take(now, at[good], trial, good)
        damping[at[good]] = _largest_damping(trial.step[good])
        damping[at[~good]] /= 2.0
    return _report(design, now, start, search, singular, tolerance, iterations)


def _clear(
    design: Design, start: Pose, moves: Array, first: Array, last: Array, facing: Array
) -> Mask:
    """Return which steps keep clear of singular rows from their first to their last pose.

    On the straight segment from J_a to J_b no matrix is singular if ‖J_a⁻¹(J_b − J_a)‖ and
    ‖J_b⁻¹(J_b − J_a)‖ are below 2: each excludes its half. The rows of a step are on a curve, so
    the interval is halved until both are below `NEAR`, and no common normal of two lines turns by
    24° or more. A step is not clear if det J has another sign at one of the points, or an interval
    stays open. The norms do not depend on the scale of a row.

    Parameters
    ----------
    start : Pose, batch shape (k,)
    moves : (k, 6) array [unit of the design, rad]
    first, last : (k, 6, 6) arrays, not singular
    facing : (k, n) array
        The signs of the common normals at the guess.
    """
    clear = np.ones(start.size, dtype=bool)
    side = np.sign(np.linalg.det(first))
    owner, low, width, a, b = np.arange(start.size), np.zeros(start.size), 1.0, first, last
    turns = norm(moves[:, 3:])
    sine_a, sine_b = (_least_sine(design.at(pose)) for pose in (start, start.moved(moves)))
    for halving in range(HALVINGS + 1):
        at = np.flatnonzero(clear[owner])
        turned = width * turns[owner[at]] > TURN * np.minimum(sine_a[at], sine_b[at])
        at = at[turned | _apart(a[at], b[at])]
        if not at.size or halving == HALVINGS:
            clear[owner[at]] = False
            return clear
        owner, low, width = owner[at], low[at], width / 2.0
        middle = start[owner].moved((low + width)[:, None] * moves[owner])
        posture = design.at(middle)
        rows, known = _rows(posture, facing[owner], _scale(design))
        same = known & (np.sign(np.linalg.det(rows)) == side[owner])
        clear[owner[~same]] = False
        owner, low = (
            np.concatenate((x[same], y[same])) for x, y in ((owner, owner), (low, low + width))
        )
        a, b = np.concatenate((a[at][same], rows[same])), np.concatenate((rows[same], b[at][same]))
        sine = _least_sine(posture)[same]
        sine_a, sine_b = (
            np.concatenate((sine_a[at][same], sine)),
            np.concatenate((sine, sine_b[at][same])),
        )
    return clear


def _least_sine(posture: Posture) -> Array:
    """Return the least sine of the angle of two lines with a common normal, (k,); inf if none."""
    legs = [leg.base_line and leg.platform_line for leg in posture.design.legs]
    sines = norm(cross(posture.lines.t, posture.lines.s))[:, legs]
    return np.asarray(sines.min(axis=-1, initial=np.inf))


def _apart(a: Array, b: Array) -> Mask:
    """Return whether the rows a and b, (m, 6, 6), may have singular ones between them."""
    change = b - a
    shares = [np.linalg.norm(np.linalg.solve(end, change), axis=(-2, -1)) for end in (a, b)]
    return np.asarray(np.maximum(*shares) > NEAR)


def _report(
    design: Design, now: _State, start: Pose, search: Mask, singular: Mask, tolerance: float,
    iterations: NDArray[np.int64],
) -> tuple[Array, Array, NDArray[np.str_], Array, NDArray[np.int64]]:  # fmt: skip
    residual = np.where(search | singular, _largest(now.error), np.nan)
    close = search & (residual <= tolerance)
    singular = singular | (search & ~_isolated(design, now, close))
    status = np.full(start.size, NOT_CONVERGED, dtype="<U13")
    status[close] = CONVERGED
    status[singular] = SINGULAR
    status[~search & ~singular] = UNDEFINED
    found = (status == CONVERGED)[:, None]
    return (
        np.where(found, now.pose.position, np.nan),
        np.where(found[..., None], now.pose.rotation, np.nan),
        status,
        residual,
        iterations,
    )


def _isolated(design: Design, now: _State, close: Mask) -> Mask:
    """Whether a posture can be distinguished from singular ones: max(error, ε) ≤ 0.01 σ_min².

    Only where the joint values are met (`close`) does the error say how far the solution is.
    """
    posture = design.at(now.pose)
    smallest = singular_values(posture.homogeneous(_scale(design)))[..., -1]
    error = np.where(close, norm(now.error), 0.0)
    return np.asarray(np.maximum(error, EPS) <= ISOLATION_BOUND * smallest**2)


def _possible(design: Design, target: Array) -> Mask:
    """Whether the values are ones that the joints can have: distances ≥ 0, angles in (0, π)."""
    with np.errstate(invalid="ignore"):
        inside = np.where(design.angular, (target > 0.0) & (target < np.pi), target >= 0.0)
    return np.asarray((inside & np.isfinite(target)).all(axis=-1))


def _scale(design: Design) -> float:
    return design.rms_radius


def _largest(error: Array) -> Array:
    return np.asarray(np.abs(error).max(axis=-1))


def _largest_damping(step: Array) -> Array:
    """Share of a Newton step that neither moves nor turns the platform too far at once."""
    reach = np.maximum(norm(step[..., :3]), norm(step[..., 3:]))
    return np.asarray(np.minimum(1.0, LARGEST_STEP / np.maximum(reach, LARGEST_STEP)))


def _take(now: _State, at: NDArray[np.int64], trial: _State, good: Mask) -> None:
    position, rotation = now.pose.position.copy(), now.pose.rotation.copy()
    position[at], rotation[at] = trial.pose.position[good], trial.pose.rotation[good]
    now.pose = Pose._trusted(position, rotation)
    for name in ("error", "rows", "step"):
        getattr(now, name)[at] = getattr(trial, name)[good]


def _evaluate(design: Design, pose: Pose, target: Array, facing: Array | None) -> _State:
    """Errors and Newton steps; `facing` holds the signs at the guess, None at the guess itself."""
    posture = design.at(pose)
    scale, signs = _scale(design), _facing(posture)
    turned = np.ones_like(signs) if facing is None else signs * facing
    units = np.where(posture.angular, 1.0, scale)
    rows, known = _rows(posture, signs if facing is None else facing, scale)
    error = np.where(known[:, None], (turned * posture.joints - target) / units, np.inf)
    step, side = _newton(rows, -error, known)
    return _State(pose, error, rows, step, side, signs, known)


def _rows(posture: Posture, facing: Array, scale: float) -> tuple[Array, Mask]:
    """Return the dimensionless rows with the signs of the guess, and where they are defined."""
    known = posture.defined.copy()
    rows = (_facing(posture) * facing)[..., None] * posture.homogeneous(scale)
    return np.where(known[:, None, None], rows, 0.0), known


def _newton(rows: Array, wanted: Array, known: Mask) -> tuple[Array, Array]:
    """Newton or least-squares steps (m, 6), and the sides of the singularity: −1, 0, 1."""
    square = rows.shape[-2] == 6
    side = np.sign(np.linalg.det(rows)) if square else known.astype(float)
    regular = side != 0.0
    safe = np.where(regular[:, None, None], rows, np.eye(rows.shape[-2], 6))
    right = np.where(regular[:, None], wanted, 0.0)[..., None]
    step = np.linalg.solve(safe, right) if square else np.linalg.pinv(safe) @ right
    return step[..., 0], side


def _facing(posture: Posture) -> Array:
    """−1 where the common normal of a D4 leg points along s × t, else 1: (m, n)."""
    signs = np.ones(posture.joints.shape)
    d4 = [(i, row.leg) for i, row in enumerate(posture.design.rows) if row.constraint.name == "D4"]
    if d4:
        rows, legs = map(list, zip(*d4, strict=True))
        normal = cross(posture.lines.t[..., legs, :], posture.lines.s[legs])
        along = dot(posture.segments.direction[..., legs, :], normal)
        signs[..., rows] = np.where(along < 0.0, -1.0, 1.0)
    return signs
