"""`gsp planar`: the workspace program for planar platforms."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from gsp import arguments
from gsp.checks import check_memory
from gsp.cli.design.modes import all_planar_modes
from gsp.cli.inputs.designs import find_planar_design
from gsp.cli.inputs.options import Connecting, Force, Rays, refuse_unused
from gsp.cli.inputs.workspaces import check_stroke
from gsp.cli.outputs.console import say
from gsp.cli.outputs.pictures import check_picture
from gsp.cli.outputs.planar import Results, report_planar
from gsp.errors import EmptyWorkspace, InvalidInput, MissingParameter, expected
from gsp.files.tables import check_table
from gsp.planar import PlanarComponent, PlanarDesign

# Options of the workspace.
OF_WORKSPACE = (
    "stroke", "guess", "position", "angle", "rays", "starts", "seed", "connecting", "boundary",
    "plot",
)  # fmt: skip


def planar(
    context: typer.Context,
    design: Annotated[
        str, typer.Argument(help="A published planar design, or a planar design file (.toml).")
    ],
    joints: Annotated[
        str | None,
        typer.Option(
            help="Find all poses with these joint values instead of the workspace: three numbers, "
            "distances in the unit of the design, angles in rad.",
            metavar="VALUES",
            show_default=False,
        ),
    ] = None,
    stroke: Annotated[
        tuple[float, float] | None,
        typer.Option(
            help="Least and greatest length of every leg, in the unit of the design. Default: "
            "those of the design.",
            metavar="LOW HIGH",
            show_default=False,
        ),
    ] = None,
    guess: Annotated[
        tuple[float, float] | None,
        typer.Option(
            help="Near the radiating point, at which every leg is in the middle of its stroke. "
            "Default: the home pose of the design, or the middle of the base.",
            metavar="X Y",
            show_default=False,
        ),
    ] = None,
    position: Annotated[
        tuple[float, float] | None,
        typer.Option(
            help="The radiating point itself, for any legs.", metavar="X Y", show_default=False
        ),
    ] = None,
    angle: Annotated[
        float | None,
        typer.Option(
            help="Fixed angle of the platform, in degrees. Default: any angle.",
            metavar="ANGLE",
            show_default=False,
        ),
    ] = None,
    rays: Rays = 36,
    starts: Annotated[int, typer.Option(help="Angles of the platform per ray.", min=1)] = 16,
    seed: Annotated[int, typer.Option(help="Seed of the random angles.", min=0)] = 0,
    connecting: Connecting = True,
    boundary: Annotated[
        Path | None,
        typer.Option(
            help="Write the outer boundary, the farthest point of all curves on each ray, to this "
            "file: .csv, .parquet, .xlsx, .md or .tex.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write the points of all curves, or the poses of --joints, to this file.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            help="Draw the curves to this file: .png, .pdf or .svg.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Map the workspace of a planar platform: boundary, bifurcation points, connecting curves.

    The inputs and outputs are those of the program PLANSTEW of `Workspace-A`: limits of the legs, a
    guess of the radiating point and a number of rays; the boundary, the bifurcation points with
    their labels and whether they are on the boundary, and the curves between them.

    With --angle all components of the workspace are listed with their exact areas, and the curves
    are the boundaries of all of them. Without it the curves are those that rays from the radiating
    point or poses with all legs at a limit lead to.

    With --joints the poses with given joint values are listed: forward kinematics.

    **Examples**

    - `gsp planar lee-2000-planar --stroke 0.3 0.9 --plot planar.png`

    - `gsp planar lee-2000-planar --stroke 0.3 0.9 --angle 10 --boundary boundary.csv`

    - `gsp planar lee-2000-planar --joints "0.6 0.6 0.5"`
    """
    from gsp.planar import planar_section
    from gsp.workspace.boundary.mapping import RAY_BYTES

    if joints is not None:
        refuse_unused(context, OF_WORKSPACE, "--joints, which lists poses")
        all_planar_modes(find_planar_design(design), joints, out, force=force)
        return
    if plot is not None:
        check_picture(plot, overwrite=force)
    for path in (boundary, out):
        if path is not None:
            check_table(path, overwrite=force)
    check_memory("--rays", rays, RAY_BYTES, "rays")
    for option, values in (("--guess", guess), ("--position", position)):
        for value in values or ():
            arguments.number(option, value)
    turn = None if angle is None else float(np.deg2rad(arguments.number("--angle", angle)))
    if position is not None:
        refuse_unused(context, ["guess"], "--position")
    if angle is not None:
        refuse_unused(context, ["starts", "seed"], "--angle, with which all rays start")
    found = find_planar_design(design)
    if stroke is not None:
        check_stroke(stroke, signed=bool(found.angular.all()))
        found = found.replace(strokes=[stroke] * len(found.joint_names))
    place = position
    if place is None:
        found, place = _radiating(found, guess, turn)
    mapped = planar_section(
        found,
        place,
        angle=turn,
        rays=rays,
        starts=starts,
        rng=seed,
        connecting=connecting,
    )
    results = Results(boundary=boundary, out=out, plot=plot, force=force)
    report_planar(mapped, found, place, turn, rays, results)


def _radiating(
    design: PlanarDesign, guess: tuple[float, float] | None, angle: float | None
) -> tuple[PlanarDesign, tuple[float, float]]:
    """Return a design whose home is the pose at the radiating point, and this point.

    At a fixed angle where that point is not feasible, or there is none, it is a point of the
    largest component, which is said, and the home is that of the design.
    """
    from gsp.planar import radiating_point
    from gsp.planar.outlines import inner_point

    home = design.base_points.mean(axis=0) if design.home is None else design.home.position
    pose, failure = None, None
    try:
        pose = radiating_point(design, home if guess is None else guess)
    except (EmptyWorkspace, MissingParameter) as error:
        if design.strokes is None:
            raise
        failure = error
    if angle is not None and guess is None:
        parts = _components(design, angle)
        inside = pose is not None and any(part.contains(pose.position) for part in parts)
        if parts and not inside:
            say("Radiating point in the largest component: no other is known at this angle")
            x, y = inner_point(parts[0]).tolist()
            return design, (x, y)
    if pose is None:
        raise EmptyWorkspace(f"{failure}; --position states the radiating point itself")
    # Its angle is feasible there, and so the first that rays start from.
    x, y = pose.position.tolist()
    return design.replace(home=pose), (x, y)


def _components(design: PlanarDesign, angle: float) -> tuple[PlanarComponent, ...]:
    """Return the components at an angle, none where nothing bounds the positions."""
    from gsp.planar import planar_components

    try:
        parts = planar_components(design, angle)
    except InvalidInput:
        return ()
    if not parts:
        wanted = "an angle at which the workspace has an interior"
        received = f"{np.rad2deg(angle):g}°, where it has none"
        raise EmptyWorkspace(expected("--angle", wanted, received))
    return parts
