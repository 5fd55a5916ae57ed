"""`gsp.singularity_distance`: bounds of the distance from a pose to the nearest singular pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp import arguments
from gsp.checks import check_integer, check_positive, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.frames import log3
from gsp.geometry.pose import Pose, unchecked
from gsp.geometry.rotations import nearest_rotations, rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.indices.motion import instantaneous_motion
from gsp.model.design import Design, check_undriven
from gsp.proof.around import DISTANCE_INWARD
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Angles, Problem, problem_of
from gsp.proof.extremes import halved
from gsp.variation.free import free_radii
from gsp.variation.layout import LOW, MID_LOW, PARTS

# Default number of boxes per pose, and boxes of one round of the search.
BOXES_PER_POSE, BOXES_PER_ROUND = 40_000, 1024
# Gap between the ends of the bracket at which the search ends, as a share.
BRACKET_TOLERANCE = 0.05
# Largest angle of the search: each of three angles stays below that of the rotation up to π/2.
LARGEST_RADIUS = 1.5
# Rays that are followed for a change of sign, points on each, rounds that improve the best ray,
# and halvings of the interval on it.
SIGN_RAYS, POINTS_PER_RAY, RAY_ROUNDS, RAY_HALVINGS = 512, 24, 16, 48
# Radii that are tried one after the other, as shares of the greatest: a small ball takes few boxes,
# and a large one whose budget ends may prove nothing.
RADIUS_SHARES = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0)


@dataclass(frozen=True, eq=False, kw_only=True)
class SingularityDistance(ReadOnly):
    """Distances of poses from the nearest singular pose; made by `gsp.singularity_distance`.

    The distance of two poses is sqrt(|p − p'|² + (L θ)²) [unit of the design], with the angle θ of
    the rotation from one to the other and a length L. It does not depend on the axes of base and
    platform, but on the origin of the platform, whose displacement is counted.

    Attributes
    ----------
    lower : (...) array [unit of the design]
        Proven: no pose nearer than this is singular or undefined.
    upper : (...) array [unit of the design]
        Distance of `nearest`; inf where none was found.
    nearest : Pose of the same shape
        The nearest singular pose that was found, NaN where there is none. It is where det J
        changes its sign, as near as double precision gives it.
    free_motion : (..., 6) array [unit of the design/rad]
        The twist (v, ω) of the platform origin at `nearest` that no actuator prevents, to rounding,
        in base axes, of any size. NaN where `nearest` is, or where
        `gsp.instantaneous_motion` is undefined.
    length : float [unit of the design]
    n_boxes : (...) int array [1]
        Boxes that were evaluated.
    """

    lower: Array
    upper: Array
    nearest: Pose
    free_motion: Array
    length: float
    n_boxes: Array


def singularity_distance(
    design: Design,
    pose: Pose,
    length: float,
    *,
    tolerance: float = BRACKET_TOLERANCE,
    budget: int | None = None,
) -> SingularityDistance:
    """Return a bracket of the distance from poses to the nearest singular pose.

    Parameters
    ----------
    design : Design
    pose : Pose, batch shape (...)
    length : float [unit of the design]
        L > 0, the length that turns an angle into a displacement.
    tolerance : float [1]
        The bracket is closed to this share of its upper end, unless the budget ends before.
    budget : int or None
        Most boxes per pose, default 40 000.

    Returns
    -------
    SingularityDistance
        Both ends are 0 at a pose that is singular to rounding or undefined. The lower end is 0
        where rounding leaves nothing to prove, as for an origin that is far from the platform.

    Raises
    ------
    InvalidInput
        On a wrong type or shape, or numbers that are not positive.
        Also if the largest coordinate of an anchor is not between 1e-40 and 1e40.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> found = gsp.singularity_distance(d, d.home, 95.0, tolerance=0.3)
    >>> bool(0 < found.lower <= found.upper)
    True

    *Source: ours; see `docs/proofs.md`.*
    """
    check_undriven("design", design)
    check_type("pose", pose, Pose)
    scale = arguments.size("length", length)
    share = check_positive("tolerance", tolerance)
    if share >= 1.0:
        raise InvalidInput(expected("tolerance", "a number below 1", share))
    most = BOXES_PER_POSE if budget is None else check_integer("budget", budget)
    problem = problem_of(design, None, length=scale)
    flat = pose.reshape(pose.size)
    results = [
        _bracket(problem, flat.position[i], flat.rotation[i], scale, share, most)
        for i in range(pose.size)
    ]
    lower, upper, n_boxes = (
        np.array([r[k] for r in results]).reshape(pose.shape) for k in (0, 1, 3)
    )
    positions = np.array([r[2][0] for r in results]).reshape(*pose.shape, 3)
    rotations = np.array([r[2][1] for r in results]).reshape(*pose.shape, 3, 3)
    nearest = unchecked(Pose, positions, rotations)
    return SingularityDistance(
        lower=lower,
        upper=upper,
        nearest=nearest,
        free_motion=instantaneous_motion(design.at(nearest), length=scale).twist,
        length=scale,
        n_boxes=n_boxes,
    )


_Place = tuple[Array, Array]


def _bracket(
    problem: Problem, p: Array, r: Array, scale: float, share: float, budget: int
) -> tuple[float, float, _Place, int]:
    """Lower end, upper end, the nearest singular pose, and boxes, of one pose."""
    frame = problem.frame(Angles.of("ZYX"), nearest_rotations(r))
    nowhere = (np.full(3, np.nan), np.full((3, 3), np.nan))
    start = np.concatenate((p, np.zeros(3)))
    out, sign = enclose(problem, frame, np.tile(start, 2)[None])
    least = problem.names.index("minimum_singular_value")
    regular = bool(out[0, least, MID_LOW] > 0.0)
    if not regular and _singular(problem.design, p, r):
        return 0.0, 0.0, (p.copy(), r.copy()), 1
    upper, point = np.inf, start
    if problem.signed >= 0:
        upper, point = _crossing(problem, frame, start, float(sign[0]), scale)
    if not regular:  # toward an origin that is far away, rounding leaves nothing to prove
        place = (point[:3], rotation_from_angles(point[3:], "ZYX") @ r)
        return 0.0, upper, place if np.isfinite(upper) else nowhere, 1
    one = free_radii(problem.design, p[None], r[None], scale)
    most, lower, n_boxes = min(upper, LARGEST_RADIUS * scale), float(one[0]), 0
    for part in RADIUS_SHARES:
        free, more = _free(
            problem, frame, start, part * most, scale, (1.0 - share) * upper, budget - n_boxes
        )
        lower, n_boxes = max(lower, free), n_boxes + more
        if free < 0.999 * part * most or n_boxes >= budget:
            break
    if not np.isfinite(upper):
        return lower, upper, nowhere, n_boxes
    return lower, upper, (point[:3], rotation_from_angles(point[3:], "ZYX") @ r), n_boxes


def _singular(design: Design, p: Array, r: Array) -> bool:
    """Whether a pose is singular in double precision, wherever the platform origin is."""
    posture = design.at(unchecked(Pose, p, r))
    return bool(posture.singular()) or not bool(posture.defined)


def _turned(angles: Array) -> Array:
    """Angles of the rotations that ZYX angles (..., 3) give, shape (...)."""
    return np.asarray(np.linalg.norm(log3(rotation_from_angles(angles, "ZYX")), axis=-1))


def _distance(points: Array, p: Array, scale: float) -> Array:
    """Distance of points (..., 6) from the pose at p."""
    angle = _turned(points[..., 3:])
    return np.asarray(np.hypot(np.linalg.norm(points[..., :3] - p, axis=-1), scale * angle))


def _crossing(
    problem: Problem, frame: Array, start: Array, sign: float, scale: float
) -> tuple[float, Array]:
    """Find the nearest change of the sign of det J on rays; the distance and the point."""
    rng = np.random.default_rng(0)
    unit = np.repeat((1.0, 1.0 / scale), 3)
    rays = rng.standard_normal((SIGN_RAYS, 6))
    rays = np.concatenate((rays, np.eye(6), -np.eye(6)))
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    best, ray, reach, spread = np.inf, rays[0], LARGEST_RADIUS * scale, 0.5
    for _ in range(RAY_ROUNDS):
        steps = reach * np.linspace(0.0, 1.0, POINTS_PER_RAY + 1)[1:]
        points = start + steps[None, :, None] * (rays * unit)[:, None, :]
        flat = points.reshape(-1, 6)
        _, signs = enclose(problem, frame, np.concatenate((flat, flat), axis=1))
        other = signs.reshape(len(rays), POINTS_PER_RAY) * sign < 0.0
        first = np.where(other.any(axis=1), other.argmax(axis=1), POINTS_PER_RAY)
        i = int(first.argmin())
        if first[i] == POINTS_PER_RAY and not np.isfinite(best):
            return np.inf, start
        if first[i] < POINTS_PER_RAY and steps[first[i]] < best:
            best, ray = float(steps[first[i]]), rays[i]
        reach = best
        rays = ray + spread * rng.standard_normal((128, 6)) / np.sqrt(6.0)
        rays /= np.linalg.norm(rays, axis=1)[:, None]
        spread *= 0.75
    low, high = 0.0, best
    for _ in range(RAY_HALVINGS):
        middle = 0.5 * (low + high)
        point = start + middle * ray * unit
        _, signs = enclose(problem, frame, np.tile(point, 2)[None])
        low, high = (middle, high) if signs[0] * sign > 0.0 else (low, middle)
    point = start + high * ray * unit
    return float(_distance(point, start[:3], scale)), point


def _free(
    problem: Problem,
    frame: Array,
    start: Array,
    reach: float,
    scale: float,
    enough: float,
    budget: int,
) -> tuple[float, int]:
    """Prove the largest radius without singular poses: the nearest open box is halved first."""
    least = problem.names.index("minimum_singular_value")
    half = np.repeat((reach, reach / scale), 3)
    boxes, near, n_boxes = np.concatenate((start - half, start + half))[None], np.zeros(1), 0
    stuck_at = np.inf
    while len(boxes) and n_boxes < budget and near.min() < min(enough, stuck_at):
        # The nearest open boxes are the lower bound, so others are halved only after them. The sort
        # is stable, so that boxes at equal distance come in the same order on every machine.
        some = np.argsort(near, kind="stable")[:BOXES_PER_ROUND]
        rest = np.ones(len(boxes), dtype=bool)
        rest[some] = False
        out, _ = enclose(problem, frame, boxes[some])
        n_boxes += len(some)
        left = ~(out[:, least, LOW] > 0.0)
        halves, stuck = halved(boxes[some][left], out[left, least, PARTS:], scale)
        stuck_at = min(stuck_at, near[some][left][stuck].min(initial=np.inf))
        away = least_distances(halves, start, scale)
        inside = away < reach
        boxes = np.concatenate((boxes[rest], halves[inside]))
        near = np.concatenate((near[rest], away[inside]))
    return float(min(near.min(initial=reach), stuck_at)) * DISTANCE_INWARD, n_boxes


def least_distances(boxes: Array, start: Array, scale: float) -> Array:
    """Lower bound of the distance of boxes (m, 12) from the pose: see `docs/proofs.md`."""
    low, high = boxes[:, :6] - start, boxes[:, 6:] - start
    gap = np.maximum(np.maximum(low, -high), 0.0)
    middle, half = 0.5 * (low + high)[:, 3:], 0.5 * (high - low)[:, 3:]
    angle = _turned(middle) - half.sum(axis=1)
    angle = np.maximum(angle, gap[:, 3:].max(axis=1))
    return np.asarray(np.hypot(np.linalg.norm(gap[:, :3], axis=1), scale * angle) * DISTANCE_INWARD)
