"""Proven regions on the command line: positions, and orientations at a position."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from gsp.cli.inputs.workspaces import check_place, is_range, orientation_words, vertical_plane
from gsp.cli.outputs.completeness import check_reached, share_in
from gsp.cli.outputs.console import counted, number, say, warn
from gsp.cli.outputs.pictures import save_picture
from gsp.errors import InvalidInput, brief, expected
from gsp.files.tables import FORMATS, write_table
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array, cross, norm, perpendicular
from gsp.model.design import Design

if TYPE_CHECKING:
    from gsp.limits import Limits
    from gsp.workspace import LabelledBoundary, Region
    from gsp.workspace.volumes import Volume

# Base anchors are in one plane if their distances from it are this share of those in it. A normal
# that is as near to an axis is that axis.
LEVEL = 1e-9


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
    bounds : str
        The words for the limits, "" for none.
    """

    box: Array | None
    order: str
    some: bool
    plane: tuple[tuple[float, float, float] | None, float] | None
    curves: bool = False
    interior: bool = False
    bounds: str = ""


@dataclass(frozen=True, kw_only=True)
class Side:
    """The part of space that counts, and how the line of the volume names it.

    Attributes
    ----------
    half_space : (4,) array [1, 1, 1, length] or None
        n and c: positions with n · p ≥ c, where n has length 1; None for all.
    """

    half_space: Array | None = None
    name: str = "all positions"

    def volume(self, design: Design, rotation: Array, limits: Limits) -> Volume:
        """Return the volume on this side that SPS legs reach with one orientation."""
        from gsp.workspace import exact_shells

        if self.half_space is None:
            return exact_shells(design, rotation, limits).volume()
        # Volumes between heights are exact, so the normal is turned to the z-axis.
        turn = _turned_up(self.half_space[:3])
        turned = design.replace(base_points=design.base_points @ turn.T)
        least = float(self.half_space[3])
        return exact_shells(turned, turn @ rotation, limits).volume((least, np.inf))


def side_of_home(design: Design, both: bool) -> Side:
    """Return the side of a plane base on which the home pose is; with `both` there is none.

    A plane platform has the same lengths of legs at mirror images in the plane of the base, which
    are assembled in another way. The plane is that of the base anchors, in any position.

    Raises
    ------
    InvalidInput
        For `both`, if all positions count anyway.
    """
    side = _side(design)
    if not both:
        return side
    if side.half_space is None:
        wanted = "a home pose on one side of a plane of the base anchors, else it has no effect"
        place = f"of design {brief(design.name)}" if design.name else ""
        got = "no home pose" if design.home is None else "no such side"
        raise InvalidInput(expected("--both", wanted, got, place))
    return Side(name="both sides of the base")


def _side(design: Design) -> Side:
    if design.home is None:
        return Side()
    points = design.base_points
    centre = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - centre)
    home = np.ravel(design.home.position) - centre
    above = float(home @ axes[2])
    flat = sizes[2] <= LEVEL * sizes[0] < sizes[1]
    if not flat or abs(above) <= LEVEL * max(sizes[0], float(norm(home))):
        return Side()
    normal = np.sign(above) * axes[2]
    k = int(np.abs(normal).argmax())
    if norm(np.delete(normal, k)) > LEVEL:
        least = float(normal @ centre)
        name = "on the side of the plane of the base on which the home pose is"
        return Side(half_space=np.array([*normal, least]), name=name)
    normal = np.sign(normal[k]) * np.eye(3)[k]
    level = float(points[:, k].mean())
    word = "above" if normal[k] > 0.0 else "below"
    return Side(
        half_space=np.array([*normal, normal[k] * level]),
        name=f"{word} {'xyz'[k]} = {level:.6g}, the side of the home pose",
    )


def _turned_up(normal: Array) -> Array:
    """Return a rotation that turns a direction of length 1 to the z-axis."""
    if normal[2] == 1.0:
        return np.eye(3)
    across = perpendicular(normal)
    return np.stack((across, cross(normal, across), normal))


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
    say(f"{what}  between {number(low)} and {number(high)}{unit}, proven; {said}")
    every = wanted.plane is None and is_range(wanted.box) and not wanted.some
    check_reached(region, resolution, design.unit, aim="dextrous" if every else None)
    parts = [design.name, held]
    if wanted.plane is not None:
        parts.insert(1, f"vertical plane at {wanted.plane[1]:g}°")
    boundary = None
    if wanted.curves and region.empty:
        say("no curves: the region is proven empty")
    elif wanted.curves:
        from gsp.workspace import boundary_curves

        boundary = boundary_curves(region, interior=wanted.interior)
        _print_curves(boundary, wanted.interior)
    title = "\n".join([*parts, *filter(None, [wanted.bounds])])
    _save(region, files, title, boundary, wanted.interior)


def _print_curves(boundary: LabelledBoundary, interior: bool) -> None:
    """Print the labels on the boundary, and how much of it has none; and those inside."""
    labels: list[str] = []
    inside: list[str] = []
    for curve, outer in zip(boundary.section.curves, boundary.outer, strict=True):
        (labels if outer.any() else inside).append(curve.label)
    _print_labels(labels, "")
    if interior:
        _print_labels(inside, " inside")
    missed = int(boundary.missed.sum())
    say(f"{counted(len(labels), 'curve')} on the boundary; {counted(missed, 'cell')} without one")
    if left := len(boundary.incomplete) + boundary.waiting:
        warn(f"{counted(left, 'curve')} not followed to an end")


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
    say(f"Orientations  between {number(low)} and {number(high)} of all, proven{said}")
    for name, (first, last) in zip(TURNS, region.extents[1].T, strict=True):
        if not region.empty:
            say(f"{name:<6} within {np.rad2deg(first):.4g}° … {np.rad2deg(last):.4g}°")
    check_reached(region, fine, "°", float(np.rad2deg(1.0)))
    at = f"({', '.join(number(x) for x in place)}) {design.unit}".rstrip()
    title = f"{design.name}\norientations at {at}"
    _save(region, files, "\n".join(filter(None, (title, bounds))))


def _points(boundary: LabelledBoundary) -> pd.DataFrame:
    """Return the points of all curves, and which of them are on the boundary."""
    outer = np.concatenate([*boundary.outer, np.zeros(0, dtype=np.bool_)])
    return boundary.section.table().assign(boundary=outer)


def _save(
    region: Region,
    files: Files,
    title: str,
    boundary: LabelledBoundary | None = None,
    interior: bool = False,
) -> None:
    if files.out is not None and boundary is not None and files.out.suffix.lower() in FORMATS:
        write_table(_points(boundary), files.out, overwrite=files.force)
        say(f"Table      {files.out}")
    elif files.out is not None:
        region.write(files.out, overwrite=files.force)
        say(f"Region     {files.out}{share_in(region, files.out)}")
    if files.plot is not None and region.empty:
        say(f"Picture    {files.plot} is not written: the region is proven empty")
    elif files.plot is not None:
        from gsp.figures import style
        from gsp.plots import workspace as plots
        from gsp.plots.common.style import plain

        if boundary is None:
            axes = region.plot()
        else:
            axes = plots.boundary(boundary, interior=interior)
        with style():
            axes.set_title(f"{plain(title)}\n{axes.get_title()}", fontsize="medium")
        save_picture(axes, files.plot, overwrite=files.force)
