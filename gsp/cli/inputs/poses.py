"""Poses and boxes of poses, from options."""

from __future__ import annotations

import math
from typing import Any

from gsp import arguments
from gsp.cli.inputs.numbers import number_words
from gsp.errors import InvalidInput, brief, expected
from gsp.files.cells import number_of
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.rotations import rotation_from_angles
from gsp.model.design import Design


def pose_of(
    design: Design,
    position: tuple[float, float, float] | None,
    angles: tuple[float, float, float] | None,
    order: str,
) -> Pose | None:
    """Return the pose that the options give; what they do not give is taken from the home pose."""
    rotation_from_angles((0.0, 0.0, 0.0), order)  # raises an error for an unknown order
    home = design.home
    if position is None and angles is None:
        return home
    if position is None:
        if home is None:
            raise InvalidInput("--position: expected three numbers, as there is no home pose")
        return Pose.from_angles(home.position, angles or (0.0,) * 3, order, degrees=True)
    return Pose.from_angles(position, angles or (0.0,) * 3, order, degrees=True)


def read_box(text: str, order: str = "rpy") -> PoseBox:
    """Return a box of poses from six intervals low:high (x, y, z, then three angles in degrees).

    >>> read_box("-10:10 -10:10 120:140 -5:5 -5:5 0").high.round(3)
    array([1.0e+01, 1.0e+01, 1.4e+02, 8.7e-02, 8.7e-02, 0.0e+00])
    """
    words = number_words("--box", text)
    intervals = [tuple(number_of(end) for end in word.split(":")) for word in words]
    if len(intervals) != 6 or any(
        len(ends) not in (1, 2) or not all(map(math.isfinite, ends)) or ends[0] > ends[-1]
        for ends in intervals
    ):
        raise InvalidInput(_box_message(text))
    for ends in intervals:
        for end in ends:
            arguments.number("--box", end)
    pairs: list[Any] = [(ends[0], ends[-1]) for ends in intervals]
    return PoseBox(pairs[:3], pairs[3:], degrees=True, order=order)


def _box_message(text: str) -> str:
    units = "x y z in the unit of the design, three angles in degrees"
    wanted = f"six intervals low:high, low ≤ high ({units})"
    return expected("--box", wanted, brief(text))
