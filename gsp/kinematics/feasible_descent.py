"""Descent to the shortest vector with nonnegative functions that starts where they are satisfied.

Every step ends where all functions are defined and satisfied, so that a search that starts at such
a vector never ends without one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gsp.geometry.vectors import Array, norm

Indices = NDArray[np.intp]

# Most steps of a descent, halvings of one of them, and Newton's steps that make it feasible.
DESCENT_STEPS, HALVINGS, CORRECTIONS = 100, 20, 5
# Violation beyond which Newton's steps are not tried [1].
LARGEST_VIOLATION = 1.0
# Part of the decrease to first order that a step must have, and the step at which a descent ends.
LEAST_DECREASE, LAST_STEP = 0.1, 1e-7
# Gauss-Newton steps of a search for a feasible vector.
RESTORING_STEPS = 40
# Lengths of the steps that look for a shorter vector around an end, their least gain, as a share
# of the squared length, and how often the descent may start again from one.
PROBES, LEAST_GAIN, PROBE_ROUNDS = (1e-2, 1e-3), 1e-8, 8
# Most steps of the descent from such a step: where functions are not smooth it does not converge.
PROBE_STEPS = 10
# Values below which a function is active, the rest of x = Gᵀλ at a stationary vector as a share of
# |x|, the step of differences of slopes, and the second derivative below which there are probes.
ACTIVE, STATIONARY, DIFFERENCE, LEAST_BEND = 1e-6, 1e-5, 1e-5, 1e-2


class Functions(NamedTuple):
    """Functions of a vector (6,) that must not be negative.

    Attributes
    ----------
    slacks : x (6,) -> (m,) array
        The functions; hugely negative where one is undefined.
    slopes : x (6,) -> (m, 6) array
        Their derivatives.
    wrapped : x (6,) -> (6,) array
        The shortest vector that is equivalent to x.
    tolerance : float
        By how much a function may be negative.
    """

    slacks: Callable[[Array], Array]
    slopes: Callable[[Array], Array]
    wrapped: Callable[[Array], Array]
    tolerance: float

    def satisfied(self, x: Array) -> bool:
        """Return whether all functions are at least zero, to the tolerance."""
        return bool(np.isfinite(x).all() and self.slacks(x).min() >= -self.tolerance)


def closest(rows: Array, least: Array) -> Array | None:
    """Return the shortest y with rows @ y ≥ least, None without one.

    Parameters
    ----------
    rows : (m, n) array
    least : (m,) array

    Returns
    -------
    (n,) array or None

    *Source: C. L. Lawson and R. J. Hanson, Solving least squares problems, 1974, chapter 23*
    """
    from scipy.optimize import nnls

    solve: Any = nnls
    sizes = norm(rows)
    used = sizes > 0.0
    rows, least = rows[used] / sizes[used, None], least[used] / sizes[used]
    if not (least > 0.0).any():
        return np.zeros(rows.shape[1])
    aim = np.append(np.zeros(rows.shape[1]), 1.0)
    try:
        weights = solve(np.vstack((rows.T, least)), aim)[0]
    except RuntimeError:
        return None
    rest = np.vstack((rows.T, least)) @ weights - aim
    return -rest[:-1] / rest[-1] if rest[-1] < -1e-12 else None


def corrected(of: Functions, x: Array) -> Array | None:
    """Return a feasible vector next to x, by Newton's shortest steps, None without one."""
    before = np.inf
    for _ in range(CORRECTIONS):
        slacks = of.slacks(x)
        least = float(slacks.min())
        if least >= -of.tolerance:
            return x
        # Steps that do not converge fast end far away: a shorter step of the descent is better.
        if least < -LARGEST_VIOLATION or -least > 0.25 * before:
            return None
        bad, before = slacks < -0.01 * of.tolerance, -least
        x = x - np.linalg.lstsq(of.slopes(x)[bad], slacks[bad], rcond=1e-10)[0]
    return x if of.satisfied(x) else None


def restored(of: Functions, x: Array, first: int = 0) -> Array | None:
    """Return a feasible vector that damped Gauss-Newton steps lead to from x, None without one.

    Parameters
    ----------
    of : Functions
    x : (6,) array
    first : int
        How many of the last functions are satisfied first, and kept so: those that decide where
        the others are defined.

    Returns
    -------
    (6,) array or None
    """
    parts = [slice(-first, None)] if first else []
    for part in [*parts, slice(None)]:
        violation = _violation(of, x, part, first)
        for _ in range(RESTORING_STEPS):
            if violation == 0.0:
                break
            slacks = of.slacks(x)[part]
            bad = slacks < 0.0
            step = -np.linalg.lstsq(of.slopes(x)[part][bad], slacks[bad], rcond=1e-6)[0]
            step *= min(1.0, 1.0 / max(float(np.linalg.norm(step)), 1e-300))
            for share in 0.5 ** np.arange(HALVINGS):
                new = _violation(of, x + share * step, part, first)
                if new < (1.0 - 0.1 * share) * violation:
                    break
            else:
                break
            x, violation = x + share * step, new
    return corrected(of, of.wrapped(x))


def _violation(of: Functions, x: Array, part: slice, first: int) -> float:
    slacks = of.slacks(x)
    if part.start is None and first and slacks[-first:].min() < -of.tolerance:
        return float("inf")
    return float(np.linalg.norm(np.minimum(slacks[part], 0.0)))


def descended(of: Functions, x: Array, steps: int = DESCENT_STEPS) -> Array:
    """Return where a descent from a feasible vector ends: feasible, and not longer.

    Each step is that to the shortest vector that satisfies the functions to first order, or a part
    of it, made feasible by Newton's method. There is none where the conditions of Karush, Kuhn and
    Tucker hold.

    Parameters
    ----------
    of : Functions
    x : (6,) array
        Which satisfies them.
    steps : int
        At most.

    Returns
    -------
    (6,) array
    """
    share = 1.0
    for _ in range(steps):
        rows = of.slopes(x)
        shortest = closest(rows, rows @ x - np.maximum(of.slacks(x), 0.0))
        if shortest is None or norm(shortest - x) <= LAST_STEP:
            break
        # The next step is tried at four times the part that the last one had.
        better, share = _step(of, x, shortest - x, min(1.0, 4.0 * share))
        if better is None:
            break
        ended = float(better @ better) > (1.0 - LEAST_GAIN**2) * float(x @ x)
        x = better
        if ended:
            break
    return x


def _step(of: Functions, x: Array, step: Array, most: float) -> tuple[Array | None, float]:
    """Return the end of the longest part of a step that is feasible and shorter, and the part."""
    length = float(x @ x)
    for share in most * 0.5 ** np.arange(HALVINGS):
        end = corrected(of, x + share * step)
        if end is None:
            continue
        end = of.wrapped(end)
        if float(end @ end) < length + LEAST_DECREASE * share * float(x @ step):
            return end, float(share)
    return None, most


def local_minimum(of: Functions, x: Array, finish: Callable[[Array], Array]) -> Array:
    """Return a feasible vector around which probes find no shorter one.

    A descent that does not converge is finished by another search. Where the end is no minimum to
    second order, descents from steps of two lengths look for shorter vectors. So it leaves saddle
    points and ends of slow convergence.

    Parameters
    ----------
    of : Functions
    x : (6,) array
        Which satisfies them.
    finish : x (6,) -> (6,) array
        Search that converges fast near a minimum; its end is taken if that is feasible and shorter.

    Returns
    -------
    (6,) array
    """
    for _ in range(PROBE_ROUNDS):
        x = descended(of, x)
        if not _stationary(of, x)[0]:
            end = corrected(of, finish(x))
            if end is not None and norm(of.wrapped(end)) < norm(x):
                x = of.wrapped(end)
        shorter = _probe(of, x)
        if shorter is None:
            break
        x = shorter
    return x


def _stationary(of: Functions, x: Array) -> tuple[bool, Indices, Array]:
    """Return whether x = Gᵀλ for some λ ≥ 0, which functions have λ > 0, and these λ."""
    from scipy.optimize import nnls

    solve: Any = nnls
    close = np.flatnonzero(of.slacks(x) < ACTIVE)
    rows = of.slopes(x)[close]
    sizes = np.maximum(norm(rows), 1e-300)
    if not len(close):
        return bool(norm(x) <= STATIONARY), close, sizes
    forces, rest = solve((rows / sizes[:, None]).T, x)
    used = forces > 0.0
    weights: Array = (forces / sizes)[used]
    return bool(rest <= STATIONARY * norm(x)), close[used], weights


def _probe(of: Functions, x: Array) -> Array | None:
    """Return a shorter feasible vector near x, None if there is none or the probes find none."""
    ways = _descending(of, x)
    for length in PROBES:
        for way in (*ways, *-ways):
            begin = corrected(of, x + length * way)
            if begin is None:
                continue
            # A step along a surface that curves away leaves it: the descent leads back to it.
            end = descended(of, of.wrapped(begin), PROBE_STEPS)
            if float(end @ end) < (1.0 - LEAST_GAIN) * float(x @ x):
                return end
    return None


def _descending(of: Functions, x: Array) -> Array:
    """Return directions (k, 6) in which vectors may become shorter; none at a strict minimum.

    Where x = Gᵀλ with λ ≥ 0, only directions w with G w = 0 for the functions c of λ > 0 may do so;
    the others increase |x| to first order. Along feasible curves the second derivative of |x|² / 2
    is wᵀ (1 − Σ λ ∇²c) w.
    """
    stationary, active, forces = _stationary(of, x)
    if not stationary:
        mixed = np.random.default_rng(0).normal(size=(12, 6))
        return np.concatenate((np.eye(6), mixed / norm(mixed)[:, None]))
    free = _null_space(of.slopes(x)[active])
    steps = DIFFERENCE * free
    pulls = [(of.slopes(x + s) - of.slopes(x - s))[active].T @ forces for s in steps]
    bend = np.eye(len(free)) - np.reshape(pulls, (-1, 6)) @ free.T / (2.0 * DIFFERENCE)
    sizes, ways = np.linalg.eigh(0.5 * (bend + bend.T))
    return np.asarray(ways.T[sizes < LEAST_BEND] @ free)


def _null_space(rows: Array) -> Array:
    """Return orthonormal w with rows @ w = 0, shape (count, 6)."""
    if not len(rows):
        return np.eye(6)
    _, sizes, ways = np.linalg.svd(rows / np.maximum(norm(rows), 1e-300)[:, None])
    return np.asarray(ways[int((sizes > 1e-9 * sizes[0]).sum()) :])
