"""`gsp forward` and `gsp inverse`: poses of joint values, and joint values of poses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.numbers import read_rows
from gsp.cli.inputs.options import Angles, Force, Order, Out, Position
from gsp.cli.inputs.poses import pose_of
from gsp.cli.outputs.console import number, plain_table, say, show_table
from gsp.errors import InvalidInput
from gsp.files.tables import check_table, write_table
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.kinematics.forward_solution import ForwardSolution
from gsp.kinematics.forward_solution import forward as solve
from gsp.model.design import Design

if TYPE_CHECKING:
    import pandas as pd

POSE = ("x", "y", "z", "angle_1", "angle_2", "angle_3")
# Rows of a table that are printed.
PRINTED = 20


def forward(
    design: Annotated[str, typer.Argument(help="Published design, or a design file (.toml).")],
    joints: Annotated[
        str,
        typer.Option(
            help="Joint values in the order of the design, or a .csv, .parquet or .xlsx file with "
            "one column per joint. Distances in the unit of the design, angles in rad.",
            metavar="VALUES",
        ),
    ],
    position: Position = None,
    angles: Angles = None,
    order: Order = "rpy",
    out: Out = None,
    force: Force = False,
) -> None:
    """Find the poses that have given joint values, near a guess.

    The guess is `--position` and `--angles`, or the home pose of the design. A path of regular
    postures connects each pose that is found to the guess.

    **Examples**

    - `gsp forward toz-kucuk-2016-d3-6 --joints "146 120 151 128 126 135"`

    - `gsp forward mine.toml --joints log.csv --out poses.csv`
    """
    if out is not None:
        check_table(out, overwrite=force)
    found = find_design(design)
    guess = pose_of(found, position, angles, order)
    if guess is None:
        raise InvalidInput("--position: expected a guess, as the design has no home pose")
    rows = read_rows("--joints", joints, found.joint_names, gaps=True)
    table = forward_table(found, rows, solve(found, rows, guess), order)
    _print(table, ("status", *POSE), f"{found.name}: poses; position in {found.unit or 'units'}")
    if out is not None:
        write_table(table, out, _metadata(found, order), overwrite=force)
        say(f"Table      {out}")


def inverse(
    design: Annotated[str, typer.Argument(help="Published design, or a design file (.toml).")],
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
    found = find_design(design)
    if poses is None:
        pose = pose_of(found, position, angles, order)
    elif position is not None or angles is not None:
        raise InvalidInput("--poses: expected neither --position nor --angles beside it")
    else:
        rows = np.atleast_2d(read_rows("--poses", poses, POSE))
        pose = Pose.from_angles(rows[:, :3], rows[:, 3:], order, degrees=True)
    if pose is None:
        raise InvalidInput("--position: expected three numbers, as the design has no home pose")
    table = inverse_table(found, pose, order)
    _print(table, found.joint_names, f"{found.name}: joint values")
    if out is not None:
        write_table(table, out, _metadata(found, order), overwrite=force)
        say(f"Table      {out}")


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
        **_columns(found.pose, order),
    )


def inverse_table(design: Design, pose: Pose, order: str) -> pd.DataFrame:
    """Return one row per pose: the pose in degrees, and its joint values."""
    import pandas as pd

    joints = np.atleast_2d(design.at(pose).joints)
    names = design.joint_names
    return pd.DataFrame({**_columns(pose, order), **dict(zip(names, joints.T, strict=True))})


def _columns(pose: Pose, order: str) -> dict[str, Array]:
    angles = np.atleast_2d(pose.angles(order, degrees=True))
    values = np.concatenate((np.atleast_2d(pose.position), angles), axis=1)
    return dict(zip(POSE, values.T, strict=True))


def _print(table: pd.DataFrame, columns: tuple[str, ...], title: str) -> None:
    say(title, "bold")
    printed = plain_table(*columns, right=tuple(c for c in columns if c != "status"))
    for row in table.head(PRINTED).to_dict("records"):
        cells = (row[name] for name in columns)
        printed.add_row(*(x if isinstance(x, str) else number(x, 7) for x in cells))
    show_table(printed)
    if len(table) > PRINTED:
        say(f"{len(table) - PRINTED} more rows; --out FILE writes all of them.")


def _metadata(design: Design, order: str) -> dict[str, object]:
    units = dict(zip(design.joint_names, design.joint_units, strict=True))
    return {
        "design": design.name,
        "source": design.source,
        "unit_of_length": design.unit,
        "units_of_joints": units,
        "angles": f"{order}, degrees",
    }
