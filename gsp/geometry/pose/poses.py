"""Poses of the platform."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import LARGEST_NUMBER, bounded_array
from gsp.checks import check_array, check_type
from gsp.errors import InvalidInput, apart, expected
from gsp.geometry.frames import compose, exp3, exp6, interpolate, inverse, log6
from gsp.geometry.frames.placements import PlacementLike, common_shape, frame, placement_of, se3
from gsp.geometry.pose.batch import Batched, unchecked
from gsp.geometry.pose.intervals import check_bounds, grid_points, sample_points
from gsp.geometry.rotations import (
    angles_from_rotation,
    check_rotation,
    known_rotations,
    rotation_from_angles,
)
from gsp.geometry.vectors import Array, frozen

if TYPE_CHECKING:
    import pinocchio


def check_position(what: str, value: ArrayLike, dimension: int) -> Array:
    """Return positions as float64, shape (..., dimension).

    Raises
    ------
    InvalidInput
        On another shape, and on numbers that are not finite or whose squares overflow.
    """
    position = check_array(what, value, (dimension,))
    largest = float(max(position.max(), -position.min())) if position.size else 0.0
    if largest > LARGEST_NUMBER:
        got, most = apart(largest, LARGEST_NUMBER)
        wanted = f"coordinates of at most {most}"
        raise InvalidInput(expected(what, wanted, f"{got} as the largest in size"))
    return position


@dataclass(frozen=True, eq=False, init=False)
class Pose(Batched):
    """Position and orientation of the platform in the base, for one pose or a batch.

    Parameters
    ----------
    position : (..., 3) array_like [unit of the design]
        The platform origin p in base axes.
    rotation : (..., 3, 3) array_like or None [1]
        R, from platform axes to base axes; default the identity.

    Raises
    ------
    InvalidInput, InvalidRotation
        On shapes that do not fit, numbers that are not finite, or a matrix that is not a rotation.

    Examples
    --------
    >>> Pose.from_rpy([0.0, 0.0, 1.0], [0.0, 0.0, 90.0], degrees=True).rotation.round(3)[0]
    array([ 0., -1.,  0.])
    """

    ARRAYS = MappingProxyType({"position": 1, "rotation": 2})

    position: Array
    rotation: Array

    def __init__(self, position: ArrayLike, rotation: ArrayLike | None = None) -> None:
        p = check_position("pose.position", position, 3)
        r = np.eye(3) if rotation is None else check_rotation("pose.rotation", rotation)
        shape = common_shape("pose", p.shape[:-1], r.shape[:-2])
        object.__setattr__(self, "position", frozen(np.broadcast_to(p, (*shape, 3))))
        object.__setattr__(self, "rotation", frozen(np.broadcast_to(r, (*shape, 3, 3))))

    @classmethod
    def from_angles(
        cls, position: ArrayLike, angles: ArrayLike, order: str = "rpy", *, degrees: bool = False
    ) -> Pose:
        """Return poses from three angles in a named order.

        Parameters
        ----------
        position : (..., 3) array_like [unit of the design]
            The platform origin.
        angles : (..., 3) array_like [rad, or degrees]
        order : str
            "rpy", "approach-roll", or axes such as "ZYX": see `rotation_from_angles`.
        degrees : bool
            Whether the angles are in degrees.

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            On wrong shapes, numbers that are not finite, or an unknown order.
        """
        return cls(position, rotation_from_angles(angles, order, degrees=degrees))

    @classmethod
    def from_rpy(cls, position: ArrayLike, angles: ArrayLike, *, degrees: bool = False) -> Pose:
        """Return poses from roll, pitch, yaw (α, β, γ): R = Rz(γ) Ry(β) Rx(α).

        Parameters
        ----------
        position : (..., 3) array_like [unit of the design]
            The platform origin.
        angles : (..., 3) array_like [rad, or degrees]
            (α, β, γ); for other sets of angles see `from_angles`.
        degrees : bool
            Whether the angles are in degrees.

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            On wrong shapes, or numbers that are not finite.

        *Source: TozKucuk2016 §3.1 names the set; its printed joint variables fix the order.*
        """
        return cls.from_angles(position, angles, "rpy", degrees=degrees)

    @classmethod
    def from_quaternion(cls, position: ArrayLike, xyzw: ArrayLike) -> Pose:
        """Return poses from quaternions, which are normalised.

        Parameters
        ----------
        position : (..., 3) array_like [unit of the design]
            The platform origin.
        xyzw : (..., 4) array_like [1]
            Quaternions (x, y, z, w).

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            On wrong shapes, or a quaternion of zero.
        """
        from scipy.spatial.transform import Rotation

        q = check_array("quaternion", xyzw, (4,))
        largest = np.abs(q).max(axis=-1, keepdims=True)
        if (largest == 0.0).any():
            raise InvalidInput(expected("quaternion", "a non-zero quaternion", "zero"))
        turn = Rotation.from_quat((q / largest).reshape(-1, 4))
        return cls(position, turn.as_matrix().reshape(*q.shape[:-1], 3, 3))

    @classmethod
    def exp(cls, twist: ArrayLike) -> Pose:
        """Return the poses that constant twists in platform axes reach from the base in unit time.

        Parameters
        ----------
        twist : (..., 6) array_like [unit of the design, rad]
            (v, ω), taken over unit time.

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            On a wrong shape, or numbers that are not finite or beyond 1e100.

        *Source: Murray1994, chapter 2: the exponential of a twist (v, ω)*

        Examples
        --------
        >>> quarter = Pose.exp([np.pi / 2, 0.0, 0.0, 0.0, 0.0, np.pi / 2])
        >>> quarter.position.round(12)
        array([1., 1., 0.])
        """
        return cls(*exp6(bounded_array("twist", twist, (6,))))

    @classmethod
    def from_se3(cls, placement: PlacementLike) -> Pose:
        """Return poses from objects of Pinocchio.

        Parameters
        ----------
        placement : pinocchio.SE3 or pinocchio.Frame (shape ()), or a sequence of n (shape (n,))

        Returns
        -------
        Pose

        Raises
        ------
        InvalidInput, InvalidRotation
            If it is none of these, or its matrix is not a rotation.
        """
        return cls(*placement_of(placement))

    @property
    def quaternion(self) -> Array:
        """The rotations as unit quaternions (x, y, z, w) with w ≥ 0, shape (..., 4) [1].

        NaN where the rotation is NaN.

        *Source: Murray1994, chapter 2: unit quaternions; the order of the components is scipy's*
        """
        turn, known = known_rotations(self.rotation)
        xyzw = np.where(known[:, None], turn.as_quat(canonical=True), np.nan)
        return np.asarray(xyzw, dtype=np.float64).reshape(*self.shape, 4)

    def to_se3(self) -> Any:
        """Return a `pinocchio.SE3`, or for a batch a list of them (nested as the batch is)."""
        return se3(self)

    def to_frame(self, name: str, joint: int = 0) -> pinocchio.Frame:
        """Return an operational frame of Pinocchio, for `pinocchio.Model.addFrame`.

        Parameters
        ----------
        name : str
        joint : int
            Number of the joint that carries it; default the universe.

        Returns
        -------
        pinocchio.Frame

        Raises
        ------
        InvalidInput
            For a batch.
        """
        return frame(name, self, joint)

    @classmethod
    def grid(
        cls,
        position: Sequence[Any],
        angles: Sequence[Any],
        counts: int | Sequence[int],
        *,
        degrees: bool = False,
        order: str = "rpy",
    ) -> Pose:
        """Return a product grid of poses over a box: `PoseBox(…).grid(counts)`.

        Parameters
        ----------
        position : three numbers or pairs (low, high) [unit of the design]
        angles : three numbers or pairs (low, high) [rad, or degrees]
        counts : one or six integers ≥ 1
            Points per coordinate.
        degrees : bool
            Whether the angles are in degrees.
        order : str
            The angle set: see `rotation_from_angles`.

        Returns
        -------
        Pose of batch shape `counts`

        Raises
        ------
        InvalidInput
            See `PoseBox` and `PoseBox.grid`.
        """
        low, high = check_bounds(position, angles, degrees=degrees)
        return cls._of_coordinates(grid_points(low, high, counts), order)

    @classmethod
    def sample(
        cls,
        position: Sequence[Any],
        angles: Sequence[Any],
        n: int,
        *,
        rng: np.random.Generator | int,
        degrees: bool = False,
        order: str = "rpy",
        method: str = "halton",
    ) -> Pose:
        """Return a low-discrepancy sample of poses in a box: `PoseBox(…).sample(n)`.

        Parameters
        ----------
        position : three numbers or pairs (low, high) [unit of the design]
        angles : three numbers or pairs (low, high) [rad, or degrees]
        n : int
            Number of poses, ≥ 1.
        rng : numpy.random.Generator or int
            Generator or seed.
        degrees : bool
            Whether the angles are in degrees.
        order : str
            The angle set: see `rotation_from_angles`.
        method : "halton" or "sobol"
            See `PoseBox.sample`.

        Returns
        -------
        Pose of batch shape (n,)

        Raises
        ------
        InvalidInput
            See `PoseBox` and `PoseBox.sample`.
        """
        low, high = check_bounds(position, angles, degrees=degrees)
        return cls._of_coordinates(sample_points(low, high, n, rng, method), order)

    @classmethod
    def _of_coordinates(cls, values: Array, order: str) -> Pose:
        """Return poses from positions and angles [rad] in one array (..., 6)."""
        return cls.from_angles(values[..., :3], values[..., 3:], order)

    def compose(self, other: Pose) -> Pose:
        """Return the pose of `other` given in the axes of this one: T = T_self T_other.

        Parameters
        ----------
        other : Pose of batch shape (...)
            The batch shapes broadcast.

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            If `other` is not a Pose, or the shapes do not broadcast.

        *Source: Murray1994, chapter 2: products of rigid motions*
        """
        check_type("pose", other, Pose)
        return unchecked(Pose, *compose(self, other))

    def inverse(self) -> Pose:
        """Return the pose of the base in the platform, shape (...).

        *Source: Murray1994, chapter 2: the inverse of a rigid motion*
        """
        position, rotation = inverse(self)
        return unchecked(Pose, position, rotation.copy())

    def log(self) -> Array:
        """Return the twists that reach the poses from the base in unit time: inverse of `exp`.

        Returns
        -------
        (..., 6) array [unit of the design, rad]
            (v, ω) in platform axes, with |ω| in [0, π]. At |ω| = π either sign of ω is right.

        *Source: Murray1994, chapter 2: the inverse of the exponential of a twist (v, ω)*
        """
        return np.asarray(log6(self))

    def interpolate(self, other: Pose, share: ArrayLike) -> Pose:
        """Return poses on the screw motion from these poses to others.

        Parameters
        ----------
        other : Pose of batch shape (...)
        share : (...) array_like [1]
            0 at these poses, 1 at the others. Batch shapes broadcast.

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            If `other` is not a Pose, or the shapes do not broadcast.

        *Source: Murray1994, chapter 2: a screw motion is the exponential of a multiple of one
        twist*

        Examples
        --------
        >>> half = Pose([0.0, 0.0, 0.0]).interpolate(Pose.exp([0, 0, 2, 0, 0, 1.0]), 0.5)
        >>> half.log().round(12)
        array([0. , 0. , 1. , 0. , 0. , 0.5])
        """
        check_type("pose", other, Pose)
        return Pose(*interpolate(self, other, share))

    def moved(self, twist: ArrayLike) -> Pose:
        """Return the poses after steps (v, ω) in base axes: p + v and exp(ω×) R.

        This is not a screw motion: the platform origin moves by v for every ω. (See `exp`.)

        Parameters
        ----------
        twist : (..., 6) array_like [unit of the design, rad]
            Its leading axes broadcast with those of the pose.

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            On a wrong shape, shapes that do not broadcast, or numbers that are not finite.

        *Source: docs/conventions.md, "Frames and reference points"*

        Examples
        --------
        >>> Pose([0, 0, 1]).moved([1, 0, 0, 0, 0, np.pi / 2]).rotation.round(3)[0]
        array([ 0., -1.,  0.])
        """
        step = check_array("twist", twist, (6,))
        common_shape("pose, twist", self.shape, step.shape[:-1])
        return Pose(self.position + step[..., :3], exp3(step[..., 3:]) @ self.rotation)

    def angles(self, order: str = "rpy", *, degrees: bool = False) -> Array:
        """Return the three angles of a named order.

        Parameters
        ----------
        order : str
            See `rotation_from_angles`.
        degrees : bool
            Whether they are returned in degrees.

        Returns
        -------
        (..., 3) array [rad, or degrees]
            NaN where the rotation is NaN. Where the second turn aligns the axes of the others, the
            third angle of scipy's sequence is 0.

        Raises
        ------
        InvalidInput
            On an unknown order.

        *Source: docs/conventions.md, "Angle sets"*
        """
        return angles_from_rotation(self.rotation, order, degrees=degrees)

    def __repr__(self) -> str:
        if self.shape:
            return f"Pose(shape={self.shape})"
        return f"Pose(position={self.position.tolist()}, rotation={self.rotation.tolist()})"
