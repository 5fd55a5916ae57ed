"""`gsp sweep`: indices along a translation or a turn, or over a plane."""

from __future__ import annotations

import math
from pathlib import Path as FilePath
from typing import Annotated, Any

import numpy as np
import typer

from gsp import arguments
from gsp.checks import check_memory
from gsp.cli.inputs.defaults import own_ellipsoid
from gsp.cli.inputs.designs import find_design
from gsp.cli.inputs.numbers import number_words
from gsp.cli.inputs.options import (
    Angles,
    DesignName,
    Force,
    Length,
    Order,
    Out,
    Position,
    check_length,
    refuse_order,
    refuse_parameters,
    refuse_unused,
)
from gsp.cli.inputs.poses import pose_of
from gsp.cli.outputs.console import number, plain_table, say, show_table
from gsp.cli.outputs.headings import latex_headings
from gsp.cli.outputs.indices import ellipsoid_text
from gsp.cli.outputs.pictures import (
    Renderer,
    check_film,
    check_picture,
    save_film,
    save_picture,
)
from gsp.determinant import maximum
from gsp.errors import InvalidInput, MissingParameter, brief, expected
from gsp.evaluation.request import names_for
from gsp.files.cells import number_of
from gsp.files.tables import check_table, write_table
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.pose.texts import pose_text
from gsp.indices import INDICES
from gsp.model.design import Design
from gsp.sweeps import Path, plane, sweep, translation, turn

# Rows that are printed; of a longer table every n-th row, so that about so many are left.
PRINTED_ROWS = 25
THROUGH = {"platform": "platform origin", "base": "base origin"}


def sweep_command(
    context: typer.Context,
    design: DesignName,
    translate: Annotated[
        str | None,
        typer.Option(
            help='Direction in base axes: x, y, z or "1,0,1".',
            metavar="DIRECTION",
            show_default=False,
        ),
    ] = None,
    rotate: Annotated[
        str | None,
        typer.Option(
            help='Axis of rotation in base axes: x, y, z or "1,0,1".',
            metavar="DIRECTION",
            show_default=False,
        ),
    ] = None,
    over: Annotated[
        str | None,
        typer.Option(
            help="Plane of translations: xy, xz or yz.", metavar="PLANE", show_default=False
        ),
    ] = None,
    through: Annotated[
        str,
        typer.Option(
            help="A point of the axis of rotation: platform (the platform origin), base (the base "
            'origin), or "x,y,z" in the unit of the design.',
            metavar="POINT",
        ),
    ] = "platform",
    span: Annotated[
        str | None,
        typer.Option(
            help="Interval low:high, in the unit of the design or in degrees. Default: plus and "
            "minus the rms radius of the design, or -180:180.",
            metavar="LOW:HIGH",
            show_default=False,
        ),
    ] = None,
    steps: Annotated[int, typer.Option(help="Poses per coordinate.", min=2)] = 181,
    indices: Annotated[
        list[str] | None,
        typer.Option(
            help="Indices by name or symbol, separated by commas (CDN_CL,CTN), or all. Default: λ.",
            metavar="NAMES",
            show_default=False,
        ),
    ] = None,
    position: Position = None,
    angles: Angles = None,
    order: Order = "rpy",
    length: Length = None,
    ellipsoid: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            help="Semi-axes of the operation ellipsoid along the platform axes, in the unit of the "
            "design. Default: those that the design records, else (r, r, r/2) with r the largest "
            "distance of a platform anchor from the platform origin.",
            metavar="A B C",
            show_default=False,
        ),
    ] = None,
    out: Out = None,
    plot: Annotated[
        FilePath | None,
        typer.Option(
            help="Draw the table to this file: .png, .pdf or .svg.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    film: Annotated[
        FilePath | None,
        typer.Option(
            help="Write a film of the motion beside the indices to this file: .gif, .html (with "
            "buttons) or .mp4 (needs ffmpeg).",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    renderer: Annotated[
        Renderer,
        typer.Option(
            help="What draws the mechanism of a film: matplotlib lines, mujoco the links of its "
            "model (set MUJOCO_GL=egl or osmesa where there is no display)."
        ),
    ] = Renderer.matplotlib,
    force: Force = False,
) -> None:
    """Evaluate indices along a translation or a rotation, or over a plane.

    The path passes through --position, else the home pose of the design, else the pose at which
    |det J| is largest.

    **Examples**

    - `gsp sweep toz-kucuk-2016-d3-6 --rotate z --span -40:40 --plot turn.png`

    - `gsp sweep mine.toml --translate z --indices CTN,CDN_CL --film rise.gif`

    - `gsp sweep mine.toml --over xy --steps 61 --indices CTN,λ --plot plane.pdf`
    """
    if out is not None:
        check_table(out, overwrite=force)
    if plot is not None:
        check_picture(plot, overwrite=force)
    if film is not None:
        check_film(film, overwrite=force)
        if over is not None:
            raise InvalidInput(expected("--film", "--translate or --rotate", "--over"))
    else:
        refuse_unused(context, ["renderer"], "a sweep without --film, whose mechanism it draws")
    if rotate is None:
        given = "--over" if translate is None else "--translate"
        refuse_unused(context, ["through"], f"{given}: expected --rotate, whose axis it places")
    refuse_order(context, angles)
    _check_steps(steps, over)
    check_length(length)
    found = find_design(design)
    if found.driven and not indices:
        wanted = "indices, such as CTN with --length, as λ has no maximum with drives at the base"
        raise MissingParameter(expected("--indices", wanted, "none"))
    names = names_for(indices, [found]) if indices else ("quality_index",)
    refuse_parameters(context, names, [found])
    start = _start(found, position, angles, order)
    path = _path(found, start, translate, rotate, over, through, span, steps)
    spheroid = Ellipsoid(ellipsoid) if ellipsoid else own_ellipsoid(found)
    table = sweep(found, path, names, length=length, ellipsoid=spheroid)
    _print(table, found, path)
    if spheroid is not None and any("ellipsoid" in INDICES[name].parameters for name in names):
        say(ellipsoid_text(spheroid, found), "dim")
    if out is not None:
        attributes = {str(k): v for k, v in table.attrs.items()}
        write_table(table, out, attributes, headings=latex_headings(table), overwrite=force)
        say(f"Table      {out}")
    if plot is not None or film is not None:
        from gsp import plots
    if plot is not None:
        save_picture(plots.sweep(table, names), plot, overwrite=force)
    if film is not None:
        facts = table.attrs.get("maximum")
        known = facts["value"] or None if isinstance(facts, dict) else None
        values: dict[str, Any] = {"length": length, "ellipsoid": spheroid, "maximum": known}
        moving = plots.animate(found, path, names, **values, renderer=renderer.value)
        save_film(moving, film, overwrite=force)


def _check_steps(steps: int, over: str | None) -> None:
    """Raise an error for more poses than the memory can hold; a plane has steps² of them."""
    what = "--steps" if over is None else "--steps (squared, with --over)"
    check_memory(what, steps if over is None else steps**2, POSE_BYTES, "poses")


def _start(design: Design, position: Any, angles: Any, order: str) -> Pose:
    if position is None and angles is None and design.home is None:
        best = maximum(design).pose
        if best is not None:
            return best
    start = pose_of(design, position, angles, order)
    if start is None:
        raise InvalidInput("--position: expected three numbers, as the design has no home pose")
    return start


def _path(
    design: Design,
    start: Pose,
    translate: str | None,
    rotate: str | None,
    over: str | None,
    through: str,
    span: str | None,
    steps: int,
) -> Path:
    named = {"--translate": translate, "--rotate": rotate, "--over": over}
    asked = [option for option, value in named.items() if value is not None]
    if len(asked) != 1:
        got = f"{len(asked)} of them" if asked else "none"
        raise InvalidInput(expected(", ".join(asked or named), "one of these options", got))
    if rotate is not None:
        point: Any = THROUGH.get(through)
        if point is None:
            given = _three("--through", through, 'platform, base or three numbers "x,y,z"')
            point = [arguments.number("--through", value) for value in given]
        return turn(start, _direction("--rotate", rotate), _interval(span, 180.0, steps), point)
    distances = _interval(span, design.rms_radius, steps)
    if translate is not None:
        return translation(start, _direction("--translate", translate), distances)
    if over not in ("xy", "xz", "yz"):
        raise InvalidInput(expected("--over", "xy, xz or yz", brief(over)))
    return plane(start, distances, distances, (over[0], over[1]))


def _interval(span: str | None, half: float, steps: int) -> Any:
    if span is None:
        return np.linspace(-half, half, steps)
    ends = [number_of(word) for word in span.split(":")]
    if len(ends) != 2 or any(map(math.isnan, ends)):
        raise InvalidInput(expected("--span", "numbers low:high", brief(span)))
    low, high = (arguments.number("--span", end) for end in ends)
    if not low < high:
        raise InvalidInput(expected("--span", "low < high", brief(span)))
    return np.linspace(low, high, steps)


def _direction(option: str, text: str) -> Any:
    if text in ("x", "y", "z"):
        return text
    numbers = _three(option, text)
    if not any(numbers):
        raise InvalidInput(expected(option, "a direction that is not zero", brief(text)))
    return numbers


def _three(option: str, text: str, wanted: str = 'x, y, z or three numbers "1,0,1"') -> list[float]:
    numbers = [number_of(word) for word in number_words(option, text)]
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise InvalidInput(expected(option, wanted, brief(text)))
    return numbers


def _print(table: Any, design: Design, path: Path) -> None:
    say(f"{design.name}: {path.motion}", "bold")
    if path.start is not None:
        say(f"From {pose_text(path.start, design.unit)}")
    facts = table.attrs.get("maximum")
    if isinstance(facts, dict):
        say(f"|det J|max {facts['value']:.9g}, by {facts['method']}, over {_domain(facts)}")
    columns = tuple(map(str, table.columns))
    printed = plain_table(*columns, right=columns)
    for row in table.iloc[:: max(1, -(-len(table) // PRINTED_ROWS))].itertuples(index=False):
        printed.add_row(*(number(value, 5) for value in row))
    show_table(printed)


def _domain(facts: dict[str, Any]) -> str:
    domain = facts["domain"]
    part = "a box of poses" if "order" in domain else "poses near the home pose"
    return "all poses" if domain == "all poses" else part
