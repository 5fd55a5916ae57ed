"""`gsp certify`: prove requirements over a box or a path, or print a pose that refutes them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.numbers import number_words, read_rows, read_table
from gsp.cli.inputs.options import (
    DesignName,
    Force,
    Length,
    Order,
    Workers,
    check_length,
    refuse_parameters,
    refuse_unused,
)
from gsp.cli.inputs.poses import read_box
from gsp.cli.outputs.console import say
from gsp.cli.outputs.postures import box_text, in_degrees
from gsp.errors import InvalidInput, brief, expected
from gsp.files.cells import SUFFIXES
from gsp.files.writing import check_writable
from gsp.geometry.pose import Pose
from gsp.geometry.pose.texts import POSE_COLUMNS
from gsp.geometry.vectors import Array
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.proof import Certificate, PathCertificate
from gsp.proof import certify as prove
from gsp.proof import certify_path as prove_path
from gsp.proof.boxes import DEFAULT_BOXES as BOXES
from gsp.proof.paths.certify import INTERVAL_BUDGET as INTERVALS
from gsp.proof.paths.pieces import Motion
from gsp.rounding import rounded_down

STATUS = {"proven": 0, "refuted": 1, "undecided": 3}


def certify(
    design: DesignName,
    context: typer.Context,
    box: Annotated[
        str | None,
        typer.Option(
            help='The box of poses: "x0:x1 y0:y1 z0:z1 a0:a1 b0:b1 c0:c1", lengths in the unit of '
            "the design, angles in degrees in the order of --order; a single number is a fixed "
            "coordinate.",
            metavar="BOX",
            show_default=False,
        ),
    ] = None,
    path: Annotated[
        str | None,
        typer.Option(
            help="Instead of a box, the nodes of a path: a .csv, .parquet or .xlsx file with the "
            "columns x, y, z, angle_1, angle_2, angle_3, angles in degrees in the order of "
            "--order.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    motion: Annotated[
        Motion,
        typer.Option(help="The path between the nodes: straight, screw or spline."),
    ] = "straight",
    times: Annotated[
        str | None,
        typer.Option(
            help="When each node is reached: one number for each, or a file with the column time.",
            metavar="TIMES|FILE",
            show_default=False,
        ),
    ] = None,
    speeds: Annotated[
        str | None,
        typer.Option(
            help="Greatest speeds of the actuators along the path: one number, or one for each "
            "(needed where some are angles); in the units of the joints (angles in rad) and of "
            "--times.",
            metavar="SPEEDS",
            show_default=False,
        ),
    ] = None,
    accelerations: Annotated[
        str | None,
        typer.Option(
            help="Greatest accelerations along a spline: one number, or one for each actuator; in "
            "the units of the joints (angles in rad) and of --times.",
            metavar="ACCELERATIONS",
            show_default=False,
        ),
    ] = None,
    require: Annotated[
        list[str] | None,
        typer.Option(
            help='A bound of an index, such as "CDN_CL <= 10"; may be repeated.',
            metavar="BOUND",
            show_default=False,
        ),
    ] = None,
    strokes: Annotated[
        bool, typer.Option("--strokes", help="Require the strokes of the design.")
    ] = False,
    singular: Annotated[
        bool, typer.Option("--singular", help="Allow singular poses; prove the bounds only.")
    ] = False,
    length: Length = None,
    order: Order = "rpy",
    budget: Annotated[
        int | None,
        typer.Option(
            help="Largest number of boxes, or of intervals of a path, that are evaluated. "
            f"Default: {BOXES:,} boxes, {INTERVALS:,} intervals.",
            min=1,
            show_default=False,
        ),
    ] = None,
    workers: Workers = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write the certificate to this file (.json).", metavar="FILE", show_default=False
        ),
    ] = None,
    force: Force = False,
) -> int:
    """Prove that requirements hold at every pose of a box or a path, or print one that refutes.

    The exit status is 0 if they are proven, 1 if they are refuted, 3 if the budget is used up.

    **Examples**

    - `gsp certify toz-kucuk-2016-d3-6 --box "5:15 -15:-5 133:143 0:10 -10:0 -15:-5"`

    - `gsp certify mine.toml --box "-9:9 -9:9 90:99 -5:5 -5:5 0" --require "CDN_CL <= 10"`

    - `gsp certify mine.toml --path poses.csv --motion spline --times "0 1 2" --speeds 60`
    """
    if out is not None:
        check_writable(out, overwrite=force, suffixes=(".json",))
    found = find_design(design)
    limits = _limits(found, require or [], length, strokes)
    if not require:
        refuse_unused(context, ["length"], "requirements without --require")
    elif limits is not None:
        refuse_parameters(context, [index.name for index, _, _ in limits.thresholds], [found])
    if (box is None) == (path is None):
        raise InvalidInput("--box, --path: expected one of them")
    if singular and limits is None and speeds is None and accelerations is None:
        raise InvalidInput(expected("--singular", "--require or --strokes beside it", "neither"))
    for option, given in (("--speeds", speeds), ("--accelerations", accelerations)):
        if given is not None and path is not None and times is None:
            raise InvalidInput(expected(option, "--times beside it", "none"))
    if accelerations is not None and path is not None and motion != "spline":
        raise InvalidInput(expected("--accelerations", "--motion spline", f"--motion {motion}"))
    done: Certificate | PathCertificate
    if box is not None:
        refuse_unused(context, ("motion", "times", "speeds", "accelerations"), "--box")
        searched = read_box(box, order)
        done = prove(found, searched, limits, regular=not singular, budget=budget, workers=workers)
        _print(found, done, box_text(searched, found.unit))
    else:
        refuse_unused(context, ("workers",), "--path")
        nodes = read_table("--path", str(path), POSE_COLUMNS)
        if len(nodes) < 2:
            raise InvalidInput(expected("--path", "two poses or more", "one"))
        done = prove_path(
            found,
            Pose.from_angles(nodes[:, :3], nodes[:, 3:], order, degrees=True),
            limits,
            times=None if times is None else _times(times, len(nodes)),
            motion=motion,
            speeds=_rates("--speeds", speeds, found),
            accelerations=_rates("--accelerations", accelerations, found),
            regular=not singular,
            budget=budget,
        )
        _print(found, done, f"a path of {len(nodes)} nodes in {path}, {motion}")
    if out is not None:
        done.write(out, overwrite=force)
        say(f"Certificate {out}")
    return STATUS[done.status]


def _limits(
    design: Design, require: list[str], length: float | None, strokes: bool
) -> Limits | None:
    check_length(length)
    if strokes and design.strokes is None:
        raise InvalidInput("--strokes: expected a design with strokes, received one without")
    if not (require or strokes):
        return None
    none = np.full((len(design.joint_names), 2), np.nan)
    return Limits(strokes=None if strokes else none, indices=require, length=length)


def _times(text: str, n: int) -> Array:
    if Path(text).suffix.lower() in SUFFIXES:
        times = read_rows("--times", text, ["time"])[:, 0]
    else:
        times = read_rows("--times", text, [f"t{i}" for i in range(1, n + 1)])
    if (np.diff(times) <= 0.0).any():
        raise InvalidInput(expected("--times", "numbers that increase", brief(text)))
    return times


def _rates(option: str, text: str | None, design: Design) -> Array | None:
    """Return one number for all joints, or one for each."""
    if text is None:
        return None
    table = Path(text).suffix.lower() in SUFFIXES
    alone = not table and len(number_words(option, text)) == 1
    columns = ["all"] if alone else design.joint_names
    rates = read_rows(option, text, columns, also=() if alone else ("one number",))
    if (rates <= 0.0).any():
        raise InvalidInput(expected(option, "numbers above zero", brief(text)))
    return np.asarray(rates[0]) if alone else rates


def _print(design: Design, done: Certificate | PathCertificate, over: str) -> None:
    say(f"{done.status:11} {design.name}", "bold")
    say(f"over        {over}")
    what = ("boxes", "volume") if isinstance(done, Certificate) else ("intervals", "path")
    # Rounded down, so what is not all of it does not read as if it were.
    part = f"{rounded_down(100.0 * done.proven_share, 6):.6g}"
    say(f"{what[0]:11} {done.n_boxes}, {part} % of the {what[1]} proven")
    if isinstance(done, PathCertificate) and done.bracket is not None:
        say(f"parameter   {' to '.join(f'{x!r}' for x in sorted(set(done.bracket)))}")
    if done.counterexample is not None:
        say(f"because     {done.reason}")
        say(f"at          {_options_at(done, done.counterexample)}")


def _options_at(done: Certificate | PathCertificate, pose: Pose) -> str:
    """Return a counterexample as options that other commands take, to the last digit.

    A point of a box has the coordinates of the box: angles of its rotation matrix may be an ulp
    outside of it.
    """
    if isinstance(done, Certificate) and len(done.points) == 1:
        order, values = done.box.order, done.points[0].tolist()
    else:
        order, values = "rpy", [*pose.position.tolist(), *pose.angles().tolist()]
    place, turn = " ".join(map(repr, values[:3])), " ".join(map(in_degrees, values[3:]))
    return f"--position {place} --angles {turn}" + ("" if order == "rpy" else f" --order {order}")
