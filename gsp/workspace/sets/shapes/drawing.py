"""Pictures of regions: in a plane filled, with a bold outline; in space what is proven inside."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.checks import has
from gsp.errors import EmptyWorkspace, InvalidInput, brief, expected
from gsp.figures import (
    name_lengths,
    new_axes,
    require_matplotlib,
    set_space_ticks,
    style,
    write_title,
)
from gsp.geometry.vectors import Array, cross, norm
from gsp.rounding import rounded_down, rounded_up
from gsp.workspace.sets.codes import UNDECIDED
from gsp.workspace.sets.shapes.clipped import corners_beyond
from gsp.workspace.sets.shapes.polygons import GRID_SHARE, Polygons, polygons, rings
from gsp.workspace.sets.shapes.titles import direction_name, heading
from gsp.workspace.sets.surfaces.meshes import surface
from gsp.workspace.sets.tree.boxes import CONVENTION, TURNS

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

FILL, EDGE, HATCH = "#9ecae1", "#08306b", "#777777"
# What is undecided is filled too: in parts that are smaller than the hatch no line of it would be.
OPEN = "#e0e0e0"
OUTLINE: Mapping[str, Any] = MappingProxyType(
    {"facecolor": "none", "edgecolor": EDGE, "linewidth": 1.5}
)
# Half of the width of that line as a share of the size of a region, and what is too small to see.
LINE_SHARE, SLIVER_SHARE = 4e-3, 1e-5
# Lines of a title for which a figure has room.
USUAL_LINES = 5
# Intervals between the texts of the longest axis in space; more of them overlap on the short ones.
MOST_TICKS, DEGREE_STEPS = 6, (1, 1.5, 3, 4.5, 6, 9, 10)
# Distances of a plane from zero below this share of the size of a region come from rounding.
PLANE_ROUNDING = 1e-9


def draw(region: Any, ax: Axes | None) -> Axes:
    """Return axes with a region; those with a title keep it."""
    require_matplotlib()
    if region.empty:
        raise EmptyWorkspace(expected("region", "a cell or more", "an empty region"))
    kind = "rectilinear" if region.kind == "plane" else "3d"
    if ax is not None and not (has(ax, "name") and ax.name == kind):
        wanted = "matplotlib Axes (in space for a region in space), or None"
        raise InvalidInput(expected("ax", wanted, brief(ax)))
    options = {} if region.kind == "plane" else {"projection": "3d"}
    with style():
        ax = new_axes(6.0, 5.4, **options) if ax is None else ax
        measure = _flat(region, ax) if region.kind == "plane" else _solid(region, ax)
        if not ax.get_title():
            lines = f"{heading(region)}\n{measure}"
            write_title(ax, lines, USUAL_LINES, fontsize="medium")
        return ax


def _flat(region: Any, ax: Axes) -> str:
    """Draw a region in a plane; return the line of its area."""
    from matplotlib.patches import PathPatch

    outline = polygons(region)
    undecided = outline.possible.difference(outline.inside)
    looks: tuple[tuple[Any, Mapping[str, Any]], ...] = (
        (undecided, {"facecolor": OPEN, "edgecolor": HATCH, "linewidth": 0.0, "hatch": "//////"}),
        (outline.inside, {"facecolor": FILL, "edgecolor": "none", "linewidth": 0.0}),
        (_outlined(outline), OUTLINE),
    )
    labels = ("undecided", "inside, proven", "outline")
    for (shape, look), label in zip(looks, labels, strict=True):
        path = _path(shape)
        if path is not None:
            ax.add_patch(PathPatch(path, label=label, **look))
    ax.autoscale_view()
    ax.set_aspect("equal")
    name_lengths(ax, dict(zip("xy", plane_labels(region), strict=True)), region.problem.design.unit)
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small")
    return _measure("area", region.area, region.problem.design.unit, "²")


def draw_outline(region: Any, ax: Axes, filled: Iterable[Artist] = ()) -> list[Artist]:
    """Draw the outline of what is proven inside of a region in a plane; return its legend entry.

    `filled` are cut off at the outline; where nothing is proven inside, where the plane is proven
    outside.
    """
    from matplotlib.patches import PathPatch

    outline = polygons(region)
    path, possible = _path(_outlined(outline)), _path(outline.possible)
    end = possible if path is None else path
    for artist in filled if end is not None else ():
        artist.set_clip_path(end, ax.transData)
    if path is None:
        return []
    return [ax.add_patch(PathPatch(path, label="outline of what is proven inside", **OUTLINE))]


def plane_labels(region: Any) -> tuple[str, str]:
    """Return the names of the two coordinates of a region in a plane."""
    size = float(np.ptp(region.domain, axis=0).max())
    first, second = region.problem.frame[:2]
    origin = region.problem.origin
    return _coordinate(first, origin, size), _coordinate(second, origin, size)


def _outlined(outline: Polygons) -> Any:
    """Return what is inside, without gaps that the line of the outline would fill.

    Undecided cells in the midst, and bays of them that are narrower than the line, would be dots
    and spots as wide as it. Holes are kept if a part of them is proven outside.
    """
    import shapely

    ends = shapely.bounds(outline.possible).reshape(2, 2)
    size = float((ends[1] - ends[0]).max())
    # Corners of holes are those of `possible` to rounding only.
    possible = outline.possible.buffer(10.0 * GRID_SHARE * size)
    parts = []
    inside = _without_bays(outline, size)
    for part in getattr(inside, "geoms", [inside]):
        holes = [shapely.Polygon(ring) for ring in part.interiors]
        kept = [hole.exterior for hole in holes if not possible.covers(hole)]
        parts.append(shapely.Polygon(part.exterior, kept))
    return shapely.MultiPolygon(parts)


def _without_bays(outline: Polygons, size: float) -> Any:
    """Return what is inside, and undecided bays that are narrower than the line of the outline."""
    import shapely

    wide = LINE_SHARE * size
    closed = outline.inside.buffer(wide, join_style="mitre").buffer(-wide, join_style="mitre")
    gaps = closed.difference(outline.inside).intersection(outline.possible)
    bays = [gap for gap in getattr(gaps, "geoms", [gaps]) if gap.area > (SLIVER_SHARE * size) ** 2]
    if not bays:
        return outline.inside
    # A little wider, so that rounding leaves no cracks.
    wider = [bay.buffer(SLIVER_SHARE * size, join_style="mitre") for bay in bays]
    return shapely.union_all([outline.inside, *wider])


def _measure(what: str, bounds: tuple[float, float], unit: str, power: str) -> str:
    """Return a title with the bounds of an area or a volume, and its unit if that is known."""
    return f"{what} {_between(*bounds)}" + (f" {unit}{power}" if unit else "")


def _between(low: float, high: float) -> str:
    """Return the words for two proven ends: rounded, they are still true."""
    return f"between {rounded_down(low, 4):.4g} and {rounded_up(high, 4):.4g}"


def _path(shape: Any) -> Any:
    """Return polygons with their holes as one path of matplotlib; None if they are empty."""
    from matplotlib.path import Path

    lines = [Path(ring, closed=True) for ring in rings(shape)]
    return Path.make_compound_path(*lines) if lines else None


def _coordinate(v: Array, origin: Array, size: float) -> str:
    """Name of a coordinate of a plane, which counts from the point by which it was given.

    A distance of that point from zero by rounding only, beside the size of the picture, is zero.
    """
    away, name = float(v @ origin), direction_name(v)
    if abs(away) <= PLANE_ROUNDING * size:
        return name
    return f"{name} {'−' if away > 0.0 else '+'} {abs(away):.4g}"


def _solid(region: Any, ax: Any) -> str:
    """Draw a region in space, or of orientations; return the lines of its measure."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    drawn = _proven(region)
    scale = np.rad2deg(1.0) if region.kind == "orientations" else 1.0
    names = TURNS if region.kind == "orientations" else ("x", "y", "z")
    unit = "°" if region.kind == "orientations" else region.problem.design.unit
    if drawn:
        faces = Poly3DCollection(
            _even(drawn) * scale, facecolors=FILL, edgecolors=EDGE, linewidths=0.15, shade=True
        )
        ax.add_collection3d(faces)
    else:
        ax.text2D(0.5, 0.5, "nothing is proven inside", transform=ax.transAxes, ha="center")
    low, high = _hull(region) * scale
    for k, axis in enumerate("xyz"):
        getattr(ax, f"set_{axis}lim")(low[k], high[k])
    name_lengths(ax, dict(zip("xyz", names, strict=True)), unit)
    sides = np.maximum(high - low, 1e-12)
    ax.set_box_aspect(sides)
    # As many texts as fit beside a short side of the box.
    counts = [max(1, round(MOST_TICKS * side / sides.max())) for side in sides]
    set_space_ticks(ax, counts, DEGREE_STEPS if unit == "°" else None)
    if region.kind == "orientations":
        title = f"{CONVENTION}\n{_between(*region.share)} of all orientations"
    else:
        title = _measure("volume", region.volume, unit, "³")
    return f"{title}\n{_drawn(region)}" if drawn else title


def _proven(region: Any) -> list[Array]:
    """Return the polygons around what is proven inside, those of each number of corners (m, n, 3).

    Of whole cells and of parts of undecided ones: the surface that `Region.mesh` has as triangles.
    """
    found = surface(region)
    return [part for loop in found.loops for part in _corners(found.vertices[loop])]


def _corners(polygons: Array) -> list[Array]:
    """Return polygons (m, n, 3) without vertices on straight sides, and without those of no area.

    Those of each number of corners are one array: some planes pass a corner of a cell to rounding.
    """
    sides = np.roll(polygons, -1, axis=1) - polygons
    areas = norm(cross(np.roll(sides, 1, axis=1), sides))
    kept = areas > 1e-9 * (norm(sides) ** 2).sum(axis=1, keepdims=True)
    count = kept.sum(axis=1)
    chosen = [count == k for k in np.unique(count) if k > 2]
    return [polygons[some][kept[some]].reshape(some.sum(), -1, 3) for some in chosen]


def _even(faces: list[Array]) -> Array:
    """Return faces as one array (m, k, 3): those with fewer vertices repeat some.

    matplotlib fills up faces of different lengths with memory that is not initialised, whose
    numbers may overflow, and shades by the vertices 0, k/3 and 2k/3, which differ here.
    """
    counts = {some.shape[1] for some in faces}
    k = counts.pop() if len(counts) == 1 else -(-max(counts) // 3) * 3
    return np.concatenate([some[:, np.arange(k) * some.shape[1] // k] for some in faces])


def _hull(region: Any) -> Array:
    """Return the least and the greatest coordinates (2, 3) of what is not proven outside."""
    open_ = region.codes == UNDECIDED
    possible = corners_beyond(region.low[open_], region.high[open_], region.cuts[open_, :4])
    points = np.concatenate((possible, region.extents[0]))
    return np.stack((np.nanmin(points, axis=0), np.nanmax(points, axis=0)))


def _drawn(region: Any) -> str:
    """Return a line that states how much of a region in space is drawn, at least."""
    least = np.floor(1000.0 * region.volume[0] / region.volume[1]) / 10.0
    return f"drawn: what is proven inside, at least {least:g} % of it"
