"""The operation ellipsoid: the part of the end-effector that one intends to move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import SMALLEST, check_array
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.rotations import check_rotation
from gsp.geometry.scalars import Vector, components, cross, dot, minus, times, turned
from gsp.geometry.vectors import Array, frozen


@dataclass(frozen=True, eq=False, init=False)
class Ellipsoid(ReadOnly):
    """An ellipsoid in platform axes, standing for the object that is moved.

    Parameters
    ----------
    semi_axes : (3,) array_like, or a number for a sphere [length]
        Positive half-lengths of the axes.
    center : (3,) array_like [length]
        In platform axes; default the platform origin.
    rotation : (3, 3) array_like or None [1]
        Columns are the directions of the axes; default those of the platform.

    Raises
    ------
    InvalidInput
        On axes that are not positive, or wrong shapes.
    InvalidRotation
        If the columns of `rotation` are not right-handed orthonormal axes.

    *Source: Nawratil, Definition 1*
    """

    semi_axes: Array
    center: Array
    rotation: Array

    def __init__(
        self,
        semi_axes: ArrayLike,
        center: ArrayLike = (0.0, 0.0, 0.0),
        rotation: ArrayLike | None = None,
    ) -> None:
        axes = check_array("ellipsoid.semi_axes", semi_axes, ())
        if axes.shape not in ((), (3,)) or (axes < SMALLEST).any():
            raise InvalidInput(
                expected("ellipsoid.semi_axes", "three positive numbers or one", brief(semi_axes))
            )
        middle = check_array("ellipsoid.center", center, (3,))
        turn = check_rotation("ellipsoid.rotation", np.eye(3) if rotation is None else rotation)
        if middle.ndim != 1 or turn.ndim != 2:
            raise InvalidInput(expected("ellipsoid", "one centre and one rotation", "a batch"))
        object.__setattr__(self, "semi_axes", frozen(np.broadcast_to(axes, (3,))))
        object.__setattr__(self, "center", frozen(middle))
        object.__setattr__(self, "rotation", frozen(turn))

    @property
    def vertices(self) -> Array:
        """The six vertices S_1 … S_6 in platform axes, shape (6, 3) [length].

        *Source: Nawratil, Definition 1*
        """
        arms = self.rotation.T * self.semi_axes[:, None]
        return self.center + np.concatenate((arms, -arms))

    @arguments.validated(factor=arguments.positive)
    def scaled(self, factor: float) -> Ellipsoid:
        """Return the ellipsoid with its lengths multiplied by a factor.

        Parameters
        ----------
        factor : float [1]
            > 0

        Raises
        ------
        InvalidInput
            On another factor.
        """
        return Ellipsoid(self.semi_axes * factor, self.center * factor, self.rotation)

    @property
    def scalars(self) -> Array:
        """Scalars for `ellipsoid_frame`: the centre, then the columns of X by rows.

        Shape (12,) [length, 1/length].

        About the centre the matrix D of the six vertices is block diagonal: 6 I for translations
        and 2 diag(b² + c², a² + c², a² + b²) for rotations, so that D⁻¹ = X Xᵀ is written down and
        D never inverted. The columns are the directions of the axes over the roots of the latter.

        *Source: Nawratil, eq. (12)*
        """
        a, b, c = self.semi_axes
        inertia = np.sqrt(2.0) * np.hypot([b, a, a], [c, c, b])
        return np.concatenate((self.center, (self.rotation / inertia).ravel()))

    @arguments.validated(
        jacobian=arguments.array(None, 6, finite=False), rotation=arguments.array(3, 3)
    )
    def whiten(self, jacobian: Array, rotation: Array) -> Array:
        """Return J X, where D⁻¹ = X Xᵀ for the matrix D of the six vertices: shape (..., n, 6).

        Parameters
        ----------
        jacobian : (..., n, 6) array [1, length]
            Rows for twists (v, ω) at the platform origin; NaN where a posture is undefined.
        rotation : (..., 3, 3) array [1]
            R of the poses, one for each Jacobian or one for all.

        Returns
        -------
        (..., n, 6) array [1]
            Rows for speeds of the ellipsoid.

        Raises
        ------
        InvalidInput
            On wrong shapes, or batches that do not fit.

        *Source: Nawratil, eqs. (12), (17)*
        """
        shape, n = jacobian.shape, jacobian.shape[-2]
        batch = (*shape[:-2], 3, 3)
        try:
            turns = components(np.broadcast_to(rotation, batch).reshape(-1, 9))
        except ValueError as error:
            wanted = f"shape {batch}, as the Jacobians, or (3, 3)"
            raise InvalidInput(expected("rotation", wanted, f"shape {rotation.shape}")) from error
        rows = components(jacobian.reshape(len(turns[0]), n, 6))
        numbers = self.scalars.tolist()
        frame = ellipsoid_frame(turns, numbers[:3], numbers[3:])
        result = np.empty((len(turns[0]), n, 6))
        for column, values in enumerate(ellipsoid_row(rows, frame)):
            result[:, :, column] = values.T
        return result.reshape(shape)


def ellipsoid_frame(rotation: Sequence[Any], centre: Sequence[Any], axes: Sequence[Any]) -> Vector:
    """Return what `ellipsoid_row` needs of a pose: R c and R X, twelve scalars.

    Parameters
    ----------
    rotation : nine scalars
        R by rows.
    centre, axes : three and nine scalars [length, 1/length]
        See `Ellipsoid.scalars`.

    *Source: Nawratil, eqs. (12), (17)*
    """
    columns = [turned(rotation, axes[j::3]) for j in range(3)]
    return [*turned(rotation, centre), *(columns[j][i] for i in range(3) for j in range(3))]


def ellipsoid_row(row: Vector, frame: Vector, weight: Any = 6.0**-0.5) -> Vector:
    """Return a row of J X, six scalars.

    Parameters
    ----------
    row : six scalars [1, length]
        Row of J for twists at the platform origin.
    frame : twelve scalars
        Of `ellipsoid_frame`.
    weight : scalar
        1/√6, to be given for numbers of more digits than a float has.

    *Source: Nawratil, eqs. (12), (17)*
    """
    about_center = minus(row[3:], cross(frame[:3], row[:3]))
    columns = [frame[3 + j :: 3] for j in range(3)]
    return [*times(weight, row[:3]), *(dot(about_center, column) for column in columns)]
