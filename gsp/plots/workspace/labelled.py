"""Labelled curves on the boundary of a region in a plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.figures import new_axes, style
from gsp.geometry.vectors import Array
from gsp.plots.common.style import VERMILION
from gsp.plots.workspace.curves import finish_curves, smooth
from gsp.plots.workspace.notes import Note, mark_points, number_note, point_texts, write
from gsp.workspace.labelled import LabelledBoundary

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

# Widths of curves on the boundary and inside of the region [points].
OUTER_WIDTH, INNER_WIDTH = 2.2, 0.7
# Corners of a cell in their order around it: low or high along each axis.
CORNERS_AROUND = ((0, 0), (1, 0), (1, 1), (0, 1))
# What the picture adds to that of the region.
MISSED = "boundary without a curve"


@arguments.validated(
    boundary=arguments.kind(
        LabelledBoundary, "a LabelledBoundary, as gsp.workspace.boundary_curves returns it"
    ),
    interior=arguments.flag,
    labels=arguments.flag,
)
def boundary(
    boundary: LabelledBoundary,
    ax: Axes | None = None,
    *,
    interior: bool = False,
    labels: bool = True,
) -> Axes:
    """Return axes with a region, and the labelled curves on its boundary.

    The region is filled, and what is undecided hatched. Curves are coloured by label, numbered as
    well if there are more than seven labels; those beneath others are named in the entry of those,
    and those beneath dots are left out. Dots are bifurcation points on the boundary, with their
    labels and numbers as in `gsp.plots.workspace.section`. Cells that the boundary passes and no
    curve does are filled in red.

    Parameters
    ----------
    boundary : LabelledBoundary
        As `gsp.workspace.boundary_curves` returns it.
    ax : matplotlib Axes or None
        Default a new figure.
    interior : bool
        Whether to draw, thin, how the curves go on inside of the region.
    labels : bool
        Whether to write the labels of the bifurcation points.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    InvalidInput
        On wrong types.
    MissingSoftware
        Without matplotlib, or shapely.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> plane = ([0, 0, 0], [[1, 0, 0], [0, 0, 1]])
    >>> region = gsp.workspace.fixed_orientation(d, plane=plane, resolution=0.5)
    >>> found = gsp.workspace.boundary_curves(region)
    >>> len(boundary(found).texts) > 0
    True

    *Source: Workspace-3, figures 3.2–3.4, drawn on the region*
    """
    with style():
        ax = boundary.region.plot(new_axes(7.0, 6.0) if ax is None else ax)
        chosen = [
            (curve, outer)
            for curve, outer in zip(boundary.section.curves, boundary.outer, strict=True)
            if outer.any() or interior
        ]
        drawn: dict[str, list[Line2D]] = {}
        for curve, outer in chosen:
            flat = _flat(boundary, curve.pose.position)
            lines = _lines(ax, *smooth(curve, flat, outer), interior)
            drawn.setdefault(curve.label, []).extend(lines)
        points = _points(ax, boundary, chosen)
        styles = finish_curves(ax, drawn, _regions(ax), _missed(ax, boundary))
        notes = points if labels else []
        for curve, outer in chosen:
            if curve.label in styles and outer.any():
                look, flat = styles[curve.label], _flat(boundary, curve.pose.position)
                notes = notes + number_note(look.number, flat[outer], look.colour)
        write(ax, notes)
    return ax


def _regions(ax: Axes) -> dict[str, Any]:
    """Return the entries of the legend of a region: not its outline, on which the curves are."""
    for patch in ax.patches:
        if patch.get_label() == "outline":
            patch.set(linewidth=0.5, zorder=1.5)
    handles, texts = ax.get_legend_handles_labels()
    return {t: h for t, h in zip(texts, handles, strict=True) if t != "outline"}


def _flat(boundary: LabelledBoundary, points: Array) -> Array:
    """Coordinates (N, 2) along the directions of the plane."""
    return np.asarray(boundary.region.problem.inward(points)[..., :2])


def _lines(ax: Axes, flat: Array, thick: Array, interior: bool) -> list[Line2D]:
    """Draw a curve, thick on the boundary, which is the first of the lines that are returned."""
    lines = list(ax.plot(*thick.T, linewidth=OUTER_WIDTH))
    if interior:
        lines += ax.plot(*flat.T, linewidth=INNER_WIDTH, alpha=0.8)
    return lines


def _points(ax: Axes, boundary: LabelledBoundary, chosen: Any) -> list[Note]:
    """Draw the bifurcation points at the ends of curves on the boundary; return their labels."""
    used = {
        end
        for curve, outer in chosen
        for end, there in ((curve.first, outer[0]), (curve.last, outer[-1]))
        if end is not None and there
    }
    numbers = sorted(used)
    points = [boundary.section.bifurcations[number] for number in numbers]
    places = [_flat(boundary, point.pose.position) for point in points]
    return mark_points(ax, places, point_texts(numbers, [point.label for point in points]))


def _missed(ax: Axes, boundary: LabelledBoundary) -> dict[str, Any]:
    """Fill the cells that the boundary passes and no curve does; return their entry, if any."""
    from matplotlib.collections import PolyCollection

    low, high = (x[boundary.missed] for x in (boundary.region.low, boundary.region.high))
    if not len(low):
        return {}
    ends = np.stack((low, high), axis=1)
    corners = np.stack([ends[:, (i, j), (0, 1)] for i, j in CORNERS_AROUND], axis=1)
    cells = PolyCollection(list(corners), facecolor=VERMILION, edgecolor=VERMILION, zorder=2.5)
    return {MISSED: ax.add_collection(cells)}
