"""`gsp import`: a table of anchor points as a design file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gsp import arguments
from gsp.cli.inputs.options import Force
from gsp.cli.outputs.console import say
from gsp.errors import InvalidInput, expected
from gsp.files.writing import check_writable
from gsp.geometry.pose import Pose
from gsp.model.design.tables import design_from_table


def import_table(
    file: Annotated[
        Path,
        typer.Argument(
            help="A table with one row per leg: .csv, .parquet or .xlsx.", metavar="FILE"
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
            help="Unit of length of the table, such as mm. Default: none is stated.",
            show_default=False,
        ),
    ] = "",
    name: Annotated[
        str | None,
        typer.Option(help="Name of the design. Default: that of FILE.", show_default=False),
    ] = None,
    home: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            help="Position of the platform in the home pose, in the unit of the table; without a "
            "rotation. Default: no home pose.",
            metavar="X Y Z",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Write a design file from a table of anchor points.

    The columns are base_x, base_y, base_z, platform_x, platform_y, platform_z, and where they are
    needed constraints, directions (base_dx …) and strokes (stroke_low, stroke_high). Common other
    names are read as well: bx, px, x_base, lmin …

    **Examples**

    - `gsp import anchors.csv --unit mm --home 0 0 150`
    """
    if not file.name:
        raise InvalidInput(expected("FILE", "the path of a table", "a folder, or an empty text"))
    target = out or Path(file.stem + ".toml")
    check_writable(target, overwrite=force, suffixes=(".toml",))
    for coordinate in home or ():
        arguments.number("--home", coordinate)
    design = design_from_table(
        file,
        unit=unit,
        name=file.stem if name is None else name,
        home=None if home is None else Pose(home),
    )
    design.write(target, overwrite=force)
    say(str(target))
