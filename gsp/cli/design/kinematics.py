"""`gsp forward` and `gsp inverse`: poses of joint values, and joint values of poses."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
import typer

from gsp.cli.design.modes import all_modes
from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.numbers import read_rows, read_table
from gsp.cli.inputs.options import (
    Angles,
    DesignName,
    Force,
    Order,
    Out,
    Position,
    refuse_order,
    refuse_unused,
)
from gsp.cli.inputs.poses import pose_of
from gsp.cli.outputs.console import counted, say, warn
from gsp.cli.outputs.headings import motion_headings
from gsp.cli.outputs.pictures import check_picture
from gsp.cli.outputs.poses import pose_columns, print_rows
from gsp.errors import InvalidInput, brief, expected
from gsp.files.tables import check_table, write_table
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import POSE_COLUMNS
from gsp.geometry.vectors import Array
from gsp.kinematics.forward_solution import ForwardSolution
from gsp.kinematics.forward_solution import forward as solve
from gsp.model.design import Design
from gsp.model.posture import Posture

if TYPE_CHECKING:
    import pandas as pd

# Joint values that no joint can have, or that poses do not have, are listed up to this number.
MOST_REASONS = 5


def forward(
    context: typer.Context,
    design: DesignName,
    joints: Annotated[
        str,
        typer.Option(
            help="Joint values in the order of the design, or a .csv, .parquet or .xlsx file with "
            "one column per joint. Distances in the unit of the design, angles in rad.",
            metavar="VALUES|FILE",
        ),
    ],
    position: Position = None,
    angles: Angles = None,
    order: Order = "rpy",
    fallback: Annotated[
        str | None,
        typer.Option(
            help="modes: where no path of regular postures leads to a pose, take the nearest of "
            "all assembly modes.",
            metavar="WAY",
            show_default=False,
        ),
    ] = None,
    every: Annotated[
        bool, typer.Option("--all", help="Find all poses with the joint values of one pose.")
    ] = False,
    certify: Annotated[
        bool, typer.Option("--certify", help="With --all: prove each pose in ball arithmetic.")
    ] = False,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="With --all: draw the poses, to this file: .png, .pdf or .svg.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    out: Out = None,
    force: Force = False,
) -> None:
    """Find the poses that have given joint values, near a guess, or all of them.

    The guess is `--position` and `--angles`, or the home pose of the design. A path of regular
    postures connects each pose that is found to the guess.

    **Examples**

    - `gsp forward toz-kucuk-2016-d3-6 --joints "146 120 151 128 126 135"`

    - `gsp forward mine.toml --joints log.csv --out poses.csv`

    - `gsp forward lee-2000-3-3 --joints "1.4 1.4 1.4 1.4 1.4 1.4" --all --plot modes.png`
    """
    if out is not None:
        check_table(out, overwrite=force)
    if every:
        refuse_unused(context, ["position", "angles", "fallback"], "--all, which needs no guess")
    else:
        refuse_unused(
            context,
            ["certify", "plot"],
            "a guess: expected --all, which takes the joint values of one pose",
        )
    if plot is not None:
        check_picture(plot, overwrite=force)
    found = find_design(design)
    if every:
        rows = read_rows("--joints", joints, found.joint_names, gaps=True)
        table = all_modes(found, rows, order, certify=certify, plot=plot, force=force)
        _write(table, out, found, order, force=force)
        return
    guess = pose_of(found, position, angles, order)
    if guess is None:
        raise InvalidInput("--position: expected a guess, as the design has no home pose")
    rows = read_rows("--joints", joints, found.joint_names, gaps=True)
    ends = solve(found, rows, guess, fallback=_fallback(fallback))
    table = forward_table(found, rows, ends, order)
    say(f"{found.name}: poses; position in {found.unit or 'units'}", "bold")
    print_rows(table, ("status", *POSE_COLUMNS), text=("status",))
    _warn_of_undefined(found, rows, guess, ends)
    _write(table, out, found, order, force=force)


def inverse(
    context: typer.Context,
    design: DesignName,
    position: Position = None,
    angles: Angles = None,
    poses: Annotated[
        str | None,
        typer.Option(
            help="A .csv, .parquet or .xlsx file of poses with the columns x, y, z, angle_1, "
            "angle_2, angle_3; angles in degrees, in the order of --order.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    order: Order = "rpy",
    out: Out = None,
    force: Force = False,
) -> None:
    """Print the joint values of poses.

    Distances are in the unit of the design, angles in rad.

    **Examples**

    - `gsp inverse toz-kucuk-2016-d3-6 --position 10 -10 138 --angles 5 -5 -10`

    - `gsp inverse mine.toml --poses path.csv --out joints.csv`
    """
    if out is not None:
        check_table(out, overwrite=force)
    elif poses is None:
        refuse_order(context, angles)
    found = find_design(design)
    if poses is None:
        pose = pose_of(found, position, angles, order)
    elif position is not None or angles is not None:
        raise InvalidInput("--poses: expected neither --position nor --angles beside it")
    else:
        rows = read_table("--poses", poses, POSE_COLUMNS)
        pose = Pose.from_angles(rows[:, :3], rows[:, 3:], order, degrees=True)
    if pose is None:
        raise InvalidInput("--position: expected three numbers, as the design has no home pose")
    posture = found.at(pose)
    table = inverse_table(posture, order)
    say(f"{found.name}: joint values", "bold")
    print_rows(table, found.joint_names)
    _warn_of_values(posture)
    _write(table, out, found, order, force=force)


def forward_table(
    design: Design, joints: Array, found: ForwardSolution, order: str
) -> pd.DataFrame:
    """Return one row per sample: joint values, status, residual, steps, pose in degrees."""
    import pandas as pd

    values = np.atleast_2d(joints)
    table = pd.DataFrame(dict(zip(design.joint_names, values.T, strict=True)))
    return table.assign(
        status=np.atleast_1d(found.status),
        residual=np.atleast_1d(found.residual),
        iterations=np.atleast_1d(found.iterations),
        **pose_columns(found.pose, order),
    )


def _warn_of_undefined(design: Design, joints: Array, guess: Pose, found: ForwardSolution) -> None:
    """State why poses are undefined: joint values that a joint cannot have, or the guess."""
    values = np.atleast_2d(joints)
    turns, drives = design.angular, np.array([row.constraint.driven for row in design.rows])
    lost = np.atleast_1d(found.status) == "undefined"
    inside = (values > 0.0) & (values < np.where(turns, np.pi, np.inf)) | (~turns & (values == 0.0))
    inside = np.where(drives, np.isfinite(values), inside)
    of_guess = int((lost & inside.all(axis=-1)).sum())
    if of_guess:
        reasons = "; ".join(f"{each.joint}: {each.reason}" for each in design.at(guess).undefined)
        warn(f"{counted(of_guess, 'pose')} undefined, as the guess has undefined legs: {reasons}")
    wrong = np.argwhere(~inside & lost[:, None])
    for row, joint in wrong[:MOST_REASONS]:
        wanted = "an angle between 0 and π" if turns[joint] else "a finite distance ≥ 0"
        wanted = "a finite number" if drives[joint] else wanted
        where = f"row {row + 1}: " if len(values) > 1 else ""
        given = f"{values[row, joint]:.6g}"
        warn(f"undefined: {where}{expected(design.joint_names[joint], wanted, given)}")
    if len(wrong) > MOST_REASONS:
        warn(f"undefined: {counted(len(wrong) - MOST_REASONS, 'such joint value')} more")


def inverse_table(posture: Posture, order: str) -> pd.DataFrame:
    """Return one row per pose: the pose in degrees, and its joint values."""
    import pandas as pd

    joints, names = np.atleast_2d(posture.joints), posture.joint_names
    poses = pose_columns(posture.pose, order)
    return pd.DataFrame({**poses, **dict(zip(names, joints.T, strict=True))})


def _warn_of_values(posture: Posture) -> None:
    """State why joints have no value."""
    lost, most = posture.undefined, max(MOST_REASONS, len(posture.joint_names))
    for element in lost[:most]:
        where = f"row {element.pose[0] + 1}: " if element.pose else ""
        warn(f"{where}{element.joint} is undefined: {element.reason}")
    if len(lost) > most:
        warn(f"undefined: {counted(len(lost) - most, 'joint value')} more")


def _fallback(text: str | None) -> Literal["modes"] | None:
    if text not in (None, "modes"):
        raise InvalidInput(expected("--fallback", "modes", brief(text)))
    return None if text is None else "modes"


def _write(
    table: pd.DataFrame, out: Path | None, design: Design, order: str, *, force: bool
) -> None:
    if out is not None:
        facts, headings = _metadata(design, order), motion_headings(design)
        write_table(table, out, facts, headings=headings, overwrite=force)
        say(f"Table      {out}")


def _metadata(design: Design, order: str) -> dict[str, object]:
    units = dict(zip(design.joint_names, design.joint_units, strict=True))
    return {
        "design": design.name,
        "source": design.source,
        "unit_of_length": design.unit,
        "units_of_joints": units,
        "angles": f"{order}, degrees",
    }
