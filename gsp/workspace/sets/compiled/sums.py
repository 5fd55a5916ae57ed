"""Compiled bounds of weighted sums of constraints over boxes of positions and balls of rotations.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.kernels.compiled.legs import leg_vectors
from gsp.workspace.sets.compiled.bounds import SQUARE_ROUNDING
from gsp.workspace.sets.compiled.weights import constraints, face_constraints, weights

# λ_max of a symmetric matrix by the trigonometric formula is widened by this share of its norm: it
# loses half of the digits at a double root.
ROOT_ROUNDING = 1e-7
# Numbers of a sum: S with all of the box, the coupling, |α|, κ, slopes along the positions, S in
# the middle, what is of second order; and the entries of a matrix.
SUM_SCALARS, BASE, COUPLING, PULL, BEND, SLOPE, MIDDLE, SECOND, MATRIX = 18, 0, 1, 2, 3, 4, 7, 8, 9


@njit(error_model="numpy", nogil=True)
def _largest_root(m: Array) -> float:
    """Return an upper bound of the largest eigenvalue of the symmetric part of a 3 × 3 matrix."""
    a, b, c = m[0, 0], m[1, 1], m[2, 2]
    d, e, f = 0.5 * (m[0, 1] + m[1, 0]), 0.5 * (m[0, 2] + m[2, 0]), 0.5 * (m[1, 2] + m[2, 1])
    mean = (a + b + c) / 3.0
    a, b, c = a - mean, b - mean, c - mean
    off = d * d + e * e + f * f
    spread = np.sqrt((a * a + b * b + c * c + 2.0 * off) / 6.0)
    norm = abs(mean) + spread
    if spread <= 1e-300:
        return float(mean + ROOT_ROUNDING * norm)
    det = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)
    ratio = min(1.0, max(-1.0, 0.5 * det / (spread * spread * spread)))
    root = mean + 2.0 * spread * np.cos(np.arccos(ratio) / 3.0)
    return float(root + 3.0 * ROOT_ROUNDING * norm)


@njit(error_model="numpy", nogil=True)
def sum_of(
    p: Array,
    h: Array,
    legs: Array,
    faces: Array,
    weight: Array,
    cut: Array,
    r: Array,
    out: Array,
) -> None:
    """Write what bounds a weighted sum over a box of positions, turned from the rotation r.

    Parameters
    ----------
    p, h : (3,) arrays [length]
    faces : (f, 7) array
        As in `gsp.workspace.sets.faces`; empty for all rotations.
    weight : (2 n + 1 + f,) array
        Of the constraints of the legs, of the cut, and of the faces.
    cut : (4,) array
        Only δ with n · δ ≤ c count: n, c. Without weight it is not used.
    r : (≥ 9,) array
    out : (SUM_SCALARS,) array
        Filled.
    """
    middle, mass, scale = 0.0, 0.0, 0.0
    g0, g1, g2, t0, t1, t2, e0, e1, e2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    m = out[MATRIX:].reshape(3, 3)
    m[:, :] = 0.0
    for j in range(2 * len(legs)):
        if weight[j] <= 0.0:
            continue
        i = j // 2
        bound = legs[i, 7 + j % 2]
        u = 0.5 * weight[j] / bound
        a0, a1, a2, r0, r1, r2 = leg_vectors(p, legs[i], r)
        d0, d1, d2 = a0 + r0, a1 + r1, a2 + r2
        reach = abs(a0) + abs(a1) + abs(a2) + legs[i, 6]
        scale += u * (reach * reach + bound * bound)
        if j % 2:
            u = -u
        middle += u * (d0 * d0 + d1 * d1 + d2 * d2 - bound * bound)
        mass += u
        u *= 2.0
        g0, g1, g2 = g0 + u * d0, g1 + u * d1, g2 + u * d2
        e0, e1, e2 = e0 + u * r0, e1 + u * r1, e2 + u * r2
        t0 += u * (r1 * a2 - r2 * a1)
        t1 += u * (r2 * a0 - r0 * a2)
        t2 += u * (r0 * a1 - r1 * a0)
        m[0, 0] += u * r0 * a0
        m[0, 1] += u * r0 * a1
        m[0, 2] += u * r0 * a2
        m[1, 0] += u * r1 * a0
        m[1, 1] += u * r1 * a1
        m[1, 2] += u * r1 * a2
        m[2, 0] += u * r2 * a0
        m[2, 1] += u * r2 * a1
        m[2, 2] += u * r2 * a2
    out[SLOPE], out[SLOPE + 1], out[SLOPE + 2], out[MIDDLE] = g0, g1, g2, middle
    extra = weight[2 * len(legs)]
    if extra > 0.0:
        middle += extra * cut[3]
        g0, g1, g2 = g0 - extra * cut[0], g1 - extra * cut[1], g2 - extra * cut[2]
        scale += extra * (abs(cut[3]) + abs(cut[0]) + abs(cut[1]) + abs(cut[2]))
    for f in range(len(faces)):
        u = weight[2 * len(legs) + 1 + f]
        if u <= 0.0:
            continue
        n0, n1, n2 = u * faces[f, 0], u * faces[f, 1], u * faces[f, 2]
        b0, b1, b2 = faces[f, 3], faces[f, 4], faces[f, 5]
        r0 = r[0] * b0 + r[1] * b1 + r[2] * b2
        r1 = r[3] * b0 + r[4] * b1 + r[5] * b2
        r2 = r[6] * b0 + r[7] * b1 + r[8] * b2
        scale += 3.0 * (abs(n0) + abs(n1) + abs(n2)) + u * abs(faces[f, 6])
        middle += n0 * r0 + n1 * r1 + n2 * r2 - u * faces[f, 6]
        t0 += r1 * n2 - r2 * n1
        t1 += r2 * n0 - r0 * n2
        t2 += r0 * n1 - r1 * n0
        m[0, 0] += r0 * n0
        m[0, 1] += r0 * n1
        m[0, 2] += r0 * n2
        m[1, 0] += r1 * n0
        m[1, 1] += r1 * n1
        m[1, 2] += r1 * n2
        m[2, 0] += r2 * n0
        m[2, 1] += r2 * n1
        m[2, 2] += r2 * n2
    wide = h[0] * h[0] + h[1] * h[1] + h[2] * h[2]
    out[SECOND] = max(0.0, mass) * wide + SQUARE_ROUNDING * (scale + 4.0 * wide)
    out[BASE] = middle + abs(g0) * h[0] + abs(g1) * h[1] + abs(g2) * h[2] + out[SECOND]
    out[COUPLING] = 2.0 * np.sqrt(wide * (e0 * e0 + e1 * e1 + e2 * e2))
    out[PULL] = np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
    out[BEND] = _largest_root(m) - (m[0, 0] + m[1, 1] + m[2, 2])


@njit(error_model="numpy", nogil=True)
def rise(out: Array, x: float) -> float:
    """Return how much a sum rises at most by turns of up to an angle; x is the sine of its half.

    With sin θ = 2 x √(1 − x²) and 1 − cos θ = 2 x². It does not fall as x grows.
    """
    pull, bend = out[PULL], out[BEND]
    total, most = out[COUPLING] * x, np.sqrt(pull * pull + bend * bend)
    if 2.0 * x * x * most >= most + bend:
        return float(total + bend + most)
    return float(total + 2.0 * x * (pull * np.sqrt(max(0.0, 1.0 - x * x)) + bend * x))


@njit(error_model="numpy", nogil=True)
def radius(out: Array) -> float:
    """Return an angle within which a sum is negative: −1 if it is not at 0, π for all rotations."""
    if not out[BASE] < 0.0:
        return -1.0
    if out[BASE] + rise(out, 1.0) < 0.0:
        return float(np.pi)
    low, high = 0.0, 1.0
    for _ in range(10):
        middle = 0.5 * (low + high)
        if out[BASE] + rise(out, middle) < 0.0:
            low = middle
        else:
            high = middle
    return float(2.0 * np.arcsin(low))


@njit(error_model="numpy", nogil=True)
def ball(
    p: Array,
    h: Array,
    legs: Array,
    faces: Array,
    r: Array,
    w: float,
    goal: float,
    cut: Array,
    given: bool,
    values: Array,
    slopes: Array,
    weight: Array,
    mix: Array,
    out: Array,
    warm: bool,
) -> float:
    """Return the angle about the rotation r within which no pose is feasible, −1 if it may be.

    Poses beyond none of the faces count. The weights are chosen for turns by w, and the search for
    them begins with those of `weight` if `warm`: in neighbouring cells they differ little. With
    `given`, only δ with n · δ ≤ c of the box count.
    """
    m = 2 * len(legs)
    constraints(p, h, legs, r, w, values, slopes)
    values[m] = cut[3] if given else np.inf
    for k in range(3):
        slopes[m, k] = -cut[k] * h[k] if given else 0.0
        slopes[m, 3 + k] = 0.0
    face_constraints(faces, r, w, m + 1, values, slopes)
    n = m + 1 + len(faces)
    weights(values, slopes, n, weight, mix, 1.0, goal, 0.0, 0.03, warm)
    sum_of(p, h, legs, faces, weight, cut, r, out)
    return radius(out)
