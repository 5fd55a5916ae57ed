"""Checks of what a design is made of: points, directions, strokes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import LARGEST_NUMBER
from gsp.checks import check_array
from gsp.errors import InvalidDesign, InvalidInput, brief, expected
from gsp.geometry.vectors import Array, frozen, unit

# Lengths whose squares and inverses are normal numbers.
LEAST_SIZE, LARGEST_SIZE = 1.0 / LARGEST_NUMBER, LARGEST_NUMBER


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
    raise InvalidInput(expected(what, wanted, f"{sizes[what]:g} as the largest in size"))


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
    given = np.full((len(used), dimension), np.nan) if value is None else value
    rows = _table(what, given, len(used), dimension, finite=False)
    size = np.abs(rows).max(axis=1, keepdims=True, initial=0.0)
    bad = wanted & ~((size[:, 0] > 0.0) & (size[:, 0] < np.inf))
    if bad.any():
        leg = int(np.flatnonzero(bad)[0])
        wish = "a finite direction other than zero, as the leg has a line there"
        raise InvalidDesign(expected(f"{what}[{leg}]", wish, rows[leg].tolist()))
    extreme = (size > LARGEST_SIZE) | (size < LEAST_SIZE)
    chosen = np.where(wanted[:, None], rows, np.nan)
    with np.errstate(invalid="ignore", divide="ignore"):
        return frozen(unit(np.where(extreme, chosen / size, chosen)))


def check_strokes(value: ArrayLike | None, n: int) -> Array | None:
    """Return least and greatest values of n actuators, (n, 2), or None where none has a limit.

    Raises
    ------
    InvalidDesign
        On another shape, or least values above greatest ones.
    """
    if value is None:
        return None
    limits = check_array("strokes", value, (n, 2), finite=False)
    if limits.ndim != 2 or (limits[:, 0] > limits[:, 1]).any():
        wanted = f"shape ({n}, 2) with least ≤ greatest"
        raise InvalidDesign(expected("strokes", wanted, brief(limits.tolist())))
    return None if np.isnan(limits).all() else frozen(limits)


def open_strokes(strokes: Array | None, n: int) -> Array:
    """Return the strokes of n actuators as bounds (n, 2): ∓inf for NaN, and everywhere for None."""
    return open_bounds(np.full((n, 2), np.nan) if strokes is None else strokes)


def open_bounds(pairs: Array) -> Array:
    """Return pairs (..., 2) of least and greatest values, ∓inf for NaN: no bound."""
    return np.where(np.isnan(pairs), (-np.inf, np.inf), pairs)


def _table(what: str, value: ArrayLike, n: int, dimension: int, *, finite: bool = True) -> Array:
    rows = check_array(what, value, (n, dimension), finite=finite)
    if rows.ndim != 2:
        raise InvalidInput(expected(what, f"shape ({n}, {dimension})", f"shape {rows.shape}"))
    return rows
