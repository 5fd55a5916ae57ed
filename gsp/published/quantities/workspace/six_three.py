"""The 6-3 platform of `Workspace-3` and of appendices B to D of `Workspace-A`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from scipy.optimize import NonlinearConstraint, minimize, root

from gsp.catalogue import design as published_design
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.limits.labels import active_from_label
from gsp.workspace import BifurcationPoint, Shells, bifurcation_point, exact_shells
from gsp.workspace.exact.shells import Vertex

ORDER = "approach-roll"
NAME = "workspace-6-3"
# Points nearer to OZ than this are on it; lengths of the design are 1 to 15.
ON_AXIS = 1e-6
# Points of a curve from corner to corner, and what lengths may lie beyond the strokes as corners
# are given to 0.1°.
ARC_POINTS, ROUNDED = 15, 0.05


def _point(
    label: str,
    near: Sequence[float],
    angles_deg: Sequence[float],
    held: Mapping[str, float],
) -> BifurcationPoint:
    """Solve a point of the vertical plane from a guess in a few digits."""
    guess = Pose.from_angles(near, angles_deg, ORDER, degrees=True)
    return bifurcation_point(published_design(NAME), label, guess, held=held)


def position(
    label: str,
    near: Sequence[float],
    angles_deg: Sequence[float],
    held: Mapping[str, float],
) -> Array:
    """Coordinates (x, y, z) of a point at which the joints of a label are at their limits."""
    return _point(label, near, angles_deg, held).pose.position


def orientation(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float]
) -> Array:
    """Angles (α, β, γ) [deg] of such a point."""
    return _point(label, near, angles_deg, held).pose.angles(ORDER, degrees=True)


def tilt(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float]
) -> float:
    """Angle β [deg] of such a point."""
    return float(_point(label, near, angles_deg, held).pose.angles(ORDER, degrees=True)[1])


def leg_lengths(
    label: str,
    near: Sequence[float],
    angles_deg: Sequence[float],
    held: Mapping[str, float],
) -> Array:
    """Leg lengths of such a point."""
    return _point(label, near, angles_deg, held).joints


def leg_lengths_at(position: Sequence[float], angles_deg: Sequence[float]) -> Array:
    """Leg lengths at a pose."""
    pose = Pose.from_angles(position, angles_deg, ORDER, degrees=True)
    return published_design(NAME).at(pose).joints


def radiating_height(lowest: str) -> float:
    """z0 = (z_max + z_min) / 2 of eq. (3.13), for a reading of the lowest position.

    "horizontal": all legs shortest without a turn; "point A": the flipped platform.
    """
    top = position("111111", (0, 0, 13), (0, 0, 0), {})[2]
    if lowest == "horizontal":
        bottom = position("000000", (0, 0, 2.6), (0, 0, 0), {})[2]
    else:
        bottom = position("-0000-", (0, 0, 2.4), (0, -54, 0), {"x": 0.0, "y": 0.0})[2]
    return float(0.5 * (top + bottom))


def lowest_on_axis() -> float:
    """Lowest height z on OZ of a pose without a turn and with all legs longest, below the base."""
    return float(position("111111", (0, 0, -13), (0, 0, 0), {})[2])


def above_point_a(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float]
) -> int:
    """1 if such a point is higher than point A on OZ, −1 if it is lower."""
    lowest = position("-0000-", (0, 0, 2.4), (0, -54, 0), {"x": 0.0, "y": 0.0})[2]
    return int(np.sign(position(label, near, angles_deg, held)[2] - lowest))


def beside_axis(
    label: str, near: Sequence[float], angles_deg: Sequence[float], held: Mapping[str, float]
) -> int:
    """1 if such a point lies beside OZ on the side of x > 0, −1 on the other side, 0 on OZ."""
    x = float(position(label, near, angles_deg, held)[0])
    return 0 if abs(x) < ON_AXIS else int(np.sign(x))


def ray_angle(
    label: str, near: Sequence[float], angles_deg: Sequence[float], unit: str = "deg"
) -> float:
    """Inclination φ of the ray from u0 through a point, from the negative z-axis: eq. (3.14)."""
    x, y, z = position(label, near, angles_deg, {"y": 0.0})
    phi = np.arctan2(np.hypot(x, y), radiating_height("horizontal") - z)
    return float(np.rad2deg(phi) if unit == "deg" else phi)


def range_above(label: str, near: Sequence[float], angles_deg: Sequence[float]) -> float:
    """Angle [rad] between the ray from u0 through a point and the vertical: the range of (B.2)."""
    return float(np.pi - ray_angle(label, near, angles_deg, "rad"))


def section_legs(theta_deg: float, gamma_deg: float) -> Array:
    """Legs that bound A[0, 0, γ] in the half-plane at θ, above and below its outermost point.

    Above it lies the arc of a greatest length, below it that of a least length, as the
    workspace above the base.
    """
    shells = _shells(gamma_deg)
    theta = np.deg2rad(theta_deg)
    outward = np.array([np.cos(theta), np.sin(theta), 0.0])
    arcs = [
        arc
        for arc in shells.section((0.0, 0.0, 0.0), np.stack((outward, (0.0, 0.0, 1.0))))
        if (arc.points @ outward).max() > 1e-9 and arc.points[:, 2].max() > 0.0
    ]
    tip = max((point for arc in arcs for point in (arc.first, arc.last)), key=lambda p: p @ outward)
    legs = {}
    for arc in arcs:
        if min(np.linalg.norm(arc.first - tip), np.linalg.norm(arc.last - tip)) < 1e-9:
            ((leg, side), *_) = active_from_label(arc.label, 6)
            legs[side] = leg + 1
    return np.array([legs[1], legs[0]])


def _corner(gamma_deg: float, near: Sequence[float]) -> Vertex:
    """Return the bifurcation point of A[0, 0, γ] nearest a place."""
    corners = _shells(gamma_deg).vertices()
    return min(corners, key=lambda v: float(np.linalg.norm(v.position - near)))


def corner(gamma_deg: float, near: Sequence[float]) -> Array:
    """Coordinates of the bifurcation point of A[0, 0, γ] nearest a place."""
    return _corner(gamma_deg, near).position


def corner_lengths(gamma_deg: float, near: Sequence[float]) -> Array:
    """Leg lengths of the bifurcation point of A[0, 0, γ] nearest a place."""
    return leg_lengths_at(corner(gamma_deg, near).tolist(), [0.0, 0.0, gamma_deg])


def legs_at_corner(gamma_deg: float, near: Sequence[float]) -> int:
    """Count the legs at a limit in the bifurcation point of A[0, 0, γ] nearest a place."""
    return len(active_from_label(_corner(gamma_deg, near).label, 6))


def highest() -> float:
    """Greatest height of the working point over all poses within the strokes.

    By sequential quadratic programming from eight random poses.
    """
    design, rng, found = published_design(NAME), np.random.default_rng(0), -np.inf
    squares = _squares_of_strokes()

    def slack(u: Array) -> Array:
        lengths = design.at(Pose.from_angles(u[:3], u[3:], ORDER)).joints ** 2
        return np.concatenate((squares[:, 1] - lengths, lengths - squares[:, 0]))

    for _ in range(8):
        start = np.append(rng.uniform([-3.0, -3.0, 6.0], [3.0, 3.0, 12.0]), rng.uniform(-1, 1, 3))
        best = minimize(  # type: ignore[call-overload]
            lambda u: -float(u[2]),
            start,
            method="SLSQP",
            constraints=[NonlinearConstraint(slack, 0.0, np.inf)],
            tol=1e-10,
        )
        if best.success and slack(best.x).min() > -1e-6:
            found = max(found, float(best.x[2]))
    return found


def _squares_of_strokes() -> Array:
    strokes = published_design(NAME).strokes
    return np.asarray(strokes, dtype=np.float64) ** 2


def _along(
    label: str, tilts_deg: Sequence[float], near: Sequence[float]
) -> tuple[Array, Array, Array]:
    """Return x, z and leg lengths at tilts β [deg] of a curve in the plane of symmetry.

    The label fixes one leg of each of two symmetric pairs; each point is solved from the one
    before.
    """
    design, strokes = published_design(NAME), np.sqrt(_squares_of_strokes())
    active = [(leg, side) for leg, side in active_from_label(label, 6) if leg in (0, 1, 2)]
    if len(active) != 2:
        raise InvalidInput(expected("label", "two legs of 1, 2 and 3 at a limit", repr(label)))
    legs = [leg for leg, _ in active]
    target = np.array([strokes[leg, side] for leg, side in active])

    def at(u: Array, beta: float) -> Array:
        pose = Pose.from_angles([u[0], 0.0, u[1]], [0.0, beta, 0.0], ORDER, degrees=True)
        return design.at(pose).joints

    places = [np.array([near[0], near[2]])]
    for beta in tilts_deg:

        def missing(u: Array, beta: float = float(beta)) -> Array:
            return np.asarray(at(u, beta)[legs] - target)

        places.append(root(missing, places[-1], tol=1e-13).x)
    x, z = np.array(places[1:]).T
    lengths = [at(u, float(beta)) for u, beta in zip(places[1:], tilts_deg, strict=True)]
    return x, z, np.array(lengths)


def retraction(label: str, tilts_deg: Sequence[float], near: Sequence[float]) -> Array:
    """Return how leg 3 changes from tilt β [deg] to tilt along a curve: 1 longer, −1 shorter."""
    return np.sign(np.diff(_along(label, tilts_deg, near)[2][:, 2]))


def lowest_curve(labels: Sequence[str], corners_deg: Sequence[float], near: Sequence[float]) -> int:
    """Return the number, from 1, of the curve with the lowest point of a chain of curves.

    In the plane of symmetry. Curve k leads from the tilt β [deg] of corner k to that of corner
    k + 1; 0 if the chain leaves the strokes, or if the lowest point is one of its corners.
    """
    strokes, place, lowest = np.sqrt(_squares_of_strokes()), list(near), []
    for label, ends in zip(labels, pairwise(corners_deg), strict=True):
        x, z, lengths = _along(label, np.linspace(*ends, ARC_POINTS).tolist(), place)
        if ((lengths < strokes[:, 0] - ROUNDED) | (lengths > strokes[:, 1] + ROUNDED)).any():
            return 0
        lowest.append((float(z.min()), bool(0 < z.argmin() < ARC_POINTS - 1)))
        place = [float(x[-1]), 0.0, float(z[-1])]
    best = min(range(len(lowest)), key=lambda k: lowest[k][0])
    return best + 1 if lowest[best][1] else 0


def reached_with_turn(label: str, gamma_deg: Sequence[float], margin: float) -> float:
    """Share of a bifurcation curve of A[0, 0, γ] above the base that all γ of a range reach.

    The curve is that of the first γ [deg], without a margin at its ends, as a share of its points.
    """
    curves = [
        arc
        for arc in _shells(gamma_deg[0]).edges(points=101)
        if arc.label.replace(" ", "") == label and arc.points[:, 2].mean() > 0.0
    ]
    if len(curves) != 1:
        raise InvalidInput(expected("label", "that of a curve above the base", label))
    curve = curves[0]
    cut = round(margin * len(curve.points))
    points = curve.points[cut : len(curve.points) - cut]
    inside = [
        _shells(gamma).contains(points, slack=1e-9)
        for gamma in np.linspace(gamma_deg[0], gamma_deg[1], 61)
    ]
    return float(np.mean(np.logical_and.reduce(inside)))


def symmetry_error(turn_deg: float) -> float:
    """Largest change of the sorted leg lengths if a pose is turned about OZ, over 50 poses.

    The platform is turned back about its own normal by the same angle.
    """
    poses = Pose.sample([(-5.0, 5.0)] * 3, [(-3.0, 3.0)] * 3, 50, rng=0)
    turn = rotation_from_angles((0.0, 0.0, turn_deg), ORDER, degrees=True)
    turned = Pose(poses.position @ turn.T, turn @ poses.rotation @ turn.T)
    both = [np.sort(published_design(NAME).at(p).joints, axis=-1) for p in (poses, turned)]
    return float(np.abs(both[0] - both[1]).max())


def error_function(equation: str, position: Sequence[float], phi_deg: float) -> float:
    """Error function (B.1) or (C.1) at a position without a turn, in the plane θ = 0."""
    lengths = leg_lengths_at(position, [0.0, 0.0, 0.0])
    low, high = np.sqrt(_squares_of_strokes()).T
    if equation == "(C.1)":
        return float(
            (lengths[0] - low[0]) ** 2 + (lengths[1] - high[1]) ** 2 + (lengths[4] - high[4]) ** 2
        )
    if equation != "(B.1)":
        raise InvalidInput(expected("equation", '"(B.1)" or "(C.1)"', repr(equation)))
    x, y, z = position
    ray = np.hypot(x, y) - (radiating_height("horizontal") - z) * np.tan(np.deg2rad(phi_deg))
    legs = [0, 1, 4, 5]
    return float(((lengths - high)[legs] ** 2).sum() + y**2 + ray**2)


def _shells(gamma_deg: float) -> Shells:
    turn = rotation_from_angles((0.0, 0.0, gamma_deg), ORDER, degrees=True)
    return exact_shells(published_design(NAME), turn)


QUANTITIES = (
    position,
    orientation,
    tilt,
    leg_lengths,
    leg_lengths_at,
    radiating_height,
    lowest_on_axis,
    above_point_a,
    beside_axis,
    highest,
    ray_angle,
    range_above,
    section_legs,
    corner,
    corner_lengths,
    legs_at_corner,
    retraction,
    lowest_curve,
    reached_with_turn,
    symmetry_error,
    error_function,
)
