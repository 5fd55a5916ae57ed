"""The workspace of a planar platform at a fixed angle: its components, from circles and lines.

A D1 leg keeps the platform origin in a ring, a D2 or D3 leg in one strip or two, and an A1 leg
allows an angle or not. So the boundary consists of pieces of circles and lines between the points
where these cross, and nothing is approximated. Every piece has the workspace on its left.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_type
from gsp.errors import GspError, InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, Mask, norm
from gsp.limits.labels import Active
from gsp.planar.allowed import Legs
from gsp.planar.bounds import planar_bounds
from gsp.planar.curves import Curve, crossings
from gsp.planar.design import PlanarDesign
from gsp.workspace.exact.spheres import SAME_TOLERANCE

# How near crossings are one point, as shorter pieces are, and how near curves are one [shares of
# the size]: where curves touch, half the digits are lost. Curves that nearly touch or coincide may
# form no closed loops with the first pair; the first pair that closes all of them is taken.
NEAR = ((1e-7, SAME_TOLERANCE), (1e-5, SAME_TOLERANCE), (1e-6, 1e-8), (1e-5, 1e-7), (1e-4, 1e-6))
# Where pieces are tested [shares of their length]. Others may touch a curve there.
TESTED_SHARES = np.array([0.21, 0.48, 0.83])
# What is expected of curves that do not form outlines.
DISTINCT = "limits whose curves coincide, or differ by more than rounding"


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
    _loops: tuple[tuple[tuple[Curve, float, float], ...], ...]

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
        points = check_array("position", position, (2,))
        turns = sum(_winding(loop, points) for loop in self._loops)
        return np.asarray(np.abs(turns) > 0.5)


def planar_components(design: PlanarDesign, angle: float = 0.0) -> tuple[PlanarComponent, ...]:
    """Return all parts of the workspace of a planar platform at a fixed angle, the largest first.

    Parts and gaps smaller than 1e-7 of the size may be missed. Parts that only touch are separate
    where curves cross; between curves that are tangent there, rounding decides whether they are one
    part. Their total area and `contains` do not depend on it.

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
        legs whose lines have different directions; or on arguments of other types.
    GspError
        If curves that nearly touch or coincide form no closed outlines.

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
    if not legs.bounded:
        wanted = "a D1 leg with a greatest length, or legs with lines of two directions"
        raise InvalidInput(expected("strokes", wanted, "positions without bounds"))
    return components(legs)


def components(legs: Legs) -> tuple[PlanarComponent, ...]:
    """Return the components that legs allow at a fixed angle, the largest first."""
    if not legs.possible:
        return ()
    for near, slack in NEAR:
        loops = _loops(_pieces(legs, near * legs.size, slack * legs.size))
        parts = None if loops is None else _parts(loops, legs, (near * legs.size) ** 2)
        if parts is not None:
            return parts
    raise GspError(expected("strokes", DISTINCT, "curves whose pieces form no closed outlines"))


# A piece: its curve, the parameters of its ends, and the numbers of its vertices.
Link = tuple[Curve, float, float, int | None, int | None]
Loop = list[Link]


def _parts(loops: list[Loop], legs: Legs, least: float) -> tuple[PlanarComponent, ...] | None:
    """Return the components of loops, without those of at most a least area; None without outline.

    Where curves touch up to rounding, loops around nothing are between them.
    """
    middle = legs.centre.mean(axis=0)
    known = sorted(((_area(loop, middle), loop) for loop in loops), key=lambda item: -item[0])
    outer = [(area, loop) for area, loop in known if area > least]
    inner: dict[int, list[tuple[float, Loop]]] = defaultdict(list)
    for area, loop in known:
        if area < -least:
            curve, start, stop, *_ = loop[0]
            # Most of three points, as a hole may touch the outline in one of them.
            there = curve.at(start + TESTED_SHARES * (stop - start))
            turns = [np.median(_winding(_plain(around), there)) for _, around in outer]
            around = [i for i, turn in enumerate(turns) if turn > 0.5]
            if not around:
                return None
            # The smallest of them: outer loops are in descending order.
            inner[around[-1]].append((area, loop))
    made = [_component(area, loop, inner[i]) for i, (area, loop) in enumerate(outer)]
    return tuple(sorted(made, key=lambda part: -part.area))


def _pieces(legs: Legs, near: float, slack: float) -> list[Link]:
    """Return the pieces of all curves that bound the workspace.

    Crossings within `near` are one point, and curves within `slack` are one [length].
    """
    curves = legs.curves(slack)
    vertices: list[Array] = []
    on: list[dict[int, float]] = [{} for _ in curves]
    for i, j in combinations(range(len(curves)), 2):
        for point in crossings(curves[i], curves[j]):
            if not legs.allow(point[None], near)[0]:
                continue
            same = (k for k, other in enumerate(vertices) if norm(other - point) <= near)
            number = next(same, len(vertices))
            if number == len(vertices):
                vertices.append(point)
            for k in (i, j):
                on[k].setdefault(number, curves[k].parameter(vertices[number]))
    found = []
    for curve, ends in zip(curves, on, strict=True):
        for link in _between(curve, ends):
            tested = link[1] + TESTED_SHARES * (link[2] - link[1])
            points = np.stack([curve.at(t) for t in tested])
            if legs.allow(points, slack).all():
                found.append(link)
    return found


def _between(curve: Curve, ends: dict[int, float]) -> list[Link]:
    """Return the pieces of a curve between its vertices, in its direction."""
    order = sorted(ends, key=lambda number: ends[number])
    if not curve.closed:
        pairs = list(pairwise(order))
        return [(curve, ends[a], ends[b], a, b) for a, b in pairs]
    period = 2.0 * np.pi
    if not order:
        return [(curve, 0.0, period, None, None)]
    pairs = list(zip(order, [*order[1:], order[0]], strict=True))
    stops = [ends[b] for _, b in pairs[:-1]] + [ends[order[0]] + period]
    return [(curve, ends[a], stop, a, b) for (a, b), stop in zip(pairs, stops, strict=True)]


def _loops(links: list[Link]) -> list[Loop] | None:
    """Join pieces at their ends; None if some form no closed loop.

    Where more than two pieces meet, parts of the workspace are separated.
    """
    leaving: dict[int | None, list[Link]] = defaultdict(list)
    for link in links:
        leaving[link[3]].append(link)
    loops: list[Loop] = [[link] for link in leaving.pop(None, [])]
    while any(leaving.values()):
        loop = [next(way for way in leaving.values() if way).pop()]
        while loop[-1][4] != loop[0][3]:
            choices = leaving[loop[-1][4]]
            if not choices:
                return None
            best = max(choices, key=lambda link: _left_turn(loop[-1], link))
            choices.remove(best)
            loop.append(best)
        loops.append(loop)
    return loops


def _left_turn(before: Link, after: Link) -> float:
    """Return by how much a path turns to the left from one piece to the next, plus π/2 [rad].

    A corner of the workspace has an angle between 0 and π, as each limit alone leaves a half-plane
    there, so what is negative is 0, or π where curves touch, up to rounding.
    """
    u, v = before[0].direction(before[2]), after[0].direction(after[1])
    return float((np.arctan2(u[0] * v[1] - u[1] * v[0], u @ v) + 0.5 * np.pi) % (2.0 * np.pi))


def _plain(loop: Loop) -> tuple[tuple[Curve, float, float], ...]:
    return tuple((curve, start, stop) for curve, start, stop, *_ in loop)


def _area(loop: Loop, origin: Array) -> float:
    """Return the area that a loop encloses, negative if it is clockwise (Green's theorem)."""
    return sum(curve.area(start, stop, origin) for curve, start, stop, *_ in loop)


def _winding(loop: tuple[tuple[Curve, float, float], ...], points: Array) -> Array:
    """Return how often a loop goes around points (..., 2), counter-clockwise."""
    total = np.zeros(points.shape[:-1])
    for curve, start, stop in loop:
        total += curve.angle_seen(start, stop, points)
    return total / (2.0 * np.pi)


def _component(area: float, loop: Loop, holes: list[tuple[float, Loop]]) -> PlanarComponent:
    inner = [hole for _, hole in holes]
    return PlanarComponent(
        area + sum(less for less, _ in holes),
        _drawn(loop),
        tuple(_drawn(hole) for hole in inner),
        tuple(_plain(part) for part in (loop, *inner)),
    )


def _drawn(loop: Loop) -> tuple[Piece, ...]:
    return tuple(
        Piece(curve.active, curve.drawn(start, stop), first, last)
        for curve, start, stop, first, last in loop
    )
