"""Intersections of spherical shells: sections, areas, volumes and edges, exactly."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import bounded_array
from gsp.checks import check_array, check_integer, check_memory, reading
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly, kept_property, read_only_tuple
from gsp.geometry.vectors import Array, Mask, cross, frozen, norm, unit
from gsp.limits.labels import Active, label
from gsp.workspace.exact.discs import FULL_TURN, Circles, arcs, areas
from gsp.workspace.exact.spheres import (
    SAME_TOLERANCE,
    Circle,
    Spheres,
    frame_of,
    merged_spheres,
    pair_circles,
    touching,
    triple_points,
)
from gsp.workspace.planes import plane_frame
from gsp.workspace.volumes import Volume, check_heights

# Gauss–Legendre nodes between two critical heights; the error is estimated from half as many.
NODES_PER_INTERVAL = 32
# Heights of points this near [share of the greatest radius] to the set split the integration. One
# that is superfluous costs time only; one that is missing reduces the accuracy.
NEAR_CRITICAL = 1e-6
# Arcs of a section shorter than this [rad] are rounding, where circles cross in one point.
SHORTEST_ARC = 1e-7
# Points of one label nearer than this [share of the greatest radius] are one, and shorter curves
# are points. Where spheres are tangent, both are known to the square root of rounding only: three
# spheres with a common tangent meet in points 1e-8 apart, two that touch in a circle of that size.
TANGENT_SHARE = 1e-7
# Memory for each point of a curve [bytes].
POINT_BYTES = 100


@read_only_tuple
class Arc(NamedTuple):
    """A circular arc of the boundary, in a plane section or an edge in space.

    Attributes
    ----------
    label : str
        The constraints that are active on it, as `Shells.label` writes them.
    points : (q, 3) array [length]
        In base axes, from `first` to `last`.
    """

    label: str
    points: Array

    @property
    def first(self) -> Array:
        """First end point, shape (3,), in base axes [length].

        *Source: ours*
        """
        return np.asarray(self.points[0])

    @property
    def last(self) -> Array:
        """Last end point, shape (3,), in base axes [length].

        *Source: ours*
        """
        return np.asarray(self.points[-1])


@read_only_tuple
class Vertex(NamedTuple):
    """A bifurcation point in space.

    Attributes
    ----------
    label : str
        The constraints that are active there, as `Shells.label` writes them.
    position : (3,) array [length]
        In base axes.
    """

    label: str
    position: Array


@dataclass(frozen=True, eq=False, init=False)
class Shells(ReadOnly):
    """Points at distances [low_i, high_i] from centres c_i: the set, its boundary, its volume.

    Parameters
    ----------
    centers : (n, 3) array_like [length]
    low, high : (n,) array_like [length]
        0 ≤ low < high.

    Raises
    ------
    InvalidInput
        On shapes that do not fit, or radii that are negative, not finite, or cross.

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
        c = bounded_array("shells.centers", centers, (None, 3))
        if c.ndim != 2:
            raise InvalidInput(expected("shells.centers", "shape (n, 3)", f"shape {c.shape}"))
        n = len(c)
        a, b = (bounded_array(f"shells.{k}", v, (n,)) for k, v in (("low", low), ("high", high)))
        if a.ndim != 1 or b.ndim != 1:
            got = f"shapes {a.shape} and {b.shape}"
            raise InvalidInput(expected("shells.low, shells.high", f"shape ({n},)", got))
        if not n or (a < 0.0).any() or (a >= b).any():
            wanted = "0 ≤ low < high for at least one shell"
            raise InvalidInput(expected("shells", wanted, f"{a.tolist()} and {b.tolist()}"))
        for name, value in (("centers", c), ("low", a), ("high", b)):
            object.__setattr__(self, name, frozen(value))

    @kept_property
    def spheres(self) -> Spheres:
        """The bounding spheres, each once.

        *Source: Workspace-3, eq. (3.1), for the bounds; the shells are ours*
        """
        return merged_spheres(self.centers, self.low, self.high)

    @kept_property
    def _slack(self) -> float:
        return SAME_TOLERANCE * float(self.high.max())

    def _labelled(self, points: Array) -> str:
        """Label of all bounds that are active at all of some points (q, 3)."""
        here = touching(self.spheres, points, 2.0 * self._slack)
        return self.label(tuple(b for i in np.flatnonzero(here) for b in self.spheres.bounds[i]))

    def contains(self, position: ArrayLike, slack: float = 0.0) -> Mask:
        """Return whether positions lie in the set.

        Parameters
        ----------
        position : (..., 3) array_like [length]
        slack : float [length]
            Added to the bounds on both sides.

        Returns
        -------
        (...) bool array

        Raises
        ------
        InvalidInput
            On wrong shapes, or numbers that are not finite.

        *Source: Workspace-3, §3.1 (ii), for the set; the shells are ours*
        """
        points, slack = check_array("position", position, (3,)), check_number("slack", slack)
        gap = norm(points[..., None, :] - self.centers)
        return np.asarray(((gap >= self.low - slack) & (gap <= self.high + slack)).all(axis=-1))

    def label(self, active: Active) -> str:
        """Return the label of active bounds in the notation of the source.

        Parameters
        ----------
        active : pairs of int
            Number of the shell, and 0 for its inner or 1 for its outer sphere.

        Returns
        -------
        str

        Raises
        ------
        InvalidInput
            On anything else.
        """
        return label(_check_active(active, len(self.low)), (), len(self.low))

    def section(self, origin: ArrayLike, axes: ArrayLike, *, points: int = 65) -> tuple[Arc, ...]:
        """Return the arcs that bound the section with a plane, labelled.

        Parameters
        ----------
        origin : (3,) array_like [length]
            A point of the plane.
        axes : (2, 3) array_like [any length]
            Two directions of the plane.
        points : int
            Points per arc, ≥ 2; the first and the last are bifurcation points.

        Returns
        -------
        tuple of Arc

        Raises
        ------
        InvalidInput
            On wrong shapes, dependent directions, or fewer than two points.

        *Source: Workspace-A, appendix D, whose sections this gives*
        """
        start, frame = plane_frame(origin, axes)
        points = check_integer("points", points, least=2)
        check_memory("points", points, POINT_BYTES, "points")
        circles = self._circles(frame, (frame[2] @ start)[None])
        found = arcs(circles)
        result = []
        for circle, place in np.argwhere(
            found.real[0] & (found.stop - found.start > SHORTEST_ARC)[0]
        ):
            angle = np.linspace(found.start[0, circle, place], found.stop[0, circle, place], points)
            flat = circles.centre[0, circle] + circles.radius[0, circle] * np.stack(
                (np.cos(angle), np.sin(angle)), axis=-1
            )
            there = flat @ frame[:2] + (frame[2] @ start) * frame[2]
            result.append(Arc(self._labelled(there), there))
        return tuple(result)

    def section_area(self, origin: ArrayLike, axes: ArrayLike) -> float:
        """Return the area of the section with a plane, exact up to rounding.

        Parameters
        ----------
        origin : (3,) array_like [length]
            A point of the plane.
        axes : (2, 3) array_like [any length]
            Two directions of the plane.

        Returns
        -------
        float [length²]

        Raises
        ------
        InvalidInput
            On wrong shapes, or dependent directions.

        *Source: ours; Workspace-A, appendix D, draws such sections*
        """
        start, frame = plane_frame(origin, axes)
        return float(areas(self._circles(frame, (frame[2] @ start)[None]))[0])

    def volume(self, heights: tuple[float, float] = (-np.inf, np.inf)) -> Volume:
        """Return the volume of the set between two heights z, and an estimate of its error.

        Distances from points of a plane base do not distinguish the two sides of that plane;
        heights of (0, inf) take the part above it.

        The areas of horizontal sections are exact; between the heights where the shape of the
        section changes, they are integrated by Gauss–Legendre in a variable that removes the
        square roots at the ends.

        Parameters
        ----------
        heights : (float, float) [length]
            Least and greatest z.

        Returns
        -------
        Volume [length³]

        Raises
        ------
        InvalidInput
            If `heights` are not two numbers.

        *Source: ours*
        """
        levels = self._critical_heights(*check_heights(heights))
        if len(levels) < 2:
            return Volume(0.0, 0.0)
        fine, coarse = (
            self._integral(levels, n) for n in (NODES_PER_INTERVAL, NODES_PER_INTERVAL // 2)
        )
        return Volume(fine, abs(fine - coarse) + 1e-14 * abs(fine))

    def vertices(self) -> tuple[Vertex, ...]:
        """Bifurcation points in space: where three spheres meet on the boundary, labelled."""
        near = TANGENT_SHARE * float(self.high.max())
        groups: list[tuple[str, list[Array]]] = []
        for point in self._triple_points:
            if not self.contains(point, self._slack):
                continue
            name = self._labelled(point[None])
            same = (there for text, there in groups if text == name)
            group = next((g for g in same if norm(g[0] - point) <= near), None)
            if group is None:
                groups.append((name, [point]))
            else:
                group.append(point)
        return tuple(Vertex(name, np.mean(there, axis=0)) for name, there in groups)

    def edges(self, *, points: int = 65) -> tuple[Arc, ...]:
        """Return the bifurcation curves: arcs where two spheres meet on the boundary, labelled.

        Parameters
        ----------
        points : int
            Points per arc, ≥ 2.

        Returns
        -------
        tuple of Arc

        Raises
        ------
        InvalidInput
            On fewer than two points.
        """
        points = check_integer("points", points, least=2)
        check_memory("points", points, POINT_BYTES, "points")
        corners = np.array([v.position for v in self.vertices()]).reshape(-1, 3)
        result: list[Arc] = []
        for centre, radius, normal in self._pair_circles:
            e1, e2 = frame_of(normal)
            rest = corners - centre
            rise, flat = rest @ normal, np.hypot(rest @ e1, rest @ e2)
            on = np.hypot(rise, flat - radius) <= 4.0 * self._slack
            cuts = np.sort(np.arctan2(rest[on] @ e2, rest[on] @ e1) % FULL_TURN)
            starts = cuts if len(cuts) else np.zeros(1)
            stops = np.append(starts[1:], starts[0] + FULL_TURN)
            for a, b in zip(starts, stops, strict=True):
                t = np.linspace(a, b, points)[:, None]
                arc = centre + radius * (np.cos(t) * e1 + np.sin(t) * e2)
                middle = arc[len(arc) // 2]
                if (
                    radius * (b - a) > TANGENT_SHARE * float(self.high.max())
                    and self.contains(middle, self._slack)
                    and not any(
                        norm(o.points[len(arc) // 2] - middle) <= self._slack for o in result
                    )
                ):
                    result.append(Arc(self._labelled(arc), arc))
        return tuple(result)

    @kept_property
    def _pair_circles(self) -> list[Circle]:
        return pair_circles(self.spheres)

    @kept_property
    def _triple_points(self) -> Array:
        return triple_points(self.spheres)

    def _circles(self, frame: Array, height: Array) -> Circles:
        """Circles in the planes at heights (Z,) along frame[2]."""
        centres, radii, sides, _ = self.spheres
        local = centres @ frame.T
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
        """Heights where the topology of the horizontal section may change, sorted.

        It changes at points of the boundary only: where a sphere or a circle of two spheres is
        highest or lowest, and where three spheres meet.
        """
        bottom = max(low, float((self.centers[:, 2] - self.high).max()))
        top = min(high, float((self.centers[:, 2] + self.high).min()))
        if bottom >= top:
            return np.empty(0)
        up = np.array([0.0, 0.0, 1.0])
        reach = self.spheres.radii[:, None] * up
        points = [self.spheres.centres - reach, self.spheres.centres + reach, self._triple_points]
        for centre, radius, normal in self._pair_circles:
            level = cross(normal, up)
            flat = float(norm(level)) <= SAME_TOLERANCE  # a horizontal circle: one height
            first = frame_of(normal)[0] if flat else cross(unit(level), normal)
            points.append(np.stack((centre - radius * first, centre + radius * first)))
        every = np.concatenate(points)
        near = every[self.contains(every, NEAR_CRITICAL * float(self.high.max()))][:, 2]
        inside = near[(near > bottom) & (near < top)]
        ordered = np.unique(np.concatenate(([bottom], inside, [top])))
        keep = np.append(True, np.diff(ordered) > 1e-13 * (top - bottom))
        return np.asarray(ordered[keep])


def check_number(what: str, value: Any) -> float:
    """Return one finite number, or raise InvalidInput."""
    number = check_array(what, value, ())
    if number.ndim:
        raise InvalidInput(expected(what, "one number", brief(value)))
    return float(number)


def _check_active(active: Active, n: int) -> Active:
    """Return pairs (joint, 0 or 1) of n joints, or raise InvalidInput."""
    wanted = f"pairs of a joint from 0 to {n - 1} and 0 or 1"
    with reading("active", wanted, active):
        pairs = [(operator.index(i), operator.index(side)) for i, side in active]
    if any(not (0 <= i < n and side in (0, 1)) for i, side in pairs):
        raise InvalidInput(expected("active", wanted, brief(active)))
    return tuple(pairs)
