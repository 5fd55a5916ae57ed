"""Sections of workspaces: printed, written to files and drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from gsp.cli.inputs.workspaces import check_place, vertical_plane
from gsp.cli.outputs.completeness import check_stopped
from gsp.cli.outputs.console import counted, number, plain_table, say, show_table, warn
from gsp.cli.outputs.pictures import save_picture
from gsp.cli.outputs.regions import Files
from gsp.files.tables import write_table
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.units import power_base
from gsp.workspace.sides import Side

if TYPE_CHECKING:
    import pandas as pd

    from gsp.limits import Limits
    from gsp.workspace import Section
    from gsp.workspace.exact.shells import Arc

# Largest length of a table [unit] below which six decimals are too few; digits relative to it.
SMALL_LENGTH, RELATIVE_DIGIT = 1e-2, 1e-9


def exact_section(
    design: Design,
    rotation: Array,
    limits: Limits,
    position: tuple[float, float, float] | None,
    theta: float,
    held: str,
    side: Side,
    files: Files,
) -> None:
    """Print volume and bifurcation points of a fixed orientation; write its arcs and draw them."""
    from gsp.workspace import exact_shells

    shells = exact_shells(design, rotation, limits)
    volume = side.volume(design, rotation, limits)
    size = f"{number(volume.value, 10)} ± {volume.error:.1e} {cubic(design.unit)}".rstrip()
    say(f"Volume  {size}; {side.name}")
    corners = shells.vertices()
    rows = [(str(i), c.label, *c.position) for i, c in enumerate(corners)]
    _print(["nr", "label", "x", "y", "z"], rows)
    arcs = shells.section(position or (0.0, 0.0, 0.0), vertical_plane(theta))
    where = "" if side.half_space is None else ", on both sides of the base"
    say(f"{len(corners)} bifurcation points; {len(arcs)} arcs in the plane{where}")
    if not arcs:
        empty = "plane" if corners else "workspace"
        advice = "; see --position" if corners else ""
        unwritten = ", nothing is written" if files.plot or files.out else ""
        warn(f"the {empty} is empty{unwritten}{advice}")
    if files.out is not None and arcs:
        write_table(_arcs_table(arcs), files.out, _facts(design, theta), overwrite=files.force)
        say(f"Table      {files.out}")
    if files.plot is not None and arcs:
        from gsp.plots import workspace as plots

        title = _title(design, theta, held)
        drawn = plots.arcs(arcs, axes=vertical_plane(theta), unit=design.unit, title=title)
        save_picture(drawn, files.plot, overwrite=files.force)


def _title(design: Design, theta: float, orientation: str) -> str:
    """Return the name of the design, its plane and its orientation."""
    return f"{design.name}\nvertical plane at {theta:g}°\n{orientation}"


def _arcs_table(arcs: Sequence[Arc]) -> pd.DataFrame:
    """Return the points of arcs, one row per point: arc, label, x, y, z."""
    import pandas as pd

    rows = [(i, arc.label, *point) for i, arc in enumerate(arcs) for point in arc.points]
    return pd.DataFrame(rows, columns=["arc", "label", "x", "y", "z"])


def _facts(design: Design, theta: float) -> dict[str, object]:
    return {"design": design.name, "unit_of_length": design.unit, "theta_deg": theta}


def mapped_section(
    design: Design,
    rotation: Array | None,
    limits: Limits,
    position: tuple[float, float, float] | None,
    theta: float,
    held: str,
    order: str,
    files: Files,
    search: Mapping[str, Any],
) -> None:
    """Print the bifurcation points and curves of a section; write its points and draw it."""
    from gsp.workspace import section

    check_place(design, position)
    plane = vertical_plane(theta)
    mapped = section(design, position, plane, rotation=rotation, limits=limits, **search)
    _print_section(mapped, order)
    if files.out is not None:
        facts = {**_facts(design, theta), "order": order, "seed": search["rng"]}
        write_table(mapped.table(order), files.out, facts, overwrite=files.force)
        say(f"Table      {files.out}")
    if files.plot is not None and not mapped.curves:
        warn("no curve was found, no picture is written")
    elif files.plot is not None:
        from gsp.plots import workspace as plots

        title = _title(design, theta, held)
        drawn = plots.section(mapped, axes=plane, unit=design.unit, title=title)
        save_picture(drawn, files.plot, overwrite=files.force)


def _print_section(mapped: Section, order: str) -> None:
    points = mapped.bifurcation_table(order)
    columns = ["label", "x", "y", "z", "alpha", "beta", "gamma"]
    _print(["nr", *columns], [(str(i), *row) for i, row in enumerate(_rows(points[columns]))])
    say("")
    _print(
        ["curve", "label", "from", "to", "maximal"],
        [
            (str(i), curve.label, _end(curve.first), _end(curve.last), curve.maximal.mean())
            for i, curve in enumerate(mapped.curves)
        ],
    )
    ends = mapped.ends
    say(
        f"{len(mapped.curves)} curves, {len(mapped.bifurcations)} bifurcation points, "
        f"{int(ends.maximal.sum())} of {len(ends.maximal)} ray ends are local maxima"
    )
    lost = sum(curve.lost for curve in mapped.curves)
    if lost:
        warn(f"{counted(lost, 'curve')} could not be followed to an end")
    check_stopped(mapped)


def _rows(frame: pd.DataFrame) -> list[tuple[object, ...]]:
    return [tuple(row) for row in frame.itertuples(index=False)]


def _end(node: int | None) -> str:
    return "" if node is None else str(node)


def _print(columns: list[str], rows: list[tuple[object, ...]]) -> None:
    right = tuple(c for c in columns if c != "label")
    table = plain_table(*columns, right=right)
    lengths = [i for i, name in enumerate(columns) if name in ("x", "y", "z")]
    size = max((abs(float(row[i])) for row in rows for i in lengths), default=0.0)  # type: ignore[arg-type]
    for row in rows:
        table.add_row(*(_cell(value, size if i in lengths else 1.0) for i, value in enumerate(row)))
    show_table(table)


def _cell(value: object, size: float) -> str:
    """Return a text as it is; a number with six decimals, or with six digits if all are small.

    There is no minus before zero.
    """
    if isinstance(value, str):
        return value
    given = float(value)  # type: ignore[arg-type]
    if size < SMALL_LENGTH:
        return f"{given if abs(given) > RELATIVE_DIGIT * size else 0.0:.6e}"
    return f"{round(given, 6) + 0.0:.6f}"


def cubic(unit: str) -> str:
    """Return the unit of a volume."""
    return f"{power_base(unit)}³" if unit else ""
