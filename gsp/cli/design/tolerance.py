"""`gsp tolerance`: what manufacturing errors do to the pose, or to what a task wants."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import (
    Angles,
    DesignName,
    Force,
    Order,
    Out,
    Position,
    Workers,
    refuse_unused,
)
from gsp.cli.inputs.poses import pose_of
from gsp.cli.outputs.console import number, plain_table, say, show_table, warn
from gsp.errors import InvalidInput, expected
from gsp.exploration import (
    Deviations,
    IndexTolerance,
    PoseTolerance,
    index_tolerance,
    pose_tolerance,
    read_task,
)
from gsp.files.tables import check_table, write_table
from gsp.model.design import Design

if TYPE_CHECKING:
    import pandas as pd

# Parts of legs that are listed, those that matter most, and the share of copies of a bound.
MOST_ROWS, COVERED_SHARE = 12, 0.95
UNIT = "in the unit of the design"
DISPLACEMENTS = ("dx", "dy", "dz", "turn_x", "turn_y", "turn_z")


def _size(help_text: str) -> Any:
    return typer.Option(help=help_text, min=0.0)


def tolerance(
    context: typer.Context,
    design: DesignName,
    base: Annotated[float, _size(f"Error of a coordinate of a base point, {UNIT}.")] = 0.0,
    platform: Annotated[float, _size(f"Error of a coordinate of a platform point, {UNIT}.")] = 0.0,
    base_lines: Annotated[float, _size("Error of a turn of a base line [rad].")] = 0.0,
    platform_lines: Annotated[float, _size("Error of a turn of a platform line [rad].")] = 0.0,
    joints: Annotated[float, _size(f"Error of a joint zero point, {UNIT} or in rad.")] = 0.0,
    uniform: Annotated[
        bool,
        typer.Option(
            "--uniform", help="Errors are half widths of uniform ones, not standard deviations."
        ),
    ] = False,
    task: Annotated[
        Path | None,
        typer.Option(
            help="A task (.toml): the effect on what it wants of indices. Default: the effect on "
            "the pose.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    position: Position = None,
    angles: Angles = None,
    order: Order = "rpy",
    point: Annotated[
        tuple[float, float, float],
        typer.Option(help="The point that is displaced, in platform axes.", metavar="X Y Z"),
    ] = (0.0, 0.0, 0.0),
    samples: Annotated[int, typer.Option(help="Number of manufactured copies.", min=2)] = 1024,
    seed: Annotated[int, typer.Option(help="Seed of the copies.", min=0)] = 0,
    workers: Workers = None,
    out: Out = None,
    force: Force = False,
) -> None:
    """Compute what manufacturing errors do to the pose, or to what a task wants.

    Copies of the design are drawn, and each stands at the joint values of DESIGN, or is evaluated
    for a task. `--out` has one row per copy.

    **Examples**

    - `gsp tolerance mine.toml --base 0.1 --platform 0.1 --joints 0.02`

    - `gsp tolerance mine.toml --base 0.1 --task task.toml --out copies.parquet`
    """
    if out is not None:
        check_table(out, overwrite=force)
    found = find_design(design)
    if not any((base, platform, base_lines, platform_lines, joints)):
        options = "--base, --platform, --base-lines, --platform-lines and --joints"
        raise InvalidInput(expected("gsp tolerance", f"an error > 0 by one of {options}", "none"))
    errors = Deviations(
        base_points=base,
        platform_points=platform,
        base_directions=base_lines,
        platform_directions=platform_lines,
        joints=joints,
        distribution="uniform" if uniform else "normal",
    )
    if task is None:
        refuse_unused(context, ["workers"], "a pose: expected --task")
        pose = pose_of(found, position, angles, order)
        if pose is None:
            raise InvalidInput("--position: expected three numbers, as there is no home pose")
        copies = _of_pose(
            found, pose_tolerance(found, pose, errors, point=point, samples=samples, seed=seed)
        )
    else:
        refuse_unused(context, ["position", "angles", "order", "point", "joints"], "--task")
        wanted = read_task(task)
        copies = _of_task(
            found,
            index_tolerance(found, wanted, errors, samples=samples, seed=seed, workers=workers),
        )
    if out is not None:
        facts = {"design": found.name, "seed": seed, "samples": samples}
        write_table(copies, out, facts, overwrite=force)
        say(f"Table      {out}")


def _of_pose(design: Design, found: PoseTolerance) -> pd.DataFrame:
    """Print the displacements of a pose, and return those of each copy with its errors."""
    import pandas as pd

    unit = design.unit or "units"
    _title(design, len(found.displacements))
    length, turn = found.quantiles(COVERED_SHARE)
    first = np.sqrt(np.diagonal(found.first_order))
    shown = plain_table("", unit, "rad", title="Displacement", right=(unit, "rad"))
    shown.add_row("95 % of the copies within", number(length), number(turn))
    for axis, one, two in zip("xyz", first[:3], first[3:], strict=True):
        shown.add_row(f"standard deviation, {axis}, to first order", number(one), number(two))
    show_table(shown)
    if found.lost:
        warn(f"no pose was found for {100.0 * float(found.lost):.3g} % of the copies")
    _shares(found.shares())
    copies = pd.DataFrame(found.errors, columns=list(found.names))
    return copies.join(pd.DataFrame(found.displacements, columns=list(DISPLACEMENTS)))


def _of_task(design: Design, found: IndexTolerance) -> pd.DataFrame:
    """Print the distribution of what a task wants, and return the values of each copy."""
    _title(design, len(found.samples))
    names = ("nominal", "mean", "deviation", "first_order", "low", "high")
    shown = plain_table("value", *names, title="95 % of the copies: low to high", right=names)
    for label, row in found.table.iterrows():
        shown.add_row(str(label), *(number(float(row[name])) for name in names))
    show_table(shown)
    _shares(found.shares)
    return found.samples


def _title(design: Design, copies: int) -> None:
    say(f"{design.name or 'unnamed'}: {copies} copies", "bold")


def _shares(table: pd.DataFrame) -> None:
    """Print which parts of legs matter most."""
    values = [str(name) for name in table if name not in ("part", "leg")]
    title = "Shares of the variance, to first order"
    shown = plain_table("part", "leg", *values, title=title, right=("leg", *values))
    for row in table.head(MOST_ROWS).to_dict("records"):
        shares = (number(float(row[name]), 3) for name in values)
        shown.add_row(str(row["part"]), str(row["leg"]), *shares)
    show_table(shown)
