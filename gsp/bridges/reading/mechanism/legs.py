"""The leg of the catalogue that a chain of joints is, with its anchors, lines and strokes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gsp.bridges.reading.mechanism.actuated import check_driven, driven_of_two
from gsp.bridges.reading.mechanism.chains import Path
from gsp.bridges.reading.mechanism.driven import driven_leg, is_driven
from gsp.bridges.reading.mechanism.ends import (
    End,
    FoundLeg,
    check_near,
    check_small,
    joint_at_end,
    sine,
)
from gsp.bridges.reading.mechanism.linkages import Freedom
from gsp.bridges.reading.mechanism.mobility import rank
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
        Of the leg.

    Returns
    -------
    FoundLeg
        In the axes of the world, on the side of the base.

    Raises
    ------
    InvalidInput
        If the joints are not those of an SPS, SPC, CPS or CCC leg, or of a PSS or RSS leg that is
        driven at the base. Two or three turns whose axes meet count as S, a slide and a turn along
        one line as C. If the leg alone holds the platform, or other joints are driven than those
        of the leg.
    """
    where = f"leg {number} (joints {cut(path.names, LETTERS_PER_TEXT)})"
    count = sum(3 if x.kind == "ball" else 1 for x in path.freedoms)
    _check_count(count, count, where)
    if is_driven(path.freedoms):
        leg = driven_leg(path.freedoms, where, size)
        _check_count(rank(path.freedoms, size), count, where)
        return leg
    base, rest = joint_at_end(path.freedoms, where, size, "base")
    platform, rest = joint_at_end(tuple(reversed(rest)), where, size, "platform")
    middle = tuple(reversed(rest))
    kinds = sorted(x.kind for x in middle)
    if kinds not in (["slide"], ["slide", "turn"]):
        got = ", ".join(f"{x.kind} {brief(x.name)}" for x in middle) or "none"
        wanted = "one slide, or a slide and a turn along one axis, between the joints at its ends"
        raise InvalidInput(expected(where, wanted, got))
    _check_count(rank(path.freedoms, size), count, where)
    slide = next(x for x in middle if x.kind == "slide")
    turn = next((x for x in middle if x.kind == "turn"), None)
    if turn is not None:
        check_small(sine(slide.axis, turn.axis), where, "a slide and a turn along one axis", "sine")
    lines = not np.isnan(base.line).any(), not np.isnan(platform.line).any()
    u, length = _segment(base, platform, slide, where, size)
    if all(lines):
        if turn is None:
            raise InvalidInput(expected(where, "a turn beside the slide between two lines", "none"))
        driven = driven_of_two(path.freedoms, slide, turn, where)
        return _between_lines(base, platform, slide, turn, u, length, driven, where)
    if turn is not None:
        centre = (platform if lines[0] else base).point
        away = float(norm(cross(slide.axis, turn.point - centre)))
        check_near(away, size, where, "a turn beside the slide about the line through a joint S")
    check_driven(path.freedoms, slide, where)
    names = {(False, False): "D1", (False, True): "D2", (True, False): "D3"}
    stroke = _stroke(slide, length, float(slide.axis @ u), where)
    return FoundLeg(names[lines], base, platform, [stroke])


def _check_count(independent: int, count: int, where: str) -> None:
    if independent < LEAST_FREEDOMS:
        wanted = f"at least {LEAST_FREEDOMS} freedoms, with which a leg alone holds nothing"
        got = f"{count}" if independent == count else f"{count}, of them {independent} independent"
        raise InvalidInput(expected(where, wanted, got))


def _between_lines(
    base: End,
    platform: End,
    slide: Freedom,
    turn: Freedom,
    u: Array,
    length: float,
    driven: Sequence[Freedom],
    where: str,
) -> FoundLeg:
    normal = cross(base.line, platform.line)
    angle = float(np.arctan2(norm(normal), base.line @ platform.line))
    strokes = {
        "D4": (slide, _stroke(slide, length, float(slide.axis @ u), where)),
        "A1": (turn, _stroke(turn, angle, float(turn.axis @ normal), where)),
    }
    found = {name: stroke for name, (freedom, stroke) in strokes.items() if freedom in driven}
    return FoundLeg(" ".join(found), base, platform, list(found.values()))


def _segment(
    base: End, platform: End, slide: Freedom, where: str, size: float
) -> tuple[Array, float]:
    """Return direction and length of a leg; its slide must be along it."""
    d = platform.point - base.point
    for end in (base, platform):
        if not np.isnan(end.line).any():
            check_small(float(slide.axis @ end.line), where, "a slide across its lines", "cosine")
    along = float(d @ slide.axis)
    u = slide.axis * (1.0 if along >= 0.0 else -1.0)
    aside = d - abs(along) * u
    for end in (base, platform):
        if not np.isnan(end.line).any():
            aside = aside - (aside @ end.line) * end.line
    # Both anchors of lines may lie anywhere on them: what is left aside is neither.
    if np.isnan(base.line).any() or np.isnan(platform.line).any():
        check_near(float(norm(aside)), size, where, "a slide from end to end")
    return u, abs(along)


def _stroke(freedom: Freedom, value: float, sign: float, where: str) -> tuple[float, float]:
    """Return the limits of an actuated joint within what it can have; NaN for none."""
    ends = (freedom.low, freedom.high) if sign >= 0.0 else (-freedom.high, -freedom.low)
    low, high = (value + x if np.isfinite(x) else np.nan for x in ends)
    what, most = ("a length", np.inf) if freedom.kind == "slide" else ("an angle", np.pi)
    if high < 0.0 or low > most:
        got = f"limits of {brief(freedom.name)} from {low:g} to {high:g}, counted by it"
        raise InvalidInput(expected(where, f"limits that {what} can have", got))
    # Comparisons with NaN are false, so that it stays.
    return (0.0 if low < 0.0 else low, most if high > most else high)
