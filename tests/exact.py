"""Condition numbers and control numbers in 50 digits, from their definitions.

The rows come from the joint screws of `tests.screws`, and the extreme generalised eigenvalues from
JᵀJ itself, which is harmless with so many digits. `nawratil_matrices` forms the printed matrices of
Nawratil in the printed coordinates: (ω, velocity of the base origin), Plücker moments about it.
"""

from __future__ import annotations

import mpmath
import numpy as np

from tests.screws import exact, legs_at, rates

DIGITS = 50


def skew(x):
    zero = x[0] * 0
    return np.array([[zero, -x[2], x[1]], [x[2], zero, -x[0]], [-x[1], x[0], zero]])


def identity(n):
    return exact(np.eye(n))


def extremes(a, n):
    """Smallest and largest λ of (A − λN) q = 0 for symmetric A and positive definite N."""
    root = mpmath.cholesky(mpmath.matrix(n))
    inverse = root**-1
    values = mpmath.eigsy(inverse * mpmath.matrix(a) * inverse.T, eigvals_only=True)
    return min(values), max(values)


def screw_rates(design, pose):
    return [rates(leg, exact(pose.position)) for leg in legs_at(design, pose, exact)]


def weighted_rows(design, screws, length):
    """Rows of J; those of angles times the length."""
    return np.array(
        [
            screw.active[c.name] * (mpmath.mpf(length) if c.quantity == "angle" else 1)
            for leg, screw in zip(design.legs, screws, strict=True)
            for c in leg.constraints
        ]
    )


def indices(design, pose, length, ellipsoid):
    """CDN_CL, CDN_OE and CTN of one posture, in 50 digits."""
    with mpmath.workdps(DIGITS):
        screws, scale = screw_rates(design, pose), mpmath.mpf(length)
        rows = weighted_rows(design, screws, length)
        homogeneous = rows * np.array([1] * 3 + [1 / scale] * 3)
        metrics = [
            (velocities(pose, ellipsoid), rows, 1),
            (passive(screws, scale), rows, -1),
        ]
        low, high = extremes(homogeneous.T @ homogeneous, identity(6))
        values = [mpmath.sqrt(high / low)]
        for metric, speeds, power in metrics:
            low, high = extremes(metric, speeds.T @ speeds)
            values.append(mpmath.sqrt(high / low) ** power)
        return tuple(values)


def condition(metric, speeds):
    low, high = extremes(metric, speeds.T @ speeds)
    return mpmath.sqrt(high / low)


def least(matrix):
    """Smallest singular value of a matrix whose square is given."""
    return mpmath.sqrt(min(mpmath.eigsy(mpmath.matrix(matrix), eigvals_only=True)))


def inverse(matrix):
    return np.array((mpmath.matrix(matrix) ** -1).tolist())


def reviewed(design, pose, length, corners):
    """The reviewed indices of a design with six actuators, σ_min and |det J|.

    By normal equations, which do no harm with so many digits; `corners` are the three platform
    anchors of CDN_3P.
    """
    with mpmath.workdps(DIGITS):
        screws, one = screw_rates(design, pose), identity(6)
        plain = weighted_rows(design, screws, 1)
        rows = weighted_rows(design, screws, length)
        # v = q̂ − p × ω, with q̂ the velocity of the base origin.
        shift = identity(6)
        shift[:3, 3:] = -skew(exact(pose.position))
        turn = exact(pose.rotation)
        points = [turn @ x for x in exact(design.platform_points)[corners]]
        metric = sum(x.T @ x for x in (np.hstack((one[:3, :3], -skew(x))) for x in points))
        v, w = rows[:, :3], rows[:, 3:]
        scale = np.array([mpmath.mpf(1)] * 3 + [mpmath.mpf(length)] * 3)
        homogeneous = rows / scale
        screw_part = w.T @ w - w.T @ v @ inverse(v.T @ v) @ v.T @ w
        legs = [i for i, leg in enumerate(design.legs) for _ in leg.constraints]
        arms = [turn @ b for b in exact(design.platform_points)[legs]]
        growth = np.array([row[:3] @ arm for row, arm in zip(plain, arms, strict=True)])
        omega = (inverse(plain) @ growth)[3:]
        forces = inverse(homogeneous).T
        compliance = inverse(rows.T @ rows)
        return {
            "condition_number_plain": condition(one, plain @ shift),
            "condition_number_points": condition(metric, rows),
            "complex_deviation_rotation": least(screw_part),
            "complex_deviation_translation": least(v.T @ v),
            "local_conditioning": 1 / condition(one, homogeneous),
            "minimum_singular_value": least(homogeneous.T @ homogeneous),
            "manipulability": abs(mpmath.det(mpmath.matrix(plain))),
            "greatest_force": max(mpmath.sqrt(column @ column) for column in forces),
            "rigidity_rate": mpmath.atan(1 / mpmath.sqrt(omega @ omega)),
            **{f"stiffness_{'xyz'[i]}": 1 / compliance[i, i] for i in range(3)},
        }


def velocities(pose, ellipsoid):
    """D: the sum of the squared speeds of the vertices, for twists at the platform origin."""
    arms = [exact(pose.rotation) @ vertex for vertex in ellipsoid_vertices(ellipsoid)]
    parts = [np.concatenate((identity(3), -skew(arm)), axis=1) for arm in arms]
    return sum(part.T @ part for part in parts)


def passive(screws, length):
    """T: the sum of the squared turns of the legs and of the squared slides over the length."""
    return sum(
        part.T @ part
        for screw in screws
        for part in (screw.from_base, screw.from_platform, screw.slides / length)
        if len(part)
    )


def ellipsoid_vertices(ellipsoid):
    axes, centre, turn = map(exact, (ellipsoid.semi_axes, ellipsoid.center, ellipsoid.rotation))
    return [centre + sign * axes[i] * turn[:, i] for i in range(3) for sign in (1, -1)]


def nawratil_matrices(design, pose, ellipsoid):
    """D, N and T of a design with UPS legs, by the printed equations.

    *Source: Nawratil, eqs. (1), (6), (12), (19), (20), (22); q = (ω, velocity of the origin).*
    """
    p, r = exact(pose.position), exact(pose.rotation)
    d, n, t = (exact(np.zeros((6, 6))) for _ in range(3))
    for vertex in ellipsoid_vertices(ellipsoid):
        s = p + r @ vertex
        big_s = np.array([[0, s[2], -s[1]], [-s[2], 0, s[0]], [s[1], -s[0], 0]])
        top = np.concatenate((big_s.T @ big_s, big_s.T), axis=1)
        d = d + np.concatenate((top, np.concatenate((big_s, identity(3)), axis=1)))
    for base, platform in zip(
        exact(design.base_points), exact(design.platform_points), strict=True
    ):
        b, q = base, p + r @ platform
        line = q - b
        norm = mpmath.sqrt(line @ line)
        row = np.concatenate((np.cross(q, line), line)) / norm
        n = n + np.outer(row, row)
        for point in (q, b):
            velocity = np.concatenate((-skew(point), identity(3)), axis=1)
            t = t + (velocity.T @ velocity - np.outer(row, row)) / norm**2
    return d, n, t
