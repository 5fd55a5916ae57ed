"""Proven regions on the command line: positions, and orientations at a position."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from gsp.cli.inputs.workspaces import check_place, is_range, orientation_words, vertical_plane
from gsp.cli.outputs.completeness import check_curves, check_reached, share_in
from gsp.cli.outputs.console import between, counted, number, say
from gsp.cli.outputs.pictures import save_picture
from gsp.cli.outputs.samples import Content, IndicesOver, print_sample
from gsp.files.tables import FORMATS, write_table
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.progress import during
from gsp.rounding import rounded_down, rounded_up
from gsp.workspace.sides import Side

if TYPE_CHECKING:
    from gsp.limits import Limits
    from gsp.workspace import LabelledBoundary, Region


@dataclass(frozen=True, kw_only=True)
class Files:
    """What a region is drawn and written to, None for nothing."""

    plot: Path | None
    out: Path | None
    force: bool


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """Which positions a region has.

    Attributes
    ----------
    box : (3, 2) array [°] or None
        Least and greatest angles; None for any orientation.
    order : str
        The angle set.
    some : bool
        Whether some orientation of a range is enough.
    plane : pair (point, angle [°] from the x-axis) or None
        Of a vertical plane, whose point is that of the home pose for None; None for space.
    curves : bool
        Whether labelled curves on the boundary are wanted.
    interior : bool
        Whether those inside of the region are wanted too.
    indices : IndicesOver or None
        Indices over the region that are wanted.
    bounds : str
        The words for the limits, "" for none.
    """

    box: Array | None
    order: str
    some: bool
    plane: tuple[tuple[float, float, float] | None, float] | None
    curves: bool = False
    interior: bool = False
    indices: IndicesOver | None = None
    bounds: str = ""


def positions_of(
    design: Design,
    wanted: Wanted,
    limits: Limits,
    resolution: float | None,
    side: Side,
    files: Files,
) -> None:
    """Print the proven area or volume of positions; draw and write them."""
    held = orientation_words(wanted.box, wanted.order, some=wanted.some)
    region = _positions(design, wanted, limits, resolution, side.half_space)
    what, power = ("Volume", "³") if wanted.plane is None else ("Area", "²")
    unit = f" {design.unit}{power}" if design.unit else ""
    low, high = region.bracket
    said = "; ".join(filter(None, (held, side.name, wanted.bounds)))
    say(f"{what}  {between(low, high)}{unit}, proven; {said}")
    every = wanted.plane is None and is_range(wanted.box) and not wanted.some
    parts = [design.name, held]
    if wanted.plane is not None:
        parts.insert(1, f"vertical plane at {wanted.plane[1]:g}°")
    content = None
    if wanted.curves and region.empty:
        say("no curves: the region is proven empty")
    elif wanted.curves:
        from gsp.workspace import boundary_curves

        boundary = boundary_curves(region, interior=wanted.interior)
        _print_curves(boundary, wanted.interior)
        content = _curves(boundary, wanted.interior)
    if wanted.indices is not None:
        content = print_sample(region, wanted.indices, wanted.order)
    title = "\n".join([*parts, *filter(None, [wanted.bounds])])
    _save(region, files, title, content)
    check_reached(region, resolution, design.unit, aim="dextrous" if every else None)


def _curves(boundary: LabelledBoundary, interior: bool) -> Content:
    from gsp.plots import workspace as plots

    draw = partial(plots.boundary, boundary, interior=interior)
    return Content(table=partial(_points, boundary), draw=draw)


def _print_curves(boundary: LabelledBoundary, interior: bool) -> None:
    """Print the labels on the boundary, and how much of it has none; and those inside."""
    labels: list[str] = []
    inside: list[str] = []
    for curve, outer in zip(boundary.section.curves, boundary.outer, strict=True):
        (labels if outer.any() else inside).append(curve.label)
    _print_labels(labels, "")
    if interior:
        _print_labels(inside, " inside")
    _print_points(boundary)
    missed = int(boundary.missed.sum())
    say(f"{counted(len(labels), 'curve')} on the boundary; {counted(missed, 'cell')} without one")
    check_curves(boundary, len(labels) + missed)


def _print_points(boundary: LabelledBoundary) -> None:
    """Print the labels of bifurcation points of which pictures have the numbers only."""
    from gsp.plots.workspace.notes import is_long

    for i, point in enumerate(boundary.section.bifurcations):
        if is_long(point.label):
            say(f"({i})  bifurcation point [{point.label}]")


def _print_labels(labels: list[str], where: str) -> None:
    for label in sorted(set(labels)):
        say(f"[{label}]  {counted(labels.count(label), 'curve')}{where}")


def _positions(
    design: Design,
    wanted: Wanted,
    limits: Limits,
    resolution: float | None,
    half_space: Array | None,
) -> Region:
    from gsp.geometry.pose import PoseBox
    from gsp.workspace import dextrous, fixed_orientation, reachable

    plane = None
    if wanted.plane is not None:
        place, theta = wanted.plane
        home = (0.0, 0.0, 0.0) if design.home is None else design.home.position
        axes = vertical_plane(theta)
        point = np.asarray(home if place is None else place)
        # Coordinates count from the origin of the base where the plane contains it.
        plane = (point - (point @ axes.T) @ axes, axes)
    box = wanted.box
    where: dict[str, Any] = {"plane": plane, "half_space": half_space, "resolution": resolution}
    if box is None:
        return reachable(design, limits, **where)
    if not is_range(box):
        turn = rotation_from_angles(box[:, 0], wanted.order, degrees=True)
        return fixed_orientation(design, turn, limits, **where)
    angles = PoseBox([0.0, 0.0, 0.0], box.tolist(), degrees=True, order=wanted.order)
    if wanted.some:
        return reachable(design, limits, rotations=angles, **where)
    return dextrous(design, angles, limits, **where)


def orientations_at(
    design: Design,
    position: tuple[float, float, float] | None,
    limits: Limits,
    resolution: float | None,
    bounds: str,
    files: Files,
    indices: IndicesOver | None = None,
) -> None:
    """Print the share of orientations that are feasible at a position; draw and write them."""
    from gsp.workspace import orientations
    from gsp.workspace.sets.tree.boxes import TURNS

    check_place(design, position)
    place = position if position is not None else design.home.position  # type: ignore[union-attr]
    fine = None if resolution is None else float(np.deg2rad(resolution))
    region = orientations(design, place, limits, resolution=fine)
    low, high = region.share
    said = f"; {bounds}" if bounds else ""
    say(f"Orientations  {between(low, high)} of all, proven{said}")
    for name, (first, last) in zip(TURNS, region.extents[1].T, strict=True):
        if not region.empty:
            ends = (rounded_down(np.rad2deg(first), 4), rounded_up(np.rad2deg(last), 4))
            say(f"{name:<6} within {ends[0]:.4g}° … {ends[1]:.4g}°")
    at = f"({', '.join(number(x) for x in place)}) {design.unit}".rstrip()
    title = f"{design.name}\norientations at {at}"
    content = None if indices is None else print_sample(region, indices, "rpy")
    _save(region, files, "\n".join(filter(None, (title, bounds))), content)
    check_reached(region, fine, "°", float(np.rad2deg(1.0)))


def _points(boundary: LabelledBoundary) -> pd.DataFrame:
    """Return the points of all curves, and which of them are on the boundary."""
    outer = np.concatenate([*boundary.outer, np.zeros(0, dtype=np.bool_)])
    return boundary.section.table().assign(boundary=outer)


def _save(region: Region, files: Files, title: str, content: Content | None) -> None:
    if files.out is not None and content is not None and files.out.suffix.lower() in FORMATS:
        write_table(content.table(), files.out, overwrite=files.force)
        say(f"Table      {files.out}")
    elif files.out is not None:
        region.write(files.out, overwrite=files.force)
        say(f"Region     {files.out}{share_in(region, files.out)}")
    if files.plot is not None and region.empty:
        say(f"Picture    {files.plot} is not written: the region is proven empty")
    elif files.plot is not None:
        from gsp.figures import style, wrapped
        from gsp.workspace.sets.shapes.titles import heading

        with during("picture"):
            axes = region.plot() if content is None else content.draw()
        # These lines state what was asked for, in the words of the options.
        rest = axes.get_title().removeprefix(heading(region) + "\n")
        with style():
            axes.set_title(f"{wrapped(title)}\n{rest}", fontsize="medium")
        save_picture(axes, files.plot, overwrite=files.force)
