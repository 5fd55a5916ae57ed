"""Tolerances of a manufactured copy of a design."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_array
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.vectors import Array, frozen
from gsp.model.design import Design, check_undriven


@dataclass(frozen=True, eq=False)
class Tolerances(ReadOnly):
    """Tolerances of a manufactured copy of a design; a proof with them holds for every copy.

    Parameters
    ----------
    base_points, platform_points : float or (n_legs,) array_like [unit]
        Greatest distance of an anchor point from its place in the design.
    base_directions, platform_directions : float or (n_legs,) array_like [rad]
        Greatest angle between a line and the line of the design.
    joints : float or (n,) array_like [unit, rad]
        Greatest error of the zero point of an actuated joint, in the order of `joint_names`.

    Raises
    ------
    InvalidInput
        On numbers that are negative or not finite, or arrays of several axes.

    Examples
    --------
    >>> Tolerances(base_points=0.1, joints=0.05).base_points
    0.1
    """

    base_points: ArrayLike = 0.0
    platform_points: ArrayLike = 0.0
    base_directions: ArrayLike = 0.0
    platform_directions: ArrayLike = 0.0
    joints: ArrayLike = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            given = getattr(self, field.name)
            value = check_array(f"tolerances.{field.name}", given, (), axes=1)
            if (value < 0.0).any():
                wanted = "one number ≥ 0, or one for each"
                raise InvalidInput(
                    expected(f"tolerances.{field.name}", wanted, brief(value.tolist()))
                )
            object.__setattr__(self, field.name, frozen(value) if value.ndim else float(value))

    @arguments.validated(design=check_undriven)
    def of_legs(self, design: Design) -> Array:
        """Return the tolerances of the anchors and lines of each leg.

        Parameters
        ----------
        design : Design

        Returns
        -------
        (n_legs, 4) array [length, length, rad, rad]
            Of a, b, s and t.

        Raises
        ------
        InvalidInput
            If there is neither one for all nor one for each.

        *Source: ours; see `docs/proofs.md`*
        """
        names = ("base_points", "platform_points", "base_directions", "platform_directions")
        return np.stack([self._each(name, design.n_legs) for name in names], axis=1)

    @arguments.validated(design=check_undriven)
    def of_joints(self, design: Design) -> Array:
        """Return the tolerances of the zero points of the joints.

        Parameters
        ----------
        design : Design

        Returns
        -------
        (n,) array [unit of the design, rad]

        Raises
        ------
        InvalidInput
            If there is neither one for all nor one for each.

        *Source: ours; see `docs/proofs.md`*
        """
        return self._each("joints", len(design.joint_names))

    def _each(self, name: str, n: int) -> Array:
        what = f"tolerances.{name}"
        value = np.asarray(getattr(self, name), dtype=np.float64)
        if value.shape not in ((), (n,)):
            raise InvalidInput(expected(what, f"one number or {n}", value.tolist()))
        return np.broadcast_to(value, (n,))
