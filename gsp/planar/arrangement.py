"""Which pieces of circles and lines enclose the parts of a set, decided for narrower limits.

Symmetric designs have curves that touch, pass one point or coincide, where rounding would decide
what is connected. So all limits are first made narrower by about half the tolerance, each by
another share of it. What touched or nearly touched then overlaps by far more than rounding, slivers
are gone, and no three curves pass one point. The loops of this set are unambiguous. Afterwards
their corners are moved back to where the curves themselves cross or touch.
"""

from __future__ import annotations

from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np

from gsp.geometry.vectors import Array, norm
from gsp.planar.allowed import Limits
from gsp.planar.curves import Curve, crossings, touching

# Limits are narrower by half the tolerance times 1 to 1.25, different for each curve: fractional
# parts of multiples of the golden ratio are far apart. Each try has other shares.
NARROWING_SPREAD, GOLDEN, NEXT_TRY = 0.25, 0.6180339887498949, 0.41421356237309503
# Tries before an error. One is enough unless two of the moved curves touch up to rounding.
CONTACT_TRIES = 8
# How far corners may violate a limit [tolerances]: curves within one tolerance are one.
CORNER_SLACK = 2.5


class Corner(NamedTuple):
    """Where two curves cross: their numbers, which of the crossings it is, and its position."""

    curves: tuple[int, int]
    branch: int
    at: Array


class Link(NamedTuple):
    """A piece of a curve: the parameters of its ends, and the numbers of its corners."""

    curve: int
    start: float
    stop: float
    first: int | None
    last: int | None


Loop = list[Link]


def shrunk(limits: Limits, tolerance: float, attempt: int) -> Limits | None:
    """Return limits that are narrower by about half a tolerance [length]; None if none is left."""
    number = np.arange(1.0, len(limits.curves) + 1.0)
    share = (number * GOLDEN + attempt * NEXT_TRY) % 1.0
    return limits.moved(0.5 * tolerance * (1.0 + NARROWING_SPREAD * share))


def traced(limits: Limits) -> tuple[list[Loop], list[Corner]] | None:
    """Return the loops of pieces that bound a set, with the set on the left, and their corners.

    None if the pieces form no closed loops, as where curves touch up to rounding.
    """
    corners: list[Corner] = []
    on: list[dict[int, float]] = [{} for _ in limits.curves]
    for pair in combinations(range(len(limits.curves)), 2):
        one, other = (limits.curves[i] for i in pair)
        for branch, point in enumerate(crossings(one, other)):
            for i in pair:
                on[i][len(corners)] = limits.curves[i].parameter(point)
            corners.append(Corner(pair, branch, point))
    links = [
        link
        for i, (curve, ends) in enumerate(zip(limits.curves, on, strict=True))
        for link in between(i, curve, ends)
    ]
    if not links:
        return [], corners
    middle = [limits.curves[link.curve].at(0.5 * (link.start + link.stop)) for link in links]
    margins = limits.margins(np.stack(middle), np.array([link.curve for link in links]))
    loops = joined([link for link, margin in zip(links, margins, strict=True) if margin > 0.0])
    return None if loops is None else (loops, corners)


def between(number: int, curve: Curve, ends: dict[int, float]) -> list[Link]:
    """Return the pieces of a curve between its corners, in its direction."""
    order = sorted(ends, key=lambda corner: ends[corner])
    if not curve.closed:
        return [Link(number, ends[a], ends[b], a, b) for a, b in pairwise(order)]
    period = 2.0 * np.pi
    if not order:
        return [Link(number, 0.0, period, None, None)]
    stops = [*(ends[corner] for corner in order[1:]), ends[order[0]] + period]
    following = [*order[1:], order[0]]
    return [
        Link(number, ends[a], stop, a, b)
        for a, stop, b in zip(order, stops, following, strict=True)
    ]


def joined(links: list[Link]) -> list[Loop] | None:
    """Join pieces at their corners; None unless one ends where another one begins, at each."""
    leaving = {link.first: link for link in links if link.first is not None}
    ends = [link.last for link in links if link.last is not None]
    if sorted(leaving) != sorted(ends):
        return None
    loops: list[Loop] = [[link] for link in links if link.first is None]
    while leaving:
        loop = [leaving.pop(next(iter(leaving)))]
        while loop[-1].last != loop[0].first:
            loop.append(leaving.pop(loop[-1].last))  # type: ignore[arg-type]
        loops.append(loop)
    return loops


def restored(
    loops: list[Loop], corners: list[Corner], limits: Limits, tolerance: float, rounding: float
) -> list[Loop]:
    """Return loops with their corners where curves of the given limits cross or touch.

    A corner keeps its place where that would violate another limit, or reverse a piece. Corners
    within a tolerance are one, and shorter pieces are left out [length]. Overlaps of up to
    `rounding` [length] are contacts.
    """
    place = {
        link.first: _original(corners[link.first], limits, tolerance, rounding)
        for loop in loops
        for link in loop
        if link.first is not None
    }
    moved = [[_between_places(link, place, limits) for link in loop] for loop in loops]
    while reversed_ := {
        corner
        for loop in moved
        for link in loop
        if not link.stop > link.start
        for corner in (link.first, link.last)
        if corner is not None and place[corner] is not None
    }:
        place |= dict.fromkeys(reversed_)
        moved = [[_between_places(link, place, limits) for link in loop] for loop in loops]
    number = _numbered(
        {k: corners[k].at if at is None else at for k, at in place.items()}, tolerance
    )
    return [_numbers_of(loop, number, limits, tolerance) for loop in moved]


def _original(corner: Corner, limits: Limits, tolerance: float, rounding: float) -> Array | None:
    """Return where the curves of a corner cross or touch, None if that violates a limit."""
    one, other = (limits.curves[i] for i in corner.curves)
    crossed = crossings(one, other)
    if one.closed or other.closed:
        overlap, nearest = touching(one, other)
        point = nearest if overlap <= rounding or not crossed else crossed[corner.branch]
    else:
        point = crossed[corner.branch]
    kept = limits.margins(point[None])[0] >= -CORNER_SLACK * tolerance
    return point if kept else None


def _between_places(link: Link, place: dict[int, Array | None], limits: Limits) -> Link:
    """Return a piece of a curve between the new places of its corners."""
    curve, ends = limits.curves[link.curve], []
    for corner, end in ((link.first, link.start), (link.last, link.stop)):
        at = None if corner is None else place[corner]
        if at is None:
            ends.append(end)
            continue
        step = curve.parameter(at) - end
        # Of the angles of a point, the one nearest to that of the corner.
        ends.append(end + (step if not curve.closed else (step + np.pi) % (2.0 * np.pi) - np.pi))
    return link._replace(start=ends[0], stop=ends[1])


def _numbered(places: dict[int, Array], tolerance: float) -> dict[int, int]:
    """Return new numbers of corners, the same for those within a tolerance [length]."""
    number: dict[int, int] = {}
    points: list[Array] = []
    for corner, at in places.items():
        same = (k for k, other in enumerate(points) if norm(other - at) <= tolerance)
        number[corner] = next(same, len(points))
        if number[corner] == len(points):
            points.append(at)
    return number


def _numbers_of(loop: Loop, number: dict[int, int], limits: Limits, tolerance: float) -> Loop:
    """Return a loop with new numbers of corners, without pieces shorter than a tolerance."""
    long = []
    for link in loop:
        if (link.stop - link.start) * (limits.curves[link.curve].radius or 1.0) > tolerance:
            long.append(link)
    found = []
    for link in long or loop:
        first, last = (None if k is None else number[k] for k in (link.first, link.last))
        found.append(link._replace(first=first, last=last))
    return found
