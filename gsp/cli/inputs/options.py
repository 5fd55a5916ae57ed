"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Out = Annotated[
    Path | None,
    typer.Option(
        help="Write the table to this file: .csv, .parquet, .md or .tex.", show_default=False
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Overwrite files that exist.")]
Order = Annotated[
    str,
    typer.Option(
        help='Angle set: "rpy" (R = Rz Ry Rx), "approach-roll" (R = Ry Rx Rz), or axes such as '
        '"ZYX" (moving) or "zyx" (fixed).'
    ),
]

Position = Annotated[
    tuple[float, float, float] | None,
    typer.Option(
        help="Platform origin, in the unit of the design. Default: the home pose of the design.",
        metavar="X Y Z",
        show_default=False,
    ),
]
Angles = Annotated[
    tuple[float, float, float] | None,
    typer.Option(
        help="Orientation in degrees, in the order of --order. Default: 0 0 0 with --position, "
        "else that of the home pose.",
        metavar="A B C",
        show_default=False,
    ),
]
Template = Annotated[
    str,
    typer.Option(
        help="Design on whose anchor lines a mechanism is placed: a name or a file.",
        metavar="DESIGN",
    ),
]
TEMPLATE = "toz-kucuk-2016-d3-6"
