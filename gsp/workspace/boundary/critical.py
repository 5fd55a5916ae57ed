"""Critical points of a workspace's projection: the equations, and Newton's method for them.

A point u of a plane lies on the boundary of the set of reachable points only if some orientation
w makes active constraints g_i = 0 whose gradients with respect to w are dependent with weights
λ_i ≥ 0: Σ λ_i ∂g_i/∂w = 0. (That is the Fritz John condition of the farthest point on a ray, for
every ray.) With Σ λ_i² = 1 and n active constraints in a plane these are n + k + 1 equations for
2 + k + n unknowns: a curve, which does not depend on the radiating point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.frames import exp3
from gsp.geometry.matrices import RESIDUAL_TOLERANCE, newton, solve_least_squares, solve_linear
from gsp.geometry.rotations import skew_part
from gsp.geometry.vectors import EPS, Array, Mask, dot, norm
from gsp.limits.labels import Active
from gsp.limits.quantities import BoundedQuantities, moved

# Equations whose least singular value is below this share of the greatest leave a turn free.
FREE_TURN = 1e-9
# Share of the residuals of gradients by differences that counts: they are accurate to 1e-9 at best,
# the rounding of some values over a step of 1e-5.
DIFFERENCE_SHARE = 1e-3
# Residual of a long stroke that counts as rounding [units of rounding of the stroke].
ROUNDED_UNITS = 40.0
# Steps of Newton's method, and the longest of them [share of the scale, rad].
CRITICAL_STEPS, LONGEST_CRITICAL_STEP = 30, 0.3


@dataclass(frozen=True, eq=False)
class Points:
    """N critical points that share their active constraints.

    Attributes
    ----------
    position : (N, 3) array [length]
    rotation : (N, 3, 3) array [1]
    weight : (N, n) array [1]
        λ of the active constraints, Σ λ² = 1.
    """

    position: Array
    rotation: Array
    weight: Array

    def __getitem__(self, index: Any) -> Points:
        return Points(self.position[index], self.rotation[index], self.weight[index])

    def upright(self) -> Points:
        """Return the points with the sign of λ whose sum is positive; −λ is a solution as well."""
        sign = np.where(self.weight.sum(axis=1) < 0.0, -1.0, 1.0)
        return Points(self.position, self.rotation, self.weight * sign[:, None])


# Extra equations: points, jet -> residuals (N, q), gradients (N, q, m + k + n).
Extra = Callable[["Points", "Jet"], tuple[Array, Array]]


@dataclass(frozen=True, eq=False)
class Jet:
    """Constraints at points: excess (N, m, 2) and gradients (N, m, 2, d), per size."""

    excess: Array
    gradient: Array

    def of(self, active: Active) -> tuple[Array, Array]:
        """Excess (N, n) and gradients (N, n, d) of active constraints."""
        index = [i for i, _ in active], [side for _, side in active]
        return self.excess[:, index[0], index[1]], self.gradient[:, index[0], index[1]]


@dataclass(frozen=True, eq=False)
class Chart:
    """A plane (or line, or space) of positions, and the turns that are free.

    Attributes
    ----------
    bounds : BoundedQuantities
    axes : (m, 3) array
        Orthonormal directions of positions, in base axes.
    turns : (k, 3) array
        Orthonormal axes of free turns, in base axes: three, one for a planar platform, or none.
    """

    bounds: BoundedQuantities
    axes: Array
    turns: Array

    @property
    def freedoms(self) -> int:
        """Number m + k of coordinates."""
        return len(self.axes) + len(self.turns)

    def move(self, points: Points, step: Array) -> Points:
        """Move points by coordinates (..., m + k + n) of position / scale, turn, and weight."""
        m, k = len(self.axes), len(self.turns)
        twist = np.concatenate(
            (step[..., :m] @ self.axes, step[..., m : m + k] @ self.turns), axis=-1
        )
        p, r = moved(points.position, points.rotation, twist, self.bounds.scale)
        return Points(p, r, points.weight + step[..., m + k :])

    def jet(self, position: Array, rotation: Array) -> Jet:
        """Evaluate the constraints."""
        excess, rows = self.bounds.comparable(position, rotation)
        along, about = rows[..., :3] @ self.axes.T, rows[..., 3:] @ self.turns.T
        # Signs of the lower and of the upper bound.
        gradient = np.concatenate((along, about), axis=-1)[..., None, :] * [[-1.0], [1.0]]
        return Jet(excess, gradient)

    def equations(
        self, points: Points, active: Active, *, second_order: bool = True
    ) -> tuple[Array, Array, Jet]:
        """Residuals (N, n + k + 1), their matrix (N, n + k + 1, m + k + n), and the jet.

        Without `second_order` the matrix leaves out how the gradients change with the pose.
        Newton's method converges to the same solution where positions and turns do not depend on
        the weights.
        """
        m, k, n, d = len(self.axes), len(self.turns), len(active), self.freedoms
        jet = self.jet(points.position, points.rotation)
        g, gradient = jet.of(active)
        number = len(g)
        residual = np.concatenate(
            (
                g,
                self._rotation_gradient(points, gradient),
                (dot(points.weight, points.weight) - 1.0)[:, None],
            ),
            axis=1,
        )
        matrix = np.zeros((number, n + k + 1, d + n))
        matrix[:, :n, :d] = gradient
        if k and second_order:
            matrix[:, n : n + k, :d] = self._rotation_gradient_derivative(points, active)
        if k:
            matrix[:, n : n + k, d:] = np.swapaxes(gradient[..., m:], -1, -2)
        matrix[:, -1, d:] = 2.0 * points.weight
        return residual, matrix, jet

    def _rotation_gradient(self, points: Points, gradient: Array) -> Array:
        """Σ λ_i ∂g_i/∂w, shape (N, k)."""
        turning = gradient[..., len(self.axes) :]
        return np.asarray(np.einsum("...n,...nk->...k", points.weight, turning))

    def net(self, weight: Array, active: Active) -> Array:
        """Weights (N, m) of all quantities from those of active constraints (N, n), with signs."""
        net = np.zeros((len(weight), len(self.bounds.names)))
        for place, (i, side) in enumerate(active):
            net[:, i] += (2 * side - 1) * weight[:, place]
        return net

    def _rotation_gradient_derivative(self, points: Points, active: Active) -> Array:
        """Differentiate Σ λ_i ∂g_i/∂w, shape (N, k, d); exact where that sum is zero."""
        net = self.net(points.weight, active)
        curvature = self.bounds.curvature(points.position, points.rotation, net)
        turned = self.turns @ curvature[:, 3:]
        return np.concatenate(
            (turned[..., :3] @ self.axes.T, turned[..., 3:] @ self.turns.T),
            axis=-1,
        )

    def solve(
        self, points: Points, active: Active, extra: Extra, *, second_order: bool | None = None
    ) -> tuple[Points, Mask, Jet]:
        """Solve the equations and some more by Newton's method, for all points at once.

        `second_order` as in `equations`; by default it is left out where k + 1 constraints fix the
        pose for given places, and weights do not occur among the other equations.

        Returns
        -------
        points, solved (N,), jet at the points
            `solved` is False where the iteration did not converge to rounding, which of gradients
            is that of differences where quantities have no formula of them.
        """
        full = len(active) <= len(self.turns) if second_order is None else second_order
        jets: list[Jet] = []
        turning = slice(len(active), len(active) + len(self.turns))
        share = DIFFERENCE_SHARE if self.bounds.differentiated else 1.0
        tolerance = self._tolerance(active)
        # Steps along curves of one orientation grow with the strokes, and so may corrections.
        far = 1.0 if len(self.turns) else max(1.0, float(self.strokes(active).min(initial=np.inf)))

        def equations(here: Points) -> tuple[Array, Array]:
            residual, matrix, jet = self.equations(here, active, second_order=full)
            residual[:, turning] *= share
            matrix[:, turning] *= share
            more, row = extra(here, jet)
            jets[:] = [jet]
            matrix = np.concatenate((matrix, row), axis=1)
            # Where a quantity changes fast, as between lines that are almost parallel, the rounding
            # of the pose is multiplied by that: residuals count per largest derivative.
            most = np.maximum(1.0, np.abs(matrix).max(axis=2))
            residual = np.concatenate((residual, more), axis=1) / most
            return residual, matrix / most[..., None]

        points, residual = newton(
            points,
            equations,
            self.move,
            # Turns may be free, as about the axis of a single leg: of the solutions, the nearest.
            solve=_nearest if full else solve_linear,
            longest=LONGEST_CRITICAL_STEP * far,
            most=CRITICAL_STEPS,
            rest=0.1 * tolerance,
        )
        return points, np.asarray(residual < tolerance), jets[0]

    def strokes(self, active: Active) -> Array:
        """Return the bounds of active constraints that are lengths of joints, 0 for others, (n,).

        As shares of the scale.
        """
        bounds = self.bounds
        lengths = [q.kind == "joint" and not q.angular for q in bounds.named]
        ends = [(bounds.low, bounds.high)[side][i] if lengths[i] else 0.0 for i, side in active]
        return np.asarray(np.abs(np.array(ends)) / bounds.scale)

    def _tolerance(self, active: Active) -> float:
        """Return the residual of solved points: where strokes are long, it is their rounding."""
        longest = float(self.strokes(active).max(initial=0.0))
        return max(RESIDUAL_TOLERANCE, ROUNDED_UNITS * EPS * longest)

    def tangents(self, points: Points, active: Active) -> Array:
        """Return unit tangents of the curves through points, shape (N, m + k + n).

        Where k + 1 constraints fix the curve by themselves, its weights are left out. Where a turn
        is free, as about the axis of a single active leg, the platform does not make it.
        """
        if len(active) == len(self.turns) + 1:
            gradient = self.jet(points.position, points.rotation).of(active)[1]
            pose = np.linalg.svd(gradient)[2][:, -1]
            return np.concatenate((pose, np.zeros_like(points.weight)), axis=1)
        _, matrix, _ = self.equations(points, active)
        _, values, rows = np.linalg.svd(matrix)
        tangents = rows[:, -1]
        rank = (values > FREE_TURN * values[:, :1]).sum(axis=1)
        for number in np.unique(rank[rank < values.shape[1]]):
            free = rank == number
            basis = rows[free, number:]
            # Of these directions, the combination that moves the position most.
            share = np.linalg.svd(basis[..., : len(self.axes)])[0][..., 0]
            tangents[free] = np.einsum("nb,nbd->nd", share, basis)
        return np.asarray(tangents)

    def weights(self, gradient: Array) -> tuple[Array, Array]:
        """λ that best makes Σ λ_i ∂g_i/∂w = 0, shape (N, n), and the defect (N,)."""
        pull = np.swapaxes(gradient[..., len(self.axes) :], -1, -2)
        n, k = pull.shape[-1], pull.shape[-2]
        _, s, vt = np.linalg.svd(pull)
        weight = vt[..., -1, :]
        defect = s[..., -1] if n <= k else np.zeros(s.shape[:-1])
        return weight * np.where(weight.sum(axis=-1) < 0.0, -1.0, 1.0)[..., None], defect

    def normal(self, points: Points, jet: Jet, active: Active) -> Array:
        """Outward normals Σ λ_i ∂g_i/∂u, shape (N, m)."""
        gradient = jet.of(active)[1][..., : len(self.axes)]
        return np.asarray(np.einsum("...n,...nm->...m", points.weight, gradient))


def _nearest(matrix: Array, right: Array) -> Array:
    """Shortest least-squares solutions (N, d): free turns are not made."""
    return solve_least_squares(matrix, right, FREE_TURN)


def between(points: Points, place: NDArray[np.intp], share: Array) -> Points:
    """Interpolate between points and their followers, to second order: N of them."""
    one, two = points[place], points[place + 1]
    spin = skew_part(two.rotation @ np.swapaxes(one.rotation, -1, -2))
    s = share[:, None]
    return Points(
        one.position + s * (two.position - one.position),
        exp3(s * spin) @ one.rotation,
        one.weight + s * (two.weight - one.weight),
    )


def distance(one: Points, other: Points, size: float) -> float:
    """Distance of two single points in position / size and rotation."""
    place = norm(one.position[0] - other.position[0]) / size
    return float(place + np.linalg.norm(one.rotation[0] - other.rotation[0]))


def joined(parts: list[Points]) -> Points:
    """Return points of several records as one."""
    return Points(
        np.concatenate([p.position for p in parts]),
        np.concatenate([p.rotation for p in parts]),
        np.concatenate([p.weight for p in parts]),
    )
