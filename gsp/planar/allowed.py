"""Positions that the legs of a planar platform allow at a fixed angle, and the curves around them.

A D1 leg keeps the platform origin in a ring, a D2 or D3 leg in one strip or two, and an A1 leg
allows an angle or not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np

from gsp.geometry.frames import exp3
from gsp.geometry.vectors import Array, Mask, norm
from gsp.limits.quantities import BoundedQuantities
from gsp.planar.curves import Curve, same_curve
from gsp.planar.design import PlanarDesign
from gsp.workspace.exact.spheres import SAME_TOLERANCE

# Rounding of the centres of curves [share of the greatest coordinate].
CENTRE_ROUNDING = 8.0 * np.finfo(float).eps


@dataclass(frozen=True, eq=False)
class Legs:
    """What the legs allow at a fixed angle.

    Attributes
    ----------
    centre : (n, 2) array [length]
        a − R b.
    normal : (n, 2) array [1]
        Of the line of D2 and D3 legs; zero for D1 legs.
    low, high : (n,) arrays [length]
    number : n integers
        Of each leg in the design: A1 legs are left out.
    possible : bool
        Whether the A1 legs allow the angle.
    rounding : float [length]
        Of the centres.
    """

    centre: Array
    normal: Array
    low: Array
    high: Array
    number: tuple[int, ...]
    possible: bool
    rounding: float

    @classmethod
    def of(cls, design: PlanarDesign, bounds: BoundedQuantities, angle: float) -> Legs:
        """Return the legs of a design at an angle [rad]."""
        rotation = exp3(np.array([0.0, 0.0, angle]))
        angular = design.angular
        names = np.array([leg.name for leg in design.legs])
        lines = np.zeros((len(names), 2))
        turn = rotation[:2, :2]
        lines[names == "D2"] = design.platform_directions[names == "D2"] @ turn.T
        lines[names == "D3"] = design.base_directions[names == "D3"]
        normal = np.stack((-lines[:, 1], lines[:, 0]), axis=1)
        centre = design.base_points - design.platform_points @ turn.T
        kept = ~angular
        low, high = np.maximum(bounds.low, 0.0), bounds.high
        greatest = max(np.abs(p).max() for p in (design.base_points, design.platform_points))
        return cls(
            centre[kept],
            normal[kept],
            low[kept],
            high[kept],
            tuple(np.flatnonzero(kept).tolist()),
            angle_allowed(bounds, rotation, angular),
            float(CENTRE_ROUNDING * greatest),
        )

    @property
    def disc(self) -> tuple[Array, float] | None:
        """Centre (2,) and radius [length] of a disc with all positions; None if there is none.

        The smallest of the discs of D1 legs, and of those around the parallelograms of two legs
        with lines.
        """
        round_, held = norm(self.normal) == 0.0, np.isfinite(self.high)
        found = [
            (float(self.high[i]), self.centre[i].copy()) for i in np.flatnonzero(round_ & held)
        ]
        for pair in combinations(np.flatnonzero(~round_ & held), 2):
            rows = self.normal[list(pair)]
            if abs(rows[0, 0] * rows[1, 1] - rows[0, 1] * rows[1, 0]) <= SAME_TOLERANCE:
                continue
            middle = np.linalg.solve(rows, (rows * self.centre[list(pair)]).sum(axis=1))
            corners = np.linalg.solve(rows, self.high[list(pair), None] * [[1.0, 1.0], [1.0, -1.0]])
            found.append((float(np.hypot(*corners).max()), middle))
        if not found:
            return None
        radius, centre = min(found, key=lambda item: item[0])
        return centre, radius

    def scaled(self, middle: Array, unit: float) -> Legs:
        """Return the legs for positions from a point (2,), in another unit [length]."""
        return replace(
            self,
            centre=(self.centre - middle) / unit,
            low=self.low / unit,
            high=self.high / unit,
            rounding=self.rounding / unit,
        )

    def size(self, radius: float) -> float:
        """Return the greatest radius of a circle that meets a disc about the origin [length].

        At least the radius of the disc itself.
        """
        far = norm(self.centre)[:, None]
        reach = np.stack((self.low, self.high), axis=1)
        with np.errstate(invalid="ignore"):
            meets = np.abs(far - reach) <= radius + SAME_TOLERANCE * (far + reach)
        meets &= np.isfinite(reach) & (norm(self.normal) == 0.0)[:, None]
        return float(max(radius, reach[meets].max(initial=0.0)))

    def limits(self, radius: float, slack: float) -> Limits | None:
        """Return the curves that bound positions in a disc about the origin, each once.

        Curves of one side that are nearer than `slack` [length] are one. None if a limit excludes
        the whole disc.
        """
        curves: list[Curve] = []
        groups: list[tuple[int, ...]] = []
        for leg, side in product(range(len(self.low)), (0, 1)):
            reach = float((self.low, self.high)[side][leg])
            if not 0.0 < reach < np.inf:
                continue
            key = (self.number[leg], side)
            every = Curve.of_limit(self.centre[leg], self.normal[leg], reach, key)
            near = [curve for curve in every if abs(curve.margin(np.zeros(2))) <= radius + slack]
            beyond = [curve for curve in every if abs(curve.margin(np.zeros(2))) > radius + slack]
            met = [curve.margin(np.zeros(2)) > 0.0 for curve in beyond]
            # Of two lines at a least length a position satisfies one, of others all.
            if side == 0:
                if any(met):
                    continue
                if not near:
                    return None
                groups.append(tuple(_number(curve, curves, slack) for curve in near))
            elif not all(met):
                return None
            else:
                groups += [(_number(curve, curves, slack),) for curve in near]
        return Limits(curves, groups)


@dataclass(frozen=True, eq=False)
class Limits:
    """The curves that bound positions, and how.

    Attributes
    ----------
    curves : list of Curve
        Each once, with all the limits that it stands for.
    groups : list of tuples of int
        Numbers of curves: a position is allowed if it is on the feasible side of at least one curve
        of each group.
    """

    curves: list[Curve]
    groups: list[tuple[int, ...]]

    def margins(self, points: Array, on: Array | None = None) -> Array:
        """Return the least margin of points (m, 2) in any limit, shape (m,) [length].

        `on` has the numbers (m,) of curves whose own limit is left out.
        """
        every = np.stack([curve.margin(points) for curve in self.curves], axis=1)
        if on is not None:
            every[np.arange(len(points)), on] = np.inf
        least = [every[:, list(group)].max(axis=1) for group in self.groups]
        return np.asarray(np.min(least, axis=0))

    def moved(self, far: Array) -> Limits | None:
        """Return limits narrower by lengths (n,), one per curve; None if they allow nothing."""
        curves = [curve.moved(float(d)) for curve, d in zip(self.curves, far, strict=True)]
        gone = any(
            old.closed and not new.closed for old, new in zip(self.curves, curves, strict=True)
        )
        return None if gone else Limits(curves, self.groups)


def _number(curve: Curve, known: list[Curve], slack: float) -> int:
    """Return the number of a curve among known ones, to which it is added if it is new."""
    for i, other in enumerate(known):
        if same_curve(curve, other, slack):
            known[i] = other.with_limits(curve.active)
            return i
    known.append(curve)
    return len(known) - 1


def angle_allowed(bounds: BoundedQuantities, rotation: Array, angular: Mask) -> bool:
    """Return whether the A1 legs allow a rotation (3, 3), up to rounding.

    A value of half a turn has either sign.
    """
    values = bounds.quantities.values(np.zeros(3), rotation)[angular]
    low, high = bounds.low[angular] - SAME_TOLERANCE, bounds.high[angular] + SAME_TOLERANCE
    half = np.pi - np.abs(values) <= SAME_TOLERANCE
    fits = (values >= low) & (values <= high) | half & (-values >= low) & (-values <= high)
    return bool(fits.all())
