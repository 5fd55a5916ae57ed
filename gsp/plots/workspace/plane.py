"""Plane sections of workspaces, with labelled curves."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import (
    check_array,
    check_integer,
    check_items,
    check_text,
    check_type,
    is_a,
    reading,
)
from gsp.errors import EmptyWorkspace, InvalidInput, brief, expected
from gsp.figures import INK, name_lengths, style, wrapped, write_title
from gsp.geometry.vectors import Array, cross, norm, unit
from gsp.plots.common.style import GREY, axes_or_new
from gsp.plots.workspace.curves import CurveStyle, finish_curves, smooth
from gsp.plots.workspace.notes import Note, mark_points, number_note, point_texts, write
from gsp.workspace.boundary.sections import Curve, Section
from gsp.workspace.exact.shells import Arc

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

# Side of the figure of a section, and the greatest for many labels [inches]; the number of
# bifurcation points up to which the first is enough.
SECTION_SIDE, GREATEST_SIDE, POINTS_OF_SIDE = 6.4, 10.0, 24
# The same of arcs, and the number of labels up to which the side is enough for the legend.
ARCS_SIDE, LABELS_OF_SIDE = 5.2, 20
# Size of the title, and widths of curves that are a maximum or connect only [points].
TITLE_SIZE, THICK, THIN = 10.0, 2.0, 0.7
# An arc whose ends are nearer than this share of its extent is a circle, without end points.
CLOSED_ARC_SHARE = 1e-9
# Directions of a plane are upright if a vertical has at least this component in it.
UPRIGHT_COMPONENT = 0.01


def section(
    section: Section,
    ax: Axes | None = None,
    *,
    curves: Sequence[int] | None = None,
    axes: ArrayLike | None = None,
    labels: bool = True,
    unit: str = "",
    title: str = "",
) -> Axes:
    """Return axes with the curves of a plane section, coloured by label.

    Thick where a curve is a local maximum along its normal, thin where it only connects. Dots are
    bifurcation points, a cross is the radiating point. Of more labels than seven (the colours),
    curves and entries of the legend are numbered as well. Bifurcation points of one label have
    their number in `Section.bifurcation_table` as well. Those whose labels are longer than 23
    letters have this number only, and of more than 60 points all do. Curves that are beneath others
    throughout are named in the entry of those; beneath dots they are left out. The legend is beside
    the axes or below them, and its last entry counts what has no room.

    Parameters
    ----------
    section : Section
        As `gsp.workspace.section` returns it.
    ax : matplotlib Axes or None
        Default a new figure, larger for many bifurcation points.
    curves : sequence of int or None
        Numbers of the curves to draw; default all.
    axes : (2, 3) array_like or None [1]
        What is drawn to the right and upward: orthogonal unit vectors in base axes. Default the
        plane of the section, with z upward, or y if the plane is horizontal.
    labels : bool
        Whether to write the labels of the bifurcation points.
    unit : str
        Of lengths, for the labels of the axes.
    title : str
        Above the axes. Set afterwards it takes room from the labels, which are placed before.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    EmptyWorkspace
        If the section has no curve.
    InvalidInput
        On wrong types, numbers of no curve, or axes that are not orthogonal unit vectors.
    MissingSoftware
        Without matplotlib.

    *Source: Workspace-3, figures 3.2–3.4, drawn so*
    """
    check_type("section", section, Section, "a section, as gsp.workspace.section returns it")
    if not section.curves:
        raise EmptyWorkspace(expected("section", "a curve or more", "none"))
    chosen = _curves(section, curves)
    frame = _upright(section.axes) if axes is None else _frame(axes)
    if not is_a(labels, bool | np.bool_):
        raise InvalidInput(expected("labels", "True or False", brief(labels)))
    texts = check_text("unit", unit), check_text("title", title)
    with style():
        count = len(_ends(chosen)) if labels else 0
        side = _side(SECTION_SIDE, count / POINTS_OF_SIDE)
        ax = axes_or_new(ax, side, side)
        drawn = _lines(ax, chosen, frame)
        ax.plot(*(section.origin @ frame.T), "+", color=INK, markersize=9)
        notes = _points(ax, section, chosen, frame)
        _name(ax, frame, *texts)
        styles = finish_curves(ax, drawn, after=_widths(chosen))
        write(ax, (notes if labels else []) + _numbers(chosen, frame, styles))
    return ax


def arcs(
    arcs: Iterable[Arc],
    ax: Axes | None = None,
    *,
    axes: ArrayLike | None = None,
    unit: str = "",
    title: str = "",
) -> Axes:
    """Return axes with the arcs of a section of a fixed-orientation workspace, coloured by label.

    Arcs that are beneath others throughout are named in their entry of the legend, as of `section`.

    Parameters
    ----------
    arcs : iterable of Arc
        As `Shells.section` returns them.
    ax : matplotlib Axes or None
        Default a new figure.
    axes : (2, 3) array_like or None [1]
        What is drawn to the right and upward: orthogonal unit vectors in base axes. Default the
        plane of the arcs, with z upward, or y if the plane is horizontal.
    unit : str
        Of lengths, for the labels of the axes.
    title : str
        Above the axes. Set afterwards it takes room from the labels, which are placed before.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    EmptyWorkspace
        If there is no arc.
    InvalidInput
        On wrong types, or axes that are not orthogonal unit vectors.
    MissingSoftware
        Without matplotlib.

    *Source: Workspace-A, figure D.1, drawn so*
    """
    chosen = _arcs(arcs)
    frame = _upright(_spanned(chosen)) if axes is None else _frame(axes)
    texts = check_text("unit", unit), check_text("title", title)
    with style():
        side = _side(ARCS_SIDE, len({arc.label for arc in chosen}) / LABELS_OF_SIDE)
        ax = axes_or_new(ax, side, side)
        drawn: dict[str, list[Line2D]] = {}
        for arc in chosen:
            flat = arc.points @ frame.T
            drawn.setdefault(arc.label, []).extend(ax.plot(*flat.T, linewidth=THICK))
            if norm(flat[-1] - flat[0]) > CLOSED_ARC_SHARE * np.ptp(flat, axis=0).max():
                ax.plot(*flat[[0, -1]].T, "o", color=INK, markersize=3.5)
        _name(ax, frame, *texts)
        styles = finish_curves(ax, drawn)
        write(ax, _numbers(chosen, frame, styles))
    return ax


def _side(least: float, filled: float) -> float:
    """Return the side of a new figure with room for labels that fill the least so many times."""
    return float(np.clip(least * np.sqrt(filled), least, GREATEST_SIDE))


def _curves(section: Section, numbers: Sequence[int] | None) -> list[Curve]:
    """Return the curves with these numbers, all for None."""
    if numbers is None:
        return list(section.curves)
    wanted = f"numbers of curves, 0 to {len(section.curves) - 1}"
    chosen = [
        check_integer("curves", number, least=0)
        for number in check_items("curves", numbers, wanted)
    ]
    with reading("curves", wanted, numbers):
        curves = [section.curves[i] for i in chosen]
    if not curves:
        raise InvalidInput(expected("curves", wanted, "none"))
    return curves


def _arcs(arcs: Iterable[Arc]) -> list[Arc]:
    wanted = "arcs, as Shells.section returns them"
    chosen = list(check_items("arcs", arcs, wanted))
    for arc in chosen:
        check_type("arcs", arc, Arc, wanted)
    if not chosen:
        raise EmptyWorkspace(expected("arcs", "an arc or more", "none"))
    return chosen


def _frame(axes: ArrayLike) -> Array:
    frame = check_array("axes", axes, (2, 3))
    if frame.ndim != 2 or np.abs(frame @ frame.T - np.eye(2)).max() > 1e-6:
        raise InvalidInput(expected("axes", "two orthogonal unit vectors", brief(axes)))
    return frame


def _spanned(arcs: Sequence[Arc]) -> Array:
    """Return orthonormal directions of the plane that arcs lie in, (2, 3)."""
    points = np.concatenate([arc.points for arc in arcs])
    return np.asarray(np.linalg.svd(points - points.mean(axis=0), full_matrices=True)[2][:2])


def _upright(axes: Array) -> Array:
    """Return the directions of a plane to draw right and up: z upward, or y if it is horizontal."""
    vertical = next(v for v in np.eye(3)[[2, 1]] if norm(axes @ v) > UPRIGHT_COMPONENT)
    up = unit((axes @ vertical) @ axes)
    right = cross(up, cross(axes[0], axes[1]))
    right = right * np.sign(right[np.abs(right).argmax()])
    # Rounding aside, so that the coordinates of a section along base axes are unchanged.
    return np.asarray(np.where(np.abs(np.stack((right, up))) < 1e-15, 0.0, np.stack((right, up))))


def _lines(ax: Axes, curves: Sequence[Curve], frame: Array) -> dict[str, list[Line2D]]:
    """Draw curves; return the lines of each label, in turn thick and thin ones."""
    drawn: dict[str, list[Line2D]] = {}
    for curve in curves:
        flat = curve.pose.position @ frame.T
        flat, thick = smooth(curve, flat, curve.maximal)
        lines = drawn.setdefault(curve.label, [])
        thin = ax.plot(*flat.T, linewidth=THIN, alpha=0.7)
        lines += [*ax.plot(*thick.T, linewidth=THICK), *thin]
    return drawn


def _widths(curves: Sequence[Curve]) -> dict[str, Line2D]:
    """Return what the widths of curves mean, if there are two."""
    from matplotlib.lines import Line2D

    if all(curve.maximal.all() for curve in curves):
        return {}
    widths = {"maximum along its normal": THICK, "connects only": THIN}
    return {text: Line2D([], [], color=GREY, linewidth=wide) for text, wide in widths.items()}


def _numbers(
    curves: Sequence[Curve | Arc], frame: Array, styles: dict[str, CurveStyle]
) -> list[Note]:
    """Return the numbers of curves that are seen, to be written beside their middle points."""
    notes = []
    for curve in curves:
        look = styles.get(curve.label)
        points = curve.pose.position if isinstance(curve, Curve) else curve.points
        notes += number_note(look.number, points @ frame.T, look.colour) if look else []
    return notes


def _ends(chosen: Sequence[Curve]) -> list[int]:
    """Return the numbers of the bifurcation points at the ends of curves."""
    return sorted({end for curve in chosen for end in (curve.first, curve.last) if end is not None})


def _points(ax: Axes, section: Section, chosen: Sequence[Curve], frame: Array) -> list[Note]:
    """Draw the bifurcation points at the ends of the curves, and return their labels."""
    numbers = _ends(chosen)
    points = [section.bifurcations[number] for number in numbers]
    texts = point_texts(numbers, [point.label for point in points])
    return mark_points(ax, [point.pose.position @ frame.T for point in points], texts)


def _name(ax: Axes, frame: Array, unit: str, title: str) -> None:
    """Set the title, labels with the unit, and equal scales."""
    ax.set_aspect("equal")
    name_lengths(ax, {axis: _axis_name(v) for axis, v in zip("xy", frame, strict=True)}, unit)
    if title:
        write_title(ax, wrapped(title), fontsize=TITLE_SIZE)
    ax.grid(visible=True)


def _axis_name(direction: Array) -> str:
    for name, axis in zip("xyz", np.eye(3), strict=True):
        if np.allclose(direction, axis):
            return name
    return "along (" + ", ".join(f"{x:.3g}" for x in direction) + ")"
