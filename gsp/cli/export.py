"""`gsp export`: a design as a model of MuJoCo, URDF or Pinocchio."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from gsp.cli.designs import find_design
from gsp.design import Design
from gsp.errors import MissingParameter
from gsp.pose import Pose

Triple = tuple[float, float, float]


class Form(StrEnum):
    """What can be written."""

    mjcf = "mjcf"
    urdf = "urdf"
    pinocchio = "pinocchio"


def export(
    design: Annotated[str, typer.Argument(help="Published design, or a design file.")],
    to: Annotated[Form, typer.Option(help="Which program's form.")],
    out: Annotated[
        Path | None, typer.Option(help="File to write; default the design's name, here.")
    ] = None,
    position: Annotated[
        Triple | None, typer.Option(help="Platform origin; default the design's home pose.")
    ] = None,
    angles: Annotated[
        Triple, typer.Option(help="Roll, pitch, yaw in degrees, with --position.")
    ] = (0.0, 0.0, 0.0),
    radius: Annotated[
        float | None, typer.Option(help="Of the legs, in the design's unit; default 2 % of size.")
    ] = None,
    density: Annotated[float, typer.Option(help="Of all links [kg/m³].")] = 2700.0,
    platform_mass: Annotated[float | None, typer.Option(help="Of the platform [kg].")] = None,
    metres: Annotated[
        float | None, typer.Option(help="Length of the design's unit; default by its name.")
    ] = None,
    overwrite: Annotated[bool, typer.Option(help="Replace files that exist.")] = False,
) -> None:
    """Write a design as a multibody model, assembled at a pose.

    mjcf is a MuJoCo model with closed loops and servos. urdf is the tree of links, pinocchio the
    model that Pinocchio reads with Model.loadFromXML(file, "model"); their loops and configuration
    go to a .loops.json beside them.
    """
    from gsp.bridges.export import SUFFIXES
    from gsp.bridges.export import export as write
    from gsp.bridges.solids import Solids

    chosen = find_design(design)
    solids = Solids(radius=radius, density=density, platform_mass=platform_mass, metres=metres)
    target = out or Path((chosen.name or "design").replace(" ", "-") + SUFFIXES[to])
    pose = _pose(chosen, position, angles)
    for path in write(chosen, pose, to.value, target, solids, overwrite=overwrite):
        print(path)


def _pose(design: Design, position: Triple | None, angles: Triple) -> Pose:
    if position is not None:
        return Pose.from_rpy(position, angles, degrees=True)
    if design.home is None:
        raise MissingParameter(
            f"--position: expected one, as design {design.name!r} has no home pose, received none"
        )
    return design.home
