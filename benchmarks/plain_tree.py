"""A plain branch and prune, for comparison: octree of positions, balls of rotations.

The range of each length over a ball of rotations is exact, the position adds the radius of its
cell. There is nothing of second order, and no cell uses what its parent found.
"""

from __future__ import annotations

import numpy as np
from numba import njit

INSIDE, OUTSIDE, UNDECIDED = 1, -1, 0
# A rotation cell is halved until its points move by less than this share of the position cell.
SHARE = 0.5


@njit(cache=True)
def rotation_of(face, u):
    """Rotation of a point u of a face of the 4-cube (0 to 3), or of "rpy" angles u (4)."""
    r = np.empty((3, 3))
    if face == 4:
        cr, sr = np.cos(u[0]), np.sin(u[0])
        cp, sp = np.cos(u[1]), np.sin(u[1])
        cy, sy = np.cos(u[2]), np.sin(u[2])
        r[0] = cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr
        r[1] = sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr
        r[2] = -sp, cp * sr, cp * cr
        return r
    q = np.empty(4)
    q[face] = 1.0
    k = 0
    for i in range(4):
        if i != face:
            q[i] = u[k]
            k += 1
    w, x, y, z = q / np.sqrt((q * q).sum())
    r[0] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    r[1] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    r[2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    return r


@njit(cache=True)
def radius_of(face, u, h):
    """Greatest angle of the rotations of a cell from that of its middle."""
    if face == 4:
        return h[0] + h[1] + h[2]
    middle = 1.0 + (u * u).sum()
    least = 1.0
    for corner in range(8):
        dot, square = 1.0, 1.0
        for k in range(3):
            v = u[k] + (h[k] if corner >> k & 1 else -h[k])
            dot += u[k] * v
            square += v * v
        least = min(least, dot / np.sqrt(middle * square))
    return 2.0 * np.arccos(max(-1.0, min(1.0, least)))


@njit(cache=True)
def lengths_in(p, r, rotation, theta, a, b, low, high):
    """Whether the lengths are all within their limits (1), one is beyond (−1), or neither (0)."""
    result = INSIDE
    for i in range(len(a)):
        x = p - a[i]
        turned = rotation @ b[i]
        nx, nb = np.sqrt((x * x).sum()), np.sqrt((turned * turned).sum())
        angle = np.arccos(max(-1.0, min(1.0, (x * turned).sum() / max(nx * nb, 1e-300))))
        nearest, farthest = min(np.pi, angle + theta), max(0.0, angle - theta)
        least = np.sqrt(max(0.0, nx * nx + nb * nb + 2 * nx * nb * np.cos(nearest))) - r
        most = np.sqrt(nx * nx + nb * nb + 2 * nx * nb * np.cos(farthest)) + r
        if least > high[i] or most < low[i]:
            return OUTSIDE
        if least < low[i] or most > high[i]:
            result = UNDECIDED
    return result


@njit(cache=True)
def decide(p, r, roots, every, a, b, low, high, arm, count):
    """Code of a ball of positions: some rotation of the roots, or every one, is feasible."""
    stack = np.empty((4096, 7))
    n = len(roots)
    stack[:n] = roots
    result = INSIDE if every else OUTSIDE
    while n > 0:
        n -= 1
        face, u, h = int(stack[n, 0]), stack[n, 1:4].copy(), stack[n, 4:7].copy()
        rotation, theta = rotation_of(face, u), radius_of(face, u, h)
        count[0] += 1
        code = lengths_in(p, r, rotation, theta, a, b, low, high)
        if code == (INSIDE if every else OUTSIDE):
            continue
        point = lengths_in(p, r, rotation, 0.0, a, b, low, high)
        if point == (OUTSIDE if every else INSIDE):
            return point
        if theta * arm < SHARE * r:
            result = UNDECIDED
            continue
        for corner in range(8):
            stack[n, 0] = face
            for k in range(3):
                stack[n, 1 + k] = u[k] + 0.5 * (h[k] if corner >> k & 1 else -h[k])
                stack[n, 4 + k] = 0.5 * h[k]
            n += 1
    return result


@njit(cache=True)
def bracket(low_corner, high_corner, axes, depth, roots, every, a, b, low, high):
    """Bounds of the measure of the positions (along the given axes), and balls looked at."""
    arm = 0.0
    for i in range(len(b)):
        arm = max(arm, np.sqrt((b[i] * b[i]).sum()))
    count = np.zeros(1, np.int64)
    stack = np.empty((8 * depth + 8, 6))
    levels = np.zeros(8 * depth + 8, np.int64)
    stack[0, :3], stack[0, 3:] = low_corner, high_corner
    n, inside, undecided = 1, 0.0, 0.0
    while n > 0:
        n -= 1
        first, last, level = stack[n, :3].copy(), stack[n, 3:].copy(), levels[n]
        half = 0.5 * (last - first)
        r = np.sqrt((half * half).sum())
        code = decide(first + half, r, roots, every, a, b, low, high, arm, count)
        size = 1.0
        for k in axes:
            size *= last[k] - first[k]
        if code == INSIDE:
            inside += size
        elif code == UNDECIDED and level == depth:
            undecided += size
        elif code == UNDECIDED:
            for corner in range(1 << len(axes)):
                stack[n, :3], stack[n, 3:] = first, last
                for j in range(len(axes)):
                    k = axes[j]
                    if corner >> j & 1:
                        stack[n, k] += half[k]
                    else:
                        stack[n, 3 + k] -= half[k]
                levels[n] = level + 1
                n += 1
    return inside, inside + undecided, count[0]


def all_rotations() -> np.ndarray:
    """Return the four faces of the 4-cube that hold each rotation: rows face, middle, half."""
    return np.array([[face, 0, 0, 0, 1, 1, 1] for face in range(4)], dtype=float)


def rotations_between(least: np.ndarray, most: np.ndarray) -> np.ndarray:
    """Return the one cell of a range of "rpy" angles [rad]."""
    return np.array([[4, *(0.5 * (least + most)), *(0.5 * (most - least))]])
