"""Compiled climbs: rotations whose least margin is large.

Only import it where it is used: it loads numba.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from gsp.geometry.vectors import Array
from gsp.workspace.sets.compiled.frames import CELL_FRAME_SCALARS, TURNS, frame_of, turn_about
from gsp.workspace.sets.compiled.weights import constraints, weights


@njit(error_model="numpy", nogil=True)
def _least(values: Array, n: int) -> float:
    least = np.inf
    for j in range(n):
        least = min(least, values[j])
    return least


@njit(error_model="numpy", nogil=True)
def _farthest(legs: Array) -> float:
    """Return the largest |b|: no slope of a length is steeper [length/rad]."""
    most = 0.0
    for i in range(len(legs)):
        most = max(most, legs[i, 6])
    return most


@njit(error_model="numpy", nogil=True)
def ascend(
    p: Array,
    nothing: Array,
    legs: Array,
    turns: Array,
    within: Array,
    r: Array,
    first: float,
    steps: int,
    values: Array,
    slopes: Array,
    weight: Array,
    mix: Array,
    new: Array,
    axis: Array,
) -> float:
    """Turn a rotation to where the least constraint at p is large; return that constraint.

    Parameters
    ----------
    nothing : (3,) array
        Zeros.
    turns : (6, 3) array
        As in `Bounded`.
    within : (2, 3) array [rad]
        The range of the angles, which is not left; (0, 3) for all rotations.
    r : (12,) array
        The rotation by rows and its angles, which are not used for all rotations.
    first : float [rad]
        The first step.
    values, slopes, weight, mix, new, axis : arrays
        Overwritten; `new` (12,), `axis` (3,).
    """
    if len(within) == 0:
        return ascend_freely(
            p, nothing, legs, r, first, steps, values, slopes, weight, mix, new, axis
        )
    return ascend_within(
        p, nothing, legs, turns, within, r, first, steps, values, slopes, weight, mix, new
    )


@njit(error_model="numpy", nogil=True)
def ascend_freely(
    p: Array,
    nothing: Array,
    legs: Array,
    r: Array,
    first: float,
    steps: int,
    values: Array,
    slopes: Array,
    weight: Array,
    mix: Array,
    new: Array,
    axis: Array,
) -> float:
    """Climb over all rotations, as in `ascend`.

    Steps of a trust region: each maximises the least of the constraints, taken as linear.
    """
    m = 2 * len(legs)
    constraints(p, nothing, legs, r, 1.0, values, slopes)
    margin, reach, far = _least(values, m), first, _farthest(legs)
    for step in range(steps):
        if reach < 1e-4:
            break
        expected = weights(values, slopes, m, weight, mix, reach, -np.inf, margin, 0.1, step > 0)
        size = np.sqrt(mix[3] ** 2 + mix[4] ** 2 + mix[5] ** 2)
        # At a local maximum the weighted slopes cancel, or no step has a predicted gain.
        if size <= 1e-9 * far or not expected > margin + 1e-4 * abs(margin) + 1e-9 * size:
            break
        for k in range(3):
            axis[k] = mix[3 + k] / size
        turn_about(r, axis, reach, new)
        constraints(p, nothing, legs, new, 1.0, values, slopes)
        found = _least(values, m)
        gain = (found - margin) / (expected - margin)
        if gain > 0.0:
            for k in range(9):
                r[k] = new[k]
            margin = found
        else:  # the arrays hold the rotation that was tried
            constraints(p, nothing, legs, r, 1.0, values, slopes)
        if gain > 0.5:
            reach = min(1.0, 2.0 * reach)
        elif gain < 0.2:
            reach *= 0.3
    return margin


@njit(error_model="numpy", nogil=True)
def place_at(angles: Array, turns: Array, frame: Array) -> None:
    """Write the rotation at three angles and the unit axes about which each of them turns it."""
    frame_of(angles - 1.0, angles + 1.0, turns, frame)


@njit(error_model="numpy", nogil=True)
def weights_within(
    values: Array,
    slopes: Array,
    n: int,
    frame: Array,
    angles: Array,
    within: Array,
    weight: Array,
    mix: Array,
    reach: float,
    floor: float,
    share: float,
    warm: bool,
    held: Array,
) -> float:
    """Write weights as `weights` does, for turns that do not leave a range; return their sum.

    An angle at an end of the range that would be moved beyond it is held, one after the other.

    Parameters
    ----------
    slopes : (≥ n, 6) array
        Those along turns about x, y and z are replaced by those along the angles, 0 if held.
    frame : (CELL_FRAME_SCALARS,) array
        As `place_at` writes it.
    held : (3,) array
        Filled: 1 for an angle that is held, else 0.
    """
    for j in range(n):
        along_angles(slopes[j], frame)
    for k in range(3):
        held[k] = 0.0
        if within[0, k] >= within[1, k]:
            _hold(slopes, n, k, held)
    expected = weights(values, slopes, n, weight, mix, reach, -np.inf, floor, share, warm)
    for _ in range(3):
        most, out = 0.0, -1
        for k in range(3):
            push = mix[3 + k]
            at_end = angles[k] >= within[1, k] if push > 0.0 else angles[k] <= within[0, k]
            if at_end and abs(push) > most:
                most, out = abs(push), k
        if out < 0:
            break
        _hold(slopes, n, out, held)
        expected = weights(values, slopes, n, weight, mix, reach, -np.inf, floor, share, True)
    return expected


@njit(error_model="numpy", nogil=True)
def along_angles(slope: Array, frame: Array) -> None:
    """Replace the slopes (6,) along turns about x, y and z by those along the angles."""
    s0, s1, s2 = slope[3], slope[4], slope[5]
    for k in range(3):
        at = TURNS + 3 * k
        slope[3 + k] = frame[at] * s0 + frame[at + 1] * s1 + frame[at + 2] * s2


@njit(error_model="numpy", nogil=True)
def _hold(slopes: Array, n: int, k: int, held: Array) -> None:
    held[k] = 1.0
    for j in range(n):
        slopes[j, 3 + k] = 0.0


@njit(error_model="numpy", nogil=True)
def ascend_within(
    p: Array,
    nothing: Array,
    legs: Array,
    turns: Array,
    within: Array,
    r: Array,
    first: float,
    steps: int,
    values: Array,
    slopes: Array,
    weight: Array,
    mix: Array,
    new: Array,
) -> float:
    """Climb within a range of angles, as in `ascend`."""
    frame, held, m = np.empty(CELL_FRAME_SCALARS), np.empty(3), 2 * len(legs)
    for k in range(3):
        r[9 + k] = min(within[1, k], max(within[0, k], r[9 + k]))
    place_at(r[9:], turns, frame)
    r[:9] = frame[:9]
    constraints(p, nothing, legs, r, 1.0, values, slopes)
    margin, reach, far = _least(values, m), first, _farthest(legs)
    for step in range(steps):
        if reach < 1e-4:
            break
        expected = weights_within(
            values,
            slopes,
            m,
            frame,
            r[9:],
            within,
            weight,
            mix,
            reach,
            margin,
            0.1,
            step > 0,
            held,
        )
        size = np.sqrt(mix[3] ** 2 + mix[4] ** 2 + mix[5] ** 2)
        if size <= 1e-9 * far or not expected > margin + 1e-4 * abs(margin) + 1e-9 * size:
            break
        clipped = False
        for k in range(3):
            angle = r[9 + k] + reach * mix[3 + k] / size
            new[9 + k] = min(within[1, k], max(within[0, k], angle))
            clipped |= new[9 + k] != angle
        place_at(new[9:], turns, frame)
        new[:9] = frame[:9]
        constraints(p, nothing, legs, new, 1.0, values, slopes)
        found = _least(values, m)
        gain = (found - margin) / (expected - margin)
        if found > margin:
            r[:] = new
            margin = found
        else:
            place_at(r[9:], turns, frame)
            constraints(p, nothing, legs, r, 1.0, values, slopes)
        if gain > 0.5:
            reach = min(1.0, 2.0 * reach)
        elif gain < 0.2 and not (clipped and found > margin):
            reach *= 0.3
    return margin
