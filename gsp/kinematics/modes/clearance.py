"""How far a solution is from the next one, and how exactly it is known.

Newton's method converges to a solution from all poses nearer than its clearance, so there is no
other one within it. A solution that rounding moves by nearly as much cannot be told from a multiple
one.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array
from gsp.kinematics.modes.equations import Complex, Layout, linear

# Smallest singular value of a solution whose clearance is looked at, as a share of the largest one.
WEAK_SHARE = 1e-4
# Change of the derivatives at which Newton's method may fail, as a share of them.
CLEAR_CHANGE = 0.5
# Step from a pose to others at which derivatives are compared, as a share of its size.
COMPARED_STEP = 1e-4
# Directions in which they are compared: those that are controlled least.
COMPARED_DIRECTIONS = 3
# Share of the clearance within which poses are the same solution, and how many times what rounding
# moves them by; how many times as much the clearance of a regular solution is at least.
SAME_SHARE, SAME_ROUNDINGS, REGULAR_ROUNDINGS = 0.2, 4.0, 10.0


@dataclass(frozen=True, eq=False)
class Clearances:
    """Clearances of solutions.

    Attributes
    ----------
    sizes : (m,) array
        Of quaternions and positions together.
    shares : (m,) array [1]
        See `regular_shares`.
    distances : (m,) array [1]
        As shares of the sizes of quaternion and position: within them there is no other solution;
        inf where `shares` are above `WEAK_SHARE`.
    rounding : (m,) array [1]
        By how much poses are uncertain as parameters and products are rounded; 0 as before.
    """

    sizes: Array
    shares: Array
    distances: Array
    rounding: Array

    @classmethod
    def of(cls, layout: Layout, parameters: Complex, poses: Complex) -> Clearances:
        """Return the clearances of solutions (m, 7) of the equations with parameters (6, 13)."""
        shares = regular_shares(layout, parameters, poses)
        distances, rounding = np.full(len(poses), np.inf), np.zeros(len(poses))
        weak = (shares < WEAK_SHARE) & (shares > 0.0)
        if weak.any():
            distances[weak], rounding[weak] = _clear(layout, parameters, poses[weak])
        return cls(np.abs(poses).max(axis=1, initial=0.0), shares, distances, rounding)

    def __getitem__(self, places: NDArray[np.intp] | NDArray[np.bool_]) -> Clearances:
        """Return those of some solutions."""
        return Clearances(*(getattr(self, field.name)[places] for field in fields(self)))

    @property
    def regular(self) -> NDArray[np.bool_]:
        """Which solutions are regular, (m,)."""
        clear = self.distances > REGULAR_ROUNDINGS * self.rounding
        return np.asarray(clear & (self.shares > 0.0))

    def within(self, share: float) -> Array:
        """Return distances within which poses are the same, (m,).

        A share of their sizes, or what rounding explains, and less than the clearances.
        """
        explained = np.maximum(share, SAME_ROUNDINGS * self.rounding)
        return np.asarray(np.minimum(explained, SAME_SHARE * self.distances) * self.sizes)


def regular_shares(layout: Layout, parameters: Complex, poses: Complex) -> Array:
    """Return the smallest singular value at poses (m, 7) as a share of the largest one, (m,).

    Of derivatives by twists in the scales of positions and rows; 0 where these are not defined.
    """
    from gsp.kinematics.modes.tracking import derivatives

    slopes = np.empty((len(poses), 6, 6), dtype=np.complex128)
    derivatives(layout.kinds, parameters, np.ascontiguousarray(poses), slopes)
    slopes[:, :, :3] *= _scales(poses)[:, None, 4:]
    with np.errstate(invalid="ignore", divide="ignore"):
        slopes /= np.linalg.norm(slopes, axis=2, keepdims=True)
    defined = np.asarray(np.isfinite(slopes).all(axis=(1, 2)))
    values = np.linalg.svd(slopes[defined], compute_uv=False)
    shares = np.zeros(len(poses))
    shares[defined] = values[:, -1] / values[:, 0]
    return shares


def _scales(poses: Complex) -> Array:
    """Return the sizes of quaternion and position, at least 1, for each component: (m, 7)."""
    sizes = np.abs(poses)
    turns, places = sizes[:, :4].max(axis=1, initial=0.0), sizes[:, 4:].max(axis=1, initial=1.0)
    return np.repeat(np.stack((turns, places), axis=-1), (4, 3), axis=1)


def _clear(layout: Layout, parameters: Complex, poses: Complex) -> tuple[Array, Array]:
    """Return the clearances of solutions (m, 7), and what rounding moves them; shares of scales.

    Solutions are apart in directions of small singular values. So directions, and equations, count
    with the root of the smallest value over theirs. Newton's method may fail where the derivatives
    change by `CLEAR_CHANGE` of the smallest value.
    """
    scales = _scales(poses)[:, None, :]
    slopes = linear(layout, parameters, poses)[1] * scales
    left, values, right = np.linalg.svd(slopes)
    least = right[:, -COMPARED_DIRECTIONS:].conj()
    beside = poses[:, None] + COMPARED_STEP * scales * least
    after = linear(layout, parameters, beside.reshape(-1, 7))[1].reshape(*least.shape, 7)
    changed = after * scales[:, None] - slopes[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = np.sqrt(values[:, -1:] / values)
        some = weights[:, -COMPARED_DIRECTIONS:]
        change = left.conj().swapaxes(1, 2)[:, None] @ changed @ least.swapaxes(1, 2)[:, None]
        change *= some[:, :, None, None] * weights[:, None, :, None] * some[:, None, None, :]
        change = np.linalg.norm(change, axis=(2, 3)).max(axis=1) / (values[:, -1] * COMPARED_STEP)
        terms = np.abs(slopes) @ np.abs(poses / scales[:, 0])[..., None]
        moved = np.abs(left.conj().swapaxes(1, 2)) @ terms / values[..., None]
        rounding = np.finfo(float).eps * moved.max(axis=(1, 2))
        distances = np.nan_to_num(CLEAR_CHANGE / change, posinf=np.inf)
    return distances, np.nan_to_num(rounding, nan=np.inf, posinf=np.inf)
