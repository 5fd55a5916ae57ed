"""Compiled witnesses: rotations that follow the position, feasible on all or a part of a box.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.legs import leg_vectors
from gsp.workspace.sets.compiled.bounds import SQUARE_ROUNDING
from gsp.workspace.sets.compiled.climbing import along_angles, place_at, weights_within
from gsp.workspace.sets.compiled.frames import CELL_FRAME_SCALARS, TURNS
from gsp.workspace.sets.compiled.weights import constraints, weights

# How much the turns that follow the position are damped, as a share of the trace of the equations.
DAMPING_SHARE = 3e-3
# Turns [rad] for which the weights of a witness are chosen.
WITNESS_TURN = 0.05


@njit(error_model="numpy", nogil=True)
def _solve(g: Array, y: Array, x: Array) -> None:
    """Solve a symmetric positive system of three equations by cofactors."""
    a, b, c, d, e, f = g[0, 0], g[0, 1], g[0, 2], g[1, 1], g[1, 2], g[2, 2]
    m00, m01, m02 = d * f - e * e, e * c - b * f, b * e - c * d
    m11, m12, m22 = a * f - c * c, b * c - a * e, a * d - b * b
    det = a * m00 + b * m01 + c * m02
    x[0] = (m00 * y[0] + m01 * y[1] + m02 * y[2]) / det
    x[1] = (m01 * y[0] + m11 * y[1] + m12 * y[2]) / det
    x[2] = (m02 * y[0] + m12 * y[1] + m22 * y[2]) / det


@njit(error_model="numpy", nogil=True)
def follow(
    values: Array, slopes: Array, weight: Array, h: Array, normal: Array, turns: Array
) -> None:
    """Write the slope of the least constraint, and turns A that make the others change like it.

    Constraints that may become the least one within the box are made equal, in least squares. The
    result is only a proposal.

    Parameters
    ----------
    values, slopes : (2 n,) and (2 n, 6) arrays
        Constraints in the middle; slopes along unit positions and turns.
    weight : (2 n,) array
        Those of the local optimum.
    h : (3,) array
    normal : (3,) array
        Filled.
    turns : (3, 3) array
        Filled: the turn is A δ.
    """
    normal[:] = 0.0
    least = np.inf
    m = len(values)
    for j in range(m):
        least = min(least, values[j])
        if weight[j] > 0.0:
            for k in range(3):
                normal[k] += weight[j] * slopes[j, k]
    g, y, x = np.zeros((3, 3)), np.zeros((3, 3)), np.empty(3)
    trace = 0.0
    for j in range(m):
        if values[j] == np.inf:
            continue
        over = 0.0
        for k in range(3):
            over += abs(slopes[j, k] - normal[k]) * h[k]
        part = weight[j]
        if values[j] - least < over:
            part = max(part, 0.3 * (1.0 - (values[j] - least) / over))
        if part <= 1e-6:
            continue
        for k in range(3):
            trace += part * slopes[j, 3 + k] ** 2
            for i in range(3):
                g[k, i] += part * slopes[j, 3 + k] * slopes[j, 3 + i]
                y[i, k] += part * slopes[j, 3 + k] * (normal[i] - slopes[j, i])
    turns[:, :] = 0.0
    if trace <= 0.0:
        return
    for k in range(3):
        g[k, k] += DAMPING_SHARE * trace
    for i in range(3):
        _solve(g, y[i], x)
        for k in range(3):
            turns[k, i] = x[k]


@njit(error_model="numpy", nogil=True)
def _add_order(axes: Array, angular: Array, q: Array, m: Array) -> None:
    """Add what the order of three turns changes: Σ_{i<k} φ_i φ_k (ω_i × ω_k) · q."""
    for i in range(2):
        for k in range(i + 1, 3):
            triple = 0.0
            for j in range(3):
                one, two = (j + 1) % 3, (j + 2) % 3
                cross = axes[i, one] * axes[k, two] - axes[i, two] * axes[k, one]
                triple += cross * q[j]
            for row in range(3):
                for column in range(3):
                    m[row, column] += triple * angular[i, row] * angular[k, column]


@njit(error_model="numpy", nogil=True)
def covered(
    p: Array,
    h: Array,
    legs: Array,
    r: Array,
    turns: Array,
    normal: Array,
    axes: Array,
    angular: Array,
) -> float:
    """Return the least c for which exp([A δ]) r is feasible at all δ of the box with n · δ ≥ c.

    Infinite if there is none, −infinite for all of the box. `docs/sets.md` derives the bounds. With
    axes ω_k the rotation is exp([ω_1 φ_1]) exp([ω_2 φ_2]) exp([ω_3 φ_3]) r, with φ = B δ.

    Parameters
    ----------
    p, h : (3,) arrays [length]
    r : (9,) array
    turns : (3, 3) array
        A.
    normal : (3,) array
        n.
    axes : (3, 3) array
        The axes by rows; (0, 3) for the first form.
    angular : (3, 3) array
        B; A is then the product of the transposed axes and B.
    """
    size, square_n, wide, angle = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        size += abs(normal[k]) * h[k]
        square_n += normal[k] * normal[k]
        wide += h[k] * h[k]
        turn = 0.0
        for i in range(3):
            turn += abs(turns[k, i]) * h[i]
        angle += turn * turn
    wide, theta = np.sqrt(wide), np.sqrt(angle)
    if len(axes):
        theta = 0.0
        for k in range(3):
            for i in range(3):
                theta += abs(angular[k, i]) * h[i]
        angle = theta * theta
    b, x, q, slope, m = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty((3, 3))
    cut = -np.inf
    for leg in range(len(legs)):
        square, dot, arm, scale = 0.0, 0.0, 0.0, legs[leg, 6] + wide
        x[0], x[1], x[2], b[0], b[1], b[2] = leg_vectors(p, legs[leg], r)
        for k in range(3):
            square += (x[k] + b[k]) ** 2
            dot += x[k] * b[k]
            arm += x[k] * x[k]
            scale += abs(x[k])
        q[0] = b[1] * x[2] - b[2] * x[1]
        q[1] = b[2] * x[0] - b[0] * x[2]
        q[2] = b[0] * x[1] - b[1] * x[0]
        for i in range(3):
            slope[i] = turns[0, i] * q[0] + turns[1, i] * q[1] + turns[2, i] * q[2]
            slope[i] = 2.0 * (x[i] + b[i] + slope[i])
            along_b = turns[0, i] * b[0] + turns[1, i] * b[1] + turns[2, i] * b[2]
            for k in range(3):
                one, two = (k + 1) % 3, (k + 2) % 3
                m[k, i] = 2.0 * (turns[one, i] * b[two] - turns[two, i] * b[one])
                along_x = turns[0, k] * x[0] + turns[1, k] * x[1] + turns[2, k] * x[2]
                both = turns[0, k] * turns[0, i] + turns[1, k] * turns[1, i]
                m[k, i] += along_x * along_b - dot * (both + turns[2, k] * turns[2, i])
            m[i, i] += 1.0
        if len(axes):
            _add_order(axes, angular, q, m)
        low, high = 0.0, 0.0
        for k in range(3):
            bend = m[k, k] * h[k] * h[k]
            low, high = low + min(0.0, bend), high + max(0.0, bend)
            for i in range(k):
                bend = abs(m[k, i] + m[i, k]) * h[k] * h[i]
                low, high = low - bend, high + bend
        rest = legs[leg, 6] * angle * (np.sqrt(arm) * theta / 3.0 + wide)
        rest += SQUARE_ROUNDING * (scale * scale + legs[leg, 6] * scale * angle)
        for side in range(2):
            bound = legs[leg, 7 + side]
            if bound == np.inf:
                continue
            # Without a least length the length must not be 0.
            sign = -1.0 if side else 1.0
            value = sign * (square - bound * bound) - (high if side else -low) - rest
            full, share, beside = 0.0, 0.0, 0.0
            for k in range(3):
                full += abs(slope[k]) * h[k]
                share += sign * slope[k] * normal[k]
            if value - full > 0.0:
                continue
            if not share > 0.0:
                return np.inf
            share /= square_n
            for k in range(3):
                beside += abs(sign * slope[k] - share * normal[k]) * h[k]
            cut = max(cut, (beside - value) / share)
    if cut <= -size:
        return -np.inf
    return cut if cut < size else np.inf


@njit(error_model="numpy", nogil=True)
def witnessed(
    p: Array,
    h: Array,
    legs: Array,
    turns: Array,
    within: Array,
    r: Array,
    margin: float,
    values: Array,
    slopes: Array,
    weight: Array,
    mix: Array,
    normal: Array,
    follows: Array,
) -> float:
    """Return `covered` of the rotation r (12,) and turns that suit it; `normal` is written.

    Parameters
    ----------
    within : (2, 3) or (0, 3) array
        As in `gsp.workspace.sets.compiled.climbing.ascend`; all the turns stay within it.
    margin : float [length]
        The least constraint at p.
    """
    m, one, nothing = 2 * len(legs), np.ones(3), np.zeros(3)
    constraints(p, nothing, legs, r, WITNESS_TURN, values, slopes)
    if len(within) == 0:
        weights(values, slopes, m, weight, mix, 1.0, -np.inf, margin, 0.03, False)
        constraints(p, one, legs, r, 1.0, values, slopes)
        follow(values[:m], slopes, weight, h, normal, follows)
        return covered(p, h, legs, r, follows, normal, np.empty((0, 3)), follows)
    frame, held, angular = np.empty(CELL_FRAME_SCALARS), np.empty(3), np.empty((3, 3))
    place_at(r[9:], turns, frame)
    weights_within(
        values, slopes, m, frame, r[9:], within, weight, mix, 1.0, margin, 0.03, False, held
    )
    constraints(p, one, legs, r, 1.0, values, slopes)
    for j in range(m):
        along_angles(slopes[j], frame)
        for k in range(3):
            if held[k] > 0.0:
                slopes[j, 3 + k] = 0.0
    follow(values[:m], slopes, weight, h, normal, angular)
    _keep_within(r[9:], within, h, angular)
    axes = frame[TURNS : TURNS + 9].reshape(3, 3)
    for k in range(3):
        for i in range(3):
            follows[k, i] = axes[0, k] * angular[0, i] + axes[1, k] * angular[1, i]
            follows[k, i] += axes[2, k] * angular[2, i]
    return covered(p, h, legs, r, follows, normal, axes, angular)


@njit(error_model="numpy", nogil=True)
def _keep_within(angles: Array, within: Array, h: Array, angular: Array) -> None:
    """Make turns B smaller where they would leave a range on some of the box |δ_k| ≤ h_k."""
    for k in range(3):
        left = min(angles[k] - within[0, k], within[1, k] - angles[k])
        most = 0.0
        for i in range(3):
            most += abs(angular[k, i]) * h[i]
        if most > left:
            for i in range(3):
                angular[k, i] *= max(0.0, left) / most
