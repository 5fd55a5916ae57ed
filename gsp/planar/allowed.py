"""Positions that the legs of a planar platform allow at a fixed angle, and the curves around them.

A D1 leg keeps the platform origin in a ring, a D2 or D3 leg in one strip or two, and an A1 leg
allows an angle or not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp.geometry.frames import exp3
from gsp.geometry.vectors import Array, Mask, norm
from gsp.limits.quantities import BoundedQuantities
from gsp.planar.curves import Curve, same_curve
from gsp.planar.design import PlanarDesign
from gsp.workspace.exact.spheres import SAME_TOLERANCE


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
    """

    centre: Array
    normal: Array
    low: Array
    high: Array
    number: tuple[int, ...]
    possible: bool

    @classmethod
    def of(cls, design: PlanarDesign, bounds: BoundedQuantities, angle: float) -> Legs:
        """Return the legs of a design at an angle [rad]."""
        rotation = exp3(np.array([0.0, 0.0, angle]))
        values = bounds.quantities.values(np.zeros(3), rotation)
        slack = SAME_TOLERANCE
        angular = design.angular
        fits = (values >= bounds.low - slack) & (values <= bounds.high + slack)
        names = np.array([leg.name for leg in design.legs])
        lines = np.zeros((len(names), 2))
        turn = rotation[:2, :2]
        lines[names == "D2"] = design.platform_directions[names == "D2"] @ turn.T
        lines[names == "D3"] = design.base_directions[names == "D3"]
        normal = np.stack((-lines[:, 1], lines[:, 0]), axis=1)
        centre = design.base_points - design.platform_points @ turn.T
        kept = ~angular
        low, high = np.maximum(bounds.low, 0.0), bounds.high
        number = tuple(np.flatnonzero(kept).tolist())
        possible = bool(fits[angular].all())
        return cls(centre[kept], normal[kept], low[kept], high[kept], number, possible)

    @property
    def size(self) -> float:
        """Greatest finite stroke or distance of the centres [length]."""
        finite = self.high[np.isfinite(self.high)]
        middle = self.centre.mean(axis=0)
        return float(max(finite.max(initial=0.0), self.low.max(), norm(self.centre - middle).max()))

    @property
    def bounded(self) -> bool:
        """Whether the greatest lengths bound the positions."""
        held = self.normal[np.isfinite(self.high)]
        if (norm(held) == 0.0).any():
            return True
        sines = held[:, :1] * held[None, :, 1] - held[:, 1:] * held[None, :, 0]
        return bool((np.abs(sines) > SAME_TOLERANCE).any())

    def allow(self, points: Array, slack: float) -> Mask:
        """Return whether positions (q, 2) are within the limits up to a slack [length]."""
        offset = points[:, None] - self.centre
        line = np.abs((offset * self.normal).sum(axis=-1))
        value = np.where(norm(self.normal) == 0.0, norm(offset), line)
        return np.asarray(((value >= self.low - slack) & (value <= self.high + slack)).all(axis=1))

    def curves(self, slack: float) -> list[Curve]:
        """Return the circles and lines that bound the positions, each once, with all its limits.

        Curves nearer than `slack` [length] are one. A curve that one limit allows on one side only,
        and another on the other side only, bounds nothing.
        """
        every: list[Curve] = []
        for leg, (low, high) in enumerate(zip(self.low, self.high, strict=True)):
            for side, reach in ((0, low), (1, high)):
                if 0.0 < reach < np.inf:
                    key = (self.number[leg], side)
                    every += Curve.of_limit(self.centre[leg], self.normal[leg], float(reach), key)
        found: list[Curve] = []
        dropped: set[int] = set()
        for curve in every:
            for i, other in enumerate(found):
                relation = same_curve(curve, other, slack)
                if relation > 0:
                    found[i] = other.with_limits(curve.active)
                    break
                if relation < 0:
                    dropped |= {i, len(found)}
            else:
                found.append(curve)
        return [curve for i, curve in enumerate(found) if i not in dropped]
