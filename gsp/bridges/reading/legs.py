"""The leg of the catalogue that a chain of joints is, with its anchors, lines and strokes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gsp.bridges.reading.chains import Path
from gsp.bridges.reading.linkages import Freedom
from gsp.errors import LETTERS_PER_TEXT, InvalidInput, brief, cut, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, norm, unit

# Largest distance of what should meet, as a share of the size of the leg, and largest sine or
# cosine of what should be parallel or perpendicular: files often have six digits.
TOLERANCE = 1e-4
NONE = np.full(3, np.nan)
MANY_TURNS = 3
LEAST_FREEDOMS = 6


class End(NamedTuple):
    """The joint at one end of a leg: spherical (`line` is NaN), or cylindrical along a line."""

    point: Array
    line: Array


class FoundLeg(NamedTuple):
    """A leg: its constraints, anchors and lines in the axes of the file, strokes per constraint."""

    constraints: str
    base: End
    platform: End
    strokes: list[tuple[float, float]]


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
        If the joints are not those of an SPS, SPC, CPS or CCC leg. Two or three turns whose axes
        meet count as S, a slide and a turn along one line as C.
    """
    where = f"leg {number} (joints {cut(path.names, LETTERS_PER_TEXT)})"
    count = sum(3 if x.kind == "ball" else 1 for x in path.freedoms)
    if count < LEAST_FREEDOMS:
        wanted = f"at least {LEAST_FREEDOMS} freedoms, with which a leg alone holds nothing"
        raise InvalidInput(expected(where, wanted, f"{count}"))
    base, rest = _end(path.freedoms, where, size, platform=False)
    platform, rest = _end(tuple(reversed(rest)), where, size, platform=True)
    middle = tuple(reversed(rest))
    kinds = sorted(x.kind for x in middle)
    if kinds not in (["slide"], ["slide", "turn"]):
        got = ", ".join(f"{x.kind} {brief(x.name)}" for x in middle) or "none"
        wanted = "one slide, or a slide and a turn along one axis, between the joints at its ends"
        raise InvalidInput(expected(where, wanted, got))
    slide = next(x for x in middle if x.kind == "slide")
    turn = next((x for x in middle if x.kind == "turn"), None)
    if turn is not None:
        _check(_parallel(slide.axis, turn.axis), where, "a slide and a turn along one axis")
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
            _check(_perpendicular(slide.axis, end.line), where, "a slide across its lines")
    along = float(d @ slide.axis)
    u = slide.axis * (1.0 if along >= 0.0 else -1.0)
    aside = d - abs(along) * u
    for end in (base, platform):
        if not np.isnan(end.line).any():
            aside = aside - (aside @ end.line) * end.line
    # Both anchors of lines may lie anywhere on them: what is left aside is neither.
    if np.isnan(base.line).any() or np.isnan(platform.line).any():
        _check(float(norm(aside)) <= TOLERANCE * size, where, "a slide from end to end")
    return u, abs(along)


def _stroke(freedom: Freedom, value: float, sign: float) -> tuple[float, float]:
    """Return the limits of an actuated joint; NaN for none."""
    ends = (freedom.low, freedom.high) if sign >= 0.0 else (-freedom.high, -freedom.low)
    low, high = (value + x if np.isfinite(x) else np.nan for x in ends)
    return (max(low, 0.0) if low == low else low, high)


def _end(
    freedoms: Sequence[Freedom], where: str, size: float, *, platform: bool
) -> tuple[End, tuple[Freedom, ...]]:
    """Return the joint at the beginning of a sequence, and the freedoms behind it."""
    side = "platform" if platform else "base"
    first = freedoms[0] if freedoms else None
    if first is not None and first.kind == "ball":
        return End(first.point, NONE), tuple(freedoms[1:])
    pair = freedoms[:2]
    if {x.kind for x in pair} == {"slide", "turn"} and _parallel(pair[0].axis, pair[1].axis):
        return _cylindrical(pair, platform=platform), tuple(freedoms[2:])
    count = 0
    while count < min(MANY_TURNS, len(freedoms)) and freedoms[count].kind == "turn":
        count += 1
    for turns in range(count, 1, -1):
        point = _meeting(freedoms[:turns])
        if point is not None and _through(point, freedoms[:turns]) <= TOLERANCE * size:
            return End(point, NONE), tuple(freedoms[turns:])
    got = ", ".join(f"{x.kind} {brief(x.name)}" for x in freedoms[:MANY_TURNS]) or "nothing"
    wanted = f"at the {side} a ball, turns whose axes meet, or a slide and a turn along one line"
    raise InvalidInput(expected(where, wanted, got))


def _cylindrical(pair: Sequence[Freedom], *, platform: bool) -> End:
    """Return the line of a slide and a turn; its anchor is where the slide counts zero.

    At the platform the turn is at the anchor, and the slide moves the leg along the line.
    """
    slide = next(x for x in pair if x.kind == "slide")
    turn = next(x for x in pair if x.kind == "turn")
    if platform:
        return End(turn.point, -slide.axis)
    counted = 0.0 if np.isnan(slide.value) else slide.value
    return End(turn.point - counted * slide.axis, slide.axis)


def _meeting(turns: Sequence[Freedom]) -> Array | None:
    """Return the point nearest to some axes, None if they are parallel."""
    total, moments = np.zeros((3, 3)), np.zeros(3)
    if all(np.array_equal(x.point, turns[0].point) for x in turns):
        parallel = all(_parallel(turns[0].axis, x.axis) for x in turns[1:])
        return None if parallel else turns[0].point
    for freedom in turns:
        across = np.eye(3) - np.outer(freedom.axis, freedom.axis)
        total, moments = total + across, moments + across @ freedom.point
    if np.linalg.eigvalsh(total)[0] < TOLERANCE**2:
        return None
    return np.asarray(np.linalg.solve(total, moments))


def _through(point: Array, turns: Sequence[Freedom]) -> float:
    """Return the largest distance of a point from some axes."""
    return max(float(norm(cross(point - x.point, x.axis))) for x in turns)


def _parallel(one: Array, other: Array) -> bool:
    return float(norm(cross(one, other))) <= TOLERANCE


def _perpendicular(one: Array, other: Array) -> bool:
    return abs(float(one @ other)) <= TOLERANCE


def _check(holds: bool, where: str, wanted: str) -> None:
    if not holds:
        raise InvalidInput(expected(where, wanted, "another direction or place"))


def anchors_on_platform(end: End, shift: Pose, platform: Pose) -> End:
    """Return the joint at the platform in the axes of the platform."""
    at = platform.inverse().compose(shift)
    line = NONE if np.isnan(end.line).any() else unit(at.rotation @ end.line)
    return End(at.position + at.rotation @ end.point, line)
