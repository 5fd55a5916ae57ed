"""Ranges of angles, limits and checks of the options of `gsp workspace`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import typer

from gsp import arguments
from gsp.checks import check_memory
from gsp.cli.inputs.numbers import number_words
from gsp.cli.inputs.options import check_length, refuse_unused
from gsp.errors import InvalidInput, apart, brief, expected
from gsp.files.cells import number_of
from gsp.geometry.vectors import Array
from gsp.model.design import Design

if TYPE_CHECKING:
    from gsp.limits import Limits


def read_range(context: typer.Context, angles: str | None, tilt: float | None) -> Array | None:
    """Return least and greatest angles in degrees (3, 2), None for any orientation."""
    if tilt is None:
        return None if angles is None else _read_angles(angles)
    refuse_unused(context, ["angles", "order"], "--tilt")
    if not 0.0 < arguments.number("--tilt", tilt) < 90.0:
        raise InvalidInput(expected("--tilt", "an angle above 0 and below 90 (degrees)", tilt))
    return np.array([[-tilt, tilt], [-tilt, tilt], [0.0, 0.0]])


def _read_angles(text: str) -> Array:
    ends = [[number_of(end) for end in word.split(":")] for word in number_words("--angles", text)]
    pairs = [(end[0], end[-1]) for end in ends if len(end) in (1, 2)]
    known = all(math.isfinite(angle) for end in ends for angle in end)
    if len(ends) != 3 or len(pairs) != 3 or not known:
        raise InvalidInput(
            expected(
                "--angles", 'three angles or intervals low:high, such as "0 0 -30:30"', brief(text)
            )
        )
    if any(low > high for low, high in pairs):
        raise InvalidInput(expected("--angles", "intervals low:high with low ≤ high", brief(text)))
    return np.array(pairs)


def read_bounds(text: str | None) -> list[list[float | None]] | None:
    """Return least and greatest x, y and z of --box, None for no bound."""
    if text is None:
        return None
    words = [word.split(":") for word in number_words("--box", text)]
    box = [[None if end == "" else number_of(end) for end in word] for word in words]
    numbers = [end for pair in box for end in pair if end is not None]
    if [len(pair) for pair in box] != [2, 2, 2] or not all(map(math.isfinite, numbers)):
        wanted = 'three intervals low:high, an end left out for no bound, such as "-1:1 : 0:2"'
        raise InvalidInput(expected("--box", wanted, brief(text)))
    if any(None not in pair and pair[0] > pair[1] for pair in box):  # type: ignore[operator]
        raise InvalidInput(expected("--box", "intervals low:high with low ≤ high", brief(text)))
    return box


def is_range(box: Array | None) -> bool:
    """Return whether angles (3, 2) are more than one orientation."""
    return box is not None and bool((box[:, 1] > box[:, 0]).any())


def orientation_words(box: Array | None, order: str, *, some: bool = False) -> str:
    """Return the words for any orientation, one, or those of a range: all, or some of them."""
    if box is None:
        return "any orientation"
    from gsp.workspace.sets.shapes.titles import range_words

    return range_words(box, order, some=some)


def limit_words(
    stroke: tuple[float, float] | None,
    cone: float | None,
    radius: float | None,
    require: list[str] | None,
    unit: str,
    position: str | None = None,
) -> str:
    """Return the words for the limits that options give, "" for none."""
    words = []
    if position is not None:
        words.append(f"x y z in {' '.join(position.replace(',', ' ').split())}")
    if stroke is not None:
        words.append(f"joints {stroke[0]:g}…{stroke[1]:g}")
    if cone is not None:
        words.append(f"cones of {cone:g}°")
    if radius is not None:
        words.append(f"legs of radius {radius:g} {unit}".rstrip())
    return ", ".join([*words, *(" ".join(text.split()) for text in require or ())])


def vertical_plane(theta: float) -> Array:
    """Return the two directions of the vertical plane at an angle [°] from the x-axis."""
    turn = np.deg2rad(theta)
    return np.array([[np.cos(turn), np.sin(turn), 0.0], [0.0, 0.0, 1.0]])


def read_limits(
    strokes: list[list[float]] | None,
    cone: float | None,
    radius: float | None,
    require: list[str] | None,
    length: float | None,
    position: str | None = None,
) -> Limits:
    """Return the limits that options give; angles are in degrees.

    Raises
    ------
    InvalidInput
        Which names the option.
    """
    from gsp.limits import Limits

    if cone is not None and not 0.0 < arguments.number("--cone", cone) <= 90.0:
        raise InvalidInput(expected("--cone", "an angle above 0, at most 90 (degrees)", cone))
    if radius is not None:
        arguments.size("--radius", radius)
    check_length(length)
    half = None if cone is None else float(np.deg2rad(cone))
    return Limits(
        strokes=strokes,
        base_cone=half,
        platform_cone=half,
        position=read_bounds(position),
        leg_radius=radius,
        indices=require or (),
        length=length,
    )


def check_numbers(rays: int, theta: float, position: tuple[float, float, float] | None) -> None:
    """Raise an error for numbers that are not finite, or more rays than fit into the memory.

    Raises
    ------
    InvalidInput
        Which names the option.
    """
    from gsp.workspace.boundary.mapping import RAY_BYTES

    check_memory("--rays", rays, RAY_BYTES, "rays")
    arguments.number("--theta", theta)
    for value in position or ():
        arguments.number("--position", value)


def check_curves(box: Array | None, where: str | None, curves: bool, interior: bool) -> None:
    """Raise an error for curves that are not on the boundary of a region in a plane.

    Raises
    ------
    InvalidInput
        Which names the option.
    """
    if interior and not curves:
        raise InvalidInput(expected("--interior", "--curves", "none"))
    if curves and where != "plane":
        received = "no --region" if where is None else f"a region in {where}"
        raise InvalidInput(expected("--curves", "--region plane", received))
    if curves and is_range(box):
        wanted = "any orientation, or one (--angles)"
        raise InvalidInput(expected("--curves", wanted, "an interval of angles"))


def check_index(
    index: list[str] | None, where: str | None, *, curves: bool, orientations: bool
) -> None:
    """Raise an error for indices that are not over a region.

    Raises
    ------
    InvalidInput
        Which names the option.
    """
    if index and not orientations and (where is None or curves):
        wanted = "--region, an interval of angles, or --orientations"
        raise InvalidInput(expected("--index", wanted, "--curves" if curves else "none"))


def check_place(design: Design, position: tuple[float, float, float] | None) -> None:
    """Raise an error if there is neither a position nor a home pose.

    Raises
    ------
    InvalidInput
        Which names the option.
    """
    if position is None and design.home is None:
        raise InvalidInput(
            expected("--position", "a point, as the design has no home pose", "none")
        )


def check_cone(design: Design, cone: float | None) -> None:
    """Raise an error for a cone about directions that there are not.

    Raises
    ------
    InvalidInput
        Which names the option.
    """
    if cone is not None and design.home is None:
        wanted = "a design with a home pose, whose legs are the axes of the cones"
        raise InvalidInput(expected("--cone", wanted, "none"))


def check_stroke(stroke: tuple[float, float], *, equal: bool = False, signed: bool = False) -> None:
    """Raise an error for bounds in the wrong order, or equal ones, between which no curve is.

    Bounds below zero are an error too, but for joints whose values have a sign.
    """
    low, high = (arguments.number("--stroke", value) for value in stroke)
    if low < 0.0 and not signed:
        wanted = "0 ≤ LOW, as no distance is negative"
        raise InvalidInput(expected("--stroke", wanted, " ".join(apart(low, high))))
    if low > high or (low == high and not equal):
        wanted = "LOW ≤ HIGH" if equal else "LOW < HIGH"
        raise InvalidInput(expected("--stroke", wanted, " ".join(apart(low, high))))
