"""Options that several commands share, and how their texts are read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import rotation_from_angles
from gsp.model.design import Design

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
        help="Orientation in degrees, in the order of --order. Default: none (0 0 0) with "
        "--position, else that of the home pose.",
        metavar="A B C",
        show_default=False,
    ),
]
Template = Annotated[
    str,
    typer.Option(
        help="Design on whose anchor lines mechanisms go: a name or a file.", metavar="DESIGN"
    ),
]
TEMPLATE = "toz-kucuk-2016-d3-6"


def pose_of(
    design: Design,
    position: tuple[float, float, float] | None,
    angles: tuple[float, float, float] | None,
    order: str,
) -> Pose | None:
    """Return the pose that the options give; the home pose, if any, fills what they leave open."""
    rotation_from_angles((0.0, 0.0, 0.0), order)  # refuses an unknown order in any case
    home = design.home
    if position is None and angles is None:
        return home
    if position is None:
        if home is None:
            raise InvalidInput("--position: expected three numbers, as there is no home pose")
        return Pose.from_angles(home.position, angles or (0.0,) * 3, order, degrees=True)
    return Pose.from_angles(position, angles or (0.0,) * 3, order, degrees=True)


def read_box(text: str, order: str = "rpy") -> PoseBox:
    """Read a box of poses: six intervals low:high (x, y, z, then three angles in degrees).

    >>> read_box("-10:10 -10:10 120:140 -5:5 -5:5 0").high.round(3)
    array([1.0e+01, 1.0e+01, 1.4e+02, 8.7e-02, 8.7e-02, 0.0e+00])
    """
    words = text.replace(",", " ").split()
    try:
        intervals = [tuple(float(end) for end in word.split(":")) for word in words]
    except ValueError as error:
        raise InvalidInput(_box_message(text)) from error
    if len(intervals) != 6 or any(len(ends) not in (1, 2) for ends in intervals):
        raise InvalidInput(_box_message(text))
    pairs: list[Any] = [(ends[0], ends[-1]) for ends in intervals]
    return PoseBox(pairs[:3], pairs[3:], degrees=True, order=order)


def _box_message(text: str) -> str:
    wanted = "six intervals low:high (x y z in the unit of the design, three angles in degrees)"
    return expected("--box", wanted, repr(text))


def box_text(box: PoseBox, unit: str) -> str:
    """Return a box as one line, angles in degrees."""
    low, high = (np.concatenate((ends[:3], np.rad2deg(ends[3:]))) for ends in (box.low, box.high))
    names = ("x", "y", "z", "α", "β", "γ")
    parts = [f"{n} {a:.4g}…{b:.4g}" for n, a, b in zip(names, low, high, strict=True)]
    return f"{', '.join(parts[:3])} {unit}; ".replace(" ;", ";") + f"{', '.join(parts[3:])}°"
