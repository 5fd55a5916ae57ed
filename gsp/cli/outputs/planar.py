"""The workspace of a planar platform: printed, written to files and drawn."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gsp.cli.outputs.completeness import check_stopped
from gsp.cli.outputs.console import counted, number, plain_table, say, show_table, warn
from gsp.cli.outputs.pictures import save_picture
from gsp.errors import InvalidInput
from gsp.figures import INK
from gsp.files.tables import write_table
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.units import power_base
from gsp.planar import PlanarComponent, PlanarDesign, on_boundary, planar_components

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from gsp.workspace import Section


@dataclass(frozen=True, kw_only=True)
class Results:
    """What a workspace in the plane is written to and drawn to, None for nothing."""

    boundary: Path | None
    out: Path | None
    plot: Path | None
    force: bool


def report_planar(
    mapped: Section,
    design: PlanarDesign,
    place: tuple[float, float],
    angle: float | None,
    rays: int,
    results: Results,
) -> None:
    """Print radiating point, bifurcation points and curves; write and draw them."""
    parts = _parts(design, angle)
    _print_radiating(mapped, design, place, angle)
    _print_points(mapped, angle)
    _print_curves(mapped)
    _print_parts(parts, place, design.unit)
    facts = {"design": design.name, "unit_of_length": design.unit}
    for path, table in (
        (results.boundary, _boundary(mapped, rays, parts)),
        (results.out, _curves(mapped, parts)),
    ):
        if path is not None:
            write_table(table, path, facts, overwrite=results.force)
            say(f"Table      {path}")
    if results.plot is not None and not mapped.curves:
        warn("no curve was found, no picture is written")
    elif results.plot is not None:
        _draw(mapped, design, angle, parts, results.plot, results.force)


def _parts(design: PlanarDesign, angle: float | None) -> tuple[PlanarComponent, ...]:
    """Return the components at a fixed angle; none for any angle, or without bounds."""
    if angle is None:
        return ()
    try:
        return planar_components(design, angle)
    except InvalidInput:
        warn("the strokes do not bound the positions: components that no ray meets are not listed")
        return ()


def _part_of_curve(parts: tuple[PlanarComponent, ...]) -> Array:
    """Return the number of the component of each curve of a section."""
    return np.repeat(np.arange(len(parts)), [len(part.pieces) for part in parts])


def _print_parts(parts: tuple[PlanarComponent, ...], place: tuple[float, float], unit: str) -> None:
    """Print the components with their areas, and in which of them the radiating point is."""
    if not parts:
        return
    table = plain_table("component", "area", "holes", "curves", right=("area", "holes"))
    for i, part in enumerate(parts):
        curves = np.flatnonzero(_part_of_curve(parts) == i)
        numbers = f"{curves[0]}–{curves[-1]}" if len(curves) > 1 else str(curves[0])
        table.add_row(str(i), number(part.area, 7), str(len(part.holes)), numbers)
    show_table(table)
    own = [str(i) for i, part in enumerate(parts) if part.contains(place)]
    total = number(sum(part.area for part in parts), 7)
    squared = f" {power_base(unit)}²" if unit else ""
    text = f"{counted(len(parts), 'component')}, area {total}{squared}"
    say(text + (f"; the radiating point is in component {own[0]}" if own else ""))


def _print_radiating(
    mapped: Section, design: PlanarDesign, place: tuple[float, float], angle: float | None
) -> None:
    """Print the radiating point, and the pose there from which rays start first, if it is known."""
    unit = f" {design.unit}" if design.unit else ""
    x, y = _without_rounding(mapped, place)
    text = f"Radiating point  ({number(x, 6)}, {number(y, 6)}){unit}"
    home = design.home
    if home is not None and angle is None and tuple(home.position.tolist()) == place:
        joints = design.at(home).joints
        if ((joints >= mapped.bounds.low) & (joints <= mapped.bounds.high)).all():
            lengths = " ".join(number(x, 6) for x in joints)
            text += f", angle {np.rad2deg(float(home.angle)):.6g}°, joints {lengths}"
    say(text)


def _without_rounding(mapped: Section, point: Iterable[float]) -> list[float]:
    """Return coordinates with zeros for those that are rounding errors."""
    tiny = 1e-12 * mapped.bounds.scale
    return [0.0 if abs(v) < tiny else v for v in point]


def _print_points(mapped: Section, angle: float | None) -> None:
    """Print the bifurcation points, and the labels of which none was found or on the boundary."""
    outer = on_boundary(mapped)
    numbers = ("x", "y", "angle_deg")
    # At a fixed angle all of them are on the boundary.
    farthest = "boundary" if angle is None else "farthest on its ray"
    table = plain_table("nr", "label", *numbers, farthest, right=numbers)
    for i, (point, last) in enumerate(zip(mapped.bifurcations, outer, strict=True)):
        x, y = _without_rounding(mapped, point.pose.position[:2])
        cells = (number(x, 7), number(y, 7), f"{np.round(_turns(point.pose), 6) + 0.0:.6f}")
        table.add_row(str(i), point.label, *cells, "yes" if last else "no")
    show_table(table)
    n = mapped.bounds.joints
    complete = [" ".join(marks) for marks in product("01", repeat=n)] if angle is None else []
    known = {point.label: False for point in mapped.bifurcations}
    for point, last in zip(mapped.bifurcations, outer, strict=True):
        known[point.label] |= bool(last)
    for text, labels in (
        ("Labels on the boundary", [name for name in complete if known.get(name)]),
        ("Labels inside only", [name for name in complete if known.get(name) is False]),
        ("Labels without a pose", [name for name in complete if name not in known]),
    ):
        if labels:
            say(f"{text}: {', '.join(labels)}")


def _print_curves(mapped: Section) -> None:
    table = plain_table("curve", "label", "from", "to", "maximal", right=("maximal",))
    for i, curve in enumerate(mapped.curves):
        ends = ["–" if end is None else str(end) for end in (curve.first, curve.last)]
        table.add_row(str(i), curve.label, *ends, f"{curve.maximal.mean():.2f}")
    show_table(table)
    maximal = mapped.ends.maximal
    say(
        f"{counted(len(mapped.curves), 'curve')}, "
        f"{counted(len(mapped.bifurcations), 'bifurcation point')}, "
        f"{int(maximal.sum())} of {len(maximal)} ray ends are local maxima"
    )
    check_stopped(mapped)


def _turns(pose: Pose) -> Array:
    """Return the angles of poses that are turned about the z-axis, in degrees."""
    return np.asarray(pose.angles(degrees=True)[..., 2] + 0.0)


def _boundary(mapped: Section, rays: int, parts: tuple[PlanarComponent, ...]) -> pd.DataFrame:
    """Return the farthest point of the curves on each of the rays: angle, distance, x, y, label.

    With components also which of them it is on.
    """
    angles = np.arange(rays) * (2.0 * np.pi / rays)
    frame = mapped.on_rays(angles)
    frame = frame[frame["outer"]].drop_duplicates("ray").reset_index(drop=True)
    frame["angle_deg"] = np.rad2deg(frame["angle"])
    columns = ["ray", "angle_deg", "distance", "x", "y", "label"]
    if parts:
        frame["component"] = _part_of_curve(parts)[frame["curve"].to_numpy(dtype=int)]
        columns.append("component")
    return frame[columns]


def _curves(mapped: Section, parts: tuple[PlanarComponent, ...]) -> pd.DataFrame:
    """Return the points of all curves: curve, label, x, y, angle, maximal, connecting, ends.

    With components also which of them they bound.
    """
    frame = mapped.table("rpy")
    turns = [_turns(curve.pose) for curve in mapped.curves]
    frame = frame.drop(columns=["z", "alpha", "beta", "gamma"])
    frame.insert(4, "angle_deg", np.concatenate(turns) if turns else [])
    if parts:
        frame["component"] = _part_of_curve(parts)[frame["curve"].to_numpy(dtype=int)]
    return frame


def _draw(
    mapped: Section,
    design: PlanarDesign,
    angle: float | None,
    parts: tuple[PlanarComponent, ...],
    path: Path,
    force: bool,
) -> None:
    from gsp.plots import workspace as plots

    held = "any angle" if angle is None else f"angle {np.rad2deg(angle):.6g}°"
    if len(parts) > 1:
        held += f", {counted(len(parts), 'component')}"
    drawn = plots.section(
        mapped, axes=np.eye(3)[:2], unit=design.unit, title=f"{design.name}\n{held}"
    )
    _fill(drawn, parts)
    save_picture(drawn, path, overwrite=force)


def _fill(ax: Axes, parts: tuple[PlanarComponent, ...]) -> None:
    """Fill components, without their holes, beneath what is drawn."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    for part in parts:
        loops = [
            np.concatenate([piece.points for piece in loop]) for loop in (part.outline, *part.holes)
        ]
        around = Outline.make_compound_path(*[Outline(loop, closed=True) for loop in loops])
        ax.add_patch(PathPatch(around, facecolor=INK, alpha=0.1, linewidth=0.0, zorder=0.5))
