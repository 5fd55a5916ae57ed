"""Plane sections of workspaces: bifurcation points, labelled curves, ray ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from gsp.design import Design
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.pose import Pose, check_rotation
from gsp.vectors import Array, Mask, check_array, cross, frozen, norm, unit
from gsp.workspace.critical import Active, Chart, Points, between
from gsp.workspace.labels import active_from_label, label
from gsp.workspace.limits import Limits, restraints
from gsp.workspace.network import Branch, Network, Progress
from gsp.workspace.rays import RayEnds, certify, on_ray, ray_ends
from gsp.workspace.restraints import Restraints
from gsp.workspace.tracing import Node, Tracer

TRIES = 20_000


@dataclass(frozen=True, eq=False)
class BifurcationPoint:
    """A point where boundary curves meet.

    Attributes
    ----------
    label : str
        Which joints are at their least (0) and greatest (1) value.
    pose : Pose
    joints : (m,) array
        The bounded quantities there: joints first.
    """

    label: str
    pose: Pose
    joints: Array


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve on which the same constraints are active, from one end to the other.

    Attributes
    ----------
    label : str
    pose : Pose, batch shape (N,)
    weight : (N, n) array
        Multipliers of the active constraints, Σ λ² = 1.
    maximal : (N,) bool array
        Where the curve is a local maximum along its outward normal: a boundary of what can be
        reached without changing the branch. Elsewhere it only connects bifurcation points.
    first, last : int or None
        Numbers of the bifurcation points at its ends.
    connecting : bool
        Whether it was followed as a connecting curve, not as a boundary.
    closed, lost : bool
        Whether it returns to its start; whether it could not be followed to an end.
    active, held : tuples of (quantity, side)
        The independent constraints that the weights belong to; all that stay at their bounds.
    """

    label: str
    pose: Pose
    weight: Array
    maximal: Mask
    first: int | None
    last: int | None
    connecting: bool
    closed: bool
    lost: bool
    active: Active
    held: Active


@dataclass(frozen=True, eq=False)
class Section:
    """A plane section of a workspace.

    Attributes
    ----------
    origin : (3,) array [length]
        The radiating point u0.
    axes : (2, 3) array
        Orthonormal; a ray of angle φ goes along cos φ axes[0] + sin φ axes[1].
    bifurcations : tuple of BifurcationPoint
    curves : tuple of Curve
    ends : RayEnds
        The ray ends that the curves were followed from.
    turns : (k, 3) array
        Axes of the free turns.
    """

    origin: Array
    axes: Array
    bifurcations: tuple[BifurcationPoint, ...]
    curves: tuple[Curve, ...]
    ends: RayEnds
    turns: Array

    @property
    def restraints(self) -> Restraints:
        """The bounded quantities."""
        return self.ends.restraints

    def find(self, text: str) -> tuple[int, ...]:
        """Return the numbers of the curves with a label, in any spelling."""
        wanted = active_from_label(text, self.restraints.joints)
        return tuple(i for i, curve in enumerate(self.curves) if curve.held == wanted)

    def table(self, order: str = "approach-roll") -> pd.DataFrame:
        """Return the points of all curves: a row a point, with its angles [deg] in an order.

        Columns: curve, label, x, y, z, alpha, beta, gamma, maximal, connecting, first, last.
        """
        parts = []
        for number, curve in enumerate(self.curves):
            angles = curve.pose.angles(order, degrees=True)
            columns = dict(zip("xyz", curve.pose.position.T, strict=True))
            columns |= dict(zip(("alpha", "beta", "gamma"), angles.T, strict=True))
            part = pd.DataFrame(columns)
            part.insert(0, "curve", number)
            part.insert(1, "label", curve.label)
            part["maximal"], part["connecting"] = curve.maximal, curve.connecting
            part["first"], part["last"] = curve.first, curve.last
            parts.append(part)
        return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()

    def bifurcation_table(self, order: str = "approach-roll") -> pd.DataFrame:
        """Return the bifurcation points: label, x, y, z, angles [deg], and the joints."""
        rows = [
            (b.label, *b.pose.position, *b.pose.angles(order, degrees=True), *b.joints)
            for b in self.bifurcations
        ]
        names = ("label", "x", "y", "z", "alpha", "beta", "gamma", *self.restraints.names)
        return pd.DataFrame(rows, columns=list(names))

    def outer_bifurcations(self) -> tuple[int, ...]:
        """Return the numbers of the bifurcation points that no farther ray end hides.

        *Source: Workspace-A, §A.2.2: those that the mapping of the boundary finds*
        """
        offset = np.array([b.pose.position for b in self.bifurcations]).reshape(-1, 3) - self.origin
        flat = offset @ self.axes.T
        reach, phi = norm(flat), np.arctan2(flat[:, 1], flat[:, 0])
        nudge = 1e-6
        frame = self.on_rays(np.concatenate((phi - nudge, phi + nudge)))
        far = frame[frame["outer"]].groupby(frame["ray"] % max(len(phi), 1))["distance"].min()
        slack = 1e-4 * self.restraints.size
        return tuple(int(i) for i in far.index if reach[i] >= far[i] - slack)

    def on_rays(self, angles: ArrayLike) -> pd.DataFrame:
        """Where rays meet the curves, solved to rounding.

        Parameters
        ----------
        angles : (q,) array_like [rad]
            From axes[0] toward axes[1].

        Returns
        -------
        pandas.DataFrame
            A row a crossing: ray, angle, curve, label, distance, x, y, z, maximal (a local
            maximum along the ray), outer (the farthest of those on its ray). Crossings that could
            not be solved are marked by solved = False, and are never maximal.
        """
        phi = check_array("angles", angles, (None,))
        rows = [row for i in range(len(self.curves)) for row in self._crossings(i, phi)]
        columns = ["ray", "angle", "curve", "label", "distance", "x", "y", "z", "solved", "maximal"]
        frame = pd.DataFrame(rows, columns=columns).sort_values(
            ["ray", "distance"], ignore_index=True
        )
        farthest = frame[frame["maximal"]].groupby("ray")["distance"].transform("max")
        frame["outer"] = (frame["distance"] == farthest.reindex(frame.index)) & frame["maximal"]
        return frame

    def _crossings(self, number: int, phi: Array) -> list[tuple[object, ...]]:
        curve = self.curves[number]
        flat = (curve.pose.position - self.origin) @ self.axes.T
        heading = np.stack((np.cos(phi), np.sin(phi)), axis=-1)
        offset = np.outer(heading[:, 0], flat[:, 1]) - np.outer(heading[:, 1], flat[:, 0])
        ahead = heading @ flat.T > 0.0
        crosses = (offset[:, :-1] * offset[:, 1:] <= 0.0) & (ahead[:, :-1] | ahead[:, 1:])
        crosses &= offset[:, :-1] != 0.0
        ray, place = np.nonzero(crosses)
        if not len(ray):
            return []
        before, after = np.abs(offset[ray, place]), np.abs(offset[ray, place + 1])
        guess = between(
            Points(curve.pose.position, curve.pose.rotation, curve.weight),
            place,
            before / (before + after),
        )
        chart = Chart(self.restraints, np.eye(3), self.turns)
        direction = heading[ray] @ self.axes
        points, solved, jet = chart.solve(
            guess, curve.active, on_ray(chart, self.origin, direction)
        )
        reach = np.einsum("ij,ij->i", points.position - self.origin, direction)
        behind = solved & (reach <= 0.0)
        solved &= norm(points.position - guess.position) < self.restraints.size
        why = certify(chart, points, jet, curve.active, direction, solved)
        return [
            (int(ray[i]), phi[ray[i]], number, curve.label, reach[i], *points.position[i],
             bool(solved[i]), not why[i])
            for i in np.flatnonzero(~behind)
        ]  # fmt: skip


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
    most: int = 200,
    progress: Progress = None,
) -> Section:
    """Map the boundary of a workspace in a plane: ray ends, bifurcation points, curves.

    Rays from the radiating point are climbed from several orientations each; every end that is
    certified starts a curve, which is followed by continuation to the bifurcation points at its
    ends, and from there on along all branches that are local maxima. All branches are reported,
    the near-global ones too.

    Parameters
    ----------
    design : Design
    origin : (3,) array_like or None [length]
        The radiating point u0; default the position of the design's home pose.
    axes : (2, 3) array_like
        Two directions that span the plane.
    rotation : (3, 3) array_like or None
        A fixed orientation; default none, any orientation is allowed.
    limits : Limits or None
        Default: the strokes of the design.
    rays : int or (q,) array_like [rad]
        Number of rays all around, or their angles from axes[0] toward axes[1].
    starts : int
        Orientations per ray: the home orientation, if feasible, and random feasible ones.
    rng : Generator or int
        For the orientations.
    connecting : bool
        Whether to follow the curves between complete bifurcation points as well.
    most : int
        Greatest number of curves.
    progress : function (done, known so far) or None

    Raises
    ------
    EmptyWorkspace
        If no orientation is feasible at the radiating point.
    MissingParameter, InvalidInput
        Without limits or radiating point; on limits that cross or strokes of zero.

    *Source: Workspace-3, §3.4, eqs. (3.9)–(3.18), and Workspace-A, appendix B. The continuation,
    the certificates and the connecting rule are ours.*
    """
    bounds = restraints(design, limits)
    start, frame = _plane(design, origin, axes)
    turns = np.eye(3) if rotation is None else np.zeros((0, 3))
    orientations = feasible_orientations(design, bounds, start, rotation, starts, rng)
    phi = (
        np.arange(rays) * (2.0 * np.pi / rays)
        if isinstance(rays, int)
        else check_array("rays", rays, (None,))
    )
    heading = np.stack((np.cos(phi), np.sin(phi)), axis=-1) @ frame
    number = len(orientations)
    ends = ray_ends(
        bounds,
        turns,
        np.broadcast_to(start, (len(phi) * number, 3)),
        np.tile(orientations, (len(phi), 1, 1)),
        np.repeat(heading, number, axis=0),
    )
    return map_section(bounds, turns, start, frame, ends, connecting, most, progress)


def map_section(
    bounds: Restraints, turns: Array, origin: Array, axes: Array, ends: RayEnds,
    connecting: bool, most: int, progress: Progress, corners: Points | None = None,
) -> Section:  # fmt: skip
    """Follow the curves from ray ends and from known bifurcation points, and what they lead to."""
    network = Network(Tracer(Chart(bounds, axes, turns)), most, progress)
    for i in _different(ends, bounds.size):
        used = ends.weight[i] != 0.0
        active = tuple(a for a, w in zip(ends.active[i], used, strict=True) if w)
        point = Points(ends.position[[i]], ends.rotation[[i]], ends.weight[i][None, used])
        network.add_seed(point, active)
    for i in range(0 if corners is None else len(corners.position)):
        network.add_node(corners[[i]])  # type: ignore[index]
    if connecting:
        network.connect()
    return Section(
        frozen(origin),
        frozen(axes),
        tuple(_bifurcation(node, bounds) for node in network.nodes),
        tuple(_curve(branch, network.tracer) for branch in network.branches),
        ends,
        frozen(turns),
    )


def feasible_orientations(
    design: Design, bounds: Restraints, origin: Array, rotation: ArrayLike | None, number: int,
    rng: np.random.Generator | int,
) -> Array:  # fmt: skip
    """Return orientations that are strictly feasible at a point, shape (≤ number, 3, 3).

    Raises
    ------
    EmptyWorkspace
        If there is none.
    """
    if number < 1:
        raise InvalidInput(expected("starts", "an integer ≥ 1", number))
    margin = -1e-6 * bounds.size
    if rotation is not None:
        chosen = check_rotation("rotation", rotation)[None]
    else:
        random = Rotation.random(TRIES, rng=np.random.default_rng(rng)).as_matrix()
        home = [] if design.home is None else [design.home.rotation]
        chosen = np.concatenate((np.reshape(home, (-1, 3, 3)), random))
    places = np.broadcast_to(origin, (len(chosen), 3))
    inside = chosen[bounds.allowed(places, chosen, margin)][:number]
    if not len(inside):
        tried = "the given orientation" if rotation is not None else f"{len(chosen)} orientations"
        raise EmptyWorkspace(
            f"radiating point {np.round(origin, 6).tolist()}: expected a feasible orientation, "
            f"received none: {tried} tried; closest: {_closest(bounds, places, chosen)}"
        )
    return inside


def _closest(bounds: Restraints, position: Array, rotation: Array) -> str:
    excess = bounds.excess(bounds.quantities.values(position, rotation))
    with np.errstate(invalid="ignore"):
        worst = np.nan_to_num(excess, nan=np.inf).max(axis=(1, 2))
    best = int(np.argmin(worst))
    i, side = np.unravel_index(int(np.nanargmax(excess[best])), excess[best].shape)
    bound = (bounds.low, bounds.high)[int(side)][i]
    value = bound + (2 * int(side) - 1) * excess[best][i, side]
    return f"{bounds.names[int(i)]} = {value:.6g} {'<>'[int(side)]} {bound:.6g}"


def _plane(design: Design, origin: ArrayLike | None, axes: ArrayLike) -> tuple[Array, Array]:
    if origin is None:
        if design.home is None:
            raise InvalidInput(expected("origin", "a point, as the design has no home pose", None))
        origin = design.home.position
    start = check_array("origin", origin, (3,))
    given = check_array("axes", axes, (2, 3))
    first = unit(given[0])
    normal = cross(given[0], given[1])
    if not norm(normal) > 1e-12 * norm(given[0]) * norm(given[1]):
        raise InvalidInput(expected("axes", "two independent directions", given.tolist()))
    return start, np.stack((first, cross(unit(normal), first)))


def _different(ends: RayEnds, size: float) -> list[int]:
    """Certified ends, each once, the farthest first."""
    seen: set[tuple[object, ...]] = set()
    result = []
    for i in np.argsort(-ends.distance):
        place = (ends.position[i] / size).round(6) + 0.0
        key = (ends.active[i], *place, *(ends.rotation[i].round(6) + 0.0).ravel())
        if ends.certified[i] and key not in seen:
            seen.add(key)
            result.append(int(i))
    return result


def _bifurcation(node: Node, bounds: Restraints) -> BifurcationPoint:
    position, rotation = node.points.position[0], node.points.rotation[0]
    values = bounds.quantities.values(position, rotation)
    text = label(node.active, bounds.names, bounds.joints)
    return BifurcationPoint(text, Pose(position, rotation), frozen(values))


def _curve(branch: Branch, tracer: Tracer) -> Curve:
    bounds, trace = tracer.chart.restraints, branch.trace
    return Curve(
        label(branch.held, bounds.names, bounds.joints),
        Pose(trace.points.position, trace.points.rotation),
        frozen(trace.points.weight),
        tracer.maximal(trace.points, trace.active),
        branch.first, branch.last, branch.connecting, trace.closed, trace.lost, trace.active, branch.held,
    )  # fmt: skip
