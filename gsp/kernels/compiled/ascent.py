"""Compiled climbs along rays under bounds on point distances, ray by ray.

The steps are those of `gsp.workspace.boundary.climb`, to rounding. Only import it where it is used.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit, types

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.legs import checksum_of_code, leg_vectors

# Sweeps of Jacobi's method; it converges quadratically.
JACOBI_SWEEPS = 12


@njit(error_model="numpy")
def _slacks(
    legs: Array,
    low: Array,
    high: Array,
    size: float,
    p: Array,
    r: Array,
    slack: Array,
) -> float:
    """Slacks (m, 2) at a pose, and the sum of their logarithms; -inf outside."""
    total = 0.0
    for i in range(len(legs)):
        a0, a1, a2, r0, r1, r2 = leg_vectors(p, legs[i], r)
        length = np.sqrt((a0 + r0) ** 2 + (a1 + r1) ** 2 + (a2 + r2) ** 2)
        slack[i, 0] = (length - low[i]) / size
        slack[i, 1] = (high[i] - length) / size
        for side in range(2):
            if not slack[i, side] > 0.0:
                total = -np.inf
            elif slack[i, side] < np.inf:
                total += np.log(slack[i, side])
    return total


@njit(error_model="numpy")
def _derivatives(
    legs: Array,
    size: float,
    turns: Array,
    e: Array,
    p: Array,
    r: Array,
    slack: Array,
    barrier: float,
    work: Array,
    gradient: Array,
    hessian: Array,
) -> None:
    """Differentiate −r − barrier Σ log(slack) over (r / size, turns)."""
    n = len(gradient)
    arm, u, g, x = work[0], work[1], work[2], work[3:]
    for j in range(n):
        gradient[j] = 0.0 if j else -1.0
        for k in range(n):
            hessian[j, k] = 0.0
    for i in range(len(legs)):
        a0, a1, a2, arm[0], arm[1], arm[2] = leg_vectors(p, legs[i], r)
        u[0], u[1], u[2] = a0 + arm[0], a1 + arm[1], a2 + arm[2]
        length = np.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
        for a in range(3):
            u[a] /= length
            x[0, a] = e[a]
        outward = arm[0] * u[0] + arm[1] * u[1] + arm[2] * u[2]
        for j in range(1, n):
            t = turns[j - 1]
            x[j, 0] = (t[1] * arm[2] - t[2] * arm[1]) / size
            x[j, 1] = (t[2] * arm[0] - t[0] * arm[2]) / size
            x[j, 2] = (t[0] * arm[1] - t[1] * arm[0]) / size
        for j in range(n):
            g[j] = u[0] * x[j, 0] + u[1] * x[j, 1] + u[2] * x[j, 2]
        least, most = barrier / slack[i, 0], barrier / slack[i, 1]
        net, stiffness = most - least, least / slack[i, 0] + most / slack[i, 1]
        for j in range(n):
            gradient[j] += net * g[j]
            for k in range(j + 1):
                inner = x[j, 0] * x[k, 0] + x[j, 1] * x[k, 1] + x[j, 2] * x[k, 2]
                bend = (inner - g[j] * g[k]) * size / length
                if k > 0:
                    s, t = turns[j - 1], turns[k - 1]
                    su = s[0] * u[0] + s[1] * u[1] + s[2] * u[2]
                    tu = t[0] * u[0] + t[1] * u[1] + t[2] * u[2]
                    sa = s[0] * arm[0] + s[1] * arm[1] + s[2] * arm[2]
                    ta = t[0] * arm[0] + t[1] * arm[1] + t[2] * arm[2]
                    st = s[0] * t[0] + s[1] * t[1] + s[2] * t[2]
                    bend += (0.5 * (su * ta + tu * sa) - st * outward) / size
                hessian[j, k] += stiffness * g[j] * g[k] + net * bend
    for j in range(n):
        for k in range(j):
            hessian[k, j] = hessian[j, k]


@njit(error_model="numpy")
def _eigen(a: Array, v: Array) -> None:
    """Diagonalise a small symmetric matrix in place by Jacobi's method; v: eigenvectors."""
    n = len(a)
    for i in range(n):
        for j in range(n):
            v[i, j] = 1.0 if i == j else 0.0
    for _ in range(JACOBI_SWEEPS):
        turned = False
        for i in range(n):
            for j in range(i + 1, n):
                # Smaller entries are below the rounding of the diagonal.
                if not a[i, j] * a[i, j] > 1e-34 * abs(a[i, i] * a[j, j]):
                    continue
                turned = True
                theta = (a[j, j] - a[i, i]) / (2.0 * a[i, j])
                t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
                t = -t if theta < 0.0 else t
                c = 1.0 / np.sqrt(t * t + 1.0)
                s = t * c
                for k in range(n):
                    a[k, i], a[k, j] = c * a[k, i] - s * a[k, j], s * a[k, i] + c * a[k, j]
                for k in range(n):
                    a[i, k], a[j, k] = c * a[i, k] - s * a[j, k], s * a[i, k] + c * a[j, k]
                    v[k, i], v[k, j] = c * v[k, i] - s * v[k, j], s * v[k, i] + c * v[k, j]
                a[i, j] = a[j, i] = 0.0
        if not turned:
            return


@njit(error_model="numpy")
def _descend(
    hessian: Array, gradient: Array, along: float, turn: float, v: Array, step: Array
) -> float:
    """Newton step with |eigenvalues|, limited along the ray and in turns; the decrement."""
    n = len(gradient)
    _eigen(hessian, v)
    greatest = 0.0
    for i in range(n):
        greatest = max(greatest, abs(hessian[i, i]))
    decrement = 0.0
    for i in range(n):
        step[i] = 0.0
    for i in range(n):
        inner = 0.0
        for k in range(n):
            inner += v[k, i] * gradient[k]
        # |eigenvalues|: the step descends also where the Hessian is not positive definite.
        share = inner / max(abs(hessian[i, i]), 1e-9 * greatest)
        decrement += inner * share
        for k in range(n):
            step[k] -= share * v[k, i]
    length = abs(step[0]) / along
    for k in range(1, n):
        length = max(length, abs(step[k]) / turn)
    for k in range(n):
        step[k] /= max(1.0, length)
    return decrement


@njit(error_model="numpy")
def _move(
    p: Array,
    r: Array,
    e: Array,
    turns: Array,
    size: float,
    step: Array,
    factor: float,
    to_p: Array,
    to_r: Array,
) -> None:
    """Go along the ray and turn: p + size r e, and exp(ω) R by Rodrigues' formula."""
    w0 = w1 = w2 = 0.0
    for a in range(3):
        to_p[a] = p[a] + size * factor * step[0] * e[a]
    for j in range(len(turns)):
        w0 += factor * step[1 + j] * turns[j, 0]
        w1 += factor * step[1 + j] * turns[j, 1]
        w2 += factor * step[1 + j] * turns[j, 2]
    square = w0 * w0 + w1 * w1 + w2 * w2
    angle = np.sqrt(square)
    s, c = 1.0, 0.5
    if angle > 1e-8:  # 1 − cos by the sine of half the angle, which does not cancel
        s, c = np.sin(angle) / angle, 2.0 * np.sin(0.5 * angle) ** 2 / square
    for b in range(3):
        x, y, z = r[b], r[3 + b], r[6 + b]
        inner = c * (w0 * x + w1 * y + w2 * z)
        keep = 1.0 - c * square
        to_r[b] = keep * x + s * (w1 * z - w2 * y) + inner * w0
        to_r[3 + b] = keep * y + s * (w2 * x - w0 * z) + inner * w1
        to_r[6 + b] = keep * z + s * (w0 * y - w1 * x) + inner * w2


@njit(error_model="numpy")
def _stays(
    legs: Array,
    low: Array,
    high: Array,
    p: Array,
    r: Array,
    e: Array,
    turns: Array,
    size: float,
    step: Array,
    factor: float,
    sample: float,
    way: float,
    to_p: Array,
    to_r: Array,
    slack: Array,
) -> bool:
    """Whether the samples of the way of a step are inside."""
    length = abs(step[0]) / max(1.0, way)
    for k in range(1, len(step)):
        length = max(length, abs(step[k]))
    number = int(np.ceil(factor * length / sample))
    for i in range(1, number):
        _move(p, r, e, turns, size, step, factor * i / number, to_p, to_r)
        if _slacks(legs, low, high, size, to_p, to_r, slack) == -np.inf:
            return False
    return True


@njit(error_model="numpy")
def _copy(p: Array, r: Array, slack: Array, to_p: Array, to_r: Array, to_slack: Array) -> None:
    for a in range(3):
        to_p[a] = p[a]
    for k in range(9):
        to_r[k] = r[k]
    for i in range(len(slack)):
        to_slack[i, 0], to_slack[i, 1] = slack[i, 0], slack[i, 1]


def _climber(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def climb_points(
        legs: Array,
        low: Array,
        high: Array,
        size: float,
        turns: Array,
        direction: Array,
        barriers: Array,
        control: Array,
        position: Array,
        rotation: Array,
        slack: Array,
        converged: Array,
    ) -> None:
        """Climb N rays.

        Parameters
        ----------
        legs, low, high : (m, 6), (m,), (m,) arrays
            Points whose distances are bounded, in base and then in platform axes; the bounds.
        size : float
        turns, direction : (k, 3) and (N, 3) arrays
        barriers : (b, 2) array
            Weights, and Newton steps at each of them.
        control : (5,) array
            Backtracks; the greatest step, and its share of the way along the ray; the distance of
            samples; the decrement of a maximum, per weight.
        position, rotation : (N, 3) and (N, 9) arrays
            Strictly feasible poses, replaced by the ends.
        slack, converged : (N, m, 2) and (N,) arrays
            Filled.
        """
        n = 1 + len(turns) + 0 * digest
        longest, share, sample, rest = control[1], control[2], control[3], control[4]
        gradient, step = np.empty(n), np.empty(n)
        hessian, v, work = np.empty((n, n)), np.empty((n, n)), np.empty((3 + n, max(n, 3)))
        new_p, new_r, new_slack = np.empty(3), np.empty(9), np.empty((len(legs), 2))
        on_p, on_r, on_slack = np.empty(3), np.empty(9), np.empty((len(legs), 2))
        for ray in range(len(position)):
            p, r, e, s = position[ray], rotation[ray], direction[ray], slack[ray]
            log, way = _slacks(legs, low, high, size, p, r, s), 0.0
            for row in range(len(barriers)):
                barrier = barriers[row, 0]
                converged[ray] = False
                for _ in range(int(barriers[row, 1])):
                    _derivatives(legs, size, turns, e, p, r, s, barrier, work, gradient, hessian)
                    along = max(longest, share * way)
                    decrement = _descend(hessian, gradient, along, longest, v, step)
                    factor, good, slope = 1.0, False, 0.0
                    for k in range(n):
                        slope -= gradient[k] * step[k]
                    for _ in range(int(control[0])):
                        _move(p, r, e, turns, size, step, factor, new_p, new_r)
                        new = _slacks(legs, low, high, size, new_p, new_r, new_slack)
                        gain = factor * step[0] + barrier * (new - log)
                        # Armijo's condition; at the end of a climb gains are rounding alone.
                        good = gain >= 1e-4 * factor * slope - 1e-15 and _stays(
                            legs, low, high, p, r, e, turns, size, step, factor, sample, way,
                            on_p, on_r, on_slack,
                        )  # fmt: skip
                        if good:
                            _copy(new_p, new_r, new_slack, p, r, s)
                            log = new
                            way += factor * step[0]
                            break
                        factor *= 0.5
                    if not good or not decrement > rest * barrier:
                        converged[ray] = True
                        break

    return climb_points


def _fixed(dimensions: int) -> types.Array:
    return types.Array(types.float64, dimensions, "C", readonly=True)


climb_points = njit(
    types.void(
        _fixed(2),
        _fixed(1),
        _fixed(1),
        types.float64,
        _fixed(2),
        _fixed(2),
        _fixed(2),
        _fixed(1),
        types.float64[:, ::1],
        types.float64[:, ::1],
        types.float64[:, :, ::1],
        types.boolean[::1],
    ),
    error_model="numpy",
    nogil=True,
    cache=True,
)(_climber(checksum_of_code()))
