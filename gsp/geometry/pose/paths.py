"""Paths of poses in pieces of polynomials."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_type, is_a
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.frames import exp3, log3
from gsp.geometry.pose.poses import Pose
from gsp.geometry.vectors import Array, frozen

# Gaps between two pieces that count as rounding: relative to the positions, and in rad.
PIECE_GAP = 1e-9
# Steps of time beyond which coefficients of polynomials overflow or vanish.
LEAST_TIME_STEP, GREATEST_TIME_STEP = 1e-50, 1e50


@dataclass(frozen=True, eq=False, init=False)
class PosePath(ReadOnly):
    """A curve of poses in m pieces: polynomials of position and of a rotation vector.

    At the time t of piece i, with x = t − tᵢ,

        p = Σ_j position[i, j] xʲ,    R = rotation[i] exp([Σ_j turn[i, j] xʲ]×).

    Parameters
    ----------
    times : array_like, shape (m + 1,) [time, or 1]
        Ends of the pieces, increasing by 1e-50 to 1e50.
    position : (m, k, 3) array_like [unit of the design / timeʲ]
        Coefficients, lowest power first.
    turn : (m, k, 3) array_like [rad/timeʲ]
        Coefficients of rotation vectors in platform axes; k may differ from that of `position`.
    rotation : (m, 3, 3) array_like or None [1]
        Rotations that come before; default none.

    Raises
    ------
    InvalidInput
        On wrong shapes, times that do not increase, or pieces that do not meet: gaps up to 1e-9 of
        the largest term of a position, or 1e-9 rad, count as rounding.
    InvalidRotation
        On matrices that are not rotations.

    Examples
    --------
    >>> import gsp
    >>> lift = gsp.PosePath([0, 2], [[[0, 0, 130], [0, 0, 10]]], [[[0, 0, 0]]])
    >>> lift.pose(1.5).position
    array([  0.,   0., 145.])
    """

    times: Array
    position: Array
    turn: Array
    rotation: Array

    def __init__(
        self,
        times: ArrayLike,
        position: ArrayLike,
        turn: ArrayLike,
        rotation: ArrayLike | None = None,
    ) -> None:
        given = check_times(times)
        m = len(given) - 1
        before = np.tile(np.eye(3), (m, 1, 1)) if rotation is None else rotation
        values = {
            "position": check_array("position", position, (m, None, 3)),
            "turn": check_array("turn", turn, (m, None, 3)),
            "rotation": Pose(np.zeros((m, 3)), before).rotation,
        }
        for name, value in values.items():
            if value.ndim != 3 or value.shape[0] != m or not value.size:
                wanted = f"shape ({m}, {'3' if name == 'rotation' else 'k'}, 3)"
                raise InvalidInput(expected(name, wanted, f"shape {value.shape}"))
            object.__setattr__(self, name, frozen(value))
        object.__setattr__(self, "times", frozen(given))
        self._check_meets()

    def _check_meets(self) -> None:
        """Raise InvalidInput unless each piece ends where the next one starts."""
        span = np.diff(self.times)[:-1]
        start, end = (
            self._at(np.arange(1, len(self)), 0.0),
            self._at(np.arange(len(self) - 1), span),
        )
        # Terms at the ends of pieces: a velocity is not a length.
        powers = np.diff(self.times)[:, None] ** np.arange(self.position.shape[1])
        size = np.abs(self.position * powers[..., None]).max()
        away = np.linalg.norm(start.position - end.position, axis=-1) > PIECE_GAP * size
        turned = log3(end.rotation.swapaxes(-1, -2) @ start.rotation)
        away |= np.linalg.norm(turned, axis=-1) > PIECE_GAP
        if away.any():
            i = int(away.argmax())
            where = f"at times[{i + 1}] = {self.times[i + 1]:g}"
            raise InvalidInput(expected("position, turn", "pieces that meet", "a gap", where))

    @classmethod
    def through(cls, poses: Pose, times: ArrayLike | None = None) -> PosePath:
        """Return the cubic splines through poses.

        Positions are on `scipy.interpolate.CubicSpline`, rotations on
        `scipy.spatial.transform.RotationSpline`: velocities and accelerations are continuous.

        Parameters
        ----------
        poses : Pose of shape (n,), n ≥ 2
        times : (n,) array_like or None [time]
            When each pose is reached, increasing; default 0, 1, …, n − 1.

        Returns
        -------
        PosePath

        Raises
        ------
        InvalidInput
            On a wrong shape, or times that do not increase.

        Examples
        --------
        >>> import gsp
        >>> nodes = gsp.Pose([[0, 0, 1], [1, 0, 1], [1, 1, 1]])
        >>> gsp.PosePath.through(nodes).pose(2.0).position.round(12)
        array([1., 1., 1.])
        """
        from scipy.interpolate import CubicSpline
        from scipy.spatial.transform import Rotation, RotationSpline

        nodes = check_nodes(poses)
        given = np.arange(float(len(nodes))) if times is None else check_times(times)
        if len(given) != len(nodes):
            raise InvalidInput(expected("times", f"{len(nodes)} numbers", len(given)))
        # In units of the mean step: the equations of the splines are well scaled then.
        step = float(np.diff(given).mean())
        scaled = (given - given[0]) / step
        turns = RotationSpline(scaled, Rotation.from_matrix(nodes.rotation))
        return cls._of_splines(CubicSpline(scaled, nodes.position), turns, given, step)

    @classmethod
    def of_splines(cls, position: Any, rotation: Any) -> PosePath:
        """Return the path of two splines of scipy.

        Parameters
        ----------
        position : scipy.interpolate.PPoly, such as CubicSpline, with values of shape (3,)
        rotation : scipy.spatial.transform.RotationSpline
            With the same times.

        Returns
        -------
        PosePath

        Raises
        ------
        InvalidInput
            On other objects, or splines whose times differ.
        """
        from scipy.interpolate import PPoly
        from scipy.spatial.transform import RotationSpline

        if not is_a(position, PPoly) or position.c.ndim != 3 or position.c.shape[2] != 3:
            wanted = "a scipy.interpolate.PPoly with values of shape (3,)"
            raise InvalidInput(expected("position", wanted, brief(position)))
        check_type("rotation", rotation, RotationSpline, "a RotationSpline of scipy")
        if not np.array_equal(position.x, rotation.times):
            raise InvalidInput(expected("rotation", "the times of the position", "others"))
        return cls._of_splines(position, rotation, rotation.times, 1.0)

    @classmethod
    def _of_splines(cls, position: Any, rotation: Any, times: Array, step: float) -> PosePath:
        """Return the path of splines whose time is counted in steps."""
        places, turns = (
            x.c[::-1].transpose(1, 0, 2) / step ** np.arange(len(x.c))[:, None]
            for x in (position, rotation.interpolator)
        )
        before = rotation.rotations.as_matrix()[: len(turns)]
        return cls(times, places, turns, before)

    def __len__(self) -> int:
        """Return the number of pieces."""
        return len(self.times) - 1

    def pose(self, time: ArrayLike) -> Pose:
        """Return poses at times; outside of the path those of the first or last polynomials.

        Parameters
        ----------
        time : (...) array_like [time]

        Returns
        -------
        Pose of batch shape (...)

        Raises
        ------
        InvalidInput
            If it is not a finite number.
        """
        t = check_array("time", time, ())
        if np.abs(t).max(initial=0.0) > GREATEST_TIME_STEP:
            raise InvalidInput(
                expected("time", f"at most {GREATEST_TIME_STEP:g} in size", brief(time))
            )
        piece = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self) - 1)
        return self._at(piece, t - self.times[piece])

    def _at(self, piece: Any, x: Any) -> Pose:
        """Return poses of pieces at times after their start."""
        x = np.broadcast_to(x, np.shape(piece))[..., None]
        place, vector = (_horner(c[piece], x) for c in (self.position, self.turn))
        return Pose(place, self.rotation[piece] @ exp3(vector))


def _horner(coefficients: Array, x: Array) -> Array:
    """Values of polynomials with coefficients (..., k, 3), lowest power first."""
    total = coefficients[..., -1, :]
    for j in range(coefficients.shape[-2] - 2, -1, -1):
        total = total * x + coefficients[..., j, :]
    return np.asarray(total)


def check_times(times: Any) -> Array:
    """Return times as an array if there are at least two and they increase, else raise."""
    given = check_array("times", times, (None,))
    steps = np.diff(given) if given.ndim == 1 else np.empty(0)
    if not steps.size or not (steps > 0.0).all():
        wanted = "at least two numbers that increase"
        raise InvalidInput(expected("times", wanted, brief(times)))
    if steps.min() < LEAST_TIME_STEP or steps.max() > GREATEST_TIME_STEP:
        wanted = f"steps between {LEAST_TIME_STEP:g} and {GREATEST_TIME_STEP:g}"
        raise InvalidInput(expected("times", wanted, brief(times)))
    return given


def check_nodes(poses: Any) -> Pose:
    """Return poses if they are at least two, shape (n,), else raise InvalidInput."""
    check_type("poses", poses, Pose)
    nodes: Pose = poses
    if len(nodes.shape) != 1 or len(nodes) < 2:
        raise InvalidInput(expected("poses", "shape (n,) with n ≥ 2", f"shape {nodes.shape}"))
    return nodes
