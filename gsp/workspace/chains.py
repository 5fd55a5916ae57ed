"""Chains: the curves of a section that a turning ray meets one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array
from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import Array, norm
from gsp.workspace.boundary.critical import Chart, Points
from gsp.workspace.boundary.maxima import why_not_maximal
from gsp.workspace.boundary.sections import Section

# How near to a ray the end of a curve counts as on it [rad].
RAY_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Way:
    """A curve of a section, in one sense.

    Attributes
    ----------
    number : int
        Of the curve.
    backward : bool
        Whether from its last point to its first.
    turned : (N,) array [rad]
        How far the ray to each of its points has turned, from that to the first one.
    distance : (N,) array [length]
        From the radiating point.
    """

    number: int
    backward: bool
    turned: Array
    distance: Array


@dataclass(frozen=True, eq=False)
class Rays:
    """Rays that turn about a point of the plane of a section, in one sense.

    Attributes
    ----------
    section : Section
    origin : (3,) array [length]
    sense : 1.0 or -1.0
        Whether their angles become greater.
    step : float [rad]
        From one ray to the next.
    """

    section: Section
    origin: Array
    sense: float
    step: float

    def way(self, number: int, backward: bool) -> Way:
        """Return a curve in one sense."""
        x, y = self._flat(number).T
        turned = self.sense * np.unwrap(np.arctan2(y, x))
        away = np.hypot(x, y)
        if backward:
            turned, away = turned[::-1], away[::-1]
        return Way(number, backward, turned - turned[0], away)

    def before(self, number: int, angle: float) -> float | None:
        """How far a ray turns from an angle to the first point of a curve, ≤ 0; None if apart."""
        x, y = self._flat(number).T
        every = self.sense * (np.unwrap(np.arctan2(y, x)) - angle)
        every += 2.0 * np.pi * np.floor((RAY_TOLERANCE - every.min()) / (2.0 * np.pi))
        return float(every[0]) if every.max() > RAY_TOLERANCE else None

    def onward(self, number: int, arrived: Way) -> Way | None:
        """Return the curve on which the next ray ends, of those that leave a bifurcation point."""
        back = arrived.number, not arrived.backward
        ways = [
            way
            for way in self._leaving(number)
            if (way.number, way.backward) != back and self._ends(way)
        ]
        angle = min((way.turned[self.next(way)] for way in ways), default=0.0)
        return max(ways, key=lambda way: np.interp(angle, way.turned, way.distance), default=None)

    def next(self, way: Way) -> int:
        """Return the number of the first point that the next ray has reached, else of the last."""
        reached = way.turned >= self.step
        return int(np.argmax(reached)) if reached.any() else len(reached) - 1

    def _leaving(self, number: int) -> Iterator[Way]:
        for i, curve in enumerate(self.section.curves):
            for end, backward in ((curve.first, False), (curve.last, True)):
                if end == number:
                    yield self.way(i, backward)

    def _ends(self, way: Way) -> bool:
        """Whether the next ray has a local maximum on a curve."""
        curve, place = self.section.curves[way.number], self.next(way)
        if way.turned[place] <= 0.0:
            return False
        at = [len(way.turned) - 1 - place if way.backward else place]
        point = Points(curve.pose.position, curve.pose.rotation, curve.weight)[at]
        chart = Chart(self.section.bounds, np.eye(3), self.section.turns)
        ray = point.position - self.origin
        jet, solved = chart.jet(point.position, point.rotation), np.ones(1, dtype=bool)
        return not why_not_maximal(chart, point, jet, curve.active, ray / norm(ray), solved)[0]

    def _flat(self, number: int) -> Array:
        points = self.section.curves[number].pose.position - self.origin
        return np.asarray(points @ self.section.axes.T)


@arguments.validated(
    section=arguments.kind(Section, "a section, as gsp.workspace.section returns it"),
    curve=arguments.integer(0),
    start=arguments.number,
    stop=arguments.number,
    step=arguments.size,
)
def curve_chain(
    section: Section,
    curve: int,
    start: float,
    stop: float,
    *,
    step: float = np.pi / 180.0,
    origin: ArrayLike | None = None,
) -> tuple[int, ...]:
    """Return the curves of a section that a turning ray meets one after the other.

    It begins on a curve and follows it. At a bifurcation point it goes on with the curve on which
    the ray a step further has its farthest local maximum. That is the search of the source, in
    which each ray starts from the end of the ray before: it does not change to another family of
    orientations that reaches farther.

    Parameters
    ----------
    section : Section
        As `section` or `boundary_curves` returns it, with connecting curves.
    curve : int
        Number of the first curve.
    start, stop : float [rad]
        Angles of the first and of the last ray, from axes[0] of the section toward axes[1].
    step : float [rad]
        From one ray to the next, > 0. Where a curve turns back by less, the rays go on.
    origin : (3,) array_like or None [length]
        The radiating point; default that of the section.

    Returns
    -------
    tuple of int
        Numbers of curves. The chain ends before the last ray where no curve goes on, or where one
        turns back.

    Raises
    ------
    InvalidInput
        If the first ray does not meet the curve, or for a wrong type or range.

    Examples
    --------
    >>> import gsp, numpy as np
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> mapped = gsp.workspace.section(d, rays=[1.4, 4.9], starts=4, connecting=False)
    >>> top = [mapped.curves[i].pose.position[:, 2].max() for i in mapped.find("-1111-")]
    >>> first = mapped.find("-1111-")[int(np.argmax(top))]
    >>> chain = gsp.workspace.curve_chain(mapped, first, np.pi / 2, -np.pi / 2)
    >>> [mapped.curves[i].label for i in chain][:2]
    ['- 1 1 1 1 -', '0 1 - - 1 0']

    *Source: Workspace-3, §3.4.2, figures 3.3 and 3.4; the choice at bifurcation points is ours*
    """
    if curve >= len(section.curves):
        raise InvalidInput(
            expected("curve", f"a number of a curve below {len(section.curves)}", curve)
        )
    place = section.origin if origin is None else check_array("origin", origin, (3,))
    if place.ndim != 1:
        raise InvalidInput(expected("origin", "a single point", f"shape {place.shape}"))
    rays = Rays(section, place, 1.0 if stop >= start else -1.0, step)
    return tuple(_chain(rays, curve, start, abs(stop - start)))


def _chain(rays: Rays, number: int, start: float, turn: float) -> Iterator[int]:
    """Yield the curves of rays that turn by an angle from a first one."""
    before = rays.before(number, start)
    if before is None:
        raise InvalidInput(expected("curve", "one that the first ray meets", number))
    way = rays.way(number, False)
    if way.turned[-1] < 0.0:  # it is followed from its other end
        before, way = before + float(way.turned[-1]), rays.way(number, True)
    seen = set()
    while (way.number, way.backward) not in seen:
        seen.add((way.number, way.backward))
        yield way.number
        before += float(way.turned[-1])
        curve = rays.section.curves[way.number]
        node = curve.first if way.backward else curve.last
        back = np.maximum.accumulate(way.turned) - way.turned
        done = back.max() > rays.step or before >= turn - RAY_TOLERANCE
        onward = None if done or node is None else rays.onward(node, way)
        if onward is None:
            return
        way = onward
