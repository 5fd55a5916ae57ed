"""`gsp report`: all that is known about a design, as one HTML page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import (
    Angles,
    DesignName,
    Force,
    Length,
    Order,
    Position,
    check_length,
    refuse_order,
)
from gsp.cli.inputs.poses import pose_of
from gsp.cli.outputs.console import say
from gsp.errors import InvalidInput
from gsp.exploration import read_task
from gsp.files.names import file_stem
from gsp.files.writing import check_writable, write_text
from gsp.installed import check_installed


def report(
    context: typer.Context,
    design: DesignName,
    task: Annotated[
        Path | None,
        typer.Option(
            help="A task (.toml): its poses and limits are proven, and mechanisms on the same "
            "anchor lines are compared for it.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    position: Position = None,
    angles: Angles = None,
    order: Order = "rpy",
    length: Length = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="File to write (.html). Default: named after the design, here.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Write a report of a design: one HTML page that opens offline and can be printed.

    It has the design in space, dimensions, joints and strokes, Jacobian, indices with their
    meaning, sections and volume of the workspace, proven poses, the distance to singularity,
    actuator forces, and a comparison with the catalogue. It takes some seconds.

    **Examples**

    - `gsp report workspace-6-3`

    - `gsp report mine.toml --task assembly.toml --out mine.html`
    """
    check_installed("nicegui", "the report of a design", "app")
    refuse_order(context, angles)
    check_length(length)
    found = find_design(design)
    target = out or Path(file_stem(found.name) + ".html")
    check_writable(target, overwrite=force, suffixes=(".html",))
    pose = pose_of(found, position, angles, order)
    if pose is None:
        raise InvalidInput("--position: expected three numbers, as the design has no home pose")
    wanted = None if task is None else read_task(task)
    from gsp.app.report import report as report_of

    words = ["gsp report", design, *(["--task", str(task)] if task else [])]
    page = report_of(found, pose, wanted, length=length, command=" ".join(words))
    write_text(target, page, overwrite=force)
    say(f"Report     {target}")
