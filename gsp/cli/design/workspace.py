"""`gsp workspace`: the workspace of a design."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from gsp.checks import check_memory
from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import (
    Connecting,
    DesignName,
    Force,
    Order,
    Rays,
    refuse_parameters,
    refuse_unused,
)
from gsp.cli.inputs.sides import side_of_home
from gsp.cli.inputs.workspaces import (
    check_cone,
    check_curves,
    check_index,
    check_numbers,
    check_stroke,
    is_range,
    limit_words,
    orientation_words,
    read_limits,
    read_range,
)
from gsp.cli.outputs.pictures import check_picture
from gsp.cli.outputs.regions import Files, Wanted, orientations_at, positions_of
from gsp.cli.outputs.samples import IndicesOver, read_indices
from gsp.cli.outputs.workspaces import exact_section, mapped_section
from gsp.errors import InvalidInput, expected
from gsp.files.tables import check_table
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.rotations import rotation_from_angles
from gsp.model.design import Design

ORDER = "approach-roll"


class Where(StrEnum):
    """Where the positions of a region are."""

    plane = "plane"
    space = "space"


# Options of the search along rays, which the exact cases do without.
SECTION = ("rays", "starts", "seed", "connecting")
# Options of positions, which the orientations at a position do without.
POSITIONS = ("theta", "angles", "tilt", "order", "region", "some", "both", "curves", "box")
# Those of the orientations from which rays start.
RANDOM = ("starts", "seed")


def workspace(
    context: typer.Context,
    design: DesignName,
    position: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            help="Point of the vertical plane, where the rays start, or where the orientations "
            "of --orientations are, in the unit of the design. Default: the home pose of the "
            "design; with --angles and no --region, for SPS legs, the origin.",
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
    region: Annotated[
        Where | None,
        typer.Option(
            help="The proven region of the positions, not its curves: those in the vertical plane, "
            "or in space. Default: in space with an interval of angles, else curves.",
            show_default=False,
        ),
    ] = None,
    some: Annotated[
        bool,
        typer.Option(
            "--some",
            help="Positions reached with some orientation of an interval of angles. Default: with "
            "all of them.",
        ),
    ] = False,
    curves: Annotated[
        bool,
        typer.Option(
            "--curves",
            help="Labelled curves on the boundary, with --region plane; not of an interval of "
            "angles.",
        ),
    ] = False,
    interior: Annotated[
        bool,
        typer.Option(
            "--interior",
            help="With --curves also those inside of the region that leave bifurcation points.",
        ),
    ] = False,
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
    box: Annotated[
        str | None,
        typer.Option(
            help='Bounds of the position, "x0:x1 y0:y1 z0:z1" in base axes and the unit of the '
            "design; an end that is left out is no bound. Needed where the strokes do not bound "
            "the position.",
            metavar="BOX",
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
            help='A bound of an index, such as "CTN >= 0.1"; may be repeated.',
            metavar="BOUND",
            show_default=False,
        ),
    ] = None,
    index: Annotated[
        list[str] | None,
        typer.Option(
            help="An index over the region: its mean, the worst value that is found and, where it "
            "is proven, a bound of the worst one, and the global index (for CDN_CL the mean of its "
            'reciprocal). With a bound, such as "λ >= 0.3", also the share of the poses. May be '
            "repeated; the picture is of the first one.",
            metavar="INDEX",
            show_default=False,
        ),
    ] = None,
    samples: Annotated[
        int, typer.Option(help="Poses of the region that are drawn for --index.", min=2)
    ] = 10_000,
    length: Annotated[
        float | None,
        typer.Option(
            help="Characteristic length for --require and --index, in the unit of the design. "
            "Default: that of the design.",
            metavar="LENGTH",
            show_default=False,
        ),
    ] = None,
    resolution: Annotated[
        float | None,
        typer.Option(
            help="Longest side of the cells that stay undecided, in the unit of the design; of "
            "--orientations, in degrees. Default: until the measure is known within ±2 % (an "
            "area), ±3 % (a volume reached with all angles of an interval) or ±6 % (others).",
            show_default=False,
        ),
    ] = None,
    both: Annotated[
        bool,
        typer.Option(
            "--both",
            help="Both sides of the plane of the base anchors. Default: the side of the home pose.",
        ),
    ] = False,
    rays: Rays = 24,
    starts: Annotated[int, typer.Option(help="Orientations per ray.", min=1)] = 16,
    seed: Annotated[
        int, typer.Option(help="Seed of the random orientations, or of the poses.", min=0)
    ] = 0,
    connecting: Connecting = True,
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
            help="Write the points of the curves, also those of --curves, the poses of --index, or "
            "the cells of a region to this file: .csv, .parquet, .xlsx, .md or .tex; the surface "
            "of what is proven inside of a region in space to .stl, .obj, .ply or .glb; outlines "
            "in a plane to .svg or .dxf.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Compute a workspace: bifurcation points and boundary curves in a vertical plane.

    The platform may take any orientation, or a fixed one (--angles; for SPS legs the exact volume
    is printed as well). With --region, the area or volume of the positions is proven: reached with
    any orientation, with a fixed one, with all orientations of an interval of angles or of --tilt,
    or with some of them (--some). With --orientations, it is the share of orientations at a
    position. With --index, indices over such a region.

    **Examples**

    - `gsp workspace workspace-6-3 --plot section.png`

    - `gsp workspace workspace-6-3 --angles "0 0 -30" --theta 15`

    - `gsp workspace workspace-6-3 --angles "0 0 -30:30"`

    - `gsp workspace workspace-6-3 --region plane --plot region.png`

    - `gsp workspace workspace-6-3 --region plane --curves --resolution 0.5 --plot curves.png`

    - `gsp workspace workspace-6-3 --angles "0 0 -30:30" --some --region plane`

    - `gsp workspace workspace-6-3 --region plane --box "-3:3 : 0:9"`

    - `gsp workspace workspace-6-3 --tilt 15 --index CDN_CL --index "CTN >= 0.1" --length 7.5`

    - `gsp workspace workspace-6-3 --orientations --position 0 0 8 --plot orientations.png`
    """
    from gsp.proof.branching.requirements import with_maximum

    if plot is not None:
        check_picture(plot, overwrite=force)
    check_numbers(rays, theta, position)
    rotation_from_angles((0.0, 0.0, 0.0), order)  # raises an error for an unknown order
    turns = read_range(context, angles, tilt)
    if some and not is_range(turns):
        raise InvalidInput(expected("--some", "an interval of angles, or --tilt", "none"))
    where = Where.space if region is None and is_range(turns) else region
    check_curves(turns, where, curves, interior)
    check_index(index, where, curves=curves, orientations=orientations)
    if out is not None:
        _check_out(out, "orientations" if orientations else where, force)
    if stroke is not None:
        check_stroke(stroke, equal=orientations or where is not None)
    found = find_design(design)
    check_cone(found, cone)
    strokes = None if stroke is None else [list(stroke)] * len(found.joint_names)
    limits = with_maximum(found, read_limits(strokes, cone, radius, require, length, box))
    over = _indices(context, found, index, samples, length, seed)
    required = [threshold.name for threshold, _, _ in limits.thresholds]
    _refuse_length(context, found, [*required, *(over.names if over else ())])
    section = [name for name in SECTION if not (over and name == "seed")]
    files = Files(plot=plot, out=out, force=force)
    bounds = limit_words(stroke, cone, radius, require, found.unit, box)
    if orientations:
        refuse_unused(context, [*section, *POSITIONS], "--orientations")
        orientations_at(found, position, limits, resolution, bounds, files, over)
        return
    side = side_of_home(found, both)
    if where is not None:
        refuse_unused(context, section, "a region, which has no rays")
        if where is Where.space:
            refuse_unused(context, ["position", "theta"], "a region in space")
        if turns is None:
            refuse_unused(context, ["order"], "a region reached with any orientation")
        plane = (position, theta) if where is Where.plane else None
        more: dict[str, Any] = {
            "curves": curves,
            "interior": interior,
            "indices": over,
            "bounds": bounds,
        }
        wanted = Wanted(box=turns, order=order, some=some, plane=plane, **more)
        positions_of(found, wanted, limits, resolution, side, files)
        return
    refuse_unused(context, ["resolution"], "a section, which has no cells")
    rotation = None if turns is None else rotation_from_angles(turns[:, 0], order, degrees=True)
    held = "\n".join(filter(None, (orientation_words(turns, order), bounds)))
    strokes_only = not require and cone is None and radius is None and box is None
    if rotation is not None and strokes_only and found.between_points:
        refuse_unused(context, SECTION, "one orientation of SPS legs, whose section is exact")
        exact_section(found, rotation, limits, position, theta, held, side, files)
        return
    refuse_unused(context, ["both"], "a section, which has no volume")
    if rotation is not None:
        refuse_unused(context, RANDOM, "one orientation, from which all rays start")
    search = {"rays": rays, "starts": starts, "rng": seed, "connecting": connecting}
    mapped_section(found, rotation, limits, position, theta, held, order, files, search)


def _refuse_length(context: typer.Context, design: Design, names: list[str]) -> None:
    """Raise an error for --length, if no index depends on it."""
    if names:
        refuse_parameters(context, names, [design])
    else:
        refuse_unused(context, ["length"], "limits without --require or --index")


def _indices(
    context: typer.Context,
    design: Design,
    texts: list[str] | None,
    samples: int,
    length: float | None,
    seed: int,
) -> IndicesOver | None:
    """Return the indices over a region that are wanted, None for none."""
    if not texts:
        refuse_unused(context, ["samples"], "a workspace without --index")
        return None
    check_memory("--samples", samples, POSE_BYTES, "poses")
    names, bounds = read_indices(design, texts, length)
    return IndicesOver(names=names, bounds=bounds, length=length, samples=samples, seed=seed)


def _check_out(out: Path, kind: str | None, force: bool) -> None:
    """Raise an error, before any search, for a file that could not be written."""
    from gsp.workspace.sets.shapes.files import check_shape

    if kind is None:
        check_table(out, overwrite=force)
    else:
        check_shape(out, kind, overwrite=force)
