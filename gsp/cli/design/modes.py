"""`gsp forward --all`: every assembly mode of joint values."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gsp.cli.outputs.console import number, say, warn
from gsp.cli.outputs.pictures import save_picture
from gsp.cli.outputs.poses import pose_columns, print_rows
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose.texts import POSE_COLUMNS
from gsp.geometry.vectors import Array
from gsp.kinematics.modes import AssemblyModes, assembly_modes
from gsp.kinematics.modes.modes import STATUS_MEANINGS
from gsp.model.design import Design

if TYPE_CHECKING:
    import pandas as pd

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
    table = modes_table(modes, order)
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


def _print(table: pd.DataFrame, *, certify: bool) -> None:
    shown = table.assign(
        det_j=[SIDES.get(float(side), "undefined") for side in table["side"]],
        condition=[number(c, 4) for c in table["condition"]],
    )
    words = ("mode", "det_j", "condition", *(("certified",) if certify else ()))
    print_rows(shown, (*words, *POSE_COLUMNS), text=words)


def modes_table(modes: AssemblyModes, order: str) -> pd.DataFrame:
    """Return one row per mode: sign of det J, condition, multiplicity, certificate, pose."""
    import pandas as pd

    return pd.DataFrame(
        {
            "mode": np.arange(1, len(modes.side) + 1),
            "side": modes.side,
            "condition": modes.condition,
            "multiplicity": modes.multiplicity,
            "residual": modes.residual,
            "certified": modes.certified,
            **pose_columns(modes.poses, order),
        }
    )


def _title(design: Design, modes: AssemblyModes) -> str:
    if not modes.n_paths:
        return f"{design.name}: no assembly mode was searched"
    total = modes.n_complex + modes.n_singular
    return f"{design.name}: {len(modes.side)} real of {total} complex assembly modes"
