"""Checks of what a design is made of: points, directions, strokes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import LARGEST_NUMBER, bounded_array
from gsp.checks import check_array, check_items
from gsp.errors import InvalidDesign, InvalidInput, apart, brief, expected
from gsp.geometry.vectors import Array, Mask, frozen, unit

# Lengths from it to LARGEST_NUMBER have squares and inverses that are normal numbers.
LEAST_SIZE = 1.0 / LARGEST_NUMBER


def check_legs(value: Any) -> tuple[Any, ...]:
    """Return the entries of legs, one per leg.

    Raises
    ------
    InvalidDesign
        If it is not a sequence, or a text.
    """
    try:
        return check_items("legs", value, "a sequence with one entry per leg")
    except InvalidInput as error:
        raise InvalidDesign(str(error)) from error


def check_points(what: str, value: ArrayLike, n: int, dimension: int) -> Array:
    """Return n points as a read-only array (n, dimension).

    Raises
    ------
    InvalidInput
        On another shape, or numbers that are not finite.
    """
    return frozen(_table(what, value, n, dimension))


def check_sizes(sides: dict[str, Array]) -> None:
    """Raise InvalidInput if squares of coordinates overflow, or all of them vanish."""
    sizes = {what: float(np.abs(points).max(initial=0.0)) for what, points in sides.items()}
    what = max(sizes, key=lambda side: sizes[side])
    wanted = f"coordinates of at most {LARGEST_NUMBER:g}"
    if 0.0 < sizes[what] < LEAST_SIZE:
        wanted = f"a coordinate of at least {LEAST_SIZE:g}"
    elif sizes[what] <= LARGEST_NUMBER:
        return
    size = apart(sizes[what], LEAST_SIZE, LARGEST_NUMBER)[0]
    raise InvalidInput(expected(what, wanted, f"{size} as the largest in size"))


def check_directions(
    what: str, value: ArrayLike | None, used: Sequence[bool], dimension: int
) -> Array:
    """Return unit directions as a read-only array (n, dimension), NaN where they are not used.

    Raises
    ------
    InvalidDesign
        If a direction that is used is missing, zero or not finite.
    InvalidInput
        On another shape.
    """
    wanted = np.array(used, dtype=bool)
    if value is None and wanted.any():
        where = f"{what}[{int(np.flatnonzero(wanted)[0])}]"
        raise InvalidDesign(expected(where, "a direction, as the leg has a line there", None))
    if value is None:
        return frozen(np.full((len(used), dimension), np.nan))
    rows = _table(what, value, len(used), dimension, finite=False)
    size = np.abs(rows).max(axis=1, keepdims=True, initial=0.0)
    bad = wanted & ~((size[:, 0] > 0.0) & (size[:, 0] < np.inf))
    if bad.any():
        leg = int(np.flatnonzero(bad)[0])
        wish = "a finite direction other than zero, as the leg has a line there"
        raise InvalidDesign(expected(f"{what}[{leg}]", wish, rows[leg].tolist()))
    extreme = (size > LARGEST_NUMBER) | (size < LEAST_SIZE)
    chosen = np.where(wanted[:, None], rows, np.nan)
    with np.errstate(invalid="ignore", divide="ignore"):
        return frozen(unit(np.where(extreme, chosen / size, chosen)))


def check_strokes(value: ArrayLike | None, signed: Mask, what: str = "strokes") -> Array | None:
    """Return least and greatest values of n actuators, (n, 2), or None where none has a limit.

    Parameters
    ----------
    value : (n, 2) array_like or None [length, rad]
    signed : (n,) bool array
        Which actuators may have negative values: angles and drives at the base.
    what : str
        The argument, for messages.

    Raises
    ------
    InvalidDesign
        On another shape, least values above greatest ones, bounds that no value meets, or bounds
        of a distance below zero.
    InvalidInput
        On finite bounds whose squares are not finite.
    """
    if value is None:
        return None
    n = len(signed)
    limits = bounded_array(what, value, (n, 2), finite=False)
    if limits.ndim != 2 or (limits[:, 0] > limits[:, 1]).any():
        wanted = f"shape ({n}, 2) with least ≤ greatest"
        raise InvalidDesign(expected(what, wanted, brief(limits.tolist())))
    without = np.flatnonzero((limits[:, 0] == np.inf) | (limits[:, 1] == -np.inf))
    if without.size:
        wanted = "least < ∞ and greatest > −∞"
        raise InvalidDesign(expected(f"{what}[{without[0]}]", wanted, limits[without[0]].tolist()))
    below = np.flatnonzero(~signed & below_zero(limits))
    if below.size:
        wanted = "bounds ≥ 0, as no distance is negative"
        raise InvalidDesign(expected(f"{what}[{below[0]}]", wanted, limits[below[0]].tolist()))
    return None if np.isnan(limits).all() else frozen(limits)


def below_zero(limits: Array) -> Mask:
    """Return which bounds (..., 2) are below zero; −∞ as the least value is no bound."""
    least, greatest = limits[..., 0], limits[..., 1]
    return np.asarray((greatest < 0.0) | (least < 0.0) & (least > -np.inf))


def open_strokes(strokes: Array | None, n: int) -> Array:
    """Return the strokes of n actuators as bounds (n, 2): ∓inf for NaN, and everywhere for None."""
    return open_bounds(np.full((n, 2), np.nan) if strokes is None else strokes)


def open_bounds(pairs: Array) -> Array:
    """Return pairs (..., 2) of least and greatest values, ∓inf for NaN: no bound."""
    return np.where(np.isnan(pairs), (-np.inf, np.inf), pairs)


def check_bounds(low: Array, high: Array, names: Sequence[str], *, equal: bool = False) -> None:
    """Raise InvalidInput for bounds that no number meets, and for equal ones unless `equal`."""
    wanted = "least ≤ greatest" if equal else "least < greatest"
    for name, least, greatest in zip(names, low, high, strict=True):
        if least == np.inf or greatest == -np.inf:
            got = f"{least:g} and {greatest:g}"
            raise InvalidInput(expected(f"limits of {name}", "least < ∞ and greatest > −∞", got))
        if not (least <= greatest if equal else least < greatest):
            got = " and ".join(apart(least, greatest))
            raise InvalidInput(expected(f"limits of {name}", wanted, got))


def _table(what: str, value: ArrayLike, n: int, dimension: int, *, finite: bool = True) -> Array:
    rows = check_array(what, value, (n, dimension), finite=finite)
    if rows.ndim != 2:
        raise InvalidInput(expected(what, f"shape ({n}, {dimension})", f"shape {rows.shape}"))
    return rows
