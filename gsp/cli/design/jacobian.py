"""`gsp jacobian`: joint variables and inverse Jacobian of a design at one pose."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import (
    Angles,
    DesignName,
    Force,
    Order,
    Out,
    Position,
    check_length,
    refuse_order,
)
from gsp.cli.inputs.poses import pose_of
from gsp.cli.outputs.console import number, plain_table, say, show_table
from gsp.cli.outputs.headings import motion_headings
from gsp.cli.outputs.indices import indices_table, print_indices
from gsp.cli.outputs.postures import strokes, warn_of
from gsp.errors import InvalidInput
from gsp.evaluation.request import names_for
from gsp.files.tables import check_table, write_table
from gsp.geometry.frames.changes import TWIST_NAMES
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import pose_text
from gsp.model.design import Design
from gsp.model.posture import Posture

if TYPE_CHECKING:
    import pandas as pd


def jacobian(
    context: typer.Context,
    design: DesignName,
    position: Position = None,
    angles: Angles = None,
    order: Order = "rpy",
    length: Annotated[
        float | None,
        typer.Option(
            help="Print the homogeneous Jacobian for this characteristic length instead, in the "
            "unit of the design.",
            show_default=False,
        ),
    ] = None,
    indices: Annotated[
        list[str] | None,
        typer.Option(
            help="Indices by name or symbol, separated by commas, or all; for λ the maximum of "
            "|det J| is searched.",
            metavar="NAMES",
            show_default=False,
        ),
    ] = None,
    out: Out = None,
    force: Force = False,
) -> None:
    """Print the joint variables and the inverse Jacobian of a design at a pose.

    Rate of an actuator = row times twist (v, ω) of the platform. v is the velocity of its origin
    and ω its angular velocity, both in base axes. det J of these rows is in the unit of the design.
    The indices follow: all that need no more parameters, λ where its maximum is known, or those
    that are named.

    **Examples**

    - `gsp jacobian toz-kucuk-2016-d3-6`

    - `gsp jacobian toz-kucuk-2016-d3-6 --position 10 -10 138 --angles 5 -5 -10 --length 95`

    - `gsp jacobian mine.toml --position 0 0 100 --out jacobian.csv`
    """
    if out is not None:
        check_table(out, overwrite=force)
    refuse_order(context, angles)
    found = find_design(design)
    pose = pose_of(found, position, angles, order)
    if pose is None:
        raise InvalidInput("--position: expected three numbers, as the design has no home pose")
    posture = found.at(pose)
    check_length(length)
    names = None if indices is None else names_for(indices, [found])
    found_indices = indices_table(posture, names, length)
    say(_title(found, pose, length), "bold")
    table = jacobian_table(posture, length)
    _print(table, strokes(posture))
    warn_of(posture)
    say("")
    print_indices(posture, *found_indices)
    if out is not None:
        facts, headings = _metadata(posture, length), motion_headings(found)
        write_table(table, out, facts, headings=headings, overwrite=force)
        say(f"Table      {out}")


def jacobian_table(posture: Posture, length: float | None) -> pd.DataFrame:
    """Return a table of one posture: joint, leg, constraint, value, unit, and the row."""
    import pandas as pd

    design = posture.design
    rows = posture.jacobian if length is None else posture.homogeneous(length)
    frame = pd.DataFrame(
        {
            "joint": posture.joint_names,
            "leg": [row.leg + 1 for row in design.rows],
            "constraint": [row.constraint.name for row in design.rows],
            "value": posture.joints,
            "unit": design.joint_units,
        }
    )
    if design.strokes is not None:
        low, high = design.strokes.T
        frame = frame.assign(stroke_low=low, stroke_high=high)
    return frame.assign(**{name: rows[:, i] for i, name in enumerate(TWIST_NAMES)})


def _title(design: Design, pose: Pose, length: float | None) -> str:
    kind = "inverse Jacobian"
    if length is not None:
        kind = f"homogeneous inverse Jacobian, length {length:g} {design.unit}".rstrip()
    return f"{design.name}: {kind} at {pose_text(pose, design.unit)}"


def _print(table: pd.DataFrame, marks: list[str]) -> None:
    twist = ("v_x", "v_y", "v_z", "ω_x", "ω_y", "ω_z")
    stroke = ("stroke",) if any(marks) else ()
    printed = plain_table(
        "joint",
        "leg",
        "constraint",
        "value",
        "unit",
        *stroke,
        *twist,
        right=("leg", "value", "stroke", *twist),
    )
    for row, mark in zip(table.to_dict("records"), marks, strict=True):
        first = (row["joint"], str(row["leg"]), row["constraint"], number(row["value"], 7))
        rates = [number(row[name], 6) for name in TWIST_NAMES]
        printed.add_row(*first, row["unit"], *([mark] if stroke else []), *rates)
    show_table(printed)


def _metadata(posture: Posture, length: float | None) -> dict[str, object]:
    design, pose = posture.design, posture.pose
    unit = design.unit or "length"
    return {
        "design": design.name,
        "source": design.source,
        "unit_of_length": design.unit,
        "position": pose.position.tolist(),
        "rotation": pose.rotation.tolist(),
        "length": length,
        "units_of_rows": "1"
        if length is not None
        else {"distance": f"1, then {unit}", "angle": f"1/{unit}, then 1"},
        "undefined": {element.joint: element.reason for element in posture.undefined},
    }
