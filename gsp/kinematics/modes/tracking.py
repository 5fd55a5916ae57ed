"""Compiled tracking of complex poses while the parameters of a design move on a line.

A pose is a complex quaternion x with x · x = 1 and a complex position p; a row of parameters is
(a, b, s, t, k) as in `gsp.kinematics.modes.equations`, and `linearise` has the equations of
`gsp.kinematics.modes.forms` with their derivatives. Only import this module where it is used: it
loads numba.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from zlib import crc32

import numpy as np
from numba import njit, types

import gsp.kernels.compiled  # noqa: F401, which logs the first compilation
from gsp.kinematics.modes import forms
from gsp.kinematics.modes.forms import NUMBER

# Numbers of the equations that `linearise` has, by the constraints; there is no other.
D1, D2, D3, D4, A1 = (NUMBER[name] for name in ("D1", "D2", "D3", "D4", "A1"))
# Ends of a path.
ARRIVED, DIVERGED, STUCK = 0, 1, 2
# First and longest step, as shares of the line; the shortest as a share of what is left of it; and
# what is left where a path is abandoned: its end is a multiple solution, or is on a curve of them.
FIRST_PATH_STEP, LONGEST_PATH_STEP, SHORTEST_STEP_SHARE, GIVEN_UP_SHARE = 0.02, 0.25, 1e-9, 1e-15
# Growth of a step at most, and what a rejected one is multiplied by.
PATH_STEP_GROWTH, PATH_STEP_CUT = 2.0, 0.4
# A step is rejected if the first correction is this many times what was aimed at, or the second
# one more than this share of the first and than rounding explains. That is a share of the pose:
# one divided by the share of the smallest pivot, and one times the square of its size, between
# bounds. Where solutions are near to each other, this keeps a path to its own.
CORRECTION_EXCESS, CORRECTION_DECREASE = 10.0, 0.1
PIVOT_ROUNDING, SQUARES_ROUNDING, LEAST_ROUNDING, LARGEST_ROUNDING = 1e-14, 1e-13, 1e-9, 1e-6
# Size of a pose, quaternion and position together, beyond which its path diverges. Paths pass near
# poles on their way: positions of 1e5 occur in every fifth system of six D1 rows.
DIVERGED_SIZE = 1e8
# Newton steps at the end.
POLISHING_STEPS = 5


@njit(error_model="numpy", nogil=True)
def rotation_of(x, r):  # type: ignore[no-untyped-def]
    """Write the rotation (9,) of a unit quaternion (w, x, y, z)."""
    w, i, j, k = x[0], x[1], x[2], x[3]
    r[0] = w * w + i * i - j * j - k * k
    r[1] = 2.0 * (i * j - w * k)
    r[2] = 2.0 * (i * k + w * j)
    r[3] = 2.0 * (i * j + w * k)
    r[4] = w * w - i * i + j * j - k * k
    r[5] = 2.0 * (j * k - w * i)
    r[6] = 2.0 * (i * k - w * j)
    r[7] = 2.0 * (j * k + w * i)
    r[8] = w * w - i * i - j * j + k * k


@njit(error_model="numpy", nogil=True)
def _turn(r, v0, v1, v2):  # type: ignore[no-untyped-def]
    return (
        r[0] * v0 + r[1] * v1 + r[2] * v2,
        r[3] * v0 + r[4] * v1 + r[5] * v2,
        r[6] * v0 + r[7] * v1 + r[8] * v2,
    )


@njit(error_model="numpy", nogil=True)
def _dot(u, v):  # type: ignore[no-untyped-def]
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@njit(error_model="numpy", nogil=True)
def _cross(u, v):  # type: ignore[no-untyped-def]
    return (
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    )


@njit(error_model="numpy", nogil=True)
def linearise(kinds, here, rates, z, r, m):  # type: ignore[no-untyped-def]
    """Write the rows [∂F/∂v, ∂F/∂ω, F, ∂F/∂τ] of the equations at a pose: m (6, 8).

    A row of an equation that is not defined here is NaN, which ends the path.
    """
    rotation_of(z, r)
    for i in range(6):
        kind = kinds[i]
        q, dq = here[i], rates[i]
        arm = _turn(r, q[3], q[4], q[5])
        darm = _turn(r, dq[3], dq[4], dq[5])
        d = (z[4] + arm[0] - q[0], z[5] + arm[1] - q[1], z[6] + arm[2] - q[2])
        dd = (darm[0] - dq[0], darm[1] - dq[1], darm[2] - dq[2])
        k, dk = q[12], dq[12]
        if kind == D1:
            g = (2.0 * d[0], 2.0 * d[1], 2.0 * d[2])
            mom = _cross(arm, g)
            value, rate = _dot(d, d) - k, _dot(g, dd) - dk
        elif kind == D3:
            s, ds = (q[6], q[7], q[8]), (dq[6], dq[7], dq[8])
            n, dn, e, dsq = _dot(s, s), 2.0 * _dot(s, ds), _dot(d, s), _dot(d, d) - k
            g = (
                2.0 * (n * d[0] - e * s[0]),
                2.0 * (n * d[1] - e * s[1]),
                2.0 * (n * d[2] - e * s[2]),
            )
            mom = _cross(arm, g)
            value = dsq * n - e * e
            rate = _dot(g, dd) + dsq * dn - 2.0 * e * _dot(d, ds) - dk * n
        elif kind == D2:
            t, dt = _turn(r, q[9], q[10], q[11]), _turn(r, dq[9], dq[10], dq[11])
            n, dn, e, dsq = _dot(t, t), 2.0 * _dot(t, dt), _dot(d, t), _dot(d, d) - k
            g = (
                2.0 * (n * d[0] - e * t[0]),
                2.0 * (n * d[1] - e * t[1]),
                2.0 * (n * d[2] - e * t[2]),
            )
            u, v = _cross(arm, g), _cross(t, d)
            mom = (u[0] - 2.0 * e * v[0], u[1] - 2.0 * e * v[1], u[2] - 2.0 * e * v[2])
            value = dsq * n - e * e
            rate = _dot(g, dd) + dsq * dn - 2.0 * e * _dot(d, dt) - dk * n
        else:
            s, ds = (q[6], q[7], q[8]), (dq[6], dq[7], dq[8])
            t, dt = _turn(r, q[9], q[10], q[11]), _turn(r, dq[9], dq[10], dq[11])
            if kind == D4:
                n = _cross(s, t)
                u, v = _cross(ds, t), _cross(s, dt)
                dn = (u[0] + v[0], u[1] + v[1], u[2] + v[2])
                e, nn = _dot(d, n), _dot(n, n)
                g = (2.0 * e * n[0], 2.0 * e * n[1], 2.0 * e * n[2])
                c = (
                    2.0 * (e * d[0] - k * n[0]),
                    2.0 * (e * d[1] - k * n[1]),
                    2.0 * (e * d[2] - k * n[2]),
                )
                u, v = _cross(arm, g), _cross(t, _cross(c, s))
                mom = (u[0] + v[0], u[1] + v[1], u[2] + v[2])
                value = e * e - k * nn
                rate = _dot(g, dd) + _dot(c, dn) - dk * nn
            else:
                zero = 0.0 * k
                g = (zero, zero, zero)
                mom = _cross(t, s)
                value = _dot(s, t) - k
                rate = _dot(ds, t) + _dot(s, dt) - dk
                if kind != A1:
                    value = rate = np.nan + zero
        m[i, 0], m[i, 1], m[i, 2] = g
        m[i, 3], m[i, 4], m[i, 5] = mom
        m[i, 6], m[i, 7] = value, rate


@njit(error_model="numpy", nogil=True)
def _square(c):  # type: ignore[no-untyped-def]
    return c.real * c.real + c.imag * c.imag


@njit(error_model="numpy", nogil=True)
def solve(m):  # type: ignore[no-untyped-def]
    """Replace the last two columns of m (6, 8) by the solutions with the first six; row pivots.

    Returns the smallest pivot as a share of the largest one, 0 if the rows are dependent.
    """
    least, most = np.inf, 0.0
    for j in range(6):
        best, pivot = _square(m[j, j]), j
        for i in range(j + 1, 6):
            size = _square(m[i, j])
            if size > best:
                best, pivot = size, i
        if not best > 0.0:
            return 0.0
        least, most = min(least, best), max(most, best)
        if pivot != j:
            for c in range(j, 8):
                m[j, c], m[pivot, c] = m[pivot, c], m[j, c]
        inverse = complex(m[j, j].real / best, -m[j, j].imag / best)
        for i in range(j + 1, 6):
            f = m[i, j] * inverse
            for c in range(j + 1, 8):
                m[i, c] -= f * m[j, c]
        for c in range(j + 1, 8):
            m[j, c] *= inverse
    for j in range(4, -1, -1):
        for i in range(j + 1, 6):
            m[j, 6] -= m[j, i] * m[i, 6]
            m[j, 7] -= m[j, i] * m[i, 7]
    return np.sqrt(least / most)


@njit(error_model="numpy", nogil=True)
def velocity(z, m, column, v):  # type: ignore[no-untyped-def]
    """Write minus the rate (7,) of a pose whose twist is a column of m."""
    h0, h1, h2 = 0.5 * m[3, column], 0.5 * m[4, column], 0.5 * m[5, column]
    w, i, j, k = z[0], z[1], z[2], z[3]
    v[0] = h0 * i + h1 * j + h2 * k
    v[1] = -(h0 * w + h1 * k - h2 * j)
    v[2] = -(h1 * w + h2 * i - h0 * k)
    v[3] = -(h2 * w + h0 * j - h1 * i)
    for c in range(3):
        v[4 + c] = -m[c, column]


@njit(error_model="numpy", nogil=True)
def normalise(z):  # type: ignore[no-untyped-def]
    """Scale the quaternion of a pose to x · x = 1."""
    n = z[0] * z[0] + z[1] * z[1] + z[2] * z[2] + z[3] * z[3]
    f = 1.0 / np.sqrt(n)
    for c in range(4):
        z[c] *= f


@njit(error_model="numpy", nogil=True)
def square_sum(z):  # type: ignore[no-untyped-def]
    """Return the sum of the squares of the parts of a pose."""
    total = 0.0
    for c in range(7):
        total += _square(z[c])
    return total


def digest_of_code() -> int:
    """Return a checksum of the sources that numba's cache does not check for changes."""
    return crc32(Path(forms.__file__).read_bytes())


def _tracker(digest: int) -> Callable[..., None]:
    """Return the function to compile; numba caches it by the number it encloses."""

    def track_paths(  # type: ignore[no-untyped-def]
        kinds, start, end, poses, tight, most, out, ends, numbers
    ):
        """Follow poses while the parameters move on the line from `start` to `end`.

        A step extrapolates the cubic through the last two points with their tangents, and corrects
        twice. The first correction decides about the next step: its share of the pose grows with
        the fourth power of the step.

        Parameters
        ----------
        kinds : (6,) int array
            Places in `gsp.kinematics.modes.forms.FORMS`.
        start, end : (6, 13) complex arrays
        poses : (n, 7) complex array
            At `start`.
        tight : float
            First correction that a step aims at, as a share of the pose.
        most : int
            Steps of a path at most.
        out : (n, 7) complex array
            Filled with the last pose of each path.
        ends : (n,) int array
            Filled with how each path ended.
        numbers : (n, 3) array
            Filled with the number of steps, the share of the line that was left, and the last
            correction as a share of the pose.
        """
        rates = end - start
        here, r, m = (
            np.empty_like(start),
            np.empty(9, np.complex128),
            np.empty((6, 8), np.complex128),
        )
        z0, v0 = np.empty(7, np.complex128), np.empty(7, np.complex128)
        z1, v1 = np.empty(7, np.complex128), np.empty(7, np.complex128)
        new, dz, dv = (
            np.empty(7, np.complex128),
            np.empty(7, np.complex128),
            np.empty(7, np.complex128),
        )
        for path in range(len(poses) + 0 * digest):
            z1[:] = poses[path]
            linearise(kinds, start, rates, z1, r, m)
            solve(m)
            velocity(z1, m, 7, v1)
            left, last, h, second = 1.0, 0.0, FIRST_PATH_STEP, 0.0
            ends[path], count = STUCK, 0
            while count < most:
                count += 1
                # A rest of a thousandth of a step would cost as much as a whole step.
                if h > left * 0.999:
                    h = left
                if last > 0.0:
                    u = 1.0 + h / last
                    a0, b0 = u * u * (2.0 * u - 3.0) + 1.0, u * (u - 1.0) * (u - 1.0) * last
                    a1, b1 = u * u * (3.0 - 2.0 * u), u * u * (u - 1.0) * last
                    for c in range(7):
                        new[c] = a0 * z0[c] + b0 * v0[c] + a1 * z1[c] + b1 * v1[c]
                else:
                    for c in range(7):
                        new[c] = z1[c] + h * v1[c]
                normalise(new)
                after = 0.0 if h == left else left - h
                for i in range(6):
                    for c in range(13):
                        here[i, c] = end[i, c] - after * rates[i, c]
                scale = np.sqrt(square_sum(z1))
                linearise(kinds, here, rates, new, r, m)
                good = solve(m) > 0.0
                velocity(new, m, 6, dz)
                first = np.sqrt(square_sum(dz)) / scale
                good &= first < CORRECTION_EXCESS * tight
                if good:
                    for c in range(7):
                        new[c] += dz[c]
                    normalise(new)
                    linearise(kinds, here, rates, new, r, m)
                    share = solve(m)
                    velocity(new, m, 6, dz)
                    velocity(new, m, 7, dv)
                    second = np.sqrt(square_sum(dz)) / scale
                    rounding = PIVOT_ROUNDING / share + SQUARES_ROUNDING * scale * scale
                    rounding = min(LEAST_ROUNDING + rounding, LARGEST_ROUNDING)
                    good = second < CORRECTION_DECREASE * first + rounding
                if not good:
                    h *= PATH_STEP_CUT
                    if h < SHORTEST_STEP_SHARE * left or after == left:
                        break
                    continue
                for c in range(7):
                    z0[c], v0[c] = z1[c], v1[c]
                    z1[c], v1[c] = new[c] + dz[c], dv[c]
                normalise(z1)
                last, left = h, after
                if left == 0.0:
                    ends[path] = ARRIVED
                    break
                if square_sum(z1) > DIVERGED_SIZE * DIVERGED_SIZE:
                    ends[path] = DIVERGED
                    break
                if left < GIVEN_UP_SHARE:
                    break
                h = min(
                    h * min(PATH_STEP_GROWTH, 0.9 * (tight / (first + 1e-30)) ** 0.25),
                    LONGEST_PATH_STEP,
                )
            if ends[path] == ARRIVED:
                for _ in range(POLISHING_STEPS):
                    linearise(kinds, end, rates, z1, r, m)
                    solve(m)
                    velocity(z1, m, 6, dz)
                    for c in range(7):
                        z1[c] += dz[c]
                    normalise(z1)
                    second = np.sqrt(square_sum(dz) / square_sum(z1))
                    if second < 1e-15:
                        break
            out[path] = z1
            numbers[path, 0], numbers[path, 1], numbers[path, 2] = count, left, second

    return track_paths


_PARAMETERS = types.Array(types.complex128, 2, "C", readonly=True)
track = njit(
    types.void(
        types.Array(types.int64, 1, "C", readonly=True),
        _PARAMETERS,
        _PARAMETERS,
        _PARAMETERS,
        types.float64,
        types.int64,
        types.complex128[:, ::1],
        types.int64[::1],
        types.float64[:, ::1],
    ),
    error_model="numpy",
    nogil=True,
    cache=True,
)(_tracker(digest_of_code()))


@njit(
    types.void(
        types.Array(types.int64, 1, "C", readonly=True),
        _PARAMETERS,
        types.Array(types.complex128, 2, "C", readonly=True),
        types.complex128[:, :, ::1],
    ),
    error_model="numpy",
    nogil=True,
    cache=True,
)
def derivatives(kinds, parameters, poses, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, 6, 6) with ∂F/∂v and ∂F/∂ω of the equations at poses (n, 7)."""
    rates, r, m = (
        np.zeros_like(parameters),
        np.empty(9, np.complex128),
        np.empty((6, 8), np.complex128),
    )
    for pose in range(len(poses)):
        linearise(kinds, parameters, rates, poses[pose], r, m)
        out[pose] = m[:, :6]
