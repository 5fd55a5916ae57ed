"""Cells with the values of an index, and those of a sample of poses of a region."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.checks import reading
from gsp.errors import InvalidInput, brief, expected
from gsp.figures import name_coordinates, style
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.indices import INDICES
from gsp.model.design import Design
from gsp.plots.common.fields import (
    COLOURS,
    REVERSED,
    draw_cells,
    write_constant,
    write_undrawable,
)
from gsp.plots.common.scales import scale_of
from gsp.plots.common.style import GREY, VERMILION, axes_or_new, symbol_text
from gsp.plots.common.tables import with_unit
from gsp.plots.workspace.legends import below_labels
from gsp.workspace.sets.inside.samples import IndexSample
from gsp.workspace.sets.inside.worst import Worst
from gsp.workspace.sets.shapes.drawing import draw_outline, plane_labels
from gsp.workspace.sets.tree.boxes import TURNS

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

# Angles that differ by less come from rounding [°].
ROUNDING_DEGREES = 1e-9
UNDEFINED, INFEASIBLE, NO_POSE = "feasible, index undefined", "infeasible", "no pose was drawn"
# Share of a cell that is too small to be seen as a white part of the region.
WHITE_SHARE = 0.05
# Poses of a sample per cell, about, and the least and greatest number of cells along a side.
POSES_PER_CELL, CELLS_PER_SIDE = 20, (5, 60)


def fill(ax: Axes, design: Design, name: str, edges: tuple[Array, Array], values: Array) -> None:
    """Fill cells (n, m) between edges with the values of an index."""
    scale = scale_of(values, name)
    if scale is None or scale.constant:
        # One value, which may be infinite, has one colour.
        known = ~np.isnan(values)
        grey = np.ma.masked_array(np.zeros(values.shape), ~known)
        ax.pcolormesh(*edges, grey.T, cmap="Greys", vmin=-1.0, vmax=3.0)
        if scale is None:
            write_undrawable(ax, symbol_text(name), values[known] if known.any() else values)
        else:
            write_constant(ax, values)
    else:
        colours = COLOURS if INDICES[name].better == "higher" else REVERSED
        label = with_unit(name, INDICES[name].unit(design))
        draw_cells(ax, edges, values, scale, label, colours=colours)


def hatch(ax: Axes, edges: tuple[Array, Array], cells: Mask) -> list[Artist]:
    """Hatch cells that are feasible and have no value; return the entry of the legend."""
    from matplotlib.patches import Patch

    if not cells.any():
        return []
    look: dict[str, Any] = {
        "facecolor": "none",
        "edgecolor": GREY,
        "hatch": "////",
        "linewidth": 0.0,
    }
    for i, j in np.argwhere(cells):
        x, y = edges[0][i : i + 2], edges[1][j : j + 2]
        ax.fill([*x, *x[::-1]], np.repeat(y, 2), **look)
    return [Patch(label=UNDEFINED, **look)]


def white(cells: Mask, label: str) -> list[Artist]:
    """Return the entry of the legend for cells that are left white, if there are any."""
    from matplotlib.patches import Patch

    look: dict[str, Any] = {"facecolor": "white", "edgecolor": GREY, "linewidth": 0.6}
    return [Patch(label=label, **look)] if cells.any() else []


def explain(ax: Axes, entries: Sequence[Artist]) -> None:
    """Write a legend below axes, if there is something to explain."""
    if entries:
        place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0)}
        below = below_labels(ax)
        ax.legend(handles=entries, fontsize="small", bbox_transform=below, **place)


def draw_sample(
    sample: IndexSample, name: str, over: Any, ax: Axes | None, value: str, found: Worst | None
) -> Axes:
    """Return axes with an index over two coordinates of a sample of poses."""
    names = _names(sample)
    chosen = _over(names, over)
    unit = sample.region.problem.design.unit
    labels = dict(zip(names, names, strict=True))
    if sample.region.kind == "plane":
        labels |= zip("uv", plane_labels(sample.region), strict=True)
    turning = [name in TURNS for name in chosen]
    points = [_coordinate(sample.region, sample.pose, name) for name in chosen]
    ends = [_ends(sample, *pair) for pair in zip(chosen, points, strict=True)]
    number, equal = sample.pose.size / POSES_PER_CELL, turning[0] == turning[1]
    edges = _edges(ends, number, equal=equal)
    values, feasible = _binned(points, edges, sample.values[name], name, value)
    # As many cells again as were empty, so that those with poses have some twenty each.
    edges = _edges(ends, number / feasible.mean(), equal=equal)
    values, feasible = _binned(points, edges, sample.values[name], name, value)
    with style():
        ax = axes_or_new(ax, 5.8, 4.6)
        ax.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
        name_coordinates(ax, [labels[name] for name in chosen], turning, unit)
        if turning[0] == turning[1]:
            ax.set_aspect("equal")
        title = f"{value} {symbol_text(name)} in each cell, {sample.pose.size} poses"
        ax.set_title(title, fontsize="medium")
        before = {*ax.collections, *ax.patches}
        fill(ax, sample.region.problem.design, name, edges, values)
        entries = hatch(ax, edges, feasible & np.isnan(values))
        empty = ~feasible
        if sorted(chosen) == ["u", "v"] and chosen[0] == "u":
            # The poses are in the region, but squares around them reach beyond it.
            cells = {*ax.collections, *ax.patches} - before
            entries += draw_outline(sample.region, ax, cells)
            empty &= _seen(sample.region, edges)
        entries += white(empty, NO_POSE)
        if value == "worst":
            entries += _mark_worst(ax, sample, name, chosen, found)
        explain(ax, entries)
    return ax


def _seen(region: Any, edges: tuple[Array, Array]) -> Mask:
    """Return of which cells (n, m) more than a sliver is inside of the outline of a region."""
    import shapely

    x, y = edges
    low, high = np.meshgrid(x[:-1], y[:-1], indexing="ij"), np.meshgrid(x[1:], y[1:], indexing="ij")
    boxes = shapely.box(low[0], low[1], high[0], high[1])
    share = shapely.area(shapely.intersection(boxes, region.polygons().inside))
    return np.asarray(share > WHITE_SHARE * shapely.area(boxes))


def _mark_worst(
    ax: Axes, sample: IndexSample, name: str, chosen: tuple[str, str], found: Worst | None
) -> list[Artist]:
    """Mark the pose with the worst value of a sample, or `found` if that is worse."""
    values = sample.values[name]
    if np.isnan(values).all():
        return []
    lower = INDICES[name].better == "lower"
    k = int(np.nanargmax(values) if lower else np.nanargmin(values))
    number, pose = float(values[k]), sample.pose[k]
    if found is not None and (found.value > number if lower else found.value < number):
        number, pose = found.value, found.pose
    place = [_coordinate(sample.region, pose.reshape(1), axis) for axis in chosen]
    # Within the frame, also where poses of a search are beside all that were drawn.
    frame = ax.get_xlim(), ax.get_ylim()
    place = [np.clip(x, min(ends), max(ends)) for x, ends in zip(place, frame, strict=True)]
    words = f"worst found: {number:.4g}"
    look: dict[str, Any] = {"marker": "X", "markersize": 8, "linestyle": "none", "zorder": 4}
    look |= {"markerfacecolor": VERMILION, "markeredgecolor": "white", "clip_on": False}
    return list(ax.plot(*place, label=words, **look))


def _names(sample: IndexSample) -> tuple[str, ...]:
    """Return the coordinates that may be drawn: those of one value only are left out."""
    first = {"plane": ("u", "v"), "orientations": ()}.get(sample.region.kind, ("x", "y", "z"))
    turns = [np.ptp(_coordinate(sample.region, sample.pose, name)) for name in TURNS]
    vary = (name for name, range_ in zip(TURNS, turns, strict=True) if range_ > ROUNDING_DEGREES)
    return (*first, *vary)


def _over(names: tuple[str, ...], over: Any) -> tuple[str, str]:
    """Return the names of the two coordinates that are drawn."""
    wanted = "two of " + ", ".join(names)
    if over is None:
        return (names[0], names[2]) if names[:3] == ("x", "y", "z") else (names[0], names[1])
    with reading("over", wanted, over):
        chosen = tuple(str(name) for name in over)
    if len(chosen) != 2 or chosen[0] == chosen[1] or not {*chosen} <= {*names}:
        raise InvalidInput(expected("over", wanted, brief(over)))
    return chosen[0], chosen[1]


def _coordinate(region: Any, pose: Pose, name: str) -> Array:
    """Return a coordinate of poses (n,) by its name, angles in degrees."""
    if name in TURNS:
        return np.asarray(pose.angles(degrees=True)[:, TURNS.index(name)])
    if name in ("u", "v"):
        return np.asarray(region.problem.inward(pose.position)[:, "uv".index(name)])
    return np.asarray(pose.position[:, "xyz".index(name)])


def _ends(sample: IndexSample, name: str, values: Array) -> tuple[float, float]:
    """Return the ends of a coordinate: those of the region in its plane, else of the poses."""
    if name in ("u", "v"):
        low, high = sample.region.extents[1][:, "uv".index(name)]
        return float(low), float(high)
    return float(values.min()), float(values.max())


def _edges(ends: list[tuple[float, float]], number: float, *, equal: bool) -> tuple[Array, Array]:
    """Return where about as many cells as `number` end; squares of `equal` units."""
    low, high = np.array(ends).T
    side = np.maximum(high - low, np.finfo(float).tiny)
    number = max(number, 1.0)
    counts = np.repeat(np.sqrt(number), 2)
    if equal:
        counts = side / np.sqrt(side.prod() / number)
    first, second = np.clip(np.rint(counts), *CELLS_PER_SIDE).astype(int)
    return np.linspace(low[0], high[0], first + 1), np.linspace(low[1], high[1], second + 1)


def _binned(
    points: list[Array], edges: tuple[Array, Array], values: Array, name: str, value: str
) -> tuple[Array, Mask]:
    """Return the mean or the worst value of each cell, NaN for none, and which have a pose."""
    places = [
        np.clip(np.searchsorted(edge, x, side="right") - 1, 0, len(edge) - 2)
        for edge, x in zip(edges, points, strict=True)
    ]
    shape = len(edges[0]) - 1, len(edges[1]) - 1
    cell, known = np.ravel_multi_index(places, shape), ~np.isnan(values)
    size = shape[0] * shape[1]
    count = np.bincount(cell[known], minlength=size)
    if value == "mean":
        found = np.bincount(cell[known], values[known], size) / np.maximum(count, 1)
    else:
        lower = INDICES[name].better == "lower"
        found = np.full(size, -np.inf if lower else np.inf)
        (np.maximum if lower else np.minimum).at(found, cell[known], values[known])
    found = np.where(count > 0, found, np.nan)
    return found.reshape(shape), (np.bincount(cell, minlength=size) > 0).reshape(shape)
