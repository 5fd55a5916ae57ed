"""Boxes of poses: intervals of the position and of three named angles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_type, plain_text
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose.intervals import check_bounds, grid_points, sample_points
from gsp.geometry.pose.poses import Pose
from gsp.geometry.rotations import angle_set
from gsp.geometry.vectors import Array, frozen


@dataclass(frozen=True, eq=False, init=False)
class PoseBox(ReadOnly):
    """A box of positions and angles.

    Parameters
    ----------
    position : three numbers or pairs (low, high) [unit of the design]
        Intervals of the coordinates; a single number stands for an interval of no width.
    angles : three numbers or pairs (low, high) [rad, or degrees]
    degrees : bool
        Whether the angles are in degrees.
    order : str
        The angle set: see `rotation_from_angles`.

    Attributes
    ----------
    low, high : (6,) arrays [unit of the design, rad]
    order : str

    Raises
    ------
    InvalidInput
        On intervals that cross, numbers that are not finite, positions beyond 1e100, or an unknown
        order.
    """

    low: Array
    high: Array
    order: str

    def __init__(
        self,
        position: Sequence[Any],
        angles: Sequence[Any],
        *,
        degrees: bool = False,
        order: str = "rpy",
    ) -> None:
        low, high = check_bounds(position, angles, degrees=degrees)
        angle_set(order)  # raises an error for an unknown order here, not at the first use
        object.__setattr__(self, "low", frozen(low))
        object.__setattr__(self, "high", frozen(high))
        object.__setattr__(self, "order", plain_text(order))

    @classmethod
    def around(cls, pose: Pose, half_widths: ArrayLike, *, order: str = "rpy") -> PoseBox:
        """Return the smallest box that holds the given poses, widened.

        Parameters
        ----------
        pose : Pose of any batch shape, not empty
        half_widths : (6,) array_like [unit of the design, rad]
            ≥ 0, added on both sides.
        order : str
            The angle set: see `rotation_from_angles`.

        Returns
        -------
        PoseBox

        Raises
        ------
        InvalidInput
            Without a pose, or on half-widths that are negative.
        """
        check_type("pose", pose, Pose)
        if not pose.size:
            raise InvalidInput(expected("pose", "at least one pose", "an empty batch"))
        wide = check_array("half_widths", half_widths, (6,))
        if wide.ndim != 1 or (wide < 0.0).any():
            raise InvalidInput(expected("half_widths", "six numbers ≥ 0", wide.tolist()))
        values = np.concatenate((pose.position, pose.angles(order)), axis=-1).reshape(-1, 6)
        low, high = values.min(axis=0) - wide, values.max(axis=0) + wide
        pairs = np.stack((low, high), axis=-1)
        return cls(pairs[:3].tolist(), pairs[3:].tolist(), order=order)

    def pose(self, values: ArrayLike) -> Pose:
        """Return poses from coordinates.

        Parameters
        ----------
        values : (..., 6) array_like [unit of the design, rad]
            Positions, then angles of the box's set; they may lie outside of the box.

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            On a wrong shape, or numbers that are not finite.
        """
        given = check_array("values", values, (6,))
        return Pose.from_angles(given[..., :3], given[..., 3:], self.order)

    def grid(self, counts: int | Sequence[int]) -> Pose:
        """Return the product grid with its end points.

        Parameters
        ----------
        counts : one or six integers ≥ 1
            Points per coordinate; a coordinate with one point takes the middle of its interval.

        Returns
        -------
        Pose of batch shape `counts`

        Raises
        ------
        InvalidInput
            If `counts` are not such integers.
        """
        return self.pose(grid_points(self.low, self.high, counts))

    def sample(self, n: int, *, rng: np.random.Generator | int, method: str = "halton") -> Pose:
        """Return a low-discrepancy sample of the box.

        Parameters
        ----------
        n : int
            Number of poses, ≥ 1.
        rng : numpy.random.Generator or int
            Generator or seed.
        method : "halton" or "sobol"
            Scrambled sequences of `scipy.stats.qmc`; sobol is balanced where n is a power of two.

        Returns
        -------
        Pose of batch shape (n,)

        Raises
        ------
        InvalidInput
            On a number, generator or method that cannot be used.
        """
        return self.pose(sample_points(self.low, self.high, n, rng, method))
