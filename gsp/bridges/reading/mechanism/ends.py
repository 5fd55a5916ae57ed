"""The joints at the ends of a leg of a model file: spherical, or cylindrical along a line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gsp.bridges.reading.mechanism.linkages import Freedom
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, norm, unit
from gsp.model.drives import Drive

# Largest distance of what should meet, as a share of the size of the leg, and largest sine or
# cosine of what should be parallel or perpendicular: files often have six digits.
TOLERANCE = 1e-5
NONE = np.full(3, np.nan)
MANY_TURNS = 3


class End(NamedTuple):
    """The joint at one end of a leg: spherical (`line` is NaN), or cylindrical along a line."""

    point: Array
    line: Array


class FoundLeg(NamedTuple):
    """A leg: its constraints, anchors and lines in the axes of the file, strokes per constraint.

    Of a leg that is driven at the base the constraint is D1, and the arm of its drive is in the
    axes of the file.
    """

    constraints: str
    base: End
    platform: End
    strokes: list[tuple[float, float]]
    drive: Drive | None = None


def joint_at_end(
    freedoms: Sequence[Freedom], where: str, size: float, side: str
) -> tuple[End, tuple[Freedom, ...]]:
    """Return the joint at the beginning of a sequence, and the freedoms behind it.

    Parameters
    ----------
    freedoms : sequence of Freedom
        From one end of a leg on.
    where : str
        The leg, for errors.
    size : float [m]
        Of the leg.
    side : "base", "tip" or "platform"
        Where they begin.

    Raises
    ------
    InvalidInput
        If it is neither spherical nor cylindrical.
    """
    first = freedoms[0] if freedoms else None
    if first is not None and first.kind == "ball":
        return End(first.point, NONE), tuple(freedoms[1:])
    pair = freedoms[:2]
    if {x.kind for x in pair} == {"slide", "turn"} and parallel(pair[0].axis, pair[1].axis):
        return _cylindrical(pair, platform=side == "platform"), tuple(freedoms[2:])
    count = 0
    while count < min(MANY_TURNS, len(freedoms)) and freedoms[count].kind == "turn":
        count += 1
    missed = None
    for turns in range(count, 1, -1):
        point = _meeting(freedoms[:turns])
        if point is None:
            continue
        missed = _through(point, freedoms[:turns])
        if missed <= TOLERANCE * size:
            return End(point, NONE), tuple(freedoms[turns:])
    got = ", ".join(f"{x.kind} {brief(x.name)}" for x in freedoms[:MANY_TURNS]) or "nothing"
    if missed is not None:
        got += f", of which the axes miss each other by {_beyond(missed)}"
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
        alike = all(parallel(turns[0].axis, x.axis) for x in turns[1:])
        return None if alike else turns[0].point
    for freedom in turns:
        across = np.eye(3) - np.outer(freedom.axis, freedom.axis)
        total, moments = total + across, moments + across @ freedom.point
    if np.linalg.eigvalsh(total)[0] < TOLERANCE**2:
        return None
    return np.asarray(np.linalg.solve(total, moments))


def _through(point: Array, turns: Sequence[Freedom]) -> float:
    """Return the largest distance of a point from some axes."""
    return max(float(norm(cross(point - x.point, x.axis))) for x in turns)


def sine(one: Array, other: Array) -> float:
    """Return the sine of the angle between two unit vectors, in [0, 1]."""
    return float(norm(cross(one, other)))


def parallel(one: Array, other: Array) -> bool:
    """Return whether two unit vectors are parallel up to the tolerance."""
    return sine(one, other) <= TOLERANCE


def check_small(value: float, where: str, wanted: str, what: str) -> None:
    """Raise InvalidInput with what was wanted of a leg, if a sine or cosine is not small."""
    if abs(value) > TOLERANCE:
        raise InvalidInput(expected(where, wanted, f"a {what} of {value:.2g} between them"))


def check_near(distance: float, size: float, where: str, wanted: str) -> None:
    """Raise InvalidInput with what was wanted of a leg, if a distance is more than rounding."""
    if distance > TOLERANCE * size:
        raise InvalidInput(expected(where, wanted, f"one that misses by {_beyond(distance)}"))


def _beyond(distance: float) -> str:
    return f"{distance:.3g} m, which is more than {TOLERANCE:g} of the leg"


def anchors_on_platform(end: End, shift: Pose, platform: Pose) -> End:
    """Return the joint at the platform in the axes of the platform."""
    at = platform.inverse().compose(shift)
    line = NONE if np.isnan(end.line).any() else unit(at.rotation @ end.line)
    return End(at.position + at.rotation @ end.point, line)
