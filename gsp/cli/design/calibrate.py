"""`gsp calibrate`: the dimensions of a machine from a table of measurements."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import typer

from gsp.calibration import Calibration, calibrate
from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.numbers import read_table
from gsp.cli.inputs.options import DesignName, Force, Order, Out, refuse_unused
from gsp.cli.outputs.console import counted, number, plain_table, say, show_table, warn
from gsp.errors import InvalidInput, expected
from gsp.files.cells import table_rows
from gsp.files.tables import check_table, write_table
from gsp.files.writing import check_writable
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import POSE_COLUMNS
from gsp.model.design import Design

# Names of columns that look like those of joints.
JOINT_COLUMN = re.compile(r"(d|theta)\d+")
# Coordinates that the table on the terminal lists, those that deviate most.
MOST_ROWS = 12


def calibrate_command(
    context: typer.Context,
    design: DesignName,
    measurements: Annotated[
        Path,
        typer.Argument(
            help="A table (.csv, .parquet or .xlsx), one row per pose: the readings of the joints "
            "(d1, d2 …), and what was measured of the pose: x, y, z, angle_1, angle_2, angle_3 "
            "[degrees], or x, y, z alone, or nothing.",
            metavar="MEASUREMENTS",
        ),
    ],
    point: Annotated[
        tuple[float, float, float],
        typer.Option(
            help="The point whose place x, y, z is, in platform axes; without angles only.",
            metavar="X Y Z",
        ),
    ] = (0.0, 0.0, 0.0),
    guess: Annotated[
        Path | None,
        typer.Option(
            help="A table of poses (x, y, z, angle_1, angle_2, angle_3 [degrees]) near those of "
            "the measurements, where their angles are not known: one row, or one per measurement. "
            "Default: the home pose.",
            metavar="POSES",
            show_default=False,
        ),
    ] = None,
    joint_errors: Annotated[
        float | None,
        typer.Option(
            help="Standard error of the readings, in the unit of the design. Default: it is "
            "estimated from the residuals.",
            show_default=False,
        ),
    ] = None,
    pose_errors: Annotated[
        tuple[float, float] | None,
        typer.Option(
            help="Standard errors of each coordinate of a place, and of a rotation [rad]. Default: "
            "poses are exact.",
            metavar="LENGTH ANGLE",
            show_default=False,
        ),
    ] = None,
    loss: Annotated[
        Literal["linear", "soft_l1", "huber", "cauchy", "arctan"],
        typer.Option(help="How much large residuals count; other than linear: --joint-errors."),
    ] = "linear",
    order: Order = "rpy",
    write: Annotated[
        Path | None,
        typer.Option(
            help="Write the design that was found to this file (.toml).",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    out: Out = None,
    force: Force = False,
) -> None:
    """Find the dimensions and joint zero points of a machine from measurements.

    Prints how well the data fit, what they do not determine, and what deviates most from DESIGN,
    the nominal one. `--out` has all coordinates, with their standard errors.

    **Examples**

    - `gsp calibrate mine.toml log.csv --write calibrated.toml --out report.csv`

    - `gsp calibrate mine.toml log.csv --joint-errors 0.01 --pose-errors 0.02 1e-4`

    - `gsp calibrate mine.toml readings.csv --guess commanded.csv`
    """
    if write is not None:
        check_writable(write, overwrite=force, suffixes=(".toml",))
    if out is not None:
        check_table(out, overwrite=force)
    nominal = find_design(design)
    readings, poses = measured(nominal, measurements, order)
    _refuse_unused(context, poses, guess)
    errors: Any = pose_errors
    if pose_errors is not None and not isinstance(poses, Pose):
        errors = pose_errors[0]
    found = calibrate(
        nominal,
        readings,
        poses,
        point=point,
        guess=guessed(guess, order),
        joint_errors=joint_errors,
        pose_errors=errors,
        loss=loss,
    )
    _report(found, len(readings), measurements)
    if write is not None:
        found.design.write(write, overwrite=force)
        say(f"Design     {write}")
    if out is not None:
        facts = {"design": nominal.name, "measurements": str(measurements), **_facts(found)}
        write_table(found.table(), out, facts, overwrite=force)
        say(f"Table      {out}")


def measured(design: Design, path: Path, order: str) -> tuple[Any, Any]:
    """Return the readings (k, n) of a table, and its poses, its places (k, 3), or None.

    Raises
    ------
    InvalidInput, MalformedFile
    """
    readings = read_table("MEASUREMENTS", path, design.joint_names)
    _, header = next(table_rows(path))
    known = {*design.joint_names, *POSE_COLUMNS}
    others = [name for name in header if JOINT_COLUMN.fullmatch(name) and name not in known]
    if others:
        warn(f"{path}: {', '.join(others)}: no joint of {design.name or 'the design'}, not used")
    there = [name for name in POSE_COLUMNS if name in header]
    if not there:
        return readings, None
    if there == list(POSE_COLUMNS[:3]):
        return readings, read_table("MEASUREMENTS", path, POSE_COLUMNS[:3])
    if there != list(POSE_COLUMNS):
        wanted = f"{', '.join(POSE_COLUMNS)}, or x, y, z alone"
        raise InvalidInput(expected(str(path), wanted, ", ".join(there)))
    return readings, _poses("MEASUREMENTS", path, order)


def guessed(path: Path | None, order: str) -> Pose | None:
    """Return the poses of a table, a single one for one row; None for no table.

    Raises
    ------
    InvalidInput, MalformedFile
    """
    if path is None:
        return None
    poses = _poses("--guess", path, order)
    return poses[0] if len(poses) == 1 else poses


def _poses(option: str, path: Path, order: str) -> Pose:
    numbers = read_table(option, path, POSE_COLUMNS)
    return Pose.from_angles(numbers[:, :3], numbers[:, 3:], order, degrees=True)


def _refuse_unused(context: typer.Context, poses: Any, guess: Path | None) -> None:
    """Raise InvalidInput on options that have no effect beside what was measured of the poses."""
    if isinstance(poses, Pose):
        refuse_unused(context, ["point", "guess"], "measured angles: expected x, y, z alone")
    elif poses is None:
        refuse_unused(context, ["point", "pose_errors"], "a table without places")
    if guess is None and not isinstance(poses, Pose):
        refuse_unused(context, ["order"], "a table without angles")


def _facts(found: Calibration) -> dict[str, Any]:
    return {
        "chi_squared": found.chi_squared,
        "degrees_of_freedom": found.degrees_of_freedom,
        "converged": found.converged,
        "iterations": found.iterations,
        "not_identified": list(found.not_identified),
        "zero_points": found.zero_points.tolist(),
    }


def _report(found: Calibration, k: int, path: Path) -> None:
    size = float(np.sqrt((found.residuals**2).mean()))
    known = f"{int(found.identified.sum())} of {len(found.names)} coordinates"
    if not found.converged:
        known = f"not converged. Where the search ended, the data determine {known}"
    say(f"{counted(k, 'pose')} of {path}: {known}", "bold")
    say(f"Residuals  {number(size)} (root mean square of the readings)")
    fit = f"{number(found.chi_squared)} for {found.degrees_of_freedom} degrees of freedom"
    say(f"χ²         {fit}")
    for what in found.not_identified:
        say(f"Not known  {what}")
    if not found.converged:
        warn(
            f"not converged after {counted(found.iterations, 'iteration')}: dimensions, errors and "
            "what is not known are those of no minimum"
        )
    table = found.table()
    sizes = table["deviation"].abs().sort_values(ascending=False, kind="stable")
    names = ("name", "nominal", "value", "deviation", "standard_error")
    shown = plain_table(*names, title="What deviates most", right=names[1:])
    for row in table.loc[sizes.index].head(MOST_ROWS).to_dict("records"):
        shown.add_row(row["name"], *(number(float(row[name]), 6) for name in names[1:]))
    show_table(shown)
