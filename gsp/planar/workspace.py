"""The planar program: boundary, bifurcation points and connecting curves of a planar platform."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_integer, check_rng, check_type
from gsp.errors import EmptyWorkspace, InvalidInput, MissingParameter, expected
from gsp.geometry.frames import exp3
from gsp.geometry.matrices import RESIDUAL_TOLERANCE, newton, solve_least_squares
from gsp.geometry.vectors import Array, Mask, norm
from gsp.limits.quantities import (
    BoundedQuantities,
    Quantities,
    check_bounds,
    point_distances,
)
from gsp.planar.design import PlanarDesign
from gsp.planar.pose import PlanarPose
from gsp.progress import Progress, meter
from gsp.workspace.boundary.critical import Points
from gsp.workspace.boundary.mapping import START_SLACK, fan, map_section, ray_angles
from gsp.workspace.boundary.sections import Section
from gsp.workspace.boundary.tracing import POSE_TOLERANCE

AXES = np.eye(3)[:2]
SPIN = np.eye(3)[2:]
# Steps of Newton's method, and the longest of them [share of the scale, rad].
NEWTON_STEPS, LONGEST_NEWTON_STEP = 60, 0.5
# Residual at which iterations end [share of the scale]. Where two assembly modes meet, the error of
# a pose is the square root of it, and the modes are separated by POSE_TOLERANCE.
RESIDUAL_AT_REST = 1e-15
# Random angles among which feasible ones are sought at the radiating point.
ANGLES_TRIED = 20_000


def planar_bounds(design: PlanarDesign) -> BoundedQuantities:
    """Return the strokes of a planar design as quantities between bounds, for poses in space."""
    check_type("design", design, PlanarDesign)
    if design.strokes is None:
        raise MissingParameter(f"planar design {design.name!r}: expected strokes, received none")
    strokes = np.where(np.isnan(design.strokes), (-np.inf, np.inf), design.strokes)
    check_bounds(strokes[:, 0], strokes[:, 1], design.joint_names)

    def pose(position: Array, rotation: Array) -> PlanarPose:
        return PlanarPose(position[..., :2], np.arctan2(rotation[..., 1, 0], rotation[..., 0, 0]))

    def values(position: Array, rotation: Array) -> Array:
        return design.at(pose(position, rotation)).joints

    def evaluate(position: Array, rotation: Array) -> tuple[Array, Array]:
        posture = design.at(pose(position, rotation))
        rows = np.zeros((*posture.joints.shape, 6))
        rows[..., [0, 1, 5]] = posture.jacobian
        return posture.joints, rows

    quantities = Quantities(values, evaluate)
    if all(leg.name == "D1" for leg in design.legs):
        quantities = point_distances(
            _in_space(design.base_points), _in_space(design.platform_points)
        )
    low, high = strokes.T
    size = design.rms_radius
    sizes = np.full(design.n_legs, size)
    return BoundedQuantities(design.joint_names, low, high, quantities, size, design.n_legs, sizes)


def _in_space(points: Array) -> Array:
    return np.concatenate((points, np.zeros((len(points), 1))), axis=1)


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
        raise MissingParameter("radiating point: expected both limits of every stroke")
    angles = np.linspace(-np.pi, np.pi, 24, endpoint=False)
    poses, ok = _assemble(bounds, middle, np.broadcast_to(start, (24, 2)), angles)
    if not ok.any():
        raise EmptyWorkspace(
            f"radiating point: expected a pose with the joints {middle.tolist()}, received none "
            f"from the guess {start.tolist()}"
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
        If it has not three legs with both limits, or on arguments of other types.

    *Source: Workspace-A, §A.2 and eq. (A.12)*
    """
    bounds = planar_bounds(design)
    if design.n_legs != 3 or not np.isfinite([bounds.low, bounds.high]).all():
        raise InvalidInput(expected("design", "three legs with both limits", design.n_legs))
    generator, starts = check_rng("rng", rng), check_integer("starts", starts)
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


@arguments.validated(connecting=arguments.flag)
def planar_section(
    design: PlanarDesign,
    origin: ArrayLike | None = None,
    *,
    angle: float | None = None,
    rays: int | ArrayLike = 36,
    starts: int = 16,
    rng: np.random.Generator | int = 0,
    connecting: bool = True,
    most: int = 400,
    progress: Progress = None,
) -> Section:
    """Return the workspace of a planar platform: boundary, bifurcation points, curves.

    Parameters
    ----------
    design : PlanarDesign
        With strokes.
    origin : (2,) array_like or None [length]
        The radiating point; default the position of the design's home pose: see also
        `radiating_point`.
    angle : float or None [rad]
        A fixed orientation; default any.
    rays : int or (q,) array_like [rad]
        Number of rays all around, or their angles from the x-axis.
    starts : int
        Angles of the platform per ray: that of the home pose, if feasible, and random ones.
    rng : numpy.random.Generator or int
        Generator or seed of these angles.
    connecting : bool
        Whether to follow the curves between complete bifurcation points as well.
    most : int
        Greatest number of curves.
    progress : function (done, known so far), bool or None
        Called after each curve; False: no output; None or True: a progress bar.

    Returns
    -------
    Section
        In the plane z = 0; with free orientation and three legs its bifurcation points include
        all of `corner_poses`.

    Raises
    ------
    EmptyWorkspace
        If no angle is feasible at the radiating point.
    MissingParameter
        Without strokes or a radiating point.
    InvalidInput
        On arguments of other types, shapes or ranges.

    *Source: Workspace-A, appendix A*
    """
    bounds = planar_bounds(design)
    if origin is None and design.home is None:
        raise MissingParameter("planar workspace: expected origin, as the design has no home pose")
    place = design.home.position if origin is None else check_array("origin", origin, (2,))  # type: ignore[union-attr]
    if place.ndim != 1:
        raise InvalidInput(expected("origin", "a single point", f"shape {place.shape}"))
    start = np.append(place, 0.0)
    turns = SPIN if angle is None else np.zeros((0, 3))
    phi, number = ray_angles(rays), check_integer("most", most)
    with meter(progress, "curves") as report:
        orientations = _orientations(design, bounds, start, angle, starts, check_rng("rng", rng))
        ends = fan(bounds, turns, start, AXES, phi, orientations)
        corners = None
        finite = bool(np.isfinite([bounds.low, bounds.high]).all())
        if angle is None and design.n_legs == 3 and finite:
            corners = _corner_points(corner_poses(design, rng=rng))
        return map_section(bounds, turns, start, AXES, ends, connecting, number, report, corners)


def _corner_points(found: dict[str, PlanarPose]) -> Points:
    position = np.concatenate([pose.position for pose in found.values()])
    angle = np.concatenate([pose.angle for pose in found.values()])
    spatial = PlanarPose(position, angle).spatial()
    return Points(spatial.position, spatial.rotation, np.zeros((len(angle), 0)))


def _orientations(
    design: PlanarDesign,
    bounds: BoundedQuantities,
    start: Array,
    angle: float | None,
    starts: int,
    rng: np.random.Generator,
) -> Array:
    home = [] if design.home is None else [float(design.home.angle)]
    tries = np.concatenate((home, rng.uniform(-np.pi, np.pi, ANGLES_TRIED)))
    angles = tries if angle is None else np.array([check_array("angle", angle, ())])
    if angles.ndim != 1:
        raise InvalidInput(expected("angle", "one angle", f"shape {angles.shape[1:]}"))
    check_integer("starts", starts)
    rotation = exp3(angles[:, None] * SPIN)
    inside = bounds.allowed(np.broadcast_to(start, (len(angles), 3)), rotation, -START_SLACK)
    if not inside.any():
        raise EmptyWorkspace(
            f"radiating point {start[:2].tolist()}: expected a feasible angle, received none "
            f"({len(angles)} tried)"
        )
    return rotation[inside][:starts]


def _assemble(
    bounds: BoundedQuantities, target: Array, position: Array, angle: Array
) -> tuple[Array, Mask]:
    """Poses (N, 3) with joints at a target, by damped Newton steps, and which are solved."""
    scale = np.array([bounds.scale, bounds.scale, 1.0])

    def equations(poses: Array) -> tuple[Array, Array]:
        place = np.concatenate((poses[:, :2], np.zeros((len(poses), 1))), axis=1)
        values, rows = bounds.evaluate(place, exp3(poses[:, 2:] * SPIN))
        gap = np.nan_to_num((values - target) / bounds.scale, nan=1.0)
        return gap, np.nan_to_num(rows[..., [0, 1, 5]]) * scale / bounds.scale

    poses, residual = newton(
        np.concatenate((position, angle[:, None]), axis=1),
        equations,
        lambda poses, step: poses + step * scale,
        solve=solve_least_squares,
        longest=LONGEST_NEWTON_STEP,
        most=NEWTON_STEPS,
        rest=RESIDUAL_AT_REST,
    )
    poses[:, 2] = (poses[:, 2] + np.pi) % (2.0 * np.pi) - np.pi
    return poses, np.asarray(residual < RESIDUAL_TOLERANCE)


def _unique(poses: Array, size: float) -> Array:
    kept: list[Array] = []
    for pose in poses:
        if not any(_apart(pose, other, size) < POSE_TOLERANCE for other in kept):
            kept.append(pose)
    return np.array(kept).reshape(-1, 3)


def _apart(one: Array, other: Array, size: float) -> float:
    spin = abs(np.angle(np.exp(1j * (one[2] - other[2]))))
    return float(norm(one[:2] - other[:2]) / size + spin)
