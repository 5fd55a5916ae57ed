"""One linear step of a fit: poses are eliminated, and what the data do not determine is found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gsp.calibration.measurements import Linear
from gsp.geometry.vectors import Array

# Singular values below it, as a share of the greatest, are rounding: nothing is determined there.
UNDETERMINED = 1e-10


class PoseSteps(NamedTuple):
    """How the poses follow the dimensions in a step.

    Attributes
    ----------
    inverse : (k, 6, m) array
        Least-squares inverses of the derivatives by the pose.
    linear : Linear
        With its weights.
    """

    inverse: Array
    linear: Linear

    def step(self, dimensions: Array) -> Array:
        """Return the steps (k, 6) of the poses for that of the dimensions (p,)."""
        left = self.linear.residuals + self.linear.by_dimensions @ dimensions
        return -(self.inverse @ left[..., None])[..., 0]


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
        return int((self.values > UNDETERMINED * self.values.max(initial=0.0)).sum())

    @property
    def undetermined(self) -> Array:
        """Orthonormal combinations that are not, (p − rank, p)."""
        return self.vectors[self.rank :]

    def step(self, damping: float, away: Array) -> Array:
        """Return a damped step (p,), with what is not determined led back from `away`."""
        known = slice(0, self.rank)
        s = self.values[known]
        held = damping * self.values.max(initial=0.0)
        along = -s / (s * s + held * held) * self.loads[known]
        loose = self.undetermined
        return np.asarray(along @ self.vectors[known] - loose.T @ (loose @ away))

    def covariance(self) -> Array:
        """Return the covariance (p, p) of the combinations that are determined."""
        half = self.vectors[: self.rank] / self.values[: self.rank, None]
        return np.asarray(half.T @ half)


def reduced(linear: Linear, weights: Array, exact: bool) -> tuple[Reduced, PoseSteps | None]:
    """Return the problem of the dimensions alone, and how the poses follow; None if they are exact.

    Parameters
    ----------
    linear : Linear
    weights : (k, m) array [1]
        Of the squares of the residuals.
    exact : bool
        Whether poses are fixed.
    """
    roots = np.sqrt(weights)
    r, by_pose, by_dimensions = linear
    weighted = Linear(r * roots, by_pose * roots[..., None], by_dimensions * roots[..., None])
    rest, follow = weighted, None
    if not exact:
        across = np.swapaxes(np.linalg.qr(weighted.by_pose, mode="complete").Q[..., 6:], -1, -2)
        left = (across @ weighted.residuals[..., None])[..., 0]
        rest = Linear(left, by_pose, across @ weighted.by_dimensions)
        follow = PoseSteps(np.asarray(np.linalg.pinv(weighted.by_pose), dtype=np.float64), weighted)
    p = by_dimensions.shape[-1]
    rows = np.hstack((rest.by_dimensions.reshape(-1, p), rest.residuals.reshape(-1, 1)))
    return _decomposed(np.asarray(np.linalg.qr(rows, mode="r"))), follow


def _decomposed(rows: Array) -> Reduced:
    """Return the decomposition of a matrix whose last column has the residuals."""
    p = rows.shape[1] - 1
    left, values, right = np.linalg.svd(rows[:, :p])
    number = len(values)
    padded, loads = np.zeros(p), np.zeros(p)
    padded[:number], loads[:number] = values, left[:, :number].T @ rows[:, p]
    return Reduced(values=padded, vectors=right, loads=loads)
