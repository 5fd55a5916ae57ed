"""`gsp rank`: its options and its steps."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gsp.catalogue.placement import TEMPLATE
from gsp.cli import interrupts
from gsp.cli.inputs.options import (
    Force,
    Order,
    Workers,
    check_length,
    refuse_parameters,
    refuse_unused,
)
from gsp.cli.outputs.console import show_table, warn
from gsp.cli.ranking.candidates import find_candidates
from gsp.cli.ranking.files import chosen_columns, outputs, save, stopped
from gsp.cli.ranking.plan import make_plan
from gsp.cli.ranking.report import best_table, headline, left_out, metadata
from gsp.cli.ranking.tasks import OF_TASK, own_columns, rank_for_task
from gsp.evaluation.request import names_for
from gsp.exploration import read_task
from gsp.indices import index_name, index_names


def rank(
    context: typer.Context,
    designs: Annotated[
        list[str] | None,
        typer.Argument(
            help="Published designs, design files, or mechanisms such as D1^3D2^3, which are "
            "placed on the anchors of the template. Default: the 195 mechanisms of the catalogue.",
            show_default=False,
        ),
    ] = None,
    template: Annotated[
        str | None,
        typer.Option(
            help="Design on whose anchor lines mechanisms are placed: a name or a file. Default: "
            f"the design that is given with them, else {TEMPLATE}.",
            metavar="DESIGN",
            show_default=False,
        ),
    ] = None,
    task: Annotated[
        Path | None,
        typer.Option(
            help="A task (.toml): its poses, limits, indices and weights decide, in place of the "
            "options on these. The designs are ordered by their score.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    every_placement: Annotated[
        bool,
        typer.Option(
            "--placements",
            help="Put the legs of each mechanism on the positions of the template in all distinct "
            "ways (3707 for all mechanisms on the default template). Default: one way, legs of a "
            "kind far apart.",
        ),
    ] = False,
    box: Annotated[
        str | None,
        typer.Option(
            help='Poses to sample: "x0:x1 y0:y1 z0:z1 a0:a1 b0:b1 c0:c1", lengths in the unit of '
            "the designs, angles in degrees in the order of --order. Default: a box that exceeds "
            "the home poses by about a sixth of the size of the design (20 mm for the default "
            "template) and by 10 degrees.",
            metavar="BOX",
            show_default=False,
        ),
    ] = None,
    order: Order = "rpy",
    samples: Annotated[int, typer.Option(help="Number of poses.", min=1)] = 4000,
    seed: Annotated[int, typer.Option(help="Seed of the Halton sample.", min=0)] = 0,
    by: Annotated[
        str | None,
        typer.Option(
            help="Index by whose mean the designs are ranked, by name or symbol; without --indices "
            "it is computed beside the default ones. Default: the first one computed.",
            metavar="NAME",
            show_default=False,
        ),
    ] = None,
    indices: Annotated[
        list[str] | None,
        typer.Option(
            help="Indices by name or symbol, separated by commas (CDN_CL,CTN), or all. "
            "Default: CDN_CL, CDN_OE, CTN, λ, |det J| and σ_min, as far as they can be computed.",
            metavar="NAMES",
            show_default=False,
        ),
    ] = None,
    length: Annotated[
        float | None,
        typer.Option(
            help="Characteristic length, in the unit of the designs. Default: the one that each "
            "design records.",
            show_default=False,
        ),
    ] = None,
    ellipsoid: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            help="Semi-axes of the operation ellipsoid along the platform axes, in the unit of the "
            "designs. Default: those that the designs record, else (r, r, r/2) with r the largest "
            "distance of a platform anchor from the platform origin.",
            metavar="A B C",
            show_default=False,
        ),
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option(
            help="Convert designs with another unit of length to this one: mm, cm, m, in … "
            "Default: the unit of the designs.",
            metavar="UNIT",
            show_default=False,
        ),
    ] = None,
    feasible: Annotated[
        bool,
        typer.Option("--feasible", help="Use only poses within the strokes of each design."),
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Table to write: .csv, .parquet, .xlsx, .md or .tex. Default: "
            "results/ranking.csv, or the first free ranking-2.csv, ranking-3.csv …",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    columns: Annotated[
        list[str] | None,
        typer.Option(
            help="Columns of the table, separated by commas; the name of an index selects its mean "
            "(rank,design,CTN,control_number_min). Default: all; in LaTeX the means.",
            metavar="NAMES",
            show_default=False,
        ),
    ] = None,
    resume: Annotated[
        bool,
        typer.Option("--resume", help="Continue an interrupted run that had the same arguments."),
    ] = False,
    plot: Annotated[
        bool | None,
        typer.Option(
            "--plot/--no-plot",
            help="Plot the indices against each other, in a .png file with the name of the table. "
            "Default: yes, if matplotlib is installed.",
            show_default=False,
        ),
    ] = None,
    workers: Workers = None,
    force: Force = False,
) -> None:
    """Rank designs, or the 195 mechanisms of the catalogue, over a sample of poses.

    Prints the best 20 and writes the whole table, its metadata (.json) and a picture (.png).
    λ is relative to the largest |det J| of the same design in the sample. Mechanisms that are given
    with a design are placed on its anchors.

    **Examples**

    - `gsp rank`

    - `gsp rank --by CTN --samples 500 --out ranking.parquet`

    - `gsp rank --placements --samples 500`

    - `gsp rank --placements --task task.toml`

    - `gsp rank "D1^6" "D2^6" mine.toml --template mine.toml --box "0 0 90:110 -5:5 -5:5 0"`
    """
    if task is not None:
        refuse_unused(context, OF_TASK, "--task, which states it")
        wanted = read_task(task)
        rank_for_task(
            find_candidates(designs or [], template, unit, every_placement),
            wanted,
            origin=task,
            out=out,
            columns=chosen_columns(columns, own_columns(wanted)),
            resume=resume,
            plot=plot,
            workers=workers,
            force=force,
        )
        return
    chosen = index_names(indices) if indices else None  # raises an error for an unknown one
    decides = None if by is None else index_name(by)
    taken = chosen_columns(columns)
    check_length(length)
    plan = make_plan(
        designs or [],
        template=template,
        box=box,
        order=order,
        samples=samples,
        seed=seed,
        length=length,
        semi_axes=ellipsoid,
        unit=unit,
        feasible=feasible,
        every_placement=every_placement,
    )
    if (plan.box.low == plan.box.high).all():
        refuse_unused(context, ["seed"], "--box with a single pose")
    if indices:
        chosen = names_for(indices, plan.designs)
        names = [*chosen, *([decides] if decides and decides not in chosen else [])]
        refuse_parameters(context, names, plan.designs)
    plan.check(chosen, decides, workers)
    with outputs(out, plot, force, resume) as files:
        plan.check_parts(chosen, decides, files.parts, resume)
        headline(plan)
        for line in plan.notes():
            warn(line)
        try:
            with interrupts.concluded_by(lambda: stopped(files.parts)):
                table = plan.compute(chosen, decides, workers, files.parts, resume)
        except KeyboardInterrupt:
            raise typer.Exit(stopped(files.parts)) from None
        for line in left_out(plan, table, chosen):
            warn(line)
        show_table(best_table(table))
        save(table, metadata(plan, table), files, force, taken)
