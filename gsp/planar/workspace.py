"""The workspace of a planar platform: its boundary, with the curves between corner poses."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_integer, check_rng, check_type
from gsp.errors import EmptyWorkspace, InvalidInput, MissingParameter, expected
from gsp.geometry.frames import exp3
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask, frozen
from gsp.limits.labels import label
from gsp.limits.quantities import BoundedQuantities
from gsp.planar.allowed import Legs
from gsp.planar.bounds import planar_bounds
from gsp.planar.corners import PLANE_NORMAL, corner_poses
from gsp.planar.design import PlanarDesign
from gsp.planar.outlines import PlanarComponent, components
from gsp.planar.pose import PlanarPose
from gsp.progress import Progress, Steps, meter
from gsp.workspace.boundary.climb import CLIMB_STEPS
from gsp.workspace.boundary.critical import Chart, Points
from gsp.workspace.boundary.mapping import fan, map_section, ray_angles
from gsp.workspace.boundary.network import Network
from gsp.workspace.boundary.orientations import START_SLACK
from gsp.workspace.boundary.rays import RayEnds
from gsp.workspace.boundary.sections import BifurcationPoint, Curve, Section
from gsp.workspace.boundary.tracing import Tracer

PLANE = np.eye(3)[:2]
# Random angles among which feasible ones are sought at the radiating point.
ANGLES_TRIED = 20_000
# Rays beside a bifurcation point [rad], and how near to it they meet a curve that ends there
# [share of the scale].
BESIDE, SAME_DISTANCE = 1e-7, 1e-4


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

    With a fixed angle the curves are the boundaries of all components, exactly, in the order of
    `planar_components`, whether a ray reaches them or not. Only where the strokes do not bound the
    positions (`planar_components` raises InvalidInput) they are those that rays reach. A ray itself
    ends where it first leaves the workspace.

    With free orientation the curves are those that are connected with ray ends or complete
    bifurcation points. The ends of rays are local maxima that poses lead to from the radiating
    point, so a component without a complete bifurcation point may be left out: call the function
    with a point in it.

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
        Whether to follow the curves between complete bifurcation points as well; with a fixed angle
        there are none.
    most : int
        Greatest number of curves that are followed.
    progress : function (done, known so far), bool or None
        Called after each step of the rays and along the curves: with the steps done, and these
        and the ones ahead, 25 for a curve that is known and not yet followed. False: no output;
        None or True: a progress bar.

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
    turns = PLANE_NORMAL if angle is None else np.zeros((0, 3))
    phi, number = ray_angles(rays), check_integer("most", most)
    with meter(progress, "boundary") as report:
        steps = Steps(report, ahead=CLIMB_STEPS)
        orientations = _orientations(design, bounds, start, angle, starts, check_rng("rng", rng))
        ends = fan(bounds, turns, start, PLANE, phi, orientations, steps)
        if angle is not None and (legs := Legs.of(design, bounds, float(angle))).disc is not None:
            steps.ahead = 0
            return _exact(components(legs), orientations[0], start, ends)
        corners = None
        finite = bool(np.isfinite([bounds.low, bounds.high]).all())
        if angle is None and design.n_legs == 3 and finite:
            corners = _corner_points(corner_poses(design, rng=rng))
        network = Network(Tracer(Chart(bounds, PLANE, turns)), number, steps)
        return map_section(network, start, ends, connecting, corners)


def _exact(
    parts: tuple[PlanarComponent, ...], rotation: Array, origin: Array, ends: RayEnds
) -> Section:
    """Return the section of components at a fixed orientation (3, 3), the curves part by part."""
    bounds = ends.bounds
    numbers: dict[int, int] = {}
    points: list[tuple[int, Array]] = []
    curves = []
    held: dict[int, set[tuple[int, int]]] = {}
    for piece in (piece for part in parts for piece in part.pieces):
        n = len(piece.points)
        place = np.concatenate((piece.points, np.zeros((n, 1))), axis=1)
        for vertex, at in ((piece.first, 0), (piece.last, -1)):
            if vertex is not None:
                held.setdefault(vertex, set()).update(piece.active)
                if vertex not in numbers:
                    numbers[vertex] = len(points)
                    points.append((vertex, place[at]))
        curves.append(
            Curve(
                label=label(piece.active, bounds.names, bounds.joints),
                pose=Pose(place, np.broadcast_to(rotation, (n, 3, 3))),
                weight=frozen(np.ones((n, 1))),
                maximal=np.ones(n, dtype=bool),
                first=None if piece.first is None else numbers[piece.first],
                last=None if piece.last is None else numbers[piece.last],
                connecting=False,
                status="closed" if piece.first is None else "complete",
                active=piece.active[:1],
                held=piece.active,
            )
        )
    bifurcations = tuple(
        BifurcationPoint(
            label(tuple(sorted(held[vertex])), bounds.names, bounds.joints),
            Pose(place, rotation),
            frozen(bounds.quantities.values(place, rotation)),
        )
        for vertex, place in points
    )
    turns = frozen(np.zeros((0, 3)))
    return Section(frozen(origin), frozen(PLANE), bifurcations, tuple(curves), ends, turns)


def on_boundary(section: Section) -> Mask:
    """Return which bifurcation points are on the boundary, as seen from the radiating point.

    Parameters
    ----------
    section : Section
        As `planar_section` or `gsp.workspace.section` returns it.

    Returns
    -------
    (n,) bool array
        For each of `section.bifurcations` whether it is the farthest point on its ray: the labels
        of those are the rows of the matrix IDBound of the source.

    Raises
    ------
    InvalidInput
        If `section` is not a section.

    *Source: Workspace-A, §A.2.2 and eq. (A.13)*
    """
    check_type("section", section, Section)
    if not section.bifurcations:
        return np.zeros(0, dtype=bool)
    points = np.array([point.pose.position for point in section.bifurcations])
    flat = (points - section.origin) @ section.axes.T
    angle, n = np.arctan2(flat[:, 1], flat[:, 0]), len(flat)
    # Curves end at the point: at its own angle a ray may pass beside both.
    frame = section.on_rays(np.concatenate((angle - BESIDE, angle + BESIDE)))
    farthest = np.full(2 * n, np.nan)
    outer = frame[frame["outer"]]
    farthest[outer["ray"].to_numpy(dtype=int)] = outer["distance"]
    gap = np.abs(farthest.reshape(2, n) - np.hypot(*flat.T)) / section.bounds.scale
    return np.asarray((gap < SAME_DISTANCE).any(axis=0))


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
    rotation = exp3(angles[:, None] * PLANE_NORMAL)
    inside = bounds.allowed(np.broadcast_to(start, (len(angles), 3)), rotation, -START_SLACK)
    if not inside.any():
        place = start[:2].tolist()
        if angle is not None:
            wanted = f"one that is feasible at the radiating point {place}"
            raise EmptyWorkspace(expected("angle", wanted, "one that is not"))
        wanted = "a radiating point with a feasible angle"
        raise EmptyWorkspace(
            expected("position", wanted, f"{place}, where none of {len(angles)} is")
        )
    return rotation[inside][:starts]
