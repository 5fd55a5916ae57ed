"""`gsp workspace`: the workspace of a design."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from gsp import arguments
from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import Force, Order, refuse_unused
from gsp.cli.outputs.console import number, say
from gsp.cli.outputs.pictures import check_picture
from gsp.cli.outputs.workspaces import cubic, report_section, report_shells, vertical_plane
from gsp.errors import InvalidInput, brief, expected
from gsp.files.cells import number_of
from gsp.files.tables import check_table
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array
from gsp.model.design import Design

if TYPE_CHECKING:
    from gsp.workspace import Limits

ORDER = "approach-roll"
# Options of the search along rays, which the exact cases do without.
SECTION = ("rays", "starts", "seed", "connecting")


def workspace(
    context: typer.Context,
    design: Annotated[str, typer.Argument(help="Published design, or a design file (.toml).")],
    position: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            help="Point of the vertical plane from which the rays go, in the unit of the design. "
            "Default: the home pose of the design; with --angles, for SPS legs, the origin.",
            metavar="X Y Z",
            show_default=False,
        ),
    ] = None,
    theta: Annotated[
        float, typer.Option(help="Angle of the vertical plane from the x-axis, in degrees.")
    ] = 0.0,
    angles: Annotated[
        str | None,
        typer.Option(
            help='Fixed orientation "α β γ" in degrees, in the order of --order. With an interval '
            'such as "0 0 -30:30": the dextrous workspace. Default: any orientation.',
            metavar="ANGLES",
            show_default=False,
        ),
    ] = None,
    order: Order = ORDER,
    stroke: Annotated[
        tuple[float, float] | None,
        typer.Option(
            help="Least and greatest value of every joint, distances in the unit of the design, "
            "angles in rad. Default: those of the design.",
            metavar="LOW HIGH",
            show_default=False,
        ),
    ] = None,
    index: Annotated[
        list[str] | None,
        typer.Option(
            help='Limit of an index, such as "CTN >= 0.1"; may be repeated.',
            metavar="BOUND",
            show_default=False,
        ),
    ] = None,
    resolution: Annotated[
        float | None,
        typer.Option(
            help="Longest side of the cells that stay undecided in a dextrous workspace, in the "
            "unit of the design. Default: until the volume is known within ±3 %.",
            show_default=False,
        ),
    ] = None,
    rays: Annotated[int, typer.Option(help="Rays around the radiating point.", min=1)] = 24,
    starts: Annotated[int, typer.Option(help="Orientations per ray.", min=1)] = 16,
    seed: Annotated[int, typer.Option(help="Seed of the random orientations.", min=0)] = 0,
    connecting: Annotated[
        bool, typer.Option(help="Follow curves between complete bifurcation points as well.")
    ] = True,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="Draw the section to this file: .png, .pdf or .svg.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write the points of the curves to this file: .csv, .parquet, .xlsx, .md or .tex.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Compute a workspace: bifurcation points and boundary curves in a vertical plane.

    The platform may take any orientation, or a fixed one (--angles; for SPS legs the exact volume
    is printed as well). With an interval of angles the volume of the dextrous workspace is printed.

    **Examples**

    - `gsp workspace workspace-6-3 --plot section.png`

    - `gsp workspace workspace-6-3 --angles "0 0 -30" --theta 15`

    - `gsp workspace workspace-6-3 --angles "0 0 -30:30"`
    """
    from gsp.proof.branching.requirements import with_maximum
    from gsp.workspace import Limits, exact_shells, section

    if plot is not None:
        check_picture(plot, overwrite=force)
    if out is not None:
        check_table(out, overwrite=force)
    arguments.number("--theta", theta)
    for option, values in (("--position", position), ("--stroke", stroke)):
        for value in values or ():
            arguments.number(option, value)
    rotation_from_angles((0.0, 0.0, 0.0), order)  # raises an error for an unknown order
    found = find_design(design)
    strokes = None if stroke is None else [list(stroke)] * len(found.joint_names)
    limits = with_maximum(found, Limits(strokes=strokes, indices=index or ()))
    box = None if angles is None else _read_angles(angles)
    if box is not None and (box[:, 1] > box[:, 0]).any():
        refuse_unused(
            context,
            [*SECTION, "position", "theta", "index", "out", "plot"],
            "an interval of angles, where only the volume is computed",
        )
        _dextrous(found, box, order, limits, resolution)
        return
    refuse_unused(context, ["resolution"], "a section, which has no cells")
    rotation = None if box is None else rotation_from_angles(box[:, 0], order, degrees=True)
    held = _orientation(box, order)
    if rotation is not None and not index and all(leg.name == "D1" for leg in found.legs):
        refuse_unused(context, SECTION, "one orientation of SPS legs, whose section is exact")
        shells = exact_shells(found, rotation, limits)
        report_shells(shells, position or (0.0, 0.0, 0.0), theta, found, held, plot, out, force)
        return
    mapped = section(
        found,
        position,
        vertical_plane(theta),
        rotation=rotation,
        limits=limits,
        rays=rays,
        starts=starts,
        rng=seed,
        connecting=connecting,
    )
    report_section(mapped, theta, found, held, plot, out, force, order=order, seed=seed)


def _read_angles(text: str) -> Array:
    ends = [[number_of(end) for end in word.split(":")] for word in text.replace(",", " ").split()]
    pairs = [(end[0], end[-1]) for end in ends if len(end) in (1, 2)]
    known = all(math.isfinite(angle) for end in ends for angle in end)
    if len(ends) != 3 or len(pairs) != 3 or not known or any(low > high for low, high in pairs):
        raise InvalidInput(
            expected("--angles", 'three angles or intervals, such as "0 0 -30:30"', brief(text))
        )
    return np.array(pairs)


def _dextrous(
    design: Design, box: Array, order: str, limits: Limits, resolution: float | None
) -> None:
    from gsp.geometry.pose import PoseBox
    from gsp.workspace import dextrous

    angles = PoseBox([0.0, 0.0, 0.0], box.tolist(), degrees=True, order=order)
    low, high = dextrous(design, angles, limits, resolution=resolution).volume
    unit = f" {cubic(design.unit)}".rstrip()
    say(f"Volume  between {number(low)} and {number(high)}{unit}, proven")


def _orientation(box: Array | None, order: str) -> str:
    """Return the words for a fixed orientation, or for any."""
    if box is None:
        return "any orientation"
    return f"angles {' '.join(f'{angle:g}°' for angle in box[:, 0])} ({order})"
