"""The workspace of a planar platform at a fixed angle: its components, from circles and lines.

A D1 leg keeps the platform origin in a ring, a D2 or D3 leg in one strip or two, and an A1 leg
allows an angle or not. So the boundary consists of pieces of circles and lines between the points
where these cross or touch, and nothing is approximated. Every piece has the workspace on its left.
What is connected is decided once, with PART_TOLERANCE, in `gsp.planar.arrangement`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_type
from gsp.errors import GspError, InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, Mask, norm
from gsp.geometry.vectors import unit as unit_vector
from gsp.limits.labels import Active
from gsp.planar.allowed import CENTRE_ROUNDING, Legs, Limits
from gsp.planar.arrangement import CONTACT_TRIES, Link, Loop, restored, shrunk, traced
from gsp.planar.bounds import planar_bounds
from gsp.planar.curves import Curve
from gsp.planar.design import PlanarDesign
from gsp.workspace.exact.spheres import SAME_TOLERANCE

# Passages narrower than this are closed, narrower parts are none, and curves nearer than it are one
# [share of the size: the greatest radius of the circles among which the positions are].
PART_TOLERANCE = SAME_TOLERANCE
# Where pieces are tested [shares of their length].
TESTED_SHARES = np.array([0.21, 0.48, 0.83])
# Gaps between pieces that are rounding [share of the size].
JOINED = 1e-14
# What is expected of curves that do not form outlines.
DISTINCT = "limits whose curves form closed outlines"

# A piece of a boundary: its curve, and the parameters of its ends.
Arc = tuple[Curve, float, float]


@dataclass(frozen=True, eq=False)
class Piece(ReadOnly):
    """A piece of a circle or a line on the boundary of a workspace at a fixed angle.

    Attributes
    ----------
    active : tuple of (leg, side)
        The limits of which it consists: side 0 least, 1 greatest.
    points : (q, 2) array [length]
        In base axes, with the workspace on the left.
    first, last : int or None
        Numbers of the vertices at its ends; None if it is a whole circle.
    """

    active: Active
    points: Array
    first: int | None
    last: int | None


@dataclass(frozen=True, eq=False)
class PlanarComponent(ReadOnly):
    """A connected part of the positions that a planar platform reaches at a fixed angle.

    Attributes
    ----------
    area : float [length²]
        Exact up to rounding; holes do not count.
    outline : tuple of Piece
        The outer boundary, counter-clockwise.
    holes : tuple of tuples of Piece
        The boundaries of the holes, each clockwise.
    """

    area: float
    outline: tuple[Piece, ...]
    holes: tuple[tuple[Piece, ...], ...]
    _loops: tuple[tuple[Arc, ...], ...]
    _middle: Array
    _unit: float

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """All pieces of the boundary: of the outline, then of the holes."""
        return sum(self.holes, self.outline)

    def contains(self, position: ArrayLike) -> Mask:
        """Return whether positions are in the component.

        Parameters
        ----------
        position : (..., 2) array_like [length]
            In base axes. On the boundary itself rounding decides.

        Returns
        -------
        (...) bool array

        Raises
        ------
        InvalidInput
            On wrong shapes, or numbers that are not finite.

        *Source: ours*
        """
        points = (check_array("position", position, (2,)) - self._middle) / self._unit
        turns = sum(_winding(loop, points) for loop in self._loops)
        return np.asarray(np.abs(turns) > 0.5)


def planar_components(design: PlanarDesign, angle: float = 0.0) -> tuple[PlanarComponent, ...]:
    """Return all parts of the workspace of a planar platform at a fixed angle, the largest first.

    The workspace is what is within the limits, without its boundary: parts that touch in points are
    separate, and a hole that touches the outline from inside is part of it. What is narrower than a
    tolerance counts as nothing, whether it is a passage between parts or a part, and curves nearer
    than it are one. The tolerance is 1e-9 of the size, the greatest radius of the circles that meet
    a disc around the workspace; what is wider than 1.25e-9 of it counts.

    Parameters
    ----------
    design : PlanarDesign
        With strokes.
    angle : float [rad]
        Of the platform.

    Returns
    -------
    tuple of PlanarComponent
        Empty if no position is feasible.

    Raises
    ------
    MissingParameter
        Without strokes.
    InvalidInput
        If the strokes do not bound the positions: neither a D1 leg with a greatest length, nor two
        legs whose lines are more than 1e-9 rad from parallel; or on arguments of other types.
    GspError
        If curves form no closed outlines, as two of them touch up to rounding in each of the
        8 ways in which contacts are decided.

    Examples
    --------
    >>> import numpy as np
    >>> from gsp.planar import PlanarDesign, planar_components
    >>> point = np.zeros((3, 2))
    >>> ring = PlanarDesign(["D1"] * 3, point, point, strokes=[[1.0, 2.0]] * 3)
    >>> [part] = planar_components(ring)
    >>> len(part.holes), bool(abs(part.area - 3 * np.pi) < 1e-12)
    (1, True)

    *Source: ours; Workspace-A, appendix A, traces such boundaries*
    """
    check_type("design", design, PlanarDesign)
    bounds = planar_bounds(design)
    turn = check_array("angle", angle, ())
    if turn.ndim:
        raise InvalidInput(expected("angle", "one angle", f"shape {turn.shape}"))
    legs = Legs.of(design, bounds, float(turn))
    if legs.disc is None:
        wanted = "a D1 leg with a greatest length, or two with lines at least 1e-9 rad apart"
        raise InvalidInput(expected("strokes", wanted, "positions without bounds"))
    return components(legs)


def components(legs: Legs) -> tuple[PlanarComponent, ...]:
    """Return the components that legs allow at a fixed angle, the largest first."""
    if not legs.possible or legs.disc is None:
        return ()
    middle, radius = legs.disc
    legs = legs.scaled(middle, radius)
    size = legs.size(1.0)
    legs, radius, unit = legs.scaled(np.zeros(2), size), 1.0 / size, radius * size
    limits = legs.limits(radius, PART_TOLERANCE)
    for attempt in range(CONTACT_TRIES):
        narrow = None if limits is None else shrunk(limits, PART_TOLERANCE, attempt)
        if limits is None or narrow is None:
            return ()
        found = traced(narrow)
        nested = None if found is None else _nested(found[0], narrow)
        if found is not None and nested is not None:
            rounding = legs.rounding + CENTRE_ROUNDING
            loops = restored(*found, limits, PART_TOLERANCE, rounding)
            made = (_component([loops[i] for i in own], limits, middle, unit) for own in nested)
            return tuple(sorted(made, key=lambda part: -part.area))
    raise GspError(expected("strokes", DISTINCT, "some that do not"))


def inner_point(part: PlanarComponent) -> Array:
    """Return a point (2,) of a component that is far from its boundary [length].

    The farthest of points on the normals of the pieces, at distances of powers of two.
    """
    boundary = np.concatenate([piece.points for piece in part.pieces])
    away = np.ptp(boundary, axis=0).max() * 0.5 ** np.arange(1.0, 30.0)
    best, depth = boundary[0], -1.0
    for piece in part.pieces:
        k = len(piece.points) // 2
        along = unit_vector(piece.points[k + 1] - piece.points[k - 1])
        points = piece.points[k] + away[:, None] * [-along[1], along[0]]
        points = points[part.contains(points)]
        far = norm(points[:, None] - boundary).min(axis=1)
        if far.max(initial=depth) > depth:
            best, depth = points[far.argmax()], float(far.max())
    return np.asarray(best)


def _nested(loops: list[Loop], limits: Limits) -> list[list[int]] | None:
    """Return the numbers of the loops of each part, the outline first; None without outline."""
    arcs = [_arcs(loop, limits) for loop in loops]
    area = [_area(loop) for loop in arcs]
    outer = sorted((i for i in range(len(loops)) if area[i] > 0.0), key=lambda i: -area[i])
    parts: dict[int, list[int]] = {i: [i] for i in outer}
    for i in sorted(set(range(len(loops))) - set(outer), key=lambda i: area[i]):
        curve, start, stop = arcs[i][0]
        there = curve.at(start + TESTED_SHARES * (stop - start))
        around = [k for k in outer if np.median(_winding(arcs[k], there)) > 0.5]
        if not around:
            return None
        # The smallest of them: outer loops are in descending order.
        parts[around[-1]].append(i)
    return list(parts.values())


def _arcs(loop: Loop, limits: Limits) -> tuple[Arc, ...]:
    return tuple((limits.curves[link.curve], link.start, link.stop) for link in loop)


def _gaps(arcs: Sequence[Arc]) -> list[tuple[Array, Array]]:
    """Return the straight gaps between the pieces of a loop: from an end to the next start."""
    ends = [curve.at(stop) for curve, _, stop in arcs]
    starts = [curve.at(start) for curve, start, _ in (*arcs[1:], arcs[0])]
    pairs = zip(ends, starts, strict=True)
    return [(end, start) for end, start in pairs if norm(start - end) > JOINED]


def _area(arcs: Sequence[Arc]) -> float:
    """Return the area that a loop encloses, negative if it is clockwise (Green's theorem)."""
    gaps = sum(0.5 * float(a[0] * b[1] - a[1] * b[0]) for a, b in _gaps(arcs))
    return gaps + sum(curve.area(start, stop, np.zeros(2)) for curve, start, stop in arcs)


def _winding(arcs: Sequence[Arc], points: Array) -> Array:
    """Return how often a loop goes around points (..., 2), counter-clockwise."""
    total = np.zeros(points.shape[:-1])
    for curve, start, stop in arcs:
        total += curve.angle_seen(start, stop, points)
    for end, following in _gaps(arcs):
        a, b = end - points, following - points
        total += np.arctan2(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0], (a * b).sum(axis=-1))
    return total / (2.0 * np.pi)


def _component(loops: list[Loop], limits: Limits, middle: Array, unit: float) -> PlanarComponent:
    arcs = tuple(_arcs(loop, limits) for loop in loops)
    outline, *holes = (
        tuple(_piece(link, limits.curves[link.curve], middle, unit) for link in loop)
        for loop in loops
    )
    area = sum(map(_area, arcs)) * unit * unit
    return PlanarComponent(area, outline, tuple(holes), arcs, middle, unit)


def _piece(link: Link, curve: Curve, middle: Array, unit: float) -> Piece:
    points = middle + unit * curve.drawn(link.start, link.stop)
    return Piece(curve.active, points, link.first, link.last)
