"""Statements of `Nawratil` beside its indices: velocities, remarks, free parameters."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

import numpy as np
from scipy.optimize import least_squares

from gsp.determinant import maximum
from gsp.errors import InvalidInput, expected
from gsp.families.nawratil import example_design, example_pose, line_configuration
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, norm, unit
from gsp.indices import condition_number, control_number, manipulability
from gsp.model.design import Design
from gsp.published.quantities import common
from gsp.published.quantities.nawratil import matrices as source_matrices

RADIANS_PER_DEGREE = np.pi / 180.0
UPPER = np.triu_indices(6)


def _random_screw() -> tuple[Array, Array]:
    """Return q and q̂ of a general screw."""
    q, hat = np.random.default_rng(5).normal(size=(2, 3))
    return q, hat


def leg_rate_error(design: str, place: float) -> float:
    """Largest error of eq. (3), with v taken at a point of each leg line, at a general screw.

    The place is 0 at the base anchor and 1 at the platform anchor; J is ours.
    """
    posture = common.posture(design)
    q, hat = _random_screw()
    base = posture.design.base_points
    leg = posture.pose.position + posture.lines.arm - base
    velocity = hat + cross(np.broadcast_to(q, base.shape), base + place * leg)
    rates = (unit(leg) * velocity).sum(axis=-1)
    origin = posture.pose.position
    twist = np.concatenate((hat + cross(q, origin), q))
    return float(np.abs(posture.jacobian @ twist - rates).max())


def vertex_speed_error(a: float, b: float, c: float) -> float:
    """Left side less right side of eq. (15), at a general screw, over the left side."""
    q, hat = _random_screw()
    axes = np.diag([a, b, c])
    vertices = np.concatenate((axes, -axes))
    omega, direction = float(norm(q)), unit(q)
    rise = float(direction @ hat)
    foot = cross(q, hat) / omega**2
    distances = norm(cross(vertices - foot, np.broadcast_to(direction, vertices.shape)))
    left = float(((hat + cross(np.broadcast_to(q, vertices.shape), vertices)) ** 2).sum())
    return (left - omega**2 * float((distances**2).sum()) - 6.0 * rise**2) / left


def passive_rate_error(design: str) -> float:
    """Sum of the middle terms of eqs. (19), (20) over that of the assembled passive rates, less 1.

    The terms are those of the source, (‖v‖² − d²)/l² for both joints of each leg at a general
    screw; the rows of the passive rates are assembled from the legs.
    """
    posture = common.posture(design)
    q, hat = _random_screw()
    low = posture.design.base_points
    high = posture.pose.position + posture.lines.arm
    length, along = norm(high - low), unit(high - low)
    total = 0.0
    for points in (high, low):
        velocity = hat + cross(np.broadcast_to(q, points.shape), points)
        rate = (velocity * along).sum(axis=-1)
        total += float((((velocity**2).sum(axis=-1) - rate**2) / length**2).sum())
    twist = np.concatenate((hat + cross(q, posture.pose.position), q))
    return total / float(((posture.passive_rates(None) @ twist) ** 2).sum()) - 1.0


def screw_from_axis(pitch: float) -> Array:
    """[pitch, errors of direction and moment of the axis] that eq. (24) gives for a known screw."""
    point, direction = np.array([0.3, -1.2, 0.7]), unit(np.array([2.0, -1.0, 2.0]))
    q = 1.7 * direction
    hat = cross(point, q) + pitch * q
    found = float(q @ hat / (q @ q))
    axis, moment = q / norm(q), (hat - found * q) / norm(q)
    return np.array([found, norm(axis - direction), norm(moment - cross(point, direction))])


def off_diagonal_of_example(alpha_deg: float, h: float, origin: str) -> float:
    """Largest element beside the diagonals of T and N in S_K.

    With the origin in the centre of the platform, as the coordinates are printed ("platform"), or
    midway between base and platform ("midway").
    """
    heights = {"platform": -2.0 * h, "midway": -h}
    if origin not in heights:
        raise InvalidInput(expected("origin", "one of " + ", ".join(heights), repr(origin)))
    design = example_design(alpha_deg * RADIANS_PER_DEGREE)
    base = design.base_points + [0.0, 0.0, heights[origin]]
    top = design.platform_points + [0.0, 0.0, heights[origin] + 2.0 * h]
    pair = (
        source_matrices.angular_matrix(base, top),
        source_matrices.normal_matrix(base, top - base),
    )
    return float(max(np.abs(m - np.diag(np.diag(m))).max() for m in pair))


def greatest_quality(alpha_deg: float) -> float:
    """|det J| at h = sin(30° − α) in S_K over the greatest |det J| of the design over all poses."""
    design = example_design(alpha_deg * RADIANS_PER_DEGREE)
    best = example_pose(np.sin(np.pi / 6.0 - alpha_deg * RADIANS_PER_DEGREE))
    return float(manipulability(design.at(best))) / maximum(design, seed=0, store=False).value


def one_sided(index: str) -> float:
    """Return a value for six legs along path tangents of platform anchors, of a general screw.

    "rank" of J, "one-sided": the index if ζ is the sum over the base joints only, or "CTN".
    """
    points = np.random.default_rng(2).normal(size=(6, 3))
    q, hat = _random_screw()
    velocity = hat + cross(np.broadcast_to(q, points.shape), points)
    base = points - 0.8 * velocity
    posture = Design(["D1"] * 6, base, points).at(Pose([0.0, 0.0, 0.0]))
    if index == "rank":
        return float(np.linalg.matrix_rank(posture.homogeneous(1.0)))
    if index == "CTN":
        return float(control_number(posture) > 0.0)
    if index != "one-sided":
        raise InvalidInput(expected("index", "rank, one-sided, CTN", repr(index)))
    rows = source_matrices.passive_rows(points, base)
    return float(norm(rows @ np.concatenate((q, hat))) / norm(velocity).max())


def _lines_through(points: Array, others: Array) -> Array:
    return np.concatenate((others - points, cross(points, others)), axis=-1)


def _bundle(rng: np.random.Generator) -> Array:
    ends = rng.normal(size=(8, 3))
    return _lines_through(np.broadcast_to(rng.normal(size=3), ends.shape), ends)


def _field(rng: np.random.Generator) -> Array:
    axes, centre = rng.normal(size=(2, 3)), rng.normal(size=3)
    p, q = (centre + rng.normal(size=(8, 2)) @ axes for _ in range(2))
    return _lines_through(p, q)


def _regulus(rng: np.random.Generator) -> Array:
    p, q = (np.cumsum(rng.normal(size=(2, 3)), axis=0) for _ in range(2))
    share = rng.uniform(size=(8, 1))
    return _lines_through(p[0] + share * (p[1] - p[0]), q[0] + share * (q[1] - q[0]))


def _two_pencils(rng: np.random.Generator) -> Array:
    p, q, u, v = rng.normal(size=(4, 3))
    share = rng.uniform(-1.0, 1.0, size=(4, 1))
    first = _lines_through(np.broadcast_to(p, (4, 3)), q + share * (u - p))
    second = _lines_through(np.broadcast_to(q, (4, 3)), p + share * (v - q))
    return np.concatenate((first, second))


def _congruence(rng: np.random.Generator) -> Array:
    p, q, u, v = rng.normal(size=(4, 3))
    return _lines_through(p + rng.normal(size=(8, 1)) * u, q + rng.normal(size=(8, 1)) * v)


def _axis(rng: np.random.Generator) -> Array:
    p, u = rng.normal(size=(2, 3))
    return _lines_through(p + rng.normal(size=(8, 1)) * u, p + rng.normal(size=(8, 1)) * u)


def _parallel(rng: np.random.Generator) -> Array:
    points = rng.normal(size=(8, 3))
    return _lines_through(points, points + rng.normal(size=3))


_SYSTEMS: MappingProxyType[str, Callable[[np.random.Generator], Array]] = MappingProxyType(
    {
        "congruence": _congruence,
        "bundle": _bundle,
        "field": _field,
        "regulus": _regulus,
        "two pencils": _two_pencils,
        "one line": _axis,
        "parallel": _parallel,
    }
)


def rank_of_lines(system: str) -> int:
    """Rank of eight random lines of a linear system of lines."""
    if system not in _SYSTEMS:
        raise InvalidInput(expected("system", "one of " + ", ".join(_SYSTEMS), repr(system)))
    rows = _SYSTEMS[system](np.random.default_rng(3))
    return int(np.linalg.matrix_rank(rows / norm(rows)[:, None], tol=1e-10))


def free_parameters(g: int, turn: bool) -> int:
    """Free parameters of CTN = 1 in the set M, beside g and the factor of similarity.

    Twelve coordinates of two legs less the rank of the conditions T = λ N at a solution, less the
    turn about the z-axis, the shift along it and the similarity; and less the turn of one of the
    two sets against the other, on which T and N do not depend, if it is not counted.
    """
    angle = 2.0 * np.pi * np.arange(g) / g
    rotations = Pose.from_rpy(np.zeros(3), np.stack((0 * angle, 0 * angle, angle), axis=1)).rotation

    def conditions(u: Array) -> Array:
        low, high = (
            np.einsum("kij,sj->ksi", rotations, u[k : k + 6].reshape(2, 3)).reshape(-1, 3)
            for k in (0, 6)
        )
        t, n = (
            source_matrices.angular_matrix(low, high),
            source_matrices.normal_matrix(low, high - low),
        )
        return np.asarray((t / np.trace(t[3:, 3:]) - n / np.trace(n[3:, 3:]))[UPPER])

    start = np.random.default_rng(0).normal(size=12)
    found = least_squares(conditions, start, xtol=1e-15, ftol=1e-15, gtol=1e-15)
    if np.abs(found.fun).max() > 1e-12:
        raise InvalidInput("conditions CTN = 1: no solution found")
    steps = 1e-6 * np.eye(12)
    slopes = [conditions(found.x + s) - conditions(found.x - s) for s in steps]
    rank = int(np.linalg.matrix_rank(np.array(slopes), tol=1e-12))
    return 12 - rank - 3 - (0 if turn else 1)


def planar_control_number(g: int, angle: float) -> float:
    """CTN of the projected legs with a and b at an angle on the circle a² + b² = 2/3."""
    a, b = np.sqrt(2.0 / 3.0) * np.array([np.cos(angle), np.sin(angle)])
    feet, directions = line_configuration(g, np.sqrt(3.0) / 3.0, 1.0, 0.0)
    feet, directions = feet[:g] * [1.0, 1.0, 0.0], directions[:g]
    x, y = feet + a * directions, feet + b * directions
    n = source_matrices.normal_matrix(x, y - x)[source_matrices.PLANAR]
    return 1.0 / source_matrices.root_of_eigenvalue_ratio(
        source_matrices.angular_matrix(x, y)[source_matrices.PLANAR], n
    )


def sum_of_squares(p: float) -> float:
    """a² + b² of the anchors that make T and N similar: eqs. (33) solved."""
    return float((source_matrices.best_anchors(3, p) ** 2).sum())


def condition_number_at(design: str, shift: float, scale: float, turn: float) -> float:
    """Ratio of CDN for another reference frame, of a length 1, to that of the frame of the design.

    The frame is shifted, made larger, and turned [rad] about the z-axis.
    """
    posture = common.posture(design)
    low = posture.design.base_points
    high = posture.pose.position + posture.lines.arm
    rotation = Pose.from_rpy([0.0, 0.0, 0.0], [0.0, 0.0, turn]).rotation
    values = []
    for s, k, r in ((0.0, 1.0, np.eye(3)), (shift, scale, rotation)):
        a, b = (k * (points @ r.T) + [s, 0.0, 0.0] for points in (low, high))
        moved = Design(["D1"] * len(a), a, b).at(Pose([0.0, 0.0, 0.0]))
        values.append(float(condition_number(moved, 1.0)))
    return values[1] / values[0]


QUANTITIES = (
    leg_rate_error,
    vertex_speed_error,
    passive_rate_error,
    screw_from_axis,
    off_diagonal_of_example,
    greatest_quality,
    one_sided,
    rank_of_lines,
    free_parameters,
    planar_control_number,
    sum_of_squares,
    condition_number_at,
)
