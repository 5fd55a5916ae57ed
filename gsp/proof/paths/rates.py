"""Bounds of the speeds and accelerations of actuated joints along a path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gsp.checks import check_array
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.formulas import placement
from gsp.model.legs import LEGS, Leg
from gsp.proof.paths.charts import at_middle, enclosed
from gsp.proof.paths.pieces import Numbers, Pieces
from gsp.proof.paths.series import SUM_ROUNDING, Series
from gsp.proof.tolerances import Tolerances

# What is bounded, in this order.
RATES = ("speed", "acceleration")
# Coefficients of the series of joints: accelerations have the exact derivative.
JOINT_COEFFICIENTS = 4
# Bounds of one joint in one interval: on the interval, and at its middle.
LOW, HIGH, MID_LOW, MID_HIGH = range(4)


@dataclass(frozen=True, eq=False)
class _Group:
    """Legs of one kind: their anchors and lines as constants, and numbers of their joints."""

    kind: Leg
    points: tuple[list[Series], list[Series]]
    directions: tuple[list[Series], list[Series]]
    joints: list[Numbers]

    def nominal(self) -> _Group:
        """Return the legs without tolerances."""

        def exact(some: list[Series]) -> list[Series]:
            return [_constant(x.mid[0, :, 0], np.zeros(x.mid.shape[1])) for x in some]

        (a, b), (s, t) = self.points, self.directions
        return replace(self, points=(exact(a), exact(b)), directions=(exact(s), exact(t)))


@dataclass(frozen=True, eq=False)
class Rates:
    """Greatest speeds and accelerations of the joints of a design.

    Attributes
    ----------
    names : tuple of str
        Of the joints.
    most : (2, n) array [unit of the joint/time, /time²]
        Of speeds and accelerations; inf where there is no bound.
    groups : list
    """

    names: tuple[str, ...]
    most: Array
    groups: list[_Group]

    @classmethod
    def of(
        cls, design: Design, speeds: Any, accelerations: Any, tolerances: Tolerances | None
    ) -> Rates:
        """Return the bounds of a design.

        Raises
        ------
        InvalidInput
            Unless there is one positive number for all joints of one unit, or one for each.
        """
        given = Tolerances() if tolerances is None else tolerances
        most = [
            _most(design, name, x)
            for name, x in (("speeds", speeds), ("accelerations", accelerations))
        ]
        off = given.of_legs(design)
        first = np.cumsum([0] + [len(leg.constraints) for leg in design.legs])
        groups = []
        for kind in LEGS:
            legs = np.array([i for i, leg in enumerate(design.legs) if leg is kind], dtype=np.int64)
            if not legs.size:
                continue
            parts = [design.base_points, design.platform_points]
            parts += [
                np.nan_to_num(x) for x in (design.base_directions, design.platform_directions)
            ]
            a, b, s, t = (
                [_constant(x[legs, k], off[legs, i]) for k in range(3)] for i, x in enumerate(parts)
            )
            joints = [first[legs] + k for k in range(len(kind.constraints))]
            groups.append(_Group(kind, (a, b), (s, t if kind.platform_line else []), joints))
        return cls(tuple(design.joint_names), np.array(most), groups)

    def nominal(self) -> Rates:
        """Return the bounds of the design itself, without tolerances."""
        return replace(self, groups=[group.nominal() for group in self.groups])

    @property
    def claims(self) -> dict[str, list[float | None]]:
        """The bounds by the names of speeds and accelerations."""
        return {
            f"{kind} of {name}": [-float(x), float(x)]
            for kind, row in zip(RATES, self.most, strict=True)
            for name, x in zip(self.names, row, strict=True)
            if np.isfinite(x)
        }

    @property
    def accelerated(self) -> bool:
        """Whether an acceleration has a bound."""
        return bool(np.isfinite(self.most[1]).any())

    def bounds(self, pieces: Pieces, piece: Numbers, middle: Array, half: Array) -> Array:
        """Bounds of speeds and accelerations.

        Parameters
        ----------
        piece : (m,) int array
        middle, half : (m,) arrays
            Intervals of u.

        Returns
        -------
        (2, n_joints, m, 4) array [unit of the joint/time, /time²]
            Least and greatest value in each interval, and at its middle; infinite if unbounded.
        """
        with np.errstate(all="ignore"):
            return self._bounds(pieces, piece, middle, half)

    def _bounds(self, pieces: Pieces, piece: Numbers, middle: Array, half: Array) -> Array:
        m = len(middle)
        u = Series.variable(
            np.tile(middle, 2), np.concatenate((np.zeros(m), half)), JOINT_COEFFICIENTS
        )
        both = np.tile(piece, 2)
        place, turn = pieces.places(both, u), pieces.rotations(both, u)
        p = [place[i, None] for i in range(3)]
        r = [turn[i, j, None] for i in range(3) for j in range(3)]
        result = np.full((2, len(self.names), m, 4), np.nan)
        for group in self.groups:
            segment = group.kind.segment(placement(p, r, group.points, group.directions, 0.0))
            for constraint, joints in zip(group.kind.constraints, group.joints, strict=True):
                value, span = constraint.measure(segment), pieces.span[piece]
                for order in range(2):
                    value = value.derivative()
                    ends = [*enclosed(value, half), *at_middle(value, m)]
                    per = np.stack(ends, axis=-1) / (span ** (order + 1))[:, None]
                    per[..., ::2] -= 16.0 * SUM_ROUNDING * np.abs(per[..., ::2])
                    per[..., 1::2] += 16.0 * SUM_ROUNDING * np.abs(per[..., 1::2])
                    unbounded = [-np.inf, np.inf] * 2
                    result[order, joints] = np.where(np.isnan(per), unbounded, per)
        return result


def _constant(value: Array, radius: Array) -> Series:
    return Series.constant(
        value[:, None], (radius + SUM_ROUNDING * np.abs(value))[:, None], JOINT_COEFFICIENTS
    )


def _most(design: Design, name: str, given: Any) -> Array:
    n = len(design.joint_names)
    if given is None:
        return np.full(n, np.inf)
    value = check_array(name, given, (), finite=False)
    if value.shape not in ((), (n,)) or not (value[~np.isnan(value)] > 0.0).all():
        raise InvalidInput(expected(name, f"one number > 0 or {n}", brief(given)))
    if value.ndim == 0 and design.angular.any() and not design.angular.all():
        wanted = f"{n} numbers, one for each joint, as some are angles"
        raise InvalidInput(expected(name, wanted, "one number"))
    return np.broadcast_to(np.where(np.isnan(value), np.inf, value), (n,))
