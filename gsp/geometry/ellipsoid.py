"""The operation ellipsoid: the part of the end-effector that one intends to move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import SMALLEST, check_array
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.frames import jacobian_at
from gsp.geometry.rotations import check_rotation
from gsp.geometry.vectors import Array, frozen


@dataclass(frozen=True, eq=False, init=False)
class Ellipsoid:
    """An ellipsoid in platform axes, standing for the object that is moved.

    Parameters
    ----------
    semi_axes : (3,) array_like, or a number for a sphere [length]
        Positive half-lengths of the axes.
    center : (3,) array_like [length], default 0
    rotation : (3, 3) array_like, default identity
        Columns are the directions of the axes.

    Raises
    ------
    InvalidInput, InvalidRotation

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
            raise InvalidInput(expected("ellipsoid", "one center and one rotation", "a batch"))
        object.__setattr__(self, "semi_axes", frozen(np.broadcast_to(axes, (3,))))
        object.__setattr__(self, "center", frozen(middle))
        object.__setattr__(self, "rotation", frozen(turn))

    @property
    def vertices(self) -> Array:
        """The six vertices S_1 … S_6 in platform axes, shape (6, 3) [length]."""
        arms = self.rotation.T * self.semi_axes[:, None]
        return self.center + np.concatenate((arms, -arms))

    def whiten(self, jacobian: Array, rotation: Array) -> Array:
        """Return J X, where D⁻¹ = X Xᵀ for the matrix D of the six vertices: shape (..., n, 6).

        About the centre D is block diagonal: 6 I for translations and
        2 diag(b² + c², a² + c², a² + b²) for rotations, so X is written down and D never inverted.

        Parameters
        ----------
        jacobian : (..., n, 6) array
            Rows for twists (v, ω) at the platform origin.
        rotation : (..., 3, 3) array
            R of the poses.

        *Source: Nawratil, eqs. (12), (17)*
        """
        a, b, c = self.semi_axes
        root = np.sqrt(2.0) * np.hypot([b, a, a], [c, c, b])
        about_center = jacobian_at(jacobian, rotation @ self.center)
        turned = about_center[..., 3:] @ (rotation @ self.rotation) / root
        return np.concatenate((about_center[..., :3] / np.sqrt(6.0), turned), axis=-1)
