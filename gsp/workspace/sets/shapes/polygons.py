"""The inside and the possible part of a region in a plane, as polygons."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.geometry.vectors import Array
from gsp.installed import optional
from gsp.workspace.sets.codes import INSIDE

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

# Corners nearer than this share of the size of a region are one: clipped cells share them only to
# rounding.
GRID_SHARE = 1e-10


@dataclass(frozen=True, eq=False, kw_only=True)
class Polygons:
    """The outline of a region in a plane.

    Attributes
    ----------
    inside : shapely Polygon or MultiPolygon [length]
        What is proven inside, with its holes: coordinates along the two directions of the plane.
    possible : shapely Polygon or MultiPolygon [length]
        What is not proven outside.
    """

    inside: BaseGeometry
    possible: BaseGeometry


def polygons(region: Any) -> Polygons:
    """Return the union of the cells of a region in a plane, and of their proven parts."""
    with optional("shapely", "outlines of a region in a plane", "plots"):
        import shapely
    low, high = region.low, region.high
    cells = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
    settled = region.codes == INSIDE
    kept = shapely.intersection(cells, _half_planes(region, region.cuts[:, 4:]))
    left = shapely.intersection(cells, _half_planes(region, region.cuts[:, :4]))
    size = float((high.max(axis=0) - low.min(axis=0)).max()) if len(low) else 1.0

    def union(parts: Any) -> Any:
        return shapely.union_all(parts, grid_size=GRID_SHARE * size)

    return Polygons(
        inside=union(np.where(settled, cells, kept)), possible=union(np.where(settled, cells, left))
    )


def rings(shape: Any) -> list[Array]:
    """Return the closed lines (m, 2) of polygons: outlines, and clockwise those of holes."""
    from shapely.geometry.polygon import orient

    polygons = [
        orient(polygon)
        for polygon in getattr(shape, "geoms", [shape])
        if polygon.geom_type == "Polygon" and not polygon.is_empty
    ]
    return [
        np.asarray(ring.coords)
        for polygon in polygons
        for ring in (polygon.exterior, *polygon.interiors)
    ]


def _half_planes(region: Any, cuts: Array) -> Any:
    """Return, for each cell, a square that covers what of it satisfies n · δ ≥ c."""
    import shapely

    n = cuts[:, :2]
    half = 0.5 * (region.high - region.low)
    middle = 0.5 * (region.high + region.low)
    length = np.hypot(*n.T)
    unit = np.where(length[:, None] > 0.0, n / np.where(length > 0.0, length, 1.0)[:, None], (1, 0))
    size = 4.0 * np.hypot(*half.T)
    with np.errstate(invalid="ignore", divide="ignore"):
        away = cuts[:, 3] / length
    # An infinite c is not a part of the cell, or is all of it.
    away = np.clip(np.where(length > 0.0, away, cuts[:, 3]), -size, size)
    along = np.stack((-unit[:, 1], unit[:, 0]), axis=1)
    foot = middle + away[:, None] * unit
    side, depth = size[:, None] * along, 2.0 * size[:, None] * unit
    corners = (foot - side, foot + side, foot + side + depth, foot - side + depth)
    return shapely.polygons(np.stack(corners, axis=1))
