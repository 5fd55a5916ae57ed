"""Bounded quantities: values of a platform at a pose, each between a least and a greatest one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.copies import ReadOnly, kept_property
from gsp.geometry.vectors import Array, Mask
from gsp.limits.kinds import Quantity
from gsp.model.legs import LEG
from gsp.model.posture.assembly import Group, groups, joints_and_rows, parts
from gsp.model.posture.derivatives import derivatives_of_rows

Values = Callable[[Array, Array], Array]
Evaluate = Callable[[Array, Array], tuple[Array, Array]]
Curvature = Callable[[Array, Array, Array], Array]

# Step of the central differences [share of the scale, rad]; the error of a gradient is about its
# square, and rounding adds about 1e-16 over the step.
DIFFERENCE_STEP = 1e-5
# Step of second differences [share of the scale, rad]; rounding adds about 1e-16 over its square.
SECOND_DIFFERENCE_STEP = 1e-4
# Moves of second differences [1]: none, along each of six axes and of 15 pairs, and the opposite.
_PAIRS = np.triu_indices(6, 1)
_AXES = np.concatenate((np.eye(6), np.eye(6)[_PAIRS[0]] + np.eye(6)[_PAIRS[1]]))
_SECOND_MOVES = np.concatenate((np.zeros((1, 6)), _AXES, -_AXES))


@dataclass(frozen=True, eq=False)
class Quantities(ReadOnly):
    """Some quantities of a platform, as functions of positions (..., 3) and rotations (..., 3, 3).

    The functions are partial ones of functions of modules, so that results that hold them can be
    pickled.

    Attributes
    ----------
    values : -> (..., m) array [of the quantity]
    evaluate : -> values (..., m), rows (..., m, 6) [per unit of length, per rad]
        The gradients are those with respect to the twist (v, ω).
    curvature : and weights (..., m) -> (..., 6, 6) array, or None
        Second derivatives of the weighted sum along p + v, exp(ω) R.
    points : pair of (m, 3) arrays, or None [length]
        Points in base and in platform axes, if the quantities are their distances and no more:
        for compiled code.
    differentiated : bool
        Whether rows are differences.
    """

    values: Values
    evaluate: Evaluate
    curvature: Curvature | None = None
    points: tuple[Array, Array] | None = None
    differentiated: bool = False


@dataclass(frozen=True, eq=False)
class BoundedQuantities(ReadOnly):
    """Quantities that bound a workspace.

    Attributes
    ----------
    named : tuple of Quantity
        Their names and kinds; the actuated joints come first.
    low, high : (m,) arrays [of the quantity]
        Bounds; ∓inf where there is none.
    quantities : Quantities
    scale : float [length]
        A length that makes positions and turns comparable.
    sizes : (m,) array [of the quantity]
        What makes the quantities comparable in any unit of length: the scale for lengths, 1 for
        angles, the bound for indices.
    """

    named: tuple[Quantity, ...]
    low: Array
    high: Array
    quantities: Quantities
    scale: float
    sizes: Array

    @kept_property
    def names(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(quantity.name for quantity in self.named)

    @kept_property
    def joints(self) -> int:
        """How many of them are actuated joints."""
        return sum(quantity.kind == "joint" for quantity in self.named)

    @property
    def differentiated(self) -> bool:
        """Whether gradients of some quantities are differences."""
        return self.quantities.differentiated

    def evaluate(self, position: Array, rotation: Array) -> tuple[Array, Array]:
        """Return the values of the quantities at poses, and their gradients.

        Parameters
        ----------
        position : (..., 3) array [length]
        rotation : (..., 3, 3) array [1]

        Returns
        -------
        values : (..., m) array [of the quantity]
        rows : (..., m, 6) array [of the quantity per unit of length, per rad]
            With respect to the twist (v, ω).

        *Source: ours; rows of joints as `Posture.jacobian`*
        """
        return self.quantities.evaluate(position, rotation)

    def comparable(self, position: Array, rotation: Array) -> tuple[Array, Array]:
        """Return how far quantities lie beyond their bounds, and their gradients, per size.

        Parameters
        ----------
        position : (..., 3) array [length]
        rotation : (..., 3, 3) array [1]

        Returns
        -------
        excess : (..., m, 2) array [1]
            As `excess`, in units of `sizes`.
        rows : (..., m, 6) array [1]
            With respect to (v / scale, ω), in units of `sizes`.

        *Source: ours*
        """
        values, rows = self.evaluate(position, rotation)
        rows = rows * (np.repeat([self.scale, 1.0], 3) / self.sizes[:, None])
        return self.excess(values) / self.sizes[:, None], rows

    def curvature(self, position: Array, rotation: Array, weight: Array) -> Array:
        """Return the second derivatives of a weighted sum of quantities per size, along twists.

        By central differences of the values of those quantities that have no formula.

        Parameters
        ----------
        position : (..., 3) array [length]
        rotation : (..., 3, 3) array [1]
        weight : (..., m) array [1]
            Of quantities in units of `sizes`: their sum is the same in every unit of length.

        Returns
        -------
        (..., 6, 6) array [1]
            Symmetric; with respect to (v / scale, ω), along p + v, exp(ω) R.

        *Source: ours*
        """
        units = np.repeat([self.scale, 1.0], 3)
        given = position, rotation, weight / self.sizes
        return np.asarray(_curvature(self.quantities, self.scale, *given) * units * units[:, None])

    def excess(self, values: Array) -> Array:
        """Return how far values lie below `low` and above `high`.

        Parameters
        ----------
        values : (..., m) array [of the quantity]

        Returns
        -------
        (..., m, 2) array [of the quantity]
            ≤ 0 where allowed.

        *Source: ours*
        """
        excess = np.empty((*values.shape, 2))
        np.subtract(self.low, values, out=excess[..., 0])
        np.subtract(values, self.high, out=excess[..., 1])
        return excess

    def allowed(self, position: Array, rotation: Array, slack: float = 0.0) -> Mask:
        """Return whether all quantities are within bounds widened by `slack` sizes.

        Parameters
        ----------
        position : (..., 3) array [length]
        rotation : (..., 3, 3) array [1]
        slack : float [1]
            In units of `sizes`.

        Returns
        -------
        (...) bool array
            False where a quantity is NaN.

        *Source: ours*
        """
        values = self.quantities.values(position, rotation)
        with np.errstate(invalid="ignore"):
            inside = self.excess(values) <= slack * self.sizes[:, None]
        return np.asarray(inside.all(axis=(-2, -1)))


def leg_joints(legs: Sequence[Group], n_joints: int) -> Quantities:
    """Return the joint values of legs and their rows, by the formulas of the legs.

    A posture has the same values. It is not made, since poses of searches are rotations already.

    Parameters
    ----------
    legs : sequence of Group
    n_joints : int
        Number of actuated joints.
    """
    of = tuple(legs), n_joints
    values, evaluate = partial(_joint_values, *of), partial(_joint_rows, *of)
    return Quantities(values, evaluate, partial(_joint_curvature, *of))


def _joint_values(legs: Sequence[Group], n_joints: int, position: Array, rotation: Array) -> Array:
    return _assembled(legs, n_joints, position, rotation, 0)[0]


def _joint_rows(
    legs: Sequence[Group], n_joints: int, position: Array, rotation: Array
) -> tuple[Array, Array]:
    return _assembled(legs, n_joints, position, rotation, 6)


def _assembled(
    legs: Sequence[Group], n_joints: int, position: Array, rotation: Array, columns: int
) -> tuple[Array, Array]:
    shape = position.shape[:-1]
    evaluated = parts(legs, position, rotation)
    values, rows = joints_and_rows(evaluated, math.prod(shape), n_joints, columns)
    return values.reshape(*shape, n_joints), rows.reshape(*shape, n_joints, columns)


def _joint_curvature(
    legs: Sequence[Group], n_joints: int, position: Array, rotation: Array, weight: Array
) -> Array:
    _, slopes = derivatives_of_rows(legs, n_joints, position, rotation)
    bend = np.einsum("...m,...mij->...ij", weight, slopes)
    return np.asarray(0.5 * (bend + np.swapaxes(bend, -1, -2)))


def point_distances(base_points: Array, platform_points: Array) -> Quantities:
    """Return the distances from base points to platform points: the joints of SPS legs.

    Compiled code may use the points.

    Parameters
    ----------
    base_points, platform_points : (m, 3) arrays [length]
    """
    lines, kinds = np.zeros_like(base_points), [LEG["D1"]] * len(base_points)
    legs = groups(kinds, kinds[:1], (base_points, platform_points), (lines, lines))
    joints = leg_joints(legs, len(kinds))
    return replace(joints, points=(base_points, platform_points))


def positions() -> Quantities:
    """Return the coordinates of the position."""
    return Quantities(_places, _place_rows, _no_curvature)


def _places(position: Array, rotation: Array) -> Array:
    return position


def _place_rows(position: Array, rotation: Array) -> tuple[Array, Array]:
    rows = np.concatenate((np.eye(3), np.zeros((3, 3))), axis=1)
    return position, np.broadcast_to(rows, (*position.shape[:-1], 3, 6))


def _no_curvature(position: Array, rotation: Array, weight: Array) -> Array:
    return np.zeros((*position.shape[:-1], 6, 6))


def differentiated(values: Values, scale: float) -> Quantities:
    """Add rows to quantities that have none, by central differences over the six twists."""
    return Quantities(values, partial(_with_differences, values, scale), differentiated=True)


def _with_differences(
    values: Values, scale: float, position: Array, rotation: Array
) -> tuple[Array, Array]:
    steps = DIFFERENCE_STEP * np.concatenate((np.eye(6), -np.eye(6)))
    p, r = moved(position[..., None, :], rotation[..., None, :, :], steps, scale)
    around = values(p, r)
    rows = np.swapaxes(around[..., :6, :] - around[..., 6:, :], -1, -2) / (2.0 * DIFFERENCE_STEP)
    return values(position, rotation), rows / np.repeat([scale, 1.0], 3)


def joined(parts: list[Quantities], counts: Sequence[int], scale: float) -> Quantities:
    """Return groups of quantities, of so many each, as one; `scale` is that of differences."""
    if len(parts) == 1:
        return parts[0]
    ends = np.cumsum(counts)[:-1]
    return Quantities(
        partial(_joined_values, parts),
        partial(_joined_rows, parts),
        partial(_joined_curvature, parts, ends, scale),
        differentiated=any(part.differentiated for part in parts),
    )


def _joined_values(parts: list[Quantities], position: Array, rotation: Array) -> Array:
    return np.concatenate([part.values(position, rotation) for part in parts], axis=-1)


def _joined_rows(parts: list[Quantities], position: Array, rotation: Array) -> tuple[Array, Array]:
    results = [part.evaluate(position, rotation) for part in parts]
    return (
        np.concatenate([values for values, _ in results], axis=-1),
        np.concatenate([rows for _, rows in results], axis=-2),
    )


def _joined_curvature(
    parts: list[Quantities],
    ends: NDArray[np.intp],
    scale: float,
    position: Array,
    rotation: Array,
    weight: Array,
) -> Array:
    total = np.zeros((*position.shape[:-1], 6, 6))
    for part, share in zip(parts, np.split(weight, ends, axis=-1), strict=True):
        if share.any():
            total += _curvature(part, scale, position, rotation, share)
    return total


def _curvature(
    quantities: Quantities, scale: float, position: Array, rotation: Array, weight: Array
) -> Array:
    """Second derivatives (..., 6, 6) of a weighted sum, by differences if there is no formula."""
    if quantities.curvature is not None:
        return quantities.curvature(position, rotation, weight)
    steps = SECOND_DIFFERENCE_STEP * _SECOND_MOVES
    p, r = moved(position[..., None, :], rotation[..., None, :, :], steps, scale)
    values = np.einsum("...m,...sm->...s", weight, quantities.values(p, r))
    n = len(_AXES)
    bend = values[..., 1 : 1 + n] + values[..., 1 + n :] - 2.0 * values[..., :1]
    result = np.zeros((*values.shape[:-1], 6, 6))
    result[..., np.arange(6), np.arange(6)] = bend[..., :6]
    i, j = _PAIRS
    result[..., i, j] = result[..., j, i] = 0.5 * (bend[..., 6:] - bend[..., i] - bend[..., j])
    units = SECOND_DIFFERENCE_STEP * np.repeat([scale, 1.0], 3)
    return np.asarray(result / units / units[:, None])


def moved(position: Array, rotation: Array, step: Array, scale: float) -> tuple[Array, Array]:
    """Move poses by twists (v / scale, ω), shape (..., 6): p + v and exp(ω) R.

    It is called in every step of a search, so it does not check its arguments as `exp3` does.
    """
    from scipy.spatial.transform import Rotation

    # A copy, as scipy raises an error for read-only arrays.
    turn = Rotation.from_rotvec(np.array(step[..., 3:]).reshape(-1, 3)).as_matrix()
    return position + scale * step[..., :3], turn.reshape(*step.shape[:-1], 3, 3) @ rotation
