"""The leg of the catalogue that a chain of joints is, with its anchors, lines and strokes."""

from __future__ import annotations

import numpy as np

from gsp.bridges.reading.chains import Path
from gsp.bridges.reading.driven import driven_leg, is_driven
from gsp.bridges.reading.ends import (
    TOLERANCE,
    End,
    FoundLeg,
    check_that,
    joint_at_end,
    parallel,
    perpendicular,
)
from gsp.bridges.reading.linkages import Freedom
from gsp.errors import LETTERS_PER_TEXT, InvalidInput, brief, cut, expected
from gsp.geometry.vectors import Array, cross, norm

LEAST_FREEDOMS = 6


def leg_of(path: Path, number: int, size: float) -> FoundLeg:
    """Return the leg that a chain of joints is.

    Parameters
    ----------
    path : Path
    number : int
        Of the leg, from 1, for errors.
    size : float [m]
        Of the mechanism.

    Returns
    -------
    FoundLeg
        In the axes of the world, on the side of the base.

    Raises
    ------
    InvalidInput
        If the joints are not those of an SPS, SPC, CPS or CCC leg, or of a PSS or RSS leg that is
        driven at the base. Two or three turns whose axes meet count as S, a slide and a turn along
        one line as C.
    """
    where = f"leg {number} (joints {cut(path.names, LETTERS_PER_TEXT)})"
    count = sum(3 if x.kind == "ball" else 1 for x in path.freedoms)
    if count < LEAST_FREEDOMS:
        wanted = f"at least {LEAST_FREEDOMS} freedoms, with which a leg alone holds nothing"
        raise InvalidInput(expected(where, wanted, f"{count}"))
    if is_driven(path.freedoms):
        return driven_leg(path.freedoms, where, size)
    base, rest = joint_at_end(path.freedoms, where, size, "base")
    platform, rest = joint_at_end(tuple(reversed(rest)), where, size, "platform")
    middle = tuple(reversed(rest))
    kinds = sorted(x.kind for x in middle)
    if kinds not in (["slide"], ["slide", "turn"]):
        got = ", ".join(f"{x.kind} {brief(x.name)}" for x in middle) or "none"
        wanted = "one slide, or a slide and a turn along one axis, between the joints at its ends"
        raise InvalidInput(expected(where, wanted, got))
    slide = next(x for x in middle if x.kind == "slide")
    turn = next((x for x in middle if x.kind == "turn"), None)
    if turn is not None:
        check_that(parallel(slide.axis, turn.axis), where, "a slide and a turn along one axis")
    lines = not np.isnan(base.line).any(), not np.isnan(platform.line).any()
    u, length = _segment(base, platform, slide, where, size)
    if all(lines):
        if turn is None:
            raise InvalidInput(expected(where, "a turn beside the slide between two lines", "none"))
        return _between_lines(base, platform, slide, turn, u, length, where)
    names = {(False, False): "D1", (False, True): "D2", (True, False): "D3"}
    stroke = _stroke(slide, length, float(slide.axis @ u))
    return FoundLeg(names[lines], base, platform, [stroke])


def _between_lines(
    base: End, platform: End, slide: Freedom, turn: Freedom, u: Array, length: float, where: str
) -> FoundLeg:
    normal = cross(base.line, platform.line)
    angle = float(np.arctan2(norm(normal), base.line @ platform.line))
    strokes = {
        "D4": _stroke(slide, length, float(slide.axis @ u)),
        "A1": _stroke(turn, angle, float(turn.axis @ normal)),
    }
    active = {"D4": slide.active, "A1": turn.active}
    names = [name for name, drives in active.items() if drives]
    if not names:
        wanted = "an actuator of the slide, of the turn, or of both"
        raise InvalidInput(expected(where, wanted, "none"))
    return FoundLeg(" ".join(names), base, platform, [strokes[name] for name in names])


def _segment(
    base: End, platform: End, slide: Freedom, where: str, size: float
) -> tuple[Array, float]:
    """Return direction and length of a leg; its slide must be along it."""
    d = platform.point - base.point
    for end in (base, platform):
        if not np.isnan(end.line).any():
            check_that(perpendicular(slide.axis, end.line), where, "a slide across its lines")
    along = float(d @ slide.axis)
    u = slide.axis * (1.0 if along >= 0.0 else -1.0)
    aside = d - abs(along) * u
    for end in (base, platform):
        if not np.isnan(end.line).any():
            aside = aside - (aside @ end.line) * end.line
    # Both anchors of lines may lie anywhere on them: what is left aside is neither.
    if np.isnan(base.line).any() or np.isnan(platform.line).any():
        check_that(float(norm(aside)) <= TOLERANCE * size, where, "a slide from end to end")
    return u, abs(along)


def _stroke(freedom: Freedom, value: float, sign: float) -> tuple[float, float]:
    """Return the limits of an actuated joint; NaN for none."""
    ends = (freedom.low, freedom.high) if sign >= 0.0 else (-freedom.high, -freedom.low)
    low, high = (value + x if np.isfinite(x) else np.nan for x in ends)
    return (max(low, 0.0) if low == low else low, high)
