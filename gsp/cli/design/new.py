"""`gsp new`: the design file of a hexapod, from options or from questions on a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable
from enum import StrEnum
from math import inf, isnan
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import typer

from gsp import arguments
from gsp.cli.inputs.options import Force
from gsp.cli.outputs import waiting
from gsp.cli.outputs.console import say, warn
from gsp.cli.outputs.postures import warn_of
from gsp.determinant.canonical import canonical
from gsp.determinant.search import always_singular
from gsp.errors import InvalidInput, brief, expected
from gsp.families.circular import LARGEST_PAIR_ANGLE_DEG, hexapod
from gsp.files.cells import number_of
from gsp.files.names import file_stem
from gsp.files.writing import check_writable
from gsp.model.design import Design
from gsp.model.units import METRES_PER_UNIT, check_unit


class Arrangement(StrEnum):
    """How the legs join the pairs of anchors."""

    pairs = "pairs"
    zigzag = "zigzag"


Number = float | None
LARGEST = arguments.LARGEST_NUMBER
ANGLE = arguments.within(0.0, LARGEST_PAIR_ANGLE_DEG, "an angle in [0, 120] degrees")


class Question(NamedTuple):
    """A question, and the check of its answer."""

    text: str
    check: Callable[[str, float], object]


QUESTIONS = {
    "base_radius": Question("Radius of the base", arguments.size),
    "base_angle": Question(
        "Angle between the two anchors of a pair of the base, in degrees", ANGLE
    ),
    "platform_radius": Question("Radius of the platform", arguments.size),
    "platform_angle": Question(
        "Angle between the two anchors of a pair of the platform, in degrees", ANGLE
    ),
    "height": Question("Height of the platform in the home pose", arguments.size),
}


def new(
    base_radius: Annotated[
        Number, typer.Option(help="Radius of the circle of the base anchors, in --unit.")
    ] = None,
    base_angle: Annotated[
        Number,
        typer.Option(help="Angle between the two base anchors of a pair, 0 to 120 degrees."),
    ] = None,
    platform_radius: Annotated[
        Number, typer.Option(help="Radius of the circle of the platform anchors, in --unit.")
    ] = None,
    platform_angle: Annotated[
        Number,
        typer.Option(help="Angle between the two platform anchors of a pair, 0 to 120 degrees."),
    ] = None,
    height: Annotated[
        Number, typer.Option(help="Height of the platform in the home pose, in --unit.")
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option(
            help="Unit of length, such as mm. Default: m where it is asked for, else none.",
            show_default=False,
        ),
    ] = None,
    strokes: Annotated[
        tuple[float, float] | None,
        typer.Option(
            help="Least and greatest length of all legs, in --unit. Default: no limits.",
            metavar="LOW HIGH",
            show_default=False,
        ),
    ] = None,
    arrangement: Annotated[
        Arrangement,
        typer.Option(
            help="pairs: each base anchor is joined to the nearest platform anchor of the "
            "neighbouring pair; zigzag: the pairs are above each other, and the legs lean to the "
            "left and to the right alternately."
        ),
    ] = Arrangement.pairs,
    name: Annotated[str, typer.Option(help="Name of the design.")] = "hexapod",
    out: Annotated[
        Path | None,
        typer.Option(
            help="File to write (.toml). Default: named after the design, here.",
            metavar="FILE",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Write the design file of a hexapod: six legs, anchors in pairs on two circles.

    On a terminal the radii, angles, height, unit and strokes that are not given are asked for.
    Elsewhere the five numbers are required.

    **Examples**

    - `gsp new --base-radius 2 --base-angle 20 --platform-radius 1 --platform-angle 20 --height 1.5`
    """
    if strokes is not None:
        _check_strokes(strokes)
    if unit is not None:
        _check_unit("--unit", unit)
    given = {
        "base_radius": base_radius,
        "base_angle": base_angle,
        "platform_radius": platform_radius,
        "platform_angle": platform_angle,
        "height": height,
    }
    missing = [key for key, value in given.items() if value is None]
    if missing and not sys.stdin.isatty():
        options = ", ".join(f"--{key.replace('_', '-')}" for key in missing)
        raise InvalidInput(f"{options}: expected a number, as there is no terminal to ask on")
    target = out or Path(file_stem(name) + ".toml")
    if missing:
        check_writable(target, overwrite=force, suffixes=(".toml",))  # before any question
        for key, value in given.items():
            if value is not None:
                QUESTIONS[key].check(f"--{key.replace('_', '-')}", value)
        unit = _unit() if unit is None else unit
    numbers = {
        key: _number(QUESTIONS[key]) if value is None else value for key, value in given.items()
    }
    if missing and strokes is None and _yes("Do the legs have limits?"):
        low = _number(Question("Least length", arguments.within(0.0, LARGEST, "a length ≥ 0")))
        most = arguments.within(low, LARGEST, f"at least {low:g}, the least length")
        strokes = (low, _number(Question("Greatest length", most)))
    design = hexapod(
        **numbers,
        arrangement=arrangement.value,
        degrees=True,
        strokes=strokes,
        unit=unit or "",
        name=name,
    )
    check_writable(target, overwrite=force, suffixes=(".toml",))
    design.write(target, overwrite=force)
    say(str(target))
    _warn_of(design)


def _number(question: Question) -> float:
    """Return the number that is typed; what is none, or out of range, is said, and asked again."""
    while True:
        answer = _text(question.text).strip()
        value = number_of(answer)
        if isnan(value):
            warn(expected("answer", "a number", brief(answer)))
            continue
        try:
            question.check("answer", value)
        except InvalidInput as error:
            warn(str(error))
            continue
        return value


def _unit() -> str:
    """Return the unit that is typed; what is none is said, and asked again."""
    while True:
        answer = _text("Unit of length, such as mm", default="m").strip()
        try:
            _check_unit("answer", answer)
        except InvalidInput as error:
            warn(str(error))
            continue
        return answer


def _check_unit(what: str, text: str) -> None:
    """Refuse what names no unit of length, such as the answer to another question."""
    if check_unit(what, text) and text not in METRES_PER_UNIT:
        wanted = "the name of a unit of length: " + ", ".join(METRES_PER_UNIT)
        raise InvalidInput(expected(what, wanted, brief(text)))


def _text(question: str, **options: Any) -> str:
    with waiting.question():
        return str(typer.prompt(question, type=str, **options))


def _yes(question: str) -> bool:
    """Return whether the answer is yes; what is neither yes nor no is asked again."""
    while True:
        answer = _text(f"{question} [y/N]", default="", show_default=False).strip().lower()
        if answer in ("y", "yes", "n", "no", ""):
            return answer.startswith("y")
        warn(expected("answer", "y or n", brief(answer)))


def _check_strokes(strokes: tuple[float, float]) -> None:
    if not 0.0 <= strokes[0] <= strokes[1] < inf:
        wanted = "0 ≤ LOW ≤ HIGH, both finite"
        raise InvalidInput(expected("--strokes", wanted, f"{strokes[0]} {strokes[1]}"))
    arguments.number("--strokes", strokes[1])


def _warn_of(design: Design) -> None:
    """Print whether a design is singular in every pose, and its legs beyond their strokes."""
    form = canonical(design)
    if always_singular(form.design, form.region):
        warn("singular in every pose: the hexagons of the anchors are similar")
    if design.home is not None:
        warn_of(design.at(design.home), "in the home pose, ")
