"""`gsp workspace`: the workspace of a design."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from gsp import arguments
from gsp.checks import check_memory, check_positive
from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import Force, Order, check_length, refuse_unused
from gsp.cli.outputs.pictures import check_picture
from gsp.cli.outputs.regions import Files, dextrous_positions, orientations_at, side_of_home
from gsp.cli.outputs.workspaces import report_section, report_shells, vertical_plane
from gsp.errors import InvalidInput, brief, expected
from gsp.files.cells import number_of
from gsp.files.tables import check_table
from gsp.geometry.rotations import rotation_from_angles
from gsp.geometry.vectors import Array

if TYPE_CHECKING:
    from gsp.limits import Limits

ORDER = "approach-roll"
# Options of the search along rays, which the exact cases do without.
SECTION = ("rays", "starts", "seed", "connecting")


def workspace(
    context: typer.Context,
    design: Annotated[str, typer.Argument(help="Published design, or a design file (.toml).")],
    position: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            help="Point of the vertical plane from which the rays go, or where the orientations of "
            "--orientations are, in the unit of the design. Default: the home pose of the design; "
            "with --angles, for SPS legs, the origin.",
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
    tilt: Annotated[
        float | None,
        typer.Option(
            help="The dextrous workspace for tilts: α and β between −TILT and TILT, in degrees, "
            "and γ = 0, in the order approach-roll.",
            metavar="TILT",
            show_default=False,
        ),
    ] = None,
    orientations: Annotated[
        bool,
        typer.Option("--orientations", help="All orientations that are feasible at --position."),
    ] = False,
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
    cone: Annotated[
        float | None,
        typer.Option(
            help="Greatest angle of each leg from its direction at the home pose, in base and "
            "platform, in degrees.",
            metavar="ANGLE",
            show_default=False,
        ),
    ] = None,
    radius: Annotated[
        float | None,
        typer.Option(
            help="Radius of the legs, which must not touch each other, in the unit of the design.",
            metavar="RADIUS",
            show_default=False,
        ),
    ] = None,
    require: Annotated[
        list[str] | None,
        typer.Option(
            "--require",
            "--index",
            help='A bound of an index, such as "CTN >= 0.1"; may be repeated.',
            metavar="BOUND",
            show_default=False,
        ),
    ] = None,
    length: Annotated[
        float | None,
        typer.Option(
            help="Characteristic length for --require, in the unit of the design. Default: that of "
            "the design.",
            metavar="LENGTH",
            show_default=False,
        ),
    ] = None,
    resolution: Annotated[
        float | None,
        typer.Option(
            help="Longest side of the cells that stay undecided: in a dextrous workspace, in the "
            "unit of the design; of --orientations, in degrees. Default: until the volume is known "
            "within ±3 %, or ±6 % of orientations.",
            show_default=False,
        ),
    ] = None,
    both: Annotated[
        bool,
        typer.Option(
            "--both", help="Volumes on both sides of the base. Default: the side of the home pose."
        ),
    ] = False,
    rays: Annotated[int, typer.Option(help="Rays around the radiating point.", min=1)] = 24,
    starts: Annotated[int, typer.Option(help="Orientations per ray.", min=1)] = 16,
    seed: Annotated[int, typer.Option(help="Seed of the random orientations.", min=0)] = 0,
    connecting: Annotated[
        bool, typer.Option(help="Follow curves between complete bifurcation points as well.")
    ] = True,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="Draw the section, or the region, to this file: .png, .pdf or .svg.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write the points of the curves, or the cells of a region, to this file: .csv, "
            ".parquet, .xlsx, .md or .tex; the surface of a region to .stl, .obj, .ply or .glb.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Compute a workspace: bifurcation points and boundary curves in a vertical plane.

    The platform may take any orientation, or a fixed one (--angles; for SPS legs the exact volume
    is printed as well). With an interval of angles, or --tilt, the volume of the dextrous workspace
    is printed; with --orientations, the share of orientations at a position.

    **Examples**

    - `gsp workspace workspace-6-3 --plot section.png`

    - `gsp workspace workspace-6-3 --angles "0 0 -30" --theta 15`

    - `gsp workspace workspace-6-3 --angles "0 0 -30:30"`

    - `gsp workspace workspace-6-3 --orientations --position 0 0 8 --plot orientations.png`
    """
    from gsp.proof.branching.requirements import with_maximum
    from gsp.workspace import exact_shells, section
    from gsp.workspace.boundary.mapping import RAY_BYTES
    from gsp.workspace.sets.shapes.files import check_shape

    if plot is not None:
        check_picture(plot, overwrite=force)
    check_memory("--rays", rays, RAY_BYTES, "rays")
    arguments.number("--theta", theta)
    for option, values in (("--position", position), ("--stroke", stroke)):
        for value in values or ():
            arguments.number(option, value)
    rotation_from_angles((0.0, 0.0, 0.0), order)  # raises an error for an unknown order
    box = _range(context, angles, tilt)
    ranged = box is not None and bool((box[:, 1] > box[:, 0]).any())
    if out is not None and (orientations or ranged):
        check_shape(out, "orientations" if orientations else "space", overwrite=force)
    elif out is not None:
        check_table(out, overwrite=force)
    found = find_design(design)
    strokes = None if stroke is None else [list(stroke)] * len(found.joint_names)
    limits = with_maximum(found, _limits(strokes, cone, radius, require, length))
    files = Files(plot=plot, out=out, force=force)
    if orientations:
        unused = [*SECTION, "theta", "angles", "tilt", "order", "both"]
        refuse_unused(context, unused, "--orientations")
        orientations_at(found, position, limits, resolution, files)
        return
    side = side_of_home(found, both)
    if box is not None and ranged:
        refuse_unused(
            context,
            [*SECTION, "position", "theta"],
            "an interval of angles, whose positions are searched in space",
        )
        dextrous_positions(found, box, order, limits, resolution, side, files)
        return
    refuse_unused(context, ["resolution"], "a section, which has no cells")
    rotation = None if box is None else rotation_from_angles(box[:, 0], order, degrees=True)
    held = _orientation(box, order)
    strokes_only = not require and cone is None and radius is None
    if rotation is not None and strokes_only and all(leg.name == "D1" for leg in found.legs):
        refuse_unused(context, SECTION, "one orientation of SPS legs, whose section is exact")
        shells = exact_shells(found, rotation, limits)
        place = position or (0.0, 0.0, 0.0)
        report_shells(shells, place, theta, found, held, side, plot, out, force)
        return
    refuse_unused(context, ["both"], "a section, which has no volume")
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


def _range(context: typer.Context, angles: str | None, tilt: float | None) -> Array | None:
    """Return least and greatest angles in degrees (3, 2), None for any orientation."""
    if tilt is None:
        return None if angles is None else _read_angles(angles)
    refuse_unused(context, ["angles", "order"], "--tilt")
    if not 0.0 < arguments.number("--tilt", tilt) < 90.0:
        raise InvalidInput(expected("--tilt", "an angle above 0 and below 90 (degrees)", tilt))
    return np.array([[-tilt, tilt], [-tilt, tilt], [0.0, 0.0]])


def _limits(
    strokes: list[list[float]] | None,
    cone: float | None,
    radius: float | None,
    require: list[str] | None,
    length: float | None,
) -> Limits:
    from gsp.limits import Limits

    if cone is not None and not 0.0 < arguments.number("--cone", cone) <= 90.0:
        raise InvalidInput(expected("--cone", "an angle above 0, at most 90 (degrees)", cone))
    if radius is not None:
        check_positive("--radius", radius)
    check_length(length)
    half = None if cone is None else float(np.deg2rad(cone))
    return Limits(
        strokes=strokes,
        base_cone=half,
        platform_cone=half,
        leg_radius=radius,
        indices=require or (),
        length=length,
    )


def _read_angles(text: str) -> Array:
    ends = [[number_of(end) for end in word.split(":")] for word in text.replace(",", " ").split()]
    pairs = [(end[0], end[-1]) for end in ends if len(end) in (1, 2)]
    known = all(math.isfinite(angle) for end in ends for angle in end)
    if len(ends) != 3 or len(pairs) != 3 or not known or any(low > high for low, high in pairs):
        raise InvalidInput(
            expected(
                "--angles", 'three angles or intervals low:high, such as "0 0 -30:30"', brief(text)
            )
        )
    return np.array(pairs)


def _orientation(box: Array | None, order: str) -> str:
    """Return the words for a fixed orientation, or for any."""
    if box is None:
        return "any orientation"
    return f"angles {' '.join(f'{angle:g}°' for angle in box[:, 0])} ({order})"
