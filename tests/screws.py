"""An independent derivation of active and passive rates: from the joint screws of each leg.

Nothing here uses `gsp.model`: the feet come from least squares, the joints of a leg are put on its
anchor points and lines, and the rates for a twist of the platform are found by solving
with their six unit screws (of the seven of an SPS leg the idle turn is left out). All of it works
on floats and on arrays of mpmath numbers.
"""

from __future__ import annotations

from types import SimpleNamespace

import mpmath
import numpy as np

CHAINS = {
    "D1": "SPS",
    "D2": "SPC",
    "D3": "CPS",
    "D4": "CCC",
    "A1": "CCC",
    "D4 A1": "CCC",
}


def exact(array):
    """The same numbers, as mpmath numbers."""
    numbers = [mpmath.mpf(x) for x in np.asarray(array).ravel().tolist()]
    return np.array(numbers, dtype=object).reshape(np.shape(array))


def legs_at(design, pose, number=np.asarray):
    """Kind, base anchor and line, platform anchor and line of each leg, in base axes.

    With `number=exact` in mpmath numbers, from the stored ones and with lines of length one.
    """
    p, r = number(pose.position), number(pose.rotation)
    anchors, lines = zip(
        *[
            ((number(a), p + r @ number(b)), (number(s), r @ number(t)))
            for a, s, b, t in zip(
                design.base_points, design.base_directions,
                design.platform_points, design.platform_directions, strict=True,
            )
        ], strict=True,
    )  # fmt: skip
    return [
        (leg.name, a, s / length(s), b, t / length(t))
        for leg, (a, b), (s, t) in zip(design.legs, anchors, lines, strict=True)
    ]


def length(x):
    return mpmath.sqrt(x @ x) if x.dtype == object else np.sqrt(x @ x)


def solve(matrix, right):
    if matrix.dtype != object:
        return np.linalg.solve(matrix, right)
    solution = mpmath.matrix(matrix) ** -1 * mpmath.matrix(right)
    return np.array(solution.tolist()).reshape(right.shape)


def feet(leg):
    """The nearest points of what the leg joins: point or line on the base and on the platform."""
    name, a, s, b, t = leg
    chain, d = CHAINS[name], b - a
    if chain == "SPS":
        return a, b
    if chain == "SPC":
        return a, b - t * (d @ t) / (t @ t)
    if chain == "CPS":
        return a + s * (d @ s) / (s @ s), b
    # Least squares of |d + τ t − σ s|, by its two normal equations.
    normal = np.array([[s @ s, -(s @ t)], [-(s @ t), t @ t]])
    sigma, tau = solve(normal, np.array([[s @ d], [-(t @ d)]]))[:, 0]
    return a + sigma * s, b + tau * t


def revolute(axis, point, origin):
    """Twist (velocity of `origin`, ω) of a unit turn about an axis through a point."""
    return np.concatenate((np.cross(axis, origin - point), axis))


def prismatic(axis):
    return np.concatenate((axis, axis * 0))


def frame(u):
    """Three orthonormal vectors, the first of them u."""
    other = np.eye(3)[np.argmin(np.abs(u.astype(float)))]
    e1 = np.cross(u, other)
    e1 = e1 / length(e1)
    return u, e1, np.cross(u, e1)


def rates(leg, origin):
    """What a twist (velocity of `origin`, ω) makes of a leg.

    Returns a namespace: `active` {constraint: row (6,)}, `from_base` and `from_platform` (3, 6) for
    the rates of the unit vector of the leg seen from there, `slides` (j, 6) of the passive slides.
    """
    name, _, s, _, t = leg
    low, high = feet(leg)
    u = (high - low) / length(high - low)
    _, e1, e2 = frame(u)
    base_turns, platform_turns = {
        "SPS": ((e1, e2), (u, e1, e2)), "SPC": ((u, e1, e2), (t,)),
        "CPS": ((s,), (u, e1, e2)), "CCC": ((s,), (t,)),
    }[CHAINS[name]]  # fmt: skip
    base_slide = [prismatic(s)] if CHAINS[name][0] == "C" else []
    platform_slide = [prismatic(t)] if CHAINS[name][2] == "C" else []
    middle_turn = [revolute(u, low, origin)] if CHAINS[name] == "CCC" else []
    parts = {
        "base turns": [revolute(x, low, origin) for x in base_turns],
        "base slide": base_slide,
        "length": [prismatic(u)],
        "twist": middle_turn,
        "platform turns": [revolute(x, high, origin) for x in platform_turns],
        "platform slide": platform_slide,
    }
    screws = np.array([screw for part in parts.values() for screw in part]).T
    inverse = solve(screws, np.eye(6) * (u[0] * 0 + 1))
    rows, start = {}, 0
    for key, part in parts.items():
        rows[key] = inverse[start : start + len(part)]
        start += len(part)
    active = {}
    if "A1" in name:
        # s goes to t by the middle turn about u; the angle counts up to π only.
        active["A1"] = rows["twist"][0] * (1 if u @ np.cross(s, t) > 0 else -1)
    if name != "A1":
        active[name.split()[0]] = rows["length"][0]
    slides = [*rows["base slide"], *rows["platform slide"]]
    if name == "A1":
        slides += list(rows["length"])
    return SimpleNamespace(
        active=active,
        from_base=sum(
            np.outer(np.cross(x, u), row)
            for x, row in zip(base_turns, rows["base turns"], strict=True)
        ),
        from_platform=-sum(
            np.outer(np.cross(x, u), row)
            for x, row in zip(platform_turns, rows["platform turns"], strict=True)
        ),
        slides=np.array(slides).reshape(-1, 6),
    )
