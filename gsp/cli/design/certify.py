"""`gsp certify`: prove requirements over a box of poses, or print a pose that refutes them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.options import Force, Order
from gsp.cli.inputs.poses import read_box
from gsp.cli.outputs.console import say
from gsp.cli.outputs.postures import box_text
from gsp.errors import InvalidInput
from gsp.files.writing import check_writable
from gsp.geometry.pose import Pose
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.proof import Certificate
from gsp.proof import certify as prove

STATUS = {"proven": 0, "refuted": 1, "undecided": 3}


def certify(
    design: Annotated[str, typer.Argument(help="Published design, or a design file (.toml).")],
    box: Annotated[
        str,
        typer.Option(
            help='The box of poses: "x0:x1 y0:y1 z0:z1 a0:a1 b0:b1 c0:c1", angles in degrees; a '
            "single number is a fixed coordinate.",
            metavar="BOX",
            show_default=False,
        ),
    ],
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
    length: Annotated[
        float | None,
        typer.Option(
            help="Characteristic length. Default: that of the design.", show_default=False
        ),
    ] = None,
    order: Order = "rpy",
    budget: Annotated[
        int | None, typer.Option(help="Most boxes that are evaluated.", min=1, show_default=False)
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(help="Threads. Default: one per core.", min=1, show_default=False),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Write the certificate to this file (.json).", show_default=False),
    ] = None,
    force: Force = False,
) -> int:
    """Prove that requirements hold at every pose of a box, or print a pose where one does not.

    The exit status is 0 if they are proven, 1 if they are refuted, 3 if the budget is used up.

    **Examples**

    - `gsp certify toz-kucuk-2016-d3-6 --box "5:15 -15:-5 133:143 0:10 -10:0 -15:-5"`

    - `gsp certify mine.toml --box "-9:9 -9:9 90:99 -5:5 -5:5 0" --require "CDN_CL <= 10"`
    """
    if out is not None:
        check_writable(out, overwrite=force, suffixes=(".json",))
    found = find_design(design)
    limits = _limits(found, require or [], length, strokes)
    searched = read_box(box, order)
    done = prove(found, searched, limits, regular=not singular, budget=budget, workers=workers)
    _print(found, done)
    if out is not None:
        done.write(out, overwrite=force)
        say(f"Certificate {out}")
    return STATUS[done.status]


def _limits(
    design: Design, require: list[str], length: float | None, strokes: bool
) -> Limits | None:
    if strokes and design.strokes is None:
        raise InvalidInput("--strokes: expected a design with strokes, received one without")
    if not (require or strokes):
        return None
    none = np.full((len(design.joint_names), 2), np.nan)
    return Limits(strokes=None if strokes else none, indices=require, length=length)


def _print(design: Design, done: Certificate) -> None:
    say(f"{done.status:11} {design.name}", "bold")
    say(f"over        {box_text(done.box, design.unit)}")
    say(f"boxes       {done.n_boxes}, {100.0 * done.proven_share:.6g} % of the volume proven")
    if done.counterexample is not None:
        say(f"because     {done.reason}")
        say(f"at          {options_of(done.counterexample)}")


def options_of(pose: Pose) -> str:
    """Return a pose as options that other commands take, to the last digit."""
    place = " ".join(repr(float(x)) for x in pose.position)
    turn = " ".join(repr(float(x)) for x in pose.angles(degrees=True))
    return f"--position {place} --angles {turn}"
