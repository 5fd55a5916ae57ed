"""`gsp forward --all` and `gsp planar --joints`: every assembly mode of joint values."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gsp.cli.inputs.numbers import read_rows
from gsp.cli.outputs.console import counted, number, say, warn
from gsp.cli.outputs.pictures import save_picture
from gsp.cli.outputs.poses import pose_columns, print_rows
from gsp.errors import InvalidInput, expected
from gsp.files.tables import check_table, write_table
from gsp.geometry.pose.texts import POSE_COLUMNS
from gsp.geometry.vectors import Array
from gsp.kinematics.modes import AssemblyModes, assembly_modes
from gsp.kinematics.modes.modes import STATUS_MEANINGS
from gsp.kinematics.planar import planar_modes
from gsp.model.design import Design
from gsp.planar import PlanarDesign

if TYPE_CHECKING:
    import pandas as pd

# What is not found of planar platforms.
PLANAR_STATUS = {
    "moving": STATUS_MEANINGS["moving"],
    "incomplete": "a joint value is more than 1e6 times the size of the design",
    "undefined": STATUS_MEANINGS["undefined"],
}
# Words for the sign of det J.
SIDES = {-1.0: "-", 0.0: "singular", 1.0: "+"}


def all_modes(
    design: Design, joints: Array, order: str, *, certify: bool, plot: Path | None, force: bool
) -> pd.DataFrame:
    """Print the modes of joint values, draw them if that is required, and return their table.

    Parameters
    ----------
    joints : (6,) array [unit of the design, rad]
    """
    if joints.ndim != 1:
        if len(joints) != 1:
            got = f"{len(joints)} rows"
            raise InvalidInput(expected("--all", "the joint values of one pose", got))
        joints = joints[0]
    if len(design.joint_names) != 6:
        got = f"{len(design.joint_names)} of {design.name}"
        raise InvalidInput(expected("--all", "a design with six actuators", got))
    modes = assembly_modes(design, joints, certify=certify)
    table = modes_table(design, modes, order)
    unit = design.unit or "units"
    say(f"{_title(design, modes)}; position in {unit}, angles {order} in degrees", "bold")
    if len(table):
        _print(table, certify=certify)
    if modes.status in STATUS_MEANINGS:
        warn(f"{modes.status}: {STATUS_MEANINGS[modes.status]}")
    if plot is not None and not len(table):
        warn(f"{plot} is not written: there is no real mode to draw")
    elif plot is not None:
        from gsp.plots import assembly_modes as draw

        save_picture(draw(design, modes), plot, overwrite=force)
    return table


def all_planar_modes(design: PlanarDesign, joints: str, out: Path | None, *, force: bool) -> None:
    """Print the modes of a planar platform, and write them to a table if that is required.

    Parameters
    ----------
    joints : str
        Three values, or the name of a table with one row.
    """
    import pandas as pd

    if out is not None:
        check_table(out, overwrite=force)
    values = np.atleast_2d(read_rows("--joints", joints, design.joint_names, gaps=True))
    if len(values) != 1:
        raise InvalidInput(expected("--joints", "the values of one pose", f"{len(values)} rows"))
    modes = planar_modes(design, values[0])
    table = pd.DataFrame(
        {
            "mode": np.arange(1, len(modes.side) + 1),
            "side": modes.side,
            "x": modes.pose.position[:, 0],
            "y": modes.pose.position[:, 1],
            "angle": np.rad2deg(modes.pose.angle),
            "residual": modes.residual,
        }
    )
    unit = design.unit or "units"
    found = counted(len(table), "assembly mode")
    say(f"{design.name}: {found}; position in {unit}, angle in degrees", "bold")
    if len(table):
        shown = table.assign(det_j=[SIDES[float(side)] for side in table["side"]])
        print_rows(shown, ("mode", "det_j", "x", "y", "angle"), text=("mode", "det_j"))
    if modes.status in PLANAR_STATUS:
        warn(f"{modes.status}: {PLANAR_STATUS[modes.status]}")
    if out is not None:
        facts = {"design": design.name, "unit_of_length": design.unit, "angle": "degrees"}
        write_table(table, out, facts, overwrite=force)
        say(f"Table      {out}")


def _print(table: pd.DataFrame, *, certify: bool) -> None:
    shown = table.assign(
        det_j=[SIDES.get(float(side), "undefined") for side in table["side"]],
        condition=[number(c, 4) for c in table["condition"]],
    )
    labels = [name for name in ("on_branches",) if name in table]
    words = ("mode", "det_j", "condition", *(("certified",) if certify else ()), *labels)
    print_rows(shown, (*words, *POSE_COLUMNS), text=words)


def modes_table(design: Design, modes: AssemblyModes, order: str) -> pd.DataFrame:
    """Return one row per mode: sign of det J, condition, multiplicity, certificate, pose.

    With drives at the base also whether it is on the stated branches.
    """
    import pandas as pd

    branches = {"on_branches": modes.on_branches} if design.driven else {}

    return pd.DataFrame(
        {
            "mode": np.arange(1, len(modes.side) + 1),
            "side": modes.side,
            "condition": modes.condition,
            "multiplicity": modes.multiplicity,
            "residual": modes.residual,
            "certified": modes.certified,
            **branches,
            **pose_columns(modes.poses, order),
        }
    )


def _title(design: Design, modes: AssemblyModes) -> str:
    if not modes.n_paths:
        return f"{design.name}: no assembly mode was searched"
    total = modes.n_complex + modes.n_singular
    return f"{design.name}: {len(modes.side)} real of {total} complex assembly modes"
