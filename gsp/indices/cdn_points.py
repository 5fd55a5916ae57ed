"""CDN_3P: the condition number with the velocities of three points of the platform."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.checks import check_array
from gsp.errors import InvalidInput, expected
from gsp.geometry.matrices import reciprocal_condition, singular_values, whiten
from gsp.geometry.vectors import Array, cross, norm, skew
from gsp.indices.record import ALL_SIX, Index, Invariance
from gsp.indices.requirements import require_posture, with_singular_drives
from gsp.indices.spectra import whitened_extremes
from gsp.model.design import Design
from gsp.model.formulas import ZERO
from gsp.model.posture import Posture
from gsp.model.posture.assembled import finite_rows
from gsp.model.posture.slopes import Slopes

# Triangles whose areas differ by less than this share are equally large: above the rounding of
# dimensions that are printed with a few digits.
EQUAL_AREA_SHARE = 1e-9


def condition_number_points(
    posture: Posture, length: float | None = None, points: ArrayLike | None = None
) -> Array:
    """Condition number between actuator speeds and the velocities of three platform points.

    σ_max / σ_min of the map from the nine velocity components of the points, in the space of those
    that rigid motions have, to the actuator speeds.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    length : float or None [unit of the design]
        Weight of A1 actuators, which count with the speed L·θ̇; not used without them.
    points : (3, 3) array_like or None [unit of the design]
        Three points in platform axes, one per row, not on a line. Default the three platform
        anchors that span the largest triangle, and the largest value where several triangles are
        equally large; NaN if all anchors lie on a line.

    Returns
    -------
    (...) array [1]
        In [1, ∞]; inf when singular, NaN where the posture is undefined.

    Raises
    ------
    InvalidInput
        If three given points lie on a line.
    MissingParameter
        If the design has A1 actuators and no length is given.

    *Source: Nawratil, §2.1.2 (concept B), which reviews Kim and Ryu and gives no formula: that the
    nine components are measured by the sum of their squares over rigid motions, as (10) does for
    six points, is ours; so are the default points and legs other than UPS. The value depends on the
    choice of the points.*
    """
    require_posture(posture)
    given = None if points is None else _check_points(points)
    rows = finite_rows(posture, posture.weighted(length))
    in_platform = _turned(rows, posture.pose.rotation)
    least = np.full(posture.shape, np.nan)
    for chosen in largest_triangles(posture.design) if given is None else given[None]:
        values = singular_values(whiten(in_platform, _velocities(chosen)))
        least = np.fmin(least, reciprocal_condition(values))
    with np.errstate(divide="ignore"):
        return with_singular_drives(posture, np.asarray(1.0 / least), np.inf)


def _turned(rows: Array, turn: Array) -> Array:
    """Return rows for twists in platform axes."""
    return np.concatenate((rows[..., :3] @ turn, rows[..., 3:] @ turn), axis=-1)


def _velocities(points: Array) -> Array:
    """Return v + ω × x for each of three points: nine rows for twists in platform axes."""
    return np.concatenate([np.hstack((np.eye(3), -skew(x))) for x in points])


def _slope(slopes: Slopes, length: float | None = None) -> Array:
    """Return the derivative; NaN where several triangles are largest: another one may become it."""
    posture, anchors = slopes.posture, slopes.directions.anchors
    chosen = largest_corners(posture.design)
    if len(chosen) != 1:
        return np.full((*posture.shape, len(anchors)), np.nan)
    corners = chosen[0]
    still = np.zeros((3, 3))
    rates = [
        np.concatenate([np.hstack((still, -skew(x))) for x in one])
        for one in anchors[:, corners, 3:6]
    ]
    turn = posture.pose.rotation
    return whitened_extremes(
        _turned(posture.weighted(length), turn),
        _velocities(posture.design.platform_points[corners]),
        _turned(slopes.weighted(length), turn[..., None, :, :]),
        np.array(rates),
    ).condition


def largest_triangles(design: Design) -> Array:
    """Return the triangles of platform anchors that are as large as the largest, (k, 3, 3).

    Symmetric platforms have several, of which rounding would choose one. None on a line.
    """
    return np.asarray(design.platform_points[largest_corners(design)])


def largest_corners(design: Design) -> NDArray[np.int64]:
    """Return which anchors `largest_triangles` have, (k, 3)."""
    triples = np.array(list(combinations(range(design.n_legs), 3)))
    corners = design.platform_points[triples]
    areas, floors = _areas(corners), _area_floor(corners)
    large = areas >= areas.max() * (1.0 - EQUAL_AREA_SHARE) - floors.max()
    return np.asarray(triples[large & (areas > floors)])


def _areas(corners: Array) -> Array:
    sides = corners[..., 1:, :] - corners[..., :1, :]
    return norm(cross(sides[..., 0, :], sides[..., 1, :])) / 2.0


def _area_floor(corners: Array) -> Array:
    """Return the rounding of the areas: that of the coordinates, times the longest side."""
    sides = norm(corners - np.roll(corners, 1, axis=-2)).max(axis=-1)
    return np.asarray(ZERO * np.abs(corners).max(axis=(-2, -1)) * sides)


def _check_points(value: ArrayLike) -> Array:
    points = check_array("points", value, (3, 3))
    if points.ndim != 2:
        raise InvalidInput(expected("points", "shape (3, 3)", f"shape {points.shape}"))
    if _areas(points) <= _area_floor(points):
        raise InvalidInput(expected("points", "three points not on a line", points.tolist()))
    return points


CONDITION_NUMBER_POINTS = Index(
    name="condition_number_points",
    symbol="CDN_3P",
    function=condition_number_points,
    slope=_slope,
    better="lower",
    best=1.0,
    worst=np.inf,
    parameters=("length",),
    needs=(),
    length_for="angular",
    unit_power="1",
    source="Nawratil, §2.1.2",
    properties=ALL_SIX,
    invariance=Invariance(exchange="changes", slide="changes"),
    routine=False,
)
