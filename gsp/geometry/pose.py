"""Poses of the platform, and boxes of poses."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_integer, check_rng, check_type
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.rotations import angle_set, check_rotation, rotation_from_angles
from gsp.geometry.vectors import Array, Mask, frozen

if TYPE_CHECKING:
    import pinocchio
    from scipy.spatial.transform import Rotation


@dataclass(frozen=True, eq=False, init=False)
class Pose:
    """Position and orientation of the platform in the base, for one pose or a batch.

    Parameters
    ----------
    position : (..., 3) array_like [unit of the design]
        The platform origin p in base axes.
    rotation : (..., 3, 3) array_like, default identity
        R, from platform axes to base axes.

    Raises
    ------
    InvalidInput, InvalidRotation
        On shapes that do not fit, numbers that are not finite, or a matrix that is no rotation.

    Examples
    --------
    >>> Pose.from_rpy([0.0, 0.0, 1.0], [0.0, 0.0, 90.0], degrees=True).rotation.round(3)[0]
    array([ 0., -1.,  0.])
    """

    position: Array
    rotation: Array

    def __init__(self, position: ArrayLike, rotation: ArrayLike | None = None) -> None:
        p = check_array("pose.position", position, (3,))
        r = check_rotation("pose.rotation", np.eye(3) if rotation is None else rotation)
        shape = _common_shape(p.shape[:-1], r.shape[:-2])
        self._set(
            frozen(np.broadcast_to(p, (*shape, 3))), frozen(np.broadcast_to(r, (*shape, 3, 3)))
        )

    def _set(self, position: Array, rotation: Array) -> None:
        object.__setattr__(self, "position", position)
        object.__setattr__(self, "rotation", rotation)

    @classmethod
    def _trusted(cls, position: Array, rotation: Array) -> Pose:
        """Make a pose of new arrays or views that are known to be right."""
        pose = object.__new__(cls)
        position.flags.writeable = rotation.flags.writeable = False
        pose._set(position, rotation)
        return pose

    @classmethod
    def from_angles(
        cls, position: ArrayLike, angles: ArrayLike, order: str = "rpy", *, degrees: bool = False
    ) -> Pose:
        """Make poses from three angles in a named order: see `rotation_from_angles`."""
        return cls(position, rotation_from_angles(angles, order, degrees=degrees))

    @classmethod
    def from_rpy(
        cls, position: ArrayLike, angles: ArrayLike, degrees: bool = False, order: str = "rpy"
    ) -> Pose:
        """Make poses from roll, pitch, yaw (α, β, γ): R = Rz(γ) Ry(β) Rx(α).

        Parameters
        ----------
        position, angles : (..., 3) array_like
            The platform origin, and (α, β, γ) in radians (or degrees).
        order : str
            Another angle set by name: see `rotation_from_angles`.

        *Source: TozKucuk2016 §3.1 names the set; its printed joint variables fix the order.*
        """
        return cls.from_angles(position, angles, order, degrees=degrees)

    @classmethod
    def from_quaternion(cls, position: ArrayLike, xyzw: ArrayLike) -> Pose:
        """Make poses from quaternions (x, y, z, w), shape (..., 4), which are normalised."""
        from scipy.spatial.transform import Rotation

        q = check_array("quaternion", xyzw, (4,))
        size = np.abs(q).max(axis=-1, keepdims=True)
        if (size == 0.0).any():
            raise InvalidInput(expected("quaternion", "a non-zero quaternion", "zero"))
        turn = Rotation.from_quat((q / size).reshape(-1, 4))
        return cls(position, turn.as_matrix().reshape(*q.shape[:-1], 3, 3))

    @property
    def quaternion(self) -> Array:
        """The rotations as unit quaternions (x, y, z, w) with w ≥ 0, shape (..., 4).

        NaN where the rotation is NaN.
        """
        turn, known = _turns(self.rotation)
        xyzw = np.where(known[:, None], turn.as_quat(canonical=True), np.nan)
        return np.asarray(xyzw, dtype=np.float64).reshape(*self.shape, 4)

    @classmethod
    def from_se3(cls, placement: pinocchio.SE3 | Iterable[Any]) -> Pose:
        """Make poses from one `pinocchio.SE3` (shape ()) or from a sequence of n (shape (n,))."""
        try:
            if hasattr(placement, "rotation") and hasattr(placement, "translation"):
                return cls(placement.translation, placement.rotation)
            parts = [(p.translation, p.rotation) for p in placement]
        except (AttributeError, TypeError) as error:
            got = type(placement).__name__
            raise InvalidInput(expected("placement", "SE3 or a sequence of SE3", got)) from error
        if not parts:
            return cls(np.zeros((0, 3)), np.zeros((0, 3, 3)))
        return cls(np.array([p for p, _ in parts]), np.array([r for _, r in parts]))

    def to_se3(self) -> Any:
        """Return a `pinocchio.SE3`, or for a batch a list of them (nested as the batch is)."""
        import pinocchio

        if self.shape:
            return [self[i].to_se3() for i in range(self.shape[0])]
        return pinocchio.SE3(self.rotation.copy(), self.position.copy())

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
        """Product grid over a box: see `PoseBox` and `PoseBox.grid`."""
        return PoseBox(position, angles, degrees=degrees, order=order).grid(counts)

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
        """Low-discrepancy sample of n poses in a box: see `PoseBox` and `PoseBox.sample`."""
        return PoseBox(position, angles, degrees=degrees, order=order).sample(
            n, rng=rng, method=method
        )

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch shape; () for a single pose."""
        return self.position.shape[:-1]

    @property
    def size(self) -> int:
        """Number of poses."""
        return int(np.prod(self.shape, dtype=np.int64))

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single pose has no length")
        return self.shape[0]

    def __getitem__(self, index: Any) -> Pose:
        """Return some of the poses, by numpy indexing of the batch axes."""
        axes = index if isinstance(index, tuple) else (index,)
        return Pose._trusted(
            self.position[(*axes, *_rest(axes), slice(None))],
            self.rotation[(*axes, *_rest(axes), slice(None), slice(None))],
        )

    def reshape(self, *shape: int) -> Pose:
        """Return the same poses in another batch shape (-1 stands for what is left)."""
        try:
            new = (
                np.empty(self.shape, dtype=bool)
                .reshape(shape if len(shape) != 1 else shape[0])
                .shape
            )
        except (TypeError, ValueError) as error:
            wanted = f"the axes of a batch of {self.size} poses"
            raise InvalidInput(expected("shape", wanted, brief(shape))) from error
        return Pose._trusted(self.position.reshape(*new, 3), self.rotation.reshape(*new, 3, 3))

    def compose(self, other: Pose) -> Pose:
        """Return the pose of `other` given in the axes of this one: T = T_self T_other.

        The batch shapes broadcast.
        """
        check_type("pose", other, Pose)
        _common_shape(self.shape, other.shape)
        turned = (self.rotation @ other.position[..., None])[..., 0]
        return Pose._trusted(self.position + turned, self.rotation @ other.rotation)

    def inverse(self) -> Pose:
        """Return the pose of the base in the platform."""
        back = np.swapaxes(self.rotation, -1, -2)
        return Pose._trusted(-(back @ self.position[..., None])[..., 0], back.copy())

    def moved(self, twist: ArrayLike) -> Pose:
        """Return the pose after a step (v, ω) in base axes: p + v and exp(ω×) R.

        Parameters
        ----------
        twist : (..., 6) array_like [unit of the design, rad]
            Its leading axes broadcast with those of the pose.

        Examples
        --------
        >>> Pose([0, 0, 1]).moved([1, 0, 0, 0, 0, np.pi / 2]).rotation.round(3)[0]
        array([ 0., -1.,  0.])
        """
        from scipy.spatial.transform import Rotation

        step = check_array("twist", twist, (6,))
        turn = Rotation.from_rotvec(step[..., 3:].reshape(-1, 3)).as_matrix()
        turn = turn.reshape(*step.shape[:-1], 3, 3)
        return Pose(self.position + step[..., :3], turn @ self.rotation)

    def angles(self, order: str = "rpy", *, degrees: bool = False) -> Array:
        """Return the three angles of a named order, shape (..., 3); NaN where the rotation is NaN.

        Where the second turn aligns the axes of the others, the third of scipy's sequence is 0.
        """
        sequence, places = angle_set(order)
        turn, known = _turns(self.rotation)
        turned = turn.as_euler(sequence, degrees=degrees, suppress_warnings=True)  # type: ignore[call-overload]
        named = np.where(known[:, None], turned[:, np.argsort(places)], np.nan)
        return np.asarray(named, dtype=np.float64).reshape(*self.shape, 3)

    def __repr__(self) -> str:
        if self.shape:
            return f"Pose(shape={self.shape})"
        return f"Pose(position={self.position.tolist()}, rotation={self.rotation.tolist()})"


def _turns(rotation: Array) -> tuple[Rotation, Mask]:
    """Return rotations (..., 3, 3) as scipy's, (n,), and which of them are finite.

    Scipy refuses a batch with a NaN in it, as the poses of a failed search have; the identity
    stands in for such an element.
    """
    from scipy.spatial.transform import Rotation

    flat = rotation.reshape(-1, 3, 3)
    known = np.asarray(np.isfinite(flat).all(axis=(-2, -1)))
    return Rotation.from_matrix(np.where(known[:, None, None], flat, np.eye(3))), known


def _common_shape(one: tuple[int, ...], other: tuple[int, ...]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(one, other)
    except ValueError as error:
        wanted = "batch shapes of positions and rotations that broadcast"
        raise InvalidInput(expected("pose", wanted, f"{one} and {other}")) from error


def _rest(axes: tuple[Any, ...]) -> tuple[Any, ...]:
    return () if any(axis is Ellipsis for axis in axes) else (Ellipsis,)


@dataclass(frozen=True, eq=False, init=False)
class PoseBox:
    """A box of positions and angles, from which poses are taken.

    Parameters
    ----------
    position, angles : three intervals each
        (low, high) per coordinate; a single number stands for an interval of no width.
    order : str
        The angle set: see `rotation_from_angles`.

    Attributes
    ----------
    low, high : (6,) arrays [length, length, length, rad, rad, rad]
    order : str
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
        places = _intervals("box.position", position)
        turns = _intervals("box.angles", angles)
        bounds = np.concatenate((places, np.deg2rad(turns) if degrees else turns))
        rotation_from_angles(np.zeros(3), order)  # refuses an unknown order here, not later
        object.__setattr__(self, "low", frozen(bounds[:, 0]))
        object.__setattr__(self, "high", frozen(bounds[:, 1]))
        object.__setattr__(self, "order", order)

    @classmethod
    def around(cls, pose: Pose, half_widths: ArrayLike, *, order: str = "rpy") -> PoseBox:
        """Smallest box that holds the given poses, widened by (6,) half-widths [rad]."""
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

    def pose(self, values: Array) -> Pose:
        """Poses from coordinates (position, angles in rad), shape (..., 6)."""
        return Pose.from_angles(values[..., :3], values[..., 3:], self.order)

    def grid(self, counts: int | Sequence[int]) -> Pose:
        """Product grid with its end points, shape `counts` (six numbers ≥ 1; one serves for all).

        A coordinate with one point takes the middle of its interval.
        """
        try:
            number = np.broadcast_to(np.asarray(counts), (6,))
        except ValueError:
            number = np.zeros(6)
        if number.dtype.kind not in "iu" or (number < 1).any():
            raise InvalidInput(expected("counts", "one or six integers ≥ 1", brief(counts)))
        axes = [
            np.linspace(low, high, n) if n > 1 else np.array([(low + high) / 2.0])
            for low, high, n in zip(self.low, self.high, number, strict=True)
        ]
        return self.pose(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1))

    def sample(self, n: int, *, rng: np.random.Generator | int, method: str = "halton") -> Pose:
        """Low-discrepancy sample, shape (n,), from a seed or a `numpy.random.Generator`.

        Parameters
        ----------
        n : int
            Number of poses, ≥ 1.
        method : "halton" or "sobol"
            Scrambled sequences of `scipy.stats.qmc`; sobol is balanced where n is a power of two.
        """
        check_integer("n", n)
        from scipy.stats import qmc  # a second of import time, for those who sample

        generator = check_rng("rng", rng)
        if isinstance(method, str) and method == "halton":
            points = qmc.Halton(d=6, rng=generator).random(n)
        elif isinstance(method, str) and method == "sobol":
            exponent = int(np.ceil(np.log2(n)))
            points = qmc.Sobol(d=6, rng=generator).random_base2(exponent)[:n]
        else:
            raise InvalidInput(expected("method", '"halton" or "sobol"', brief(method)))
        return self.pose(self.low + points * (self.high - self.low))


def _intervals(what: str, value: Sequence[Any]) -> Array:
    wanted = "three numbers or pairs (low ≤ high)"
    try:
        pairs = [np.broadcast_to(check_array(what, v, ()), (2,)) for v in value]
        array = np.array(pairs).reshape(3, 2)
    except (TypeError, ValueError) as error:
        raise InvalidInput(expected(what, wanted, brief(value))) from error
    if (array[:, 0] > array[:, 1]).any():
        raise InvalidInput(expected(what, wanted, brief(value)))
    return array
