"""Rods of which the links of a design are made, with one radius and one density."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gsp.bridges.links.motions import Chain, Span, X, displacements
from gsp.bridges.links.shapes import Capsule
from gsp.geometry.vectors import Array, norm

OVERLAP_SHARE = 0.6  # of the length of a leg, taken by each of its two links
# Half the length of the carriage of a slider, and how far the axle of a crank is longer than it
# needs to be, in radii of the legs.
CARRIAGE_LENGTH = 3.0
# Mass of the links between the turns and slides into which a joint is split where a format has no
# joint of several freedoms, as a share of a ball of the radius of the legs. Larger shares change
# the motion: the platform's acceleration by about 2e-6 of g for a share of 0.01.
SPLIT_SHARE = 0.001
# The reader of Gazebo leaves out links of 1e-6 kg and less of a URDF, with all that they carry. In
# small machines these links are heavier than that, up to a share of a ball.
LEAST_SPLIT = 1.2e-6  # kg
LARGEST_SPLIT_SHARE = 0.1

Ends = tuple[Array, Array]


@dataclass(frozen=True)
class Stock:
    """Size of rods in the unit of the design, and their density in kg per unit cubed."""

    size: float
    radius: float
    weight: float
    link_mass: float | None

    def rod(
        self, start: Array, end: Array, share: float = 1.0, mass: float | None = None
    ) -> Capsule:
        """Make a rod of a share of the full radius, and of its natural mass if none is given."""
        r = self.radius * share
        volume = np.pi * r**2 * (float(norm(end - start)) + 4.0 / 3.0 * r)
        return Capsule(start, end, r, float(self.weight * volume) if mass is None else mass)

    def links(self, chain: Chain, span: Span) -> dict[str, tuple[Capsule, ...]]:
        """Make the two links of a leg, and its rail or ball on the platform."""
        ends = self._telescope(chain, span) if chain.telescopic else self._crank_and_rod(chain)
        lower, upper = ends
        parts: dict[str, tuple[Capsule, ...]] = {
            f"{chain.name}_lower": (self.rod(*lower, mass=self.link_mass),),
            f"{chain.name}_upper": (self.rod(*upper, 0.6, self.link_mass),),
        }
        if chain.leg.platform_line:
            start, end = _rail(span.platform, 0.3 * self.size)
            parts[f"{chain.name}_rail"] = (self.rod(start, end, 0.5),)
        else:
            parts[f"{chain.name}_ball"] = (self.ball(),)
        return parts

    def _telescope(self, chain: Chain, span: Span) -> tuple[Ends, Ends]:
        """Return the ends of two links that overlap, each from the foot at which it is."""
        length = min(OVERLAP_SHARE * span.longest, chain.length)
        reach = chain.middle[0].axis * max(length, 2.0 * self.radius)
        return (np.zeros(3), reach), (-reach, np.zeros(3))

    def _crank_and_rod(self, chain: Chain) -> tuple[Ends, Ends]:
        """Return the ends of a crank, from its axis to its tip, or of a carriage, and of a rod."""
        tip = chain.middle[0].offset
        on_axis = (tip @ X) * X
        crank = (on_axis, tip)
        if np.array_equal(tip, on_axis):
            half = CARRIAGE_LENGTH * self.radius * X
            crank = (tip - half, tip + half)
        return crank, (np.zeros(3), chain.platform[0].offset)

    def ball(self, share: float = 1.0) -> Capsule:
        """Make a ball of the radius of the legs, and of a share of its natural mass."""
        natural = self.rod(np.zeros(3), np.zeros(3))
        return replace(natural, mass=share * natural.mass)

    def split(self) -> Capsule:
        """Make a link between the turns and slides of one joint."""
        share = LEAST_SPLIT / self.ball().mass
        return self.ball(min(max(SPLIT_SHARE, share), LARGEST_SPLIT_SHARE))

    def base_rail(self, chain: Chain, span: Span) -> Capsule:
        """Make the rail of a leg on the base, or the axle of its crank, in base axes."""
        at = float(chain.middle[0].offset @ X)
        spare = 0.3 * self.size if displacements(chain.base) else CARRIAGE_LENGTH * self.radius
        start, end = _rail((span.base[0] + at, span.base[1] + at), spare)
        turn, origin = chain.foot.rotation, chain.foot.position
        return self.rod(origin + turn @ start, origin + turn @ end, 0.5)


def _rail(feet: tuple[float, float], spare: float) -> Ends:
    """Return the ends of a rail that holds the anchor and the feet, and some length to slide."""
    return X * (min(0.0, feet[0]) - spare), X * (max(0.0, feet[1]) + spare)


def plate_ends(points: Array) -> list[Ends]:
    """Return the ends of rods from the middle of some points to each, and around.

    Parameters
    ----------
    points : (n, 3) array
    """
    middle = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - middle)
    flat = (points - middle) @ axes[:2].T
    around = points[np.argsort(np.arctan2(flat[:, 1], flat[:, 0]), kind="stable")]
    pairs = [(middle, p) for p in points]
    pairs += list(zip(around, np.roll(around, -1, axis=0), strict=True))
    return [(a, b) for a, b in pairs if norm(a - b) > 0.0] or [(middle, middle)]
