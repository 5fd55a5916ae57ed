"""Sections of workspaces: ray ends, the curves through them, and the section made of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array, check_integer, check_memory
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, frozen
from gsp.limits.bounds import bounded_quantities
from gsp.limits.labels import label
from gsp.limits.limits import Limits
from gsp.limits.quantities import BoundedQuantities
from gsp.model.design import Design
from gsp.progress import Progress, Steps, meter
from gsp.workspace.boundary.branches import Branch
from gsp.workspace.boundary.climb import CLIMB_STEPS
from gsp.workspace.boundary.critical import Chart, Points
from gsp.workspace.boundary.network import CURVE_STEPS, MOST_CURVES, Network
from gsp.workspace.boundary.orientations import feasible_orientations
from gsp.workspace.boundary.rays import RayEnds, ray_ends
from gsp.workspace.boundary.sections import BifurcationPoint, Curve, Section
from gsp.workspace.boundary.tracing import Node, Tracer
from gsp.workspace.planes import plane_frame

# Memory for each ray from one orientation [bytes]: its end, and the state of its climb.
RAY_BYTES = 1000


@arguments.validated(connecting=arguments.flag)
def section(
    design: Design,
    origin: ArrayLike | None = None,
    axes: ArrayLike = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    *,
    rotation: ArrayLike | None = None,
    limits: Limits | None = None,
    rays: int | ArrayLike = 24,
    starts: int = 24,
    rng: np.random.Generator | int = 0,
    connecting: bool = True,
    most: int = MOST_CURVES,
    budget: int = CURVE_STEPS,
    progress: Progress = None,
) -> Section:
    """Return the boundary, in a plane, of the workspace that rays from a point of it reach.

    Rays from the radiating point are climbed from several orientations each; every end that is a
    local maximum of the distance starts a curve, which is followed by continuation to the
    bifurcation points at its ends, and from there on along all branches that are local maxima. All
    branches are reported, the near-global ones too. So these are the boundary curves that are
    connected to a ray end. A component of the workspace that no ray reaches is left out, such as
    the mirror image below the base: call the function with a point in it.

    A climb ends before every gap that is wider than 1/128 of the size of the design, or of the
    distance from the radiating point if that is more: poses as close as this on its way are
    feasible. So with a fixed orientation a ray ends where it first leaves the workspace. With free
    orientations its end is a local maximum: another start may go farther. The checks of the ends
    prove nothing; `gsp.workspace.reachable` proves what is inside and outside. For SPS legs with a
    fixed orientation `gsp.workspace.exact_shells` has the sections of all components.

    Parameters
    ----------
    design : Design
    origin : (3,) array_like or None [length]
        The radiating point u0; default the position of the design's home pose.
    axes : (2, 3) array_like [any length]
        Two directions that span the plane.
    rotation : (3, 3) array_like or None [1]
        A fixed orientation; default none, any orientation is allowed.
    limits : Limits or None
        Default: the strokes of the design.
    rays : int or (q,) array_like [rad]
        Number of rays all around, or their angles from axes[0] toward axes[1].
    starts : int
        Orientations per ray: the home orientation and the identity, if feasible, then random
        feasible ones.
    rng : numpy.random.Generator or int
        Generator or seed of the orientations.
    connecting : bool
        Whether to follow the curves between complete bifurcation points as well.
    most : int
        Greatest number of curves, as in `boundary_curves`; see `Section.stopped_by`.
    budget : int
        Greatest number of steps along curves, as in `boundary_curves`; see `Section.waiting`.
    progress : function (done, known so far), bool or None
        Called after each step of the rays and along the curves: with the steps done, and these
        and the ones ahead, 25 for a curve that is known and not yet followed. False: no output;
        None or True: a progress bar.

    Returns
    -------
    Section

    Raises
    ------
    EmptyWorkspace
        If `rotation` is not feasible at the radiating point; without it, if none of the home
        orientation, the identity and 20,000 random ones is, which proves nothing.
    MissingParameter
        Without limits.
    InvalidInput
        Without a radiating point; on limits that cross, strokes of zero, or wrong arguments.

    *Source: Workspace-3, §3.4, eqs. (3.9)–(3.18), and Workspace-A, appendix B. The continuation,
    the checks and the connecting rule are ours.*
    """
    bounds = bounded_quantities(design, limits)
    start, frame = _plane(design, origin, axes)
    turns = np.eye(3) if rotation is None else np.zeros((0, 3))
    phi = ray_angles(rays)
    number, steps_left = check_integer("most", most), check_integer("budget", budget)
    with meter(progress, "boundary") as report:
        steps = Steps(report, ahead=CLIMB_STEPS)
        orientations = feasible_orientations(design, bounds, start, rotation, starts, rng)
        ends = fan(bounds, turns, start, frame, phi, orientations, steps)
        network = Network(Tracer(Chart(bounds, frame, turns)), number, steps, budget=steps_left)
        return map_section(network, start, ends, connecting)


def ray_angles(rays: int | ArrayLike) -> Array:
    """Return the angles of rays in a plane [rad], (q,): given ones, or a number of equal steps."""
    if isinstance(rays, bool | np.bool_) or not isinstance(rays, int | np.integer):
        angles = check_array("rays", rays, (None,))
        if angles.ndim != 1 or not angles.size:
            raise InvalidInput(expected("rays", "a number or angles, (q,)", brief(rays)))
        return angles
    number = check_memory("rays", check_integer("rays", rays), RAY_BYTES, "rays")
    return np.asarray(np.arange(number) * (2.0 * np.pi / number), dtype=np.float64)


def fan(
    bounds: BoundedQuantities,
    turns: Array,
    origin: Array,
    axes: Array,
    phi: Array,
    orientations: Array,
    steps: Steps,
) -> RayEnds:
    """Return the ends of rays in a plane, for each ray from each of the orientations."""
    number = len(orientations)
    check_memory("rays, times starts", len(phi) * number, RAY_BYTES, "rays")
    heading = np.stack((np.cos(phi), np.sin(phi)), axis=-1) @ axes
    return ray_ends(
        bounds,
        turns,
        np.broadcast_to(origin, (len(phi) * number, 3)),
        np.tile(orientations, (len(phi), 1, 1)),
        np.repeat(heading, number, axis=0),
        steps,
    )


def map_section(
    network: Network,
    origin: Array,
    ends: RayEnds,
    connecting: bool,
    corners: Points | None = None,
) -> Section:
    """Follow all curves that are connected with ray ends or known bifurcation points."""
    for i in _different(ends, ends.bounds.scale):
        network.add_seed(*ends.seed(i))
    for i in range(0 if corners is None else len(corners.position)):
        network.add_node(corners[[i]])  # type: ignore[index]
    if connecting:
        network.connect()
    return section_of(network, origin, ends)


def section_of(network: Network, origin: Array, ends: RayEnds) -> Section:
    """Return the section that the nodes and branches of a network make."""
    chart, network.steps.ahead = network.tracer.chart, 0
    return Section(
        frozen(origin),
        frozen(chart.axes),
        tuple(_bifurcation(node, chart.bounds) for node in network.nodes),
        tuple(_curve(branch, network.tracer, network.steps) for branch in network.branches),
        ends,
        frozen(chart.turns),
        network.waiting,
        stopped_by=network.stopped_by,
    )


def _plane(design: Design, origin: ArrayLike | None, axes: ArrayLike) -> tuple[Array, Array]:
    if origin is None:
        if design.home is None:
            raise InvalidInput(expected("origin", "a point, as the design has no home pose", None))
        origin = design.home.position
    start, frame = plane_frame(origin, axes)
    return start, frame[:2]


def _different(ends: RayEnds, size: float) -> list[int]:
    """Return the ends that are local maxima, each once, the farthest first."""
    seen: set[tuple[object, ...]] = set()
    result = []
    for i in np.argsort(-ends.distance):
        place = (ends.position[i] / size).round(6) + 0.0
        key = (ends.active[i], *place, *(ends.rotation[i].round(6) + 0.0).ravel())
        if ends.maximal[i] and key not in seen:
            seen.add(key)
            result.append(int(i))
    return result


def _bifurcation(node: Node, bounds: BoundedQuantities) -> BifurcationPoint:
    position, rotation = node.points.position[0], node.points.rotation[0]
    values = bounds.quantities.values(position, rotation)
    text = label(node.active, bounds.names, bounds.joints)
    return BifurcationPoint(text, Pose(position, rotation), frozen(values))


def _curve(branch: Branch, tracer: Tracer, steps: Steps) -> Curve:
    bounds, trace = tracer.chart.bounds, branch.trace
    steps()
    return Curve(
        label=label(branch.held, bounds.names, bounds.joints),
        pose=Pose(trace.points.position, trace.points.rotation),
        weight=frozen(trace.points.weight),
        maximal=tracer.maximal(trace.points, trace.active),
        first=branch.first,
        last=branch.last,
        connecting=branch.connecting,
        status=trace.status,
        active=trace.active,
        held=branch.held,
    )
