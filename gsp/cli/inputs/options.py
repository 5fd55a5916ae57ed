"""Options that several commands share."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from gsp import arguments
from gsp.errors import InvalidInput
from gsp.indices import INDICES
from gsp.model.design import Design

DesignName = Annotated[
    str,
    typer.Argument(
        help='A published design, a design file (.toml), or a family such as "lee-3-3(a=1, b=2)".'
    ),
]
Length = Annotated[
    float | None,
    typer.Option(
        help="Characteristic length, in the unit of the design. Default: that of the design.",
        show_default=False,
    ),
]
Rays = Annotated[int, typer.Option(help="Rays around the radiating point.", min=1)]
Connecting = Annotated[
    bool, typer.Option(help="Follow curves between complete bifurcation points as well.")
]
Workers = Annotated[
    int | None,
    typer.Option(help="Threads. Default: one per core.", min=1, show_default=False),
]
Out = Annotated[
    Path | None,
    typer.Option(
        help="Write the table to this file: .csv, .parquet, .xlsx, .md or .tex.",
        metavar="FILE",
        show_default=False,
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Overwrite files that exist.")]
Order = Annotated[
    str,
    typer.Option(
        help='Angle set: "rpy" (R = Rz Ry Rx), "approach-roll" (R = Ry Rx Rz), or axes such as '
        '"ZYX" (moving) or "zyx" (fixed).',
        metavar="SET",
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
        help="Orientation in degrees, in the order of --order. Default: 0 0 0 with --position, "
        "else that of the home pose.",
        metavar="A B C",
        show_default=False,
    ),
]
Template = Annotated[
    str,
    typer.Option(
        help="Design on whose anchor lines a mechanism is placed: a name or a file.",
        metavar="DESIGN",
    ),
]


def refuse_unused(context: typer.Context, names: Iterable[str], beside: str) -> None:
    """Raise an error if the user gave an option that the command would not use.

    Parameters
    ----------
    context : typer.Context
    names : iterable of str
        Of the parameters.
    beside : str
        What makes them of no use, for the message.

    Raises
    ------
    InvalidInput
    """
    sources = {name: context.get_parameter_source(name) for name in names}
    given = {name for name, source in sources.items() if source and source.name == "COMMANDLINE"}
    options = [
        (p.secondary_opts or p.opts if context.params[p.name] is False else p.opts)[0]
        for p in context.command.params
        if p.name in given
    ]
    if options:
        raise InvalidInput(f"{', '.join(options)}: not used beside {beside}")


def refuse_order(context: typer.Context, angles: object) -> None:
    """Raise InvalidInput if the user gave --order, but no angles to which it applies."""
    if angles is None:
        refuse_unused(context, ["order"], "a pose without --angles: expected both or neither")


def refuse_parameters(
    context: typer.Context, names: Sequence[str], designs: Sequence[Design]
) -> None:
    """Raise an error if the user gave --length or --ellipsoid, and no index depends on it.

    Parameters
    ----------
    context : typer.Context
    names : sequence of str
        Of the indices that are computed.
    designs : sequence of Design

    Raises
    ------
    InvalidInput
    """
    needed = {need for name in names for design in designs for need in needs(name, design)}
    known = {parameter.name for parameter in context.command.params}
    unused = [name for name in ("length", "ellipsoid") if name in known - needed]
    options = [f"--{name}" for name in ("require", "index", "indices") if context.params.get(name)]
    beside = " and ".join(options or ["--indices"])
    refuse_unused(context, unused, f"{beside} {','.join(names)}, which does not depend on it")


def needs(name: str, design: Design) -> tuple[str, ...]:
    """Return the parameters on which an index of a design depends."""
    return INDICES[name].missing(design, ())


def check_length(length: float | None) -> None:
    """Raise InvalidInput, which names the option, for a length that is not positive, or extreme."""
    if length is not None:
        arguments.size("--length", length)
