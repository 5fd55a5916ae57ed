"""`gsp show`: one mechanism or one design."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer

from gsp.catalogue import independent_loops, instantiate, kinematic_graph, mobility
from gsp.catalogue.equations import EQUATIONS, SYMBOLS
from gsp.catalogue.placement import TEMPLATE
from gsp.cli.inputs.designs import find_design, find_mechanism_or_design
from gsp.cli.inputs.options import (
    Angles,
    Force,
    Order,
    Position,
    Template,
    check_length,
    refuse_order,
    refuse_parameters,
    refuse_unused,
)
from gsp.cli.inputs.poses import pose_of
from gsp.cli.outputs.console import number, plain_table, say, show_table, warn
from gsp.cli.outputs.indices import indices_table, print_indices
from gsp.cli.outputs.pictures import check_picture, save_picture
from gsp.cli.outputs.postures import strokes, warn_of
from gsp.errors import InvalidInput
from gsp.evaluation.request import names_for
from gsp.geometry.pose.texts import pose_text
from gsp.indices import index_names
from gsp.model.constraints import CONSTRAINT
from gsp.model.design import Design
from gsp.model.drives import Crank, drives_text
from gsp.model.legs import Leg
from gsp.model.mechanism import Mechanism
from gsp.model.posture import Posture


def show(
    context: typer.Context,
    name: Annotated[
        str, typer.Argument(help="A mechanism, a published design, or a design file (.toml).")
    ],
    position: Position = None,
    angles: Angles = None,
    order: Order = "rpy",
    indices: Annotated[
        list[str] | None,
        typer.Option(
            help="Indices by name or symbol, separated by commas, or all; for λ the maximum of "
            "|det J| is searched. Default: those that need no more parameters; λ where its "
            "maximum is known.",
            metavar="NAMES",
            show_default=False,
        ),
    ] = None,
    length: Annotated[
        float | None,
        typer.Option(
            help="Characteristic length for the indices, in the unit of the design. Default: that "
            "of the design.",
            show_default=False,
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="Draw it in space, to this file: .png, .pdf or .svg. A mechanism is drawn on the "
            "anchors of the template.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    template: Template = TEMPLATE,
    force: Force = False,
) -> None:
    """Show a mechanism or a design: legs, joints, equations; for a design also its posture.

    Actuated joints are in brackets.

    **Examples**

    - `gsp show "D1^2 D2 D4 A1^2"`

    - `gsp show toz-kucuk-2016-d3-6 --indices all --plot hexapod.png`
    """
    if plot is not None:
        check_picture(plot, overwrite=force)
    check_length(length)
    names = index_names(indices) if indices else None  # raises an error for an unknown one
    found = find_mechanism_or_design(name)
    if isinstance(found, Design) and indices:
        names = names_for(indices, [found])
        refuse_parameters(context, names, [found])
    if isinstance(found, Design):
        refuse_unused(context, ["template"], "a design, which has its own anchors")
    else:
        refuse_unused(context, ["indices", "length"], "a mechanism, which has no dimensions")
        if plot is None:
            unused = ["template", "position", "angles", "order"]
            refuse_unused(context, unused, "a mechanism without --plot, which has no dimensions")
    refuse_order(context, angles)
    if isinstance(found, Design):
        design: Design | None = found
    else:
        design = instantiate(found, find_design(template)) if plot else None
    pose = None if design is None else pose_of(design, position, angles, order)
    posture = None if design is None or pose is None else design.at(pose)
    if posture is None and (plot is not None or names):
        what = "the picture" if plot is not None else "the indices"
        raise InvalidInput(f"--position: expected one for {what}, as there is no home pose")
    if posture is None:
        refuse_unused(context, ["length"], "a design without a home pose or --position")
    if isinstance(found, Mechanism):
        _show_mechanism(found)
    else:
        # What an index needs is found out before anything is printed.
        found_indices = None if posture is None else indices_table(posture, names, length)
        _show_design(found)
        if posture is not None and found_indices is not None:
            _show_posture(posture)
            print_indices(posture, *found_indices)
        else:
            warn("no posture: the design has no home pose; --position gives one")
    if plot is not None and posture is not None:
        _draw(posture, plot, force)


def _show_mechanism(mechanism: Mechanism) -> None:
    graph = kinematic_graph(mechanism)
    exchanged = mechanism.exchanged()
    other = "itself" if exchanged == mechanism else exchanged.name
    say(f"{mechanism.name}, class {mechanism.group}", "bold")
    say(f"Legs       {len(mechanism.legs)}, {independent_loops(graph)} independent loops")
    say(f"Mobility   {mobility(graph)}")
    say(f"Symmetric  {'yes' if mechanism.symmetric else 'no'}")
    say(f"Base and platform exchanged: {other}")
    _legs_table(mechanism.legs)
    _equations_table(mechanism.constraints)


def _show_design(design: Design) -> None:
    drives = drives_text(design.drives)
    kind = f"{design.mechanism.name}, class {design.mechanism.group}"
    say(f"{design.name}, {kind}{drives and ', '}{drives}", "bold")
    say(f"Source     {design.source or 'not stated'}")
    say(f"Unit       {design.unit or 'not stated'}")
    if design.characteristic_length is not None:
        say(f"Length     {design.characteristic_length:g} {design.unit}".rstrip())
    _legs_table(design.legs)
    _anchors_table(design)
    _drives_table(design)
    _equations_table(row.constraint.name for row in design.rows if not row.constraint.driven)


def _legs_table(legs: tuple[Leg, ...]) -> None:
    table = plain_table("leg", "constraints", "chain", "joints", "actuated", right=("leg",))
    for i, leg in enumerate(legs, 1):
        names = ", ".join(f"{c.symbol}{i}" for c in leg.constraints)
        table.add_row(str(i), _constraints(leg), leg.chain, " ".join(map(str, leg.joints)), names)
    say("")
    show_table(table)


def _constraints(leg: Leg) -> str:
    return " ".join(constraint.name for constraint in leg.constraints)


def _drives_table(design: Design) -> None:
    """Print the drives at the base: rails and axes are the base lines of the legs."""
    if not design.driven:
        return
    table = plain_table("leg", "drive", "rod", "branch", "arm", right=("leg", "rod", "branch"))
    for i, drive in enumerate(design.drives, 1):
        if drive is not None:
            arm = _vector(drive.arm) if isinstance(drive, Crank) else ""
            table.add_row(str(i), drive.kind, f"{drive.rod:.6g}", f"{drive.branch:+d}", arm)
    say("")
    show_table(table)
    say("The base line of a driven leg is the rail of its slider or the axis of its crank.", "dim")


def _anchors_table(design: Design) -> None:
    headings = ("base point", "base direction", "platform point", "platform direction")
    table = plain_table("leg", *headings, right=("leg", *headings))
    for i in range(design.n_legs):
        table.add_row(
            str(i + 1),
            _vector(design.base_points[i]),
            _vector(design.base_directions[i]),
            _vector(design.platform_points[i]),
            _vector(design.platform_directions[i]),
        )
    say("")
    show_table(table)


def _vector(vector: object) -> str:
    values = [float(x) for x in vector]  # type: ignore[attr-defined]
    return "" if values[0] != values[0] else "  ".join(f"{x + 0.0:8.6g}" for x in values)


def _equations_table(constraints: Iterable[str]) -> None:
    names = list(dict.fromkeys(constraints))
    if not names:
        return
    table = plain_table("constraint", "value", "row", "source")
    for name in names:
        equation = EQUATIONS[name]
        table.add_row(name, equation.value, equation.text, CONSTRAINT[name].source)
    say("")
    show_table(table)
    say(SYMBOLS, "dim")


def _show_posture(posture: Posture) -> None:
    design = posture.design
    say("")
    say(f"At {pose_text(posture.pose, design.unit)}", "bold")
    marks = strokes(posture)
    stroke = ("stroke",) if any(marks) else ()
    joints = plain_table("joint", "value", "unit", *stroke, right=("value", "stroke"))
    for name, value, unit, mark in zip(
        posture.joint_names, posture.joints, design.joint_units, marks, strict=True
    ):
        joints.add_row(name, number(value, 7), unit, *([mark] if stroke else []))
    show_table(joints)
    warn_of(posture)
    say("")


def _draw(posture: Posture, path: Path, force: bool) -> None:
    from gsp import plots

    save_picture(plots.mechanism(posture.design, posture.pose), path, overwrite=force)
