"""Maps of indices over workspaces: a coloured cell for each node of a grid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from gsp import arguments
from gsp.checks import check_integer, check_type, reading
from gsp.errors import InvalidInput, brief, expected
from gsp.figures import name_coordinates, style, wrapped, write_title
from gsp.geometry.vectors import Array, Mask
from gsp.indices import INDICES
from gsp.plots.common.style import SHORT_NAME, axes_or_new, few_marks
from gsp.plots.common.tables import chosen_indices
from gsp.plots.workspace.cells import INFEASIBLE, draw_sample, explain, fill, hatch, white
from gsp.workspace.maps import IndexMap, cell_edges
from gsp.workspace.sets.inside.samples import IndexSample
from gsp.workspace.sets.inside.worst import Worst
from gsp.workspace.sets.tree.boxes import TURNS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Names of the coordinates of a box; the angles are numbered in angle sets other than "rpy".
POSITIONS, NUMBERED = ("x", "y", "z"), ("angle 1", "angle 2", "angle 3")


def _check_mapped(what: str, mapped: Any) -> IndexMap | IndexSample:
    if not isinstance(mapped, IndexMap | IndexSample):
        wanted = "an IndexMap, as gsp.workspace.index_map returns it, or an IndexSample"
        raise InvalidInput(expected(what, wanted, brief(mapped)))
    return mapped


def _check_worst(what: str, worst: Any) -> Worst | None:
    if worst is not None:
        check_type(what, worst, Worst, "a worst value, as Region.worst returns it, or None")
    return worst  # type: ignore[no-any-return]


@arguments.validated(
    mapped=_check_mapped,
    value=arguments.one_of("worst", "mean"),
    worst=_check_worst,
)
def index_map(
    mapped: IndexMap | IndexSample,
    index: str | None = None,
    over: Sequence[str] | None = None,
    ax: Axes | None = None,
    *,
    at: Mapping[str, int] | None = None,
    value: Literal["worst", "mean"] = "worst",
    worst: Worst | None = None,
) -> Axes:
    """Return axes with an index over two coordinates of a map, dark where it is better.

    Each cell is the part of the box that is nearest to a node. It has the worst value, or the
    mean, of the feasible poses over all other coordinates, where the index is defined; with `at`
    a slice is drawn. White is infeasible; hatched is feasible, but the index is undefined.

    Of a sample of poses of a region, the cells are squares with some twenty poses each. White is
    where no pose was drawn. In a region in a plane they end at its outline, which is that of what
    is proven inside. Of worst values the worst of all poses is marked, and its value is in the
    legend.

    Parameters
    ----------
    mapped : IndexMap or IndexSample
        As `gsp.workspace.index_map` and `Region.index_sample` return them.
    index : str or None
        Name or symbol; default the first index of the map.
    over : two names or None
        Coordinates to the right and upward: x, y, z, roll, pitch, yaw; angles of other angle sets
        are "angle 1" to "angle 3". Default the first two that vary. Of a sample: x, y, z, or u, v
        of a region in a plane, and roll, pitch, yaw; default u and v, x and z, or roll and pitch.
    ax : matplotlib Axes or None
        Default a new figure.
    at : mapping from name to int, or None
        Numbers of the nodes, from 0, of coordinates that are fixed; not of a sample.
    value : "worst" or "mean"
        What a cell shows of several poses; means have the weights `IndexMap.weight`.
    worst : gsp.workspace.Worst or None
        Of the same region and index, as `Region.worst` returns it; marked if it is worse than all
        poses of the sample. Not of an IndexMap.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        If the map has no such index or coordinate, or does not vary along two of them; on other
        types.
    MissingSoftware
        Without matplotlib.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> box = gsp.PoseBox([(-6, 6), 0, (2, 12)], [0, 0, 0])
    >>> found = gsp.workspace.index_map(d, box, (13, 1, 11, 1, 1, 1), ["CTN"], length=7.5)
    >>> index_map(found).get_xlabel()
    'x'
    """
    name = _index(mapped, index)
    if isinstance(mapped, IndexSample):
        if at is not None:
            raise InvalidInput(expected("at", "None for a sample, which has no nodes", brief(at)))
        return draw_sample(mapped, name, over, ax, value, worst)
    if worst is not None:
        raise InvalidInput(expected("worst", "None for an IndexMap", brief(worst)))
    axes = _axes(mapped, over)
    nodes = _nodes(mapped, axes, at)
    values, feasible = _cells(mapped, name, axes, nodes, value)
    with style():
        ax = axes_or_new(ax, 5.4, 4.2)
        _frame(ax, mapped, axes)
        write_title(ax, _title(mapped, axes, nodes, value), loc="left", fontsize=9, wrap=True)
        fill(ax, mapped.design, name, _edges(mapped, axes), values)
        entries = hatch(ax, _edges(mapped, axes), feasible & np.isnan(values))
        explain(ax, [*entries, *white(~feasible, INFEASIBLE)])
    return ax


def _index(mapped: IndexMap | IndexSample, index: str | None) -> str:
    there = list(mapped.values)
    names = chosen_indices(index, there) if isinstance(index, str) else there
    if not (index is None or (isinstance(index, str) and len(names) == 1)):
        raise InvalidInput(expected("index", "the name of one index", brief(index)))
    return names[0]


def _names(mapped: IndexMap) -> tuple[str, ...]:
    return POSITIONS + (TURNS if mapped.box.order == "rpy" else NUMBERED)


def _axes(mapped: IndexMap, over: Sequence[str] | None) -> tuple[int, int]:
    """Return the numbers of the two coordinates that are drawn."""
    names, box = _names(mapped), mapped.box
    vary = [k for k, n in enumerate(mapped.pose.shape) if n > 1 and box.high[k] > box.low[k]]
    if over is None and len(vary) < 2:
        got = ", ".join(names[k] for k in vary) or "none"
        raise InvalidInput(expected("mapped", "a grid that varies in two coordinates", got))
    wanted = "two of " + ", ".join(names[k] for k in vary)
    with reading("over", wanted, over):
        chosen = vary[:2] if over is None else [names.index(name) for name in over]
    if len(chosen) != 2 or chosen[0] == chosen[1] or not {*chosen} <= {*vary}:
        raise InvalidInput(expected("over", wanted, brief(over)))
    return chosen[0], chosen[1]


def _nodes(mapped: IndexMap, axes: tuple[int, int], at: Any) -> dict[int, int]:
    """Return the nodes of the other coordinates that are fixed, by the number of the coordinate."""
    names, shape = _names(mapped), mapped.pose.shape
    others = [name for k, name in enumerate(names) if k not in axes]
    given = {} if at is None else arguments.mapping("at", at)
    for name, node in given.items():
        if name not in others:
            raise InvalidInput(expected("at", "some of " + ", ".join(others), brief(name)))
        count = shape[names.index(name)]
        if check_integer(f"at[{name!r}]", node, least=0) >= count:
            raise InvalidInput(expected(f"at[{name!r}]", f"an integer below {count}", node))
    fixed = {names.index(name): int(node) for name, node in given.items()}
    return {k: 0 for k, n in enumerate(shape) if n == 1 and k not in axes} | fixed


def _cells(
    mapped: IndexMap, name: str, axes: tuple[int, int], nodes: dict[int, int], value: str
) -> tuple[Array, Mask]:
    """Return the values of the cells (n, m), NaN for none, and which have a feasible pose."""

    def rows(grid: Any) -> Any:
        for k, node in nodes.items():
            grid = np.take(grid, [node], axis=k)
        grid = np.moveaxis(grid, axes, (0, 1))
        return grid.reshape(*grid.shape[:2], -1)

    values, feasible, weight = map(rows, (mapped.values[name], mapped.feasible, mapped.weight))
    known = ~np.isnan(values)
    if value == "mean":
        share = np.where(known, weight, 0.0)
        share = share / np.maximum(share.sum(axis=-1, keepdims=True), np.finfo(float).tiny)
        found = (share * np.where(known, values, 0.0)).sum(axis=-1)
    elif INDICES[name].better == "lower":
        found = np.where(known, values, -np.inf).max(axis=-1)
    else:
        found = np.where(known, values, np.inf).min(axis=-1)
    return np.where(known.any(axis=-1), found, np.nan), feasible.any(axis=-1)


def _edges(mapped: IndexMap, axes: tuple[int, int]) -> tuple[Array, Array]:
    """Return where the cells end, angles in degrees."""
    box, shape = mapped.box, mapped.pose.shape
    ends = [cell_edges(box.low[k], box.high[k], shape[k]) for k in axes]
    first, second = (np.rad2deg(x) if k > 2 else x for k, x in zip(axes, ends, strict=True))
    return first, second


def _frame(ax: Axes, mapped: IndexMap, axes: tuple[int, int]) -> None:
    """Set the limits of the axes, their labels, and equal scales of equal units."""
    x, y = _edges(mapped, axes)
    ax.set(xlim=x[[0, -1]], ylim=y[[0, -1]])
    names, turning = [_names(mapped)[k] for k in axes], [k > 2 for k in axes]
    few_marks(ax)
    name_coordinates(ax, names, turning, mapped.design.unit)
    if (axes[0] > 2) == (axes[1] > 2):
        ax.set_aspect("equal")


def _title(mapped: IndexMap, axes: tuple[int, int], nodes: dict[int, int], value: str) -> str:
    """Return the name of the design, the fixed coordinates, and those of which it is the worst.

    Angles that are 0 are left out.
    """
    names, box, shape = _names(mapped), mapped.box, mapped.pose.shape
    fixed = []
    for k, node in sorted(nodes.items()):
        ends = box.low[k], box.high[k]
        place = np.linspace(*ends, shape[k])[node] if shape[k] > 1 else np.mean(ends)
        if k < 3:
            fixed.append(f"{names[k]} = {place:.4g}")
        elif place:
            fixed.append(f"{names[k]} = {np.rad2deg(place):.4g}°")
    others = [name for k, name in enumerate(names) if k not in (*axes, *nodes)]
    of = f"{value} over {', '.join(others)}" if others else ""
    name = wrapped(mapped.design.name)
    rest = "; ".join(text for text in (", ".join(fixed), of) if text)
    # A longer name has its own lines.
    between = "; " if len(name) <= SHORT_NAME else "\n"
    return between.join(text for text in (name, rest) if text)
