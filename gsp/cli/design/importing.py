"""`gsp import`: a table of anchor points, or a model of another program, as a design file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gsp import arguments
from gsp.bridges import read_model
from gsp.bridges.reading import FORMS
from gsp.cli.inputs.options import Force, refuse_unused
from gsp.cli.outputs.console import say, warn
from gsp.errors import InvalidInput, expected
from gsp.files.cells import SUFFIXES
from gsp.files.writing import check_writable
from gsp.geometry.pose import Pose
from gsp.model.design import Design
from gsp.model.design.tables import design_from_table
from gsp.ranking import in_unit


def import_file(
    context: typer.Context,
    file: Annotated[
        Path,
        typer.Argument(
            help="A table with one row per leg: .csv, .parquet or .xlsx; a model: .xml (MuJoCo), "
            ".urdf or .sdf; or a file of a public package: .json or .yaml.",
            metavar="FILE",
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            help="File to write (.toml). Default: named after FILE, here.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    unit: Annotated[
        str,
        typer.Option(
            help="Unit of length, such as mm. Of a table it is the unit of its numbers; default: "
            "none is stated. Models are in metres, and are converted to this unit.",
            show_default=False,
        ),
    ] = "",
    name: Annotated[
        str | None,
        typer.Option(
            help="Name of the design. Default: that in the model, or that of FILE.",
            show_default=False,
        ),
    ] = None,
    home: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            help="Position of the platform in the home pose, in the unit of the design; without a "
            "rotation. Default: the pose of the model, or no home pose.",
            metavar="X Y Z",
            show_default=False,
        ),
    ] = None,
    base: Annotated[
        str,
        typer.Option(
            help="Name of the body of a model that is the base. Default: the one that is fixed to "
            "the world, or the root.",
            show_default=False,
        ),
    ] = "",
    platform: Annotated[
        str,
        typer.Option(
            help="Name of the body of a model that is the platform. Default: the one to which most "
            "chains lead from the base.",
            show_default=False,
        ),
    ] = "",
    force: Force = False,
) -> None:
    """Write a design file from a table of anchor points, or from a model of another program.

    The columns of a table are base_x, base_y, base_z, platform_x, platform_y, platform_z, and where
    they are needed constraints, directions (base_dx …) and strokes (stroke_low, stroke_high).
    Common other names are read as well: bx, px, x_base, lmin …

    In a model each leg is a chain of joints: a ball, or turns whose axes meet, or a slide and a
    turn along one line at both ends, and a slide between them. The loops of NAME.urdf are in
    NAME.urdf.loops.json, as `gsp export` writes it, or in elements gazebo.

    Packages: oKermorgant/cdpr (.yaml), IRMA-LAB/cdpr_matlab and 64-B1T/basic_robotics (.json).

    **Examples**

    - `gsp import anchors.csv --unit mm --home 0 0 150`

    - `gsp import stewart.xml --platform top_plate --unit mm`
    """
    if not file.name:
        raise InvalidInput(expected("FILE", "the path of a file", "a folder, or an empty text"))
    target = out or Path(file.stem + ".toml")
    check_writable(target, overwrite=force, suffixes=(".toml",))
    for coordinate in home or ():
        arguments.number("--home", coordinate)
    suffix = file.suffix.lower()
    if suffix not in FORMS + SUFFIXES:
        wanted = f"a table ({', '.join(SUFFIXES)}), or a model or package ({', '.join(FORMS)})"
        raise InvalidInput(expected(str(file), wanted, suffix or "no suffix"))
    if suffix in FORMS:
        design = _from_model(file, unit, name, base, platform)
        if home is not None:
            design = design.replace(home=Pose(home))
    else:
        refuse_unused(context, ["base", "platform"], "a table")
        design = design_from_table(
            file,
            unit=unit,
            name=file.stem if name is None else name,
            home=None if home is None else Pose(home),
        )
    design.write(target, overwrite=force)
    say(str(target))


def _from_model(file: Path, unit: str, name: str | None, base: str, platform: str) -> Design:
    design = read_model(file, name=name, base=base, platform=platform)
    if not design.name:
        design = design.replace(name=file.stem)
    if design.home is None:
        warn("the file has no home pose: see --home")
    return in_unit(design, unit) if unit else design
