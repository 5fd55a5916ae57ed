"""Coordinates of the dimensions of a design and of the zero points of its joints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, Mask, perpendicular, unit
from gsp.model.design import Design
from gsp.model.design.frame import POINTS
from gsp.model.posture import Posture
from gsp.model.posture.slopes import ANCHOR_DIRECTIONS, Directions, Slopes

# The dimensions of a leg, in the order of `Directions.anchors`, and the zero points.
ANCHORS = ("base_points", "platform_points", "base_directions", "platform_directions")
PARTS = (*ANCHORS, "joints")


class Coordinate(NamedTuple):
    """One coordinate of the dimensions.

    Attributes
    ----------
    name : str
        "base_x1", "platform_z6"; "base_line2a", "base_line2b" for the two turns of a line;
        "zero_d1" for the zero point of a joint.
    part : str
        One of `PARTS`.
    leg : int
        Counted from 0.
    """

    name: str
    part: str
    leg: int


@dataclass(frozen=True, eq=False, kw_only=True)
class Dimensions(ReadOnly):
    """Coordinates z (p,) of designs near a nominal one, which is z = 0.

    Anchor points have their three coordinates. A line has two, a and b: it turns to s + a u + b v,
    over its norm, with u and v across the nominal s. The zero point of a joint is what is added to
    its reading to give the joint value.

    Attributes
    ----------
    design : Design
        The nominal one.
    coordinates : tuple of Coordinate, p of them
    anchors : (p, n_legs, 12) array [1]
        Rates of a, b, s and t at the nominal design.
    zeros : (p, n) array [1]
        Rates of the zero points.
    angular : (p,) array of bool
        Whether a coordinate is in rad; others are in the unit of the design.
    """

    design: Design
    coordinates: tuple[Coordinate, ...]
    anchors: Array
    zeros: Array
    angular: Mask

    @classmethod
    def of(cls, design: Design, parts: Iterable[str] = PARTS) -> Self:
        """Return the coordinates of some parts of a design, leg by leg; zero points come last.

        Raises
        ------
        InvalidInput
            On a text that is no part, or if no coordinate is left.
        """
        wanted = tuple(parts)
        for part in wanted:
            if part not in PARTS:
                raise InvalidInput(expected("free", f"some of {', '.join(PARTS)}", brief(part)))
        found = [one for one in _all_coordinates(design) if one[0].part in wanted]
        if not found:
            raise InvalidInput(expected("free", "parts that the design has", ", ".join(wanted)))
        coordinates, anchors, zeros, angular = zip(*found, strict=True)
        return cls(
            design=design,
            coordinates=coordinates,
            anchors=np.array(anchors),
            zeros=np.array(zeros),
            angular=np.array(angular, dtype=bool),
        )

    def __len__(self) -> int:
        return len(self.coordinates)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return tuple(one.name for one in self.coordinates)

    @property
    def units(self) -> tuple[str, ...]:
        """Units of the coordinates: that of the design, or rad."""
        return tuple("rad" if angle else self.design.unit for angle in self.angular)

    @property
    def sizes(self) -> Array:
        """Return the size of the design for lengths and 1 for angles, shape (p,) [unit, rad]."""
        return np.where(self.angular, 1.0, self.design.rms_radius)

    def at(self, values: Array) -> Design:
        """Return the design at coordinates (p,) [unit, rad]."""
        legs = np.tensordot(values, self.anchors, 1)
        moved = {
            part: getattr(self.design, part) + legs[:, 3 * i : 3 * i + 3]
            for i, part in enumerate(ANCHORS)
        }
        return self.design.replace(**moved)

    def zero_points(self, values: Array) -> Array:
        """Return the zero points (n,) [unit, rad] at coordinates (p,) [unit, rad]."""
        return np.asarray(values @ self.zeros)

    def directions(self, design: Design) -> Directions:
        """Return how anchors and lines change with the coordinates at a design that `at` made."""
        rates = self.anchors.copy()
        for i, part in enumerate(ANCHORS[2:], 2):
            nominal, now = (np.nan_to_num(getattr(one, part)) for one in (self.design, design))
            # s = (s₀ + …) / |s₀ + …| with … across s₀, so 1 / |s₀ + …| = s₀ · s.
            rates[:, :, 3 * i : 3 * i + 3] *= (nominal * now).sum(axis=-1)[:, None]
        return Directions(anchors=rates, length=np.zeros(len(self)))

    def reading_slopes(self, posture: Posture) -> Array:
        """Return the derivatives (..., n, p) of the readings, joint value less zero point.

        Parameters
        ----------
        posture : Posture, batch shape (...)
            Of a design that `at` made.
        """
        found = Slopes(posture, self.directions(posture.design)).joints
        return np.asarray(np.swapaxes(found - self.zeros, -1, -2))


def _all_coordinates(design: Design) -> Iterator[tuple[Coordinate, Array, Array, bool]]:
    """Yield coordinates with their rates of anchors and of zero points, and whether in rad."""
    n = len(design.joint_names)
    for leg, kind in enumerate(design.legs):
        lines = (kind.base_line, kind.platform_line)
        for i, (side, part) in enumerate(zip(POINTS, ANCHORS, strict=False)):
            for name, rate in zip(POINTS[side], np.eye(3), strict=True):
                one = Coordinate(f"{name}{leg + 1}", part, leg)
                yield one, _of_leg(design, leg, i, rate), np.zeros(n), False
        for i, side in enumerate(POINTS):
            for letter, rate in _across(design, leg, i) if lines[i] else ():
                one = Coordinate(f"{side}_line{leg + 1}{letter}", ANCHORS[2 + i], leg)
                yield one, _of_leg(design, leg, 2 + i, rate), np.zeros(n), True
    still = np.zeros((design.n_legs, ANCHOR_DIRECTIONS))
    rows = zip(design.rows, design.joint_names, design.angular, np.eye(n), strict=True)
    for row, name, angle, rate in rows:
        yield Coordinate(f"zero_{name}", "joints", row.leg), still, rate, bool(angle)


def _across(design: Design, leg: int, side: int) -> Iterator[tuple[str, Array]]:
    """Yield the two unit vectors across a line."""
    line = getattr(design, ANCHORS[2 + side])[leg]
    first = unit(perpendicular(line))
    yield from (("a", first), ("b", np.cross(line, first)))


def _of_leg(design: Design, leg: int, part: int, rate: Array) -> Array:
    rates = np.zeros((design.n_legs, ANCHOR_DIRECTIONS))
    rates[leg, 3 * part : 3 * part + 3] = rate
    return rates
