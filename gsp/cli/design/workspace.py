"""`gsp workspace`: the workspace of a design."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from gsp import arguments
from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import Force, Order, refuse_unused
from gsp.cli.outputs.console import number, plain_table, say, show_table, warn
from gsp.cli.outputs.pictures import check_picture, save_picture
from gsp.errors import InvalidInput, brief, expected
from gsp.files.tables import check_table, write_table
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.model.design import Design

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from gsp.workspace import Limits, Section, Shells
    from gsp.workspace.exact.shells import Arc

ORDER = "approach-roll"
# Below this six decimals of a length are too few; digits relative to the largest length of a table.
SMALL, DIGITS = 1e-2, 1e-9
# Options of the search along rays, which the exact cases do without.
SECTION = ("rays", "starts", "seed", "connecting")


def workspace(
    context: typer.Context,
    design: Annotated[str, typer.Argument(help="Published design, or a design file (.toml).")],
    position: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            help="Point of the vertical plane from which the rays go, in the unit of the design. "
            "Default: the home pose of the design; with --angles, for SPS legs, the origin.",
            metavar="X Y Z",
            show_default=False,
        ),
    ] = None,
    theta: Annotated[
        float, typer.Option(help="Angle of the vertical plane from the x-axis, in degrees.")
    ] = 0.0,
    angles: Annotated[
        str | None,
        typer.Option(
            help='Fixed orientation "α β γ" in degrees, in the order of --order. With an interval '
            'such as "0 0 -30:30": the dextrous workspace. Default: any orientation.',
            metavar="ANGLES",
            show_default=False,
        ),
    ] = None,
    order: Order = ORDER,
    stroke: Annotated[
        tuple[float, float] | None,
        typer.Option(
            help="Least and greatest value of every joint, distances in the unit of the design, "
            "angles in rad. Default: those of the design.",
            metavar="LOW HIGH",
            show_default=False,
        ),
    ] = None,
    index: Annotated[
        list[str] | None,
        typer.Option(
            help='Limit of an index, such as "CTN >= 0.1"; may be repeated.',
            metavar="BOUND",
            show_default=False,
        ),
    ] = None,
    resolution: Annotated[
        float | None,
        typer.Option(
            help="Longest side of the cells that stay undecided in a dextrous workspace, in the "
            "unit of the design. Default: until the volume is known within 6 %.",
            show_default=False,
        ),
    ] = None,
    rays: Annotated[int, typer.Option(help="Rays around the radiating point.", min=1)] = 24,
    starts: Annotated[int, typer.Option(help="Orientations per ray.", min=1)] = 16,
    seed: Annotated[int, typer.Option(help="Seed of the random orientations.", min=0)] = 0,
    connecting: Annotated[
        bool, typer.Option(help="Follow curves between complete bifurcation points as well.")
    ] = True,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="Draw the section to this file: .png, .pdf or .svg.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write the points of the curves to this file: .csv, .parquet, .xlsx, .md or .tex.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Compute a workspace: bifurcation points and boundary curves in a vertical plane.

    The platform may take any orientation, or a fixed one (--angles; for SPS legs the exact volume
    is printed as well). With an interval of angles the volume of the dextrous workspace is printed.

    **Examples**

    - `gsp workspace workspace-6-3 --plot section.png`

    - `gsp workspace workspace-6-3 --angles "0 0 -30" --theta 15`

    - `gsp workspace workspace-6-3 --angles "0 0 -30:30"`
    """
    from gsp.proof.branching.requirements import with_maximum
    from gsp.workspace import Limits, exact_shells, section

    if plot is not None:
        check_picture(plot, overwrite=force)
    if out is not None:
        check_table(out, overwrite=force)
    arguments.number("--theta", theta)
    for option, values in (("--position", position), ("--stroke", stroke)):
        for value in values or ():
            arguments.number(option, value)
    rotation_from_angles((0.0, 0.0, 0.0), order)  # raises an error for an unknown order
    found = find_design(design)
    strokes = None if stroke is None else [list(stroke)] * len(found.joint_names)
    limits = with_maximum(found, Limits(strokes=strokes, indices=index or ()))
    box = None if angles is None else _read_angles(angles)
    if box is not None and (box[:, 1] > box[:, 0]).any():
        refuse_unused(
            context,
            [*SECTION, "position", "theta", "index", "out", "plot"],
            "an interval of angles, where only the volume is computed",
        )
        _dextrous(found, box, order, limits, resolution)
        return
    refuse_unused(context, ["resolution"], "a section, which has no cells")
    rotation = None if box is None else rotation_from_angles(box[:, 0], order, degrees=True)
    held = _orientation(box, order)
    if rotation is not None and not index and all(leg.name == "D1" for leg in found.legs):
        refuse_unused(context, SECTION, "one orientation of SPS legs, whose section is exact")
        shells = exact_shells(found, rotation, limits)
        _shells(shells, position or (0.0, 0.0, 0.0), theta, found, held, plot, out, force)
        return
    mapped = section(
        found,
        position,
        _axes(theta),
        rotation=rotation,
        limits=limits,
        rays=rays,
        starts=starts,
        rng=seed,
        connecting=connecting,
    )
    _section(mapped, order)
    if out is not None:
        facts = {**_facts(found, theta), "order": order, "seed": seed}
        write_table(mapped.table(order), out, facts, overwrite=force)
        say(f"Table      {out}")
    if plot is not None and not mapped.curves:
        warn("no curve was found, no picture is written")
    elif plot is not None:
        from gsp.plots import workspace as plots

        drawn = plots.section(mapped, axes=_axes(theta), unit=found.unit)
        save_picture(_titled(drawn, found, theta, held), plot, overwrite=force)


def _read_angles(text: str) -> Array:
    try:
        ends = [[float(end) for end in word.split(":")] for word in text.replace(",", " ").split()]
        pairs = [(end[0], end[-1]) for end in ends if len(end) in (1, 2)]
    except ValueError:
        pairs = []
    if len(pairs) != 3 or any(low > high for low, high in pairs):
        raise InvalidInput(
            expected("--angles", 'three angles or intervals, such as "0 0 -30:30"', brief(text))
        )
    return np.array(pairs)


def _axes(theta: float) -> Array:
    turn = np.deg2rad(theta)
    return np.array([[np.cos(turn), np.sin(turn), 0.0], [0.0, 0.0, 1.0]])


def _dextrous(
    design: Design, box: Array, order: str, limits: Limits, resolution: float | None
) -> None:
    from gsp.geometry.pose import PoseBox
    from gsp.workspace import dextrous

    angles = PoseBox([0.0, 0.0, 0.0], box.tolist(), degrees=True, order=order)
    low, high = dextrous(design, angles, limits, resolution=resolution).volume
    unit = f" {_cubic(design.unit)}".rstrip()
    say(f"Volume  between {number(low)} and {number(high)}{unit}, proven")


def _shells(
    shells: Shells,
    origin: tuple[float, float, float],
    theta: float,
    design: Design,
    held: str,
    plot: Path | None,
    out: Path | None,
    force: bool,
) -> None:
    volume = shells.volume()
    say(f"Volume  {number(volume.value, 10)} ± {volume.error:.1e} {_cubic(design.unit)}")
    corners = shells.vertices()
    _print(["label", "x", "y", "z"], [(c.label, *c.position) for c in corners])
    arcs = shells.section(origin, _axes(theta))
    say(f"{len(corners)} bifurcation points; {len(arcs)} arcs in the plane")
    if not arcs:
        empty = "plane" if corners else "workspace"
        warn(f"the {empty} is empty" + (", no picture is written" if plot is not None else ""))
    if out is not None:
        write_table(_arcs_table(arcs), out, _facts(design, theta), overwrite=force)
        say(f"Table      {out}")
    if plot is not None and arcs:
        from gsp.plots import workspace as plots

        drawn = plots.arcs(arcs, axes=_axes(theta), unit=design.unit)
        save_picture(_titled(drawn, design, theta, held), plot, overwrite=force)


def _titled(drawn: Axes, design: Design, theta: float, orientation: str) -> Axes:
    """Return axes with the name of the design, its plane and its orientation above them."""
    from gsp.plots.common.style import plain

    title = f"{plain(design.name)}\nvertical plane at {theta:g}°\n{orientation}"
    drawn.set_title(title, fontsize=10)
    return drawn


def _orientation(box: Array | None, order: str) -> str:
    """Return the words for a fixed orientation, or for any."""
    if box is None:
        return "any orientation"
    return f"angles {' '.join(f'{angle:g}°' for angle in box[:, 0])} ({order})"


def _arcs_table(arcs: Sequence[Arc]) -> pd.DataFrame:
    """Return the points of arcs, one row per point: arc, label, x, y, z."""
    import pandas as pd

    rows = [(i, arc.label, *point) for i, arc in enumerate(arcs) for point in arc.points]
    return pd.DataFrame(rows, columns=["arc", "label", "x", "y", "z"])


def _facts(design: Design, theta: float) -> dict[str, object]:
    return {"design": design.name, "unit_of_length": design.unit, "theta_deg": theta}


def _section(mapped: Section, order: str) -> None:
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
        f"{int(ends.certified.sum())} of {len(ends.certified)} ray ends certified"
    )
    lost = sum(curve.lost for curve in mapped.curves)
    if lost:
        warn(f"{lost} {'curve' if lost == 1 else 'curves'} could not be followed to an end")


def _rows(frame: pd.DataFrame) -> list[tuple[object, ...]]:
    return [tuple(row) for row in frame.itertuples(index=False)]


def _end(node: int | None) -> str:
    return "" if node is None else str(node)


def _print(columns: list[str], rows: list[tuple[object, ...]]) -> None:
    right = tuple(c for c in columns if c not in ("label",))
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
    if size < SMALL:
        return f"{given if abs(given) > DIGITS * size else 0.0:.6e}"
    return f"{round(given, 6) + 0.0:.6f}"


def _cubic(unit: str) -> str:
    return f"{unit}³" if unit else ""
