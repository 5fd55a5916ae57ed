"""Half-spaces of rotation matrices that hold a range of three angles.

Entries of a rotation are bounded where an angle is: a sum n · R m − c of them is not negative on
all of the range. It is linear in R, as squared lengths are, so both are terms of one weighted sum.
"""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array, cross

# Shares of sine and cosine that count as 0: far above their rounding, and far below the share of a
# sum by which its bounds are widened.
FACE_ROUNDING = 1e-14


def within_range(least: Array, most: Array) -> Array:
    """Return the range of angles (2, 3) in which turns stay: no ends for whole turns."""
    whole = most - least >= 2.0 * np.pi
    return np.stack((np.where(whole, -np.inf, least), np.where(whole, np.inf, most)))


def faces_of(turns: Array, least: Array, most: Array, scale: float) -> Array:
    """Return n, m and c of half-spaces n · R m ≥ c that hold a range of angles, shape (f, 7).

    With R = R_1(θ_1) R_2(θ_2) R_3(θ_3) about moving axes a_k, the middle angle is bounded by
    a_1 · R a_3. The first one is the direction of R a_3 about a_1: with the part f(θ_2) of R_2 a_3
    along a_1 × a_2, sin(θ − θ_1) f is an entry of R too, and of one sign if f is. The third one is
    bounded in the same way by the transposed rotation.

    Parameters
    ----------
    turns : (6, 3) array
        The moving axes, and the rotation before them.
    least, most : (3,) arrays [rad]
    scale : float [length]
        Length of n; m is of unit length.
    """
    one, two, three = turns[:3]
    before = turns[3:]
    e, f = cross(one, two), cross(three, two)
    faces = []

    def add(n: Array, m: Array, c: float) -> None:
        faces.append([*(scale * n), *(m @ before), scale * c])

    low, high = _extremes(one @ three, one @ cross(two, three), least[1], most[1])
    if low > -1.0 + FACE_ROUNDING:
        add(one, three, low)
    if high < 1.0 - FACE_ROUNDING:
        add(-one, three, -high)
    for k, axis, start in ((0, one, e), (2, three, f)):
        if most[k] - least[k] > np.pi:
            continue
        # R_2 turns a_3 for the first angle, e_3 for the third one; both sums are a_1 · …
        ends = _extremes(*_part(one, two, three, k), least[1], most[1])
        if ends[0] < -FACE_ROUNDING and ends[1] > FACE_ROUNDING:
            continue
        sign = 1.0 if ends[0] >= -FACE_ROUNDING else -1.0
        for angle, side in ((most[k], sign), (least[k], -sign)):
            across = cross(axis, start)
            if k == 0:
                add(side * (np.sin(angle) * start - np.cos(angle) * across), three, 0.0)
            else:
                add(one, side * (np.sin(angle) * start + np.cos(angle) * across), 0.0)
    return np.array(faces).reshape(-1, 7)


def _part(one: Array, two: Array, three: Array, k: int) -> tuple[float, float]:
    """Factors of cos θ_2 and sin θ_2 in e · R_2 a_3, or in a_1 · R_2 f."""
    if k == 0:
        e = cross(one, two)
        return float(e @ three), float(e @ cross(two, three))
    f = cross(three, two)
    return float(one @ f), float(one @ cross(two, f))


def _extremes(c: float, s: float, least: float, most: float) -> tuple[float, float]:
    """Return the least and the greatest c cos θ + s sin θ of an interval."""
    size, top = np.hypot(c, s), np.arctan2(s, c)
    ends = [c * np.cos(x) + s * np.sin(x) for x in (least, most)]

    def holds(angle: float) -> bool:
        return bool(least + (angle - least) % (2.0 * np.pi) <= most)

    return (
        float(-size if holds(top + np.pi) else min(ends)),
        float(size if holds(top) else max(ends)),
    )
