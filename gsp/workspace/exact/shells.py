"""Fixed-orientation workspaces of SPS legs: intersections of spherical shells, exactly."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.errors import InvalidDesign, InvalidInput, expected
from gsp.geometry.rotations import check_rotation
from gsp.geometry.vectors import Array, Mask, cross, frozen, norm, unit
from gsp.limits.labels import Active, label
from gsp.limits.limits import Limits, bounded_quantities
from gsp.model.design import Design
from gsp.workspace.exact.discs import FULL_TURN, Circles, arcs, areas
from gsp.workspace.exact.spheres import frame_of, three_spheres, two_spheres

# Gauss–Legendre nodes between two critical heights; the error is estimated from half as many.
NODES_PER_INTERVAL = 32
# Distances nearer than this [share of the greatest radius] are equal; arcs of less [rad] are empty.
DISTANCE_TOLERANCE = 1e-10
# Arcs of a section shorter than this [rad] are rounding, where circles cross in one point.
SHORTEST_ARC = 1e-7


class Arc(NamedTuple):
    """A circular arc of a plane section: label, points (q, 3), from `first` to `last`."""

    label: str
    points: Array

    @property
    def first(self) -> Array:
        """First end point, in base axes."""
        return np.asarray(self.points[0])

    @property
    def last(self) -> Array:
        """Last end point, in base axes."""
        return np.asarray(self.points[-1])


class Vertex(NamedTuple):
    """A bifurcation point in space: its label and position."""

    label: str
    position: Array


class Volume(NamedTuple):
    """A volume and an estimate of its error."""

    value: float
    error: float


@dataclass(frozen=True, eq=False, init=False)
class Shells:
    """Points at distances [low_i, high_i] from centers c_i: the set, its boundary, its volume.

    Parameters
    ----------
    centers : (n, 3) array_like [length]
    low, high : (n,) array_like [length]
        0 ≤ low < high.

    Raises
    ------
    InvalidInput
        On radii that are negative, not finite, or cross.

    Examples
    --------
    >>> ball = Shells([[0.0, 0.0, 0.0]], [0.0], [1.0])
    >>> bool(abs(ball.volume().value - 4 / 3 * np.pi) < 1e-12)
    True
    """

    centers: Array
    low: Array
    high: Array

    def __init__(self, centers: ArrayLike, low: ArrayLike, high: ArrayLike) -> None:
        c = check_array("shells.centers", centers, (None, 3))
        n = len(c)
        a, b = check_array("shells.low", low, (n,)), check_array("shells.high", high, (n,))
        if not n or (a < 0.0).any() or (a >= b).any():
            wanted = "0 ≤ low < high for at least one shell"
            raise InvalidInput(expected("shells", wanted, f"{a.tolist()} and {b.tolist()}"))
        for name, value in (("centers", c), ("low", a), ("high", b)):
            object.__setattr__(self, name, frozen(value))

    @property
    def spheres(self) -> tuple[Array, Array, Array, Active]:
        """Centers, radii, sides and (leg, side) of the bounding spheres."""
        active = [(i, 0) for i in range(len(self.low)) if self.low[i] > 0.0]
        active += [(i, 1) for i in range(len(self.high))]
        radius = np.array([(self.low, self.high)[side][i] for i, side in active])
        sides = np.array([side for _, side in active])
        return self.centers[[i for i, _ in active]], radius, sides, tuple(active)

    def contains(self, position: ArrayLike, slack: float = 0.0) -> Mask:
        """Whether positions (..., 3) lie in the set, widened by `slack`: shape (...)."""
        points = check_array("position", position, (3,))
        gap = norm(points[..., None, :] - self.centers)
        return np.asarray(((gap >= self.low - slack) & (gap <= self.high + slack)).all(axis=-1))

    def label(self, active: Active) -> str:
        """Label of active bounds in the notation of the source."""
        return label(active, (), len(self.low))

    def section(self, origin: ArrayLike, axes: ArrayLike, *, points: int = 65) -> tuple[Arc, ...]:
        """Return the arcs that bound the section with a plane, labelled.

        Parameters
        ----------
        origin : (3,) array_like
            A point of the plane.
        axes : (2, 3) array_like
            Two directions of the plane.
        points : int
            Points per arc; the first and the last are bifurcation points.

        *Source: Workspace-A, appendix D, whose sections this gives*
        """
        start, frame = _plane(origin, axes)
        circles = self._circles(frame, (frame[2] @ start)[None])
        active = self.spheres[3]
        found = arcs(circles)
        result = []
        for circle, place in np.argwhere(
            found.real[0] & (found.stop - found.start > SHORTEST_ARC)[0]
        ):
            angle = np.linspace(found.start[0, circle, place], found.stop[0, circle, place], points)
            flat = circles.center[0, circle] + circles.radius[0, circle] * np.stack(
                (np.cos(angle), np.sin(angle)), axis=-1
            )
            there = flat @ frame[:2] + (frame[2] @ start) * frame[2]
            result.append(Arc(self.label(_together(circles, circle, active)), there))
        return tuple(result)

    def section_area(self, origin: ArrayLike, axes: ArrayLike) -> float:
        """Area of the section with a plane [length²], exact up to rounding."""
        start, frame = _plane(origin, axes)
        return float(areas(self._circles(frame, (frame[2] @ start)[None]))[0])

    def volume(self, heights: tuple[float, float] = (-np.inf, np.inf)) -> Volume:
        """Volume of the set between two heights z, and an estimate of its error.

        Without a base to stop it, a set of distances is the same above and below a flat base;
        heights of (0, inf) take the part above.

        The areas of horizontal sections are exact; between the heights where the shape of the
        section changes, they are integrated by Gauss–Legendre in a variable that removes the
        square roots at the ends.
        """
        levels = self._critical_heights(*heights)
        if len(levels) < 2:
            return Volume(0.0, 0.0)
        fine, coarse = (
            self._integral(levels, n) for n in (NODES_PER_INTERVAL, NODES_PER_INTERVAL // 2)
        )
        return Volume(fine, abs(fine - coarse) + 1e-14 * abs(fine))

    def vertices(self) -> tuple[Vertex, ...]:
        """Bifurcation points in space: where three spheres meet on the boundary, labelled."""
        centers, radii, _, active = self.spheres
        slack = DISTANCE_TOLERANCE * float(self.high.max())
        found: list[Vertex] = []
        for three in combinations(range(len(radii)), 3):
            for point in three_spheres(centers[list(three)], radii[list(three)]):
                if self.contains(point, slack) and not any(
                    norm(v.position - point) < slack for v in found
                ):
                    gap = np.abs(norm(point - centers) - radii)
                    here = tuple(active[i] for i in np.flatnonzero(gap < slack))
                    found.append(Vertex(self.label(here), point))
        return tuple(found)

    def edges(self, *, points: int = 65) -> tuple[Arc, ...]:
        """Bifurcation curves in space: arcs where two spheres meet on the boundary, labelled."""
        centers, radii, _, active = self.spheres
        corners = np.array([v.position for v in self.vertices()]).reshape(-1, 3)
        slack = DISTANCE_TOLERANCE * float(self.high.max())
        result = []
        for i, j in combinations(range(len(radii)), 2):
            circle = two_spheres(centers[[i, j]], radii[[i, j]])
            if circle is None:
                continue
            center, radius, normal = circle
            e1, e2 = frame_of(normal)
            on = (np.abs(norm(corners - centers[i]) - radii[i]) < slack) & (
                np.abs(norm(corners - centers[j]) - radii[j]) < slack
            )
            rest = corners[on] - center
            cuts = np.sort(np.arctan2(rest @ e2, rest @ e1) % FULL_TURN)
            starts = cuts if len(cuts) else np.zeros(1)
            stops = np.append(starts[1:], starts[0] + FULL_TURN)
            for a, b in zip(starts, stops, strict=True):
                middle = center + radius * (np.cos((a + b) / 2) * e1 + np.sin((a + b) / 2) * e2)
                if self.contains(middle, slack) and b - a > DISTANCE_TOLERANCE:
                    t = np.linspace(a, b, points)[:, None]
                    arc = center + radius * (np.cos(t) * e1 + np.sin(t) * e2)
                    result.append(Arc(self.label((active[i], active[j])), arc))
        return tuple(result)

    def _circles(self, frame: Array, height: Array) -> Circles:
        """Circles in the planes at heights (Z,) along frame[2]."""
        centers, radii, sides, _ = self.spheres
        local = centers @ frame.T
        square = radii**2 - (height[:, None] - local[:, 2]) ** 2
        radius = np.sqrt(np.where(square > 0.0, square, np.nan))
        flat = np.broadcast_to(local[:, :2], (*radius.shape, 2))
        return Circles(flat, radius, sides)

    def _integral(self, heights: Array, nodes: int) -> float:
        t, weight = np.polynomial.legendre.leggauss(nodes)
        middle = 0.5 * (heights[1:] + heights[:-1])[:, None]
        half = 0.5 * (heights[1:] - heights[:-1])[:, None]
        z = middle + half * np.sin(0.5 * np.pi * t)
        measure = half * 0.5 * np.pi * np.cos(0.5 * np.pi * t) * weight
        circles = self._circles(np.eye(3), z.ravel())
        return float((areas(circles).reshape(z.shape) * measure).sum())

    def _critical_heights(self, low: float, high: float) -> Array:
        """Heights where the topology of the horizontal section may change, sorted."""
        centers, radii, _, _ = self.spheres
        bottom = max(low, float((self.centers[:, 2] - self.high).max()))
        top = min(high, float((self.centers[:, 2] + self.high).min()))
        heights = [*(centers[:, 2] - radii), *(centers[:, 2] + radii)]
        for i, j in combinations(range(len(radii)), 2):
            circle = two_spheres(centers[[i, j]], radii[[i, j]])
            if circle is not None:
                middle, radius, normal = circle
                rise = radius * np.sqrt(max(0.0, 1.0 - normal[2] ** 2))
                heights += [middle[2] - rise, middle[2] + rise]
        for three in combinations(range(len(radii)), 3):
            points = three_spheres(centers[list(three)], radii[list(three)])
            heights += [point[2] for point in points]
        inside = [z for z in heights if bottom < z < top]
        if bottom >= top:
            return np.empty(0)
        ordered = np.unique(np.array([bottom, *inside, top]))
        keep = np.append(True, np.diff(ordered) > 1e-13 * (top - bottom))
        return np.asarray(ordered[keep])


def fixed_orientation(
    design: Design, rotation: ArrayLike | None = None, limits: Limits | None = None
) -> Shells:
    """Return the fixed-orientation workspace A[α, β, γ] of a design of SPS legs, exactly.

    Leg i keeps the platform origin between two spheres about a_i − R b_i.

    Parameters
    ----------
    design : Design
        All legs D1, with strokes.
    rotation : (3, 3) array_like, default identity
        R.
    limits : Limits or None
        Other strokes; no other kind of limit is taken here.

    Raises
    ------
    InvalidDesign
        If a leg is not SPS.

    Examples
    --------
    >>> import gsp
    >>> ring = np.array([[np.cos(a), np.sin(a), 0.0] for a in np.arange(6)])
    >>> d = gsp.Design(["D1"] * 6, 2 * ring, ring, strokes=[[1.0, 2.0]] * 6)
    >>> fixed_orientation(d).volume().value > 0
    True

    *Source: Workspace-3, §3.1 (ii); the shells are ours*
    """
    other = sorted({leg.name for leg in design.legs} - {"D1"})
    if other:
        wanted = "SPS legs (D1) alone; for others use a section with fixed orientation"
        raise InvalidDesign(expected("design", wanted, ", ".join(other)))
    bounds = bounded_quantities(design, limits)
    if len(bounds.names) > bounds.joints:
        raise InvalidInput(expected("limits", "strokes alone", bounds.names[bounds.joints]))
    if not np.isfinite(bounds.high).all():
        raise InvalidInput(expected("strokes", "a greatest length per leg", bounds.high.tolist()))
    turn = np.eye(3) if rotation is None else check_rotation("rotation", rotation)
    centers = design.base_points - design.platform_points @ turn.T
    return Shells(centers, np.maximum(bounds.low, 0.0), bounds.high)


def _together(circles: Circles, circle: int, active: Active) -> Active:
    """Constraints whose circles in the first plane are the given one."""
    c, r = circles.center[0], circles.radius[0]
    gap = norm(c - c[circle]) + np.abs(r - r[circle])
    same = (gap < DISTANCE_TOLERANCE * r[circle]) & (circles.side == circles.side[circle])
    return tuple(active[i] for i in np.flatnonzero(same))


def _plane(origin: ArrayLike, axes: ArrayLike) -> tuple[Array, Array]:
    start = check_array("plane.origin", origin, (3,))
    given = check_array("plane.axes", axes, (2, 3))
    normal = cross(given[0], given[1])
    if norm(normal) <= 1e-12 * norm(given[0]) * norm(given[1]):
        raise InvalidInput(expected("plane.axes", "two independent directions", given.tolist()))
    first, third = unit(given[0]), unit(normal)
    return start, np.stack((first, cross(third, first), third))
