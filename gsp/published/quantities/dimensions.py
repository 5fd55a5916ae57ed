"""Dimensions and poses of published designs, compared with what their sources print.

No other printed number depends on some of them, such as the unit of length or a home pose that the
source names in its text only.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from gsp import catalogue
from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import Array, cross, norm
from gsp.model.units import METRES_PER_UNIT


def _at(side: str, base: Array, platform: Array) -> Array:
    known = {"base": base, "platform": platform}
    if side not in known:
        raise InvalidInput(expected("side", "one of " + ", ".join(known), repr(side)))
    return known[side]


def anchors(design: str, side: str) -> Array:
    """Anchor points of a design, on its "base" or "platform" [unit of the design]: (n, 3)."""
    placed = catalogue.design(design)
    return _at(side, placed.base_points, placed.platform_points)


def line_distances(design: str, side: str, point: Sequence[float]) -> Array:
    """Distances of a point from the lines of the legs on one side [unit of the design]: (n,)."""
    placed = catalogue.design(design)
    directions = _at(side, placed.base_directions, placed.platform_directions)
    return np.asarray(norm(cross(np.asarray(point) - anchors(design, side), directions)))


def directions(design: str, side: str) -> Array:
    """Lines of a design on its "base" or "platform", as unit vectors [1]: (n, 3)."""
    placed = catalogue.design(design)
    return _at(side, placed.base_directions, placed.platform_directions)


def drives(design: str) -> Array:
    """Rod, branch and arm of each drive at the base [unit of the design, 1]: (n, 5); NaN for none.

    Sliders have no arm.
    """
    numbers = [() if d is None else d.numbers for d in catalogue.design(design).drives]
    return np.array([[*given, *[np.nan] * (5 - len(given))] for given in numbers])


def home(design: str) -> Array:
    """Home pose of a design: x, y, z [its unit], roll, pitch, yaw [°]."""
    pose = catalogue.design(design).home
    if pose is None:
        raise InvalidInput(expected("design", "one with a home pose", design))
    return np.concatenate((pose.position, pose.angles(degrees=True)))


def strokes(design: str) -> Array:
    """Strokes of a design [its unit]: (joints, 2)."""
    found = catalogue.design(design).strokes
    if found is None:
        raise InvalidInput(expected("design", "one with strokes", design))
    return found


def semi_axes(design: str) -> Array:
    """Semi-axes of the operation ellipsoid of a design [its unit]: (3,)."""
    found = catalogue.design(design).ellipsoid
    if found is None:
        raise InvalidInput(expected("design", "one with an ellipsoid", design))
    return found.semi_axes


def stated_length(design: str) -> float:
    """Characteristic length of a design [its unit]."""
    found = catalogue.design(design).characteristic_length
    if found is None:
        raise InvalidInput(expected("design", "one with a characteristic length", design))
    return found


def metres(design: str) -> float:
    """Length of the unit of a design [m]."""
    unit = catalogue.design(design).unit
    if unit not in METRES_PER_UNIT:
        raise InvalidInput(expected("design", "one with a unit of length", design))
    return METRES_PER_UNIT[unit]


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        f.__name__: f
        for f in (
            anchors,
            line_distances,
            directions,
            drives,
            home,
            strokes,
            semi_axes,
            stated_length,
            metres,
        )
    }
)
