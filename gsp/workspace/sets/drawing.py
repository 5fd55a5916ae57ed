"""Pictures of regions: filled, with a bold outline, undecided cells hatched."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.errors import EmptyWorkspace, InvalidInput, MissingSoftware, brief, expected
from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import INSIDE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FILL, EDGE, HATCH = "#9ecae1", "#08306b", "#777777"
# Least component of a vertical in a direction for it to be drawn upward [1].
UPRIGHT = 0.01


def draw(region: Any, ax: Axes | None) -> Axes:
    """Return axes with a region."""
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise MissingSoftware("matplotlib", "plots") from error
    if region.empty:
        raise EmptyWorkspace(expected("region", "a cell or more", "an empty region"))
    if ax is not None and getattr(ax, "name", "") != (
        "rectilinear" if region.kind == "plane" else "3d"
    ):
        wanted = "matplotlib Axes (in space for a region in space), or None"
        raise InvalidInput(expected("ax", wanted, brief(ax)))
    if region.kind == "plane":
        ax = pyplot.subplots(figsize=(6.0, 5.4), layout="constrained")[1] if ax is None else ax
        return _flat(region, ax)
    if ax is None:
        figure = pyplot.figure(figsize=(6.0, 5.4), layout="constrained")
        ax = figure.add_subplot(projection="3d")
    return _solid(region, ax)


def _flat(region: Any, ax: Axes) -> Axes:
    from matplotlib.collections import LineCollection, PolyCollection

    inside = region.codes == INSIDE
    open_ = PolyCollection(
        _squares(region.low[~inside], region.high[~inside]),
        facecolor="none",
        edgecolor=HATCH,
        linewidth=0.0,
        hatch="////",
        label="undecided",
    )
    full = PolyCollection(
        _squares(region.low[inside], region.high[inside]),
        facecolor=FILL,
        edgecolor=FILL,
        linewidth=0.3,
        label="inside, proven",
    )
    ax.add_collection(full)
    ax.add_collection(open_)
    ax.add_collection(LineCollection(outline(region), color=EDGE, linewidth=1.8))
    ax.autoscale_view()
    ax.set_aspect("equal")
    names = [_direction(v) for v in region.problem.frame[:2]]
    unit = f" [{region.problem.design.unit}]" if region.problem.design.unit else ""
    ax.set_xlabel(names[0] + unit)
    ax.set_ylabel(names[1] + unit)
    low, high = region.area
    ax.set_title(f"area between {low:.4g} and {high:.4g}", fontsize="medium")
    ax.legend(loc="upper right", fontsize="small", framealpha=0.9)
    return ax


def _direction(v: Array) -> str:
    """Name of a direction: an axis of the base, or its components."""
    k = int(np.argmax(np.abs(v)))
    if abs(abs(v[k]) - 1.0) < 1e-9:
        return ("−" if v[k] < 0.0 else "") + "xyz"[k]
    return "along (" + ", ".join(f"{x:.3g}" for x in v) + ")"


def _squares(low: Array, high: Array) -> Any:
    x0, y0, x1, y1 = low[:, 0], low[:, 1], high[:, 0], high[:, 1]
    corners = [np.stack(pair, axis=1) for pair in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    return np.stack(corners, axis=1)


def outline(region: Any) -> Any:
    """Return the segments, (n, 2, 2), that bound the inside cells of a region in a plane."""
    faces = free_faces(region)
    segments = []
    for k, side, low, high in faces:
        start, end = low.copy(), high.copy()
        end[k] = start[k] = high[k] if side else low[k]
        segments.append((start, end))
    return np.array(segments).reshape(-1, 2, 2)


def free_faces(region: Any) -> list[tuple[int, int, Array, Array]]:
    """Faces of the inside cells that are no face of another: direction, side, cell.

    Cells are divided to the size of the smallest one first.
    """
    inside = region.codes == INSIDE
    low, high = region.low[inside], region.high[inside]
    if not len(low):
        return []
    step = (high - low).min(axis=0)
    start = low.min(axis=0)
    first = np.rint((low - start) / step).astype(np.int64)
    last = np.rint((high - start) / step).astype(np.int64)
    grid = np.zeros(last.max(axis=0) + 2, dtype=np.bool_)
    for a, b in zip(first, last, strict=True):
        grid[tuple(slice(i + 1, j + 1) for i, j in zip(a, b, strict=True))] = True
    grid = np.pad(grid, [(0, 1)] * grid.ndim)
    faces = []
    for k in range(grid.ndim):
        for side in (0, 1):
            other = np.roll(grid, -1 if side else 1, axis=k)
            for cell in np.argwhere(grid & ~other):
                corner = start + (cell - 1) * step
                faces.append((k, side, corner, corner + step))
    return faces


def _solid(region: Any, ax: Any) -> Axes:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    quads = surface(region)
    scale = np.rad2deg(1.0) if region.kind == "orientations" else 1.0
    names = ("α", "β", "γ") if region.kind == "orientations" else ("x", "y", "z")
    unit = "°" if region.kind == "orientations" else region.problem.design.unit
    if len(quads):
        faces = Poly3DCollection(
            quads * scale, facecolors=FILL, edgecolors=EDGE, linewidths=0.15, shade=True
        )
        ax.add_collection3d(faces)
    low, high = region._hull(region.codes >= 0) * scale
    for k, name in enumerate(names):
        getattr(ax, f"set_{'xyz'[k]}lim")(low[k], high[k])
        getattr(ax, f"set_{'xyz'[k]}label")(name + (f" [{unit}]" if unit else ""))
    ax.set_box_aspect(np.maximum(high - low, 1e-12))
    least, most = region.volume
    ax.set_title(f"volume between {least:.4g} and {most:.4g}", fontsize="medium")
    return ax  # type: ignore[no-any-return]


def surface(region: Any) -> Array:
    """Return the outer faces of the inside cells, as quadrangles (n, 4, 3)."""
    quads = []
    for k, side, low, high in free_faces(region):
        i, j = (k + 1) % 3, (k + 2) % 3
        corners = np.empty((4, 3))
        corners[:, k] = high[k] if side else low[k]
        corners[:, i] = [low[i], high[i], high[i], low[i]]
        corners[:, j] = [low[j], low[j], high[j], high[j]]
        quads.append(corners if side else corners[::-1])
    return np.array(quads).reshape(-1, 4, 3)
