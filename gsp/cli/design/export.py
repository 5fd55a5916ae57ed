"""`gsp export`: a design as a model of MuJoCo, URDF, SDF or Pinocchio."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from gsp.bridges import Drives, Solids
from gsp.bridges.exports import SUFFIXES, default_file
from gsp.bridges.exports import export as write
from gsp.catalogue import instantiate
from gsp.catalogue.placement import TEMPLATE
from gsp.cli.inputs.designs import find_design, find_mechanism_or_design
from gsp.cli.inputs.options import (
    Angles,
    Force,
    Order,
    Position,
    Template,
    refuse_order,
    refuse_unused,
)
from gsp.cli.inputs.poses import pose_of
from gsp.cli.outputs.console import say, warn
from gsp.cli.outputs.postures import warn_of
from gsp.errors import InvalidInput
from gsp.files.writing import check_writable
from gsp.model.mechanism import Mechanism


class Form(StrEnum):
    """A format that can be written."""

    mjcf = "mjcf"
    urdf = "urdf"
    sdf = "sdf"
    pinocchio = "pinocchio"


def export(
    context: typer.Context,
    name: Annotated[
        str,
        typer.Argument(
            help="A published design, a design file (.toml), or a mechanism (on the anchors of the "
            "template).",
            metavar="DESIGN",
        ),
    ],
    to: Annotated[Form, typer.Option(help="The format of the model.")],
    out: Annotated[
        Path | None,
        typer.Option(
            help="File to write: .urdf for urdf, .sdf for sdf, else .xml. Default: named after the "
            "design, in this folder; for pinocchio it ends in .pinocchio.xml.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    position: Position = None,
    angles: Angles = None,
    order: Order = "rpy",
    template: Template = TEMPLATE,
    radius: Annotated[
        float | None,
        typer.Option(
            help="Radius of the legs, in the unit of the design. Default: 2 % of its size.",
            show_default=False,
        ),
    ] = None,
    density: Annotated[float, typer.Option(help="Density of all links, in kg/m³.")] = 2700.0,
    platform_mass: Annotated[
        float | None,
        typer.Option(
            help="Mass of the platform, in kg; balls and rails of the joints on it come on top. "
            "Default: from the density.",
            show_default=False,
        ),
    ] = None,
    metres: Annotated[
        float | None,
        typer.Option(
            help="The unit of the design, in metres. Default: from its name.", show_default=False
        ),
    ] = None,
    effort: Annotated[
        float | None,
        typer.Option(
            help="Greatest force of each actuator, in N (torque in N m). Default: no limit.",
            show_default=False,
        ),
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(
            help="Greatest speed of each actuator, in m/s (rad/s). Default: no limit.",
            show_default=False,
        ),
    ] = None,
    on_leg: Annotated[
        bool,
        typer.Option(
            "--on-leg",
            help="Of urdf: fix the platform to the end of leg 1 instead of a floating joint, which "
            "PyBullet and Drake do not have.",
        ),
    ] = False,
    force: Force = False,
) -> None:
    """Write a design as a multibody model, assembled at a pose.

    **mjcf** is a MuJoCo model with closed loops and servos, and **sdf** a model with closed loops
    for Gazebo. **urdf** is the tree of links, and **pinocchio** the model that Pinocchio reads with
    `pin.Model().loadFromXML(file, "model")`. The loops of these two are written to a second file
    beside it, which ends in .urdf.loops.json or .pinocchio.loops.json. The joints of urdf and sdf
    are zero at the pose; the second file has the values that they stand for.

    **Examples**

    - `gsp export toz-kucuk-2016-d3-6 --to mjcf`

    - `gsp export "D4^3 A1^3" --to urdf --out mine.urdf --platform-mass 2`
    """
    if out is not None:
        check_writable(out, overwrite=force, suffixes=(SUFFIXES[to],))
    refuse_order(context, angles)
    if to is Form.mjcf:
        refuse_unused(context, ["speed"], "--to mjcf, as MuJoCo has no limits of speed")
    if to is not Form.urdf:
        refuse_unused(context, ["on_leg"], f"--to {to.value}")
    found = find_mechanism_or_design(name)
    if isinstance(found, Mechanism):
        design = instantiate(found, find_design(template))
    else:
        refuse_unused(context, ["template"], "a design, which has its own anchors")
        design = found
    pose = pose_of(design, position, angles, order)
    if pose is None:
        raise InvalidInput("--position: expected three numbers, as the design has no home pose")
    solids = Solids(radius=radius, density=density, platform_mass=platform_mass, metres=metres)
    drives = Drives(efforts=effort, speeds=speed)
    if metres is None and not design.unit:
        warn("the design has no unit; its lengths are taken as metres: see --metres")
    target = out or Path(default_file(design.name, to.value))
    files = write(
        design, pose, to.value, target, solids, drives, floating=not on_leg, overwrite=force
    )
    warn_of(design.at(pose))
    for path in files:
        say(str(path))
