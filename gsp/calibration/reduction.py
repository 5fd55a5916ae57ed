"""One linear step of a fit: poses are eliminated, and what the data do not determine is found.

A step d of all unknowns, poses and dimensions, makes |r + J d|² + μ² |d|² least, with a damping μ
that is the same for all of them. The products of J with itself are never formed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from gsp.calibration.measurements import Linear
from gsp.geometry.vectors import Array

# Singular values below it, as a share of the greatest, are rounding: nothing is determined there.
UNDETERMINED = 1e-10


def filtered(values: Array, damping: float | Array) -> tuple[Array, Array]:
    """Return the damped inverses s / (s² + μ²) of singular values, and what these leave.

    Of a residual along a left vector the share (μ² / (s² + μ²))^½ is left: its square is the least
    of |1 + s d|² + μ² d². Where s is rounding, the inverse is 0 and the share is 1.

    Parameters
    ----------
    values : (..., q) array
        s ≥ 0.
    damping : float or (..., 1) array
        μ ≥ 0.
    """
    s = np.where(values > UNDETERMINED * values.max(axis=-1, keepdims=True, initial=0.0), values, 0)
    size = np.hypot(s, damping)
    divisor = np.where(size > 0.0, size, 1.0)
    return s / divisor / divisor, np.where(size > 0.0, damping / divisor, 1.0)


class PoseBlocks(NamedTuple):
    """The derivatives of residuals by each pose, as their singular value decompositions.

    Attributes
    ----------
    left : (k, m, m) array
        Left vectors, as columns.
    values : (k, q) array
        q = min(m, 6) singular values.
    right : (k, q, 6) array
        Right vectors, as rows.
    """

    left: Array
    values: Array
    right: Array

    @classmethod
    def of(cls, by_pose: Array) -> Self:
        """Return the decompositions of derivatives (k, m, 6)."""
        left, values, right = np.linalg.svd(by_pose)
        return cls(left, values, right[:, : values.shape[-1]])

    @property
    def rank(self) -> int:
        """Number of coordinates of all poses that are determined."""
        return int((filtered(self.values, 0.0)[0] > 0.0).sum())

    def left_over(self, rows: Array, damping: float) -> Array:
        """Return what the best damped steps of the poses leave of rows (k, m, ...)."""
        along = np.swapaxes(self.left, -1, -2) @ rows
        along[:, : self.values.shape[-1]] *= filtered(self.values, damping)[1][..., None]
        return np.asarray(along)

    def step(self, residuals: Array, damping: float | Array) -> Array:
        """Return the damped steps (k, 6) of the poses for residuals (k, m)."""
        inverse = filtered(self.values, damping)[0]
        along = (np.swapaxes(self.left, -1, -2) @ residuals[..., None])[:, : inverse.shape[-1], 0]
        return -((inverse * along)[:, None] @ self.right)[:, 0]


@dataclass(frozen=True, eq=False, kw_only=True)
class Reduced:
    """The linear problem of the dimensions alone, as its singular value decomposition.

    Attributes
    ----------
    values : (p,) array
        Singular values, descending, 0 for those that are missing.
    vectors : (p, p) array
        Their right vectors, as rows.
    loads : (p,) array
        Residuals along the left vectors.
    """

    values: Array
    vectors: Array
    loads: Array

    @property
    def rank(self) -> int:
        """Number of combinations that are determined."""
        return int((filtered(self.values, 0.0)[0] > 0.0).sum())

    @property
    def undetermined(self) -> Array:
        """Orthonormal combinations that are not, (p − rank, p)."""
        return self.vectors[self.rank :]

    def step(self, damping: float, away: Array) -> Array:
        """Return a damped step (p,), with what is not determined led back from `away`."""
        loose = self.undetermined
        along = filtered(self.values, damping)[0] * self.loads
        return np.asarray(-along @ self.vectors - loose.T @ (loose @ away))

    def covariance(self) -> Array:
        """Return the covariance (p, p) of the combinations that are determined."""
        half = self.vectors[: self.rank] / self.values[: self.rank, None]
        return np.asarray(half.T @ half)


class Step(NamedTuple):
    """A step of all unknowns.

    Attributes
    ----------
    dimensions : (p,) array
        In sizes of the design and in rad.
    poses : (k, 6) array or None
        In sizes of the design and in rad; None where poses are exact.
    predicted : float
        By how much the sum of the squares decreases if the residuals are linear.
    """

    dimensions: Array
    poses: Array | None
    predicted: float

    @property
    def largest(self) -> float:
        """Largest component of dimensions and poses."""
        parts = [self.dimensions] if self.poses is None else [self.dimensions, self.poses]
        return max(float(np.abs(part).max(initial=0.0)) for part in parts)


@dataclass(frozen=True, eq=False, kw_only=True)
class LinearProblem:
    """A fit whose residuals are linear in poses and dimensions.

    Attributes
    ----------
    linear : Linear
        With its weights.
    blocks : PoseBlocks or None
        None where poses are exact.
    """

    linear: Linear
    blocks: PoseBlocks | None

    @classmethod
    def of(cls, linear: Linear, weights: Array, exact: bool) -> Self:
        """Return the problem with weights (k, m) of the squares; `exact`: poses are fixed."""
        roots = np.sqrt(weights)
        r, by_pose, by_dimensions = linear
        weighted = Linear(r * roots, by_pose * roots[..., None], by_dimensions * roots[..., None])
        return cls(
            linear=weighted, blocks=None if exact else PoseBlocks.of(np.asarray(weighted.by_pose))
        )

    @property
    def size(self) -> float:
        """Largest norm of a column of all derivatives."""
        found = np.linalg.norm(self.linear.by_dimensions, axis=(0, 1)).max(initial=0.0)
        if self.blocks is not None:
            found = max(found, np.linalg.norm(self.linear.by_pose, axis=1).max(initial=0.0))
        return float(found)

    def reduced(self, damping: float = 0.0) -> Reduced:
        """Return the problem of the dimensions alone, with poses that follow, damped."""
        r, _, by_dimensions = self.linear
        rows = np.concatenate((by_dimensions, r[..., None]), axis=-1)
        if self.blocks is not None:
            rows = self.blocks.left_over(rows, damping)
        flat = rows.reshape(-1, rows.shape[-1])
        return _decomposed(np.asarray(np.linalg.qr(flat, mode="r")))

    def step(self, damping: float) -> Step:
        """Return the step with a damping."""
        return self.with_poses(self.reduced(damping).step(damping, np.zeros(self._p)), damping)

    def with_poses(self, dimensions: Array, damping: float = 0.0) -> Step:
        """Return the step of the dimensions (p,) with the best damped one of the poses."""
        r, by_pose, by_dimensions = self.linear
        change = by_dimensions @ dimensions
        poses = None
        if self.blocks is not None:
            poses = self.blocks.step(r + change, damping)
            change = change + (by_pose @ poses[..., None])[..., 0]
        return Step(dimensions, poses, predicted=float(reduction(r, change).sum()))

    @property
    def _p(self) -> int:
        return int(self.linear.by_dimensions.shape[-1])


def reduction(residuals: Array, change: Array) -> Array:
    """Return by how much the squares of residuals (..., m) decrease with their change, summed."""
    return np.asarray(-(change * (2.0 * residuals + change)).sum(axis=-1))


def _decomposed(rows: Array) -> Reduced:
    """Return the decomposition of a matrix whose last column has the residuals."""
    p = rows.shape[1] - 1
    left, values, right = np.linalg.svd(rows[:, :p])
    number = len(values)
    padded, loads = np.zeros(p), np.zeros(p)
    padded[:number], loads[:number] = values, left[:, :number].T @ rows[:, p]
    return Reduced(values=padded, vectors=right, loads=loads)
